//! One event at a time: nodes that touch and nodes that leave, for kernels of which nothing is known.

use super::tuning::{ESTIMATED, LEAST_RATE, TIED_EVENTS, TOLERANCE};

use super::factor_log::FactorLog;
use super::phase::Phase;
use super::run::LoadingRun;
use super::state::ContactEvent;
use super::tolerances::{WindowTolerances, ties_until};
use super::window::Window;
use crate::Error;
use crate::clock::Stopwatch;
use crate::updater::{Left, Solution};

/// The next event, unless another one comes first.
#[derive(Debug, Clone, Copy)]
struct Upcoming {
    approach: f64,
    /// Greatest error of its approach.
    error: f64,
    node: usize,
    event: ContactEvent,
}

/// Finds every event, touch or release, from a solution of its own.
#[derive(Debug, Default)]
pub(super) struct Stepwise {
    upcoming: Option<Upcoming>,
    window: Window,
    /// Those of the nodes out of contact whose gap closes.
    touches: Vec<Upcoming>,
    /// Events so far at the approach of the front.
    tied: usize,
    /// Whether the next event has been looked for.
    has_begun: bool,
    /// All events of the factor so far.
    log: FactorLog,
    /// The error of the state that the path goes on from, if that is an estimate and no solution has been without
    /// tension and overlap since.
    inherited: f64,
}

impl Stepwise {
    /// Whether the next event is known at the present state.
    pub(super) fn has_begun(&self) -> bool {
        self.has_begun
    }

    /// Says that the path has gone on otherwise.
    pub(super) fn forget(&mut self) {
        self.has_begun = false;
    }

    /// All events of the factor so far.
    pub(super) fn log(&self) -> &FactorLog {
        &self.log
    }

    /// Goes on with a factor that grew so.
    pub(super) fn follow_on(&mut self, log: FactorLog) {
        self.log = log;
    }

    /// Goes on from a state of which the approach may be off by `error`.
    pub(super) fn inherit(&mut self, error: f64) {
        self.inherited = error;
    }

    /// Finds the next event, if that has not been done.
    pub(super) fn begin(&mut self, run: &mut LoadingRun, phase: &mut Phase) -> Result<(), Error> {
        if !self.has_begun {
            self.survey(run, phase)?;
            self.has_begun = true;
        }
        Ok(())
    }

    /// Computes one state, unless there is none with at most `most_nodes` in contact.
    pub(super) fn produce(
        &mut self,
        run: &mut LoadingRun,
        phase: &mut Phase,
        most_nodes: usize,
    ) -> Result<(), Error> {
        self.begin(run, phase)?;
        let enough = run.contact.len() >= most_nodes;
        let within = |next: &Upcoming| next.event == ContactEvent::Release || !enough;
        let Some(next) = self.upcoming.filter(within) else {
            return Ok(());
        };
        if !next.approach.is_finite() {
            return Err(run.not_finite());
        }
        self.count_tie(run, next.approach)?;
        let step = run.steps() + 1;
        if next.event == ContactEvent::Touch {
            let time = next.approach - run.scalars.approach();
            phase.admit(run, &mut self.window, (next.node, time))?;
            if let Phase::Factor { .. } = phase {
                self.log.push(&[next.node], std::iter::once(0), 1);
            }
        } else {
            let position = Self::release(run, phase, step, next.node)?;
            if let Phase::Factor { .. } = phase {
                self.log.push_left(position);
            }
        }
        let inherited = self.inherited;
        run.scalars.advance(next.approach);
        let contact_nodes = run.contact.len();
        let event = (step, next.event, next.node);
        let checked = self.survey(run, phase).and_then(|()| {
            let scalars = run.scalars;
            let error = scalars.reported_error(next.error, 0.0).max(inherited);
            run.enqueue_at(&scalars, event, contact_nodes, error)
        });
        // The order of contact must be that of the states before; the updater stays without the node. One
        // that touched may stay where it is: behind all others.
        if checked.is_err() && next.event == ContactEvent::Release {
            run.take_back_release()?;
        }
        checked
    }

    /// Refuses to go on without end at one approach.
    fn count_tie(&mut self, run: &LoadingRun, approach: f64) -> Result<(), Error> {
        if approach > run.scalars.approach() {
            self.tied = 0;
        }
        self.tied += 1;
        if self.tied > TIED_EVENTS * (run.problem.grid().nodes() + 1) {
            return Err(Error::Cycling { approach, events: self.tied });
        }
        Ok(())
    }

