#!/usr/bin/env python3
"""Leaks through ten gap maps by sparse LU factors of scipy: makes `tests/data/leak`.

    leak.py DIR

Ten maps of 40 x 32 nodes, of filtered noise above a threshold: far from percolation, and with the last channel along the flow just
open. Cells have sides of 2e-5 m and 3e-5 m. Reynolds' equation in cell-centred finite volumes, harmonic means of g^3/12 on the faces,
the pressures 1 and 0 on the outer sides of the first and of the last cells, viscosity 1. The matrix is assembled as such, with
everything out of contact in it that hangs together with an edge, factored by SuperLU after its rows and columns are scaled, and its solution refined with pressures
and residuals of 50 digits, until what is lost at all cells is below 1e-15 of the leak rate.

    gaps.npy      ten maps side by side [m]; 0 in contact
    leaks.csv     one row for each map and direction
    pressures.npy the pressures of the flow along x, NaN where there is no fluid or no pressure
"""
import decimal
import sys
from pathlib import Path

import numpy as np
import scipy.sparse as sparse
from scipy.ndimage import label
from scipy.sparse.linalg import splu

SHAPE, CELL = (40, 32), (2e-5, 3e-5)
decimal.getcontext().prec = 50
LONG = np.frompyfunc(decimal.Decimal, 1, 1)
FLOAT = np.frompyfunc(float, 1, 1)


def noise(seed):
    """Periodic, of a Hurst exponent of 0.8 between waves of half the side and of four cells, with the rms 1."""
    nx, ny = SHAPE
    q = np.hypot(*np.meshgrid(np.fft.fftfreq(nx) * nx, np.fft.fftfreq(ny) * nx, indexing="ij"))
    inside = (q >= 2) & (q <= nx / 4)
    amplitude = np.zeros(SHAPE)
    amplitude[inside] = q[inside] ** -1.8
    z = np.real(np.fft.ifft2(np.fft.fft2(np.random.default_rng(seed).standard_normal(SHAPE)) * amplitude))
    return z / z.std()


def neighbours(periodic):
    """Pairs of cells with a common side, and the width of that side over the distance: flow along the first index."""
    def pairs(shape):
        number = np.arange(shape[0] * shape[1]).reshape(shape)
        along = number[:-1].ravel(), number[1:].ravel()
        across = number[:, :-1].ravel(), number[:, 1:].ravel()
        if periodic:
            across = tuple(np.concatenate(both) for both in zip(across, (number[:, -1], number[:, 0])))
        return along, across
    return pairs


def open_along(gap, periodic):
    """Which cells hang together with the first row, and with the last."""
    parts, count = label(gap > 0)
    if periodic:
        # Joins parts across the border.
        parent = list(range(count + 1))
        def root(k):
            while parent[k] != k:
                k = parent[k]
            return k
        for a, b in zip(parts[:, 0], parts[:, -1]):
            if a and b:
                parent[root(a)] = root(b)
        parts = np.array([root(k) for k in range(count + 1)])[parts]
    at = lambda row: np.isin(parts, parts[row][parts[row] > 0])
    return at(0), at(-1)


