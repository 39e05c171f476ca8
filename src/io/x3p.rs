//! To be written.

use std::path::Path;

use nalgebra::DMatrix;

use super::fault::Fault;
use super::raw::Parsed;
use crate::{Error, Grid};

pub(super) fn parse(_file: &[u8]) -> Parsed {
    Err(Fault::malformed("to be written"))
}

/// To be written.
pub fn write_x3p(
    _path: impl AsRef<Path>,
    _grid: &Grid,
    _heights: &DMatrix<f64>,
) -> Result<(), Error> {
    Ok(())
}
