//! `leak.png`: the leak rate against the mean pressure, and the share of the critical constriction.

use std::path::{Path, PathBuf};

use asperity::leak::{LeakCurve, LeakPoint};
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, GREY, ORANGE, Series, Style};
use asperity_cli::outcome::Failure;

/// Decades of the leak rate that are shown at most: the last states before the closing can leak as little as they like.
const DECADES: f64 = 14.0;

/// Draws both charts; nothing if nothing leaks under load.
pub(super) fn draw(curve: &LeakCurve, name: &Path) -> Result<Option<PathBuf>, Failure> {
    let leaking: Vec<&LeakPoint> = curve.points.iter().filter(|p| p.leak_rate > 0.0).collect();
    let reached = curve.points.last().map_or(0.0, pressure);
    if leaking.is_empty() || reached <= 0.0 {
        return Ok(None);
    }
    // A stiff coat may open a channel under load, and the mean field may leak less or more.
    let most = leaking.iter().map(|p| p.leak_rate.max(p.mean_field_leak_rate)).fold(0.0, f64::max);
    let least = leaking.iter().map(|point| point.leak_rate).fold(most, f64::min);
    let least = least.max(most * 10_f64.powf(-DECADES));
    let x = || Axis::linear("mean pressure", "Pa", 0.0, 1.04 * reached);
    let of = |quantity: fn(&LeakPoint) -> f64| -> Vec<(f64, f64)> {
        let points = leaking.iter().map(|point| (pressure(point), quantity(point)));
        points.filter(|(_, value)| *value > 0.0).collect()
    };
    // A line that goes on below is drawn down to the border.
    let shown = |points: Vec<(f64, f64)>| {
        let crossings = points.windows(2).filter_map(|pair| {
            let [(from, high), (to, low)] = [pair[0], pair[1]];
            let part = (high / least).ln() / (high / low).ln();
            let crosses = (high >= least) != (low >= least);
            crosses.then_some((from + part * (to - from), least))
        });
        let mut shown: Vec<_> = crossings.collect();
        shown.extend(points.into_iter().filter(|(_, y)| *y >= least));
        shown.sort_by(|a, b| a.0.total_cmp(&b.0));
        shown
    };
    let closing = curve.closing.map(|state| state.contact.mean_pressure());
    let mark = |name: &str, from: f64, to: f64| {
        let line = closing.map(|at| [(at, from), (at, to)]);
        line.map(|line| Series::new(name, GREY, Style::Dashed, line))
    };
    let rates = Chart {
        title: "leak rate".to_string(),
        x: x(),
        y: Axis::logarithmic("leak rate", "m³/s", least, most).with_room(0.04, 0.06),
        series: mark("the last channel closes", least, most)
            .into_iter()
            .chain([
                Series::new(
                    "mean field",
                    ORANGE,
                    Style::Dashed,
                    shown(of(|p| p.mean_field_leak_rate)),
                ),
                Series::new("Reynolds' equation", BLUE, Style::Line, shown(of(|p| p.leak_rate))),
            ])
            .collect(),
        legend: Corner::BottomLeft,
    };
    let share = |of: fn(&asperity::leak::CriticalConstriction) -> f64| -> Vec<(f64, f64)> {
        let all = leaking.iter();
        all.filter_map(|point| Some((pressure(point), of(&point.constriction?)))).collect()
    };
    let shares = Chart {
        title: "the critical constriction".to_string(),
        x: x(),
        y: Axis::plain("share", 0.0, 1.3),
        series: mark("", 0.0, 1.0)
            .into_iter()
            .chain([
                Series::new(
                    "of the power, within 9 × 9 cells",
                    ORANGE,
                    Style::Line,
                    share(|c| c.dissipation),
                ),
                Series::new(
                    "of the pressure drop, at its cell",
                    BLUE,
                    Style::Line,
                    share(|c| c.pressure_drop),
                ),
            ])
            .collect(),
        legend: Corner::TopLeft,
    };
    chart::draw(&[rates, shares], 2, name).map(Some)
}

fn pressure(point: &LeakPoint) -> f64 {
    point.state.contact.mean_pressure()
}
