//! An updater of the crate, one call of which goes wrong.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};

use asperity::Error;
use asperity::updater::{LinearUpdater, Schur, Solution};
use asperity_testing::{Altered, Call};

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

/// An updater that spoils one call.
pub(super) type Failing<U> = Altered<U, Arc<Strike>>;

/// Passes on all calls to an updater but one, number `at` from 0.
pub(super) fn failing<U: LinearUpdater + 'static>(inner: U, fault: Fault, at: usize) -> Failing<U> {
    let strike = Arc::new(Strike {
        fault,
        at: AtomicUsize::new(at),
        calls: AtomicUsize::new(0),
        struck: Mutex::new(None),
    });
    let [calls, bytes] = [(); 2].map(|()| Arc::clone(&strike));
    Altered::with_state(inner, strike).on_call(move |inner, call| calls.call(inner, call)).on_bytes(
        move |inner, (contact, watched)| bytes.ask("bytes", || inner.bytes(contact, watched)),
    )
}

/// Methods that answer with numbers.
const ANSWERS: [&str; 4] = ["solve", "watch", "solve_for", "watch_both"];

/// Counts all calls and spoils one.
#[derive(Debug)]
pub(super) struct Strike {
    fault: Fault,
    /// Which call it is, from 0.
    at: AtomicUsize,
    calls: AtomicUsize,
    /// The method that the fault struck.
    struck: Mutex<Option<&'static str>>,
}

impl Strike {
    /// How many calls there were.
    pub(super) fn calls(&self) -> usize {
        self.calls.load(Relaxed)
    }

    /// The method that the fault struck.
    pub(super) fn struck(&self) -> Option<&'static str> {
        *self.struck.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn set_struck(&self, method: Option<&'static str>) {
        *self.struck.lock().unwrap_or_else(PoisonError::into_inner) = method;
    }

    /// Spoils the call that comes `ahead` calls after the next one.
    pub(super) fn arm(&self, ahead: usize) {
        self.at.store(self.calls() + ahead, Relaxed);
    }

    /// Whether this call is the one, of a method to which the fault can happen.
    fn strikes(&self, method: &'static str) -> bool {
        let call = self.calls.fetch_add(1, Relaxed);
        let possible = match (self.fault, method) {
            (Fault::PanicBefore | Fault::PanicAfter, _) => true,
            (_, "bytes") => false,
            (Fault::Refuse, _) => true,
            (Fault::Forget, _) => !ANSWERS.contains(&method),
            (
                Fault::Each(Part::Pressure | Part::Rate, _)
                | Fault::Last(Part::Pressure | Part::Rate, _),
                _,
            ) => method == "solve" || method == "solve_for",
            (Fault::Each(Part::RowSums, _) | Fault::Last(Part::RowSums, _), _) => method == "watch",
            (Fault::Each(..) | Fault::Last(..), _) => method == "watch" || method == "watch_both",
            (Fault::Length(_), _) => ANSWERS.contains(&method) && method != "solve_for",
        };
        let strikes = possible && call == self.at.load(Relaxed);
        if strikes {
            self.set_struck(Some(method));
        }
        strikes
    }

    /// A call that may fail.
    fn call<U: LinearUpdater>(&self, inner: &mut U, call: &mut Call<'_>) -> Result<(), Error> {
        if !self.strikes(call.method()) {
            return call.ask(inner);
        }
        match self.fault {
            Fault::Refuse => return Err(REFUSED),
            Fault::Forget => return Ok(()),
            // Without the hook that prints a message.
            Fault::PanicBefore => resume_unwind(Box::new(())),
            Fault::PanicAfter => {
                let _ = call.ask(inner);
                resume_unwind(Box::new(()))
            }
            _ => {
                if let Err(error) = call.ask(inner) {
                    // There is no answer to spoil.
                    self.set_struck(None);
                    return Err(error);
                }
            }
        }
        match call {
            Call::Watch { schur, .. } | Call::WatchBoth { schur, .. } => {
                spoil_schur(self.fault, schur);
            }
            Call::SolveFor { rhs: [], .. } => self.set_struck(None),
            Call::SolveFor { rhs, .. } => {
                let mut values: Vec<f64> = rhs.iter().map(|x| x[0]).collect();
                change(self.fault, &mut values);
                for (x, value) in rhs.iter_mut().zip(values) {
                    x[0] = value;
                }
            }
            // An empty answer has nothing to spoil.
            Call::Solve { count: 0, .. } if !matches!(self.fault, Fault::Length(1..)) => {
                self.set_struck(None);
            }
            Call::Solve { solution, .. } => spoil_solution(self.fault, solution),
            _ => {}
        }
        Ok(())
    }

    /// A question that cannot fail.
    fn ask<T>(&self, method: &'static str, answer: impl FnOnce() -> T) -> T {
        if self.strikes(method) {
            resume_unwind(Box::new(()));
        }
        answer()
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
