"""The same periodic contact by tamaas: equal sets of nodes and equal pressures.

    pip install tamaas
    python python/gallery/beside_tamaas.py
"""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import tamaas as tm
from _frame import BLUE, ORANGE, output, save

import asperity as asp

NODES, SIDE, E_STAR = 96, 1.0, 1.0
surface = asp.self_affine(
    (NODES, NODES), SIDE, hurst=0.8, rolloff=SIDE / 3, short_cutoff=SIDE / 12, rms_gradient=0.2, seed=3
)
# The kernel of tamaas: waves of the grid alone.
body = asp.HalfSpace(E_STAR, boundary="spectral")
path = asp.load_path(surface, body, area_fraction=0.6, check=False)
history = path.run(check=False)

pressures = np.array([0.002, 0.005, 0.01, 0.02, 0.04])
differences, areas = [], []
tm.set_log_level(tm.LogLevel.error)
for mean_pressure in pressures:
    model = tm.Model(tm.model_type.basic_2d, [SIDE, SIDE], [NODES, NODES])
    model.E, model.nu = E_STAR, 0.0
    # Its rows are the first axis too: for a solver that knows no direction any axis may be the first.
    solver = tm.PolonskyKeerRey(model, np.ascontiguousarray(surface.z), 1e-13)
    solver.max_iter = 100_000
    solver.solve(mean_pressure)
    theirs = np.asarray(model.traction)
    state = history.at(mean_pressure=mean_pressure)
    ours = path.pressure(state)
    assert np.array_equal(theirs > 0, ours > 0), "another set of nodes"
    differences.append(np.abs(theirs - ours).max() / ours.max())
    areas.append((theirs > 0).mean())
print("greatest difference of pressures:", ", ".join(f"{d:.0e}" for d in differences))

figure, (left, right) = plt.subplots(1, 2, figsize=(8.4, 3.6))
left.plot(history.mean_pressure / E_STAR, 100 * history.area_fraction, color=BLUE, label=f"asperity: {len(history)} events")
left.plot(pressures / E_STAR, 100 * np.array(areas), "o", color=ORANGE, label="tamaas: one solution each")
left.set(xlabel="p̄ / E*", ylabel="contact area (%)", title="contact area")
left.legend(loc="lower right")
right.semilogy(pressures / E_STAR, differences, "o", color=ORANGE)
right.set(xlabel="p̄ / E*", ylabel="greatest difference / greatest pressure", title="pressures", ylim=(1e-15, 1e-7))
save(figure, output("python_beside_tamaas.png"))
