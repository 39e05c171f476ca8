//! The periodic half-space of spectral codes.

use super::even::Even;
use super::symmetric::{self, Symmetric, half_space, in_long_sides, wave_number};
use crate::kernel::gauge::of_half_space;
use crate::kernel::{Boundary, ContactGrowth, InfluenceKernel, KernelOrigin};
use crate::{Error, Grid};

/// The periodic half-space, seen by the waves of the grid alone: symbol 2 / (E* |q|) \[m/Pa\].
///
/// Pressure and displacement are trigonometric interpolants of their values at the nodes, and each
/// wave answers as it would on the continuous half-space (Johnson; Stanley and Kato):
///
/// ```math
/// \hat C(k_1, k_2) = \frac{2}{E^* |\mathbf q|}, \qquad
///    \mathbf q = 2 \pi \Bigl( \frac{k_1}{n_x \Delta_x}, \frac{k_2}{n_y \Delta_y} \Bigr), \qquad
///    |k_1| \le \frac{n_x}2, \quad |k_2| \le \frac{n_y}2,
/// ```
///
/// where $`\hat C(\mathbf k) = \sum_{\mathbf r} C(\mathbf r)\,
/// e^{-2 \pi i (k_1 r_1 / n_x + k_2 r_2 / n_y)}`$ and $`\hat C(0) = 0`$. Waves at the Nyquist frequency
/// of an even number of nodes have their full weight. This is the kernel of *tamaas* and of
/// *ContactMechanics* to the last digits (of the former for even nx only: for odd nx tamaas 2.9.0
/// mistakes the wave number at index (nx − 1)/2; of the latter with `stiffness_q0=0.0`, since its
/// default is a gauge).
///
/// [`PeriodicBoussinesq`](super::PeriodicBoussinesq) differs from it in what is finer than the grid.
/// Choose `Spectral` to compare with spectral codes, and `PeriodicBoussinesq` otherwise.
///
/// # Gauge
///
/// The mean displacement is arbitrary and settled by the gauge s as described for
/// [`PeriodicBoussinesq`](super::PeriodicBoussinesq#gauge):
/// $`C(\mathbf r) = C^{(0)}(\mathbf r) + s`$. But the interpolants ring: two cells away along an axis
/// the inverse is positive (2 % of its diagonal), so that this kernel is an inverse M-matrix in *no*
/// gauge, except on tiny grids. Contact nevertheless grows monotonically on every grid tried. Only the
/// convexity of gaps is lost, and a path checks all gaps after every window of events.
/// The gauge is 4/5 of the long side of the grid over (E* M), near the least gauge of
/// [`PeriodicBoussinesq`](super::PeriodicBoussinesq) (0.64 to 0.83 of the same on common grids).
///
/// # Example
///
/// ```
/// use asperity::{Grid, InfluenceKernel, Spectral};
///
/// let kernel = Spectral::new(Grid::square(64, 1.0)?, 1.0)?;
/// // A wave of length 1/4: 2 / (2 π × 4).
/// assert!((kernel.symbol(0, 4) - 1.0 / (4.0 * std::f64::consts::PI)).abs() < 1e-16);
/// // Periodic: 63 cells away is one cell away.
/// assert_eq!(kernel.coefficient(63, 0), kernel.coefficient(-1, 0));
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # References
///
/// * H. M. Stanley and T. Kato, An FFT-based method for rough surface contact, J. Tribol. 119
///   (1997) 481.
/// * K. L. Johnson, Contact Mechanics, Cambridge University Press (1985), p. 398.
/// * L. Frérot et al., Tamaas: a library for elastic-plastic contact of periodic rough surfaces,
///   J. Open Source Softw. 5 (2020) 2121.
#[derive(Debug, Clone)]
pub struct Spectral {
    half_space: Symmetric,
}

impl Spectral {
    /// The periodic half-space of composite modulus `e_star` \[Pa\] under `grid`.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for `e_star`, or if C(0, 0) or the cells over- or underflow.
    pub fn new(grid: Grid, e_star: f64) -> Result<Self, Error> {
        let cells = in_long_sides(&grid)?;
        let symbol = Even::from_fn(grid.shape(), |kx, ky| {
            let qx = wave_number(kx, cells.nx(), cells.dx());
            let qy = wave_number(ky, cells.ny(), cells.dy());
            if (kx, ky) == (0, 0) { 0.0 } else { 2.0 / libm::hypot(qx, qy) }
        });
        Ok(Self { half_space: Symmetric::new(grid, e_star, &symbol, of_half_space(&cells, None))? })
    }
}

half_space! {
    Spectral,
    /// Contact was found to grow monotonically for every contact set of small grids (up to 6 × 6 and
    /// 8 × 4, exhaustively) and for the worst that annealing found on grids up to 24²; gaps are not
    /// convex.
    fn contact_growth(&self) -> ContactGrowth {
        ContactGrowth::Monotone
    }
}
