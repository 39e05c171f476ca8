//! What holds at every event of a path on which nodes leave, and between events.

use std::collections::BTreeSet;

use super::table::Table;
use crate::common::loaded;
use asperity::loading::{ContactEvent, History};
use asperity::updater::LinearUpdater;
use asperity::{LoadingSolver, LoadingState};
use asperity_testing::dense::{complementary, from_first_touch};
use nalgebra::{DMatrix, DVector};

/// Both sides solve with matrices of condition 1e3 at most, which loses three digits of sixteen.
pub(super) const EXACT: f64 = 1e-12;
/// Solutions that are iterated to residuals of 1e-14: times the condition number.
pub(super) const ITERATED: f64 = 1e-10;

/// A path from first touch to its end, checked at every event and between events. Returns the number
/// of releases.
///
/// Everything within `tolerance` of the greatest pressure or load. With a factor that is [`EXACT`].
pub(super) fn check<U: LinearUpdater>(
    kernel: &Table,
    gaps: &[f64],
    mut path: LoadingSolver<U>,
    tolerance: f64,
) -> usize {
    let matrix = kernel.matrix();
    let gaps = from_first_touch(gaps);
    let mut contact = BTreeSet::new();
    let mut states: Vec<LoadingState> = Vec::new();
    let compare = |pressure: &DMatrix<f64>, state: &LoadingState| {
        let expected = complementary(&matrix, &gaps, kernel.own_approach(state));
        let scale = expected.max().max(1e-3);
        let error = (DVector::from_column_slice(pressure.as_slice()) - &expected).amax();
        assert!(error <= tolerance * scale, "{state:?}: pressure {error:e} of {scale:e}");
        let error = (expected.sum() - state.contact.load).abs();
        assert!(error <= tolerance * scale * gaps.len() as f64, "{state:?}: load {error:e}");
        let displacement = (&matrix * &expected).mean();
        let mean_gap =
            DVector::from_column_slice(&gaps).mean() + displacement - kernel.own_approach(state);
        let error = (mean_gap - state.contact.mean_gap).abs();
        assert!(error <= tolerance * (1.0 + kernel.own_approach(state)), "{state:?}: {error:e}");
    };
    while let Some(state) = path.next() {
        let state = state.unwrap();
        let node = kernel.grid.node(state.node.0, state.node.1).unwrap();
        match state.event {
            ContactEvent::Touch => assert!(contact.insert(node), "{state:?}"),
            ContactEvent::Release => assert!(contact.remove(&node), "{state:?}"),
            _ => panic!("no limit was set: {state:?}"),
        }
        assert_eq!(state.step, states.len() + 1);
        assert_eq!(state.contact.contact_nodes, contact.len());
        assert_eq!(state.contact.contact_area, contact.len() as f64);
        let order = path.contact_order();
        assert_eq!(order.len(), contact.len());
        assert_eq!(BTreeSet::from_iter(order), contact);
        let map = path.contact_map();
        assert!((0..gaps.len()).all(|node| map.as_slice()[node] == contact.contains(&node)));
        // Gaps are relative to a length of which some 0.3 is Sq, and round like the approach in the gauge of
        // the kernel.
        let slack = 30.0 * tolerance * (1.0 + kernel.own_approach(&state));
        let certificate = path.certificate().unwrap();
        assert!(certificate.least_pressure >= -slack, "{certificate:?}");
        let slack = 0.3 * slack / certificate.length;
        assert!(certificate.least_gap >= -slack, "{certificate:?}");
        assert!(certificate.greatest_contact_gap <= slack, "{certificate:?}");
        compare(&path.fields().unwrap().pressure, &state);
        if let Some(last) = states.last() {
            assert!(state.contact.load >= last.contact.load);
            // Half way from the last event to this one the contact is that after the last.
            let interval: History = [*last, state].into_iter().collect();
            let middle = interval.at_load(0.5 * (last.contact.load + state.contact.load)).unwrap();
            compare(&path.fields_at(&middle).unwrap().pressure, &middle);
            let work = 0.5
                * (last.contact.load + state.contact.load)
                * (state.contact.approach - last.contact.approach);
            let error = (state.contact.energy - last.contact.energy - work).abs();
            assert!(error <= tolerance * (1.0 + state.contact.energy.abs()), "{error:e}");
        }
        states.push(state);
    }
    assert!(path.next().is_none());

    // Every earlier state, whatever left since, and the state that a history reads.
    for state in states.iter().step_by(3) {
        compare(&path.fields_at(state).unwrap().pressure, state);
    }
    let last = *states.last().unwrap();
    let history: History = states.iter().copied().collect();
    let half = history.at_load(0.5 * last.contact.load).unwrap();
    compare(&path.fields_at(&half).unwrap().pressure, &half);
    let first_half = history.at_area_fraction(0.5);
    let expected = states.iter().find(|state| state.contact.contact_nodes >= gaps.len() / 2);
    assert_eq!(first_half.as_ref(), expected);
    // Nothing happens any more: the same contact far beyond.
    let beyond = loaded(last, 10.0 * last.contact.load + 1.0);
    compare(&path.fields_at(&beyond).unwrap().pressure, &beyond);
    let releases = states.iter().filter(|state| state.event == ContactEvent::Release);
    releases.count()
}
