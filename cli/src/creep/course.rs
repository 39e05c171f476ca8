//! What is asked for: bodies, history, times.

use asperity::creep::{ControlHistory, PiecewiseLinear, Prony, Steps};
use asperity_cli::outcome::Failure;

use super::Options;
use crate::history_table::HistoryTable;
use crate::values::{FORCE, LENGTH, TIME};

/// What to follow.
pub(super) struct Task {
    pub(super) prony: Prony,
    pub(super) course: ControlHistory,
    pub(super) steps: Steps,
    pub(super) end: f64,
    pub(super) cycles: Option<Cycles>,
}

/// Cycles of load around a mean.
pub(super) struct Cycles {
    pub(super) mean: f64,
    pub(super) amplitude: f64,
}

impl Task {
    pub(super) fn new(options: &Options) -> Result<Self, Failure> {
        let prony = Prony::shares(&options.prony)
            .map_err(|error| Failure::new("this is no Prony series of a body", error))?;
        let course = course(options)?;
        let corners = course.corners().corners();
        let (begin, last) =
            (corners.first().map_or(0.0, |corner| corner.0), course.corners().end());
        let longest = prony.relaxation_terms().last().map_or(1.0, |term| term.time);
        let end = match (options.time, &options.history) {
            (Some(time), _) => time,
            (None, Some(_)) if last > begin => last,
            _ => last + 100.0 * longest,
        };
        if end < begin {
            return Err(Failure::request(format!(
                "--time {end} is before the history begins, at {begin} s"
            )));
        }
        let cycles = match options.load {
            Some(mean) => {
                let amplitude = options.cycle_amplitude.unwrap_or(0.2 * mean);
                if amplitude > mean {
                    return Err(Failure::request(format!(
                        "--cycle-amplitude {amplitude} N is more than --load, {mean} N: the load would become negative"
                    )));
                }
                Some(Cycles { mean, amplitude })
            }
            None => None,
        };
        let steps = Steps { least: options.steps as usize, ..Steps::default() };
        Ok(Self { prony, course, steps, end, cycles })
    }
}

fn course(options: &Options) -> Result<ControlHistory, Failure> {
    let failed = |error| Failure::new("this is no history", error);
    let put_on = |value: f64| match options.ramp {
        Some(duration) => PiecewiseLinear::ramp(value, duration),
        None => PiecewiseLinear::step(value),
    };
    match (options.load, options.approach, &options.history) {
        (Some(load), _, _) => put_on(load).map(ControlHistory::Load).map_err(failed),
        (_, Some(approach), _) => put_on(approach).map(ControlHistory::Approach).map_err(failed),
        (_, _, Some(file)) => HistoryTable::read(file, history),
        _ => Err(Failure::request("give --load, --approach or --history")),
    }
}

/// Load or approach over time.
fn history(table: &HistoryTable) -> Result<ControlHistory, String> {
    let (values, make): (_, fn(PiecewiseLinear) -> ControlHistory) =
        match (table.has("load"), table.has("approach")) {
            (true, false) => (table.column("load", &FORCE)?, ControlHistory::Load),
            (false, true) => (table.column("approach", &LENGTH)?, ControlHistory::Approach),
            _ => {
                return Err(format!(
                    "its first line must name `time` and one of `load` and `approach`: it is `{}`",
                    table.header()
                ));
            }
        };
    let times = table.column("time", &TIME)?;
    let corners = times.into_iter().zip(values);
    PiecewiseLinear::new(corners).map(make).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn histories_are_read() {
        let parse = |text| HistoryTable::parse(text).and_then(|table| history(&table));
        let read = parse("time, load\n0,0\n0.5, 2e2\n0.5,100\n");
        let expected = PiecewiseLinear::new([(0.0, 0.0), (0.5, 200.0), (0.5, 100.0)]);
        assert_eq!(read.ok(), expected.ok().map(ControlHistory::Load));
        assert!(matches!(parse("time,approach\n0,1e-6"), Ok(ControlHistory::Approach(_))));
        for (bad, word) in [
            ("0,1\n1,2", "must name"),
            ("time,load,approach\n0,1,2", "one of"),
            ("load\n0", "`time`"),
            ("time,load", "at least 1"),
            ("time,load\n1,1\n0,1", "no earlier"),
        ] {
            let said = parse(bad).err().unwrap_or_default();
            assert!(said.contains(word), "{bad}: {said}");
        }
    }
}
