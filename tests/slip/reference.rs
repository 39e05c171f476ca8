//! A history of (P, T) on a rough surface, solved by a bound-constrained quadratic programme that stops at every event
//! and shares no code with this crate: `tests/data/slip`.

use std::path::Path;

use asperity::bed::Bed;
use asperity::slip::{Friction, PartialSlip, SlipHistory};
use asperity::{Boussinesq, Grid, LoadingSolver};
use asperity_testing::close::relative;

use crate::common::surface;
use crate::joints::read;

/// Of `tests/data/slip/selfaffine_48.json`.
const FRICTION: f64 = 0.4;
const COMPLIANCE_RATIO: f64 = 1.2142857142857144;
const PRELOAD: f64 = 9.75e-07;

/// Both solvers err by the condition number of the contact, some 10³, times 10⁻¹⁶, and the dissipation by that over the
/// share of the work that is lost: 10⁻² at least.
const EXACT: f64 = 1e-11;
const LOST: f64 = 1e-10;

/// Load, tangential load, displacement, and energy lost where the load has been constant so far.
fn rows() -> Vec<(f64, f64, f64, Option<f64>)> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/slip/selfaffine_48.csv");
    let text = std::fs::read_to_string(file).unwrap();
    let lines = text.lines().skip(1).map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |k: usize| fields[k].parse().unwrap();
        (number(0), number(1), number(2), fields[3].parse().ok())
    });
    lines.collect()
}

#[test]
fn a_history_of_both_loads() {
    let heights = surface("selfaffine_48");
    let kernel = Boussinesq::new(Grid::square(48, 1e-2).unwrap(), 1.0).unwrap();
    let (mut path, history) =
        read(LoadingSolver::builder(&heights, &kernel).max_load(1.35 * PRELOAD));
    let bed = Bed::new(&history).unwrap();
    let friction = Friction::new(FRICTION, COMPLIANCE_RATIO).unwrap();

    let mut joint = SlipHistory::new(&bed, friction);
    joint.to(PRELOAD, 0.0).unwrap();
    let rows = rows();
    assert_eq!(rows.len(), 23);
    let mut worst = [0.0_f64; 3];
    let scale = rows.iter().fold(0.0_f64, |most, row| most.max(row.2.abs()));
    for (load, force, displacement, lost) in rows {
        let state = joint.to(load, force).unwrap();
        assert!((state.tangential_load - force).abs() < 1e-15 * FRICTION * PRELOAD * 10.0);
        let error = (state.displacement - displacement).abs() / scale;
        worst[0] = worst[0].max(error);
        assert!(error < EXACT, "{load} {force}: {error:e}");
        if let Some(lost) = lost {
            let error = relative(joint.dissipation(), lost);
            worst[1] = worst[1].max(error);
            assert!(error < LOST, "{load} {force}: {error:e}");
        }
    }
    // The last traction, at nodes that the truth names.
    let traction = joint.traction(&mut path).unwrap();
    let greatest = traction.amax();
    for (node, expected) in [
        ((30, 8), 0.011986939162081907),
        ((14, 27), 0.04163384136989405),
        ((1, 40), 0.004213363338528069),
        ((47, 26), -0.028039985343093512),
        ((1, 8), -0.01504738147088582),
    ] {
        // The truth's own residual is 7e-14; pressures lose a digit or two more.
        let error = (traction[node] - expected).abs() / greatest;
        worst[2] = worst[2].max(error);
        assert!(error < 1e-11, "{node:?}: {error:e}");
    }
    println!("worst errors of U, D and traction: {worst:?}");

    // Cycles at constant load; 30 µm of 95 µm at 0.9 of the limit.
    let joint = PartialSlip::new(&bed, PRELOAD, friction).unwrap();
    for (amplitude, displacement, lost) in [
        (3.9000000000000005e-08, 5.214161340717716e-06, 2.8419110366668125e-15),
        (1.17e-07, 1.6008204733784562e-05, 9.490560716096823e-14),
        (2.34e-07, 3.408191154373532e-05, 1.296770963248212e-12),
        (3.51e-07, 6.020821171603751e-05, 1.0970449275845175e-11),
        (3.9e-07, 9.46033491602848e-05, 5.221373105584242e-11),
    ] {
        let cycle = joint.cycle(amplitude).unwrap();
        assert!(relative(cycle.displacement, displacement) < EXACT);
        assert!(relative(cycle.dissipation, lost) < LOST, "{amplitude}");
    }
}
