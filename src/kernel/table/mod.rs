//! All influence coefficients of a grid, ready for look-up without index arithmetic.

mod checks;
mod coarse;
mod symbol;

pub(crate) use coarse::Blocks;
use symbol::Symbol;

use super::gauge::{GREATEST_CONVEX_GAUGE, convex, of_coefficients};
use super::{Boundary, ContactGrowth, Gauge, InfluenceKernel, KernelOrigin, MeanDisplacement};
use crate::{Error, Grid, KernelError};

/// As [`GREATEST_CONVEX_GAUGE`] for other kernels, whose contact is the same in every gauge; and what stands in for a
/// gauge that is greater, as a multiple of a good one.
const LARGE_GAUGE: f64 = 10.0;

/// The coefficients C(di, dj) for all offsets |di| < nx, |dj| < ny of a kernel.
///
/// A table is a kernel itself: besides [`new`](Self::new), which evaluates another kernel,
/// [`from_fn`](Self::from_fn) and [`from_symbol`](Self::from_symbol) make one from a function of the
/// offset or of the wavevector.
///
/// Each node has a *place* in the table, such that the coefficient between two nodes is found at
/// the difference of their places: filling a column of the influence matrix costs one subtraction
/// and one load per element.
///
/// # Example
///
/// A layer of thickness h, bonded to a rigid base (Bentall and Johnson, Int. J. Mech. Sci. 10 (1968)
/// 637). With `κ = 3 − 4ν` and `a = q h` its symbol is
///
/// ```math
/// \hat C(q) = \frac{2}{E^* q}\,
///     \frac{2 \kappa \sinh 2a - 4a}{2 \kappa \cosh 2a + 4a^2 + \kappa^2 + 1} ,
/// ```
///
/// which tends to the half-space's 2/(E\* q) for short waves, and for long ones to the compression
/// h (1 − 2ν)/((1 − ν)² E\*). That mean displacement is a property of the layer:
///
/// ```
/// use asperity::kernel::KernelTable;
/// use asperity::{ContactGrowth, Grid, MeanDisplacement};
///
/// let (e_star, nu, h): (f64, f64, f64) = (1e9, 0.3, 1e-4);
/// let kappa = 3.0 - 4.0 * nu;
/// let symbol = |qx: f64, qy: f64| {
///     let q = qx.hypot(qy);
///     if q == 0.0 {
///         return h * (1.0 - 2.0 * nu) / ((1.0 - nu).powi(2) * e_star);
///     }
///     // Hyperbolic functions of large numbers overflow, and from a = 40 on it is a half-space.
///     let a = (q * h).min(40.0);
///     let above = 2.0 * kappa * (2.0 * a).sinh() - 4.0 * a;
///     let below = 2.0 * kappa * (2.0 * a).cosh() + 4.0 * a * a + kappa * kappa + 1.0;
///     2.0 / (e_star * q) * above / below
/// };
/// let grid = Grid::square(32, 1e-3)?;
/// let layer = KernelTable::from_symbol(
///     grid,
///     MeanDisplacement::Physical,
///     ContactGrowth::Unknown,
///     symbol,
/// )?;
/// assert_eq!(layer.gauge(), None);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct KernelTable {
    grid: Grid,
    boundary: Boundary,
    growth: ContactGrowth,
    mean: MeanDisplacement,
    origin: KernelOrigin,
    /// (2 nx − 1) × (2 ny − 1) coefficients, di fastest, offset (0, 0) in the middle.
    values: Vec<f64>,
}

impl KernelTable {
    /// Evaluates `kernel` at every offset of its grid.
    ///
    /// # Errors
    ///
    /// As [`KernelTable::from_fn`].
    pub fn new<K: InfluenceKernel + ?Sized>(kernel: &K) -> Result<Self, Error> {
        let (grid, boundary) = (kernel.grid(), kernel.boundary());
        let coefficient = |di, dj| kernel.coefficient(di, dj);
        let table = Self::from_fn(grid, boundary, kernel.contact_growth(), coefficient)?;
        Ok(Self {
            origin: kernel.origin(),
            ..table.with_mean_displacement(kernel.mean_displacement())
        })
    }

