"""Contact patches: beside counts of NumPy, and of tamaas."""

from __future__ import annotations

import csv
from collections import deque

import numpy as np
import pytest
from conftest import DATA
from numpy.typing import NDArray

import asperity as asp


def flood(contact: NDArray[np.bool_], connectivity: int, periodic: bool) -> NDArray[np.int64]:
    """Labels by a walk from node to node."""
    rows, columns = contact.shape
    steps = [(0, 1), (1, 0), (0, -1), (-1, 0)] + ([(1, 1), (1, -1), (-1, 1), (-1, -1)] if connectivity == 8 else [])
    labels = np.zeros(contact.shape, dtype=np.int64)
    count = 0
    for start in np.argwhere(contact):
        if labels[tuple(start)]:
            continue
        count += 1
        labels[tuple(start)] = count
        waiting = deque([tuple(start)])
        while waiting:
            row, column = waiting.popleft()
            for dr, dc in steps:
                r, c = row + dr, column + dc
                if periodic:
                    r, c = r % rows, c % columns
                if 0 <= r < rows and 0 <= c < columns and contact[r, c] and not labels[r, c]:
                    labels[r, c] = count
                    waiting.append((r, c))
    return labels


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("periodic", [False, True])
def test_labels_and_loads(connectivity: int, periodic: bool) -> None:
    random = np.random.default_rng(3)
    contact = random.random((23, 31)) < 0.4
    pressure = np.where(contact, random.random((23, 31)), 0.0)
    size = (31e-6, 46e-6)
    found = asp.label_patches(contact, size, periodic=periodic, connectivity=connectivity, pressure=pressure)
    labels = flood(contact, connectivity, periodic)
    # The engine counts patches in the order in which x runs fastest, as a walk along rows does.
    np.testing.assert_array_equal(found.labels, labels)
    assert len(found) == labels.max()
    every = range(1, len(found) + 1)
    np.testing.assert_array_equal(found.nodes, [np.sum(labels == k) for k in every])
    cell = 1e-6 * 2e-6
    np.testing.assert_allclose(found.area, found.nodes * cell, rtol=1e-12)
    np.testing.assert_allclose(found.load, [pressure[labels == k].sum() * cell for k in every], rtol=1e-12)
    np.testing.assert_array_equal(found.max_pressure, [pressure[labels == k].max() for k in every])
    np.testing.assert_allclose(found.mean_pressure, found.load / found.area, rtol=1e-12)
    if not periodic:
        rows, columns = np.indices(contact.shape)
        np.testing.assert_allclose(found.x, [(columns[labels == k].mean() + 0.5) * 1e-6 for k in every], rtol=1e-12)
        np.testing.assert_allclose(found.y, [(rows[labels == k].mean() + 0.5) * 2e-6 for k in every], rtol=1e-12)
        assert not found.wraps_x.any() and not found.wraps_y.any()
    assert set(found.columns()) >= {"nodes", "area", "load", "x", "y"}
    assert np.isnan(asp.label_patches(contact, size, periodic=periodic).load).all()


