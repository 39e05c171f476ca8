//! Where a path is in its windows: what a record keeps besides states, so that a path that goes on is the one that was
//! not interrupted.

use std::mem;
use std::sync::Arc;

use super::estimated::resumed::EstimatedEnd;
use super::factor_log::FactorLog;
use super::limits::LoadingEnd;
use super::path::LoadingPath;
use super::phase::Phase;
use super::snapshot::{Snapshot, not_on_path};
use super::state::{ContactEvent, LoadingState};
use super::tuning::RECOGNISED;
use crate::Error;
use crate::contact::ContactState;
use crate::updater::{Left, Solution};

/// The end of the last window that a path has computed, which lies ahead of the state that it has yielded.
///
/// What later windows depend on, besides surface, kernel, settings and the states up to here:
///
/// | | with a factor | without |
/// |---|---|---|
/// | `ahead` | the states of the window that are yet to come: the contact at its end | the same |
/// | `handed_over_at` | | when the factor was given up, which memory may have decided |
/// | `next` | [`FactorEnd`] | [`EstimatedEnd`] and [`Kept`](crate::updater::Kept) |
///
/// The [`FactorLog`] has the windows and single events so far: the factor is made again by the same steps, and the next
/// window keeps the order of the nodes that were watched last and have not touched. Scalars are sums over all events.
/// Behind yields the solution is that of the factor before them.
///
/// Nothing else is remembered from window to window. Timings are not kept.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WindowEnd {
    pub(crate) ahead: Vec<LoadingState>,
    pub(crate) handed_over_at: Option<usize>,
    pub(crate) next: NextWindow,
}

/// What the next window begins with.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum NextWindow {
    Factor(Box<FactorEnd>),
    Iterations(Box<EstimatedEnd>),
}

/// What the next window with a factor depends on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FactorEnd {
    pub(crate) log: FactorLog,
    /// Approach, load, energy, mean gap, stiffness and closing rate in the gauge of the kernel.
    pub(crate) scalars: [f64; 6],
    /// The solution at the end of a window in which nodes yielded: that of the factor before.
    pub(crate) solution: Option<Solution>,
}

impl LoadingPath {
    /// The end of the last window behind the state that was yielded last; `None` before the first one, behind states
    /// alone, in full contact, and behind an error.
    pub(crate) fn window_end(&self) -> Option<WindowEnd> {
        use LoadingEnd::{Failed, FullContact, Memory};
        let is_over = matches!(self.end, Some(FullContact | Failed | Memory));
        let step = self.state?.step;
        if self.rebuilt_at == Some(step) || self.failure.is_some() || is_over {
            return None;
        }
        let run = &self.run;
        let next = match &self.phase {
            Phase::Factor { log, .. } => NextWindow::Factor(Box::new(FactorEnd {
                log: log.clone(),
                scalars: run.scalars.numbers(),
                solution: self.exact.solution(run),
            })),
            Phase::Iterations(iterations) => {
                let is_single = self.single.has_begun();
                NextWindow::Iterations(Box::new(self.estimated.end(
                    run,
                    &**iterations,
                    is_single,
                )?))
            }
        };
        let ahead = self.run.queue.iter().copied().collect();
        Some(WindowEnd { ahead, handed_over_at: self.handed_over_at, next })
    }

