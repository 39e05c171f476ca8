"""Conductance, and laws of the interface for finite elements."""

from __future__ import annotations

import pickle
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import asperity as asp
from asperity import errors


@pytest.fixture(scope="module")
def path() -> asp.LoadingPath:
    path = asp.load_path(asp.example_surface(nodes=48), asp.HalfSpace(115e9, boundary="love"), area_fraction=0.5)
    path.run(check=False)
    return path


def test_conductance(path: asp.LoadingPath) -> None:
    history = path.history
    found = asp.conductance(path, 0.05)
    # A periodic half-space has no contact stiffness: 1/R = 2 K_i / (rho E*), to rounding.
    np.testing.assert_allclose(found, 2.0 * history.interfacial_stiffness / (0.05 * 115e9), rtol=1e-14)
    free = asp.load_path(asp.example_surface(nodes=32), asp.HalfSpace(115e9, boundary="free"), area_fraction=0.2)
    stiffness = free.run(check=False).contact_stiffness
    np.testing.assert_allclose(asp.conductance(free, 0.05), 2.0 * stiffness / (0.05 * 115e9), rtol=1e-14)
    # Of a row the approach is counted from where one likes: as on a periodic half-space, also from a pickle.
    row = asp.load_path(asp.example_surface(nodes=32), asp.HalfSpace(115e9, boundary="x"), area_fraction=0.2)
    row.run(check=False)
    for of, step in ((row, 1), (pickle.loads(pickle.dumps(row.history)), 1), (row.history[::2], 2)):
        stiffness = row.history.interfacial_stiffness[::step]
        found_of_row = asp.conductance(of, 0.05, e_star=115e9)
        np.testing.assert_allclose(found_of_row, 2.0 * stiffness / (0.05 * 115e9), rtol=1e-14)
    alone = asp.conductance(free, 0.05, interface=True)
    np.testing.assert_allclose(alone, 2.0 * free.history.interfacial_stiffness / (0.05 * 115e9), rtol=1e-14)
    np.testing.assert_array_equal(asp.conductance(history, 0.05, e_star=115e9), found)
    np.testing.assert_array_equal(asp.conductance(path, 0.05, carrier="current"), found)
    # The gap in parallel: k times the open area over its mean gap and the jump distance.
    filled = asp.conductance(path, 0.05, gap=(0.025, 1e-6))
    open_share = 1.0 - history.area_fraction
    through = 0.025 * open_share * np.prod(path.size) / (history.mean_gap / open_share + 1e-6)
    np.testing.assert_allclose(filled - found, through, atol=1e-13 * filled.max())
    with pytest.raises(ValueError, match="e_star"):
        asp.conductance(history, 0.05)
    with pytest.raises(errors.AsperityError):
        asp.conductance(path, -1.0)


def test_bounds(path: asp.LoadingPath) -> None:
    lower, upper = asp.conductance_bounds(path, 0.05, 1e-7)
    found = asp.conductance(path, 0.05)
    assert lower.shape == upper.shape == found.shape
    known = np.isfinite(found)
    assert (lower[known] <= found[known] * (1 + 1e-12)).all() and (upper[known] >= found[known] * (1 - 1e-12)).all()


# What Abaqus and CalculiX have of one row: the stiffness, or the displacement at which it slips.
FRICTION = {"tangential_stiffness", "elastic_slip"}


def column_of(columns: dict[str, np.ndarray], name: str) -> np.ndarray:
    """A column of a table, or what follows from two of them."""
    return columns["slip_limit"] / columns["tangential_stiffness"] if name == "elastic_slip" else columns[name]


def read_back(program: str, text: str) -> dict[str, np.ndarray]:
    """The columns of a table as another program reads them: the numbers below each keyword, or of each function."""
    found: dict[str, np.ndarray] = {}
    if program == "csv":
        header, *lines = text.splitlines()
        rows = np.array([line.split(",") for line in lines], dtype=float)
        found = dict(zip(header.split(","), rows.T, strict=True))
    elif program == "moose":
        function = r"\[(\w+)_of_(\w+)\]\s+type = PiecewiseLinear\s+x = '([^']*)'\s+y = '([^']*)'"
        for name, of, x, y in re.findall(function, text):
            name = "thermal_conductance" if name == "conductance" else name
            for column, values in ((of, x), (name, y)):
                numbers = np.array(values.split(), dtype=float)
                np.testing.assert_array_equal(found.setdefault(column, numbers), numbers, err_msg=column)
    else:
        below: dict[str, list[list[float]]] = {}
        for line in text.splitlines():
            if line.startswith("*") and not line.startswith("**"):
                keyword, *options = line.split(",")
                rows_below = below.setdefault(keyword, [])
                for option in options:
                    if "ELASTIC SLIP" in option:
                        found["elastic_slip"] = np.array([float(option.split("=")[1])])
            elif not line.startswith("*"):
                rows_below.append([float(cell) for cell in line.split(",")])
        found["pressure"], found["overclosure"] = np.array(below["*SURFACE BEHAVIOR"]).T
        found["thermal_conductance"], pressure = np.array(below["*GAP CONDUCTANCE"]).T
        np.testing.assert_array_equal(pressure, found["pressure"])
        coefficient, *stiffness = below["*FRICTION"][0]
        assert coefficient == 0.3
        if stiffness:
            found["tangential_stiffness"] = np.array(stiffness)
    return found


