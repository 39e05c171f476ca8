//! An updater some of whose answers are changed on their way.

use std::fmt;

use asperity::contact::ContactSequence;
use asperity::updater::{Left, LinearUpdater, Schur, Solution, WindowFactor};
use asperity::{Error, Problem};
use nalgebra::DMatrix;

/// A call of a [`LinearUpdater`] that can fail, with the place of its answer.
#[derive(Debug)]
#[allow(missing_docs)] // as in the trait
pub enum Call<'a> {
    Watch {
        problem: &'a Problem,
        contact: &'a ContactSequence,
        nodes: &'a [usize],
        schur: &'a mut Schur,
    },
    Join {
        problem: &'a Problem,
        contact: &'a ContactSequence,
        factor: &'a WindowFactor,
    },
    Solve {
        problem: &'a Problem,
        contact: &'a ContactSequence,
        count: usize,
        approach: f64,
        solution: &'a mut Solution,
    },
    Truncate {
        problem: &'a Problem,
        contact: &'a ContactSequence,
    },
    Release {
        problem: &'a Problem,
        contact: &'a ContactSequence,
        left: &'a [Left],
    },
    WatchBoth {
        problem: &'a Problem,
        contact: &'a ContactSequence,
        nodes: &'a [usize],
        positions: &'a [usize],
        schur: &'a mut Schur,
    },
    Relief {
        problem: &'a Problem,
        contact: &'a ContactSequence,
        nodes: &'a [usize],
        relief: &'a mut Option<DMatrix<f64>>,
    },
    SolveFor {
        problem: &'a Problem,
        contact: &'a ContactSequence,
        rhs: &'a mut [[f64; 2]],
    },
    MakeRoom {
        problem: &'a Problem,
        bytes: usize,
    },
}

impl Call<'_> {
    /// Name of the method.
    #[must_use]
    pub fn method(&self) -> &'static str {
        match self {
            Self::Watch { .. } => "watch",
            Self::Join { .. } => "join",
            Self::Solve { .. } => "solve",
            Self::Truncate { .. } => "truncate",
            Self::Release { .. } => "release",
            Self::WatchBoth { .. } => "watch_both",
            Self::Relief { .. } => "relief",
            Self::SolveFor { .. } => "solve_for",
            Self::MakeRoom { .. } => "make_room",
        }
    }

    /// Asks an updater; its answer can be changed afterwards.
    ///
    /// # Errors
    ///
    /// Those of the updater.
    pub fn ask(&mut self, updater: &mut dyn LinearUpdater) -> Result<(), Error> {
        match self {
            Self::Watch { problem, contact, nodes, schur } => {
                updater.watch(problem, contact, nodes, schur)
            }
            Self::Join { problem, contact, factor } => updater.join(problem, contact, factor),
            Self::Solve { problem, contact, count, approach, solution } => {
                updater.solve(problem, contact, *count, *approach, solution)
            }
            Self::Truncate { problem, contact } => updater.truncate(problem, contact),
            Self::Release { problem, contact, left } => updater.release(problem, contact, left),
            Self::WatchBoth { problem, contact, nodes, positions, schur } => {
                updater.watch_both(problem, contact, nodes, positions, schur)
            }
            Self::Relief { problem, contact, nodes, relief } => {
                **relief = updater.relief(problem, contact, nodes)?;
                Ok(())
            }
            Self::SolveFor { problem, contact, rhs } => updater.solve_for(problem, contact, rhs),
            Self::MakeRoom { problem, bytes } => updater.make_room(problem, *bytes),
        }
    }
}

type OnCall<U> = Box<dyn FnMut(&mut U, &mut Call<'_>) -> Result<(), Error> + Send + Sync>;
type OnBytes<U> = Box<dyn Fn(&U, (usize, usize)) -> usize + Send + Sync>;

/// An updater that passes on all that it is asked, unless a closure does something else.
///
/// What the closures have seen can be told through `state`, of which they then hold a part: an `Arc` of what it counts,
/// for example.
pub struct Altered<U, S = ()> {
    /// What is to be looked at while a path holds the updater.
    pub state: S,
    inner: U,
    on_call: OnCall<U>,
    on_bytes: OnBytes<U>,
}

impl<U: LinearUpdater> Altered<U> {
    /// As `inner` is.
    pub fn new(inner: U) -> Self {
        Self::with_state(inner, ())
    }
}

impl<U: LinearUpdater, S> Altered<U, S> {
    /// As `inner` is, with something to look at.
    pub fn with_state(inner: U, state: S) -> Self {
        Self {
            state,
            inner,
            on_call: Box::new(|inner, call| call.ask(inner)),
            on_bytes: Box::new(|inner, (contact, watched)| inner.bytes(contact, watched)),
        }
    }

    /// Does this at every call that can fail.
    #[must_use]
    pub fn on_call(
        mut self,
        on_call: impl FnMut(&mut U, &mut Call<'_>) -> Result<(), Error> + Send + Sync + 'static,
    ) -> Self {
        self.on_call = Box::new(on_call);
        self
    }

    /// Answers so to [`LinearUpdater::bytes`] of contact and watched nodes.
    #[must_use]
    pub fn on_bytes(
        mut self,
        on_bytes: impl Fn(&U, (usize, usize)) -> usize + Send + Sync + 'static,
    ) -> Self {
        self.on_bytes = Box::new(on_bytes);
        self
    }

    fn call(&mut self, mut call: Call<'_>) -> Result<(), Error> {
        (self.on_call)(&mut self.inner, &mut call)
    }
}

impl<U: fmt::Debug, S: fmt::Debug> fmt::Debug for Altered<U, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("Altered");
        shown.field("inner", &self.inner).field("state", &self.state).finish_non_exhaustive()
    }
}

impl<U: LinearUpdater, S: Send + Sync + 'static> LinearUpdater for Altered<U, S> {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        self.call(Call::Watch { problem, contact, nodes, schur })
    }

    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        factor: &WindowFactor,
    ) -> Result<(), Error> {
        self.call(Call::Join { problem, contact, factor })
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        self.call(Call::Solve { problem, contact, count, approach, solution })
    }

    fn truncate(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
        self.call(Call::Truncate { problem, contact })
    }

    fn release(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        left: &[Left],
    ) -> Result<(), Error> {
        self.call(Call::Release { problem, contact, left })
    }

    fn watch_both(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        positions: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        self.call(Call::WatchBoth { problem, contact, nodes, positions, schur })
    }

    fn relief(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
    ) -> Result<Option<DMatrix<f64>>, Error> {
        let mut relief = None;
        self.call(Call::Relief { problem, contact, nodes, relief: &mut relief })?;
        Ok(relief)
    }

    fn solve_for(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        rhs: &mut [[f64; 2]],
    ) -> Result<(), Error> {
        self.call(Call::SolveFor { problem, contact, rhs })
    }

    fn make_room(&mut self, problem: &Problem, bytes: usize) -> Result<(), Error> {
        self.call(Call::MakeRoom { problem, bytes })
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        (self.on_bytes)(&self.inner, (contact, watched))
    }
}
