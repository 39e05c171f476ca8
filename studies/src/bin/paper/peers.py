#!/usr/bin/env python3
"""Contact of one surface by aspher and tamaas: makes `peers.csv`, which the study `paper` reads.

    cargo run --release -p asperity-studies --bin paper -- --peers-surface heights.npy
    pip install numpy tamaas aspher
    python3 studies/src/bin/paper/peers.py heights.npy > studies/src/bin/paper/peers.csv

heights.npy: the surface of Table 1, seed 1, on 256 x 256 nodes and a side of 1e-2, heights towards
the half-space. aspher solves the free half-space with Love's kernel; tamaas the periodic one with
2/(E*|q|). E* = 1. Columns: program, version, tolerance of the solver, mean pressure / E*, nodes with
pressure, greatest pressure / E*.
"""
import sys
from importlib.metadata import version

import aspher
import numpy as np
import tamaas

SIDE = 1e-2
LOADS = [0.001, 0.01, 0.05]
# The path to higher loads on a periodic half-space is long.
PERIODIC_LOADS = [0.001, 0.01]


def by_aspher(heights, load, tolerance):
    n = heights.shape[0]
    result = aspher.solve_nested(
        grid_size=n, gap=(heights.max() - heights).ravel(), p_nominal=load, domain_size=SIDE,
        E_star=1.0, coarsest=min(64, n), tol=tolerance, backend="fft")
    assert str(result.status) == "converged", result.status
    return np.asarray(result.pressure)


def by_tamaas(heights, load, tolerance):
    model = tamaas.Model(tamaas.model_type.basic_2d, [SIDE, SIDE], list(heights.shape))
    model.E, model.nu = 1.0, 0.0
    solver = tamaas.PolonskyKeerRey(model, heights, tolerance)
    solver.max_iter = 20000
    error = solver.solve(load)
    assert error <= tolerance, error
    return np.asarray(model.traction)


def main():
    tamaas.set_log_level(tamaas.LogLevel.error)
    heights = np.ascontiguousarray(np.load(sys.argv[1]))
    print("program,version,tolerance,load,nodes,greatest_pressure")
    for name, solve, loads, tolerance in (
        ("aspher", by_aspher, LOADS, 1e-8),
        ("tamaas", by_tamaas, PERIODIC_LOADS, 1e-12),
    ):
        for load in loads:
            pressure = solve(heights, load, tolerance)
            print(f"{name},{version(name)},{tolerance:g},{load:g},{int((pressure > 0).sum())},"
                  f"{pressure.max():.17g}", flush=True)


if __name__ == "__main__":
    main()
