//! Single loads.

mod solution;
mod sweep;

use asperity::{ContactTarget, FixedLoadSolver};
use pyo3::prelude::*;

use self::solution::Solution;
use crate::argument::whole;
use crate::compute::{detached, interruptible};
use crate::errors::Fallible;
use crate::given::{Hardness, warn_of};
use crate::half_space::HalfSpace;
use crate::history::Setting;
use crate::surface::Surface;
use crate::targets::Targets;
use crate::warnings::{of_contact, warn_all};

/// How a solver is made.
struct Settings {
    tolerance: f64,
    max_iterations: usize,
    stiffness: bool,
    memory_budget: Option<usize>,
}

/// A solver of a surface on a half-space.
fn solver(
    py: Python<'_>,
    surface: &Surface,
    half_space: &HalfSpace,
    hardness: Option<&Bound<'_, PyAny>>,
    settings: &Settings,
) -> Fallible<FixedLoadSolver> {
    let topography = surface.topography()?;
    let grid = *surface.grid();
    let hardness = hardness.map(|hardness| Hardness::of(hardness, &grid)).transpose()?;
    let kernel = half_space.kernel(py, grid)?;
    Ok(detached(py, move || {
        let mut builder = FixedLoadSolver::builder(topography, &*kernel)
            .tolerance(settings.tolerance)
            .max_iterations(settings.max_iterations)
            .stiffness(settings.stiffness);
        match &hardness {
            Some(Hardness::Same(hardness)) => builder = builder.hardness(*hardness),
            Some(Hardness::Map(map)) => builder = builder.hardness_map(map),
            None => {}
        }
        if let Some(bytes) = settings.memory_budget {
            builder = builder.memory_budget(bytes);
        }
        builder.build()
    })??)
}

/// Solve for the contact at one load, mean pressure, approach, area or mean gap, without the path to it.
///
/// Parameters
/// ----------
/// surface : Surface
///     Without missing nodes.
/// half_space : HalfSpace
/// load, mean_pressure, approach, area_fraction, mean_gap : float
///     One of them [N, Pa, m, -, m].
/// stiffness : bool
///     Whether to compute both stiffnesses and the pressure rate too: about as much work again.
/// hardness : float or array_like, optional
///     Greatest pressure H [Pa], elastic-perfectly plastic. A map is ``[row, column]``.
/// tolerance : float
///     Greatest error of the gaps, relative to the approach.
/// max_iterations : int
///     Steps of conjugate gradients after which to give up.
/// memory_budget : int, optional
///     Bytes that may be held; three quarters of what the process may use unless it is given (Linux).
/// check : bool
///     Warn of a surface, a modulus, layers or a contact that look wrong.
///
/// Returns
/// -------
/// Solution
///
/// Raises
/// ------
/// ConvergenceError
///     A `RuntimeError` as well, with ``residual``, ``iterations`` and ``tolerance``.
/// MemoryLimitError
///     A `MemoryError` as well, with ``needed`` and ``budget``.
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> surface = asp.example_surface(nodes=64)
/// >>> one = asp.solve(surface, asp.HalfSpace(115e9, boundary="free"), load=500.0, check=False)
/// >>> one.pressure.shape, one.load
/// ((64, 64), 500.0)
#[pyfunction]
#[pyo3(signature = (surface, half_space, *, load=None, mean_pressure=None, approach=None, area_fraction=None, mean_gap=None, stiffness=true, hardness=None, tolerance=1e-8, max_iterations=5000, memory_budget=None, check=true))]
#[allow(clippy::too_many_arguments)] // each is a keyword
fn solve(
    py: Python<'_>,
    surface: PyRef<'_, Surface>,
    half_space: PyRef<'_, HalfSpace>,
    load: Option<f64>,
    mean_pressure: Option<f64>,
    approach: Option<f64>,
    area_fraction: Option<f64>,
    mean_gap: Option<f64>,
    stiffness: bool,
    hardness: Option<&Bound<'_, PyAny>>,
    tolerance: f64,
    #[pyo3(from_py_with = whole)] max_iterations: usize,
    #[pyo3(from_py_with = whole)] memory_budget: Option<usize>,
    check: bool,
) -> Fallible<Solution> {
    let grid = *surface.grid();
    let targets = Targets { load, mean_pressure, approach, area_fraction, mean_gap };
    let target = targets.only()?;
    if check {
        warn_of(py, &surface, &half_space, hardness)?;
    }
    let settings = Settings { tolerance, max_iterations, stiffness, memory_budget };
    let mut solver = solver(py, &surface, &half_space, hardness, &settings)?;
    let solved = interruptible(py, move || match target {
        ContactTarget::Load(load) => solver.solve(load),
        target => solver.solve_target(target),
    })??;
    let boundary = half_space.surroundings();
    let setting = Setting { grid, boundary, has_hardness: solved.contact.plastic.is_some() };
    if check {
        let e_star = half_space.modulus().filter(|_| solved.contact.plastic.is_none());
        let on = (&grid, boundary);
        let fields = &solved.fields;
        let found =
            detached(py, || of_contact(&fields.pressure, &fields.contact_map, on, e_star))??;
        warn_all(py, found)?;
    }
    Ok(Solution::new(solved, setting))
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(solve, module)?)?;
    solution::register(module)?;
    sweep::register(module)
}
