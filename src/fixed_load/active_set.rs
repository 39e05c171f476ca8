//! The active set: which nodes carry, round after round.

use super::descent::Descent;
use super::iterate::{Criteria, Errors, Iterate, Progress};
use super::level::{Level, Prescribed};
use super::tuning::{INNER, INNER_DOWNHILL, PATIENCE, STRICTER, STRICTEST, UNCONFIRMED};
use crate::Error;
use crate::krylov::{dot, greatest, sum, sum_over};

/// The search for the nodes in contact on one grid.
#[derive(Debug)]
pub(super) struct ActiveSet<'a> {
    level: &'a mut Level,
    prescribed: Prescribed,
    criteria: Criteria,
    progress: Progress,
    /// Smallest error so far, relative to the scale of the criteria.
    best: f64,
    /// Smallest error in the set so far, and rounds since.
    least: f64,
    stalled: usize,
    /// Whether the last round ended with the solution on its set, and not where a node lost its pressure.
    is_solved: bool,
    /// Whether no pressure changed when nodes joined last, since some of them had tension from the start.
    is_blocked: bool,
}

impl<'a> ActiveSet<'a> {
    pub(super) fn new(level: &'a mut Level, prescribed: Prescribed, criteria: Criteria) -> Self {
        Self {
            level,
            prescribed,
            criteria,
            progress: Progress::default(),
            best: f64::INFINITY,
            least: f64::INFINITY,
            stalled: 0,
            is_solved: true,
            is_blocked: false,
        }
    }

    /// Solves from the pressure of the present iterate, which has the sum if one is prescribed, and
    /// returns the number of iterations. If the iterate is a `prediction` its displacements and its
    /// approach are known, and pressures may be negative; else they must not be.
    ///
    /// # Errors
    ///
    /// [`Error::NoConvergence`] with the best residual, and [`Error::FactorizationFailed`] if the
    /// kernel is not positive definite.
    pub(super) fn solve(mut self, prediction: bool) -> Result<usize, Error> {
        let criteria = self.criteria;
        self.begin(prediction)?;
        let mut unconfirmed = 0;
        let mut working = criteria;
        loop {
            self.progress.rounds += 1;
            let errors = self.round(working)?;
            self.stalled += 1;
            if errors.in_set() < self.least {
                (self.least, self.stalled) = (errors.in_set(), 0);
            }
            let worst = self.relative(&errors);
            if worst.is_nan() || !self.level.iterate.approach.is_finite() {
                return Err(self.no_convergence());
            }
            if worst > working.tolerance {
                // Below the tolerance what is not verified means nothing.
                if worst > criteria.tolerance {
                    self.best = self.best.min(worst);
                }
            } else if !criteria.verify {
                return Ok(self.progress.iterations);
            } else {
                let errors = self.verify()?;
                let verified = self.relative(&errors);
                if verified <= criteria.tolerance {
                    return Ok(self.progress.iterations);
                }
                self.best = self.best.min(verified);
                unconfirmed += 1;
                working.tolerance =
                    (STRICTER * working.tolerance).max(STRICTEST * criteria.tolerance);
            }
            let Progress { iterations, rounds } = self.progress;
            if unconfirmed >= UNCONFIRMED || iterations.max(rounds) >= criteria.max_iterations {
                return Err(self.no_convergence());
            }
        }
    }

    /// The worst of the errors, in units of the tolerance's length.
    fn relative(&self, errors: &Errors) -> f64 {
        errors.worst() / self.criteria.scale(self.level.iterate.approach)
    }

    /// The error when no iterate was good enough; if all ended with tension, it has the residual of the last one.
    fn no_convergence(&mut self) -> Error {
        if self.best == f64::INFINITY
            && let Ok(errors) = self.verify()
        {
            self.best = self.best.min(self.relative(&errors));
        }
        Error::NoConvergence {
            residual: self.best,
            tolerance: self.criteria.tolerance,
            iterations: self.progress.iterations,
        }
    }

    /// Displacements and approach of the start.
    fn begin(&mut self, prediction: bool) -> Result<(), Error> {
        if !prediction {
            self.level.refresh()?;
        }
        match self.prescribed {
            Prescribed::Approach(approach) => self.level.iterate.approach = approach,
            Prescribed::Sum(_) if prediction => {}
            Prescribed::Sum(sum) => {
                self.prefer_single_node(sum)?;
                let iterate = &mut self.level.iterate;
                iterate.approach = dot(&iterate.pressure, &iterate.total_gap) / sum;
            }
        }
        Ok(())
    }

