//! Fig. 7: approach and contact stiffness against load.

use std::error::Error;
use std::path::{Path, PathBuf};

use crate::fit::{Fit, Shape};
use crate::run::{GREATEST_LOAD, Run};
use crate::study::{Family, Study};
use crate::table::write_csv;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLACK, Chart, Corner, GREY, PURPLE, Series, Style, colour};
use asperity_cli::outcome::Failure;
use asperity_studies::line::Line;
use asperity_studies::spread::Spread;

/// The fits of the paper: y₀, A, t; slope and intercept; saturated stiffness.
pub(crate) const PAPER_EXPONENTIAL: (f64, f64, f64) = (-2.56, 2.26, 0.0021);
pub(crate) const PAPER_LINE: (f64, f64) = (-8.93, -0.11);
pub(crate) const PAPER_STIFFNESS: f64 = 5.8e-3;
/// Greatest load of the exponential fit, about the greatest at which the paper's own, with t = 0.0021, has
/// not yet come to its end. The fit up to there is judged.
pub(crate) const SMALL_LOAD: f64 = 5e-3;
/// Others, for information: the paper does not state its range.
pub(crate) const OTHER_LOADS: [f64; 2] = [2.5e-3, 1e-2];
/// Least load of the fits of K.
pub(crate) const LEAST_LOAD: f64 = 1e-4;
/// Least load of the linear fit, which the paper does not state.
pub(crate) const LARGE_LOAD: f64 = 0.02;
/// The ordinate with which the paper's line fits: u over 20 Sq.
pub(crate) const LINE_UNIT: f64 = 20.0;
/// The part of the punch's stiffness from which on K counts as saturated.
pub(crate) const SATURATED: f64 = 0.95;
const SAMPLES: usize = 300;

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
    /// Up to [`SMALL_LOAD`].
    pub(crate) small: Approach,
    /// Up to each of [`OTHER_LOADS`].
    pub(crate) others: [Approach; 2],
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

pub(crate) struct Figure7 {
    pub(crate) fits: Vec<Fits>,
    pub(crate) picture: PathBuf,
}

pub(crate) fn make(study: &Study, directory: &Path) -> Result<Figure7, Failure> {
    let failed = |error: Box<dyn Error>| Failure::new("the fits of Fig. 7", error);
    let mut fits = Vec::new();
    let mut rows = Vec::new();
    let (mut small, mut all, mut stiffness, mut logarithmic) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (place, family) in study.families.iter().enumerate() {
        fits.push(Fits::of(family, study.punch).map_err(failed)?);
        let colour = colour(place);
        for (index, run) in family.runs.iter().enumerate() {
            rows.extend(run.points.iter().map(|p| {
                let numbers = [run.seed as f64, p.load, -p.approach, p.contact_stiffness];
                [
                    vec![family.rough.name().to_string()],
                    numbers.map(|n| n.to_string()).to_vec(),
                ]
                .concat()
            }));
            let name = if index == 0 { family.rough.name() } else { "" };
            let approach = run.points.iter().map(|p| (p.load, -p.approach));
            let light = run.evenly(0.0, SMALL_LOAD, SAMPLES);
            let light = light.iter().map(|p| (p.load, -p.approach));
            small.push(Series::new(name, colour, Style::Line, light));
            all.push(Series::new(name, colour, Style::Line, approach));
            let k = run.points.iter().map(|p| (p.load, p.contact_stiffness));
            stiffness.push(Series::new(name, colour, Style::Line, k.clone()));
            logarithmic.push(Series::new(name, colour, Style::Line, k));
        }
        if let Some(run) = family.runs.first() {
            let points = light_loads(run, SMALL_LOAD);
            let fit = Fit::with_offset(&points, Shape::Decay).map_err(failed)?;
            let curve = small_loads().map(|w| (w, fit.at(w)));
            small.push(Series::new("", BLACK, Style::Dashed, curve));
            let line = line(run);
            let ends = [0.0, GREATEST_LOAD].map(|w| (w, line.at(w)));
            all.push(Series::new("", BLACK, Style::Dashed, ends));
        }
    }
    let (y0, a, t) = PAPER_EXPONENTIAL;
    let paper = small_loads().map(|w| (w, y0 + a * (-w / t).exp()));
    small.push(Series::new("the paper's fit", PURPLE, Style::Line, paper));
    let (slope, intercept) = PAPER_LINE;
    let paper = [0.0, GREATEST_LOAD].map(|w| (w, LINE_UNIT * (intercept + slope * w)));
    all.push(Series::new(
        "the paper's line × 20",
        PURPLE,
        Style::Dashed,
        paper,
    ));
    let punch = [(0.0, study.punch), (GREATEST_LOAD, study.punch)];
    stiffness.push(Series::new(
        "rigid square punch",
        GREY,
        Style::Dashed,
        punch,
    ));
    let punch = [(1e-6, study.punch), (GREATEST_LOAD, study.punch)];
    logarithmic.push(Series::new(
        "rigid square punch",
        GREY,
        Style::Dashed,
        punch,
    ));
    write_csv(
        &directory.join("figure7.csv"),
        &[
            "surface",
            "seed",
            "load",
            "approach_over_sq",
            "contact_stiffness",
        ],
        rows.into_iter(),
    )?;
    let lowest = all
        .iter()
        .flat_map(|s| &s.points)
        .map(|p| p.1)
        .fold(0.0, f64::min);
    let charts = [
        Chart {
            title: "Small loads, exponential fits (dashed)".to_string(),
            x: Axis::plain("load W / A₀E*", 0.0, SMALL_LOAD),
            y: Axis::plain("normal approach u / Sq", -4.0, 0.0),
            series: small,
            legend: Corner::TopRight,
        },
        Chart {
            title: "All loads, linear fits (dashed)".to_string(),
            x: Axis::plain("load W / A₀E*", 0.0, GREATEST_LOAD),
            y: Axis::plain("normal approach u / Sq", 1.05 * lowest, 0.0),
            series: all,
            legend: Corner::TopRight,
        },
        Chart {
            title: "Contact stiffness".to_string(),
            x: Axis::plain("load W / A₀E*", 0.0, GREATEST_LOAD),
            y: Axis::plain("K Sq / A₀E*", 0.0, 1.1 * study.punch),
            series: stiffness,
            legend: Corner::BottomRight,
        },
        Chart {
            title: "Contact stiffness, from the lightest loads".to_string(),
            x: Axis::plain_logarithmic("load W / A₀E*", 1e-6, GREATEST_LOAD),
            y: Axis::plain_logarithmic("K Sq / A₀E*", 3e-5, 1e-2),
            series: logarithmic,
            legend: Corner::BottomRight,
        },
    ];
    let picture = chart::draw(&charts, 2, &directory.join("figure7.png"))?;
    Ok(Figure7 { fits, picture })
}

