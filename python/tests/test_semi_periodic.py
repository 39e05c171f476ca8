"""Half-spaces that repeat along one side."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from conftest import measured

import asperity as asp

SIZE = (32 * 2e-5, 24 * 3e-5)
# Of an array [row, column]: x runs along the columns.
SIDES = {"x": 1, "y": 0}


@pytest.mark.parametrize("side", SIDES)
def test_the_half_space_repeats_along_its_side_alone(side: str) -> None:
    surface = measured("periodic_32x24", SIZE)
    body = asp.HalfSpace(1.0, boundary=side)
    assert body.boundary == side and body.periodic == side and repr(body) == f"HalfSpace(e_star=1.0, boundary='{side}')"
    one = asp.solve(surface, body, load=1e-9, tolerance=1e-12, check=False)
    for name, axis in SIDES.items():
        moved = asp.Surface(np.roll(surface.z, 5, axis=axis), size=SIZE)
        other = asp.solve(moved, body, load=1e-9, tolerance=1e-12, check=False)
        pressure = np.roll(other.pressure, -5, axis=axis)
        # Gaps are zero to 1e-12 of the heights; a condition number of some hundreds makes 1e-9 of the greatest pressure of it.
        same = np.allclose(pressure, one.pressure, rtol=0.0, atol=1e-9 * one.pressure.max())
        assert same == (name == side)


@pytest.mark.parametrize("side", SIDES)
def test_it_is_pickled_and_recorded(side: str, tmp_path) -> None:  # type: ignore[no-untyped-def]
    surface = measured("periodic_32x24", SIZE)
    body = pickle.loads(pickle.dumps(asp.HalfSpace(1.0, boundary=side)))
    assert body.boundary == side and body.e_star == 1.0
    path = asp.load_path(surface, body, area_fraction=0.3, check=False)
    history = path.run(check=False)
    assert pickle.loads(pickle.dumps(history)) == history
    # Edges are closed where the map does not repeat.
    seal = asp.Seal(1e-3, 1e-6, "y" if side == "x" else "x")
    gap, contact = path.gap(), path.contact_map()
    of_map = seal.leak_of(gap, contact, path.size, periodic=path.periodic)
    assert of_map.leak_rate == seal.leak(path).leak_rate
    assert seal.leak_of(gap, contact, path.size, periodic=False).leak_rate < of_map.leak_rate
    solution = asp.solve(surface, body, area_fraction=0.2, check=False)
    again = pickle.loads(pickle.dumps(solution))
    np.testing.assert_array_equal(again.pressure, solution.pressure)
    # Patches of what was pickled go around the side that repeats, and around no other.
    contact = history.at(area_fraction=0.3)
    expected = asp.label_patches(path.contact_map(contact), SIZE, periodic=path.periodic)
    for patches in (asp.patches(path).at(contact), asp.patches(pickle.loads(pickle.dumps(history))).at(contact)):
        np.testing.assert_array_equal(patches.labels, expected.labels)
    path.save(tmp_path / "path.npz")
    opened = asp.open(tmp_path / "path.npz")
    assert path.periodic == opened.periodic == side
    # A path that was opened iterates the fields of its last state.
    np.testing.assert_allclose(opened.pressure(), path.pressure(), rtol=0.0, atol=1e-9 * path.pressure().max())
    opened.continue_to(area_fraction=0.4)
    whole = asp.load_path(surface, body, area_fraction=0.4, check=False).run(check=False)
    # Its factor is made again, and rounded in another order.
    np.testing.assert_allclose(opened.run(check=False).load, whole.load, rtol=1e-12, atol=0.0)


def test_its_coefficients_make_the_same_body() -> None:
    surface = measured("periodic_32x24", SIZE)
    body = asp.HalfSpace(1.0, boundary="x")
    table = asp.influence(surface, body)

    def coefficients(di: np.ndarray, dj: np.ndarray) -> np.ndarray:
        return table[np.abs(dj), di % 32]

    own = asp.HalfSpace.from_coefficients(coefficients, boundary="x", growth="convex")
    np.testing.assert_array_equal(asp.influence(surface, own), table)
    paths = [asp.load_path(surface, body, nodes=60, check=False).run(check=False) for body in (body, own)]
    np.testing.assert_array_equal(paths[0].load, paths[1].load)
    # What its approach is counted from is a convention, whoever made it.
    conducted = [asp.conductance(path, e_star=1.0, resistivity=1.0) for path in paths]
    np.testing.assert_array_equal(conducted[0], conducted[1])


def test_patches_and_leaks_take_the_side() -> None:
    contact = np.zeros((4, 5), dtype=bool)
    contact[1, [0, 4]] = contact[[0, 3], 2] = True
    numbers = {False: 4, "x": 3, "y": 3, True: 2}
    for periodic, number in numbers.items():
        found = asp.label_patches(contact, 1.0, periodic=periodic, connectivity=4)  # type: ignore[arg-type]
        assert found.labels.max() == number
    gap, open_everywhere = np.full((4, 5), 1e-6), np.zeros((4, 5), dtype=bool)
    gap[0] = 1e-5
    seal = asp.Seal(1e-3, 1e5, along="x")
    rates = [seal.leak_of(gap, open_everywhere, 1.0, periodic=side).leak_rate for side in (False, "x", "y", True)]  # type: ignore[arg-type]
    # Along x, only sides across it are joined: nothing changes, as the flow is along rows.
    np.testing.assert_allclose(rates, rates[0], rtol=1e-12)
    for wrong in ("z", "periodic", 1.5, None):
        with pytest.raises((asp.AsperityError, TypeError)):
            asp.label_patches(contact, 1.0, periodic=wrong)  # type: ignore[arg-type]


def test_layers_repeat_along_both_sides_or_none() -> None:
    with pytest.raises(asp.AsperityError, match="boundary"):
        asp.HalfSpace.layered([("rubber", 1e-3)], "rigid", "x")  # type: ignore[arg-type]
    with pytest.raises(asp.AsperityError, match="boundary"):
        asp.HalfSpace(1.0, boundary="z")  # type: ignore[arg-type]
