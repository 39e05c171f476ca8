//! Fig. 5: area against load, and how straight the line is below 30 % contact.

use std::path::{Path, PathBuf};

use crate::run::{GREATEST_LOAD, Run};
use crate::study::{Family, Study};
use crate::surfaces::PAPER_GRADIENT;
use crate::table::write_csv;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLACK, Chart, Corner, PURPLE, Series, Style, colour};
use asperity_cli::outcome::Failure;
use asperity_studies::line::Line;
use asperity_studies::spread::Spread;

/// Up to where the paper fits a line.
pub(crate) const STRAIGHT: f64 = 0.3;
/// The paper's state under its greatest load, A/A₀ from its k = 1.0 and its gradient.
pub(crate) const PAPER_END: (f64, f64) = (GREATEST_LOAD, GREATEST_LOAD / PAPER_GRADIENT);
/// Evenly spaced loads of the fit.
const SAMPLES: usize = 300;

/// The fit of one surface.
pub(crate) struct Straight {
    pub(crate) pearson: Spread,
    /// A / A₀ per W / A₀E*: of the line, and in the lower and the upper half of the loads beyond 30 %.
    pub(crate) slopes: [Spread; 3],
    /// Runs in which each of these is less than the one before.
    pub(crate) falling: usize,
    /// A / A₀ under the greatest load.
    pub(crate) end: Spread,
}

pub(crate) struct Figure5 {
    pub(crate) fits: Vec<Straight>,
    pub(crate) picture: PathBuf,
}

pub(crate) fn make(study: &Study, directory: &Path) -> Result<Figure5, Failure> {
    let mut fits = Vec::new();
    let mut rows = Vec::new();
    let mut whole = Vec::new();
    let mut below = Vec::new();
    let mut lines_drawn = Vec::new();
    for (place, family) in study.families.iter().enumerate() {
        let colour = colour(place);
        let mut lines = Vec::new();
        for (index, run) in family.runs.iter().enumerate() {
            let points = straight(run);
            let line = Line::fit(&points);
            lines.push(line);
            rows.extend(run.points.iter().map(|p| {
                let numbers = [run.seed as f64, p.load, p.area, p.corrected];
                [vec![family.rough.name().to_string()], numbers.map(|n| n.to_string()).to_vec()]
                    .concat()
            }));
            let name = if index == 0 { family.rough.name() } else { "" };
            let all = run.points.iter().map(|p| (p.load, p.area));
            whole.push(Series::new(name, colour, Style::Line, all));
            below.push(Series::new(name, colour, Style::Line, points.clone()));
            if index == 0 {
                let ends = points.first().into_iter().chain(points.last());
                let fitted = ends.map(|(x, _)| (*x, line.at(*x)));
                let name = if place == 0 { "lines of seed 1" } else { "" };
                lines_drawn.push(Series::new(name, BLACK, Style::Dashed, fitted));
            }
        }
        let slopes = slopes(family, &lines);
        fits.push(Straight {
            pearson: Spread::of(lines.iter().map(|line| line.pearson)),
            slopes: [0, 1, 2].map(|k| Spread::of(slopes.iter().map(|found| found[k]))),
            falling: slopes.iter().filter(|s| s[0] > s[1] && s[1] > s[2]).count(),
            end: family.at_end(|p| p.area),
        });
    }
    below.extend(lines_drawn);
    whole.push(Series::new("the paper's end", PURPLE, Style::Dots, [PAPER_END]));
    write_csv(
        &directory.join("figure5.csv"),
        &["surface", "seed", "load", "area", "corrected_area"],
        rows.into_iter(),
    )?;
    let greatest = |series: &[Series]| {
        let loads = series.iter().flat_map(|s| &s.points).map(|p| p.0);
        loads.fold(0.0, f64::max)
    };
    let charts = [
        Chart {
            title: "Real contact area, all loads".to_string(),
            x: Axis::plain("load W / A₀E*", 0.0, 1.05 * greatest(&whole)),
            y: Axis::plain("contact area A / A₀", 0.0, 1.0),
            series: whole,
            legend: Corner::TopLeft,
        },
        Chart {
            title: "Below 30 % contact, with fitted lines".to_string(),
            x: Axis::plain("load W / A₀E*", 0.0, greatest(&below)),
            y: Axis::plain("contact area A / A₀", 0.0, 1.1 * STRAIGHT),
            series: below,
            legend: Corner::BottomRight,
        },
    ];
    let picture = chart::draw(&charts, 2, &directory.join("figure5.png"))?;
    Ok(Figure5 { fits, picture })
}

/// Slopes of every run that goes beyond 30 % contact: of its line, and of lines through the lower and the upper
/// half of the loads beyond.
fn slopes(family: &Family, lines: &[Line]) -> Vec<[f64; 3]> {
    let runs = family.runs.iter().zip(lines);
    runs.filter_map(|(run, line)| {
        let from = run.at_area(STRAIGHT)?.load;
        let to = run.last()?.load;
        let middle = 0.5 * (from + to);
        let slope = |from, to| {
            let points = run.evenly(from, to, SAMPLES);
            let points: Vec<_> = points.iter().map(|p| (p.load, p.area)).collect();
            Line::fit(&points).slope
        };
        Some([line.slope, slope(from, middle), slope(middle, to)])
    })
    .collect()
}

/// (load, area) at evenly spaced loads up to 30 % contact.
fn straight(run: &Run) -> Vec<(f64, f64)> {
    let end = run.at_area(STRAIGHT).or(run.last().copied());
    let greatest = end.map_or(0.0, |point| point.load);
    let points = run.evenly(0.0, greatest, SAMPLES);
    points.iter().map(|p| (p.load, p.area)).collect()
}
