//! Input that makes no sense, and numbers at the ends of double precision: typed errors or finite answers, and no
//! panic.

use asperity::bed::Bed;
use asperity::creep::{
    Control, ControlHistory, Creep, PiecewiseLinear, Prony, Relaxation, Steps, Unloading,
    ViscoelasticBed,
};
use asperity::loading::History;
use asperity::{BedError, Boussinesq, CreepError, Error, Grid, LoadingSolver};
use proptest::prelude::*;

use crate::stepping::rough;

fn history(nodes: usize) -> History {
    let grid = Grid::square(10, 1.0).unwrap();
    let half_space = Boussinesq::new(grid, 1.0).unwrap();
    let path = LoadingSolver::builder(&rough(&grid, 4), &half_space).max_nodes(nodes).build();
    path.unwrap().collect::<Result<_, _>>().unwrap()
}

fn solid() -> Prony {
    Prony::shares(&[(1.0, 0.5)]).unwrap()
}

#[test]
fn loads_and_times_that_are_none() {
    let history = history(50);
    let bed = Bed::new(&history).unwrap();
    let negative = PiecewiseLinear::new([(0.0, 1.0), (1.0, -1.0)]).unwrap();
    assert!(matches!(Creep::new(&bed, &solid(), &negative), Err(Error::OutOfRange { .. })));
    let load = bed.loads()[10];
    let creep = Creep::new(&bed, &solid(), &PiecewiseLinear::step(load).unwrap()).unwrap();
    assert!(matches!(creep.at(f64::NAN), Err(Error::OutOfRange { .. })));
    let before = creep.at(-1.0).unwrap();
    assert_eq!((before.load, before.effective_load, before.contact_nodes), (0.0, 0.0, 1));
    assert_eq!(creep.at(f64::NEG_INFINITY).unwrap().load, 0.0);
    assert!(creep.at(f64::INFINITY).is_ok());
    assert!(creep.pressure(1.0, 0).is_err());
    assert_eq!(creep.pressure(-1.0, 5).unwrap().load(), 0.0);
    assert_eq!(creep.time_of(f64::NAN), None);
    let relaxation =
        Relaxation::new(&bed, &solid(), &PiecewiseLinear::step(-1.0).unwrap()).unwrap();
    assert_eq!(relaxation.at(1.0).unwrap().contact_nodes, 0);
    assert_eq!(relaxation.pressure(1.0, 5).unwrap().load(), 0.0);
    assert!(matches!(relaxation.at(f64::NAN), Err(Error::OutOfRange { .. })));
    let beyond = PiecewiseLinear::ramp(10.0 * bed.approaches()[49], 1.0).unwrap();
    let relaxation = Relaxation::new(&bed, &solid(), &beyond).unwrap();
    assert!(relaxation.at(0.05).is_ok());
    assert!(matches!(relaxation.at(1.0), Err(Error::Bed(BedError::PathEndsBefore { .. }))));
    // At once as well.
    let at_once = PiecewiseLinear::step(10.0 * bed.approaches()[49]).unwrap();
    let relaxation = Relaxation::new(&bed, &solid(), &at_once).unwrap();
    assert!(matches!(relaxation.at(0.0), Err(Error::Bed(BedError::PathEndsBefore { .. }))));
}

