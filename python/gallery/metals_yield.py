"""How much of a steel surface yields, and what is left after unloading?

    python python/gallery/metals_yield.py
"""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from _frame import BLUE, GREY, ORANGE, output, save

import asperity as asp

surface = asp.example_surface(nodes=128)
steel = asp.materials()["steel"]
assert steel.hardness is not None
body = asp.HalfSpace(asp.composite_modulus("steel"), boundary="free")

elastic = asp.load_path(surface, body, area_fraction=0.15).run(check=False)
path = asp.load_path(surface, body, area_fraction=0.15, hardness=steel.hardness)
history = path.run()
unloading = path.unload()
share = unloading.energy_lost / (unloading.energy_lost + unloading.energy_returned)
print(f"{(history.event == 'yield').sum()} of {(history.event == 'touch').sum()} nodes have yielded; "
      f"{share:.0%} of the work is lost, in {unloading.plastic_volume * 1e9:.3g} mm³")

figure, (left, right) = plt.subplots(1, 2, figsize=(8.4, 3.6))
left.plot(elastic.load / 1e3, 100 * elastic.area_fraction, color=GREY, label="elastic")
left.plot(history.load / 1e3, 100 * history.area_fraction, color=BLUE, label="with a hardness of 2.5 GPa")
left.plot(history.load / 1e3, 100 * history.yielded_area_fraction, color=ORANGE, linestyle="--", label="of which yielded")
left.set(xlabel="load (kN)", ylabel="contact area (%)", title="area", xlim=(0, 1.3 * history.load[-1] / 1e3))
left.legend()
back = unloading.columns()
right.plot(history.approach * 1e6, history.load / 1e3, color=BLUE, label="loading")
right.plot(back["approach"] * 1e6, back["load"] / 1e3, color=ORANGE, label="unloading")
right.fill(
    np.concatenate([history.approach, back["approach"]]) * 1e6,
    np.concatenate([history.load, back["load"]]) / 1e3,
    color=ORANGE,
    alpha=0.15,
    label="energy lost",
)
right.set(xlabel="approach (µm)", ylabel="load (kN)", title="the way there and back")
right.legend(loc="upper left")
save(figure, output("python_metals_yield.png"))
