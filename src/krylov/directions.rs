//! Search directions of conjugate gradients, and the step along one.

use super::{NodeSet, Operator, add_scaled, dot};
use crate::Error;
use crate::parallel::for_each_chunk;

/// Earlier directions to which a new one is made conjugate. One would do in exact arithmetic; with
/// the second the iteration does not suffer from steps in single precision.
const MEMORY: usize = 2;
/// Directions that are kept if they are to serve another right-hand side: the first ones hold the long
/// waves, which right-hand sides have in common.
const KEPT: usize = 12;
/// Values of a field that a thread changes at a time.
const CHUNK: usize = 4096;

/// A search direction and what it does to the contact set.
#[derive(Debug, Clone)]
struct Direction {
    values: Vec<f64>,
    image: Vec<f64>,
    curvature: f64,
    /// Displacements of the whole grid, if the direction may be kept.
    everywhere: Vec<f32>,
}

/// A step of conjugate gradients on a contact set: by `length` along `values`, which changes
/// displacements by `length` times `image`.
#[derive(Debug)]
pub(crate) struct Step<'a> {
    pub(crate) length: f64,
    pub(crate) values: &'a [f64],
    pub(crate) image: &'a [f64],
}

/// Search directions, oldest first: the first ones, if they are to serve other right-hand sides, and the
/// last ones.
#[derive(Debug, Clone, Default)]
pub(crate) struct Directions {
    list: Vec<Direction>,
    /// How many of the first are kept.
    kept: usize,
    /// Those before this one are not looked back at.
    since: usize,
}

impl Directions {
    /// Directions that are to serve other right-hand sides of the same matrix as well.
    pub(crate) fn keeping() -> Self {
        Self {
            kept: KEPT,
            ..Self::default()
        }
    }

    /// The last ones, to which a new one is made conjugate.
    fn last(&self) -> &[Direction] {
        let first = self.list.len().saturating_sub(MEMORY).max(self.since);
        &self.list[first..]
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.last().is_empty()
    }

    /// Takes the parts along all kept directions out of the residual of x, whose displacements of the whole
    /// grid are u: the directions are conjugate, so that each is a step of its own (Chan and Wan, SIAM J.
    /// Sci. Comput. 18 (1997) 1698).
    pub(crate) fn project(&self, x: &mut [f64], residual: &mut [f64], u: &mut [f64]) {
        let mut lengths = Vec::new();
        let kept = &self.list[..self.kept.min(self.list.len())];
        for direction in kept {
            let length = dot(residual, &direction.values) / direction.curvature;
            add_scaled(x, length, &direction.values);
            add_scaled(residual, -length, &direction.image);
            lengths.push(length);
        }
        for_each_chunk(u, CHUNK, |chunk, u| {
            for (direction, length) in kept.iter().zip(&lengths) {
                let changes = &direction.everywhere[chunk * CHUNK..];
                for (u, change) in u.iter_mut().zip(changes) {
                    *u += length * f64::from(*change);
                }
            }
        });
    }

    /// The step that takes most of the energy out of `residual`, along the preconditioned residual
    /// `z` made conjugate to earlier directions. The operator then holds the displacements that the
    /// direction causes on the whole grid.
    ///
    /// On a set of few nodes nothing may be left of z once it is conjugate to directions whose images
    /// are of single precision: then they are forgotten, and the step goes along z itself.
    ///
    /// # Errors
    ///
    /// [`Error::FactorizationFailed`] if the curvature along z is not positive either.
    pub(crate) fn advance(
        &mut self,
        operator: &mut Operator,
        contact: &NodeSet,
        residual: &[f64],
        z: &[f64],
    ) -> Result<Step<'_>, Error> {
        let direction = match self.explore(operator, contact, z)? {
            None if !self.is_empty() => {
                self.since = self.list.len();
                self.explore(operator, contact, z)?
            }
            direction => direction,
        };
        let Some(direction) = direction else {
            return Err(Error::FactorizationFailed {
                nodes: contact.len(),
            });
        };
        if self.list.len() == self.kept + MEMORY {
            self.list.remove(self.kept);
            self.since = self.since.saturating_sub(1);
        }
        self.list.push(direction);
        let Direction {
            values,
            image,
            curvature,
            ..
        } = &self.list[self.list.len() - 1];
        Ok(Step {
            length: dot(residual, values) / curvature,
            values,
            image,
        })
    }

    /// The direction along `z`, conjugate to the earlier ones; `None` unless its curvature is positive
    /// and finite.
    fn explore(
        &self,
        operator: &mut Operator,
        contact: &NodeSet,
        z: &[f64],
    ) -> Result<Option<Direction>, Error> {
        let mut values = z.to_vec();
        for earlier in self.last() {
            let part = dot(z, &earlier.image) / earlier.curvature;
            add_scaled(&mut values, -part, &earlier.values);
        }
        let displacement = operator.step(contact, &values)?;
        let mut image = Vec::new();
        contact.gather(displacement, &mut image);
        let everywhere = if self.list.len() < self.kept {
            displacement.iter().map(|u| *u as f32).collect()
        } else {
            Vec::new()
        };
        let curvature = dot(&values, &image);
        let usable = curvature > 0.0 && curvature.is_finite();
        Ok(usable.then_some(Direction {
            values,
            image,
            curvature,
            everywhere,
        }))
    }
}
