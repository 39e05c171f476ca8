//! Coated, thin and graded bodies.

mod below;
mod body;
mod cell;
mod compliance;
mod far;
mod free;
mod growth;
mod periodic;
mod radial;

pub(crate) use below::Below;
pub use body::{Base, Layer, LayeredBody};

use super::gauge::{convex, of_coefficients};
use super::periodic::{Even, least_gauge};
use super::{Boundary, Boussinesq, ContactGrowth, InfluenceKernel, KernelOrigin, MeanDisplacement};
use crate::{Error, Grid};

/// A [`LayeredBody`] under the cells of a grid.
///
/// | constructor | boundary | a cell's displacement | without layers it is |
/// |---|---|---|---|
/// | [`free`](Self::free) | free | exact for uniform pressure on each cell | [`Boussinesq`](super::Boussinesq) |
/// | [`periodic`](Self::periodic) | periodic | exact for uniform pressure on each cell | [`PeriodicBoussinesq`](super::PeriodicBoussinesq) |
/// | [`spectral`](Self::spectral) | periodic | the waves of the grid only | [`Spectral`](super::Spectral) |
///
/// # Evaluation
///
/// All are sums of a half-space of the uppermost layer and of a difference, whose transform fades as exp(−2 q h), h the
/// thickness of the uppermost layer. With a free boundary the difference is a function of the distance,
///
/// ```math
/// f(r) = \frac{1}{2 \pi} \int_0^\infty \Bigl( q\, \hat C(q) - \frac{2}{E_1^*} \Bigr) J_0(q r)\, \mathrm dq ,
/// ```
///
/// tabulated and integrated over the cell: C(d) is Love's coefficient with E₁\* plus ∫ f dA. With a periodic boundary
/// it is a sum over all waves that look alike on the grid, for thin layers with the shortest of them replaced by
/// integrals over cells.
///
/// Coefficients err by some 10⁻¹⁴ of C(0, 0), those with a free boundary also by 10⁻¹⁵ Δ/E₁\*, and the symbol of cells
/// of a side Δ by some 10⁻¹⁵ Δ/E₁\*, however little is left of it: on a rigid base it is a difference of the two parts.
/// Of a thin compressible layer some h/E₁ is left. A thin incompressible one, under a uniform pressure on a cell, moves
/// at the edges of the cell only, and the symbol falls exponentially with Δ/h: on 12 nodes in a row that of the longest
/// wave is 1.8 × 10⁻⁴ Δ/E₁ for h = 0.1 Δ, 2.2 × 10⁻⁶ for 0.05 Δ, 1.4 × 10⁻¹¹ for 0.02 Δ and 10⁻¹⁸ for 0.011 Δ. Where an
/// incompressible layer is thinner than 0.05 cells, use [`spectral`](Self::spectral), which takes no difference.
///
/// # Mean displacement
///
/// With a rigid base it is [physical](MeanDisplacement::Physical): a uniform pressure p compresses the layers by Ĉ(0) p
/// ([`LayeredBody::mean_compliance`]). If all are incompressible to rounding, it is zero under any load. The matrix is
/// singular then, and is treated like that of an [arbitrary](MeanDisplacement::Arbitrary) mean; the approach of the
/// mean planes, which is reported, is the approach of the base, and its stiffness the interfacial one. On an elastic
/// half-space, or in contact with one, the mean is arbitrary.
///
/// # Growth of contact
///
/// A coat that is stiffer than what it lies on bends over a support, and rises beside it. Contact may then lose nodes
/// as the approach grows. [`ContactGrowth::Monotone`] is promised where nothing of the kind can happen on the waves of
/// the grid: where the compliance falls no faster than 1/q and rises no faster than q² (soft coats, layers on a rigid
/// base), and where the inverse of the kernel has no positive element off the diagonal, or such that its row sums
/// outweigh. With a periodic boundary and none at all gaps are [convex](ContactGrowth::Convex) as well, unless waves
/// ring. They ring most where the compliance still rises at the shortest wave of the grid, as that of a nearly
/// incompressible layer much thinner than a cell: [`spectral`](Self::spectral) then promises only what the inverse of
/// its own matrix tells. With a free boundary waves longer than the grid count too, which feel what lies below a coat as
/// thick as the grid is long: its kernel is inverted, on a coarse grid if it has many nodes. Of other bodies [nothing is
/// promised](ContactGrowth::Unknown): nodes that leave are found as well.
///
/// # Example
///
/// A sphere on a rubber layer of 1 mm on steel:
///
/// ```
/// use asperity::kernel::{Base, Layer, Layered, LayeredBody};
/// use asperity::surface::Paraboloid;
/// use asperity::{FixedLoadSolver, Grid};
///
/// let rubber = Layer { youngs_modulus: 3e6, poissons_ratio: 0.5, thickness: 1e-3 };
/// let body = LayeredBody::new(&[rubber], Base::Rigid)?;
/// let kernel = Layered::free(Grid::square(64, 8e-3)?, body)?;
/// let solution = FixedLoadSolver::new(&Paraboloid::new(20e-3)?, &kernel)?.solve(1.0)?;
/// assert!(solution.contact.approach < 0.2e-3);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Layered {
    grid: Grid,
    body: LayeredBody,
    growth: ContactGrowth,
    mean: MeanDisplacement,
    coefficients: Coefficients,
}

