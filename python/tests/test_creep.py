"""Viscoelastic bodies."""

from __future__ import annotations

import json
import math
import os
import pickle
import signal
import threading
import time
from collections.abc import Callable
from dataclasses import replace
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
    # To the rounding of two conversions.
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
    # Contact and gaps are those of the path at the effective load.
    for k, effective in enumerate(states["effective_load"]):
        same = path.history.at(load=effective)
        assert states["contact_nodes"][k] == same.contact_nodes
        for name in ("approach", "contact_area", "area_fraction", "mean_gap"):
            assert states[name][k] == pytest.approx(getattr(same, name), rel=1e-12), name
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
    np.testing.assert_array_equal(held.gap(1.0), path.gap(state))
    # In steps the same: a pressure that is held is linear in each of them, and the rest is rounding of 3000 increments.
    followed = held.follow(held.step_times(20.0))
    found = followed.columns()
    exact = held.at(found["time"])
    assert len(followed) == len(exact["time"]) and found["time"][-1] == 20.0 and followed.halvings == 0
    np.testing.assert_allclose(found["approach"], exact["approach"], rtol=1e-12)
    # The fields of the last state bear its load and have its mean gap; forty pieces leave some 1e-3 of the greatest pressure.
    pressure, gap = followed.pressure(), followed.gap()
    assert pressure.sum() * np.prod(path.surface.cell) == pytest.approx(load, rel=1e-9)
    assert gap.mean() == pytest.approx(found["mean_gap"][-1], rel=2e-3)
    assert ((gap == 0.0).sum()) >= found["contact_nodes"][-1] and (gap >= 0.0).all()
    np.testing.assert_allclose(pressure, held.pressure(20.0), atol=5e-3 * pressure.max())


def test_steps_converge(path: asp.LoadingPath) -> None:
    """The load at an approach that grows: a quarter of the error is left in steps half as long."""
    rubber, approach = asp.Prony.shares(TERMS), 0.6 * path.history.approach[-1]
    ramp = asp.creep(path, rubber, [0.0, 1.0], approach=[0.0, approach])
    worst = []
    for halvings in (0, 1):
        found = ramp.follow(ramp.step_times(20.0, halvings=halvings)).columns()
        exact = ramp.at(found["time"])
        worst.append((abs(found["load"] - exact["load"]) / exact["load"].max()).max())
    # Some 1e-4 as documented; the order is 2 but for increments that join within a step.
    assert 1e-9 < worst[0] < 1e-3 and worst[1] < 0.35 * worst[0], worst


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
    np.testing.assert_array_equal(held.gap(0.1), path.gap(path.history.at(approach=approach)))
    with pytest.raises(ValueError, match="single unloading"):
        held.unloading([1.0])
    # Lifted off, the surfaces are apart.
    lifted = asp.creep(path, rubber, [0.0], approach=[-1e-6])
    np.testing.assert_array_equal(lifted.gap(1.0), -path.surface.z + 1e-6)
    assert lifted.at([1.0])["contact_nodes"][0] == 0
    # The state of the path is that of first touch, through which less leaks than through the gap of the time.
    seal, nowhere = asp.Seal(1e-3, 1e5, along="x"), np.zeros(path.shape, dtype=bool)
    assert lifted.path_state(1.0) == path.history[0]
    apart = seal.leak_of(lifted.gap(1.0), nowhere, path.size, periodic=path.periodic)
    assert apart.leak_rate > seal.leak(path, lifted.path_state(1.0), check=False).leak_rate


