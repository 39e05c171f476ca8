//! Updaters that cannot let nodes go, or fail: what came before stays.

use super::check::EXACT;
use super::table::{Table, case};
use asperity::loading::ContactEvent;
use asperity::updater::RecursiveCholesky;
use asperity::{Error, LoadingState, UpdaterError};
use asperity_testing::bordering::Bordering;
use asperity_testing::dense::{complementary, from_first_touch};
use asperity_testing::{Altered, Call};
use nalgebra::DVector;

fn has_releases((kernel, gaps): &(Table, Vec<f64>)) -> bool {
    let mut states = kernel.path(gaps).map(Result::unwrap);
    states.any(|state| state.event == ContactEvent::Release)
}

/// One that knows the three verbs that every path needs, and not how to let a node leave.
#[test]
fn an_updater_that_cannot_let_nodes_leave_says_so() {
    let (kernel, gaps) = (0..).map(case).find(has_releases).unwrap();
    let mut complete = kernel.path(&gaps);
    let mut path = kernel.path_with(&gaps, Bordering::default());
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

/// An event whose state fails is not yielded, whether a node touched or left; what came before stays.
#[test]
fn states_before_a_failure_stay() {
    let (kernel, gaps) = (0..).map(case).find(has_releases).unwrap();
    let expected: Vec<LoadingState> = kernel.path(&gaps).map(Result::unwrap).collect();
    // One solution before first touch, and at least one for each release and for the window before it.
    let releases = expected.iter().filter(|state| state.event == ContactEvent::Release).count();
    for good in 0..releases {
        let mut solutions = 0;
        let updater = Altered::new(RecursiveCholesky::new()).on_call(move |inner, call| {
            call.ask(inner)?;
            if let Call::Solve { solution, .. } = call {
                solutions += 1;
                if solutions == good + 2 {
                    solution.pressure.fill(f64::NAN);
                }
            }
            Ok(())
        });
        let mut path = kernel.path_with(&gaps, updater);
        let mut found = Vec::new();
        let error = loop {
            match path.next().unwrap() {
                Ok(state) => found.push(state),
                Err(error) => break error,
            }
        };
        assert!(found.len() >= good && found == expected[..found.len()], "{good}");
        let closed = matches!(error, Error::Updater(UpdaterError::ContactNotClosed { .. }));
        assert!(closed, "{error}");
        assert!(path.next().is_none());
        assert_eq!(path.state().as_ref(), found.last());
        for state in &found {
            let approach = kernel.own_approach(state);
            let exact = complementary(&kernel.matrix(), &from_first_touch(&gaps), approach);
            let found = path.fields_at(state).unwrap().pressure;
            let error = (DVector::from_column_slice(found.as_slice()) - &exact).amax();
            assert!(error <= EXACT * exact.max().max(1e-3), "{state:?}: {error:e}");
        }
        let nodes = path.state().map_or(0, |state| state.contact.contact_nodes);
        assert_eq!(path.contact_order().len(), nodes);
    }
}
