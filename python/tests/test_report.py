"""The page of a path is the one that the program makes."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import measured

import asperity as asp


def data_of(page: str) -> dict[str, Any]:
    """What is in a page."""
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    data: dict[str, Any] = json.loads(found[1])
    return data


def path_of(*, hardness: float | None = None) -> asp.LoadingPath:
    surface = measured("selfaffine_48", (1e-2, 1e-2))
    path = asp.load_path(surface, asp.HalfSpace(1.0, boundary="free"), area_fraction=0.2, hardness=hardness, check=False)
    path.run(check=False)
    return path


@pytest.mark.parametrize("hardness", [None, 0.02])
def test_same_as_the_program(program: Callable[..., str], tmp_path: Path, hardness: float | None) -> None:
    path = path_of(hardness=hardness)
    record = tmp_path / "path.npz"
    path.save(record)
    program("report", record, "--out", tmp_path / "page.html")
    there = data_of((tmp_path / "page.html").read_text(encoding="utf-8"))["records"][0]
    # A record opened is replayed, as the program does it.
    here = data_of(asp.report(asp.open(record)).html)["records"][0]
    for name in ("name", "notes"):
        there.pop(name), here.pop(name)
    assert here == there
    # The path itself has the same events and the same scalars.
    live = data_of(asp.report(path).html)["records"][0]
    assert live["events"] == there["events"]


def test_notebooks_show_it_in_a_frame(tmp_path: Path) -> None:
    path = path_of()
    page = asp.report(path, name="</iframe><script>alert(1)</script>")
    frame = page._repr_html_()
    parts = re.fullmatch(r'(<iframe [^<>]*srcdoc=")([^"<>]*)"></iframe>', frame, re.DOTALL)
    assert parts is not None
    assert unescape(parts[2]) == page.html
    assert "allow-same-origin" not in parts[1]
    page.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == page.html
    assert data_of(page.html)["records"][0]["name"] == "</iframe><script>alert(1)</script>"


def test_two_paths_and_tables(tmp_path: Path) -> None:
    (tmp_path / "slip.csv").write_text("tangential_load,displacement,slip_area\n0,0,0\n1,1e-6,1e-9\n")
    (tmp_path / "leak.csv").write_text("load,leak_rate\n1\n")
    page = asp.report(path_of(), path_of(hardness=0.02), name="elastic", other_name="yields", folder=tmp_path)
    first, second = data_of(page.html)["records"]
    assert (first["name"], second["name"]) == ("elastic", "yields")
    assert [panel["file"] for panel in first["panels"]] == ["slip.csv"] and second["panels"] == []
    assert page.notes == ["leak.csv is left out: line 2 has 1 columns and not 2"]


def test_units_are_those_of_the_program(program: Callable[..., str], tmp_path: Path) -> None:
    path = path_of()
    record = tmp_path / "path.npz"
    path.save(record)
    program("report", record, "--out", tmp_path / "page.html", "--units", "mm-N-MPa")
    there = data_of((tmp_path / "page.html").read_text(encoding="utf-8"))["units"]
    assert data_of(asp.report(path, units="mm-N-MPa").html)["units"] == there != data_of(asp.report(path).html)["units"]
    with pytest.raises(ValueError, match="'SI', 'mm-N-MPa'"):
        asp.report(path, units="inch")  # type: ignore[arg-type]


def test_a_path_without_states_has_no_page() -> None:
    surface = asp.example_surface(nodes=16)
    path = asp.load_path(surface, asp.HalfSpace(1e9, boundary="free"), check=False)
    with pytest.raises(asp.AsperityError, match="number of states"):
        asp.report(path)


def test_own_kernels_have_fields() -> None:
    surface = asp.example_surface(nodes=16)
    body = asp.HalfSpace.from_symbol(lambda qx, qy: 2.0 / (1e9 * np.maximum(np.hypot(qx, qy), 1.0)), growth="monotone")
    path = asp.load_path(surface, body, area_fraction=0.1, check=False)
    path.run(check=False)
    page = asp.report(path)
    assert page.notes == []
    assert len(data_of(page.html)["records"][0]["fields"]["states"]) > 3