def leak(gap, cell, periodic):
    """Leak rate, permeability across, and pressures: from the first row to the last."""
    shape = gap.shape
    (dx, dy), k = cell, LONG(gap.ravel()) ** 3 / 12
    first, last = open_along(gap, periodic)
    wet = (first | last).ravel()
    nowhere = np.full(shape, np.nan)
    if not (first & last).any():
        nowhere[first], nowhere[last] = 1.0, 0.0
        return LONG(0.0), LONG(0.0), nowhere
    number = np.full(gap.size, -1)
    number[wet] = np.arange(wet.sum())
    along, across = neighbours(periodic)(shape)
    faces = []
    for (a, b), form in ((along, LONG(dy) / LONG(dx)), (across, LONG(dx) / LONG(dy))):
        both = wet[a] & wet[b]
        a, b = a[both], b[both]
        faces.append((number[a], number[b], 2 * k[a] * k[b] / (k[a] + k[b]) * form))
    i, j, t = (np.concatenate(part) for part in zip(*faces))
    n = wet.sum()
    zeros = lambda *shape: LONG(np.zeros(shape))
    edge = zeros(2, n)
    rows = np.arange(gap.size).reshape(shape)
    for side, row in ((0, rows[0]), (1, rows[-1])):
        row = row[wet[row]]
        edge[side, number[row]] = 2 * k[row] * (LONG(dy) / LONG(dx))
    diagonal = edge[0] + edge[1]
    np.add.at(diagonal, i, t)
    np.add.at(diagonal, j, t)
    scale = 1 / np.sqrt(FLOAT(diagonal).astype(float))
    w = FLOAT(t).astype(float) * scale[i] * scale[j]
    matrix = sparse.coo_matrix(
        (np.concatenate([np.ones(n), -w, -w]),
         (np.concatenate([np.arange(n), i, j]), np.concatenate([np.arange(n), j, i]))), shape=(n, n)).tocsc()
    factor = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    p = zeros(n)
    for _ in range(200):
        flow = t * (p[i] - p[j])
        residual = edge[0] * (1 - p) - edge[1] * p
        np.add.at(residual, i, -flow)
        np.add.at(residual, j, flow)
        rate = (edge[0] * (1 - p)).sum()
        if abs(residual).sum() < LONG(1e-15) * abs(rate):
            break
        size = max(abs(residual))
        scaled = FLOAT(residual / size).astype(float) * scale
        p += LONG(scale * factor.solve(scaled)) * size
    else:
        raise RuntimeError(f"not refined: {abs(residual).sum() / rate}")
    out = (edge[1] * p).sum()
    assert abs(rate / out - 1) < LONG(1e-14), rate / out - 1
    nowhere[wet.reshape(shape)] = FLOAT(p).astype(float)
    la, lc = shape[0] * LONG(dx), shape[1] * LONG(dy)
    a, b, t = faces[1]
    return rate, (t * (p[a] - p[b])).sum() * LONG(dy) / lc, nowhere


def threshold(z, periodic, along):
    """The greatest height at which a channel still leads along the flow."""
    heights = np.sort(z.ravel())
    low, high = 0, heights.size - 1
    is_open = lambda k: (lambda ends: (ends[0] & ends[1]).any())(
        open_along(np.maximum(z - heights[k], 0) if along == 0 else np.maximum(z - heights[k], 0).T, periodic))
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if is_open(middle) else (low, middle)
    return heights, low


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    gaps, pressures, lines = [], [], ["map,boundary,along,leak_rate,transverse_permeability"]
    for case in range(10):
        periodic = case % 2 == 1
        z = noise(case)
        heights, last = threshold(z, periodic, 0)
        # Shares of the cells that are closed at percolation, and at last the last open state itself.
        place = int(last * [0.0, 0.3, 0.6, 0.8, 0.9, 0.95, 0.98, 0.99, 1.0, 1.0][case])
        # Between two heights, just below the upper one: the narrowest place of the last channel is all but closed.
        part = [0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.9][case]
        level = heights[place] * (1 - part) + heights[min(place + 1, heights.size - 1)] * part
        gap = np.maximum(z - level, 0) * 1e-6
        gaps.append(gap)
        for along, name in ((0, "x"), (1, "y")):
            turned, cell = (gap, CELL) if along == 0 else (gap.T, CELL[::-1])
            rate, across, p = leak(turned, cell, periodic)
            if along == 0:
                pressures.append(p)
            boundary = "periodic" if periodic else "free"
            lines.append(f"{case},{boundary},{name},{float(rate)!r},{float(across) if periodic else float('nan')!r}")
            k = gap[gap > 0] ** 3
            print(lines[-1], f"{(gap == 0).mean():.3f} closed, contrast {k.max() / k.min():.1e}")
    np.save(folder / "gaps.npy", np.hstack(gaps))
    np.save(folder / "pressures.npy", np.hstack(pressures))
    (folder / "leaks.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
