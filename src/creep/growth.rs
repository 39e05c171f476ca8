//! Contact that grows: when each node touches, and the weights of all increments of pressure.

use super::exponential_sum::{ExponentialSum, bisect};
use super::hereditary::{Hereditary, Place};
use super::prony::{Prony, PronyTerm};
use super::weights::Weights;

/// The effective load W′ over time, which is the load of the elastic path whose contact there is, and the loads Wₖ at
/// which that path has its knots.
#[derive(Debug, Clone)]
pub(super) struct Growth<'a> {
    knots: &'a [f64],
    load: Hereditary,
}

/// What rounding may make of W′, relative to it: compliances are divided by what is left of the modulus, which
/// multiplies their rounding of some 10⁻¹⁶, so that this is enough down to a thousandth of the modulus. What is closer
/// to the last knot is that knot: a path to the load `W / (1 − Σ g)` is enough for a load W that is held for ever.
const ROUNDING: f64 = 1e-12;

/// A stretch of time in which contact grows between two knots.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stretch {
    /// The knot before.
    knot: usize,
    /// The corner of the load before.
    corner: usize,
    /// Times since that corner.
    from: f64,
    to: f64,
    /// What W′ jumps by, without any time.
    jump: f64,
}

/// A kernel `r∞ + Σ r e^(−t/ϱ)`.
#[derive(Debug, Clone)]
pub(super) struct Kernel {
    constant: f64,
    terms: Vec<PronyTerm>,
}

impl Kernel {
    /// R.
    pub(super) fn relaxation(prony: &Prony) -> Self {
        Self { constant: prony.equilibrium_modulus(), terms: prony.relaxation_terms().to_vec() }
    }

    /// dR/dt.
    pub(super) fn derivative(&self) -> Self {
        let terms = self.terms.iter().map(|t| PronyTerm { amount: -t.amount / t.time, ..*t });
        Self { constant: 0.0, terms: terms.collect() }
    }

    /// The longest relaxation time; 0 without any.
    pub(super) fn slowest(&self) -> f64 {
        self.terms.last().map_or(0.0, |term| term.time)
    }

    fn at(&self, time: f64) -> f64 {
        let terms = self.terms.iter().map(|term| term.amount * (-time / term.time).exp());
        self.constant + terms.sum::<f64>()
    }

    /// `∫ R(left + to − z) f(z) dz` from `from` to `to`, of a rate f: each pair of exponentials in closed form, without
    /// differences of nearly equal ones.
    fn over(&self, rate: &ExponentialSum, (from, to): (f64, f64), left: f64) -> f64 {
        // Far from 0 the sum of two times may be later than what they are parts of.
        let (length, left) = (to - from, left.max(0.0));
        let mean = |z: f64| Weights::of(z).mean;
        let constant = rate.constant + rate.linear * from;
        let decaying = |(c, time): &(f64, f64)| (c * (-from / time).exp(), *time);
        let terms = || rate.terms.iter().map(decaying);
        let plain = constant
            + 0.5 * rate.linear * length
            + terms().map(|(c, time)| c * mean(length / time)).sum::<f64>();
        let own = |term: &PronyTerm| {
            let w = Weights::of(length / term.time);
            let mixed = terms().map(|(c, time)| {
                let slower = time.max(term.time);
                let difference = (length / time - length / term.time).abs();
                c * (-length / slower).exp() * mean(difference)
            });
            let sum = constant * w.mean + rate.linear * term.time * w.now + mixed.sum::<f64>();
            term.amount * (-left / term.time).exp() * sum
        };
        length * (self.constant * plain + self.terms.iter().map(own).sum::<f64>())
    }
}

impl<'a> Growth<'a> {
    pub(super) fn new(knots: &'a [f64], load: Hereditary) -> Self {
        Self { knots, load }
    }

    pub(super) fn load(&self) -> &Hereditary {
        &self.load
    }

