"""Small results of asperity, as data classes: they print, compare and pickle."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from asperity._asperity import State

__all__ = [
    "ArealParameters",
    "Certificate",
    "Constriction",
    "CriticalConstriction",
    "Cycle",
    "Distribution",
    "Effort",
    "Estimate",
    "FirstYield",
    "GreatestStress",
    "KernelReport",
    "Leak",
    "LeakCurve",
    "Material",
    "Percolation",
    "PowerSpectrum",
    "ProfileParameters",
    "SelfAffineFit",
    "SlipCycle",
    "SlipState",
    "SpectralMoments",
    "StressField",
    "StressSurvey",
    "Trend",
]


def _is_same(one: object, other: object) -> bool:
    """Whether two values are the same: arrays node by node, and NaN as NaN."""
    numbers = (np.ndarray, float)
    if isinstance(one, numbers) and isinstance(other, numbers):
        return bool(np.array_equal(one, other, equal_nan=True))
    return bool(one == other)


@dataclass(frozen=True, eq=False)
class _WithArrays:
    """A result with arrays: the same as one with the same numbers, and without a hash."""

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(_is_same(getattr(self, one.name), getattr(other, one.name)) for one in fields(self))


@dataclass(frozen=True)
class Certificate:
    """How well a state fulfils the conditions of contact, computed afresh from its pressure.

    All figures are dimensionless: pressures relative to the mean pressure on the contact, loads to the load, gaps to
    `length`. Zero would be exact.

    Attributes
    ----------
    least_pressure : float
        Least pressure in contact: zero at a node that just touches, negative by rounding.
    least_gap : float
        Least gap out of contact; infinite in full contact.
    greatest_contact_gap : float
        Greatest absolute gap in contact.
    complementarity : float
        Sum of pressure times gap, over the sum of pressures.
    load_error : float
        Difference between the sum of pressures and the load.
    excess_pressure : float or None
        Greatest pressure over the hardness of its node, less 1; None without a hardness.
    length : float
        The length that gaps are relative to [m].
    """

    least_pressure: float
    least_gap: float
    greatest_contact_gap: float
    complementarity: float
    load_error: float
    excess_pressure: float | None
    length: float


@dataclass(frozen=True)
class Effort:
    """What a solution for one load took.

    Attributes
    ----------
    iterations, stiffness_iterations : int
        Steps of conjugate gradients on the finest grid, for the pressure and for the stiffness.
    convolutions : int
        Convolutions on the finest grid.
    coarse_convolutions : float
        Convolutions on coarser grids, each counted as its part of the nodes of the finest.
    """

    iterations: int
    stiffness_iterations: int
    convolutions: int
    coarse_convolutions: float


@dataclass(frozen=True)
class Constriction:
    """The narrowest place of the widest channel.

    Attributes
    ----------
    row, column : int
        The node.
    gap : float
        The gap there [m].
    """

    row: int
    column: int
    gap: float


@dataclass(frozen=True)
class Percolation:
    """When contact percolates and when leakage ends, along x and along y: None for what has not happened.

    Attributes
    ----------
    contact_x, contact_y : State or None
        The first state at which one patch alone leads all the way.
    seal_x, seal_y : State or None
        The first state at which no channel does: from there on the gap seals.
    """

    contact_x: State | None
    contact_y: State | None
    seal_x: State | None
    seal_y: State | None


@dataclass(frozen=True, eq=False)
class Distribution(_WithArrays):
    """How often the values of a field occur.

    Attributes
    ----------
    edges : ndarray of float
        Edges of the bins, one more than there are bins.
    counts : ndarray of int
        Number of values in each bin.
    density : ndarray of float
        Probability density in each bin.
    outside : int
        Number of values in no bin.
    area_fraction : float
        The share of nodes in contact.
    """

    edges: NDArray[np.float64]
    counts: NDArray[np.int64]
    density: NDArray[np.float64]
    outside: int
    area_fraction: float


@dataclass(frozen=True, eq=False)
class PowerSpectrum(_WithArrays):
    """A power spectral density: of a surface [m⁴], or of profiles [m³].

    Attributes
    ----------
    wavevector : ndarray of float
        Mean wavevector q = 2π/λ of the waves in each bin [rad/m].
    density : ndarray of float
        Their mean density.
    waves : ndarray of int
        Their number.
    """

    wavevector: NDArray[np.float64]
    density: NDArray[np.float64]
    waves: NDArray[np.int64]


@dataclass(frozen=True)
class Trend:
    """A polynomial fitted to a surface, about its centre.

    Attributes
    ----------
    height : float
        Height at the centre [m].
    slopes : (float, float)
        Slopes along x and y there.
    curvatures : (float, float, float)
        Second derivatives xx, xy and yy [1/m].
    tilt : float
        Angle of the tangent plane at the centre [rad].
    """

    height: float
    slopes: tuple[float, float]
    curvatures: tuple[float, float, float]
    tilt: float


@dataclass(frozen=True)
class SpectralMoments:
    """Moments of the power spectrum, as of Nayak, and what follows from them.

    Attributes
    ----------
    m0, m2, m4 : float
        Moments of profiles [m², -, 1/m²].
    rms_height : float
        [m]
    rms_gradient : float
        Two-dimensional, without unit.
    rms_laplacian, rms_curvature : float
        [1/m]
    nayak_parameter : float
        ``m0 m4 / m2²``
    """

    m0: float
    m2: float
    m4: float
    rms_height: float
    rms_gradient: float
    rms_laplacian: float
    rms_curvature: float
    nayak_parameter: float


@dataclass(frozen=True)
class Estimate:
    """A number with its standard error, one standard deviation."""

    value: float
    standard_error: float


@dataclass(frozen=True)
class ArealParameters:
    """Texture of a map by ISO 25178-2, without its tilt.

    Attributes
    ----------
    sa, sq, sz, sp, sv : float
        Arithmetical mean, root mean square and maximum height, highest peak and deepest pit [m].
    ssk, sku : float
        Skewness and kurtosis.
    sdq, sdr : float
        Root mean square gradient, and developed area ratio.
    sal : float or None
        Autocorrelation length [m]: the shortest way on which the autocorrelation falls to 0.2; None where it does not.
    str : float or None
        Texture aspect ratio: sal over the longest such way.
    sk, spk, svk : float
        Height of the core, reduced height of the peaks and reduced depth of the dales of the material ratio curve [m].
    smrk1, smrk2 : float
        Material ratios at the upper and the lower end of the core.
    """

    sa: float
    sq: float
    sz: float
    sp: float
    sv: float
    ssk: float
    sku: float
    sdq: float
    sdr: float
    sal: float | None
    str: float | None
    sk: float
    spk: float
    svk: float
    smrk1: float
    smrk2: float


@dataclass(frozen=True)
class ProfileParameters:
    """Parameters of a profile by ISO 21920: of its roughness with a cut-off wavelength, of the primary profile without one.

    Attributes
    ----------
    cutoff : float or None
        Cut-off wavelength [m].
    evaluation_length : float
        [m]
    ra, rq, rz, rt : float
        Arithmetical mean, root mean square, maximum and total height [m]. The maximum height is the mean over sections as long as the
        cut-off.
    rsk, rku : float
        Skewness and kurtosis.
    rsm : float or None
        Mean spacing of the elements [m]; None where there are fewer than two.
    """

    cutoff: float | None
    evaluation_length: float
    ra: float
    rq: float
    rz: float
    rt: float
    rsk: float
    rku: float
    rsm: float | None


@dataclass(frozen=True)
class SelfAffineFit:
    """A self-affine spectrum that was fitted to that of a surface.

    Attributes
    ----------
    hurst : Estimate
        Hurst exponent.
    rolloff_wavelength, short_cutoff_wavelength, long_cutoff_wavelength : Estimate or None
        [m]; None where the spectrum has none.
    prefactor : float
        Prefactor of the power law [m^(2 - 2H)].
    dispersion : float
        Mean square of the relative residuals: 1 for a surface of random amplitudes, greater where the spectrum is not of
        this form.
    """

    hurst: Estimate
    rolloff_wavelength: Estimate | None
    short_cutoff_wavelength: Estimate | None
    long_cutoff_wavelength: Estimate | None
    prefactor: float
    dispersion: float


@dataclass(frozen=True)
class KernelReport:
    """What `check_half_space` has tried and found.

    Attributes
    ----------
    contact_sets : int
        Number of sets of nodes that were tried.
    largest_contact : int
        Nodes of the largest of them.
    exhaustive : bool
        Whether every set there is on the grid was tried.
    least_symbol : float or None
        The least value of the symbol on the waves of the grid [m/Pa]; None on a free boundary.
    promised_growth, supported_growth : str
        ``"unknown"``, ``"monotone"`` or ``"convex"``: what the body promises, and the most that no set contradicts.
    """

    contact_sets: int
    largest_contact: int
    exhaustive: bool
    least_symbol: float | None
    promised_growth: str
    supported_growth: str


@dataclass(frozen=True)
class Material:
    """Typical values of a material.

    Attributes
    ----------
    youngs_modulus : float
        [Pa]
    poissons_ratio : float
    hardness : float or None
        Mean pressure under an indenter [Pa], None where none is known.
    """

    youngs_modulus: float
    poissons_ratio: float
    hardness: float | None


@dataclass(frozen=True)
class CriticalConstriction:
    """The narrowest place of the widest channel of a leak.

    Attributes
    ----------
    row, column : int
        The node.
    gap : float
        The gap there [m].
    pressure_drop : float
        The share of the pressure drop from one side of its cell to the other.
    dissipation : float
        The share of the power that is lost in the square of 9 x 9 cells about it.
    """

    row: int
    column: int
    gap: float
    pressure_drop: float
    dissipation: float


@dataclass(frozen=True, eq=False)
class Leak(_WithArrays):
    """The leak through a gap map.

    Attributes
    ----------
    leak_rate : float
        Through the whole width of the surface [m³/s]: exactly 0 if no channel leads from edge to edge.
    permeability : float
        Along the flow [m³/(Pa s)]: of a gap g everywhere it is g³ / (12 viscosity).
    transverse_permeability : float
        Mean flux across the flow over the mean pressure gradient along it [m³/(Pa s)], of either sign; NaN on a free
        boundary.
    mean_field_leak_rate : float
        Bruggeman's estimate of the leak rate [m³/s].
    constriction : CriticalConstriction or None
        The narrowest place of the widest channel.
    pressure : ndarray of float, [row, column]
        Fluid pressure above the outlet [Pa], NaN where there is no fluid and in pools.
    flux_x, flux_y : ndarray of float, [row, column]
        Volume per time and width [m²/s].
    sections : ndarray of float
        Leak rate through each section across the flow [m³/s].
    imbalance : float
        What is lost at all nodes together over the leak rate.
    flowing_nodes : int
        Nodes through which the fluid flows.
    pools : int
        Places with fluid that no channel joins to an edge.
    iterations : int
        Iterations of the solver.
    """

    leak_rate: float
    permeability: float
    transverse_permeability: float
    mean_field_leak_rate: float
    constriction: CriticalConstriction | None
    pressure: NDArray[np.float64] = field(repr=False)
    flux_x: NDArray[np.float64] = field(repr=False)
    flux_y: NDArray[np.float64] = field(repr=False)
    sections: NDArray[np.float64] = field(repr=False)
    imbalance: float
    flowing_nodes: int
    pools: int
    iterations: int


@dataclass(frozen=True, eq=False)
class LeakCurve(_WithArrays):
    """The leak rate along a path, in the order of loading.

    Attributes
    ----------
    states : list of State
    load, mean_pressure, area_fraction, mean_gap : ndarray of float
        Of the states [N, Pa, -, m].
    leak_rate, mean_field_leak_rate : ndarray of float
        [m³/s]
    permeability, transverse_permeability : ndarray of float
        Mean fluxes along the flow and across it over the mean pressure gradient along it [m³/(Pa s)]; across of either
        sign, and NaN on a free boundary.
    constrictions : list of CriticalConstriction or None
        The narrowest place of the widest channel; None where nothing leaks.
    imbalance : ndarray of float
        What is lost at all nodes together over the leak rate.
    closing : State or None
        The state at which the last channel closes; None if the path does not reach it, and if nodes leave the contact.
    """

    states: list[State]
    load: NDArray[np.float64]
    mean_pressure: NDArray[np.float64]
    area_fraction: NDArray[np.float64]
    mean_gap: NDArray[np.float64]
    leak_rate: NDArray[np.float64]
    mean_field_leak_rate: NDArray[np.float64]
    permeability: NDArray[np.float64]
    transverse_permeability: NDArray[np.float64]
    constrictions: list[CriticalConstriction | None]
    imbalance: NDArray[np.float64]
    closing: State | None


@dataclass(frozen=True)
class GreatestStress:
    """The greatest value of a measure of stress, and where it is.

    Attributes
    ----------
    value : float
        [Pa]
    depth : float
        Below the surface [m].
    row, column : int
        The node above it.
    """

    value: float
    depth: float
    row: int
    column: int


@dataclass(frozen=True, eq=False)
class StressField(_WithArrays):
    """The stresses at a depth; tension is positive, z points into the body.

    Attributes
    ----------
    depth : float
        [m]
    xx, yy, zz, yz, xz, xy : ndarray of float, [row, column]
        Components [Pa].
    von_mises, tresca : ndarray of float, [row, column]
        Equivalent stresses [Pa].
    greatest_shear : ndarray of float, [row, column]
        Half the difference of the greatest and the least principal stress [Pa].
    greatest_tension : ndarray of float, [row, column]
        The greatest principal stress [Pa].
    """

    depth: float
    xx: NDArray[np.float64] = field(repr=False)
    yy: NDArray[np.float64] = field(repr=False)
    zz: NDArray[np.float64] = field(repr=False)
    yz: NDArray[np.float64] = field(repr=False)
    xz: NDArray[np.float64] = field(repr=False)
    xy: NDArray[np.float64] = field(repr=False)
    von_mises: NDArray[np.float64] = field(repr=False)
    tresca: NDArray[np.float64] = field(repr=False)
    greatest_shear: NDArray[np.float64] = field(repr=False)
    greatest_tension: NDArray[np.float64] = field(repr=False)


@dataclass(frozen=True, eq=False)
class StressSurvey(_WithArrays):
    """The greatest stresses at each depth, and over all.

    Attributes
    ----------
    depth : ndarray of float
        From the least to the greatest [m].
    von_mises, tresca, greatest_shear, greatest_tension : ndarray of float
        The greatest value at each depth [Pa].
    greatest : dict of GreatestStress
        Of each of these names over all depths.
    """

    depth: NDArray[np.float64]
    von_mises: NDArray[np.float64]
    tresca: NDArray[np.float64]
    greatest_shear: NDArray[np.float64]
    greatest_tension: NDArray[np.float64]
    greatest: dict[str, GreatestStress]


@dataclass(frozen=True)
class FirstYield:
    """The state of an elastic path at which a body begins to yield.

    Attributes
    ----------
    state : State
    greatest : GreatestStress
        Von Mises' stress there, which is the yield stress within 1e-4.
    """

    state: State
    greatest: GreatestStress


@dataclass(frozen=True)
class SlipState:
    """The tangential state of a contact under a load.

    Attributes
    ----------
    load, tangential_load : float
        [N]
    displacement : float
        Of distant points of both bodies against each other [m].
    interfacial_displacement : float
        What the joint itself gives way [m].
    stick_load : float
        Nodes in contact at this load of the path stick [N].
    stick_nodes, slipping_nodes : int
    stick_area, slip_area : float
        [m²]
    tangential_stiffness : float
        dT/dU if T goes on as it went [N/m].
    """

    load: float
    tangential_load: float
    displacement: float
    interfacial_displacement: float
    stick_load: float
    stick_nodes: int
    slipping_nodes: int
    stick_area: float
    slip_area: float
    tangential_stiffness: float


@dataclass(frozen=True)
class SlipCycle:
    """A steady cycle of the tangential load between -T and T.

    Attributes
    ----------
    amplitude : float
        Of the tangential load [N].
    displacement, interfacial_displacement : float
        Amplitudes [m].
    dissipation : float
        Energy lost in a cycle [J].
    secant_stiffness : float
        [N/m]
    loss_factor : float
        The energy lost over 2 pi times T U / 2.
    stick_load : float
        Nodes in contact at this load stick throughout [N].
    slipping_nodes : int
        Nodes that slip.
    has_few_nodes : bool
        So few that the dissipation is that of the grid: below some 50.
    """

    amplitude: float
    displacement: float
    interfacial_displacement: float
    dissipation: float
    secant_stiffness: float
    loss_factor: float
    stick_load: float
    slipping_nodes: int
    has_few_nodes: bool


@dataclass(frozen=True, eq=False)
class Cycle(_WithArrays):
    """A steady cycle of the load of viscoelastic bodies.

    Attributes
    ----------
    period : float
        [s]
    mean_load, amplitude : float
        [N]
    approach_amplitude : float
        Half of the range of the approach [m].
    dissipation : float
        Energy lost in the last cycle [J].
    stiffness : float
        Amplitude of the load over that of the approach [N/m].
    loss_factor : float
        Energy lost over pi times both amplitudes.
    approach, load : ndarray of float
        The last cycle [m, N].
    cycles : int
        How many cycles were run.
    distance : float
        How far the energy lost is from that of the steady cycle, over the product of amplitudes: an estimate.
    """

    period: float
    mean_load: float
    amplitude: float
    approach_amplitude: float
    dissipation: float
    stiffness: float
    loss_factor: float
    approach: NDArray[np.float64] = field(repr=False)
    load: NDArray[np.float64] = field(repr=False)
    cycles: int
    distance: float
