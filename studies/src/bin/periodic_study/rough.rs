//! Self-affine surfaces under the same loads, against the theories of rough contact.

use std::fmt::Write;
use std::time::Instant;

use asperity::reference::AreaLoadLaw;
use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity::{FixedLoadSolver, Grid};
use indicatif::ProgressBar;

use crate::Options;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{BLACK, BLUE, Chart, Corner, GREEN, GREY, ORANGE, Series, Style};
use asperity_cli::half_space::{Periodic, half_space};
use asperity_cli::outcome::Failure;
use asperity_studies::line::Line;
use asperity_studies::spread::Spread;

/// Hurst exponent.
const HURST: f64 = 0.8;
/// Wavelengths of the roll-off and of the short cut-off, as parts of the side.
const ROLLOFF: f64 = 0.25;
const CUTOFF: f64 = 1.0 / 32.0;
/// It cancels: all results are relative to it.
const RMS_HEIGHT: f64 = 1e-3;
/// Mean pressures over E* h′: from isolated contacts to nearly full contact.
const LEAST_LOAD: f64 = 1e-3;
const MOST_LOAD: f64 = 1.2;
/// Where the exponential law of the mean gap is fitted.
const FIT: (f64, f64) = (3e-3, 0.1);
/// The greatest A/A0 at which area is taken to be in proportion to load, as the area laws have it.
const LIGHT: f64 = 0.1;

/// One state of one surface, in the units of the theories.
#[derive(Debug, Clone, Copy)]
struct State {
    seed: u64,
    /// p̄/(E* h′).
    load: f64,
    /// A/A0.
    area: f64,
    /// ḡ/h_rms.
    gap: f64,
    /// K_i h_rms/(A0 p̄).
    stiffness: f64,
}

/// All states of all surfaces.
pub(crate) struct Study {
    nodes: usize,
    kernel: Periodic,
    surfaces: u64,
    loads: usize,
    /// Surface by surface, and load by load.
    states: Vec<State>,
    laws: AreaLoadLaw,
    seconds: f64,
    convolutions: f64,
}

