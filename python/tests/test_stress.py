"""Stress below the surface."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import asperity as asp
from asperity import errors

MEASURES = ("von_mises", "tresca", "greatest_shear", "greatest_tension")


def test_the_stress_of_the_program(program: Callable[..., str], tmp_path: Path) -> None:
    """All that it prints, bit for bit, for both bodies."""
    record = tmp_path / "path.npz"
    program("path", "--nodes", 32, "--material", "steel", "--against", "glass", "--record", record, "--out", tmp_path / "out")
    path = asp.open(record)
    load = 0.4 * path.history.load[-1]
    words = ["--load", repr(float(load)), "--friction", 0.2, "--angle", 30, "--yield-stress", 1e9, "--json"]
    told = json.loads(program("stress", record, *words))
    state = path.history.at(load=load)
    for body, ratio, friction in ((told["bodies"][0], None, 0.2), (told["bodies"][1], 0.22, -0.2)):
        below = asp.stress(path, ratio, state=state, friction=friction, angle=30.0)
        assert below.poissons_ratio == body["poissons_ratio"]
        survey = below.survey()
        assert survey.depth.tolist() == body["depths"]
        for name in MEASURES:
            found, expected = survey.greatest[name], body[name]
            assert (found.value, found.depth) == (expected["value"], expected["depth"])
            assert [found.column, found.row] == expected["node"]
            assert getattr(survey, name).max() == found.value
            field = below.at_depth(found.depth)
            assert getattr(field, name)[found.row, found.column] == pytest.approx(found.value, rel=1e-12)
    first = asp.first_yield(path, 1e9, friction=0.2, angle=30.0)
    assert first is not None and first.state.load == told["bodies"][0]["materials"][0]["first_yield"]["load"]
    assert first.greatest.value == pytest.approx(1e9, rel=1e-4)
    assert asp.first_yield(path, 1e15) is None
    assert pickle.loads(pickle.dumps(survey)) == survey


def test_each_material_yields_by_itself(program: Callable[..., str], tmp_path: Path) -> None:
    record = tmp_path / "coat.npz"
    program("path", "--nodes", 16, "--layer", "400e9,0.25,2e-4", "--base", "steel", "--record", record, "--out", tmp_path / "out")
    told = json.loads(program("stress", record, "--yield-stress", "2e9,5e8", "--json"))
    path = asp.open(record)
    depths = []
    for first, material in zip(asp.first_yields(path, [2e9, 5e8]), told["bodies"][0]["materials"], strict=True):
        assert first is not None and first.state.load == material["first_yield"]["load"]
        assert first.greatest.value == pytest.approx(material["yield_stress"], rel=1e-4)
        depths.append(first.greatest.depth)
    assert depths[0] <= 2e-4 < depths[1]
    assert asp.first_yields(path, [1e15, 5e8])[0] is None
    with pytest.raises(errors.AsperityError, match="2 materials") as told:
        asp.first_yields(path, [1e9])
    assert (told.value.kind, told.value.given, told.value.materials) == ("YieldStresses", 1, 2)


def test_rows_and_columns() -> None:
    """A strip along x presses below itself, and pulls to either side: y runs along the rows."""
    pressure = np.zeros((21, 40))
    pressure[10, :] = 1e9
    below = asp.stress_of(pressure, (40e-6, 21e-6), 0.3, periodic="x")
    np.testing.assert_array_equal(below.pressure, pressure)
    surface = below.at_depth(0.0)
    np.testing.assert_allclose(surface.zz, -pressure, atol=1e-2)
    field = below.at_depth(1e-6)
    assert (field.zz.argmin(axis=0) == 10).all() and np.ptp(field.zz, axis=1).max() < 1.0
    # Plane strain along the strip.
    np.testing.assert_allclose(field.xx, 0.3 * (field.yy + field.zz), atol=1.0)
    np.testing.assert_allclose(field.yz, -field.yz[::-1], atol=1.0)
    # Tension is positive, and z points into the body: below the strip the pressure falls with the depth, d(zz)/dz > 0, and so does yz
    # with y.
    assert field.yz[9, 0] > 1e8 and field.yz[11, 0] < -1e8
    assert abs(field.xz).max() < 1.0
    turned = asp.stress_of(pressure.T, (21e-6, 40e-6), 0.3, periodic="y").at_depth(1e-6)
    np.testing.assert_allclose(turned.xx.T, field.yy, atol=1.0)
    np.testing.assert_allclose(turned.xz.T, field.yz, atol=1.0)
    along = asp.stress_of(pressure, (40e-6, 21e-6), 0.3, periodic="x", friction=0.5, angle=90.0).at_depth(0.0)
    np.testing.assert_allclose(along.yz, -0.5 * pressure, atol=1e-2)


def test_a_volume(tmp_path: Path) -> None:
    below = asp.stress_of(np.ones((4, 5)), 1e-3, 0.3, periodic=False)
    below.write_volume(tmp_path / "stress.vti", 1e-4, 3)
    data = (tmp_path / "stress.vti").read_bytes()
    assert data.startswith(b"<?xml") and b'WholeExtent="0 4 0 3 0 2"' in data
    start = data.index(b'encoding="raw">\n_') + len(b'encoding="raw">\n_') + 8
    values = np.frombuffer(data, dtype="<f4", count=60, offset=start).reshape(3, 4, 5)
    for k in range(3):
        np.testing.assert_array_equal(values[k], below.at_depth(k * 1e-4).von_mises.astype("f4"))


def test_what_has_no_answer_is_refused() -> None:
    with pytest.raises(errors.AsperityError) as told:
        asp.stress_of(np.zeros((4, 4)), 1e-3, 0.3, periodic=False).survey()
    assert told.value.kind == "NoLoad"
    for ratio in (-1.0, 0.6, float("nan")):
        with pytest.raises(ValueError):
            asp.stress_of(np.ones((4, 4)), 1e-3, ratio, periodic=False)
    below = asp.stress_of(np.ones((4, 4)), 1e-3, 0.3, periodic=False)
    with pytest.raises(ValueError):
        below.at_depth(-1.0)
    layered = asp.HalfSpace.layered([(400e9, 0.25, 1e-5)], (210e9, 0.3), "free")
    path = asp.load_path(asp.example_surface(nodes=16), layered, area_fraction=0.1, check=False)
    path.run(check=False)
    with pytest.raises(errors.AsperityError, match="layers"):
        asp.stress(path, friction=0.1)
    coated = asp.stress(path)
    assert coated.poissons_ratio == 0.25
    # Layers have ratios of their own.
    for ask in (
        lambda: asp.stress(path, 0.3),
        lambda: asp.first_yield(path, 1e9, 0.3),
        lambda: asp.first_yields(path, [1e9, 1e9], 0.3),
    ):
        with pytest.raises(errors.AsperityError, match="have their own"):
            ask()
    # The coat and what lies below it differ in what they bear along the interface alone.
    upper, lower = coated.at_depth(1e-5), coated.at_depth(np.nextafter(1e-5, 1.0))
    np.testing.assert_allclose(upper.zz, lower.zz, atol=1e-8 * coated.pressure.max())
    assert upper.xx.max() > lower.xx.max()
    plain = asp.load_path(asp.example_surface(nodes=16), asp.HalfSpace(1e11, boundary="free"), area_fraction=0.1, check=False)
    plain.run(check=False)
    with pytest.raises(ValueError, match="poissons_ratio"):
        asp.stress(plain)
    # Nor does a body of one's own have a ratio.
    own = asp.HalfSpace.from_symbol(lambda qx, qy: 2.0 / (1e11 * np.hypot(qx, qy)))
    path = asp.load_path(asp.example_surface(nodes=16), own, area_fraction=0.1, check=False)
    path.run(check=False)
    with pytest.raises(ValueError, match="poissons_ratio"):
        asp.first_yield(path, 1e9)
    assert asp.stress(path, 0.3).poissons_ratio == 0.3