def test_tables(path: asp.LoadingPath) -> None:
    history = path.history
    table = asp.interface_table(path, resistivity=0.05, friction=0.3, compliance_ratio=1.2, tolerance=0.01)
    columns = table.columns()
    assert list(columns) == ["pressure", "overclosure", "thermal_conductance", "tangential_stiffness", "slip_limit"]
    assert len(table) == len(columns["pressure"]) < len(history) // 4
    np.testing.assert_allclose(columns["slip_limit"], 0.3 * columns["pressure"], rtol=1e-12)
    # Linear interpolation is as near as was asked for.
    area = np.prod(path.surface.size)
    whole = asp.conductance(path, 0.05, interface=True) / area
    pressure = history.load / area
    inside = (pressure > columns["pressure"][1]) & np.isfinite(whole)
    between = np.interp(pressure[inside], columns["pressure"], columns["thermal_conductance"])
    np.testing.assert_allclose(between, whole[inside], rtol=0.0101)
    assert list(asp.interface_table(history).columns()) == ["pressure", "overclosure"]
    # Every row of every column is in the texts, with the twelve digits or so that they have.
    for program in ("abaqus", "calculix", "moose", "csv"):
        found = read_back(program, table.text(program))  # type: ignore[arg-type]
        assert {"pressure", "overclosure", "thermal_conductance"} < set(found), program
        for name, column in found.items():
            # Friction of Abaqus and CalculiX has the last row alone.
            expected = column_of(columns, name)[-len(column) :]
            assert len(column) == (1 if program in ("abaqus", "calculix") and name in FRICTION else len(table)), (program, name)
            np.testing.assert_allclose(column, expected, rtol=1e-11, err_msg=f"{program}: {name}")
        if program in ("moose", "csv"):
            assert set(found) == set(columns), program
        else:
            assert FRICTION & set(found), program
    with pytest.raises(ValueError, match="program"):
        table.text("ansys")  # type: ignore[arg-type]
    ratio = asp.shear(path, friction=0.3, bodies=("steel", "glass"), check=False).compliance_ratio
    of_bodies = asp.interface_table(path, friction=0.3, bodies=("steel", "glass"))
    assert of_bodies.text("csv") == asp.interface_table(path, friction=0.3, compliance_ratio=ratio).text("csv")
    for arguments in ({"friction": 0.3}, {"compliance_ratio": 1.0}, {"friction": 0.3, "compliance_ratio": 1.0, "bodies": ("steel", "rigid")}):
        with pytest.raises(ValueError, match="together"):
            asp.interface_table(path, **arguments)  # type: ignore[arg-type]
    # What nothing would be made of.
    for arguments in ({"gap": (0.026, 0.0)}, {"e_star": 1e11}, {"gap": (0.026, 0.0), "friction": 0.3, "compliance_ratio": 1.0}):
        with pytest.raises(errors.AsperityError, match="resistivity"):
            asp.interface_table(path, **arguments)  # type: ignore[arg-type]
    with pytest.raises(errors.AsperityError, match="carrier must be"):
        asp.interface_table(path, carrier="heta")  # type: ignore[arg-type]
    for hostile in (0.0, -1.0, np.nan, np.inf):
        for name in ("resistivity", "tolerance", "friction"):
            arguments = {"compliance_ratio": 1.0} if name == "friction" else {}
            with pytest.raises(errors.AsperityError):
                asp.interface_table(path, **{name: hostile}, **arguments)  # type: ignore[arg-type]
        with pytest.raises(errors.AsperityError):
            asp.conductance(path, hostile)
        with pytest.raises(errors.AsperityError):
            asp.conductance(history, 0.05, e_star=hostile)
    with pytest.raises(errors.AsperityError):
        asp.conductance_bounds(path, 0.05, -1e-7)
    with pytest.raises(ValueError, match="LoadingPath"):
        asp.conductance(np.ones(3), 0.05)  # type: ignore[arg-type]


