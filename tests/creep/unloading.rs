//! One unloading as a root, against the bed in steps of time.

use asperity::bed::Bed;
use asperity::creep::{ControlHistory, Creep, PiecewiseLinear, Prony, Unloading, ViscoelasticBed};
use asperity::loading::History;
use asperity::{Boussinesq, CreepError, Error, Grid, LoadingSolver};

use crate::stepping::rough;

fn history() -> (LoadingSolver, History) {
    let grid = Grid::square(16, 1.0).unwrap();
    let half_space = Boussinesq::new(grid, 1.0).unwrap();
    let mut path = LoadingSolver::builder(&rough(&grid, 5), &half_space).build().unwrap();
    let history = path.by_ref().collect::<Result<_, _>>().unwrap();
    (path, history)
}

/// Up in a second and down in another: the contact is that of an earlier time, and so are pressures but for relaxation.
/// The bed converges to both with the square of its steps; the elastic state at the effective load, taken in spite of
/// its fall, has far too many nodes.
#[test]
fn contact_is_that_of_an_earlier_time() {
    let (mut path, history) = history();
    let bed = Bed::new(&history).unwrap();
    let body = Prony::relaxation(0.2, &[(1.0, 0.3), (0.1, 0.5)]).unwrap();
    let load = bed.loads()[50];
    let corners = PiecewiseLinear::ramp(load, 1.0).unwrap().to(0.0, 1.0).unwrap();
    let creep = Creep::new(&bed, &body, &corners).unwrap();
    // The effective load of two ramps does not know the surface: with W = t up to 1 it falls from 1.098012 on.
    let recession = creep.recession().unwrap();
    assert!((recession.time - 1.098012).abs() < 1e-6, "{recession:?}");
    assert!(!recession.is_jump);
    let Err(Error::Creep(CreepError::ContactRecedes { time, effective_load })) = creep.at(1.2)
    else {
        panic!("it recedes");
    };
    assert_eq!((time, effective_load), (recession.time, recession.effective_load));
    let unloading = Unloading::new(&creep).unwrap();
    assert_eq!(unloading.returns(), None);
    let times = [0.5, 1.05, 1.3, 1.5, 1.7, 1.9];
    let mut errors = Vec::new();
    for steps in [50, 100, 200, 400] {
        let all: Vec<f64> = (0..=2 * steps).map(|k| k as f64 / steps as f64).collect();
        let mut worst = 0.0_f64;
        for time in times {
            let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
            let up_to: Vec<f64> = all.iter().copied().filter(|t| *t <= time + 1e-9).collect();
            let states = contact.follow(&ControlHistory::Load(corners.clone()), &up_to).unwrap();
            let time = states.last().unwrap().time;
            let expected = unloading.at(time).unwrap();
            if steps == 400 {
                assert_eq!(
                    states.last().unwrap().contact_nodes,
                    expected.contact.contact_nodes,
                    "{time}"
                );
                assert_eq!(expected.contact_time < time, time > recession.time);
                let naive = bed.at_load(creep.effective_load(time)).unwrap().contact_nodes;
                println!(
                    "{time}: {} nodes, {naive} at the effective load",
                    expected.contact.contact_nodes
                );
                assert!(naive >= expected.contact.contact_nodes);
                assert!(time < 1.6 || naive as f64 > 1.2 * expected.contact.contact_nodes as f64);
            }
            let truth = unloading.pressure(time, usize::MAX).unwrap();
            // ∫ R dW_e up to the root: to the rounding of times, on a load that goes down to a tenth.
            assert!((truth.load() / expected.load - 1.0).abs() < 1e-12, "{time}");
            let truth = truth.pressure(&bed, &mut path).unwrap();
            let found = contact.pressure(usize::MAX).unwrap().pressure(&bed, &mut path).unwrap();
            worst = worst.max((found - &truth).abs().max() / truth.max());
        }
        errors.push(worst);
    }
    println!("{errors:?}");
    for pair in errors.windows(2) {
        // Elements that come free within a step are met at its end: the order is two, with some scatter.
        assert!(pair[1] < 0.45 * pair[0], "{errors:?}");
    }
    assert!(errors[3] < 3e-5, "{errors:?}");
}