impl Study {
    pub(crate) fn run(options: &Options) -> Result<Self, Failure> {
        if options.surfaces < 1 || options.loads < 2 {
            return Err(Failure::request("a study needs a surface and two loads"));
        }
        let failed = |error| Failure::new("the study of rough surfaces failed", error);
        let start = Instant::now();
        let grid = Grid::square(options.nodes, 1.0).map_err(failed)?;
        let bar = ProgressBar::new(options.surfaces * options.loads as u64);
        let (mut states, mut convolutions) = (Vec::new(), 0.0);
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
            for solution in solver.sweep(pressures) {
                let solution = solution.map_err(failed)?;
                let state = solution.state;
                let effort = solution.effort;
                convolutions += effort.convolutions as f64 + effort.coarse_convolutions;
                states.push(State {
                    seed,
                    load: state.load / rms_gradient,
                    area: state.contact_area_fraction,
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
            seconds: start.elapsed().as_secs_f64(),
            convolutions,
        })
    }

    /// The states of all surfaces under the same load.
    fn at(&self, load: usize) -> impl Iterator<Item = &State> {
        self.states.iter().skip(load).step_by(self.loads)
    }

    fn spread(&self, load: usize, value: fn(&State) -> f64) -> Spread {
        Spread::of(self.at(load).map(value))
    }

    /// A/A0 of Persson's theory.
    fn persson(&self, load: f64) -> f64 {
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
    fn exponential(&self) -> (Spread, f64) {
        let each = self.exponentials();
        let intercept = Spread::of(each.iter().map(|fit| fit.1)).mean;
        (Spread::of(each.iter().map(|fit| fit.0)), intercept)
    }

    /// κ of A/A0 = κ p̄/(E* h′) at light load: its mean over the loads with A/A0 below the limit.
    fn kappa(&self) -> Spread {
        Spread::of(self.states.chunks(self.loads).map(|states| {
            let light = states.iter().filter(|s| s.area <= LIGHT);
            Spread::of(light.map(|s| s.area / s.load)).mean
        }))
    }

    pub(crate) fn csv(&self) -> String {
        let mut text = "seed,mean_pressure_over_e_star_rms_gradient,contact_area_fraction,\
                        mean_gap_over_rms_height,interfacial_stiffness_rms_height_over_load\n"
            .to_string();
        for s in &self.states {
            let (load, area, gap, stiffness) = (s.load, s.area, s.gap, s.stiffness);
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{},{load:e},{area:e},{gap:e},{stiffness:e}", s.seed);
        }
        text
    }

    pub(crate) fn table(&self) -> String {
        let (gamma, _) = self.exponential();
        let mut text = String::new();
        let _ = writeln!(
            text,
            "{} self-affine surfaces of {n} × {n} nodes (H = {HURST}, roll-off at a quarter and short \
             cut-off at 1/32 of the side, {} cells), kernel {}; {} loads each; {:.0} convolutions and \
             {:.1} s in all.\n",
            self.surfaces,
            (CUTOFF * self.nodes as f64).round(),
            self.kernel.name(),
            self.loads,
            self.convolutions,
            self.seconds,
            n = self.nodes,
        );
        let _ = writeln!(
            text,
            "| p̄/(E\\* h′) | A/A₀ | Persson | κ = A E\\* h′/(A₀ p̄) | ḡ/h_rms | K_i h_rms/(A₀ p̄) |\n\
             |---|---|---|---|---|---|"
        );
        for load in (0..self.loads).step_by(self.loads.div_ceil(12)) {
            let Some(first) = self.at(load).next() else {
                break;
            };
            let _ = writeln!(
                text,
                "| {:.2e} | {} | {:.4} | {} | {} | {} |",
                first.load,
                self.spread(load, |s| s.area).decimals(4),
                self.persson(first.load),
                self.spread(load, |s| s.area / s.load).decimals(2),
                self.spread(load, |s| s.gap).decimals(3),
                self.spread(load, |s| s.stiffness).decimals(2),
            );
        }
        let _ = writeln!(
            text,
            "\nMean ± standard deviation of one surface. With A/A₀ below {LIGHT}, κ = {}; Persson √(8/π) = \
             {:.3}, Bush-Gibson-Thomas √(2π) = {:.3}. With p̄/(E\\* h′) from {} to {}, p̄ ∝ \
             exp(−ḡ/(γ h_rms)) fits with γ = {}, 1/γ = {:.2}.",
            self.kappa().decimals(2),
            AreaLoadLaw::PERSSON,
            AreaLoadLaw::BUSH_GIBSON_THOMAS,
            FIT.0,
            FIT.1,
            gamma.decimals(3),
            1.0 / gamma.mean,
        );
        text
    }

    /// The states of all surfaces as dots and their mean as a line.
    fn series(&self, x: fn(&State) -> f64, y: fn(&State) -> f64) -> [Series; 2] {
        let dots = self.states.iter().map(|s| (x(s), y(s)));
        let means = (0..self.loads).map(|i| (self.spread(i, x).mean, self.spread(i, y).mean));
        let name = format!("{} surfaces", self.surfaces);
        [
            Series::new(name, BLUE, Style::Dots, dots),
            Series::new("their mean", BLUE, Style::Line, means),
        ]
    }

    pub(crate) fn charts(&self) -> [Chart; 4] {
        let grid =
            || (0..=200).map(|i| LEAST_LOAD * (MOST_LOAD / LEAST_LOAD).powf(i as f64 / 200.0));
        let load = || {
            Axis::plain_logarithmic("mean pressure / (E* h′)", LEAST_LOAD, MOST_LOAD)
                .with_room(0.03, 0.03)
        };
        let with = |mut series: Vec<Series>, own: [Series; 2]| {
            series.extend(own);
            series
        };
        let bgt = AreaLoadLaw::BUSH_GIBSON_THOMAS;
        let (gamma, intercept) = self.exponential();
        let gap_range = (0.0, self.spread(0, |s| s.gap).mean * 1.1);
        let law = |gap: f64| (gap, (intercept - gap / gamma.mean).exp());
        [
            Chart {
                title: "Contact area".to_string(),
                x: load(),
                y: Axis::plain_logarithmic("A / A₀", 1e-3, 1.0).with_room(0.0, 0.04),
                series: with(
                    vec![
                        Series::new(
                            "Persson",
                            BLACK,
                            Style::Line,
                            grid().map(|p| (p, self.persson(p))),
                        ),
                        Series::new(
                            "Bush-Gibson-Thomas, κ = √(2π)",
                            ORANGE,
                            Style::Dashed,
                            grid().map(|p| (p, bgt * p)).filter(|(_, a)| *a <= 1.0),
                        ),
                    ],
                    self.series(|s| s.load, |s| s.area),
                ),
                legend: Corner::BottomRight,
            },
            Chart {
                title: "Area over load".to_string(),
                x: Axis::plain_logarithmic("A / A₀", 2e-3, 1.0),
                y: Axis::plain("κ = A E* h′ / load", 0.6, 3.4),
                series: with(
                    vec![
                        Series::new(
                            "Persson",
                            BLACK,
                            Style::Line,
                            grid().map(|p| (self.persson(p), self.persson(p) / p)),
                        ),
                        Series::new(
                            "Bush-Gibson-Thomas, √(2π)",
                            ORANGE,
                            Style::Dashed,
                            [(2e-3, bgt), (1.0, bgt)],
                        ),
                    ],
                    self.series(|s| s.area, |s| s.area / s.load),
                ),
                legend: Corner::BottomLeft,
            },
            Chart {
                title: "Mean gap".to_string(),
                x: Axis::plain("ḡ / h_rms", gap_range.0, gap_range.1),
                y: Axis::plain_logarithmic("mean pressure / (E* h′)", LEAST_LOAD, MOST_LOAD)
                    .with_room(0.05, 0.08),
                series: with(
                    vec![Series::new(
                        format!("exp(−ḡ/(γ h_rms)), γ = {:.2}", gamma.mean),
                        GREEN,
                        Style::Dashed,
                        (0..=200).map(|i| law(gap_range.1 * f64::from(i) / 200.0)),
                    )],
                    self.series(|s| s.gap, |s| s.load),
                ),
                legend: Corner::TopRight,
            },
            Chart {
                title: "Interfacial stiffness over load".to_string(),
                x: load(),
                y: Axis::plain("K_i h_rms / load", 0.0, 6.0),
                series: with(
                    vec![
                        Series::new(
                            format!("1/γ = {:.2}, fitted", 1.0 / gamma.mean),
                            GREEN,
                            Style::Dashed,
                            [(FIT.0, 1.0 / gamma.mean), (FIT.1, 1.0 / gamma.mean)],
                        ),
                        Series::new(
                            "1/γ = 2.08, Akarapu et al. (2011)",
                            GREY,
                            Style::Dashed,
                            [(LEAST_LOAD, 1.0 / 0.48), (MOST_LOAD, 1.0 / 0.48)],
                        ),
                    ],
                    self.series(|s| s.load, |s| s.stiffness),
                ),
                legend: Corner::BottomLeft,
            },
        ]
    }
}
