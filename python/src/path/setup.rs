//! How a path begins: from a surface, or from a record.

use std::path::PathBuf;

use asperity::record::LoadingRecord;
use asperity::{ContactRule, LoadingSolver};
use pyo3::prelude::*;

use super::LoadingPath;
use super::inner::{Inner, Resume, Updater};
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
/// updater : {"auto", "cholesky", "iterative"}
///     A Cholesky factor while it pays and fits and iterations afterwards, a factor to the end, or iterations from the
///     beginning. An updater of your own is written in Rust, by the trait ``LinearUpdater``.
/// rule : {"first-contact", "approximate-order"}
///     The exact order of events, or nearly that, which is faster without a factor.
/// window_size : int, optional
///     Nodes to watch at a time; chosen by itself.
/// memory_budget : int, optional
///     Bytes that the path may hold; three quarters of the memory of the machine unless it is given (Linux).
/// check : bool
///     Warn of a surface, a modulus or layers that look wrong.
///
/// Returns
/// -------
/// LoadingPath
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
#[pyo3(signature = (surface, half_space, *, load=None, mean_pressure=None, approach=None, area_fraction=None, mean_gap=None, nodes=None, hardness=None, updater="auto", rule="first-contact", window_size=None, memory_budget=None, check=true))]
#[allow(clippy::too_many_arguments)] // each is a keyword
fn load_path(
    py: Python<'_>,
    surface: PyRef<'_, Surface>,
    half_space: PyRef<'_, HalfSpace>,
    load: Option<f64>,
    mean_pressure: Option<f64>,
    approach: Option<f64>,
    area_fraction: Option<f64>,
    mean_gap: Option<f64>,
    nodes: Option<usize>,
    hardness: Option<&Bound<'_, PyAny>>,
    updater: &str,
    rule: &str,
    window_size: Option<usize>,
    memory_budget: Option<usize>,
    check: bool,
) -> Fallible<LoadingPath> {
    let topography = surface.topography()?;
    let grid = *surface.grid();
    let targets = Targets { load, mean_pressure, approach, area_fraction, mean_gap }.on(&grid)?;
    let updater = choose("updater", updater, &Updater::WORDS)?;
    let rule = choose("rule", rule, &RULES)?;
    let hardness = hardness.map(|hardness| Hardness::of(hardness, &grid)).transpose()?;
    LoadingSolver::check_room(&grid, half_space.surroundings(), memory_budget)?;
    if check {
        warn_of(py, &surface, &half_space)?;
    }
    let kernel = half_space.kernel(py, grid)?;
    let solver = detached(py, move || {
        let mut builder =
            LoadingSolver::builder(topography, &*kernel).updater(updater.make()).rule(rule);
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
        if let Some(bytes) = memory_budget {
            builder = builder.memory_budget(bytes);
        }
        builder.build()
    })??;
    let inner = Inner::live(solver.into_path(), half_space.elastic_bodies());
    Ok(LoadingPath::new(inner, half_space.modulus()))
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
/// LoadingPath
///     With the states of the record in `history`. It goes on when more states are asked for.
#[pyfunction]
#[pyo3(signature = (path, *, half_space=None, updater="auto", memory_budget=None))]
fn open(
    py: Python<'_>,
    path: PathBuf,
    half_space: Option<PyRef<'_, HalfSpace>>,
    updater: &str,
    memory_budget: Option<usize>,
) -> Fallible<LoadingPath> {
    let updater = choose("updater", updater, &Updater::WORDS)?;
    let record = detached(py, || LoadingRecord::read_npz(path))??;
    let found = HalfSpace::of_origin(&record.kernel().origin);
    let body = match (&half_space, &found) {
        (Some(given), None) => &**given,
        (None, Some(found)) => found,
        (Some(_), Some(_)) => {
            return Err(Failure::arguments(
                "the record knows its half-space: half_space is for a body of your own",
            ));
        }
        (None, None) => return Err(asperity::Error::ForeignKernel.into()),
    };
    let (kernel, e_star) = (body.kernel(py, record.grid())?, body.modulus());
    let resume = Resume { kernel, updater, memory_budget };
    let inner = detached(py, || Inner::of_record(record, resume))??;
    Ok(LoadingPath::new(inner, e_star))
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(load_path, module)?)?;
    module.add_function(wrap_pyfunction!(open, module)?)
}
