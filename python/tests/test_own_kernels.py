"""Half-spaces of one's own: functions of Python, called once."""

from __future__ import annotations

import gc
import pickle
import weakref
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import asperity as asp

Array = NDArray[np.float64]


def spectral(qx: Array, qy: Array) -> Array:
    """The half-space of spectral codes, E* = 1 GPa."""
    return 2.0 / (1e9 * np.hypot(qx, qy))


def layer(qx: Array, qy: Array) -> Array:
    """A layer bonded to a rigid base (Bentall and Johnson 1968): 100 um, E* = 1 GPa, nu = 0.3."""
    e_star, nu, h = 1e9, 0.3, 1e-4
    kappa = 3 - 4 * nu
    q = np.hypot(qx, qy)
    # From a = 40 on it is a half-space.
    a = np.minimum(q * h, 40.0)
    above = 2 * kappa * np.sinh(2 * a) - 4 * a
    below = 2 * kappa * np.cosh(2 * a) + 4 * a * a + kappa * kappa + 1
    waves = np.divide(2.0, e_star * q, out=np.zeros_like(q), where=q > 0) * above / below
    return np.where(q == 0.0, h * (1 - 2 * nu) / ((1 - nu) ** 2 * e_star), waves)


@pytest.fixture
def small() -> asp.Surface:
    return asp.example_surface(nodes=32)


def test_a_symbol_of_the_engine(small: asp.Surface) -> None:
    """The spectral half-space once more: contact is the same, whatever is known of how it grows."""
    own = asp.HalfSpace.from_symbol(spectral, growth="monotone", e_star=1e9)
    path = asp.load_path(small, own, area_fraction=0.3, check=False)
    known = asp.load_path(small, asp.HalfSpace(1e9, boundary="spectral"), area_fraction=0.3, check=False)
    found, expected = path.run(check=False), known.run(check=False)
    np.testing.assert_array_equal(found.row, expected.row)
    np.testing.assert_array_equal(found.column, expected.column)
    np.testing.assert_allclose(found.load, expected.load, rtol=1e-9, atol=1e-12 * expected.load.max())
    unknown = asp.load_path(small, asp.HalfSpace.from_symbol(spectral), area_fraction=0.1, check=False)
    np.testing.assert_array_equal(unknown.run(check=False).row, expected.row[: int(0.1 * 1024)])
    assert own.boundary == "symbol" and own.periodic is True and own.e_star == 1e9
    report = asp.check_half_space(small, own)
    assert report.promised_growth == "monotone" and report.least_symbol is not None


@pytest.mark.parametrize("e_star", [-5.0, 0.0, np.nan, np.inf])
def test_a_modulus_is_positive(e_star: float) -> None:
    with pytest.raises(asp.AsperityError, match="composite modulus"):
        asp.HalfSpace.from_symbol(lambda qx, qy: 1.0 / np.hypot(qx, qy), e_star=e_star)


def test_bodies_that_refer_to_themselves_are_collected() -> None:
    class Body:
        def __init__(self) -> None:
            self.half_space = asp.HalfSpace.from_symbol(self.symbol)

        def symbol(self, qx: np.ndarray, qy: np.ndarray) -> np.ndarray:
            return 1.0 / np.hypot(qx, qy)

    seen = weakref.ref(Body())
    gc.collect()
    assert seen() is None


def test_a_layer(small: asp.Surface) -> None:
    """Stiffer than the half-space, and its mean displacement is its own."""
    body = asp.HalfSpace.from_symbol(layer, mean_displacement="physical", e_star=1e9)
    one = asp.solve(small, body, mean_pressure=1e6, check=False)
    half_space = asp.solve(small, asp.HalfSpace(1e9, boundary="spectral"), mean_pressure=1e6, check=False)
    assert one.contact_nodes < half_space.contact_nodes and one.max_pressure > half_space.max_pressure
    assert np.isfinite(one.contact_stiffness)
    # A uniform pressure compresses it by h (1 - 2 nu) / ((1 - nu)^2 E*) for each Pa.
    influence = asp.influence(small, body)
    assert influence.sum() == pytest.approx(layer(np.zeros(1), np.zeros(1))[0], rel=1e-12)


