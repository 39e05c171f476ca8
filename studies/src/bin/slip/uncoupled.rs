//! Joints of bodies alike: Cerruti's half-space, with tractions of both directions, against the scalar theory.

use std::fmt::Write as _;

use asperity::bed::Bed;
use asperity::slip::{Friction, PartialSlip};
use asperity_cli::outcome::Failure;
use nalgebra::DVector;

use crate::cerruti::Cerruti;
use crate::coulomb::Coulomb;
use crate::joints::{FRICTION, LEVELS, Pressed, SIDE};

/// Steps between two levels.
const STEPS: usize = 6;

pub(crate) fn write(nodes: usize, text: &mut String) -> Result<(), Failure> {
    let _ = write!(
        text,
        "\n### Bodies alike, without the assumption of one direction\n\nSurfaces of {SIDE} × {SIDE} nodes, of which {nodes} are in contact, \
         μ = {FRICTION}, sheared once by an incremental solution of Coulomb's law on all nodes: tractions along both directions within discs, \
         influences of Cerruti's half-space. β is 0. Tangential load and dissipation over those that the path gives, at displacements \
         U over κμδ; the last column is what acts across, Σ|q_y|/Σ|q_x| at 0.6.\n\n\
         | surface | ν | T at U = 0.03, 0.1, 0.3, 0.6, 0.9 | D | across |\n|---|---|---|---|---|\n"
    );
    let failed = |error: asperity::Error| Failure::new("cannot press a surface", error);
    let made = [
        (Pressed::sphere(nodes), &[0.0, 0.3, 0.5][..]),
        (Pressed::rough(1, nodes), &[0.3, 0.5]),
        (Pressed::rough(2, nodes), &[0.3, 0.5]),
        (Pressed::rough(4, nodes), &[0.3]),
        (Pressed::ridges(5, true, nodes), &[0.3]),
        (Pressed::ridges(5, false, nodes), &[0.3]),
    ];
    for (pressed, ratios) in made {
        let pressed = pressed.map_err(failed)?;
        for &ratio in ratios {
            eprintln!("{}, ν = {ratio}", pressed.name);
            let row = shear(&pressed, ratio)?;
            let _ = writeln!(text, "| {} | {ratio} | {row} |", pressed.name);
        }
    }
    Ok(())
}

fn shear(pressed: &Pressed, ratio: f64) -> Result<String, Failure> {
    let failed = |error: asperity::Error| Failure::new("cannot shear a joint", error);
    let friction = Friction::between(FRICTION, (1.0, ratio), Some((1.0, ratio))).map_err(failed)?;
    let bed = Bed::new(&pressed.history).map_err(failed)?;
    let joint = PartialSlip::new(&bed, pressed.load, friction).map_err(failed)?;

    let half_space = Cerruti::new(SIDE, ratio);
    let mut coulomb = Coulomb::new(&half_space, &pressed.order);
    let pressure = pressed.pressure.as_slice();
    let limits: Vec<f64> = pressed.order.iter().map(|&node| FRICTION * pressure[node]).collect();
    let count = 2 * pressed.order.len();
    let (mut before, mut lost, mut from) = (DVector::zeros(count), 0.0, 0.0);
    let (mut forces, mut losses, mut across) = (Vec::new(), Vec::new(), 0.0);
    for level in LEVELS {
        for step in 1..=STEPS {
            let to = from + (level - from) * step as f64 / STEPS as f64;
            let last = from + (level - from) * (step - 1) as f64 / STEPS as f64;
            let shift = (to - last) * joint.sliding_displacement();
            let rigid = DVector::from_fn(count, |k, _| if k % 2 == 0 { shift } else { 0.0 });
            coulomb.solve(&(&before + &rigid), &limits)?;
            let now = coulomb.displacement();
            lost += coulomb.traction.dot(&(&rigid - &now + &before));
            before = now;
        }
        from = level;
        let theory =
            joint.cycle_of_displacement(level * joint.sliding_displacement()).map_err(failed)?;
        forces.push(format!("{:.4}", coulomb.force() / theory.amplitude));
        losses.push(format!("{:.3}", lost / (0.25 * theory.dissipation)));
        if level == 0.6 {
            across = coulomb.across();
        }
    }
    Ok(format!("{} | {} | {:.0} %", forces.join(", "), losses.join(", "), 100.0 * across))
}
