#!/usr/bin/env python3
"""Influence coefficients of a layer under square cells with a free boundary: makes `tests/data/layers_free.csv`.

    layered_cells.py FILE.csv

Needs numpy only. To Love's rectangle on a half-space of the layer comes the difference of the symbol, in the formula of Nogi and
Kato, from that of this half-space, times the transform of a cell: an integral over all wavevectors in polar coordinates, by
Gauss-Legendre quadrature with 40 panels of 20 wave numbers, narrow ones first, and 200 angles.
"""
import csv
import sys

import numpy as np

# (E1, nu1, h, E2, nu2), cells of 1; E2 = None is a rigid base.
CASES = [
    (1.0, 0.3, 1.0, None, None), (1.0, 0.49, 0.6, None, None), (1.0, 0.0, 4.0, None, None), (1.0, 0.5, 0.8, None, None),
    (0.1, 0.4, 1.0, 1.0, 0.3), (10.0, 0.2, 0.8, 1.0, 0.3), (2.0, 0.3, 3.0, 1.0, 0.4)]
OFFSETS = [(0, 0), (1, 0), (1, 1), (2, 0), (3, 2), (5, 0), (7, 4)]


def reduced(q, e1, nu1, h, e2, nu2):
    """q times displacement over pressure."""
    g1 = e1 / (2 * (1 + nu1))
    m = 0.0 if e2 is None else g1 / (e2 / (2 * (1 + nu2)))
    lam = 1 - 4 * (1 - nu1) / (1 + m * (3 - 4 * (nu2 or 0)))
    kap = (m - 1) / (m + 3 - 4 * nu1)
    x = q * h
    t = np.exp(-2 * x)
    above = 1 + 4 * x * kap * t - lam * kap * t * t
    return (1 - nu1) / g1 * above / (1 - (lam + kap + 4 * kap * x * x) * t + lam * kap * t * t)


def love(x, y, e_star):
    def corner(x, y):
        return x * np.arcsinh(y / abs(x)) + y * np.arcsinh(x / abs(y))
    a, b, c, d = x + 0.5, x - 0.5, y + 0.5, y - 0.5
    return (corner(a, c) - corner(b, c) - corner(a, d) + corner(b, d)) / (np.pi * e_star)


def main():
    nodes, weights = np.polynomial.legendre.leggauss(20)
    # Panels of [-1, 1].
    nodes = np.concatenate([(nodes + 1 + 2 * panel) / 40 - 1 for panel in range(40)])
    weights = np.tile(weights / 40, 40)
    angles, parts = np.polynomial.legendre.leggauss(200)
    angles, parts = np.pi / 4 * (angles + 1), np.pi / 4 * parts
    with open(sys.argv[1], "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow("young poisson thickness base_young base_poisson di dj coefficient".split())
        for e1, nu1, h, e2, nu2 in CASES:
            top = e1 / (1 - nu1 ** 2)
            # Behind 24 / h nothing is left.
            part = (nodes + 1) / 2
            q, w = 24 / h * part ** 3, 36 / h * part ** 2 * weights
            g = reduced(q, e1, nu1, h, e2, nu2) - 2 / top
            x, y = q[:, None] * np.cos(angles), q[:, None] * np.sin(angles)
            cell = np.sinc(x / (2 * np.pi)) * np.sinc(y / (2 * np.pi))
            for i, j in OFFSETS:
                waves = cell * np.cos(i * x) * np.cos(j * y)
                value = love(i, j, top) + (w * g) @ waves @ parts / np.pi ** 2
                table.writerow([e1, nu1, h, e2 or 0, nu2 or 0, i, j, repr(float(value))])


main()
