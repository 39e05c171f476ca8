//! `conductance.png`: what the contact conducts against the mean pressure.

use std::path::{Path, PathBuf};

use asperity::LoadingState;
use asperity::joint::Carrier;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, Series, Style};
use asperity_cli::outcome::Failure;

use super::job::Job;
use crate::conduction::{Named, conductances};

/// Draws a chart of each conductance; nothing if none was asked for, or no state has one.
pub(super) fn draw(
    job: &Job,
    conductions: &[Named],
    states: &[LoadingState],
    directory: &Path,
) -> Option<Result<PathBuf, Failure>> {
    let charts: Vec<Chart> =
        conductions.iter().filter_map(|conduction| chart(job, conduction, states)).collect();
    let name = directory.join("conductance.png");
    (!charts.is_empty()).then(|| chart::draw(&charts, charts.len(), &name))
}

fn chart(job: &Job, conduction: &Named, states: &[LoadingState]) -> Option<Chart> {
    let area = job.grid().nominal_area();
    let of = |state: &LoadingState| {
        let found = conductances(&[*conduction], &state.contact, job.layering());
        let conductance = found.first().map_or(f64::NAN, |(_, conductance)| *conductance);
        (state.contact.mean_pressure(), conductance / area)
    };
    let points = states.iter().map(of);
    let points: Vec<(f64, f64)> =
        points.filter(|(p, h)| *p > 0.0 && *h > 0.0 && h.is_finite()).collect();
    let ends = |value: fn(&(f64, f64)) -> f64| {
        let least = points.iter().map(value).reduce(f64::min)?;
        Some((least, points.iter().map(value).fold(least, f64::max)))
    };
    let (from, to) = ends(|point| point.0)?;
    let (least, most) = ends(|point| point.1)?;
    // Whole decades, whose labels are short.
    let (least, most) = (decade(least, f64::floor), decade(most, f64::ceil));
    let (title, unit) = match conduction.1.carrier() {
        Carrier::Heat => ("conductance of heat per nominal area", "W/(m² K)"),
        Carrier::Current => ("conductance of current per nominal area", "S/m²"),
    };
    Some(Chart {
        title: title.to_string(),
        x: Axis::logarithmic("mean pressure", "Pa", from, to).with_room(0.0, 0.02),
        y: Axis::logarithmic("conductance", unit, least, most),
        series: vec![Series::new("", BLUE, Style::Line, points)],
        legend: Corner::TopLeft,
    })
}

/// A power of ten beside a number.
fn decade(value: f64, round: fn(f64) -> f64) -> f64 {
    10_f64.powi(round(value.log10()) as i32)
}
