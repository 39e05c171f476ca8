//! Joints of bodies alike: Cerruti's half-space, with tractions of both directions, against the scalar theory.

use std::fmt::Write as _;

use asperity::bed::Bed;
use asperity::slip::{Friction, PartialSlip};
use asperity_cli::outcome::Failure;
use nalgebra::DVector;

use crate::cerruti::Cerruti;
use crate::coulomb::Coulomb;
use crate::joints::{FRICTION, LEVELS, Pressed, SIDE, ranges};

/// Steps between two levels.
const STEPS: usize = 6;

pub(crate) fn write(nodes: usize, text: &mut String) -> Result<(), Failure> {
    let _ = write!(
        text,
        "\n### Bodies alike, without the assumption of one direction\n\nSurfaces of {SIDE} × {SIDE} nodes, of which \
         {nodes} are in contact, μ = {FRICTION}, sheared once by an incremental solution of Coulomb's law on all \
         nodes, with tractions along both directions and influences of Cerruti's half-space. T and D over what the \
         path gives, at displacements U over κμδ, of several seeds least and greatest; *across* is Σ|q_y|/Σ|q_x| at \
         0.6.\n\n\
         | surface | ν | T at U = 0.03, 0.1, 0.3, 0.6, 0.9 | D | across |\n|---|---|---|---|---|\n"
    );
    let failed = |error: asperity::Error| Failure::new("cannot press a surface", error);
    let sphere = || vec![Pressed::sphere(nodes)];
    let rough = |seeds: &[u64]| seeds.iter().map(|&seed| Pressed::rough(seed, nodes)).collect();
    let ridges = |along_x| vec![Pressed::ridges(5, along_x, nodes)];
    let made = [
        ("sphere", 0.0, sphere()),
        ("sphere", 0.5, sphere()),
        ("rough, 3 seeds", 0.3, rough(&[1, 2, 4])),
        ("rough, 2 seeds", 0.5, rough(&[1, 2])),
        ("ridges 4:1 along T", 0.3, ridges(true)),
        ("ridges 4:1 across T", 0.3, ridges(false)),
    ];
    for (name, ratio, surfaces) in made {
        let mut found: [Vec<Vec<f64>>; 3] = Default::default();
        for pressed in surfaces {
            eprintln!("{name}, ν = {ratio}");
            for (of, values) in found.iter_mut().zip(shear(&pressed.map_err(failed)?, ratio)?) {
                of.push(values);
            }
        }
        let [forces, losses, across] = found;
        let (forces, losses, across) = (ranges(&forces, 4), ranges(&losses, 3), ranges(&across, 0));
        let _ = writeln!(text, "| {name} | {ratio} | {forces} | {losses} | {across} % |");
    }
    Ok(())
}

/// T and D at each level, and what acts across, in per cent.
fn shear(pressed: &Pressed, ratio: f64) -> Result<[Vec<f64>; 3], Failure> {
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
        forces.push(coulomb.force() / theory.amplitude);
        losses.push(lost / (0.25 * theory.dissipation));
        if level == 0.6 {
            across = coulomb.across();
        }
    }
    Ok([forces, losses, vec![100.0 * across]])
}
