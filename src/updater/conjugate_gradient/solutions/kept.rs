//! Solutions as plain numbers, and made again of these.

use super::{Equilibrium, Passage, Solutions, membership};
use crate::contact::ContactSequence;
use crate::krylov::{Field, NodeSet, greatest};
use crate::updater::conjugate_gradient::plastic_sums::PlasticSums;
use crate::updater::conjugate_gradient::proposed::Proposed;
use crate::updater::conjugate_gradient::row_sums::RowSums;
use crate::updater::conjugate_gradient::tolerances::{Aim, Criteria, Tolerances};
use crate::updater::conjugate_gradient::tuning::{SUMS_TOLERANCE, UNSPOILT};
use crate::updater::{Kept, KeptBeside, KeptField, check_count};
use crate::{Boundary, Error, Problem, UpdaterError};

impl Solutions {
    /// The numbers that what follows depends on; `None` unless there is a solution on the whole contact.
    pub(in super::super) fn keep_all(
        &self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        may_yield: bool,
    ) -> Option<Kept> {
        let now = &self.now;
        let is_whole = now.count == contact.len() && now.load.is_known() && now.rate.is_known();
        if !is_whole {
            return None;
        }
        let beside = if self.may_yield { Some(self.keep_beside(contact)?) } else { None };
        let joined = self.passage.as_ref().map_or(0, |passage| passage.joined.len());
        let set = whole(contact);
        let kept = |field: &Field| kept_field(&set, field);
        let mut all = Kept {
            tolerance: criteria.tolerance,
            approach: now.approach,
            serves: now.serves,
            load: kept(&now.load),
            rate: kept(&now.rate),
            proposed: self.proposed.locals().iter().map(|local| local.node).collect(),
            // Of those beside which they were proposed, the ones that are left.
            proposed_beside: contact.len().saturating_sub(joined),
            row_sums: self.proposed.complement().row_sums().to_vec(),
            coarse: self.solver.coarse_nodes().iter().map(|&node| node as usize).collect(),
            beside,
            ..Kept::default()
        };
        // They serve row sums, which are all the same elsewhere, and sums beside nodes that yield.
        if problem.boundary() != Boundary::Periodic || may_yield {
            all.directions = self.directions.values().map(<[f32]>::to_vec).collect();
            all.marks = self.directions.marks();
        }
        if problem.boundary() != Boundary::Periodic {
            let (field, start) = self.sums.parts();
            all.sums_of = self.sums.count();
            all.sums = kept(field);
            all.sums_start = on(&set, start);
        }
        Some(all)
    }

    /// The same of what has yielded; `None` unless the window was proposed.
    fn keep_beside(&self, contact: &ContactSequence) -> Option<KeptBeside> {
        let passage = self.passage.as_ref()?;
        let (fields, under) = self.plastic_sums.parts()?;
        let (yielded, pressures): (Vec<usize>, Vec<f64>) = passage.fixed.iter().copied().unzip();
        let set = with_yielded(contact, &yielded);
        Some(KeptBeside {
            outside: self.proposed.outside(),
            yielded,
            pressures,
            sums: fields.each_ref().map(|field| kept_field(&set, field)),
            under: under.clone(),
        })
    }

