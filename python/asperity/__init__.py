"""Elastic contact of rough surfaces by the boundary element method: the exact loading path, event by event, and single
loads.

A rigid rough surface is pressed without friction into an elastic half-space. The surface is a grid of rectangular cells
with a uniform pressure on each. An event is the instant at which one more node touches, or yields. Between two events
everything is linear in the approach, so that there are no load steps, and every state has its exact tangent stiffnesses.

>>> import asperity as asp
>>> surface = asp.example_surface(nodes=32)
>>> steel = asp.HalfSpace(asp.composite_modulus("steel"), boundary="free")
>>> path = asp.load_path(surface, steel, area_fraction=0.1)
>>> history = path.run(check=False)
>>> int(history.contact_nodes[-1]), path.end
(102, 'area fraction')

Where to find it
----------------
``Surface``, ``read``, ``self_affine``
    heights: from arrays, files of instruments, generators
``HalfSpace``, ``composite_modulus``, ``materials``
    the elastic body
``load_path``, ``open``
    the loading path, its states (``History``, ``State``) and fields, and its records
``Adhesion``
    surfaces that stick: both branches of the path (``AdhesivePath``, ``AdhesiveBranch``), pull-off
``report``
    a path as one page for a browser
``solve``, ``sweep``
    single loads
``patches``, ``label_patches``
    contact patches, percolation, activation
``Seal``
    leakage through the gap
``stress``, ``stress_of``, ``first_yield``, ``first_yields``
    stress below the surface
``shear``
    tangential loads: partial slip, stiffness, dissipation
``Prony``, ``creep``, ``steady_cycles``
    viscoelastic bodies over time
``conductance``, ``interface_table``
    heat and current through a joint; its laws for finite elements
``asperity.errors``, ``asperity.results``
    exceptions and warnings; small results

Conventions
-----------
* Units are SI: m, N, Pa, N/m, J.
* Arrays are ``[row, column]``: x is the column, y the row, as in an image. Sizes are ``(x, y)``. Only a ``.npy`` file
  that `read` reads, and ``heights()`` of SurfaceTopography, are ``[ix, iy]``.
* Heights are positive towards the half-space: the highest node touches first. Pressure is positive in compression, a gap
  where the surfaces are apart.
* The approach counts from first touch; on a periodic half-space it is that of the mean planes.
* Every array is a new one: float64, int64, int8 (codes), bool or text, in C order; NaN for what does not exist.

Own kernels can be functions of Python (`HalfSpace.from_symbol`, `HalfSpace.from_coefficients`), which are called once.
Own solvers of the linear systems are written in Rust, by its trait ``LinearUpdater``.
"""

from asperity import errors, results
from asperity._asperity import (
    EVENTS,
    Adhesion,
    AdhesiveBranch,
    AdhesivePath,
    AdhesiveState,
    Creep,
    CreepSteps,
    HalfSpace,
    History,
    InterfaceTable,
    LoadingPath,
    LoadSweep,
    PartialSlip,
    PatchAnalysis,
    PatchMap,
    Prony,
    Report,
    Seal,
    Solution,
    State,
    Stress,
    Surface,
    Unloading,
    __version__,
    channels,
    check_half_space,
    composite_modulus,
    conductance,
    conductance_bounds,
    cone,
    creep,
    cylinder,
    example_surface,
    first_yield,
    first_yields,
    formats,
    gap_distribution,
    hardness,
    influence,
    interface_table,
    label_patches,
    load_path,
    materials,
    open,
    paraboloid,
    patches,
    pressure_distribution,
    read,
    report,
    save_fields,
    self_affine,
    set_threads,
    shear,
    solve,
    steady_cycle,
    steady_cycles,
    stress,
    stress_of,
    sweep,
    threads,
    wave,
)
from asperity.errors import AsperityError, AsperityWarning

__all__ = [
    "Adhesion",
    "AdhesiveBranch",
    "AdhesivePath",
    "AdhesiveState",
    "AsperityError",
    "AsperityWarning",
    "Creep",
    "CreepSteps",
    "EVENTS",
    "HalfSpace",
    "History",
    "InterfaceTable",
    "LoadSweep",
    "LoadingPath",
    "PartialSlip",
    "PatchAnalysis",
    "PatchMap",
    "Prony",
    "Report",
    "Seal",
    "Solution",
    "State",
    "Stress",
    "Surface",
    "Unloading",
    "__version__",
    "channels",
    "check_half_space",
    "composite_modulus",
    "conductance",
    "conductance_bounds",
    "cone",
    "creep",
    "cylinder",
    "errors",
    "example_surface",
    "first_yield",
    "first_yields",
    "formats",
    "gap_distribution",
    "hardness",
    "influence",
    "interface_table",
    "label_patches",
    "load_path",
    "materials",
    "open",
    "paraboloid",
    "patches",
    "pressure_distribution",
    "read",
    "report",
    "results",
    "save_fields",
    "self_affine",
    "set_threads",
    "shear",
    "solve",
    "steady_cycle",
    "steady_cycles",
    "stress",
    "stress_of",
    "sweep",
    "threads",
    "wave",
]
