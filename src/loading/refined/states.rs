//! States of a window, pinned to the exact ones at both ends.

use crate::Error;
use crate::loading::run::{LoadingRun, Mark};
use crate::loading::state::ContactEvent;
use crate::loading::tolerances::WindowTolerances;
use crate::loading::tuning::{OF_END, OF_LOAD, OF_TIME};
use crate::loading::window::ties::Settled;
use crate::loading::window::{Window, WindowEvent};

/// Queues the states of the events of a corrected window, from a mark to the present approach.
///
/// Stiffness and closing rate grow as the pivots say, all of them scaled so that they end where they should;
/// load, mean gap and energy follow by integration, and what they lack at the end, a few parts in a million,
/// is spread along the way.
pub(super) fn enqueue(
    run: &mut LoadingRun,
    mut window: Window,
    settled: &Settled,
    (mark, time): (&Mark, f64),
    tolerances: &WindowTolerances,
) -> Result<(), Error> {
    let start = &mark.scalars;
    let closing = |event: &WindowEvent| window.course(event.position).line.closing;
    let of_gaps: Vec<f64> =
        settled.events.iter().map(|event| tolerances.time_of_gap(closing(event))).collect();
    for event in &settled.events {
        window.happen(event.position, event.time).map_err(|bad| run.not_positive_definite(bad))?;
    }
    let steps = pinned(&window, start.missing(&run.scalars));
    let mut walked = *start;
    let mut along = Vec::with_capacity(settled.events.len());
    for (k, (event, step)) in settled.events.iter().zip(&steps).enumerate() {
        walked.advance(start.approach() + event.time);
        walked.touch(*step, mark.count + k + 1);
        along.push(walked);
    }
    walked.advance(run.scalars.approach());
    // What the load may be off by: what is spread, and what the events so far would change of it.
    let spacing = time / settled.events.len() as f64;
    let mut load_error =
        run.scalars.load_beyond(&walked).abs() + run.scalars.load_over(OF_END * spacing);
    for (k, (mut scalars, event)) in along.into_iter().zip(&settled.events).enumerate() {
        let contact_nodes = mark.count + k + 1;
        scalars.pin(&walked, &run.scalars, event.time / time);
        scalars.clamp_mean_gap();
        if contact_nodes == run.problem.grid().nodes() {
            scalars.close();
        }
        let step = run.releases.steps(contact_nodes);
        let node = window.node(event.position);
        let error = settled.errors[k];
        load_error += scalars.load_of(steps[k][0], error);
        let error = OF_TIME * error + of_gaps[k];
        let error = scalars.reported_error(error, OF_LOAD * load_error);
        run.enqueue_at(&scalars, (step, ContactEvent::Touch, node), contact_nodes, error)?;
    }
    Ok(())
}

/// What each event of a window adds to stiffness and closing rate, scaled so that all of them add what they should.
pub(super) fn pinned(window: &Window, all: [f64; 2]) -> Vec<[f64; 2]> {
    let steps: Vec<[f64; 2]> = window.increments().collect();
    let total = |k: usize| steps.iter().map(|step| step[k]).sum::<f64>();
    let scale = [0, 1].map(|k| if total(k) == 0.0 { 0.0 } else { all[k] / total(k) });
    steps.into_iter().map(|step| [scale[0] * step[0], scale[1] * step[1]]).collect()
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

    /// From the approach 1 to 3, nodes 2 and 4 touch at 1.5 and 2.5: states are those of solutions there, if pivots are right and
    /// if all of them are wrong by one factor.
    #[test]
    fn states_between_solutions_are_theirs() -> Result<(), Error> {
        for factor in [1.0, 2.0] {
            let mark = at(&[0], 1.0)?.mark();
            let mut run = at(&[0, 2, 4], 3.0)?;
            let mut window = test_chain::apart(&[(4, 1.5), (2, 0.5)], 9.0);
            window.schur_mut().matrix_mut().scale_mut(factor);
            let settled = Settled {
                events: test_chain::events(&[(1, 0.5), (0, 1.5)]),
                errors: vec![1e-3, 2e-3],
            };
            enqueue(&mut run, window, &settled, (&mark, 2.0), &tolerances(1e-6))?;
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

    /// What is lacking at the end, here twice the load that was walked to, comes in proportion to the way.
    #[test]
    fn what_is_lacking_is_spread() -> Result<(), Error> {
        let mark = at(&[0], 1.0)?.mark();
        let mut run = at(&[0, 2], 3.0)?;
        // The event is known to be at 0.5; at 1.0 load and stiffness lack what half a metre of 2/4 N/m gives, 1/4 N.
        let settled = Settled { events: test_chain::events(&[(0, 1.0)]), errors: vec![0.0] };
        let window = test_chain::apart(&[(2, 0.5)], 9.0);
        enqueue(&mut run, window, &settled, (&mark, 2.0), &tolerances(0.0))?;
        let load = run.queue[0].contact.load;
        // 1/2 N at the beginning and 1/2 N/m, and half of 1/4 N.
        assert!((load - 1.125).abs() < 1e-14, "{load}");
        Ok(())
    }
}
