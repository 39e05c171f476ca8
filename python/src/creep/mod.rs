//! Viscoelastic bodies.

mod contact;
mod cycle;
mod prony;

use pyo3::prelude::*;

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    prony::register(module)?;
    contact::register(module)?;
    cycle::register(module)
}
