//! Pictures of a measured surface.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use asperity::Grid;
use asperity::io::MeasuredSurface;
use asperity::patches::{Bins, Histogram};
use asperity::surface::{RadialBins, Topography, Window};
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, GREY, Series, Style};
use asperity_cli::field_map::{FieldMap, Scale};
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;

use super::summary::Summary;

/// Bins of the distribution of heights.
const BINS: usize = 80;

/// The heights as a map, missing nodes left white.
pub(super) fn map(
    measured: &MeasuredSurface,
    summary: &Summary,
    directory: &Path,
) -> Result<PathBuf, Failure> {
    let (nx, ny) = measured.heights.shape();
    let (grid, length_unit) = match measured.grid() {
        Ok(grid) => (grid, "m"),
        // Of unknown size: counted in cells.
        Err(_) => {
            let grid = Grid::new(nx, ny, 1.0, 1.0);
            (
                grid.map_err(|error| Failure::new("no map", error))?,
                "cells",
            )
        }
    };
    FieldMap {
        grid: &grid,
        length_unit,
        values: &measured.heights.map(|height| height - summary.mean),
        range: (summary.min - summary.mean, summary.max - summary.mean),
        scale: Scale::Linear,
        contours: &[],
        label: ("height above the mean", "m"),
    }
    .write(
        &directory.join("surface_map.png"),
        &format!("{nx} × {ny} nodes, Sq = {}", quantity(summary.sq, "m", 4)),
    )
}

/// The distribution of heights, and the power spectrum of the surface without its tilt.
pub(super) fn statistics(
    measured: &MeasuredSurface,
    summary: &Summary,
    levelled: Option<&Topography>,
    directory: &Path,
) -> Result<PathBuf, Failure> {
    let charts = [distribution(measured, summary), levelled.and_then(spectrum)];
    let charts: Vec<Chart> = charts.into_iter().flatten().collect();
    let columns = charts.len();
    if charts.is_empty() {
        return Err(Failure::request(
            "no statistics of a surface without relief",
        ));
    }
    chart::draw(&charts, columns, &directory.join("surface_statistics.png"))
}

/// The distribution of heights beside the normal one of the same Sq; `None` of heights that are all the same.
fn distribution(measured: &MeasuredSurface, summary: &Summary) -> Option<Chart> {
    let Summary { mean, sq, .. } = *summary;
    let present = measured.heights.iter().filter(|height| height.is_finite());
    let heights = present.map(|height| height - mean);
    let histogram = Histogram::new(heights, Bins::Linear(BINS)).ok()?;
    let middles = histogram.edges().windows(2);
    let middles = middles.map(|edges| 0.5 * (edges[0] + edges[1]));
    // In units of 1/Sq, so that a normal distribution is always the same curve.
    let densities = histogram.density().into_iter().map(|density| density * sq);
    let bars: Vec<(f64, f64)> = middles.zip(densities).collect();
    let normal = bars.iter().map(|(z, _)| {
        let x = z / sq;
        (*z, (-0.5 * x * x).exp() / (2.0 * PI).sqrt())
    });
    let normal: Vec<(f64, f64)> = normal.collect();
    let highest = bars.iter().map(|(_, density)| *density).fold(0.4, f64::max);
    Some(Chart {
        title: "distribution of heights".to_string(),
        x: Axis::linear(
            "height above the mean",
            "m",
            summary.min - mean,
            summary.max - mean,
        ),
        y: Axis::plain("probability density × Sq", 0.0, 1.1 * highest),
        series: vec![
            Series::new("normal", GREY, Style::Dashed, normal),
            Series::new("this surface", BLUE, Style::Line, bars),
        ],
        legend: Corner::TopLeft,
    })
}

/// The radial power spectrum, `None` without two waves to draw.
fn spectrum(levelled: &Topography) -> Option<Chart> {
    let windowed = levelled.window(Window::Hann).ok()?;
    let bins = windowed.radial_psd(&RadialBins::PerDecade(20)).ok()?;
    let points = bins.iter().map(|bin| (bin.wavevector, bin.density));
    let points: Vec<(f64, f64)> = points.filter(|(q, c)| *q > 0.0 && *c > 0.0).collect();
    let ends = |values: &dyn Fn(&(f64, f64)) -> f64| {
        let least = points.iter().map(values).reduce(f64::min)?;
        let greatest = points.iter().map(values).reduce(f64::max)?;
        Some((least, greatest))
    };
    let (first, last) = ends(&|(q, _)| *q)?;
    let (least, greatest) = ends(&|(_, c)| *c)?;
    Some(Chart {
        title: "radial power spectrum (tilt removed, Hann window)".to_string(),
        x: Axis::logarithmic("wavevector q = 2π/λ", "rad/m", first, last),
        y: Axis::logarithmic("C", "m⁴", least, greatest).with_room(0.04, 0.06),
        series: vec![Series::new("", BLUE, Style::Line, points)],
        legend: Corner::TopRight,
    })
}
