//! Love's rectangle, repeated: the periodic half-space under uniform pressure on each cell.

mod short_range;

use super::cosines::{CosineSeries, sinc};
use super::even::Even;
use super::symmetric::{self, Symmetric, half_space, in_long_sides, least_gauge, wave_number};
use crate::kernel::check_periodic_cells;
use crate::kernel::gauge::of_half_space;
use crate::kernel::{Boundary, ContactGrowth, InfluenceKernel, KernelOrigin};
use crate::{Error, Grid};
use short_range::{ALPHA, ShortRange};

/// The periodic half-space, $`C(\mathbf d)`$ of a cell under uniform pressure \[m/Pa\].
///
/// Every cell and all its images, one in each period of $`L_x \times L_y`$, carry the same uniform
/// pressure, and the displacement is observed at the centres of the cells, as with
/// [`Boussinesq`](crate::Boussinesq). Its symbol is a sum over all waves that look alike on the grid:
///
/// ```math
/// \hat C(k_1, k_2) = \frac{2}{E^*} \sum_{m_1, m_2 = -\infty}^\infty
///    \frac{\operatorname{sinc}(k_1 / n_x + m_1) \operatorname{sinc}(k_2 / n_y + m_2)}
///         {|\mathbf Q_{\mathbf m}|}, \qquad
///    \mathbf Q_{\mathbf m} = 2 \pi \Bigl( \frac{k_1 / n_x + m_1}{\Delta_x},
///    \frac{k_2 / n_y + m_2}{\Delta_y} \Bigr),
/// ```
///
/// with $`\operatorname{sinc} x = \sin(\pi x) / (\pi x)`$ and $`\hat C(\mathbf k) = \sum_{\mathbf r}
/// C(\mathbf r)\, e^{-2 \pi i (k_1 r_1 / n_x + k_2 r_2 / n_y)}`$. It depends on the wave vector and
/// the cell, not on the number of nodes: on square cells $`E^* \hat C(n_x / 2, 0) / \Delta =
/// 8 G / \pi^2`$ with Catalan's constant G on any grid.
///
/// # Evaluation
///
/// The sum over aliases converges slowly. Ewald's split of 1/r = erf(αr)/r + erfc(αr)/r with
/// α = 1 / (4 D), D the long side of a cell, makes both parts finite:
///
/// ```math
/// \hat C = \frac{2}{E^* |\mathbf q|} \operatorname{erfc} \frac{|\mathbf q|}{2 \alpha}
///    \operatorname{sinc} \frac{k_1}{n_x} \operatorname{sinc} \frac{k_2}{n_y} +
///    \sum_{a, b} S(a, b) \cos \frac{2 \pi a k_1}{n_x} \cos \frac{2 \pi b k_2}{n_y},
/// ```
///
/// ```math
/// S(a, b) = \frac{1}{\pi E^*} \int_{\text{cell } (a, b)}
///    \frac{\operatorname{erfc} \alpha r}{r} ~ \mathrm dA .
/// ```
///
/// The first alias of the smooth part is below erfc(2π) = 6 × 10⁻¹⁹, and S falls below 10⁻¹⁸ at
/// 25 D. Near the cell, S is Love's formula less a quadrature of erf(αr)/r, which is smooth; farther
/// than 2.5 D it is a quadrature of erfc(αr)/r itself, since there the difference would cancel.
///
/// Against the sum over aliases, accelerated, the greatest relative error of the symbol is
/// 2 × 10⁻¹⁵ on cells up to 1 : 4, and grows in proportion to the aspect beyond (3 × 10⁻¹⁴ at
/// 1 : 100). Real-space coefficients, from an inverse Fourier transform, err by 10⁻¹⁵ C(0, 0).
///
/// # Gauge
///
/// The mean displacement of a periodic half-space under a net load is arbitrary. In the *zero gauge*
/// the mean is zero, $`\hat C(0) = 0`$; in the gauge s a uniform displacement is added,
///
/// ```math
/// C(\mathbf r) = C^{(0)}(\mathbf r) + s, \qquad \hat C(0) = s M, \qquad
///    \bar u = s \sum p, \qquad M = n_x n_y .
/// ```
///
/// No gauge changes a pressure, a gap, or the order in which nodes touch. It only changes what the approach is counted
/// from: `δ_s = δ₀ + s Σp`, where `δ₀` is the approach of the mean planes. [`InfluenceKernel::coefficient`] is in the
/// gauge [`gauge`](Self::gauge), and [`symbol`](Self::symbol) in the zero gauge.
///
/// The gauge decides, however, whether the matrix is an inverse M-matrix, in which case gaps are convex
/// functions of the approach; the matrix of the free half-space is one. With A(r) the pseudo-inverse,
/// which is the inverse transform of $`1 / \hat C`$ without k = 0,
///
/// ```math
/// C_s^{-1} = A + \frac{1}{s M^2}, \qquad \text{off-diagonals} \le 0 \iff
///    s \ge s^* = \frac{1}{M^2 \min_{\mathbf r \ne 0} (-A(\mathbf r))} .
/// ```
///
/// As made, the kernel has the gauge 1.02 s\*. On a square of L and many nodes
/// $`s^* M \to 0.7608 ~ L / E^*`$.
///
/// # Example
///
/// ```
/// use asperity::{Grid, InfluenceKernel, PeriodicBoussinesq};
///
/// let kernel = PeriodicBoussinesq::new(Grid::new(8, 8, 1.0, 1.0)?, 1.0)?;
/// assert!((kernel.symbol(4, 0) - 0.742453745421544).abs() < 1e-14);
/// // Periodic: seven cells away is one cell away.
/// assert_eq!(kernel.coefficient(7, 0), kernel.coefficient(-1, 0));
/// // In the zero gauge:
/// let own = kernel.coefficient(0, 0) - kernel.gauge();
/// assert!((own - 0.967247073979926).abs() < 1e-14);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # References
///
/// * P. P. Ewald, Die Berechnung optischer und elektrostatischer Gitterpotentiale, Ann. Phys. 369
///   (1921) 253, for the split.
/// * H. M. Stanley and T. Kato, An FFT-based method for rough surface contact, J. Tribol. 119
///   (1997) 481, for periodic contact.
/// * A. E. H. Love, Phil. Trans. R. Soc. A 228 (1929) 377, for the cell.
#[derive(Debug, Clone)]
pub struct PeriodicBoussinesq {
    half_space: Symmetric,
}

