//! States that a command line asks for by what is known of them: `--at 5MPa,50N,10%`.

use std::fmt;
use std::str::FromStr;

use asperity::contact::ContactState;
use asperity::record::LoadingRecord;
use asperity::{ContactTarget, LoadingState};
use asperity_cli::number::{area, quantity};
use asperity_cli::outcome::Failure;

use crate::values::{AREA, FORCE, PRESSURE, SHARE, any_of};

/// Significant digits by which states are told apart.
const DIGITS: usize = 9;

/// A state.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub(crate) enum At {
    /// Under a load \[N\].
    Load(f64),
    /// Under a load over nominal area \[Pa\].
    MeanPressure(f64),
    /// With a contact area \[m²\].
    Area(f64),
    /// With a contact area over nominal area.
    AreaFraction(f64),
}

impl At {
    /// What a path or a single load reaches there.
    pub(crate) fn target(self, nominal_area: f64) -> ContactTarget {
        match self {
            Self::Load(load) => ContactTarget::Load(load),
            Self::MeanPressure(pressure) => ContactTarget::Load(pressure * nominal_area),
            Self::Area(area) => ContactTarget::AreaFraction(area / nominal_area),
            Self::AreaFraction(fraction) => ContactTarget::AreaFraction(fraction),
        }
    }

    /// The same of a state, by what this one is known by.
    pub(crate) fn of_same_kind(self, state: &LoadingState, nominal_area: f64) -> Self {
        let ContactState { load, contact_area, contact_area_fraction, .. } = state.contact;
        match self {
            Self::Load(_) => Self::Load(load),
            Self::MeanPressure(_) => Self::MeanPressure(load / nominal_area),
            Self::Area(_) => Self::Area(contact_area),
            Self::AreaFraction(_) => Self::AreaFraction(contact_area_fraction),
        }
    }

    /// The ending of the name of a file: `_5MPa`.
    pub(crate) fn ending(self) -> String {
        let ascii = |c: char| match c {
            'µ' => 'u',
            '²' => '2',
            other => other,
        };
        let name: String = self.to_string().chars().filter(|c| *c != ' ').map(ascii).collect();
        // Beyond all prefixes there is a power of ten.
        match (name.is_ascii(), self) {
            (true, _) => format!("_{name}"),
            (false, Self::Load(value)) => format!("_{value:e}N"),
            (false, Self::MeanPressure(value)) => format!("_{value:e}Pa"),
            (false, Self::Area(value)) => format!("_{value:e}m2"),
            (false, Self::AreaFraction(value)) => format!("_{value:e}"),
        }
    }

    /// The furthest of states along a path, whose end it is.
    pub(crate) fn furthest(all: &[Self], nominal_area: f64) -> Option<ContactTarget> {
        let size = |target: &ContactTarget| match *target {
            ContactTarget::Load(value) | ContactTarget::AreaFraction(value) => value,
            _ => 0.0,
        };
        let targets = all.iter().map(|at| at.target(nominal_area));
        targets.max_by(|one, other| size(one).total_cmp(&size(other)))
    }

    /// Whether it comes behind a state that is known by the same.
    pub(crate) fn is_beyond(self, end: Self) -> bool {
        std::mem::discriminant(&self) == std::mem::discriminant(&end) && self > end
    }

    /// Whether it is a contact area.
    fn is_area(self) -> bool {
        matches!(self, Self::Area(_) | Self::AreaFraction(_))
    }

    /// `Ok` if no two states have one name, and if one of them is surely the furthest where `ends_there`.
    pub(crate) fn check(all: &[Self], ends_there: bool) -> Result<(), Failure> {
        let twice = all.iter().enumerate().find(|(k, at)| {
            let earlier = &all[..*k];
            earlier.iter().any(|other| other.ending() == at.ending())
        });
        if let Some((_, at)) = twice {
            return Err(Failure::request(format!("the state at {at} is asked for twice")));
        }
        let areas = all.iter().filter(|at| at.is_area()).count();
        if ends_there && (1..all.len()).contains(&areas) {
            return Err(Failure::request(
                "--at has loads and areas: say where the path ends, with --mean-pressure, --max-area-fraction or another end",
            ));
        }
        Ok(())
    }
}

/// The state of a record at a load \[N\].
pub(crate) fn state_at_load(record: &LoadingRecord, load: f64) -> Result<LoadingState, Failure> {
    record.history().at_load(load).ok_or_else(|| {
        let end = record.states().last().map_or(0.0, |last| last.contact.load);
        Failure::request(format!(
            "the path has no state at {}: it ends at {}",
            quantity(load, "N", 6),
            quantity(end, "N", 6)
        ))
    })
}

impl FromStr for At {
    type Err = String;

    /// A bare number is a mean pressure.
    fn from_str(text: &str) -> Result<Self, String> {
        let found = any_of(
            text,
            &[
                (&PRESSURE, Self::MeanPressure as fn(f64) -> Self),
                (&FORCE, Self::Load),
                (&AREA, Self::Area),
                (&SHARE, Self::AreaFraction),
            ],
        )?;
        match found {
            Self::AreaFraction(fraction) if fraction > 1.0 => {
                Err("the contact area is at most 100% of the nominal area".to_string())
            }
            _ => Ok(found),
        }
    }
}

/// `5 MPa`.
impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = match *self {
            Self::Load(load) => quantity(load, "N", DIGITS),
            Self::MeanPressure(pressure) => quantity(pressure, "Pa", DIGITS),
            Self::Area(value) => area(value, DIGITS),
            Self::AreaFraction(fraction) => {
                // As many digits as there are, and no more: 7 % is not 7.000000000000001 %.
                let percent = format!("{:.*e}", DIGITS - 1, 100.0 * fraction);
                format!("{} %", percent.parse::<f64>().unwrap_or(100.0 * fraction))
            }
        };
        f.write_str(&text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_are_pressures_loads_and_areas() {
        for (text, at, name) in [
            ("5MPa", At::MeanPressure(5e6), "5MPa"),
            ("2e6", At::MeanPressure(2e6), "2MPa"),
            ("0.5 N/mm²", At::MeanPressure(5e5), "500kPa"),
            ("0.5N/mm^2", At::MeanPressure(5e5), "500kPa"),
            ("1.5kN", At::Load(1500.0), "1.5kN"),
            ("3uN", At::Load(3e-6), "3uN"),
            ("2mm2", At::Area(2e-6), "2mm2"),
            ("7%", At::AreaFraction(0.07), "7%"),
            ("1e99N", At::Load(1e99), "1e99N"),
        ] {
            assert_eq!(text.parse(), Ok(at), "{text}");
            assert_eq!(at.ending(), format!("_{name}"));
        }
        for bad in ["", "5", "-5MPa", "0N", "101%", "5mm", "5µm", "10 K"] {
            assert_eq!(bad.parse::<At>().is_err(), bad != "5", "{bad}");
        }
    }

    #[test]
    fn the_furthest_is_the_end() {
        let [a, b, c] = [At::MeanPressure(5e6), At::Load(100.0), At::AreaFraction(0.1)];
        assert_eq!(At::furthest(&[a, b], 1e-4), Some(ContactTarget::Load(500.0)));
        assert_eq!(At::furthest(&[c], 1e-4), Some(ContactTarget::AreaFraction(0.1)));
        assert_eq!(At::furthest(&[], 1e-4), None);
        assert!(At::check(&[a, b], true).is_ok() && At::check(&[a, c], false).is_ok());
        assert!(At::check(&[a, c], true).is_err() && At::check(&[a, b, a], false).is_err());
    }
}
