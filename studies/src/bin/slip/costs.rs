//! What the curves of a long path cost.

use std::fmt::Write as _;
use std::time::Instant;

use asperity::bed::Bed;
use asperity::contact::ContactState;
use asperity::loading::History;
use asperity::reference::HertzSphere;
use asperity::slip::{Friction, PartialSlip, SlipHistory};
use asperity::{ContactEvent, Error, Grid, LoadingState};

/// Nodes along a side of the path.
const SIDE: usize = 512;
/// Amplitudes of a curve, and steps of a history.
const AMPLITUDES: usize = 1000;
const STEPS: usize = 10_000;

pub(crate) fn write(text: &mut String) -> Result<(), Error> {
    let history = history()?;
    let start = Instant::now();
    let bed = Bed::new(&history)?;
    let load = 0.9 * bed.last_load();
    let friction = Friction::new(0.3, 1.2)?;
    let joint = PartialSlip::new(&bed, load, friction)?;
    let made = start.elapsed().as_secs_f64();

    let start = Instant::now();
    for k in 1..=AMPLITUDES {
        let force = joint.sliding_load() * k as f64 / AMPLITUDES as f64;
        joint.monotone(force)?;
        joint.cycle(force)?;
    }
    let curves = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let elements = joint.jenkins_elements().count();
    let iwan = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let mut sheared = SlipHistory::new(&bed, friction);
    for k in 0..STEPS {
        // Two waves that do not repeat.
        let (p, t) = (f64::from(k as u32).sin(), (1.7 * f64::from(k as u32)).sin());
        let load = load * (0.6 + 0.35 * p);
        sheared.to(load, 0.29 * load * t)?;
    }
    let steps = start.elapsed().as_secs_f64();
    // Writing to a text cannot fail.
    let _ = write!(
        text,
        "\n### What it costs\n\nOn a path of {} states, one core: the joint {:.0} ms, {AMPLITUDES} amplitudes, first \
         loading and cycle, {:.1} ms, the {elements} elements {:.1} ms, and a history of {STEPS} steps of both loads \
         {:.0} ms.\n",
        history.states().len(),
        1e3 * made,
        1e3 * curves,
        1e3 * iwan,
        1e3 * steps
    );
    Ok(())
}

/// States of as many nodes as a grid has, with the loads of a sphere.
fn history() -> Result<History, Error> {
    let (grid, sphere) = (Grid::square(SIDE, 1.0)?, HertzSphere::new(1.0, 1.0)?);
    let count = grid.nodes();
    let states = (0..count).map(|k| {
        let approach = 1e-2 * k as f64 / count as f64;
        let mean_gap = 1e-2 - 0.1 * approach;
        let mut contact =
            ContactState::new(&grid, k + 1, approach, sphere.load(approach), mean_gap);
        contact.contact_stiffness = Some(sphere.contact_stiffness(approach).max(1e-6));
        contact.interfacial_stiffness = contact.contact_stiffness;
        LoadingState::new(k + 1, ContactEvent::Touch, grid.coordinates(k), contact)
    });
    Ok(states.collect())
}
