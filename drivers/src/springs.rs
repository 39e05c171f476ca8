//! Springs with sliders that know nothing of each other, from event to event: what partial slip is compared with.
//!
//! Spring n is reached at the approach δₙ and adds ΔKₙ to the stiffness of the bed. Its stretch a, of the tangential
//! force `ΔKₙ a/κ`, obeys Coulomb's law: `|a| ≤ κμ (δ − δₙ)`. Between knots of the path all bounds move at one rate, and
//! all springs that stick at that of the displacement. So the rate that carries a tangential load is the root of a
//! monotone function with two corners, and the next event is that of the spring that reaches its bound first.

use std::cmp::Ordering;

use asperity::bed::Bed;
use asperity::slip::Friction;

use crate::verdict::Violation;

/// Stiffnesses up to so many times the first one: rounding is multiplied by their ratio.
const STIFFEST: f64 = 1e4;

/// What a spring does.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Hold {
    Apart,
    Sticks,
    /// In the direction of this sign.
    Slips(f64),
}

#[derive(Debug, Clone, Copy)]
struct Spring {
    stiffness: f64,
    gap: f64,
    stretch: f64,
    hold: Hold,
}

impl Spring {
    /// The part of a shift after which a spring that sticks reaches its bound, which grows as well, and the sign of it.
    fn until(&self, [shift, bound]: [f64; 2], most: f64) -> (f64, f64) {
        let [ahead, back] = [1.0, -1.0].map(|sign| {
            let rate = sign * shift - bound;
            let left = (most - sign * self.stretch).max(0.0);
            (if rate > 0.0 { left / rate } else { f64::INFINITY }, sign)
        });
        if ahead.0 <= back.0 { ahead } else { back }
    }
}

/// The bed, and where it has come to.
#[derive(Debug, Clone)]
pub(crate) struct Springs {
    /// Approach and load: those of the path, or, where rounding takes their curve from below its chords, the chords.
    knots: Vec<(f64, f64)>,
    /// How far approaches of the path are from the chords.
    pub(crate) deviation: f64,
    springs: Vec<Spring>,
    friction: Friction,
    pub(crate) load: f64,
    approach: f64,
    pub(crate) displacement: f64,
    pub(crate) dissipation: f64,
}

impl Springs {
    /// Those of a bed, and of as much again behind full contact; `None` of one without any load.
    pub(crate) fn new(bed: &Bed<'_>, friction: Friction, beyond: f64) -> Option<Self> {
        let mut given: Vec<(f64, f64)> = Vec::new();
        for (&approach, &load) in bed.approaches().iter().zip(bed.loads()) {
            given.pop_if(|last| last.1 == load);
            given.push((approach, load));
        }
        if let (true, Some(stiffness)) = (bed.is_full(), bed.stiffnesses().last()) {
            let (approach, load) = given.last().copied()?;
            let more = if load > 0.0 { load } else { beyond };
            given.push((approach + more / stiffness, load + more));
        }
        let mut knots: Vec<(f64, f64)> = Vec::new();
        for &knot in &given {
            while let &[.., before, last] = &knots[..]
                && compliance(before, last) <= compliance(last, knot)
            {
                knots.pop();
            }
            knots.push(knot);
        }
        let first = compliance(*knots.first()?, *knots.get(1)?);
        let is_soft = |pair: &[(f64, f64)]| compliance(pair[0], pair[1]) * STIFFEST > first;
        let soft = knots.windows(2).take_while(|pair| is_soft(pair)).count();
        knots.truncate(soft + 1);
        if soft == 0 || !first.is_normal() {
            return None;
        }
        let mut stiffness = 0.0;
        let springs = knots.windows(2).map(|pair| {
            let before = std::mem::replace(&mut stiffness, 1.0 / compliance(pair[0], pair[1]));
            let (gap, stiffness) = (pair[0].0, stiffness - before);
            Spring { stiffness, gap, stretch: 0.0, hold: Hold::Apart }
        });
        let springs = springs.collect();
        let mut made = Self {
            knots,
            deviation: 0.0,
            springs,
            friction,
            load: 0.0,
            approach: 0.0,
            displacement: 0.0,
            dissipation: 0.0,
        };
        let within = given.iter().filter(|knot| knot.1 <= made.greatest_load());
        let off = within.map(|knot| (made.approach_at(knot.1) - knot.0).abs());
        made.deviation = off.fold(0.0, f64::max);
        Some(made)
    }

