//! Pictures of a measured surface.

use std::path::{Path, PathBuf};

use asperity::Grid;
use asperity::io::MeasuredSurface;
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
    levelled: Option<&Topography>,
    directory: &Path,
) -> Result<PathBuf, Failure> {
    let mut charts = vec![distribution(measured)];
    charts.extend(levelled.and_then(spectrum));
    let columns = charts.len();
    chart::draw(&charts, columns, &directory.join("surface_statistics.png"))
}

fn distribution(measured: &MeasuredSurface) -> Chart {
    let heights = measured.heights.iter().copied();
    let heights: Vec<f64> = heights.filter(|height| height.is_finite()).collect();
    let count = heights.len().max(1) as f64;
    let mean = heights.iter().sum::<f64>() / count;
    let sq = (heights.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / count).sqrt();
    let least = heights.iter().copied().fold(f64::INFINITY, f64::min) - mean;
    let greatest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max) - mean;
    let width = (greatest - least) / BINS as f64;
    let mut counts = vec![0.0; BINS];
    for height in &heights {
        let bin = ((height - mean - least) / width) as usize;
        counts[bin.min(BINS - 1)] += 1.0;
    }
    // In units of 1/Sq, so that a normal distribution is always the same curve.
    let density = |count: f64| count / count_times(heights.len(), width) * sq;
    let middle = |bin: usize| least + (bin as f64 + 0.5) * width;
    let bars = counts.iter().enumerate();
    let bars: Vec<(f64, f64)> = bars.map(|(bin, n)| (middle(bin), density(*n))).collect();
    let normal = bars.iter().map(|(z, _)| {
        let x = z / sq;
        (
            *z,
            (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt(),
        )
    });
    let highest = bars.iter().map(|(_, d)| *d).fold(0.4, f64::max);
    Chart {
        title: "distribution of heights".to_string(),
        x: Axis::linear("height above the mean", "m", least, greatest),
        y: Axis::plain("probability density × Sq", 0.0, 1.1 * highest),
        series: vec![
            Series::new("normal", GREY, Style::Dashed, normal.collect::<Vec<_>>()),
            Series::new("this surface", BLUE, Style::Line, bars.clone()),
        ],
        legend: Corner::TopLeft,
    }
}

/// Never zero.
fn count_times(count: usize, width: f64) -> f64 {
    let product = count as f64 * width;
    if product > 0.0 { product } else { 1.0 }
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
