//! Pressures that end at a hardness: nodes yield, round after round.

use super::level::{Level, Prescribed};
use super::plateau::ends;
use super::tuning::{MOST_RECOVERIES, NO_REST};
use crate::Error;
use crate::hardness::Hardness;
use crate::krylov::sum;

/// Nodes that have yielded, on the way to a solution.
///
/// Rounds of elastic solutions, each with the nodes above H yielded, end at the solution. Where no pressure draws
/// others with it (`C_EE⁻¹ C_EY ≥ 0`), no node that carries more than H in an elastic solution can be elastic in the
/// end: pressure that is taken off it goes to others, and never back. On other bodies a node can have yielded too
/// early. It then has a gap under H, and is elastic again in the next round.
#[derive(Debug)]
pub(super) struct Yielded<'a> {
    hardness: &'a Hardness,
    map: Vec<bool>,
    /// Sum of their pressures \[Pa\].
    sum: f64,
    /// A gap that no approach closes: yielded nodes are no part of the elastic problem.
    open: f64,
    own_gap: Vec<f64>,
    /// The gap under the pressures of nodes that have yielded, g + C H.
    gap: Vec<f64>,
    /// How many times nodes were elastic again.
    recoveries: usize,
}

/// What a round has changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Round {
    /// Nothing: the solution is found.
    Settled,
    /// Nodes have yielded, or are elastic again.
    Changed,
    /// Nodes come and go without end.
    Undecided,
}

impl<'a> Yielded<'a> {
    /// None yet.
    pub(super) fn none(hardness: &'a Hardness, level: &Level, prescribed: Prescribed) -> Self {
        let own_gap = level.gap.clone();
        // Without a mean a node may lie above it. No coefficient of a positive definite matrix exceeds its diagonal.
        let length = match prescribed {
            Prescribed::Sum(sum) => level.self_influence * sum,
            Prescribed::Approach(approach) => approach,
        };
        let open = 4.0 * (own_gap.iter().copied().fold(0.0, f64::max) + length);
        let (map, gap) = (vec![false; own_gap.len()], own_gap.clone());
        Self { hardness, map, sum: 0.0, open, own_gap, gap, recoveries: 0 }
    }

    /// Those of an earlier state of the level, which a greater load or approach has as well. The level's problem
    /// becomes that of the others, whose pressures stay within their hardness.
    pub(super) fn resume(
        hardness: &'a Hardness,
        level: &mut Level,
        prescribed: Prescribed,
        earlier: &[bool],
    ) -> Result<Self, Error> {
        let mut yielded = Self::none(hardness, level, prescribed);
        let pressures = level.iterate.pressure.iter_mut().zip(hardness.values());
        for ((pressure, &hardness), &has_yielded) in pressures.zip(earlier) {
            *pressure = if has_yielded { f64::INFINITY } else { pressure.clamp(0.0, hardness) };
        }
        yielded.revise(level, f64::INFINITY)?;
        Ok(yielded)
    }

    /// Lets all nodes of the level's iterate yield that carry anything, if with their hardness they carry the sum
    /// `sum`: no pressure exceeds it. Returns whether it does.
    pub(super) fn exhaust(&mut self, level: &mut Level, sum: f64) -> Result<bool, Error> {
        let pressures = level.iterate.pressure.iter().zip(self.hardness.values());
        let carrying = pressures.filter(|(pressure, _)| **pressure > 0.0).map(|(_, h)| h);
        let rest = sum - self.sum - carrying.sum::<f64>();
        // Also where one of them never yields.
        let is_all = rest.abs() <= NO_REST * sum;
        if !is_all {
            return Ok(false);
        }
        for pressure in level.iterate.pressure.iter_mut().filter(|pressure| **pressure > 0.0) {
            *pressure = f64::INFINITY;
        }
        self.revise(level, f64::INFINITY)?;
        Ok(true)
    }

    /// What nodes that have not yielded carry of the sum `sum`; nothing on a plateau.
    pub(super) fn rest(&self, sum: f64) -> Option<f64> {
        let rest = sum - self.sum;
        (rest > NO_REST * sum).then_some(rest)
    }

    /// Makes the iterate of the level, on which no node carries anything, that of the beginning of a plateau: where the
    /// last node yields. Returns by how much others overlap there.
    pub(super) fn begin_plateau(&self, level: &mut Level) -> f64 {
        let [last, next] = ends(&self.gap, &self.map);
        let iterate = &mut level.iterate;
        iterate.pressure.fill(0.0);
        iterate.total_gap.copy_from_slice(&level.gap);
        iterate.approach = last.min(next);
        last - next
    }

    /// Lets the nodes of the level's iterate yield whose pressure exceeds their hardness, and those be elastic again
    /// that have a gap above `tolerance` \[m\].
    pub(super) fn revise(&mut self, level: &mut Level, tolerance: f64) -> Result<Round, Error> {
        let mut load = vec![0.0; self.map.len()];
        let iterate = &mut level.iterate;
        let nodes = iterate.pressure.iter_mut().zip(self.hardness.values()).zip(&mut self.map);
        let mut recovers = false;
        for (node, ((pressure, &hardness), has_yielded)) in nodes.enumerate() {
            let displaced = iterate.total_gap[node] - self.open;
            if *has_yielded && self.gap[node] + displaced - iterate.approach > tolerance {
                (*has_yielded, load[node], *pressure) = (false, -hardness, hardness);
                recovers = true;
            } else if !*has_yielded && *pressure > hardness {
                (*has_yielded, load[node], *pressure) = (true, hardness, 0.0);
            }
        }
        if load.iter().all(|value| *value == 0.0) {
            return Ok(Round::Settled);
        }
        if recovers {
            self.recoveries += 1;
            if self.recoveries > MOST_RECOVERIES {
                return Ok(Round::Undecided);
            }
        }
        self.sum += sum(&load);
        let displacement = level.operator.apply_field(&load)?;
        let gaps = level.gap.iter_mut().zip(&mut self.gap).zip(&self.map);
        for (((level_gap, gap), has_yielded), u) in gaps.zip(displacement) {
            *gap += u;
            *level_gap = if *has_yielded { self.open } else { *gap };
        }
        Ok(Round::Changed)
    }

    /// Makes the level's problem the one of the surface again, and its iterate that with all pressures. Returns the
    /// nodes that have yielded.
    pub(super) fn finish(self, level: &mut Level) -> Result<Vec<bool>, Error> {
        level.gap = self.own_gap;
        let pressures = level.iterate.pressure.iter_mut().zip(self.hardness.values());
        for ((pressure, hardness), has_yielded) in pressures.zip(&self.map) {
            if *has_yielded {
                *pressure = *hardness;
            }
        }
        level.refresh()?;
        Ok(self.map)
    }

    /// Makes the level's problem the one of the surface again, after an error.
    pub(super) fn abandon(self, level: &mut Level) {
        level.gap = self.own_gap;
    }
}