#[test]
fn steps_that_are_none() {
    let history = history(50);
    let bed = Bed::new(&history).unwrap();
    let mut contact = ViscoelasticBed::new(&bed, &solid()).unwrap();
    let load = bed.loads()[10];
    contact.step(0.0, Control::Load(load)).unwrap();
    let before = contact.state();
    for (duration, control) in [
        (-1.0, Control::Load(load)),
        (f64::NAN, Control::Load(load)),
        (f64::INFINITY, Control::Load(load)),
        (1.0, Control::Load(-load)),
        (1.0, Control::Load(f64::NAN)),
        (1.0, Control::Load(f64::INFINITY)),
        (1.0, Control::Approach(f64::NAN)),
        (1.0, Control::Approach(f64::NEG_INFINITY)),
    ] {
        let refused = contact.step(duration, control);
        assert!(matches!(refused, Err(Error::OutOfRange { .. })), "{refused:?}");
        assert_eq!(contact.state(), before);
    }
    for control in
        [Control::Load(2.0 * bed.last_load()), Control::Approach(2.0 * bed.approaches()[49])]
    {
        let refused = contact.step(0.1, control);
        assert!(matches!(refused, Err(Error::Creep(CreepError::BedEnds { .. }))), "{refused:?}");
        assert_eq!(contact.state(), before);
    }
    // It goes on as if nothing had been asked.
    assert!(contact.step(0.1, Control::Load(load)).is_ok());
    let course = ControlHistory::Load(PiecewiseLinear::step(load).unwrap());
    assert!(contact.follow(&course, &[0.05]).is_err());
    assert!(contact.follow(&course, &[f64::NAN]).is_err());
    assert!(contact.follow(&course, &[1.0, 0.5]).is_err());
    for steps in [
        Steps { first: 0.0, ..Steps::default() },
        Steps { first: f64::NAN, ..Steps::default() },
        Steps { growth: 0.5, ..Steps::default() },
        Steps { growth: f64::INFINITY, ..Steps::default() },
    ] {
        assert!(steps.times(&solid(), course.corners(), 1.0).is_err());
    }
    assert!(Steps::default().times(&solid(), course.corners(), f64::INFINITY).is_err());
    let elastic = Prony::elastic(1.0).unwrap();
    assert!(Steps::default().times(&elastic, course.corners(), 1.0).unwrap().len() > 3);
    assert_eq!(Steps::default().times(&solid(), course.corners(), -1.0).unwrap(), [-1.0]);
}

/// Paths that are no bed have been refused before: empty ones, and those that begin elsewhere.
#[test]
fn a_path_of_one_state_is_a_bed() {
    let one = history(1);
    let bed = Bed::new(&one).unwrap();
    let creep = Creep::new(&bed, &solid(), &PiecewiseLinear::step(0.0).unwrap()).unwrap();
    assert_eq!(creep.at(1.0).unwrap().contact_nodes, 1);
    assert_eq!(creep.times().len(), 1);
    let loaded = Creep::new(&bed, &solid(), &PiecewiseLinear::step(1.0).unwrap()).unwrap();
    assert!(loaded.at(1.0).is_err());
    let mut contact = ViscoelasticBed::new(&bed, &solid()).unwrap();
    assert!(contact.step(1.0, Control::Load(0.0)).is_ok());
    assert!(contact.step(1.0, Control::Load(1.0)).is_err());
    assert!(contact.step(1.0, Control::Approach(-1.0)).is_ok());
    assert!(contact.step(1.0, Control::Approach(1.0)).is_err());
}