/// The end of a single unloading: the load held again grows the contact, as the bed has it.
#[test]
fn a_hold_after_unloading_brings_contact_back() {
    let (_, history) = history();
    let bed = Bed::new(&history).unwrap();
    let body = Prony::relaxation(0.2, &[(1.0, 0.3), (0.1, 0.5)]).unwrap();
    let load = bed.loads()[50];
    let corners = PiecewiseLinear::ramp(load, 1.0)
        .unwrap()
        .to(0.5 * load, 0.3)
        .unwrap()
        .to(0.2 * load, 0.1)
        .unwrap();
    let held = corners.clone().hold(1.0).unwrap().to(0.0, 1.0).unwrap();
    let creep = Creep::new(&bed, &body, &held).unwrap();
    let unloading = Unloading::new(&creep).unwrap();
    let returns = unloading.returns().unwrap();
    assert!((returns - 1.4).abs() < 1e-12);
    assert!(unloading.at(1.4).is_ok());
    let refused = unloading.at(1.41);
    assert!(matches!(refused, Err(Error::Creep(CreepError::ContactReturns { .. }))), "{refused:?}");
    let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
    let times: Vec<f64> = (0..=2000).map(|k| 1e-3 * f64::from(k)).collect();
    let states = contact.follow(&ControlHistory::Load(held), &times).unwrap();
    assert!(states[1900].contact_nodes > states[1400].contact_nodes);
    // Taken away at once, part by part: each time the contact shrinks, and comes back.
    let steps = PiecewiseLinear::step(load).unwrap().hold(1.0).unwrap().jump(0.4 * load).unwrap();
    let creep = Creep::new(&bed, &body, &steps).unwrap();
    let recession = creep.recession().unwrap();
    assert!(recession.is_jump && recession.time == 1.0);
    assert!(creep.at(1.0 - 1e-12).is_ok() && creep.at(1.0).is_err());
    let unloading = Unloading::new(&creep).unwrap();
    let state = unloading.at(1.0).unwrap();
    assert!(state.contact_time < 1.0 && state.contact.load < recession.effective_load);
    assert_eq!(unloading.returns(), Some(1.0));
    assert!(
        (unloading.pressure(1.0, usize::MAX).unwrap().load() / (0.4 * load) - 1.0).abs() < 1e-12
    );
    let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
    let times: Vec<f64> = (0..=1000).map(|k| 1e-3 * f64::from(k)).collect();
    let states = contact.follow(&ControlHistory::Load(steps), &times).unwrap();
    assert_eq!(states[1000].contact_nodes, state.contact.contact_nodes);
}

/// A load that was put on at once is taken off: the contact is that of a part of the jump, as in the bed, and its
/// pressure carries the load.
#[test]
fn what_was_put_on_at_once_is_taken_off_in_part() {
    let (_, history) = history();
    let bed = Bed::new(&history).unwrap();
    let body = Prony::relaxation(0.2, &[(1.0, 0.3), (0.1, 0.5)]).unwrap();
    let load = bed.loads()[50];
    let corners = PiecewiseLinear::step(load).unwrap().hold(0.5).unwrap().to(0.0, 1.0).unwrap();
    let creep = Creep::new(&bed, &body, &corners).unwrap();
    let unloading = Unloading::new(&creep).unwrap();
    assert_eq!(unloading.returns(), None);
    let steps = 400;
    let times: Vec<f64> = (0..=3 * steps / 2).map(|k| f64::from(k) / f64::from(steps)).collect();
    let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
    let states = contact.follow(&ControlHistory::Load(corners), &times).unwrap();
    let mut within = 0;
    for state in states.iter().filter(|state| state.time > 0.5) {
        let found = unloading.at(state.time).unwrap();
        within += usize::from(found.contact_time == 0.0 && found.contact.load < load);
        let carried = unloading.pressure(state.time, usize::MAX).unwrap().load();
        assert!((carried - state.load).abs() < 1e-10 * load, "{state:?}: {carried}");
        // Of steps of 1/400.
        let nodes = found.contact.contact_nodes.abs_diff(state.contact_nodes);
        assert!(nodes <= 1, "{state:?}: {found:?}");
    }
    assert!(within > 100, "{within}");
}

/// A load that comes back to what it was before a jump leaves nothing of the jump, whatever rounding does.
#[test]
fn nothing_is_left_of_a_jump_that_is_taken_back() {
    let (_, history) = history();
    let bed = Bed::new(&history).unwrap();
    let elastic = Prony::relaxation(1.0, &[]).unwrap();
    for (k, knot) in bed.loads().iter().take(60).enumerate().skip(1) {
        let (low, high) = (knot / 1.37, 0.9 * bed.last_load());
        for (begin, duration) in [(0.0, 0.1 * k as f64), (1.3423e7, 1.2e-5)] {
            let on = begin + duration;
            let corners = [(begin, 0.0), (on, low), (on, high), (on + 1.0, low)];
            let corners = PiecewiseLinear::new(corners).unwrap();
            let creep = Creep::new(&bed, &elastic, &corners).unwrap();
            let state = Unloading::new(&creep).unwrap().at(on + 1.0).unwrap();
            assert!((state.contact.load / low - 1.0).abs() < 1e-9, "{low}: {state:?}");
        }
    }
}

