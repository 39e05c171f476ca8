"""What the scripts of the gallery share: where pictures go, and how they look."""

from __future__ import annotations

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.figure import Figure

# From dark to bright, and two lines that differ in print too.
BLUE, ORANGE, GREY = "#1f4e8c", "#d9730d", "#8a8a8a"

plt.rcParams.update(
    {
        "figure.dpi": 100,
        "figure.constrained_layout.use": True,
        "font.size": 9,
        "axes.grid": True,
        "grid.alpha": 0.3,
        "axes.axisbelow": True,
    }
)


def output(name: str) -> Path:
    """The picture of a script, in the folder of ``--out``."""
    parser = argparse.ArgumentParser(description=f"draws {name}")
    parser.add_argument("--out", type=Path, default=Path(), help="folder of the picture [default: the current one]")
    folder: Path = parser.parse_args().out
    folder.mkdir(parents=True, exist_ok=True)
    return folder / name


def save(figure: Figure, path: Path) -> None:
    """Writes a picture and says so."""
    figure.savefig(path)
    plt.close(figure)
    print(f"wrote {path}")