#[derive(Debug, Clone)]
enum Coefficients {
    /// At offsets that are not negative, x fastest.
    Free(Vec<f64>),
    /// Without a uniform part, and that.
    Periodic { values: Even, uniform: f64, pressure: Pressure },
}

/// What pressure is between the nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Pressure {
    Cells,
    Waves,
}

/// Nodes a side of a grid on which the inverse of a periodic kernel is looked at, or so many thicknesses if these are
/// longer: its waves must feel what lies below.
const LOOKED_AT: usize = 256;
const THICKNESSES: f64 = 10.0;
/// Nodes a side of a grid on which a free kernel is inverted: 20 ms.
const INVERTED: usize = 16;
/// In cells of that grid, the thickness from which on the longest waves of the periodic kernel do not tell what longer
/// ones see.
const THICK: f64 = 1.5;

/// A mean compliance is nothing below so much of the greatest value of the symbol: twice what a convolution takes for
/// rounding, so that none is refused for its own.
const ROUNDING: f64 = 32.0 * f64::EPSILON;
/// With a free boundary C(0, 0) of less than so much of that of a half-space of the uppermost layer has not even four
/// digits.
const LEAST_OF_HALF_SPACE: f64 = 1e-11;

impl Layered {
    /// With a free boundary.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] and [`Error::OutOfRange`] for moduli, thicknesses and cells that are too far apart, and for
    /// layers so much thinner than the cells that rounding is left of their coefficients.
    pub fn free(grid: Grid, body: LayeredBody) -> Result<Self, Error> {
        check_scales(&grid, &body)?;
        let values = free::coefficients(&grid, &body)?;
        let half_space = Boussinesq::new(grid, body.top_modulus())?;
        let part = values[0] / half_space.coefficient(0, 0);
        Error::require(
            "displacement of a cell by its own pressure, over that of a half-space of the uppermost layer",
            part,
            part >= LEAST_OF_HALF_SPACE,
            "1e-11 or more: less is rounding",
        )?;
        let grows = growth::is_soft(&grid, &body) || free_contact_grows(&grid, &body, &values)?;
        let growth = if grows { ContactGrowth::Monotone } else { ContactGrowth::Unknown };
        let coefficients = Coefficients::Free(values);
        Ok(Self { grid, body, growth, mean: MeanDisplacement::default(), coefficients })
    }

    /// With a periodic boundary, and uniform pressure on each cell and its images.
    ///
    /// # Errors
    ///
    /// As [`Self::free`], and [`Error::OutOfRange`] for cells that are more than
    /// [`MAX_ASPECT`](super::PeriodicBoussinesq::MAX_ASPECT) times as long as wide.
    pub fn periodic(grid: Grid, body: LayeredBody) -> Result<Self, Error> {
        check_scales(&grid, &body)?;
        let mean = body.mean_compliance().unwrap_or_default();
        let symbol = periodic::cells(&grid, &body, mean)?;
        let grows = growth::is_soft(&grid, &body);
        Ok(Self::of_symbol(grid, body, &symbol, Pressure::Cells, grows))
    }

    /// With a periodic boundary, on the waves of the grid.
    ///
    /// # Errors
    ///
    /// As [`Self::free`].
    pub fn spectral(grid: Grid, body: LayeredBody) -> Result<Self, Error> {
        check_scales(&grid, &body)?;
        let mean = body.mean_compliance().unwrap_or_default();
        let symbol = periodic::waves(&grid, &body, mean);
        let grows = if growth::rises_at_the_end(&grid, &body) {
            // Cut off while they rise, waves ring so much that the body behind them tells nothing.
            growth::is_outweighed(grid.shape(), &symbol)
        } else {
            // Waves ring, which lets no inverse be one of an M-matrix; the body behind them may be.
            growth::is_soft(&grid, &body) || is_inverse_m_matrix(&grid, &body)?
        };
        Ok(Self::of_symbol(grid, body, &symbol, Pressure::Waves, grows))
    }

