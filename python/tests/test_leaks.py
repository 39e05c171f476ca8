"""Memory: columns take no object for each state, and a thousand paths leave nothing behind."""

from __future__ import annotations

import gc
import sys
from pathlib import Path

import numpy as np
import pytest

import asperity as asp


def resident() -> int:
    """Bytes of memory of this process, less what is shared."""
    pages = Path("/proc/self/statm").read_text().split()
    return (int(pages[1]) - int(pages[2])) * 4096


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="no /proc")
def test_a_thousand_paths_leave_nothing() -> None:
    body = asp.HalfSpace(115e9, boundary="free")
    z = asp.example_surface(nodes=24).z

    def one() -> None:
        surface = asp.Surface(z, 1e-2)
        path = asp.load_path(surface, body, area_fraction=0.1, check=False)
        next(path)
        history = path.run(check=False)
        path.pressure(history.at(load=1.0))
        history.columns()
        asp.patches(path).activation()
        with pytest.raises(asp.AsperityError):
            history.at(load=-1.0)

    for _ in range(200):
        one()
    gc.collect()
    objects, before = len(gc.get_objects()), resident()
    for _ in range(1000):
        one()
    gc.collect()
    # A path on 24 x 24 nodes holds some 300 kB: a thousand of them would be 300 MB, and a single number of each node 4.6 MB.
    assert resident() - before < 3_000_000
    assert len(gc.get_objects()) - objects < 100


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="no /proc")
def test_single_loads_leave_nothing() -> None:
    body, surface = asp.HalfSpace(115e9, boundary="free"), asp.example_surface(nodes=32)

    def one() -> None:
        asp.solve(surface, body, load=50.0, check=False).patches()
        sweep = asp.sweep(surface, body, [50.0, 60.0], check=False)
        next(sweep)

    for _ in range(50):
        one()
    gc.collect()
    before = resident()
    for _ in range(200):
        one()
    gc.collect()
    # A solver on 32 x 32 nodes holds some 1 MB.
    assert resident() - before < 20_000_000


def test_columns_cost_no_object_for_each_state() -> None:
    """512 states and 51 take the same number of objects."""
    body = asp.HalfSpace(115e9, boundary="love")
    counts = []
    for fraction in [0.05, 0.5]:
        history = asp.load_path(asp.example_surface(nodes=32), body, area_fraction=fraction).run(check=False)
        for _ in range(5):
            history.columns()
        gc.collect()
        before = sys.getallocatedblocks()
        columns = history.columns()
        counts.append(sys.getallocatedblocks() - before)
        assert all(isinstance(column, np.ndarray) and column.dtype != object for column in columns.values())
        del columns
    assert abs(counts[0] - counts[1]) <= 2 and max(counts) < 200


def test_tables_of_other_packages(free_surface: asp.Surface, unit_half_space: asp.HalfSpace) -> None:
    history = asp.load_path(free_surface, unit_half_space, nodes=40, check=False).run(check=False)
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(history.columns())
    assert len(frame) == 40 and frame["load"].dtype == np.float64 and frame["event"].iloc[0] == "touch"
    categories = pandas.Categorical.from_codes(history.event_code, asp.EVENTS)
    assert categories[0] == "touch" and len(categories) == 40
    xarray = pytest.importorskip("xarray")
    data = xarray.Dataset({name: ("step", column) for name, column in history.columns().items() if name != "step"})
    assert data.sizes == {"step": 40}


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="no /proc")
def test_what_follows_from_a_path_leaves_nothing() -> None:
    """Slip, creep, leaks, layers and conductance of one path, again and again."""
    path = asp.load_path(asp.example_surface(nodes=24), asp.HalfSpace(4e6, boundary="love"), area_fraction=0.6)
    history = path.run(check=False)
    load = 0.3 * float(history.load[-1])
    surface = asp.example_surface(nodes=16, short_cutoff=2.5e-3)

    def one() -> None:
        joint = asp.shear(path, friction=0.3, compliance_ratio=1.2)
        joint.loading([0.1 * joint.sliding_load])
        joint.follow([load, load], [0.1 * load, 0.0])
        joint.friction_work(0.1 * joint.sliding_load)
        rubber = asp.Prony.shares([(1.0, 0.3)]).plane_strain(0.5).in_series(asp.Prony.elastic(1e3)).relative_to(1.0)
        held = asp.creep(path, rubber, [0.0, 1.0], load=[0.0, 0.1 * load])
        held.at([1.0])
        held.follow([0.0, 0.5, 1.0]).columns()
        asp.Seal(1e-3, 1e5, along="x").leak(path, check=False)
        asp.conductance(path, 0.05)
        asp.interface_table(history[::8], friction=0.3, compliance_ratio=1.0).text("csv")
        asp.solve(surface, asp.HalfSpace.layered([(1e9, 0.3, 1e-3)], "rigid", "love"), mean_pressure=1e5, check=False)

    for _ in range(30):
        one()
    gc.collect()
    objects, before = len(gc.get_objects()), resident()
    for _ in range(150):
        one()
    gc.collect()
    # One map of a node is 4.6 kB here, and a round makes some twenty of them and five copies of the history of 345 states, 60 kB each:
    # what stayed of each round would be 50 MB.
    assert resident() - before < 8_000_000
    assert len(gc.get_objects()) - objects < 100
