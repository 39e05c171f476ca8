//! A path of 262 144 states, whose curves take some tenths of a second: printed, and not tested.

use std::time::Instant;

use asperity::bed::Bed;
use asperity::creep::{Control, Creep, PiecewiseLinear, Prony, ViscoelasticBed};
use asperity::loading::History;
use asperity::{ContactEvent, ContactState, Grid, LoadingState};

/// A path by formula: loads that grow by the square of the area, and gaps that close in proportion to its root.
fn long_path() -> History {
    let side = 512;
    let grid = Grid::square(side, 1.0).unwrap();
    let states = (0..side * side).map(|k| {
        let part = k as f64 / (side * side) as f64;
        let load = part * part;
        let approach = 1e-3 * part.sqrt() * (1.0 + part);
        let mean_gap = 2e-3 * (1.0 - part.sqrt());
        let mut contact = ContactState::new(&grid, k + 1, approach, load, mean_gap);
        contact.contact_stiffness = Some(1e3);
        contact.interfacial_stiffness = Some(1e3);
        LoadingState::new(k + 1, ContactEvent::Touch, (k % side, k / side), contact)
    });
    states.collect()
}

/// Times of all events, two hundred states, and the weights of all increments; and a hundred steps of the bed. What it
/// took is printed, and not tested: a busy machine is no error.
#[test]
fn a_long_path_is_evaluated_at_once() {
    let history = long_path();
    let start = Instant::now();
    let bed = Bed::new(&history).unwrap();
    let body = Prony::shares(&[(0.1, 0.2), (1.0, 0.3), (30.0, 0.2)]).unwrap();
    let load = PiecewiseLinear::ramp(0.25, 1.0).unwrap();
    let creep = Creep::new(&bed, &body, &load).unwrap();
    let times = creep.times();
    let curve: Vec<_> =
        (0..200).map(|k| creep.at(10_f64.powf(-3.0 + 0.03 * f64::from(k))).unwrap()).collect();
    let curves = start.elapsed();
    let carried = creep.pressure(100.0, 40).unwrap().load();
    let weights = start.elapsed() - curves;
    let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
    for k in 1..=100 {
        contact.step(0.01, Control::Load(0.0025 * f64::from(k))).unwrap();
    }
    let steps = start.elapsed() - curves - weights;
    println!("curves {curves:?}, weights {weights:?}, 100 steps {steps:?}");
    // 0.25/0.3 of the load in the end, of which the area is the root.
    let last = curve.last().unwrap();
    assert!((last.contact_area_fraction / (0.25_f64 / 0.3).sqrt() - 1.0).abs() < 1e-5);
    let reached = (0.25_f64 / 0.3).sqrt() * (512.0 * 512.0);
    assert!((times.len() as f64 - reached).abs() < 2.0, "{} {reached}", times.len());
    assert!((carried / 0.25 - 1.0).abs() < 1e-11, "{carried}");
    let expected = creep.at(1.0).unwrap();
    assert_eq!(contact.state().contact_nodes, expected.contact_nodes);
}
