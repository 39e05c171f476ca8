//! Periodic half-spaces whose symbol is even along x and along y: coefficients, and the gauge they are
//! in.

use super::even::Even;
use crate::kernel::gauge::least;
use crate::{Error, Grid};

/// A periodic kernel whose symbol is even along x and along y.
#[derive(Debug, Clone)]
pub(super) struct Symmetric {
    pub(super) grid: Grid,
    pub(super) e_star: f64,
    /// Ĉ(k) \[m/Pa\], zero at k = 0.
    pub(super) symbol: Even,
    /// C⁽⁰⁾(r) \[m/Pa\], the inverse transform of the symbol.
    pub(super) coefficients: Even,
    pub(super) gauge: f64,
}

impl Symmetric {
    /// A kernel of symbol `unit` × D / E*, in the gauge `unit_gauge` × D / E*, with D the long side
    /// of a cell; symbol and gauge come from the grid with cells in units of D.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for `e_star`, or if C(0, 0) over- or underflows.
    pub(super) fn new(
        grid: Grid,
        e_star: f64,
        unit: &Even,
        unit_gauge: f64,
    ) -> Result<Self, Error> {
        let e_star = Error::require_positive("composite modulus", e_star)?;
        let scale = grid.dx().max(grid.dy()) / e_star;
        let coefficients = unit.inverse_transform().map(|value| value * scale);
        let gauge = unit_gauge * scale;
        Error::require_positive("influence coefficient C(0, 0)", coefficients.at(0, 0) + gauge)?;
        Ok(Self { grid, e_star, symbol: unit.map(|value| value * scale), coefficients, gauge })
    }

    pub(super) fn set_gauge(&mut self, gauge: f64) -> Result<(), Error> {
        let is_gauge = gauge >= 0.0 && gauge.is_finite();
        let quantity = "gauge of a periodic kernel";
        self.gauge = Error::require(quantity, gauge, is_gauge, "finite and not negative")?;
        Ok(())
    }
}

/// The methods of a half-space that is a [`Symmetric`] kernel, given its `contact_growth`.
macro_rules! half_space {
    ($kernel:ident, $($contact_growth:tt)*) => {
        impl $kernel {
            /// The same kernel in the gauge `gauge` \[m/Pa\]; a new kernel has the one described above.
            ///
            /// Where [`least_gauge`](Self::least_gauge) is known, gaps are convex in the approach from there on; far
            /// above it, digits are lost, one for each power of ten. In the gauge 0 the matrix is singular.
            ///
            /// # Errors
            ///
            /// [`Error::OutOfRange`] if it is negative or not finite.
            pub fn with_gauge(mut self, gauge: f64) -> Result<Self, Error> {
                self.half_space.set_gauge(gauge)?;
                Ok(self)
            }

            /// Composite modulus E* \[Pa\].
            #[must_use]
            pub fn e_star(&self) -> f64 {
                self.half_space.e_star
            }

            /// Ĉ(kx, ky) \[m/Pa\] in the zero gauge, Ĉ(0, 0) = 0; periodic and even in both indices.
            #[must_use]
            pub fn symbol(&self, kx: isize, ky: isize) -> f64 {
                self.half_space.symbol.at(kx, ky)
            }

            /// The gauge s \[m/Pa\]: the mean of the coefficients.
            #[must_use]
            pub fn gauge(&self) -> f64 {
                self.half_space.gauge
            }

            /// The least gauge s\* \[m/Pa\] in which the kernel is an inverse M-matrix; zero on a single node. `None`
            /// if there is none, or if rounding hides it, on extremely long cells. It takes a Fourier transform.
            #[must_use]
            pub fn least_gauge(&self) -> Option<f64> {
                symmetric::least_gauge(&self.half_space.grid, &self.half_space.symbol)
            }
        }

        impl InfluenceKernel for $kernel {
            fn grid(&self) -> Grid {
                self.half_space.grid
            }

            /// [`Boundary::Periodic`].
            fn boundary(&self) -> Boundary {
                Boundary::Periodic
            }

            $($contact_growth)*

            /// $`C^{(0)} + s`$ \[m/Pa\]; defined at every offset, on the grid or in any of its periods.
            fn coefficient(&self, di: isize, dj: isize) -> f64 {
                self.half_space.coefficients.at(di, dj) + self.half_space.gauge
            }

            fn origin(&self) -> KernelOrigin {
                KernelOrigin::$kernel { e_star: self.e_star() }
            }
        }
    };
}
pub(super) use half_space;

/// The inverse of a kernel, given its symbol; the uniform wave counts unless its value is zero.
pub(in crate::kernel) fn inverse(symbol: &Even) -> Even {
    symbol.map(|value| if value == 0.0 { 0.0 } else { 1.0 / value }).inverse_transform()
}

/// The least gauge s* in which the kernel's matrix is an inverse M-matrix, if there is any.
pub(in crate::kernel) fn least_gauge(grid: &Grid, symbol: &Even) -> Option<f64> {
    least(grid.nodes(), inverse(symbol).values())
}

/// The grid with lengths in units of the long side of its cells.
pub(super) fn in_long_sides(grid: &Grid) -> Result<Grid, Error> {
    let long = grid.dx().max(grid.dy());
    Ok(Grid::new(grid.nx(), grid.ny(), grid.dx() / long, grid.dy() / long)?)
}

/// Wave number of mode k of n on cells of `spacing`, for 0 ≤ k ≤ n / 2.
pub(in crate::kernel) fn wave_number(k: usize, n: usize, spacing: f64) -> f64 {
    std::f64::consts::TAU * (k as f64 / n as f64) / spacing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_gauge_is_enough_for_a_single_node() -> Result<(), Error> {
        let grid = Grid::new(1, 1, 2.0, 1.0)?;
        let symbol = Even::from_fn((1, 1), |_, _| 0.0);
        assert_eq!(least_gauge(&grid, &symbol), Some(0.0));
        Ok(())
    }

    #[test]
    fn two_nodes_by_hand() -> Result<(), Error> {
        // Ĉ = (0, c): A = (1, −1) / (2 c), and C_s⁻¹ off the diagonal is −1 / (2 c) + 1 / (4 s).
        let grid = Grid::new(2, 1, 1.0, 1.0)?;
        let symbol = Even::from_fn((2, 1), |k, _| 3.0 * k as f64);
        let least = least_gauge(&grid, &symbol).unwrap_or(f64::NAN);
        // A few rounding errors of numbers near 1.
        assert!((least - 1.5).abs() < 1e-15, "{least}");
        Ok(())
    }
}
