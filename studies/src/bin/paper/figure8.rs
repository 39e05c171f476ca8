//! Fig. 8: mean gap and interfacial stiffness against load.
//!
//! A gap that is linear in the logarithm of the load, ḡ = const − γ Sq ln W, has
//! γ = −dḡ/d(ln W)/Sq = W/(K_i Sq). With exact stiffnesses the law holds where γ is constant.

use std::path::{Path, PathBuf};

use crate::run::{GREATEST_LOAD, Run};
use crate::study::{Family, Study};
use crate::table::write_csv;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLACK, Chart, Corner, GREY, Series, Style, colour};
use asperity_cli::outcome::Failure;
use asperity_studies::line::Line;
use asperity_studies::spread::Spread;

/// The range in which the paper finds the gap logarithmic.
pub(crate) const PAPER_RANGE: (f64, f64) = (4e-3, 2e-2);
/// By which fraction γ may fall short of its greatest value and still count as constant.
pub(crate) const TOLERANCE: f64 = 0.1;
/// Loads a quarter of the lower and two and a half times the upper end: the law should not hold there.
pub(crate) const OUTSIDE: [f64; 2] = [1e-3, 5e-2];
/// Light, moderate and heavy loads, between which the growth of K_i is measured.
pub(crate) const GROWTH: [(f64, f64); 3] = [(1e-4, 1e-3), PAPER_RANGE, (3e-2, 1e-1)];
const LEAST: f64 = 1e-5;
const SAMPLES: usize = 400;

/// The gap of one surface.
pub(crate) struct Gap {
    /// γ by a line through ḡ/Sq against ln W in the paper's range, and its correlation.
    pub(crate) decay: Spread,
    pub(crate) pearson: Spread,
    /// Greatest γ on the mean curve, and the loads between which γ is within 10 % of it.
    pub(crate) greatest: f64,
    pub(crate) range: (f64, f64),
    /// γ at the ends of the paper's range, over γ of the line.
    pub(crate) ends: [Spread; 2],
    /// Greatest deviation of γ on the mean curve from γ of the line in the paper's range, as a fraction.
    pub(crate) inside: f64,
    /// γ on the mean curve at each of [`OUTSIDE`], over the greatest.
    pub(crate) outside: [f64; 2],
    /// Exponents of K_i ~ W^α over each of [`GROWTH`].
    pub(crate) exponents: [Spread; 3],
}

pub(crate) struct Figure8 {
    pub(crate) gaps: Vec<Gap>,
    pub(crate) picture: PathBuf,
}

pub(crate) fn make(study: &Study, directory: &Path) -> Result<Figure8, Failure> {
    let mut gaps = Vec::new();
    let mut rows = Vec::new();
    let (mut gap, mut decay, mut stiffness, mut growth) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (place, family) in study.families.iter().enumerate() {
        gaps.push(Gap::of(family));
        let colour = colour(place);
        for (index, run) in family.runs.iter().enumerate() {
            rows.extend(run.points.iter().map(|p| {
                let numbers =
                    [run.seed as f64, p.load, p.mean_gap, p.interfacial_stiffness, p.decay()];
                [vec![family.rough.name().to_string()], numbers.map(|n| n.to_string()).to_vec()]
                    .concat()
            }));
            let name = if index == 0 { family.rough.name() } else { "" };
            let line = |value: fn(&crate::run::Point) -> f64| {
                let points = run.points.iter().map(move |p| (p.load, value(p)));
                Series::new(name, colour, Style::Line, points)
            };
            gap.push(line(|p| p.mean_gap));
            decay.push(line(|p| p.decay()));
            stiffness.push(line(|p| p.interfacial_stiffness));
        }
        let name = format!("{}, mean", family.rough.name());
        growth.push(Series::new(name, colour, Style::Line, exponents(family)));
        if let Some(run) = family.runs.first() {
            let fit = logarithmic(run);
            let ends = [PAPER_RANGE.0 / 4.0, PAPER_RANGE.1 * 2.5];
            let ends = ends.map(|w| (w, fit.at(w.ln())));
            gap.push(Series::new("", BLACK, Style::Dashed, ends));
        }
    }
    // Many points: those outside the axes are left out.
    let upright =
        |load: f64| (0..=4000).map(move |k| (load, 10_f64.powf(f64::from(k) / 400.0 - 6.0)));
    let (from, to) = (upright(PAPER_RANGE.0), upright(PAPER_RANGE.1));
    for charts in [&mut gap, &mut decay, &mut stiffness, &mut growth] {
        let name = "the paper's range";
        charts.push(Series::new(name, GREY, Style::Dashed, from.clone()));
        charts.push(Series::new("", GREY, Style::Dashed, to.clone()));
    }
    let ends = [(LEAST, 1.0), (GREATEST_LOAD, 1.0)];
    growth.push(Series::new("1: growth at a constant rate", BLACK, Style::Dashed, ends));
    write_csv(
        &directory.join("figure8.csv"),
        &[
            "surface",
            "seed",
            "load",
            "mean_gap_over_sq",
            "interfacial_stiffness",
            "decay_length_over_sq",
        ],
        rows.into_iter(),
    )?;
    let load = || Axis::plain_logarithmic("load W / A₀E*", LEAST, GREATEST_LOAD);
    let highest = gap.iter().flat_map(|s| &s.points).map(|p| p.1);
    let highest = highest.filter(|g| *g < 100.0).fold(0.0, f64::max);
    let charts = [
        Chart {
            title: "Mean gap, with the line of the paper's range".to_string(),
            x: load(),
            y: Axis::plain("mean gap ḡ / Sq", 0.0, highest.min(4.0)),
            series: gap,
            legend: Corner::BottomLeft,
        },
        Chart {
            title: "Exact slope: constant where ḡ is logarithmic".to_string(),
            x: load(),
            y: Axis::plain("γ = −dḡ/d(ln W) / Sq", 0.0, 1.1),
            series: decay,
            legend: Corner::TopLeft,
        },
        Chart {
            title: "Interfacial stiffness".to_string(),
            x: load(),
            y: Axis::plain_logarithmic("Kᵢ Sq / A₀E*", 1e-5, 10.0),
            series: stiffness,
            legend: Corner::TopLeft,
        },
        Chart {
            title: "Growth of the interfacial stiffness".to_string(),
            x: load(),
            y: Axis::plain("α = d(ln Kᵢ)/d(ln W)", 0.0, 4.0),
            series: growth,
            legend: Corner::TopLeft,
        },
    ];
    let picture = chart::draw(&charts, 2, &directory.join("figure8.png"))?;
    Ok(Figure8 { gaps, picture })
}

