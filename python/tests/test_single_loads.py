"""Single loads and sweeps."""

from __future__ import annotations

import json
import warnings

import numpy as np
import pytest
from conftest import DATA, measured

import asperity as asp
from asperity.errors import ConvergenceError, MemoryLimitError


def test_a_load_is_a_state_of_the_path(rough: asp.Surface, body: asp.HalfSpace) -> None:
    path = asp.load_path(rough, body, area_fraction=0.2)
    state = path.run(check=False).at(load=500.0)
    one = asp.solve(rough, body, load=500.0, tolerance=1e-12, check=False)
    np.testing.assert_array_equal(one.contact_map, path.contact_map(state))
    # The tolerance of the gaps, times what pressures are more sensitive by.
    assert np.abs(one.pressure - path.pressure(state)).max() < 1e-9 * one.max_pressure
    assert one.approach == pytest.approx(state.approach, rel=1e-11)
    assert one.mean_gap == pytest.approx(state.mean_gap, rel=1e-11)
    assert one.contact_stiffness == pytest.approx(state.contact_stiffness, rel=1e-7)
    assert one.interfacial_stiffness == pytest.approx(state.interfacial_stiffness, rel=1e-7)
    assert one.energy == pytest.approx(state.energy, rel=1e-10)
    rate = one.pressure_rate
    assert rate is not None and rate.sum() * rough.area / rough.z.size == pytest.approx(1.0, rel=1e-12)
    assert one.certificate.greatest_contact_gap <= 1e-12 and one.effort.iterations > 0
    bare = asp.solve(rough, body, load=500.0, stiffness=False, check=False)
    assert bare.pressure_rate is None and np.isnan(bare.contact_stiffness)


@pytest.mark.parametrize("target", ["load", "mean_pressure", "approach", "area_fraction", "mean_gap"])
def test_every_target(rough: asp.Surface, body: asp.HalfSpace, target: str) -> None:
    one = asp.solve(rough, body, load=500.0, check=False)
    value = getattr(one, target)
    found = asp.solve(rough, body, **{target: value}, check=False)
    assert getattr(found, target) == pytest.approx(value, rel=1e-7)
    assert found.contact_nodes == one.contact_nodes


def test_the_answers_of_tamaas() -> None:
    """Four mean pressures on 128 x 128 nodes, by tamaas 2.9.0 to a tolerance of 1e-13."""
    known = json.loads((DATA / "periodic_128_fixed_load.json").read_text())
    surface = measured("periodic_128", (1.0, 1.0))
    half_space = asp.HalfSpace(known["e_star"], boundary="spectral")
    assert len(known["cases"]) == 4
    for case in known["cases"]:
        one = asp.solve(surface, half_space, mean_pressure=case["mean_pressure"], tolerance=1e-12, check=False)
        # The tolerance of both, and what a greatest pressure is more sensitive by.
        assert one.contact_nodes == case["contact_nodes"]
        assert one.max_pressure == pytest.approx(case["max_pressure"], rel=1e-8)
        assert one.mean_gap == pytest.approx(case["mean_gap"], rel=1e-8)


def test_sweeps(rough: asp.Surface, body: asp.HalfSpace) -> None:
    loads = [100.0, 120.0, 400.0, 90.0]
    sweep = asp.sweep(rough, body, loads, tolerance=1e-11, check=False)
    assert len(sweep) == 4
    found = list(sweep)
    assert [one.load for one in found] == loads and list(sweep) == []
    for one in found:
        alone = asp.solve(rough, body, load=one.load, tolerance=1e-11, check=False)
        assert one.contact_nodes == alone.contact_nodes
        assert one.approach == pytest.approx(alone.approach, rel=1e-9)
    gaps = [one.mean_gap for one in found]
    again = asp.sweep(rough, body, mean_gap=np.array(gaps), check=False, stiffness=False)
    assert [one.contact_nodes for one in again] == [one.contact_nodes for one in found]
    assert list(asp.sweep(rough, body, [], check=False)) == []
    for arguments in [{}, {"load": [1.0], "approach": [1.0]}, {"load": [-1.0, 1.0]}, {"load": [[1.0]]}, {"load": 1.0}]:
        with pytest.raises(asp.AsperityError):
            list(asp.sweep(rough, body, **arguments, check=False))
    # The first error ends it, and what was found before stays.
    mixed = asp.sweep(rough, body, [100.0, -1.0, 200.0], check=False)
    assert next(mixed).load == 100.0
    with pytest.raises(asp.AsperityError):
        next(mixed)
    assert next(mixed, None) is None


def test_a_sweep_whose_warnings_are_errors_loses_nothing(body: asp.HalfSpace) -> None:
    surface = asp.example_surface(nodes=32)
    sweep = asp.sweep(surface, body, [10.0, 20.0])
    loads = []
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for _ in range(4):
            try:
                loads.append(next(sweep).load)
            except asp.AsperityWarning:
                loads.append(None)
    assert loads[0::2] == [None, None] and np.allclose(loads[1::2], [10.0, 20.0])
    assert next(sweep, None) is None


