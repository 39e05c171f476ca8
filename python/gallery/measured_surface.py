"""From the file of a measurement to its contact under a pressure.

    python python/gallery/measured_surface.py
"""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from _frame import output, save

import asperity as asp

FILE = Path(__file__).resolve().parents[2] / "tests" / "data" / "selfaffine_128.npy"

# A .npy file has neither size nor unit; those of instruments do. A tilt is taken off, and holes are filled.
surface = asp.read(FILE, size=(1e-2, 1e-2), height_unit="m").level("plane").fill_missing()
print(f"{surface}, Sq {surface.sq * 1e6:.1f} um, rms gradient {surface.rms_gradient:.3f}")

steel = asp.HalfSpace(asp.composite_modulus("steel", "steel"), boundary="free")
path = asp.load_path(surface, steel, mean_pressure=200e6)
# It is elastic: the greatest pressure is what the warning is about.
history = path.run(check=False)
last, pressure = history[-1], path.pressure()
print(f"{len(history)} events; at {last.mean_pressure / 1e6:.0f} MPa "
      f"{last.area_fraction:.2%} in contact, greatest pressure {pressure.max() / 1e9:.1f} GPa")

x, y = (1e3 * side for side in surface.size)
figure, (left, right) = plt.subplots(1, 2, figsize=(8.4, 3.7))
heights = left.imshow(surface.z * 1e6, extent=(0, x, 0, y), origin="lower", cmap="cividis")
left.set(title="heights", xlabel="x (mm)", ylabel="y (mm)")
figure.colorbar(heights, ax=left, label="z (µm)", shrink=0.85)
carried = np.ma.masked_where(~path.contact_map(), pressure / 1e9)
map_ = right.imshow(carried, extent=(0, x, 0, y), origin="lower", cmap="inferno_r", interpolation="nearest")
right.set(title=f"contact under {last.mean_pressure / 1e6:.0f} MPa", xlabel="x (mm)")
figure.colorbar(map_, ax=right, label="pressure (GPa)", shrink=0.85)
for axes in (left, right):
    axes.grid(visible=False)
save(figure, output("python_measured_surface.png"))
