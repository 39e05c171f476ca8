//! Heights given node by node: measured, or computed elsewhere.

use nalgebra::DMatrix;

use super::placement::all_finite;
use crate::{Error, Grid, Surface};

/// Heights \[m\] of the nodes of a grid, positive towards the half-space.
///
/// Element `[(ix, iy)]` belongs to node (ix, iy): x is the first index; an image `[row, column]` must be
/// transposed. The map has no lengths of its own; the cell size comes with the [`Grid`], whose shape
/// must be that of the map.
///
/// ```
/// use asperity_surfaces::{Error, Grid, Surface, surface::HeightMap};
/// use asperity_surfaces::nalgebra::DMatrix;
///
/// # fn main() -> Result<(), Error> {
/// let map = HeightMap::new(DMatrix::from_row_slice(2, 3, &[0.0, 1e-6, 0.0, 0.0, -1e-6, 0.0]))?;
/// let grid = Grid::new(2, 3, 1e-3, 1e-3)?;
/// assert_eq!(map.heights(&grid)?[(0, 1)], 1e-6);
/// assert_eq!(map.mean_height(), 0.0);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct HeightMap {
    heights: DMatrix<f64>,
}

impl HeightMap {
    /// A map of the given heights \[m\].
    ///
    /// # Errors
    ///
    /// [`Error::EmptyGrid`] without any height, and [`Error::HeightNotFinite`], which counts the
    /// heights that are NaN or infinite and names the first of them: missing data of a measurement
    /// must be filled first, by [`fill_missing`](super::fill_missing). [`Error::NothingMeasured`] if all are NaN.
    pub fn new(heights: DMatrix<f64>) -> Result<Self, Error> {
        let (nx, ny) = heights.shape();
        if nx == 0 || ny == 0 {
            return Err(Error::EmptyGrid { nx, ny });
        }
        // Infinite ones may have overflown; missing are those that are NaN.
        if heights.iter().all(|z| z.is_nan()) {
            return Err(Error::NothingMeasured { nx, ny });
        }
        Ok(Self { heights: all_finite(heights)? })
    }

    /// A map of heights, at least one, that are known to be finite.
    pub(super) fn of_finite(heights: DMatrix<f64>) -> Self {
        Self { heights }
    }

    /// The heights of any surface on a grid, for its statistics or to keep them.
    ///
    /// # Errors
    ///
    /// Those of the surface, and those of [`HeightMap::new`].
    pub fn sample(surface: &(impl Surface + ?Sized), grid: &Grid) -> Result<Self, Error> {
        let heights = surface.heights(grid)?;
        grid.check_shape(heights.shape())?;
        Self::new(heights)
    }

    /// The heights \[m\].
    #[must_use]
    pub fn matrix(&self) -> &DMatrix<f64> {
        &self.heights
    }

    /// The heights \[m\], taken out of the map.
    #[must_use]
    pub fn into_matrix(self) -> DMatrix<f64> {
        self.heights
    }

    /// Number of nodes along x and y.
    #[must_use]
    pub fn shape(&self) -> (usize, usize) {
        self.heights.shape()
    }

    /// Height of the highest node \[m\].
    #[must_use]
    pub fn max_height(&self) -> f64 {
        self.heights.max()
    }

    /// Height of the lowest node \[m\].
    #[must_use]
    pub fn min_height(&self) -> f64 {
        self.heights.min()
    }

    /// Mean height `h̄` \[m\].
    #[must_use]
    pub fn mean_height(&self) -> f64 {
        if self.peak_to_valley() == 0.0 {
            // Exactly, so that nothing is left of a flat map without it.
            return self.max_height();
        }
        let unit = self.unit();
        unit * self.mean(|z| z / unit)
    }

    /// Height of the highest node above the lowest \[m\]: S_z of ISO 25178-2.
    #[must_use]
    pub fn peak_to_valley(&self) -> f64 {
        self.max_height() - self.min_height()
    }

    /// Arithmetical mean height \[m\], ISO 25178-2; no tilt is removed.
    ///
    /// ```math
    /// S_a = \langle |h - \bar h| \rangle
    /// ```
    #[must_use]
    pub fn mean_absolute_height(&self) -> f64 {
        self.unit() * self.mean_about_mean(f64::abs)
    }

    /// Root mean square height about the mean height \[m\]; no tilt is removed.
    ///
    /// ```math
    /// S_q = \sqrt{\langle (h - \bar h)^2 \rangle}
    /// ```
    #[must_use]
    pub fn rms_height(&self) -> f64 {
        self.unit() * self.mean_about_mean(|z| z * z).sqrt()
    }

