"""The loading path: its states, its ends, its fields."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import DATA

import asperity as asp


def truth(name: str) -> dict[str, np.ndarray]:
    """A table of events that another solver has made."""
    with (DATA / name).open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}


def test_the_path_of_another_solver(free_surface: asp.Surface, unit_half_space: asp.HalfSpace) -> None:
    """Every event of a dense solution, in row and column: 48 x 48 nodes on a free half-space."""
    known = truth("selfaffine_48_events.csv")
    nodes = len(known["step"])
    path = asp.load_path(free_surface, unit_half_space, nodes=nodes, check=False)
    history = path.run(check=False)
    assert path.end == "nodes" and len(history) == nodes
    np.testing.assert_array_equal(history.column, known["ix"])
    np.testing.assert_array_equal(history.row, known["iy"])
    np.testing.assert_array_equal(history.step, known["step"])
    # Of the greatest: the dense solver loses some digits of small loads by cancellation.
    for name in ["load", "approach", "mean_gap", "contact_stiffness", "interfacial_stiffness"]:
        scale = np.abs(known[name]).max()
        np.testing.assert_allclose(getattr(history, name), known[name], rtol=1e-9, atol=1e-11 * scale, err_msg=name)
    assert path.pressure().max() == pytest.approx(known["max_pressure"][-1], rel=1e-9)
    assert set(history.event.tolist()) == {"touch"}


@pytest.mark.parametrize("boundary", ["love", "spectral"])
def test_the_path_of_another_solver_on_a_periodic_half_space(periodic_surface: asp.Surface, boundary: str) -> None:
    known = truth(f"periodic_32x24_{boundary}_events.csv")
    path = asp.load_path(periodic_surface, asp.HalfSpace(1.0, boundary=boundary), check=False)
    history = path.run(check=False)
    assert path.end == "full contact" and len(history) == 768
    np.testing.assert_array_equal(history.column, known["ix"])
    np.testing.assert_array_equal(history.row, known["iy"])
    scale = known["load"].max()
    np.testing.assert_allclose(history.load, known["load"], rtol=1e-9, atol=1e-11 * scale)
    assert np.isnan(history.contact_stiffness).all()
    assert np.isinf(history.interfacial_stiffness[-1]) and history.mean_gap[-1] == 0.0


def test_states_come_one_by_one(rough: asp.Surface, body: asp.HalfSpace) -> None:
    whole = asp.load_path(rough, body, area_fraction=0.1).run(check=False)
    path = asp.load_path(rough, body, area_fraction=0.1)
    assert (path.state, path.end, len(path.history)) == (None, None, 0)
    with pytest.raises(asp.AsperityError, match="run"):
        path.pressure()
    first = next(path)
    assert (first.step, first.event, first.load, first.approach) == (1, "touch", 0.0, 0.0)
    assert path.state == first == whole[0] and len(path.history) == 1
    some = [next(path) for _ in range(99)]
    assert [state.step for state in some] == list(range(2, 101))
    # The rest at once: the history begins with first touch all the same.
    rest = path.run(check=False)
    assert rest == whole == path.history and path.end == "area fraction"
    assert list(path) == [] and next(path, None) is None
    assert whole[-1] == path.state and whole[99] == some[-1]
    assert [state.load for state in whole][:5] == whole.load[:5].tolist()
    for beyond in [len(whole), -len(whole) - 1, 10**30]:
        with pytest.raises(IndexError):
            whole[beyond]
    assert whole.area_fraction[-1] <= 0.1
    np.testing.assert_allclose(whole.corrected_area[-1], whole.contact_area[-1], rtol=0.2)


@pytest.mark.parametrize(
    ("target", "column", "end"),
    [
        ({"load": 300.0}, "load", "load"),
        ({"mean_pressure": 5e6}, "mean_pressure", "load"),
        ({"approach": 2e-5}, "approach", "approach"),
        ({"mean_gap": 1.2e-4}, "mean_gap", "mean gap"),
    ],
)
def test_paths_end_at_exactly_what_is_asked_for(
    rough: asp.Surface, body: asp.HalfSpace, target: dict[str, float], column: str, end: str
) -> None:
    path = asp.load_path(rough, body, **target)
    history = path.run(check=False)
    ((_, value),) = target.items()
    assert path.end == end and history.event[-1] == "limit"
    # A mean pressure is a load over the area: divided and multiplied again.
    assert getattr(history, column)[-1] == pytest.approx(value, rel=0 if column != "mean_pressure" else 1e-15)
    ((name, found),) = path.targets.items()
    assert found == pytest.approx(value * (rough.area if name == "load" and column != "load" else 1.0))
    # And go on from there: the limit is no event.
    path.continue_to(area_fraction=0.3)
    on = path.run(check=False)
    assert "limit" not in on.event and path.end == "area fraction"
    assert on == asp.load_path(rough, body, area_fraction=0.3).run(check=False)
    with pytest.raises(asp.AsperityError) as behind:
        path.continue_to(load=1.0)
    assert behind.value.kind == "OutOfRange" and behind.value.value == 1.0


def test_a_history_is_read_at_any_instant(rough: asp.Surface, body: asp.HalfSpace) -> None:
    path = asp.load_path(rough, body, area_fraction=0.2)
    history = path.run(check=False)
    state = history.at(load=120.0)
    assert state.load == 120.0
    pressure, gap, contact = path.pressure(state), path.gap(state), path.contact_map(state)
    cell = rough.area / rough.z.size
    # Rounding of a sum over some hundred nodes.
    assert pressure.sum() * cell == pytest.approx(120.0, rel=1e-12)
    assert contact.sum() == state.contact_nodes and np.all(pressure[~contact] == 0.0)
    assert np.abs(gap[contact]).max() < 1e-12 * state.approach and gap[~contact].min() > 0.0
    np.testing.assert_allclose(path.displacement(state) - gap, state.approach + rough.z - rough.z.max(), atol=1e-15)
    for target in [{"mean_pressure": 1e6}, {"approach": 1e-5}, {"mean_gap": history.mean_gap[50]}]:
        found = history.at(**target)
        ((name, value),) = target.items()
        assert getattr(found, name) == pytest.approx(value, rel=1e-15)
    assert history.at(area_fraction=0.05).contact_nodes == int(0.05 * 4096)
    for wrong in [{"load": -1.0}, {"load": 1e9}, {"load": np.nan}, {"approach": 1.0}, {"area_fraction": 0.9}]:
        with pytest.raises(asp.AsperityError) as refused:
            history.at(**wrong)
        assert refused.value.kind == "OutOfRange"
    with pytest.raises(asp.AsperityError, match="one of"):
        history.at()
    with pytest.raises(asp.AsperityError, match="one of"):
        history.at(load=1.0, approach=1.0)
    certificate = path.certificate(state)
    # Rounding of solutions with some hundred nodes.
    assert certificate.least_pressure > -1e-9 and abs(certificate.load_error) < 1e-12
    assert certificate.greatest_contact_gap < 1e-12 and certificate.excess_pressure is None
    assert path.certificate() == path.certificate(path.state)


def test_states_of_other_paths_are_refused(rough: asp.Surface, body: asp.HalfSpace) -> None:
    path = asp.load_path(rough, body, area_fraction=0.05)
    history = path.run(check=False)
    other = asp.load_path(rough.flip("x"), asp.HalfSpace(1e9, boundary="free"), area_fraction=0.05, check=False)
    other.run(check=False)
    with pytest.raises(asp.AsperityError) as refused:
        other.pressure(history[100])
    assert refused.value.kind == "NotOnPath" and refused.value.step == 101
    early = asp.load_path(rough, body, area_fraction=0.05)
    next(early)
    with pytest.raises(asp.AsperityError) as ahead:
        early.pressure(history[100])
    assert ahead.value.kind == "StateNotReached" and (ahead.value.step, ahead.value.present) == (101, 1)


def test_maps_of_states_that_are_of_this_path(rough: asp.Surface, body: asp.HalfSpace) -> None:
    """Maps and patches of a state of another path are refused, and those of a state between two events are not."""
    path = asp.load_path(rough, body, area_fraction=0.1, check=False)
    history = path.run(check=False)
    other = asp.load_path(rough.scaled(1.5), body, area_fraction=0.1, check=False)
    foreign = other.run(check=False)[-5]
    analysis = asp.patches(path)
    for refused in (path.contact_map, path.yielded_map, path.pressure, analysis.at):
        with pytest.raises(asp.AsperityError) as out:
            refused(foreign)
        assert out.value.kind == "NotOnPath"
    for state in (history[0], history[7], history.at(load=0.37 * history.load[-1]), history[-1], path.state):
        assert state is not None
        assert path.contact_map(state).sum() == state.contact_nodes == (analysis.at(state).labels > 0).sum()
    # What comes later is in no analysis of before.
    path.continue_to(area_fraction=0.2)
    path.run(check=False)
    with pytest.raises(asp.AsperityError) as out:
        analysis.at(path.state)
    assert out.value.kind == "StateNotReached"


def test_arguments_that_make_no_sense(rough: asp.Surface, body: asp.HalfSpace) -> None:
    for arguments, kind in [
        ({"load": -1.0}, "NotPositive"),
        ({"load": float("nan")}, "NotPositive"),
        ({"mean_pressure": 0.0}, "NotPositive"),
        ({"area_fraction": 1.5}, "OutOfRange"),
        ({"area_fraction": 1e-9}, "LessThanOneNode"),
        ({"mean_gap": 1.0}, "OutOfRange"),
        ({"nodes": 0}, "OutOfRange"),
        ({"window_size": 0}, "OutOfRange"),
        ({"hardness": -1.0}, "NotPositive"),
        ({"hardness": np.ones((3, 3))}, "GridMismatch"),
        ({"memory_budget": 1000}, "MemoryBudget"),
        ({"load": 1.0, "mean_pressure": 1.0}, "Arguments"),
        ({"updater": "lu"}, "Arguments"),
        ({"rule": "any"}, "Arguments"),
    ]:
        with pytest.raises(asp.AsperityError) as refused:
            asp.load_path(rough, body, **arguments)
        assert refused.value.kind == kind, arguments
    for arguments in [{"load": "1"}, {"hardness": "hard"}, {"memory_budget": 1.5}, {"nonsense": 1}]:
        with pytest.raises(TypeError):
            asp.load_path(rough, body, **arguments)
    with pytest.raises(asp.AsperityError, match="expected 64 rows x 64 columns, but found 2 x 3") as shape:
        asp.load_path(rough, body, hardness=np.ones((2, 3)))
    assert (shape.value.expected, shape.value.found) == ((64, 64), (2, 3))
    with pytest.raises(TypeError):
        asp.load_path(rough.z, body)
    for e_star, boundary in [(0.0, "free"), (-1.0, "love"), (float("nan"), "free"), (1e9, "periodic"), (1e9, "Free")]:
        with pytest.raises(asp.AsperityError):
            asp.HalfSpace(e_star, boundary=boundary)
    with pytest.raises(TypeError):
        asp.HalfSpace(1e9)  # type: ignore[call-arg]


def test_numbers_that_no_count_can_be(rough: asp.Surface, body: asp.HalfSpace) -> None:
    for value, call in [
        ("-1", lambda: asp.load_path(rough, body, nodes=-1)),
        ("-2", lambda: asp.load_path(rough, body, window_size=-2)),
        ("-3", lambda: asp.example_surface(-3)),
        (str(2**70), lambda: asp.example_surface(16, 2**70)),
        (r"\(-1, 48\)", lambda: rough.resample((-1, 48))),
        ("-4", lambda: asp.solve(rough, body, load=1.0, max_iterations=-4)),
        ("-5", lambda: asp.set_threads(-5)),
    ]:
        with pytest.raises(asp.AsperityError, match=f"from 0 to {2**64 - 1} here, but this is {value}(\n|$)"):
            call()


@pytest.mark.parametrize("body", [asp.HalfSpace(1e6, boundary="love"), asp.HalfSpace(1e6, boundary="free")])
def test_states_behind_full_contact(body: asp.HalfSpace, tmp_path: Path) -> None:
    """They have fields: of waves that are pressed flat, and of a flat punch, all in contact from the beginning."""
    is_flat = body.periodic is False
    surface = asp.wave(1e-6, (1e-3, 1e-3), (16, 16), 1e-3)
    if is_flat:
        surface = asp.Surface(np.zeros((16, 16)), 1e-3)
    path = asp.load_path(surface, body, check=False)
    history = path.run(check=False)
    assert path.end == "full contact" and history.contact_nodes[-1] == 256
    load = 1e-3 if is_flat else 2.0 * history.load[-1]
    behind = [history.at(load=load)]
    if is_flat:
        behind.append(history.at(approach=2.0 * behind[0].approach))
    path.save(tmp_path / "full.npz")
    opened = asp.open(tmp_path / "full.npz")
    for state in behind:
        assert path.pressure(state).mean() == pytest.approx(state.load / surface.area, rel=1e-9)
        assert opened.pressure(state).mean() == pytest.approx(state.load / surface.area, rel=1e-7)
        assert path.contact_map(state).all() and path.constriction("x", state) is None
        assert np.abs(path.gap(state)).max() < 1e-15
        assert len(asp.patches(path).at(state)) == 1
        assert asp.Seal(1e-3, 1e5, along="x").leak(path, state, check=False).leak_rate == 0.0
        assert asp.stress(path, 0.3, state=state).survey([1e-4]).depth.tolist() == [1e-4]
    # Those of another body are none of this path.
    other = asp.load_path(surface.scaled(1.5), asp.HalfSpace(2e6, boundary="free" if is_flat else "love"), check=False)
    other.run(check=False)
    with pytest.raises(asp.AsperityError) as foreign:
        other.pressure(behind[0])
    assert foreign.value.kind == "NotOnPath"


def test_memory_has_a_limit(rough: asp.Surface, body: asp.HalfSpace) -> None:
    path = asp.load_path(rough, body, updater="cholesky", memory_budget=8_000_000)
    with pytest.raises(MemoryError) as refused:
        path.run(check=False)
    assert isinstance(refused.value, asp.AsperityError) and refused.value.kind == "MemoryBudget"
    assert refused.value.needed > refused.value.budget == 8_000_000
    # What there was room for is there.
    assert len(path.history) > 100 and path.end == "memory" and path.nbytes <= 8_000_000
    with pytest.raises(asp.AsperityError) as over:
        path.continue_to(load=1e6)
    assert over.value.kind == "CannotContinue"


def test_warnings(rough: asp.Surface, body: asp.HalfSpace) -> None:
    with pytest.warns(asp.AsperityWarning, match="softer than rubber"):
        asp.load_path(rough, asp.HalfSpace(115.0, boundary="free"), nodes=3)
    with pytest.warns(asp.AsperityWarning, match="units"):
        asp.load_path(rough.scaled(1e3), body, nodes=3)
    with pytest.warns(asp.AsperityWarning, match="greatest pressure"):
        asp.load_path(rough, body, area_fraction=0.05).run()
    with pytest.warns(asp.AsperityWarning, match="greatest pressure"):
        asp.solve(rough, body, load=5000.0)
    # With a hardness no pressure is too high.
    soft = asp.load_path(rough, body, area_fraction=0.05, hardness=1e9)
    soft.run()
    # As errors they are raised: pytest is set up so.
    with pytest.raises(asp.AsperityWarning):
        asp.load_path(rough, asp.HalfSpace(115.0, boundary="free"))


def ball(nodes: int) -> asp.Surface:
    """A sphere of 10 mm over 1 mm x 1 mm."""
    x = ((np.arange(nodes) + 0.5) / nodes - 0.5) * 1e-3
    return asp.Surface(-(x**2 + x[:, None] ** 2) / 0.02, 1e-3)


def test_warnings_of_contacts() -> None:
    # Rubber, which bears any pressure.
    surface, free = ball(32), asp.HalfSpace(2.67e6, boundary="free")
    # A contact that is cut off at the border, by a path, a single load and a sweep.
    with pytest.warns(asp.AsperityWarning, match="border of the grid"):
        asp.load_path(surface, free, load=0.093).run()
    with pytest.warns(asp.AsperityWarning, match="border of the grid"):
        asp.solve(surface, free, load=0.093)
    with pytest.warns(asp.AsperityWarning, match="border of the grid"):
        list(asp.sweep(surface, free, load=[0.093]))
    # A few nodes.
    with pytest.warns(asp.AsperityWarning, match="not resolved"):
        asp.load_path(surface, free, nodes=12).run()
    with pytest.warns(asp.AsperityWarning, match="not resolved"):
        asp.solve(surface, free, load=1.2e-5)
    # None of a contact that is resolved.
    asp.load_path(surface, free, load=0.012).run()
    asp.solve(surface, free, load=0.012)
    # A flat surface touches all at once.
    with pytest.warns(asp.AsperityWarning, match="touch at the same height"):
        asp.load_path(asp.Surface(np.zeros((16, 16)), 1e-3), free, area_fraction=0.1).run()
    thin = asp.HalfSpace.layered([(3e6, 0.4, 20e-6)], "rigid", "free")
    with pytest.warns(asp.AsperityWarning, match="wider than the coat"):
        asp.load_path(surface, thin, load=1e-3)


def test_progress(rough: asp.Surface, body: asp.HalfSpace, capsys: pytest.CaptureFixture[str]) -> None:
    told: list[tuple[float, int]] = []
    path = asp.load_path(rough, body, area_fraction=0.5)
    path.run(progress=lambda done, state: told.append((done, state.step)), check=False)
    assert told[-1] == (1.0, 2048) and all(0.0 <= done <= 1.0 for done, _ in told)
    assert [done for done, _ in told] == sorted(done for done, _ in told)
    # The path may be asked meanwhile.
    path = asp.load_path(rough, body, area_fraction=0.3)
    seen: list[int] = []
    path.run(progress=lambda done, state: seen.append(len(path.history)), check=False)
    assert seen[-1] == len(path.history)
    # What a function raises ends the run, and the path goes on.
    path = asp.load_path(rough, body, area_fraction=0.5)

    def fails(done: float, state: asp.State) -> None:
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        path.run(progress=fails, check=False)
    assert 0 < len(path.history) <= 2048
    assert len(path.run(progress=False, check=False)) == 2048
    asp.load_path(rough, body, area_fraction=0.3).run(progress=True, check=False)
    assert "nodes" in capsys.readouterr().err


def test_progress_without_tqdm(rough: asp.Surface, body: asp.HalfSpace, monkeypatch: pytest.MonkeyPatch) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    history = asp.load_path(rough, body, area_fraction=0.3).run(progress=True, check=False)
    assert len(history) == 1228


def test_records(rough: asp.Surface, body: asp.HalfSpace, tmp_path: Path) -> None:
    path = asp.load_path(rough, body, area_fraction=0.1)
    history = path.run(check=False)
    path.save(tmp_path / "path.npz", fields=True)
    opened = asp.open(tmp_path / "path.npz")
    assert opened.history == history and opened.end == "area fraction"
    assert opened.targets == {"area_fraction": 0.1} and opened.e_star == 115e9
    assert opened.state == path.state and opened.shape == (64, 64)
    # A solution without a factor: to the tolerance of the iterations, relative to the greatest pressure.
    state = history.at(load=100.0)
    for found, exact in [(opened.pressure(state), path.pressure(state)), (opened.pressure(), path.pressure())]:
        assert np.abs(found - exact).max() < 1e-8 * exact.max()
    np.testing.assert_array_equal(opened.contact_map(), path.contact_map())
    assert opened.certificate().greatest_contact_gap < 1e-8
    stored = np.load(tmp_path / "path.npz")
    np.testing.assert_array_equal(stored["pressure"].T, path.pressure())
    # And on, as the path itself does: the same nodes, and states equal to rounding.
    opened.continue_to(area_fraction=0.15)
    path.continue_to(area_fraction=0.15)
    on, straight = opened.run(check=False), path.run(check=False)
    np.testing.assert_array_equal(on.row, straight.row)
    np.testing.assert_array_equal(on.column, straight.column)
    np.testing.assert_allclose(on.load, straight.load, rtol=1e-9)
    assert opened.end == path.end == "area fraction"
    opened.save(tmp_path / "on.npz")
    assert len(asp.open(tmp_path / "on.npz").history) == int(0.15 * 4096)
    rows, columns = path.contact_order()
    np.testing.assert_array_equal(rows, straight.row)
    np.testing.assert_array_equal(columns, straight.column)


def test_a_record_of_a_path_under_way_goes_on(rough: asp.Surface, body: asp.HalfSpace, tmp_path: Path) -> None:
    path = asp.load_path(rough, body, area_fraction=0.1)
    for _ in range(100):
        next(path)
    path.save(tmp_path / "begun.npz")
    opened = asp.open(tmp_path / "begun.npz")
    assert opened.end is None and len(opened.history) == 100
    assert next(opened).step == 101
    assert len(opened.run(check=False)) == 409 and opened.end == "area fraction"


def test_records_with_numbers_that_no_state_has(rough: asp.Surface, body: asp.HalfSpace, tmp_path: Path) -> None:
    path = asp.load_path(rough, body, nodes=30, check=False)
    path.run(check=False)
    path.save(tmp_path / "whole.npz")
    members = dict(np.load(tmp_path / "whole.npz"))
    load = members["load"].copy()
    load[20] = np.nan
    np.savez(tmp_path / "load.npz", **{**members, "load": load})
    with pytest.raises(asp.AsperityError, match="at step 21 the load is NaN") as refused:
        asp.open(tmp_path / "load.npz")
    assert (refused.value.kind, refused.value.step, refused.value.quantity) == ("RecordNotFinite", 21, "load")
    own = "Periodic" if body.periodic is True else "Free"
    parameters = str(members["parameters"]).replace(f'"boundary":"{own}"', '"boundary":"PeriodicX"')
    np.savez(tmp_path / "boundary.npz", **{**members, "parameters": np.array(parameters)})
    with pytest.raises(asp.AsperityError, match="its boundary is PeriodicX") as other:
        asp.open(tmp_path / "boundary.npz")
    assert (other.value.kind, other.value.expected, other.value.found) == ("WrongBoundary", own, "PeriodicX")


def test_files_that_are_no_records(tmp_path: Path, rough: asp.Surface, body: asp.HalfSpace) -> None:
    with pytest.raises(FileNotFoundError):
        asp.open(tmp_path / "nothing.npz")
    np.savez(tmp_path / "other.npz", x=np.zeros(3))
    with pytest.raises(OSError) as refused:
        asp.open(tmp_path / "other.npz")
    assert refused.value.kind == "BadFile"
    (tmp_path / "noise.npz").write_bytes(b"noise")
    with pytest.raises(asp.AsperityError):
        asp.open(tmp_path / "noise.npz")
    path = asp.load_path(rough, body, nodes=5)
    path.run(check=False)
    with pytest.raises(OSError):
        path.save(tmp_path / "no folder" / "path.npz")
    path.save(tmp_path / "path.npz")
    with pytest.raises(asp.AsperityError, match="knows its half-space"):
        asp.open(tmp_path / "path.npz", half_space=body)


def test_yielding_and_the_way_back(rough: asp.Surface, body: asp.HalfSpace) -> None:
    path = asp.load_path(rough, body, area_fraction=0.2, hardness=2.5e9)
    history = path.run()
    columns = history.columns()
    assert {"yielded_nodes", "yielded_area_fraction", "plastic_volume", "plastic_work"} <= columns.keys()
    attributes = columns.keys() & set(dir(history))
    assert attributes == columns.keys() - {"plastic_volume_per_load", "plastic_work_per_load"}
    for name in attributes:
        np.testing.assert_array_equal(columns[name], getattr(history, name), err_msg=name)
    for name in columns.keys() & set(dir(history[-1])):
        np.testing.assert_array_equal(columns[name][-1], getattr(history[-1], name), err_msg=name)
    np.testing.assert_array_equal(columns["yielded_area_fraction"], columns["yielded_nodes"] / rough.z.size)
    assert history.has_hardness and (history.event == "yield").sum() == history.yielded_nodes[-1] > 100
    yielded, pressure, depth = path.yielded_map(), path.pressure(), path.plastic_depth()
    assert yielded.sum() == history.yielded_nodes[-1]
    assert np.all(pressure[yielded] == 2.5e9) and pressure.max() == 2.5e9
    assert np.all(depth[~yielded] == 0.0)
    cell = rough.area / rough.z.size
    # Rounding of sums over some hundred nodes.
    assert depth.sum() * cell == pytest.approx(path.state.plastic_volume, rel=1e-9)
    assert path.state.plastic_work == pytest.approx(2.5e9 * path.state.plastic_volume, rel=1e-9)
    certificate = path.certificate()
    assert certificate.excess_pressure == pytest.approx(0.0, abs=1e-12)
    left = path.residual_surface()
    np.testing.assert_allclose(left.z, rough.z - rough.z.max() - depth, atol=1e-18)
    unloading = path.unload()
    back = unloading.columns()
    assert back["load"][0] == path.state.load and back["load"][-1] == 0.0
    assert np.all(np.diff(back["load"]) <= 0.0)
    # The first state is the last of the path.
    assert back["approach"][0] == pytest.approx(path.state.approach, rel=1e-9)
    assert back["energy"][0] == pytest.approx(unloading.energy_returned, rel=1e-6)
    assert back["approach"][-1] == pytest.approx(unloading.separation, abs=1e-18)
    assert unloading.energy_lost == path.state.plastic_work and unloading.surface == left
    assert unloading.reloading.load[-1] == path.state.load
    one = asp.solve(rough, body, load=path.state.load, hardness=2.5e9, tolerance=1e-10)
    np.testing.assert_array_equal(one.yielded_map, yielded)
    with pytest.raises(asp.AsperityError, match="hardness"):
        elastic = asp.load_path(rough, body, nodes=5)
        elastic.run(check=False)
        elastic.unload()


def test_the_way_back_with_the_updater_of_the_path(body: asp.HalfSpace, tmp_path: Path) -> None:
    """Of a live path and of one that was opened: the same states with a factor and without."""
    path = asp.load_path(asp.example_surface(nodes=32), body, area_fraction=0.2, hardness=2.5e9, updater="iterative", check=False)
    path.run(check=False)
    path.save(tmp_path / "path.npz")
    ways = [path, *(asp.open(tmp_path / "path.npz", updater=updater) for updater in ("iterative", "cholesky"))]
    loads = path.state.load * np.linspace(0.1, 0.9, 9)
    approaches = []
    for way in ways:
        back = way.unload().columns()
        assert back["load"][0] == path.state.load
        approaches.append(np.interp(loads, back["load"][::-1], back["approach"][::-1]))
    for found in approaches[1:]:
        np.testing.assert_allclose(found, approaches[0], rtol=1e-6)


def test_a_path_ends_where_all_nodes_have_yielded(body: asp.HalfSpace) -> None:
    surface = asp.example_surface(nodes=16, short_cutoff=2.5e-3)
    path = asp.load_path(surface, body, hardness=2e8, check=False)
    history = path.run(check=False)
    assert path.end == "fully plastic" and history.yielded_nodes[-1] == 256 == history.contact_nodes[-1]
    # H times the nominal area, the sum of so many cells.
    assert history.load[-1] == pytest.approx(2e8 * surface.area, rel=1e-12)


def test_slices_of_a_history(free_surface: asp.Surface, unit_half_space: asp.HalfSpace) -> None:
    history = asp.load_path(free_surface, unit_half_space, nodes=60, check=False).run(check=False)
    every = history[::4]
    assert isinstance(every, asp.History) and len(every) == 15 and every[1] == history[4]
    np.testing.assert_array_equal(every.load, history.load[::4])
    assert history[:] == history and len(history[70:]) == 0 and history[-3:][0] == history[57]
    with pytest.raises(ValueError, match="order"):
        history[::-1]
    with pytest.raises(TypeError, match="integer"):
        history["load"]  # type: ignore[call-overload]
    with pytest.raises(IndexError):
        history[60]
    # What follows nodes from state to state says so; what is made of increments takes fewer of them.
    with pytest.raises(asp.AsperityError, match="left out"):
        asp.patches(every)
    with pytest.raises(asp.AsperityError, match="2 to 4 are left out"):
        every.at(load=history.load[10])
    assert history[30:].at(load=history.load[40]) == history.at(load=history.load[40])
    assert np.isnan(every.corrected_area).all() and len(every.columns()["corrected_area"]) == 15
    np.testing.assert_array_equal(history[:30].corrected_area, history.corrected_area[:30])
    assert asp.patches(history[:30]).number.tolist() == asp.patches(history).number[:30].tolist()
    assert asp.shear(every, friction=0.3, compliance_ratio=1.0).sliding_load == pytest.approx(0.3 * every.load[-1])


def test_files_of_fields(free_surface: asp.Surface, unit_half_space: asp.HalfSpace, tmp_path: Path) -> None:
    path = asp.load_path(free_surface, unit_half_space, nodes=60, check=False)
    path.run(check=False)
    pressure, gap = path.pressure(), path.gap()
    asp.save_fields(tmp_path / "pressure.npy", {"pressure": pressure}, path.size)
    np.testing.assert_array_equal(np.load(tmp_path / "pressure.npy").T, pressure)
    asp.save_fields(tmp_path / "gap.gsf", {"gap": gap}, path.size, unit="m")
    # A file of Gwyddion has single precision.
    found = asp.read(tmp_path / "gap.gsf")
    np.testing.assert_allclose(found.z, gap, rtol=1e-6, atol=1e-30)
    assert found.size == pytest.approx(path.size)
    asp.save_fields(tmp_path / "fields.vti", {"pressure": pressure, "a <gap>": gap}, 1e-2)
    content = (tmp_path / "fields.vti").read_bytes()
    head, data = content.split(b'<AppendedData encoding="raw">\n_')
    assert b'Name="pressure"' in head and b'Name="a &lt;gap' in head
    for k, field in enumerate((pressure, gap)):
        start = k * (8 + 8 * field.size) + 8
        np.testing.assert_array_equal(np.frombuffer(data, "<f8", field.size, start).reshape(field.shape), field)
    for name, fields in {"a.txt": {"a": gap}, "a.gsf": {"a": gap, "b": gap}, "a.vti": {}, "b.vti": {"a": gap, "b": gap[1:]}}.items():
        with pytest.raises(asp.AsperityError):
            asp.save_fields(tmp_path / name, fields, 1e-2)
        assert not (tmp_path / name).exists()
    with pytest.raises(OSError):
        asp.save_fields(tmp_path / "no" / "a.npy", {"a": gap}, 1e-2)


def test_the_fields_of_the_program(program: Callable[..., str], tmp_path: Path) -> None:
    """The same files, byte for byte."""
    steel = asp.HalfSpace(asp.composite_modulus("steel"), boundary="free")
    path = asp.load_path(asp.example_surface(nodes=32), steel, area_fraction=0.3)
    path.run(check=False)
    fields = {"pressure": path.pressure(), "gap": path.gap()}
    for kind in ("npy", "gsf", "vti"):
        out = tmp_path / kind
        program("path", "--nodes", 32, "--max-area-fraction", 0.3, "--fields", kind, "--out", out)
        if kind == "vti":
            asp.save_fields(tmp_path / "fields.vti", fields, path.size)
            assert (tmp_path / "fields.vti").read_bytes() == (out / "fields.vti").read_bytes()
            continue
        for name, unit in {"pressure": "Pa", "gap": "m"}.items():
            asp.save_fields(tmp_path / f"{name}.{kind}", {name: fields[name]}, path.size, unit=unit)
            assert (tmp_path / f"{name}.{kind}").read_bytes() == (out / f"{name}.{kind}").read_bytes(), name
