//! The prediction of a state from the last ones.

use super::level::Level;
use super::tangent::Tangent;
use super::tuning::GREATEST_STEP;
use crate::krylov::{add_scaled, sum};

/// The states of a sequence before the last one, which the level holds.
#[derive(Debug, Clone, Default)]
pub(super) struct Continuation {
    pub(super) tangent: Tangent,
    earlier: Option<Earlier>,
}

/// What is left of the state before the last one. Tangents may become known from one to the next, and unknown: a metal
/// that yields has plateaus without any.
#[derive(Debug, Clone)]
enum Earlier {
    /// Itself, where its tangent was not known.
    State(Fields),
    /// Its tangent, per unit of the sum of pressures.
    Tangent(Fields),
}

/// Fields of an earlier state.
#[derive(Debug, Clone)]
struct Fields {
    /// Sum of pressures there.
    sum: f64,
    pressure: Vec<f64>,
    displacement: Vec<f64>,
    /// The approach in the same combination.
    approach: f64,
}

impl Continuation {
    /// With a known tangent, or an empty one.
    pub(super) fn new(tangent: Tangent) -> Self {
        Self { tangent, earlier: None }
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
            let (before, pressure, total_gap, approach) = match self.earlier.take() {
                Some(Earlier::State(earlier)) if is_close(change, now - earlier.sum) => {
                    (earlier.sum, earlier.pressure, earlier.displacement, earlier.approach)
                }
                _ => (0.0, vec![0.0; level.gap.len()], level.gap.clone(), 0.0),
            };
            let factor = change / (now - before);
            self.earlier = Some(Earlier::State(Fields {
                sum: now,
                pressure: iterate.pressure.clone(),
                displacement: iterate.total_gap.clone(),
                approach: iterate.approach,
            }));
            for (now, before) in
                [(&mut iterate.pressure, &pressure), (&mut iterate.total_gap, &total_gap)]
            {
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
        let tangent = Fields {
            sum: now,
            pressure: unit(&self.tangent.rate, 0.0),
            displacement: unit(&self.tangent.displacement, uniform),
            approach: total.recip() - uniform,
        };
        let mut second = 0.0;
        if let Some(Earlier::Tangent(earlier)) = &self.earlier
            && is_close(change, now - earlier.sum)
        {
            second = 0.5 * change * change / (now - earlier.sum);
            add_scaled(&mut iterate.pressure, -second, &earlier.pressure);
            add_scaled(&mut iterate.total_gap, -second, &earlier.displacement);
            iterate.approach -= second * earlier.approach;
        }
        let first = change + second;
        add_scaled(&mut iterate.pressure, first, &tangent.pressure);
        add_scaled(&mut iterate.total_gap, first, &tangent.displacement);
        iterate.approach += first * tangent.approach;
        self.earlier = Some(Earlier::Tangent(tangent));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::FlatPunch;
    use crate::{Boussinesq, Error, FixedLoadSolver, Grid, InfluenceKernel, PeriodicBoussinesq};

    const NODES: usize = 6;
    /// Rounding of some sums of numbers of the order of 10.
    const ROUNDING: f64 = 1e-13;

    /// States over the sum S of their pressures, all parabolas: pressures `a + b S + c S²` with Σ b = 1 and
    /// Σ a = Σ c = 0, and displacements and approach likewise. Without `curvature` they are lines.
    struct States {
        curvature: f64,
    }

    impl States {
        fn pressure(&self, node: usize, sum: f64) -> f64 {
            let sign = if node.is_multiple_of(2) { 1.0 } else { -1.0 };
            sign * (0.3 + self.curvature * sum * sum) + sum * (1.0 + sign * 0.4) / NODES as f64
        }

        fn pressure_rate(&self, node: usize, sum: f64) -> f64 {
            let sign = if node.is_multiple_of(2) { 1.0 } else { -1.0 };
            sign * 2.0 * self.curvature * sum + (1.0 + sign * 0.4) / NODES as f64
        }

        fn total_gap(&self, node: usize, sum: f64) -> f64 {
            let node = node as f64;
            0.7 + node + sum * (0.2 + 0.1 * node) - self.curvature * node * sum * sum
        }

        fn total_gap_rate(&self, node: usize, sum: f64) -> f64 {
            let node = node as f64;
            0.2 + 0.1 * node - 2.0 * self.curvature * node * sum
        }

        fn approach(&self, sum: f64) -> f64 {
            0.5 + 1.5 * sum - self.curvature * sum * sum
        }

        fn approach_rate(&self, sum: f64) -> f64 {
            1.5 - 2.0 * self.curvature * sum
        }

        /// Makes the level hold the state.
        fn put(&self, level: &mut Level, sum: f64) {
            let iterate = &mut level.iterate;
            for node in 0..NODES {
                iterate.pressure[node] = self.pressure(node, sum);
                iterate.total_gap[node] = self.total_gap(node, sum);
            }
            iterate.approach = self.approach(sum);
        }

        /// Pressure and displacement per unit of approach, in the gauge of the level.
        fn tangent(&self, level: &Level, sum: f64) -> Tangent {
            let total = 1.0 / (self.approach_rate(sum) + level.uniform());
            let nodes = 0..NODES;
            Tangent {
                rate: (nodes.clone()).map(|node| total * self.pressure_rate(node, sum)).collect(),
                displacement: nodes
                    .map(|node| total * (self.total_gap_rate(node, sum) + level.uniform()))
                    .collect(),
                drift: 0.0,
            }
        }

        /// Where the level is from this state at most.
        fn distance(&self, level: &Level, sum: f64) -> f64 {
            let iterate = &level.iterate;
            let nodes = (0..NODES).map(|node| {
                let pressure = (iterate.pressure[node] - self.pressure(node, sum)).abs();
                pressure.max((iterate.total_gap[node] - self.total_gap(node, sum)).abs())
            });
            nodes.fold((iterate.approach - self.approach(sum)).abs(), f64::max)
        }
    }

    /// A free half-space, and a periodic one that is computed in a gauge.
    fn levels() -> Result<[Level; 2], Error> {
        let grid = Grid::new(3, 2, 1.0, 1.0)?;
        let free = Boussinesq::new(grid, 1.0)?;
        let periodic = PeriodicBoussinesq::new(grid, 1.0)?;
        let level = |kernel: &dyn InfluenceKernel| -> Result<Level, Error> {
            let mut level = FixedLoadSolver::new(&FlatPunch::default(), kernel)?.into_finest();
            level.gap = (0..NODES).map(|node| 0.3 * node as f64).collect();
            Ok(level)
        };
        Ok([level(&free)?, level(&periodic)?])
    }

    /// A quarter more, or as much less, is too far; 1.25 and 5/4 of 8 are exact.
    #[test]
    fn a_state_reaches_loads_near_its_own() -> Result<(), Error> {
        let [mut level, _] = levels()?;
        level.iterate.pressure.fill(0.0);
        level.iterate.pressure[3] = 8.0;
        for (target, is_near) in [
            (10.0_f64.next_up(), false),
            (10.0, false),
            (10.0_f64.next_down(), true),
            (8.0, true),
            (6.5, true),
            (6.4, false),
            (6.3, false),
        ] {
            assert_eq!(Continuation::reaches(&level, target), is_near, "{target}");
        }
        Ok(())
    }

    /// Without tangents the line through two states, or through one and no contact if the other is too close
    /// to it for so long a step.
    #[test]
    fn lines() -> Result<(), Error> {
        let states = States { curvature: 0.0 };
        for mut level in levels()? {
            let mut continuation = Continuation::default();
            let in_proportion = |level: &mut Level, continuation: &mut Continuation, from, to| {
                states.put(level, from);
                continuation.predict(level, to);
                let factor = to / from;
                for node in 0..NODES {
                    let gap = level.gap[node];
                    let pressure = factor * states.pressure(node, from);
                    let total_gap = gap + factor * (states.total_gap(node, from) - gap);
                    assert!((level.iterate.pressure[node] - pressure).abs() < ROUNDING);
                    assert!((level.iterate.total_gap[node] - total_gap).abs() < ROUNDING);
                }
                assert!((level.iterate.approach - factor * states.approach(from)).abs() < ROUNDING);
            };
            in_proportion(&mut level, &mut continuation, 1.0, 1.2);
            for (from, to) in [(1.2, 1.5), (1.5, 1.45), (1.45, 1.41)] {
                states.put(&mut level, from);
                continuation.predict(&mut level, to);
                // The second step turns round, and begins anew; the third goes on from it.
                let distance = states.distance(&level, to);
                assert_eq!(distance < ROUNDING, to != 1.45, "{to}: {distance:e}");
            }
            // More than twice as far as the last step.
            in_proportion(&mut level, &mut continuation, 1.41, 1.2);
        }
        Ok(())
    }

    /// With tangents the parabola through two states.
    #[test]
    fn parabolas() -> Result<(), Error> {
        let states = States { curvature: 0.02 };
        for mut level in levels()? {
            let mut continuation = Continuation::default();
            // With one tangent a line; with two that are close a parabola.
            for (from, to, is_parabola) in [
                (1.0, 1.1, false),
                (1.1, 1.25, true),
                (1.25, 1.2, false),
                (1.2, 1.12, true),
                (1.12, 0.9, false),
            ] {
                states.put(&mut level, from);
                continuation.tangent = states.tangent(&level, from);
                continuation.predict(&mut level, to);
                if is_parabola {
                    let distance = states.distance(&level, to);
                    assert!(distance < ROUNDING, "{from} to {to}: {distance:e}");
                    continue;
                }
                let change = to - from;
                let approach = states.approach(from) + change * states.approach_rate(from);
                assert!((level.iterate.approach - approach).abs() < ROUNDING);
                for node in 0..NODES {
                    let pressure =
                        states.pressure(node, from) + change * states.pressure_rate(node, from);
                    let total_gap =
                        states.total_gap(node, from) + change * states.total_gap_rate(node, from);
                    assert!((level.iterate.pressure[node] - pressure).abs() < ROUNDING);
                    assert!((level.iterate.total_gap[node] - total_gap).abs() < ROUNDING);
                }
            }
        }
        Ok(())
    }

    /// A state is no tangent, and a tangent no state: where tangents become known or unknown a prediction is that of a
    /// continuation that has seen nothing before, and the next one rests on two of a kind again.
    #[test]
    fn states_and_tangents_are_not_mixed() -> Result<(), Error> {
        let states = States { curvature: 0.02 };
        for mut level in levels()? {
            for is_known in [false, true] {
                let mut continuation = Continuation::default();
                let tangent = |level: &Level, sum: f64, is_known: bool| match is_known {
                    true => states.tangent(level, sum),
                    false => Tangent::default(),
                };
                for (from, to, is_known, is_new) in [
                    (1.0, 1.1, is_known, true),
                    (1.1, 1.25, !is_known, true),
                    (1.25, 1.4, !is_known, false),
                    (1.4, 1.5, is_known, true),
                ] {
                    states.put(&mut level, from);
                    continuation.tangent = tangent(&level, from, is_known);
                    let mut other = level.clone();
                    continuation.predict(&mut level, to);
                    Continuation::new(tangent(&other, from, is_known)).predict(&mut other, to);
                    let [found, fresh] = [&level, &other].map(|level| &level.iterate);
                    let is_same = found.pressure == fresh.pressure
                        && found.total_gap == fresh.total_gap
                        && found.approach == fresh.approach;
                    assert_eq!(is_same, is_new, "{from} to {to}");
                }
            }
        }
        Ok(())
    }

    /// The sum that goes with an approach: in proportion, or along the tangent.
    #[test]
    fn sums_at_an_approach() -> Result<(), Error> {
        let states = States { curvature: 0.0 };
        for mut level in levels()? {
            states.put(&mut level, 2.0);
            let approach = states.approach(2.6);
            let proportional = Continuation::default().sum_at(&level, approach);
            let expected = 2.0 * approach / states.approach(2.0);
            assert!((proportional - expected).abs() < ROUNDING);
            let known = Continuation::new(states.tangent(&level, 2.0));
            assert!((known.sum_at(&level, approach) - 2.6).abs() < ROUNDING);
        }
        Ok(())
    }
}
