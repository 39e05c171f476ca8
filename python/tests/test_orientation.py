"""Rows and columns: one map that is neither square nor symmetric goes through every door, and the same node is first in contact."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from conftest import DATA
from numpy.typing import NDArray

import asperity as asp

# 5 rows of 7 columns, cells of 2 um x 3 um, as of the files in tests/data/surface_files.
COLUMN, ROW = np.meshgrid(np.arange(7), np.arange(5))
Z: NDArray[np.float64] = 1e-9 * (100 * COLUMN + 17 * ROW**2 - 3 * COLUMN * ROW - 250.0)
SIZE = (7 * 2e-6, 5 * 3e-6)


class Topography:
    """What looks like a topography of SurfaceTopography: heights() is [ix, iy], in the unit of its sizes."""

    def __init__(self, heights: NDArray[np.float64], sizes: tuple[float, ...], unit: str | None, periodic: bool) -> None:
        self._heights, self.physical_sizes, self.unit, self.is_periodic = heights, sizes, unit, periodic

    def heights(self) -> NDArray[np.float64]:
        return self._heights


def doors(folder: Path) -> dict[str, asp.Surface]:
    """The same map by every way into the package."""
    array = asp.Surface(Z, SIZE)
    for name in ["map.npy", "map.gsf", "map.x3p"]:
        array.save(folder / name)
    np.save(folder / "transposed.npy", Z.T)
    files = DATA / "surface_files"
    path = asp.load_path(array, asp.HalfSpace(1e9, boundary="free"), area_fraction=0.2, check=False)
    path.run(check=False)
    path.save(folder / "record.npz")
    recorded = np.load(folder / "record.npz")["heights"]
    quiet = {"height_unit": "m", "size": SIZE}
    return {
        "array": array,
        "fortran": asp.Surface(np.asfortranarray(Z), SIZE),
        "view": asp.Surface(np.ascontiguousarray(Z.T).T, SIZE),
        "list": asp.Surface(Z.tolist(), SIZE),
        "topography": asp.Surface(Topography(Z.T * 1e6, (14.0, 15.0), "µm", False)),
        "masked topography": asp.Surface(Topography(np.ma.array(Z.T * 1e6), (14.0, 15.0), "um", False)),
        "npy": asp.read(folder / "map.npy", **quiet),
        "npy of the transposed image": asp.read(folder / "transposed.npy", **quiet),
        "npy bytes": asp.read((folder / "map.npy").read_bytes(), **quiet),
        "npy file object": asp.read(io.BytesIO((folder / "map.npy").read_bytes()), **quiet),
        "gsf": asp.read(folder / "map.gsf"),
        "x3p": asp.read(folder / "map.x3p"),
        "gsf of the library": asp.read(files / "plain.gsf"),
        "x3p of the library": asp.read(files / "plain_i16.x3p"),
        "record": asp.Surface(recorded.T, SIZE),
        "record opened": asp.open(folder / "record.npz").surface,
        "resampled": array.resample((5, 7)),
        "pickled": asp.Surface(array),
    }


@pytest.fixture(scope="module")
def surfaces(tmp_path_factory: pytest.TempPathFactory) -> dict[str, asp.Surface]:
    return doors(tmp_path_factory.mktemp("doors"))


def test_one_map_through_every_door(surfaces: dict[str, asp.Surface]) -> None:
    for name, surface in surfaces.items():
        assert surface.shape == (5, 7), name
        assert surface.size == pytest.approx(SIZE, rel=1e-15), name
        # float32 of a file rounds a height of 0.5 um to 3e-14 m; a record counts heights from the highest node.
        found = surface.z - surface.z.max()
        np.testing.assert_allclose(found, Z - Z.max(), rtol=0, atol=1e-13, err_msg=name)


def test_the_same_node_is_first_in_contact(surfaces: dict[str, asp.Surface]) -> None:
    row, column = np.unravel_index(np.argmax(Z), Z.shape)
    # The order of the first nodes is that of the heights where loads are small, and the highest lies in a corner that no mirror keeps.
    assert (row, column) == (4, 6)
    orders = {}
    for name, surface in surfaces.items():
        path = asp.load_path(surface, asp.HalfSpace(1e9, boundary="free"), nodes=5, check=False)
        history = path.run(check=False)
        orders[name] = list(zip(history.row.tolist(), history.column.tolist(), strict=True))
        assert orders[name][0] == (row, column), name
        assert orders[name] == orders["array"], name
        contact = path.contact_map()
        assert contact.shape == (5, 7)
        assert {tuple(node) for node in np.argwhere(contact).tolist()} == set(orders[name]), name
        pressure = path.pressure()
        assert pressure.shape == (5, 7)
        assert np.all(pressure[~contact] == 0.0)


def test_fields_have_the_axes_of_the_heights(tmp_path: Path) -> None:
    """A crest along a row, and what lies along it: every field, every patch and every file."""
    z = np.zeros((6, 9))
    z[4, :] = 1e-6
    surface = asp.Surface(z, size=(9e-6, 6e-6))
    path = asp.load_path(surface, asp.HalfSpace(1e9, boundary="love"), nodes=9, check=False)
    history = path.run(check=False)
    assert set(history.row.tolist()) == {4}
    assert sorted(history.column.tolist()) == list(range(9))
    analysis = asp.patches(path)
    percolation = analysis.percolation()
    # A ridge along x: contact goes on along x, and no fluid gets along y.
    assert percolation.contact_x is not None and percolation.contact_y is None
    assert percolation.seal_y is not None and percolation.seal_x is None
    assert not np.isnan(analysis.activation()[4]).any()
    assert np.isnan(np.delete(analysis.activation(), 4, axis=0)).all()
    labels = asp.label_patches(path.contact_map(), surface.size, periodic=True)
    assert labels.labels[4].tolist() == [1] * 9
    assert (labels.wraps_x.tolist(), labels.wraps_y.tolist()) == ([True], [False])
    assert labels.y[0] == pytest.approx(4.5e-6, rel=1e-12) and np.isnan(labels.x[0])
    path.save(tmp_path / "ridge.npz", fields=True)
    # The file is that of the library: [ix, iy].
    record = np.load(tmp_path / "ridge.npz")
    np.testing.assert_array_equal(record["pressure"].T, path.pressure())
    one = asp.solve(surface, asp.HalfSpace(1e9, boundary="love"), load=1e-6, check=False)
    assert one.contact_map[4].all() and one.contact_map.sum() == 9


def test_a_hardness_map_is_row_and_column() -> None:
    """The column that is soft yields."""
    surface = asp.example_surface(nodes=32)
    hardness = np.full((32, 32), 1e12)
    hardness[:, 20:] = 1e9
    path = asp.load_path(
        surface, asp.HalfSpace(115e9, boundary="free"), area_fraction=0.2, hardness=hardness, check=False
    )
    path.run(check=False)
    rows, columns = np.nonzero(path.yielded_map())
    assert len(rows) > 10 and columns.min() >= 20
    np.testing.assert_array_equal(path.hardness, hardness)


def test_sides_along_x_and_y() -> None:
    surface = asp.Surface(Z, SIZE)
    assert surface.cell == (SIZE[0] / 7, SIZE[1] / 5)
    # One number is the side along x, with square cells.
    assert asp.Surface(Z, 7e-6).size == (7e-6, 7e-6 / 7 * 5)
    plane = asp.Surface(1e-7 * COLUMN, size=(7.0, 5.0))
    assert plane.trend().slopes == pytest.approx((1e-7, 0.0), abs=1e-20)
    assert plane.rms_slopes == pytest.approx((1e-7, 0.0), abs=1e-20)


def test_turning_and_cutting() -> None:
    surface = asp.Surface(Z, SIZE)
    np.testing.assert_array_equal(surface.transpose().z, Z.T)
    assert surface.transpose().size == (SIZE[1], SIZE[0])
    np.testing.assert_array_equal(surface.flip("x").z, Z[:, ::-1])
    np.testing.assert_array_equal(surface.flip("y").z, Z[::-1])
    np.testing.assert_array_equal(surface.shift(2, -1).z, np.roll(Z, (-1, 2), (0, 1)))
    piece = surface.crop(rows=(1, 4), columns=(2, 7))
    np.testing.assert_array_equal(piece.z, Z[1:4, 2:7])
    assert piece.cell == surface.cell
    np.testing.assert_array_equal((-surface).z, -Z)
    np.testing.assert_array_equal((surface + surface.flip("x")).z, Z + Z[:, ::-1])


def test_a_topography_of_surfacetopography() -> None:
    package = pytest.importorskip("SurfaceTopography")
    topography = package.Topography(Z.T * 1e6, (14.0, 15.0), unit="µm", periodic=False)
    surface = asp.Surface(topography)
    np.testing.assert_allclose(surface.z, Z, rtol=1e-15)
    assert surface.size == pytest.approx(SIZE, rel=1e-15)
    assert surface.is_periodic is False
