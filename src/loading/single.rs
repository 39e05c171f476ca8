//! One event at a time, where a node may leave at any moment: touches and releases, each from a solution of its own.

use super::estimated::Estimated;
use super::estimated::leaving::Attempt;
use super::exact::Exact;
use super::phase::Phase;
use super::ranking::{Ranking, fill};
use super::run::LoadingRun;
use super::state::ContactEvent;
use super::tolerances::{WindowTolerances, ties_until};
use super::tuning::{ESTIMATED, LEAST_RATE, TOLERANCE};
use super::window::Window;
use crate::Error;
use crate::clock::Stopwatch;
use crate::tied_events::TiedEvents;
use crate::updater::{Left, Solution};

/// The next event.
#[derive(Debug, Clone, Copy)]
struct Upcoming {
    approach: f64,
    /// Greatest error of its approach.
    error: f64,
    node: usize,
    event: ContactEvent,
}

/// Finds events for kernels of which nothing is known: what is right at the end of a window need not have been right
/// throughout. Windows hold what comes before the next release, [with a factor](super::exact) and
/// [without](super::estimated::leaving); all other events have a solution of their own.
#[derive(Debug, Default)]
pub(super) struct Single {
    upcoming: Option<Upcoming>,
    window: Window,
    /// Nodes out of contact by the approach at which they touch.
    touches: Ranking,
    tied: TiedEvents,
    /// Whether the next event has been looked for.
    has_begun: bool,
}

impl Single {
    /// Whether the next event is known at the present state.
    pub(super) fn has_begun(&self) -> bool {
        self.has_begun
    }

    /// Finds the next event, if that has not been done.
    pub(super) fn begin(&mut self, run: &mut LoadingRun, phase: &mut Phase) -> Result<(), Error> {
        if !self.has_begun {
            self.survey(run, phase)?;
            self.has_begun = true;
        }
        Ok(())
    }

