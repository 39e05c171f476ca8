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
    path = asp.load_path(surface, asp.HalfSpace(asp.composite_modulus(*STEEL), boundary="free"), load=500.0)
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
        lost = 18 * (mu * load) ** 2 * kappa / (5 * a * e_star) * loop
        assert joint.cycle(share * mu * load).dissipation == pytest.approx(lost, rel=0.05)


def test_fields_bear_the_load(path: asp.LoadingPath, joint: asp.PartialSlip) -> None:
    load = 70.0
    cell = np.prod(path.surface.cell)
    traction, zones, slip = joint.traction(load), joint.zones(load), joint.slip(load)
    assert traction.shape == zones.shape == slip.shape == path.surface.shape and zones.dtype == np.int8
    assert traction.sum() * cell == pytest.approx(load, rel=1e-12)
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
    assert joint.friction_work(load).sum() * cell == pytest.approx(cycle.dissipation, rel=1e-12)


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
        # On a free half-space they make up the whole joint, the bodies among it: 4 sum k phi (U - phi). Sums of some hundred terms.
        lost = 4.0 * (stiffness * limit * np.maximum(cycle.displacement - limit, 0.0)).sum()
        assert lost == pytest.approx(cycle.dissipation, rel=1e-10)
    assert joint.cycle_of_displacement(columns["displacement"][1]).dissipation == pytest.approx(columns["dissipation"][1], rel=1e-12)
    assert joint.cycle_of_displacement(2.0 * joint.sliding_displacement).dissipation > columns["dissipation"][2]


def test_any_history(path: asp.LoadingPath, joint: asp.PartialSlip) -> None:
    amplitude = 60.0
    load = [0.0, 400.0, 400.0, 400.0, 400.0]
    followed = joint.follow(load, [0.0, 0.0, amplitude, -amplitude, amplitude])
    assert followed["displacement"][2] == pytest.approx(joint.monotone(amplitude).displacement, rel=1e-9)
    lost = followed["dissipation"]
    assert lost[4] - lost[2] == pytest.approx(joint.cycle(amplitude).dissipation, rel=1e-12)
    assert (np.diff(lost) >= 0.0).all() and set(followed) >= {"stick_area", "slip_area", "stored_energy"}
    # Histories without their path know all but fields.
    same = asp.shear(path.history, friction=0.3, bodies=STEEL, load=400.0)
    assert same.monotone(amplitude) == joint.monotone(amplitude)
    for field in (same.traction, same.slip, same.zones, same.friction_work):
        with pytest.raises(ValueError, match="History"):
            field(amplitude)


def csv(file: Path) -> dict[str, np.ndarray]:
    """A table of the program: its numbers have all their digits."""
    table = np.genfromtxt(file, delimiter=",", names=True)
    return {name: table[name] for name in table.dtype.names}


