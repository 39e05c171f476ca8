#!/usr/bin/env python3
"""tamaas' Maugis functional on states of paths with adhesion: do they stay where they are?

    adhesion.py

Needs the packages asperity (`pip install ./python`) and tamaas. Three periodic rough surfaces are pressed on and pulled
off. tamaas' law ends at once where asperity's has a slope, so that both have the same equilibria only where no node is
on the slope: such states are taken, of both branches, and tamaas minimises from each, at its mean gap, with the range of
the law between the gaps of the last node that is pulled and of the first that is not.
"""
import warnings

import asperity as asp
import numpy as np
import tamaas

warnings.simplefilter("ignore")
tamaas.set_log_level(tamaas.LogLevel.error)
HEIGHT = 0.02


def minimised(heights, law_range, stress, start):
    """Pressure and gap where the functional of tamaas ends from a field of gaps, at their mean."""
    model = tamaas.Model(tamaas.model_type.basic_2d, [1.0, 1.0], list(heights.shape))
    model.E, model.nu = 1.0, 0.0
    gap = tamaas.PolonskyKeerRey.gap
    solver = tamaas.PolonskyKeerRey(model, heights.copy(), 1e-12, gap, gap)
    solver.max_iter = 20_000
    field = solver.model["gap"]
    field[:] = start.reshape(np.array(field).shape)
    functional = tamaas.MaugisAdhesionFunctional(heights.copy())
    functional.parameters = {"rho": law_range, "surface_energy": stress * law_range}
    solver.addFunctionalTerm(functional)
    solver.solve(float(start.mean()))
    pressure, displacement = (np.array(x).reshape(heights.shape) for x in (model.traction, model.displacement))
    found = displacement - heights
    return pressure, found - found.min()


states = other_nodes = 0
worst = 0.0
print("nodes  branch     in contact  pulled  pressure / greatest  nodes pulled by one alone")
for nodes, seed in ((32, 1), (48, 2), (64, 3), (40, 4)):
    surface = asp.self_affine(
        (nodes, nodes), (1.0, 1.0), hurst=0.8, rolloff=0.5, short_cutoff=8 / nodes, rms_height=HEIGHT, seed=seed
    )
    stress = HEIGHT * HEIGHT * 2 * np.pi * 3
    adhesion = asp.Adhesion(stress * HEIGHT, cohesive_stress=stress)
    path = asp.load_path(surface, asp.HalfSpace(1.0, boundary="spectral"), adhesion=adhesion, area_fraction=0.3)
    for branch, run in (("loading", path.run), ("unloading", path.unload)):
        sharp = [s for s in run() if s.soft_nodes == 0 and s.contact_nodes > 0 and not s.event.startswith("jump")]
        for state in sharp[:: max(1, len(sharp) // 2)][:2]:
            pressure, gap, pulled = path.pressure(state), path.gap(state), path.pulled_map(state)
            last = gap[pulled].max(initial=0.0)
            law_range = 0.5 * (last + gap[~pulled & (gap > 1e-12)].min())
            theirs, their_gap = minimised(np.array(surface.z), law_range, stress, gap)
            difference = abs(theirs - pressure).max() / abs(pressure).max()
            others = int(((their_gap < law_range) != (gap < law_range)).sum())
            states, other_nodes, worst = states + 1, other_nodes + others, max(worst, difference)
            counts = f"{state.contact_nodes:10}  {int(pulled.sum()):6}"
            print(f"{nodes:5}  {branch:9}  {counts}  {difference:19.1e}  {others}", flush=True)
print(f"{states} states: pressures within {worst:.1e} of the greatest, {other_nodes} nodes pulled by one alone")
