//! Viscoelastic bodies.

mod columns;
mod contact;
mod cycle;
mod prony;
mod steps;

use pyo3::prelude::*;

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    prony::register(module)?;
    steps::register(module)?;
    contact::register(module)?;
    cycle::register(module)
}
