//! `asperity slip`: what a tangential load does to the contact of a record.
//!
//! Prints the state under the load and the cycle, and writes `slip.csv`, `cycles.csv`, `iwan.csv`, `slip.png`,
//! `stick_map.png` and `wear_map.png`; with `--history` also `history.csv` and `history.png`.

mod charts;
mod history;
mod joint;
mod maps;
mod table;
mod words;

use std::path::{Path, PathBuf};

use asperity::bed::Bed;
use asperity::record::LoadingRecord;
use asperity_cli::outcome::{self, Failure, Outcome};
use asperity_cli::{answer, panel, speech};
use clap::{ArgGroup, Args};

use crate::earlier::{self, Earlier};
use crate::material::Material;
use crate::values::{FORCE, SHARE, positive};
use history::Sheared;
use joint::Joint;

/// Partial slip of a recorded contact under a tangential load: stiffness, dissipation, and which nodes slip
///
/// The joint is pressed with a load and sheared with a tangential load between -T and T. Nodes slip where the traction
/// reaches the friction limit, long before the joint slides as a whole. All of it follows from the path, without
/// another solution; only the maps take three fields of it.
///
/// Writes slip.csv (the first loading), cycles.csv (dissipation, stiffness and loss factor against amplitude), iwan.csv
/// (the joint as elements of a spring and a slider), slip.png, stick_map.png and wear_map.png.
///
/// For bodies of one material, or of Poisson's ratio 1/2 against a rigid one, stiffnesses are right within some per
/// cent; see docs/joints_that_slip.md. The dissipation is that of a cycle, and not of the first loading.
#[derive(Debug, Args)]
#[command(group(ArgGroup::new("compliance").args(["compliance_ratio", "material"])))]
pub(crate) struct Options {
    /// File that `asperity path --record` has written
    #[arg(value_name = "FILE.npz")]
    record: PathBuf,

    /// Coefficient of friction
    #[arg(long, value_name = "MU", value_parser = SHARE.positive())]
    friction: f64,

    /// Load that presses the joint [default: that of the last state]
    #[arg(long, value_name = "NEWTONS", value_parser = FORCE.positive())]
    load: Option<f64>,

    /// Tangential load T, and amplitude of the cycle [default: half of what friction bears]
    #[arg(long, value_name = "NEWTONS", value_parser = FORCE.positive())]
    amplitude: Option<f64>,

    /// Ratio of the tangential to the normal compliance of the bodies, E*/G*: (2 - ν)/(2 (1 - ν)) of one material
    #[arg(long, value_name = "KAPPA", value_parser = positive)]
    compliance_ratio: Option<f64>,

    /// One body: a name (steel, aluminium, ...) or Young's modulus in Pa and Poisson's ratio (210e9,0.3) [default: both
    /// bodies of the record, if it knows them]
    #[arg(long, value_name = "NAME|E,NU")]
    material: Option<Material>,

    /// The other body [default: rigid]
    #[arg(
        long,
        value_name = "NAME|E,NU",
        requires = "material",
        conflicts_with = "compliance_ratio"
    )]
    against: Option<Material>,

    /// Table of loads and tangential loads, with the columns load,tangential_load: the joint follows straight lines
    /// between them, from no load on. Units may stand in the first line, `load [kN]`, or behind numbers; cells end at
    /// commas, semicolons or tabs. Writes history.csv and history.png
    #[arg(long, value_name = "FILE.csv")]
    history: Option<PathBuf>,

    /// Print one JSON object with load, tangential_load, displacement, interfacial_displacement, stick_area, slip_area,
    /// stick_nodes, slipping_nodes, tangential_stiffness, dissipation, secant_stiffness, loss_factor, sliding_load,
    /// sliding_displacement, friction, compliance_ratio, dundurs_beta, history_dissipation and warnings (SI units; null
    /// where unknown), and write files only if --out is given
    #[arg(long)]
    json: bool,

    /// Directory for the files, created if it does not exist [default: out]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// The tables that are written, the last of a history.
const TABLES: [&str; 4] = ["slip.csv", "cycles.csv", "iwan.csv", "history.csv"];

/// Reads the record, says what the tangential load does, and writes the files.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if options.json {
        speech::be_quiet();
    }
    let file = options.record.display();
    let record = LoadingRecord::read_npz(&options.record)
        .map_err(|error| Failure::new(format!("cannot read {file}"), error))?;
    let bed = Bed::of_record(&record)
        .map_err(|error| Failure::new(format!("cannot shear the path of {file}"), error))?;
    let joint = Joint::new(&bed, &record, options)?;
    let directory = outcome::directory(options.out.as_deref(), options.json);
    if let (Some(history), Some(directory)) = (&options.history, directory) {
        outcome::check_input(history, directory, &TABLES)?;
    }
    let sheared =
        options.history.as_deref().map(|name| Sheared::follow(&joint, name)).transpose()?;
    if options.json {
        answer!("{}", words::object(&joint, sheared.as_ref()));
    }
    words::print(&joint, sheared.as_ref());
    match directory {
        Some(directory) => {
            let read = [Some(options.record.as_path()), options.history.as_deref()];
            let earlier = Earlier::of(&earlier::SLIP, Some(directory), &read);
            earlier.finish(write(&joint, sheared.as_ref(), directory)?)
        }
        None => Ok(()),
    }
}

fn write(joint: &Joint, sheared: Option<&Sheared>, directory: &Path) -> Result<Outcome, Failure> {
    panel::register_font()?;
    outcome::create_folder(directory)?;
    let mut outcome = Outcome::default();
    let place = |name: &str| directory.join(name);
    let [loading, cycles, elements, history] = TABLES;
    outcome.written(table::loading(joint, &place(loading)));
    outcome.written(table::cycles(joint, &place(cycles)));
    outcome.written(table::elements(joint, &place(elements)));
    outcome.written(charts::draw(joint, &place("slip.png")));
    if let Some(sheared) = sheared {
        outcome.written(table::history(sheared, &place(history)));
        outcome.written(charts::draw_history(sheared, &place("history.png")));
    }
    outcome.all_written(maps::draw(joint, directory));
    Ok(outcome)
}
