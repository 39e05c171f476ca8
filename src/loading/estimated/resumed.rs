//! A path without a factor that goes on at the end of a window.

use super::Estimated;
use crate::contact::ContactSequence;
use crate::loading::run::LoadingRun;
use crate::loading::tolerances::WindowTolerances;
use crate::updater::{Iterations, Kept};
use crate::{Error, UpdaterError};

/// Everything on which the next window without a factor depends, besides problem and contact. The gaps, their ranking
/// and the scalars follow from it, by the same arithmetic as at the end of the window.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct EstimatedEnd {
    /// Whether events that were too close were settled.
    pub(crate) settles: bool,
    /// The nodes of the last window in the order in which its end was solved: sums round by it.
    pub(crate) joined: Vec<usize>,
    /// How far the last window went, and the span that the rates at hand serve.
    pub(crate) last_span: f64,
    pub(crate) rate_span: f64,
    /// The part of a pivot that matrices were off by lately, which limits the events of a window.
    pub(crate) left_out: f64,
    /// How many nodes yielded in each window so far.
    pub(crate) yielded: Vec<usize>,
    /// The scalars, sums over all events: only behind an event with a solution of its own, where no window ends.
    pub(crate) scalars: Option<[f64; 6]>,
    /// The solution, and what iterations go on from besides.
    pub(crate) kept: Kept,
}

impl EstimatedEnd {
    /// The contact in the order in which the end of the window was solved.
    ///
    /// # Errors
    ///
    /// [`UpdaterError::UpdaterMismatch`] and those of the contact if other nodes than the last ones joined in the
    /// window.
    pub(in crate::loading) fn contact(
        &self,
        contact: &ContactSequence,
    ) -> Result<ContactSequence, Error> {
        let mut solved = contact.clone();
        solved.truncate(contact.len().saturating_sub(self.joined.len()));
        self.joined.iter().try_for_each(|&node| solved.push(node))?;
        let same = contact.order().iter().filter(|&&node| solved.contains(node)).count();
        UpdaterError::check_length("nodes of the last window", same, contact.len())?;
        UpdaterError::check_length("nodes in contact", solved.len(), contact.len())?;
        Ok(solved)
    }
}

impl Estimated {
    /// What the next window depends on, behind a window or an event with a solution of its own; `None` if the
    /// iterations cannot tell.
    pub(in crate::loading) fn end(
        &self,
        run: &LoadingRun,
        iterations: &dyn Iterations,
        is_single: bool,
    ) -> Option<EstimatedEnd> {
        // Nothing has moved since the last window ended.
        let approach = run.scalars.approach();
        if !is_single && self.ranked != Some((run.contact.revision(), approach)) {
            return None;
        }
        let kept = iterations.keep(&run.problem, &run.contact, run.plastic.is_some())?;
        (kept.approach == approach).then(|| EstimatedEnd {
            settles: self.settles,
            joined: if is_single { Vec::new() } else { self.joined.clone() },
            scalars: is_single.then(|| run.scalars.numbers()),
            last_span: self.last_span,
            rate_span: self.rate_span,
            left_out: self.left_out,
            yielded: run.plastic.as_ref().map_or(Vec::new(), |plastic| plastic.groups().to_vec()),
            kept,
        })
    }

    /// Whether the windows before were made by the same rule.
    pub(in crate::loading) fn can_follow(&self, end: &EstimatedEnd) -> bool {
        self.settles == end.settles
    }

    /// Goes on at the end of a window whose contact is that of the path, with iterations that were restored there.
    pub(in crate::loading) fn follow_on(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        end: &EstimatedEnd,
    ) -> Result<(), Error> {
        let spans = [end.last_span, end.rate_span, end.left_out];
        for (quantity, span) in
            ["span of the last window", "span of its rates", "error of its pivots"]
                .into_iter()
                .zip(spans)
        {
            Error::require(quantity, span, span >= 0.0, "not negative")?;
        }
        [self.last_span, self.rate_span, self.left_out] = spans;
        let approach = end.kept.approach;
        if end.scalars.is_some() {
            return run.advance_field(iterations, approach, f64::INFINITY);
        }
        self.joined.clone_from(&end.joined);
        let solved = end.contact(&run.contact)?;
        let ordered = std::mem::replace(&mut run.contact, solved);
        run.advance_field(iterations, approach, self.rate_span)?;
        run.field.reorder(&run.contact, &ordered);
        run.contact = ordered;
        run.scalars.place_at(approach);
        let tolerances = WindowTolerances::of(run, iterations.tolerance());
        self.survey(run, &tolerances)
    }
}
