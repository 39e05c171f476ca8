//! Search directions of conjugate gradients, and the step along one.

use super::{NodeSet, Operator, add_scaled, dot};
use crate::Error;

/// Earlier directions to which a new one is made conjugate. One would do in exact arithmetic; with
/// the second the iteration does not suffer from steps in single precision.
const MEMORY: usize = 2;
/// Directions that are kept if they are to serve another right-hand side: the first ones hold the long
/// waves, which right-hand sides have in common.
const KEPT: usize = 12;

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

/// The last search directions, oldest first.
#[derive(Debug, Clone, Default)]
pub(crate) struct Directions {
    last: Vec<Direction>,
    /// The first ones, if they are to serve other right-hand sides.
    kept: Option<Vec<Direction>>,
}

impl Directions {
    /// Directions that are to serve other right-hand sides of the same matrix as well.
    pub(crate) fn keeping() -> Self {
        Self {
            last: Vec::new(),
            kept: Some(Vec::new()),
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.last.is_empty()
    }

    /// Takes the parts along all kept directions out of the residual of x, whose displacements of the whole
    /// grid are u: the directions are conjugate, so that each is a step of its own (Chan and Wan, SIAM J.
    /// Sci. Comput. 18 (1997) 1698).
    pub(crate) fn project(&self, x: &mut [f64], residual: &mut [f64], u: &mut [f64]) {
        for direction in self.kept.iter().flatten() {
            let length = dot(residual, &direction.values) / direction.curvature;
            add_scaled(x, length, &direction.values);
            add_scaled(residual, -length, &direction.image);
            for (u, change) in u.iter_mut().zip(&direction.everywhere) {
                *u += length * f64::from(*change);
            }
        }
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
                self.last.clear();
                self.explore(operator, contact, z)?
            }
            direction => direction,
        };
        let Some(direction) = direction else {
            return Err(Error::FactorizationFailed {
                nodes: contact.len(),
            });
        };
        if let Some(kept) = self.kept.as_mut().filter(|kept| kept.len() < KEPT) {
            kept.push(direction.clone());
        }
        if self.last.len() == MEMORY {
            self.last.remove(0);
        }
        self.last.push(direction);
        let Direction {
            values,
            image,
            curvature,
            ..
        } = &self.last[self.last.len() - 1];
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
        for earlier in &self.last {
            let part = dot(z, &earlier.image) / earlier.curvature;
            add_scaled(&mut values, -part, &earlier.values);
        }
        let displacement = operator.step(contact, &values)?;
        let mut image = Vec::new();
        contact.gather(displacement, &mut image);
        let everywhere = match &self.kept {
            Some(kept) if kept.len() < KEPT => displacement.iter().map(|u| *u as f32).collect(),
            _ => Vec::new(),
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
