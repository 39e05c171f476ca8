//! The prediction of a state from the last ones.

use super::level::Level;
use super::tangent::Tangent;
use crate::krylov::{add_scaled, sum};

/// Greatest change of the load, as a factor, for which the last state is a better start than the
/// coarser grids. Those begin with an error of 3 % of the approach, a step of 7 % of the load with
/// 0.8 % (512 × 512 nodes, 12 % in contact).
const GREATEST_STEP: f64 = 1.25;

/// What is known of a sequence of states besides the last one, which the level holds.
#[derive(Debug, Clone, Default)]
pub(super) struct Continuation {
    pub(super) tangent: Tangent,
    /// With tangents the one before, per unit of the sum of pressures; else the state before.
    earlier: Option<Earlier>,
}

/// Fields at an earlier state.
#[derive(Debug, Clone)]
struct Earlier {
    /// Sum of pressures there.
    sum: f64,
    pressure: Vec<f64>,
    displacement: Vec<f64>,
    /// What belongs to the approach in the same combination.
    approach: f64,
}

impl Continuation {
    /// With a known tangent, or an empty one.
    pub(super) fn new(tangent: Tangent) -> Self {
        Self {
            tangent,
            earlier: None,
        }
    }

    /// The sum of pressures at an approach, by the tangent or in proportion.
    pub(super) fn sum_at(&self, level: &Level, approach: f64) -> f64 {
        let iterate = &level.iterate;
        let now = sum(&iterate.pressure);
        if !self.tangent.is_known() {
            return now * approach / iterate.approach;
        }
        let compliance = sum(&self.tangent.rate).recip() - level.uniform();
        now + (approach - iterate.approach) / compliance
    }

    /// Whether the state of `level` is a good start for another sum of pressures.
    pub(super) fn reaches(level: &Level, target: f64) -> bool {
        let ratio = target / sum(&level.iterate.pressure);
        ratio < GREATEST_STEP && ratio > 1.0 / GREATEST_STEP
    }

    /// Moves the iterate of `level` to the sum `target`. Pressures, displacements and approach are
    /// combined alike, so that only the conditions of contact can be broken: pressures may become
    /// negative where nodes leave, gaps where nodes join.
    ///
    /// With tangents `t = y₂ / Σ y₂` at the sums S and, before, S′, the pressure follows the parabola
    /// `p + a t + ½ a² (t − t′) / (S − S′)`, a being the change of the sum; without tangents the line
    /// through the last two states, or through the first and no contact.
    pub(super) fn predict(&mut self, level: &mut Level, target: f64) {
        let uniform = level.uniform();
        let iterate = &mut level.iterate;
        let now = sum(&iterate.pressure);
        let change = target - now;
        if !self.tangent.is_known() {
            let (before, pressure, closure, approach) = match self.earlier.take() {
                Some(earlier) if is_close(change, now - earlier.sum) => (
                    earlier.sum,
                    earlier.pressure,
                    earlier.displacement,
                    earlier.approach,
                ),
                _ => (0.0, vec![0.0; level.gap.len()], level.gap.clone(), 0.0),
            };
            let factor = change / (now - before);
            self.earlier = Some(Earlier {
                sum: now,
                pressure: iterate.pressure.clone(),
                displacement: iterate.closure.clone(),
                approach: iterate.approach,
            });
            for (now, before) in [
                (&mut iterate.pressure, &pressure),
                (&mut iterate.closure, &closure),
            ] {
                extrapolate(now, before, factor);
            }
            iterate.approach += factor * (iterate.approach - approach);
            return;
        }
        let total = sum(&self.tangent.rate);
        // Per unit of the sum, in which the gauge is a displacement of all nodes alike.
        let unit = |field: &[f64], gauge: f64| {
            let values = field.iter();
            values.map(|value| value / total - gauge).collect()
        };
        let tangent = Earlier {
            sum: now,
            pressure: unit(&self.tangent.rate, 0.0),
            displacement: unit(&self.tangent.displacement, uniform),
            approach: total.recip() - uniform,
        };
        let mut second = 0.0;
        if let Some(earlier) = &self.earlier
            && is_close(change, now - earlier.sum)
        {
            second = 0.5 * change * change / (now - earlier.sum);
            add_scaled(&mut iterate.pressure, -second, &earlier.pressure);
            add_scaled(&mut iterate.closure, -second, &earlier.displacement);
            iterate.approach -= second * earlier.approach;
        }
        let first = change + second;
        add_scaled(&mut iterate.pressure, first, &tangent.pressure);
        add_scaled(&mut iterate.closure, first, &tangent.displacement);
        iterate.approach += first * tangent.approach;
        self.earlier = Some(tangent);
    }
}

/// Whether an extrapolation by `step` is not too far beyond the interval it rests on.
fn is_close(step: f64, interval: f64) -> bool {
    let ratio = step / interval;
    ratio > 0.0 && ratio < 2.0
}

/// now ← now + factor (now − before).
fn extrapolate(now: &mut [f64], before: &[f64], factor: f64) {
    for (now, before) in now.iter_mut().zip(before) {
        *now += factor * (*now - before);
    }
}
