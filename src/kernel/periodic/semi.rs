//! The half-space that repeats in one direction.

use std::f64::consts::PI;

use super::{PeriodicBoussinesq, check_periodic_cells, love};
use crate::kernel::gauss::TWENTY;
use crate::kernel::{Boundary, ContactGrowth, InfluenceKernel, KernelOrigin};
use crate::surface::Axis;
use crate::{Error, Grid};

/// Periods between the grid and its image across, in the periodic kernel that this one is made from.
const APART: f64 = 5.0;

/// The half-space that is periodic in one direction and free in the other, $`C(\mathbf d)`$ of a cell under uniform
/// pressure \[m/Pa\].
///
/// A cell and all its images along x, at distances of the side L = nx Δx of the grid, carry the same uniform pressure,
/// as with [`PeriodicBoussinesq`]; beyond the edges along y there is no pressure, as with
/// [`Boussinesq`](crate::Boussinesq). So do a long ridge, a seal or a roller whose profile varies across and whose
/// roughness repeats along. With [`Axis::Y`] it is the other way round.
///
/// # What the approach is counted from
///
/// The images have no end, and the displacement under them has no bound: that of the 2N + 1 nearest ones,
///
/// ```math
/// C_N(\mathbf d) = \sum_{k = -N}^{N} C_\mathrm{Love}(d_x + k n_x, d_y) \to
///     \frac{2 A}{\pi E^* L} \ln \frac{\ell}{|y|}, \qquad \ell = (2 N + 1) L ,
/// ```
///
/// far from them, grows with the logarithm of the length ℓ of their row; A is the area of a cell. The coefficients are
/// those of a row of length R, the [`reference_length`](Self::reference_length):
///
/// ```math
/// C(\mathbf d) = \lim_{N \to \infty} \Bigl( C_N(\mathbf d) - \frac{2 A}{\pi E^* L} \ln \frac{\ell}{R} \Bigr),
///     \qquad R = 2 \sqrt{L^2 + L_\perp^2} ,
/// ```
///
/// twice the diagonal of the grid. Displacement and approach are counted from points at a distance of about R across,
/// which under the load W do not move. Another length R′ adds a uniform displacement, and changes neither pressures nor
/// gaps nor the order of events:
///
/// ```math
/// \delta' = \delta + \frac{2 W}{\pi E^* L} \ln \frac{R'}{R} , \qquad
///     \frac{1}{K'} = \frac{1}{K} + \frac{2}{\pi E^* L} \ln \frac{R'}{R} .
/// ```
///
/// In a plane problem, a cylinder on a half-space, it is the same: the approach depends on the depth or distance from
/// which it is counted. The interfacial stiffness and the mean gap are independent of R.
///
/// # Evaluation
///
/// From the [periodic kernel](PeriodicBoussinesq) of period P = Lᵧ + 5 L across. Its waves that vary along x decay as
/// exp(−2π|y|/L), so that those of the images across are not felt; what does not vary along x is the plane problem,
/// whose images add up in closed form:
///
/// ```math
/// C(\mathbf d) = C^{(0)}_P(\mathbf d) + \frac{2 A}{\pi E^* L} \Bigl\langle
///     \ln \frac{2 R\, |\sin (\pi y / P)|}{|y|} \Bigr\rangle ,
/// ```
///
/// averaged over the width of a cell at y. The images left out are below 5 × 10⁻¹⁵ C(0, 0); the rest is as exact as the
/// periodic kernel, 10⁻¹⁵ C(0, 0) on square cells. Making it takes the time and memory of the periodic kernel on a grid
/// of period P.
///
/// # Growth of contact
///
/// Where R is great enough the influence matrix is an inverse M-matrix, so that gaps are convex in the approach. In the
/// plane limit, a strip of the width Lᵧ ≫ L, that is R > e² Lᵧ / 4 = 1.85 Lᵧ; on grids from 2 × 1 to 30 × 30 nodes with
/// cells from 1 : 10 to 100 : 1 the least R is between 0.31 and 1.79 times the diagonal.
///
/// # Example
///
/// ```
/// use asperity::kernel::SemiPeriodicBoussinesq;
/// use asperity::surface::Axis;
/// use asperity::{Grid, InfluenceKernel};
///
/// let kernel = SemiPeriodicBoussinesq::new(Grid::square(32, 1e-3)?, 115e9, Axis::X)?;
/// // 31 cells away along x is one cell away; along y it is far.
/// assert_eq!(kernel.coefficient(31, 0), kernel.coefficient(-1, 0));
/// assert!(kernel.coefficient(0, 31) < 0.5 * kernel.coefficient(0, 1));
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct SemiPeriodicBoussinesq {
    grid: Grid,
    e_star: f64,
    along: Axis,
    reference: f64,
    /// Along the period from 0 to half of it, fastest, and across at offsets that are not negative.
    coefficients: Vec<f64>,
}

