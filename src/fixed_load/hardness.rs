//! Pressures that end at a hardness: nodes yield, round after round.

use super::level::{Level, Prescribed};
use crate::Error;
use crate::hardness::Hardness;

/// Nodes that have yielded, on the way to a solution.
///
/// On a body whose contact only grows, no node that carries more than H
/// in an elastic solution can be elastic in the end: pressure that is taken off it goes to others, and never back. So rounds of
/// elastic solutions, each with the nodes above H yielded, end, and end at the solution.
#[derive(Debug)]
pub(super) struct Yielded<'a> {
    hardness: &'a Hardness,
    map: Vec<bool>,
    /// Sum of their pressures \[Pa\].
    sum: f64,
    /// A gap that no approach closes: yielded nodes are no part of the elastic problem.
    open: f64,
    own_gap: Vec<f64>,
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
        Self { hardness, map: vec![false; own_gap.len()], sum: 0.0, open, own_gap }
    }

    /// Those of an earlier state of the level, which a greater load or approach has as well. The level's problem becomes that of the
    /// others, whose pressures stay within their hardness.
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
        yielded.grow(level)?;
        Ok(yielded)
    }

    /// Sum of the pressures of nodes that have yielded \[Pa\].
    pub(super) fn sum(&self) -> f64 {
        self.sum
    }

    /// Whether all have.
    pub(super) fn is_everywhere(&self) -> bool {
        !self.map.contains(&false)
    }

    /// Lets the nodes of the level's iterate whose pressure exceeds their hardness yield; false if there is none.
    pub(super) fn grow(&mut self, level: &mut Level) -> Result<bool, Error> {
        let mut load = vec![0.0; self.map.len()];
        let pressures = level.iterate.pressure.iter_mut().zip(self.hardness.values());
        for (node, (pressure, &hardness)) in pressures.enumerate() {
            if *pressure > hardness && !self.map[node] {
                (self.map[node], load[node], *pressure) = (true, hardness, 0.0);
                self.sum += hardness;
            }
        }
        if load.iter().all(|value| *value == 0.0) {
            return Ok(false);
        }
        let displacement = level.operator.apply_field(&load)?;
        for ((gap, u), has_yielded) in level.gap.iter_mut().zip(displacement).zip(&self.map) {
            *gap = if *has_yielded { self.open } else { *gap + u };
        }
        Ok(true)
    }

    /// Makes the level's problem the one of the surface again, and its iterate that with all pressures. Returns the nodes that have
    /// yielded.
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
