//! Fig. 7: approach and contact stiffness against load.

mod fits;

use std::path::{Path, PathBuf};

use crate::fit::{Fit, Shape};
use crate::run::GREATEST_LOAD;
use crate::study::Study;
use crate::table::write_csv;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{
    self, BLACK, BLUE, Chart, Corner, GREEN, GREY, ORANGE, PURPLE, Series, Style, colour,
};
use asperity_cli::outcome::Failure;

pub(crate) use fits::{
    Fits, LARGE_LOAD, LEAST_LOAD, LIGHT_LOADS, LINE_UNIT, PAPER_EXPONENTIAL, PAPER_LINE, SATURATED,
    SMALL_LOAD, ratio_of_line,
};
use fits::{SAMPLES, growth_loads, growths, light_loads, line};

pub(crate) struct Figure7 {
    pub(crate) fits: Vec<Fits>,
    pub(crate) picture: PathBuf,
}

pub(crate) fn make(study: &Study, directory: &Path) -> Result<Figure7, Failure> {
    let mut fits = Vec::new();
    let mut rows = Vec::new();
    let (mut small, mut all, mut rest) = (Vec::new(), Vec::new(), Vec::new());
    let (mut stiffness, mut logarithmic) = (Vec::new(), Vec::new());
    // The approach without that of the punch under the same load.
    let less = |(load, approach): (f64, f64)| (load, approach + load / study.punch);
    for (place, family) in study.families.iter().enumerate() {
        fits.push(Fits::of(family, study.punch));
        let colour = colour(place);
        for (index, run) in family.runs.iter().enumerate() {
            rows.extend(run.points.iter().map(|p| {
                let numbers = [run.seed as f64, p.load, -p.approach, p.contact_stiffness];
                [vec![family.rough.name().to_string()], numbers.map(|n| n.to_string()).to_vec()]
                    .concat()
            }));
            let name = if index == 0 { family.rough.name() } else { "" };
            let approach = run.points.iter().map(|p| (p.load, -p.approach));
            let light = run.evenly(0.0, SMALL_LOAD, SAMPLES);
            let light = light.iter().map(|p| (p.load, -p.approach));
            small.push(Series::new(name, colour, Style::Line, light));
            all.push(Series::new(name, colour, Style::Line, approach.clone()));
            rest.push(Series::new(name, colour, Style::Line, approach.map(less)));
            let k = run.points.iter().map(|p| (p.load, p.contact_stiffness));
            stiffness.push(Series::new(name, colour, Style::Line, k.clone()));
            logarithmic.push(Series::new(name, colour, Style::Line, k));
        }
        if let Some(run) = family.runs.first() {
            let points = light_loads(run, SMALL_LOAD);
            let fit = Fit::with_offset(&points, Shape::Decay);
            let curve = small_loads().map(|w| (w, fit.at(w)));
            small.push(Series::new("", BLACK, Style::Dashed, curve));
            let line = line(run);
            let ends = [0.0, GREATEST_LOAD].map(|w| (w, line.at(w)));
            all.push(Series::new("", BLACK, Style::Dashed, ends));
            rest.push(Series::new("", BLACK, Style::Dashed, ends.map(less)));
        }
    }
    let (y0, a, t) = PAPER_EXPONENTIAL;
    let paper = small_loads().map(|w| (w, y0 + a * (-w / t).exp()));
    small.push(Series::new("the paper's fit", PURPLE, Style::Line, paper));
    let (slope, intercept) = PAPER_LINE;
    let paper = [0.0, GREATEST_LOAD].map(|w| (w, LINE_UNIT * (intercept + slope * w)));
    all.push(Series::new("the paper's line × 20", PURPLE, Style::Dashed, paper));
    rest.push(Series::new("the paper's line × 20", PURPLE, Style::Dashed, paper.map(less)));
    let punch = [(0.0, study.punch), (GREATEST_LOAD, study.punch)];
    stiffness.push(Series::new("rigid square punch", GREY, Style::Dashed, punch));
    let punch = [(1e-6, study.punch), (GREATEST_LOAD, study.punch)];
    logarithmic.push(Series::new("rigid square punch", GREY, Style::Dashed, punch));
    write_csv(
        &directory.join("figure7.csv"),
        &["surface", "seed", "load", "approach_over_sq", "contact_stiffness"],
        rows.into_iter(),
    )?;
    let lowest = all.iter().flat_map(|s| &s.points).map(|p| p.1).fold(0.0, f64::min);
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
            title: "All loads, less the approach of the punch".to_string(),
            x: Axis::plain("load W / A₀E*", 0.0, GREATEST_LOAD),
            y: Axis::plain("u / Sq + W / K of the punch", -4.0, 0.0),
            series: rest,
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
        growth_chart(study),
    ];
    let picture = chart::draw(&charts, 2, &directory.join("figure7.png"))?;
    Ok(Figure7 { fits, picture })
}

/// Loads at which curves of the first chart are drawn.
fn small_loads() -> impl Iterator<Item = f64> {
    (0..=100).map(|k| SMALL_LOAD * f64::from(k) / 100.0)
}

/// K at light loads with what it may grow like, the first run.
fn growth_chart(study: &Study) -> Chart {
    let mut series = Vec::new();
    let mut title = "Growth of K at light loads".to_string();
    let first = study.families.first();
    if let Some((family, run)) = first.and_then(|family| Some((family, family.runs.first()?))) {
        title = format!("{title}: {}, seed {}", family.rough.name(), run.seed);
        let points = growth_loads(run);
        let every = points.iter().step_by(10).copied();
        series.push(Series::new("computed", BLUE, Style::Dots, every));
        let names = ["c exp(W/t)", "c (1 − exp(−W/t))", "c W^α"];
        let fits = growths(run).into_iter().zip(names);
        for ((fit, name), colour) in fits.zip([ORANGE, GREEN, BLACK]) {
            let curve = points.iter().map(|(load, _)| (*load, fit.at(*load)));
            series.push(Series::new(name, colour, Style::Line, curve));
        }
    }
    Chart {
        title,
        x: Axis::plain("load W / A₀E*", 0.0, SMALL_LOAD),
        y: Axis::plain("K Sq / A₀E*", 0.0, 0.005),
        series,
        legend: Corner::BottomRight,
    }
}
