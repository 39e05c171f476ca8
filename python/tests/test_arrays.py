"""Arrays in and out: any real dtype, any strides; new arrays of float64 in C order."""

from __future__ import annotations

import numpy as np
import pytest

import asperity as asp
from asperity.errors import ArrayError

INTEGERS = np.array([[0, 1, 5], [2, 3, 4]])
SIZE = (3.0, 2.0)
REAL = ["f2", "f4", "f8", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", ">f4", ">f8", ">i2", "<i8", np.longdouble]


@pytest.mark.parametrize("dtype", REAL, ids=str)
def test_every_real_dtype(dtype: str) -> None:
    z = INTEGERS.astype(dtype)
    z.flags.writeable = False
    found = asp.Surface(z, SIZE).z
    np.testing.assert_array_equal(found, INTEGERS)
    assert found.dtype == np.float64 and found.dtype.isnative


def test_every_stride() -> None:
    wide = np.arange(60.0).reshape(6, 10)
    views = [wide[::2], wide[:, ::3], wide[::-1, ::-2], wide.T, wide[1:4, 2:7], np.broadcast_to(wide[0], (4, 10))]
    for view in views:
        surface = asp.Surface(view, (1.0, 1.0))
        np.testing.assert_array_equal(surface.z, view)
    # Not aligned.
    packed = np.zeros(8, dtype=[("flag", "u1"), ("z", "f8")])
    packed["z"] = np.arange(8.0)
    np.testing.assert_array_equal(asp.Surface(packed["z"].reshape(2, 4), (1.0, 1.0)).z, packed["z"].reshape(2, 4))


def test_the_surface_does_not_see_what_becomes_of_the_array() -> None:
    z = INTEGERS.astype(float)
    surface = asp.Surface(z, SIZE)
    z[:] = -1.0
    np.testing.assert_array_equal(surface.z, INTEGERS)
    # Nor what becomes of what it gave.
    surface.z[:] = -1.0
    np.testing.assert_array_equal(surface.z, INTEGERS)


def test_what_is_missing() -> None:
    z = np.arange(20.0).reshape(4, 5) * 1e-9
    holes = z.copy()
    holes[1, 2], holes[3, 4], holes[0, 0] = np.nan, np.inf, -np.inf
    masked = np.ma.masked_array(z, mask=~np.isfinite(holes))
    integers = np.ma.masked_array(np.arange(20).reshape(4, 5), mask=~np.isfinite(holes))
    for given in [holes, masked, integers]:
        surface = asp.Surface(given, (5.0, 4.0))
        assert surface.missing == 3
        np.testing.assert_array_equal(np.isnan(surface.z), ~np.isfinite(holes))
    surface = asp.Surface(holes, (5.0, 4.0))
    filled = surface.fill_missing()
    assert filled.missing == 0
    # Nodes that were measured stay as they are.
    np.testing.assert_array_equal(filled.z[np.isfinite(holes)], z[np.isfinite(holes)])
    with pytest.raises(asp.AsperityError) as refused:
        asp.load_path(surface, asp.HalfSpace(1e9, boundary="free"))
    assert refused.value.kind == "HeightNotFinite" and refused.value.count == 3
    assert (refused.value.row, refused.value.column) == (0, 0)
    assert "Surface.fill_missing()" in str(refused.value)
    with pytest.raises(asp.AsperityError) as nothing:
        asp.Surface(np.full((3, 4), np.nan), (1.0, 1.0)).fill_missing()
    assert nothing.value.kind == "NothingMeasured" and (nothing.value.nx, nothing.value.ny) == (4, 3)
    # A mask that is no mask.
    np.testing.assert_array_equal(asp.Surface(np.ma.array(z), (5.0, 4.0)).z, z)


def test_rows_that_are_masked() -> None:
    rows = [np.ma.masked_greater(np.arange(4.0) + k, 5.0) for k in range(4)]
    for given in [rows, tuple(rows)]:
        surface = asp.Surface(given, size=(1.0, 1.0))
        assert surface.missing == sum(row.mask.sum() for row in rows) == 1


def test_masks_of_truths() -> None:
    """A mask that hides something is refused: there is no contact that may be or not. Without one all are what they are."""
    gap = np.arange(12.0).reshape(3, 4)
    contact = gap < 3.0
    found = asp.gap_distribution(gap, contact)
    masked = np.ma.array(contact, mask=np.zeros((3, 4), dtype=bool))
    np.testing.assert_array_equal(asp.gap_distribution(gap, masked).counts, found.counts)
    masked[1, 2] = np.ma.masked
    with pytest.raises(ArrayError) as refused:
        asp.gap_distribution(gap, masked)
    assert refused.value.argument == "contact_map" and "masked" in str(refused.value)


HOSTILE = [
    np.zeros((2, 3), dtype=complex),
    np.zeros((2, 3), dtype=object),
    np.array([["a", "b"], ["c", "d"]]),
    np.array([["a", 1.0]], dtype=object),
    np.zeros((2, 3), dtype=bool),
    np.zeros((2, 3), dtype="datetime64[s]"),
    np.zeros((2, 3), dtype=[("x", "f8")]),
    np.float64(1.0),
    np.zeros(()),
    np.zeros(5),
    np.zeros((2, 3, 4)),
    np.zeros((1, 1, 1, 1)),
    "heights",
    b"heights",
    None,
    3.5,
    {"z": 1},
    [[1.0, 2.0], ["x", 3.0]],
    [[10**400, 1.0]],
    object(),
    int,
]


@pytest.mark.parametrize("z", HOSTILE, ids=lambda z: repr(z)[:40])
def test_what_is_no_map_of_heights(z: object) -> None:
    with pytest.raises(ArrayError) as refused:
        asp.Surface(z, SIZE)
    # One error has all three names.
    assert isinstance(refused.value, asp.AsperityError)
    assert isinstance(refused.value, ValueError) and isinstance(refused.value, TypeError)
    assert refused.value.argument == "z"
    assert hasattr(refused.value, "dtype") or hasattr(refused.value, "shape")


def test_ragged_lists_are_refused() -> None:
    with pytest.raises(ValueError):
        asp.Surface([[1.0, 2.0], [3.0]], SIZE)


@pytest.mark.parametrize("shape", [(0, 3), (3, 0), (0, 0)])
def test_empty_maps(shape: tuple[int, int]) -> None:
    with pytest.raises(asp.AsperityError) as refused:
        asp.Surface(np.zeros(shape), SIZE)
    assert refused.value.kind == "EmptyGrid"
    assert (refused.value.ny, refused.value.nx) == shape


def test_huge_sides_are_refused_before_they_are_copied() -> None:
    """A view of 10¹² heights takes no memory, and its copy would."""
    with pytest.raises(asp.AsperityError) as refused:
        asp.Surface(np.broadcast_to(0.0, (10**6, 10**6)), SIZE)
    assert refused.value.kind == "GridTooLarge" and refused.value.max_side == 32768
    for nodes in [10**5, 2**40]:
        with pytest.raises(asp.AsperityError):
            asp.example_surface(nodes=nodes)


@pytest.mark.parametrize("size", [(0.0, 1.0), (1.0, -1.0), (np.nan, 1.0), (np.inf, 1.0), -1.0, (1e300, 1e300)])
def test_sides_that_are_none(size: object) -> None:
    with pytest.raises(asp.AsperityError) as refused:
        asp.Surface(INTEGERS, size)
    assert refused.value.kind == "NotPositive"


@pytest.mark.parametrize("size", ["1e-3", (1.0, 2.0, 3.0), [], object()])
def test_sizes_of_another_kind(size: object) -> None:
    with pytest.raises(TypeError, match=r"a number or \(x, y\) was expected, but this is"):
        asp.Surface(INTEGERS, size)


def test_sides_as_a_list() -> None:
    assert asp.Surface(INTEGERS, [1e-3, 2e-3]).size == (1e-3, 2e-3)


def test_an_array_needs_a_size() -> None:
    with pytest.raises(asp.AsperityError, match="size="):
        asp.Surface(INTEGERS)


def test_units() -> None:
    np.testing.assert_array_equal(asp.Surface(INTEGERS, SIZE, height_unit="nm").z, INTEGERS * 1e-9)
    with pytest.raises(asp.AsperityError) as refused:
        asp.Surface(INTEGERS, SIZE, height_unit="V")
    assert refused.value.kind == "NoLength" and refused.value.unit == "V"


class Odd:
    """A topography that is not all there."""

    physical_sizes: object = (1.0, 1.0)
    unit: object = "m"
    is_periodic: object = True

    def __init__(self, **others: object) -> None:
        self.__dict__.update(others)

    def heights(self) -> object:
        return INTEGERS


def test_topographies_that_are_not_all_there() -> None:
    assert asp.Surface(Odd()).is_periodic is True
    for odd in [Odd(physical_sizes=(1.0,)), Odd(physical_sizes=None), Odd(physical_sizes=(1.0, 0.0)), Odd(unit="V")]:
        with pytest.raises(asp.AsperityError):
            asp.Surface(odd)
    with pytest.warns(asp.AsperityWarning, match="no unit"):
        asp.Surface(Odd(unit=None))
    with pytest.raises(asp.AsperityError, match="neither size nor height_unit"):
        asp.Surface(Odd(), size=(1.0, 1.0))
    class Raises(Odd):
        def heights(self) -> object:
            raise KeyError("no heights")
    with pytest.raises(KeyError):
        asp.Surface(Raises())
    class Unreadable(Odd):
        def __init__(self) -> None: ...
        @property
        def unit(self) -> str:  # type: ignore[override]
            raise RuntimeError("metadata")
    with pytest.raises(RuntimeError, match="metadata"):
        asp.Surface(Unreadable())


def test_errors_name_rows_and_columns() -> None:
    z = np.zeros((12, 16))
    z[2, 5] = np.nan
    with pytest.raises(asp.AsperityError, match="the first at the node in row 2, column 5;") as refused:
        _ = asp.Surface(z, 1.0).sq
    assert (refused.value.row, refused.value.column) == (2, 5)
    gap, apart = np.where(np.isnan(z), np.nan, 1e-6), np.zeros(z.shape, bool)
    with pytest.raises(asp.AsperityError, match="the gap at the node in row 2, column 5 is NaN"):
        asp.Seal(1e-3, 1e5, "x").leak_of(gap, apart, 1.0, periodic=False)
    with pytest.raises(asp.AsperityError, match=r"a grid of 0 x 5 \(rows x columns\) nodes is empty") as empty:
        asp.Surface(np.zeros((0, 5)), 1.0)
    assert (empty.value.rows, empty.value.columns) == (0, 5)
    with pytest.raises(asp.AsperityError, match=r"a grid of 3 x 40000 \(rows x columns\) nodes is too large"):
        asp.Surface(np.zeros((4, 4)), 1.0).resample((3, 40000))


def test_errors_of_arguments_are_their_own() -> None:
    class Bad:
        def __float__(self) -> float:
            raise RuntimeError("mine")
    with pytest.raises(RuntimeError, match="mine"):
        asp.Surface(INTEGERS, Bad())  # type: ignore[arg-type]
    with pytest.raises(OverflowError):
        asp.Surface(INTEGERS, 10**400)
    with pytest.raises(TypeError, match="a number or"):
        asp.Surface(INTEGERS, "1 mm")  # type: ignore[arg-type]


def test_pieces_and_sums_of_periodic_surfaces() -> None:
    whole, edged = (asp.Surface(Odd(is_periodic=periodic)) for periodic in (True, False))
    rows, columns = whole.shape
    unknown = asp.Surface(INTEGERS.T, (1.0, 1.0))
    assert [unknown.shape, unknown.is_periodic] == [(rows, columns), None]
    for same in (whole.crop(), whole.crop((0, rows), (0, columns)), whole.flip("x"), whole + whole):
        assert same.is_periodic is True
    for piece in (whole.crop(rows=(1, rows)), whole.crop(columns=(0, columns - 1)), whole + unknown, unknown + whole):
        assert piece.is_periodic is None
    assert (whole + edged).is_periodic is False and (edged + whole).is_periodic is False


def test_what_comes_out_is_new_and_in_order(free_surface: asp.Surface, unit_half_space: asp.HalfSpace) -> None:
    path = asp.load_path(free_surface, unit_half_space, nodes=20, check=False)
    history = path.run(check=False)
    for name, column in history.columns().items():
        assert column.shape == (20,), name
        expected = {"step": "i8", "row": "i8", "column": "i8", "contact_nodes": "i8", "event": "<U7"}.get(name, "f8")
        assert column.dtype == np.dtype(expected), name
    one = asp.solve(free_surface, unit_half_space, load=1e-7, check=False)
    fields = [path.pressure(), path.gap(), path.displacement(), path.contact_map(), one.pressure, one.gap, one.contact_map]
    for field in fields:
        assert field.flags.c_contiguous and field.flags.writeable and field.shape == (48, 48)
        assert field.dtype in (np.float64, np.bool_)
    first = path.pressure()
    first[:] = 7.0
    assert path.pressure().max() != 7.0
