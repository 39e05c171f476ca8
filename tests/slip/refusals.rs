//! What cannot be answered is refused, with the numbers.

use asperity::bed::Bed;
use asperity::loading::History;
use asperity::slip::{Friction, JenkinsElement, PartialSlip, SlipHistory};
use asperity::updater::ConjugateGradient;
use asperity::{
    BedError, Boussinesq, Error, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq,
    SlipError,
};
use asperity_testing::surfaces::rough;

use crate::joints::rough_path;

fn path() -> (LoadingSolver, History) {
    rough_path(&Boussinesq::new(Grid::square(12, 1.0).unwrap(), 1.0).unwrap(), 1, 0.5)
}

const BAD: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[test]
fn sliding_and_loads_beyond_the_path() {
    let (_, history) = path();
    let bed = Bed::new(&history).unwrap();
    let friction = Friction::new(0.5, 1.0).unwrap();
    let last = bed.last_load();
    let beyond = PartialSlip::new(&bed, 1.01 * last, friction);
    assert!(matches!(beyond, Err(Error::Bed(BedError::PathEndsBefore { end, .. })) if end == last));
    for bad in BAD.into_iter().chain([0.0, -1.0]) {
        assert!(matches!(PartialSlip::new(&bed, bad, friction), Err(Error::NotPositive { .. })));
    }
    let joint = PartialSlip::new(&bed, last, friction).unwrap();
    let limit = joint.sliding_load();
    for force in [1.01 * limit, -1.01 * limit] {
        let refused = joint.monotone(force);
        assert!(
            matches!(refused, Err(Error::Slip(SlipError::JointSlides { tangential_load, load, limit: most })) if (tangential_load, load, most) == (force, last, limit)),
            "{refused:?}"
        );
    }
    for bad in BAD {
        assert!(matches!(joint.monotone(bad), Err(Error::OutOfRange { .. })));
        assert!(matches!(joint.cycle(bad), Err(Error::NotPositive { .. })));
        assert!(matches!(joint.cycle_of_displacement(bad), Err(Error::NotPositive { .. })));
    }
    for bad in [0.0, -0.1 * limit] {
        assert!(matches!(joint.cycle(bad), Err(Error::NotPositive { .. })));
        assert!(matches!(joint.cycle_of_displacement(bad), Err(Error::NotPositive { .. })));
    }
    // The limit itself, and what rounding makes of it.
    for force in [limit, limit * (1.0 + 1e-13), -limit] {
        let state = joint.monotone(force).unwrap();
        assert_eq!((state.stick_load, state.stick_nodes), (0.0, 0));
        assert_eq!(state.displacement.abs(), joint.sliding_displacement());
    }
    // No load too small, none between events special.
    for load in [1e-300, 1e-12 * last, bed.loads()[3], last] {
        let joint = PartialSlip::new(&bed, load, friction).unwrap();
        for share in [1e-9, 0.3, 1.0] {
            let cycle = joint.cycle(share * joint.sliding_load());
            assert!(cycle.is_ok_and(|cycle| cycle.dissipation >= 0.0), "{load} {share}");
        }
    }
}

/// A path that ends in full contact goes on in proportion, unless nodes will yield there.
#[test]
fn loads_beyond_full_contact_of_bodies_that_yield() {
    let grid = Grid::square(12, 1.0).unwrap();
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    let surface = rough(&grid, 3);
    let history = |hardness: f64| -> History {
        let builder = LoadingSolver::builder(&surface, &kernel).hardness(hardness);
        let path = builder.max_area_fraction(1.0).build().unwrap();
        path.map(Result::unwrap).collect()
    };
    let friction = Friction::new(0.3, 1.0).unwrap();
    let elastic = history(f64::INFINITY);
    let last = elastic.states().last().unwrap().contact.load;
    let beyond = |history: &History| {
        let bed = Bed::new(history).unwrap();
        PartialSlip::new(&bed, 4.0 * last, friction).map(|slip| slip.sliding_load())
    };
    let limit = beyond(&elastic).unwrap();
    assert!((limit / (1.2 * last) - 1.0).abs() < 1e-12);
    // Nothing has yielded before.
    let refused = beyond(&history(100.0 * last));
    assert!(matches!(refused, Err(Error::Bed(BedError::PathEndsBefore { .. }))), "{refused:?}");
}

