//! Projected conjugate gradients on a contact set.

use super::iterate::{Criteria, Effort, Errors};
use super::level::{Level, Target};
use crate::Error;
use crate::krylov::{Directions, NodeSet, add_scaled, dot, greatest, sum, sum_over};

/// Where a round began.
struct Start {
    pressure: Vec<f64>,
    closure: Vec<f64>,
    approach: f64,
}

impl Level {
    /// Conjugate gradients on `contact`, then release of nodes with tension.
    pub(super) fn round_on(
        &mut self,
        contact: &NodeSet,
        target: Target,
        criteria: Criteria,
        inner: f64,
        effort: &mut Effort,
    ) -> Result<Errors, Error> {
        let (mut x, mut closure) = (Vec::new(), Vec::new());
        contact.gather(&self.iterate.pressure, &mut x);
        contact.gather(&self.iterate.closure, &mut closure);
        let mut weights = Vec::new();
        let mut total_weight = 0.0;
        if let Target::Sum(_) = target {
            self.inverse.apply(&vec![1.0; contact.len()], &mut weights);
            total_weight = sum(&weights);
        }
        let approach_of = |closure: &[f64]| match target {
            Target::Approach(approach) => approach,
            Target::Sum(_) => dot(&weights, closure) / total_weight,
        };
        self.iterate.approach = approach_of(&closure);
        let start = Start {
            pressure: x.clone(),
            closure: closure.clone(),
            approach: self.iterate.approach,
        };

        let mut errors = self.errors(contact, &x, &closure);
        let mut residual = vec![0.0; x.len()];
        let mut z = Vec::new();
        let mut directions = Directions::default();
        loop {
            let approach = self.iterate.approach;
            let others = errors.in_set();
            let tolerance = criteria.tolerance * criteria.scale(approach);
            // What is within the tolerance need not be cured.
            let enough = if others > tolerance {
                tolerance.max(inner * others)
            } else {
                tolerance
            };
            let done = errors.residual <= enough || errors.residual.is_nan();
            // A set that has just been chosen deserves a step, unless nothing is wrong.
            let fresh = directions.is_empty() && others > tolerance;
            if (done && !fresh) || effort.iterations >= criteria.max_iterations || x.is_empty() {
                break;
            }
            for (r, g) in residual.iter_mut().zip(&closure) {
                *r = approach - g;
            }
            self.inverse.apply(&residual, &mut z);
            let values = directions.conjugate(&z);
            let displacement = self.operator.step(contact, &values)?;
            let mut image = Vec::new();
            contact.gather(displacement, &mut image);
            let curvature = dot(&values, &image);
            if curvature.is_nan() || curvature <= 0.0 {
                if residual.iter().all(|r| *r == 0.0) {
                    break;
                }
                if directions.forget() {
                    continue;
                }
                return Err(Error::FactorizationFailed {
                    nodes: contact.len(),
                });
            }
            let step = dot(&residual, &values) / curvature;
            add_scaled(&mut x, step, &values);
            add_scaled(&mut self.iterate.closure, step, displacement);
            add_scaled(&mut closure, step, &image);
            self.iterate.approach = approach_of(&closure);
            directions.push(values, image, curvature);
            effort.iterations += 1;
            errors = self.errors(contact, &x, &closure);
        }
        let slack = criteria.tolerance * criteria.scale(self.iterate.approach);
        if errors.tension <= slack {
            for value in &mut x {
                *value = value.max(0.0);
            }
            contact.scatter(&x, &mut self.iterate.pressure);
            return Ok(errors);
        }

        self.release(&mut x, &weights, target);
        self.accept(contact, &start, &mut x)?;
        if let Target::Sum(_) = target {
            // On the nodes that still carry.
            contact.gather(&self.iterate.closure, &mut closure);
            let carrying = |i: usize| if x[i] > 0.0 { weights[i] } else { 0.0 };
            self.iterate.approach =
                sum_over(x.len(), |i| carrying(i) * closure[i]) / sum_over(x.len(), carrying);
        }
        Ok(Errors {
            residual: f64::INFINITY,
            ..errors
        })
    }

    /// Moves to the pressures `x`, or less far if the energy rises on the way.
    fn accept(&mut self, contact: &NodeSet, start: &Start, x: &mut [f64]) -> Result<(), Error> {
        contact.scatter(x, &mut self.iterate.pressure);
        self.refresh()?;
        let mut closure = Vec::new();
        contact.gather(&self.iterate.closure, &mut closure);
        // Along the segment the energy is a parabola, known from its slopes.
        let change = |i: usize| x[i] - start.pressure[i];
        let slope = sum_over(x.len(), |i| (start.closure[i] - start.approach) * change(i));
        let curvature = sum_over(x.len(), |i| (closure[i] - start.closure[i]) * change(i));
        let minimum = -slope / curvature;
        if minimum > 0.0 && minimum < 0.5 {
            for (x, start) in x.iter_mut().zip(&start.pressure) {
                *x = start + minimum * (*x - start);
            }
            contact.scatter(x, &mut self.iterate.pressure);
            self.refresh()?;
        }
        Ok(())
    }

    /// The worst errors at present.
    fn errors(&self, contact: &NodeSet, x: &[f64], closure: &[f64]) -> Errors {
        let approach = self.iterate.approach;
        let (all, places) = (&self.iterate.closure, contact.places());
        Errors {
            residual: greatest(x.len(), 0.0, |i| (approach - closure[i]).abs()),
            overlap: greatest(all.len(), 0.0, |node| {
                if places[node] == NodeSet::NONE {
                    approach - all[node]
                } else {
                    0.0
                }
            }),
            tension: greatest(x.len(), 0.0, |i| -x[i]) * self.self_influence,
        }
    }
}
