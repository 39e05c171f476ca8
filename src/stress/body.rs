//! The body whose stresses are asked for.

use nalgebra::DMatrix;

use super::kernel::{Domain, StressKernel};
use super::load::{COMPONENTS, Load, Response};
use super::tensor::StressField;
use super::waves::Between;
use crate::kernel::{
    Below, KernelOrigin, LayeredBody, PeriodicBoussinesq, Theory, check_periodic_cells,
};
use crate::record::LoadingRecord;
use crate::{Boundary, Error, Grid, InfluenceKernel, StressError};

/// An elastic half-space, or a [`LayeredBody`], under the cells of a grid, whose stresses under any pressure are asked
/// for.
///
/// ```
/// use asperity::stress::{Measure, Subsurface};
/// use asperity::surface::Paraboloid;
/// use asperity::{Boussinesq, FixedLoadSolver, Grid};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let grid = Grid::square(64, 4e-3)?;
/// let kernel = Boussinesq::new(grid, 115e9)?;
/// let ball = FixedLoadSolver::new(&Paraboloid::new(50e-3)?, &kernel)?.solve(1000.0)?;
/// let steel = Subsurface::of(&kernel, 0.3)?;
/// let stress = steel.at_depth(&ball.fields.pressure, 0.33e-3)?;
/// let von_mises = stress.map(Measure::VonMises).max();
/// assert!((von_mises / ball.fields.max_pressure() - 0.62).abs() < 0.02);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct Subsurface {
    domain: Domain,
    /// Of a homogeneous body.
    poissons_ratio: f64,
    layers: Option<LayeredBody>,
    /// Traction over pressure along x and along y.
    friction: (f64, f64),
}

/// Greatest depth in long sides of a cell: measures take third powers of stresses, which fall with the square of it.
const DEEPEST: f64 = 1e30;

impl Subsurface {
    /// The half-space of Poisson's ratio ν, `poissons_ratio`, with uniform pressure on each cell of `grid`.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] unless −1 < ν ≤ ½, and for cells that repeat and are more than
    /// [`MAX_ASPECT`](PeriodicBoussinesq::MAX_ASPECT) times as long as wide.
    pub fn new(grid: Grid, boundary: Boundary, poissons_ratio: f64) -> Result<Self, Error> {
        Self::with(Domain { grid, boundary, between: Between::Cells }, poissons_ratio)
    }

    /// The body of a kernel: its grid, its boundary, its layers, and what pressure is between the nodes. Layers have
    /// Poisson's ratios of their own, and the one given does not count. A kernel of your own is taken for a half-space
    /// with uniform pressure on each cell.
    ///
    /// # Errors
    ///
    /// Those of [`Self::new`].
    pub fn of<K: InfluenceKernel + ?Sized>(kernel: &K, poissons_ratio: f64) -> Result<Self, Error> {
        Self::of_origin(kernel.grid(), kernel.boundary(), &kernel.origin(), poissons_ratio)
    }

    /// The same of the body of a record.
    ///
    /// # Errors
    ///
    /// Those of [`Self::of`].
    pub fn of_record(record: &LoadingRecord, poissons_ratio: f64) -> Result<Self, Error> {
        let kernel = record.kernel();
        Self::of_origin(record.grid(), kernel.boundary, &kernel.origin, poissons_ratio)
    }

    fn of_origin(
        grid: Grid,
        boundary: Boundary,
        origin: &KernelOrigin,
        poissons_ratio: f64,
    ) -> Result<Self, Error> {
        let between = match origin {
            KernelOrigin::Spectral { .. } | KernelOrigin::SpectralLayered { .. } => Between::Waves,
            _ => Between::Cells,
        };
        let layers = match origin {
            KernelOrigin::Layered { body }
            | KernelOrigin::PeriodicLayered { body }
            | KernelOrigin::SpectralLayered { body } => Some(body.clone()),
            _ => None,
        };
        // Layers have ratios of their own.
        let ratio = match layers.as_ref().and_then(|body| body.layers().first()) {
            Some(top) => top.poissons_ratio,
            None => poissons_ratio,
        };
        let body = Self::with(Domain { grid, boundary, between }, ratio)?;
        Ok(Self { layers, ..body })
    }

    fn with(domain: Domain, poissons_ratio: f64) -> Result<Self, Error> {
        if domain.boundary != Boundary::Free && domain.between == Between::Cells {
            check_periodic_cells(&domain.grid, PeriodicBoussinesq::MAX_ASPECT, "at most 1000")?;
        }
        let is_one = poissons_ratio > -1.0 && poissons_ratio <= 0.5;
        let expected = "above -1 and at most 1/2";
        let poissons_ratio = Error::require("Poisson's ratio", poissons_ratio, is_one, expected)?;
        Ok(Self { domain, poissons_ratio, layers: None, friction: (0.0, 0.0) })
    }

