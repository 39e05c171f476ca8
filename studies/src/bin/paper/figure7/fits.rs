//! The fits of Fig. 7.

use crate::fit::{Fit, Shape};
use crate::run::{GREATEST_LOAD, Run};
use crate::study::Family;
use asperity_studies::line::Line;
use asperity_studies::spread::Spread;

/// The fits of the paper: y₀, A, t; slope and intercept.
pub(crate) const PAPER_EXPONENTIAL: (f64, f64, f64) = (-2.56, 2.26, 0.0021);
pub(crate) const PAPER_LINE: (f64, f64) = (-8.93, -0.11);
/// Greatest loads of the exponential fit: the paper does not state its range, so that each is judged.
pub(crate) const LIGHT_LOADS: [f64; 3] = [2.5e-3, SMALL_LOAD, 1e-2];
/// Greatest load of the fits of K, about the greatest at which the paper's exponential, with t = 0.0021, has not yet
/// come to its end.
pub(crate) const SMALL_LOAD: f64 = 5e-3;
/// Least load of the fits of K.
pub(crate) const LEAST_LOAD: f64 = 1e-4;
/// Least load of the linear fit, which the paper does not state.
pub(crate) const LARGE_LOAD: f64 = 0.02;
/// The ordinate with which the paper's line fits: u over 20 Sq.
pub(crate) const LINE_UNIT: f64 = 20.0;
/// The part of the punch's stiffness from which on K counts as saturated.
pub(crate) const SATURATED: f64 = 0.95;
pub(super) const SAMPLES: usize = 300;

/// y₀, A, t and rms deviation of an exponential through u/Sq.
#[derive(Clone, Copy)]
pub(crate) struct Approach {
    pub(crate) offset: Spread,
    pub(crate) amplitude: Spread,
    pub(crate) scale: Spread,
    pub(crate) deviation: Spread,
    /// Rms deviation of y₀ + A W^α through the same points, and the range of u/Sq among them.
    pub(crate) of_power: Spread,
    pub(crate) range: Spread,
}

/// Intercept over slope of the paper's line: a load, whatever unit the approach has.
pub(crate) fn ratio_of_line() -> f64 {
    PAPER_LINE.1 / PAPER_LINE.0
}

/// The fits of one surface.
pub(crate) struct Fits {
    /// Up to each of [`LIGHT_LOADS`].
    pub(crate) light: [Approach; 3],
    /// Slope and intercept of u/Sq, and the intercept over the slope.
    pub(crate) line: [Spread; 2],
    pub(crate) offset: Spread,
    /// K Sq/A₀E* under the greatest load.
    pub(crate) stiffness: Spread,
    /// Approach / Sq under the greatest load.
    pub(crate) approach: Spread,
    /// Exponent of K ~ W^α between 10⁻⁴ and 10⁻³ A₀E*.
    pub(crate) exponent: Spread,
    /// Rms deviations of a growing and a saturating exponential and a power through K, two parameters each, over the
    /// rms K, from [`LEAST_LOAD`] to [`SMALL_LOAD`].
    pub(crate) growth: [Spread; 3],
    /// A/A₀ where K is 95 % of that of the punch.
    pub(crate) saturated_at: Spread,
}

/// (W, −δ/Sq) at evenly spaced loads up to `greatest`.
pub(super) fn light_loads(run: &Run, greatest: f64) -> Vec<(f64, f64)> {
    let points = run.evenly(0.0, greatest, SAMPLES);
    points.iter().map(|p| (p.load, -p.approach)).collect()
}

impl Approach {
    fn of(family: &Family, greatest: f64) -> Self {
        let (mut exponentials, mut powers, mut ranges) = (Vec::new(), Vec::new(), Vec::new());
        for run in &family.runs {
            let points = light_loads(run, greatest);
            exponentials.push(Fit::with_offset(&points, Shape::Decay));
            powers.push(Fit::with_offset(&points, Shape::Power));
            let ends = points.first().zip(points.last());
            ranges.extend(ends.map(|(a, b)| (a.1 - b.1).abs()));
        }
        let of = |value: fn(&Fit) -> f64| Spread::of(exponentials.iter().map(value));
        Self {
            offset: of(|f| f.offset),
            amplitude: of(|f| f.amplitude),
            scale: of(|f| f.parameter),
            deviation: of(|f| f.deviation),
            of_power: Spread::of(powers.iter().map(|f| f.deviation)),
            range: Spread::of(ranges),
        }
    }
}

/// What K may grow like, in the order of [`Fits::growth`].
pub(super) const GROWTHS: [Shape; 3] = [Shape::Growth, Shape::Saturation, Shape::Power];

/// Those of two parameters through K at light loads.
pub(super) fn growths(run: &Run) -> [Fit; 3] {
    let points = growth_loads(run);
    GROWTHS.map(|shape| Fit::through_zero(&points, shape))
}

/// (W, K Sq/A₀E*) at evenly spaced loads from [`LEAST_LOAD`] to [`SMALL_LOAD`].
pub(super) fn growth_loads(run: &Run) -> Vec<(f64, f64)> {
    let points = run.evenly(LEAST_LOAD, SMALL_LOAD, SAMPLES);
    points.iter().map(|p| (p.load, p.contact_stiffness)).collect()
}

/// Their rms deviations over the rms K.
fn growth(run: &Run) -> [f64; 3] {
    let points = growth_loads(run);
    let squares = points.iter().map(|(_, k)| k * k).sum::<f64>();
    let rms = (squares / points.len() as f64).sqrt();
    growths(run).map(|fit| fit.deviation / rms)
}

/// A/A₀ of the first state with 95 % of the stiffness of the punch.
fn saturated_at(run: &Run, punch: f64) -> Option<f64> {
    let mut points = run.points.iter();
    points.find(|p| p.contact_stiffness >= SATURATED * punch).map(|p| p.area)
}

/// The line through −δ/Sq at large loads.
pub(super) fn line(run: &Run) -> Line {
    let points = run.evenly(LARGE_LOAD, GREATEST_LOAD, SAMPLES);
    let points: Vec<_> = points.iter().map(|p| (p.load, -p.approach)).collect();
    Line::fit(&points)
}

/// The exponent of K ~ W^α at light loads.
fn exponent(run: &Run) -> Line {
    let loads = (0..=50).map(|k| 10_f64.powf(-4.0 + f64::from(k) / 50.0));
    let points: Vec<_> = loads
        .filter_map(|w| run.at_load(w))
        .map(|p| (p.load.ln(), p.contact_stiffness.ln()))
        .collect();
    Line::fit(&points)
}

impl Fits {
    pub(super) fn of(family: &Family, punch: f64) -> Self {
        let lines: Vec<Line> = family.runs.iter().map(line).collect();
        let growth: Vec<[f64; 3]> = family.runs.iter().map(growth).collect();
        let exponents = family.runs.iter().map(|run| exponent(run).slope);
        Self {
            light: LIGHT_LOADS.map(|load| Approach::of(family, load)),
            line: [
                Spread::of(lines.iter().map(|l| l.slope)),
                Spread::of(lines.iter().map(|l| l.intercept)),
            ],
            offset: Spread::of(lines.iter().map(|l| l.intercept / l.slope)),
            stiffness: family.at_end(|p| p.contact_stiffness),
            approach: family.at_end(|p| p.approach),
            exponent: Spread::of(exponents),
            growth: [0, 1, 2].map(|k| Spread::of(growth.iter().map(|found| found[k]))),
            saturated_at: family.spread(|run| saturated_at(run, punch)),
        }
    }
}