    /// `grows` if contact does, whether gaps are convex or not.
    fn of_symbol(
        grid: Grid,
        body: LayeredBody,
        symbol: &Even,
        pressure: Pressure,
        grows: bool,
    ) -> Self {
        // What rounding leaves of an incompressible layer, a sum over coefficients cannot tell from nothing.
        let greatest = symbol.values().iter().copied().fold(0.0, f64::max);
        let mean = match body.mean_compliance() {
            Some(compliance) if compliance > ROUNDING * greatest => MeanDisplacement::Physical,
            _ => MeanDisplacement::Arbitrary,
        };
        let values = symbol.inverse_transform();
        let (uniform, is_convex) = match mean {
            MeanDisplacement::Physical => (0.0, growth::greatest_off_diagonal(symbol) < 0.0),
            MeanDisplacement::Arbitrary => {
                let least = values.values().iter().copied().fold(f64::INFINITY, f64::min);
                // A single node has nothing but its gauge: any will do.
                let own = grid.cell_area().sqrt() / body.surface_modulus();
                let good = of_coefficients(0.0, least);
                let good = if good > 0.0 { good } else { own };
                let convex = convex(least_gauge(&grid, symbol), good);
                (convex.unwrap_or(good), convex.is_some())
            }
        };
        let growth = if is_convex {
            ContactGrowth::Convex
        } else if grows {
            ContactGrowth::Monotone
        } else {
            ContactGrowth::Unknown
        };
        let coefficients = Coefficients::Periodic { values, uniform, pressure };
        Self { grid, body, growth, mean, coefficients }
    }

    /// The body.
    #[must_use]
    pub fn body(&self) -> &LayeredBody {
        &self.body
    }
}

/// Whether contact grows with a free boundary: by the inverse of the kernel itself on a small grid. On a larger one
/// short waves are looked at with a periodic boundary, and the long ones on a coarse grid of the same sides, unless
/// layers are so thin that the former tell all.
fn free_contact_grows(grid: &Grid, body: &LayeredBody, values: &[f64]) -> Result<bool, Error> {
    let (nx, ny) = grid.shape();
    let shape = (nx.min(INVERTED), ny.min(INVERTED));
    if shape == (nx, ny) {
        return Ok(growth::inverse_keeps_signs(shape, values));
    }
    if !is_inverse_m_matrix(grid, body)? {
        return Ok(false);
    }
    let (lx, ly) = grid.sides();
    let coarse = Grid::new(shape.0, shape.1, lx / shape.0 as f64, ly / shape.1 as f64)?;
    if body.thickness() < THICK * coarse.dx().max(coarse.dy()) {
        return Ok(true);
    }
    Ok(growth::inverse_keeps_signs(shape, &free::coefficients(&coarse, body)?))
}

/// Whether the inverse of the periodic kernel on cells of this size is that of an M-matrix, in a gauge that is great
/// enough.
fn is_inverse_m_matrix(grid: &Grid, body: &LayeredBody) -> Result<bool, Error> {
    let (nx, ny) = grid.shape();
    let along = |n: usize, cell: f64| {
        n.min(LOOKED_AT.max((THICKNESSES * body.thickness() / cell).ceil() as usize))
    };
    let (nx, ny) = (along(nx, grid.dx()), along(ny, grid.dy()));
    let looked_at = Grid::new(nx, ny, grid.dx(), grid.dy())?;
    if grid.cell_aspect() > super::PeriodicBoussinesq::MAX_ASPECT {
        return Ok(false);
    }
    let symbol = periodic::cells(&looked_at, body, 0.0)?;
    Ok(growth::greatest_off_diagonal(&symbol) < 0.0)
}

/// `Ok` if thickness and cells are not so far apart that nothing can be computed.
fn check_scales(grid: &Grid, body: &LayeredBody) -> Result<(), Error> {
    let (lx, ly) = grid.sides();
    let ratio = body.thickness() / grid.dx().min(grid.dy());
    let quantity = "thickness of all layers over the short side of a cell";
    Error::require(quantity, ratio, ratio <= 1e12, "at most 1e12")?;
    let ratio = lx.max(ly) / body.top_thickness();
    let quantity = "long side of the grid over the thickness of the uppermost layer";
    Error::require(quantity, ratio, ratio <= 1e12, "at most 1e12").map(drop)
}

impl InfluenceKernel for Layered {
    fn grid(&self) -> Grid {
        self.grid
    }

    fn boundary(&self) -> Boundary {
        match self.coefficients {
            Coefficients::Free(_) => Boundary::Free,
            Coefficients::Periodic { .. } => Boundary::Periodic,
        }
    }

    /// \[m/Pa\]; NaN at offsets beyond the grid if the boundary is free.
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        match &self.coefficients {
            Coefficients::Free(values) => {
                let (nx, ny) = self.grid.shape();
                let (di, dj) = (di.unsigned_abs(), dj.unsigned_abs());
                if di < nx && dj < ny { values[di + nx * dj] } else { f64::NAN }
            }
            Coefficients::Periodic { values, uniform, .. } => values.at(di, dj) + uniform,
        }
    }

    fn contact_growth(&self) -> ContactGrowth {
        self.growth
    }

    fn mean_displacement(&self) -> MeanDisplacement {
        self.mean
    }

    fn origin(&self) -> KernelOrigin {
        let body = self.body.clone();
        match self.coefficients {
            Coefficients::Free(_) => KernelOrigin::Layered { body },
            Coefficients::Periodic { pressure: Pressure::Cells, .. } => {
                KernelOrigin::PeriodicLayered { body }
            }
            Coefficients::Periodic { pressure: Pressure::Waves, .. } => {
                KernelOrigin::SpectralLayered { body }
            }
        }
    }
}

#[cfg(test)]
mod tests;
