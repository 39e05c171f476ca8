"""Results are pickled and copied, bit for bit."""

from __future__ import annotations

import copy
import pickle
from dataclasses import replace

import numpy as np
import pytest

import asperity as asp
from asperity import errors


@pytest.fixture(scope="module")
def path() -> asp.LoadingPath:
    path = asp.load_path(asp.example_surface(nodes=48), asp.HalfSpace(115e9, boundary="free"), area_fraction=0.2, hardness=3e9)
    path.run()
    return path


@pytest.mark.parametrize("protocol", range(2, pickle.HIGHEST_PROTOCOL + 1))
def test_histories_and_states(path: asp.LoadingPath, protocol: int) -> None:
    history = pickle.loads(pickle.dumps(path.history, protocol))
    assert history == path.history and repr(history) == repr(path.history)
    for name, column in path.history.columns().items():
        np.testing.assert_array_equal(history.columns()[name], column)
    assert history.at(load=10.0) == path.history.at(load=10.0)
    state = pickle.loads(pickle.dumps(path.state, protocol))
    assert state == path.state and hash(state) == hash(path.state) and state is not path.state
    np.testing.assert_array_equal(path.pressure(state), path.pressure())
    assert state != path.history[0]


def test_stiffnesses_that_are_infinite_or_not_there() -> None:
    surface = asp.example_surface(nodes=16, short_cutoff=2.5e-3)
    whole = asp.load_path(surface, asp.HalfSpace(1e9, boundary="love"), check=False)
    history = whole.run(check=False)
    again = pickle.loads(pickle.dumps(history))
    assert again == history
    assert np.isinf(again.interfacial_stiffness[-1]) and np.isnan(again.contact_stiffness[-1])
    assert asp.patches(again).number[-1] == 1


def test_surfaces() -> None:
    z = asp.example_surface(nodes=32).z
    z[3, 4] = np.nan
    surface = asp.Surface(z, size=(1e-3 / 3, 7e-4))
    again = pickle.loads(pickle.dumps(surface))
    assert again == surface and again.cell == surface.cell and again.missing == 1
    assert copy.deepcopy(surface) == surface == copy.copy(surface)
    assert surface != asp.Surface(z, size=(1e-3, 7e-4))


def test_solutions() -> None:
    surface, body = asp.example_surface(nodes=32), asp.HalfSpace(115e9, boundary="free")
    for arguments in [{}, {"stiffness": False}, {"hardness": 3e9}]:
        one = asp.solve(surface, body, load=200.0, check=False, **arguments)
        again = pickle.loads(pickle.dumps(one))
        assert repr(again) == repr(one) and again.certificate == one.certificate and again.effort == one.effort
        for name in ["load", "approach", "mean_gap", "energy", "interfacial_stiffness", "plastic_work", "corrected_area"]:
            np.testing.assert_array_equal(getattr(again, name), getattr(one, name))
        for name in ["pressure", "gap", "displacement", "contact_map", "pressure_rate", "yielded_map", "plastic_depth"]:
            found, expected = getattr(again, name), getattr(one, name)
            assert (found is None) == (expected is None)
            if found is not None:
                np.testing.assert_array_equal(found, expected)


def test_small_results_and_errors(path: asp.LoadingPath) -> None:
    for result in [path.certificate(), path.surface.moments(), path.surface.trend(), asp.materials()["steel"]]:
        assert pickle.loads(pickle.dumps(result)) == result
    with pytest.raises(asp.AsperityError) as refused:
        path.history.at(load=-1.0)
    again = pickle.loads(pickle.dumps(refused.value))
    assert type(again) is type(refused.value) and str(again) == str(refused.value)
    assert (again.kind, again.value) == ("OutOfRange", -1.0) and again.numbers == refused.value.numbers
    with pytest.raises(FileNotFoundError) as missing:
        asp.open("nothing.npz")
    again = pickle.loads(pickle.dumps(missing.value))
    assert (again.filename, again.errno) == ("nothing.npz", 2) and "nothing.npz" in str(again)


def test_results_with_arrays_are_compared_by_their_numbers() -> None:
    """Every array counts, and NaN is NaN: across a free boundary nothing has a permeability."""
    rough = asp.example_surface(nodes=32)
    smooth, gap = rough.scaled(0.5), rough.z.max() - rough.z
    pressure, none, size = np.where(gap < 1e-6, 1e9, 0.0), gap < 0.0, rough.size
    pressure[3, 4] = 1e9
    pairs = [
        tuple(surface.psd() for surface in (rough, smooth)),
        tuple(surface.psd_along("x") for surface in (rough, smooth)),
        tuple(asp.gap_distribution(gap, none, bins=bins) for bins in (4, 5)),
        tuple(asp.stress_of(pressure, size, ratio, periodic=False).survey([0.0, 1e-4]) for ratio in (0.2, 0.3)),
        tuple(asp.stress_of(pressure, size, ratio, periodic=False).at_depth(1e-4) for ratio in (0.2, 0.3)),
        tuple(asp.Seal(1e-3, drop, along="x").leak_of(gap, none, size, periodic=False) for drop in (1e5, 2e5)),
    ]
    for one, other in pairs:
        again = pickle.loads(pickle.dumps(one))
        assert again == one and not again != one and one != other and one != 1
        arrays = {name: values for name, values in vars(one).items() if isinstance(values, np.ndarray)}
        for name, values in arrays.items():
            assert replace(one, **{name: values + 1}) != one, name
            assert replace(one, **{name: values[:-1]}) != one, name
        with pytest.raises(TypeError, match="unhashable"):
            hash(one)


def test_what_is_under_way_is_not_pickled(path: asp.LoadingPath) -> None:
    sweep = asp.sweep(asp.example_surface(nodes=32), asp.HalfSpace(1e9, boundary="free"), [1.0], check=False)
    for live in [path, sweep]:
        with pytest.raises(TypeError, match="pickle"):
            pickle.dumps(live)


def test_every_exception_has_its_names() -> None:
    bases = {
        errors.ArrayError: TypeError,
        errors.ConvergenceError: RuntimeError,
        errors.FileError: OSError,
        errors.MissingFileError: FileNotFoundError,
        errors.ForbiddenFileError: PermissionError,
        errors.MemoryLimitError: MemoryError,
        errors.InternalError: RuntimeError,
    }
    for error, base in bases.items():
        raised = error("words", kind="Kind", number=3)
        assert isinstance(raised, base) and isinstance(raised, asp.AsperityError) and isinstance(raised, ValueError)
        assert (str(raised), raised.kind, raised.number, raised.numbers) == ("words", "Kind", 3, {"number": 3})
        assert str(pickle.loads(pickle.dumps(raised))) == "words"
