//! The geometry of the challenge, and its contact under a load.

use asperity::patches::{Bins, gap_distribution, pressure_distribution};
use asperity::surface::{Amplitude, HeightMap, SelfAffine, Spectrum};
use asperity::{Boundary, Error, FixedLoadSolution, FixedLoadSolver, Grid, Spectral};
use asperity_studies::contact_area::corrected_area_fraction;

/// L, λ_r \[m\], E* \[Pa\], H and the rms gradient.
pub(crate) const SIDE: f64 = 1e-4;
pub(crate) const ROLLOFF: f64 = 2e-5;
pub(crate) const E_STAR: f64 = 25e6;
pub(crate) const HURST: f64 = 0.8;
pub(crate) const GRADIENT: f64 = 1.0;
/// L/λ_s.
pub(crate) const BAND: usize = 1000;
const SEED: u64 = 2017;
/// Bins of the distributions in each factor of ten of the gap, and over the range of pressures.
const GAP_BINS: usize = 8;
const PRESSURE_BINS: usize = 60;

/// One contact.
pub(crate) struct Contact {
    pub(crate) nodes: usize,
    /// L/λ_s.
    pub(crate) band: usize,
    pub(crate) spectrum: Spectrum,
    /// p̄/E*.
    pub(crate) load: f64,
    /// A/A₀, cells counted and corrected.
    pub(crate) area: f64,
    pub(crate) corrected: f64,
    /// Mean gap \[m\].
    pub(crate) gap: f64,
    /// K_i h_rms/(A₀ p̄); not a number where it was not asked for.
    pub(crate) stiffness: f64,
    /// Greatest pressure over the mean pressure.
    pub(crate) peak: f64,
    /// Middle of a bin \[m\] and density of the gap over the nominal area, times the gap.
    pub(crate) gaps: Vec<(f64, f64)>,
    /// Pressure over E* and its density over the nominal area, times E*.
    pub(crate) pressures: Vec<(f64, f64)>,
}

impl Contact {
    pub(crate) fn kappa(&self) -> f64 {
        self.area * GRADIENT / self.load
    }

    pub(crate) fn corrected_kappa(&self) -> f64 {
        self.corrected * GRADIENT / self.load
    }

    /// Cells to the shortest wave.
    pub(crate) fn cells(&self) -> f64 {
        self.nodes as f64 / self.band as f64
    }
}

/// The surface with its spectrum cut at L/`band`, under each load p̄/E*.
pub(crate) fn solve(
    nodes: usize,
    band: usize,
    loads: &[f64],
    stiffness: bool,
) -> Result<Vec<Contact>, Error> {
    let grid = Grid::square(nodes, SIDE)?;
    let amplitude = Amplitude::RmsGradient(GRADIENT);
    let surface = SelfAffine::new(HURST, ROLLOFF, SIDE / band as f64, amplitude, SEED)?;
    let spectrum = surface.spectrum(&grid)?;
    let heights = HeightMap::sample(&surface, &grid)?;
    let kernel = Spectral::new(grid, E_STAR)?;
    let mut solver = FixedLoadSolver::builder(&heights, &kernel).stiffness(stiffness).build()?;
    let solved = loads.iter().map(|load| {
        let solution = solver.solve(load * E_STAR * grid.nominal_area())?;
        read(&solution, &grid, band, spectrum, *load)
    });
    solved.collect()
}

fn read(
    solution: &FixedLoadSolution,
    grid: &Grid,
    band: usize,
    spectrum: Spectrum,
    load: f64,
) -> Result<Contact, Error> {
    let state = &solution.contact;
    let stiffness = state.interfacial_stiffness.unwrap_or(f64::NAN);
    let map = &solution.fields.contact_map;
    let gaps = gap_distribution(&solution.fields.gap, map, Bins::PerDecade(GAP_BINS))?;
    let open = 1.0 - gaps.contact_area_fraction;
    let middle = |edges: &[f64]| (edges[0] * edges[1]).sqrt();
    let gaps = gaps.histogram.edges().windows(2).zip(gaps.histogram.density());
    let found = pressure_distribution(&solution.fields.pressure, map, Bins::Linear(PRESSURE_BINS))?;
    let share = found.contact_area_fraction;
    let pressures = found.histogram.edges().windows(2).zip(found.histogram.density());
    Ok(Contact {
        nodes: grid.nx(),
        band,
        spectrum,
        load,
        area: state.contact_area_fraction,
        corrected: corrected_area_fraction(map, grid, Boundary::Periodic)?,
        gap: state.mean_gap,
        stiffness: stiffness * spectrum.rms_height() / state.load,
        peak: solution.fields.max_pressure() / state.mean_pressure(),
        gaps: gaps
            .map(|(edges, density)| (middle(edges), open * density * middle(edges)))
            .filter(|(_, density)| *density > 0.0)
            .collect(),
        pressures: pressures
            .map(|(edges, density)| {
                let middle = 0.5 * (edges[0] + edges[1]) / E_STAR;
                (middle, share * density * E_STAR)
            })
            .filter(|(_, density)| *density > 0.0)
            .collect(),
    })
}
