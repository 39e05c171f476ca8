//! `distributions.png`: pressures, gaps and areas of patches at one state.

use std::path::{Path, PathBuf};

use asperity::kernel::KernelOrigin;
use asperity::patches::{Bins, Histogram, gap_distribution, pressure_distribution};
use asperity::record::LoadingRecord;
use asperity::reference::AreaLoadLaw;
use asperity::{Boundary, Error};
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, ORANGE, Series, Style};
use asperity_cli::number::{counted, quantity};
use asperity_cli::outcome::Failure;

use super::moment::Moment;

/// Bins of pressure and of gap, and bins of area to a decade.
const BINS: usize = 60;
const PER_DECADE: usize = 4;
/// Points of a theory.
const POINTS: usize = 400;

/// Draws those of which there is anything.
pub(super) fn draw(
    record: &LoadingRecord,
    moment: &Moment,
    name: &Path,
) -> Result<PathBuf, Failure> {
    let failed = |error| Failure::new("cannot compute the distributions", error);
    let charts = [
        pressures(record, moment).map_err(failed)?,
        gaps(moment).map_err(failed)?,
        areas(record, moment).map_err(failed)?,
    ];
    let charts: Vec<Chart> = charts.into_iter().flatten().collect();
    if charts.is_empty() {
        return Err(Failure::request(
            "there are no distributions: the state has no pressure and no gap",
        ));
    }
    chart::draw(&charts, charts.len(), name)
}

/// Over the nominal area, in units of the reciprocal of the mean pressure in contact; beside it Persson's, where
/// the surface has no edge.
fn pressures(record: &LoadingRecord, moment: &Moment) -> Result<Option<Chart>, Error> {
    let state = &moment.state;
    let found = pressure_distribution(&moment.pressure, &moment.contact_map, Bins::Linear(BINS))?;
    let Some(&greatest) = found.histogram.edges().last() else {
        return Ok(None);
    };
    let mean = state.contact.load / state.contact.contact_area;
    let density = found.histogram.density();
    let density = density.iter().map(|d| d * found.contact_area_fraction * mean);
    let own = outline(found.histogram.edges(), density, 0.0);
    let name = |who: &str, area: f64| format!("{who}, A/A₀ = {:.2} %", 100.0 * area);
    let mut series = vec![Series::new(
        name("this surface", found.contact_area_fraction),
        BLUE,
        Style::Line,
        own,
    )];
    if let Some(law) = persson(record)? {
        let nominal = state.contact.mean_pressure();
        let theory = (0..=POINTS).map(|k| {
            let pressure = greatest * k as f64 / POINTS as f64;
            (pressure, law.persson_density(pressure, nominal) * mean)
        });
        let name = name("Persson", law.persson(nominal));
        series.push(Series::new(name, ORANGE, Style::Dashed, theory));
    }
    Ok(Some(Chart {
        title: format!("pressure, W = {}", quantity(state.contact.load, "N", 4)),
        x: Axis::linear("pressure p", "Pa", 0.0, greatest),
        y: Axis::plain("density over A₀ × mean p in contact", 0.0, 1.2 * top(&series)),
        series,
        legend: Corner::TopRight,
    }))
}

/// `None` on a free boundary, for bodies that are no half-space, and where nodes yield: the theory is elastic.
fn persson(record: &LoadingRecord) -> Result<Option<AreaLoadLaw>, Error> {
    let (
        Boundary::Periodic,
        &(KernelOrigin::PeriodicBoussinesq { e_star } | KernelOrigin::Spectral { e_star }),
        None,
    ) = (record.kernel().boundary, &record.kernel().origin, &record.settings().hardness)
    else {
        return Ok(None);
    };
    let gradient = record.heights().rms_gradient(&record.grid())?;
    // A flat surface has no theory.
    Ok(AreaLoadLaw::new(gradient, e_star).ok())
}

/// Over the nodes out of contact, in units of the reciprocal of their mean gap.
fn gaps(moment: &Moment) -> Result<Option<Chart>, Error> {
    let found = gap_distribution(&moment.gap, &moment.contact_map, Bins::Linear(BINS))?;
    let Some(&greatest) = found.histogram.edges().last() else {
        return Ok(None);
    };
    let open = 1.0 - found.contact_area_fraction;
    let mean = moment.state.contact.mean_gap / open;
    let density = found.histogram.density();
    let density = density.iter().map(|density| density * mean);
    let points = outline(found.histogram.edges(), density, 0.0);
    let series = vec![Series::new("", BLUE, Style::Line, points)];
    Ok(Some(Chart {
        title: format!("gap, open on {:.2} % of the area", 100.0 * open),
        x: Axis::linear("gap", "m", 0.0, greatest),
        y: Axis::plain("density × mean open gap", 0.0, top(&series)),
        series,
        legend: Corner::TopRight,
    }))
}

/// Patches in bins of equal ratio, if there are several.
fn areas(record: &LoadingRecord, moment: &Moment) -> Result<Option<Chart>, Error> {
    if moment.patches.len() < 2 {
        return Ok(None);
    }
    let nodes = moment.patches.iter().map(|(patch, _)| patch.nodes as f64);
    let found = Histogram::new(nodes, Bins::PerDecade(PER_DECADE))?;
    let most = found.counts().iter().copied().max().unwrap_or(0);
    let cell = record.grid().cell_area();
    let edges: Vec<f64> = found.edges().iter().map(|nodes| nodes * cell).collect();
    let (Some(&least), Some(&greatest)) = (edges.first(), edges.last()) else {
        return Ok(None);
    };
    // A logarithmic axis has no zero.
    let foot = 0.8;
    // Each run of bins that are not empty has an outline of its own: an empty bin has nothing to draw.
    let mut series = Vec::new();
    let mut first = 0;
    for run in found.counts().chunk_by(|one, next| (*one == 0) == (*next == 0)) {
        let counts = run.iter().map(|&count| count as f64);
        if run.iter().any(|&count| count > 0) {
            let points = outline(&edges[first..=first + run.len()], counts, foot);
            series.push(Series::new("", BLUE, Style::Line, points));
        }
        first += run.len();
    }
    Ok(Some(Chart {
        title: counted(moment.patches.len(), "patch"),
        x: Axis::logarithmic("area of a patch", "m²", least, greatest),
        y: Axis::plain_logarithmic("patches in a quarter of a decade", foot, 1.5 * most as f64),
        series,
        legend: Corner::TopRight,
    }))
}

/// The outline of a histogram that stands on `foot`.
fn outline(edges: &[f64], heights: impl Iterator<Item = f64>, foot: f64) -> Vec<(f64, f64)> {
    let ends = |place: Option<&f64>| place.map(|&edge| (edge, foot));
    let bins = edges.windows(2).zip(heights);
    let tops = bins.flat_map(|(ends, height)| [(ends[0], height), (ends[1], height)]);
    ends(edges.first()).into_iter().chain(tops).chain(ends(edges.last())).collect()
}

/// The upper end of an axis for these series.
fn top(series: &[Series]) -> f64 {
    let points = series.iter().flat_map(|series| &series.points);
    let highest = points.map(|(_, y)| *y).fold(0.0, f64::max);
    if highest > 0.0 { 1.06 * highest } else { 1.0 }
}
