"""When does a contact seal, and how wide is the last channel before that?

    python python/gallery/when_it_seals.py
"""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from _frame import BLUE, ORANGE, output, save

import asperity as asp

surface = asp.example_surface(nodes=96, seed=4)
rubber = asp.HalfSpace(asp.composite_modulus((10e6, 0.5)), boundary="love")
path = asp.load_path(surface, rubber)
history = path.run(check=False)

analysis = asp.patches(path)
seal = analysis.percolation().seal_x
assert seal is not None
print(f"sealed along x at {seal.area_fraction:.1%} contact, under {seal.mean_pressure / 1e6:.2f} MPa")

# The narrowest place of the widest channel along x, at states up to there.
states = [history[k] for k in np.linspace(50, seal.step - 2, 25).astype(int)]
channels = [path.constriction("x", state) for state in states]
widths = [channel.gap if channel else 0.0 for channel in channels]

figure, (left, right) = plt.subplots(1, 2, figsize=(8.4, 3.7))
pressures = [state.mean_pressure / 1e6 for state in states]
left.semilogy(pressures, np.array(widths) * 1e6, "o-", markersize=3, color=BLUE)
left.axvline(seal.mean_pressure / 1e6, color=ORANGE, linestyle="--", label="sealed")
left.set(xlabel="mean pressure (MPa)", ylabel="narrowest gap of the widest channel (µm)", title="the last channel")
left.legend()
# The load at which each node touched holds every contact map.
x, y = (1e3 * side for side in surface.size)
activation = analysis.activation("mean_pressure") / 1e6
image = right.imshow(
    activation, extent=(0, x, 0, y), origin="lower", cmap="viridis_r", vmax=2 * seal.mean_pressure / 1e6
)
rows, columns = surface.shape
centres = (np.arange(columns) + 0.5) * x / columns, (np.arange(rows) + 0.5) * y / rows
sealed = (activation <= seal.mean_pressure / 1e6).astype(float)
right.contour(*centres, sealed, [0.5], colors=ORANGE, linewidths=0.8)
right.set(xlabel="x (mm)", ylabel="y (mm)", title="pressure at which each node touched, and the seal")
right.grid(visible=False)
figure.colorbar(image, ax=right, label="mean pressure (MPa)", shrink=0.85)
save(figure, output("python_when_it_seals.png"))