    /// Starts from the highest node alone if that has less energy than the start given: loads so
    /// small that a coarse grid cannot find it are carried by few nodes.
    fn prefer_single_node(&mut self, sum: f64) -> Result<(), Error> {
        let own = self.level.self_influence - self.level.uniform();
        let gap = &self.level.gap;
        let Iterate { pressure, total_gap, .. } = &mut self.level.iterate;
        let energy =
            sum_over(pressure.len(), |i| pressure[i] / sum * (0.5 * (total_gap[i] + gap[i])));
        let lower = |best: usize, node: usize| if gap[node] < gap[best] { node } else { best };
        let highest = (1..gap.len()).fold(0, lower);
        let alone = 0.5 * sum * own + gap[highest];
        // NaN, from a start that failed, is replaced as well.
        if energy <= alone {
            return Ok(());
        }
        pressure.fill(0.0);
        pressure[highest] = sum;
        self.level.refresh()
    }

    /// One contact set: conjugate gradients on it, then release of nodes with tension.
    fn round(&mut self, criteria: Criteria) -> Result<Errors, Error> {
        let deepest = criteria.deepest(self.level.iterate.approach);
        if self.stalled >= PATIENCE {
            return self.cautious_round(criteria, deepest);
        }
        // Nodes with pressure or overlap.
        self.level.choose_contact(|node, pressure, total_gap| {
            pressure[node] != 0.0 || total_gap[node] < deepest
        })?;
        self.descend(criteria, |descent, progress| descent.run(INNER, progress))
    }

    /// A round of the primal active-set method: nodes that overlap join the solution on a set, and pressures go towards
    /// the new solution as far as the energy falls. It is less with every solution, so that no set comes again with
    /// one; and between two of them nodes only leave (Nocedal and Wright, Numerical Optimization, 2006, 16.5, where
    /// they do one at a time). Of nodes that join together some may have tension from the start, and the energy falls
    /// nowhere on that way. Then the node that overlaps most joins alone: its pressure grows, and the energy falls.
    fn cautious_round(&mut self, criteria: Criteria, deepest: f64) -> Result<Errors, Error> {
        let joins = self.is_solved;
        let before = self.level.iterate.pressure.clone();
        let alone = self.is_blocked.then(|| self.greatest_overlap()).flatten();
        self.level.choose_contact(|node, pressure, total_gap| {
            let may_join = joins && alone.is_none_or(|alone| node == alone);
            pressure[node] > 0.0 || (may_join && total_gap[node] < deepest)
        })?;
        let errors = self.descend(criteria, |descent, progress| {
            descent.run_downhill(INNER_DOWNHILL, progress)
        })?;
        self.is_solved = errors.residual < f64::INFINITY;
        if joins {
            self.is_blocked = !self.is_solved && self.level.iterate.pressure == before;
        }
        Ok(errors)
    }

    /// The node without pressure that overlaps most.
    fn greatest_overlap(&self) -> Option<usize> {
        let Iterate { pressure, total_gap, .. } = &self.level.iterate;
        let free = (0..pressure.len()).filter(|&node| pressure[node] <= 0.0);
        free.min_by(|&a, &b| total_gap[a].total_cmp(&total_gap[b]))
    }

