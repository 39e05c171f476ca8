//! Paths as arguments of what takes none with adhesion.

use std::ops::Deref;

use pyo3::prelude::*;

use crate::adhesion::AdhesivePath;
use crate::errors::Failure;
use crate::path::LoadingPath;

/// A path on which contact only grows and presses.
pub(crate) struct ElasticPath<'py>(PyRef<'py, LoadingPath>);

impl Deref for ElasticPath<'_> {
    type Target = LoadingPath;

    fn deref(&self) -> &LoadingPath {
        &self.0
    }
}

impl<'a, 'py> FromPyObject<'a, 'py> for ElasticPath<'py> {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        if given.is_instance_of::<AdhesivePath>() {
            let message = "a path with adhesion was given, and this is made of contact that only grows and presses";
            return Err(Failure::arguments(message).into());
        }
        Ok(Self(given.extract()?))
    }
}