def test_unloading(path: asp.LoadingPath) -> None:
    rubber, load = asp.Prony.shares(TERMS), 0.3 * path.history.load[-1]
    ramp = asp.creep(path.history, rubber, [0.0, 1.0, 2.0], load=[0.0, load, 0.0])
    assert ramp.recession is not None and 0.9 < ramp.recession < 1.3
    with pytest.raises(errors.AsperityError) as info:
        ramp.at([1.9])
    assert info.value.kind == "ContactRecedes" and info.value.time == ramp.recession
    assert info.value.effective_load > load
    back = ramp.unloading([1.5, 1.8])
    assert (back["contact_time"] < 1.5).all() and (np.diff(back["contact_area"]) < 0.0).all()
    np.testing.assert_allclose(back["load"], [0.5 * load, 0.2 * load])
    steps = ramp.follow(ramp.step_times(1.5, halvings=2))
    assert steps.columns()["contact_area"][-1] == pytest.approx(back["contact_area"][0], rel=0.02)
    # Fields need the path.
    for ask in (lambda: ramp.pressure(0.5), lambda: ramp.gap(0.5), steps.pressure, steps.gap):
        with pytest.raises(ValueError, match="History"):
            ask()
    fields = asp.creep(path, rubber, [0.0, 1.0, 2.0], load=[0.0, load, 0.0]).follow(ramp.step_times(1.5))
    contact = fields.columns()["contact_nodes"][-1]
    assert (fields.pressure() > 0.0).sum() == contact <= (fields.gap() == 0.0).sum()


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
    assert pickle.loads(pickle.dumps(cycle)) == cycle != replace(cycle, load=2.0 * cycle.load)
    assert cycle.stiffness == pytest.approx(cycle.amplitude / cycle.approach_amplitude)
    with pytest.raises(errors.AsperityError) as info:
        asp.steady_cycle(path, asp.Prony.shares([(1.0, 1.0)]), mean_load=load, amplitude=0.1 * load, period=1.0)
    assert info.value.kind == "NoSteadyCycle"
    slow = asp.Prony.shares([(1.0, 0.3), (1000.0, 0.3)])
    settings = {"mean_load": load, "amplitude": 0.5 * load, "period": 1.0, "steps": 16}
    cycle = asp.steady_cycle(path.history[::8], slow, **settings)
    assert cycle.distance <= 1e-5 and cycle.cycles < 100
    with pytest.raises(errors.ConvergenceError) as few:
        asp.steady_cycle(path.history[::8], slow, most=3, **settings)
    assert few.value.kind == "NotSteady" and few.value.cycles == 3 and few.value.distance > few.value.tolerance


def csv(file: Path) -> dict[str, np.ndarray]:
    """A table of the program: its numbers have all their digits."""
    table = np.genfromtxt(file, delimiter=",", names=True)
    return {name: table[name] for name in table.dtype.names}


