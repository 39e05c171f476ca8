//! Limits: what is refused, where a path ends, and why.

use crate::common::Sphere;
use asperity::loading::{ContactEvent, LoadingBuilder, LoadingEnd};
use asperity::surface::HeightMap;
use asperity::{
    Boussinesq, Error, Grid, InfluenceKernel, LoadingSolver, LoadingState, PeriodicBoussinesq,
    SurfaceError,
};
use asperity_testing::assert_relative;
use nalgebra::DMatrix;

/// A limit of a builder.
type Limit = fn(LoadingBuilder<'_>, f64) -> LoadingBuilder<'_>;

#[test]
fn limits_that_make_no_sense() {
    let sphere = Sphere::on(4);
    let positive: [Limit; 3] = [
        |builder, load| builder.max_load(load),
        |builder, approach| builder.max_approach(approach),
        |builder, pressure| builder.max_mean_pressure(pressure),
    ];
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for limit in positive {
            let error = limit(sphere.builder(), bad).build().unwrap_err();
            assert!(matches!(error, Error::NotPositive { .. }), "{error}");
        }
    }
    for bad in [0.0, -1e-9, 1.0 + 1e-9, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error = sphere.builder().max_area_fraction(bad).build().unwrap_err();
        assert!(matches!(error, Error::OutOfRange { .. }), "{error}");
    }
    // Less than a node is no contact.
    let error = sphere.builder().max_area_fraction(0.9 / 16.0).build();
    let error = error.unwrap_err();
    assert!(matches!(error, Error::Surface(SurfaceError::LessThanOneNode { .. })), "{error}");
    let unloaded = sphere.states()[0].contact.mean_gap;
    for bad in [-1e-9, unloaded, 2.0 * unloaded, f64::NAN, f64::INFINITY] {
        let error = sphere.builder().min_mean_gap(bad).build().unwrap_err();
        assert!(matches!(error, Error::OutOfRange { .. }), "{error}");
    }
    for builder in [sphere.builder().max_nodes(0), sphere.builder().window_size(0)] {
        let error = builder.build().unwrap_err();
        assert!(matches!(error, Error::OutOfRange { .. }), "{error}");
    }
}

/// A path to its end, which is fused.
fn run(builder: LoadingBuilder<'_>, end: LoadingEnd) -> Vec<LoadingState> {
    let mut path = builder.build().unwrap();
    assert_eq!(path.end(), None);
    let states: Vec<_> = path.by_ref().map(Result::unwrap).collect();
    for _ in 0..3 {
        assert!(path.next().is_none(), "fused");
    }
    assert_eq!(path.end(), Some(end));
    assert_eq!(path.size_hint(), (0, Some(0)));
    assert_eq!(path.state(), states.last().copied());
    states
}

/// The same events; limits choose other windows, which round otherwise.
#[track_caller]
fn assert_same(found: &[LoadingState], expected: &[LoadingState]) {
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert_eq!(
            (a.step, a.event, a.contact.contact_nodes),
            (b.step, b.event, b.contact.contact_nodes)
        );
        assert!((a.contact.load - b.contact.load).abs() <= 1e-12 * b.contact.load, "{a:?} {b:?}");
        assert!(
            (a.contact.approach - b.contact.approach).abs() <= 1e-12 * b.contact.approach,
            "{a:?} {b:?}"
        );
    }
}

/// Every limit ends the path with `None`, after the last state that obeys it and before the first
/// that does not; one of load, approach or mean gap with one more state, exactly there.
#[test]
fn limits_are_ends_and_not_errors() {
    let sphere = Sphere::on(6);
    let all = sphere.states();
    assert_eq!(all.len(), 36);
    for nodes in [1, 7, 35] {
        let states = run(sphere.builder().max_nodes(nodes), LoadingEnd::Nodes);
        assert_same(&states, &all[..nodes]);
    }
    for nodes in [36, usize::MAX] {
        let states = run(sphere.builder().max_nodes(nodes), LoadingEnd::FullContact);
        assert_same(&states, &all);
    }
    for (fraction, nodes) in [(1.0 / 36.0, 1), (0.5, 18), (0.999, 35)] {
        let builder = sphere.builder().max_area_fraction(fraction);
        assert_same(&run(builder, LoadingEnd::AreaFraction), &all[..nodes]);
    }
    let builder = sphere.builder().max_area_fraction(1.0);
    assert_same(&run(builder, LoadingEnd::FullContact), &all);
    // A whole shell has the same load: limits between shells, far from rounding.
    let (before, after) = (all[15], all[16]);
    assert!(after.contact.approach > before.contact.approach * 1.01);
    let middle = |quantity: fn(&LoadingState) -> f64| 0.5 * (quantity(&before) + quantity(&after));
    let load = middle(|state| state.contact.load);
    let approach = middle(|state| state.contact.approach);
    let mean_gap = middle(|state| state.contact.mean_gap);
    for (builder, end) in [
        (sphere.builder().max_load(load), LoadingEnd::Load),
        // The nominal area is 1.
        (sphere.builder().max_mean_pressure(load), LoadingEnd::Load),
        (sphere.builder().max_approach(approach), LoadingEnd::Approach),
        (sphere.builder().min_mean_gap(mean_gap), LoadingEnd::MeanGap),
    ] {
        let states = run(builder, end);
        let (last, events) = states.split_last().unwrap();
        assert_same(events, &all[..16]);
        assert_eq!(last.event, ContactEvent::Limit);
        assert_eq!((last.step, last.node), (before.step, events[15].node));
    }
    let builder = sphere.builder().window_size(usize::MAX);
    assert_eq!(run(builder, LoadingEnd::FullContact).len(), 36);
}