/// A body that hardly is one: numbers of any size, and what comes out is finite or an error.
fn check(body: &Prony, corners: &PiecewiseLinear, time: f64, bed: &Bed) {
    if let Ok(creep) = Creep::new(bed, body, corners) {
        if let Ok(state) = creep.at(time) {
            assert!(state.effective_load.is_finite() && state.approach.is_finite(), "{state:?}");
            if let Ok(pressure) = creep.pressure(time, 10) {
                assert!(pressure.load().is_finite());
            }
        }
        let times = creep.times();
        assert!(times.windows(2).all(|pair| pair[0] <= pair[1]), "{times:?}");
        if let Ok(unloading) = Unloading::new(&creep)
            && let Ok(state) = unloading.at(time)
        {
            assert!(state.contact.load.is_finite());
        }
    }
    if let Ok(relaxation) = Relaxation::new(bed, body, corners)
        && let Ok(state) = relaxation.at(time)
    {
        assert!(state.load.is_finite(), "{state:?}");
    }
    let mut contact = ViscoelasticBed::new(bed, body).unwrap();
    let times = [0.25 * time, 0.5 * time, time];
    if let Ok(states) = contact.follow(&ControlHistory::Load(corners.clone()), &times) {
        assert!(states.iter().all(|state| state.approach.is_finite()), "{states:?}");
    }
    let mut contact = ViscoelasticBed::new(bed, body).unwrap();
    if let Ok(states) = contact.follow(&ControlHistory::Approach(corners.clone()), &times) {
        assert!(states.iter().all(|state| state.load.is_finite()), "{states:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn numbers_of_any_size(
        terms in prop::collection::vec((-300.0..300.0_f64, -300.0..300.0_f64), 0..4),
        equilibrium in prop_oneof![Just(0.0), (-300.0..300.0_f64).prop_map(|x| 10_f64.powf(x))],
        corners in prop::collection::vec((-300.0..300.0_f64, prop_oneof![Just(0.0), (-30.0..3.0_f64).prop_map(|x| 10_f64.powf(x))]), 1..5),
        time in -300.0..300.0_f64,
    ) {
        let history = history(60);
        let bed = Bed::new(&history).unwrap();
        let terms: Vec<_> = terms.iter().map(|t| (10_f64.powf(t.0), 10_f64.powf(t.1))).collect();
        let Ok(body) = Prony::relaxation(equilibrium, &terms) else {
            return Ok(());
        };
        let Ok(body) = body.relative_to(body.instantaneous_modulus()) else {
            return Ok(());
        };
        let mut now = 0.0;
        let corners = corners.iter().map(|(duration, load)| {
            now += 10_f64.powf(*duration);
            (now, load * bed.last_load())
        });
        let corners: Vec<_> = corners.collect();
        let Ok(corners) = PiecewiseLinear::new(corners) else {
            return Ok(());
        };
        check(&body, &corners, 10_f64.powf(time), &bed);
    }

    #[test]
    fn any_bits_at_all(
        terms in prop::collection::vec((any::<f64>(), any::<f64>()), 0..4),
        equilibrium in any::<f64>(),
        corners in prop::collection::vec((any::<f64>(), any::<f64>()), 0..5),
        time in any::<f64>(),
    ) {
        let history = history(20);
        let bed = Bed::new(&history).unwrap();
        let body = Prony::relaxation(equilibrium, &terms).ok();
        let body = body.or_else(|| Prony::creep(equilibrium, &terms, time).ok());
        if let (Some(body), Ok(corners)) = (body, PiecewiseLinear::new(corners)) {
            let _ = Creep::new(&bed, &body, &corners).map(|creep| creep.at(time).is_ok());
            let _ = Relaxation::new(&bed, &body, &corners).map(|held| held.at(time).is_ok());
        }
    }
}

/// A load that is held over all decades of a series, as master curves of rubber have them: the pressure carries it at
/// any time. What the weight of an increment is off by is the rounding of a few numbers of its size.
#[test]
fn pressures_carry_the_load_after_any_time() {
    let history = history(24);
    let bed = Bed::new(&history).unwrap();
    let load = 0.3 * bed.last_load();
    for terms in [&[(1e-6, 0.2), (1e-2, 0.2), (1e3, 0.2)][..], &[(1e-9, 0.5)], &[(1.0, 0.5)]] {
        let body = Prony::shares(terms).unwrap();
        let held = Creep::new(&bed, &body, &PiecewiseLinear::step(load).unwrap()).unwrap();
        for time in [0.0, 1e-6, 1.0, 1e4, 1e8, 1e12, 1e20] {
            let carried = held.pressure(time, usize::MAX).unwrap().load();
            assert!(
                (carried / load - 1.0).abs() < 1e-12,
                "{terms:?} at {time} s: {carried} {load}"
            );
        }
    }
}

/// A ramp so long that its times are known to a minute only, which is far longer than a body takes to relax.
#[test]
fn pressures_carry_the_load_of_a_ramp_at_late_times() {
    let history = history(24);
    let bed = Bed::new(&history).unwrap();
    let (start, end) = (1.1e11, 7.5e17);
    let last = bed.approaches().last().unwrap();
    let ramp = PiecewiseLinear::new([(start, 0.0), (end, *last)]).unwrap();
    let body = Prony::relaxation(0.0, &[(1e-3, 0.5), (1e8, 0.5)]).unwrap();
    let pressed = Relaxation::new(&bed, &body, &ramp).unwrap();
    for k in 1..4000 {
        let time = start + end * 10_f64.powf(f64::from(k) / 1000.0 - 4.0);
        let load = pressed.at(time).unwrap().load;
        let carried = pressed.pressure(time, usize::MAX).unwrap().load();
        // A minute of 10⁸ s.
        assert!((carried / load - 1.0).abs() < 1e-6, "{time} s: {carried} {load}");
    }
}
