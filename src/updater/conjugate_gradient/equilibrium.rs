//! A solution on a contact, as fields of the grid.

use crate::contact::ContactSequence;

/// Pressures of the grid and the displacements that they cause.
#[derive(Debug, Clone, Default)]
pub(super) struct Field {
    pub(super) pressure: Vec<f64>,
    /// Empty if it is not known.
    pub(super) displacement: Vec<f64>,
}

/// The pressure at an approach and its rate, on the first `count` nodes of a contact.
#[derive(Debug, Clone, Default)]
pub(super) struct Equilibrium {
    pub(super) count: usize,
    pub(super) approach: f64,
    pub(super) load: Field,
    pub(super) rate: Field,
}

impl Field {
    pub(super) fn zero(nodes: usize) -> Self {
        Self {
            pressure: vec![0.0; nodes],
            displacement: vec![0.0; nodes],
        }
    }

    pub(super) fn is_known(&self) -> bool {
        !self.displacement.is_empty()
    }

    /// This field and `factor` times another.
    pub(super) fn plus(&self, factor: f64, other: &Self) -> Self {
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + factor * b).collect();
        Self {
            pressure: sum(&self.pressure, &other.pressure),
            displacement: if other.is_known() {
                sum(&self.displacement, &other.displacement)
            } else {
                Vec::new()
            },
        }
    }

    /// Keeps the pressures on nodes in contact; what they cause is not known then.
    pub(super) fn keep(&mut self, contact: &ContactSequence) {
        self.displacement.clear();
        for (node, value) in self.pressure.iter_mut().enumerate() {
            if !contact.contains(node) {
                *value = 0.0;
            }
        }
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.pressure[..]) + size_of_val(&self.displacement[..])
    }
}

impl Equilibrium {
    /// Before any contact.
    pub(super) fn zero(nodes: usize) -> Self {
        Self {
            load: Field::zero(nodes),
            rate: Field::zero(nodes),
            ..Self::default()
        }
    }

    /// The pressure at another approach, as long as no node joins.
    pub(super) fn load_at(&self, approach: f64) -> Field {
        self.load.plus(approach - self.approach, &self.rate)
    }

    pub(super) fn bytes(&self) -> usize {
        self.load.bytes() + self.rate.bytes()
    }
}
