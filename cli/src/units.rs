//! In which units people read tables and charts. Files for programs are in SI units, whatever is chosen.

use std::sync::OnceLock;

use clap::ValueEnum;

use crate::number::{area_unit, is_power_of_length, plain, prefixed, quantity};

/// A system of units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Units {
    /// SI units with prefixes: kN, µm, MPa
    #[default]
    #[value(name = "SI")]
    Si,
    /// Millimetres, newtons and megapascals, as in most models of finite elements
    #[value(name = "mm-N-MPa")]
    Millimetres,
}

/// What has been chosen.
static CHOSEN: OnceLock<Units> = OnceLock::new();

/// SI units, what they are in mm, N, MPa and s, and the name there.
const MILLIMETRES: [(&str, f64, &str); 14] = [
    ("m", 1e-3, "mm"),
    ("N", 1.0, "N"),
    ("Pa", 1e6, "MPa"),
    ("m²", 1e-6, "mm²"),
    ("m³", 1e-9, "mm³"),
    ("m⁴", 1e-12, "mm⁴"),
    ("N/m", 1e3, "N/mm"),
    ("N/m²", 1e6, "MPa"),
    ("J", 1e-3, "mJ"),
    ("m²/s", 1e-6, "mm²/s"),
    ("m³/s", 1e-9, "mm³/s"),
    ("rad/m", 1e3, "rad/mm"),
    ("W/(m² K)", 1e3, "mW/(mm² K)"),
    ("S/m²", 1e9, "A/(mV mm²)"),
];

/// From here on tables and charts are in these units.
pub fn choose(units: Units) {
    // Only the first choice counts: there is one command line.
    let _ = CHOSEN.set(units);
}

/// Which these are.
pub fn chosen() -> Units {
    CHOSEN.get().copied().unwrap_or_default()
}

/// The unit in which values up to `greatest` of an SI unit are shown, and its name.
pub fn of(si_unit: &str, greatest: f64) -> (f64, String) {
    shown(chosen(), si_unit, greatest)
}

/// A time with up to four digits, from a quarter of an hour on in a unit that the command line reads too.
pub fn time(seconds: f64) -> String {
    time_to(seconds, 4)
}

/// The same with other digits.
pub fn time_to(seconds: f64, digits: usize) -> String {
    const DAY: f64 = 86_400.0;
    const UNITS: [(f64, f64, &str); 3] =
        [(DAY, DAY, "d"), (3600.0, 3600.0, "h"), (900.0, 60.0, "min")];
    match UNITS.iter().find(|(least, ..)| (*least..1e6 * DAY).contains(&seconds)) {
        Some((_, unit, name)) => format!("{} {name}", plain(seconds / unit, digits)),
        None => quantity(seconds, "s", digits),
    }
}

fn shown(units: Units, si_unit: &str, greatest: f64) -> (f64, String) {
    let known = MILLIMETRES.iter().find(|(name, ..)| *name == si_unit);
    match (units, known) {
        (Units::Millimetres, Some((_, unit, name))) => (*unit, (*name).to_string()),
        (Units::Si, _) if si_unit == "m²" => {
            let (unit, name) = area_unit(greatest);
            (unit, name.to_string())
        }
        // Nobody counts in megaseconds.
        _ if is_power_of_length(si_unit) || ["cells", "s"].contains(&si_unit) => {
            (1.0, si_unit.to_string())
        }
        _ => prefixed(si_unit, greatest),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quantity has one unit, whoever shows it.
    #[test]
    fn units_are_those_of_the_reader() {
        for (si, greatest, prefixed, plain) in [
            ("m", 2e-5, (1e-6, "µm"), (1e-3, "mm")),
            ("N", 2e4, (1e3, "kN"), (1.0, "N")),
            ("Pa", 2e9, (1e9, "GPa"), (1e6, "MPa")),
            ("m²", 1e-5, (1e-6, "mm²"), (1e-6, "mm²")),
            ("m³/s", 1e-12, (1.0, "m³/s"), (1e-9, "mm³/s")),
            ("N/m", 3e9, (1e9, "GN/m"), (1e3, "N/mm")),
            ("Hz", 3e3, (1e3, "kHz"), (1e3, "kHz")),
            ("cells", 3e3, (1.0, "cells"), (1.0, "cells")),
        ] {
            for (units, expected) in [(Units::Si, prefixed), (Units::Millimetres, plain)] {
                let (unit, name) = shown(units, si, greatest);
                assert!((unit / expected.0 - 1.0).abs() < 1e-12, "{si}: {unit:e}");
                assert_eq!(name, expected.1);
            }
        }
    }
    #[test]
    fn long_times_are_told_in_days() {
        for (seconds, text) in [
            (0.0, "0 s"),
            (2.5e-3, "2.5 ms"),
            (899.0, "899 s"),
            (1000.0, "16.67 min"),
            (5400.0, "1.5 h"),
            (31_536_000.0, "365 d"),
            (1e9, "11574 d"),
            (f64::INFINITY, "inf s"),
        ] {
            assert_eq!(time(seconds), text);
        }
        assert_eq!(time_to(10_234.0, 2), "2.8 h");
    }
}
