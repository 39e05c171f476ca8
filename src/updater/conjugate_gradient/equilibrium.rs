//! A solution on a contact, as fields of the grid.

use crate::contact::ContactSequence;

/// Pressures of the grid and the displacements that they cause.
#[derive(Debug, Clone, Default)]
pub(super) struct Field {
    pub(super) pressure: Vec<f64>,
    /// Empty if it is not known.
    pub(super) displacement: Vec<f64>,
    /// What changes in single precision may have spoilt of the displacements.
    pub(super) drift: f64,
}

/// The pressure at an approach and its rate, on the first `count` nodes of a contact.
#[derive(Debug, Clone, Default)]
pub(super) struct Equilibrium {
    pub(super) count: usize,
    pub(super) approach: f64,
    /// How much further the approach may go with the rate.
    pub(super) span: f64,
    pub(super) load: Field,
    pub(super) rate: Field,
}

impl Field {
    pub(super) fn zero(nodes: usize) -> Self {
        Self {
            pressure: vec![0.0; nodes],
            displacement: vec![0.0; nodes],
            drift: 0.0,
        }
    }

    /// Pressures whose displacements are not known.
    pub(super) fn of(pressure: Vec<f64>) -> Self {
        Self {
            pressure,
            ..Self::default()
        }
    }

    pub(super) fn is_known(&self) -> bool {
        !self.displacement.is_empty()
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

    fn bytes(&self) -> usize {
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
        let (time, load, rate) = (approach - self.approach, &self.load, &self.rate);
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + time * b).collect();
        Field {
            pressure: sum(&load.pressure, &rate.pressure),
            displacement: sum(&load.displacement, &rate.displacement),
            drift: load.drift + time.abs() * rate.drift,
        }
    }

    pub(super) fn bytes(&self) -> usize {
        self.load.bytes() + self.rate.bytes()
    }
}
