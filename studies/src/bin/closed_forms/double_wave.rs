//! The wave in two directions, between the limits of Johnson, Greenwood and Higginson: Hertz contact of each crest
//! under a light load, a penny crack in each valley just below full contact, and full contact itself.

use asperity::reference::DoubleWave;
use asperity::surface::BiWave;
use asperity::{Error, FixedLoadSolution, FixedLoadSolver, Grid};
use asperity_cli::half_space::{Periodic, half_space};

use crate::curve::APEXES;
use asperity_studies::contact_area::corrected_area_fraction;
use asperity_studies::line::Line;
use asperity_studies::order::order;
use asperity_studies::spread::Spread;

const AMPLITUDE: f64 = 0.01;
/// P = p̄/p* where full contact is looked at.
pub(crate) const BEYOND: f64 = 1.02;
/// How close to its load full contact is asked for, below and above.
pub(crate) const BRACKET: f64 = 1e-6;
const FULL_NODES: [usize; 5] = [16, 32, 64, 128, 256];
/// Nodes along the wave of the limits: contacts and holes are as small as the least of these P and 1 − P make them.
pub(crate) const LIGHT_NODES: usize = 1024;
pub(crate) const HEAVY_NODES: usize = 512;
const LIGHT: [f64; 6] = [1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2];
const HEAVY: [f64; 5] = [5e-3, 1e-2, 2e-2, 5e-2, 0.1];
/// By how much the extrapolated area may differ from the limit, relative.
pub(crate) const CLOSE: f64 = 0.01;
/// The same of the load of full contact in spectral solutions, which have the wave as one of their own: what gaps wrong
/// by the tolerance mean for pressures, at worst as the shortest wave of the finest grid, 256/(2√2) times as stiff.
pub(crate) const EXACT: f64 = 1e-10;
/// Of the solutions in full contact.
const FULL_TOLERANCE: f64 = 1e-12;

/// Full contact on finer and finer grids.
pub(crate) struct Full {
    pub(crate) kernel: Periodic,
    /// (nodes along the wave, relative errors of the load of full contact, of the greatest pressure and of the energy
    /// at P = 1.02).
    pub(crate) errors: Vec<(usize, [f64; 3])>,
    /// Whether contact is full just above the load found, and not just below, on every grid.
    pub(crate) bracketed: bool,
}

impl Full {
    fn new(kernel: Periodic) -> Result<Self, Error> {
        let exact = DoubleWave::new(AMPLITUDE, 1.0, 1.0)?;
        let full = exact.full_contact_pressure();
        let (mut errors, mut bracketed) = (Vec::new(), true);
        for nodes in FULL_NODES {
            let grid = Grid::square(nodes, 1.0)?;
            // Nodes on the crests and in the valleys.
            let mut solver = solver(kernel, grid, grid.position(0, 0))?;
            let solution = solver.solve(BEYOND * full)?;
            let found = solution.contact.load - solution.fields.pressure.min();
            let peak = solution.fields.pressure.max() / full;
            // ½ p u in the mean, both in proportion to the wave.
            let energy = full * AMPLITUDE / 8.0;
            let relative = [found / full, peak / (1.0 + BEYOND), solution.contact.energy / energy];
            errors.push((nodes, relative.map(|ratio| (ratio - 1.0).abs())));
            let mut is_full = |load: f64| -> Result<bool, Error> {
                Ok(solver.solve(load)?.contact.contact_nodes == grid.nodes())
            };
            bracketed &= is_full(found * (1.0 + BRACKET))? && !is_full(found * (1.0 - BRACKET))?;
        }
        Ok(Self { kernel, errors, bracketed })
    }

    /// Order of the error of the load of full contact.
    pub(crate) fn order(&self) -> f64 {
        let points: Vec<_> = self.errors.iter().map(|(n, e)| (*n as f64, e[0])).collect();
        order(&points, 3)
    }

    pub(crate) fn agrees(&self) -> bool {
        let exact = self.errors.iter().all(|(_, e)| e[0] <= EXACT);
        self.bracketed
            && match self.kernel {
                Periodic::Spectral => exact,
                Periodic::Love | Periodic::X | Periodic::Y => (self.order() - 2.0).abs() <= 0.2,
            }
    }
}