    /// Goes on at the end of a window behind the last of the states that were restored. Returns false, and nothing has
    /// changed, if this path does not go on so: with another updater or rule, or with too little memory for it.
    pub(super) fn follow_on(&mut self, end: &WindowEnd) -> Result<bool, Error> {
        let Some(last) = self.state else {
            return Ok(false);
        };
        let (run, phase) = (&mut self.run, &mut self.phase);
        let mut contact = run.contact.clone();
        let mut left = Vec::new();
        let mut yielded: Vec<usize> = run.releases.yielded_at(last.step).collect();
        for (state, step) in end.ahead.iter().zip(last.step + 1..) {
            let (ix, iy) = state.node;
            let node = run.problem.grid().node(ix, iy).unwrap_or(usize::MAX);
            let is_event = match state.event {
                ContactEvent::Touch => contact.push(node).map(|()| true)?,
                ContactEvent::Release if run.may_leave() => {
                    let position = contact.remove(node)?;
                    left.push((step, state.event, Left { node, position }));
                    true
                }
                ContactEvent::Yield if run.plastic.is_some() => {
                    let position = contact.remove(node)?;
                    left.push((step, state.event, Left { node, position }));
                    yielded.push(node);
                    true
                }
                _ => false,
            };
            let nodes = contact.len() + yielded.len();
            let said = state.contact.yielded_nodes();
            let is_counted = state.contact.contact_nodes == nodes && said == yielded.len();
            let is_next = is_event && state.step == step && is_counted;
            if !is_next || !state.contact.is_finite() || state.approach_error.is_nan() {
                let number = state.step as f64;
                return Err(not_on_path(
                    state,
                    "number of the event",
                    number,
                    "one more than before",
                ));
            }
        }
        let counts: Vec<usize> = match &end.next {
            NextWindow::Factor(end) => end.log.yielded.iter().map(|[_, count]| *count).collect(),
            NextWindow::Iterations(end) => end.yielded.clone(),
        };
        let plastic = run.plastic.as_ref();
        let after = plastic.map(|plastic| plastic.after(groups(&counts, &yielded)));
        let before = after.transpose()?.map(|(plastic, problem)| {
            let plastic = run.plastic.replace(Arc::new(plastic));
            (plastic, mem::replace(&mut run.problem, problem))
        });
        let restored = match &end.next {
            NextWindow::Factor(end) => phase.restore_factor(run, &contact, &end.log),
            NextWindow::Iterations(end) if self.estimated.can_follow(end) => {
                phase.restore_iterations(run, &contact, end)
            }
            NextWindow::Iterations(_) => Ok(false),
        };
        if !matches!(restored, Ok(true)) {
            if let Some(before) = before {
                (run.plastic, run.problem) = before;
            }
            return restored;
        }
        run.contact = contact;
        for (step, event, left) in left {
            run.releases.push_event(step, event, left);
        }
        let front = end.ahead.last().unwrap_or(&last);
        // The contact of the last one is solved anew if a node has left since.
        let known = if run.releases.is_prefix(last.step) { &last } else { front };
        let snapshot = Snapshot::of(run, phase, known)?;
        snapshot.recognise(run, phase, known)?;
        let scalars = match (&end.next, &mut *phase) {
            (NextWindow::Iterations(end), Phase::Iterations(iterations)) => {
                self.estimated.follow_on(run, &mut **iterations, end)?;
                end.scalars
            }
            (NextWindow::Factor(end), _) => Some(end.scalars),
            _ => None,
        };
        if let Some(scalars) = scalars {
            run.scalars.take_over(scalars);
            if let Some(plastic) = &run.plastic {
                run.scalars.place_yielded(plastic.count());
            }
            // A window in which nothing happens ends behind the last state, and up to there all is linear.
            let mut at_front = run.scalars;
            at_front.advance(run.scalars.own_approach(&front.contact));
            let own = at_front.state(run.contact_nodes());
            let known = &front.contact;
            // Of lengths on a flat periodic surface nothing is left but rounding of what pressures displace.
            let pressed = run.problem.grid().cell_area() * known.contact_nodes as f64;
            let displaced = run.problem.table().self_influence() * known.load / pressed;
            let length = at_front.approach().abs().max(displaced);
            let is_behind = run.scalars.approach() >= at_front.approach() - RECOGNISED * length;
            let stiffness = |state: &ContactState| {
                state.contact_stiffness.or(state.interfacial_stiffness).unwrap_or_default()
            };
            // Of a periodic body that has yielded everywhere nothing elastic is left but a difference of works.
            let work = known.load * (known.approach.abs() + known.mean_gap.abs() + displaced);
            let pairs = [
                ("approach", own.approach, known.approach, displaced),
                ("load", own.load, known.load, 0.0),
                ("energy", own.energy, known.energy, work),
                ("stiffness", stiffness(&own), stiffness(known), 0.0),
            ];
            // They are those of the last state, but for a load that must not fall by rounding, and a stiffness that is
            // infinite.
            let is_other = |&&(_, a, b, unit): &&(&str, f64, f64, f64)| {
                let is_same = a == b || (a - b).abs() <= RECOGNISED * unit.max(b.abs());
                !is_same
            };
            if let Some(&(quantity, found, ..)) = pairs.iter().find(is_other) {
                return Err(not_on_path(front, quantity, found, "that of the state"));
            }
            if !is_behind || !at_front.is_sound(&own) {
                return Err(not_on_path(front, "load", own.load, "the load of the state"));
            }
        }
        if let NextWindow::Factor(end) = &end.next {
            self.exact.follow_on(&end.log, end.solution.is_some());
            // Events of a factor are exact but for what was inherited.
            run.inherited = front.approach_error;
            if let Some(solution) = &end.solution {
                let approach = run.scalars.approach();
                run.field.place(&run.contact, solution.clone(), approach)?;
                run.check_closed(&run.problem, &run.contact, approach)?;
            }
        }
        if run.may_leave() && scalars.is_some() {
            self.single.begin(run, phase)?;
        }
        run.last = run.last.map(|_| front.contact);
        run.queue = end.ahead.iter().copied().collect();
        self.handed_over_at = end.handed_over_at;
        Ok(true)
    }
}

