"""Viscoelastic bodies."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import asperity as asp
from asperity import errors

TERMS = [(0.1, 0.3), (10.0, 0.2)]


@pytest.fixture(scope="module")
def path() -> asp.LoadingPath:
    surface = asp.Surface(asp.example_surface(nodes=48).z, size=(6e-3, 8e-3))
    path = asp.load_path(surface, asp.HalfSpace(4e6, boundary="free"), area_fraction=0.6, check=False)
    path.run(check=False)
    return path


def test_series() -> None:
    rubber = asp.Prony.shares(TERMS)
    assert (rubber.instantaneous_modulus, rubber.equilibrium_modulus, rubber.fluidity) == pytest.approx((1.0, 0.5, 0.0))
    times = np.array([0.0, 0.05, 1.0, 30.0])
    relaxed = 0.5 + 0.3 * np.exp(-times / 0.1) + 0.2 * np.exp(-times / 10.0)
    np.testing.assert_allclose(rubber.relaxation_at(times), relaxed, rtol=1e-12)
    # The other form of the same body.
    again = asp.Prony.creep(1.0, rubber.creep_terms)
    np.testing.assert_allclose(again.relaxation_at(times), relaxed, rtol=1e-9)
    assert rubber.relaxation_terms == TERMS
    solid = asp.Prony.creep(1.0, [(2.0, 1.0)])
    np.testing.assert_allclose(solid.creep_at(times), 2.0 - np.exp(-times / 2.0), rtol=1e-12)
    maxwell = asp.Prony.creep(1.0, [], fluidity=0.5)
    assert maxwell.fluidity == pytest.approx(0.5) and maxwell.equilibrium_modulus == 0.0
    flowing = asp.Prony.shares([(2.0, 1.0)])
    np.testing.assert_allclose(flowing.creep_at(times), maxwell.creep_at(times), rtol=1e-12)
    # Bodies of two materials over an E*.
    young = asp.Prony.relaxation(1.5e6, [(1.0, 1.5e6)])
    steel = asp.Prony.elastic(230e9)
    both = young.plane_strain(0.5).in_series(steel).relative_to(4e6)
    assert both.instantaneous_modulus == pytest.approx(1.0 / (1.0 + 4e6 / 230e9))
    for one in (rubber, maxwell, both):
        copy = pickle.loads(pickle.dumps(one))
        assert copy == one and copy.creep_terms == one.creep_terms and copy is not one
    assert rubber != maxwell and "2 terms" in repr(rubber)
    for bad in ([(0.0, 0.5)], [(1.0, 1.5)], [(1.0, -0.1)], [(np.nan, 0.5)]):
        with pytest.raises(errors.AsperityError):
            asp.Prony.shares(bad)


def test_creep_under_a_load(path: asp.LoadingPath) -> None:
    rubber, load = asp.Prony.shares(TERMS), 0.4 * path.history.load[-1]
    held = asp.creep(path, rubber, [0.0, 0.0], load=[0.0, load])
    assert held.recession is None
    times = np.array([0.0, 0.01, 1.0, 1e3])
    states = held.at(times)
    np.testing.assert_allclose(states["effective_load"], load * rubber.creep_at(times), rtol=1e-12)
    np.testing.assert_allclose(states["load"], load)
    same = path.history.at(load=states["effective_load"])
    for name in ("approach", "contact_nodes", "contact_area", "area_fraction", "mean_gap"):
        np.testing.assert_allclose(states[name], getattr(same, name), rtol=1e-12, err_msg=name)
    state = held.path_state(1.0)
    assert state.load == states["effective_load"][2]
    # The pressure bears the load, and no more than the contact of the time.
    pressure = held.pressure(1.0)
    assert pressure.shape == path.surface.shape == (48, 48)
    assert pressure.sum() * np.prod(path.surface.cell) == pytest.approx(load, rel=2e-3)
    assert not pressure[~path.contact_map(state)].any()
    touched = held.touch_times
    assert (np.diff(touched) >= 0.0).all() and touched[0] == 0.0
    np.testing.assert_allclose(rubber.creep_at(touched[-1:]) * load, path.history.load[len(touched) - 1], rtol=1e-6)
    followed = held.follow(20.0, halvings=1)
    exact = held.at(followed["time"])
    np.testing.assert_allclose(followed["approach"], exact["approach"], rtol=2e-3)


def test_relaxation_at_an_approach(path: asp.LoadingPath) -> None:
    rubber = asp.Prony.shares(TERMS)
    approach = 0.7 * path.history.approach[-1]
    held = asp.creep(path, rubber, [0.0, 0.0], approach=[0.0, approach])
    states = held.at([0.0, 0.1, 1e4])
    elastic = path.history.at(approach=approach).load
    np.testing.assert_allclose(states["load"], elastic * rubber.relaxation_at([0.0, 0.1, 1e4]), rtol=1e-9)
    np.testing.assert_allclose(states["approach"], approach)
    pressure = held.pressure(0.1)
    full = path.pressure(path.history.at(approach=approach))
    np.testing.assert_allclose(pressure, full * rubber.relaxation_at([0.1])[0], atol=1e-6 * full.max())
    with pytest.raises(ValueError, match="single unloading"):
        held.unloading([1.0])


def test_unloading(path: asp.LoadingPath) -> None:
    rubber, load = asp.Prony.shares(TERMS), 0.3 * path.history.load[-1]
    ramp = asp.creep(path.history, rubber, [0.0, 1.0, 2.0], load=[0.0, load, 0.0])
    assert ramp.recession is not None and 0.9 < ramp.recession < 1.3
    with pytest.raises(errors.AsperityError) as info:
        ramp.at([1.9])
    assert info.value.kind == "ContactRecedes" and info.value.time == 1.9
    back = ramp.unloading([1.5, 1.8])
    assert (back["contact_time"] < 1.5).all() and (np.diff(back["contact_area"]) < 0.0).all()
    np.testing.assert_allclose(back["load"], [0.5 * load, 0.2 * load])
    steps = ramp.follow(1.5, halvings=2)
    assert steps["contact_area"][-1] == pytest.approx(back["contact_area"][0], rel=0.02)
    with pytest.raises(ValueError, match="History"):
        ramp.pressure(0.5)


def test_cycles(path: asp.LoadingPath) -> None:
    """In the limit of small amplitudes the bed is that of the body: its loss angle."""
    rubber = asp.Prony.shares([(1.0, 0.4)])
    load = 0.3 * path.history.load[-1]
    cycle = asp.steady_cycle(path, rubber, mean_load=load, amplitude=0.02 * load, period=2 * np.pi)
    assert cycle.mean_load == load and cycle.period == 2 * np.pi
    # E = 0.6 + 0.4 i w / (1 + i w) at w = 1.
    modulus = 0.6 + 0.4 * 1j / (1 + 1j)
    assert cycle.loss_factor == pytest.approx(np.sin(np.angle(modulus)), rel=0.05)
    assert cycle.approach.shape == cycle.load.shape and cycle.cycles >= 2
    assert cycle.stiffness == pytest.approx(cycle.amplitude / cycle.approach_amplitude)
    with pytest.raises(errors.AsperityError) as info:
        asp.steady_cycle(path, asp.Prony.shares([(1.0, 1.0)]), mean_load=load, amplitude=0.1 * load, period=1.0)
    assert info.value.kind == "NoSteadyCycle"


def test_the_creep_of_the_program(program: Callable[..., str], tmp_path: Path) -> None:
    record = tmp_path / "path.npz"
    program("path", "--nodes", 48, "--max-area-fraction", 0.5, "--record", record, "--out", tmp_path / "out")
    path = asp.open(record)
    load = 0.2 * path.history.load[-1]
    words = ["--prony", "0.1,0.3", "10,0.2", "--load", repr(float(load)), "--json", "--out", tmp_path / "creep"]
    told = json.loads(program("creep", record, *words))
    held = asp.creep(path, asp.Prony.shares(TERMS), [0.0, 0.0], load=[0.0, load])
    last = held.at([told["time"]])
    for name in ("load", "effective_load", "approach", "contact_nodes", "mean_gap"):
        assert last[name][0] == told[name], name
    table = np.genfromtxt(tmp_path / "creep" / "creep.csv", delimiter=",", names=True)
    table = table[table["load"] > 0.0]
    states = held.at(table["time"])
    for name in ("effective_load", "load", "approach", "mean_gap"):
        np.testing.assert_array_equal(states[name], table[name], err_msg=name)


def test_what_cannot_creep(path: asp.LoadingPath) -> None:
    rubber, end = asp.Prony.shares(TERMS), path.history.load[-1]
    held = asp.creep(path, rubber, [0.0, 0.0], load=[0.0, 0.8 * end])
    with pytest.raises(errors.AsperityError) as info:
        held.at([1e3])
    assert info.value.kind == "PathEnds" and info.value.path_ends == pytest.approx(end)
    for arguments in ({}, {"load": [0.0, 1.0], "approach": [0.0, 1e-6]}):
        with pytest.raises(ValueError, match="one of load"):
            asp.creep(path, rubber, [0.0, 1.0], **arguments)
    with pytest.raises(ValueError):
        asp.creep(path, rubber, [0.0, 1.0], load=[0.0])
    with pytest.raises(errors.AsperityError):
        asp.creep(path, rubber, [1.0, 0.0], load=[0.0, 1.0])
