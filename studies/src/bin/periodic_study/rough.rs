//! Self-affine surfaces under the same loads, for the theories of rough contact.

use std::fmt::Write;

use asperity::reference::AreaLoadLaw;
use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity::{Boundary, ContactTarget, FixedLoadSolver, Grid};
use indicatif::ProgressBar;

use crate::Options;
use asperity_cli::half_space::{Periodic, half_space};
use asperity_cli::outcome::Failure;
use asperity_studies::contact_area::corrected_area_fraction;
use asperity_studies::line::Line;
use asperity_studies::spread::Spread;

/// Hurst exponent.
pub(crate) const HURST: f64 = 0.8;
/// Wavelengths of the roll-off and of the short cut-off, as parts of the side.
const ROLLOFF: f64 = 0.25;
pub(crate) const CUTOFF: f64 = 1.0 / 32.0;
/// It cancels: all results are relative to it.
const RMS_HEIGHT: f64 = 1e-3;
/// Mean pressures over E* h′: from isolated contacts to nearly full contact.
pub(crate) const LEAST_LOAD: f64 = 1e-3;
pub(crate) const MOST_LOAD: f64 = 1.2;
/// Where the exponential law of the mean gap is fitted.
pub(crate) const FIT: (f64, f64) = (3e-3, 0.1);
/// The greatest A/A0 at which area is taken to be in proportion to load, as the area laws have it.
pub(crate) const LIGHT: f64 = 0.1;

/// One state of one surface, in the units of the theories.
#[derive(Debug, Clone, Copy)]
pub(crate) struct State {
    seed: u64,
    /// p̄/(E* h′).
    pub(crate) load: f64,
    /// A/A0, cells counted whole.
    pub(crate) area: f64,
    /// A/A0 without what whole cells count too much.
    pub(crate) corrected: f64,
    /// ḡ/h_rms.
    pub(crate) gap: f64,
    /// K_i h_rms/(A0 p̄).
    pub(crate) stiffness: f64,
}

/// All states of all surfaces.
pub(crate) struct Study {
    pub(crate) nodes: usize,
    pub(crate) kernel: Periodic,
    pub(crate) surfaces: u64,
    pub(crate) loads: usize,
    /// Surface by surface, and load by load.
    pub(crate) states: Vec<State>,
    laws: AreaLoadLaw,
}

fn failed(error: impl Into<asperity::Error>) -> Failure {
    Failure::new("the study of rough surfaces failed", error.into())
}

impl Study {
    pub(crate) fn run(options: &Options) -> Result<Self, Failure> {
        if options.surfaces < 1 || options.loads < 2 {
            return Err(Failure::request("a study needs a surface and two loads"));
        }
        let grid = Grid::square(options.nodes, 1.0).map_err(failed)?;
        let bar = ProgressBar::new(options.surfaces * options.loads as u64);
        let mut states = Vec::new();
        let mut rms_gradient = 0.0;
        for seed in 1..=options.surfaces {
            let height = Amplitude::RmsHeight(RMS_HEIGHT);
            let surface = SelfAffine::new(HURST, ROLLOFF, CUTOFF, height, seed).map_err(failed)?;
            // The gradient of the spectrum is the same for all seeds.
            rms_gradient = surface.spectrum(&grid).map_err(failed)?.rms_gradient();
            let heights = HeightMap::sample(&surface, &grid).map_err(failed)?;
            let kernel = half_space(Some(options.kernel), grid, 1.0).map_err(failed)?;
            let mut solver = FixedLoadSolver::new(&heights, &kernel).map_err(failed)?;
            let pressures = (0..options.loads).map(|i| {
                let part = i as f64 / (options.loads - 1) as f64;
                rms_gradient * LEAST_LOAD * (MOST_LOAD / LEAST_LOAD).powf(part)
            });
            // On the unit square, with E* = 1, loads are mean pressures over E*.
            for solution in solver.sweep(pressures.map(ContactTarget::Load)) {
                let solution = solution.map_err(failed)?;
                let (state, map) = (solution.contact, &solution.fields.contact_map);
                states.push(State {
                    seed,
                    load: state.load / rms_gradient,
                    area: state.contact_area_fraction,
                    corrected: corrected_area_fraction(map, &grid, Boundary::Periodic)
                        .map_err(failed)?,
                    gap: state.mean_gap / RMS_HEIGHT,
                    stiffness: state.interfacial_stiffness.unwrap_or(f64::NAN) * RMS_HEIGHT
                        / state.load,
                });
                bar.inc(1);
            }
        }
        bar.finish_and_clear();
        Ok(Self {
            nodes: options.nodes,
            kernel: options.kernel,
            surfaces: options.surfaces,
            loads: options.loads,
            states,
            laws: AreaLoadLaw::new(rms_gradient, 1.0).map_err(failed)?,
        })
    }

    /// The states of all surfaces under the same load.
    pub(crate) fn at(&self, load: usize) -> impl Iterator<Item = &State> {
        self.states.iter().skip(load).step_by(self.loads)
    }

    pub(crate) fn spread(&self, load: usize, value: fn(&State) -> f64) -> Spread {
        Spread::of(self.at(load).map(value))
    }

    /// A/A0 of Persson's theory.
    pub(crate) fn persson(&self, load: f64) -> f64 {
        self.laws.persson(load * self.laws.rms_gradient())
    }

    /// γ and ln(p̄₀/(E* h′)) of p̄ = p̄₀ exp(−ḡ/(γ h_rms)) for each surface.
    fn exponentials(&self) -> Vec<(f64, f64)> {
        self.states
            .chunks(self.loads)
            .map(|states| {
                let fitted = states.iter().filter(|s| s.load >= FIT.0 && s.load <= FIT.1);
                let points: Vec<_> = fitted.map(|s| (s.gap, s.load.ln())).collect();
                let line = Line::fit(&points);
                (-1.0 / line.slope, line.intercept)
            })
            .collect()
    }

    /// Mean of γ, of the intercept, and the spread of γ.
    pub(crate) fn exponential(&self) -> (Spread, f64) {
        let each = self.exponentials();
        let intercept = Spread::of(each.iter().map(|fit| fit.1)).mean;
        (Spread::of(each.iter().map(|fit| fit.0)), intercept)
    }

    /// κ of A/A0 = κ p̄/(E* h′) of an area: its mean over the loads at which contact is light.
    pub(crate) fn kappa(&self, area: fn(&State) -> f64) -> Spread {
        Spread::of(self.states.chunks(self.loads).map(|states| {
            let light = states.iter().filter(|s| s.area <= LIGHT);
            Spread::of(light.map(|s| area(s) / s.load)).mean
        }))
    }

    /// The loads, by their number, at which contact is light on every surface.
    pub(crate) fn light(&self) -> impl Iterator<Item = usize> {
        (0..self.loads).filter(|load| self.at(*load).all(|s| s.area <= LIGHT))
    }

    pub(crate) fn csv(&self) -> String {
        let mut text = "seed,mean_pressure_over_e_star_rms_gradient,contact_area_fraction,corrected_area_fraction,\
                        mean_gap_over_rms_height,interfacial_stiffness_rms_height_over_load\n"
            .to_string();
        for s in &self.states {
            let (load, area, gap, stiffness) = (s.load, s.area, s.gap, s.stiffness);
            let (seed, corrected) = (s.seed, s.corrected);
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{seed},{load:e},{area:e},{corrected:e},{gap:e},{stiffness:e}");
        }
        text
    }
}
