//! States of a window, pinned to the exact ones at both ends.

use crate::Error;
use crate::loading::run::LoadingRun;
use crate::loading::scalars::{PathScalars, Rates};
use crate::loading::state::ContactEvent;
use crate::loading::tolerances::WindowTolerances;
use crate::loading::tuning::{OF_END, OF_LOAD, OF_TIME, RATE_ERROR};
use crate::loading::walk::{Carried, Walk};
use crate::loading::window::ties::Settled;
use crate::loading::window::{Window, WindowEvent};

/// A window that the path has gone through.
pub(super) struct Passed {
    /// Where it began, and the nodes in contact there.
    pub(super) start: PathScalars,
    pub(super) before: Carried,
    /// How far it went.
    pub(super) span: f64,
}

/// What has changed along a window while nodes were elastic: the approach, and both plastic sums. On plateaus, where
/// none is, all rates are known.
#[derive(Debug, Clone, Copy, Default)]
struct Open([f64; 3]);

impl Open {
    /// Advances scalars to an approach, with so many nodes that are elastic.
    fn advance(&mut self, scalars: &mut PathScalars, approach: f64, elastic: usize) {
        let before = scalars.lengths();
        scalars.advance(approach);
        if elastic > 0 {
            let after = scalars.lengths();
            (0..3).for_each(|k| self.0[k] += after[k] - before[k]);
        }
    }

    /// What has changed since then: nothing before it.
    fn since(&self, then: &Self) -> Self {
        Self(std::array::from_fn(|k| (self.0[k] - then.0[k]).max(0.0)))
    }

    /// How much of all that changes this is: nothing if nothing does.
    fn parts_of(&self, all: &Self) -> [f64; 3] {
        std::array::from_fn(|k| {
            if all.0[k] > 0.0 { (self.0[k] / all.0[k]).clamp(0.0, 1.0) } else { 0.0 }
        })
    }
}

/// The numbers of rates.
fn numbers(rates: &Rates) -> [f64; 4] {
    let Rates { unit_stiffness, closing, plastic: [depth, work] } = *rates;
    [unit_stiffness, closing, depth, work]
}

fn rates_of([unit_stiffness, closing, depth, work]: [f64; 4]) -> Rates {
    Rates { unit_stiffness, closing, plastic: [depth, work] }
}

/// Rates of events, corrected to end as they should, with `exact`: what they lack there is added in proportion to how
/// much the events so far have changed them.
pub(super) fn completed(start: &Rates, events: &[Rates], exact: &Rates) -> Vec<Rates> {
    let (start, exact) = (numbers(start), numbers(exact));
    let events: Vec<[f64; 4]> = events.iter().map(numbers).collect();
    let mut found = events.clone();
    for k in 0..4 {
        let mut last = start[k];
        let mut way = 0.0;
        let ways: Vec<f64> = events
            .iter()
            .map(|event| {
                way += (event[k] - last).abs();
                last = event[k];
                way
            })
            .collect();
        let lacking = exact[k] - last;
        for (event, part) in found.iter_mut().zip(ways) {
            event[k] += if way > 0.0 { lacking * part / way } else { lacking };
        }
    }
    found.into_iter().map(rates_of).collect()
}

/// The stiffness of so many elastic nodes that is nearly `found`: one of them has that of one `alone`, and more are
/// stiffer.
fn stiffness_of(elastic: usize, found: f64, alone: f64) -> f64 {
    match elastic {
        0 => found,
        1 => alone,
        _ => found.max(alone),
    }
}

