"""What Python costs: `python python/tests/overhead.py`, on a machine that does nothing else.

Prints the time of the first command's path by the program and here, alternating, and what a state costs in a loop of Python.
"""

from __future__ import annotations

import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import asperity as asp

REPOSITORY = Path(__file__).resolve().parents[2]
ROUNDS = 5


def of_the_program(nodes: int) -> float:
    """Seconds that the program says the path took: its table is written meanwhile, some milliseconds."""
    with tempfile.TemporaryDirectory() as folder:
        command = [str(REPOSITORY / "target/release/asperity"), "path", "--nodes", str(nodes), "--out", folder]
        told = subprocess.run(command, check=True, capture_output=True, text=True, encoding="utf-8").stdout
    found = re.search(r"states in ([0-9.]+) (ms|s)", told)
    assert found, told
    return float(found[1]) * (1e-3 if found[2] == "ms" else 1.0)


def path(nodes: int) -> asp.LoadingPath:
    """The same path, before its first state."""
    body = asp.HalfSpace(asp.composite_modulus("steel"), boundary="free")
    return asp.load_path(asp.example_surface(nodes), body, area_fraction=0.1)


def of_python(nodes: int) -> float:
    """Seconds of `run`."""
    begun = path(nodes)
    start = time.perf_counter()
    begun.run(check=False)
    return time.perf_counter() - start


def of_states() -> float:
    """Seconds that a state costs in a loop besides computing: of a path whose states are all there, as near as can be."""
    whole, one_by_one = [], []
    for _ in range(ROUNDS):
        whole.append(of_python(96))
        begun = path(96)
        start = time.perf_counter()
        for _ in begun:
            pass
        one_by_one.append(time.perf_counter() - start)
    return (min(one_by_one) - min(whole)) / len(begun.history)


def main() -> None:
    nodes = int(sys.argv[1]) if len(sys.argv) > 1 else 256
    ratios = []
    for turn in range(ROUNDS):
        program, python = of_the_program(nodes), of_python(nodes)
        ratios.append(python / program)
        print(f"{turn + 1}: program {program:.3f} s, Python {python:.3f} s, ratio {ratios[-1]:.3f}")
    print(f"median ratio {statistics.median(ratios):.3f}")
    print(f"a state in a loop: {1e6 * of_states():.2f} us besides computing")


if __name__ == "__main__":
    main()