    /// Takes a node out of the contact; returns its place there.
    fn release(
        run: &mut LoadingRun,
        phase: &mut Phase,
        step: usize,
        node: usize,
    ) -> Result<usize, Error> {
        let position = run.contact.remove(node)?;
        // First, so that earlier contacts are known even if the updater panics.
        run.releases.push(step, Left { node, position });
        let released = phase.release(&run.problem, &run.contact, &[Left { node, position }]);
        if released.is_err() {
            run.take_back_release()?;
        }
        released.map(|()| position)
    }

    /// Solves at the present approach, checks the conditions of contact there, and finds the next event.
    fn survey(&mut self, run: &mut LoadingRun, phase: &mut Phase) -> Result<(), Error> {
        self.upcoming = None;
        let approach = run.scalars.approach();
        phase.renew_field(run, approach)?;
        let overlap = WindowTolerances::of(run, phase.tolerance()).overlap(approach);
        let length = run.problem.greatest_gap() + approach.abs();
        let count = run.contact.len();
        let is_pulled = |overlap| run.negative_pressure(count, (approach, overlap));
        let allowed = if self.inherited > 0.0 { overlap.max(ESTIMATED * length) } else { overlap };
        if let Some((node, value)) = is_pulled(allowed) {
            return Err(run.not_monotone("pressure", node, value));
        }
        let mut is_sound = is_pulled(overlap).is_none();
        if phase.tolerance() > 0.0 {
            // A stiffness by iterations may be off by more than what it adds up to over a long way.
            run.scalars.renew_load(&run.problem, &run.contact, &run.field);
        } else {
            run.scalars.renew_stiffness(run.field.solution());
        }
        let start = Stopwatch::start();
        self.touches.clear();
        self.touches.reserve(run.problem.grid().nodes());
        run.survey(Some(allowed), |node, line| {
            is_sound &= line.gap >= -overlap.max(TOLERANCE * length);
            if line.closing > LEAST_RATE {
                self.touches.push(Upcoming {
                    approach: approach + line.gap / line.closing,
                    error: overlap / line.closing,
                    node,
                    event: ContactEvent::Touch,
                });
            }
        })?;
        if is_sound {
            self.inherited = 0.0;
        }
        self.upcoming = self.first_event(run, overlap);
        run.timings.choice += start.elapsed();
        Ok(())
    }

