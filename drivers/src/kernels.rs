//! Half-spaces and other bodies: those of the library, and tables of coefficients that promise nothing.

use asperity::kernel::{
    Base, KernelTable, Layer, Layered, LayeredBody, MeanDisplacement, SemiPeriodicBoussinesq,
};
use asperity::surface::Axis;
use asperity::{
    Boundary, Boussinesq, ContactGrowth, Error, Grid, InfluenceKernel, PeriodicBoussinesq, Spectral,
};

use crate::draw::Draw;

/// What a kernel is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Class {
    /// Love's rectangle, and the same as a table that promises nothing.
    Free,
    FreeTable,
    /// The periodic half-spaces, and the same in another gauge.
    Periodic,
    PeriodicInGauge,
    Spectral,
    SpectralInGauge,
    /// Coefficients that fall exponentially: a positive definite matrix that promises nothing.
    Exponential,
    /// A symbol drawn at random: nodes leave the contact. The mean displacement is real or arbitrary.
    Physical,
    Arbitrary,
    /// Coefficients drawn at random, which may be indefinite.
    Random,
    /// Half-spaces that repeat along one side.
    AlongX,
    AlongY,
    /// Layers whose contact only grows: none is stiffer than what it lies on.
    Soft,
    SoftPeriodic,
    /// Any layers, on which contact may lose nodes.
    Layers,
    LayersPeriodic,
    LayersSpectral,
}

/// Kernels beside that of a free half-space.
pub(crate) const ALL: &[Class] = &[
    Class::FreeTable,
    Class::Periodic,
    Class::PeriodicInGauge,
    Class::Spectral,
    Class::SpectralInGauge,
    Class::Exponential,
    Class::Physical,
    Class::Arbitrary,
    Class::Random,
    Class::AlongX,
    Class::AlongY,
    Class::Layers,
    Class::LayersPeriodic,
    Class::LayersSpectral,
];

/// Those whose matrices are positive definite by theory, on any grid that they accept.
pub(crate) const DEFINITE: &[Class] = &[
    Class::FreeTable,
    Class::Periodic,
    Class::PeriodicInGauge,
    Class::Spectral,
    Class::SpectralInGauge,
    Class::Exponential,
    Class::Physical,
    Class::Arbitrary,
    Class::AlongX,
    Class::AlongY,
    Class::Layers,
    Class::LayersPeriodic,
    Class::LayersSpectral,
];

/// Those that promise that contact only grows.
pub(crate) const GROWING: &[Class] = &[
    Class::Periodic,
    Class::PeriodicInGauge,
    Class::Spectral,
    Class::SpectralInGauge,
    Class::AlongX,
    Class::AlongY,
    Class::Soft,
    Class::SoftPeriodic,
];

/// Cells up to so many times as long as wide on a half-space that repeats along one side: what is computed across is as
/// wide as the grid and five periods.
pub(crate) const LONGEST_ALONG: f64 = 10.0;

/// A kernel, or why there is none.
pub(crate) struct Made {
    pub(crate) class: Class,
    pub(crate) kernel: Result<Box<dyn InfluenceKernel + Send + Sync>, Error>,
}

/// A kernel on `grid` with the modulus `e_star`, of a class that is drawn: a free half-space or one of these.
pub(crate) fn kernel(draw: &mut Draw<'_>, grid: Grid, e_star: f64, others: &[Class]) -> Made {
    let class = match draw.one_of(Class::Free, others) {
        Class::AlongX | Class::AlongY if grid.cell_aspect() > LONGEST_ALONG => Class::Periodic,
        class => class,
    };
    Made { class, kernel: make(draw, grid, e_star, class) }
}

