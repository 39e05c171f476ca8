//! A rigid surface on one body, which is coupled: pressed with friction, then sheared, by turns of the normal and the
//! tangential problem.

use std::fmt::Write as _;

use asperity::bed::Bed;
use asperity::slip::{Friction, PartialSlip};
use asperity_cli::outcome::Failure;
use nalgebra::{DMatrix, DVector};

use crate::cerruti::Cerruti;
use crate::coulomb::Coulomb;
use crate::joints::{FRICTION, Pressed, SIDE, ranges};

/// Steps of pressing, and of a quarter of a cycle.
const RAMP: usize = 16;
const QUARTER: usize = 12;
/// Turns of a step, and the change of pressures over the greatest at which they end.
const TURNS: usize = 200;
const SETTLED: f64 = 1e-7;
/// Amplitudes of the displacement, over that of sliding.
const AMPLITUDES: [f64; 4] = [0.1, 0.3, 0.6, 0.9];

pub(crate) fn write(nodes: usize, text: &mut String) -> Result<(), Failure> {
    let _ = write!(
        text,
        "\n### A rigid surface on one body\n\nThe same, but a rigid surface on one body: tractions move the surface \
         normally too, and pressing leaves tractions. Pressed with friction in {RAMP} steps, then sheared between −U \
         and U. T and D of the first loading, and of the second cycle, over what the path gives, at U = {} times κμδ; \
         of several seeds least and greatest.\n\n\
         | surface | ν | β | T, first loading | D, first loading | T, second cycle | D, second cycle \
         |\n|---|---|---|---|---|---|---|\n",
        AMPLITUDES.map(|amplitude| amplitude.to_string()).join(", ")
    );
    let failed = |error: asperity::Error| Failure::new("cannot press a surface", error);
    let rough = |seeds: &[u64]| -> Vec<_> {
        seeds.iter().map(|&seed| Pressed::rough(seed, nodes)).collect()
    };
    for (name, ratio, surfaces) in [
        ("rough, 4 seeds", 0.3, rough(&[1, 2, 3, 4])),
        ("rough", 0.0, rough(&[1])),
        ("rough", 0.45, rough(&[1])),
    ] {
        let mut columns: [Vec<Vec<f64>>; 4] = Default::default();
        let mut coupling = 0.0;
        for pressed in surfaces {
            let pressed = pressed.map_err(failed)?;
            let mut joint: [Vec<f64>; 4] = Default::default();
            for amplitude in AMPLITUDES {
                eprintln!("{name}, ν = {ratio}, rigid against elastic, {amplitude}");
                let (beta, found) = cycle(&pressed, ratio, amplitude)?;
                coupling = beta;
                joint.iter_mut().zip(found).for_each(|(of, value)| of.push(value));
            }
            columns.iter_mut().zip(joint).for_each(|(column, of)| column.push(of));
        }
        let digits = [3, 2, 3, 3];
        let columns: Vec<String> =
            columns.iter().zip(digits).map(|(column, digits)| ranges(column, digits)).collect();
        let _ = writeln!(text, "| {name} | {ratio} | {coupling:.3} | {} |", columns.join(" | "));
    }
    Ok(())
}

/// β, and what the table has.
fn cycle(pressed: &Pressed, ratio: f64, amplitude: f64) -> Result<(f64, [f64; 4]), Failure> {
    let failed = |error: asperity::Error| Failure::new("cannot shear a joint", error);
    let friction = Friction::between(FRICTION, (1.0, ratio), None).map_err(failed)?;
    let beta = friction.dundurs_beta().unwrap_or(0.0);
    let bed = Bed::new(&pressed.history).map_err(failed)?;
    let joint = PartialSlip::new(&bed, pressed.load, friction).map_err(failed)?;
    let far = amplitude * joint.sliding_displacement();
    let theory = joint.cycle_of_displacement(far).map_err(failed)?;

    let mut coupled = Coupled::new(pressed, ratio, beta);
    for step in 1..=RAMP {
        coupled.to(pressed.load * step as f64 / RAMP as f64, 0.0)?;
    }
    // A quarter, and from there two whole cycles.
    let mut losses = vec![coupled.lost];
    let mut forces = Vec::new();
    let ends = [0.0, 1.0, -1.0, 1.0, -1.0, 1.0];
    for ends in ends.windows(2) {
        let steps = if losses.len() == 1 { QUARTER } else { 2 * QUARTER };
        for step in 1..=steps {
            let share = step as f64 / steps as f64;
            coupled.to(pressed.load, far * (ends[0] + share * (ends[1] - ends[0])))?;
        }
        losses.push(coupled.lost);
        forces.push(coupled.tangential.force());
    }
    let first = (losses[1] - losses[0]) / (0.25 * theory.dissipation);
    let second = (losses[5] - losses[3]) / theory.dissipation;
    let force = 0.5 * (forces[4] - forces[3]) / theory.amplitude;
    Ok((beta, [forces[0] / theory.amplitude, first, force, second]))
}

