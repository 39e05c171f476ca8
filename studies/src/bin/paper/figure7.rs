//! Fig. 7: approach and contact stiffness against load.

use std::error::Error;
use std::path::{Path, PathBuf};

use crate::exponential::Exponential;
use crate::run::{GREATEST_LOAD, Run};
use crate::study::{Family, Study};
use crate::table::write_csv;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLACK, Chart, Corner, GREY, Series, Style, colour};
use asperity_cli::outcome::Failure;
use asperity_studies::line::Line;
use asperity_studies::spread::Spread;

/// The fits of the paper: y₀, A, t; slope and intercept; saturated stiffness.
pub(crate) const PAPER_EXPONENTIAL: (f64, f64, f64) = (-2.56, 2.26, 0.0021);
pub(crate) const PAPER_LINE: (f64, f64) = (-8.93, -0.11);
pub(crate) const PAPER_STIFFNESS: f64 = 5.8e-3;
/// Greatest loads of the exponential fit, which the paper does not state; the middle one counts.
pub(crate) const SMALL_LOADS: [f64; 3] = [0.0025, 0.005, 0.01];
/// The one that is drawn.
pub(crate) const SMALL_FIT: f64 = SMALL_LOADS[1];
/// Least load of the linear fit, which the paper does not state.
pub(crate) const LARGE_LOAD: f64 = 0.02;
/// The ordinate with which the paper's line fits: u over 20 Sq.
pub(crate) const LINE_UNIT: f64 = 20.0;
const SAMPLES: usize = 300;

/// The fits of one surface.
pub(crate) struct Fits {
    /// y₀, A, t and rms deviation of the exponential fits, one for each of [`SMALL_LOADS`].
    pub(crate) exponentials: Vec<[Spread; 4]>,
    /// Slope and intercept of u/Sq.
    pub(crate) line: [Spread; 2],
    /// K Sq/A₀E* under the greatest load.
    pub(crate) stiffness: Spread,
    /// Approach / Sq under the greatest load.
    pub(crate) approach: Spread,
    /// Exponent of K ~ W^α between 10⁻⁴ and 10⁻³ A₀E*.
    pub(crate) exponent: Spread,
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
        fits.push(Fits::of(family).map_err(failed)?);
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
            let light = run.evenly(0.0, SMALL_FIT, SAMPLES);
            let light = light.iter().map(|p| (p.load, -p.approach));
            small.push(Series::new(name, colour, Style::Line, light));
            all.push(Series::new(name, colour, Style::Line, approach));
            let k = run.points.iter().map(|p| (p.load, p.contact_stiffness));
            stiffness.push(Series::new(name, colour, Style::Line, k.clone()));
            logarithmic.push(Series::new(name, colour, Style::Line, k));
        }
        if let Some(run) = family.runs.first() {
            let fit = exponential(run, SMALL_FIT).map_err(failed)?;
            let loads = (0..=100).map(|k| SMALL_FIT * f64::from(k) / 100.0);
            let curve = loads.map(|w| (w, fit.at(w)));
            small.push(Series::new("", BLACK, Style::Dashed, curve));
            let line = line(run);
            let ends = [0.0, GREATEST_LOAD].map(|w| (w, line.at(w)));
            all.push(Series::new("", BLACK, Style::Dashed, ends));
        }
    }
    let loads = (0..=100).map(|k| SMALL_FIT * f64::from(k) / 100.0);
    let (y0, a, t) = PAPER_EXPONENTIAL;
    let paper = loads.map(|w| (w, y0 + a * (-w / t).exp()));
    small.push(Series::new("the paper's fit", GREY, Style::Line, paper));
    let (slope, intercept) = PAPER_LINE;
    let paper = [0.0, GREATEST_LOAD].map(|w| (w, LINE_UNIT * (intercept + slope * w)));
    all.push(Series::new(
        "the paper's line × 20",
        GREY,
        Style::Line,
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
            x: Axis::plain("load W / A₀E*", 0.0, SMALL_FIT),
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

/// The exponential through −δ/Sq up to a load.
fn exponential(run: &Run, greatest: f64) -> Result<Exponential, Box<dyn Error>> {
    let points = run.evenly(0.0, greatest, SAMPLES);
    let points: Vec<_> = points.iter().map(|p| (p.load, -p.approach)).collect();
    Exponential::fit(&points, PAPER_EXPONENTIAL.2)
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
    fn of(family: &Family) -> Result<Self, Box<dyn Error>> {
        let each = |load| -> Result<[Spread; 4], Box<dyn Error>> {
            let fits = family.runs.iter().map(|run| exponential(run, load));
            let fits = fits.collect::<Result<Vec<_>, _>>()?;
            let of = |value: fn(&Exponential) -> f64| Spread::of(fits.iter().map(value));
            Ok([
                of(|f| f.offset),
                of(|f| f.amplitude),
                of(|f| f.scale),
                of(|f| f.deviation),
            ])
        };
        let lines: Vec<Line> = family.runs.iter().map(line).collect();
        let exponents = family.runs.iter().map(|run| exponent(run).slope);
        Ok(Self {
            exponentials: SMALL_LOADS
                .into_iter()
                .map(each)
                .collect::<Result<_, _>>()?,
            line: [
                Spread::of(lines.iter().map(|l| l.slope)),
                Spread::of(lines.iter().map(|l| l.intercept)),
            ],
            stiffness: family.at_end(|p| p.contact_stiffness),
            approach: family.at_end(|p| p.approach),
            exponent: Spread::of(exponents),
        })
    }
}