    /// The same while it slides: each cell carries a traction of `coefficient` times its pressure as well, in the
    /// direction at `angle` \[rad\] from x towards y, which is that in which the other body moves over this one.
    ///
    /// The pressure is taken as it is: that traction changes it between unlike bodies is left out.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for what is not finite, and [`Error::NotHomogeneous`] for layers.
    pub fn sliding(mut self, coefficient: f64, angle: f64) -> Result<Self, Error> {
        let coefficient = Error::require(
            "coefficient of friction",
            coefficient,
            coefficient.is_finite(),
            "finite",
        )?;
        let angle = Error::require("angle of sliding", angle, angle.is_finite(), "finite")?;
        self.friction = (coefficient * libm::cos(angle), coefficient * libm::sin(angle));
        if coefficient != 0.0 {
            self.check_homogeneous()?;
        }
        Ok(self)
    }

    fn check_homogeneous(&self) -> Result<(), Error> {
        let layering = self.layers.as_ref().map(LayeredBody::layering);
        layering.map_or(Ok(()), |layering| layering.check(Theory::Traction))
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.domain.grid
    }

    /// The surroundings of the grid.
    #[must_use]
    pub fn boundary(&self) -> Boundary {
        self.domain.boundary
    }

    /// The layers, if the body has any.
    #[must_use]
    pub fn layers(&self) -> Option<&LayeredBody> {
        self.layers.as_ref()
    }

    /// Poisson's ratio, of layers that of the uppermost.
    #[must_use]
    pub fn poissons_ratio(&self) -> f64 {
        self.poissons_ratio
    }

    /// Stresses below the centres of the cells, on an interface of layers on its upper side, at a depth z ≥ 0 \[m\]
    /// under a pressure \[Pa\].
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a depth that is negative or more than 10³⁰ long sides of a cell, and for layers or
    /// depths below them that are thinner than a fifth of a cell where the grid repeats;
    /// [`StressError::InRigidBase`]; [`Error::GridMismatch`] and [`Error::FieldNotFinite`] for the pressure.
    pub fn at_depth(&self, pressure: &DMatrix<f64>, depth: f64) -> Result<StressField, Error> {
        let (along_x, along_y) = self.friction;
        let no = DMatrix::zeros(0, 0);
        let traction = |ratio: f64| if ratio == 0.0 { no.clone() } else { ratio * pressure };
        self.under_loads(depth, pressure, &traction(along_x), &traction(along_y))
    }

    /// The same under a pressure and tractions on the body along x and along y \[Pa\], as of partial slip. Friction as
    /// by [`sliding`](Self::sliding) is not added.
    ///
    /// # Errors
    ///
    /// As [`Self::at_depth`], and [`Error::NotHomogeneous`] for tractions on layers.
    pub fn under_traction(
        &self,
        (pressure, depth): (&DMatrix<f64>, f64),
        [along_x, along_y]: [&DMatrix<f64>; 2],
    ) -> Result<StressField, Error> {
        for traction in [along_x, along_y] {
            self.domain.grid.check_finite("traction", traction)?;
        }
        self.under_loads(depth, pressure, along_x, along_y)
    }

    fn kernel(&self, load: Load, depth: f64) -> Result<StressKernel, Error> {
        if load != Load::Normal {
            self.check_homogeneous()?;
        }
        match &self.layers {
            Some(body) if load == Load::Normal => match Below::new(body, depth) {
                Some(below) => StressKernel::of_layers(self.domain, &below, depth),
                None => Err(StressError::InRigidBase { depth, thickness: body.thickness() }.into()),
            },
            _ => StressKernel::new(self.domain, Response::new(load, self.poissons_ratio), depth),
        }
    }

    fn under_loads(
        &self,
        depth: f64,
        pressure: &DMatrix<f64>,
        along_x: &DMatrix<f64>,
        along_y: &DMatrix<f64>,
    ) -> Result<StressField, Error> {
        let grid = &self.domain.grid;
        let is_one = depth >= 0.0 && depth.is_finite();
        Error::require("depth", depth, is_one, "finite and not negative")?;
        let deep = depth / grid.dx().max(grid.dy());
        let quantity = "depth over the long side of a cell";
        Error::require(quantity, deep, deep <= DEEPEST, "at most 1e30")?;
        grid.check_finite("pressure", pressure)?;
        let (nx, ny) = grid.shape();
        let mut sums: [DMatrix<f64>; COMPONENTS] = std::array::from_fn(|_| DMatrix::zeros(nx, ny));
        let loads = [(Load::Normal, pressure), (Load::AlongX, along_x), (Load::AlongY, along_y)];
        for (load, field) in loads {
            if field.iter().all(|value| *value == 0.0) {
                continue;
            }
            self.kernel(load, depth)?.add(field.as_slice(), &mut sums)?;
        }
        Ok(StressField::new(depth, sums))
    }
}
