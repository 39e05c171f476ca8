//! Solutions as plain numbers, and made again of these.

use super::{Equilibrium, Solutions};
use crate::contact::ContactSequence;
use crate::krylov::{Field, NodeSet, greatest};
use crate::updater::conjugate_gradient::proposed::Proposed;
use crate::updater::conjugate_gradient::row_sums::RowSums;
use crate::updater::conjugate_gradient::tolerances::{Aim, Criteria, Tolerances};
use crate::updater::conjugate_gradient::tuning::{SUMS_TOLERANCE, UNSPOILT};
use crate::updater::{Kept, KeptField, check_count};
use crate::{Boundary, Error, Problem, UpdaterError};

impl Solutions {
    /// The numbers that what follows depends on; `None` unless there is a solution on the whole contact.
    pub(in super::super) fn keep_all(
        &self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
    ) -> Option<Kept> {
        let now = &self.now;
        let is_whole = now.count == contact.len() && now.load.is_known() && now.rate.is_known();
        if !is_whole || self.both.is_some() {
            return None;
        }
        let set = whole(contact);
        let kept = |field: &Field| KeptField {
            pressure: on(&set, &field.pressure),
            displacement: field.displacement.clone(),
            drift: field.drift,
        };
        let mut all = Kept {
            tolerance: criteria.tolerance,
            approach: now.approach,
            serves: now.serves,
            load: kept(&now.load),
            rate: kept(&now.rate),
            proposed: self.proposed.nodes().collect(),
            proposed_beside: self.proposed.count(),
            row_sums: self.proposed.complement().row_sums().to_vec(),
            coarse: self.solver.coarse_nodes().iter().map(|&node| node as usize).collect(),
            ..Kept::default()
        };
        // Elsewhere no one asks for them.
        if problem.boundary() != Boundary::Periodic {
            let (field, start) = self.sums.parts();
            all.sums_of = self.sums.count();
            all.sums = kept(field);
            all.sums_start = on(&set, start);
            all.directions = self.directions.values().map(<[f32]>::to_vec).collect();
            all.marks = self.directions.marks();
        }
        Some(all)
    }

    /// What they were, on a contact.
    ///
    /// # Errors
    ///
    /// [`Error::LengthMismatch`], [`Error::NodeOutOfGrid`], [`Error::AlreadyInContact`], and [`Error::OutOfRange`] for numbers that are not
    /// those of a solution on it.
    pub(in super::super) fn restore(
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        kept: &Kept,
    ) -> Result<Self, Error> {
        let mut restored = Self::new(problem);
        let count = contact.len();
        check_count(0, kept.proposed_beside.saturating_sub(count))?;
        check_count(kept.proposed.len(), kept.row_sums.len())?;
        problem.check_nodes(&kept.proposed)?;
        problem.check_nodes(&kept.coarse)?;
        for values in &kept.directions {
            check_count(count, values.len())?;
        }
        let finite = [kept.approach, kept.load.drift, kept.rate.drift, kept.sums.drift];
        let [approach, ..] = finite;
        let is_finite = finite.into_iter().chain(kept.row_sums.iter().copied()).all(f64::is_finite);
        Error::require(
            "approach where a window ends",
            approach,
            is_finite,
            "finite, as all beside it",
        )?;
        Error::require("span of a rate", kept.serves, kept.serves >= 0.0, "not negative")?;

        // The local solutions of what was proposed beside an earlier contact.
        let Self { solver, neighbourhood, .. } = &mut restored;
        solver.choose(contact, kept.proposed_beside);
        for &node in &kept.proposed {
            if solver.set().contains(node) {
                let (ix, iy) = problem.grid().coordinates(node);
                return Err(Error::AlreadyInContact { ix, iy });
            }
        }
        let mut sums = kept.row_sums.iter().copied();
        let nodes = (&kept.proposed[..], kept.proposed_beside);
        let proposed = Proposed::new(problem, (neighbourhood, solver), nodes, |_| {
            // One for each node, in their order.
            sums.next().unwrap_or_default()
        })?;
        let mut coarse = NodeSet::new(problem.grid().nodes());
        let is_in = membership(problem.grid().nodes(), &kept.coarse);
        coarse.assign(|node| is_in[node]);
        solver.recall(contact, &coarse);

        let of = |field: &KeptField| restored_field(problem, solver.set(), field);
        let (load, rate) = (of(&kept.load)?, of(&kept.rate)?);
        let length = greatest(count, problem.least_length(), |k| {
            (approach - problem.initial_gap()[contact.order()[k]]).abs()
        });
        // What solutions leave of displacements at worst, whatever they serve.
        let left = Tolerances::of(criteria, Aim::Span(0.0), length, 1.0);
        for (field, most) in [(&load, left.load), (&rate, left.rate)] {
            restored.solver.check(field, UNSPOILT * most)?;
        }
        if problem.boundary() != Boundary::Periodic {
            check_count(count, kept.sums_start.len())?;
            check_count(0, kept.sums_of.saturating_sub(count))?;
            let start = spread(problem, restored.solver.set(), &kept.sums_start)?;
            let field = match kept.sums.displacement.is_empty() {
                true => Field::default(),
                false => restored_field(problem, restored.solver.set(), &kept.sums)?,
            };
            let sums = problem.row_sums();
            let most = greatest(sums.len(), 0.0, |i| sums[i]);
            restored.solver.check(&field, SUMS_TOLERANCE * most)?;
            restored.sums = RowSums::of(kept.sums_of, field, start);
            let values = kept.directions.iter().cloned();
            restored.directions = restored.solver.recall_directions(values, kept.marks)?;
        }
        restored.proposed = proposed;
        restored.solved = contact.order().to_vec();
        restored.now = Equilibrium { count, approach, serves: kept.serves, load, rate };
        Ok(restored)
    }
}

/// All nodes of a contact.
fn whole(contact: &ContactSequence) -> NodeSet {
    let mut set = NodeSet::new(contact.grid().nodes());
    set.assign(|node| contact.contains(node));
    set
}

/// Which nodes of a grid are among some.
fn membership(nodes: usize, some: &[usize]) -> Vec<bool> {
    let mut is_in = vec![false; nodes];
    for &node in some {
        is_in[node] = true;
    }
    is_in
}

/// The values of a field on a contact.
fn on(set: &NodeSet, field: &[f64]) -> Vec<f64> {
    let mut values = Vec::new();
    if !field.is_empty() {
        set.gather(field, &mut values);
    }
    values
}

/// A field of values on a contact.
fn spread(problem: &Problem, set: &NodeSet, values: &[f64]) -> Result<Vec<f64>, Error> {
    check_count(set.len(), values.len())?;
    let mut field = vec![0.0; problem.grid().nodes()];
    set.scatter(values, &mut field);
    Ok(field)
}

/// Pressures and displacements of the grid.
fn restored_field(problem: &Problem, set: &NodeSet, kept: &KeptField) -> Result<Field, Error> {
    UpdaterError::check_length("displacements", kept.displacement.len(), problem.grid().nodes())?;
    let pressure = spread(problem, set, &kept.pressure)?;
    Ok(Field { pressure, displacement: kept.displacement.clone(), drift: kept.drift })
}
