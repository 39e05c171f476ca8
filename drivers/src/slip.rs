//! Joints under loads that come back to where they were: partial slip.

use asperity::bed::Bed;
use asperity::loading::History;
use asperity::slip::{Friction, PartialSlip, SlipHistory};
use asperity::{Error, LoadingState, SlipError};

use crate::draw::Draw;
use crate::kernels;
use crate::problem::Sample;
use crate::springs::Springs;
use crate::variant::{Run, Variant};
use crate::verdict::{Tally, Verdict, Violation, ensure};

/// Knots of a path that rounding moves by more than this part of the approach say nothing of slip.
const WELL_KNOWN: f64 = 1e-9;
/// By how much a tangential load may be off, over the greatest μP: ratios that differ by 10⁻¹² of μ are taken for one,
/// and pieces of 10⁻¹⁴ of the load are left out.
const SNAPPED: f64 = 4e-12;
/// Ratios above this part of μ are taken for it.
const AT_LIMIT: f64 = 1.0 - 1e-12;
/// Loads that lose digits, which are drawn as well \[N\], and displacements \[m\].
const UNDERFLOWS: f64 = 1e-290;

/// Draws a surface on a half-space, a part of its path, friction, and steps of both loads in which equal and nearly
/// equal values return. Displacement, forces of all springs, stored and lost energies are compared with
/// springs from event to event; refusals have to be deserved and change nothing; cycles at constant
/// load are those of a history.
///
/// # Errors
///
/// What is wrong.
pub fn slip(bytes: &[u8]) -> Verdict {
    let mut draw = Draw::new(bytes);
    Sample::look(&mut draw, kernels::GROWING, |sample, draw| run(sample, draw))
}

fn run(sample: &Sample, draw: &mut Draw<'_>) -> Verdict {
    let path = Variant::REFERENCE.run(sample, &[], |_, _| Ok(()))?;
    let Run::Followed { mut states, failure: None, .. } = path else {
        // It is the driver of paths that asks why.
        return Ok(Tally::default());
    };
    if draw.once_in(2) {
        states.truncate(draw.whole(1, states.len().max(1)));
    }
    if draw.once_in(3) {
        let [force, length] = [0, 0].map(|_| 2_f64.powf((draw.between(-100.0, 100.0)).round()));
        states.iter_mut().for_each(|state| in_units(state, force, length));
    }
    let history = History::from_iter(states);
    let Ok(bed) = Bed::new(&history) else {
        return Ok(Tally::refusal());
    };
    let (coefficient, ratio) = match draw.once_in(4) {
        true => (draw.decades(-20.0, 20.0), draw.decades(-20.0, 20.0)),
        false => (draw.decades(-2.0, 0.5), draw.between(1.0, 1.5)),
    };
    let friction = Friction::new(coefficient, ratio)
        .map_err(|error| Violation::new(format!("sensible friction was refused: {error}")))?;
    let stiffness = bed.stiffnesses().last().map_or(0.0, |k| *k);
    let Some(springs) = Springs::new(&bed, friction, stiffness * sample.kernel.grid().dx()) else {
        return Ok(Tally::refusal());
    };
    let greatest = springs.greatest_load();
    if springs.deviation > WELL_KNOWN * springs.approach_at(greatest) {
        return Ok(Tally::refusal());
    }
    let mut trial = Trial {
        bed: &bed,
        friction,
        joint: SlipHistory::new(&bed, friction),
        springs,
        pool: vec![(0.0, 0.0), (greatest, 0.0)],
        most: 0.0,
        steps: 0,
        energy: 0.0,
        tally: Tally::default(),
    };
    for _ in 0..draw.whole(1, 40) {
        let (load, force) = trial.draw(draw);
        trial.step(load, force).map_err(|violation| {
            violation.during(format!("to {load:e}, {force:e} behind {:?}", trial.pool))
        })?;
    }
    let load = trial.load(draw);
    let amplitude = match draw.whole(0, 3) {
        0 => 1.0,
        1 => 1.0 - 1e-15,
        2 => draw.unit(),
        _ => draw.decades(-18.0, 0.0),
    };
    trial.cycle(load, amplitude * coefficient * load).map_err(|violation| {
        violation.during(format!("a cycle of {amplitude:e} of the limit under {load:e}"))
    })?;
    Ok(trial.tally)
}