    /// W′ just after a time: 0 before the first corner.
    pub(super) fn at(&self, time: f64) -> f64 {
        self.to_knot(self.load.place(time).map_or(0.0, |place| self.load.response(place).0))
    }

    /// That of the last knot for a load that rounding alone takes beyond it.
    pub(super) fn to_knot(&self, load: f64) -> f64 {
        match self.knots.last() {
            Some(&last) if load > last && load <= last * (1.0 + ROUNDING) => last,
            _ => load,
        }
    }

    /// When each knot is reached, up to a time, while W′ does not fall.
    pub(super) fn times(&self, until: f64) -> Vec<f64> {
        let mut times = Vec::new();
        let corners = self.load.corners();
        self.walk((until, f64::INFINITY), |stretch| {
            let start = corners[stretch.corner].0 + stretch.from;
            times.resize(times.len().max(stretch.knot + 1), start);
        });
        // Those that are reached just then.
        let reached = self.at(until);
        while self.knots.get(times.len()).is_some_and(|knot| *knot <= reached) {
            times.push(until);
        }
        times
    }

    /// Mean weights of the increments from knot to knot, `φ = R(t − s)` with s the time at which each was made: the
    /// load at the end of each increment, and its weight. The last ends at the greatest load, W′(until).
    pub(super) fn increments(
        &self,
        kernel: &Kernel,
        time: f64,
        (until, greatest): (f64, f64),
    ) -> Vec<(f64, f64)> {
        let mut carried: Vec<f64> = Vec::new();
        let corners = self.load.corners();
        let mut rate: Option<(usize, ExponentialSum)> = None;
        self.walk((until, greatest), |stretch| {
            carried.resize(carried.len().max(stretch.knot + 1), 0.0);
            let start = corners[stretch.corner].0;
            carried[stretch.knot] += if stretch.jump > 0.0 {
                stretch.jump * kernel.at(time - start)
            } else {
                if rate.as_ref().is_none_or(|(corner, _)| *corner != stretch.corner) {
                    rate = Some((stretch.corner, self.load.rate(stretch.corner)));
                }
                let left = time - (start + stretch.to);
                let interval = (stretch.from, stretch.to);
                rate.as_ref().map_or(0.0, |(_, rate)| kernel.over(rate, interval, left))
            };
        });
        let increments = carried.iter().enumerate().map(|(k, carried)| {
            let end = self.knots.get(k + 1).map_or(greatest, |next| next.min(greatest));
            let length = end - self.knots[k];
            (end, if length > 0.0 { carried / length } else { 0.0 })
        });
        increments.collect()
    }

    /// `∫ R(t − s) dW′(s)` up to a time: the load that the contact of that time carries at t.
    pub(super) fn carried(&self, kernel: &Kernel, time: f64, until: f64) -> f64 {
        let mut sum = 0.0;
        for (corner, &(start, _)) in self.load.corners().iter().enumerate() {
            if start > until {
                break;
            }
            sum += self.load.response_to_jump(corner) * kernel.at(time - start);
            let length = self.load.duration(corner).min(until - start);
            if length > 0.0 {
                let left = time - (start + length);
                sum += kernel.over(&self.load.rate(corner), (0.0, length), left);
            }
        }
        sum
    }

    /// The same up to an effective load: of a jump at that time as much as leads to it.
    pub(super) fn carried_by(&self, kernel: &Kernel, time: f64, contact: (f64, f64)) -> f64 {
        let (until, effective_load) = contact;
        let reached = self.load.place(until).map_or(0.0, |place| self.load.response(place).0);
        let beyond = (reached - effective_load).max(0.0);
        self.carried(kernel, time, until) - beyond * kernel.at(time - until)
    }

