"""Partial slip."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import asperity as asp
from asperity import errors

STEEL = ("steel", "steel")


@pytest.fixture(scope="module")
def path() -> asp.LoadingPath:
    surface = asp.Surface(asp.example_surface(nodes=48).z, size=(6e-3, 8e-3))
    path = asp.load_path(surface, asp.HalfSpace(115e9, boundary="free"), load=500.0)
    path.run(check=False)
    return path


@pytest.fixture(scope="module")
def joint(path: asp.LoadingPath) -> asp.PartialSlip:
    return asp.shear(path, friction=0.3, bodies=STEEL, load=400.0)


def test_a_sphere() -> None:
    """Cattaneo and Mindlin: U = 3 mu P kappa / (4 a E*) (1 - (1 - T / mu P)^(2/3)), and the loop."""
    radius, e_star, size, load, mu = 0.05, 1e9, 2e-3, 5.0, 0.4
    surface = asp.paraboloid(radius, (96, 96), size)
    path = asp.load_path(surface, asp.HalfSpace(e_star, boundary="free"), load=load, check=False)
    path.run(check=False)
    kappa = 1.3
    joint = asp.shear(path, friction=mu, compliance_ratio=kappa)
    assert joint.load == pytest.approx(load) and joint.compliance_ratio == kappa and np.isnan(joint.dundurs_beta)
    a = (0.75 * load * radius / e_star) ** (1 / 3)
    for share in (0.2, 0.6, 0.9):
        state = joint.monotone(share * mu * load)
        displacement = 0.75 * mu * load * kappa / (a * e_star) * (1.0 - (1.0 - share) ** (2 / 3))
        assert state.displacement == pytest.approx(displacement, rel=0.01)
        stick = a * (1.0 - share) ** (1 / 3)
        assert state.stick_area == pytest.approx(np.pi * stick**2, rel=0.06)
        t = share
        loop = 1.0 - (1.0 - t) ** (5 / 3) - 5 * t / 6 * (1.0 + (1.0 - t) ** (2 / 3))
        lost = 9 * (mu * load) ** 2 * kappa / (5 * a * e_star) * loop
        assert joint.cycle(share * mu * load).dissipation == pytest.approx(lost, rel=0.05)


def test_fields_bear_the_load(path: asp.LoadingPath, joint: asp.PartialSlip) -> None:
    load = 70.0
    cell = path.surface.cell_area if hasattr(path.surface, "cell_area") else np.prod(path.surface.cell)
    traction, zones, slip = joint.traction(load), joint.zones(load), joint.slip(load)
    assert traction.shape == zones.shape == slip.shape == path.surface.shape and zones.dtype == np.int8
    assert traction.sum() * cell == pytest.approx(load, rel=1e-6)
    preload = path.history.at(load=400.0)
    pressure = path.pressure(preload)
    assert (traction <= 0.3 * pressure * (1 + 1e-9) + 1e-6 * pressure.max()).all()
    np.testing.assert_array_equal(zones > 0, pressure > 0.0)
    np.testing.assert_allclose(traction[zones == 2], 0.3 * pressure[zones == 2], rtol=1e-6)
    state = joint.monotone(load)
    assert (zones == 1).sum() == state.stick_nodes and (zones == 2).sum() == state.slipping_nodes
    assert not slip[zones != 2].any() and (slip[zones == 2] >= 0.0).all()
    # The stick nodes are those in contact at the load of the path at which they stick.
    np.testing.assert_array_equal(zones == 1, path.contact_map(path.history.at(load=state.stick_load)))
    # What is lost at all nodes is lost by the joint.
    cycle = joint.cycle(load)
    assert joint.friction_work(load).sum() * cell == pytest.approx(cycle.dissipation, rel=0.02)


def test_elements_and_cycles(joint: asp.PartialSlip) -> None:
    elements = joint.jenkins_elements()
    stiffness, limit = elements["stiffness"], elements["slip_displacement"]
    assert (stiffness * limit).sum() == pytest.approx(joint.sliding_load, rel=1e-9)
    amplitudes = np.array([20.0, 60.0, 100.0])
    columns = joint.cycles(amplitudes)
    for i, amplitude in enumerate(amplitudes):
        cycle = joint.cycle(amplitude)
        for name, column in columns.items():
            assert column[i] == getattr(cycle, name), name
        slips = np.maximum(cycle.interfacial_displacement - limit, 0.0)
        # Springs in series with the bodies, or not: the elements are those of the whole joint.
        whole = np.maximum(cycle.displacement - limit, 0.0)
        lost = [4.0 * (stiffness * limit * s).sum() for s in (slips, whole)]
        assert min(abs(value / cycle.dissipation - 1.0) for value in lost) < 1e-6
    assert joint.cycle_of_displacement(columns["displacement"][1]).dissipation == pytest.approx(columns["dissipation"][1], rel=1e-6)
    assert joint.cycle_of_displacement(2.0 * joint.sliding_displacement).dissipation > columns["dissipation"][2]


def test_any_history(path: asp.LoadingPath, joint: asp.PartialSlip) -> None:
    amplitude = 60.0
    load = [0.0, 400.0, 400.0, 400.0, 400.0]
    followed = joint.follow(load, [0.0, 0.0, amplitude, -amplitude, amplitude])
    assert followed["displacement"][2] == pytest.approx(joint.monotone(amplitude).displacement, rel=1e-9)
    lost = followed["dissipation"]
    assert lost[4] - lost[2] == pytest.approx(joint.cycle(amplitude).dissipation, rel=1e-6)
    assert (np.diff(lost) >= 0.0).all() and set(followed) >= {"stick_area", "slip_area", "stored_energy"}
    # Histories without their path know all but fields.
    same = asp.shear(path.history, friction=0.3, bodies=STEEL, load=400.0)
    assert same.monotone(amplitude) == joint.monotone(amplitude)
    with pytest.raises(ValueError, match="History"):
        same.traction(amplitude)


def test_the_slip_of_the_program(program: Callable[..., str], tmp_path: Path) -> None:
    record = tmp_path / "path.npz"
    program("path", "--nodes", 64, "--max-area-fraction", 0.1, "--record", record, "--out", tmp_path / "out")
    bodies = ["--material", "steel", "--against", "aluminium"]
    told = json.loads(program("slip", record, "--friction", "0.25", *bodies, "--json", "--out", tmp_path / "slip"))
    path = asp.open(record)
    with pytest.warns(asp.AsperityWarning, match="beta") if told["warnings"] else pytest.warns(None):  # type: ignore[call-overload]
        joint = asp.shear(path, friction=0.25, bodies=("steel", "aluminium"))
    state, cycle = joint.monotone(told["tangential_load"]), joint.cycle(told["tangential_load"])
    for name in ("load", "displacement", "stick_area", "slip_area", "stick_nodes", "slipping_nodes", "tangential_stiffness"):
        assert getattr(state, name) == told[name], name
    for name in ("dissipation", "secant_stiffness", "loss_factor"):
        assert getattr(cycle, name) == told[name], name
    for name in ("sliding_load", "sliding_displacement", "compliance_ratio", "dundurs_beta"):
        assert getattr(joint, name) == told[name], name
    table = np.genfromtxt(tmp_path / "slip" / "iwan.csv", delimiter=",", names=True)
    elements = joint.jenkins_elements()
    for name in table.dtype.names:
        np.testing.assert_array_equal(elements[name], table[name])


def test_what_a_joint_cannot_do(path: asp.LoadingPath, joint: asp.PartialSlip) -> None:
    with pytest.raises(errors.AsperityError) as info:
        joint.monotone(121.0)
    assert info.value.kind == "JointSlides" and info.value.limit == pytest.approx(120.0)
    assert info.value.tangential_load == 121.0 and isinstance(info.value, ValueError)
    for arguments in ({}, {"bodies": STEEL, "compliance_ratio": 1.0}):
        with pytest.raises(ValueError, match="one of bodies"):
            asp.shear(path, friction=0.3, **arguments)
    with pytest.raises(errors.AsperityError) as info:
        asp.shear(path, friction=0.3, bodies=STEEL, load=1e9)
    assert info.value.kind == "PathEndsBefore"
    with pytest.raises(ValueError, match="LoadingPath"):
        asp.shear(3, friction=0.3, bodies=STEEL)  # type: ignore[arg-type]
    hard = asp.load_path(asp.example_surface(nodes=32), asp.HalfSpace(115e9, boundary="free"), area_fraction=0.1, hardness=2e9)
    hard.run(check=False)
    with pytest.raises(errors.AsperityError) as info:
        asp.shear(hard, friction=0.3, bodies=STEEL)
    assert info.value.kind == "NotElasticGrowth"
    # Against a rigid body, of Poisson's ratio 1/2: nothing is coupled, and nothing warns.
    asp.shear(path, friction=0.3, bodies=((1e9, 0.5), "rigid"))
    asp.shear(path, friction=0.3, bodies=("steel", "rigid"), check=False)
    with pytest.warns(asp.AsperityWarning, match="beta"):
        asp.shear(path, friction=0.3, bodies=("steel", "rigid"))