    /// Skewness of the heights, 0 for a symmetric distribution; NaN if all are equal.
    ///
    /// ```math
    /// S_{sk} = \langle (h - \bar h)^3 \rangle / S_q^3
    /// ```
    #[must_use]
    pub fn skewness(&self) -> f64 {
        self.standardised(3)
    }

    /// Kurtosis of the heights, 3 for a normal distribution; NaN if all are equal.
    ///
    /// ```math
    /// S_{ku} = \langle (h - \bar h)^4 \rangle / S_q^4
    /// ```
    #[must_use]
    pub fn kurtosis(&self) -> f64 {
        self.standardised(4)
    }

    /// Root mean square gradient from forward differences, without unit.
    ///
    /// ```math
    /// h'_\mathrm{rms} = \sqrt{
    ///     \left\langle \left(\frac{h_{i+1,j} - h_{ij}}{\Delta x}\right)^2 \right\rangle +
    ///     \left\langle \left(\frac{h_{i,j+1} - h_{ij}}{\Delta y}\right)^2 \right\rangle }
    /// ```
    ///
    /// Each mean runs over the neighbours that exist, none across the border of the grid; a
    /// direction with a single node adds nothing. Differences see less of a wave the fewer nodes
    /// it has: of one with two nodes a wavelength, 2/π of its gradient. The gradient of a generated
    /// surface is exact in [`Spectrum::rms_gradient`](super::Spectrum::rms_gradient).
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if the grid has another shape than the map.
    pub fn rms_gradient(&self, grid: &Grid) -> Result<f64, Error> {
        grid.check_shape(self.shape())?;
        let (along_x, along_y) = self.mean_square_slopes(grid);
        Ok((along_x + along_y).sqrt())
    }

    /// Mean squares of the forward differences along x and along y, over the cells of `grid`, which has the shape of
    /// the map.
    pub(super) fn mean_square_slopes(&self, grid: &Grid) -> (f64, f64) {
        let (nx, ny) = self.shape();
        let along_x = mean_square_difference(
            self.heights.rows(0, nx - 1).iter(),
            self.heights.rows(1, nx - 1).iter(),
            grid.dx(),
        );
        let along_y = mean_square_difference(
            self.heights.columns(0, ny - 1).iter(),
            self.heights.columns(1, ny - 1).iter(),
            grid.dy(),
        );
        (along_x, along_y)
    }

    /// Mean of a power of the heights about their mean, over their rms height; NaN if all are equal.
    fn standardised(&self, power: i32) -> f64 {
        let rms = self.mean_about_mean(|z| z * z).sqrt();
        self.mean_about_mean(|z| (z / rms).powi(power))
    }

    /// Mean of a function of the heights about their mean, in [`Self::unit`]. Counted from the lowest first, they lose
    /// nothing to a height that all have.
    fn mean_about_mean(&self, value: impl Fn(f64) -> f64) -> f64 {
        let unit = self.unit();
        let lowest = self.min_height() / unit;
        let mean = self.mean(|z| z / unit - lowest);
        self.mean(|z| value(z / unit - lowest - mean))
    }

    /// A power of two of the size of the heights, by which they are divided so that neither sums nor squares over-
    /// or underflow: it changes no digit of anything else.
    fn unit(&self) -> f64 {
        let greatest = self.heights.amax();
        if greatest > 0.0 { libm::scalbn(1.0, libm::ilogb(greatest)) } else { 1.0 }
    }

    /// Mean of a function of the height, summed column by column to keep rounding small.
    fn mean(&self, value: impl Fn(f64) -> f64) -> f64 {
        let columns = self.heights.column_iter();
        let sum: f64 = columns.map(|column| column.iter().map(|z| value(*z)).sum::<f64>()).sum();
        sum / self.heights.len() as f64
    }
}

/// Mean of ((b − a) / step)², 0 over nothing.
fn mean_square_difference<'a>(
    a: impl ExactSizeIterator<Item = &'a f64>,
    b: impl Iterator<Item = &'a f64>,
    step: f64,
) -> f64 {
    let count = a.len().max(1);
    let sum: f64 = a.zip(b).map(|(a, b)| ((b - a) / step).powi(2)).sum();
    // A sum of nothing is −0.
    sum / count as f64 + 0.0
}

