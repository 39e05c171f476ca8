//! Displacement from pressure: an influence kernel over the whole grid.
//!
//! ```math
//! u_i = \sum_j C(\mathbf i - \mathbf j)\, p_j
//! ```
//!
//! is a convolution, which [`Convolution`] does by fast Fourier transform in a time that hardly
//! grows faster than the number of nodes.
//!
//! The kernel's [`Boundary`] says how the grid goes on beyond its edges:
//!
//! * With a free boundary the fields are padded with zeros (Hockney's method) to px ≥ 2 nx − 1 by
//!   py ≥ 2 ny − 1 nodes, so that the transform's own periodicity never reaches the grid, and to
//!   lengths for which transforms are fast.
//! * With a periodic boundary that periodicity is the field's, and nothing is padded: px = nx and
//!   py = ny, and on a grid of 512 × 512 nodes a quarter of the time. Lengths with large prime
//!   factors are transformed as they are, which is exact but slow: ten times as slow on 509 × 509
//!   nodes. The mean displacement is that of the kernel's gauge.
//!
//! Reciprocity, C(−d) = C(d), makes the symbol (the transform of C) real, whether or not C has mirror
//! symmetry.
//!
//! # Order of the fields
//!
//! Fields are slices of one value for each node, at `ix + nx * iy`, or nalgebra's `DMatrix` with nx
//! rows and ny columns, whose storage is the same.
//!
//! # Accuracy
//!
//! The error is that of rounding in the transforms, which grows with the logarithm of the number
//! of nodes: about `1e-15 max |u|`. It is the same everywhere: small displacements far
//! from the load have the absolute error of the large ones.
//!
//! # References
//!
//! R. W. Hockney, Methods in Computational Physics 9 (1970) 135; S. Liu, Q. Wang and G. Liu,
//! Wear 243 (2000) 101, for contact problems.

mod direct;
mod engine;
mod real;
mod size;
#[cfg(test)]
mod tests;
mod transforms;
mod transpose;
mod tuning;

use std::fmt;

use nalgebra::DMatrix;

#[doc(hidden)] // for tests of kernels and convolutions
pub use direct::direct_sum;

use crate::kernel::KernelTable;
use crate::{Boundary, Error, Grid, InfluenceKernel};
use engine::Engine;
pub(crate) use engine::Table;
pub(crate) use size::fast_size;
pub(crate) use transforms::Parity;

/// Displacement from pressure on a whole grid, by fast Fourier transform.
///
/// All memory is allocated when it is made, so convolutions should be kept and used again; clones
/// share the transform of the kernel. With
/// the feature `rayon` the threads of the current pool share the work; results are the same bit
/// for bit with any number of threads, and without the feature.
///
/// ```
/// use asperity::convolution::Convolution;
/// use asperity::{Boundary, Error, Grid, InfluenceKernel};
/// use asperity::nalgebra::DMatrix;
///
/// /// A bed of independent springs: displacement in proportion to a node's own pressure.
/// struct Winkler(Grid);
///
/// impl InfluenceKernel for Winkler {
///     fn grid(&self) -> Grid {
///         self.0
///     }
///     fn boundary(&self) -> Boundary {
///         Boundary::Free
///     }
///     fn coefficient(&self, di: isize, dj: isize) -> f64 {
///         if (di, dj) == (0, 0) { 2.0 } else { 0.0 }
///     }
/// }
///
/// let grid = Grid::square(8, 1.0)?;
/// let pressure = DMatrix::from_fn(8, 8, |ix, iy| (ix + iy) as f64);
/// let displacement = Convolution::new(&Winkler(grid))?.convolve(&pressure)?;
/// assert!((displacement - 2.0 * pressure).amax() < 1e-12);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone)]
pub struct Convolution {
    engine: Engine<f64>,
}

impl Convolution {
    /// Prepares the convolution with `kernel` on its grid, with zero padding unless its boundary is
    /// periodic.
    ///
    /// # Errors
    ///
    /// Those of [`KernelTable::new`] and [`Convolution::from_table`].
    pub fn new<K: InfluenceKernel + ?Sized>(kernel: &K) -> Result<Self, Error> {
        Self::from_table(&KernelTable::new(kernel)?)
    }

    /// Prepares the convolution with tabulated influence coefficients.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] if the coefficients are so large that their sum overflows.
    pub fn from_table(table: &KernelTable) -> Result<Self, Error> {
        Ok(Self { engine: Engine::from_table(table)? })
    }

    /// Of any quantity that goes with the pressure: nothing until it is [`set`](Self::set).
    pub(crate) fn blank(domain: (Grid, Boundary)) -> Self {
        Self { engine: Engine::blank(domain) }
    }

