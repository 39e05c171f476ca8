//! How a path is followed: with which updater, window, rule, limit and number of threads.

use std::sync::OnceLock;

use asperity::loading::{History, LoadingBuilder, LoadingEnd};
use asperity::updater::{ConjugateGradient, Dense, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{ContactRule, Error, LoadingSolver, LoadingState};
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::draw::Draw;
use crate::limits::Limit;
use crate::problem::Sample;
use crate::verdict::{Violation, ensure};

/// Who solves the linear systems.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Solver {
    Cholesky,
    Dense,
    /// A factor that gives way to iterations when so many bytes beside the grid are used up; never, if that is `None`.
    Handover(Option<usize>),
    Iterations,
}

/// How a path is followed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Variant {
    pub(crate) solver: Solver,
    pub(crate) window: Option<usize>,
    pub(crate) rule: ContactRule,
    pub(crate) limit: Limit,
    /// Threads of the first run, and of one more that has to give the same bits.
    pub(crate) threads: (usize, usize),
}

impl Variant {
    /// To full contact, by default.
    pub(crate) const REFERENCE: Self = Self {
        solver: Solver::Cholesky,
        window: None,
        rule: ContactRule::FirstContact,
        limit: Limit::None,
        threads: (1, 1),
    };

    /// Draws any; what is no factor only where that is said.
    pub(crate) fn draw(draw: &mut Draw<'_>, iterations: bool) -> Self {
        let seam = Some(draw.whole(0, 60) * 2048);
        let solver = match iterations {
            false => draw.one_of(Solver::Cholesky, &[Solver::Dense, Solver::Handover(None)]),
            true => draw.one_of(
                Solver::Iterations,
                &[Solver::Handover(seam), Solver::Cholesky, Solver::Dense],
            ),
        };
        let window = match draw.whole(0, 2) {
            0 => None,
            1 => Some(draw.whole(1, 8)),
            _ => Some(draw.whole(1, 100)),
        };
        let rule = match draw.whole(0, 4) {
            0 => ContactRule::ApproximateOrder,
            _ => ContactRule::FirstContact,
        };
        Self {
            solver,
            window,
            rule,
            limit: Limit::None,
            threads: (draw.whole(1, 3), draw.whole(1, 3)),
        }
    }

    /// Whether states are exact to rounding.
    pub(crate) fn is_exact(&self) -> bool {
        matches!(self.solver, Solver::Cholesky | Solver::Dense | Solver::Handover(None))
    }

    fn updater(&self) -> Box<dyn LinearUpdater> {
        match self.solver {
            Solver::Cholesky => Box::new(RecursiveCholesky::new()),
            Solver::Dense => Box::new(Dense::new()),
            Solver::Handover(_) => Box::new(Handover::new()),
            Solver::Iterations => Box::new(ConjugateGradient::new()),
        }
    }

    fn builder<'a>(
        &self,
        sample: &'a Sample,
    ) -> Result<LoadingBuilder<'a, Box<dyn LinearUpdater>>, Error> {
        let builder = sample.path().updater(self.updater()).rule(self.rule);
        let builder = match self.window {
            Some(nodes) => builder.window_size(nodes),
            None => builder,
        };
        let builder = match self.solver {
            Solver::Handover(Some(bytes)) => {
                // What the grid takes is only known of a path.
                let empty = sample.path().build()?;
                builder.memory_budget(empty.bytes() + bytes)
            }
            _ => builder,
        };
        Ok(self.limit.set(builder))
    }

    /// Follows the path, from its beginning or behind earlier states, and then lets `look` ask it for more.
    pub(crate) fn run<T: Send>(
        &self,
        sample: &Sample,
        earlier: &[LoadingState],
        look: impl FnOnce(&mut Path, &[LoadingState]) -> Result<T, Violation> + Send,
    ) -> Result<Run<T>, Violation> {
        pool(self.threads.0)?.install(|| self.run_here(sample, earlier, look))
    }

    /// The same bits with another number of threads.
    pub(crate) fn check_threads(
        &self,
        sample: &Sample,
        earlier: &[LoadingState],
        states: &[LoadingState],
    ) -> Result<(), Violation> {
        if self.threads.0 == self.threads.1 {
            return Ok(());
        }
        let other = Self { threads: (self.threads.1, self.threads.0), ..*self };
        let run = other.run(sample, earlier, |_, _| Ok(()))?;
        let same = match &run {
            Run::Refused(_) => states.is_empty(),
            Run::Followed { states: others, .. } => others == states,
        };
        ensure!(same, "another number of threads gives other states");
        Ok(())
    }

    fn run_here<T>(
        &self,
        sample: &Sample,
        earlier: &[LoadingState],
        look: impl FnOnce(&mut Path, &[LoadingState]) -> Result<T, Violation>,
    ) -> Result<Run<T>, Violation> {
        let built = self.builder(sample).and_then(|builder| {
            if earlier.is_empty() {
                builder.build()
            } else {
                let history: History = earlier.iter().copied().collect();
                builder.resume(&history)
            }
        });
        let mut path = match built {
            Ok(path) => path,
            Err(error) => return Ok(Run::Refused(error)),
        };
        // Nodes may leave and touch again, but not so often.
        let most = 100 * (path.grid().nodes() + 10);
        let mut states = Vec::new();
        let mut failure = None;
        for state in path.by_ref() {
            match state {
                Ok(state) => states.push(state),
                Err(error) => failure = Some(error),
            }
            if states.len() > most {
                return Err(Violation::new(format!("{most} events, and no end of them")));
            }
        }
        if path.next().is_some() {
            return Err(Violation::new("a path goes on behind its end"));
        }
        let more = look(&mut path, &states)?;
        Ok(Run::Followed { end: path.end(), states, failure, more })
    }
}

/// A path with whichever updater.
pub(crate) type Path = LoadingSolver<Box<dyn LinearUpdater>>;

/// What has become of a path.
pub(crate) enum Run<T> {
    /// It was never begun.
    Refused(Error),
    Followed {
        states: Vec<LoadingState>,
        failure: Option<Error>,
        end: Option<LoadingEnd>,
        more: T,
    },
}

/// One to three threads, which are started once.
fn pool(threads: usize) -> Result<&'static ThreadPool, Violation> {
    static POOLS: [OnceLock<Option<ThreadPool>>; 3] = [const { OnceLock::new() }; 3];
    let pool = POOLS[(threads - 1).min(2)]
        .get_or_init(|| ThreadPoolBuilder::new().num_threads(threads).build().ok());
    pool.as_ref().ok_or_else(|| Violation::new(format!("{threads} threads could not be started")))
}