/// Loads at which curves of the first chart are drawn.
fn small_loads() -> impl Iterator<Item = f64> {
    (0..=100).map(|k| SMALL_LOAD * f64::from(k) / 100.0)
}

/// (W, −δ/Sq) at evenly spaced loads up to `greatest`.
fn light_loads(run: &Run, greatest: f64) -> Vec<(f64, f64)> {
    let points = run.evenly(0.0, greatest, SAMPLES);
    points.iter().map(|p| (p.load, -p.approach)).collect()
}

impl Approach {
    fn of(family: &Family, greatest: f64) -> Result<Self, Box<dyn Error>> {
        let (mut exponentials, mut powers, mut ranges) = (Vec::new(), Vec::new(), Vec::new());
        for run in &family.runs {
            let points = light_loads(run, greatest);
            exponentials.push(Fit::with_offset(&points, Shape::Decay)?);
            powers.push(Fit::with_offset(&points, Shape::Power)?);
            let ends = points.first().zip(points.last());
            ranges.extend(ends.map(|(a, b)| (a.1 - b.1).abs()));
        }
        let of = |value: fn(&Fit) -> f64| Spread::of(exponentials.iter().map(value));
        Ok(Self {
            offset: of(|f| f.offset),
            amplitude: of(|f| f.amplitude),
            scale: of(|f| f.parameter),
            deviation: of(|f| f.deviation),
            of_power: Spread::of(powers.iter().map(|f| f.deviation)),
            range: Spread::of(ranges),
        })
    }
}

/// Relative rms deviations of the three shapes through K.
fn growth(run: &Run) -> Result<[f64; 3], Box<dyn Error>> {
    let points = run.evenly(LEAST_LOAD, SMALL_LOAD, SAMPLES);
    let points: Vec<_> = points
        .iter()
        .map(|p| (p.load, p.contact_stiffness))
        .collect();
    let squares = points.iter().map(|(_, k)| k * k).sum::<f64>();
    let rms = (squares / points.len() as f64).sqrt();
    let relative = |shape| -> Result<f64, Box<dyn Error>> {
        Ok(Fit::through_zero(&points, shape)?.deviation / rms)
    };
    Ok([
        relative(Shape::Growth)?,
        relative(Shape::Saturation)?,
        relative(Shape::Power)?,
    ])
}

/// A/A₀ of the first state with 95 % of the stiffness of the punch.
fn saturated_at(run: &Run, punch: f64) -> Option<f64> {
    let mut points = run.points.iter();
    points
        .find(|p| p.contact_stiffness >= SATURATED * punch)
        .map(|p| p.area)
}

/// The line through −δ/Sq at large loads.
fn line(run: &Run) -> Line {
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
    fn of(family: &Family, punch: f64) -> Result<Self, Box<dyn Error>> {
        let lines: Vec<Line> = family.runs.iter().map(line).collect();
        let growth: Vec<[f64; 3]> = family.runs.iter().map(growth).collect::<Result<_, _>>()?;
        let exponents = family.runs.iter().map(|run| exponent(run).slope);
        let [lighter, heavier] = OTHER_LOADS.map(|load| Approach::of(family, load));
        Ok(Self {
            small: Approach::of(family, SMALL_LOAD)?,
            others: [lighter?, heavier?],
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
        })
    }
}
