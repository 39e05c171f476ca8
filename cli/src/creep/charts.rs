//! `creep.png`: contact over time.

use std::path::{Path, PathBuf};

use asperity::creep::CreepState;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{
    self, BLUE, Chart, Corner, GREEN, GREY, ORANGE, PURPLE, Series, Style, head_room,
};
use asperity_cli::outcome::Failure;

use super::followed::Followed;
use crate::passages::Passage;

type Quantity = fn(&CreepState) -> f64;

/// How time is drawn: its logarithm, the state just after t = 0 being at the left end; with corners of its own a
/// history is drawn over time itself, unless most of it is one long hold from t = 0 on.
pub(super) struct Times {
    start: f64,
    last: f64,
    is_linear: bool,
}

impl Times {
    /// Those of states in their order; `None` if all are at one.
    pub(super) fn of(states: &[CreepState], has_corners: bool) -> Option<Self> {
        let (begin, last) = (states.first()?.time, states.last()?.time);
        let mut positive = states.iter().map(|state| state.time).filter(|time| *time > 0.0);
        let first = positive.next().unwrap_or(last);
        // Half of the states lie behind a thousandth of the time.
        let middle = states[states.len() / 2].time;
        let is_late = begin < 0.0 || middle > 1e-3 * last;
        let is_linear = first >= last || (has_corners && is_late);
        let start = if is_linear { begin } else { first };
        (start < last).then_some(Self { start, last, is_linear })
    }

    /// Where a time is drawn.
    pub(super) fn place(&self, time: f64) -> f64 {
        time.max(self.start)
    }

    /// The axis, from the beginning on.
    pub(super) fn axis(&self, to: f64) -> Axis {
        match self.is_linear {
            true => Axis::linear("time", "s", self.start, to),
            false => Axis::plain_logarithmic("time [s]", self.start, to),
        }
    }
}

/// Draws area, mean gap, approach and load over time.
pub(super) fn draw(
    followed: &Followed,
    passages: &[Passage<f64>],
    times: &Times,
    name: &Path,
) -> Result<PathBuf, Failure> {
    let states = &followed.states;
    let shown: Vec<(f64, &CreepState)> =
        states.iter().map(|state| (times.place(state.time), state)).collect();
    let curve = |quantity: Quantity, name: &str, colour, style| {
        Series::new(name, colour, style, shown.iter().map(|(t, state)| (*t, quantity(state))))
    };
    let range = |quantity: Quantity| {
        let all = states.iter().map(quantity);
        all.fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)))
    };
    let seen = together(passages);
    let marks = |from: f64, to: f64, named: bool| -> Vec<Series> {
        let colours = [ORANGE, GREEN, PURPLE, GREY];
        let marks = seen.iter().zip(colours).map(|((time, names), colour)| {
            let time = times.place(*time);
            let name = if named { names.as_str() } else { "" };
            Series::new(name, colour, Style::Dashed, [(time, from), (time, to)])
        });
        marks.collect()
    };
    let chart = |title: &str, y: Axis, series: Vec<Series>, legend| Chart {
        title: title.to_string(),
        x: times.axis(times.last),
        y,
        series,
        legend,
    };
    let area: Quantity = |state| state.contact_area_fraction;
    let gap: Quantity = |state| state.mean_gap;
    let approach: Quantity = |state| state.approach;
    let (load, effective): (Quantity, Quantity) =
        (|state| state.load, |state| state.effective_load);

    let (_, largest) = range(area);
    let with_marks = |from: f64, to: f64, named, quantity| {
        let mut series = marks(from, to, named);
        series.push(curve(quantity, "", BLUE, Style::Line));
        series
    };
    let (narrowest, widest) = range(gap);
    let (least, most) = range(approach);
    let (_, heaviest) = range(load);
    let (_, most_effective) = range(effective);
    let charts = [
        chart(
            "contact area",
            Axis::plain("contact area / nominal area", 0.0, largest)
                .with_room(0.0, head_room(seen.len())),
            with_marks(0.0, largest, true, area),
            Corner::TopLeft,
        ),
        chart(
            "mean gap",
            Axis::linear("mean gap", "m", narrowest, widest).with_room(0.05, 0.05),
            with_marks(narrowest, widest, false, gap),
            Corner::TopRight,
        ),
        chart(
            "approach",
            Axis::linear("approach", "m", least.min(0.0), most).with_room(0.0, 0.05),
            vec![curve(approach, "", BLUE, Style::Line)],
            Corner::BottomRight,
        ),
        chart(
            "load, and the elastic load of the same contact while it grows",
            Axis::linear("load", "N", 0.0, heaviest.max(most_effective))
                .with_room(0.0, head_room(2)),
            vec![
                curve(load, "load", BLUE, Style::Line),
                curve(effective, "effective load", ORANGE, Style::Dashed),
            ],
            Corner::TopLeft,
        ),
    ];
    chart::draw(&charts, 2, name)
}

/// Passages at the same time have one mark.
fn together(passages: &[Passage<f64>]) -> Vec<(f64, String)> {
    let mut marks: Vec<(f64, String)> = Vec::new();
    for passage in passages {
        let Some(time) = passage.at else {
            continue;
        };
        match marks.iter_mut().find(|(at, _)| *at == time) {
            Some((_, names)) => {
                names.push_str(", ");
                names.push_str(passage.name);
            }
            None => marks.push((time, passage.name.to_string())),
        }
    }
    marks
}