    /// A kernel of the coefficients `coefficient(di, dj)` \[m/Pa\], see
    /// [`InfluenceKernel::coefficient`], which promises the `growth` given.
    ///
    /// With a periodic boundary its mean displacement is taken to be arbitrary; if it is not, say so by
    /// [`with_mean_displacement`](Self::with_mean_displacement).
    ///
    /// # Errors
    ///
    /// [`KernelError::NotFinite`], [`KernelError::NotSymmetric`], [`KernelError::NotPeriodic`] if
    /// the boundary is periodic and the coefficients are not, and [`Error::NotPositiveDefinite`] if
    /// C(0, 0) is not positive.
    pub fn from_fn(
        grid: Grid,
        boundary: Boundary,
        growth: ContactGrowth,
        mut coefficient: impl FnMut(isize, isize) -> f64,
    ) -> Result<Self, Error> {
        let (nx, ny) = (grid.nx() as isize, grid.ny() as isize);
        let mut values = Vec::with_capacity(Self::count(&grid));
        for dj in 1 - ny..ny {
            for di in 1 - nx..nx {
                let value = coefficient(di, dj);
                if !value.is_finite() {
                    return Err(Error::Kernel(KernelError::NotFinite { di, dj, value }));
                }
                values.push(value);
            }
        }
        let table = Self {
            grid,
            boundary,
            growth,
            mean: MeanDisplacement::default(),
            origin: KernelOrigin::Other,
            values,
        };
        table.check_reciprocity()?;
        table.check_periodicity()?;
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

    /// A periodic kernel from its symbol Ĉ(q) \[m/Pa\], displacement over pressure of the wave
    /// $`e^{i \mathbf q \cdot \mathbf x}`$, given by `symbol(qx, qy)` with q in rad/m.
    ///
    /// ```math
    /// C(\mathbf r) = \frac{1}{M} \sum_{\mathbf k} \hat C(\mathbf q)\,
    ///     e^{2 \pi i (k_1 r_1 / n_x + k_2 r_2 / n_y)}, \qquad
    /// \mathbf q = 2 \pi \Bigl( \frac{k_1}{n_x \Delta_x}, \frac{k_2}{n_y \Delta_y} \Bigr), \qquad
    /// |k_1| \le \frac{n_x}2, \quad |k_2| \le \frac{n_y}2 .
    /// ```
    ///
    /// Pressure and displacement are trigonometric interpolants of their values at the nodes, as with
    /// [`Spectral`](super::Spectral). The symbol must be positive, and even under q → −q; an
    /// anisotropic body need not be even in each component by itself. Waves at the Nyquist frequency of
    /// an even number of nodes have their full weight, and take the mean of both directions in which
    /// they can be said to run.
    ///
    /// `mean` says how q = 0 is taken. If the mean displacement is [physical](MeanDisplacement::Physical), Ĉ(0) is what
    /// a uniform pressure does, u = Ĉ(0) p, and must be finite. It may be zero, as of an incompressible layer on a
    /// rigid base, which no uniform pressure can compress: the mean displacement is then zero under any load, and the
    /// table treats it like an arbitrary one, because what is reported of that, an approach without the mean
    /// displacement, is then the approach itself. If it is [arbitrary](MeanDisplacement::Arbitrary), as on bodies
    /// without a base, where the symbol diverges, the symbol is not evaluated at q = 0, and the kernel gets a gauge
    /// that is good to compute in. A promise that gaps are [convex](ContactGrowth::Convex) holds from a least gauge on:
    /// of one that would take all digits, as on a strip, only [`ContactGrowth::Monotone`] is left.
    ///
    /// There is no such constructor for a free boundary: a finite number of waves only describes bodies
    /// that repeat, and a symbol sampled on a larger grid gives the displacements of all its images as
    /// well. The coefficients of a free body are Hankel integrals, for [`from_fn`](Self::from_fn); those of layers are
    /// [`Layered::free`](super::Layered::free).
    ///
    /// # Errors
    ///
    /// [`KernelError::SymbolNotPositive`] (also if not finite) and [`KernelError::SymbolNotEven`], which name the
    /// wavevector; [`Error::NotPositiveDefinite`] for a single node of arbitrary mean, of which nothing
    /// is known.
    pub fn from_symbol(
        grid: Grid,
        mean: MeanDisplacement,
        growth: ContactGrowth,
        symbol: impl FnMut(f64, f64) -> f64,
    ) -> Result<Self, Error> {
        let symbol = Symbol::new(&grid, mean, symbol)?;
        let period = symbol.coefficients();
        let (nx, ny) = (grid.nx() as isize, grid.ny() as isize);
        let mut table = Self::from_fn(grid, Boundary::Periodic, growth, |di, dj| {
            period[(di.rem_euclid(nx) + nx * dj.rem_euclid(ny)) as usize]
        })?
        .with_mean_displacement(symbol.mean);
        let Some(gauge) = table.computing_gauge() else {
            return Ok(table);
        };
        if growth != ContactGrowth::Convex {
            return Ok(table.in_gauge(gauge));
        }
        // The promise holds from the least gauge on. Without any it is not true, which a check tells.
        let least = symbol.least_gauge();
        let known = convex(least, gauge);
        if least.is_some() && known.is_none() {
            table.growth = ContactGrowth::Monotone;
        }
        Ok(table.in_gauge(known.unwrap_or(gauge)))
    }

    /// The same coefficients, with the mean displacement of a periodic body taken as said.
    #[must_use]
    pub fn with_mean_displacement(mut self, mean: MeanDisplacement) -> Self {
        self.mean = mean;
        self
    }

    /// The grid of the coefficients.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// The surroundings of the grid.
    #[must_use]
    pub fn boundary(&self) -> Boundary {
        self.boundary
    }

    /// The gauge s of a periodic kernel \[m/Pa\]: the mean of its coefficients. `None` if the
    /// mean displacement is not arbitrary, because the boundary is free or because the kernel says
    /// that it is [physical](MeanDisplacement::Physical).
    ///
    /// With it the mean displacement under pressures p is `ū = s Σp`. What does not depend on the
    /// gauge follows from an approach δ and a displacement u in this one: the approach of the mean
    /// planes is `δ − s Σp`, the displacement about its mean `u − s Σp`.
    #[must_use]
    pub fn gauge(&self) -> Option<f64> {
        let arbitrary =
            self.boundary == Boundary::Periodic && self.mean == MeanDisplacement::Arbitrary;
        arbitrary.then(|| self.mean_coefficient())
    }

    /// The gauge as a displacement for each unit of load; zero if nothing about it is arbitrary.
    pub(crate) fn gauge_per_load(&self) -> Gauge {
        Gauge::new(self.gauge(), self.grid.cell_area())
    }

    /// Mean of the coefficients over one period: the offsets that are not negative.
    fn mean_coefficient(&self) -> f64 {
        let (nx, ny) = self.grid.shape();
        let rows = self.values[self.center()..].chunks(2 * nx - 1).take(ny);
        let sum: f64 = rows.map(|row| row[..nx].iter().sum::<f64>()).sum();
        sum / self.grid.nodes() as f64
    }

    /// The same kernel with a uniform displacement added, so that the gauge becomes `gauge`; itself if
    /// it has none.
    pub(crate) fn in_gauge(&self, gauge: f64) -> Self {
        let mut table = self.clone();
        if let Some(present) = self.gauge() {
            for value in &mut table.values {
                *value = *value - present + gauge;
            }
        }
        table
    }

    /// The same kernel without a promise that gaps are convex.
    pub(crate) fn at_most_monotone(mut self) -> Self {
        if self.growth == ContactGrowth::Convex {
            self.growth = ContactGrowth::Monotone;
        }
        self
    }

    /// A gauge to compute in \[m/Pa\], of no influence on results: see [`of_coefficients`]. `None` if
    /// the kernel has none.
    pub(crate) fn computing_gauge(&self) -> Option<f64> {
        self.gauge().map(|mean| of_coefficients(mean, self.least()))
    }

    fn least(&self) -> f64 {
        self.values.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The same kernel in a gauge to follow paths in: another one where its own is far above
    /// [`Self::computing_gauge`], or lets a coefficient be negative. Then a node that touches would draw
    /// others nearer, so that they touch before the approach that bounds a window; and in the zero gauge
    /// the matrix of full contact is singular.
    pub(crate) fn regular(self) -> Self {
        let growth = self.growth;
        self.regular_for(growth)
    }

    /// The same for paths on which contact is only relied on to grow as told, whatever the kernel promises.
    pub(crate) fn regular_for(self, growth: ContactGrowth) -> Self {
        let Some(gauge) = self.gauge() else {
            return self;
        };
        let least = self.least();
        let greatest = match growth {
            ContactGrowth::Convex => GREATEST_CONVEX_GAUGE,
            _ => LARGE_GAUGE,
        };
        match of_coefficients(gauge, least) {
            good if least < 0.0 => self.in_gauge(good),
            good if gauge > greatest * good => self.in_gauge(LARGE_GAUGE * good),
            _ => self,
        }
    }

    /// The coefficient at offset (di, dj), or `None` if it lies outside the grid.
    #[must_use]
    pub fn coefficient(&self, di: isize, dj: isize) -> Option<f64> {
        let (nx, ny) = self.grid.shape();
        if di.unsigned_abs() >= nx || dj.unsigned_abs() >= ny {
            return None;
        }
        let (nx, ny) = (nx as isize, ny as isize);
        let index = (di + nx - 1) + (dj + ny - 1) * (2 * nx - 1);
        self.values.get(index as usize).copied()
    }

    /// The displacement of a cell under its own unit pressure, C(0, 0).
    #[must_use]
    pub fn self_influence(&self) -> f64 {
        self.values[self.center()]
    }

    /// Bytes of the table of a grid.
    pub(crate) fn bytes_on(grid: &Grid) -> usize {
        Self::count(grid) * size_of::<f64>()
    }

    /// Number of offsets on a grid.
    fn count(grid: &Grid) -> usize {
        (2 * grid.nx() - 1) * (2 * grid.ny() - 1)
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

impl InfluenceKernel for KernelTable {
    fn grid(&self) -> Grid {
        self.grid
    }

    fn boundary(&self) -> Boundary {
        self.boundary
    }

    /// The coefficient \[m/Pa\]; NaN at offsets that do not lie between two nodes of the grid.
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        self.coefficient(di, dj).unwrap_or(f64::NAN)
    }

    fn contact_growth(&self) -> ContactGrowth {
        self.growth
    }

    fn mean_displacement(&self) -> MeanDisplacement {
        self.mean
    }

    fn origin(&self) -> KernelOrigin {
        self.origin.clone()
    }
}

#[cfg(test)]
mod tests;
