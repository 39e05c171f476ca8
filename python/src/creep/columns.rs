//! States over time as columns.

use asperity::creep::CreepState;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::column;
use crate::errors::Fallible;

/// States over time as columns.
pub(super) fn columns<'py>(py: Python<'py>, states: &[CreepState]) -> Fallible<Bound<'py, PyDict>> {
    let of = |get: fn(&CreepState) -> f64| column(py, states.iter().map(get).collect::<Vec<f64>>());
    let columns = PyDict::new(py);
    columns.set_item("time", of(|state| state.time))?;
    columns.set_item("load", of(|state| state.load))?;
    columns.set_item("effective_load", of(|state| state.effective_load))?;
    columns.set_item("approach", of(|state| state.approach))?;
    let nodes = states.iter().map(|state| state.contact_nodes as i64).collect();
    columns.set_item("contact_nodes", column::<i64>(py, nodes))?;
    columns.set_item("contact_area", of(|state| state.contact_area))?;
    columns.set_item("area_fraction", of(|state| state.contact_area_fraction))?;
    columns.set_item("mean_gap", of(|state| state.mean_gap))?;
    Ok(columns)
}
