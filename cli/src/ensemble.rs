//! `asperity path --seeds A..B`: a path for each of many generated surfaces, a folder for each.
//!
//! A folder is there whole or not at all: it is written under another name, and renamed at the end. What is there is
//! skipped, so that a job that was killed is simply started again, and several machines may share the work.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;
use clap::Args;

/// Many surfaces in place of one.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct Ensemble {
    /// A path for each of these seeds, both ends included, in DIR/seed_N; what is there is skipped
    #[arg(long, value_name = "A..B", conflicts_with_all = ["surface", "seed", "resume", "record"])]
    pub(crate) seeds: Option<Seeds>,

    /// Only the K-th of N equal shares of the seeds, counted from 0 or from 1: for arrays of jobs
    #[arg(long, value_name = "K/N", requires = "seeds")]
    task: Option<Task>,

    /// Say what would be done, what memory it takes and about how long, and do nothing
    #[arg(long, requires = "seeds")]
    pub(crate) dry_run: bool,
}

/// Seeds from the first to the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Seeds {
    first: u64,
    last: u64,
}

impl FromStr for Seeds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text.split_once("..");
        let parsed = ends.map(|(first, last)| (first.parse(), last.parse()));
        match parsed {
            Some((Ok(first), Ok(last))) if first <= last => Ok(Self { first, last }),
            _ => Err("seeds are given as 1..200, both included".to_string()),
        }
    }
}

/// A share of the work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Task {
    which: u64,
    of: u64,
}

impl FromStr for Task {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/');
        let parsed = parts.map(|(which, of)| (which.parse(), of.parse()));
        match parsed {
            Some((Ok(which), Ok(of))) if of > 0 && which <= of => Ok(Self { which, of }),
            _ => Err("a task is given as K/N, K from 0 to N - 1 or from 1 to N".to_string()),
        }
    }
}

/// A seed whose path is still to be followed, and the folder for it.
pub(crate) struct Member {
    pub(crate) seed: u64,
    pub(crate) folder: PathBuf,
}

impl Ensemble {
    /// The seeds of this task whose folders are not there yet, and the number of those that are.
    pub(crate) fn members(&self, out: &Path) -> (Vec<Member>, usize) {
        let Some(seeds) = self.seeds else {
            return (Vec::new(), 0);
        };
        let is_mine = |place: u64| {
            self.task
                .is_none_or(|task| place % task.of == task.which % task.of)
        };
        let mine = (seeds.first..=seeds.last).filter(|seed| is_mine(seed - seeds.first));
        let members = mine.map(|seed| Member {
            seed,
            folder: out.join(format!("seed_{seed}")),
        });
        let (there, missing): (Vec<Member>, Vec<Member>) =
            members.partition(|member| member.folder.is_dir());
        (missing, there.len())
    }
}

impl Member {
    /// Where the files are written before the folder gets its name.
    pub(crate) fn unfinished(&self) -> PathBuf {
        let name = format!("seed_{}.{}.unfinished", self.seed, std::process::id());
        self.folder.with_file_name(name)
    }

    /// Gives the folder its name; one that another process has finished meanwhile stays.
    pub(crate) fn finish(&self) -> Result<(), Failure> {
        let unfinished = self.unfinished();
        let named = if self.folder.is_dir() {
            std::fs::remove_dir_all(&unfinished)
        } else {
            std::fs::rename(&unfinished, &self.folder)
        };
        named.map_err(|error| Failure::new(format!("cannot name {}", self.folder.display()), error))
    }
}

/// What one path will take.
pub(crate) struct Expected {
    pub(crate) nodes: f64,
    pub(crate) seconds: f64,
    pub(crate) bytes: f64,
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "about {:.0} nodes in contact, {} and {} of memory for each",
            self.nodes,
            quantity(self.seconds, "s", 2),
            quantity(self.bytes, "B", 2)
        )
    }
}
