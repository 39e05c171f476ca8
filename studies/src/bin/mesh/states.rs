//! Surfaces of one family under the same loads, on meshes of any fineness.

use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity::{Boundary, Error, FixedLoadSolver, Grid, PeriodicBoussinesq};
use asperity_studies::contact_area::corrected_area_fraction;

/// Hurst exponent, and wavelength of the roll-off over the side: those of the study `periodic_study`.
pub(crate) const HURST: f64 = 0.8;
pub(crate) const ROLLOFF: f64 = 0.25;
/// It cancels: all results are relative to it.
const RMS_HEIGHT: f64 = 1e-3;
/// Mean pressures over E* h′.
pub(crate) const LOADS: [f64; 5] = [0.003, 0.01, 0.03, 0.1, 0.3];

/// Which surface, on which mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Mesh {
    /// λ_r/λ_s.
    pub(crate) band: usize,
    /// Cells to the shortest wave.
    pub(crate) cells: usize,
}

/// A surface under one load, in the units of the theories.
#[derive(Debug, Clone, Copy)]
pub(crate) struct State {
    /// p̄/(E* h′).
    pub(crate) load: f64,
    /// A/A₀ as cells are counted, and corrected.
    pub(crate) area: f64,
    pub(crate) corrected: f64,
    /// ḡ/h_rms.
    pub(crate) gap: f64,
    /// K_i h_rms/(A₀ p̄).
    pub(crate) stiffness: f64,
}

impl State {
    /// κ of A/A₀ = κ p̄/(E* h′).
    pub(crate) fn kappa(&self) -> f64 {
        self.area / self.load
    }

    pub(crate) fn corrected_kappa(&self) -> f64 {
        self.corrected / self.load
    }
}

impl Mesh {
    /// Nodes a side.
    pub(crate) fn nodes(self) -> usize {
        self.band * self.cells * (1.0 / ROLLOFF) as usize
    }

    fn surface(self, seed: u64) -> Result<SelfAffine, asperity::SurfaceError> {
        let cutoff = ROLLOFF / self.band as f64;
        SelfAffine::new(HURST, ROLLOFF, cutoff, Amplitude::RmsHeight(RMS_HEIGHT), seed)
    }

    /// Nayak's parameter of the spectrum.
    pub(crate) fn nayak(self) -> Result<f64, Error> {
        let grid = Grid::square(self.nodes(), 1.0)?;
        Ok(self.surface(1)?.spectrum(&grid)?.nayak_parameter())
    }

    /// The states of one surface under all loads.
    pub(crate) fn states(self, seed: u64) -> Result<Vec<State>, Error> {
        let grid = Grid::square(self.nodes(), 1.0)?;
        let surface = self.surface(seed)?;
        // The gradient of the sum of waves is the same for all seeds and meshes.
        let gradient = surface.spectrum(&grid)?.rms_gradient();
        let heights = HeightMap::sample(&surface, &grid)?;
        let kernel = PeriodicBoussinesq::new(grid, 1.0)?;
        let mut solver = FixedLoadSolver::new(&heights, &kernel)?;
        let mut states = Vec::new();
        for load in LOADS {
            // On the unit square, with E* = 1, loads are mean pressures over E*.
            let solution = solver.solve(load * gradient)?;
            let state = &solution.contact;
            let stiffness = state.interfacial_stiffness.unwrap_or(f64::NAN);
            states.push(State {
                load,
                area: state.contact_area_fraction,
                corrected: corrected_area_fraction(
                    &solution.fields.contact_map,
                    &grid,
                    Boundary::Periodic,
                )?,
                gap: state.mean_gap / RMS_HEIGHT,
                stiffness: stiffness * RMS_HEIGHT / state.load,
            });
        }
        Ok(states)
    }
}