def test_a_function_is_called_once_with_arrays(small: asp.Surface) -> None:
    calls: list[tuple[Array, Array]] = []

    def symbol(qx: Array, qy: Array) -> Array:
        calls.append((qx, qy))
        return spectral(qx, qy)

    asp.load_path(small, asp.HalfSpace.from_symbol(symbol), nodes=2, check=False)
    ((qx, qy),) = calls
    assert qx.shape == qy.shape and qx.ndim == 1 and len(qx) >= 2 * (32 * 32 - 1)
    assert qx.dtype == np.float64 and not np.any((qx == 0) & (qy == 0))
    assert np.abs(qx).max() == pytest.approx(np.pi / (1e-2 / 32), rel=1e-12)


def test_axes_of_a_symbol() -> None:
    """A body that is stiff along x for waves along x: a crest along y has less contact than one along x."""
    def stiff_along_x(qx: Array, qy: Array) -> Array:
        return 2.0 / (1e9 * np.sqrt(16 * qx**2 + qy**2))

    body = asp.HalfSpace.from_symbol(stiff_along_x)
    shape, size = (24, 24), 1e-3
    along = {axis: asp.wave(1e-6, 1e-3, shape, size, axis=axis) for axis in "xy"}
    loads = {axis: asp.solve(surface, body, mean_pressure=2e6, check=False).area_fraction for axis, surface in along.items()}
    assert loads["x"] < loads["y"]


def test_coefficients(small: asp.Surface) -> None:
    """Love's coefficients, tabulated by the engine and given back: the same path, bit for bit."""
    influence = asp.influence(small, asp.HalfSpace(1e9, boundary="free"))

    def coefficient(di: NDArray[np.int64], dj: NDArray[np.int64]) -> Array:
        return influence[np.abs(dj), np.abs(di)]

    own = asp.HalfSpace.from_coefficients(coefficient, boundary="free", growth="convex", e_star=1e9)
    path = asp.load_path(small, own, area_fraction=0.3, check=False)
    known = asp.load_path(small, asp.HalfSpace(1e9, boundary="free"), area_fraction=0.3, check=False)
    assert path.run(check=False) == known.run(check=False)
    assert own.periodic is False and own.boundary == "coefficients"
    # One number for all is broadcast: a body that sinks as a whole, on which no second node ever touches.
    flat = asp.load_path(small, asp.HalfSpace.from_coefficients(lambda di, dj: 1e-15, boundary="free"), check=False)
    assert len(flat.run(check=False)) == 1 and flat.end == "no more events"


def test_records_of_own_bodies(small: asp.Surface, tmp_path: Path) -> None:
    own = asp.HalfSpace.from_symbol(spectral, growth="monotone")
    path = asp.load_path(small, own, area_fraction=0.1, check=False)
    path.run(check=False)
    path.save(tmp_path / "own.npz")
    with pytest.raises(asp.AsperityError) as foreign:
        asp.open(tmp_path / "own.npz")
    assert foreign.value.kind == "ForeignKernel" and "half_space=" in str(foreign.value)
    opened = asp.open(tmp_path / "own.npz", half_space=own)
    assert np.abs(opened.pressure() - path.pressure()).max() < 1e-8 * path.pressure().max()
    with pytest.raises(asp.AsperityError) as wrong:
        asp.open(tmp_path / "own.npz", half_space=asp.HalfSpace(2e9, boundary="spectral"))
    assert wrong.value.kind == "WrongKernel" and wrong.value.expected != wrong.value.found


