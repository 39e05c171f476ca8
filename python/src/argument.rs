//! Arguments of several types.

use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::errors::Failure;

/// Reads an argument as the first of some types that it is of, the variants of an enum, and says what it should have
/// been if it is of none.
macro_rules! one_of {
    ($name:ident, $expected:literal, $($variant:ident),+) => {
        impl<'a, 'py> pyo3::FromPyObject<'a, 'py> for $name {
            type Error = pyo3::PyErr;

            fn extract(given: pyo3::Borrowed<'a, 'py, pyo3::PyAny>) -> Result<Self, pyo3::PyErr> {
                $(match given.extract().map_err(Into::into) {
                    Ok(found) => return Ok(Self::$variant(found)),
                    Err(error) if !$crate::argument::is_of_type(&error, &given) => return Err(error),
                    Err(_) => {}
                })+
                Err($crate::argument::not_one(&given, $expected))
            }
        }
    };
}
pub(crate) use one_of;

/// Whether an argument was refused for its type or length, and not by itself or for its size.
pub(crate) fn is_of_type(error: &PyErr, given: &Bound<'_, PyAny>) -> bool {
    error.is_instance_of::<PyTypeError>(given.py())
        || error.is_instance_of::<PyValueError>(given.py())
}

/// That an argument is not what was expected.
pub(crate) fn not_one(given: &Bound<'_, PyAny>, expected: &str) -> PyErr {
    match given.repr() {
        Ok(given) => PyTypeError::new_err(format!("{expected} was expected, but this is {given}")),
        Err(error) => error,
    }
}

/// Reads whole numbers, one or several, and says which there are where one is below 0 or too large.
pub(crate) fn whole<'a, 'py, T>(given: &'a Bound<'py, PyAny>) -> PyResult<T>
where
    T: FromPyObject<'a, 'py, Error = PyErr>,
{
    given.extract().map_err(|error: PyErr| {
        if !error.is_instance_of::<PyOverflowError>(given.py()) {
            return error;
        }
        let most = u64::MAX;
        given.repr().map_or_else(
            |error| error,
            |given| {
                let message =
                    format!("whole numbers go from 0 to {most} here, but this is {given}");
                Failure::arguments(message).into()
            },
        )
    })
}
