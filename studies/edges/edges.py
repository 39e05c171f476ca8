#!/usr/bin/env python3
"""How far into a map the step at its border reaches if it is taken as periodic.

    pip install numpy tamaas==2.9.0
    python studies/edges/edges.py

Pieces of periodic self-affine surfaces, levelled and taken as periodic, beside the contact that they have in the whole surface
at the same load. Prints the table of docs/measured_surfaces.md.
"""
import numpy as np
import tamaas

WHOLE, PIECE, CUTOFF, HURST = 512, 256, 8, 0.8  # cells
LOAD = 0.06  # mean pressure over E* and the rms gradient
DISTANCES = [0, 1, 3, 8, 16, 32, 64, 128]
SEEDS = range(4)


def surface(rolloff, seed):
    """Heights of a Gaussian self-affine surface with a roll-off of so many cells."""
    waves = np.fft.fft2(np.random.default_rng(seed).standard_normal((WHOLE, WHOLE)))
    k = np.fft.fftfreq(WHOLE)
    q = np.hypot(k[:, None], k[None, :])
    density = np.maximum(q, 1 / rolloff) ** (-2 * (1 + HURST))
    density[(q > 1 / CUTOFF) | (q == 0)] = 0
    heights = np.fft.ifft2(waves * np.sqrt(density)).real
    return heights / heights.std()


def level(heights):
    """The heights without their mean plane."""
    x = np.arange(PIECE) - (PIECE - 1) / 2
    slopes = [(heights * x[:, None]).sum(), (heights * x[None, :]).sum()] / (PIECE * (x**2).sum())
    return heights - heights.mean() - slopes[0] * x[:, None] - slopes[1] * x[None, :]


def pressure(heights, mean):
    side = float(len(heights))
    model = tamaas.Model(tamaas.model_type.basic_2d, [side, side], heights.shape)
    model.E, model.nu = 1.0, 0.0
    solver = tamaas.PolonskyKeerRey(model, np.ascontiguousarray(heights), 1e-9)
    solver.max_iter = 4000
    solver.solve(mean)
    return np.array(model.traction)


def main():
    tamaas.set_log_level(tamaas.LogLevel.error)
    nodes = np.arange(PIECE)
    inward = np.minimum(nodes, PIECE - 1 - nodes)
    distance = np.minimum(inward[:, None], inward[None, :])
    for rolloff in (PIECE // 4, PIECE):
        shares, greatest, inside, areas = [], [], [], []
        for seed in SEEDS:
            whole = surface(rolloff, seed)
            gradient = np.hypot(*np.gradient(whole))
            true = pressure(whole, LOAD * np.sqrt((gradient**2).mean()))
            areas.append((true > 0).mean())
            for corner in (0, WHOLE - PIECE):
                piece = slice(corner, corner + PIECE), slice(corner, corner + PIECE)
                found = pressure(level(whole[piece]), true[piece].mean())
                differ, right = (found > 0) != (true[piece] > 0), true[piece] > 0
                rings = [(distance >= a) & (distance < b) for a, b in zip(DISTANCES, DISTANCES[1:])]
                shares.append([differ[ring].sum() / right[ring].sum() for ring in rings])
                greatest.append(found.max() / true[piece].max())
                far = distance >= 32
                inside.append(found[far].max() / true[piece][far].max())
        print(f"roll-off {rolloff} cells, {len(shares)} pieces, contact {100 * np.mean(areas):.1f} %")
        for a, b, share in zip(DISTANCES, DISTANCES[1:], np.mean(shares, axis=0)):
            print(f"  {a} to {b - 1} cells from the border: {100 * share:.0f} % differ")
        print(f"  greatest pressure {min(greatest):.2f} to {max(greatest):.2f} of the true one, "
              f"32 cells inside {min(inside):.2f} to {max(inside):.2f}")


if __name__ == "__main__":
    main()
