//! Love's rectangle: the elastic half-space under uniform pressure on one cell.

mod far;
mod near;

use std::f64::consts::PI;

use self::far::Far;
use super::{Boundary, ContactGrowth, InfluenceKernel, KernelOrigin};
use crate::{Error, Grid};

/// The elastic half-space with a free boundary, $`C(\mathbf d)`$ of a cell under uniform pressure
/// \[m/Pa\].
///
/// The Boussinesq solution integrated over a cell of $`\Delta_x \times \Delta_y`$, observed at the
/// centre of the cell $`\mathbf d = (d_i, d_j)`$ cells away:
///
/// ```math
/// C(d_i, d_j) = \frac{1}{\pi E^*}
///    \int_{-\Delta_x/2}^{\Delta_x/2} \int_{-\Delta_y/2}^{\Delta_y/2}
///    \frac{\mathrm d\xi ~ \mathrm d\eta}{\sqrt{(x-\xi)^2 + (y-\eta)^2}},
///    \qquad x = d_i \Delta_x,\quad y = d_j \Delta_y.
/// ```
///
/// Love's closed form of it, with $`F(x; y_1, y_2) = x [\operatorname{asinh}(y_2/|x|) -
/// \operatorname{asinh}(y_1/|x|)]`$, is eq. (3) of the paper, which calls it a point load:
///
/// ```math
/// \pi E^* C = F(x_+; y_-, y_+) - F(x_-; y_-, y_+) + F(y_+; x_-, x_+) - F(y_-; x_-, x_+),
/// ```
///
/// where $`x_\pm = x \pm \Delta_x / 2`$ and $`y_\pm = y \pm \Delta_y / 2`$.
///
/// On square cells $`C(0, 0) = 4 \ln(1 + \sqrt 2) \Delta / (\pi E^*)`$, and far away
/// $`C \to (\Delta / \pi E^*) (1/r) (1 + 1/(24 r^2) + \dots)`$ with `r` in cells.
///
/// # Accuracy
///
/// The closed form is a difference of numbers that grow with the distance: evaluated as it stands,
/// eight digits are left at 5800 cells. Here nothing cancels. Near the cell, 1/r is integrated along
/// the long side in closed form and across it by Gauss-Legendre quadrature: all terms are positive.
/// Far from it, the multipoles of the cell are small corrections to the first, each order in use up
/// to the distance at which it is below 10⁻¹⁶ of the whole.
///
/// Against 320-bit arithmetic the greatest relative error is 5 × 10⁻¹⁶, two units in the last place,
/// in samples of offsets up to 4096 cells for sides from 1 : 1 to 100 : 1 either way.
///
/// The coefficients are even in both offsets, and on square cells symmetric in them, bit for bit.
/// They scale exactly with the cell: nothing overflows on a grid of nanometres.
///
/// # Example
///
/// ```
/// use asperity::{Boussinesq, Grid, InfluenceKernel};
///
/// let kernel = Boussinesq::new(Grid::new(64, 64, 1e-6, 1e-6)?, 100e9)?;
/// let own = kernel.coefficient(0, 0);
/// let neighbour = kernel.coefficient(1, 0);
/// assert!((own - 1.1222e-17).abs() < 1e-21);
/// assert!(0.0 < neighbour && neighbour < own);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # References
///
/// * A. E. H. Love, The stress produced in a semi-infinite solid by pressure on part of the
///   boundary, Phil. Trans. R. Soc. A 228 (1929) 377.
/// * K. L. Johnson, Contact Mechanics, Cambridge University Press (1985), p. 54.
#[derive(Debug, Clone)]
pub struct Boussinesq {
    grid: Grid,
    e_star: f64,
    /// Long side of the cell over the short one.
    aspect: f64,
    /// Whether the long side runs along x.
    long_is_x: bool,
    self_influence: f64,
    /// Short side / (π E*).
    near_scale: f64,
    far: Far,
}

impl Boussinesq {
    /// Greatest ratio of the sides of a cell: squares of lengths must not overflow.
    const MAX_ASPECT: f64 = 1e100;

    /// The half-space of composite modulus `e_star` \[Pa\] under the cells of `grid`.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for `e_star`, or if C(0, 0) over- or underflows;
    /// [`Error::OutOfRange`] for cells more than 10¹⁰⁰ times as long as wide.
    pub fn new(grid: Grid, e_star: f64) -> Result<Self, Error> {
        let e_star = Error::require_positive("composite modulus", e_star)?;
        let (dx, dy) = (grid.dx(), grid.dy());
        let (long, short) = (dx.max(dy), dx.min(dy));
        let aspect = grid.cell_aspect();
        let quantity = "ratio of the sides of a cell";
        Error::require(quantity, aspect, aspect <= Self::MAX_ASPECT, "at most 1e100")?;
        let near_scale = short / (PI * e_star);
        let self_influence = near_scale * near::own_cell(aspect);
        Ok(Self {
            grid,
            e_star,
            aspect,
            long_is_x: dx >= dy,
            self_influence: Error::require_positive(
                "influence coefficient C(0, 0)",
                self_influence,
            )?,
            near_scale,
            far: Far::new(aspect, long / (PI * e_star)),
        })
    }

    /// Composite modulus E* \[Pa\].
    #[must_use]
    pub fn e_star(&self) -> f64 {
        self.e_star
    }
}

impl InfluenceKernel for Boussinesq {
    fn grid(&self) -> Grid {
        self.grid
    }

    /// [`Boundary::Free`].
    fn boundary(&self) -> Boundary {
        Boundary::Free
    }

    /// Love's influence matrix is an inverse M-matrix (checked on grids from 8² to 40², strips, and cells of
    /// aspect 1 to 10⁶ on small grids), and its principal submatrices inherit that.
    fn contact_growth(&self) -> ContactGrowth {
        ContactGrowth::Convex
    }

    /// Love's coefficient \[m/Pa\]; defined at every offset, on the grid or beyond.
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        let (di, dj) = (di.unsigned_abs() as f64, dj.unsigned_abs() as f64);
        // Lengths in units of the short side, x along the long one.
        let (x, y) = if self.aspect == 1.0 {
            // Either way round is the same: prefer the one that quadrature across converges best
            // for, and be symmetric to the last bit.
            (di.min(dj), di.max(dj))
        } else if self.long_is_x {
            (di * self.aspect, dj)
        } else {
            (dj * self.aspect, di)
        };
        let r2 = x * x + y * y;
        if r2 >= self.far.reach2() {
            self.far.value(x, y, r2)
        } else if r2 > 0.0 {
            self.near_scale * near::integral(self.aspect, x, y)
        } else {
            self.self_influence
        }
    }

    fn origin(&self) -> KernelOrigin {
        KernelOrigin::Boussinesq { e_star: self.e_star() }
    }
}