/// Queues the states of the events of a corrected window, which the path has gone through, from where it began to the
/// present approach.
///
/// Rates are those of its matrix, and end where they should; load, mean gap, energies and plastic sums follow by
/// integration, and what they lack at the end, a few parts in a million, is spread along the way.
pub(super) fn enqueue(
    run: &mut LoadingRun,
    (mut window, settled): (Window, &Settled),
    passed: Passed,
    ([start_rates, exact], tolerances): ([Rates; 2], &WindowTolerances),
) -> Result<(), Error> {
    let Passed { start, before, span } = passed;
    let [mut elastic, yielded] = before.nodes;
    let yields = yielded > 0 || settled.events.iter().any(|e| e.kind == ContactEvent::Yield);
    let of_gap = |event: &WindowEvent| {
        // A node that has just touched, or lost a neighbour, comes to its hardness at another rate than it began with.
        tolerances.time_of_gap(if yields { event.closing } else { window.closing(event) })
    };
    let of_gaps: Vec<f64> = settled.events.iter().map(of_gap).collect();
    for event in &settled.events {
        window.happen(event.position, event.time).map_err(|bad| run.not_positive_definite(bad))?;
    }
    let events = window.events();
    let mut rates = completed(&start_rates, &window.rates(start_rates), &exact);
    let alone = run.problem.table().self_influence().recip();
    for (event, rates) in events.iter().zip(&mut rates).filter(|_| yields) {
        elastic = if event.kind == ContactEvent::Touch { elastic + 1 } else { elastic - 1 };
        rates.unit_stiffness = stiffness_of(elastic, rates.unit_stiffness, alone);
    }
    let plastic = run.plastic.clone();
    let mut walk = Walk::new(plastic.as_deref(), before);
    let mut walked = start;
    let mut open = Open::default();
    // Rates up to the first event are solved for: nothing is lacking there. The load is known behind a plateau as well.
    let (mut first, mut known) = (Open::default(), Open::default());
    let mut along = Vec::with_capacity(events.len());
    for (k, (event, rates)) in events.iter().zip(&rates).enumerate() {
        let elastic = walk.carried.nodes[0];
        open.advance(&mut walked, start.approach() + event.time, elastic);
        if k == 0 {
            (first, known) = (open, open);
        }
        walk.pass(window.node(event.position), event.kind);
        walk.take(&mut walked, *rates);
        if walk.carried.nodes[0] == 0 {
            known = open;
        }
        along.push((walked, open));
    }
    open.advance(&mut walked, run.scalars.approach(), walk.carried.nodes[0]);
    // What the load may be off by: what is spread, what rates of nodes that yield are off by, and what the events so
    // far would change of it.
    let spacing = span / events.len() as f64;
    let of_rates = if yields { RATE_ERROR } else { 0.0 };
    let mut load_error = run.scalars.load_beyond(&walked).abs()
        + of_rates * run.scalars.load_beyond(&start).abs()
        + run.scalars.load_over(OF_END * spacing);
    let mut stiffness = start_rates.unit_stiffness;
    let mut walk = Walk::new(plastic.as_deref(), before);
    let own = run.scalars;
    for (k, ((mut scalars, so_far), event)) in along.into_iter().zip(events).enumerate() {
        let node = window.node(event.position);
        let bounds = walk.pass(node, event.kind);
        let [way, depth, work] = so_far.since(&first).parts_of(&open.since(&first));
        let [way_of_load, ..] = so_far.since(&known).parts_of(&open.since(&known));
        scalars.pin(&walked, &own, [way_of_load, way, depth, work]);
        scalars.clamp_load(bounds);
        scalars.clamp_mean_gap();
        walk.take(&mut scalars, rates[k]);
        let error = settled.errors[k];
        load_error += scalars.load_of((rates[k].unit_stiffness - stiffness).abs(), error);
        stiffness = rates[k].unit_stiffness;
        let error = OF_TIME * error + of_gaps[k];
        let error = scalars.reported_error(error, OF_LOAD * load_error);
        let event = (walk.step, event.kind, node);
        run.enqueue_at(&scalars, event, walk.contact_nodes(), error)?;
    }
    Ok(())
}

