//! The leak over time: `leak_over_time.csv` and `leak_over_time.png`.
//!
//! While contact grows, its gap is that of a state of the path, and so is its leak.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use asperity::creep::CreepState;
use asperity::leak::{Leak, Seal};
use asperity::record::LoadingRecord;
use asperity::surface::Axis as Along;
use asperity::{Error, Warning};
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, GREY, Series, Style};
use asperity_cli::number::{quantity, scientific};
use asperity_cli::outcome::{self, Failure};
use asperity_cli::{say, units};
use serde_json::{Value, json};

use super::charts::Times;
use super::followed::Followed;
use crate::advice;
use crate::passages::Passage;

/// About as many states as have their leak computed, the first and the last among them.
const STATES: usize = 40;

/// Leaks at some times, in their order.
pub(super) struct Leaks {
    seal: Seal,
    leaks: Vec<(CreepState, f64)>,
}

impl Leaks {
    pub(super) fn new(
        followed: &Followed,
        record: &LoadingRecord,
        seal: Seal,
    ) -> Result<Self, Failure> {
        if let Some(time) = followed.recedes {
            return Err(Failure::request(format!(
                "contact recedes from t = {} on, and the gap is then that of no state of the path: the leak over \
                 time is that of growing contact; give a --time before",
                units::time(time)
            )));
        }
        let failed = |error| Failure::new("cannot compute the leak over time", error);
        let mut path = record.replay().map_err(failed)?;
        let states = &followed.states;
        let (every, last) = (states.len().div_ceil(STATES).max(1), states.len().saturating_sub(1));
        let chosen = states.iter().enumerate().filter(|(k, _)| k % every == 0 || *k == last);
        let leaks = chosen.map(|(_, state)| {
            let leak: Result<Leak, Error> = followed.leak(&seal, &mut path, state);
            leak.map(|leak| (*state, leak.leak_rate))
        });
        let leaks = leaks.collect::<Result<Vec<_>, _>>().map_err(failed)?;
        Ok(Self { seal, leaks })
    }

    /// That the fluid would open the gap.
    pub(super) fn warning(&self, nominal_area: f64) -> Option<String> {
        let pressures = self.leaks.iter().map(|(state, _)| state.load / nominal_area);
        let found = Warning::of_pressure_drop(self.seal.pressure_drop(), pressures);
        found.as_ref().map(advice::told)
    }

    pub(super) fn print(&self) {
        let (Some((first, most)), Some((last, least))) = (self.leaks.first(), self.leaks.last())
        else {
            return;
        };
        say!();
        say!(
            "leak       {} m³/s at t = {}, {} m³/s at {}, under {} of a fluid of {}",
            scientific(*most, 4),
            units::time(first.time),
            scientific(*least, 4),
            units::time(last.time),
            quantity(self.seal.pressure_drop(), "Pa", 4),
            quantity(self.seal.viscosity(), "Pa s", 4)
        );
    }

    pub(super) fn object(&self) -> Value {
        let states = self.leaks.iter().map(|(state, leak_rate)| {
            json!({
                "time": state.time,
                "effective_load": state.effective_load,
                "leak_rate": leak_rate,
            })
        });
        Value::Array(states.collect())
    }

    pub(super) fn write(&self, directory: &Path) -> Result<PathBuf, Failure> {
        let mut lines =
            "time,effective_load,load,contact_area_fraction,mean_gap,leak_rate\n".to_string();
        for (state, leak_rate) in &self.leaks {
            // Writing to a text cannot fail.
            let _ = writeln!(
                lines,
                "{:e},{:e},{:e},{},{:e},{leak_rate:e}",
                state.time,
                state.effective_load,
                state.load,
                state.contact_area_fraction,
                state.mean_gap
            );
        }
        outcome::write(&directory.join("leak_over_time.csv"), lines)
    }

    /// The leak over time, up to where nothing leaks, and when contact closes the last channel; `None` if nothing leaks
    /// at two times.
    pub(super) fn draw(
        &self,
        passages: &[Passage<f64>],
        times: &Times,
        directory: &Path,
    ) -> Option<Result<PathBuf, Failure>> {
        let seals = if self.seal.along() == Along::X { "seals_x" } else { "seals_y" };
        // With a least gap the last channel closes before contact closes it.
        let by_contact = self.seal.least_gap() == 0.0;
        let closing = passages.iter().find(|passage| by_contact && passage.key == seals);
        let closing = closing.and_then(|passage| passage.at).map(|time| times.place(time));
        let points =
            self.leaks.iter().map(|(state, leak_rate)| (times.place(state.time), *leak_rate));
        let points: Vec<(f64, f64)> = points.filter(|(_, leak)| *leak > 0.0).collect();
        let (from, to) = (points.first()?.0, points.last()?.0);
        if from >= to {
            return None;
        }
        let most = points.iter().map(|point| point.1).fold(0.0, f64::max);
        let least = points.iter().map(|point| point.1).fold(most, f64::min);
        let mark = closing.map(|time| {
            let line = [(time, least), (time, most)];
            Series::new("the last channel closes", GREY, Style::Dashed, line)
        });
        let to = closing.map_or(to, |time| time.max(to));
        let chart = Chart {
            title: "leak rate".to_string(),
            x: times.axis(to),
            y: Axis::logarithmic("leak rate", "m³/s", least, most).with_room(0.04, 0.06),
            series: mark.into_iter().chain([Series::new("", BLUE, Style::Line, points)]).collect(),
            legend: Corner::BottomLeft,
        };
        Some(chart::draw(&[chart], 1, &directory.join("leak_over_time.png")))
    }
}
