//! Arguments of several types.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

/// Reads an argument as the first of some types that it is of, the variants of an enum, and says what it should have
/// been if it is of none.
macro_rules! one_of {
    ($name:ident, $expected:literal, $($variant:ident),+) => {
        impl<'a, 'py> pyo3::FromPyObject<'a, 'py> for $name {
            type Error = pyo3::PyErr;

            fn extract(given: pyo3::Borrowed<'a, 'py, pyo3::PyAny>) -> Result<Self, pyo3::PyErr> {
                $(if let Ok(found) = given.extract() {
                    return Ok(Self::$variant(found));
                })+
                Err($crate::argument::not_one(&given, $expected))
            }
        }
    };
}
pub(crate) use one_of;

/// That an argument is not what was expected.
pub(crate) fn not_one(given: &Bound<'_, PyAny>, expected: &str) -> PyErr {
    match given.repr() {
        Ok(given) => PyTypeError::new_err(format!("{expected} was expected, but this is {given}")),
        Err(error) => error,
    }
}
