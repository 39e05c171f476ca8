"""Contact resistance against load: copper on copper, with bounds for roughness finer than the grid, and the gap in parallel.

    python python/gallery/contact_resistance.py
"""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from _frame import BLUE, GREY, ORANGE, output, save

import asperity as asp

# Resistivity [Ω m] and conductivity [W/(m K)] of copper.
RESISTIVITY, CONDUCTIVITY = 1.7e-8, 400.0
copper = asp.composite_modulus((120e9, 0.34), (120e9, 0.34))
side = 1e-3
surface = asp.self_affine((128, 128), side, hurst=0.8, rolloff=side / 4, short_cutoff=side / 32, rms_height=1e-6, seed=1)
# Bounds look beyond the loads that are drawn.
path = asp.load_path(surface, asp.HalfSpace(copper, boundary="love"), load=60.0)
history = path.run(check=False)
shown = (history.load > 0.02) & (history.load < 20.0)
load = history.load[shown]

figure, (left, right) = plt.subplots(1, 2, figsize=(8.4, 3.6))
left.loglog(load, 1e3 / asp.conductance(path, 2 * RESISTIVITY, carrier="current")[shown], color=BLUE)
for unresolved, colour in [(1e-9, GREY), (1e-8, ORANGE)]:
    low, high = (bound[shown] for bound in asp.conductance_bounds(path, 2 * RESISTIVITY, unresolved, carrier="current"))
    name = f"roughness of {1e9 * unresolved:.0f} nm below the grid"
    left.fill_between(load, 1e3 / high, 1e3 / low, color=colour, alpha=0.35, linewidth=0, label=name)
left.set(xlabel="load [N]", ylabel="resistance [mΩ]", title="current")
left.legend(loc="lower left")
metal = asp.conductance(path, 2 / CONDUCTIVITY)[shown]
both = asp.conductance(path, 2 / CONDUCTIVITY, gap=(0.026, 3.7e-7))[shown]
right.loglog(load, metal / surface.area, color=BLUE, label="spots in contact")
right.loglog(load, both / surface.area, color=ORANGE, label="with air in the gap")
right.set(xlabel="load [N]", ylabel="conductance [W/(m² K)]", title="heat")
right.legend(loc="lower right")
# At exactly 10 N, not at the event after it: the conductance is 2 K / (resistivity E*).
stiffness = history.at(load=10.0).interfacial_stiffness
print(f"at 10 N: {1e3 * RESISTIVITY * copper / stiffness:.4f} mΩ")
save(figure, output("python_contact_resistance.png"))
