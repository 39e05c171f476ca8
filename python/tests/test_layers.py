"""Bodies of layers: the same as the program's, limits in closed form, and records."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import measured

import asperity as asp

LAYERS = [(0.2, 0.4, 3e-5), (3.0, 0.2, 5e-5)]
# Neither square nor symmetric: 24 rows and 32 columns, cells of 20 um x 30 um.
SIZE = (32 * 2e-5, 24 * 3e-5)


@pytest.mark.parametrize("boundary", ["free", "love", "spectral"])
@pytest.mark.parametrize("base", ["rigid", (1.0, 0.3)])
def test_records_reopen(boundary: Any, base: Any, tmp_path: Path) -> None:
    surface = measured("periodic_32x24", SIZE)
    body = asp.HalfSpace.layered(LAYERS, base=base, boundary=boundary)
    assert body.is_periodic == (boundary != "free") and body.boundary == boundary
    path = asp.load_path(surface, body, area_fraction=0.2, check=False)
    path.run(check=False)
    path.save(tmp_path / "path.npz")
    opened = asp.open(tmp_path / "path.npz")
    assert opened.history == path.history and opened.e_star == path.e_star == body.e_star
    # Fields of a record are solved again, to 1e-12 of the greatest pressure and better.
    scale = path.pressure().max()
    np.testing.assert_allclose(opened.pressure(), path.pressure(), atol=1e-9 * scale, rtol=0)
    # The node that touches first is the highest, in rows and columns.
    row, column = np.unravel_index(np.argmax(surface.z), surface.shape)
    assert (path.history.row[0], path.history.column[0]) == (row, column)
    # Both go on to the same events.
    for one in (path, opened):
        one.continue_to(area_fraction=0.25)
        one.run(check=False)
    np.testing.assert_array_equal(opened.history.row, path.history.row)
    np.testing.assert_allclose(opened.history.load, path.history.load, rtol=1e-9)


def test_limits() -> None:
    """Short waves see the uppermost layer, long ones the base; one layer by the formula of Nogi and Kato on a rigid base (Bentall
    and Johnson), for an incompressible one: C = (1 + nu)(1 - nu)... evaluated here on its own."""
    young, nu, h = 3.0, 0.3, 2e-3
    body = asp.HalfSpace.layered([(young, nu, h)], base="rigid", boundary="love")
    q = np.array([0.0, 1.0, 300.0, 700.0, 2e5])
    shear = young / (2 * (1 + nu))
    kappa, big = -1 / (3 - 4 * nu), 1 - 4 * (1 - nu)
    theta = np.exp(-2 * q[1:] * h)
    up = 1 + 4 * q[1:] * h * kappa * theta - big * kappa * theta**2
    down = 1 - (big + kappa + 4 * kappa * (q[1:] * h) ** 2) * theta + big * kappa * theta**2
    expected = (1 - nu) / (shear * q[1:]) * up / down
    # At q h = 0.002 the formula cancels to some 1e-16 / (q h)^3 = 1e-8; the library does not.
    np.testing.assert_allclose(body.compliance(q)[1:], expected, rtol=3e-8)
    uniform = h * (1 + nu) * (1 - 2 * nu) / (young * (1 - nu))
    assert body.compliance(q)[0] == pytest.approx(uniform, rel=1e-15)
    # A body without layers.
    assert asp.HalfSpace(2.0, "free").compliance([4.0])[0] == 2.0 / (2.0 * 4.0)
    # Of one material all through it is the half-space.
    whole = asp.HalfSpace.layered([(young, nu, h)], base=(young, nu), boundary="free")
    np.testing.assert_allclose(whole.compliance(q[1:]), 2 * (1 - nu**2) / (young * q[1:]), rtol=1e-13)
    assert math.isinf(whole.compliance([0.0])[0])


def test_of_one_material_it_is_the_half_space(free_surface: asp.Surface) -> None:
    whole = asp.HalfSpace.layered([(1.0, 0.3, 1e-3), (1.0, 0.3, 2e-3)], base=(1.0, 0.3), boundary="free")
    plain = asp.HalfSpace(1 / (1 - 0.3**2), boundary="free")
    # Coefficients err by 1e-13 of the greatest.
    one, other = asp.influence(free_surface, whole), asp.influence(free_surface, plain)
    np.testing.assert_allclose(one, other, atol=3e-13 * other.max(), rtol=0)


def test_against_another_body() -> None:
    coat = [(450e9, 0.25, 5e-6)]
    body = asp.HalfSpace.layered(coat, base="steel", boundary="free", against=(70e9, 0.33))
    assert body.base == (210e9, 0.3) and body.layers == coat
    expected = 1 / ((1 - 0.25**2) / 450e9 + (1 - 0.33**2) / 70e9)
    assert body.e_star == pytest.approx(expected, rel=1e-15)
    again = pickle.loads(pickle.dumps(body))
    assert repr(again) == repr(body) and (again.e_star, again.layers, again.base) == (body.e_star, body.layers, body.base)
    np.testing.assert_array_equal(again.compliance([1e3, 1e6]), body.compliance([1e3, 1e6]))
    assert asp.HalfSpace(1.0, "free").layers is None and asp.HalfSpace(1.0, "free").base is None


BAD: list[tuple[Any, Any, str]] = [
    ([], "rigid", "NotPositive"),
    ([(1.0, 0.3, 0.0)], "rigid", "NotPositive"),
    ([(1.0, 0.3, math.nan)], "rigid", "NotPositive"),
    ([(-1.0, 0.3, 1.0)], "rigid", "NotPositive"),
    ([(1.0, 0.6, 1.0)], "rigid", "OutOfRange"),
    ([(1.0, 0.3, 1.0)], (1e13, 0.3), "OutOfRange"),
    ([(1.0, 0.3, 1.0)], "soft cheese", "Arguments"),
]


@pytest.mark.parametrize(("layers", "base", "kind"), BAD)
def test_bad_bodies_are_refused(layers: Any, base: Any, kind: str) -> None:
    with pytest.raises(asp.AsperityError) as caught:
        asp.HalfSpace.layered(layers, base=base, boundary="free")
    assert caught.value.kind == kind


def test_wrong_types_are_refused(free_surface: asp.Surface) -> None:
    for layers, base in [(3.0, "rigid"), ([(1.0, 0.3)], "rigid"), ([(1.0, 0.3, 1.0)], None), (["steel"], "rigid")]:
        with pytest.raises(TypeError):
            asp.HalfSpace.layered(layers, base=base, boundary="free")  # type: ignore[arg-type]
    with pytest.raises(asp.AsperityError, match="boundary"):
        asp.HalfSpace.layered([(1.0, 0.3, 1.0)], base="rigid", boundary="periodic")  # type: ignore[arg-type]
    # Thickness and cells too far apart: told when the grid is known.
    far = asp.HalfSpace.layered([(1.0, 0.3, 1e12)], base="rigid", boundary="free")
    with pytest.raises(asp.AsperityError) as caught:
        asp.influence(free_surface, far)
    assert caught.value.kind == "OutOfRange" and caught.value.value > 1e12
    symbol = asp.HalfSpace.from_symbol(lambda qx, qy: 1 / np.hypot(qx, qy))
    with pytest.raises(asp.AsperityError, match="knows its compliance"):
        symbol.compliance([1.0])


def test_the_same_as_the_program(program: Callable[..., str], tmp_path: Path) -> None:
    """A coat on steel, by the program's record."""
    record = tmp_path / "path.npz"
    coat = ["--layer", "3e9,0.4,20e-6", "--base", "210e9,0.3"]
    program("path", "--nodes", 48, *coat, "--max-area-fraction", 0.1, "--record", record, "--out", tmp_path / "out")
    body = asp.HalfSpace.layered([(3e9, 0.4, 20e-6)], base=(210e9, 0.3), boundary="free")
    path = asp.load_path(asp.example_surface(nodes=48), body, area_fraction=0.1, check=False)
    history, stored = path.run(check=False), np.load(record)
    np.testing.assert_array_equal(history.load, stored["load"])
    np.testing.assert_array_equal(history.approach, stored["approach"])
    np.testing.assert_array_equal(path.pressure(), stored["pressure"].T)
    assert asp.open(record).history == history
