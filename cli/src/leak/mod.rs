//! `asperity leak`: how much of a fluid leaks through the gap along a recorded path.
//!
//! Prints the leak rate at states of the path, or one JSON object, and writes `leak.csv`, `leak.png`, and for each
//! load a map of the fluid pressure and one of the flux.

mod charts;
mod fluid;
mod maps;
mod table;
mod words;

use std::path::PathBuf;

use asperity::leak::{Leak, LeakCurve, Seal};
use asperity::record::LoadingRecord;
use asperity::{LoadingPath, LoadingState, Warning};
use asperity_cli::number::quantity;
use asperity_cli::outcome::{self, Failure, Outcome};
use asperity_cli::{answer, panel, speech};
use clap::Args;

use crate::advice;
use crate::at::state_at_load;
use crate::earlier::{self, Earlier};
use crate::values::FORCE;
use fluid::Fluid;
pub(crate) use fluid::PerhapsFluid;

/// Leak rate through the gap along a recorded path: Reynolds' equation on the gap, contact closed
///
/// A fluid is pressed from one edge of the surface to the opposite one. The other two edges are closed, unless the
/// half-space is periodic. Prints the leak rate at states of the path that are chosen where it changes, up to the one
/// at which the last channel closes, and writes leak.csv and leak.png; for each --load, or else for half of that load,
/// it writes maps of the fluid pressure and of the flux.
///
/// The pressure of the fluid does not open the gap. The leak rate is that of the grid: shortly before the last channel
/// closes, a constriction of few cells decides.
#[derive(Debug, Args)]
pub(crate) struct Options {
    /// File that `asperity path --record` has written
    #[arg(value_name = "FILE.npz")]
    record: PathBuf,

    #[command(flatten)]
    fluid: Fluid,

    /// Load of a state of which fluid pressure and flux are drawn; may be given several times [default: half of
    /// the load at which the last channel closes, or the last state]
    #[arg(long, value_name = "NEWTONS", value_parser = FORCE.positive())]
    load: Vec<f64>,

    /// Number of states, 3 or more, at which the leak rate along the path is computed, among them the first, the last that
    /// leaks and the one at which the last channel closes; 0 for none but those of --load
    #[arg(long, value_name = "N", default_value_t = 40)]
    states: usize,

    /// Print one JSON object instead: the last of the loads, or of the states, and all of them in `states`; files are
    /// written only if --out is given
    #[arg(long)]
    json: bool,

    /// Directory for the files, created if it does not exist [default: out]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// A record, its path, and what leaks.
struct Work {
    record: LoadingRecord,
    path: LoadingPath,
    seal: Seal,
}

impl Work {
    fn new(options: &Options) -> Result<Self, Failure> {
        let file = options.record.display();
        let record = LoadingRecord::read_npz(&options.record)
            .map_err(|error| Failure::new(format!("cannot read {file}"), error))?;
        let failed = |error| Failure::new("cannot compute a leak", error);
        let path = record.replay().map_err(failed)?;
        let seal = options.fluid.seal()?;
        Ok(Self { record, path, seal })
    }

    /// The states at the loads asked for.
    fn states(&self, loads: &[f64]) -> Result<Vec<LoadingState>, Failure> {
        if self.record.states().is_empty() {
            return Err(Failure::request("the record holds no state"));
        }
        loads.iter().map(|load| state_at_load(&self.record, *load)).collect()
    }

    /// The state at half of the load at which the last channel closes, otherwise the last one.
    fn half_closed(&self, curve: &LeakCurve) -> Option<LoadingState> {
        match &curve.closing {
            Some(closing) => self.record.history().at_load(0.5 * closing.contact.load),
            None => self.record.states().last().copied(),
        }
    }

    fn leak(&mut self, state: &LoadingState) -> Result<Leak, Failure> {
        let what = format!("cannot compute the leak at {}", quantity(state.contact.load, "N", 6));
        self.seal.leak_at(&mut self.path, state).map_err(|error| Failure::new(what, error))
    }

    fn curve(&mut self, states: usize) -> Result<LeakCurve, Failure> {
        let history = self.record.history();
        let curve = self.seal.curve(&mut self.path, history, states);
        curve.map_err(|error| Failure::new("cannot compute the leak along the path", error))
    }
}

/// Reads the record, computes the leaks, and writes the files.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if options.json {
        speech::be_quiet();
    }
    if matches!(options.states, 1 | 2) || (options.states == 0 && options.load.is_empty()) {
        return Err(Failure::request(
            "--states takes 0, with a --load, or at least 3 states: the first, the last that leaks and the one that closes",
        ));
    }
    let mut work = Work::new(options)?;
    let mut drawn = work.states(&options.load)?;
    panel::register_font()?;
    let directory = outcome::directory(options.out.as_deref(), options.json);
    directory.map_or(Ok(()), outcome::create_folder)?;
    let earlier = Earlier::of(&earlier::LEAK, directory, &[Some(&options.record)]);
    words::print_seal(&work.record, &work.seal);

    let mut outcome = Outcome::default();
    let mut documents = Vec::new();
    let mut pressures = Vec::new();
    if options.states > 0 {
        let curve = work.curve(options.states)?;
        documents.extend(curve.points.iter().map(words::point));
        words::print_curve(&curve, &work.record, &work.seal);
        pressures.extend(curve.points.iter().map(|point| point.state.contact.mean_pressure()));
        if let Some(out) = directory {
            outcome.written(table::write(&curve, &out.join("leak.csv")));
            outcome.all_written(charts::draw(&curve, &out.join("leak.png")));
        }
        if options.load.is_empty() && directory.is_some() {
            drawn.extend(work.half_closed(&curve));
        }
    }
    for (k, state) in drawn.iter().enumerate() {
        match work.leak(state) {
            Ok(leak) => {
                words::print_leak(state, &leak, &work.seal);
                if !options.load.is_empty() {
                    pressures.push(state.contact.mean_pressure());
                    documents.push(words::leak(state, &leak));
                }
                if let Some(out) = directory {
                    let place = (out, k);
                    outcome.all_written(maps::draw(
                        &work.record,
                        (state, &leak),
                        &work.seal,
                        place,
                    ));
                }
            }
            // What was found before is not lost.
            Err(failure) => outcome.note(Err(failure)),
        }
    }
    let warning = Warning::of_pressure_drop(options.fluid.pressure_drop, pressures);
    let warning = warning.as_ref().map(advice::told);
    warning.iter().for_each(speech::warn);
    if options.json
        && let Some(document) = words::document(documents, &work.seal, warning)
    {
        answer!("{document}");
    }
    earlier.finish(outcome)
}