/// A refused step leaves the history as it was.
#[test]
fn histories_that_slide() {
    let (_, history) = path();
    let bed = Bed::new(&history).unwrap();
    let mut joint = SlipHistory::new(&bed, Friction::new(0.5, 1.0).unwrap());
    let last = bed.last_load();
    // From no load along the limit.
    let refused = joint.to(last, 0.5 * last);
    assert!(
        matches!(refused, Err(Error::Slip(SlipError::StaysAtLimit { from: 0.0, .. }))),
        "{refused:?}"
    );
    joint.to(0.8 * last, 0.0).unwrap();
    joint.to(0.8 * last, 0.3 * last).unwrap();
    let before = joint.state();
    for (load, force) in
        [(0.8 * last, 0.41 * last), (0.5 * last, 0.3 * last), (0.5 * last, -0.26 * last)]
    {
        let refused = joint.to(load, force);
        assert!(matches!(refused, Err(Error::Slip(SlipError::JointSlides { .. }))), "{refused:?}");
    }
    let refused = joint.to(1.1 * last, 0.0);
    assert!(matches!(refused, Err(Error::Bed(BedError::PathEndsBefore { .. }))), "{refused:?}");
    for bad in BAD {
        assert!(matches!(joint.to(bad, 0.0), Err(Error::OutOfRange { .. })));
        assert!(matches!(joint.to(last, bad), Err(Error::OutOfRange { .. })));
    }
    assert!(matches!(joint.to(-1.0, 0.0), Err(Error::OutOfRange { .. })));
    assert!(matches!(joint.to(0.0, 1e-9), Err(Error::Slip(SlipError::JointSlides { .. }))));
    assert_eq!(joint.state(), before);
    // At the limit, and along it with less load: any displacement would do.
    joint.to(0.8 * last, 0.4 * last).unwrap();
    for load in [0.6 * last, 0.9 * last, 0.0] {
        let refused = joint.to(load, 0.5 * load);
        assert!(
            matches!(refused, Err(Error::Slip(SlipError::StaysAtLimit { .. }))),
            "{load}: {refused:?}"
        );
    }
    // Away from it the joint rests again, with more load or less of T.
    let mut relieved = joint.clone();
    assert!(joint.to(0.9 * last, 0.4 * last).unwrap().stick_nodes > 0);
    assert!(relieved.to(0.6 * last, 0.1 * last).unwrap().stick_nodes > 0);
    // And on to no load at all.
    let apart = relieved.to(0.0, 0.0).unwrap();
    assert_eq!((apart.displacement, apart.tangential_load), (0.0, 0.0));
}

/// Without a factor the approach of events is an estimate: a dissipation is refused where it would be made of its
/// errors.
#[test]
fn dissipations_within_the_error_of_the_path() {
    let (_, history) = path();
    let error = 1e-3 * history.states().last().unwrap().contact.approach;
    let estimated: History = history
        .states()
        .iter()
        .map(|state| {
            let mut state = *state;
            state.approach_error = error;
            state
        })
        .collect();
    let bed = Bed::new(&estimated).unwrap();
    let joint = PartialSlip::new(&bed, bed.last_load(), Friction::new(0.5, 1.0).unwrap()).unwrap();
    let limit = joint.sliding_load();
    let refused = joint.cycle(5e-3 * limit);
    assert!(
        matches!(refused, Err(Error::Slip(SlipError::WithinPathError { change, approach_error })) if approach_error == error && change < 10.0 * error),
        "{refused:?}"
    );
    assert!(joint.cycle(0.2 * limit).is_ok());
    assert!(joint.monotone(5e-3 * limit).is_ok());
}

/// A path on which nodes yield has no such increments.
#[test]
fn paths_that_yield() {
    let kernel = Boussinesq::new(Grid::square(12, 1.0).unwrap(), 1.0).unwrap();
    let surface = rough(&kernel.grid(), 1);
    let path = LoadingSolver::builder(&surface, &kernel).hardness(0.05).max_area_fraction(0.3);
    let history: History = path.build().unwrap().map(Result::unwrap).collect();
    let refused = Bed::new(&history);
    assert!(matches!(
        refused,
        Err(Error::Bed(BedError::NotElasticGrowth { happens: "yields", .. }))
    ));
}

/// In full contact of a periodic half-space nothing slips up to μ(P − P_full): a cycle there costs nothing, whatever
/// errors the path has.
#[test]
fn nothing_slips_in_full_contact() {
    let kernel = PeriodicBoussinesq::new(Grid::square(12, 1.0).unwrap(), 1.0).unwrap();
    let surface = rough(&kernel.grid(), 1);
    for factor in [true, false] {
        let builder = LoadingSolver::builder(&surface, &kernel);
        let history = match factor {
            true => builder.build().unwrap().run().unwrap(),
            false => builder.updater(ConjugateGradient::default()).build().unwrap().run().unwrap(),
        };
        let bed = Bed::new(&history).unwrap();
        let load = 2.0 * bed.last_load();
        let joint = PartialSlip::new(&bed, load, Friction::new(0.5, 1.0).unwrap()).unwrap();
        for part in [0.1, 0.49] {
            let cycle = joint.cycle(part * joint.sliding_load()).unwrap();
            assert_eq!((cycle.dissipation, cycle.displacement), (0.0, 0.0));
        }
        let elements: Vec<_> = joint.jenkins_elements().collect();
        let forces: f64 = elements.iter().map(|e| e.stiffness * e.slip_displacement).sum();
        // μ P_full of μP; stiffnesses between the ends of windows are estimates without a factor.
        let error = if factor { 1e-9 } else { 1e-6 };
        let part = forces / joint.sliding_load();
        assert!((part - 0.5).abs() < error, "factor {factor}: {part}");
        let cycle = joint.cycle(joint.sliding_load()).unwrap();
        let lost = |e: &JenkinsElement| {
            4.0 * e.stiffness * e.slip_displacement * (cycle.displacement - e.slip_displacement)
        };
        let sum: f64 = elements.iter().map(lost).sum();
        let of_last = 4.0 * 0.5 * joint.sliding_load() * cycle.displacement;
        let part = (sum + of_last) / cycle.dissipation;
        assert!((part - 1.0).abs() < error, "factor {factor}: {part}");
    }
}
