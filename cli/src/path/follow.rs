//! Following the path, and its files.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::Write as _;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use asperity::LoadingState;
use asperity::kernel::Layering;
use asperity_report::PathTable;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::interrupt::Interrupt;
use super::job::Job;
use super::{Solver, save};
use crate::conduction::Named;
use asperity_cli::number::{counted, scientific};
use asperity_cli::outcome::Failure;
use asperity_cli::speech;

/// States between two looks at the progress bar and two visits to the disk.
const STRIDE: usize = 64;

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
        let bar = ProgressBar::new(100);
        let start = Instant::now();
        if let Ok(style) =
            ProgressStyle::with_template("{wide_bar:.blue} {percent:>3} %  {elapsed}  {msg}")
        {
            bar.set_style(style.progress_chars("━╸─"));
        }
        if speech::is_quiet() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        let mut ended = Ok(());
        interrupt.wait();
        while ended.is_ok()
            && !interrupt.is_asked()
            && let Some(state) = solver.next()
        {
            ended = state.map_err(|error| Failure::new("the path broke off", error)).and_then(
                |state| {
                    if state.step.is_multiple_of(STRIDE) {
                        let progress = job.progress(&state);
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

/// The file `path.csv`: one line for each state. While it is written its name is `path.csv.part`, and what it holds
/// are whole lines.
pub(super) struct PathFile {
    table: PathTable,
    /// The conductances that were asked for, and of which body.
    conductions: Vec<Named>,
    body: Layering,
    name: PathBuf,
    part: PathBuf,
    output: File,
    /// Lines that are not in the file yet, and their number.
    lines: String,
    waiting: usize,
}

impl PathFile {
    /// Begins the file in a directory, in place of one that may be there from another path.
    pub(super) fn create(
        directory: &Path,
        table: PathTable,
        (conductions, body): (Vec<Named>, Layering),
    ) -> Result<Self, Failure> {
        let (name, part) = (directory.join("path.csv"), directory.join("path.csv.part"));
        let begin = || {
            match fs::remove_file(&name) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(error),
                _ => {}
            }
            File::create(&part)
        };
        let output = begin().map_err(|error| Failure::writing(&part, error))?;
        let mut lines = PathTable::HEADER.to_string();
        for (name, _) in &conductions {
            lines += &format!(",{name}");
        }
        lines.push('\n');
        Ok(Self { table, conductions, body, name, part, output, lines, waiting: 0 })
    }

    /// The whole file at once, in place of the one that is there.
    pub(super) fn write_whole(
        directory: &Path,
        table: PathTable,
        conductions: (Vec<Named>, Layering),
        states: &[LoadingState],
    ) -> Result<(), Failure> {
        let mut file = Self::create(directory, table, conductions)?;
        states.iter().try_for_each(|state| file.write(state))?;
        file.finish().map(drop)
    }

    /// Adds a state.
    fn write(&mut self, state: &LoadingState) -> Result<(), Failure> {
        let line = self.table.line(state).map_err(|error| Failure::writing(&self.part, error))?;
        self.lines += &line;
        for (_, conduction) in &self.conductions {
            let conductance = conduction.of(&state.contact, self.body);
            let conductance = conductance.map_err(|error| Failure::writing(&self.part, error))?;
            self.lines.push(',');
            if let Some(conductance) = conductance {
                // Writing to a text cannot fail.
                let _ = write!(self.lines, "{conductance:e}");
            }
        }
        self.lines.push('\n');
        self.waiting += 1;
        if self.waiting == STRIDE {
            self.flush().map_err(|error| Failure::writing(&self.part, error))?;
        }
        Ok(())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.output.write_all(self.lines.as_bytes())?;
        self.lines.clear();
        self.waiting = 0;
        Ok(())
    }

    /// Ends the file, and gives it its name.
    pub(super) fn finish(mut self) -> Result<PathBuf, Failure> {
        self.flush()
            .and_then(|()| fs::rename(&self.part, &self.name))
            .map_err(|error| Failure::writing(&self.part, error))?;
        Ok(self.name)
    }
}
