//! An updater of the crate, one call of which goes wrong.

use std::cell::Cell;
use std::panic::resume_unwind;

use asperity::contact::ContactSequence;
use asperity::updater::{LinearUpdater, Method, Schur, Solution, WindowCost, WindowFactor};
use asperity::{Error, Problem};

/// What happens at the call.
#[derive(Debug, Clone, Copy)]
pub(super) enum Fault {
    /// An error, of a method that can return one.
    Refuse,
    /// A panic before the updater is asked.
    PanicBefore,
    /// A panic once it has answered.
    PanicAfter,
    /// The call is not passed on.
    Forget,
    /// Another value in place of every number of an answer (of one kind; of all methods that give such).
    Each(Part, fn(f64) -> f64),
    /// The same in place of the last number only.
    Last(Part, fn(f64) -> f64),
    /// Answers for so many nodes more or fewer.
    Length(isize),
}

/// Numbers of an answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Part {
    Pressure,
    Rate,
    Schur,
    RowSums,
}

/// The error of [`Fault::Refuse`], which no part of the crate makes.
pub(super) const REFUSED: Error = Error::FactorizationFailed { nodes: 123_456_789 };

pub(super) fn is_refusal(error: &Error) -> bool {
    matches!(error, Error::FactorizationFailed { nodes: 123_456_789 })
}

/// Counts all calls and spoils one.
#[derive(Debug)]
pub(super) struct Failing<U> {
    inner: U,
    fault: Fault,
    /// Which call it is, from 0.
    at: Cell<usize>,
    calls: Cell<usize>,
    /// The method that the fault struck.
    pub(super) struck: Cell<Option<&'static str>>,
}

impl<U> Failing<U> {
    pub(super) fn new(inner: U, fault: Fault, at: usize) -> Self {
        Self { inner, fault, at: Cell::new(at), calls: Cell::new(0), struck: Cell::new(None) }
    }

    /// How many calls there were.
    pub(super) fn calls(&self) -> usize {
        self.calls.get()
    }

    /// Spoils the call that comes `ahead` calls after the next one.
    pub(super) fn arm(&self, ahead: usize) {
        self.at.set(self.calls() + ahead);
    }

    /// Whether this call is the one, of a method to which the fault can happen.
    fn strikes(&self, method: &'static str) -> bool {
        let call = self.calls.get();
        self.calls.set(call + 1);
        let possible = match (self.fault, method) {
            (Fault::PanicBefore | Fault::PanicAfter, _) => true,
            (_, "window_cost" | "bytes") => false,
            (Fault::Refuse, _) => true,
            (Fault::Forget, _) => method != "solve" && method != "watch",
            (
                Fault::Each(Part::Pressure | Part::Rate, _)
                | Fault::Last(Part::Pressure | Part::Rate, _),
                _,
            ) => method == "solve",
            (Fault::Each(..) | Fault::Last(..), _) => method == "watch",
            (Fault::Length(_), _) => method == "solve" || method == "watch",
        };
        let strikes = possible && call == self.at.get();
        if strikes {
            self.struck.set(Some(method));
        }
        strikes
    }

    /// A call that may fail: `work` is what the updater does. The fault, if its answer is to be spoilt.
    fn call(
        &mut self,
        method: &'static str,
        work: impl FnOnce(&mut U) -> Result<(), Error>,
    ) -> Result<Option<Fault>, Error> {
        if !self.strikes(method) {
            return work(&mut self.inner).map(|()| None);
        }
        match self.fault {
            Fault::Refuse => Err(REFUSED),
            Fault::Forget => Ok(None),
            // Without the hook that prints a message.
            Fault::PanicBefore => resume_unwind(Box::new(())),
            Fault::PanicAfter => {
                let _ = work(&mut self.inner);
                resume_unwind(Box::new(()))
            }
            fault => work(&mut self.inner).map(|()| Some(fault)),
        }
    }

    /// A question that cannot fail.
    fn ask<T>(&self, method: &'static str, answer: impl FnOnce(&U) -> T) -> T {
        if self.strikes(method) {
            resume_unwind(Box::new(()));
        }
        answer(&self.inner)
    }
}

/// Spoils all numbers or the last one.
fn change(fault: Fault, values: &mut [f64]) {
    match fault {
        Fault::Each(_, change) => values.iter_mut().for_each(|value| *value = change(*value)),
        Fault::Last(_, change) => {
            values.iter_mut().rev().take(1).for_each(|value| *value = change(*value))
        }
        _ => {}
    }
}

fn spoil_schur(fault: Fault, schur: &mut Schur) {
    match fault {
        Fault::Length(more) => {
            let size = schur.size().saturating_add_signed(more);
            // What is in it is unspecified.
            let _ = schur.resize(size);
            schur.matrix_mut().fill_with_identity();
        }
        Fault::Each(Part::RowSums, _) | Fault::Last(Part::RowSums, _) => {
            change(fault, schur.row_sums_mut());
        }
        Fault::Each(_, spoilt) => schur.matrix_mut().apply(|value| *value = spoilt(*value)),
        Fault::Last(_, spoilt) => {
            let last = schur.size() - 1;
            let mut matrix = schur.matrix_mut();
            // Column and row of the node.
            for k in 0..=last {
                matrix[(last, k)] = spoilt(matrix[(last, k)]);
            }
        }
        _ => {}
    }
}

fn spoil_solution(fault: Fault, solution: &mut Solution) {
    match fault {
        Fault::Length(more) => {
            for values in [&mut solution.pressure, &mut solution.rate] {
                values.resize(values.len().saturating_add_signed(more), 1.0);
            }
        }
        Fault::Each(Part::Rate, _) | Fault::Last(Part::Rate, _) => {
            change(fault, &mut solution.rate);
        }
        _ => change(fault, &mut solution.pressure),
    }
}

impl<U: LinearUpdater> LinearUpdater for Failing<U> {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        let spoilt = self.call("watch", |inner| inner.watch(problem, contact, nodes, schur))?;
        if let Some(fault) = spoilt {
            spoil_schur(fault, schur);
        }
        Ok(())
    }

    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        touched: &WindowFactor,
    ) -> Result<(), Error> {
        self.call("join", |inner| inner.join(problem, contact, touched)).map(drop)
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let spoilt =
            self.call("solve", |inner| inner.solve(problem, contact, count, approach, solution))?;
        match spoilt {
            // An empty answer has nothing to spoil.
            Some(fault) if count == 0 && !matches!(fault, Fault::Length(1..)) => {
                self.struck.set(None);
            }
            Some(fault) => spoil_solution(fault, solution),
            None => {}
        }
        Ok(())
    }

    fn truncate(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
        self.call("truncate", |inner| inner.truncate(problem, contact)).map(drop)
    }

    fn release(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        node: usize,
        position: usize,
    ) -> Result<(), Error> {
        self.call("release", |inner| inner.release(problem, contact, node, position)).map(drop)
    }

    fn window_cost(&self) -> WindowCost {
        self.ask("window_cost", U::window_cost)
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        self.ask("bytes", |inner| inner.bytes(contact, watched))
    }

    /// Iterations are asked as an updater is: only so do their calls come by here.
    fn method(&self) -> Method {
        match self.inner.method() {
            Method::Iterations(_) => Method::Factor,
            method => method,
        }
    }

    fn make_room(&mut self, problem: &Problem, bytes: usize) -> Result<(), Error> {
        self.call("make_room", |inner| inner.make_room(problem, bytes)).map(drop)
    }
}
