//! Whole contact problems.

use asperity::fixed_load::FixedLoadBuilder;
use asperity::loading::LoadingBuilder;
use asperity::{
    Error, FixedLoadSolver, Grid, HeightMap, InfluenceKernel, LoadingSolver, PeriodicBoussinesq,
};
use nalgebra::DMatrix;

use crate::draw::Draw;
use crate::kernels::{self, Class, Made};
use crate::surfaces;
use crate::verdict::{Tally, Verdict, Violation, ensure};

/// Nodes of the largest grid: a dense check of each state takes some n³ operations.
const MOST_NODES: usize = 81;

/// A surface on a body.
pub(crate) struct Sample {
    pub(crate) surface: HeightMap,
    pub(crate) kernel: Box<dyn InfluenceKernel + Send + Sync>,
    pub(crate) class: Class,
    /// The greatest pressure of each node \[Pa\].
    pub(crate) hardness: Option<DMatrix<f64>>,
}

impl Sample {
    /// Draws grid, heights and kernel, that of a free half-space or one of these, and looks at the problem: what is wrong
    /// there is told with it.
    pub(crate) fn look(
        draw: &mut Draw<'_>,
        kernels: &[Class],
        look: impl FnOnce(&mut Self, &mut Draw<'_>) -> Verdict,
    ) -> Verdict {
        let grid = grid(draw)?;
        // Squares of pressures, and heights squared times modulus times cell, stay within double precision.
        let (height, modulus) = match draw.once_in(4) {
            true => (draw.decades(-40.0, 40.0), draw.decades(-40.0, 40.0)),
            false => (draw.decades(-10.0, -2.0), draw.decades(0.0, 12.0)),
        };
        let heights = surfaces::heights(draw, grid.shape()) * height;
        let surface = HeightMap::new(heights)
            .map_err(|error| Violation::new(format!("finite heights were refused: {error}")))?;
        let Made { class, kernel } = kernels::kernel(draw, grid, modulus, kernels);
        let mut sample = match kernel {
            Ok(kernel) => Self { surface, kernel, class, hardness: None },
            Err(error) => return judge(&error, &grid, class),
        };
        look(&mut sample, draw).map_err(|violation| violation.during(sample.context()))
    }

    /// Draws cells from square to 100 times as long as wide, heights and a half-space, in ordinary units; periodic
    /// cells are `longest` times as long as wide at most.
    pub(crate) fn half_space(
        draw: &mut Draw<'_>,
        shape: (usize, usize),
        longest: f64,
    ) -> Result<Self, Violation> {
        half_space(draw, shape, longest)
            .map_err(|error| Violation::new(format!("a sensible problem was refused: {error}")))
    }

    /// Draws heights and a periodic half-space with cells of all lengths that are drawn elsewhere, in units of one.
    pub(crate) fn of_long_cells(
        draw: &mut Draw<'_>,
        (nx, ny): (usize, usize),
    ) -> Result<Self, Violation> {
        let made = |draw: &mut Draw<'_>| -> Result<Self, Error> {
            let surface = HeightMap::new(surfaces::heights(draw, (nx, ny)))?;
            let class = draw.one_of(Class::Spectral, &[Class::Periodic]);
            let aspect = draw.one_of(1.0, &[-1.0]) * draw.between(0.0, 2.5);
            let grid = Grid::new(nx, ny, 10_f64.powf(0.5 * aspect), 10_f64.powf(-0.5 * aspect))?;
            let kernel = kernels::make(draw, grid, 1.0, class)?;
            Ok(Self { surface, kernel, class, hardness: None })
        };
        made(draw)
            .map_err(|error| Violation::new(format!("a sensible problem was refused: {error}")))
    }

    /// Draws a hardness, one for all nodes or one for each: from one under which contacts are points to one that no
    /// pressure comes to, some of them infinite.
    pub(crate) fn harden(&mut self, draw: &mut Draw<'_>) {
        let grid = self.kernel.grid();
        let height = self.surface.peak_to_valley();
        let height = if height > 0.0 { height } else { grid.dx() };
        let pressure = height / self.kernel.coefficient(0, 0);
        let hardness = pressure
            * match draw.once_in(3) {
                true => draw.decades(-9.0, -2.0),
                false => draw.decades(-2.0, 1.0),
            };
        let (spread, infinite) = match draw.whole(0, 4) {
            0..=2 => (0.0, 0.0),
            3 => (draw.between(0.0, 3.0), 0.0),
            _ => (draw.between(0.0, 1.0), draw.unit()),
        };
        let mut noise = draw.noise();
        let (nx, ny) = grid.shape();
        self.hardness = Some(DMatrix::from_fn(nx, ny, |_, _| {
            let factor = 10_f64.powf(spread * noise());
            if noise() < infinite { f64::INFINITY } else { hardness * factor }
        }));
    }

