#!/usr/bin/env python3
"""The pull of adhesion, estimated from a path without adhesion: how far the estimate depends on the smoothing of its derivatives.

    pull_off.py PROGRAM

PROGRAM: `asperity`, built. In the limit of JKR (short-ranged adhesion of the energy w per area) and of a contact that is a function of the
approach alone (Ciavarella, J. Mech. Phys. Solids 114 (2018) 209), the state of the contact area A(d) of the path has the load

    P = P1 - P1' sqrt(2 w A' / P1''),

with the load P1(d) of the path. Its derivatives jump at every event, so that they are those of local polynomials: a cubic of the load, a
parabola of the area, with the weights (1 - t^3)^3 of t = |d - d1| / (s d1). Prints the pull-off force, the least load below zero, for
windows s; on a sphere over 1.5 pi w R, on rough surfaces in newtons. Negative: pulling is not needed, the surfaces part by themselves.
"""
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np

WINDOWS = (0.2, 0.3, 0.4, 0.5, 0.6)
SIDE, RADIUS, MODULUS = 1e-3, 5e-3, 1e9
STEEL = 210e9 / 0.91
# The first events are of single asperities.
FIRST = 30


def path(program, folder, *options):
    out = Path(folder) / "out"
    subprocess.run([program, "path", *options, "--out", out], check=True, capture_output=True)
    table = np.genfromtxt(out / "path.csv", delimiter=",", names=True, dtype=None, encoding=None)
    return tuple(table[name].astype(float) for name in ("approach", "load", "contact_area"))


def local(x, y, at, half, degree):
    """Value and two derivatives of a local polynomial; None without enough points."""
    t = (x - at) / half
    near = np.abs(t) < 1
    if len(np.unique(t[near])) < degree + 3:
        return None
    weights = np.sqrt((1 - np.abs(t[near]) ** 3) ** 3)
    c = np.polyfit(t[near], y[near], degree, w=weights)[::-1]
    return c[0], c[1] / half, 2 * c[2] / half ** 2


def pull_off(curves, energy, window):
    approach, load, area = curves
    least = np.inf
    for at in np.geomspace(approach[FIRST], 0.9 * approach[-1], 150):
        p, a = local(approach, load, at, window * at, 3), local(approach, area, at, window * at, 2)
        if p and a and p[2] > 0 and a[1] > 0:
            least = min(least, p[0] - p[1] * np.sqrt(2 * energy * a[1] / p[2]))
    return -least


def main(program):
    warnings.filterwarnings("ignore")
    print("| contact | w [J/m²] | radius at pull-off [cells] |", *(f"s = {s} |" for s in WINDOWS))
    print("|---|---|---|" + "---|" * len(WINDOWS))
    with tempfile.TemporaryDirectory() as folder:
        for nodes in (64, 128, 192):
            x = (np.arange(nodes) + 0.5) * SIDE / nodes - SIDE / 2
            heights = Path(folder) / "sphere.npy"
            np.save(heights, -np.add.outer(x ** 2, x ** 2) / (2 * RADIUS))
            curves = path(program, folder, "--surface", heights, "--side", str(SIDE),
                          "--e-star", str(MODULUS), "--max-area-fraction", "0.4")
            for energy in (1.0, 10.0):
                cells = (9 * np.pi * energy * RADIUS ** 2 / (8 * MODULUS)) ** (1 / 3) * nodes / SIDE
                forces = [pull_off(curves, energy, s) / (1.5 * np.pi * energy * RADIUS) for s in WINDOWS]
                print(f"| sphere, {nodes}² | {energy:g} | {cells:.1f} |", *(f"{force:.4g} |" for force in forces))
        for seed in (1, 2, 3):
            curves = path(program, folder, "--nodes", "256", "--seed", str(seed), "--max-area-fraction", "0.1")
            for energy in (3e4, 1e5):
                forces = [pull_off(curves, energy, s) for s in WINDOWS]
                print(f"| rough, seed {seed} | {energy:.0e} | |", *(f"{force:.4g} |" for force in forces))


if __name__ == "__main__":
    main(sys.argv[1])
