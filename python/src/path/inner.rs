//! A path with its states, live or from a record.

use std::sync::Arc;
use std::time::{Duration, Instant};

use asperity::loading::{self, LoadingBuilder, LoadingEnd};
use asperity::record::LoadingRecord;
use asperity::updater::{ConjugateGradient, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{ContactEvent, ContactTarget, Error, InfluenceKernel, LoadingSolver, LoadingState};

use super::Engine;

/// An updater of any kind.
type AnyUpdater = Box<dyn LinearUpdater>;

/// The solver of the linear systems.
#[derive(Clone, Copy)]
pub(super) enum Updater {
    Auto,
    Cholesky,
    Iterative,
}

impl Updater {
    pub(super) const WORDS: [(&'static str, Self); 3] =
        [("auto", Self::Auto), ("cholesky", Self::Cholesky), ("iterative", Self::Iterative)];

    fn make(self) -> AnyUpdater {
        match self {
            Self::Auto => Box::new(Handover::new()),
            Self::Cholesky => Box::new(RecursiveCholesky::new()),
            Self::Iterative => Box::new(ConjugateGradient::new()),
        }
    }
}

/// A kernel that a path is made with again.
pub(super) type Kernel = Box<dyn InfluenceKernel + Send + Sync>;

/// With what a path is computed.
#[derive(Clone, Copy)]
pub(super) struct Means {
    pub(super) updater: Updater,
    pub(super) memory_budget: Option<usize>,
}

impl Means {
    pub(super) fn give(self, builder: LoadingBuilder<'_>) -> LoadingBuilder<'_, AnyUpdater> {
        let builder = builder.updater(self.updater.make());
        match self.memory_budget {
            Some(bytes) => builder.memory_budget(bytes),
            None => builder,
        }
    }
}

/// Where the states come from.
enum Source {
    /// A path that goes on.
    Live(Box<Engine>),
    /// A record: its path as it was, for fields, and the kernel on which it goes on.
    Record { record: Box<LoadingRecord>, replay: Box<Engine>, kernel: Kernel },
}

/// A path with its states.
pub(super) struct Inner {
    source: Source,
    pub(super) history: Arc<loading::History>,
    /// Young's modulus \[Pa\] and Poisson's ratio of each elastic body, if they are known.
    pub(super) bodies: Vec<(f64, f64)>,
    pub(super) means: Means,
}

impl Inner {
    pub(super) fn live(engine: Engine, bodies: &[(f64, f64)], means: Means) -> Self {
        let history = Arc::new(loading::History::default().on(engine.layering()));
        Self { source: Source::Live(Box::new(engine)), history, bodies: bodies.to_vec(), means }
    }

    pub(super) fn of_record(
        record: LoadingRecord,
        kernel: Kernel,
        means: Means,
    ) -> Result<Self, Error> {
        let replay = Box::new(record.replay_on(&*kernel)?);
        let history = Arc::new(record.history().clone());
        let bodies = record.bodies().to_vec();
        let source = Source::Record { record: Box::new(record), replay, kernel };
        Ok(Self { source, history, bodies, means })
    }

    /// What computes fields.
    pub(super) fn engine(&self) -> &Engine {
        match &self.source {
            Source::Live(path) | Source::Record { replay: path, .. } => path,
        }
    }

    pub(super) fn engine_mut(&mut self) -> &mut Engine {
        match &mut self.source {
            Source::Live(path) | Source::Record { replay: path, .. } => path,
        }
    }

    /// Number of states that are there already.
    pub(super) fn waiting(&self) -> usize {
        match &self.source {
            Source::Live(engine) => engine.waiting(),
            Source::Record { .. } => 0,
        }
    }

    pub(super) fn end(&self) -> Option<LoadingEnd> {
        match &self.source {
            Source::Live(engine) => engine.end(),
            Source::Record { record, .. } => record.end(),
        }
    }

    pub(super) fn targets(&self) -> Vec<ContactTarget> {
        match &self.source {
            Source::Live(engine) => engine.targets(),
            Source::Record { record, .. } => record.settings().targets.clone(),
        }
    }

    /// The last state there is.
    pub(super) fn present(&self) -> Option<LoadingState> {
        self.history.states().last().copied()
    }

    /// A path that goes on, of a record made again: the factor is built anew.
    fn revive(&mut self) -> Result<&mut Engine, Error> {
        if let Source::Record { record, kernel, .. } = &self.source {
            let hardness = record.hardness_map()?;
            let builder = LoadingSolver::builder(record.heights(), &**kernel);
            let mut builder = self.means.give(builder).rule(record.settings().rule);
            for &target in &record.settings().targets {
                builder = builder.until(target);
            }
            if let Some(hardness) = &hardness {
                builder = builder.hardness_map(hardness);
            }
            self.source = Source::Live(Box::new(builder.resume(record.history())?.into_path()));
        }
        Ok(self.engine_mut())
    }

    pub(super) fn continue_to(&mut self, target: ContactTarget) -> Result<(), Error> {
        self.revive()?.continue_to(target)
    }

    /// The next state, which is kept.
    pub(super) fn next(&mut self) -> Result<Option<LoadingState>, Error> {
        if self.end().is_some() {
            return Ok(None);
        }
        let Some(state) = self.revive()?.next().transpose()? else {
            return Ok(None);
        };
        self.keep(state);
        Ok(Some(state))
    }

    fn keep(&mut self, state: LoadingState) {
        let history = Arc::make_mut(&mut self.history);
        // A limit is no event: the path goes on from the one before, and may come to the same limit again.
        if history.states().last().is_some_and(|last| last.event == ContactEvent::Limit) {
            let events = history.events().iter().copied();
            *history = events.collect::<loading::History>().on(history.layering());
        }
        history.extend([state]);
    }

    /// States up to the end, or for so long: signals are looked at in between, when no state is waiting. Whether there are more.
    pub(super) fn run_for(&mut self, time: Duration) -> Result<bool, Error> {
        let start = Instant::now();
        loop {
            if self.waiting() == 0 && start.elapsed() >= time {
                return Ok(true);
            }
            if self.next()?.is_none() {
                return Ok(false);
            }
        }
    }

    /// The record of the states so far.
    pub(super) fn record(&self) -> Result<LoadingRecord, Error> {
        match &self.source {
            Source::Live(engine) => {
                LoadingRecord::new(engine, (*self.history).clone())?.with_bodies(&self.bodies)
            }
            Source::Record { record, .. } => Ok((**record).clone()),
        }
    }

    /// The part of the path that is done, as far as the nearest target tells.
    pub(super) fn done(&self) -> f64 {
        let Some(state) = self.present() else {
            return 0.0;
        };
        if self.end().is_some() {
            return 1.0;
        }
        let contact = state.contact;
        let shares = self.targets().into_iter().map(|target| match target {
            ContactTarget::Load(load) => contact.load / load,
            ContactTarget::Approach(approach) => contact.approach / approach,
            ContactTarget::AreaFraction(fraction) => contact.contact_area_fraction / fraction,
            _ => 0.0,
        });
        shares.fold(contact.contact_area_fraction, f64::max).min(1.0)
    }
}
