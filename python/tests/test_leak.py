"""Leakage."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import asperity as asp
from asperity import errors


def test_a_uniform_gap() -> None:
    """Q = g³ / (12 viscosity) times drop, times width over length."""
    gap, contact = np.full((20, 30), 2e-6), np.zeros((20, 30), dtype=bool)
    for along, shape in (("x", 2e-3 / 3e-3), ("y", 3e-3 / 2e-3)):
        seal = asp.Seal(1e-3, 1e5, along=along)
        assert (seal.viscosity, seal.pressure_drop, seal.along) == (1e-3, 1e5, along)
        for periodic in (False, True):
            leak = seal.leak_of(gap, contact, (3e-3, 2e-3), periodic=periodic)
            assert leak.leak_rate == pytest.approx((2e-6) ** 3 / 12e-3 * 1e5 * shape, rel=1e-9)
            assert leak.permeability == pytest.approx((2e-6) ** 3 / 12e-3, rel=1e-9)
            assert leak.flowing_nodes == 600 and leak.pools == 0
            assert np.isnan(leak.transverse_permeability) != periodic
            assert len(leak.sections) in ((30, 29, 31) if along == "x" else (20, 19, 21))


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


def test_the_leak_of_the_program(program: Callable[..., str], tmp_path: Path) -> None:
    record = tmp_path / "path.npz"
    program("path", "--nodes", 64, "--max-area-fraction", 0.6, "--record", record, "--out", tmp_path / "out")
    words = ["--viscosity", "1e-3", "--pressure-drop", "1e5", "--along", "x", "--states", 8, "--json"]
    told = json.loads(program("leak", record, *words, "--out", tmp_path / "out"))
    path = asp.open(record)
    seal = asp.Seal(1e-3, 1e5, along="x")
    curve = seal.curve(path, states=8)
    points = told["states"][: len(curve.states)]
    assert [state.step for state in curve.states] == [point["step"] for point in points]
    for name in ("load", "mean_pressure", "leak_rate", "mean_field_leak_rate", "permeability"):
        np.testing.assert_array_equal(getattr(curve, name), [point[name] for point in points], err_msg=name)
    assert curve.area_fraction.tolist() == [point["contact_area_fraction"] for point in points]
    # One state: the narrowest place has its row and its column.
    there = points[len(points) // 2]
    leak = seal.leak(path, path.history.at(load=there["load"]))
    assert leak.leak_rate == there["leak_rate"] and leak.constriction is not None
    assert [leak.constriction.column, leak.constriction.row] == there["constriction"]["node"]
    gap = path.gap(path.history.at(load=there["load"]))
    assert gap[leak.constriction.row, leak.constriction.column] == leak.constriction.gap == there["constriction"]["gap"]
    again = seal.leak_of(gap, path.contact_map(path.history.at(load=there["load"])), path.surface.size, periodic=False)
    assert again.leak_rate == leak.leak_rate


def test_what_does_not_leak() -> None:
    with pytest.raises(errors.AsperityError):
        asp.Seal(0.0, 1e5, along="x")
    with pytest.raises(ValueError, match="axis|along"):
        asp.Seal(1e-3, 1e5, along="z")  # type: ignore[arg-type]
    with pytest.raises(errors.AsperityError):
        asp.Seal(1e-3, 1e5, along="x").leak_of(np.ones((4, 4)), np.zeros((4, 5), dtype=bool), 1.0, periodic=False)