/// Queues the states of events that come together, at the present approach, with the rates behind each.
pub(super) fn enqueue_together(
    run: &mut LoadingRun,
    events: &[(usize, ContactEvent)],
    passed: Passed,
    (rates, error): (&[Rates], f64),
) -> Result<(), Error> {
    let mut scalars = passed.start;
    scalars.advance(run.scalars.approach());
    let stiffnesses = [scalars.rates(), run.scalars.rates()].map(|rates| rates.unit_stiffness);
    let stiffness = (stiffnesses[1] - stiffnesses[0]).abs();
    let error = scalars.reported_error(error, scalars.load_of(stiffness, error));
    let plastic = run.plastic.clone();
    let mut walk = Walk::new(plastic.as_deref(), passed.before);
    for (&(node, kind), &rates) in events.iter().zip(rates) {
        let bounds = walk.pass(node, kind);
        scalars.clamp_load(bounds);
        scalars.clamp_mean_gap();
        walk.take(&mut scalars, rates);
        run.enqueue_at(&scalars, (walk.step, kind, node), walk.contact_nodes(), error)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loading::test_chain;

    const GAPS: [f64; 6] = [0.0, 9.0, 1.5, 9.0, 2.5, 9.0];

    fn tolerances(tolerance: f64) -> WindowTolerances {
        WindowTolerances { length: 2.0, tolerance, tie: 0.0 }
    }

    /// The path with some nodes in contact, and all scalars known.
    fn at(contact: &[usize], approach: f64) -> Result<LoadingRun, Error> {
        test_chain::surveyed(&GAPS, contact, approach)
    }

    /// Two metres from here.
    fn passed(begun: &LoadingRun) -> Passed {
        Passed { start: begun.scalars, before: Carried::of(begun), span: 2.0 }
    }

    /// From the approach 1 to 3, nodes 2 and 4 touch at 1.5 and 2.5: states are those of solutions there, if pivots are
    /// right and if all of them are wrong by one factor.
    #[test]
    fn states_between_solutions_are_theirs() -> Result<(), Error> {
        for factor in [1.0, 2.0] {
            let begun = at(&[0], 1.0)?;
            let mut run = at(&[0, 2, 4], 3.0)?;
            let mut window = test_chain::apart(&[(4, 1.5), (2, 0.5)], 9.0);
            window.schur_mut().matrix_mut().scale_mut(factor);
            let settled = Settled {
                events: test_chain::events(&[(1, 0.5), (0, 1.5)]),
                errors: vec![1e-3, 2e-3],
            };
            let rates = [begun.scalars.rates(), run.scalars.rates()];
            enqueue(&mut run, (window, &settled), passed(&begun), (rates, &tolerances(1e-6)))?;
            let found: Vec<_> = run.queue.drain(..).collect();
            assert_eq!(found.len(), 2);
            for (k, state) in found.iter().enumerate() {
                assert_eq!((state.step, state.contact.contact_nodes), (k + 2, k + 2));
                assert_eq!(state.node, ([2, 4][k], 0));
                // Twice what was settled, and 30 · 10⁻⁶ of 2 m at a closing rate of 1.
                let error = [2e-3, 4e-3][k] + 6e-5;
                assert!((state.approach_error - error).abs() < 1e-15, "{}", state.approach_error);
                let expected = at(&[0, 2, 4][..k + 2], [1.5, 2.5][k])?.scalars.state(k + 2);
                let pairs = [
                    (state.contact.approach, expected.approach),
                    (state.contact.load, expected.load),
                    (state.contact.energy, expected.energy),
                    (state.contact.mean_gap, expected.mean_gap),
                ];
                let stiffnesses = [
                    (state.contact.contact_stiffness, expected.contact_stiffness),
                    (state.contact.interfacial_stiffness, expected.interfacial_stiffness),
                ];
                let stiffnesses =
                    stiffnesses.map(|(a, b)| (a.unwrap_or(f64::NAN), b.unwrap_or_default()));
                for (found, expected) in pairs.into_iter().chain(stiffnesses) {
                    // Rounding errors of numbers up to 10.
                    assert!((found - expected).abs() < 1e-13, "{k}: {found} {expected}");
                }
            }
        }
        Ok(())
    }

    /// What is lacking at the end comes in proportion to the way behind the first event: up to there nothing is.
    #[test]
    fn what_is_lacking_is_spread() -> Result<(), Error> {
        let begun = at(&[0], 1.0)?;
        let mut run = at(&[0, 2, 4], 3.0)?;
        // The second event is known to be at 1.5; at 1.75 the load lacks what a quarter of a metre of 2/4 N/m gives.
        let settled =
            Settled { events: test_chain::events(&[(0, 0.5), (1, 1.75)]), errors: vec![0.0; 2] };
        let window = test_chain::apart(&[(2, 0.5), (4, 1.5)], 9.0);
        let rates = [begun.scalars.rates(), run.scalars.rates()];
        enqueue(&mut run, (window, &settled), passed(&begun), (rates, &tolerances(0.0)))?;
        let loads = [run.queue[0].contact.load, run.queue[1].contact.load];
        // 1/2 N at the beginning, 1/2 N/m and then 1 N/m; and five sixths of 1/8 N.
        assert!((loads[0] - 0.75).abs() < 1e-14, "{loads:?}");
        assert!((loads[1] - 2.0 - 5.0 / 48.0).abs() < 1e-14, "{loads:?}");
        Ok(())
    }

    /// One elastic node, a plateau with one that has yielded, and an elastic one beside it: what the window lacks
    /// belongs to the first and the last third.
    #[test]
    fn plateaus_lack_nothing() -> Result<(), Error> {
        let problem = crate::test_chain::problem(&[0.0, 1.0, 2.0, 5.0])?;
        let mut scalars = PathScalars::new(&problem).with_hardness();
        let rates = |depth| Rates { unit_stiffness: 0.5, closing: 3.0, plastic: [depth, 0.0] };
        let mut open = Open::default();
        let mut along = Vec::new();
        for (approach, nodes, depth) in [(1.0, [1, 0], 0.0), (2.0, [0, 1], 1.0), (3.0, [1, 1], 1.0)]
        {
            scalars.change_rates(rates(depth), nodes, 0.0);
            open.advance(&mut scalars, approach, nodes[0]);
            along.push(open);
        }
        let parts: Vec<_> = along.iter().map(|so_far| so_far.parts_of(&open)).collect();
        assert_eq!(parts, [[0.5, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 1.0, 0.0]]);
        // Nothing but a plateau.
        let none = Open::default();
        assert_eq!(none.parts_of(&none), [0.0; 3]);
        Ok(())
    }
}
