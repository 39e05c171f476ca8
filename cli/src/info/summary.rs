//! The numbers of a measured surface, of the nodes that are there.

use asperity::io::MeasuredSurface;
use nalgebra::DMatrix;

/// What is known of a surface before anything is done to it. Lengths in metres.
pub(super) struct Summary {
    pub(super) min: f64,
    pub(super) max: f64,
    pub(super) mean: f64,
    pub(super) sq: f64,
    /// From forward differences between nodes that are both there, `None` without a cell.
    pub(super) rms_gradient: Option<f64>,
}

impl Summary {
    /// Of the nodes that are there; NaN if none is.
    pub(super) fn of(measured: &MeasuredSurface) -> Self {
        let heights = &measured.heights;
        let present = || heights.iter().copied().filter(|height| height.is_finite());
        let count = present().count() as f64;
        let mean = present().sum::<f64>() / count;
        let variance = present().map(|height| (height - mean).powi(2)).sum::<f64>() / count;
        Self {
            min: present().reduce(f64::min).unwrap_or(f64::NAN),
            max: present().reduce(f64::max).unwrap_or(f64::NAN),
            mean,
            sq: variance.sqrt(),
            rms_gradient: measured.cell.map(|cell| rms_gradient(heights, cell)),
        }
    }
}

/// The square root of the mean squares of both slopes.
fn rms_gradient(heights: &DMatrix<f64>, (dx, dy): (f64, f64)) -> f64 {
    let (nx, ny) = heights.shape();
    let mean_square = |pairs: &mut dyn Iterator<Item = f64>| {
        let (mut sum, mut count) = (0.0, 0_usize);
        for slope in pairs.filter(|slope| slope.is_finite()) {
            sum += slope * slope;
            count += 1;
        }
        sum / count.max(1) as f64
    };
    let at = |ix: usize, iy: usize| heights[(ix, iy)];
    let mut along_x = (0..ny)
        .flat_map(|iy| (1..nx).map(move |ix| (ix, iy)))
        .map(|(ix, iy)| (at(ix, iy) - at(ix - 1, iy)) / dx);
    let mut along_y = (1..ny)
        .flat_map(|iy| (0..nx).map(move |ix| (ix, iy)))
        .map(|(ix, iy)| (at(ix, iy) - at(ix, iy - 1)) / dy);
    (mean_square(&mut along_x) + mean_square(&mut along_y)).sqrt()
}
