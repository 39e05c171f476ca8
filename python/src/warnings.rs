//! What looks wrong, as warnings of Python.

use std::ffi::CString;

use asperity::nalgebra::DMatrix;
use asperity::{Boundary, Error, Grid, Warning};
use pyo3::prelude::*;

use crate::errors::{Fallible, in_python};

/// Gives a warning of the class `AsperityWarning`, as coming from the line that called this package.
pub(crate) fn warn(py: Python<'_>, message: &str) -> Fallible<()> {
    let class = py.import("asperity.errors")?.getattr("AsperityWarning")?;
    // No text of the engine has a zero byte in it; a name of a file might.
    let text = CString::new(in_python(message).replace('\0', " "));
    let text = text.unwrap_or_default();
    Ok(PyErr::warn(py, &class, &text, 1)?)
}

/// What looks wrong with a contact; with its greatest pressure if a modulus is given. It looks for the patches of the whole
/// grid: without the lock of the interpreter.
pub(crate) fn of_contact(
    pressure: &DMatrix<f64>,
    contact_map: &DMatrix<bool>,
    on: (&Grid, Boundary),
    e_star: Option<f64>,
) -> Result<Vec<Warning>, Error> {
    let mut warnings = Warning::of_contact(pressure, contact_map, on)?;
    warnings.extend(e_star.and_then(|e_star| Warning::of_pressure(pressure.max(), e_star, None)));
    Ok(warnings)
}

/// Gives all of these warnings.
pub(crate) fn warn_all(
    py: Python<'_>,
    warnings: impl IntoIterator<Item = Warning>,
) -> Fallible<()> {
    warnings.into_iter().try_for_each(|warning| warn(py, &warning.to_string()))
}