impl Surface for HeightMap {
    /// The heights of the map.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if the grid has another shape than the map.
    fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, Error> {
        grid.check_shape(self.shape())?;
        Ok(self.heights.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Axis, Wave};
    use nalgebra::dmatrix;

    #[test]
    fn malformed_maps_are_refused() {
        for (nx, ny) in [(0, 0), (0, 3), (3, 0)] {
            assert!(matches!(HeightMap::new(DMatrix::zeros(nx, ny)), Err(Error::EmptyGrid { .. })));
        }
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut heights = DMatrix::zeros(3, 4);
            heights[(2, 1)] = bad;
            assert!(matches!(
                HeightMap::new(heights),
                Err(Error::HeightNotFinite { ix: 2, iy: 1, .. })
            ));
        }
    }

    #[test]
    fn heights_need_a_grid_of_the_same_shape() -> Result<(), Error> {
        let map = HeightMap::new(dmatrix![1.0, 2.0, 3.0; 4.0, 5.0, 6.0])?;
        assert_eq!(map.heights(&Grid::new(2, 3, 1.0, 1.0)?)?, *map.matrix());
        let transposed = Grid::new(3, 2, 1.0, 1.0)?;
        assert!(matches!(
            map.heights(&transposed),
            Err(Error::GridMismatch { expected: (3, 2), found: (2, 3) })
        ));
        assert!(map.rms_gradient(&transposed).is_err());
        Ok(())
    }

    #[test]
    fn statistics_of_a_small_map() -> Result<(), Error> {
        let map = HeightMap::new(dmatrix![1.0, 1.0, 1.0; 1.0, 1.0, 7.0])?;
        assert_eq!(map.mean_height(), 2.0);
        assert_eq!((map.min_height(), map.max_height()), (1.0, 7.0));
        assert_eq!(map.peak_to_valley(), 6.0);
        // (5 * 1 + 5) / 6: a rounding.
        assert!((map.mean_absolute_height() - 5.0 / 3.0).abs() < 1e-15);
        // (5 * 1 + 25) / 6 = 5, and likewise (125 - 5) / 6 and (625 + 5) / 6: a few rounding errors.
        assert!((map.rms_height() - 5.0_f64.sqrt()).abs() < 1e-15);
        assert!((map.skewness() - 20.0 / 5.0_f64.powf(1.5)).abs() < 1e-14);
        assert!((map.kurtosis() - 105.0 / 25.0).abs() < 1e-14);
        // Along x (0, 0, 6) / 2, along y (0, 0, 0, 6) / 3.
        let gradient = map.rms_gradient(&Grid::new(2, 3, 2.0, 3.0)?)?;
        assert!((gradient - (3.0_f64 + 1.0).sqrt()).abs() < 1e-15);
        Ok(())
    }

    /// Heights that differ in their last bits alone: their mean has none between them.
    #[test]
    fn statistics_of_heights_far_from_zero() -> Result<(), Error> {
        let near = HeightMap::new(dmatrix![1.0, 1.0, 1.0; 1.0, 2.0, 7.0])?;
        let unit = f64::EPSILON;
        let far = HeightMap::new(near.matrix().map(|z| 1.0 + unit * z))?;
        let (sq, expected) = (far.rms_height(), unit * near.rms_height());
        // A few rounding errors.
        assert!((sq / expected - 1.0).abs() < 1e-15);
        let (sa, expected) = (far.mean_absolute_height(), unit * near.mean_absolute_height());
        assert!((sa / expected - 1.0).abs() < 1e-15);
        assert!((far.skewness() / near.skewness() - 1.0).abs() < 1e-14);
        Ok(())
    }

    #[test]
    fn a_single_node_has_no_gradient() -> Result<(), Error> {
        let map = HeightMap::new(dmatrix![3.0])?;
        assert_eq!(map.rms_gradient(&Grid::square(1, 1.0)?)?, 0.0);
        assert_eq!(map.rms_height(), 0.0);
        assert!(map.skewness().is_nan());
        Ok(())
    }

    #[test]
    fn statistics_of_a_wave() -> Result<(), Error> {
        let (n, side, d) = (4000, 1.0, 1e-3);
        let grid = Grid::with_sides(n, 1, side, 1.0)?;
        let map = HeightMap::sample(&Wave::new(d, side / 4.0, Axis::X)?, &grid)?;
        // Sums of whole periods of cosine powers are exact, up to 4000 rounding errors.
        assert!((map.rms_height() / (d / 2.0_f64.sqrt()) - 1.0).abs() < 1e-12);
        assert!((map.kurtosis() - 1.5).abs() < 1e-12);
        let gradient = std::f64::consts::TAU * 4.0 * d / 2.0_f64.sqrt();
        // Missing: one difference in 4000, and (q dx)²/24 = 1.6e-6 of each.
        assert!((map.rms_gradient(&grid)? / gradient - 1.0).abs() < 2e-4);
        Ok(())
    }
}
