"""Docstrings: NumPy style, for everything that is public; their examples run."""

from __future__ import annotations

import doctest
import inspect
import pydoc
import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import asperity as asp
from asperity import _asperity, errors, results

REPOSITORY = Path(__file__).resolve().parents[2]
# Pages whose Python runs, and how many pieces of it there are at least.
PAGES = {
    "README.md": 1,
    "python/README.md": 4,
    "docs/python.md": 4,
    "docs/from_file_to_contact.md": 1,
    "docs/metals_that_yield.md": 1,
    "docs/seals_that_leak.md": 1,
    "docs/joints.md": 1,
    "docs/joints_that_slip.md": 1,
    "docs/stress_below_the_surface.md": 1,
    "docs/rubber_that_creeps.md": 1,
    "docs/coated_and_thin_bodies.md": 1,
    "docs/many_surfaces.md": 1,
}
# What takes long there is done on less here.
SMALLER = {"docs/many_surfaces.md": {"256, seed": "32, seed", "range(1, 201)": "range(1, 5)"}}


def public() -> Iterator[tuple[str, object]]:
    """Names and objects: functions, classes, and what classes have."""
    for module in (asp, errors, results):
        for name in module.__all__:
            found = getattr(module, name)
            if inspect.ismodule(found) or name in ("EVENTS", "__version__"):
                continue
            yield name, found
            if inspect.isclass(found) and found.__module__ == "asperity":
                for member, value in vars(found).items():
                    if not member.startswith("_"):
                        yield f"{name}.{member}", getattr(found, member)


EVERYTHING = dict(public())


def test_there_is_everything() -> None:
    assert len(EVERYTHING) > 180
    assert {"Surface.level", "LoadingPath.run", "solve", "patches", "History.load", "Certificate"} <= EVERYTHING.keys()


@pytest.mark.parametrize("name", sorted(EVERYTHING))
def test_docstrings(name: str) -> None:
    found = EVERYTHING[name]
    doc = inspect.getdoc(found)
    assert doc and len(doc.split()) >= 3, name
    # A first line that ends, unless it goes on.
    first = doc.split("\n\n")[0]
    assert first.rstrip().endswith((".", ":", "]", "``.")), first
    if not callable(found) or inspect.isclass(found):
        return
    signature = inspect.signature(found)
    names = [p for p in signature.parameters if p not in ("self", "slf")]
    if names:
        section = re.search(r"Parameters\n-+\n(.*?)(\n\n\w+\n-+\n|\Z)", doc, re.DOTALL)
        assert section, f"{name} has no section of parameters"
        told = {n.strip() for line in re.findall(r"^(\S[^:\n]*?)(?: :.*)?$", section[1], re.MULTILINE) for n in line.split(",")}
        assert set(names) <= told, f"{name}: {set(names) - told}"


def test_help_is_worth_reading() -> None:
    text = pydoc.render_doc(asp, renderer=pydoc.plaintext)
    for words in ["[row, column]", "load_path", "HalfSpace", "Conventions", "LinearUpdater"]:
        assert words in text
    for function in [asp.load_path, asp.solve]:
        text = pydoc.render_doc(function, renderer=pydoc.plaintext)
        assert "mean_pressure" in text and "Parameters" in text
    assert "end=None" not in pydoc.render_doc(asp.HalfSpace, renderer=pydoc.plaintext)


@pytest.mark.parametrize("name", ["asperity", *sorted(n for n, f in EVERYTHING.items() if ">>>" in (inspect.getdoc(f) or ""))])
@pytest.mark.filterwarnings("ignore::asperity.AsperityWarning")
def test_examples(name: str) -> None:
    found = asp if name == "asperity" else EVERYTHING[name]
    doc = inspect.getdoc(found)
    assert doc
    examples = doctest.DocTestParser().get_doctest(doc, {}, name, None, None)
    assert examples.examples
    result = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(examples)
    assert result.failed == 0


@pytest.mark.filterwarnings("ignore::asperity.AsperityWarning")
@pytest.mark.parametrize("page", PAGES)
def test_pages(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Their Python runs, from the beginning to the end."""
    monkeypatch.chdir(tmp_path)
    # A format is known by its content.
    for name in ["ground.x3p", "ground.sdf"]:
        asp.example_surface(nodes=64).save("ground.x3p")
        (tmp_path / name).write_bytes((tmp_path / "ground.x3p").read_bytes())
    # The first page reads a surface of the repository, in its folder.
    (tmp_path / "tests/data").mkdir(parents=True)
    shutil.copy(REPOSITORY / "tests/data/selfaffine_128.npy", tmp_path / "tests/data")
    blocks = re.findall(r"```python\n(.*?)```", (REPOSITORY / page).read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) >= PAGES[page]
    scope: dict[str, object] = {}
    for block in blocks:
        for much, little in SMALLER.get(page, {}).items():
            assert much in block
            block = block.replace(much, little)
        exec(compile(block, page, "exec"), scope)


def test_every_option_of_the_program_has_its_call(program: Callable[..., str]) -> None:
    text = (REPOSITORY / "docs/python.md").read_text(encoding="utf-8")
    table = text[text.index("## What is what in the program") : text.index("## Long paths")]
    commands = re.findall(r"^  ([a-z]+) ", program("--help").split("Commands:")[1].split("Options:")[0], re.MULTILINE)
    assert {"path", "load", "info", "gather", "patches", "leak", "slip", "creep"} <= set(commands)
    for command in commands:
        assert f"`{command}" in table, command
        # What only a command line asks for.
        options = set(re.findall(r"--[a-z][a-z-]+", program(command, "-h"))) - {"--help", "--quiet", "--dry-run"}
        left_out = {option for option in options if not re.search(rf"{option}\b(?!-)", table)}
        # `gather` is a loop in Python.
        assert left_out <= ({"--loads"} if command == "gather" else set()), f"{command}: {left_out}"


def test_the_version_is_that_of_the_workspace() -> None:
    manifest = (REPOSITORY / "Cargo.toml").read_text(encoding="utf-8")
    assert f'version = "{asp.__version__}"' in manifest
    assert _asperity.__version__ == asp.__version__
