//! How a path begins: from a surface, or from a record.

use std::path::PathBuf;

use asperity::record::{AdhesiveRecord, LoadingRecord};
use asperity::{AdhesionError, ContactRule, Error, LoadingSolver};
use pyo3::prelude::*;

use super::LoadingPath;
use super::inner::{Inner, Means, Updater};
use crate::adhesion::{Adhesion, AdhesivePath, set_up};
use crate::argument::whole;
use crate::choice::choose;
use crate::compute::detached;
use crate::errors::{Failure, Fallible};
use crate::given::{Hardness, warn_of};
use crate::half_space::HalfSpace;
use crate::surface::Surface;
use crate::targets::Targets;

const RULES: [(&str, ContactRule); 2] = [
    ("first-contact", ContactRule::FirstContact),
    ("approximate-order", ContactRule::ApproximateOrder),
];

const ADHESION_BY_ITERATIONS: &str =
    "a path with adhesion takes a factor: updater=\"auto\" or \"cholesky\"";

/// Set up the loading path of a rough surface on an elastic half-space.
///
/// Parameters
/// ----------
/// surface : Surface
///     Without missing nodes.
/// half_space : HalfSpace
/// load, mean_pressure, approach, area_fraction, mean_gap : float, optional
///     Where the path ends, at exactly this value [N, Pa, m, -, m], whichever comes first; at full contact unless one is
///     given. A path with a hardness goes on until all nodes have yielded.
/// nodes : int, optional
///     Greatest number of nodes in contact.
/// hardness : float or array_like, optional
///     Greatest pressure H [Pa]: nodes that reach it yield, perfectly plastically. A map is ``[row, column]``.
/// adhesion : Adhesion, optional
///     The surfaces stick: the path is an `AdhesivePath`, with loads below 0 at first, and `unload` pulls them off. Load and
///     approach at which it ends may be negative. It takes a factor, and no hardness.
/// updater : {"auto", "cholesky", "iterative"}
///     A Cholesky factor while it pays and fits and iterations afterwards, a factor to the end, or iterations from the
///     beginning. An updater of your own is written in Rust, by the trait ``LinearUpdater``.
/// rule : {"first-contact", "approximate-order"}
///     The exact order of events, or nearly that, which is faster without a factor.
/// window_size : int, optional
///     Nodes to watch at a time; chosen by itself.
/// memory_budget : int, optional
///     Bytes that the path may hold; three quarters of what the process may use unless it is given (Linux).
/// check : bool
///     Warn of a surface, a modulus or layers that look wrong.
///
/// Returns
/// -------
/// LoadingPath or AdhesivePath
///     Nothing is computed yet but the half-space.
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> surface = asp.example_surface(nodes=32)
/// >>> steel = asp.HalfSpace(asp.composite_modulus("steel"), boundary="free")
/// >>> path = asp.load_path(surface, steel, mean_pressure=1e9)
/// >>> for state in path:
/// ...     load, stiffness = state.load, state.contact_stiffness
/// >>> path.end, round(path.state.mean_pressure)
/// ('load', 1000000000)
#[pyfunction]
#[pyo3(signature = (surface, half_space, *, load=None, mean_pressure=None, approach=None, area_fraction=None, mean_gap=None, nodes=None, hardness=None, adhesion=None, updater="auto", rule="first-contact", window_size=None, memory_budget=None, check=true))]
#[allow(clippy::too_many_arguments)] // each is a keyword
fn load_path<'py>(
    py: Python<'py>,
    surface: PyRef<'_, Surface>,
    half_space: PyRef<'_, HalfSpace>,
    load: Option<f64>,
    mean_pressure: Option<f64>,
    approach: Option<f64>,
    area_fraction: Option<f64>,
    mean_gap: Option<f64>,
    #[pyo3(from_py_with = whole)] nodes: Option<usize>,
    hardness: Option<&Bound<'_, PyAny>>,
    adhesion: Option<PyRef<'_, Adhesion>>,
    updater: &str,
    rule: &str,
    #[pyo3(from_py_with = whole)] window_size: Option<usize>,
    #[pyo3(from_py_with = whole)] memory_budget: Option<usize>,
    check: bool,
) -> Fallible<Bound<'py, PyAny>> {
    let topography = surface.topography()?;
    let grid = *surface.grid();
    let targets = Targets { load, mean_pressure, approach, area_fraction, mean_gap }.all()?;
    let updater = choose("updater", updater, &Updater::WORDS)?;
    let rule = choose("rule", rule, &RULES)?;
    LoadingSolver::check_room(&grid, half_space.surroundings(), memory_budget)?;
    if check {
        warn_of(py, &surface, &half_space, hardness)?;
    }
    let hardness = hardness.map(|hardness| Hardness::of(hardness, &grid)).transpose()?;
    let kernel = half_space.kernel(py, grid)?;
    if let Some(adhesion) = adhesion {
        let refused = [
            (
                hardness.is_some(),
                "adhesion of surfaces that yield is not derived: give hardness or adhesion",
            ),
            (
                nodes.is_some(),
                "a path with adhesion ends at an area_fraction, and not at a number of nodes",
            ),
            (matches!(updater, Updater::Iterative), ADHESION_BY_ITERATIONS),
            (
                rule != ContactRule::FirstContact,
                "a path with adhesion follows events in their exact order: rule=\"first-contact\"",
            ),
        ];
        if let Some((_, reason)) = refused.into_iter().find(|(is, _)| *is) {
            return Err(Failure::arguments(reason));
        }
        let law = adhesion.law();
        let settings = (targets, window_size, memory_budget);
        let e_star = half_space.modulus();
        let path = set_up(py, &surface, (&*kernel, law), settings, (e_star, check))?;
        return Ok(path.into_pyobject(py)?.into_any());
    }
    let means = Means { updater, memory_budget };
    let solver = detached(py, move || {
        let mut builder = means.give(LoadingSolver::builder(topography, &*kernel)).rule(rule);
        for target in targets {
            builder = builder.until(target);
        }
        if let Some(nodes) = nodes {
            builder = builder.max_nodes(nodes);
        }
        match &hardness {
            Some(Hardness::Same(hardness)) => builder = builder.hardness(*hardness),
            Some(Hardness::Map(map)) => builder = builder.hardness_map(map),
            None => {}
        }
        if let Some(size) = window_size {
            builder = builder.window_size(size);
        }
        builder.build()
    })??;
    let inner = Inner::live(solver.into_path(), half_space.elastic_bodies(), means);
    Ok(LoadingPath::new(inner, half_space.modulus()).into_pyobject(py)?.into_any())
}

