#!/usr/bin/env python3
"""tamaas' viscoelastic solver (MaxwellViscoelastic) in full contact of a wave, whose pressure has a closed form.

    creep.py

A wave is pressed flat at once and held. Its displacement is the wave from then on, and the amplitude of the pressure relaxes as
R(t) = 0.2 + 0.8 exp(-t). Prints both amplitudes over those of the elastic body, for three steps of time.
"""
import numpy as np
import tamaas

NODES, HEIGHT, NU = 16, 1e-3, 0.5
tamaas.set_log_level(tamaas.LogLevel.error)


def shear_modulus(e_star):
    return e_star * (1 - NU) / 2


wave = HEIGHT * np.cos(2 * np.pi * np.arange(NODES) / NODES)[:, None] * np.ones((1, NODES))
print("step   time   pressure found / exact   displacement found / exact")
for step in (0.1, 0.05, 0.025):
    model = tamaas.Model(tamaas.model_type.basic_2d, [1.0, 1.0], [NODES, NODES])
    model.nu, model.E = NU, 2 * shear_modulus(0.2) * (1 + NU)
    solver = tamaas.MaxwellViscoelastic(model, wave.copy(), 1e-13, step, [shear_modulus(0.8)], [1.0])
    solver.max_iter = 100_000
    for k in range(1, round(1 / step) + 1):
        solver.solve(1.0)
        if k in (1, 2, round(1 / step)):
            pressure, displacement = (np.ptp(np.array(x)) / 2 for x in (model.traction, model.displacement))
            exact = np.pi * HEIGHT * (0.2 + 0.8 * np.exp(-k * step))
            print(f"{step:5}  {k * step:5.3f}  {pressure / exact:22.4f}  {displacement / HEIGHT:26.4f}")