/// The area beside that of a limit.
pub(crate) struct Limit {
    pub(crate) nodes: usize,
    /// (distance from the limit: P or 1 − P, ratio of the area in contact or out of contact to that of the limit).
    pub(crate) ratios: Vec<(f64, Spread)>,
    /// The power of the distance with which the ratio goes to 1.
    pub(crate) power: f64,
}

impl Limit {
    /// The ratio at the limit itself, by a line in the power of the distance.
    pub(crate) fn extrapolated(&self) -> f64 {
        let points = self.ratios.iter().map(|(d, r)| (d.powf(self.power), r.mean));
        Line::fit(&points.collect::<Vec<_>>()).intercept
    }

    pub(crate) fn agrees(&self) -> bool {
        (self.extrapolated() - 1.0).abs() <= CLOSE
    }

    /// Ratios at each distance, over the places of the crest in the cells.
    fn new(
        nodes: usize,
        distances: &[f64],
        power: f64,
        load: fn(f64) -> f64,
        ratio: fn(&DoubleWave, f64, f64) -> f64,
    ) -> Result<Self, Error> {
        let exact = DoubleWave::new(AMPLITUDE, 1.0, 1.0)?;
        let full = exact.full_contact_pressure();
        let grid = Grid::square(nodes, 1.0)?;
        let mut found = vec![Vec::new(); distances.len()];
        for offset in APEXES {
            let (x, y) = grid.center();
            let crest = (x + offset.0 * grid.dx(), y + offset.1 * grid.dy());
            let kernel = half_space(Some(Periodic::Love), grid, 1.0)?;
            let surface = surface(crest)?;
            let mut solver =
                FixedLoadSolver::builder(&surface, &kernel).stiffness(false).build()?;
            for (distance, ratios) in distances.iter().zip(&mut found) {
                let solution = solver.solve(load(*distance) * full)?;
                ratios.push(ratio(&exact, solution.contact.load, area(&solution, &grid)?));
            }
        }
        let spread = found.into_iter().map(Spread::of);
        Ok(Self { nodes, ratios: distances.iter().copied().zip(spread).collect(), power })
    }
}

fn area(solution: &FixedLoadSolution, grid: &Grid) -> Result<f64, Error> {
    corrected_area_fraction(&solution.fields.contact_map, grid, asperity::Boundary::Periodic)
}

fn surface(crest: (f64, f64)) -> Result<BiWave, asperity::SurfaceError> {
    BiWave::new(AMPLITUDE, 1.0, 1.0)?.centered_at(crest.0, crest.1)
}

fn solver(kernel: Periodic, grid: Grid, crest: (f64, f64)) -> Result<FixedLoadSolver, Error> {
    let kernel = half_space(Some(kernel), grid, 1.0)?;
    FixedLoadSolver::builder(&surface(crest)?, &kernel)
        .tolerance(FULL_TOLERANCE)
        .stiffness(false)
        .build()
}

/// All that is compared.
pub(crate) struct Comparison {
    pub(crate) full: [Full; 2],
    pub(crate) light: Limit,
    pub(crate) heavy: Limit,
}

impl Comparison {
    pub(crate) fn new() -> Result<Self, Error> {
        Ok(Self {
            full: [Full::new(Periodic::Love)?, Full::new(Periodic::Spectral)?],
            // A crest is a paraboloid to second order in the radius of contact, which goes with P to the third.
            light: Limit::new(
                LIGHT_NODES,
                &LIGHT,
                2.0 / 3.0,
                |p| p,
                |exact, mean, area| area / exact.contact_area_fraction_light(mean),
            )?,
            // So is a valley, in the radius of a hole, which goes with the root of 1 − P.
            heavy: Limit::new(
                HEAVY_NODES,
                &HEAVY,
                1.0,
                |p| 1.0 - p,
                |exact, mean, area| (1.0 - area) / (1.0 - exact.contact_area_fraction_heavy(mean)),
            )?,
        })
    }
}
