//! `patches.png`: how patches grow in number and size as the path goes on.

use std::path::{Path, PathBuf};

use asperity::LoadingState;
use asperity::patches::PatchState;
use asperity::record::LoadingRecord;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, GREEN, GREY, ORANGE, PURPLE, Series, Style};
use asperity_cli::outcome::Failure;

use super::followed::Followed;
use crate::passages::Passage;

/// A quantity of a state with its patches.
type Quantity<'a> = &'a dyn Fn(&LoadingState, &PatchState) -> f64;

const AREA: &str = "contact area / nominal area";
/// About as many points as a curve shows.
const POINTS: usize = 600;

/// Draws four charts, with the states at which contact percolates and leakage ends.
pub(super) fn draw(
    record: &LoadingRecord,
    followed: &Followed,
    name: &Path,
) -> Result<PathBuf, Failure> {
    let grid = record.grid();
    let marks = marks(&followed.passages);
    let states = || followed.touches.iter().zip(&followed.patches);
    let reached = states().map(|(state, _)| state.contact.contact_area_fraction);
    let reached = reached.fold(0.0, f64::max);
    let count = followed.patches.len();
    let shown = |quantity: Quantity| -> Vec<(f64, f64)> {
        let all = states().enumerate();
        let some = all.filter(|(k, _)| (count - 1 - k).is_multiple_of(1 + count / POINTS));
        some.map(|(_, (s, p))| (s.contact.contact_area_fraction, quantity(s, p))).collect()
    };
    // Marks end at `top`, so that they do not run behind a legend above.
    let against_area = |title: &str, y: Axis, top: f64, quantity: Quantity| {
        let lines = marks.iter().map(|mark| {
            let x = mark.state.contact.contact_area_fraction;
            mark.series([(x, 0.0), (x, top)])
        });
        let curve = Series::new("", BLUE, Style::Line, shown(quantity));
        Chart {
            title: title.to_string(),
            x: Axis::plain(AREA, 0.0, reached),
            y,
            series: lines.chain([curve]).collect(),
            legend: Corner::TopRight,
        }
    };
    let greatest = |quantity: Quantity| {
        let all = states().map(|(s, p)| quantity(s, p));
        1.06 * all.fold(0.0, f64::max)
    };

    let number: Quantity = &|_, p| p.patches as f64;
    let share: Quantity = &|s, p| p.largest as f64 / s.contact.contact_nodes as f64;
    let perimeter: Quantity = &|_, p| p.perimeter.length(&grid);
    let (most, longest) = (greatest(number), greatest(perimeter));
    let room = if marks.is_empty() { 1.0 } else { 1.3 };
    let (patches, part, length) = (
        Axis::plain("patches", 0.0, room * most),
        Axis::plain("largest patch / contact area", 0.0, 1.06),
        Axis::linear("perimeter", "m", 0.0, longest),
    );
    let mut charts = vec![
        against_area("number of patches", patches, most, number),
        against_area("the largest patch", part, 1.06, share),
        against_area("edges of all patches", length, longest, perimeter),
    ];
    for chart in charts.iter_mut().skip(1) {
        // The first chart names the marks for all.
        let series = chart.series.iter_mut();
        series.for_each(|series| series.name.clear());
    }
    let nominal = grid.nominal_area();
    let corrected: Quantity = &|_, p| p.corrected_area(&grid) / nominal;
    charts.extend(areas(states().collect(), corrected, &marks));
    chart::draw(&charts, 2, name)
}

/// Area against load, counted in cells and corrected; `None` if no state carries load.
fn areas(
    states: Vec<(&LoadingState, &PatchState)>,
    corrected: Quantity,
    marks: &[Mark],
) -> Option<Chart> {
    let loaded = states.iter().filter(|(state, _)| state.contact.load > 0.0);
    let counted = loaded.clone().map(|(s, _)| (s.contact.load, s.contact.contact_area_fraction));
    let corrected: Vec<_> = loaded.map(|(s, p)| (s.contact.load, corrected(s, p))).collect();
    let (first, last) = (*corrected.first()?, *corrected.last()?);
    let least = corrected.iter().map(|(_, area)| *area).fold(1.0, f64::min);
    let y = Axis::plain_logarithmic(AREA, least, last.1);
    let lines = marks.iter().map(|mark| {
        let mut line =
            mark.series([(mark.state.contact.load, least), (mark.state.contact.load, last.1)]);
        line.name.clear();
        line
    });
    let curves = [
        Series::new("whole cells", GREY, Style::Dashed, counted),
        Series::new("corrected along the edges", BLUE, Style::Line, corrected),
    ];
    Some(Chart {
        title: "contact area".to_string(),
        x: Axis::logarithmic("load", "N", first.0, last.0).with_room(0.0, 0.02),
        y: y.with_room(0.04, 0.06),
        series: lines.chain(curves).collect(),
        legend: Corner::TopLeft,
    })
}

/// Passages at the same state.
struct Mark<'a> {
    state: &'a LoadingState,
    names: Vec<&'a str>,
    place: usize,
}

impl Mark<'_> {
    fn series(&self, ends: [(f64, f64); 2]) -> Series {
        let colour = [ORANGE, GREEN, PURPLE, GREY][self.place % 4];
        Series::new(self.names.join(", "), colour, Style::Dashed, ends)
    }
}

/// In the order of loading.
fn marks(passages: &[Passage<LoadingState>]) -> Vec<Mark<'_>> {
    let mut marks: Vec<Mark> = Vec::new();
    for passage in passages {
        let Some(state) = &passage.at else {
            continue;
        };
        match marks.iter_mut().find(|mark| mark.state.step == state.step) {
            Some(mark) => mark.names.push(passage.name),
            None => marks.push(Mark { state, names: vec![passage.name], place: 0 }),
        }
    }
    marks.sort_by_key(|mark| mark.state.step);
    for (place, mark) in marks.iter_mut().enumerate() {
        mark.place = place;
    }
    marks
}
