//! Projected conjugate gradients on a contact set.

use super::iterate::{Criteria, Errors, Progress};
use super::level::{Level, Prescribed};
use super::release::release;
use super::tuning::{MOST_HALVINGS, ULPS};
use crate::Error;
use crate::krylov::{Directions, NodeSet, add_scaled, dot, greatest, sum, sum_over};

/// The way down in energy on the contact set of a level, at whose nodes it keeps the fields.
#[derive(Debug)]
pub(super) struct Descent<'a> {
    level: &'a mut Level,
    prescribed: Prescribed,
    criteria: Criteria,
    pressure: Vec<f64>,
    total_gap: Vec<f64>,
    /// The preconditioner times the unit vector if the sum is prescribed, and its sum.
    weights: Vec<f64>,
    total_weight: f64,
}

/// Where a descent began.
struct Start {
    pressure: Vec<f64>,
    total_gap: Vec<f64>,
    approach: f64,
}

impl<'a> Descent<'a> {
    /// From the present iterate of `level`.
    pub(super) fn new(level: &'a mut Level, prescribed: Prescribed, criteria: Criteria) -> Self {
        let (mut pressure, mut total_gap) = (Vec::new(), Vec::new());
        let contact = &level.iterate.contact;
        contact.gather(&level.iterate.pressure, &mut pressure);
        contact.gather(&level.iterate.total_gap, &mut total_gap);
        let mut weights = Vec::new();
        if let Prescribed::Sum(_) = prescribed {
            level.preconditioner.apply(&vec![1.0; contact.len()], &mut weights);
        }
        let descent = Self {
            level,
            prescribed,
            criteria,
            pressure,
            total_gap,
            total_weight: sum(&weights),
            weights,
        };
        descent.level.iterate.approach = descent.approach();
        descent
    }

    /// Conjugate gradients until the residual is below `inner` times the errors of the set itself,
    /// then release of nodes with tension.
    pub(super) fn run(self, inner: f64, progress: &mut Progress) -> Result<Errors, Error> {
        self.run_and(inner, progress, Self::release)
    }

    /// The same, but from the start, whose pressures must not be negative, only as far towards the solution as the
    /// energy is less than it was with all nodes on the way set free that lose their pressure.
    pub(super) fn run_downhill(self, inner: f64, progress: &mut Progress) -> Result<Errors, Error> {
        self.run_and(inner, progress, Self::go_downhill)
    }

    /// Conjugate gradients, and `cure` where they leave tension.
    fn run_and(
        mut self,
        inner: f64,
        progress: &mut Progress,
        cure: impl FnOnce(&mut Self, &Start) -> Result<(), Error>,
    ) -> Result<Errors, Error> {
        let start = Start {
            pressure: self.pressure.clone(),
            total_gap: self.total_gap.clone(),
            approach: self.level.iterate.approach,
        };
        let errors = self.iterate(inner, progress)?;
        if errors.tension > self.tolerance() {
            cure(&mut self, &start)?;
            return Ok(errors.unsolved());
        }
        self.keep();
        Ok(errors)
    }

    /// The whole way, half of it, and so on until the energy is less, but not less far than to where the first
    /// pressures vanish: up to there it falls.
    fn go_downhill(&mut self, start: &Start) -> Result<(), Error> {
        let end = self.pressure.clone();
        let edge = edge(&start.pressure, &end);
        let mut part = 1.0;
        for _ in 0..MOST_HALVINGS {
            if part <= edge {
                break;
            }
            for ((x, from), end) in self.pressure.iter_mut().zip(&start.pressure).zip(&end) {
                *x = (from + part * (end - from)).max(0.0);
            }
            self.prescribed.scale(&mut self.pressure);
            self.move_there()?;
            if self.energy_since(start) < 0.0 {
                return Ok(());
            }
            part *= 0.5;
        }
        self.pressure = end;
        self.stop_at_the_edge(start, edge)
    }

    /// What the energy has changed by since the start, less the approach times the change of the sum: of both
    /// displacements, so that nothing cancels.
    fn energy_since(&self, start: &Start) -> f64 {
        let (x, total_gap) = (&self.pressure, &self.total_gap);
        sum_over(x.len(), |i| {
            let gap = 0.5 * (total_gap[i] + start.total_gap[i]) - start.approach;
            (x[i] - start.pressure[i]) * gap
        })
    }

    /// Where the first pressures vanish, which part of the way is that.
    fn stop_at_the_edge(&mut self, start: &Start, part: f64) -> Result<(), Error> {
        for (x, from) in self.pressure.iter_mut().zip(&start.pressure) {
            let is_free = *x < 0.0 && from / (from - *x) <= part;
            *x = if is_free { 0.0 } else { (from + part * (*x - from)).max(0.0) };
        }
        self.move_there()
    }

    /// Makes the pressures those of the level, without what is left of tension.
    fn keep(&mut self) {
        for value in &mut self.pressure {
            *value = value.max(0.0);
        }
        let iterate = &mut self.level.iterate;
        iterate.contact.scatter(&self.pressure, &mut iterate.pressure);
    }