/// Pressures and tractions on all nodes that may touch.
struct Coupled {
    beta: f64,
    normal: DMatrix<f64>,
    coupling: [DMatrix<f64>; 2],
    gap: DVector<f64>,
    pressure: DVector<f64>,
    tangential: Coulomb,
    displacement: DVector<f64>,
    shift: f64,
    lost: f64,
}

impl Coupled {
    fn new(pressed: &Pressed, ratio: f64, beta: f64) -> Self {
        let half_space = Cerruti::new(SIDE, ratio);
        // The nodes in contact, and those whose gap is least besides: twice as many in all.
        let mut nodes = pressed.order.clone();
        let mut others: Vec<usize> =
            (0..SIDE * SIDE).filter(|node| !nodes.contains(node)).collect();
        others.sort_by(|a, b| pressed.gap[*a].total_cmp(&pressed.gap[*b]));
        others.truncate(nodes.len());
        nodes.extend(others);
        let count = nodes.len();
        Self {
            beta,
            normal: half_space.normal(&nodes, &nodes),
            coupling: half_space.coupling(&nodes, &nodes),
            gap: DVector::from_fn(count, |k, _| pressed.gap[nodes[k]]),
            pressure: DVector::zeros(count),
            tangential: Coulomb::new(&half_space, &nodes),
            displacement: DVector::zeros(2 * count),
            shift: 0.0,
            lost: 0.0,
        }
    }

    /// To a load and a displacement along x.
    fn to(&mut self, load: f64, shift: f64) -> Result<(), Failure> {
        let count = self.gap.len();
        let rigid =
            DVector::from_fn(2 * count, |k, _| if k % 2 == 0 { shift - self.shift } else { 0.0 });
        for _ in 0..TURNS {
            let along = |axis: usize| {
                DVector::from_fn(count, |k, _| self.tangential.traction[2 * k + axis])
            };
            let lift = &self.coupling[0] * along(0) + &self.coupling[1] * along(1);
            let gap = &self.gap + lift * self.beta;
            let pressure = press(&self.normal, &gap, load, &self.pressure)?;
            let change = (&pressure - &self.pressure).amax() / pressure.amax();
            self.pressure = pressure;
            let limits: Vec<f64> = self.pressure.iter().map(|p| FRICTION * p.max(0.0)).collect();
            let of_pressure = self.of_pressure();
            self.tangential.solve(&(&self.displacement + &rigid - &of_pressure), &limits)?;
            if change < SETTLED {
                let now = self.tangential.displacement() + of_pressure;
                self.lost += self.tangential.traction.dot(&(&rigid - &now + &self.displacement));
                (self.displacement, self.shift) = (now, shift);
                return Ok(());
            }
        }
        Err(Failure::request("the turns of a step do not settle"))
    }

    /// Tangential displacements under the pressure.
    fn of_pressure(&self) -> DVector<f64> {
        let [x, y] = [0, 1].map(|axis| &self.coupling[axis] * &self.pressure * -self.beta);
        DVector::from_fn(2 * x.len(), |k, _| if k % 2 == 0 { x[k / 2] } else { y[k / 2] })
    }
}

/// Pressures p ≥ 0 that carry a load with gaps ≥ 0, by an active set from that of the last ones.
fn press(
    normal: &DMatrix<f64>,
    gap: &DVector<f64>,
    load: f64,
    last: &DVector<f64>,
) -> Result<DVector<f64>, Failure> {
    let count = gap.len();
    let mut inside: Vec<bool> = last.iter().map(|p| *p > 0.0).collect();
    if !inside.contains(&true) {
        inside.fill(true);
    }
    for _ in 0..TURNS {
        let set: Vec<usize> = (0..count).filter(|&k| inside[k]).collect();
        let part = DMatrix::from_fn(set.len(), set.len(), |i, j| normal[(set[i], set[j])]);
        let factor = part
            .cholesky()
            .ok_or_else(|| Failure::request("the influence matrix is not positive definite"))?;
        let fixed = factor.solve(&DVector::from_fn(set.len(), |k, _| -gap[set[k]]));
        let unit = factor.solve(&DVector::repeat(set.len(), 1.0));
        let approach = (load - fixed.sum()) / unit.sum();
        let mut pressure = DVector::zeros(count);
        for (k, &node) in set.iter().enumerate() {
            pressure[node] = fixed[k] + approach * unit[k];
        }
        let open = normal * &pressure + gap;
        let next: Vec<bool> = (0..count)
            .map(
                |k| if inside[k] { pressure[k] >= 0.0 } else { open[k] < approach * (1.0 - 1e-12) },
            )
            .collect();
        if next == inside {
            return Ok(pressure);
        }
        inside = next;
    }
    Err(Failure::request("the contact of a step does not settle"))
}