/// The line through ḡ/Sq against ln W in the paper's range, evenly in the logarithm.
fn logarithmic(run: &Run) -> Line {
    let (from, to) = PAPER_RANGE;
    let loads = (0..=SAMPLES).map(|k| from * (to / from).powf(k as f64 / SAMPLES as f64));
    let points: Vec<_> =
        loads.filter_map(|w| run.at_load(w)).map(|p| (p.load.ln(), p.mean_gap)).collect();
    Line::fit(&points)
}

/// The exponent of K_i ~ W^α around each load, over half a decade, the mean over the seeds.
fn exponents(family: &Family) -> Vec<(f64, f64)> {
    let half = 10_f64.powf(0.25);
    let loads = (0..=SAMPLES).map(|k| {
        let (from, to) = (LEAST * half, GREATEST_LOAD / half);
        from * (to / from).powf(k as f64 / SAMPLES as f64)
    });
    loads
        .map(|load| (load, exponent(family, (load / half, (load * half).min(GREATEST_LOAD))).mean))
        .filter(|(_, exponent)| exponent.is_finite())
        .collect()
}

/// The exponent of K_i ~ W^α between two loads.
fn exponent(family: &Family, (from, to): (f64, f64)) -> Spread {
    family.spread(|run| {
        // The greatest load is met to rounding.
        let last = run.last()?.load;
        let (a, b) = (run.at_load(from)?, run.at_load(to.min(last))?);
        Some((b.interfacial_stiffness / a.interfacial_stiffness).ln() / (to / from).ln())
    })
}

impl Gap {
    fn of(family: &Family) -> Self {
        let lines: Vec<Line> = family.runs.iter().map(logarithmic).collect();
        let mean = |load: f64| family.spread(|run| run.at_load(load).map(|p| p.decay())).mean;
        let curve: Vec<(f64, f64)> = (0..=SAMPLES)
            .map(|k| LEAST * (GREATEST_LOAD / LEAST).powf(k as f64 / SAMPLES as f64))
            .map(|load| (load, mean(load)))
            .collect();
        let greatest = curve.iter().map(|(_, g)| *g).fold(0.0, f64::max);
        let flat = || curve.iter().filter(|(_, g)| *g >= (1.0 - TOLERANCE) * greatest);
        let loads = flat().map(|(load, _)| *load);
        let range = (loads.clone().fold(f64::INFINITY, f64::min), loads.fold(0.0, f64::max));
        let end = |load: f64| {
            let runs = family.runs.iter().zip(&lines);
            Spread::of(
                runs.filter_map(|(run, line)| Some(run.at_load(load)?.decay() / -line.slope)),
            )
        };
        let decay = Spread::of(lines.iter().map(|l| -l.slope));
        let (from, to) = PAPER_RANGE;
        let inside = (0..=SAMPLES).map(|k| from * (to / from).powf(k as f64 / SAMPLES as f64));
        let inside = inside.map(|load| (mean(load) / decay.mean - 1.0).abs());
        Self {
            inside: inside.fold(0.0, f64::max),
            outside: OUTSIDE.map(|load| mean(load) / greatest),
            exponents: GROWTH.map(|range| exponent(family, range)),
            decay,
            pearson: Spread::of(lines.iter().map(|l| l.pearson)),
            greatest,
            range,
            ends: [end(PAPER_RANGE.0), end(PAPER_RANGE.1)],
        }
    }
}
