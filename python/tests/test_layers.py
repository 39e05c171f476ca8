"""Layered bodies."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import DATA, measured

import asperity as asp
from asperity import errors

BOUNDARIES = ["free", "love", "spectral"]


def test_compliance() -> None:
    """A layer on a rigid base, with Poisson's ratio 1/2: u / p = 2 (sinh 2x - 2x) / (cosh 2x + 1 + 2x²) / (E* q)."""
    thickness = 1e-3
    body = asp.HalfSpace.layered([(3e6, 0.5, thickness)], "rigid", "love")
    assert body.e_star == 4e6 and body.thickness == thickness and body.periodic is True and body.boundary == "love"
    for x in (0.3, 1.0, 4.0):
        q = x / thickness
        closed = 2.0 / (4e6 * q) * (np.sinh(2 * x) - 2 * x) / (np.cosh(2 * x) + 1 + 2 * x**2)
        assert body.compliance([q])[0] == pytest.approx(closed, rel=1e-9)
    # Short waves see the layer alone.
    assert body.compliance([1e6])[0] == pytest.approx(2.0 / (4e6 * 1e6), rel=1e-12)
    plain = asp.HalfSpace(4e6, boundary="love")
    assert plain.thickness is None and plain.layers is None and plain.base is None
    for other in (plain, asp.HalfSpace.from_symbol(lambda qx, qy: 1.0 / np.hypot(qx, qy))):
        with pytest.raises(ValueError, match="no layers"):
            other.compliance([1.0])
    for hostile in ("a", [1j], [[1.0]], None):
        with pytest.raises((errors.AsperityError, TypeError)):
            body.compliance(hostile)  # type: ignore[arg-type]


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_a_layer_of_the_same_material_changes_nothing(boundary: str) -> None:
    surface = asp.example_surface(nodes=32)
    layered = asp.HalfSpace.layered([("steel", 1e-3), (210e9, 0.3, 2e-3)], "steel", boundary, against="steel")
    plain = asp.HalfSpace(asp.composite_modulus("steel", "steel"), boundary=boundary)
    assert layered.e_star == pytest.approx(plain.e_star)
    one, other = (asp.solve(surface, body, area_fraction=0.2, tolerance=1e-11, check=False) for body in (layered, plain))
    assert one.contact_nodes == other.contact_nodes
    np.testing.assert_allclose(one.pressure, other.pressure, rtol=0, atol=1e-6 * other.pressure.max())


def test_a_stiff_coat_bears_more() -> None:
    surface = asp.example_surface(nodes=32)
    coated = asp.HalfSpace.layered([(600e9, 0.2, 3e-4)], (210e9, 0.3), "free")
    plain = asp.HalfSpace(asp.composite_modulus("steel"), boundary="free")
    loads = [asp.load_path(surface, body, approach=2e-6, check=False).run(check=False).load[-1] for body in (coated, plain)]
    assert loads[0] > 1.05 * loads[1]


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_the_path_of_the_program(boundary: str, program: Callable[..., str], tmp_path: Path) -> None:
    """A soft layer on a rigid base, and a stiff coat on steel against glass, bit for bit."""
    surroundings = [] if boundary == "free" else ["--periodic", boundary]
    bodies = [
        (["--layer", "3e6,0.49,2e-3", "--base", "rigid"], asp.HalfSpace.layered([(3e6, 0.49, 2e-3)], "rigid", boundary), "1 layer"),
        (
            ["--layer", "450e9,0.25,5e-5", "--layer", "gold,1e-4", "--base", "steel", "--against", "glass"],
            asp.HalfSpace.layered([(450e9, 0.25, 5e-5), ("gold", 1e-4)], "steel", boundary, against="glass"),
            "2 layers",
        ),
    ]
    for k, (options, body, words) in enumerate(bodies):
        record, out = tmp_path / f"path_{k}.npz", tmp_path / f"out_{k}"
        ends = ["--max-area-fraction", "0.2", "--fields", "npy", "--record", record, "--out", out]
        program("path", "--surface", DATA / "selfaffine_48.npy", "--side", "1e-2", *surroundings, *options, *ends)
        path = asp.load_path(measured("selfaffine_48", (1e-2, 1e-2)), body, area_fraction=0.2, check=False)
        history = path.run(check=False)
        stored = np.load(record)
        for name in ("load", "approach", "mean_gap", "interfacial_stiffness", "energy"):
            np.testing.assert_array_equal(getattr(history, name), stored[name], err_msg=name)
        np.testing.assert_array_equal(path.pressure(), np.load(out / "pressure.npy").T)
        np.testing.assert_array_equal(path.gap(), np.load(out / "gap.npy").T)
        # Records know the layers, and go on with them.
        opened = asp.open(record)
        assert opened.history == history and opened.e_star == body.e_star
        for one in (opened, path):
            one.continue_to(area_fraction=0.25)
            one.run(check=False)
        np.testing.assert_array_equal(opened.history.row, path.history.row)
        np.testing.assert_allclose(opened.history.load, path.history.load, rtol=1e-9)
        assert words in repr(body)


