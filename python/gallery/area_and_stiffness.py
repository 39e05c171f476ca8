"""Contact area and stiffness against load: every event of six surfaces, and their linear laws.

    python python/gallery/area_and_stiffness.py
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import matplotlib.pyplot as plt
import numpy as np
from _frame import BLUE, GREY, ORANGE, output, save

import asperity as asp

E_STAR, SIDE = 115e9, 1e-2
body = asp.HalfSpace(E_STAR, boundary="love")


def path_of(seed: int) -> tuple[asp.Surface, asp.History]:
    """One surface to 30 % contact."""
    surface = asp.self_affine(
        (96, 96), SIDE, hurst=0.8, rolloff=SIDE / 4, short_cutoff=SIDE / 12, rms_gradient=0.1, seed=seed
    )
    return surface, asp.load_path(surface, body, area_fraction=0.3).run(check=False)


# The lock of the interpreter is released: paths run side by side.
with ThreadPoolExecutor() as threads:
    found = list(threads.map(path_of, range(1, 7)))

figure, (left, right) = plt.subplots(1, 2, figsize=(8.4, 3.6))
slopes = []
for surface, history in found:
    reduced = history.mean_pressure / (E_STAR * surface.moments().rms_gradient)
    corrected = history.corrected_area / surface.area
    left.plot(reduced, corrected, color=BLUE, alpha=0.6, linewidth=1)
    light = reduced < 0.05
    slopes.append(np.polyfit(reduced[light], corrected[light], 1)[0])
    stiffness = history.interfacial_stiffness * surface.sq / (E_STAR * surface.area)
    right.loglog(history.mean_pressure[5:] / E_STAR, stiffness[5:], color=ORANGE, alpha=0.6, linewidth=1)
print(f"kappa, the slope of the area: {np.mean(slopes):.2f} +- {np.std(slopes):.2f}")
line = np.linspace(0, 0.12, 2)
left.plot(line, 2 * line, color=GREY, linestyle="--", label="κ = 2")
left.set(xlabel="p̄ / (E* h′)", ylabel="contact area / nominal area", title="area, corrected for whole cells")
left.legend(loc="lower right")
pressures = np.array([1e-4, 1e-2])
right.loglog(pressures, 2 * pressures, color=GREY, linestyle="--", label="K Sq / (E* A) = 2 p̄ / E*")
right.set(xlabel="p̄ / E*", ylabel="K Sq / (E* A)", title="interfacial stiffness")
right.legend(loc="lower right")
save(figure, output("python_area_and_stiffness.png"))
