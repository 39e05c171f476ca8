#!/usr/bin/env python3
"""Contact with a hardness by tamaas' solver with a ceiling (KatoSaturated): makes `hardness.csv`.

    hardness.py PROGRAM FILE.csv

PROGRAM: `asperity`, built. Ten self-affine surfaces on a periodic half-space, each with a hardness and a mean pressure of its own;
asperity follows the path to that pressure, tamaas solves for it alone.

    contact_different   nodes with pressure in one solution and not in the other
    yielded_different   nodes at the hardness in one solution and not in the other
    difference          greatest difference of pressures over the hardness
"""
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import tamaas

TOLERANCE = 1e-12
# (nodes, seed, hardness over E* h', mean pressure over hardness)
CASES = [
    (64, 1, 0.05, 0.1), (64, 2, 0.1, 0.3), (64, 3, 0.2, 0.05), (64, 4, 0.5, 0.2), (64, 5, 1.0, 0.1),
    (128, 6, 0.02, 0.05), (128, 7, 0.1, 0.1), (128, 8, 0.2, 0.6), (128, 9, 0.5, 0.05), (128, 10, 0.2, 0.9)]


def surface(n, seed):
    """Heights of a Hurst exponent of 0.8 between waves of half the side and of eight cells."""
    q = np.hypot(*np.meshgrid(np.fft.fftfreq(n) * n, np.fft.fftfreq(n) * n, indexing="ij"))
    inside = (q >= 2) & (q <= n / 8)
    amplitude = np.zeros((n, n))
    amplitude[inside] = q[inside] ** -1.8
    noise = np.fft.fft2(np.random.default_rng(seed).standard_normal((n, n)))
    z = np.real(np.fft.ifft2(noise * amplitude))
    return z / z.std() * 1e-2


def rms_gradient(z):
    n = len(z)
    k = 2j * np.pi * np.fft.fftfreq(n) * n
    s = np.fft.fft2(z)
    slopes = [np.fft.ifft2(s * k[:, None]).real, np.fft.ifft2(s * k[None, :]).real]
    return np.sqrt(sum((slope ** 2).mean() for slope in slopes))


def by_tamaas(z, hardness, pressure):
    model = tamaas.Model(tamaas.model_type.basic_2d, [1.0, 1.0], list(z.shape))
    model.E, model.nu = 1.0, 0.0
    solver = tamaas.KatoSaturated(model, z.copy(), TOLERANCE, hardness)
    solver.max_iter = 1_000_000
    error = solver.solve(pressure)
    return np.array(model.traction), error


def by_asperity(program, z, hardness, pressure):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "surface.npy"
        np.save(file, z)
        subprocess.run(
            [program, "path", "--surface", file, "--side", "1", "--e-star", "1", "--periodic", "spectral",
             "--hardness", repr(hardness), "--mean-pressure", repr(pressure), "--fields", "npy", "--out", folder],
            check=True, capture_output=True)
        return np.load(Path(folder) / "pressure.npy")


def main():
    program, table = sys.argv[1:3]
    tamaas.set_log_level(tamaas.LogLevel.error)
    with open(table, "w", newline="") as output:
        writer = csv.writer(output)
        writer.writerow(["nodes", "seed", "hardness_over_e_star_gradient", "mean_pressure_over_hardness", "contact_nodes",
                         "yielded_nodes", "contact_different", "yielded_different", "difference", "tamaas_error"])
        for n, seed, ratio, share in CASES:
            z = surface(n, seed)
            hardness = float(ratio * rms_gradient(z))
            pressure = float(share * hardness)
            ours = by_asperity(program, z, hardness, pressure)
            theirs, error = by_tamaas(z, hardness, pressure)
            low = [p > 1e-7 * hardness for p in (ours, theirs)]
            high = [p > (1 - 1e-7) * hardness for p in (ours, theirs)]
            row = [n, seed, ratio, share, int(low[0].sum()), int(high[0].sum()), int((low[0] != low[1]).sum()),
                   int((high[0] != high[1]).sum()), f"{abs(ours - theirs).max() / hardness:.3e}", f"{error:.3e}"]
            writer.writerow(row)
            output.flush()
            print(*row, flush=True)


main()
