#!/usr/bin/env python3
"""Stresses below the surface by tamaas' volume operators: makes `stress.csv`, which the study `stress` reads.

    stress.py FILE.csv

Hertz's pressure of radius 1 on a half-space that repeats every 4 radii, at the nodes, smoothed with weights of 1, 2, 1 along both sides:
of the shortest wave of a grid nothing is left, whose direction has no meaning. Each line is a node (ix, iy) on n x n nodes, a depth, and
all components of the stress.
"""
import csv
import sys

import numpy as np
import tamaas

POISSON = 0.3
SIDE = 4.0
NODES = [32, 256]
STEP, DEPTHS = 0.25, 4


def pressure(n):
    x = (np.arange(n) - n // 2) * SIDE / n
    square = 1.0 - x[:, None] ** 2 - x[None, :] ** 2
    smooth = np.sqrt(np.maximum(square, 0.0))
    for axis in (0, 1):
        smooth = 0.25 * (np.roll(smooth, 1, axis) + np.roll(smooth, -1, axis)) + 0.5 * smooth
    return smooth


def stress(n):
    """xx, yy, zz, yz, xz, xy at [depth, ix, iy]."""
    model = tamaas.Model(tamaas.model_type.volume_2d, [STEP * (DEPTHS - 1), SIDE, SIDE], [DEPTHS, n, n])
    model.E, model.nu = 1.0, POISSON
    tamaas.ModelFactory.registerVolumeOperators(model)
    model.traction[..., 2] = pressure(n)
    gradient = np.zeros((DEPTHS, n, n, 6))
    model.operators["boussinesq_gradient"](model.traction, gradient)
    found = np.zeros_like(gradient)
    model.operators["hooke"](gradient, found)
    # Its order is xx, yy, zz, xy, xz, yz, the last three times the root of 2.
    return found[..., [0, 1, 2, 5, 4, 3]] / np.array([1, 1, 1, *3 * [np.sqrt(2)]])


def main():
    tamaas.set_log_level(tamaas.LogLevel.error)
    with open(sys.argv[1], "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow("version nodes depth ix iy xx yy zz yz xz xy".split())
        for n in NODES:
            found = stress(n)
            for k in range(1, DEPTHS):
                for ix in n // 2 + np.arange(3) * n // 8:
                    for iy in n // 2 + np.arange(3) * n // 8:
                        values = [f"{value:.16e}" for value in found[k, ix, iy]]
                        table.writerow([tamaas.__version__, n, k * STEP, ix, iy, *values])


main()
