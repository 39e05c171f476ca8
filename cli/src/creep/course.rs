//! What is asked for: bodies, history, times.

use std::path::Path;

use asperity::creep::{ControlHistory, PiecewiseLinear, Prony, Steps};
use asperity_cli::outcome::Failure;

use super::Options;

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
        (_, _, Some(file)) => read(file),
        _ => Err(Failure::request("give --load, --approach or --history")),
    }
}

/// A history from a file.
fn read(file: &Path) -> Result<ControlHistory, Failure> {
    let name = file.display();
    let text = std::fs::read_to_string(file)
        .map_err(|error| Failure::new(format!("cannot read {name}"), error))?;
    parse(&text).map_err(|what| Failure::request(format!("{name}: {what}")))
}

fn parse(text: &str) -> Result<ControlHistory, String> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines = text.lines().zip(1..).map(|(line, number)| (line.trim(), number));
    let mut lines = lines.filter(|(line, _)| !line.is_empty() && !line.starts_with('#'));
    let header = lines.next().map_or("", |(line, _)| line);
    let names: Vec<String> = header.split(',').map(|name| name.trim().to_lowercase()).collect();
    let make: fn(PiecewiseLinear) -> ControlHistory =
        match names.iter().map(String::as_str).collect::<Vec<_>>()[..] {
            ["time", "load"] => ControlHistory::Load,
            ["time", "approach"] => ControlHistory::Approach,
            _ => {
                return Err(format!(
                    "the first line must be `time,load` or `time,approach`, but is `{header}`"
                ));
            }
        };
    let mut corners = Vec::new();
    for (line, number) in lines {
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        let parsed = match fields[..] {
            [time, value] => time.parse().ok().zip(value.parse().ok()),
            _ => None,
        };
        let corner: (f64, f64) =
            parsed.ok_or_else(|| format!("line {number}, `{line}`, is no pair of numbers"))?;
        corners.push(corner);
    }
    PiecewiseLinear::new(corners).map(make).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn histories_are_read() {
        let read = parse("\u{feff}# made by hand\nTime, Load\r\n0,0\n\n0.5, 2e2\n0.5,100\n");
        let expected = PiecewiseLinear::new([(0.0, 0.0), (0.5, 200.0), (0.5, 100.0)]);
        assert_eq!(read.ok(), expected.ok().map(ControlHistory::Load));
        assert!(matches!(parse("time,approach\n0,1e-6"), Ok(ControlHistory::Approach(_))));
        for (bad, word) in [
            ("", "first line"),
            ("0,1\n1,2", "first line"),
            ("time,load,area\n0,1,2", "first line"),
            ("time,load", "at least 1"),
            ("time,load\n0,a", "line 2"),
            ("time,load\n0,1,2", "line 2"),
            ("time,load\n1,1\n0,1", "no earlier"),
            ("time,load\n0,nan", "finite"),
        ] {
            let said = parse(bad).err().unwrap_or_default();
            assert!(said.contains(word), "{bad}: {said}");
        }
    }
}