def csv(file: Path) -> dict[str, np.ndarray]:
    """A table of the program: its numbers have all their digits."""
    table = np.genfromtxt(file, delimiter=",", names=True, dtype=None, encoding="utf-8")
    return {name: table[name] for name in table.dtype.names}


FILES = {"abaqus": "interface.inp", "calculix": "interface.inp", "moose": "interface.i", "csv": "interface.csv"}


@pytest.mark.parametrize("periodic", [False, True])
def test_the_joints_of_the_program(periodic: bool, program: Callable[..., str], tmp_path: Path) -> None:
    """path.csv, conductance.csv and the tables for finite elements, bit for bit."""
    options = ["--nodes", 48, "--max-area-fraction", 0.3, *(["--periodic", "love"] if periodic else [])]
    boundary = "love" if periodic else "free"
    steel = asp.HalfSpace(asp.composite_modulus("steel"), boundary=boundary)
    path = asp.load_path(asp.example_surface(nodes=48), steel, area_fraction=0.3)
    history = path.run(check=False)
    both = [*options, "--resistivity", "1.5e-7,2.7e-8", "--conductivity", "50,237", "--gap-conductivity", "0.026"]
    program("path", *both, "--jump-distance", "3.7e-7", "--unresolved-roughness", "1e-7", "--out", tmp_path)
    gap = (0.026, 3.7e-7)
    current = asp.conductance(path, 1.5e-7 + 2.7e-8, carrier="current")
    heat = asp.conductance(path, 1 / 50 + 1 / 237, gap=gap)
    table = csv(tmp_path / "path.csv")
    np.testing.assert_array_equal(current, table["electrical_conductance"])
    np.testing.assert_array_equal(heat, table["thermal_conductance"])
    for name in ("step", "load", "approach", "mean_gap", "interfacial_stiffness"):
        np.testing.assert_array_equal(getattr(history, name), table[name], err_msg=name)
    table = csv(tmp_path / "conductance.csv")
    bounds = {
        "electrical_conductance": asp.conductance_bounds(path, 1.5e-7 + 2.7e-8, 1e-7, carrier="current"),
        "thermal_conductance": asp.conductance_bounds(path, 1 / 50 + 1 / 237, 1e-7, gap=gap),
    }
    for name, (lower, upper) in bounds.items():
        np.testing.assert_array_equal(lower, table[f"{name}_lower"], err_msg=name)
        np.testing.assert_array_equal(upper, table[f"{name}_upper"], err_msg=name)
    laws = ["--conductivity", "50", "--friction", "0.2", "--compliance-ratio", "1.21", "--fe-error", "0.02"]
    made = asp.interface_table(path, resistivity=1 / 50, friction=0.2, compliance_ratio=1.21, tolerance=0.02)
    for kind, file in FILES.items():
        program("path", *options, *laws, "--fe-table", kind, "--out", tmp_path / kind)
        assert made.text(kind) == (tmp_path / kind / file).read_text(encoding="utf-8"), kind  # type: ignore[arg-type]