impl PeriodicBoussinesq {
    /// Greatest ratio of the sides of a cell: the sum of S has 25 × 25 times as many terms.
    pub const MAX_ASPECT: f64 = 1000.0;

    /// The periodic half-space of composite modulus `e_star` \[Pa\] under the cells of `grid`, in
    /// the gauge 1.02 s\*.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for `e_star`, or if C(0, 0) over- or underflows;
    /// [`Error::OutOfRange`] for cells more than [`MAX_ASPECT`](Self::MAX_ASPECT) times as long as
    /// wide.
    pub fn new(grid: Grid, e_star: f64) -> Result<Self, Error> {
        check_periodic_cells(&grid, Self::MAX_ASPECT, "at most 1000")?;
        let cells = in_long_sides(&grid)?;
        let symbol = symbol(cells.shape(), (cells.dx(), cells.dy()))?;
        let gauge = of_half_space(&cells, least_gauge(&cells, &symbol));
        Ok(Self { half_space: Symmetric::new(grid, e_star, &symbol, gauge)? })
    }
}

half_space! {
    PeriodicBoussinesq,
    /// In a gauge that is large enough, such as the one [`PeriodicBoussinesq::new`] chooses, the
    /// influence matrix is an inverse M-matrix. In a smaller one it is not, but the signs of `y₂` and `r₂`
    /// are the same in every gauge.
    fn contact_growth(&self) -> ContactGrowth {
        match self.least_gauge() {
            Some(least) if self.gauge() >= least => ContactGrowth::Convex,
            Some(_) => ContactGrowth::Monotone,
            None => ContactGrowth::Unknown,
        }
    }
}

/// The symbol for E* = 1 on cells whose long side is 1.
pub(super) fn symbol((nx, ny): (usize, usize), (dx, dy): (f64, f64)) -> Result<Even, Error> {
    let short_range = ShortRange::new(dx, dy)?;
    // The sum over the rows b of S, for each wave along x and each row.
    let rows = short_range.rows();
    let (series_x, series_y) = (CosineSeries::new(nx), CosineSeries::new(ny));
    let mut along_x = vec![0.0; (nx / 2 + 1) * rows];
    for (kx, sums) in along_x.chunks_exact_mut(rows).enumerate() {
        for (b, sum) in sums.iter_mut().enumerate() {
            *sum = series_x.sum(short_range.row(b), kx);
        }
    }
    Ok(Even::from_fn((nx, ny), |kx, ky| {
        if (kx, ky) == (0, 0) {
            return 0.0;
        }
        let sums = &along_x[kx * rows..][..rows];
        let qx = wave_number(kx, nx, dx);
        let qy = wave_number(ky, ny, dy);
        let q = libm::hypot(qx, qy);
        let long_range = 2.0 / q
            * libm::erfc(q / (2.0 * ALPHA))
            * sinc(kx as f64 / nx as f64)
            * sinc(ky as f64 / ny as f64);
        long_range + series_y.sum(sums, ky)
    }))
}

#[cfg(test)]
mod tests;
