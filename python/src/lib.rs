//! The package `asperity` of Python: the library, with arrays of NumPy, exceptions and signals.
//!
//! Nothing is computed here. Each file has one topic, with a function `register` that adds its classes and functions.

mod adhesion;
mod argument;
mod arrays;
mod choice;
mod compute;
mod creep;
mod elastic_path;
mod errors;
mod fixed_load;
mod given;
mod half_space;
mod history;
mod increments;
mod joint;
mod leak;
mod materials;
mod own_kernels;
mod patches;
mod path;
mod report;
mod results;
mod slip;
mod state;
mod stress;
mod surface;
mod targets;
mod warnings;

use pyo3::prelude::*;

/// The engine.
#[pymodule]
fn _asperity(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    compute::register(module)?;
    surface::register(module)?;
    half_space::register(module)?;
    materials::register(module)?;
    state::register(module)?;
    history::register(module)?;
    path::register(module)?;
    path::setup::register(module)?;
    adhesion::register(module)?;
    report::register(module)?;
    fixed_load::register(module)?;
    patches::register(module)?;
    leak::register(module)?;
    stress::register(module)?;
    slip::register(module)?;
    creep::register(module)?;
    joint::register(module)
}