def test_sweeps_that_nobody_follows_to_their_end(rough: asp.Surface, body: asp.HalfSpace) -> None:
    for _ in range(20):
        sweep = asp.sweep(rough, body, [100.0, 200.0], check=False)
        next(sweep)
        del sweep
    with pytest.warns(asp.AsperityWarning, match="greatest pressure"):
        next(asp.sweep(rough, body, [5000.0]))


def test_what_does_not_converge(rough: asp.Surface, body: asp.HalfSpace) -> None:
    with pytest.raises(RuntimeError) as refused:
        asp.solve(rough, body, load=500.0, max_iterations=1, check=False)
    assert isinstance(refused.value, ConvergenceError) and isinstance(refused.value, ValueError)
    assert refused.value.kind == "NoConvergence" and refused.value.tolerance == 1e-8
    assert refused.value.residual > 1e-8 and refused.value.iterations >= 1
    with pytest.raises(MemoryLimitError) as full:
        asp.solve(rough, body, load=500.0, memory_budget=10_000, check=False)
    assert isinstance(full.value, MemoryError) and full.value.budget == 10_000
    for arguments, kind in [
        ({"load": 0.0}, "NotPositive"),
        ({"load": 1.0, "tolerance": 0.0}, "OutOfRange"),
        ({"approach": -1.0}, "NotPositive"),
        ({"area_fraction": 2.0}, "OutOfRange"),
        ({}, "Arguments"),
        ({"load": 1.0, "approach": 1.0}, "Arguments"),
    ]:
        with pytest.raises(asp.AsperityError) as wrong:
            asp.solve(rough, body, **arguments, check=False)
        assert wrong.value.kind == kind, arguments


def test_yielding(rough: asp.Surface, body: asp.HalfSpace) -> None:
    one = asp.solve(rough, body, load=2000.0, hardness=2.5e9, check=False)
    assert one.pressure.max() <= 2.5e9 * (1 + 1e-12)
    assert one.yielded_map is not None and one.plastic_depth is not None
    assert one.yielded_nodes == one.yielded_map.sum() > 0
    assert one.plastic_work == pytest.approx(2.5e9 * one.plastic_volume, rel=1e-9)
    left = one.residual_surface(rough)
    np.testing.assert_array_equal(left.z, rough.z - one.plastic_depth)
    with pytest.raises(asp.AsperityError) as other:
        one.residual_surface(asp.Surface(rough.z, 2.0 * rough.size[0]))
    assert other.value.kind == "CellMismatch"
    elastic = asp.solve(rough, body, load=2000.0, check=False)
    assert elastic.yielded_map is None and elastic.plastic_depth is None and elastic.yielded_nodes == 0
    with pytest.raises(asp.AsperityError) as over:
        asp.solve(rough, body, load=2.6e9 * rough.area, hardness=2.5e9, check=False)
    assert over.value.kind == "BeyondHardness"
    assert (over.value.mean_pressure, over.value.hardness) == (pytest.approx(2.6e9), pytest.approx(2.5e9))
    assert "a mean pressure of 2.6 GPa" in str(over.value) and "their hardness, 2.5 GPa on average" in str(over.value)


@pytest.mark.parametrize("boundary", ["free", "love"])
def test_plateaus(boundary: str) -> None:
    """Where all nodes in contact have yielded: loads, approaches and mean gaps have the states of the path."""
    surface = asp.Surface(np.load(DATA / "hardness" / "plateaus_16.npy").T, size=(1e-3, 1e-3))
    body = asp.HalfSpace(100e9, boundary=boundary)
    history = asp.load_path(surface, body, hardness=8e6, check=False).run(check=False)
    plateau = (history.yielded_nodes == history.contact_nodes)[:-1] & (np.diff(history.approach) > 1e-9 * history.approach[-1])
    places = np.flatnonzero(plateau & (history.mean_gap[1:] > 0.0))
    assert len(places) > 50
    for place in places[:: len(places) // 8]:
        first = history[int(place)]
        exact = asp.solve(surface, body, load=first.load, hardness=8e6, check=False)
        assert exact.approach == pytest.approx(first.approach, rel=1e-10) and exact.yielded_nodes == first.yielded_nodes
        for name in ("approach", "mean_gap"):
            column = getattr(history, name)
            target = {name: 0.3 * column[place] + 0.7 * column[place + 1]}
            found, expected = asp.solve(surface, body, hardness=8e6, check=False, **target), history.at(**target)
            assert found.load == pytest.approx(expected.load, rel=1e-12)
            assert found.plastic_work == pytest.approx(expected.plastic_work, rel=1e-9)
            assert found.mean_gap == pytest.approx(expected.mean_gap, rel=1e-9)
