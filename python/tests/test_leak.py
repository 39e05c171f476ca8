"""Leakage."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from conftest import DATA

import asperity as asp
from asperity import errors


def test_a_uniform_gap() -> None:
    """Q = g³ / (12 viscosity) times drop, times width over length."""
    gap, contact = np.full((20, 30), 2e-6), np.zeros((20, 30), dtype=bool)
    for along, shape in (("x", 2e-3 / 3e-3), ("y", 3e-3 / 2e-3)):
        seal = asp.Seal(1e-3, 1e5, along=along)
        assert (seal.viscosity, seal.pressure_drop, seal.along) == (1e-3, 1e5, along)
        assert repr(seal) == f"Seal(viscosity=0.001, pressure_drop=100000.0, along='{along}')"
        for periodic in (False, True):
            leak = seal.leak_of(gap, contact, (3e-3, 2e-3), periodic=periodic)
            assert leak.leak_rate == pytest.approx((2e-6) ** 3 / 12e-3 * 1e5 * shape, rel=1e-9)
            assert leak.permeability == pytest.approx((2e-6) ** 3 / 12e-3, rel=1e-9)
            assert leak.flowing_nodes == 600 and leak.pools == 0
            assert np.isnan(leak.transverse_permeability) != periodic
            # From edge to edge: one more than there are nodes along the flow. The fluid is conserved.
            assert len(leak.sections) == (31 if along == "x" else 21)
            np.testing.assert_allclose(leak.sections, leak.leak_rate, rtol=1e-11)


def test_gaps_that_count_as_closed() -> None:
    """Of a groove in a shallower gap ``least_gap`` leaves the groove, and nothing of gaps that are all as narrow."""
    gap, contact = np.full((20, 30), 1e-6), np.zeros((20, 30), dtype=bool)
    gap[3] = 2e-6
    assert asp.Seal(1e-3, 1e5, along="x").least_gap == 0.0
    groove = (2e-6) ** 3 / 12e-3 * 1e5 * 1e-4 / 3e-3
    ground = 19 / 8 * groove
    for least, expected in ((0.0, groove + ground), (0.99e-6, groove + ground), (1e-6, groove), (1.99e-6, groove), (2e-6, 0.0)):
        seal = asp.Seal(1e-3, 1e5, along="x", least_gap=least)
        assert seal.least_gap == least
        assert seal.leak_of(gap, contact, (3e-3, 2e-3), periodic=False).leak_rate == pytest.approx(expected, rel=1e-9)
    with pytest.raises(errors.AsperityError):
        asp.Seal(1e-3, 1e5, along="x", least_gap=-1e-9)


def test_gases() -> None:
    """A gas that leaves at p2 leaks (p1 + p2) / 2 p2 times as much as a liquid, as a volume at p2, and p^2 is linear in a uniform gap."""
    gap, contact = np.full((20, 30), 2e-6), np.zeros((20, 30), dtype=bool)
    assert asp.Seal(1e-3, 1e5, along="x").outlet_pressure is None
    liquid = asp.Seal(1e-3, 1e5, along="x").leak_of(gap, contact, (3e-3, 2e-3), periodic=False)
    seal = asp.Seal(1e-3, 1e5, along="x", outlet_pressure=2.5e4)
    assert seal.outlet_pressure == 2.5e4
    assert repr(seal) == "Seal(viscosity=0.001, pressure_drop=100000.0, along='x', outlet_pressure=25000.0)"
    gas = seal.leak_of(gap, contact, (3e-3, 2e-3), periodic=False)
    assert gas.leak_rate == pytest.approx(liquid.leak_rate * (1.25e5 + 2.5e4) / 5e4, rel=1e-9)
    # Above that of the outlet, in the middle of each cell.
    place = (np.arange(30) + 0.5) / 30
    expected = np.sqrt(1.25e5**2 - (1.25e5**2 - 2.5e4**2) * place) - 2.5e4
    np.testing.assert_allclose(gas.pressure, np.broadcast_to(expected, (20, 30)), rtol=1e-9)
    with pytest.raises(errors.AsperityError):
        asp.Seal(1e-3, 1e5, along="x", outlet_pressure=0.0)


def test_the_channel_is_where_it_is() -> None:
    """A groove along a row lets the fluid through along x, and not along y."""
    gap = np.zeros((12, 16))
    gap[3, :] = 1e-6
    gap[3, 5] = 5e-7
    contact = gap == 0.0
    leak = asp.Seal(1e-3, 1e5, along="x").leak_of(gap, contact, (16e-3, 12e-3), periodic=False)
    assert leak.leak_rate > 0.0 and leak.constriction is not None
    assert (leak.constriction.row, leak.constriction.column, leak.constriction.gap) == (3, 5, 5e-7)
    assert leak.pressure.shape == leak.flux_x.shape == leak.flux_y.shape == (12, 16)
    assert np.isfinite(leak.pressure[3]).all() and np.isnan(np.delete(leak.pressure, 3, axis=0)).all()
    assert (np.diff(leak.pressure[3]) < 0.0).all()
    np.testing.assert_allclose(leak.flux_x[3] * 1e-3, leak.leak_rate, rtol=1e-9)
    assert not leak.flux_y.any()
    assert asp.Seal(1e-3, 1e5, along="y").leak_of(gap, contact, 16e-3, periodic=False).leak_rate == 0.0
    turned = asp.Seal(1e-3, 1e5, along="y").leak_of(gap.T, contact.T, (12e-3, 16e-3), periodic=False)
    assert turned.leak_rate == pytest.approx(leak.leak_rate, rel=1e-12)
    np.testing.assert_allclose(turned.flux_y.T, leak.flux_x, rtol=1e-9, atol=1e-30)


@pytest.mark.parametrize("along", ["x", "y"])
def test_the_leak_of_the_program(along: Literal["x", "y"], program: Callable[..., str], tmp_path: Path) -> None:
    """The curve and single states, bit for bit, on a periodic surface that is no square."""
    record = tmp_path / "path.npz"
    surface = ["--surface", DATA / "periodic_32x24.npy", "--side", repr(32 * 2e-5), "--side-y", repr(24 * 3e-5)]
    ends = ["--e-star", "1", "--periodic", "love", "--max-area-fraction", "1", "--record", record, "--out", tmp_path / "out"]
    program("path", *surface, *ends)
    path = asp.open(record)
    loads = [0.2 * path.history.load[200], 0.5 * path.history.load[200]]
    words = ["--viscosity", "1e-3", "--pressure-drop", "1e5", "--along", along, "--states", 12, "--json"]
    more = [word for load in loads for word in ("--load", repr(float(load)))]
    told = json.loads(program("leak", record, *words, *more, "--out", tmp_path))["states"]
    seal = asp.Seal(1e-3, 1e5, along=along)
    curve = seal.curve(path, states=12, check=False)
    points = told[: len(curve.states)]
    assert [state.step for state in curve.states] == [point["step"] for point in points] and curve.closing is not None
    for name in ("load", "mean_pressure", "mean_gap", "leak_rate", "mean_field_leak_rate", "permeability", "imbalance"):
        np.testing.assert_array_equal(getattr(curve, name), [point[name] for point in points], err_msg=name)
    across = [np.nan if point["transverse_permeability"] is None else point["transverse_permeability"] for point in points]
    np.testing.assert_array_equal(curve.transverse_permeability, across)
    assert curve.area_fraction.tolist() == [point["contact_area_fraction"] for point in points]
    # The narrowest place has its row and its column.
    for found, point in zip(curve.constrictions, points, strict=True):
        place = point["constriction"]
        assert (found is None) == (place is None)
        if found is not None:
            assert [found.column, found.row] == place["node"]
            assert (found.gap, found.pressure_drop, found.dissipation) == (place["gap"], place["pressure_drop"], place["dissipation"])
    for load, there in zip(loads, told[len(points) :], strict=True):
        state = path.history.at(load=load)
        leak = seal.leak(path, state, check=False)
        for name in ("leak_rate", "mean_field_leak_rate", "permeability", "transverse_permeability", "imbalance", "flowing_nodes", "pools"):
            assert getattr(leak, name) == there[name], name
        assert leak.constriction is not None and there["load"] == state.load
        gap = path.gap(state)
        assert gap[leak.constriction.row, leak.constriction.column] == leak.constriction.gap == there["constriction"]["gap"]
        again = seal.leak_of(gap, path.contact_map(state), path.surface.size, periodic=True)
        assert again.leak_rate == leak.leak_rate
        np.testing.assert_array_equal(again.pressure, leak.pressure)
    assert pickle.loads(pickle.dumps(curve)) == curve != replace(curve, leak_rate=2.0 * curve.leak_rate)


def test_what_does_not_leak() -> None:
    with pytest.raises(errors.AsperityError):
        asp.Seal(0.0, 1e5, along="x")
    with pytest.raises(ValueError, match="axis|along"):
        asp.Seal(1e-3, 1e5, along="z")  # type: ignore[arg-type]
    with pytest.raises(errors.AsperityError):
        asp.Seal(1e-3, 1e5, along="x").leak_of(np.ones((4, 4)), np.zeros((4, 5), dtype=bool), 1.0, periodic=False)
    seal, contact = asp.Seal(1e-3, 1e5, along="x"), np.zeros((4, 4), dtype=bool)
    for gap in (np.full((4, 4), np.nan), np.full((4, 4), np.inf), np.full((4, 4), -1.0), np.ones(4), np.ones((4, 4)) * 1j, "gap", None):
        with pytest.raises((errors.AsperityError, TypeError)):
            seal.leak_of(gap, contact, 1.0, periodic=False)  # type: ignore[arg-type]
    for size in (0.0, -1.0, np.nan, (1.0, np.inf)):
        with pytest.raises(errors.AsperityError):
            seal.leak_of(np.ones((4, 4)), contact, size, periodic=False)
    with pytest.raises(errors.AsperityError):
        seal.leak_of(np.ones((4, 4)), np.zeros((4, 4)), 1.0, periodic=False)
    for viscosity, drop in ((np.nan, 1.0), (1.0, np.inf), (-1.0, 1.0), (1.0, 0.0)):
        with pytest.raises(errors.AsperityError):
            asp.Seal(viscosity, drop, along="x")
    path = asp.load_path(asp.example_surface(nodes=16, short_cutoff=2.5e-3), asp.HalfSpace(1e9, boundary="love"), nodes=20, check=False)
    with pytest.raises(errors.AsperityError):
        seal.leak(path)
    path.run(check=False)
    for states in (0, 1):
        with pytest.raises(errors.AsperityError):
            seal.curve(path, states=states)
    assert seal.curve(path, states=2, check=False).closing is None


def test_a_large_pressure_drop_is_warned_of() -> None:
    path = asp.load_path(asp.example_surface(nodes=32), asp.HalfSpace(1e9, boundary="love"), area_fraction=0.2)
    path.run(check=False)
    small = 1e-3 * path.state.mean_pressure
    asp.Seal(1e-3, small, along="x").leak(path)
    for seal in (asp.Seal(1e-3, 100.0 * small, along="x"), asp.Seal(1e-3, 1e5 * small, along="x")):
        with pytest.warns(asp.AsperityWarning, match="would open the gap"):
            seal.leak(path)
        with pytest.warns(asp.AsperityWarning, match="would open the gap"):
            seal.curve(path, states=4)
        seal.leak(path, check=False)
        seal.curve(path, states=4, check=False)
