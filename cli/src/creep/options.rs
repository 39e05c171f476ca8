//! The command line of `asperity creep`.

use std::path::PathBuf;

use asperity::patches::Connectivity;
use clap::Args;

use crate::leak::PerhapsFluid;
use crate::path::fields::Format;
use crate::values::{FORCE, LENGTH, SHARE, TIME};

/// Contact of viscoelastic bodies over time, from a recorded path: creep under a load, relaxation at an approach, any
/// history
///
/// The bodies relax as E(t)/E0 = 1 - sum of g (1 - exp(-t/tau)), E0 being the modulus E* of the path. While the
/// effective load grows, everything is in closed form from the path. Where it recedes, contact is stepped
/// in time, and the remaining error of the steps is measured and printed. Writes creep.csv (time,
/// effective_load, load, approach, contact_area_fraction, mean_gap), creep.png (area, mean gap and load over time, with
/// the times at which the contact percolates and its last channel closes), touch_times.png (when each node touched),
/// and for a load that is held creep_cycles.csv and creep_cycles.png (loops, and the energy lost in cycles of load
/// against their frequency), and with the options of a fluid leak_over_time.csv and leak_over_time.png.
#[derive(Debug, Args)]
pub(crate) struct Options {
    /// File that `asperity path --record` has written
    #[arg(value_name = "FILE.npz")]
    pub(super) record: PathBuf,

    /// Prony series: for each term a relaxation time, in seconds or as 1d, and the part of E0 that relaxes with it; if
    /// the parts add up to 1, the body flows
    #[arg(long, value_name = "TAU,G", num_args = 1.., required = true, value_parser = term)]
    pub(super) prony: Vec<(f64, f64)>,

    /// Load put on at t = 0 and held
    #[arg(long, value_name = "NEWTONS", value_parser = FORCE.positive(), conflicts_with_all = ["approach", "history"], required_unless_present_any = ["approach", "history"])]
    pub(super) load: Option<f64>,

    /// Approach from first touch, taken at t = 0 and held: the load relaxes
    #[arg(long, value_name = "METRES", value_parser = LENGTH.positive(), conflicts_with = "history")]
    pub(super) approach: Option<f64>,

    /// Load or approach over time: a table with the columns `time,load` or `time,approach`, linear between its lines; a
    /// time given twice is a jump. Units may stand in the first line, `load [kN]`, or behind numbers; cells end at
    /// commas, semicolons or tabs
    #[arg(long, value_name = "FILE.csv")]
    pub(super) history: Option<PathBuf>,

    /// Time in which --load or --approach is put on [default: at once]
    #[arg(long, value_name = "SECONDS", value_parser = TIME.positive(), conflicts_with = "history")]
    pub(super) ramp: Option<f64>,

    /// Time of the last state [default: the last line of --history, or 100 times the longest time of the terms of
    /// --prony that relax, behind the end of --ramp]
    #[arg(long, value_name = "SECONDS", value_parser = TIME.positive())]
    pub(super) time: Option<f64>,

    /// Least number of steps from one corner of the history to the next, and of lines in creep.csv
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(super) steps: u32,

    /// Amplitude of the load cycles around --load whose lost energy is drawn against frequency [default: a fifth of
    /// --load]
    #[arg(long, value_name = "NEWTONS", value_parser = FORCE.positive(), requires = "load", conflicts_with_all = ["approach", "history"])]
    pub(super) cycle_amplitude: Option<f64>,

    /// Nodes that share only a corner belong to one patch too; channels pass through sides of cells either way
    #[arg(long)]
    pub(super) corners: bool,

    /// Also write pressure and gap at the last time
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub(super) fields: Option<Format>,

    /// Number of fields of the path that are summed to the pressure: more are more exact
    #[arg(long, value_name = "N", default_value_t = 40, requires = "fields", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) pieces: u32,

    /// Print one JSON object: the last state with time, load, effective_load, approach, contact_nodes,
    /// contact_area_fraction and mean_gap; method, step_error, recedes, enough_until, states (their number), fluidity;
    /// percolates_x, percolates_y, seals_x, seals_y (seconds, or null); cycles, or no_cycles (why there are none); leaks,
    /// with a fluid; warnings. Files are written only if --out is given
    #[arg(long)]
    pub(super) json: bool,

    /// Directory for the files, created if it does not exist [default: out]
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,

    #[command(flatten, next_help_heading = "Leak over time, while contact grows")]
    pub(super) fluid: PerhapsFluid,
}

impl Options {
    pub(super) fn connectivity(&self) -> Connectivity {
        if self.corners { Connectivity::Eight } else { Connectivity::Four }
    }
}

/// A term of the series.
fn term(text: &str) -> Result<(f64, f64), String> {
    let (time, share) = text.split_once(',').ok_or("a term is TAU,G: a time and a part")?;
    let (time, share) = (TIME.positive()(time)?, SHARE.not_negative()(share)?);
    if (0.0..=1.0).contains(&share) {
        Ok((time, share))
    } else {
        Err("the part of a term must be between 0 and 1".to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::term;

    #[test]
    fn a_term_is_a_time_and_a_part() {
        assert_eq!(term("0.1,0.5"), Ok((0.1, 0.5)));
        assert_eq!(term("1e3, 1"), Ok((1e3, 1.0)));
        assert_eq!(term("2h,0.5"), Ok((7200.0, 0.5)));
        assert_eq!(term("2h,50%"), Ok((7200.0, 0.5)));
        for bad in
            ["", "1", "1;2", "0,0.5", "-1,0.5", "1,-0.1", "1,1.1", "1,nan", "inf,0.5", "1,2,3"]
        {
            assert!(term(bad).is_err(), "{bad}");
        }
    }
}