@pytest.mark.parametrize("against", ["rigid", "glass", (3e9, 0.45)])
def test_paths_that_know_their_bodies(against: str | tuple[float, float], program: Callable[..., str], tmp_path: Path) -> None:
    """A path of bodies, its record and that of the program have the same, and what is tangential takes them."""
    bodies = ("steel", against)
    half_space = asp.HalfSpace.of_bodies(bodies, boundary="free")  # type: ignore[arg-type]
    numbers = [(210e9, 0.3), *([] if against == "rigid" else [(70e9, 0.22) if against == "glass" else against])]
    assert half_space.bodies == numbers
    assert pickle.loads(pickle.dumps(half_space)).bodies == numbers
    path = asp.load_path(asp.example_surface(nodes=32), half_space, area_fraction=0.2, check=False)
    path.run(check=False)
    path.save(tmp_path / "python.npz")
    name = against if isinstance(against, str) else ",".join(map(repr, against))
    other = [] if against == "rigid" else ["--against", name]
    options = ["--nodes", 32, "--material", "steel", *other, "--max-area-fraction", 0.2]
    fe = ["--fe-table", "csv", "--friction", 0.25]
    program("path", *options, *fe, "--record", tmp_path / "program.npz", "--out", tmp_path / "out")
    told = (tmp_path / "out" / "interface.csv").read_text(encoding="utf-8")
    # kappa = E*/G*, 1/G* = sum (2 - nu) / (4 G), G = E / (2 (1 + nu)).
    compliance = sum((2.0 - nu) * (1.0 + nu) / (2.0 * e) for e, nu in numbers)
    ratio = half_space.e_star * compliance
    for known in (path, asp.open(tmp_path / "python.npz"), asp.open(tmp_path / "program.npz")):
        assert known.bodies == numbers and known.e_star == half_space.e_star
        joint = asp.shear(known, friction=0.25, check=False)
        assert joint.compliance_ratio == pytest.approx(ratio, rel=1e-14)
        given = asp.shear(known, friction=0.25, bodies=bodies, check=False)  # type: ignore[arg-type]
        assert joint.monotone(0.5 * joint.sliding_load) == given.monotone(0.5 * joint.sliding_load)
        assert asp.interface_table(known, friction=0.25).text("csv") == told
        # Others may be given in their place.
        assert asp.shear(known, friction=0.25, compliance_ratio=1.5).compliance_ratio == 1.5
        assert asp.interface_table(known, friction=0.25, compliance_ratio=1.5).text("csv") != told
        with pytest.warns(errors.AsperityWarning, match="these bodies have"):
            asp.shear(known, friction=0.25, bodies=("copper", "copper"))
        # A history knows its states alone.
        with pytest.raises(errors.AsperityError, match="bodies"):
            asp.shear(known.history, friction=0.25)
        with pytest.raises(ValueError, match="together"):
            asp.interface_table(known.history, friction=0.25)
    # A record of Python tells the program.
    program("slip", tmp_path / "python.npz", "--friction", 0.25, "--out", tmp_path / "slip")
    on = asp.open(tmp_path / "python.npz")
    on.continue_to(area_fraction=0.3)
    on.run(check=False)
    on.save(tmp_path / "python.npz")
    assert asp.open(tmp_path / "python.npz").bodies == numbers


def test_bodies_that_are_none() -> None:
    assert asp.HalfSpace(1e9, boundary="free").bodies == []
    assert asp.HalfSpace.layered([("gold", 1e-6)], "steel", "free").bodies == []
    for bodies in (("rigid", "steel"), ("unobtainium", "rigid"), ((-1.0, 0.3), "rigid"), ((1e9, 0.6), "rigid"), ("steel",), "steel"):
        with pytest.raises((errors.AsperityError, TypeError, ValueError)):
            asp.HalfSpace.of_bodies(bodies, boundary="free")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="boundary"):
        asp.HalfSpace.of_bodies(("steel", "rigid"), boundary="periodic")  # type: ignore[arg-type]


@pytest.mark.parametrize("periodic", [False, True])
def test_joints_that_yield(periodic: bool, program: Callable[..., str], tmp_path: Path) -> None:
    """All nodes in contact conduct, as where unloading begins; the same numbers as in the files of the program, bit for bit."""
    options = ["--nodes", 32, "--mean-pressure", 5e8, "--hardness", 2e9, *(["--periodic", "love"] if periodic else [])]
    e_star = asp.composite_modulus("steel")
    steel = asp.HalfSpace(e_star, boundary="love" if periodic else "free")
    path = asp.load_path(asp.example_surface(nodes=32), steel, mean_pressure=5e8, hardness=2e9)
    history = path.run(check=False)
    assert history.yielded_nodes[-1] > 100
    found = asp.conductance(path, 0.04)
    back = path.unload().columns()
    stiffness = back["interfacial_stiffness" if periodic else "contact_stiffness"][0]
    # Two factors of condition numbers of 1e3.
    assert found[-1] == pytest.approx(2.0 * stiffness / (0.04 * e_star), rel=1e-10)
    assert (np.diff(found) >= 0.0).all() and found[0] > 0.0
    program("path", *options, "--conductivity", "50,50", "--out", tmp_path)
    np.testing.assert_array_equal(found, csv(tmp_path / "path.csv")["thermal_conductance"])
    laws = ["--conductivity", "50,50", "--friction", "0.2", "--compliance-ratio", "1.21"]
    made = asp.interface_table(path, resistivity=0.04, friction=0.2, compliance_ratio=1.21)
    program("path", *options, *laws, "--fe-table", "csv", "--out", tmp_path)
    assert made.text("csv") == (tmp_path / "interface.csv").read_text(encoding="utf-8")
    columns = made.columns()
    whole = asp.conductance(path, 0.04, interface=True) / np.prod(path.size)
    assert columns["thermal_conductance"][-1] == pytest.approx(whole[-1], rel=1e-12)
    # A history has no influence matrix to take it from.
    with pytest.raises(errors.AsperityError, match="needs the path"):
        asp.conductance(history, 0.04, e_star=e_star)
    with pytest.raises(errors.AsperityError, match="residual"):
        asp.conductance_bounds(path, 0.04, 1e-8)
