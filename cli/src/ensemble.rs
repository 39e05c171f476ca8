//! `asperity path --seeds A..B`: a path for each of many generated surfaces, a folder for each.
//!
//! A folder is there whole or not at all: it is written under another name, and renamed at the end. What is there is
//! skipped, so that a job that was killed is simply started again, and several machines may share the work.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::OnceLock;
use std::time::{SystemTime, UNIX_EPOCH};

use asperity_cli::outcome::Failure;
use clap::Args;

/// Options of one path.
const OF_ONE_PATH: [&str; 4] = ["surface", "seed", "resume", "record"];

/// Many surfaces in place of one.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct Ensemble {
    /// Follow a path for each seed from A to B, in DIR/seed_N; folders that are there are skipped
    #[arg(long, value_name = "A..B", conflicts_with_all = OF_ONE_PATH, help_heading = "Many surfaces")]
    pub(crate) seeds: Option<Seeds>,

    /// Only the K-th of N equal shares of the seeds, for job arrays; K counts from 0 or from 1
    #[arg(long, value_name = "K/N", requires = "seeds", conflicts_with_all = OF_ONE_PATH, help_heading = "Many surfaces")]
    task: Option<Task>,
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
    /// The first seed of this task, how far apart its seeds are, and the last one that may be one.
    fn span(&self) -> Option<(u64, u64, u64)> {
        let Seeds { first, last } = self.seeds?;
        let (which, of) = self.task.map_or((0, 1), |task| (task.which % task.of, task.of));
        let first = first.checked_add(which)?;
        (first <= last).then_some((first, of, last))
    }

    /// The seeds of this task, in order.
    pub(crate) fn seeds_of_task(&self) -> impl Iterator<Item = u64> {
        let span = self.span();
        let next = move |seed: &u64| {
            let (_, step, last) = span?;
            seed.checked_add(step).filter(|seed| *seed <= last)
        };
        std::iter::successors(span.map(|(first, ..)| first), next)
    }

    /// How many there are.
    pub(crate) fn count(&self) -> u128 {
        self.span().map_or(0, |(first, step, last)| u128::from((last - first) / step) + 1)
    }

    /// Those of them whose folders are there: found by what is in the folder, however many seeds there may be.
    pub(crate) fn there(&self, out: &Path) -> Result<BTreeSet<u64>, Failure> {
        let failed = |error| Failure::new(format!("cannot read {}", out.display()), error);
        let (Some((first, step, last)), true) = (self.span(), out.is_dir()) else {
            return Ok(BTreeSet::new());
        };
        let mut there = BTreeSet::new();
        for entry in std::fs::read_dir(out).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let name = entry.file_name();
            let seed = name.to_str().and_then(|name| name.strip_prefix("seed_"));
            let seed = seed.and_then(|seed| seed.parse::<u64>().ok());
            let is_mine = |seed: &u64| {
                let in_span = (first..=last).contains(seed) && (seed - first).is_multiple_of(step);
                in_span && Member::new(*seed, out).folder.is_dir()
            };
            there.extend(seed.filter(is_mine));
        }
        Ok(there)
    }
}

impl Member {
    /// The path of a seed, in its folder.
    pub(crate) fn new(seed: u64, out: &Path) -> Self {
        Self { seed, folder: out.join(format!("seed_{seed}")) }
    }

    /// Where the files are written before the folder gets its name.
    pub(crate) fn unfinished(&self) -> PathBuf {
        // On several machines processes may have one number.
        static BEGUN: OnceLock<u128> = OnceLock::new();
        let now = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_nanos());
        let begun = BEGUN.get_or_init(now);
        let name = format!("seed_{}.{}.{begun}.unfinished", self.seed, std::process::id());
        self.folder.with_file_name(name)
    }

    /// Removes what is not finished.
    pub(crate) fn abandon(&self) -> Result<(), Failure> {
        let unfinished = self.unfinished();
        std::fs::remove_dir_all(&unfinished)
            .map_err(|error| Failure::new(format!("cannot remove {}", unfinished.display()), error))
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