def test_one_load_of_the_program(program: Callable[..., str], tmp_path: Path) -> None:
    layers = ["--layer", "3e6,0.5,1e-3", "--base", "rigid", "--load", "0.02", "--json"]
    told = json.loads(program("load", "--surface", DATA / "selfaffine_48.npy", "--side", "1e-2", *layers, "--out", tmp_path))
    body = asp.HalfSpace.layered([(3e6, 0.5, 1e-3)], "rigid", "free")
    one = asp.solve(measured("selfaffine_48", (1e-2, 1e-2)), body, load=0.02, check=False)
    (state,) = told["states"]
    for name in ("contact_nodes", "max_pressure", "mean_gap", "approach", "contact_stiffness", "interfacial_stiffness"):
        assert getattr(one, name) == state[name], name


def test_layers_are_pickled() -> None:
    body = asp.HalfSpace.layered([("gold", 2e-6), (3e9, 0.4, 1e-5)], "steel", "spectral", against=(1e9, 0.3))
    again = pickle.loads(pickle.dumps(body))
    assert repr(again) == repr(body) == "<HalfSpace of 2 layers, 1.2e-5 m; boundary 'spectral'>"
    assert again.layers == body.layers and again.layers[1] == (3e9, 0.4, 1e-5) and again.base == body.base == (210e9, 0.3)
    assert again.e_star == body.e_star and again.compliance([1e5]) == body.compliance([1e5])


def test_what_is_no_layer() -> None:
    layered = asp.HalfSpace.layered
    for layers in ([], [(1e9, 0.6, 1e-3)], [(1e9, 0.3, 0.0)], [(-1e9, 0.3, 1e-3)]):
        with pytest.raises(errors.AsperityError) as info:
            layered(layers, "rigid", "free")
        assert isinstance(info.value, ValueError)
    with pytest.raises(ValueError, match="cheese"):
        layered([("cheese", 1e-3)], "rigid", "free")
    with pytest.raises(ValueError, match="boundary"):
        layered([("steel", 1e-3)], "rigid", "open")
    with pytest.raises(TypeError):
        layered([(1e9, 0.3)], "rigid", "free")  # type: ignore[list-item]


def test_what_holds_on_half_spaces_is_refused_on_layers() -> None:
    """Paths, histories, parts of them and pickled ones know their body; of one material on a rigid base creep is right."""
    coated = asp.HalfSpace.layered([("gold", 1e-3)], "steel", "free")
    alone = asp.HalfSpace.layered([(3e6, 0.3, 1e-3)], "rigid", "free")
    rubber = asp.Prony.shares([(1.0, 0.5)])
    for body, creeps in ((coated, False), (alone, True)):
        path = asp.load_path(asp.example_surface(nodes=32), body, area_fraction=0.1, check=False)
        history = path.run(check=False)
        load = float(history.load[-1])
        for states in (path, history, history[::2], pickle.loads(pickle.dumps(history))):
            for refused in (
                lambda states: asp.conductance(states, 0.04, e_star=1e11),
                lambda states: asp.conductance_bounds(states, 0.04, 1e-8, e_star=1e11),
                lambda states: asp.interface_table(states, resistivity=0.04, e_star=1e11),
                lambda states: asp.interface_table(states, friction=0.3, compliance_ratio=1.2),
                lambda states: asp.shear(states, friction=0.3, compliance_ratio=1.2, check=False).monotone(1e-3 * load),
            ):
                with pytest.raises(errors.AsperityError, match="layers"):
                    refused(states)
            assert len(asp.interface_table(states)) > 5
            if creeps:
                found = asp.creep(states, rubber, [0.0], load=[0.1 * load]).at([1.0])
                assert found["load"][0] == pytest.approx(0.1 * load)
            else:
                with pytest.raises(errors.AsperityError, match="layers"):
                    asp.creep(states, rubber, [0.0], load=[0.1 * load]).at([1.0])
