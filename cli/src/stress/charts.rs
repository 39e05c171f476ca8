//! `stress.png`: the greatest stresses over depth.

use std::path::{Path, PathBuf};

use asperity::stress::Measure;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, GREEN, ORANGE, Series, Style};
use asperity_cli::outcome::Failure;

use super::body::Body;

/// One chart for each body.
pub(super) fn draw(bodies: &[Body], name: &Path) -> Result<PathBuf, Failure> {
    let charts: Vec<Chart> = bodies.iter().map(of_body).collect();
    chart::draw(&charts, charts.len(), name)
}

fn of_body(body: &Body) -> Chart {
    let depths = &body.survey.depths;
    let deepest = depths.last().map_or(0.0, |depth| depth.depth);
    let greatest = body.survey.greatest(Measure::VonMises).value;
    let series = [
        (Measure::VonMises, "von Mises", BLUE),
        (Measure::GreatestShear, "greatest shear", ORANGE),
        (Measure::GreatestTension, "greatest tension", GREEN),
    ];
    let series = series.map(|(measure, name, colour)| {
        let points = depths.iter().map(|depth| (depth.depth, depth.greatest(measure).value));
        // A single depth has no line.
        let style = if depths.len() > 1 { Style::Line } else { Style::Dots };
        Series::new(name, colour, style, points.filter(|(_, value)| *value >= 0.0))
    });
    Chart {
        title: format!("greatest stresses in the {}", body.name),
        x: Axis::linear("depth", "m", 0.0, if deepest > 0.0 { deepest } else { 1.0 }),
        y: Axis::linear("stress", "Pa", 0.0, 1.08 * greatest),
        // Where all is pressed there is no tension.
        series: series.into_iter().filter(|series| !series.points.is_empty()).collect(),
        legend: Corner::TopRight,
    }
}