@pytest.mark.parametrize("periodic", [False, True])
def test_the_slip_of_the_program(periodic: bool, program: Callable[..., str], tmp_path: Path) -> None:
    """States, cycles, elements and a history, bit for bit."""
    record, out = tmp_path / "path.npz", tmp_path / "slip"
    surroundings = ["--periodic", "love"] if periodic else []
    pair = ["--material", "steel", "--against", "aluminium"]
    program("path", "--nodes", 64, "--max-area-fraction", 0.1, *pair, *surroundings, "--record", record, "--out", tmp_path)
    path = asp.open(record)
    end = float(path.history.load[-1])
    corners = [(0.5 * end, 0.0), (0.5 * end, 0.08 * end), (0.9 * end, -0.05 * end), (0.6 * end, 0.02 * end), (0.7 * end, 0.1 * end)]
    lines = [f"{load!r},{force!r}" for load, force in corners]
    (tmp_path / "shear.csv").write_text("\n".join(["load,tangential_load", *lines]) + "\n")
    options = ["--friction", "0.25", *pair, "--load", repr(0.9 * end), "--history", tmp_path / "shear.csv"]
    told = json.loads(program("slip", record, *options, "--json", "--out", out))
    assert told["warnings"] and all("beta" in word or "β" in word for word in told["warnings"])
    with pytest.warns(asp.AsperityWarning, match="Dundurs' beta is -0.1"):
        joint = asp.shear(path, friction=0.25, bodies=("steel", "aluminium"), load=0.9 * end)
    state, cycle = joint.monotone(told["tangential_load"]), joint.cycle(told["tangential_load"])
    kept = {"load", "tangential_load", "displacement", "interfacial_displacement", "stick_area", "slip_area", "stick_nodes"}
    for name in kept | {"slipping_nodes", "tangential_stiffness"}:
        assert getattr(state, name) == told[name], name
    for name in ("dissipation", "secant_stiffness", "loss_factor"):
        assert getattr(cycle, name) == told[name], name
    for name in ("sliding_load", "sliding_displacement", "compliance_ratio", "dundurs_beta", "friction"):
        assert getattr(joint, name) == told[name], name
    table = csv(out / "slip.csv")
    loading = joint.loading(table["tangential_load"])
    table = {"loading": table, "cycles": csv(out / "cycles.csv"), "elements": csv(out / "iwan.csv")}
    cycles = joint.cycles(table["cycles"]["amplitude"])
    # The element that slips first is at the top there.
    elements = {name: column[::-1] for name, column in joint.jenkins_elements().items()}
    for kind, columns in {"loading": loading, "cycles": cycles, "elements": elements}.items():
        for name, column in table[kind].items():
            np.testing.assert_array_equal(columns[name], column, err_msg=f"{kind} {name}")
    # The program goes in 24 parts from row to row.
    way, before = [], (0.0, 0.0)
    for corner in corners:
        parts = [part / 24 for part in range(1, 24)]
        way += [tuple(a + share * (b - a) for a, b in zip(before, corner, strict=True)) for share in parts] + [corner]
        before = corner
    followed = joint.follow(*zip(*way, strict=True))
    for name, column in csv(out / "history.csv").items():
        np.testing.assert_array_equal(followed[name][23::24], column, err_msg=name)
    assert followed["dissipation"][-1] == told["history_dissipation"]
    # Parts change nothing but the last digits.
    straight = joint.follow(*zip(*corners, strict=True))
    np.testing.assert_allclose(straight["displacement"], followed["displacement"][23::24], rtol=1e-9)


def test_bodies_of_another_path(path: asp.LoadingPath) -> None:
    with pytest.warns(asp.AsperityWarning, match="only their ratio"):
        asp.shear(path, friction=0.3, bodies=("glass", "glass"))
    asp.shear(path, friction=0.3, bodies=("glass", "glass"), check=False)
    # A history does not know its modulus.
    asp.shear(path.history, friction=0.3, bodies=("glass", "glass"))


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
    for hostile in (np.nan, np.inf, -np.inf):
        for ask in (joint.monotone, joint.cycle, joint.cycle_of_displacement, joint.traction, joint.slip, joint.friction_work, joint.zones):
            with pytest.raises(errors.AsperityError):
                ask(hostile)
        with pytest.raises(errors.AsperityError):
            joint.follow([100.0], [hostile])
        with pytest.raises(errors.AsperityError):
            asp.shear(path, friction=hostile, bodies=STEEL)
    for words in (["a"], [1j], [[1.0]], None, [object()]):
        with pytest.raises((errors.AsperityError, TypeError)):
            joint.follow(words, words)  # type: ignore[arg-type]
        with pytest.raises((errors.AsperityError, TypeError)):
            joint.cycles(words)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="shape"):
        joint.follow([1.0, 2.0], [0.0, 0.0, 0.0])
    hard = asp.load_path(asp.example_surface(nodes=32), asp.HalfSpace(115e9, boundary="free"), area_fraction=0.1, hardness=2e9)
    hard.run(check=False)
    with pytest.raises(errors.AsperityError) as info:
        asp.shear(hard, friction=0.3, bodies=STEEL, check=False)
    assert info.value.kind == "NotElasticGrowth"
    # Against a rigid body, of Poisson's ratio 1/2 and the E* of the path: nothing is coupled, and nothing warns.
    asp.shear(path, friction=0.3, bodies=((path.e_star * 0.75, 0.5), "rigid"))
    asp.shear(path, friction=0.3, bodies=("steel", "rigid"), check=False)
    with pytest.warns(asp.AsperityWarning) as told:
        asp.shear(path, friction=0.3, bodies=("steel", "rigid"))
    assert ["beta is 0.286" in str(told[0].message), "only their ratio" in str(told[1].message)] == [True, True]
