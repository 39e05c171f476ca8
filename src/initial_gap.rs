//! A surface as contact sees it: the gap before any load.

use crate::{Error, Grid, Surface};

/// The initial gap $g = \max z - z \ge 0$ of a surface on a grid.
#[derive(Debug, Clone)]
pub(crate) struct InitialGap {
    /// Gaps by node index.
    pub(crate) values: Vec<f64>,
    pub(crate) greatest: f64,
    /// Standard deviation of the heights, Sq.
    pub(crate) rms_height: f64,
}

impl InitialGap {
    /// Samples a surface.
    ///
    /// # Errors
    ///
    /// Those of the surface, [`Error::GridMismatch`] for heights of another grid,
    /// [`Error::HeightNotFinite`], and [`Error::OutOfRange`] if their differences overflow.
    pub(crate) fn of<S: Surface>(surface: &S, grid: &Grid) -> Result<Self, Error> {
        let heights = surface.heights(grid)?;
        grid.check_shape(heights.shape())?;
        for (node, &value) in heights.iter().enumerate() {
            if !value.is_finite() {
                let (ix, iy) = grid.coordinates(node);
                return Err(Error::HeightNotFinite { ix, iy, value });
            }
        }
        let highest = heights.max();
        let values: Vec<f64> = heights.iter().map(|height| highest - height).collect();
        let greatest = values.iter().copied().fold(0.0, f64::max);
        if !greatest.is_finite() {
            return Err(Error::OutOfRange {
                quantity: "difference of heights",
                value: greatest,
                expected: "finite",
            });
        }
        let mean = heights.mean();
        let squares = heights
            .iter()
            .map(|height| (height - mean) * (height - mean));
        let rms_height = (squares.sum::<f64>() / grid.nodes() as f64).sqrt();
        Ok(Self {
            values,
            greatest,
            rms_height,
        })
    }
}
