"""The columns of Python and of pickles of ``docs/features_together.md``: a path is that of the program, and what is pickled comes back."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import REPOSITORY
from test_same_as_program import same

import asperity as asp
from asperity import errors

NODES = 16
SIZE = (1e-2, 1e-2)
STEEL = asp.composite_modulus("steel")


def half_space(boundary: str = "free") -> asp.HalfSpace:
    return asp.HalfSpace(STEEL, boundary=boundary)  # type: ignore[arg-type]


def layered(layer: tuple[str, float] | tuple[float, float, float], base: str | tuple[float, float]) -> asp.HalfSpace:
    return asp.HalfSpace.layered([layer], base, "free")  # type: ignore[list-item, arg-type]


# Row of the page: options of the program, the body, and arguments of `load_path`.
ROWS: dict[str, tuple[list[object], Callable[[], asp.HalfSpace], dict[str, Any]]] = {
    "free": ([], half_space, {}),
    "periodic": (["--periodic", "love"], lambda: half_space("love"), {}),
    "periodic x": (["--periodic", "x"], lambda: half_space("x"), {}),
    "periodic y": (["--periodic", "y"], lambda: half_space("y"), {}),
    "non-square cells": (["--side", 1e-2, "--side-y", 1.5e-2], half_space, {}),
    "full contact": (["--periodic", "love"], lambda: half_space("love"), {"area_fraction": 1.0}),
    "hardness": (["--hardness", 3e9], half_space, {"hardness": 3e9}),
    # The program takes no map: here all nodes have one hardness, and `test_a_map_of_hardness` has others.
    "hardness per node": (["--hardness", 3e9], half_space, {"hardness": np.full((NODES, NODES), 3e9)}),
    "fully plastic": (["--hardness", 1e8], half_space, {"hardness": 1e8, "mean_pressure": 9.99999e7}),
    "after unloading": ([], half_space, {"mean_pressure": 1e8}),
    "sheet": (["--layer", "3e6,0.49,1e-3", "--base", "rigid"], lambda: layered((3e6, 0.49, 1e-3), "rigid"), {}),
    "soft layer": (["--layer", "gold,1e-4", "--base", "steel"], lambda: layered(("gold", 1e-4), "steel"), {}),
    "stiff layer": (["--layer", "steel,6e-4", "--base", "3e9,0.3"], lambda: layered(("steel", 6e-4), (3e9, 0.3)), {}),
    "without a factor": (["--updater", "iterative"], half_space, {"updater": "iterative"}),
    "resumed": ([], half_space, {}),
}
ENDS = {"area_fraction": "--max-area-fraction", "mean_pressure": "--mean-pressure"}


def page() -> tuple[list[str], dict[str, list[str]]]:
    """The columns of the table, and the cells of each row."""
    text = (REPOSITORY / "docs" / "features_together.md").read_text(encoding="utf-8")
    lines = text[text.index("| path |") :].split("\n\n")[0].splitlines()
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return cells[0][1:], {row[0]: row[1:] for row in cells[2:]}


def test_the_page_has_these_rows() -> None:
    columns, rows = page()
    assert list(rows) == [*ROWS, "adhesion"]
    for column in ("Python", "pickles"):
        assert {cells[columns.index(column)] for cells in rows.values()} == {"yes"}


def surface(row: str, arguments: dict[str, Any]) -> asp.Surface:
    z = asp.example_surface(nodes=NODES)
    if row == "non-square cells":
        z = asp.self_affine(
            (NODES, NODES), (1e-2, 1.5e-2), hurst=0.8, rolloff=2.5e-3, short_cutoff=2.5e-3, rms_height=5e-5, seed=1
        )
    if row == "after unloading":
        first = asp.load_path(z, half_space(), hardness=1e9, check=False, **arguments)
        first.run(check=False)
        z = first.residual_surface()
    return z


def followed(row: str, **more: Any) -> asp.LoadingPath:
    _, body, arguments = ROWS[row]
    ends = {name: value for name, value in arguments.items() if name in ENDS} or {"area_fraction": 0.3}
    z = surface(row, ends)
    path = asp.load_path(z, body(), check=False, **(arguments | ends | more))
    path.run(check=False)
    return path


@pytest.mark.parametrize("row", ROWS)
def test_python(row: str, program: Callable[..., str], tmp_path: Path) -> None:
    options, body, arguments = ROWS[row]
    ends = {name: value for name, value in arguments.items() if name in ENDS} or {"area_fraction": 0.3}
    z = surface(row, ends)
    record = tmp_path / "path.npz"
    # The program reads the same heights, with [ix, iy] in a file of NumPy.
    np.save(tmp_path / "z.npy", z.z.T)
    where = [] if "--side" in options else ["--side", SIZE[0]]
    steel = [] if "--layer" in options else ["--material", "steel"]
    end = [word for name, value in ends.items() for word in (ENDS[name], repr(value))]
    given = ["--surface", tmp_path / "z.npy", *where, *steel, *options, *end, "--record", record, "--out", tmp_path / "out"]
    program("path", *given)
    path = followed(row)
    if row == "resumed":
        # Interrupted, saved, and continued.
        half = asp.load_path(z, body(), check=False, **ends)
        for _, _ in zip(range(20), half, strict=False):
            pass
        half.save(tmp_path / "half.npz")
        path = asp.open(tmp_path / "half.npz")
        path.continue_to(**ends)
    if row == "stiff layer":
        history = path.run(check=False)
        assert "release" in set(history.event)
        assert asp.open(record).history == history and history.contact_nodes[-1] > 50
        np.testing.assert_array_equal(path.pressure(), np.load(record)["pressure"].T)
        with pytest.raises(errors.AsperityError, match="leaves"):
            asp.patches(path)
    else:
        same(path, record)
    if row == "fully plastic":
        # Behind full contact of what is left unloading begins all the same.
        back, last = path.unload().columns(), path.history[-1]
        assert last.yielded_nodes > 0.9 * NODES**2
        assert back["load"][0] == pytest.approx(last.load, rel=1e-10)
        assert back["approach"][0] == pytest.approx(last.approach, rel=1e-10)


def test_a_map_of_hardness(program: Callable[..., str], tmp_path: Path) -> None:
    """The program goes on with the map of a record from Python, along the path of Python; a map that is turned round is another one."""
    rows, columns = np.indices((NODES, NODES))
    hard = np.where((rows + 2 * columns) % 3 == 0, np.inf, 2e9 * (1.5 + np.sin(rows)))
    found = followed("hardness per node", hardness=hard)
    history = found.history
    # The pressure that a node bears is at most its own hardness, and many bear that, each the one of its place.
    pressure = found.pressure()
    assert history.yielded_nodes[-1] > 5 and (pressure <= hard).all()
    assert (pressure == hard).sum() == history.yielded_nodes[-1]
    half = asp.load_path(found.surface, half_space(), hardness=hard, area_fraction=0.1, check=False)
    half.run(check=False)
    half.save(tmp_path / "half.npz")
    ends = ["--max-area-fraction", 0.3, "--record", tmp_path / "whole.npz", "--out", tmp_path / "out"]
    program("path", "--resume", tmp_path / "half.npz", *ends)
    whole = np.load(tmp_path / "whole.npz")
    for name, column in {"ix": history.column, "iy": history.row, "event": history.event_code, "yielded_nodes": history.yielded_nodes}.items():
        np.testing.assert_array_equal(whole[name], column, err_msg=name)
    # Ten digits are promised of a path that was interrupted. Mean gaps are small differences of the first one.
    for name in ("load", "approach", "plastic_volume", "plastic_work"):
        np.testing.assert_allclose(whole[name], getattr(history, name), rtol=1e-10, atol=1e-14 * abs(whole[name]).max(), err_msg=name)
    np.testing.assert_allclose(whole["pressure"].T, pressure, atol=1e-9 * pressure.max())
    # With the surface turned round as well it is the same path, and alone it is not.
    for z, is_same in ((found.surface.transpose(), True), (found.surface, False)):
        turned = asp.load_path(z, half_space(), hardness=hard.T, area_fraction=0.3, check=False)
        turned.run(check=False)
        if is_same:
            np.testing.assert_allclose(turned.history.load, history.load, rtol=1e-10)
            np.testing.assert_allclose(turned.pressure(), pressure.T, atol=1e-9 * pressure.max())
        else:
            assert turned.history.load[-1] != pytest.approx(history.load[-1], rel=1e-3)


def answers(of: asp.LoadingPath | asp.History) -> list[object]:
    """What follows from states alone, or why not."""
    found: list[object] = []
    prony = asp.Prony.shares([(1.0, 0.5)])
    history = of if isinstance(of, asp.History) else of.history
    load = history.load[-1]
    for ask in (
        lambda: asp.patches(of).number,
        lambda: asp.shear(of, friction=0.3, compliance_ratio=1.2).cycle(0.1 * load).dissipation,
        lambda: asp.creep(of, prony, [0.0, 0.0], load=[0.0, 0.2 * load]).at([0.0, 3.0])["approach"],
        lambda: asp.interface_table(of).text("csv"),
        lambda: asp.interface_table(of, friction=0.3, compliance_ratio=1.2).text("csv"),
        lambda: asp.conductance(of, 0.04, e_star=1e11),
    ):
        try:
            found.append(ask())
        except errors.AsperityError as refused:
            found.append((type(refused), str(refused)))
    return found


def test_adhesion(program: Callable[..., str], tmp_path: Path) -> None:
    """The row of another type of path: Python, pickles, and what it cannot be given."""
    columns, rows = page()
    cells = dict(zip(columns, rows["adhesion"], strict=True))
    z, record = asp.example_surface(nodes=NODES), tmp_path / "path.npz"
    np.save(tmp_path / "z.npy", z.z.T)
    given = ["--surface", tmp_path / "z.npy", "--side", SIZE[0], "--material", "steel", "--work-of-adhesion", 1000]
    program("path", *given, "--max-area-fraction", 0.3, "--unload", "--record", record, "--out", tmp_path / "out")
    path = asp.load_path(z, half_space(), adhesion=asp.Adhesion(1000.0), area_fraction=0.3, check=False)
    path.run()
    path.unload()
    np.testing.assert_array_equal(path.states.load, np.load(record)["load"])
    assert asp.open(record).states == path.states == pickle.loads(pickle.dumps(path.states))
    for name, ask in {
        "patches": lambda: asp.patches(path),  # type: ignore[call-overload]
        "slip": lambda: asp.shear(path, friction=0.3, compliance_ratio=1.2),  # type: ignore[arg-type]
        "conductance": lambda: asp.conductance(path, 0.04, e_star=1e11),  # type: ignore[arg-type]
    }.items():
        assert cells[name] == "e"
        with pytest.raises((TypeError, errors.AsperityError)):
            ask()


@pytest.mark.parametrize("row", ROWS)
def test_pickles(row: str) -> None:
    path = followed(row)
    history = pickle.loads(pickle.dumps(path.history))
    assert history == path.history
    for name, column in path.history.columns().items():
        np.testing.assert_array_equal(history.columns()[name], column)
    state = pickle.loads(pickle.dumps(path.state))
    np.testing.assert_array_equal(path.pressure(state), path.pressure())
    # Also what is refused.
    for found, expected in zip(answers(history), answers(path.history), strict=True):
        np.testing.assert_array_equal(np.asarray(found, dtype=object), np.asarray(expected, dtype=object))
    # The body too, and single loads.
    body = pickle.loads(pickle.dumps(ROWS[row][1]()))
    hardness = ROWS[row][2].get("hardness")
    one, other = (
        asp.solve(path.surface, of, load=0.5 * path.state.load, hardness=hardness, check=False)
        for of in (body, ROWS[row][1]())
    )
    np.testing.assert_array_equal(one.pressure, other.pressure)
    again = pickle.loads(pickle.dumps(one))
    np.testing.assert_array_equal(again.pressure, one.pressure)
    assert again.certificate == one.certificate


@pytest.mark.parametrize("row", ROWS)
def test_what_is_refused_is_what_the_page_says(row: str) -> None:
    columns, rows = page()
    cells = dict(zip(columns, rows[row], strict=True))
    path = followed(row)
    patches, slip, creep, plain, table, conductance = answers(path)
    if cells["unload"] == "yes":
        assert path.unload().columns()["load"][0] == pytest.approx(path.state.load, rel=1e-10)
    else:
        with pytest.raises(ValueError, match="goes back through the same states"):
            path.unload()
    assert isinstance(plain, str) or row == "stiff layer"
    for name, found in {"patches": patches, "slip": slip, "creep": creep, "FE table": table, "conductance": conductance}.items():
        is_refused = isinstance(found, tuple)
        assert is_refused == (cells[name] != "yes"), (name, found)
    if cells["slip"] == "a":
        assert "residual surface" in slip[1] and "residual surface" in creep[1]  # type: ignore[index]
        # The way that the page names.
        left = asp.load_path(path.residual_surface(), ROWS[row][1](), load=0.99 * path.state.load, check=False)
        left.run(check=False)
        assert all(not isinstance(found, tuple) for found in answers(left))
