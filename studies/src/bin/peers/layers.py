#!/usr/bin/env python3
"""The symbol of an elastic layer on a rigid base by ContactMechanics: makes `tests/data/layers_contact_mechanics.csv`.

    pip install ContactMechanics==1.8.3
    layers.py FILE.csv

Each line is a wave (kx, ky) on a grid of nx x ny nodes with the sides lx x ly: the thickness of the layer, Young's modulus, Poisson's
ratio, and the displacement over the pressure.
"""
import csv
import sys

import numpy as np
from ContactMechanics import PeriodicFFTElasticHalfSpace

CASES = [
    # nx, ny, lx, ly, thickness, young, poisson
    (8, 6, 2.0, 3.0, 0.05, 1.0, 0.3),
    (8, 6, 2.0, 3.0, 0.4, 2.5, 0.0),
    (16, 16, 1e-3, 1e-3, 2e-5, 3e9, 0.45),
    (12, 8, 1.0, 1.0, 0.2, 1.0, 0.499),
    (8, 8, 1.0, 1.0, 3.0, 1.0, 0.2),
]


def main():
    with open(sys.argv[1], "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow("nx ny lx ly thickness young poisson kx ky compliance".split())
        for nx, ny, lx, ly, thickness, young, poisson in CASES:
            body = PeriodicFFTElasticHalfSpace(
                (nx, ny), young, (lx, ly), thickness=thickness, poisson=poisson)
            cell = lx * ly / (nx * ny)
            for kx, ky in [(0, 0), (1, 0), (0, 1), (2, 3), (nx // 2, 0), (3, ny // 2)]:
                # It takes forces on the body, outwards; and both directions of the greatest wave are the same.
                i, j = np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij")
                pressure = np.cos(2 * np.pi * (kx * i / nx + ky * j / ny))
                displacement = body.evaluate_disp(-pressure * cell)
                compliance = displacement[0, 0]
                error = abs(displacement - compliance * pressure).max() / abs(compliance)
                assert error < 1e-12, error
                table.writerow([nx, ny, lx, ly, thickness, young, poisson, kx, ky,
                                repr(float(compliance))])


main()
