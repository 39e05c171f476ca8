//! Search directions of conjugate gradients.

use super::{add_scaled, dot};

/// Earlier directions to which a new one is made conjugate. One would do in exact arithmetic; with
/// the second the iteration does not suffer from steps in single precision.
const MEMORY: usize = 2;

/// A search direction and what it does to the contact set.
#[derive(Debug, Clone)]
struct Direction {
    values: Vec<f64>,
    image: Vec<f64>,
    curvature: f64,
}

/// The last search directions.
#[derive(Debug, Clone, Default)]
pub(crate) struct Directions {
    last: Vec<Direction>,
}

impl Directions {
    pub(crate) fn is_empty(&self) -> bool {
        self.last.is_empty()
    }

    /// `z` made conjugate to them.
    pub(crate) fn conjugate(&self, z: &[f64]) -> Vec<f64> {
        let mut values = z.to_vec();
        for Direction {
            values: earlier,
            image,
            curvature,
        } in &self.last
        {
            add_scaled(&mut values, -dot(z, image) / curvature, earlier);
        }
        values
    }

    /// Forgets all of them, and says whether there were any: among a few nodes they may leave nothing
    /// for another, though a step in single precision was not exact.
    pub(crate) fn forget(&mut self) -> bool {
        let any = !self.last.is_empty();
        self.last.clear();
        any
    }

    /// Adds a direction, and forgets the oldest.
    pub(crate) fn push(&mut self, values: Vec<f64>, image: Vec<f64>, curvature: f64) {
        if self.last.len() == MEMORY {
            self.last.remove(0);
        }
        self.last.push(Direction {
            values,
            image,
            curvature,
        });
    }
}
