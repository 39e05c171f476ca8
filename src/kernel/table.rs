//! All influence coefficients of a grid, ready for look-up without index arithmetic.

mod coarse;

pub(crate) use coarse::Blocks;

use super::{Boundary, InfluenceKernel};
use crate::{Error, Grid};

/// The coefficients C(di, dj) for all offsets |di| < nx, |dj| < ny of a kernel.
///
/// Each node has a *place* in the table, such that the coefficient between two nodes is found at
/// the difference of their places: filling a column of the influence matrix costs one subtraction
/// and one load per element.
#[derive(Debug, Clone)]
pub struct KernelTable {
    grid: Grid,
    boundary: Boundary,
    /// (2 nx − 1) × (2 ny − 1) coefficients, di fastest, offset (0, 0) in the middle.
    values: Vec<f64>,
}

impl KernelTable {
    /// Evaluates `kernel` at every offset of its grid.
    ///
    /// # Errors
    ///
    /// [`Error::KernelNotFinite`], [`Error::KernelNotSymmetric`], [`Error::KernelNotPeriodic`] if
    /// the boundary is periodic and the coefficients are not, and [`Error::NotPositiveDefinite`] if
    /// C(0, 0) is not positive.
    pub fn new<K: InfluenceKernel + ?Sized>(kernel: &K) -> Result<Self, Error> {
        let grid = kernel.grid();
        let (nx, ny) = (grid.nx() as isize, grid.ny() as isize);
        let mut values = Vec::with_capacity((2 * grid.nx() - 1) * (2 * grid.ny() - 1));
        for dj in 1 - ny..ny {
            for di in 1 - nx..nx {
                let value = kernel.coefficient(di, dj);
                if !value.is_finite() {
                    return Err(Error::KernelNotFinite { di, dj, value });
                }
                values.push(value);
            }
        }
        let boundary = kernel.boundary();
        let table = Self {
            grid,
            boundary,
            values,
        };
        table.check_reciprocity()?;
        if boundary == Boundary::Periodic {
            table.check_periodicity()?;
        }
        let self_influence = table.self_influence();
        if self_influence <= 0.0 {
            return Err(Error::NotPositiveDefinite {
                ix: 0,
                iy: 0,
                approach: 0.0,
                pivot: self_influence,
            });
        }
        Ok(table)
    }

    fn check_reciprocity(&self) -> Result<(), Error> {
        let opposites = self.values.iter().zip(self.values.iter().rev());
        for (place, (&value, &opposite)) in opposites.enumerate().take(self.center()) {
            if !self.agree(value, opposite) {
                let (di, dj) = self.offset(place);
                return Err(Error::KernelNotSymmetric {
                    di,
                    dj,
                    value,
                    opposite,
                });
            }
        }
        Ok(())
    }

    /// Compares every coefficient with those one period further, where the table has them.
    fn check_periodicity(&self) -> Result<(), Error> {
        let (nx, ny) = self.grid.shape();
        let width = 2 * nx - 1;
        for (place, &value) in self.values.iter().enumerate() {
            let (column, row) = (place % width, place / width);
            let along_x = (column + nx < width).then_some(place + nx);
            let along_y = (row + ny < 2 * ny - 1).then_some(place + ny * width);
            for image in [along_x, along_y].into_iter().flatten() {
                let repeated = self.values[image];
                if !self.agree(value, repeated) {
                    let (di, dj) = self.offset(place);
                    let (image_di, image_dj) = self.offset(image);
                    return Err(Error::KernelNotPeriodic {
                        di,
                        dj,
                        value,
                        image_di,
                        image_dj,
                        repeated,
                    });
                }
            }
        }
        Ok(())
    }

    /// Whether two coefficients that ought to be the same are.
    fn agree(&self, value: f64, other: f64) -> bool {
        // Twice a few ulps: a formula may be evaluated in another order for another offset.
        const TOLERANCE: f64 = 1e-14;
        let scale = self.self_influence().abs();
        (value - other).abs() <= TOLERANCE * value.abs().max(other.abs()).max(scale * 1e-2)
    }

    /// The offset at a place of the table.
    fn offset(&self, place: usize) -> (isize, isize) {
        let (nx, ny) = self.grid.shape();
        let width = 2 * nx - 1;
        let signed = |index: usize, n: usize| index as isize - (n as isize - 1);
        (signed(place % width, nx), signed(place / width, ny))
    }

    /// The grid of the coefficients.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// What surrounds the grid.
    #[must_use]
    pub fn boundary(&self) -> Boundary {
        self.boundary
    }

