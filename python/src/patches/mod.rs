//! Contact patches.

mod along;
mod at;
mod distribution;

use pyo3::prelude::*;

pub(crate) use self::at::{PatchMap, label};

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    along::register(module)?;
    at::register(module)?;
    distribution::register(module)
}
