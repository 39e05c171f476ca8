"""Conductance, and laws of the interface for finite elements."""

from __future__ import annotations

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
    stiffness = history.contact_stiffness
    found = asp.conductance(path, 0.05)
    np.testing.assert_allclose(found, 2.0 * stiffness / (0.05 * 115e9), rtol=1e-12)
    np.testing.assert_array_equal(asp.conductance(history, 0.05, e_star=115e9), found)
    np.testing.assert_array_equal(asp.conductance(path, 0.05, carrier="current"), found)
    alone = asp.conductance(path, 0.05, interface=True)
    np.testing.assert_allclose(alone, 2.0 * history.interfacial_stiffness / (0.05 * 115e9), rtol=1e-12)
    filled = asp.conductance(path, 0.05, gap=(0.025, 1e-6))
    assert (filled[np.isfinite(filled)] >= found[np.isfinite(filled)]).all()
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


def test_tables(path: asp.LoadingPath) -> None:
    history = path.history
    table = asp.interface_table(path, resistivity=0.05, friction=0.3, compliance_ratio=1.2, tolerance=0.01)
    columns = table.columns()
    assert list(columns) == ["pressure", "overclosure", "conductance", "tangential_stiffness", "slip_limit"]
    assert len(table) == len(columns["pressure"]) < len(history) // 4
    np.testing.assert_allclose(columns["slip_limit"], 0.3 * columns["pressure"], rtol=1e-12)
    # Linear interpolation is as near as was asked for.
    area = np.prod(path.surface.size)
    whole = asp.conductance(path, 0.05, interface=True) / area
    pressure = history.load / area
    inside = (pressure > columns["pressure"][1]) & np.isfinite(whole)
    between = np.interp(pressure[inside], columns["pressure"], columns["conductance"])
    np.testing.assert_allclose(between, whole[inside], rtol=0.0101)
    assert list(asp.interface_table(history).columns()) == ["pressure", "overclosure"]
    for program in ("abaqus", "calculix", "moose", "csv"):
        assert len(table.text(program).splitlines()) > len(table) // 2  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="program"):
        table.text("ansys")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="together"):
        asp.interface_table(path, friction=0.3)