@pytest.fixture(scope="module")
def record(program: Callable[..., str], tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("creep")
    surface = ["--nodes", 48, "--material", "rubber", "--periodic", "love", "--max-area-fraction", 0.7]
    program("path", *surface, "--record", folder / "path.npz", "--out", folder / "out")
    return folder / "path.npz"


def same(columns: dict[str, np.ndarray], out: Path, fields: dict[str, np.ndarray]) -> None:
    """Asserts that states are those of creep.csv, and fields those beside it."""
    table = csv(out / "creep.csv")
    table["area_fraction"] = table.pop("contact_area_fraction")
    for name, column in table.items():
        np.testing.assert_array_equal(columns[name], column, err_msg=name)
    for name, field in fields.items():
        np.testing.assert_array_equal(field, np.load(out / f"{name}.npy").T, err_msg=name)


def test_the_creep_of_the_program(program: Callable[..., str], record: Path, tmp_path: Path) -> None:
    """A load that is held: states, passages, cycles and fields, bit for bit."""
    path = asp.open(record)
    load = 0.3 * path.history.load[-1]
    options = ["--prony", "0.1,0.3", "10,0.2", "--load", repr(float(load)), "--time", "50", "--steps", "40"]
    told = json.loads(program("creep", record, *options, "--fields", "npy", "--json", "--out", tmp_path))
    assert told["method"] == "closed form" and told["enough_until"] is None
    rubber = asp.Prony.shares(TERMS)
    held = asp.creep(path, rubber, [0.0, 0.0], load=[0.0, load])
    states = held.at(held.step_times(50.0, steps=40))
    same(states, tmp_path, {"pressure": held.pressure(50.0), "gap": held.gap(50.0)})
    assert {name: states[name][-1] for name in ("load", "effective_load", "approach", "contact_nodes", "mean_gap")} == {
        name: told[name] for name in ("load", "effective_load", "approach", "contact_nodes", "mean_gap")
    }
    # When the contact percolates, and when the last channel closes.
    passages = asp.patches(path, connectivity=4).percolation()
    times = held.touch_times
    for name, state in {
        "percolates_x": passages.contact_x,
        "percolates_y": passages.contact_y,
        "seals_x": passages.seal_x,
        "seals_y": passages.seal_y,
    }.items():
        time = times[state.step - 1] if state is not None and state.step <= len(times) else np.inf
        assert told[name] == (time if time <= 50.0 else None), name
    assert told["seals_x"] is not None
    # Cycles, from the highest frequency on, on the states that they need: no more than 1500, and so all of them.
    high = 20.0 / (math.tau * rubber.relaxation_terms[0][0])
    low = 1.0 / (20.0 * math.tau * rubber.creep_terms[-1][0])
    count = math.ceil(math.log10(high / low) * 5.0)
    periods = [1.0 / (high * (low / high) ** (k / count)) for k in range(count + 1)]
    greatest = rubber.creep_at([np.inf])[0] * (load + 0.2 * load)
    within = int(np.searchsorted(path.history.load, greatest, side="right")) + 1
    assert within <= 1500
    settings = {"mean_load": load, "amplitude": 0.2 * load, "steps": 64, "tolerance": 1e-4, "most": 1000}
    cycles = asp.steady_cycles(path.history[:within], rubber, periods=periods, **settings)  # type: ignore[arg-type]
    table = csv(tmp_path / "creep_cycles.csv")
    np.testing.assert_array_equal([1.0 / cycle.period for cycle in reversed(cycles)], table.pop("frequency"))
    for name, column in table.items():
        np.testing.assert_array_equal([getattr(cycle, name) for cycle in reversed(cycles)], column, err_msg=name)


def test_the_relaxation_of_the_program(program: Callable[..., str], record: Path, tmp_path: Path) -> None:
    path = asp.open(record)
    approach = 0.6 * path.history.approach[-1]
    options = ["--prony", "0.1,0.3", "10,0.2", "--approach", repr(float(approach)), "--ramp", "0.5", "--time", "50"]
    program("creep", record, *options, "--fields", "npy", "--out", tmp_path)
    held = asp.creep(path, asp.Prony.shares(TERMS), [0.0, 0.5], approach=[0.0, approach])
    states = held.at(held.step_times(50.0))
    same(states, tmp_path, {"pressure": held.pressure(50.0), "gap": held.gap(50.0)})


def test_receding_contact_of_the_program(program: Callable[..., str], record: Path, tmp_path: Path) -> None:
    """In steps, and in steps half as long, of which the program keeps every second."""
    path = asp.open(record)
    end = float(path.history.load[-1])
    times, loads = [0.0, 1.0, 3.0, 3.0, 6.0], [0.0, 0.4 * end, 0.05 * end, 0.3 * end, 0.1 * end]
    lines = [f"{time!r},{load!r}" for time, load in zip(times, loads, strict=True)]
    (tmp_path / "load.csv").write_text("\n".join(["time,load", *lines]) + "\n")
    options = ["--prony", "0.1,0.3", "10,0.2", "--history", tmp_path / "load.csv", "--fields", "npy", "--json"]
    told = json.loads(program("creep", record, *options, "--out", tmp_path))
    assert told["method"] == "steps" and 1.0 <= told["recedes"] < 1.2
    course = asp.creep(path, asp.Prony.shares(TERMS), times, load=loads)
    assert course.recession == told["recedes"]
    coarse = course.step_times(6.0)
    fine = np.empty(2 * len(coarse) - 1)
    fine[::2], fine[1::2] = coarse, 0.5 * (coarse[:-1] + coarse[1:])
    steps = course.follow(fine)
    columns = {name: column[::2] for name, column in steps.columns().items()}
    same(columns, tmp_path, {"pressure": steps.pressure(), "gap": steps.gap()})
    rough = course.follow(coarse).columns()
    parts = [abs(columns[name] - rough[name]).max() / abs(columns[name]).max() for name in ("approach", "area_fraction")]
    assert max(parts) / 3.0 == told["step_error"]


def test_ctrl_c_while_stepping(path: asp.LoadingPath) -> None:
    """The wait ends, and nothing is locked."""
    if not hasattr(os, "fork"):
        pytest.skip("signals of POSIX")
    load = 0.3 * path.history.load[-1]
    cycling = asp.creep(path, asp.Prony.shares(TERMS), np.arange(1000.0), load=load * (1.0 + 0.5 * np.sin(np.arange(1000.0))))
    timer = threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        while True:
            cycling.follow(cycling.step_times(999.0, steps=500))
    assert time.monotonic() - start < 5.0
    assert path.pressure().max() > 0.0
    # Nor does it go on where nobody waits for it: soon the process is at rest, and takes no time.
    last = time.monotonic() + 5.0
    while True:
        before = time.process_time()
        time.sleep(0.5)
        if time.process_time() - before < 0.05:
            break
        assert time.monotonic() < last, "it goes on"


def test_times_before_the_first_corner(path: asp.LoadingPath) -> None:
    """Nothing bears before the first corner, which is a jump whether an earlier state was asked for or not."""
    load = 0.3 * path.history.load[-1]
    creep = asp.creep(path, asp.Prony.shares([(0.1, 0.2), (1.0, 0.3)]), [1.0, 1.0], load=[0.0, load])
    early, late = creep.follow([0.0, 1.0, 2.0]).columns(), creep.follow([1.0, 2.0]).columns()
    assert early["load"][0] == 0.0
    np.testing.assert_array_equal(early["approach"][1:], late["approach"])


def test_times_that_are_too_many(path: asp.LoadingPath) -> None:
    creep = asp.creep(path, asp.Prony.shares([(0.1, 0.2)]), [0.0, 0.0], load=[0.0, 0.3 * path.history.load[-1]])
    for steps, halvings in [(60, 2**32 - 1), (0, 25), (10**12, 0)]:
        with pytest.raises(asp.AsperityError, match="at most ten million"):
            creep.step_times(1e3, steps=steps, halvings=halvings)


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
    beyond = asp.creep(path, rubber, [0.0, 1.0, 2.0], load=[0.0, 0.95 * end, 0.0])
    with pytest.raises(errors.AsperityError) as info:
        beyond.follow([0.0, 1.0, 1e4, 0.5])
    assert info.value.kind in ("BedEnds", "OutOfRange")
    with pytest.raises(errors.AsperityError) as info:
        asp.creep(path, rubber, [0.0, 100.0], load=[0.0, end]).follow([0.0, 100.0])
    assert info.value.kind == "BedEnds" and info.value.path_ends == pytest.approx(end)
    for hostile in ([np.nan], [np.inf], [[0.0]], ["a"], [1j], None):
        with pytest.raises((errors.AsperityError, TypeError)):
            held.at(hostile)  # type: ignore[arg-type]
        with pytest.raises((errors.AsperityError, TypeError)):
            held.follow(hostile)  # type: ignore[arg-type]
        with pytest.raises((errors.AsperityError, TypeError)):
            asp.creep(path, rubber, hostile, load=0.5 * end)  # type: ignore[arg-type]
    for pieces in (0, -1):
        with pytest.raises(errors.AsperityError):
            held.pressure(0.0, pieces=pieces)
    for steps, halvings in ((10**8, 0), (2**63, 0), (60, 24), (60, 2**31), (-1, 0)):
        with pytest.raises(errors.AsperityError):
            held.step_times(1.0, steps=steps, halvings=halvings)
    for end_time in (np.nan, np.inf):
        with pytest.raises(errors.AsperityError):
            held.step_times(end_time)
    with pytest.raises(errors.AsperityError):
        asp.steady_cycles(path, rubber, mean_load=1.0, amplitude=2.0, periods=[1.0])
    for steps in (7, 10**12, 2**63):
        with pytest.raises(errors.AsperityError):
            asp.steady_cycle(path, rubber, mean_load=1e-3 * end, amplitude=1e-4 * end, period=1.0, steps=steps)
    assert asp.steady_cycles(path, rubber, mean_load=1e-3 * end, amplitude=1e-4 * end, periods=[]) == []
    hard = asp.load_path(asp.example_surface(nodes=32), asp.HalfSpace(4e6, boundary="free"), area_fraction=0.1, hardness=1e5)
    hard.run(check=False)
    with pytest.raises(errors.AsperityError) as info:
        asp.creep(hard, rubber, [0.0], load=[1e-3])
    assert info.value.kind == "NotElasticGrowth"
    empty = asp.load_path(asp.example_surface(nodes=32), asp.HalfSpace(4e6, boundary="free"), area_fraction=0.1)
    with pytest.raises(errors.AsperityError) as info:
        asp.creep(empty, rubber, [0.0], load=[1e-3])
    assert info.value.kind == "EmptyPath"