def test_patches_of_every_state(periodic_surface: asp.Surface) -> None:
    """768 states, whose patches tamaas has counted."""
    with (DATA / "periodic_32x24_love_patches.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    path = asp.load_path(periodic_surface, asp.HalfSpace(1.0, boundary="love"), check=False)
    path.run(check=False)
    for given in [path, path.history]:
        found = asp.patches(given, connectivity=4)
        np.testing.assert_array_equal(found.number, [int(row["patches"]) for row in rows])
        np.testing.assert_array_equal(found.largest, [int(row["largest_patch_nodes"]) for row in rows])
    assert len(found) == 768
    # Sides of 20 um along x and of 30 um along y.
    sides = np.array([int(row["perimeter_sides"]) for row in rows])
    assert np.all(found.perimeter <= sides * 3e-5 * (1 + 1e-12)) and np.all(found.perimeter >= sides * 2e-5 * (1 - 1e-12))
    np.testing.assert_array_equal(found.corrected_area, path.history.corrected_area)
    state = path.history[300]
    np.testing.assert_array_equal(found.at(state).labels, flood(path.contact_map(state), 4, True))


def test_activation_holds_every_contact_map(rough: asp.Surface, body: asp.HalfSpace) -> None:
    path = asp.load_path(rough, body, area_fraction=0.3)
    history = path.run(check=False)
    found = asp.patches(path)
    activation = found.activation()
    for state in [history[10], history[500], history[-1]]:
        np.testing.assert_array_equal(activation <= state.load, path.contact_map(state))
    np.testing.assert_array_equal(np.isnan(activation), ~path.contact_map())
    np.testing.assert_array_equal(found.activation("approach")[history.row, history.column], history.approach)
    with pytest.raises(asp.AsperityError, match="quantity must be"):
        found.activation("colour")


def test_the_tree_of_mergers(rough: asp.Surface, body: asp.HalfSpace) -> None:
    path = asp.load_path(rough, body, area_fraction=0.4)
    history = path.run(check=False)
    found = asp.patches(path)
    tree = found.merge_tree()
    lasting = tree["merged"] == -1
    # What was born and has not merged is there at every state.
    for nodes in [1, 50, 700, len(history)]:
        alive = (tree["birth"] <= nodes) & (lasting | (tree["merged"] > nodes))
        assert alive.sum() == found.number[nodes - 1]
    assert tree["nodes"][lasting].sum() == len(history)
    assert np.all(tree["into"][~lasting] < np.arange(len(lasting))[~lasting])
    np.testing.assert_array_equal(tree["row"], history.row[tree["birth"] - 1])


def test_when_it_percolates_and_seals(rough: asp.Surface) -> None:
    path = asp.load_path(rough, asp.HalfSpace(115e9, boundary="free"), area_fraction=0.7)
    history = path.run(check=False)
    found = asp.patches(path)
    percolation = found.percolation()
    assert percolation == found.winding()  # on a free boundary
    # Where contact leads along one axis, no channel does along the other.
    assert percolation.seal_x == percolation.contact_y and percolation.seal_y == percolation.contact_x
    state = percolation.contact_x
    assert state is not None
    for at, leads in [(state, True), (history[state.step - 2], False)]:
        labels = flood(path.contact_map(at), 8, False)
        ends = set(labels[:, 0]) & set(labels[:, -1]) - {0}
        assert bool(ends) == leads
    before = history[state.step - 2]
    narrow = path.constriction("y", before)
    assert narrow is not None and path.constriction("y", state) is None
    gap = path.gap(before)
    assert gap[narrow.row, narrow.column] == narrow.gap > 0.0
    # Channels as wide as that lead all the way, and wider ones do not.
    for least, leads in [(narrow.gap, True), (np.nextafter(narrow.gap, 1.0), False)]:
        labels = flood((gap >= least) & ~path.contact_map(before), 4, False)
        assert bool(set(labels[0]) & set(labels[-1]) - {0}) == leads
    one = asp.solve(rough, asp.HalfSpace(115e9, boundary="free"), load=before.load, tolerance=1e-12, check=False)
    again = one.constriction("y")
    assert again is not None and (again.row, again.column) == (narrow.row, narrow.column)
    assert len(one.patches()) == len(found.at(before))


def test_it_seals_where_the_leak_ends() -> None:
    """On a periodic surface: fluid goes from end to end and passes the border across. Around the grid is another question."""
    path = asp.load_path(
        asp.example_surface(64, seed=3), asp.HalfSpace(115e9, boundary="love"), area_fraction=0.6, check=False
    )
    history = path.run(check=False)
    for connectivity in (4, 8):
        found = asp.patches(path, connectivity=connectivity)  # type: ignore[arg-type]
        seals, winds = found.percolation(), found.winding()
        for along, state, around in (
            ("x", seals.seal_x, winds.seal_x),
            ("y", seals.seal_y, winds.seal_y),
        ):
            assert state is not None and around is not None and around.step <= state.step
            before = history[state.step - 2]
            assert asp.Seal(1e-3, 1.0, along=along).curve(path, states=3).closing == state  # type: ignore[arg-type]
            assert path.constriction(along, state) is None and path.constriction(along, before)  # type: ignore[arg-type]
        assert winds.seal_x != seals.seal_x
        assert seals.contact_x is not None and winds.contact_x is not None
        assert seals.contact_x.step <= winds.contact_x.step


def test_distributions(rough: asp.Surface, body: asp.HalfSpace) -> None:
    one = asp.solve(rough, body, load=500.0, check=False)
    pressure = asp.pressure_distribution(one.pressure, one.contact_map, bins=20)
    assert pressure.counts.sum() == one.contact_nodes and len(pressure.edges) == 21
    assert (pressure.density * np.diff(pressure.edges)).sum() == pytest.approx(1.0, rel=1e-12)
    assert pressure.area_fraction == one.area_fraction
    gap = asp.gap_distribution(one.gap, one.contact_map, per_decade=4)
    assert gap.counts.sum() + gap.outside == (~one.contact_map).sum()
    with pytest.raises(asp.AsperityError, match="not both"):
        asp.gap_distribution(one.gap, one.contact_map, bins=3, per_decade=3)
    with pytest.raises(asp.AsperityError) as refused:
        asp.pressure_distribution(one.pressure[:3], one.contact_map)
    assert refused.value.kind == "GridMismatch"
    with pytest.raises(asp.AsperityError):
        asp.pressure_distribution(one.pressure, one.pressure)


def test_what_is_no_path(rough: asp.Surface) -> None:
    for wrong in [rough, None, 3]:
        with pytest.raises(asp.AsperityError, match="LoadingPath or a History"):
            asp.patches(wrong)
    with pytest.raises(asp.AsperityError, match="4 or 8"):
        asp.label_patches(np.ones((2, 2), dtype=bool), 1.0, periodic=False, connectivity=6)