impl SemiPeriodicBoussinesq {
    /// The half-space of composite modulus `e_star` \[Pa\] under the cells of `grid`, periodic `along` one of its
    /// sides.
    ///
    /// # Errors
    ///
    /// Those of [`PeriodicBoussinesq::new`], and [`Error::OutOfRange`] if the grid of period P has more than 2³⁰ nodes,
    /// as many as the greatest [`Grid`] there is: on square cells from some 14 600 nodes along the period on.
    pub fn new(grid: Grid, e_star: f64, along: Axis) -> Result<Self, Error> {
        check_periodic_cells(&grid, PeriodicBoussinesq::MAX_ASPECT, "at most 1000")?;
        let e_star = Error::require_positive("composite modulus", e_star)?;
        // x along the period here, and lengths in units of the long side of a cell.
        let long = grid.dx().max(grid.dy());
        let (dx, dy) = (grid.dx() / long, grid.dy() / long);
        let (nx, ny) = grid.shape();
        let ((nx, dx), (ny, dy)) = match along {
            Axis::X => ((nx, dx), (ny, dy)),
            Axis::Y => ((ny, dy), (nx, dx)),
        };
        let (length, width) = (nx as f64 * dx, ny as f64 * dy);
        // Across it may have more nodes than a grid can.
        let wide = ny as f64 + (APART * length / dy).ceil();
        let most = (Grid::MAX_SIDE * Grid::MAX_SIDE) as f64;
        let quantity = "nodes along the period times those across, continued by five periods,";
        let nodes = nx as f64 * wide;
        Error::require(quantity, nodes, nodes <= most, "at most 2^30")?;
        let images = love::symbol((nx, wide as usize), (dx, dy))?.inverse_transform();
        let reference = 2.0 * length.hypot(width);
        let plane = Plane { period: wide * dy, reference, cell: dy };
        let unit = 2.0 * dx * dy / (PI * length);
        let scale = long / e_star;
        let half = nx / 2 + 1;
        let mut coefficients = Vec::with_capacity(half * ny);
        for j in 0..ny {
            let uniform = unit * plane.mean(j as f64 * dy);
            let row = (0..half).map(|i| scale * (images.at(i as isize, j as isize) + uniform));
            coefficients.extend(row);
        }
        Error::require_positive("influence coefficient C(0, 0)", coefficients[0])?;
        Ok(Self { grid, e_star, along, reference: reference * long, coefficients })
    }

    /// Composite modulus E* \[Pa\].
    #[must_use]
    pub fn e_star(&self) -> f64 {
        self.e_star
    }

    /// The direction in which it repeats.
    #[must_use]
    pub fn along(&self) -> Axis {
        self.along
    }

    /// The length R \[m\] of a finite row of images that displaces as much.
    #[must_use]
    pub fn reference_length(&self) -> f64 {
        self.reference
    }
}

/// What does not vary along the period: lines of pressure, with images across at distances of `period`.
struct Plane {
    period: f64,
    reference: f64,
    cell: f64,
}

impl Plane {
    /// ⟨ln(2 R |sin(π y / P)| / |y|)⟩ over the width of a cell. It is singular at the next image only, five widths of a
    /// cell and more away.
    fn mean(&self, y: f64) -> f64 {
        let at = |y: f64| {
            let turn = PI * y / self.period;
            // sin x / x, which is 1 at 0.
            let ratio = if turn == 0.0 { 1.0 } else { libm::sin(turn) / turn };
            libm::log(2.0 * PI * self.reference / self.period * ratio.abs())
        };
        let half = 0.5 * self.cell;
        let terms = TWENTY.iter().rev();
        0.5 * terms
            .map(|&(node, weight)| weight * (at(y - half * node) + at(y + half * node)))
            .sum::<f64>()
    }
}

impl InfluenceKernel for SemiPeriodicBoussinesq {
    fn grid(&self) -> Grid {
        self.grid
    }

    /// [`Boundary::PeriodicX`] or [`Boundary::PeriodicY`].
    fn boundary(&self) -> Boundary {
        match self.along {
            Axis::X => Boundary::PeriodicX,
            Axis::Y => Boundary::PeriodicY,
        }
    }

    /// [`ContactGrowth::Convex`]: the reference length is above the least one with which the matrix is an inverse M-matrix.
    fn contact_growth(&self) -> ContactGrowth {
        ContactGrowth::Convex
    }

    /// \[m/Pa\]; NaN at offsets beyond the grid in the direction in which it ends.
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        let (nx, ny) = self.grid.shape();
        let ((di, nx), (dj, ny)) = match self.along {
            Axis::X => ((di, nx), (dj, ny)),
            Axis::Y => ((dj, ny), (di, nx)),
        };
        let (i, j) = (di.unsigned_abs() % nx, dj.unsigned_abs());
        if j < ny { self.coefficients[i.min(nx - i) + (nx / 2 + 1) * j] } else { f64::NAN }
    }

    fn origin(&self) -> KernelOrigin {
        KernelOrigin::SemiPeriodicBoussinesq { e_star: self.e_star, boundary: self.boundary() }
    }
}

#[cfg(test)]
mod tests;
