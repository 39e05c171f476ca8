//! Approximate solutions: what they are, how good they are, and when they are good enough.

use super::tuning::{DEAD_BAND, FINEST};
use crate::krylov::{NodeSet, greatest};

/// An approximate solution on one grid: pressure ≥ 0, with the target's sum if it is one.
#[derive(Debug, Clone)]
pub(super) struct Iterate {
    pub(super) pressure: Vec<f64>,
    /// Initial gap plus displacement, G = g + C p.
    pub(super) total_gap: Vec<f64>,
    pub(super) approach: f64,
    pub(super) contact: NodeSet,
}

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Criteria {
    /// Relative to the approach, at least `floor`, or to `length` if that is smaller, though not than rounding.
    pub(super) tolerance: f64,
    pub(super) floor: f64,
    pub(super) length: f64,
    pub(super) max_iterations: usize,
    /// Whether to compute the displacement afresh at the end, and to go on if it disagrees.
    pub(super) verify: bool,
}

impl Criteria {
    /// Greatest length by which gaps may be wrong at an approach.
    pub(super) fn gap_error(&self, approach: f64) -> f64 {
        self.tolerance * self.scale(approach)
    }

    /// The total gap below which nodes overlap at an approach; what is less is rounding.
    pub(super) fn deepest(&self, approach: f64) -> f64 {
        approach - DEAD_BAND * self.gap_error(approach)
    }

    /// The unit of length of the tolerance.
    pub(super) fn scale(&self, approach: f64) -> f64 {
        // NaN stays NaN.
        let approach = if approach < self.floor { self.floor } else { approach };
        if self.length < approach { self.length.max(FINEST * approach) } else { approach }
    }
}

/// How far a solve has come: steps of conjugate gradients, and contact sets.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Progress {
    pub(super) iterations: usize,
    pub(super) rounds: usize,
}

impl Iterate {
    pub(super) fn new(nodes: usize) -> Self {
        Self {
            pressure: vec![0.0; nodes],
            total_gap: vec![0.0; nodes],
            approach: 0.0,
            contact: NodeSet::new(nodes),
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        2 * size_of_val(&self.pressure[..]) + size_of_val(self.contact.places())
    }
}

/// The worst errors of an iterate, as lengths.
#[derive(Debug, Clone, Copy)]
pub(super) struct Errors {
    /// |gap| in the contact set.
    pub(super) residual: f64,
    /// Overlap outside it.
    pub(super) overlap: f64,
    /// Tension inside it, times C(0, 0).
    pub(super) tension: f64,
}

impl Errors {
    /// Errors of the set itself.
    pub(super) fn in_set(&self) -> f64 {
        greatest(2, 0.0, |i| [self.overlap, self.tension][i])
    }

    /// The same of a set on which the solution is not known.
    pub(super) fn unsolved(self) -> Self {
        Self { residual: f64::INFINITY, ..self }
    }

    /// All of it; NaN if any is.
    pub(super) fn worst(&self) -> f64 {
        greatest(2, 0.0, |i| [self.residual, self.in_set()][i])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two fields, and the places of the contact: those of the nodes in it are counted with the preconditioner.
    #[test]
    fn bytes_are_those_of_the_fields() {
        let iterate = Iterate::new(100);
        let fields = size_of_val(&iterate.pressure[..]) + size_of_val(&iterate.total_gap[..]);
        assert_eq!(iterate.bytes(), fields + 100 * size_of::<u32>());
    }

    /// The approach, no less than the floor, or a smaller length that rounding does not reach; NaN stays.
    #[test]
    fn errors_are_relative_to_a_length_above_rounding() {
        let criteria = |floor, length| Criteria {
            tolerance: 1e-2,
            floor,
            length,
            max_iterations: 1,
            verify: false,
        };
        for (floor, length, approach, expected) in [
            (0.0, f64::INFINITY, 2.0, 2.0),
            (3.0, f64::INFINITY, 2.0, 3.0),
            (0.0, 0.5, 2.0, 0.5),
            (3.0, 0.5, 2.0, 0.5),
            // A surface that is flat but for rounding.
            (0.0, 1e-40, 2.0, 2e-12),
            (3.0, 1e-40, 2.0, 3e-12),
        ] {
            assert_eq!(criteria(floor, length).scale(approach), expected);
        }
        assert!(criteria(1.0, 0.5).scale(f64::NAN).is_nan());
    }
}
