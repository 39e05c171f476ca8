"""One engine: every column and every field is that of the program's record, bit for bit."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import DATA, measured

import asperity as asp

# Column of the record: column here.
COLUMNS = {
    "step": "step",
    "ix": "column",
    "iy": "row",
    "event": "event_code",
    "contact_nodes": "contact_nodes",
    "approach": "approach",
    "load": "load",
    "contact_area": "contact_area",
    "contact_area_fraction": "area_fraction",
    "mean_gap": "mean_gap",
    "contact_stiffness": "contact_stiffness",
    "interfacial_stiffness": "interfacial_stiffness",
    "energy": "energy",
    "approach_error": "approach_error",
}
PLASTIC = {"yielded_nodes": "yielded_nodes", "plastic_volume": "plastic_volume", "plastic_work": "plastic_work"}


def same(path: asp.LoadingPath, record: Path) -> Any:
    """Asserts that a path is the one of a record; gives the record."""
    history = path.run(check=False)
    stored = np.load(record)
    names = COLUMNS | (PLASTIC if history.has_hardness else {})
    for there, here in names.items():
        found = getattr(history, here)
        assert found.shape == stored[there].shape, here
        if found.dtype == np.float64:
            np.testing.assert_array_equal(found.view(np.int64), stored[there].view(np.int64), err_msg=here)
        else:
            np.testing.assert_array_equal(found, stored[there], err_msg=here)
    np.testing.assert_array_equal(path.pressure(), stored["pressure"].T)
    np.testing.assert_array_equal(path.gap(), stored["gap"].T)
    np.testing.assert_array_equal(path.surface.z, stored["heights"].T)
    np.testing.assert_array_equal(asp.patches(path).activation(), stored["activation"].T)
    four = asp.patches(path, connectivity=4)
    np.testing.assert_array_equal(four.number, stored["patches"])
    np.testing.assert_array_equal(four.largest, stored["largest_patch"])
    np.testing.assert_array_equal(four.perimeter, stored["perimeter"])
    opened = asp.open(record)
    assert opened.history == history and opened.end == path.end and opened.targets == path.targets
    return stored


CASES: dict[str, tuple[str, tuple[float, float], list[str], str, dict[str, Any]]] = {
    "free": ("selfaffine_48", (1e-2, 1e-2), ["--e-star", "1"], "free", {}),
    "periodic": ("periodic_32x24", (32 * 2e-5, 24 * 3e-5), ["--e-star", "1", "--periodic", "love"], "love", {}),
    "spectral": ("periodic_32x24", (32 * 2e-5, 24 * 3e-5), ["--e-star", "1", "--periodic", "spectral"], "spectral", {}),
    "along x": ("periodic_32x24", (32 * 2e-5, 24 * 3e-5), ["--e-star", "1", "--periodic", "x"], "x", {}),
    "along y": ("periodic_32x24", (32 * 2e-5, 24 * 3e-5), ["--e-star", "1", "--periodic", "y"], "y", {}),
    "without a factor": (
        "selfaffine_48",
        (1e-2, 1e-2),
        ["--e-star", "1", "--updater", "iterative"],
        "free",
        {"updater": "iterative"},
    ),
    "hand-over": (
        "selfaffine_48",
        (1e-2, 1e-2),
        ["--e-star", "1", "--memory-budget", "6000000"],
        "free",
        {"memory_budget": 6_000_000},
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_paths(case: str, program: Callable[..., str], tmp_path: Path) -> None:
    name, size, options, boundary, arguments = CASES[case]
    fraction = 1.0 if boundary != "free" else 0.4
    record = tmp_path / "path.npz"
    sides = ["--side", repr(size[0]), "--side-y", repr(size[1])]
    ends = ["--max-area-fraction", str(fraction), "--record", record, "--out", tmp_path / "out"]
    program("path", "--surface", DATA / f"{name}.npy", *sides, *options, *ends)
    half_space = asp.HalfSpace(1.0, boundary=boundary)
    path = asp.load_path(measured(name, size), half_space, area_fraction=fraction, check=False, **arguments)
    same(path, record)
    # Without a factor from the beginning, events are estimated.
    assert bool(path.history.approach_error.any()) == (case in ("without a factor", "hand-over"))
    if case == "hand-over":
        assert path.handed_over_at is not None and 50 < path.handed_over_at < 900
    else:
        assert path.handed_over_at is None


def test_the_first_command(program: Callable[..., str], tmp_path: Path) -> None:
    """The generated surface, of steel, smaller."""
    record = tmp_path / "path.npz"
    program("path", "--nodes", 64, "--max-area-fraction", 0.1, "--record", record, "--out", tmp_path / "out")
    steel = asp.HalfSpace(asp.composite_modulus("steel"), boundary="free")
    same(asp.load_path(asp.example_surface(nodes=64), steel, area_fraction=0.1), record)


def test_yielding(program: Callable[..., str], tmp_path: Path) -> None:
    record = tmp_path / "path.npz"
    options = ["--nodes", 64, "--max-area-fraction", 0.2, "--hardness", "250HB", "--unload"]
    program("path", *options, "--record", record, "--out", tmp_path / "out")
    steel = asp.HalfSpace(asp.composite_modulus("steel"), boundary="free")
    hard = asp.hardness(250, "HB")
    path = asp.load_path(asp.example_surface(nodes=64), steel, area_fraction=0.2, hardness=hard)
    stored = same(path, record)
    np.testing.assert_array_equal(path.plastic_depth(), stored["plastic_depth"].T)
    # The way back.
    table = np.genfromtxt(tmp_path / "out" / "unloading.csv", delimiter=",", names=True)
    back = path.unload().columns()
    names = {"contact_area_fraction": "area_fraction", "elastic_energy": "energy"}
    for name in table.dtype.names:
        np.testing.assert_array_equal(back[names.get(name, name)], table[name], err_msg=name)
    left = np.load(tmp_path / "out" / "residual_surface.npy")
    np.testing.assert_array_equal(path.residual_surface().z, left.T)


def test_single_loads(program: Callable[..., str], tmp_path: Path) -> None:
    """The same solution: the program asks for the stiffness after the pressure."""
    arguments = ["--side", "1e-2", "--e-star", "1", "--load", "1e-7", "--save", tmp_path, "--out", tmp_path / "out", "--json"]
    line = program("load", "--surface", DATA / "selfaffine_48.npy", *arguments)
    told = json.loads(line)["states"][0]
    surface = measured("selfaffine_48", (1e-2, 1e-2))
    one = asp.solve(surface, asp.HalfSpace(1.0, boundary="free"), load=1e-7, check=False)
    np.testing.assert_array_equal(one.pressure, np.load(tmp_path / "pressure_100nN.npy").T)
    np.testing.assert_array_equal(one.gap, np.load(tmp_path / "gap_100nN.npy").T)
    names = {"contact_area_fraction": "area_fraction", "corrected_contact_area": "corrected_area"}
    for name, number in told.items():
        if name not in ("at", "iterations", "seconds"):
            assert getattr(one, names.get(name, name)) == number, name
    assert one.effort.iterations == told["iterations"]


def test_a_record_of_python_goes_on_in_the_program(program: Callable[..., str], tmp_path: Path) -> None:
    steel = asp.HalfSpace(asp.composite_modulus("steel"), boundary="free")
    path = asp.load_path(asp.example_surface(nodes=32), steel, area_fraction=0.3)
    path.run(check=False)
    path.save(tmp_path / "path.npz")
    program("path", "--resume", tmp_path / "path.npz", "--max-area-fraction", "0.5", "--out", tmp_path / "out")
    on = asp.open(tmp_path / "path.npz")
    assert len(on.history) == 512
    path.continue_to(area_fraction=0.5)
    straight = path.run(check=False)
    np.testing.assert_array_equal(on.history.row, straight.row)
    np.testing.assert_allclose(on.history.load, straight.load, rtol=1e-9)
    program("patches", tmp_path / "path.npz", "--out", tmp_path / "patches")


@pytest.mark.parametrize("options", [[], ["--hardness", "1GPa"]])
def test_scalars_of_the_object(program: Callable[..., str], tmp_path: Path, options: list[str]) -> None:
    """The scalars of `asperity path --json`, at its end and at a load on the way, are those of the record."""
    record = tmp_path / "path.npz"
    asked = ["path", "--nodes", "32", "--max-area-fraction", "0.2", "--at", "20N", "--json", *options]
    told = json.loads(program(*asked, "--record", record, "--out", tmp_path))
    opened = asp.open(record)
    names = {name: name for name in told["at"][0].keys() & set(dir(opened.history[-1]))}
    names |= {"contact_area_fraction": "area_fraction"}
    assert len(names) == 15, sorted(names)
    for numbers, state in [(told, opened.history[-1]), (told["at"][0], opened.history.at(load=20.0))]:
        for there, here in names.items():
            # Without a hardness nothing has yielded: null there, and 0 here.
            found = 0.0 if numbers[there] is None else numbers[there]
            assert found == getattr(state, here), here
        corrected = opened.history.corrected_area if numbers is told else None
        if corrected is not None and np.isfinite(corrected[-1]):
            assert numbers["corrected_contact_area"] == corrected[-1]