/// The same state in other units.
fn in_units(state: &mut LoadingState, force: f64, length: f64) {
    let contact = &mut state.contact;
    contact.load *= force;
    contact.approach *= length;
    contact.mean_gap *= length;
    contact.energy *= force * length;
    for stiffness in [&mut contact.contact_stiffness, &mut contact.interfacial_stiffness] {
        *stiffness = stiffness.map(|stiffness| stiffness * force / length);
    }
}

/// A number next to another one, or nearly so.
fn near(value: f64, draw: &mut Draw<'_>) -> f64 {
    match draw.whole(0, 3) {
        0 => value.next_up(),
        1 => value.next_down(),
        2 => value.next_down().next_down().next_down(),
        _ => value * (1.0 + draw.one_of(1.0, &[-1.0]) * draw.decades(-15.0, -4.0)),
    }
}

struct Trial<'a> {
    bed: &'a Bed<'a>,
    friction: Friction,
    joint: SlipHistory<'a>,
    springs: Springs,
    /// Loads and tangential loads so far.
    pool: Vec<(f64, f64)>,
    /// The greatest load, and how many steps, since the surfaces were apart.
    most: f64,
    steps: usize,
    /// What the energies so far may be off by.
    energy: f64,
    tally: Tally,
}

impl Trial<'_> {
    fn now(&self) -> (f64, f64) {
        let state = self.joint.state();
        (state.load, state.tangential_load)
    }

    fn earlier(&self, draw: &mut Draw<'_>) -> (f64, f64) {
        self.pool[draw.whole(0, self.pool.len() - 1)]
    }

    fn load(&self, draw: &mut Draw<'_>) -> f64 {
        let greatest = self.springs.greatest_load();
        let knots = self.bed.loads();
        let load = match draw.whole(0, 12) {
            0..=3 => self.now().0,
            4 | 5 => self.earlier(draw).0,
            6 => near(self.earlier(draw).0, draw),
            7 => near(self.now().0, draw),
            8 => 0.0,
            9 => greatest * draw.decades(-14.0, 0.0),
            10 => knots[draw.whole(0, knots.len() - 1)],
            _ => greatest * draw.unit(),
        };
        // The last of the path is none of the springs where they are too stiff.
        load.clamp(0.0, greatest)
    }

    fn draw(&self, draw: &mut Draw<'_>) -> (f64, f64) {
        if draw.once_in(8) {
            return self.earlier(draw);
        }
        if draw.once_in(40) {
            return (draw.any(), draw.any());
        }
        let (now, before) = self.now();
        let load = self.load(draw);
        let limit = self.friction.coefficient() * load;
        let sign = draw.one_of(1.0, &[-1.0]);
        let force = match draw.whole(0, 13) {
            0 | 1 => before,
            2 => self.earlier(draw).1,
            3 => near(self.earlier(draw).1, draw),
            4 => sign * limit,
            5 => near(sign * limit, draw),
            6 => 0.0,
            7 => sign * limit * draw.decades(-20.0, -3.0),
            8 if now > 0.0 => before / now * load,
            9 => before + sign * self.friction.coefficient() * (load - now),
            10 => -before,
            11 => before + sign * draw.unit() * self.friction.coefficient() * (load - now),
            _ => sign * draw.unit() * limit,
        };
        match force.abs() > limit && !draw.once_in(6) {
            true => (load, sign * draw.unit() * limit),
            false => (load, force),
        }
    }

    fn step(&mut self, load: f64, force: f64) -> Result<(), Violation> {
        if load.is_finite() && load > self.springs.greatest_load() {
            // Beyond what is compared.
            if let Ok(state) = self.joint.clone().to(load, force) {
                let expected = load.min(self.bed.greatest_load());
                ensure!(state.load == expected, "the load is {:e}", state.load);
            }
            return Ok(());
        }
        let before = (self.joint.state(), self.joint.dissipation());
        let pieces = self.pieces()?;
        let limit = self.friction.coefficient() * load;
        let found = self.joint.to(load, force);
        let is_number = load >= 0.0 && load.is_finite() && force.is_finite();
        let greatest = self.bed.greatest_load();
        match found {
            Err(error) => {
                let deserved = match &error {
                    Error::OutOfRange { .. } => !is_number,
                    Error::Bed(_) => load > greatest,
                    Error::Slip(SlipError::JointSlides { .. }) => force.abs() > limit,
                    Error::Slip(SlipError::StaysAtLimit { .. }) => self.stays(load, force),
                    _ => false,
                };
                ensure!(deserved, "it was refused: {error}");
                let now = (self.joint.state(), self.joint.dissipation());
                ensure!(now == before && self.pieces()? == pieces, "{before:?} became {now:?}");
                self.tally.refused += 1;
                Ok(())
            }
            Ok(_) => {
                let is_reached = load <= greatest * (1.0 + 2e-12);
                ensure!(is_number && is_reached, "it was not refused");
                // Rounding of the loads of the step.
                let rounding = 2e-12 * self.friction.coefficient() * load.max(before.0.load);
                ensure!(force.abs() <= limit + rounding, "no friction bears that");
                let load = load.min(greatest);
                // Loads that have lost their digits are none.
                let (most, bears) = if load < UNDERFLOWS { (0.0, 0.0) } else { (load, limit) };
                self.springs.to(most, force.clamp(-bears, bears))?;
                self.pool.push((load, force));
                self.compare(before.0.load, load, force, before.1)
            }
        }
    }

    /// Whether a step is along the limit of friction, but for rounding.
    fn stays(&self, load: f64, force: f64) -> bool {
        let (now, before) = self.now();
        let coefficient = self.friction.coefficient();
        let allowed = SNAPPED * coefficient * now.max(load);
        let is_near = |sign: f64| {
            let least = (coefficient * now - sign * before).max(coefficient * load - sign * force);
            least <= allowed
        };
        is_near(1.0) || is_near(-1.0)
    }

    fn pieces(&self) -> Result<Vec<(f64, f64, f64)>, Violation> {
        let all = self.joint.superposition();
        let all = all.map_err(|error| Violation::new(format!("no pieces: {error}")))?;
        Ok(all.pieces().iter().map(|piece| (piece.start, piece.end, piece.weight)).collect())
    }

    /// By how much forces, displacements and energies may be off.
    ///
    /// Ratios λ follow from the loads: in each step their fronts move by what tangential loads are off by over μ, and
    /// displacements by that over the least stiffness; a step later the same errors are not greater, as steps contract
    /// in the norm of the stored energy. A spring of the independent solution rounds κμδ, which its stiffness makes a
    /// force of.
    fn allowed(&self, load: f64) -> [f64; 3] {
        let (coefficient, ratio) = (self.friction.coefficient(), self.friction.compliance_ratio());
        let [first, last] = self.springs.stiffnesses(load);
        let approach = self.springs.approach_at(load);
        let steps = (self.steps + 1) as f64;
        let rounding = 64.0 * f64::EPSILON * last * approach;
        let force = coefficient * (SNAPPED * load + rounding + UNDERFLOWS) * steps;
        let deviation = 2.0 * steps * coefficient * self.springs.deviation;
        // A small load may be a part of the first interval that is no normal number: it is rounded, at both ends of
        // pieces, to multiples of the least one.
        let slip = ratio * coefficient * self.springs.first_approach();
        let part = 2.0 * steps * f64::from_bits(1) * slip;
        let displacement = ratio * (force / first + deviation) + UNDERFLOWS + part;
        let energy = coefficient * load * displacement + force * ratio * coefficient * approach;
        // Energies underflow where loads and displacements do not, and those of the path before κμ² multiplies them.
        let least = f64::MIN_POSITIVE * (1.0 + ratio * coefficient.powi(2));
        [force, displacement, 4.0 * energy + least]
    }

    fn compare(&mut self, from: f64, load: f64, force: f64, lost: f64) -> Result<(), Violation> {
        self.most = self.most.max(from).max(load);
        self.steps += 1;
        let [forces, displacements, energies] = self.allowed(self.most);
        self.energy += energies;
        let state = self.joint.state();
        let coefficient = self.friction.coefficient();
        let tally = &mut self.tally;
        ensure!(state.load == load, "the load is {:e}", state.load);
        tally.close("tangential load", state.tangential_load, force, forces)?;
        let bound = coefficient * load * (1.0 + 1e-12);
        ensure!(state.tangential_load.abs() <= bound, "{:e} of {bound:e}", state.tangential_load);
        tally.close(
            "displacement",
            state.displacement,
            self.springs.displacement,
            displacements,
        )?;
        let dissipation = self.joint.dissipation();
        ensure!(dissipation >= lost, "{lost:e} J were lost, and now {dissipation:e}");
        tally.close("dissipation", dissipation, self.springs.dissipation, self.energy)?;
        let stored = self.joint.stored_energy();
        let stored = stored.map_err(|error| Violation::new(format!("no energy: {error}")))?;
        tally.close("stored energy", stored, self.springs.stored_energy(), energies)?;
        let pieces = self.pieces()?;
        ensure!(pieces.iter().all(|piece| piece.2.abs() <= coefficient), "beyond μ: {pieces:?}");
        let [first, last] = self.springs.stiffnesses(self.most);
        let off = self.springs.off(pieces.iter().copied());
        let forces = 2.0 * forces * (last / first).max(1.0);
        // Of stiff springs stretches underflow under forces that do not.
        let forces = forces + f64::MIN_POSITIVE * last / self.friction.compliance_ratio();
        self.tally.not_negative("what forces of springs are off", -off, forces)?;
        let sticks = self.springs.sticks_up_to(forces);
        let least = sticks * (1.0 - 1e-9);
        ensure!(state.stick_load >= least, "{sticks:e} sticks, but {:e}", state.stick_load);
        // What is at the limit slips, in one direction.
        let limit = pieces.last().map_or(0.0, |piece| AT_LIMIT * coefficient * piece.2.signum());
        let at_limit = pieces.iter().rev().take_while(|piece| piece.2 / limit > 1.0);
        let most = at_limit.last().map_or(load, |piece| piece.0) * (1.0 + SNAPPED);
        ensure!(state.stick_load <= most.min(load), "{:e} of {most:e} sticks", state.stick_load);
        let nodes = self.bed.at_load(load).map_or(0, |state| state.contact_nodes);
        ensure!(state.stick_nodes + state.slipping_nodes == nodes, "{state:?} of {nodes} nodes");
        if load == 0.0 {
            (self.most, self.steps) = (0.0, 0);
        }
        self.tally.checked += 1;
        Ok(())
    }

    /// A cycle at constant load, and the first loading up to it.
    fn cycle(&mut self, load: f64, amplitude: f64) -> Result<(), Violation> {
        if load.min(amplitude) < UNDERFLOWS {
            return Ok(());
        }
        let failed = |error: Error| Violation::new(format!("it was refused: {error}"));
        let joint = PartialSlip::new(self.bed, load, self.friction).map_err(failed)?;
        if joint.sliding_displacement() < UNDERFLOWS {
            return Ok(());
        }
        let (cycle, first) = (joint.cycle(amplitude), joint.monotone(amplitude));
        let (cycle, first) = (cycle.map_err(failed)?, first.map_err(failed)?);
        let mut history = SlipHistory::new(self.bed, self.friction);
        history.to(load, 0.0).map_err(failed)?;
        let there = history.to(load, amplitude).map_err(failed)?;
        let lost = history.dissipation();
        history.to(load, -amplitude).map_err(failed)?;
        let back = history.to(load, amplitude).map_err(failed)?;
        let around = history.dissipation() - lost;
        self.steps = 3;
        let [_, displacement, energy] = self.allowed(load);
        for (what, found) in [("first", first), ("there", there), ("back", back)] {
            let expected = cycle.displacement;
            self.tally.close(what, found.displacement, expected, displacement)?;
        }
        self.tally.close("dissipation of a cycle", cycle.dissipation, around, energy)?;
        self.tally.close("of the first loading", cycle.dissipation, 4.0 * lost, energy)?;
        ensure!(cycle.dissipation >= 0.0 && cycle.secant_stiffness > 0.0, "{cycle:?}");
        if cycle.displacement > 0.0 {
            let same = joint.cycle_of_displacement(cycle.displacement).map_err(failed)?;
            self.tally.close("by displacement", same.dissipation, cycle.dissipation, energy)?;
        }
        self.tally.checked += 1;
        Ok(())
    }
}