    pub(crate) fn greatest_load(&self) -> f64 {
        self.knots.last().map_or(0.0, |knot| knot.1)
    }

    /// The approach at the end of the first interval.
    pub(crate) fn first_approach(&self) -> f64 {
        self.knots.get(1).map_or(0.0, |knot| knot.0)
    }

    /// The stiffness at first, and below a load.
    pub(crate) fn stiffnesses(&self, load: f64) -> [f64; 2] {
        let reached = self.springs.iter().zip(&self.knots).filter(|(_, knot)| knot.1 < load);
        let sum = reached.map(|(spring, _)| spring.stiffness).sum();
        [self.springs.first().map_or(0.0, |spring| spring.stiffness), sum]
    }

    pub(crate) fn approach_at(&self, load: f64) -> f64 {
        let after = self.knots.partition_point(|knot| knot.1 <= load);
        let after = after.clamp(1, self.knots.len() - 1);
        let (start, end) = (self.knots[after - 1], self.knots[after]);
        let found = start.0 + (load - start.1) * compliance(start, end);
        match load.total_cmp(&end.1) {
            // Rounded, it might be beyond the knot.
            Ordering::Less => found.min(end.0),
            Ordering::Equal => end.0,
            Ordering::Greater => found,
        }
    }

    pub(crate) fn force(&self) -> f64 {
        self.forces().sum()
    }

