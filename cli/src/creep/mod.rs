//! `asperity creep`: viscoelastic bodies, from the record of an elastic path.
//!
//! Prints how contact grows over time and when it percolates and seals, and writes `creep.csv`, `creep.png`,
//! `touch_times.png`, for a load that is held `creep_cycles.csv` and `creep_cycles.png`, and with a fluid
//! `leak_over_time.csv` and `leak_over_time.png`.

mod charts;
mod course;
mod cycles;
mod followed;
mod leaks;
mod object;
mod options;
mod table;
mod touch_times;
mod words;

use asperity::bed::Bed;
use asperity::record::LoadingRecord;
use asperity_cli::outcome::{self, Failure, Outcome};
use asperity_cli::{answer, panel, speech};

use crate::earlier::{self, Earlier};
use crate::path::fields;
use charts::Times;
use course::Task;
use cycles::Sweep;
use followed::Followed;
use leaks::Leaks;
pub(crate) use options::Options;

/// Reads the record, follows the history on it, says what happens, and writes the files.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if options.json {
        speech::be_quiet();
    }
    let file = options.record.display();
    let record = LoadingRecord::read_npz(&options.record)
        .map_err(|error| Failure::new(format!("cannot read {file}"), error))?;
    let failed = |error| Failure::new("cannot let this contact creep", error);
    let directory = outcome::directory(options.out.as_deref(), options.json);
    if let (Some(history), Some(directory)) = (&options.history, directory) {
        outcome::check_input(history, directory, &["creep.csv", "leak_over_time.csv"])?;
    }
    let task = Task::new(options)?;
    let bed = Bed::of_record(&record).map_err(failed)?;
    let followed = Followed::new(&bed, &task)?;
    let passages = followed.passages(&record, options.connectivity()).map_err(failed)?;
    let sweep = task.cycles.as_ref().map(|cycles| Sweep::new(&record, &task, cycles));
    if followed.states.is_empty() {
        return followed.whole(&bed, &task, &options.record);
    }
    let leaks = match &options.fluid.0 {
        Some(fluid) => Some(Leaks::new(&followed, &record, fluid.seal()?)?),
        None => None,
    };
    let area = record.grid().nominal_area();
    let of_leaks = leaks.as_ref().and_then(|leaks| leaks.warning(area));
    let of_cycles = sweep.as_ref().and_then(|sweep| words::coarse(sweep.as_ref().ok()?));
    let warnings: Vec<String> = of_cycles.into_iter().chain(of_leaks).collect();
    if options.json {
        let told = (leaks.as_ref(), &warnings[..]);
        answer!("{}", object::object(&task, &followed, &passages, sweep.as_ref(), told));
    }
    words::print(options, &task, &followed, &passages, sweep.as_ref());
    leaks.iter().for_each(Leaks::print);
    warnings.iter().for_each(speech::warn);
    let Some(directory) = directory else {
        return followed.whole(&bed, &task, &options.record);
    };
    panel::register_font()?;
    outcome::create_folder(directory)?;
    let earlier = Earlier::of(
        &earlier::CREEP,
        Some(directory),
        &[Some(options.record.as_path()), options.history.as_deref()],
    );
    let mut outcome = Outcome::default();
    outcome.written(table::write(&followed, &directory.join("creep.csv")));
    let times = Times::of(&followed.states, options.history.is_some());
    outcome.written(match &times {
        Some(times) => charts::draw(&followed, &passages, times, &directory.join("creep.png")),
        None => Err(Failure::request("there is nothing to draw over time: all states are at one")),
    });
    if let Some(drawn) = touch_times::draw(&record, &followed, directory) {
        outcome.written(drawn);
    }
    if let Some(leaks) = &leaks {
        outcome.written(leaks.write(directory));
        let drawn = times.and_then(|times| leaks.draw(&passages, &times, directory));
        drawn.into_iter().for_each(|drawn| outcome.written(drawn));
    }
    // Elastic bodies have no cycles.
    if let Some(Ok(sweep)) = &sweep
        && !sweep.cycles.is_empty()
    {
        outcome.written(sweep.write(&directory.join("creep_cycles.csv")));
        outcome.written(sweep.draw(&directory.join("creep_cycles.png")));
    }
    if let Some(format) = options.fields {
        let found = followed.fields(&record, &bed, options.pieces);
        match found {
            Ok(found) => {
                outcome.all_written(fields::write(&found, &record.grid(), format, (directory, "")));
            }
            Err(failure) => outcome.note(Err(failure)),
        }
    }
    outcome.note(followed.whole(&bed, &task, &options.record));
    earlier.finish(outcome)
}
