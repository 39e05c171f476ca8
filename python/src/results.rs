//! Small results, as the data classes of `asperity.results`.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::Fallible;

/// A result of a class, with its fields by name.
pub(crate) fn make<'py>(
    py: Python<'py>,
    class: &str,
    fields: &Bound<'py, PyDict>,
) -> Fallible<Bound<'py, PyAny>> {
    Ok(py.import("asperity.results")?.getattr(class)?.call((), Some(fields))?)
}

/// The result of a class from names and values.
macro_rules! result {
    ($py:expr, $class:literal, { $($name:ident: $value:expr),* $(,)? }) => {{
        let fields = pyo3::types::PyDict::new($py);
        $(fields.set_item(stringify!($name), $value)?;)*
        crate::results::make($py, $class, &fields)
    }};
}
pub(crate) use result;
