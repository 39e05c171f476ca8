//! Steady cycles of load.

use asperity::creep::{CycleSettings, ViscoelasticBed};
use pyo3::prelude::*;

use super::prony::Prony;
use crate::arrays::column;
use crate::compute::detached;
use crate::errors::Fallible;
use crate::increments::Increments;
use crate::results::result;

/// Cycle the load of viscoelastic bodies around a mean until each cycle costs as much energy as the one before.
///
/// Parameters
/// ----------
/// path : LoadingPath or History
///     Elastic, from first touch on.
/// prony : Prony
///     The modulus over the E* of the path; of a body that does not flow.
/// mean_load, amplitude : float
///     [N]
/// period : float
///     [s]
/// steps : int
///     Steps of a cycle, at least 8.
/// tolerance : float
///     Change of the energy lost, over the product of amplitudes, at which a cycle is steady.
/// most : int
///     No more cycles than these.
///
/// Returns
/// -------
/// results.Cycle
#[pyfunction]
#[pyo3(signature = (path, prony, *, mean_load, amplitude, period, steps=96, tolerance=1e-5, most=60))]
#[allow(clippy::too_many_arguments)] // each is a keyword
fn steady_cycle<'py>(
    py: Python<'py>,
    path: &Bound<'py, PyAny>,
    prony: PyRef<'py, Prony>,
    mean_load: f64,
    amplitude: f64,
    period: f64,
    steps: usize,
    tolerance: f64,
    most: usize,
) -> Fallible<Bound<'py, PyAny>> {
    let increments = Increments::of(path)?;
    let prony = &prony.prony;
    let cycle = detached(py, || {
        let bed = increments.bed()?;
        let mut contact = ViscoelasticBed::new(&bed, prony)?;
        contact.settle(mean_load)?;
        contact.cycle(mean_load, amplitude, period, CycleSettings { steps, tolerance, most })
    })??;
    let (approach, load): (Vec<f64>, Vec<f64>) = cycle.path.iter().copied().unzip();
    result!(py, "Cycle", {
        period: cycle.period,
        mean_load: cycle.mean_load,
        amplitude: cycle.amplitude,
        approach_amplitude: cycle.approach_amplitude,
        dissipated: cycle.dissipated,
        stiffness: cycle.stiffness,
        loss_factor: cycle.loss_factor,
        approach: column(py, approach),
        load: column(py, load),
        cycles: cycle.cycles,
        change: cycle.change,
    })
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(steady_cycle, module)?)
}
