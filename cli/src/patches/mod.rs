//! `asperity patches`: what the order of contact in a record tells.
//!
//! Prints percolation, leakage and the patches at one state, and writes `patches.csv`, `patches.png`, `activation.png`,
//! `merge_tree.png` and `distributions.png`. Where nodes leave the contact, patches cannot be followed from
//! state to state: the first two and the tree are missing then.

mod activation;
mod charts;
mod distributions;
mod followed;
mod moment;
mod object;
mod table;
mod tree;
mod tree_layout;
mod words;

use std::path::PathBuf;

use asperity::patches::Connectivity;
use asperity::record::LoadingRecord;
use asperity_cli::outcome::{self, Failure, Outcome};
use asperity_cli::panel;
use asperity_cli::{answer, say, speech};
use clap::Args;

use crate::earlier::{self, Earlier};
use crate::values::{FORCE, fraction};
use followed::Followed;
use moment::Moment;

/// Contact patches along a recorded path: when the contact percolates and seals, and which patches carry the load
///
/// Prints when one patch extends from end to end of the surface along x or y, when the last channel through the gap
/// from end to end closes (from there on `asperity leak` finds no leak), when the same happens around a periodic grid,
/// and for one state the largest patch and the narrowest place of the widest channel, which any leak has to pass.
/// Writes patches.csv, patches.png, activation.png (the load at which each node touched: every contact map in one),
/// merge_tree.png and distributions.png.
#[derive(Debug, Args)]
pub(crate) struct Options {
    /// File that `asperity path --record` has written
    #[arg(value_name = "FILE.npz")]
    record: PathBuf,

    /// Load of the state that is described [default: the last state]
    // Elsewhere the option is --load.
    #[arg(long, visible_alias = "load", value_name = "NEWTONS", value_parser = FORCE.positive(), conflicts_with = "at_area_fraction")]
    at_load: Option<f64>,

    /// Contact area over nominal area of the state that is described
    #[arg(long, value_name = "F", value_parser = fraction)]
    at_area_fraction: Option<f64>,

    /// Nodes that share only a corner belong to one patch too; channels pass through sides of cells either way
    #[arg(long)]
    corners: bool,

    /// Print one JSON object instead: percolates_x, percolates_y, seals_x and seals_y (the state from which on that
    /// holds, or null), on a periodic half-space also patch_winds_x, patch_winds_y, no_channel_winds_x and
    /// no_channel_winds_y, state, patches, largest_patch, channel_x and channel_y (the narrowest place of the widest
    /// channel, or null); SI units; files are written only if --out is given
    #[arg(long)]
    json: bool,

    /// Directory for the files, created if it does not exist [default: out]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Options {
    fn connectivity(&self) -> Connectivity {
        if self.corners { Connectivity::Eight } else { Connectivity::Four }
    }
}

/// Reads the record, says what is in it, and writes the files.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if options.json {
        speech::be_quiet();
    }
    let file = options.record.display();
    let record = LoadingRecord::read_npz(&options.record)
        .map_err(|error| Failure::new(format!("cannot read {file}"), error))?;
    let connectivity = options.connectivity();
    let state = moment::state(&record, options)?;
    let followed = Followed::new(&record, connectivity);
    words::print_record(&record, connectivity);
    let moment = Moment::new(&record, state, connectivity);
    if let (true, Ok(moment)) = (options.json, &moment) {
        let object = object::of(&record, followed.as_ref().ok(), moment);
        answer!("{}", object.map_err(|error| Failure::new("cannot find the channels", error))?);
    }
    // Else there is one node, or several at one height.
    let mut events = record.history().events().iter();
    let carries = events.any(|state| state.contact.load > 0.0);
    match &followed {
        Ok(followed) => words::print_passages(&options.record, &record, followed),
        Err(error) => say!("patches cannot be followed along this path: {error}\n"),
    }
    if !carries {
        say!("no node has touched under load: no loads of activation to draw");
    }
    let mut outcome = Outcome::default();
    let mut earlier = None;
    if let Ok(moment) = &moment {
        words::print_moment(moment);
        let channels = words::print_channels(&record, moment, options.corners);
        outcome.note(channels.map_err(|error| Failure::new("cannot find the channels", error)));
    }
    if let Some(directory) = outcome::directory(options.out.as_deref(), options.json) {
        panel::register_font()?;
        outcome::create_folder(directory)?;
        earlier = Some(Earlier::of(&earlier::PATCHES, Some(directory), &[Some(&options.record)]));
        let place = |name: &str| directory.join(name);
        if let Ok(followed) = &followed {
            outcome.written(table::write(&record, followed, &place("patches.csv")));
            if carries {
                outcome.written(charts::draw(&record, followed, &place("patches.png")));
                outcome.written(tree::draw(&record, followed, &place("merge_tree.png")));
            }
        }
        if carries {
            outcome.written(activation::draw(&record, &place("activation.png")));
        }
        // First touch has no pressures.
        if let Some(moment) = moment.as_ref().ok().filter(|moment| moment.state.contact.load > 0.0)
        {
            let place = place("distributions.png");
            outcome.written(distributions::draw(&record, moment, &place));
        }
    }
    outcome.note(moment.map(|_| ()));
    match earlier {
        Some(earlier) => earlier.finish(outcome),
        None => outcome.finish(),
    }
}