    fn forces(&self) -> impl Iterator<Item = f64> + '_ {
        let ratio = self.friction.compliance_ratio();
        self.springs.iter().map(move |spring| spring.stiffness * spring.stretch / ratio)
    }

    pub(crate) fn stored_energy(&self) -> f64 {
        self.forces().zip(&self.springs).map(|(force, spring)| 0.5 * force * spring.stretch).sum()
    }

    /// The load at which the last spring is reached whose force is below its bound by more than is allowed.
    pub(crate) fn sticks_up_to(&self, allowed: f64) -> f64 {
        let clear = self.forces().zip(&self.springs).zip(&self.knots).filter(|((force, s), _)| {
            let bound = self.friction.coefficient() * s.stiffness * (self.approach - s.gap);
            bound - force.abs() > allowed
        });
        clear.map(|(_, knot)| knot.1).fold(0.0, f64::max)
    }

    /// The greatest difference of forces from those of ratios λ of the increments of the path: (start, end, λ).
    pub(crate) fn off(&self, pieces: impl Iterator<Item = (f64, f64, f64)>) -> f64 {
        let mut left: Vec<f64> = self.forces().collect();
        for (start, end, ratio) in pieces {
            let [start, end] = [start, end].map(|load| self.approach_at(load));
            for (left, spring) in left.iter_mut().zip(&self.springs) {
                let reached = |approach: f64| (approach - spring.gap).max(0.0);
                *left -= ratio * spring.stiffness * (reached(end) - reached(start));
            }
        }
        left.iter().fold(0.0, |most, left| most.max(left.abs()))
    }

    /// To a load and a tangential load, along a straight line.
    pub(crate) fn to(&mut self, load: f64, force: f64) -> Result<(), Violation> {
        let (from, before) = (self.load, self.force());
        let (low, high) = (from.min(load), from.max(load));
        let inside = self.knots.iter().filter(|knot| knot.1 > low && knot.1 < high);
        let mut stops: Vec<(f64, f64)> = inside.copied().collect();
        if load < from {
            stops.reverse();
        }
        for (approach, stop) in stops {
            let share = (stop - from) / (load - from);
            self.stretch(approach, before + share * (force - before))?;
        }
        self.stretch(self.approach_at(load), force)?;
        self.load = load;
        if load == 0.0 {
            self.displacement = 0.0;
            for spring in &mut self.springs {
                (spring.stretch, spring.hold) = (0.0, Hold::Apart);
            }
        }
        Ok(())
    }

    /// To an approach up to the next knot.
    fn stretch(&mut self, approach: f64, force: f64) -> Result<(), Violation> {
        let scale = self.friction.compliance_ratio() * self.friction.coefficient();
        for _ in 0..4 * self.springs.len() + 20 {
            let rise = approach - self.approach;
            let left = force - self.force();
            // For the rounding of a sum springs would go to and fro for ever.
            let sum: f64 = self.forces().map(f64::abs).sum();
            if rise == 0.0 && left.abs() <= 4.0 * f64::EPSILON * sum {
                return Ok(());
            }
            let bound = scale * rise;
            for spring in &mut self.springs {
                if spring.hold == Hold::Apart && rise > 0.0 && spring.gap <= self.approach {
                    spring.hold = Hold::Sticks;
                }
            }
            let shift = self.shift(bound, left);
            let mut part = 1.0_f64;
            // Those that move with their bounds but for rounding would stick and slip in turn for ever.
            let slower = bound - 1e-12 * bound.abs();
            for spring in &mut self.springs {
                match spring.hold {
                    Hold::Slips(sign) if sign * shift < slower => spring.hold = Hold::Sticks,
                    _ => (),
                }
                if spring.hold == Hold::Sticks {
                    let most = scale * (self.approach - spring.gap);
                    part = part.min(spring.until([shift, bound], most).0);
                }
            }
            let before = self.approach;
            self.approach = if part < 1.0 { before + part * rise } else { approach };
            self.displacement += part * shift;
            for spring in &mut self.springs {
                let most = scale * (self.approach - spring.gap);
                let old = spring.stretch;
                match spring.hold {
                    Hold::Apart => continue,
                    Hold::Sticks => {
                        let (until, sign) =
                            spring.until([shift, bound], scale * (before - spring.gap));
                        spring.stretch += part * shift;
                        if until <= part {
                            spring.hold = Hold::Slips(sign);
                            spring.stretch = sign * most;
                        }
                    }
                    Hold::Slips(sign) => {
                        spring.stretch = sign * most;
                        let force = 0.5 * spring.stiffness * (old + spring.stretch)
                            / self.friction.compliance_ratio();
                        self.dissipation += (force * part * (shift - sign * bound)).abs();
                    }
                }
                if most <= 0.0 && rise <= 0.0 {
                    (spring.stretch, spring.hold) = (0.0, Hold::Apart);
                }
            }
            if part >= 1.0 {
                return Ok(());
            }
        }
        Err(Violation::new("springs that slip do not come to an end"))
    }

    /// The displacement that changes the tangential force by so much while bounds grow by `bound`, if no spring reaches
    /// its bound on the way. What slips as a whole goes with its bounds.
    fn shift(&self, bound: f64, change: f64) -> f64 {
        let [mut sticks, mut ahead, mut back] = [0.0; 3];
        for spring in &self.springs {
            let stiffness = spring.stiffness / self.friction.compliance_ratio();
            match spring.hold {
                Hold::Apart => (),
                Hold::Sticks => sticks += stiffness,
                Hold::Slips(sign) if sign > 0.0 => ahead += stiffness,
                Hold::Slips(_) => back += stiffness,
            }
        }
        let carried =
            |shift: f64| sticks * shift + ahead * shift.min(bound) + back * shift.max(-bound);
        let corner = bound.abs();
        let (place, slope) = if change < carried(-corner) {
            (-corner, sticks + ahead)
        } else if change > carried(corner) {
            (corner, sticks + back)
        } else {
            (-corner, sticks + if bound > 0.0 { ahead + back } else { 0.0 })
        };
        match slope > 0.0 {
            true => place + (change - carried(place)) / slope,
            false if ahead >= back => bound,
            false => -bound,
        }
    }
}

/// dδ/dW of a chord.
fn compliance(start: (f64, f64), end: (f64, f64)) -> f64 {
    (end.0 - start.0) / (end.1 - start.1)
}