    /// Computes states up to the next release, if a window holds them; otherwise one state, unless there is none with
    /// at most `most_nodes` in contact.
    pub(super) fn produce(
        &mut self,
        run: &mut LoadingRun,
        phase: &mut Phase,
        (exact, estimated): (&mut Exact, &mut Estimated),
        most_nodes: usize,
    ) -> Result<(), Error> {
        // Whatever the limit, so that a path that goes on behind it is the same.
        if let Phase::Iterations(iterations) = phase {
            let attempt = estimated.attempt(run, &mut **iterations)?;
            self.has_begun &= attempt == Attempt::NotBegun;
            if attempt == Attempt::Made {
                // Its end has been checked.
                run.inherited = 0.0;
                return Ok(());
            }
            if !self.has_begun {
                // The solution of a single event is more exact.
                run.field.forget();
            }
        }
        self.begin(run, phase)?;
        let enough = run.contact.len() >= most_nodes;
        let within = |next: &Upcoming| next.event == ContactEvent::Release || !enough;
        let Some(next) = self.upcoming.filter(within) else {
            return Ok(());
        };
        if !next.approach.is_finite() {
            return Err(run.not_finite());
        }
        let nodes = run.problem.grid().nodes();
        // What is inherited may be tension that no release explains.
        if let Phase::Factor { updater, log, .. } = phase
            && next.event == ContactEvent::Touch
            && run.inherited == 0.0
        {
            let front = run.scalars.approach();
            let solver = (&mut **updater, log);
            if exact.produce_before_release(run, solver, most_nodes)? {
                self.has_begun = false;
                let approach = run.scalars.approach();
                return self.tied.add(0, approach > front, (approach, nodes));
            }
        }
        let has_moved = next.approach > run.scalars.approach();
        self.tied.add(1, has_moved, (next.approach, nodes))?;
        let step = run.steps() + 1;
        if next.event == ContactEvent::Touch {
            let time = next.approach - run.scalars.approach();
            phase.admit(run, &mut self.window, (next.node, time))?;
        } else {
            Self::release(run, phase, step, next.node)?;
        }
        let inherited = run.inherited;
        run.scalars.advance(next.approach);
        let contact_nodes = run.contact.len();
        let event = (step, next.event, next.node);
        let checked = self.survey(run, phase).and_then(|()| {
            let mut scalars = run.scalars;
            scalars.clamp_mean_gap();
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

    /// Takes a node out of the contact.
    fn release(
        run: &mut LoadingRun,
        phase: &mut Phase,
        step: usize,
        node: usize,
    ) -> Result<(), Error> {
        let left = Left { node, position: run.contact.remove(node)? };
        // First, so that earlier contacts are known even if the updater panics.
        run.releases.push(step, left);
        let released = phase.release(&run.problem, &run.contact, left);
        if released.is_err() {
            run.take_back_release()?;
        }
        released
    }

    /// Solves at the present approach, checks the conditions of contact there, and finds the next event.
    fn survey(&mut self, run: &mut LoadingRun, phase: &mut Phase) -> Result<(), Error> {
        self.upcoming = None;
        let approach = run.scalars.approach();
        phase.renew_field(run, approach)?;
        let overlap = WindowTolerances::of(run, phase.tolerance()).overlap(approach);
        let length = run.problem.greatest_gap() + approach.abs();
        let is_pulled = |overlap| run.negative_pressure(approach, overlap);
        let allowed = if run.inherited > 0.0 { overlap.max(ESTIMATED * length) } else { overlap };
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
        fill(run, &mut self.touches, Some(allowed), |line| {
            is_sound &= line.gap >= -overlap.max(TOLERANCE * length);
            if line.closing > LEAST_RATE { approach + line.touches() } else { f64::INFINITY }
        })?;
        if is_sound {
            run.inherited = 0.0;
        }
        self.upcoming = self.first_event(run, overlap);
        run.timings.choice += start.elapsed();
        Ok(())
    }

    /// The next event: of all that would come first, or within rounding of it, the one of the node of lowest
    /// index.
    fn first_event(&self, run: &LoadingRun, overlap: f64) -> Option<Upcoming> {
        use ContactEvent::{Release, Touch};
        let front = run.scalars.approach();
        let Solution { pressure, rate } = run.field.solution();
        // What y₂ has to be below for a node to lose its pressure.
        let slowest = -LEAST_RATE * run.greatest_rate();
        let touches = self.touches.iter().map(|&(approach, node)| (approach, node, Touch));
        let falling = run.contact.order().iter().zip(pressure.iter().zip(rate));
        let falling = falling.filter(|(_, (_, rate))| **rate < slowest);
        let releases = falling.map(|(&node, (p, rate))| (front - p / rate, node, Release));
        let events = touches.chain(releases);
        let events = events.map(|(approach, node, event)| (approach.max(front), node, event));
        let first = events.clone().map(|(approach, ..)| approach).fold(f64::INFINITY, f64::min);
        let tied = ties_until(first);
        let (approach, node, event) = events
            .filter(|&(approach, ..)| approach <= tied && approach < f64::INFINITY)
            .min_by_key(|&(_, node, _)| node)?;
        let error = match run.contact.order().iter().position(|&other| other == node) {
            Some(place) => -overlap / run.problem.table().self_influence() / rate[place],
            None => overlap / run.line(node).closing,
        };
        Some(Upcoming { approach, error, node, event })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ContactGrowth;
    use crate::loading::test_chain;

    /// What comes first at the approach 2 of nodes that touch at some approaches and of two nodes in contact, 3 and 5,
    /// with pressures and rates; the error of a touch as a gap.
    fn first(
        touches: &[(f64, usize)],
        pressure: [f64; 2],
        rate: [f64; 2],
    ) -> Result<Option<(ContactEvent, usize, f64, f64)>, Error> {
        let mut given = test_chain::Altered::given(pressure.to_vec(), rate.to_vec());
        let mut run = test_chain::run(&[0.0; 6])?;
        run.contact.push(3)?;
        run.contact.push(5)?;
        run.advance_field(&mut given, 2.0, 1.0)?;
        run.scalars.place_at(2.0);
        let single = Single { touches: touches.to_vec(), ..Single::default() };
        let first = single.first_event(&run, 0.25);
        Ok(first.map(|Upcoming { approach, error, node, event }| {
            let is_touch = event == ContactEvent::Touch;
            let error = if is_touch { error * run.line(node).closing } else { error };
            (event, node, approach, error)
        }))
    }

    #[test]
    fn what_comes_first_happens() -> Result<(), Error> {
        use ContactEvent::{Release, Touch};
        // 1/2 falls to nothing within 2 m at a rate of −1/4; an overlap of 1/4 is a tension of 1/16, and that 1/4 m.
        let releasing = ([0.5, 1.0], [-0.25, 0.5]);
        let found = |touches: &[(f64, usize)]| first(touches, releasing.0, releasing.1);
        assert_eq!(found(&[])?, Some((Release, 3, 4.0, 0.25)));
        assert_eq!(found(&[(5.0, 1)])?, Some((Release, 3, 4.0, 0.25)));
        assert_eq!(found(&[(3.5, 4), (5.0, 1)])?, Some((Touch, 4, 3.5, 0.25)));
        // What should have happened already happens now.
        assert_eq!(found(&[(1.0, 1)])?, Some((Touch, 1, 2.0, 0.25)));
        // Of events within rounding, 10⁻¹³ of 4 m, that of the lowest node.
        assert_eq!(found(&[(4.0 - 3e-13, 4)])?, Some((Release, 3, 4.0, 0.25)));
        assert_eq!(found(&[(4.0 + 3e-13, 1)])?, Some((Touch, 1, 4.0 + 3e-13, 0.25)));
        assert_eq!(found(&[(4.0 + 5e-13, 1)])?, Some((Release, 3, 4.0, 0.25)));
        assert_eq!(found(&[(4.0 - 5e-13, 4)])?, Some((Touch, 4, 4.0 - 5e-13, 0.25)));
        // A rate within rounding of none, 10⁻¹² of the greatest, releases nothing; nor does one that grows.
        for (rate, release) in [(-0.9e-12, false), (-1.1e-12, true), (0.25, false)] {
            let found = first(&[], [0.5, 1.0], [rate, 1.0])?;
            assert_eq!(found.is_some(), release, "{rate:e}");
        }
        assert_eq!(first(&[(f64::INFINITY, 1)], [0.5; 2], [1.0; 2])?, None);
        Ok(())
    }

    /// Node 0 touches at 0 and node 2 at the approach 1. Then node 1 between them, whose gap is 1.25 + 0.25 − 1 and
    /// closes at the rate 1/2, touches at 2; gaps may be off by 10⁻⁴ of the approach, 1.
    #[test]
    fn events_come_one_at_a_time() -> Result<(), Error> {
        let mut run = test_chain::run(&[0.0, 1.25, 1.0, 9.0])?;
        let mut phase = Phase::Iterations(Box::new(test_chain::Altered::inexact(1e-6)));
        let (mut single, mut estimated) = (Single::default(), Estimated::new(None, true));
        let mut exact = Exact::new(ContactGrowth::Unknown, None);
        for _ in 0..4 {
            single.produce(&mut run, &mut phase, (&mut exact, &mut estimated), 3)?;
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