    /// The gauge s of a periodic kernel \[m/Pa\]: the mean of its coefficients; `None` if the
    /// boundary is free.
    ///
    /// With it the mean displacement under pressures p is $\bar u = s \sum p$, and what does not
    /// depend on the gauge follows from an approach δ and a displacement u in this one: the approach
    /// of the mean planes is $\delta - s \sum p$, the displacement about its mean $u - s \sum p$.
    #[must_use]
    pub fn gauge(&self) -> Option<f64> {
        let (nx, ny) = self.grid.shape();
        let periodic = self.boundary == Boundary::Periodic;
        periodic.then(|| {
            // The offsets that are not negative are one period.
            let rows = self.values[self.center()..].chunks(2 * nx - 1).take(ny);
            let sum: f64 = rows.map(|row| row[..nx].iter().sum::<f64>()).sum();
            sum / self.grid.nodes() as f64
        })
    }

    /// The same kernel with a uniform displacement added, so that the gauge becomes `gauge`; itself if
    /// the boundary is free.
    pub(crate) fn in_gauge(&self, gauge: f64) -> Self {
        let mut table = self.clone();
        if let Some(present) = self.gauge() {
            for value in &mut table.values {
                *value = *value - present + gauge;
            }
        }
        table
    }

    /// The gauge for computing: of the size of the least one in which a kernel like Love's is an
    /// inverse M-matrix, and of no influence on results. `None` if the boundary is free.
    ///
    /// In the zero gauge the least coefficient is that of the farthest node. That gauge is 1.5 times
    /// its absolute value, on a square of many nodes with Love's kernel: 0.74 L / (E* M), near s\*.
    pub(crate) fn computing_gauge(&self) -> Option<f64> {
        let mean = self.gauge()?;
        let least = self.values.iter().copied().fold(f64::INFINITY, f64::min) - mean;
        // A single node has no other, and nothing but its gauge.
        Some(if least < 0.0 { -1.5 * least } else { mean })
    }

    /// The coefficient at offset (di, dj), or `None` if it lies outside the grid.
    #[must_use]
    pub fn coefficient(&self, di: isize, dj: isize) -> Option<f64> {
        let (nx, ny) = (self.grid.nx() as isize, self.grid.ny() as isize);
        if di.abs() >= nx || dj.abs() >= ny {
            return None;
        }
        let index = (di + nx - 1) + (dj + ny - 1) * (2 * nx - 1);
        self.values.get(index as usize).copied()
    }

    /// The displacement of a cell under its own unit pressure, C(0, 0).
    #[must_use]
    pub fn self_influence(&self) -> f64 {
        self.values[self.center()]
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        self.values.len() * size_of::<f64>()
    }

    /// Place of offset (0, 0).
    fn center(&self) -> usize {
        self.values.len() / 2
    }

    /// Place of a node, for [`KernelTable::between`].
    pub(crate) fn place(&self, node: usize) -> usize {
        let (ix, iy) = self.grid.coordinates(node);
        ix + iy * (2 * self.grid.nx() - 1)
    }

    /// The coefficient between two nodes given by their places.
    #[inline]
    pub(crate) fn between(&self, place: usize, other: usize) -> f64 {
        self.values[self.center() + place - other]
    }

    /// Writes the coefficients between the node at `place` and those at `others` into `column`.
    pub(crate) fn fill_column(&self, place: usize, others: &[usize], column: &mut [f64]) {
        let base = self.center() + place;
        for (value, &other) in column.iter_mut().zip(others) {
            *value = self.values[base - other];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::PeriodicBoussinesq;

    #[test]
    fn another_gauge_is_a_uniform_displacement() -> Result<(), Error> {
        let grid = Grid::new(12, 9, 1.0, 1.0)?;
        let kernel = PeriodicBoussinesq::new(grid, 1.0)?;
        let table = KernelTable::new(&kernel)?;
        let zero = table.in_gauge(0.0);
        // Means of 108 numbers near 1.
        assert!(zero.gauge().is_some_and(|gauge| gauge.abs() < 1e-15));
        let own = table.coefficient(5, 4).unwrap_or(f64::NAN) - kernel.gauge();
        let found = zero.coefficient(5, 4).unwrap_or(f64::NAN);
        assert!((found - own).abs() < 1e-15);
        // Of the size of the least gauge that makes the kernel an inverse M-matrix.
        let ratio =
            table.computing_gauge().unwrap_or(f64::NAN) / kernel.least_gauge().unwrap_or(f64::NAN);
        assert!((0.8..1.3).contains(&ratio), "{ratio}");
        Ok(())
    }
}
