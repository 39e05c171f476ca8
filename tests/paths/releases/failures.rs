//! Updaters that cannot let nodes go, or fail: what came before stays.

use super::check::EXACT;
use super::complementary::{complementary, from_first_touch};
use super::table::{Table, case};
use asperity::contact::ContactSequence;
use asperity::loading::ContactEvent;
use asperity::updater::{Dense, LinearUpdater, RecursiveCholesky, Schur, Solution, WindowFactor};
use asperity::{Error, LoadingState, Problem, UpdaterError};
use nalgebra::DVector;

fn has_releases((kernel, gaps): &(Table, Vec<f64>)) -> bool {
    let mut states = kernel.path(gaps).map(Result::unwrap);
    states.any(|state| state.event == ContactEvent::Release)
}

/// An updater that knows the three verbs that every path needs, and not how to let a node leave.
#[derive(Default)]
struct GrowsOnly(Dense);

impl LinearUpdater for GrowsOnly {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        self.0.watch(problem, contact, nodes, schur)
    }

    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        touched: &WindowFactor,
    ) -> Result<(), Error> {
        self.0.join(problem, contact, touched)
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        self.0.solve(problem, contact, count, approach, solution)
    }
}

#[test]
fn an_updater_that_cannot_let_nodes_leave_says_so() {
    let (kernel, gaps) = (0..).map(case).find(has_releases).unwrap();
    let mut complete = kernel.path(&gaps);
    let mut path = kernel.path_with(&gaps, GrowsOnly::default());
    loop {
        let expected = complete.next().unwrap().unwrap();
        match path.next().unwrap() {
            Ok(state) => assert_eq!((state.step, state.node), (expected.step, expected.node)),
            Err(Error::Updater(UpdaterError::ReleaseNotSupported { ix, iy })) => {
                assert_eq!(expected.event, ContactEvent::Release);
                assert_eq!((ix, iy), expected.node);
                break;
            }
            Err(error) => panic!("{error}"),
        }
    }
    assert!(path.next().is_none());
    // What came before stays.
    let state = path.state().unwrap();
    assert_eq!(path.contact_order().len(), state.contact.contact_nodes);
    assert!(path.certificate().unwrap().least_pressure > -1e-11);
}

/// An updater one of whose solutions is not a number.
struct Spoiled {
    inner: RecursiveCholesky,
    solutions: usize,
    spoiled: usize,
}

impl LinearUpdater for Spoiled {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        self.inner.watch(problem, contact, nodes, schur)
    }

    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        touched: &WindowFactor,
    ) -> Result<(), Error> {
        self.inner.join(problem, contact, touched)
    }

    fn release(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        node: usize,
        position: usize,
    ) -> Result<(), Error> {
        self.inner.release(problem, contact, node, position)
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        self.inner.solve(problem, contact, count, approach, solution)?;
        self.solutions += 1;
        if self.solutions == self.spoiled {
            solution.pressure.fill(f64::NAN);
        }
        Ok(())
    }
}

/// An event whose state fails is not yielded, whether a node touched or left; what came before stays.
#[test]
fn states_before_a_failure_stay() {
    let (kernel, gaps) = (0..).map(case).find(has_releases).unwrap();
    let expected: Vec<LoadingState> = kernel.path(&gaps).map(Result::unwrap).collect();
    // One solution before first touch, one at every event.
    for good in 0..expected.len() {
        let updater = Spoiled { inner: RecursiveCholesky::new(), solutions: 0, spoiled: good + 2 };
        let mut path = kernel.path_with(&gaps, updater);
        for expected in &expected[..good] {
            assert_eq!(path.next().unwrap().unwrap(), *expected);
        }
        let error = path.next().unwrap().unwrap_err();
        let closed = matches!(error, Error::Updater(UpdaterError::ContactNotClosed { .. }));
        assert!(closed, "{error}");
        assert!(path.next().is_none());
        assert_eq!(path.state().as_ref(), expected[..good].last());
        for state in &expected[..good] {
            let approach = kernel.own_approach(state);
            let exact = complementary(&kernel.matrix(), &from_first_touch(&gaps), approach);
            let found = path.pressure_at(state).unwrap();
            let error = (DVector::from_column_slice(found.as_slice()) - &exact).amax();
            assert!(error <= EXACT * exact.max().max(1e-3), "{state:?}: {error:e}");
        }
        let nodes = path.state().map_or(0, |state| state.contact.contact_nodes);
        assert_eq!(path.contact_order().len(), nodes);
    }
}