    /// The next event: of all that would come first, or within rounding of it, the one of the node of lowest
    /// index.
    fn first_event(&self, run: &LoadingRun, overlap: f64) -> Option<Upcoming> {
        let front = run.scalars.approach();
        let Solution { pressure, rate } = run.field.solution();
        // What y₂ has to be below for a node to lose its pressure.
        let slowest = -LEAST_RATE * run.greatest_rate();
        let tension = overlap / run.problem.table().self_influence();
        let releases = run.contact.order().iter().zip(pressure).zip(rate);
        let releases =
            releases.filter(|(_, rate)| **rate < slowest).map(|((&node, p), rate)| Upcoming {
                approach: front - p / rate,
                error: -tension / rate,
                node,
                event: ContactEvent::Release,
            });
        let events = self.touches.iter().copied().chain(releases);
        let events = events.map(|event| Upcoming { approach: event.approach.max(front), ..event });
        let first = events.clone().map(|event| event.approach).fold(f64::INFINITY, f64::min);
        let tied = ties_until(first);
        events
            .filter(|event| event.approach <= tied && event.approach < f64::INFINITY)
            .min_by_key(|event| event.node)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loading::test_chain;

    /// Twenty events for each of five nodes and one more, all at one approach.
    #[test]
    fn events_at_one_approach_come_to_an_end() -> Result<(), Error> {
        let mut run = test_chain::run(&[0.0; 5])?;
        run.scalars.place_at(1.0);
        let mut stepwise = Stepwise::default();
        for _ in 0..120 {
            stepwise.count_tie(&run, 1.0)?;
        }
        // One further on, and all begins anew.
        stepwise.count_tie(&run, 1.5)?;
        for _ in 0..119 {
            stepwise.count_tie(&run, 1.0)?;
        }
        let refused = stepwise.count_tie(&run, 1.0);
        assert!(
            matches!(refused, Err(Error::Cycling { approach: 1.0, events: 121 })),
            "{refused:?}"
        );
        Ok(())
    }

    fn touch(node: usize, approach: f64) -> Upcoming {
        Upcoming { approach, error: 0.0, node, event: ContactEvent::Touch }
    }

    /// What comes first at the approach 2 of these touches and of two nodes in contact, 3 and 5, with pressures and
    /// rates.
    fn first(
        touches: &[Upcoming],
        pressure: [f64; 2],
        rate: [f64; 2],
    ) -> Result<Option<(ContactEvent, usize, f64, f64)>, Error> {
        let mut given = test_chain::Altered::given(pressure.to_vec(), rate.to_vec());
        let mut run = test_chain::run(&[0.0; 6])?;
        run.contact.push(3)?;
        run.contact.push(5)?;
        run.advance_field(&mut given, 2.0, 1.0)?;
        run.scalars.place_at(2.0);
        let stepwise = Stepwise { touches: touches.to_vec(), ..Stepwise::default() };
        let first = stepwise.first_event(&run, 0.25);
        Ok(first.map(|next| (next.event, next.node, next.approach, next.error)))
    }

    #[test]
    fn what_comes_first_happens() -> Result<(), Error> {
        use ContactEvent::{Release, Touch};
        // 1/2 falls to nothing within 2 m at a rate of −1/4; an overlap of 1/4 is a tension of 1/16, and that 1/4 m.
        let releasing = ([0.5, 1.0], [-0.25, 0.5]);
        let found = |touches: &[Upcoming]| first(touches, releasing.0, releasing.1);
        assert_eq!(found(&[])?, Some((Release, 3, 4.0, 0.25)));
        assert_eq!(found(&[touch(1, 5.0)])?, Some((Release, 3, 4.0, 0.25)));
        assert_eq!(found(&[touch(4, 3.5), touch(1, 5.0)])?, Some((Touch, 4, 3.5, 0.0)));
        // What should have happened already happens now.
        assert_eq!(found(&[touch(1, 1.0)])?, Some((Touch, 1, 2.0, 0.0)));
        // Of events within rounding, 10⁻¹³ of 4 m, that of the lowest node.
        assert_eq!(found(&[touch(4, 4.0 - 3e-13)])?, Some((Release, 3, 4.0, 0.25)));
        assert_eq!(found(&[touch(1, 4.0 + 3e-13)])?, Some((Touch, 1, 4.0 + 3e-13, 0.0)));
        assert_eq!(found(&[touch(1, 4.0 + 5e-13)])?, Some((Release, 3, 4.0, 0.25)));
        assert_eq!(found(&[touch(4, 4.0 - 5e-13)])?, Some((Touch, 4, 4.0 - 5e-13, 0.0)));
        // A rate within rounding of none, 10⁻¹² of the greatest, releases nothing; nor does one that grows.
        for (rate, release) in [(-0.9e-12, false), (-1.1e-12, true), (0.25, false)] {
            let found = first(&[], [0.5, 1.0], [rate, 1.0])?;
            assert_eq!(found.is_some(), release, "{rate:e}");
        }
        assert_eq!(first(&[touch(1, f64::INFINITY)], [0.5; 2], [1.0; 2])?, None);
        Ok(())
    }

    /// Node 0 touches at 0 and node 2 at the approach 1. Then node 1 between them, whose gap is 1.25 + 0.25 − 1 and
    /// closes at the rate 1/2, touches at 2; gaps may be off by 10⁻⁴ of the approach, 1.
    #[test]
    fn events_come_one_at_a_time() -> Result<(), Error> {
        let mut run = test_chain::run(&[0.0, 1.25, 1.0, 9.0])?;
        let mut phase = Phase::Iterations(Box::new(test_chain::Altered::inexact(1e-6)));
        let mut stepwise = Stepwise::default();
        for _ in 0..4 {
            stepwise.produce(&mut run, &mut phase, 3)?;
        }
        let found: Vec<_> = run
            .queue
            .iter()
            .map(|state| (state.step, state.contact.contact_nodes, state.node))
            .collect();
        assert_eq!(found, [(1, 1, (0, 0)), (2, 2, (2, 0)), (3, 3, (1, 0))]);
        for (state, (approach, error)) in
            run.queue.iter().zip([(0.0, 0.0), (1.0, 0.0), (2.0, 2e-4)])
        {
            assert!(
                (state.contact.approach - approach).abs() < 1e-14,
                "{}",
                state.contact.approach
            );
            // At first touch a part of 10⁻⁶ of the mean gap.
            assert!((state.approach_error - error).abs() < 1e-9, "{}", state.approach_error);
        }
        // 1/2 N for each metre, and after the second node twice as much.
        let loads: Vec<f64> = run.queue.iter().map(|state| state.contact.load).collect();
        for (found, expected) in loads.into_iter().zip([0.0, 0.5, 1.5]) {
            assert!((found - expected).abs() < 1e-14, "{found}");
        }
        Ok(())
    }
}
