//! The active set: which nodes carry, round after round.

use super::iterate::{Criteria, Effort, Errors, Iterate};
use super::level::{Level, Target};
use crate::krylov::{NodeSet, dot, greatest, sum, sum_over};
use crate::{Boundary, Error};

/// Inner iterations stop when the residual on the contact set is below this part of the worst
/// error in the set itself.
const INNER: f64 = 0.5;
/// Where a round has not halved that error, long waves are wrong, which the next round must not
/// leave to the one after it: it has to be so much more exact, down to the least part.
const TIGHTENING: f64 = 0.25;
const LEAST_INNER: f64 = 0.01;
/// After so many answers that a fresh convolution does not confirm, the tolerance is below rounding.
const UNCONFIRMED: usize = 10;
/// An answer that is not confirmed, for what rounding or the tension that was cut off have done to
/// it, is asked for again with this part of the tolerance, down to the least part.
const STRICTER: f64 = 0.5;
const STRICTEST: f64 = 0.125;
/// Nodes join for overlaps, and leave for tensions, above this part of the tolerance: what is
/// smaller is rounding, and would come and go for ever.
const DEAD_BAND: f64 = 0.1;

impl Level {
    /// Solves from the pressure of the present iterate, which for a sum must have it. If it is a
    /// `prediction` its displacements and its approach are known, and it may be negative; else it
    /// must not be.
    ///
    /// # Errors
    ///
    /// [`Error::NoConvergence`] with the best residual, and [`Error::FactorizationFailed`] if the
    /// kernel is not positive definite.
    pub(super) fn solve(
        &mut self,
        target: Target,
        criteria: Criteria,
        prediction: bool,
    ) -> Result<Effort, Error> {
        let mut effort = Effort::default();
        let mut best = f64::INFINITY;
        let no_convergence = |best: f64, effort: Effort| Error::NoConvergence {
            residual: best,
            tolerance: criteria.tolerance,
            iterations: effort.iterations,
        };
        if !prediction {
            self.refresh()?;
        }
        match target {
            Target::Approach(approach) => self.iterate.approach = approach,
            Target::Sum(_) if prediction => {}
            Target::Sum(sum) => {
                self.prefer_single_node(sum)?;
                self.iterate.approach = dot(&self.iterate.pressure, &self.iterate.closure) / sum;
            }
        }
        let (mut inner, mut previous) = (INNER, f64::INFINITY);
        let mut unconfirmed = 0;
        let mut working = criteria;
        loop {
            effort.rounds += 1;
            let errors = self.round(target, working, inner, &mut effort)?;
            if errors.in_set() > 0.5 * previous {
                inner = LEAST_INNER.max(TIGHTENING * inner);
            }
            previous = errors.in_set();
            let scale = criteria.scale(self.iterate.approach);
            let worst = errors.worst() / scale;
            if worst.is_nan() || scale.is_nan() {
                return Err(no_convergence(best, effort));
            }
            if worst > working.tolerance {
                best = best.min(worst);
            } else if !criteria.verify {
                return Ok(effort);
            } else {
                let errors = self.verify(target)?;
                let verified = errors.worst() / criteria.scale(self.iterate.approach);
                if verified <= criteria.tolerance {
                    return Ok(effort);
                }
                best = best.min(verified);
                unconfirmed += 1;
                working.tolerance =
                    (STRICTER * working.tolerance).max(STRICTEST * criteria.tolerance);
            }
            if unconfirmed >= UNCONFIRMED
                || effort.iterations >= criteria.max_iterations
                || effort.rounds >= criteria.max_iterations
            {
                return Err(no_convergence(best, effort));
            }
        }
    }

    /// Starts from the highest node alone if that has less energy than the start given: loads so
    /// small that a coarse grid cannot find it are carried by few nodes.
    fn prefer_single_node(&mut self, sum: f64) -> Result<(), Error> {
        let Iterate {
            pressure, closure, ..
        } = &mut self.iterate;
        let gap = &self.gap;
        let energy = sum_over(pressure.len(), |i| {
            pressure[i] / sum * (0.5 * (closure[i] + gap[i]))
        });
        let highest = (1..gap.len()).fold(
            0,
            |best, node| {
                if gap[node] < gap[best] { node } else { best }
            },
        );
        let own = self.self_influence - self.gauge;
        let alone = 0.5 * sum * own + gap[highest];
        // Written so that NaN, from a start that failed, is replaced as well.
        if energy <= alone {
            return Ok(());
        }
        pressure.fill(0.0);
        pressure[highest] = sum;
        self.refresh()
    }