def test_functions_that_are_none(small: asp.Surface) -> None:
    def fails(qx: Array, qy: Array) -> Array:
        raise ZeroDivisionError("no symbol")

    with pytest.raises(ZeroDivisionError, match="no symbol"):
        asp.solve(small, asp.HalfSpace.from_symbol(fails), load=1.0, check=False)
    wrong: list[tuple[object, str]] = [
        (lambda qx, qy: qx[:3], "Array"),
        (lambda qx, qy: "symbol", "Array"),
        (lambda qx, qy: qx + 1j, "Array"),
        (lambda qx, qy: None, "Array"),
        (lambda qx, qy: np.ones((len(qx), 1)), "Array"),
        (lambda qx, qy: -np.hypot(qx, qy), "SymbolNotPositive"),
        (lambda qx, qy: np.full_like(qx, np.nan), "SymbolNotPositive"),
        (lambda qx, qy: np.exp(1e-4 * qx), "SymbolNotEven"),
    ]
    for symbol, kind in wrong:
        with pytest.raises(asp.AsperityError) as refused:
            asp.solve(small, asp.HalfSpace.from_symbol(symbol), load=1.0, check=False)
        assert refused.value.kind == kind
        if kind.startswith("Symbol"):
            assert len(refused.value.q) == 2
    for arguments in [{"symbol": 3}, {"symbol": spectral, "growth": "fast"}, {"symbol": spectral, "mean_displacement": "no"}]:
        with pytest.raises(asp.AsperityError):
            asp.HalfSpace.from_symbol(**arguments)
    with pytest.raises(asp.AsperityError) as lopsided:
        asp.solve(small, asp.HalfSpace.from_coefficients(lambda di, dj: 1.0 + 0.1 * di, boundary="free"), load=1.0)
    assert lopsided.value.kind == "NotSymmetric"
    broken = asp.HalfSpace.from_symbol(lambda qx, qy: np.exp(-1e-4 * np.hypot(qx, qy)) + 1e-3, growth="convex")
    with pytest.raises(asp.AsperityError) as promise:
        asp.check_half_space(small, broken)
    assert promise.value.kind == "BrokenPromise" and len(promise.value.contact) >= 1


def test_own_bodies_are_pickled() -> None:
    own = asp.HalfSpace.from_symbol(spectral, growth="monotone", e_star=1e9)
    again = pickle.loads(pickle.dumps(own))
    assert (again.boundary, again.e_star, repr(again)) == ("symbol", 1e9, repr(own))
    for boundary in ["free", "love", "spectral"]:
        assert repr(pickle.loads(pickle.dumps(asp.HalfSpace(1e9, boundary=boundary)))) == repr(asp.HalfSpace(1e9, boundary))


def test_materials() -> None:
    steel, glass = asp.materials()["steel"], asp.materials()["glass"]
    assert (steel.youngs_modulus, steel.poissons_ratio, steel.hardness) == (210e9, 0.3, 2.5e9)
    both = asp.composite_modulus("steel", "glass")
    one = [(1 - m.poissons_ratio**2) / m.youngs_modulus for m in (steel, glass)]
    assert both == pytest.approx(1 / sum(one), rel=1e-15)
    assert asp.composite_modulus((210e9, 0.3)) == asp.composite_modulus("steel")
    assert asp.materials()["rubber"].hardness is None
    with pytest.raises(asp.AsperityError, match="steel"):
        asp.composite_modulus("stone")
    with pytest.raises(asp.AsperityError) as refused:
        asp.composite_modulus((210e9, 0.7))
    assert refused.value.value == 0.7
    # 250 kgf/mm² of the surface of the indentation, 0.9635 of it in the plane.
    assert asp.hardness(250, "HB") == pytest.approx(250 * 9.80665e6 / 0.9635, rel=1e-15)
    # ASTM E140: 60 HRC are 697 HV.
    assert asp.hardness(60, "HRC") == pytest.approx(asp.hardness(697, "HV"), rel=0.015)
    with pytest.raises(asp.AsperityError) as refused:
        asp.hardness(70, "HRC")
    assert refused.value.value == 70
    assert asp.composite_modulus("Aluminum", "PTFE") == asp.composite_modulus("aluminium", "ptfe")
