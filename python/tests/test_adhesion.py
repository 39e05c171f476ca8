"""Surfaces that stick: both branches are those of the program, and are pickled, saved and turned around."""

from __future__ import annotations

import pickle
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import asperity as asp
from asperity import errors

SIDE = 1e-4
SOFT = asp.HalfSpace(1e6, boundary="free")
STICKY = asp.Adhesion(0.05)


@pytest.fixture(scope="module")
def surface() -> asp.Surface:
    return asp.self_affine(
        (32, 32), SIDE, hurst=0.8, rolloff=SIDE / 2, short_cutoff=SIDE / 4, rms_height=2e-6, seed=1
    )


def pressed(surface: asp.Surface, **more: float) -> asp.AdhesivePath:
    path = asp.load_path(surface, SOFT, adhesion=STICKY, mean_pressure=100.0, check=False, **more)  # type: ignore[call-overload]
    assert isinstance(path, asp.AdhesivePath)
    return path


def test_both_branches_are_those_of_the_program(surface: asp.Surface, program: Callable[..., str], tmp_path: Path) -> None:
    np.save(tmp_path / "z.npy", surface.z.T)
    record = tmp_path / "both.npz"
    given = ["--surface", tmp_path / "z.npy", "--side", SIDE, "--e-star", 1e6, "--work-of-adhesion", 0.05]
    program("path", *given, "--mean-pressure", 100, "--unload", "--record", record, "--out", tmp_path / "out")
    stored = np.load(record)
    path = pressed(surface)
    loading = path.run()
    pressure, gap = path.pressure(), path.gap()
    unloading = path.unload()
    columns = path.states.columns()
    assert all(hasattr(path.states[-1], name) for name in columns)
    assert len(path.states) == len(loading) + len(unloading) == len(stored["load"])
    names = {"ix": "column", "iy": "row", "contact_area_fraction": "area_fraction", "energy": "elastic_energy"}
    for name in (
        *("step", "ix", "iy", "contact_nodes", "soft_nodes", "cohesive_nodes", "approach", "load", "contact_area"),
        *("contact_area_fraction", "mean_gap", "contact_stiffness", "interfacial_stiffness", "energy"),
        *("adhesive_energy", "dissipated", "work"),
    ):
        np.testing.assert_array_equal(columns[names.get(name, name)], stored[name], err_msg=name)
    events = np.array(["near", "pull", "touch", "part", "soften", "far", "jump_start", "jump_end", "limit"])
    np.testing.assert_array_equal(columns["event"], events[stored["event"]])
    np.testing.assert_array_equal(columns["branch"] == "unloading", stored["branch"] == 1)
    np.testing.assert_array_equal(pressure, stored["pressure"].T)
    np.testing.assert_array_equal(gap, stored["gap"].T)
    # What was written here is what was written there.
    path.save(tmp_path / "again.npz")
    again = np.load(tmp_path / "again.npz")
    for name in set(again.files) - {"parameters"}:
        np.testing.assert_array_equal(again[name], stored[name], err_msg=name)
    opened = asp.open(record)
    assert opened.states == path.states and opened.e_star == path.e_star == 1e6


def test_the_law_has_what_it_was_made_of() -> None:
    """The work of adhesion, and what else it was given."""
    law = asp.Adhesion(0.05, cohesive_stress=2e5)
    assert (law.work_of_adhesion, law.adhesion_range, law.cohesive_stress) == (0.05, None, 2e5)
    assert STICKY.work_of_adhesion == 0.05 and STICKY != asp.Adhesion(0.1)
    for wrong in (-0.05, float("nan"), float("inf")):
        with pytest.raises(errors.AsperityError, match="work of adhesion"):
            asp.Adhesion(wrong)


def test_forces_and_loops(surface: asp.Surface) -> None:
    path = pressed(surface)
    assert path.state is None and path.end is None and path.shape == (32, 32) and path.size == (SIDE, SIDE)
    first = next(path)
    assert (first.event, first.branch, first.load) == ("near", "loading", 0.0)
    loading = path.run()
    peak = path.state
    assert peak is not None and path.end == "target"
    assert peak.mean_pressure == pytest.approx(100.0, rel=1e-14)
    assert peak.work == pytest.approx(peak.elastic_energy + peak.adhesive_energy + peak.dissipated, rel=1e-9)
    assert path.contact_map().sum() == peak.contact_nodes
    assert path.pulled_map().sum() == peak.soft_nodes + peak.cohesive_nodes
    assert (path.pressure()[path.contact_map()] < 0).any()
    # A loop within the path restores its state.
    back = path.unload(load=-1e-6)
    assert back[-1].load == pytest.approx(-1e-6, rel=1e-12) and back[-1].branch == "unloading"
    again = path.load_to(load=peak.load)[-1]
    assert again.contact_nodes == peak.contact_nodes and again.approach == pytest.approx(peak.approach, rel=1e-9)
    # A mean pressure is a load over the nominal area, here too.
    assert path.unload(mean_pressure=-1e-6 / SIDE**2)[-1].load == pytest.approx(-1e-6, rel=1e-12)
    assert path.load_to(mean_pressure=100.0)[-1].mean_pressure == pytest.approx(100.0, rel=1e-12)
    with pytest.raises(errors.AsperityError, match="same quantity"):
        path.load_to(load=1.0, mean_pressure=100.0)
    off = path.unload()
    assert off.pull_off == -off.load.min() > loading.pull_off > 0
    assert off[-1].load == 0 == off[-1].contact_nodes and off.jumps > 0 and off.energy_lost > 0
    assert path.states[-1].dissipated == pytest.approx(path.states.energy_lost)
    at = off.approach_at(-0.5 * off.pull_off)
    assert at is not None and off.load_at(at) == pytest.approx(-0.5 * off.pull_off, rel=1e-12)
    assert off.load_at(1.0) is None
    for beyond in [len(off), -len(off) - 1, 10**30]:
        with pytest.raises(IndexError):
            off[beyond]


