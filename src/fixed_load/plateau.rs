//! Loads under which all nodes in contact have yielded.

use super::level::Level;
use crate::Error;
use crate::hardness::Hardness;
use crate::krylov::sum;

/// A set of nodes that carry their hardness while no other node is in contact: the approach grows under one load, from
/// that at which the last of them has yielded to that at which another touches.
///
/// The pressures are known, and so are the gaps under them; both ends follow without a solution.
#[derive(Debug)]
pub(super) struct Plateau {
    pub(super) yielded: Vec<bool>,
    pub(super) pressure: Vec<f64>,
    /// Sum of the pressures \[Pa\].
    pub(super) sum: f64,
    /// Approaches of both ends \[m\].
    pub(super) ends: [f64; 2],
    /// Mean gap at the first of them \[m\].
    mean_gap: f64,
    /// Part of the nodes that are out of contact.
    open: f64,
}

impl Plateau {
    /// That of a set of nodes on a level, `None` if there is none: where another node overlaps before the last of them
    /// yields.
    pub(super) fn of(
        hardness: &Hardness,
        level: &mut Level,
        yielded: Vec<bool>,
    ) -> Result<Option<Self>, Error> {
        let nodes = yielded.iter().zip(hardness.values());
        let pressure: Vec<f64> = nodes.map(|(is_in, h)| if *is_in { *h } else { 0.0 }).collect();
        let sum = sum(&pressure);
        // A node without a limit never yields.
        if !(sum > 0.0 && sum.is_finite()) {
            return Ok(None);
        }
        let displacement = level.operator.apply_field(&pressure)?;
        let gap: Vec<f64> = level.gap.iter().zip(displacement).map(|(g, u)| g + u).collect();
        let ends = ends(&gap, &yielded);
        if ends[0] > ends[1] {
            return Ok(None);
        }
        let others = || gap.iter().zip(&yielded).filter(|(_, is_in)| !**is_in);
        let count = gap.len() as f64;
        let mean_gap = others().map(|(gap, _)| gap - ends[0]).sum::<f64>() / count;
        let open = others().count() as f64 / count;
        Ok(Some(Self { yielded, pressure, sum, ends, mean_gap, open }))
    }

    /// The approach at which its mean gap would be this one.
    pub(super) fn approach_at(&self, mean_gap: f64) -> f64 {
        self.ends[0] + (self.mean_gap - mean_gap) / self.open
    }
}

/// Where the last of the nodes that carry their hardness yields, and where the first of the others touches, with the
/// gaps under these pressures.
pub(super) fn ends(gap: &[f64], yielded: &[bool]) -> [f64; 2] {
    let nodes = gap.iter().zip(yielded);
    nodes.fold([f64::NEG_INFINITY, f64::INFINITY], |[last, next], (&gap, &has_yielded)| {
        if has_yielded { [gap.max(last), next] } else { [last, gap.min(next)] }
    })
}
