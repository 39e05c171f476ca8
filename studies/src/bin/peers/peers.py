#!/usr/bin/env python3
"""The problems of the study `peers` by other programs: makes `peers.csv`. See `peers.sh`, which runs it.

    peers.py DIR FILE.csv WAVES.csv

DIR: what `--bin peers -- --write DIR` has written. For every surface, half-space and load each program solves at the mean
pressure p and at p (1 + STEP); the stiffness is the difference quotient. Differences are to asperity's own solution:

    nodes_different      nodes with pressure in one solution and not in the other
    least_certain        greatest pressure at such a node, in either solution, over the mean pressure
    pressure_difference  greatest difference at any node over the greatest pressure
    nodes_beyond         nodes with pressure at p (1 + STEP)

The program `dense` is `dense.py`, on grids of up to DENSE nodes. WAVES.csv: the displacement under a pressure that is one
wave, over 2/(E* |q|), for the shortest wave along x and along y that is no wave of two cells.
"""
import csv
import sys
from importlib.metadata import version
from pathlib import Path

import aspher
import ContactMechanics
import numpy as np
import tamaas
from SurfaceTopography import Topography

import dense

STEP = 1e-5
DENSE = 1024
# Tighter ones are not reached at every load.
TAMAAS, ASPHER, CONTACT_MECHANICS = 1e-11, 1e-11, 1e-11
ITERATIONS = 20_000


def by_tamaas(heights, sides, half_space, load):
    model = tamaas.Model(tamaas.model_type.basic_2d, list(sides), list(heights.shape))
    model.E, model.nu = 1.0, 0.0
    solver = tamaas.PolonskyKeerRey(model, heights, TAMAAS)
    solver.max_iter = ITERATIONS
    error = solver.solve(load)
    if not error <= TAMAAS:
        raise RuntimeError(f"left {error:g}")
    return np.array(model.traction), np.array(model.displacement) - heights


def by_aspher(heights, sides, half_space, load):
    n = heights.shape[0]
    result = aspher.solve_nested(
        grid_size=n, gap=(heights.max() - heights).ravel(), p_nominal=load, domain_size=sides[0],
        E_star=1.0, coarsest=min(64, n), tol=ASPHER, max_iter=ITERATIONS,
        backend="fft" if half_space == "free" else "periodic")
    if not result.converged:
        raise RuntimeError(result.status_reason)
    return np.array(result.pressure), np.array(result.gap)


def by_contact_mechanics(heights, sides, half_space, load):
    shape = heights.shape
    cell = np.prod(sides) / heights.size
    if half_space == "free":
        substrate = ContactMechanics.FreeFFTElasticHalfSpace(shape, 1.0, tuple(sides))
    else:
        substrate = ContactMechanics.PeriodicFFTElasticHalfSpace(
            shape, 1.0, tuple(sides), stiffness_q0=0.0)
    topography = Topography(heights, tuple(sides), periodic=half_space == "periodic")
    system = ContactMechanics.Systems.NonSmoothContactSystem(substrate, topography)
    tolerance = CONTACT_MECHANICS
    result = system.minimize_proxy(
        external_force=load * np.prod(sides), pentol=tolerance * heights.std(),
        forcetol=tolerance * load * cell, thermotol=tolerance, maxiter=ITERATIONS)
    if not result.success:
        raise RuntimeError(result.message)
    gap = np.array(result.x)[:shape[0], :shape[1]] - heights - result.offset
    return np.array(result.jac)[:shape[0], :shape[1]] / cell, gap


def waves_of(shape):
    """(axis, wave number, program, displacement over 2/(E* |q|)) on a square of side 1."""
    for axis, n in enumerate(shape):
        number = (n - 1) // 2
        along = np.cos(2 * np.pi * number * np.arange(n) / n)
        wave = np.ones(shape) * (along[:, None] if axis == 0 else along[None, :])
        model = tamaas.Model(tamaas.model_type.basic_2d, [1.0, 1.0], list(shape))
        model.E, model.nu = 1.0, 0.0
        model.traction[:] = wave
        model.solveNeumann()
        substrate = ContactMechanics.PeriodicFFTElasticHalfSpace(shape, 1.0, (1.0, 1.0), stiffness_q0=0.0)
        for name, displacement in (
            ("tamaas", np.array(model.displacement)),
            ("ContactMechanics", substrate.evaluate_disp(-wave / wave.size)),
        ):
            response = (displacement * wave).sum() / (wave * wave).sum()
            yield "xy"[axis], number, name, response * np.pi * number


def by_dense(heights, sides, half_space, load):
    return dense.solve(heights, sides, half_space, load)


PROGRAMS = [
    ("aspher", by_aspher, version("aspher"), ASPHER,
     lambda shape, side, _: shape[0] == shape[1] and shape[0] % 32 == 0 and side[0] == side[1]),
    ("tamaas", by_tamaas, version("tamaas"), TAMAAS, lambda *problem: problem[2] == "periodic"),
    ("ContactMechanics", by_contact_mechanics, version("ContactMechanics"), CONTACT_MECHANICS,
     lambda *_: True),
    ("dense", by_dense, "numpy " + version("numpy"), 0.0,
     lambda shape, *_: shape[0] * shape[1] <= DENSE),
]

COLUMNS = [
    "program", "version", "tolerance", "half_space", "surface", "load", "nodes", "our_nodes", "nodes_different",
    "least_certain", "pressure_difference", "mean_gap", "our_mean_gap", "stiffness", "our_stiffness",
    "nodes_beyond"]


def main():
    directory, table, waves = map(Path, sys.argv[1:4])
    tamaas.set_log_level(tamaas.LogLevel.error)
    with open(waves, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["nx", "ny", "axis", "wave_number", "program", "response"])
        for shape in ((32, 32), (32, 27), (27, 32)):
            writer.writerows([*shape, *row[:3], f"{row[3]:.12f}"] for row in waves_of(shape))
    with open(directory / "ours.csv", newline="") as file:
        problems = list(csv.DictReader(file))
    with open(table, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for problem in problems:
            heights = np.ascontiguousarray(np.load(directory / problem["heights"]))
            ours = np.load(directory / problem["pressure"])
            sides = (float(problem["lx"]), float(problem["ly"]))
            load, half_space = float(problem["load"]), problem["half_space"]
            for name, solve, release, tolerance, can in PROGRAMS:
                if not can(heights.shape, sides, half_space):
                    continue
                row = [name, release, f"{tolerance:g}", half_space, problem["surface"], problem["load"]]
                try:
                    pressure, gap = solve(heights, sides, half_space, load)
                    beyond, gap_beyond = solve(heights, sides, half_space, load * (1 + STEP))
                except RuntimeError as error:
                    print(name, half_space, problem["surface"], load, error, flush=True)
                    continue
                different = (pressure > 0) != (ours > 0)
                least = max(pressure[different].max(initial=0), ours[different].max(initial=0)) / load
                difference = abs(pressure - ours).max() / ours.max()
                closed = gap.mean() - gap_beyond.mean()
                stiffness = STEP * load * np.prod(sides) / closed if closed else np.inf
                row += [int((pressure > 0).sum()), problem["nodes"], int(different.sum()), f"{least:.3e}",
                        f"{difference:.3e}", f"{gap.mean():.15e}", problem["mean_gap"], f"{stiffness:.9e}",
                        problem["stiffness"], int((beyond > 0).sum())]
                writer.writerow(row)
                file.flush()
                print(*row[:1], *row[3:6], *row[8:11], flush=True)


if __name__ == "__main__":
    main()
