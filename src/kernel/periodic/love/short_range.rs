//! The part of the kernel that does not reach beyond 25 cells: the cell under erfc(αr)/r.

use std::f64::consts::PI;

use crate::kernel::gauss::EIGHT;
use crate::{Boussinesq, Error, Grid, InfluenceKernel};

/// Inverse length at which the kernel is split, with the long side of a cell as the unit.
pub(super) const ALPHA: f64 = 0.25;

/// Distance from which on nothing is left: all cells whose nearest side is at 24.5 or beyond add up
/// to 3 × 10⁻¹⁸, of a total of 4.5.
const REACH: f64 = 25.0;

/// Distance up to which 1/r is too sharp for quadrature.
const NEAR: f64 = 2.5;

/// S(a, b) for E* = 1 at a, b ≥ 0, on cells whose long side is 1.
pub(super) struct ShortRange {
    columns: usize,
    values: Vec<f64>,
}

impl ShortRange {
    pub(super) fn new(dx: f64, dy: f64) -> Result<Self, Error> {
        let love = Boussinesq::new(Grid::new(1, 1, dx, dy)?, 1.0)?;
        let columns = (REACH / dx) as usize + 1;
        let rows = (REACH / dy) as usize + 1;
        let mut values = vec![0.0; columns * rows];
        for (b, row) in values.chunks_exact_mut(columns).enumerate() {
            for (a, value) in row.iter_mut().enumerate() {
                let (x, y) = (a as f64 * dx, b as f64 * dy);
                let distance = libm::hypot(x, y);
                let cell = |f: fn(f64) -> f64| integrate((x, y), (dx, dy), f) / PI;
                *value = if distance > REACH {
                    break;
                } else if distance > NEAR {
                    cell(libm::erfc)
                } else {
                    love.coefficient(a as isize, b as isize) - cell(libm::erf)
                };
            }
        }
        Ok(Self { columns, values })
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.values.len() / self.columns
    }

    /// S(a, b) for a = 0, 1, …
    pub(super) fn row(&self, b: usize) -> &[f64] {
        &self.values[b * self.columns..][..self.columns]
    }
}

/// ∫ f(αr) / r over the cell of `sides` about `center`, by 8 × 8 points.
///
/// Their number is even, so that none is at r = 0 when f(αr) / r is only continuous there. The
/// nearest singularity of the integrands is that of 1/r, on erfc at 2 from the centre of the
/// nearest cell: an 8-point rule converges as ϱ⁻¹⁶ with ϱ ≈ 10.
fn integrate(center: (f64, f64), sides: (f64, f64), f: impl Fn(f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for (node_y, weight_y) in EIGHT {
        for (node_x, weight_x) in EIGHT {
            let mut corners = 0.0;
            for (sign_x, sign_y) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
                let x = center.0 + 0.5 * sign_x * node_x * sides.0;
                let y = center.1 + 0.5 * sign_y * node_y * sides.1;
                let r = (x * x + y * y).sqrt();
                corners += f(ALPHA * r) / r;
            }
            sum += weight_x * weight_y * corners;
        }
    }
    0.25 * sides.0 * sides.1 * sum
}