    /// The solutions that were kept, on the same contact.
    ///
    /// # Errors
    ///
    /// [`Error::LengthMismatch`], [`Error::NodeOutOfGrid`], [`Error::AlreadyInContact`], and [`Error::OutOfRange`] for
    /// numbers that are not those of a solution on it.
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
        let (mut nodes, mut among) = ([&kept.proposed[..], &[]], kept.proposed_beside);
        if let Some(beside) = &kept.beside {
            let before = before_yields(problem, contact, kept, beside)?;
            among = before.len();
            solver.choose(&before, among);
            nodes = kept.proposed.split_at(beside.outside).into();
        } else {
            solver.choose(contact, among);
            for &node in &kept.proposed {
                if solver.set().contains(node) {
                    let (ix, iy) = problem.grid().coordinates(node);
                    return Err(Error::AlreadyInContact { ix, iy });
                }
            }
        }
        let mut proposed = Proposed::new(problem, (neighbourhood, solver), nodes, among)?;
        let mut sums = kept.row_sums.iter().copied();
        // One for each node, in their order.
        proposed.tell_row_sums(|_| sums.next().unwrap_or_default());
        let mut coarse = NodeSet::new(problem.grid().nodes());
        let is_in = membership(problem.grid(), &kept.coarse);
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
        }
        let directions = kept.directions.iter().cloned();
        restored.directions = restored.solver.recall_directions(directions, kept.marks)?;
        let mut fixed = Vec::new();
        if let Some(beside) = &kept.beside {
            let set = with_yielded(contact, &beside.yielded);
            let nodes = problem.grid().nodes();
            for under in &beside.under {
                UpdaterError::check_length("displacements", under.len(), nodes)?;
            }
            let [a, b, c] = &beside.sums;
            let of = |field: &KeptField| match field.displacement.is_empty() {
                true => Ok(Field::default()),
                false => restored_field(problem, &set, field),
            };
            let fields = [of(a)?, of(b)?, of(c)?];
            // Of a few elastic nodes in contact a field is nearly nothing, and what it was solved for is not, or the other way
            // round. The sums of rows beside nodes that have yielded are what is left of those of all.
            let [unit, load] = &beside.under;
            let all = problem.row_sums().iter().zip(unit);
            let all: Vec<f64> = all.map(|(sum, unit)| sum.abs() + unit.abs()).collect();
            for (field, rhs) in fields.iter().zip([&all, unit, load]) {
                let own = &field.displacement;
                let most = greatest(own.len(), 0.0, |i| own[i].abs());
                let most = greatest(rhs.len(), most, |i| rhs[i].abs());
                restored.solver.check(field, SUMS_TOLERANCE * most)?;
            }
            restored.plastic_sums = PlasticSums::of_parts(fields, beside.under.clone());
            let all = beside.yielded.iter().copied().zip(beside.pressures.iter().copied());
            fixed = all.collect();
        }
        let joined = contact.order()[kept.proposed_beside..].to_vec();
        restored.passage = Some(Passage { joined, fixed });
        restored.may_yield = kept.beside.is_some();
        restored.proposed = proposed;
        restored.solved = contact.order().to_vec();
        restored.now = Equilibrium { count, approach, serves: kept.serves, load, rate };
        let most = Tolerances::of(criteria, Aim::Span(f64::INFINITY), length, 1.0).load;
        for &node in contact.order() {
            let [left, _] = restored.now.left(problem, node);
            // NaN is none either.
            let is_closed = left.abs() <= UNSPOILT * most;
            let quantity = "gap in contact where a window ends";
            Error::require(quantity, left, is_closed, "closed, as a solution leaves it")?;
        }
        Ok(restored)
    }
}

/// The contact beside which nodes were proposed.
fn before_yields(
    problem: &Problem,
    contact: &ContactSequence,
    kept: &Kept,
    beside: &KeptBeside,
) -> Result<ContactSequence, Error> {
    let KeptBeside { outside, yielded, pressures, .. } = beside;
    check_count(yielded.len(), pressures.len())?;
    check_count(0, outside.saturating_sub(kept.proposed.len()))?;
    problem.check_nodes(yielded)?;
    let is_finite = pressures.iter().all(|pressure| pressure.is_finite());
    let quantity = "pressure of a node that has yielded";
    let first = pressures.iter().copied().find(|p| !p.is_finite()).unwrap_or_default();
    Error::require(quantity, first, is_finite, "finite")?;
    let (outside, inside) = kept.proposed.split_at(*outside);
    let had_touched = |node: &&usize| !outside.contains(node);
    let left = yielded.iter().filter(had_touched).copied();
    let stayed = contact.order()[..kept.proposed_beside].iter().copied();
    let before = ContactSequence::with_order(problem.grid(), stayed.chain(left))?;
    let is_beside = |node: &usize, inside: bool| before.contains(*node) == inside;
    let fits = outside.iter().all(|node| is_beside(node, false))
        && inside.iter().all(|node| is_beside(node, true));
    if !fits {
        let node = kept.proposed.first().copied().unwrap_or_default();
        let (ix, iy) = problem.grid().coordinates(node);
        return Err(Error::NotInContact { ix, iy });
    }
    Ok(before)
}

/// A contact and nodes that have yielded.
fn with_yielded(contact: &ContactSequence, yielded: &[usize]) -> NodeSet {
    let is_in = membership(contact.grid(), yielded);
    let mut set = NodeSet::new(contact.grid().nodes());
    set.assign(|node| is_in[node] || contact.contains(node));
    set
}

/// A field as plain numbers, with pressures on a set.
fn kept_field(set: &NodeSet, field: &Field) -> KeptField {
    KeptField {
        pressure: on(set, &field.pressure),
        displacement: field.displacement.clone(),
        drift: field.drift,
    }
}

/// All nodes of a contact.
fn whole(contact: &ContactSequence) -> NodeSet {
    let mut set = NodeSet::new(contact.grid().nodes());
    set.assign(|node| contact.contains(node));
    set
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