    /// Goes a way down on the set that was chosen, which is empty where pressures have cancelled.
    fn descend(
        &mut self,
        criteria: Criteria,
        way: impl FnOnce(Descent<'_>, &mut Progress) -> Result<Errors, Error>,
    ) -> Result<Errors, Error> {
        self.leave_one_out()?;
        if self.level.iterate.contact.len() == 0 {
            return Err(self.no_convergence());
        }
        let descent = Descent::new(self.level, self.prescribed, criteria);
        way(descent, &mut self.progress)
    }

    /// Removes the node of the widest gap from a contact that is everywhere, if an approach is prescribed and the mean
    /// displacement is arbitrary.
    ///
    /// Uniform pressure does not displace such a contact relative to its mean plane, so that no
    /// pressure there answers to an approach; short of full contact, some node is always out.
    fn leave_one_out(&mut self) -> Result<(), Error> {
        if !(matches!(self.prescribed, Prescribed::Approach(_)) && self.level.gauge.is_some()) {
            return Ok(());
        }
        let Iterate { pressure, total_gap, contact, .. } = &mut self.level.iterate;
        if contact.len() < total_gap.len() {
            return Ok(());
        }
        let wider = |widest: usize, node: usize| {
            if total_gap[node] > total_gap[widest] { node } else { widest }
        };
        let widest = (1..total_gap.len()).fold(0, wider);
        pressure[widest] = 0.0;
        self.level.choose_contact(|node, _, _| node != widest)?;
        self.level.refresh()
    }

    /// Errors of the present iterate with nothing carried over from the iteration.
    fn verify(&mut self) -> Result<Errors, Error> {
        let pressure = &mut self.level.iterate.pressure;
        for value in pressure.iter_mut() {
            *value = value.max(0.0);
        }
        if let Prescribed::Sum(target) = self.prescribed {
            let factor = target / sum(pressure);
            for value in pressure.iter_mut() {
                *value *= factor;
            }
        }
        self.level.refresh()?;
        let Iterate { pressure, total_gap, approach, .. } = &mut self.level.iterate;
        let (pressure, total_gap) = (&*pressure, &*total_gap);
        let carries = |node: usize| pressure[node] > 0.0;
        if let Prescribed::Sum(_) = self.prescribed {
            // The approach that makes the worst gap in contact smallest.
            let in_contact = |sign: f64| {
                greatest(pressure.len(), f64::NEG_INFINITY, |node| {
                    if carries(node) { sign * total_gap[node] } else { f64::NEG_INFINITY }
                })
            };
            let (highest, lowest) = (in_contact(1.0), -in_contact(-1.0));
            *approach = lowest + 0.5 * (highest - lowest);
        }
        let approach = *approach;
        let gap = |node: usize| total_gap[node] - approach;
        Ok(Errors {
            residual: greatest(pressure.len(), 0.0, |node| {
                if carries(node) { gap(node).abs() } else { 0.0 }
            }),
            overlap: greatest(
                pressure.len(),
                0.0,
                |node| {
                    if carries(node) { 0.0 } else { -gap(node) }
                },
            ),
            tension: 0.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::krylov::NodeSet;
    use crate::surface::{Amplitude, SelfAffine};
    use crate::{Boussinesq, FixedLoadSolver, Grid, InfluenceKernel, PeriodicBoussinesq};

    /// Where everything carries and the mean displacement is arbitrary, no pressure answers to an approach: a
    /// round removes the node with the widest gap, and no other. A free half-space needs no such thing.
    #[test]
    fn an_approach_leaves_one_node_out() -> Result<(), Error> {
        let grid = Grid::new(6, 5, 1.0, 1.0)?;
        let surface = SelfAffine::new(0.8, 4.0, 2.0, Amplitude::RmsHeight(0.01), 1)?;
        let free = Boussinesq::new(grid, 1.0)?;
        let periodic = PeriodicBoussinesq::new(grid, 1.0)?;
        let kernels: [(&dyn InfluenceKernel, usize); 2] = [(&free, 30), (&periodic, 29)];
        for (kernel, left) in kernels {
            let mut level = FixedLoadSolver::new(&surface, kernel)?.into_finest();
            // Uniform pressure displaces the mean plane only: the widest gap is the initial one.
            level.iterate.pressure.fill(1.0);
            level.refresh()?;
            let approach = 0.9 * level.mean_initial_gap();
            level.iterate.approach = approach;
            let wider = |best: usize, node: usize| {
                if level.gap[node] > level.gap[best] { node } else { best }
            };
            let widest = (1..30).fold(0, wider);
            let criteria = Criteria {
                tolerance: 1e-8,
                floor: 0.0,
                length: f64::INFINITY,
                max_iterations: 100,
                verify: true,
            };
            ActiveSet::new(&mut level, Prescribed::Approach(approach), criteria).round(criteria)?;
            assert_eq!(level.iterate.contact.len(), left);
            let is_in = level.iterate.contact.places()[widest] != NodeSet::NONE;
            assert_eq!(is_in, left == 30);
        }
        Ok(())
    }
}
