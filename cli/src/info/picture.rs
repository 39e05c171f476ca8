//! Pictures of a measured surface.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use asperity::patches::{Bins, Histogram};
use asperity::surface::{RadialBins, Topography, Trend, Window};
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, GREY, Series, Style};
use asperity_cli::field_map::{FieldMap, Scale};
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;

use super::summary::Whole;

/// Bins of the distribution of heights.
const BINS: usize = 80;

/// The heights as a map, the highest bright, missing nodes left white.
pub(super) fn map(whole: &Whole, directory: &Path) -> Result<PathBuf, Failure> {
    let (grid, heights) = (whole.surface.grid(), whole.surface.map());
    let (nx, ny) = grid.shape();
    let mean = whole.mean();
    FieldMap {
        grid,
        // Of unknown size: counted in cells.
        length_unit: if whole.has_size { "m" } else { "cells" },
        values: &whole.shown.add_scalar(-mean),
        range: (heights.min_height() - mean, heights.max_height() - mean),
        scale: Scale::Relief,
        contours: &[],
        label: ("height above the mean", "m"),
    }
    .write(
        &directory.join("surface_map.png"),
        &format!("{nx} × {ny} nodes, Sq = {}", quantity(heights.rms_height(), "m", 4)),
    )
}

/// The distribution of heights, and the power spectrum of the surface without its tilt; nothing of heights that are all the
/// same.
pub(super) fn statistics(whole: &Whole, directory: &Path) -> Result<Option<PathBuf>, Failure> {
    let levelled = whole.filled_flat.level(Trend::Plane).ok();
    let levelled = levelled.filter(|_| whole.has_size);
    let charts = [distribution(whole), levelled.as_ref().and_then(spectrum)];
    let charts: Vec<Chart> = charts.into_iter().flatten().collect();
    let columns = charts.len();
    if charts.is_empty() {
        return Ok(None);
    }
    chart::draw(&charts, columns, &directory.join("surface_statistics.png")).map(Some)
}

/// The distribution of heights beside the normal one of the same Sq; `None` of heights that are all the same.
fn distribution(whole: &Whole) -> Option<Chart> {
    let map = whole.surface.map();
    let (mean, sq) = (map.mean_height(), map.rms_height());
    if map.peak_to_valley() == 0.0 {
        return None;
    }
    let heights = map.matrix().iter().map(|height| height - mean);
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
            map.min_height() - mean,
            map.max_height() - mean,
        ),
        y: Axis::plain("probability density × Sq", 0.0, 1.1 * highest),
        series: vec![
            Series::new("normal", GREY, Style::Dashed, normal),
            Series::new("this surface", BLUE, Style::Line, bars),
        ],
        legend: Corner::TopLeft,
    })
}

/// The power spectrum, of a map the radial one, `None` without two waves to draw.
fn spectrum(levelled: &Topography) -> Option<Chart> {
    let windowed = levelled.window(Window::Hann).ok()?;
    // That of a profile does not depend on how wide its cells are said to be.
    let (lx, ly) = windowed.grid().sides();
    let (name, unit, across) = match windowed.grid().shape() {
        (_, 1) => ("power spectrum", "m³", ly),
        (1, _) => ("power spectrum", "m³", lx),
        _ => ("radial power spectrum", "m⁴", 1.0),
    };
    let bins = windowed.radial_psd(&RadialBins::PerDecade(20)).ok()?;
    let points = bins.iter().map(|bin| (bin.wavevector, bin.density / across));
    let points: Vec<(f64, f64)> = points.filter(|(q, c)| *q > 0.0 && *c > 0.0).collect();
    let ends = |values: &dyn Fn(&(f64, f64)) -> f64| {
        let least = points.iter().map(values).reduce(f64::min)?;
        let greatest = points.iter().map(values).reduce(f64::max)?;
        Some((least, greatest))
    };
    let (first, last) = ends(&|(q, _)| *q)?;
    let (least, greatest) = ends(&|(_, c)| *c)?;
    Some(Chart {
        title: format!("{name} (tilt removed, Hann window)"),
        x: Axis::logarithmic("wavevector q = 2π/λ", "rad/m", first, last),
        y: Axis::logarithmic("C", unit, least, greatest).with_room(0.04, 0.06),
        series: vec![Series::new("", BLUE, Style::Line, points)],
        legend: Corner::TopRight,
    })
}