/// Open the record of a path, to read it, to compute fields of its states, and to go on.
///
/// Parameters
/// ----------
/// path : str or os.PathLike
///     A ``.npz`` file of `LoadingPath.save`, of the Rust library or of the program.
/// half_space : HalfSpace, optional
///     The body, if it is one of your own; the record knows the others.
/// updater : {"auto", "cholesky", "iterative"}
///     With what the path goes on.
/// memory_budget : int, optional
///     Bytes that the path may hold when it goes on.
///
/// Returns
/// -------
/// LoadingPath or AdhesivePath
///     With the states of the record in `history`. It goes on when more states are asked for. One with adhesion has its
///     states in `states`, and goes on with `load_to` and `unload`.
#[pyfunction]
#[pyo3(signature = (path, *, half_space=None, updater="auto", memory_budget=None))]
fn open<'py>(
    py: Python<'py>,
    path: PathBuf,
    half_space: Option<PyRef<'_, HalfSpace>>,
    updater: &str,
    #[pyo3(from_py_with = whole)] memory_budget: Option<usize>,
) -> Fallible<Bound<'py, PyAny>> {
    let updater = choose("updater", updater, &Updater::WORDS)?;
    let record = match detached(py, || LoadingRecord::read_npz(&path))? {
        Err(Error::Adhesion(AdhesionError::Record { .. })) => {
            if matches!(updater, Updater::Iterative) {
                return Err(Failure::arguments(ADHESION_BY_ITERATIONS));
            }
            let record = detached(py, || AdhesiveRecord::read_npz(&path))??;
            let found = HalfSpace::of_origin(&record.kernel().origin);
            let body = body_of(half_space.as_deref(), found.as_ref())?;
            let (kernel, e_star) = (body.kernel(py, record.grid())?, body.modulus());
            let path = detached(py, || record.path_on(&*kernel, memory_budget))??;
            let path = AdhesivePath::new(path, record.states().clone(), e_star);
            return Ok(path.into_pyobject(py)?.into_any());
        }
        record => record?,
    };
    let found = HalfSpace::of_origin(&record.kernel().origin);
    let body = body_of(half_space.as_deref(), found.as_ref())?;
    let (kernel, e_star) = (body.kernel(py, record.grid())?, body.modulus());
    let means = Means { updater, memory_budget };
    let inner = detached(py, || Inner::of_record(record, kernel, means))??;
    Ok(LoadingPath::new(inner, e_star).into_pyobject(py)?.into_any())
}

/// The body of a record: the one given, if the record does not know it.
fn body_of<'a>(
    given: Option<&'a HalfSpace>,
    found: Option<&'a HalfSpace>,
) -> Fallible<&'a HalfSpace> {
    match (given, found) {
        (Some(body), None) | (None, Some(body)) => Ok(body),
        (Some(_), Some(_)) => Err(Failure::arguments(
            "the record knows its half-space: half_space is for a body of your own",
        )),
        (None, None) => Err(Error::ForeignKernel.into()),
    }
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(load_path, module)?)?;
    module.add_function(wrap_pyfunction!(open, module)?)
}
