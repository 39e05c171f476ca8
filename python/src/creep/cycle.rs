//! Steady cycles of load.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use asperity::Error;
use asperity::bed::Bed;
use asperity::creep::{self, Cycle, CycleSettings, ViscoelasticBed};
use asperity::loading::History;
use pyo3::prelude::*;

use super::prony::Prony;
use crate::argument::whole;
use crate::arrays::{Found, Kind, column};
use crate::compute::cancellable;
use crate::errors::{Failure, Fallible};
use crate::increments::Increments;
use crate::results::result;

/// Cycle the load of viscoelastic bodies around a mean until the cycle is the steady one.
///
/// The mean load is held first until nothing creeps any more. Terms of the modulus that are much slower than the period go many
/// cycles ahead at once.
///
/// Parameters
/// ----------
/// path : LoadingPath or History
///     Elastic, from first touch on. A part of its states, ``path.history[::4]``, saves time.
/// prony : Prony
///     The modulus over the E* of the path; of a body that does not flow.
/// mean_load, amplitude : float
///     [N]
/// period : float
///     [s]
/// steps : int
///     Steps of a cycle, at least 8.
/// tolerance : float
///     Estimated distance from the steady cycle at which a cycle is taken for it: of the energy lost over the product of amplitudes,
///     and of the amplitude of the approach over itself.
/// most : int
///     No more cycles than these: where they are not enough, ``ConvergenceError`` of the kind ``NotSteady`` says how near they came.
///
/// Returns
/// -------
/// results.Cycle
#[pyfunction]
#[pyo3(signature = (path, prony, *, mean_load, amplitude, period, steps=96, tolerance=1e-5, most=10_000))]
#[allow(clippy::too_many_arguments)] // each is a keyword
fn steady_cycle<'py>(
    py: Python<'py>,
    path: &Bound<'py, PyAny>,
    prony: PyRef<'py, Prony>,
    mean_load: f64,
    amplitude: f64,
    period: f64,
    #[pyo3(from_py_with = whole)] steps: usize,
    tolerance: f64,
    #[pyo3(from_py_with = whole)] most: usize,
) -> Fallible<Bound<'py, PyAny>> {
    let task = (Increments::of(path)?.history, prony.prony.clone());
    let settings = CycleSettings { steps, tolerance, most };
    let cycles = cycles(py, task, (mean_load, amplitude), vec![period], settings)?;
    cycles.first().map_or_else(|| Err(Failure::arguments("no cycle")), |cycle| of(py, cycle))
}

/// The same for many periods, one after the other on one contact: each goes on from the one before, which saves cycles if periods
/// are near each other.
///
/// Parameters
/// ----------
/// path, prony, mean_load, amplitude, steps, tolerance, most
///     As of `steady_cycle`.
/// periods : array_like of float
///     [s]; from the shortest on the contact has settled for a fast cycle. The program does it so, with ``steps=64``,
///     ``tolerance=1e-4`` and at most some 1500 states of the path.
///
/// Returns
/// -------
/// list of results.Cycle
#[pyfunction]
#[pyo3(signature = (path, prony, *, mean_load, amplitude, periods, steps=96, tolerance=1e-5, most=10_000))]
#[allow(clippy::too_many_arguments)] // each is a keyword
fn steady_cycles<'py>(
    py: Python<'py>,
    path: &Bound<'py, PyAny>,
    prony: PyRef<'py, Prony>,
    mean_load: f64,
    amplitude: f64,
    periods: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = whole)] steps: usize,
    tolerance: f64,
    #[pyo3(from_py_with = whole)] most: usize,
) -> Fallible<Vec<Bound<'py, PyAny>>> {
    let task = (Increments::of(path)?.history, prony.prony.clone());
    let periods = Found::of(periods, "periods", Kind::Real)?.list()?;
    let settings = CycleSettings { steps, tolerance, most };
    let cycles = cycles(py, task, (mean_load, amplitude), periods, settings)?;
    cycles.iter().map(|cycle| of(py, cycle)).collect()
}

/// Cycles of some periods around a mean load, after that has settled.
fn cycles(
    py: Python<'_>,
    (history, prony): (Arc<History>, creep::Prony),
    (mean_load, amplitude): (f64, f64),
    periods: Vec<f64>,
    settings: CycleSettings,
) -> Fallible<Vec<Cycle>> {
    Ok(cancellable(py, move |is_left| {
        let bed = Bed::new(&history)?;
        let mut contact = ViscoelasticBed::new(&bed, &prony)?;
        contact.settle(mean_load)?;
        let goes_on = periods.iter().take_while(|_| !is_left.load(Ordering::Relaxed));
        let run = |period: &f64| contact.cycle(mean_load, amplitude, *period, settings);
        goes_on.map(run).collect::<Result<_, Error>>()
    })??)
}

fn of<'py>(py: Python<'py>, cycle: &Cycle) -> Fallible<Bound<'py, PyAny>> {
    let (approach, load): (Vec<f64>, Vec<f64>) = cycle.path.iter().copied().unzip();
    result!(py, "Cycle", {
        period: cycle.period,
        mean_load: cycle.mean_load,
        amplitude: cycle.amplitude,
        approach_amplitude: cycle.approach_amplitude,
        dissipation: cycle.dissipation,
        stiffness: cycle.stiffness,
        loss_factor: cycle.loss_factor,
        approach: column(py, approach),
        load: column(py, load),
        cycles: cycle.cycles,
        distance: cycle.distance,
    })
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(steady_cycle, module)?)?;
    module.add_function(wrap_pyfunction!(steady_cycles, module)?)
}