/// A kernel of this class.
pub(crate) fn make(
    draw: &mut Draw<'_>,
    grid: Grid,
    e_star: f64,
    class: Class,
) -> Result<Box<dyn InfluenceKernel + Send + Sync>, Error> {
    let unknown = ContactGrowth::Unknown;
    // Compliances are of the order of a cell over the modulus.
    let scale = grid.dx().max(grid.dy()) / e_star;
    Ok(match class {
        Class::Free => Box::new(Boussinesq::new(grid, e_star)?),
        Class::FreeTable => {
            let love = Boussinesq::new(grid, e_star)?;
            let coefficient = |di, dj| love.coefficient(di, dj);
            Box::new(KernelTable::from_fn(grid, Boundary::Free, unknown, coefficient)?)
        }
        Class::Periodic => Box::new(PeriodicBoussinesq::new(grid, e_star)?),
        Class::PeriodicInGauge => {
            let kernel = PeriodicBoussinesq::new(grid, e_star)?;
            let gauge = kernel.gauge() * draw.decades(-2.0, 2.0);
            Box::new(kernel.with_gauge(gauge)?)
        }
        Class::Spectral => Box::new(Spectral::new(grid, e_star)?),
        Class::SpectralInGauge => {
            let kernel = Spectral::new(grid, e_star)?;
            let gauge = kernel.gauge() * draw.decades(-2.0, 2.0);
            Box::new(kernel.with_gauge(gauge)?)
        }
        Class::Exponential => {
            let reach = draw.decades(-1.0, 1.0);
            let coefficient =
                |di: isize, dj: isize| scale * (-(di as f64).hypot(dj as f64) / reach).exp();
            Box::new(KernelTable::from_fn(grid, Boundary::Free, unknown, coefficient)?)
        }
        Class::Physical | Class::Arbitrary => {
            let mean = match class {
                Class::Physical => MeanDisplacement::Physical,
                _ => MeanDisplacement::Arbitrary,
            };
            // Even in q as it must be: a random amplitude for each pair of opposite waves.
            let spread = draw.between(0.0, 2.0);
            let mut noise = draw.noise();
            let amplitudes: Vec<f64> = (0..64).map(|_| 10_f64.powf(spread * noise())).collect();
            let (lx, ly) = grid.sides();
            let symbol = |qx: f64, qy: f64| {
                let turn = std::f64::consts::TAU;
                let (kx, ky) = ((qx * lx / turn).abs().round(), (qy * ly / turn).abs().round());
                scale * amplitudes[(7 * kx as usize + 3 * ky as usize) % 64]
            };
            Box::new(KernelTable::from_symbol(grid, mean, unknown, symbol)?)
        }
        Class::Random => {
            let strength = draw.unit();
            let mut noise = draw.noise();
            let (nx, ny) = grid.shape();
            let values: Vec<f64> = (0..nx * ny).map(|_| 2.0 * noise() - 1.0).collect();
            let coefficient = |di: isize, dj: isize| {
                let (di, dj) = (di.unsigned_abs(), dj.unsigned_abs());
                let own = (di, dj) == (0, 0);
                scale * if own { 1.0 } else { strength * values[di + nx * dj] }
            };
            Box::new(KernelTable::from_fn(grid, Boundary::Free, unknown, coefficient)?)
        }
        Class::AlongX => Box::new(SemiPeriodicBoussinesq::new(grid, e_star, Axis::X)?),
        Class::AlongY => Box::new(SemiPeriodicBoussinesq::new(grid, e_star, Axis::Y)?),
        Class::Soft => Box::new(Layered::free(grid, soft(draw, &grid, e_star)?)?),
        Class::SoftPeriodic => Box::new(Layered::periodic(grid, soft(draw, &grid, e_star)?)?),
        Class::Layers => Box::new(Layered::free(grid, layers(draw, &grid, e_star)?)?),
        Class::LayersPeriodic => Box::new(Layered::periodic(grid, layers(draw, &grid, e_star)?)?),
        Class::LayersSpectral => Box::new(Layered::spectral(grid, layers(draw, &grid, e_star)?)?),
    })
}

/// From a tenth of a cell to a hundred of them; some are all but incompressible.
fn layer(draw: &mut Draw<'_>, grid: &Grid, youngs_modulus: f64) -> Layer {
    let thickness = grid.cell_area().sqrt() * draw.decades(-1.0, 2.0);
    Layer { youngs_modulus, poissons_ratio: draw.mostly(0.0, 0.45, 0.5), thickness }
}

/// A layer on a rigid base or on a body that is stiffer.
fn soft(draw: &mut Draw<'_>, grid: &Grid, youngs_modulus: f64) -> Result<LayeredBody, Error> {
    let layer = layer(draw, grid, youngs_modulus);
    let base = match draw.once_in(2) {
        true => Base::Rigid,
        false => Base::HalfSpace {
            youngs_modulus: youngs_modulus * draw.decades(0.0, 3.0),
            poissons_ratio: layer.poissons_ratio,
        },
    };
    LayeredBody::new(&[layer], base)
}

/// One layer or two on a rigid base or any other body, sometimes against an elastic one.
fn layers(draw: &mut Draw<'_>, grid: &Grid, youngs_modulus: f64) -> Result<LayeredBody, Error> {
    let mut layers = vec![layer(draw, grid, youngs_modulus)];
    if draw.once_in(2) {
        let youngs_modulus = youngs_modulus * draw.decades(-2.0, 2.0);
        layers.push(layer(draw, grid, youngs_modulus));
    }
    let base = match draw.once_in(2) {
        true => Base::Rigid,
        false => Base::HalfSpace {
            youngs_modulus: youngs_modulus * draw.decades(-3.0, 3.0),
            poissons_ratio: draw.between(0.0, 0.5),
        },
    };
    let body = LayeredBody::new(&layers, base)?;
    match draw.once_in(3) {
        true => body.against(youngs_modulus * draw.decades(-2.0, 2.0)),
        false => Ok(body),
    }
}
