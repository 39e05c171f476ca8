//! Following the path, and its file.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use asperity::LoadingState;
use indicatif::{ProgressBar, ProgressStyle};

use super::Solver;
use super::progress::Progress;
use asperity_cli::number::scientific;
use asperity_cli::outcome::Failure;

/// States between two looks at the progress bar and two visits to the disk.
const STRIDE: usize = 64;

/// Runs the path to its end, writing each state as it comes; returns all states, and how it ended.
pub(super) fn follow(
    solver: &mut Solver,
    file: &mut PathFile,
    progress: impl Fn(&LoadingState) -> Progress,
) -> (Vec<LoadingState>, Result<(), Failure>) {
    let bar = ProgressBar::new(100);
    let start = Instant::now();
    if let Ok(style) =
        ProgressStyle::with_template("{wide_bar:.blue} {percent:>3} %  {elapsed}  {msg}")
    {
        bar.set_style(style.progress_chars("━╸─"));
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    let mut states = Vec::new();
    let mut ended = Ok(());
    for state in solver {
        match state.map_err(|error| Failure::new("the path broke off", error)) {
            Ok(state) => {
                states.push(state);
                if let Err(failure) = file.write(&state) {
                    ended = Err(failure);
                    break;
                }
                if state.step.is_multiple_of(STRIDE) {
                    let progress = progress(&state);
                    bar.set_position((100.0 * progress.done) as u64);
                    let load = scientific(state.load, 3);
                    let left = progress.left(start.elapsed());
                    bar.set_message(format!("{} nodes, W = {load} N{left}", state.contact_nodes));
                }
            }
            Err(failure) => {
                ended = Err(failure);
                break;
            }
        }
    }
    bar.finish_and_clear();
    (states, ended)
}

/// The file `path.csv`: one line for each state, on the disk soon after it is known.
pub(super) struct PathFile {
    name: PathBuf,
    output: BufWriter<File>,
}

impl PathFile {
    /// Begins the file in a directory.
    pub(super) fn create(directory: &Path) -> Result<Self, Failure> {
        let name = directory.join("path.csv");
        let begin = || {
            let mut output = BufWriter::new(File::create(&name)?);
            writeln!(
                output,
                "step,ix,iy,approach,load,contact_area,contact_area_fraction,mean_gap,\
                 contact_stiffness,interfacial_stiffness"
            )?;
            Ok(output)
        };
        match begin() {
            Ok(output) => Ok(Self { name, output }),
            Err(error) => Err(failed(&name, error)),
        }
    }

    /// Adds a state. `{:e}` prints the shortest digits that read back as the same number.
    fn write(&mut self, state: &LoadingState) -> Result<(), Failure> {
        let (ix, iy) = state.node;
        // Empty where there is none: on a periodic half-space.
        let printed = |stiffness: Option<f64>| {
            stiffness.map_or_else(String::new, |stiffness| format!("{stiffness:e}"))
        };
        let line = writeln!(
            self.output,
            "{},{ix},{iy},{:e},{:e},{:e},{:e},{:e},{},{}",
            state.step,
            state.approach,
            state.load,
            state.contact_area,
            state.contact_area_fraction,
            state.mean_gap,
            printed(state.contact_stiffness),
            printed(state.interfacial_stiffness),
        );
        let done = match line {
            Ok(()) if state.step.is_multiple_of(STRIDE) => self.output.flush(),
            other => other,
        };
        done.map_err(|error| failed(&self.name, error))
    }

    /// Ends the file.
    pub(super) fn finish(mut self) -> Result<PathBuf, Failure> {
        match self.output.flush() {
            Ok(()) => Ok(self.name),
            Err(error) => Err(failed(&self.name, error)),
        }
    }
}

fn failed(name: &Path, error: std::io::Error) -> Failure {
    Failure::new(format!("cannot write {}", name.display()), error)
}
