//! Search directions of conjugate gradients, and the step along one.

use super::tuning::{CHUNK, KEPT, MEMORY};
use super::{NodeSet, Operator, add_scaled, dot, greatest};
use crate::Error;
use crate::parallel::for_each_chunk;

/// A search direction, whose greatest value is 1, and the displacements that it causes, in units of the operator's.
///
/// Single precision is as good as the convolution, and passes through memory in half the time.
#[derive(Debug, Clone)]
struct Direction {
    values: Vec<f32>,
    /// On the contact set, and on the whole grid.
    image: Vec<f32>,
    everywhere: Vec<f32>,
    unit: f64,
    curvature: f64,
    /// Root of the sum of squares of the values.
    norm: f64,
}

/// A step of conjugate gradients on a contact set: by `length` along `values`, which changes displacements by `reach`
/// times `image` in contact, and times `everywhere` on the whole grid. The sum of squares of what is added has the root
/// `norm`.
#[derive(Debug)]
pub(crate) struct Step<'a> {
    pub(crate) length: f64,
    pub(crate) values: &'a [f32],
    pub(crate) reach: f64,
    pub(crate) image: &'a [f32],
    pub(crate) everywhere: &'a [f32],
    pub(crate) norm: f64,
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
        Self { kept: KEPT, ..Self::default() }
    }

    /// The last ones, to which a new one is made conjugate.
    fn last(&self) -> &[Direction] {
        let first = self.list.len().saturating_sub(MEMORY).max(self.since);
        &self.list[first..]
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.last().is_empty()
    }

    /// Projects the parts along all kept directions out of the residual of x, whose displacements of the whole
    /// grid are u: the directions are conjugate, so that each is a step of its own (Chan and Wan, SIAM J.
    /// Sci. Comput. 18 (1997) 1698). Returns the root of the sum of squares of all norms of these steps.
    pub(crate) fn project(&self, x: &mut [f64], residual: &mut [f64], u: &mut [f64]) -> f64 {
        let (mut reaches, mut norm) = (Vec::new(), 0.0_f64);
        let kept = &self.list[..self.kept.min(self.list.len())];
        for direction in kept {
            let step = direction.step(residual);
            add_scaled(x, step.length, step.values);
            add_scaled(residual, -step.reach, step.image);
            reaches.push(step.reach);
            norm = norm.hypot(step.norm);
        }
        for_each_chunk(u, CHUNK, |chunk, u| {
            for (direction, reach) in kept.iter().zip(&reaches) {
                add_scaled(u, *reach, &direction.everywhere[chunk * CHUNK..]);
            }
        });
        norm
    }

    /// The step that takes most of the energy out of `residual`, along the preconditioned residual
    /// `z` made conjugate to earlier directions.
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
            return Err(Error::FactorizationFailed { nodes: contact.len() });
        };
        if self.list.len() == self.kept + MEMORY {
            self.list.remove(self.kept);
            self.since = self.since.saturating_sub(1);
        }
        self.list.push(direction);
        Ok(self.list[self.list.len() - 1].step(residual))
    }

    /// The direction along `z`, conjugate to the earlier ones; `None` unless its curvature is positive
    /// and finite.
    fn explore(
        &self,
        operator: &mut Operator,
        contact: &NodeSet,
        z: &[f64],
    ) -> Result<Option<Direction>, Error> {
        let mut sum = z.to_vec();
        for earlier in self.last() {
            let part = earlier.unit * dot(z, &earlier.image) / earlier.curvature;
            add_scaled(&mut sum, -part, &earlier.values);
        }
        let most = greatest(sum.len(), 0.0, |i| sum[i].abs());
        if most == 0.0 {
            return Ok(None);
        }
        let per_most = 1.0 / most;
        let values: Vec<f32> = sum.iter().map(|value| (value * per_most) as f32).collect();
        Direction::along(operator, contact, values)
    }

    /// The values of all directions on their contact set.
    pub(crate) fn values(&self) -> impl ExactSizeIterator<Item = &[f32]> {
        self.list.iter().map(|direction| &direction.values[..])
    }

    /// How many of the first are kept, and from which on they are looked back at.
    pub(crate) fn marks(&self) -> [usize; 2] {
        [self.kept, self.since]
    }

    /// The directions of which these are the values on a contact set, and these the marks.
    ///
    /// # Errors
    ///
    /// [`Error::FactorizationFailed`] if there is no direction along some values.
    pub(crate) fn recall(
        operator: &mut Operator,
        contact: &NodeSet,
        values: impl Iterator<Item = Vec<f32>>,
        [kept, since]: [usize; 2],
    ) -> Result<Self, Error> {
        let mut list = Vec::new();
        for values in values {
            let direction = Direction::along(operator, contact, values)?;
            list.push(direction.ok_or(Error::FactorizationFailed { nodes: contact.len() })?);
        }
        // Positions in the list, whatever was written down.
        let (kept, since) = (kept.min(KEPT), since.min(list.len()));
        list.truncate(kept + MEMORY);
        Ok(Self { list, kept, since })
    }
}

impl Direction {
    /// The one along these values; `None` unless its curvature is positive and finite.
    fn along(
        operator: &mut Operator,
        contact: &NodeSet,
        values: Vec<f32>,
    ) -> Result<Option<Self>, Error> {
        let (mut everywhere, mut image) = (Vec::new(), Vec::new());
        operator.step(contact, &values, &mut everywhere)?;
        contact.gather(&everywhere, &mut image);
        let unit = operator.unit();
        let curvature = unit * dot(&values, &image);
        let usable = curvature > 0.0 && curvature.is_finite();
        Ok(usable.then(|| Self {
            norm: dot(&values, &values).sqrt(),
            values,
            image,
            everywhere,
            unit,
            curvature,
        }))
    }

    /// The step along it that takes most of the energy out of a residual.
    fn step(&self, residual: &[f64]) -> Step<'_> {
        let length = dot(residual, &self.values) / self.curvature;
        Step {
            length,
            values: &self.values,
            reach: length * self.unit,
            image: &self.image,
            everywhere: &self.everywhere,
            norm: length.abs() * self.norm,
        }
    }
}
