"""Contact on small grids without any iteration: the judge where programs differ.

The influence matrix is built entry by entry, from Love's formula on the free half-space, from the sum over all waves on
the periodic one, and the equations on the contact set are solved by LU. The set changes until no pressure is negative
and no gap is; the conditions of contact are then met to rounding, and since the matrix is positive definite on pressures
of one sum, no other solution exists.
"""
import numpy as np


def love(nx, ny, dx, dy):
    """Displacement of the node (0, 0) under unit pressure on the cell (ix, iy); E* = 1."""
    def part(x, y0, y1):
        return x * (np.arcsinh(y1 / abs(x)) - np.arcsinh(y0 / abs(x)))

    c = np.empty((nx, ny))
    for i in range(nx):
        for j in range(ny):
            x0, x1, y0, y1 = (i - .5) * dx, (i + .5) * dx, (j - .5) * dy, (j + .5) * dy
            c[i, j] = (part(x1, y0, y1) - part(x0, y0, y1)
                       + part(y1, x0, x1) - part(y0, x0, x1)) / np.pi
    return c


def waves(nx, ny, dx, dy):
    """The same on the periodic half-space, 2/|q| for each wave of the grid, the two ends of the spectrum of an even
    number of nodes being one wave; mean displacement zero."""
    kx = np.array([k if 2 * k <= nx else k - nx for k in range(nx)]) / (nx * dx)
    ky = np.array([k if 2 * k <= ny else k - ny for k in range(ny)]) / (ny * dy)
    q = 2 * np.pi * np.hypot(kx[:, None], ky[None, :])
    q[0, 0] = 1.0
    symbol = 2 / q
    symbol[0, 0] = 0.0
    along_x = np.cos(2 * np.pi * np.outer(np.arange(nx), np.arange(nx)) / nx)
    along_y = np.cos(2 * np.pi * np.outer(np.arange(ny), np.arange(ny)) / ny)
    # The symbol is even along each axis, so that sines drop out.
    return along_x @ symbol @ along_y / (nx * ny)


def matrix(half_space, nx, ny, dx, dy):
    c = (love if half_space == "free" else waves)(nx, ny, dx, dy)
    ix, iy = np.divmod(np.arange(nx * ny), ny)
    return c[abs(ix[:, None] - ix), abs(iy[:, None] - iy)]


def solve(heights, sides, half_space, mean_pressure):
    """Pressure and gap at a mean pressure."""
    nx, ny = heights.shape
    c = matrix(half_space, nx, ny, sides[0] / nx, sides[1] / ny)
    h = heights.ravel()
    total = mean_pressure * nx * ny
    contact = h > np.quantile(h, 0.5)
    for _ in range(1000):
        n = contact.sum()
        system = np.ones((n + 1, n + 1))
        system[:n, :n] = c[np.ix_(contact, contact)]
        system[:n, n] = -1.0
        system[n, n] = 0.0
        solved = np.linalg.solve(system, np.append(h[contact], total))
        pressure = np.zeros(nx * ny)
        pressure[contact] = solved[:n]
        # C p = h + δ in contact.
        gap = c @ pressure - h - solved[n]
        negative = pressure < 0
        if negative.any():
            contact &= ~negative
            continue
        below = ~contact & (gap < -1e-14 * np.ptp(h))
        if not below.any():
            return pressure.reshape(nx, ny), np.where(contact, 0.0, gap).reshape(nx, ny)
        contact |= below
    raise RuntimeError("the contact set did not settle")
