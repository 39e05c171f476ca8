//! Following the path, and its files.

use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use asperity::LoadingState;
use asperity::kernel::Layering;
use asperity_report::PathTable;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::interrupt::Interrupt;
use super::job::Job;
use super::lines::{Lines, STRIDE, printed};
use super::{Solver, save};
use crate::conduction::Named;
use asperity_cli::number::{counted, scientific};
use asperity_cli::outcome::Failure;
use asperity_cli::speech;

/// A path as far as it has come, with its files.
pub(super) struct Followed {
    states: Vec<LoadingState>,
    file: PathFile,
    /// The record, and the states after which it is written.
    saves: Option<(PathBuf, usize)>,
}

impl Followed {
    /// Begins with the states that there are already.
    pub(super) fn new(
        job: &Job,
        mut file: PathFile,
        save_every: Option<NonZeroUsize>,
    ) -> Result<Self, Failure> {
        for state in job.begun() {
            file.write(state)?;
        }
        let record = job.record().map(Path::to_path_buf);
        Ok(Self {
            states: job.begun().to_vec(),
            file,
            saves: record.zip(save_every.map(usize::from)),
        })
    }

    /// Runs the path to its end, or until it is asked to stop, writing each state as it comes.
    pub(super) fn follow(
        &mut self,
        job: &Job,
        solver: &mut Solver,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let bar = bar();
        let start = Instant::now();
        let mut ended = Ok(());
        interrupt.wait();
        while ended.is_ok()
            && !interrupt.is_asked()
            && let Some(state) = solver.next()
        {
            ended = state.map_err(|error| Failure::new("the path broke off", error)).and_then(
                |state| {
                    if state.step.is_multiple_of(STRIDE) {
                        let progress = job.progress(&state.contact);
                        bar.set_position((100.0 * progress.done) as u64);
                        let load = scientific(state.contact.load, 3);
                        let left = progress.left(start.elapsed());
                        bar.set_message(format!(
                            "{}, W = {load} N{left}",
                            counted(state.contact.contact_nodes, "node")
                        ));
                    }
                    self.add(state, job, solver)
                },
            );
        }
        bar.finish_and_clear();
        ended
    }

    fn add(&mut self, state: LoadingState, job: &Job, solver: &Solver) -> Result<(), Failure> {
        self.states.push(state);
        self.file.write(&state)?;
        match &self.saves {
            Some((name, every)) if self.states.len().is_multiple_of(*every) => {
                save(name, job, solver, &self.states, &[]).map(|_| ())
            }
            _ => Ok(()),
        }
    }

    /// All states, and their file.
    pub(super) fn end(self) -> (Vec<LoadingState>, PathFile) {
        (self.states, self.file)
    }
}

/// A bar for progress in percent, unless people want none.
pub(super) fn bar() -> ProgressBar {
    let bar = ProgressBar::new(100);
    if let Ok(style) =
        ProgressStyle::with_template("{wide_bar:.blue} {percent:>3} %  {elapsed}  {msg}")
    {
        bar.set_style(style.progress_chars("━╸─"));
    }
    if speech::is_quiet() {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// The file `path.csv`: one line for each state.
pub(super) struct PathFile {
    table: PathTable,
    /// The conductances that were asked for, and of which body.
    conductions: Vec<Named>,
    body: Layering,
    lines: Lines,
}

impl PathFile {
    /// Begins the file in a directory, in place of one that may be there from another path.
    pub(super) fn create(
        directory: &Path,
        table: PathTable,
        (conductions, body): (Vec<Named>, Layering),
    ) -> Result<Self, Failure> {
        let mut header = PathTable::HEADER.to_string();
        for (name, _) in &conductions {
            header += &format!(",{name}");
        }
        let lines = Lines::create(directory, &header)?;
        Ok(Self { table, conductions, body, lines })
    }

    /// The whole file at once, in place of the one that is there.
    pub(super) fn write_whole(
        directory: &Path,
        table: PathTable,
        conductions: (Vec<Named>, Layering),
        (states, is_whole): (&[LoadingState], bool),
    ) -> Result<(), Failure> {
        let mut file = Self::create(directory, table, conductions)?;
        states.iter().try_for_each(|state| file.write(state))?;
        file.finish(is_whole).map(drop)
    }

    /// Adds a state.
    fn write(&mut self, state: &LoadingState) -> Result<(), Failure> {
        let failed = |error| Failure::writing(self.lines.part(), error);
        let mut line = self.table.line(state).map_err(failed)?;
        for (_, conduction) in &self.conductions {
            let conductance = conduction.of(&state.contact, self.body).map_err(failed)?;
            // Writing to a text cannot fail.
            let _ = write!(line, ",{}", printed(conductance));
        }
        self.lines.add(&line)
    }

    /// Ends the file, and gives it its name if it is that of a whole path.
    pub(super) fn finish(self, is_whole: bool) -> Result<PathBuf, Failure> {
        self.lines.finish(is_whole)
    }
}
