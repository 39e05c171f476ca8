"""Each script of the gallery runs, and draws its picture."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

GALLERY = Path(__file__).resolve().parents[1] / "gallery"
SCRIPTS = sorted(script.name for script in GALLERY.glob("*.py") if not script.name.startswith("_"))


def test_there_are_six() -> None:
    assert len(SCRIPTS) == 6


@pytest.mark.parametrize("name", SCRIPTS)
def test_scripts(name: str, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    if name == "beside_tamaas.py":
        pytest.importorskip("tamaas")
    command = [sys.executable, "-W", "error::asperity.AsperityWarning", str(GALLERY / name), "--out", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    (picture,) = tmp_path.glob("*.png")
    assert picture.name == f"python_{name.removesuffix('.py')}.png" and picture.stat().st_size < 150_000
    assert f"wrote {picture}" in done.stdout


def test_pictures_are_drawn_where_a_script_is_called(tmp_path: Path) -> None:
    """Under a plain name, unless a folder is given; and the figure that it prints is that of the page."""
    pytest.importorskip("matplotlib")
    command = [sys.executable, str(GALLERY / "contact_resistance.py")]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["python_contact_resistance.png"]
    page = (GALLERY.parents[1] / "docs" / "joints.md").read_text(encoding="utf-8")
    printed = done.stdout.split("at 10 N: ")[1].split(" mΩ")[0]
    assert f"| 10 N | {printed} mΩ |" in page