    /// The path of the problem.
    pub(crate) fn path(&self) -> LoadingBuilder<'_> {
        let builder = LoadingSolver::builder(&self.surface, &self.kernel);
        match &self.hardness {
            None => builder,
            Some(map) if map.min() == map.max() => builder.hardness(map.min()),
            Some(map) => builder.hardness_map(map),
        }
    }

    /// Single loads on it.
    pub(crate) fn single_loads(&self) -> FixedLoadBuilder<'_> {
        let builder = FixedLoadSolver::builder(&self.surface, &self.kernel);
        match &self.hardness {
            None => builder,
            Some(map) if map.min() == map.max() => builder.hardness(map.min()),
            Some(map) => builder.hardness_map(map),
        }
    }

    /// The load \[N\] under which all nodes yield.
    pub(crate) fn greatest_load(&self) -> f64 {
        let hardness = self.hardness.as_ref().map_or(f64::INFINITY, DMatrix::sum);
        hardness * self.kernel.grid().cell_area()
    }

    /// For messages.
    pub(crate) fn context(&self) -> String {
        let grid = self.kernel.grid();
        let peak = self.surface.peak_to_valley();
        // Enough to make the case again without its bytes.
        let heights = self.surface.matrix().as_slice();
        let heights = if heights.len() > 20 { &[] } else { heights };
        let hardness = self.hardness.as_ref().map_or_else(String::new, |map| {
            let values = if map.len() > 20 { &[] } else { map.as_slice() };
            format!(", hardness {:e} to {:e} {values:?}", map.min(), map.max())
        });
        format!(
            "{:?} on {} x {} nodes of {:e} x {:e}, {peak:e} high {heights:?}{hardness}",
            self.class,
            grid.nx(),
            grid.ny(),
            grid.dx(),
            grid.dy()
        )
    }
}

fn half_space(
    draw: &mut Draw<'_>,
    (nx, ny): (usize, usize),
    longest: f64,
) -> Result<Sample, Error> {
    let aspect = match draw.whole(0, 2) {
        0 => 1.0,
        1 => draw.decades(-1.0, 1.0),
        _ => draw.decades(-2.0, 2.0),
    };
    let dx = draw.decades(-8.0, 0.0);
    let (height, modulus) = (draw.decades(-10.0, -2.0), draw.decades(0.0, 12.0));
    let surface = HeightMap::new(surfaces::heights(draw, (nx, ny)) * height)?;
    let others = [
        Class::Periodic,
        Class::Spectral,
        Class::AlongX,
        Class::AlongY,
        Class::Soft,
        Class::SoftPeriodic,
    ];
    let class = draw.one_of(Class::Free, &others);
    let aspect = match class {
        Class::Free | Class::Soft => aspect,
        Class::AlongX | Class::AlongY => {
            aspect.clamp(1.0 / kernels::LONGEST_ALONG, kernels::LONGEST_ALONG)
        }
        _ => aspect.clamp(1.0 / longest, longest),
    };
    let grid = Grid::new(nx, ny, dx, dx * aspect)?;
    let kernel = kernels::make(draw, grid, modulus, class)?;
    Ok(Sample { surface, kernel, class, hardness: None })
}

/// A grid: small squares, strips and whatever lies between, with cells from square to 10⁴ times as long as wide.
fn grid(draw: &mut Draw<'_>) -> Result<Grid, Violation> {
    let (nx, ny) = match draw.whole(0, 3) {
        0 => (draw.whole(1, 5), draw.whole(1, 5)),
        1 => (draw.whole(1, 9), draw.whole(1, 9)),
        2 => (1, draw.whole(1, MOST_NODES)),
        _ => (draw.whole(1, MOST_NODES), 1),
    };
    let dx = match draw.once_in(4) {
        true => draw.decades(-40.0, 40.0),
        false => draw.decades(-8.0, 0.0),
    };
    let aspect = match draw.whole(0, 3) {
        0 | 1 => 1.0,
        2 => draw.decades(-1.0, 1.0),
        _ => draw.decades(-4.0, 4.0),
    };
    Grid::new(nx, ny, dx, dx * aspect)
        .map_err(|error| Violation::new(format!("a sensible grid was refused: {error}")))
}

/// Whether a kernel could only be refused.
fn judge(error: &Error, grid: &Grid, class: Class) -> Verdict {
    let aspect = grid.cell_aspect();
    let deserved = match (error, class) {
        (
            Error::OutOfRange { .. },
            Class::Periodic | Class::PeriodicInGauge | Class::SoftPeriodic | Class::LayersPeriodic,
        ) => aspect > PeriodicBoussinesq::MAX_ASPECT,
        // Nothing is known of a single node whose mean displacement is arbitrary.
        (Error::NotPositiveDefinite { .. }, Class::Arbitrary) => grid.nodes() == 1,
        _ => false,
    };
    ensure!(
        deserved,
        "{class:?} on {} x {} nodes, cells 1 : {aspect}: {error}",
        grid.nx(),
        grid.ny()
    );
    Ok(Tally::refusal())
}