    /// The contact that carries a load at a time, of all that was made up to another: when it was made, and its effective
    /// load. `None` if all of it carries no more.
    ///
    /// Corner by corner, so that what a jump or a ramp begins with is what the one before it ends with: a load that
    /// returns to the value before a jump leaves nothing of the jump, whatever rounding does.
    pub(super) fn left(
        &self,
        kernel: &Kernel,
        (time, load): (f64, f64),
        until: f64,
    ) -> Option<(f64, f64)> {
        let mut before = 0.0;
        for (corner, &(start, _)) in self.load.corners().iter().enumerate() {
            if start > until {
                return None;
            }
            let (jump, left) = (self.load.response_to_jump(corner), kernel.at(time - start));
            if jump > 0.0 && load < before + jump * left {
                let reached = self.load.response(Place { corner, since: 0.0 }).0 - jump;
                return Some((start, reached + ((load - before) / left).min(jump)));
            }
            before += jump * left;
            let length = self.load.duration(corner).min(until - start);
            if length <= 0.0 {
                continue;
            }
            let rate = self.load.rate(corner);
            let carried =
                |since: f64| before + kernel.over(&rate, (0.0, since), time - (start + since));
            let after = carried(length);
            if after > load {
                let since = bisect(0.0, length, |since| carried(since) > load);
                let reached = self.load.response(Place { corner, since }).0;
                return Some((start + since, self.to_knot(reached)));
            }
            before = after;
        }
        None
    }

    /// Goes through the growth up to a time, from knot to knot and from corner to corner; of a jump up to a load.
    fn walk(&self, (until, greatest): (f64, f64), mut visit: impl FnMut(Stretch)) {
        let (load, knots) = (&self.load, self.knots);
        let (mut knot, mut reached) = (0, 0.0_f64);
        for (corner, &(start, _)) in load.corners().iter().enumerate() {
            if start > until {
                return;
            }
            let after = load.response(Place { corner, since: 0.0 }).0;
            let after = if load.jump(corner) > 0.0 { after.min(greatest) } else { after };
            // Up to a jump.
            loop {
                let next = knots.get(knot + 1).copied().filter(|next| *next <= after);
                let up_to = next.unwrap_or(after);
                if load.jump(corner) > 0.0 {
                    let jump = (up_to - reached).max(0.0);
                    visit(Stretch { knot, corner, from: 0.0, to: 0.0, jump });
                }
                reached = reached.max(up_to);
                if next.is_none() {
                    break;
                }
                knot += 1;
            }
            let mut length = load.duration(corner).min(until - start);
            if length <= 0.0 {
                continue;
            }
            if length == f64::INFINITY {
                let last = knots.last().copied().unwrap_or(0.0);
                length = load.reaches(corner, last).unwrap_or(load.long());
            }
            let last = load.response(Place { corner, since: length }).0;
            let mut from = 0.0;
            while let Some(next) = knots.get(knot + 1).filter(|next| **next <= last) {
                let to = self.time_since(corner, *next, (from, length));
                visit(Stretch { knot, corner, from, to, jump: 0.0 });
                (knot, from) = (knot + 1, to);
            }
            visit(Stretch { knot, corner, from, to: length, jump: 0.0 });
            reached = reached.max(last);
        }
    }

    /// When W′ reaches a value between two times since a corner, if it has not reached it at the first and has at the
    /// second: Newton's method between bounds.
    pub(super) fn time_since(&self, corner: usize, value: f64, (from, to): (f64, f64)) -> f64 {
        let (mut below, mut above) = (from, to);
        let mut since = from;
        for _ in 0..MOST_STEPS {
            let (found, rate) = self.load.response(Place { corner, since });
            let missing = value - found;
            if missing > 0.0 {
                below = since;
            } else {
                above = since;
            }
            if missing.abs() <= f64::EPSILON * value {
                return since;
            }
            let next = since + missing / rate;
            let is_between = next > below && next < above;
            let next = if is_between { next } else { 0.5 * (below + above) };
            if (next - since).abs() <= f64::EPSILON * next || below >= above {
                return next;
            }
            since = next;
        }
        above
    }
}

/// More than bisection takes.
const MOST_STEPS: usize = 2200;
