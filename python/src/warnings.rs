//! What looks wrong, as warnings of Python.

use std::ffi::CString;

use asperity::Warning;
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

/// Gives all of these warnings.
pub(crate) fn warn_all(
    py: Python<'_>,
    warnings: impl IntoIterator<Item = Warning>,
) -> Fallible<()> {
    warnings.into_iter().try_for_each(|warning| warn(py, &warning.to_string()))
}
