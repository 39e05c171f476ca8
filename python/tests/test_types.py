"""Stubs beside the module, and mypy on what users write."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

GALLERY = Path(__file__).resolve().parents[1] / "gallery"
pytest.importorskip("mypy")

# The example of the package's page.
EXAMPLE = """
import numpy as np
import asperity as asp

surface = asp.example_surface(nodes=64)
body = asp.HalfSpace(asp.composite_modulus((210e9, 0.3), (70e9, 0.33)), boundary="free")
path = asp.load_path(surface, body, mean_pressure=5e6)
for state in path:
    load: float = state.load
history = path.run(progress=lambda done, state: print(done, state.step))
state = history.at(load=120.0)
total: np.float64 = path.pressure(state).sum()
one = asp.solve(surface, body, load=250.0)
gaps = [solution.mean_gap for solution in asp.sweep(surface, body, [1.0, 2.0])]
if (seal := asp.patches(path, connectivity=8).percolation().seal_x) is not None:
    print(seal.load)
reveal_type(path.contact_map())
"""

WRONG = """
import asperity as asp

asp.HalfSpace(1e9, boundary="periodic")
asp.solve(asp.example_surface(), 1e9, load=1.0)
asp.load_path(asp.example_surface(), asp.HalfSpace(1e9, "free"), pressure=1.0)
asp.example_surface().level("cubic")
"""


def mypy(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "mypy", "--strict", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_the_example_passes_mypy_strict(tmp_path: Path) -> None:
    (tmp_path / "example.py").write_text(EXAMPLE)
    done = mypy(tmp_path / "example.py", "--cache-dir", tmp_path)
    assert done.returncode == 0, done.stdout
    assert "numpy.bool" in done.stdout, done.stdout


def test_mistakes_are_found(tmp_path: Path) -> None:
    (tmp_path / "wrong.py").write_text(WRONG)
    done = mypy(tmp_path / "wrong.py", "--cache-dir", tmp_path)
    # `load_path` has two types, with adhesion and without: a wrong argument is said twice.
    assert "Found 5 errors" in done.stdout, done.stdout


def test_the_gallery_passes_mypy_strict(tmp_path: Path) -> None:
    # tamaas has no types, and matplotlib some.
    options = ["--cache-dir", tmp_path, "--ignore-missing-imports"]
    done = mypy(*sorted(GALLERY.glob("*.py")), *options)
    assert done.returncode == 0, done.stdout


def test_stubs_are_those_of_the_module(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "mypy.stubtest", "asperity", "--ignore-disjoint-bases"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