    /// Computes displacements afresh.
    pub(super) fn refresh(&mut self) -> Result<(), Error> {
        let Iterate {
            pressure, closure, ..
        } = &mut self.iterate;
        let displacement = self.operator.apply_field(pressure)?;
        for ((closure, u), g) in closure.iter_mut().zip(displacement).zip(&self.gap) {
            *closure = g + u;
        }
        Ok(())
    }

    /// Errors of the present iterate with nothing carried over from the iteration.
    fn verify(&mut self, target: Target) -> Result<Errors, Error> {
        let pressure = &mut self.iterate.pressure;
        for value in pressure.iter_mut() {
            *value = value.max(0.0);
        }
        if let Target::Sum(target) = target {
            let factor = target / sum(pressure);
            for value in pressure.iter_mut() {
                *value *= factor;
            }
        }
        self.refresh()?;
        let Iterate {
            pressure,
            closure,
            approach,
            ..
        } = &mut self.iterate;
        let (pressure, closure) = (&*pressure, &*closure);
        let carries = |node: usize| pressure[node] > 0.0;
        if let Target::Sum(_) = target {
            // The approach that makes the worst gap in contact smallest.
            let in_contact = |sign: f64| {
                greatest(pressure.len(), f64::NEG_INFINITY, |node| {
                    if carries(node) {
                        sign * closure[node]
                    } else {
                        f64::NEG_INFINITY
                    }
                })
            };
            let (highest, lowest) = (in_contact(1.0), -in_contact(-1.0));
            *approach = lowest + 0.5 * (highest - lowest);
        }
        let approach = *approach;
        let gap = |node: usize| closure[node] - approach;
        Ok(Errors {
            residual: greatest(pressure.len(), 0.0, |node| {
                if carries(node) { gap(node).abs() } else { 0.0 }
            }),
            overlap: greatest(pressure.len(), 0.0, |node| {
                if carries(node) { 0.0 } else { -gap(node) }
            }),
            tension: 0.0,
        })
    }

    /// One active set: conjugate gradients on it, then release of nodes with tension.
    fn round(
        &mut self,
        target: Target,
        criteria: Criteria,
        inner: f64,
        effort: &mut Effort,
    ) -> Result<Errors, Error> {
        let dead_band = DEAD_BAND * criteria.tolerance * criteria.scale(self.iterate.approach);
        self.choose_contact(dead_band);
        if let Target::Approach(_) = target
            && self.boundary == Boundary::Periodic
        {
            self.leave_one_out()?;
        }
        let contact = std::mem::replace(&mut self.iterate.contact, NodeSet::new(0));
        let outcome = self.round_on(&contact, target, criteria, inner, effort);
        self.iterate.contact = contact;
        outcome
    }

    /// Takes the widest gap out of a periodic contact that is everywhere.
    ///
    /// Uniform pressure does not displace it relative to its mean plane, so that no pressure there
    /// answers to an approach; short of full contact, some node is always out of contact.
    fn leave_one_out(&mut self) -> Result<(), Error> {
        let Iterate {
            pressure,
            closure,
            contact,
            ..
        } = &mut self.iterate;
        if contact.len() < closure.len() {
            return Ok(());
        }
        let widest = (1..closure.len()).fold(0, |widest, node| {
            if closure[node] > closure[widest] {
                node
            } else {
                widest
            }
        });
        pressure[widest] = 0.0;
        contact.assign(|node| node != widest);
        self.inverse.update(contact);
        self.refresh()
    }

    /// Nodes with pressure or overlap.
    fn choose_contact(&mut self, dead_band: f64) {
        let Iterate {
            pressure,
            closure,
            approach,
            contact,
        } = &mut self.iterate;
        let deepest = *approach - dead_band;
        contact.assign(|node| pressure[node] != 0.0 || closure[node] < deepest);
        self.inverse.update(contact);
    }
}