/// What goes on for a hundredth of the time since the contact was made is over: a hold brings nothing back. A load that
/// is left by rounding is none.
#[test]
fn what_is_over_brings_nothing_back() {
    let (_, history) = history();
    let bed = Bed::new(&history).unwrap();
    let load = bed.loads()[50];
    let corners = PiecewiseLinear::ramp(load, 20.0).unwrap().to(0.4 * load, 20.0).unwrap();
    let corners = corners.hold(5.0).unwrap();
    for (time, returns) in [(0.017, None), (0.05, None), (0.2, None), (10.0, Some(40.0))] {
        let body = Prony::relaxation(0.5, &[(time, 0.5)]).unwrap();
        let creep = Creep::new(&bed, &body, &corners).unwrap();
        let unloading = Unloading::new(&creep).unwrap();
        assert_eq!(unloading.returns(), returns, "{time}");
        if returns.is_none() {
            let [then, later] = [40.0, 1e4].map(|time| unloading.at(time).unwrap().contact.load);
            assert!((later / then - 1.0).abs() < 1e-11, "{time}: {then} {later}");
        }
    }
    let body = Prony::relaxation(0.5, &[(1.0, 0.5)]).unwrap();
    let corners = PiecewiseLinear::ramp(0.3 * load, 1.0).unwrap();
    let corners = corners.to(load * (0.1 * 3.0 - 0.3), 1.0).unwrap().hold(1.0).unwrap();
    let creep = Creep::new(&bed, &body, &corners).unwrap();
    let unloading = Unloading::new(&creep).unwrap();
    assert_eq!((unloading.returns(), unloading.at(2.5).unwrap().contact.load), (None, 0.0));
}

/// What is left of a load, however little, presses a body that flows further and further together.
#[test]
fn little_of_a_load_brings_contact_back() {
    let (_, history) = history();
    let bed = Bed::new(&history).unwrap();
    let body = Prony::relaxation(0.0, &[(1.0, 1.0)]).unwrap();
    let load = bed.loads()[50];
    for part in [1e-13, 1e-11, 1e-6] {
        let corners = PiecewiseLinear::ramp(load, 1.0).unwrap().jump(part * load).unwrap();
        let creep = Creep::new(&bed, &body, &corners.hold(40.0).unwrap()).unwrap();
        assert_eq!(Unloading::new(&creep).unwrap().returns(), Some(1.0), "{part}");
    }
}

/// Up and down at one rate, of an elastic body: the contact is that of the same load on the way up.
#[test]
fn elastic_contact_was_made_at_the_same_load() {
    let (_, history) = history();
    let bed = Bed::new(&history).unwrap();
    let load = bed.loads()[50];
    let corners = PiecewiseLinear::ramp(load, 1.0).unwrap().to(0.0, 1.0).unwrap();
    let creep = Creep::new(&bed, &Prony::relaxation(1.0, &[]).unwrap(), &corners).unwrap();
    let unloading = Unloading::new(&creep).unwrap();
    for time in [1.1, 1.37, 1.5, 1.93] {
        let state = unloading.at(time).unwrap();
        assert!((state.contact_time - (2.0 - time)).abs() < 1e-12, "{state:?}");
        assert!((state.contact.load / ((2.0 - time) * load) - 1.0).abs() < 1e-11, "{state:?}");
    }
}

/// Just after a jump up the contact has returned.
#[test]
fn contact_returns_with_a_jump() {
    let (_, history) = history();
    let bed = Bed::new(&history).unwrap();
    let body = Prony::relaxation(0.2, &[(1.0, 0.8)]).unwrap();
    let load = bed.loads()[50];
    let corners = PiecewiseLinear::ramp(load, 1.0).unwrap().to(0.0, 1.0).unwrap();
    let corners = corners.jump(0.5 * load).unwrap();
    let creep = Creep::new(&bed, &body, &corners).unwrap();
    let unloading = Unloading::new(&creep).unwrap();
    assert_eq!(unloading.returns(), Some(2.0));
    assert!(unloading.at(2.0_f64.next_down()).is_ok());
    let refused = unloading.at(2.0);
    assert!(matches!(
        refused,
        Err(Error::Creep(CreepError::ContactReturns { time })) if time == 2.0
    ));
}

/// No load has no contact, however little is left of the pressures of a fluid that flowed for long.
#[test]
fn no_load_is_no_contact() {
    let (_, history) = history();
    let bed = Bed::new(&history).unwrap();
    let body = Prony::relaxation(0.0, &[(1.0, 1.0)]).unwrap();
    let load = 1e-6 * bed.loads()[50];
    let corners = PiecewiseLinear::ramp(load, 1.0).unwrap().hold(2000.0).unwrap().jump(0.0);
    let creep = Creep::new(&bed, &body, &corners.unwrap()).unwrap();
    let unloading = Unloading::new(&creep).unwrap();
    assert_eq!(unloading.at(2002.0).unwrap().contact.load, 0.0);
}