    /// Conjugate gradients; pressures may become negative.
    fn iterate(&mut self, inner: f64, progress: &mut Progress) -> Result<Errors, Error> {
        let mut errors = self.errors();
        let mut residual = vec![0.0; self.pressure.len()];
        let mut z = Vec::new();
        let mut directions = Directions::default();
        loop {
            let others = errors.in_set();
            let tolerance = self.tolerance();
            // What is within the tolerance need not be cured.
            let enough = if others > tolerance { tolerance.max(inner * others) } else { tolerance };
            if !errors.residual.is_finite() {
                return Ok(Errors { residual: f64::NAN, ..errors });
            }
            // A set that has just been chosen deserves a step, unless nothing but rounding is wrong.
            let rounding = ULPS * f64::EPSILON * self.level.iterate.approach.abs();
            let fresh = directions.is_empty() && others > tolerance && errors.residual > rounding;
            if (errors.residual <= enough && !fresh)
                || progress.iterations >= self.criteria.max_iterations
            {
                return Ok(errors);
            }
            let approach = self.level.iterate.approach;
            for (r, g) in residual.iter_mut().zip(&self.total_gap) {
                *r = approach - g;
            }
            let Level { preconditioner, operator, iterate, .. } = &mut *self.level;
            preconditioner.apply(&residual, &mut z);
            let step = directions.advance(operator, &iterate.contact, &residual, &z)?;
            add_scaled(&mut self.pressure, step.length, step.values);
            add_scaled(&mut self.total_gap, step.reach, step.image);
            add_scaled(&mut iterate.total_gap, step.reach, step.everywhere);
            self.level.iterate.approach = self.approach();
            progress.iterations += 1;
            errors = self.errors();
        }
    }

    /// Sets nodes with tension free, and goes there, or as far as the energy falls if there was no tension at the
    /// start.
    fn release(&mut self, start: &Start) -> Result<(), Error> {
        release(
            self.level.preconditioner.sparse(),
            &mut self.pressure,
            &self.weights,
            self.prescribed,
        );
        self.move_there()?;
        if start.pressure.iter().all(|x| *x >= 0.0) {
            self.go_to_the_minimum(start)?;
        }
        if let Prescribed::Sum(_) = self.prescribed {
            // On the nodes that still carry.
            let (x, total_gap) = (&self.pressure, &self.total_gap);
            let carrying = |i: usize| if x[i] > 0.0 { self.weights[i] } else { 0.0 };
            self.level.iterate.approach =
                sum_over(x.len(), |i| carrying(i) * total_gap[i]) / sum_over(x.len(), carrying);
        }
        Ok(())
    }

    /// Goes back to where the energy is least on the way from a start without tension; with tension it could be less
    /// than that of the solution.
    fn go_to_the_minimum(&mut self, start: &Start) -> Result<(), Error> {
        // Along the segment the energy is a parabola, known from its slopes.
        let (x, total_gap) = (&self.pressure, &self.total_gap);
        let change = |i: usize| x[i] - start.pressure[i];
        let slope = sum_over(x.len(), |i| (start.total_gap[i] - start.approach) * change(i));
        let curvature = sum_over(x.len(), |i| (total_gap[i] - start.total_gap[i]) * change(i));
        let minimum = -slope / curvature;
        if minimum > 0.0 && minimum < 0.5 {
            for (x, start) in self.pressure.iter_mut().zip(&start.pressure) {
                *x = start + minimum * (*x - start);
            }
            self.move_there()?;
        }
        Ok(())
    }

    /// Makes the pressures those of the level, and computes displacements afresh.
    fn move_there(&mut self) -> Result<(), Error> {
        let iterate = &mut self.level.iterate;
        iterate.contact.scatter(&self.pressure, &mut iterate.pressure);
        self.level.refresh()?;
        let iterate = &self.level.iterate;
        iterate.contact.gather(&iterate.total_gap, &mut self.total_gap);
        Ok(())
    }

    /// The approach that is prescribed, or the multiplier of the sum that is.
    fn approach(&self) -> f64 {
        match self.prescribed {
            Prescribed::Approach(approach) => approach,
            Prescribed::Sum(_) => dot(&self.weights, &self.total_gap) / self.total_weight,
        }
    }

    /// Greatest length by which gaps may be wrong.
    fn tolerance(&self) -> f64 {
        self.criteria.gap_error(self.level.iterate.approach)
    }

    /// The worst errors at present.
    fn errors(&self) -> Errors {
        let (x, total_gap) = (&self.pressure, &self.total_gap);
        let iterate = &self.level.iterate;
        let (approach, all) = (iterate.approach, &iterate.total_gap);
        let places = iterate.contact.places();
        Errors {
            residual: greatest(x.len(), 0.0, |i| (approach - total_gap[i]).abs()),
            overlap: greatest(all.len(), 0.0, |node| {
                if places[node] == NodeSet::NONE { approach - all[node] } else { 0.0 }
            }),
            tension: greatest(x.len(), 0.0, |i| -x[i]) * self.level.self_influence,
        }
    }
}

/// The part of the way between pressures that are not negative and others at which the first ones vanish; 1 if none
/// does.
fn edge(from: &[f64], to: &[f64]) -> f64 {
    let falling = from.iter().zip(to).filter(|(_, to)| **to < 0.0);
    falling.map(|(from, to)| from / (from - to)).fold(1.0, f64::min)
}

#[cfg(test)]
mod tests;
