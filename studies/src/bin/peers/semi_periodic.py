#!/usr/bin/env python3
"""Influence coefficients of a half-space that repeats along y only, by ContactMechanics: makes `tests/data/semi_periodic.csv`.

    pip install ContactMechanics==1.8.3
    semi_periodic.py FILE.csv

It sums images up to `n_images` on either side. Each line is an offset on a grid of nx x ny nodes with the sides lx x ly: the number of
images on either side, E*, and the displacement there under unit pressure on a cell and its images.
"""
import csv
import sys

import numpy as np
from ContactMechanics import SemiPeriodicFFTElasticHalfSpace

CASES = [
    # nx, ny, lx, ly, E*, images on either side
    (8, 6, 2.0, 3.0, 1.0, 10),
    (8, 6, 2.0, 3.0, 2.5, 100),
    (12, 12, 1e-3, 1e-3, 1e9, 100),
    (4, 16, 1.0, 2.0, 1.0, 40),
]


def main():
    with open(sys.argv[1], "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow("nx ny lx ly e_star images di dj coefficient".split())
        for nx, ny, lx, ly, e_star, images in CASES:
            body = SemiPeriodicFFTElasticHalfSpace(
                (nx, ny), e_star, (lx, ly), periodicity=(False, True), n_images=images)
            force = np.zeros((nx, ny))
            # It takes forces on the body, outwards.
            force[0, 0] = -lx * ly / (nx * ny)
            displacement = body.evaluate_disp(force)
            for di, dj in [(0, 0), (1, 0), (0, 1), (1, 2), (nx // 2, ny // 2), (nx - 1, 0), (nx - 1, ny - 1)]:
                table.writerow([nx, ny, lx, ly, e_star, images, di, dj, repr(float(displacement[di, dj]))])


main()
