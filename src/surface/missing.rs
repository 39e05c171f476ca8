//! Missing data of a measurement.

use nalgebra::DMatrix;

use crate::Error;

/// Number of heights that are NaN or infinite.
#[must_use]
pub fn count_missing(heights: &DMatrix<f64>) -> usize {
    heights.iter().filter(|z| !z.is_finite()).count()
}

/// Fills missing heights.
///
/// # Errors
///
/// To be written.
pub fn fill_missing(heights: DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
    Ok(heights)
}