def test_pickles_and_records(surface: asp.Surface, tmp_path: Path) -> None:
    path = pressed(surface)
    branch = path.run()
    for one in (branch, branch[-1], branch[0], STICKY, asp.Adhesion(1.0, adhesion_range=2.0, cohesive_stress=0.7)):
        again = pickle.loads(pickle.dumps(one))
        assert again == one and repr(again) == repr(one)
    path.save(tmp_path / "on.npz")
    opened = asp.open(tmp_path / "on.npz")
    np.testing.assert_array_equal(opened.pressure(), path.pressure())
    state = branch[len(branch) // 2]
    np.testing.assert_array_equal(opened.gap(state), path.gap(state))
    # To rounding: windows begin elsewhere.
    one, other = opened.unload(), path.unload()
    assert one.pull_off == pytest.approx(other.pull_off, rel=1e-10) and len(one) == len(other)


def test_a_record_goes_on_to_its_end(surface: asp.Surface, tmp_path: Path) -> None:
    """Opened where it was left, a path goes on to where its branch was to end: from its beginning too."""
    path = pressed(surface)
    whole = path.run()
    for count in (0, 5):
        begun = pressed(surface)
        for _ in range(count):
            next(begun)
        begun.save(tmp_path / "begun.npz")
        again = asp.open(tmp_path / "begun.npz")
        assert isinstance(again, asp.AdhesivePath) and again.end is None
        again.run()
        assert (again.end, len(again.states)) == ("target", len(whole))
        np.testing.assert_allclose(again.states.load, whole.load, atol=1e-9 * np.abs(whole.load).max())
    path.save(tmp_path / "whole.npz")
    ended = asp.open(tmp_path / "whole.npz")
    assert ended.end == "target" and [state.step for state in path.states] == list(range(1, len(whole) + 1))


def test_what_is_refused(surface: asp.Surface, tmp_path: Path) -> None:
    refused: list[tuple[dict[str, object], str]] = [
        ({"hardness": 1e9}, "not derived"),
        ({"updater": "iterative"}, "factor"),
        ({"rule": "approximate-order"}, "exact order"),
        ({"nodes": 5}, "area_fraction"),
    ]
    for arguments, words in refused:
        with pytest.raises(errors.AsperityError, match=words):
            asp.load_path(surface, SOFT, adhesion=STICKY, **arguments)  # type: ignore[call-overload]
    with pytest.raises(errors.AsperityError) as steep:
        asp.load_path(surface, SOFT, adhesion=asp.Adhesion(0.05, adhesion_range=1e-9))
    assert steep.value.kind == "AdhesionUnresolved" and steep.value.cell_needed < SIDE / 32
    with pytest.raises(errors.AsperityError, match="work of adhesion"):
        asp.Adhesion(-1.0)
    for name in ("adhesion_range", "cohesive_stress"):
        for hostile in (-1.0, 0.0, np.nan):
            with pytest.raises(errors.AsperityError) as wrong:
                asp.Adhesion(0.05, **{name: hostile})
            assert wrong.value.kind == "NotPositive"
    stiff = asp.HalfSpace.layered([("steel", 6e-6)], (3e9, 0.3), "free")
    with pytest.raises(errors.AsperityError) as unknown:
        asp.load_path(surface, stiff, adhesion=STICKY, check=False)
    assert unknown.value.kind == "GrowthUnknown"
    path = pressed(surface)
    with pytest.raises(errors.AsperityError, match="no states"):
        path.pressure()
    path.run()
    with pytest.raises(errors.AsperityError) as behind:
        path.unload(load=1.0)
    assert behind.value.kind == "Behind" and behind.value.present == path.state.load  # type: ignore[union-attr]
    with pytest.raises(errors.AsperityError, match="needs a LoadingPath"):
        asp.patches(path)  # type: ignore[arg-type]
    for follow in (asp.report, lambda path: asp.stress(path, 0.3)):
        with pytest.raises(errors.AsperityError, match="with adhesion"):
            follow(path)  # type: ignore[operator]
    path.save(tmp_path / "r.npz")
    for words, arguments in [
        ("takes a factor", {"updater": "iterative"}),
        ("knows its half-space", {"half_space": SOFT}),
        ("MB of memory|kB of memory", {"memory_budget": 10_000}),
    ]:
        with pytest.raises(errors.AsperityError, match=words):
            asp.open(tmp_path / "r.npz", **arguments)  # type: ignore[arg-type]
    assert asp.open(tmp_path / "r.npz", memory_budget=10**9).states == path.states
    with pytest.raises(errors.AsperityError):
        asp.open(tmp_path / "missing.npz")


def test_what_the_cells_do_not_resolve_is_said(surface: asp.Surface) -> None:
    with pytest.warns(errors.AsperityWarning, match="highest summit"):
        path = asp.load_path(surface, SOFT, adhesion=STICKY, mean_pressure=100.0)
    assert path.law["resolution"] == pytest.approx(0.45, rel=1e-12)
    short = asp.Adhesion(0.05, adhesion_range=0.87 * path.law["range"])
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        asp.load_path(surface, SOFT, adhesion=short, mean_pressure=100.0)
    assert any("snap one by one" in str(warning.message) for warning in said)