/// Of several limits the first one reached counts, also of several of one kind, whatever their order.
#[test]
fn the_first_limit_reached_counts() {
    let sphere = Sphere::on(6);
    let all = sphere.states();
    let load = all[20].contact.load;
    let builder = sphere.builder().max_load(load).max_nodes(9);
    assert_eq!(run(builder, LoadingEnd::Nodes).len(), 9);
    let builder = sphere.builder().max_nodes(9).max_area_fraction(0.1);
    assert_eq!(run(builder, LoadingEnd::AreaFraction).len(), 3);
    let builder = sphere.builder().max_load(load).max_approach(all[12].contact.approach);
    let states = run(builder, LoadingEnd::Approach);
    assert_eq!(states.last().unwrap().contact.approach, all[12].contact.approach);
    let pressure = 0.5 * load / all[0].contact.nominal_area;
    for builder in [
        sphere.builder().max_load(load).max_mean_pressure(pressure),
        sphere.builder().max_mean_pressure(pressure).max_load(load),
    ] {
        let states = run(builder, LoadingEnd::Load);
        assert_relative!(states.last().unwrap().contact.load, 0.5 * load, 1e-15);
    }
    let (near, far) = (all[12].contact, all[15].contact);
    for [first, second] in [[near, far], [far, near]] {
        let builder = sphere.builder().max_approach(first.approach).max_approach(second.approach);
        let states = run(builder, LoadingEnd::Approach);
        assert_eq!(states.last().unwrap().contact.approach, near.approach);
        let builder = sphere.builder().min_mean_gap(first.mean_gap).min_mean_gap(second.mean_gap);
        let states = run(builder, LoadingEnd::MeanGap);
        assert_eq!(states.last().unwrap().contact.mean_gap, near.mean_gap);
        let [first, second] = [first, second].map(|contact| contact.contact_area_fraction);
        let builder = sphere.builder().max_area_fraction(first).max_area_fraction(second);
        assert_eq!(run(builder, LoadingEnd::AreaFraction).len(), near.contact_nodes);
    }
}

/// A limit at which an event happens adds no second state.
#[test]
fn a_limit_at_an_event_is_that_event() {
    let sphere = Sphere::on(6);
    let all = sphere.states();
    for state in &all {
        if state.contact.load == 0.0 {
            continue;
        }
        let states = run(sphere.builder().max_load(state.contact.load), {
            let last = all.last().unwrap();
            if state.contact.load == last.contact.load {
                LoadingEnd::FullContact
            } else {
                LoadingEnd::Load
            }
        });
        assert!(states.iter().all(|state| state.event == ContactEvent::Touch));
        assert_eq!(states.last().unwrap().contact.load, state.contact.load);
    }
}

/// The same of approach and mean gap, on a half-space of arbitrary mean displacement too: its approach is that of
/// the mean planes, whatever the gauge. Windows of one node, so that a limit changes none.
#[test]
fn limits_of_approach_and_mean_gap_at_an_event() {
    let grid = Grid::new(5, 4, 1.0, 1.0).unwrap();
    let heights = DMatrix::from_fn(5, 4, |ix, iy| ((3 * ix + 5 * iy * iy) as f64).sin());
    let surface = HeightMap::new(heights).unwrap();
    let kernels: [&dyn InfluenceKernel; 2] =
        [&Boussinesq::new(grid, 1.0).unwrap(), &PeriodicBoussinesq::new(grid, 1.0).unwrap()];
    for kernel in kernels {
        let builder = || LoadingSolver::builder(&surface, kernel).window_size(1);
        let all: Vec<_> = builder().build().unwrap().map(Result::unwrap).collect();
        for state in &all[1..19] {
            for limited in [
                builder().max_approach(state.contact.approach),
                builder().min_mean_gap(state.contact.mean_gap),
            ] {
                let states: Vec<_> = limited.build().unwrap().map(Result::unwrap).collect();
                assert_eq!(states, all[..state.step]);
            }
            // A little less is a state of its own.
            let less = state.contact.approach * (1.0 - 1e-9);
            let limited = builder().max_approach(less).build().unwrap();
            let states: Vec<_> = limited.map(Result::unwrap).collect();
            let last = states.last().unwrap();
            assert_eq!((last.event, last.contact.approach), (ContactEvent::Limit, less));
            assert_eq!(states.len(), state.step);
        }
    }
}

#[test]
fn states_that_are_not_reached() {
    let sphere = Sphere::on(6);
    let all = sphere.states();
    let mut path = sphere.builder().build().unwrap();
    assert!(path.fields().unwrap().pressure.iter().all(|p| *p == 0.0));
    assert_eq!(path.state(), None);
    for (k, state) in all.iter().enumerate() {
        let Err(Error::StateNotReached { step, present }) =
            path.fields_at(state).map(|fields| fields.pressure)
        else {
            panic!("{state:?} answered");
        };
        assert_eq!((step, present), (k + 1, k));
        path.next().unwrap().unwrap();
        assert!(path.fields_at(state).map(|fields| fields.pressure).is_ok());
    }
}
