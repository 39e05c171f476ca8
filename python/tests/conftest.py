"""What the tests share."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import asperity as asp

REPOSITORY = Path(__file__).resolve().parents[2]
DATA = REPOSITORY / "tests" / "data"

# What is small in SI units is compared with itself alone.
setattr(type(pytest.approx(1.0)), "DEFAULT_ABSOLUTE_TOLERANCE", 0.0)


def measured(name: str, size: tuple[float, float]) -> asp.Surface:
    """A surface of the tests of the library, whose arrays are [ix, iy]."""
    return asp.Surface(np.load(DATA / f"{name}.npy").T, size=size)


@pytest.fixture(scope="session", autouse=True)
def interrupts() -> None:
    """Ctrl-C interrupts, also where a shell that runs the tests in the background has it ignored."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def free_surface() -> asp.Surface:
    """48 x 48 nodes on a side of 10 mm."""
    return measured("selfaffine_48", (1e-2, 1e-2))


@pytest.fixture(scope="session")
def periodic_surface() -> asp.Surface:
    """24 rows and 32 columns with cells of 20 um x 30 um."""
    return measured("periodic_32x24", (32 * 2e-5, 24 * 3e-5))


@pytest.fixture(scope="session")
def unit_half_space() -> asp.HalfSpace:
    """E* = 1 Pa, as in the reference data."""
    return asp.HalfSpace(1.0, boundary="free")


@pytest.fixture(scope="session")
def program() -> Callable[..., str]:
    """Runs the program of the repository as it is now, built anew where it has changed: what it prints."""
    built = REPOSITORY / "target" / "release" / ("asperity.exe" if os.name == "nt" else "asperity")
    if shutil.which("cargo"):
        command = ["cargo", "build", "--release", "--locked", "--package", "asperity-cli"]
        subprocess.run(command, cwd=REPOSITORY, check=True)
    elif os.environ.get("CI"):
        pytest.fail("there is no cargo: the package would be compared with nothing, or with an older program")
    if not built.exists():
        pytest.skip("the program is not built: cargo build --release")

    def run(*arguments: object) -> str:
        command = [str(built), *map(str, arguments)]
        done = subprocess.run(command, check=True, capture_output=True, text=True, encoding="utf-8")
        return done.stdout

    return run


@pytest.fixture
def rough() -> asp.Surface:
    """A surface on which a path takes a moment: 64 x 64 nodes."""
    return asp.example_surface(nodes=64)


@pytest.fixture
def body() -> asp.HalfSpace:
    """A body of steel and such, free."""
    return asp.HalfSpace(115e9, boundary="free")