    /// Takes another quantity, by its coefficients at offsets and what `waves` adds to their symbol: see
    /// [`Engine::set`].
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] if the coefficients are so large that their sum overflows.
    pub(crate) fn set(
        &mut self,
        parity: Parity,
        coefficient: Option<Table<'_, isize>>,
        waves: Option<Table<'_, usize>>,
    ) -> Result<(), Error> {
        self.engine.set(parity, coefficient, waves)
    }

    /// The grid of the fields.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.engine.grid()
    }

    /// Bytes held: symbol, spectra and working memory, but not the plans.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.engine.bytes()
    }

    /// The same before there is a convolution.
    pub(crate) fn bytes_on(grid: &Grid, boundary: Boundary) -> usize {
        Engine::<f64>::bytes_on(grid, boundary)
    }

    /// `Ok` unless the kernel of `table`, whose convolution this is, is known not to be positive definite. That
    /// can be told of a periodic one, by its symbol on the waves of the grid; the uniform wave does not
    /// count if the mean displacement is arbitrary.
    ///
    /// # Errors
    ///
    /// [`KernelError::SymbolNotPositive`](crate::KernelError::SymbolNotPositive).
    pub(crate) fn check_definite(&self, table: &KernelTable) -> Result<(), Error> {
        match table.boundary() {
            Boundary::Free | Boundary::PeriodicX | Boundary::PeriodicY => Ok(()),
            Boundary::Periodic => {
                let skipped = usize::from(table.gauge().is_some());
                self.engine.check_symbol(skipped)
            }
        }
    }

    /// A lower bound \[m/Pa\] of the eigenvalues of the influence matrix of any nodes, which is a part of a circulant
    /// one with the values of the symbol as eigenvalues; says nothing unless it is positive.
    pub(crate) fn least_eigenvalue(&self) -> f64 {
        self.engine.least_symbol()
    }

    /// The same in single precision: half the memory, about half the time, and displacements with
    /// an error of some 10⁻⁷ of the greatest.
    pub(crate) fn to_single(&self) -> SingleConvolution {
        let unit = self.engine.greatest_symbol();
        let unit = if unit > 0.0 { unit } else { 1.0 };
        SingleConvolution {
            engine: self.engine.to_single(unit),
            unit,
            noise: self.engine.norm_of_symbol(),
        }
    }

    /// The same about the mean displacement, for a periodic kernel: in the zero gauge.
    pub(crate) fn without_mean(self) -> Self {
        Self { engine: self.engine.without_mean() }
    }

    /// Displacement \[m\] of every node under `pressure` \[Pa\].
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if `pressure` does not have nx rows and ny columns, and
    /// [`Error::FieldNotFinite`].
    pub fn convolve(&mut self, pressure: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
        self.grid().check_finite("pressure", pressure)?;
        let mut displacement = DMatrix::zeros(self.grid().nx(), self.grid().ny());
        self.apply(pressure.as_slice(), displacement.as_mut_slice())?;
        Ok(displacement)
    }

    /// Writes the displacement \[m\] under `pressure` \[Pa\] into `displacement`.
    ///
    /// Nothing is allocated. Rows without pressure cost no transform. A pressure that is not finite
    /// spoils the displacement everywhere: see [`Convolution::convolve`].
    ///
    /// # Errors
    ///
    /// [`Error::LengthMismatch`] unless both slices have one value for each node.
    pub fn apply(&mut self, pressure: &[f64], displacement: &mut [f64]) -> Result<(), Error> {
        self.engine.apply(pressure, displacement)
    }

    /// Writes the displacements \[m\] under two `pressures` \[Pa\] into `displacements`.
    ///
    /// The fields follow one another. Packed as real and imaginary parts of one complex field they
    /// would need the same column transforms and twice the memory for spectra; from the times of
    /// the row transforms the gain would be 4 % on a grid of 512 × 512 nodes.
    ///
    /// # Errors
    ///
    /// [`Error::LengthMismatch`] unless all slices have one value for each node; then nothing is
    /// written.
    #[doc(hidden)] // for the bench
    pub fn apply_two(
        &mut self,
        pressures: [&[f64]; 2],
        displacements: [&mut [f64]; 2],
    ) -> Result<(), Error> {
        for pressure in pressures {
            self.engine.check_length(pressure)?;
        }
        for displacement in &displacements {
            self.engine.check_length(displacement)?;
        }
        for (pressure, displacement) in pressures.into_iter().zip(displacements) {
            self.apply(pressure, displacement)?;
        }
        Ok(())
    }
}

/// A convolution of fields in single precision.
#[derive(Clone)]
pub(crate) struct SingleConvolution {
    engine: Engine<f32>,
    /// Displacements are in units of this under pressures of 1: the greatest value of the symbol.
    unit: f64,
    noise: f64,
}

impl SingleConvolution {
    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        self.engine.bytes()
    }

    /// The unit of displacements \[m\].
    pub(crate) fn unit(&self) -> f64 {
        self.unit
    }

    /// What the rounding errors of a spectrum come to: the root mean square error of displacements \[m\] under
    /// pressures of which the sum of squares is 1, over that of a rounding.
    ///
    /// Rounding errors spread over all waves alike, and the symbol makes the more of them the longer the wave.
    /// Pressures of short waves displace little, and yet what they spoil is this.
    pub(crate) fn noise(&self) -> f64 {
        self.noise
    }

    /// Writes the displacement under `pressure`, whose values should be of the order of 1, into `displacement`.
    ///
    /// # Errors
    ///
    /// [`Error::LengthMismatch`] unless both slices have one value for each node.
    pub(crate) fn apply(
        &mut self,
        pressure: &[f32],
        displacement: &mut [f32],
    ) -> Result<(), Error> {
        self.engine.apply(pressure, displacement)
    }
}

impl fmt::Debug for Convolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Convolution")
            .field("grid", &self.grid())
            .field("padded", &self.engine.padded())
            .finish_non_exhaustive()
    }
}

impl fmt::Debug for SingleConvolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SingleConvolution")
            .field("padded", &self.engine.padded())
            .finish_non_exhaustive()
    }
}
