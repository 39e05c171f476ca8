//! The last state of a path lies exactly at its limit, and is the one that a longer path reads there.

use crate::common::half_way;
use crate::problems::{grid, kernels, rough, states};
use asperity::loading::{ContactEvent, History, LoadingEnd};
use asperity::{ContactTarget, LoadingSolver, LoadingState};
use asperity_testing::close::assert_close;

/// The state at a target, by the longer path and by the limited one.
type Read = fn(&History, f64) -> Option<LoadingState>;

#[test]
fn paths_end_exactly_at_their_limits() {
    let surface = rough(&grid(), 1);
    for (name, kernel) in kernels(grid()) {
        let all = states(&surface, &kernel);
        let unloaded = all[0].contact.mean_gap;
        let whole: History = all.iter().copied().collect();
        let area = grid().nominal_area();
        for step in [1, 2, 40, 150, 250] {
            let at = half_way(all[step - 1], Some(all[step]));
            let builder = || LoadingSolver::builder(&surface, &kernel);
            for (builder, end, target, quantity, read) in [
                (
                    builder().max_load(at.contact.load),
                    LoadingEnd::Load,
                    at.contact.load,
                    at.contact.load,
                    History::at_load as Read,
                ),
                (
                    builder().max_mean_pressure(at.contact.load / area),
                    LoadingEnd::Load,
                    at.contact.load / area * area,
                    at.contact.load,
                    History::at_load,
                ),
                (
                    builder().max_approach(at.contact.approach),
                    LoadingEnd::Approach,
                    at.contact.approach,
                    at.contact.approach,
                    History::at_approach,
                ),
                (
                    builder().min_mean_gap(at.contact.mean_gap),
                    LoadingEnd::MeanGap,
                    at.contact.mean_gap,
                    at.contact.mean_gap,
                    History::at_mean_gap,
                ),
            ] {
                let context = format!("{name}, step {step}, {end:?}");
                let mut path = builder.build().unwrap();
                let history: History = path.by_ref().map(Result::unwrap).collect();
                assert_eq!(path.end(), Some(end), "{context}");
                assert!(path.next().is_none());
                let last = *history.states().last().unwrap();
                assert_eq!(last.event, ContactEvent::Limit, "{context}");
                assert_eq!((last.step, last.node), (step, all[step - 1].node));
                let events = &history.states()[..step];
                assert_eq!(events.len() + 1, history.states().len());
                assert!(events.iter().all(|s| s.event == ContactEvent::Touch));
                let found = match end {
                    LoadingEnd::Load => last.contact.load,
                    LoadingEnd::Approach => last.contact.approach,
                    _ => last.contact.mean_gap,
                };
                // To the last bit, and the history has it there.
                assert_eq!(found, target, "{context}");
                assert_eq!(read(&history, target), Some(last), "{context}");
                let expected = read(&whole, quantity).unwrap();
                // Two paths that differ in their last windows; beside an interval of any width the
                // quantities of the state are rounded at 1e-14 or so.
                assert_close(&last, &expected, 1e-11, unloaded);
                // Nothing beyond.
                let beyond = match end {
                    LoadingEnd::MeanGap => 0.9 * target,
                    _ => 1.1 * target,
                };
                assert!(read(&history, beyond).is_none(), "{context}");
                // Fields of the present state, which is the one at the limit.
                assert_eq!(path.state(), Some(last));
                let pressure = path.fields().unwrap().pressure;
                assert_eq!(path.fields().unwrap().max_pressure(), pressure.max());
                let load = pressure.sum() * path.grid().cell_area();
                assert!((load / last.contact.load - 1.0).abs() < 1e-12, "{context}");
                let certificate = path.certificate().unwrap();
                assert!(certificate.least_pressure >= -1e-12, "{context}");
                assert!(certificate.least_gap >= -1e-12, "{context}");
                assert!(certificate.greatest_contact_gap <= 1e-12, "{context}");
                assert!(path.fields_at(&events[step / 2]).map(|fields| fields.pressure).is_ok());
            }
        }
    }
}

/// `until` is what the named limits say.
#[test]
fn until_is_any_limit() {
    let (surface, kernel) = (rough(&grid(), 2), &kernels(grid())[0].1);
    let all = states(&surface, kernel);
    let at = half_way(all[60], Some(all[61]));
    let builder = || LoadingSolver::builder(&surface, kernel);
    let ends = |builder: asperity::loading::LoadingBuilder<'_>| {
        let path = builder.build().unwrap();
        path.last().unwrap().unwrap()
    };
    for (target, named) in [
        (ContactTarget::Load(at.contact.load), builder().max_load(at.contact.load)),
        (ContactTarget::Approach(at.contact.approach), builder().max_approach(at.contact.approach)),
        (ContactTarget::MeanGap(at.contact.mean_gap), builder().min_mean_gap(at.contact.mean_gap)),
        (ContactTarget::AreaFraction(0.25), builder().max_area_fraction(0.25)),
    ] {
        assert_eq!(ends(builder().until(target)), ends(named), "{target:?}");
    }
}

/// A path tells its limits, as they were given, and none that were not.
#[test]
fn targets_are_the_limits() {
    let (surface, kernel) = (rough(&grid(), 2), &kernels(grid())[0].1);
    let builder = || LoadingSolver::builder(&surface, kernel);
    let gap = 0.5 * states(&surface, kernel)[0].contact.mean_gap;
    let load = (builder().max_load(3.0), ContactTarget::Load(3.0));
    let approach = (builder().max_approach(1e-6), ContactTarget::Approach(1e-6));
    let mean_gap = (builder().min_mean_gap(gap), ContactTarget::MeanGap(gap));
    // 18 × 15 nodes.
    let nodes = (builder().max_nodes(27), ContactTarget::AreaFraction(27.0 / 270.0));
    for (builder, target) in [load, approach, mean_gap, nodes] {
        assert_eq!(builder.build().unwrap().targets(), [target]);
    }
    assert_eq!(builder().build().unwrap().targets(), []);
    let both = builder().max_load(3.0).max_approach(1e-6);
    let targets = [ContactTarget::Load(3.0), ContactTarget::Approach(1e-6)];
    assert_eq!(both.build().unwrap().targets(), targets);
}

/// What a state is read at, it has to the last bit, whatever the rounding of the rest.
#[test]
fn states_are_read_where_they_were_asked_for() {
    let surface = rough(&grid(), 2);
    for (name, kernel) in kernels(grid()) {
        let all = states(&surface, &kernel);
        let history: History = all.iter().copied().collect();
        for (k, pair) in all.windows(2).enumerate() {
            let [before, after] = [&pair[0], &pair[1]];
            // Anywhere between the two.
            let part = (0.618 * k as f64).fract();
            let between = |a: f64, b: f64| a + part * (b - a);
            let context = format!("{name}, step {}", before.step);
            let load = between(before.contact.load, after.contact.load);
            assert_eq!(history.at_load(load).unwrap().contact.load, load, "{context}");
            let approach = between(before.contact.approach, after.contact.approach);
            let read = history.at_approach(approach).unwrap();
            assert_eq!(read.contact.approach, approach, "{context}");
            let mean_gap = between(before.contact.mean_gap, after.contact.mean_gap);
            let read = history.at_mean_gap(mean_gap).unwrap();
            assert_eq!(read.contact.mean_gap, mean_gap, "{context}");
        }
    }
}