/// The nodes that yielded in each window, so many each, and before these what is not known by windows.
fn groups<'a>(counts: &'a [usize], yielded: &'a [usize]) -> impl Iterator<Item = &'a [usize]> {
    let known = counts.iter().fold(0, |sum: usize, count| sum.saturating_add(*count));
    let (before, mut rest) = yielded.split_at(yielded.len().saturating_sub(known));
    let groups = counts.iter().map(move |count| {
        let (own, others) = rest.split_at((*count).min(rest.len()));
        rest = others;
        own
    });
    [before].into_iter().filter(|before| !before.is_empty()).chain(groups)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loading::LoadingSolver;
    use crate::loading::{History, LoadingBuilder};
    use crate::surface::{Amplitude, SelfAffine};
    use crate::updater::{ConjugateGradient, LinearUpdater, RecursiveCholesky};
    use crate::{Boussinesq, Grid};

    /// Takes a path behind 60 of 168 states, changes what it goes on with, and tells whether it is refused.
    fn is_refused<U: LinearUpdater + Clone>(
        updater: &U,
        change: &dyn Fn(&mut WindowEnd),
    ) -> Result<bool, Error> {
        let kernel = Boussinesq::new(Grid::new(14, 12, 1.0, 1.5)?, 1.0)?;
        let surface = SelfAffine::new(0.8, 8.0, 3.0, Amplitude::RmsHeight(0.1), 3)?;
        let builder: LoadingBuilder<'_, U> =
            LoadingSolver::builder(&surface, &kernel).updater(updater.clone());
        let mut path = builder.clone().build()?;
        let states: History = path.by_ref().take(60).collect::<Result<_, _>>()?;
        let mut end = path.window_end();
        assert!(end.as_ref().is_some_and(|end| !end.ahead.is_empty()));
        if let Some(end) = &mut end {
            change(end);
        }
        Ok(builder.resume(&states.with_window_end(end)).is_err())
    }

    fn iterations(end: &mut WindowEnd) -> &mut EstimatedEnd {
        match &mut end.next {
            NextWindow::Iterations(end) => end,
            NextWindow::Factor(_) => unreachable!("there is no factor"),
        }
    }

    fn factor(end: &mut WindowEnd) -> &mut FactorEnd {
        match &mut end.next {
            NextWindow::Factor(end) => end,
            NextWindow::Iterations(_) => unreachable!("there is a factor"),
        }
    }

    /// What is not the end of a window of this path is an error, and no wrong path.
    #[test]
    fn what_was_damaged_is_refused() -> Result<(), Error> {
        let updater = ConjugateGradient::new();
        assert!(!is_refused(&updater, &|_| {})?);
        let changes: [&dyn Fn(&mut WindowEnd); 23] = [
            &|end| end.ahead[0].step += 1,
            &|end| end.ahead[0].event = ContactEvent::Release,
            &|end| end.ahead[0].node = (99, 0),
            &|end| end.ahead[0].contact.load = f64::NAN,
            &|end| end.ahead.truncate(end.ahead.len() - 1),
            &|end| end.ahead.clear(),
            &|end| iterations(end).last_span = f64::NAN,
            &|end| iterations(end).rate_span = -1.0,
            &|end| iterations(end).joined[0] = 999,
            &|end| iterations(end).joined.truncate(1),
            &|end| iterations(end).kept.approach = f64::INFINITY,
            &|end| iterations(end).kept.approach *= 1.0 + 1e-4,
            &|end| iterations(end).kept.serves = f64::NAN,
            &|end| iterations(end).kept.load.pressure[7] *= 1.001,
            &|end| iterations(end).kept.load.displacement[7] *= 1.001,
            &|end| iterations(end).kept.rate.displacement[7] = f64::NAN,
            &|end| iterations(end).kept.rate.pressure.truncate(9),
            &|end| iterations(end).kept.proposed[0] = 168,
            &|end| iterations(end).kept.row_sums.truncate(1),
            &|end| iterations(end).kept.proposed_beside = 169,
            &|end| iterations(end).kept.sums.displacement[3] = f64::INFINITY,
            &|end| iterations(end).kept.coarse.push(168),
            &|end| iterations(end).kept.directions.push(vec![1.0; 3]),
        ];
        for (k, change) in changes.into_iter().enumerate() {
            assert!(is_refused(&updater, change)?, "{k}");
        }
        let updater = RecursiveCholesky::new();
        assert!(!is_refused(&updater, &|_| {})?);
        let changes: [&dyn Fn(&mut WindowEnd); 6] = [
            &|end| end.ahead[0].node = end.ahead[1].node,
            &|end| end.ahead.truncate(end.ahead.len() - 1),
            &|end| factor(end).scalars[0] *= 1.001,
            &|end| factor(end).scalars[1] = f64::NAN,
            &|end| factor(end).log.watched[3] = 168,
            &|end| factor(end).log.windows[0][2] -= 1,
        ];
        for (k, change) in changes.into_iter().enumerate() {
            assert!(is_refused(&updater, change)?, "{k}");
        }
        Ok(())
    }

    /// Another updater goes on from the states.
    #[test]
    fn what_does_not_suit_is_left_alone() -> Result<(), Error> {
        let other = |end: &mut WindowEnd| iterations(end).kept.tolerance = 1e-9;
        assert!(!is_refused(&ConjugateGradient::new(), &other)?);
        assert!(!is_refused(&ConjugateGradient::new(), &|end| iterations(end).settles = false)?);
        Ok(())
    }
}
