//! The adhesion that a command line asks for.

use std::fmt;

use asperity::adhesion::Adhesion;
use asperity_cli::number::quantity;
use clap::Args;
use serde_json::{Value, json};

use crate::values::{LENGTH, PRESSURE, SURFACE_ENERGY};

/// How much the surfaces stick.
#[derive(Debug, Clone, Args)]
pub(crate) struct Sticking {
    /// Work of adhesion: the surfaces pull each other, and path.csv has the branch of pressing on, with loads below 0 at
    /// first, and with --unload that of pulling off; with it come the pull-off force and what the loop costs. Rubber on
    /// glass has 0.05 J/m² or more [default: nothing pulls]
    #[arg(long, value_name = "J/M2", value_parser = SURFACE_ENERGY.not_negative(), help_heading = "Adhesion")]
    work_of_adhesion: Option<f64>,

    /// Gap at which the pull ends [default: the shortest that the cells resolve, which is the limit of JKR on this grid]
    #[arg(long, value_name = "METRES", value_parser = LENGTH.positive(), requires = "work_of_adhesion", help_heading = "Adhesion")]
    adhesion_range: Option<f64>,

    /// Greatest pull, in the law of Maugis; its outer border is a slope as steep as the cells resolve, or ends at
    /// --adhesion-range [default: the pull falls in proportion to the gap, from 2w over the range]
    #[arg(long, value_name = "PA", value_parser = PRESSURE.positive(), requires = "work_of_adhesion", help_heading = "Adhesion")]
    cohesive_stress: Option<f64>,
}

/// The law that is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law {
    work: f64,
    range: Option<f64>,
    stress: Option<f64>,
}

impl Sticking {
    /// The law, if anything sticks.
    pub(crate) fn law(&self) -> Option<Law> {
        let (range, stress) = (self.adhesion_range, self.cohesive_stress);
        self.work_of_adhesion.map(|work| Law { work, range, stress })
    }
}

impl Law {
    /// That of a record.
    pub(crate) fn of(adhesion: Adhesion) -> Self {
        let (work, stress, range) = adhesion.given();
        Self { work, range, stress }
    }

    pub(crate) fn adhesion(self) -> Adhesion {
        let law = match self.stress {
            Some(stress) => Adhesion::maugis(self.work, stress),
            None => Adhesion::work(self.work),
        };
        self.range.into_iter().fold(law, Adhesion::range)
    }

    /// For `settings.json`.
    pub(crate) fn settings(self) -> Value {
        json!({"work": self.work, "range": self.range, "cohesive_stress": self.stress})
    }
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "w = {}", quantity(self.work, "J/m²", 4))?;
        if let Some(stress) = self.stress {
            write!(f, ", pull of {} at most", quantity(stress, "Pa", 4))?;
        }
        match (self.range, self.stress) {
            (Some(range), _) => write!(f, ", to a gap of {}", quantity(range, "m", 4)),
            (None, None) => write!(f, ", over the shortest range that the cells resolve"),
            (None, Some(_)) => Ok(()),
        }
    }
}
