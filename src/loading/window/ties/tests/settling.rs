//! Events that are settled by solutions.

use super::*;
use crate::loading::estimated::values_before;
use crate::loading::run::LoadingRun;
use crate::loading::test_chain::Altered;

/// Settles what a window says of events of nodes that do not act on each other. From the approach 1 on, with node 0 in
/// contact, they have joined at the approach 3.5, at which the solution has been found.
fn settle_all(
    (gaps, joined): (&[f64], &[usize]),
    window: &Window,
    before: Settled,
    (tolerance, is_certain): (f64, bool),
) -> Result<(LoadingRun, Option<Settled>), Error> {
    let mut run = test_chain::solved(gaps, joined, 3.5)?;
    let count = joined.len() - before.events.len();
    run.contact.truncate(count);
    let beginning = Beginning { approach: 1.0, count, is_certain };
    let tolerances = tolerances(1.0, tolerance, 1e-9);
    let mut iterations = Altered::inexact(tolerances.tolerance);
    let found = settle(window, &tolerances, before, beginning, |question, nodes| {
        values_before(&mut run, &mut iterations, (window, question, nodes), 1.0)
    })?;
    Ok((run, found))
}

/// Events with errors.
fn before(pairs: &[(usize, f64)], errors: &[f64]) -> Settled {
    Settled { events: events(pairs), errors: errors.to_vec() }
}

/// A window corrected to pivots of 4.
fn of_four(window: &Window) -> Window {
    correction(window, &(4.0 * test_chain::matrix(window))).window
}

/// The gap of node 2, or of node 4, closes at the approach 3, and the other one's later. Node 0 is in contact and
/// reaches neither of them. The window, from the approach 1, says that node 2 is first; it closes at half the rate
/// there.
fn settled(
    gaps: [f64; 2],
    times: [f64; 2],
    (errors, tolerance): ([f64; 2], f64),
) -> Result<(LoadingRun, Settled), Error> {
    let initial = [0.0, 9.0, gaps[0], 9.0, gaps[1], 9.0];
    let window = alone(&[2, 4], &[[9.0, 0.5], [9.0, 1.0]]);
    let before = before(&[(0, times[0]), (1, times[1])], &errors);
    let joined = (&initial[..], &[0, 4, 2][..]);
    let (run, settled) = settle_all(joined, &of_four(&window), before, (tolerance, true))?;
    let Some(settled) = settled else {
        unreachable!("two events are not contradicted");
    };
    Ok((run, settled))
}

/// Positions and times.
fn check_events(settled: &Settled, expected: &[(usize, f64)]) {
    let (positions, times): (Vec<_>, Vec<_>) = pairs(&settled.events).into_iter().unzip();
    let (expected_positions, expected_times): (Vec<_>, Vec<_>) = expected.iter().copied().unzip();
    assert_eq!(positions, expected_positions);
    close(&times, &expected_times);
}

#[test]
fn close_events_are_settled_by_their_gaps() -> Result<(), Error> {
    // At the approach 3 node 4 touches, and the gap of node 2, 1/16, closes after 1/8. Errors of 1/4 are poor there:
    // gaps may be off by 0.04 · 10⁻³ · 3 · 0.5 and 2 · 10⁻³ · 3, that is by 0.006 06; over the rates, and with 0.05 of
    // 1/8 for the second.
    let (run, found) = settled([3.0625, 3.0], [2.0, 2.03125], ([0.25; 2], 1e-3))?;
    assert_eq!(run.timings.ties, 1);
    check_events(&found, &[(1, 2.0), (0, 2.125)]);
    close(&found.errors, &[0.006_06, 0.05 * 0.125 + 0.012_12]);
    // A gap that has closed a sixteenth before.
    let (_, found) = settled([3.0625, 2.9375], [2.0, 2.03125], ([0.25; 2], 1e-3))?;
    check_events(&found, &[(1, 1.9375), (0, 2.125)]);
    close(&found.errors, &[0.006_06, 0.05 * 0.1875 + 0.012_12]);
    // The gap of node 2, which closes at half the rate, has closed 1/8 before.
    let (_, found) = settled([2.9375, 3.0], [2.0, 2.03125], ([0.25; 2], 1e-3))?;
    check_events(&found, &[(0, 1.875), (1, 2.0)]);
    close(&found.errors, &[0.012_12, 0.05 * 0.125 + 0.006_06]);
    // Or a metre before.
    let (_, found) = settled([2.5, 3.0], [2.0, 2.03125], ([0.25; 2], 1e-3))?;
    check_events(&found, &[(0, 1.0), (1, 2.0)]);
    // 1/64 apart, which is within the errors left: a second solution in the new order, as exact as they go.
    let (run, found) = settled([3.007_812_5, 3.0], [2.0, 2.03125], ([0.25; 2], 1e-3))?;
    assert_eq!(run.timings.ties, 2);
    check_events(&found, &[(1, 2.0), (0, 2.015_625)]);
    close(&found.errors, &[0.006, 0.05 / 64.0 + 0.012]);
    // Far from each other beside their errors: nothing is asked.
    let (run, found) = settled([3.0, 3.5], [2.0, 2.5], ([2e-3; 2], 1e-3))?;
    assert_eq!(run.timings.ties, 0);
    check_events(&found, &[(0, 2.0), (1, 2.5)]);
    assert_eq!(found.errors, [2e-3; 2]);
    Ok(())
}

/// What cannot be settled stays as it is: a gap that does not close, and no factor of the events before.
#[test]
fn what_cannot_be_settled_stays() -> Result<(), Error> {
    let initial = [0.0, 9.0, 3.0, 9.0, 3.0];
    let window = alone(&[2, 4], &[[9.0, 1.0], [8.0, 1.0]]);
    for (closing, own) in [(0.0, 4.0), (1.0, -4.0)] {
        let mut window = of_four(&window);
        let courses = [[9.0, 1.0, 0.0, 0.0], [9.0, closing, 0.0, 0.0]].map(course);
        window.set_courses(courses.into_iter());
        window.schur_mut().matrix_mut()[(0, 0)] = own;
        let before = before(&[(0, 2.0), (1, 2.25)], &[0.25; 2]);
        let joined = (&initial[..], &[0, 2, 4][..]);
        let (run, found) = settle_all(joined, &window, before, (1e-3, false))?;
        assert!(found.is_some_and(|found| {
            check_events(&found, &[(0, 2.0), (1, 2.25)]);
            found.errors == [0.25; 2]
        }));
        assert_eq!(run.timings.ties, 1);
    }
    Ok(())
}

/// Hands three events a thirty-second apart to be settled, the first of which truly touches at `first`; returns what
/// was found, and the number of solutions.
fn three_settled(
    first: f64,
    (lines, step, error): ([[f64; 2]; 3], f64, f64),
) -> Result<(Option<Settled>, usize), Error> {
    let initial = [0.0, 9.0, first, 9.0, 3.03125, 9.0, 3.0625];
    let window = alone(&[2, 4, 6], &lines);
    let pairs = [(0, 2.0), (1, 2.0 + step), (2, 2.0 + 2.0 * step)];
    let (before, joined) = (before(&pairs, &[error; 3]), (&initial[..], &[0, 2, 4, 6][..]));
    let (run, found) = settle_all(joined, &of_four(&window), before, (1e-2, false))?;
    Ok((found, run.timings.ties))
}

const DISTINCT: [[f64; 2]; 3] = [[9.0, 1.0], [7.0, 1.0], [5.0, 1.0]];

/// Gaps may be off by more than events are apart, whatever is done: the first solution is not exact, the second is, for
/// the first event; the third is for the second event.
#[test]
fn solutions_go_on_while_neighbours_are_close() -> Result<(), Error> {
    let (found, solutions) = three_settled(3.0, (DISTINCT, 0.03125, 0.5))?;
    assert!(found.is_some_and(|found| {
        check_events(&found, &[(0, 2.0), (1, 2.03125), (2, 2.0625)]);
        solutions == 3
    }));
    Ok(())
}

/// A gap that closed a metre before it was expected to, with an error of 0.09: more than ten times that.
#[test]
fn far_from_what_was_expected_nothing_is_settled() -> Result<(), Error> {
    let (found, solutions) = three_settled(2.0, (DISTINCT, 0.03125, 0.09))?;
    assert!(found.is_none() && solutions == 1);
    Ok(())
}

/// Events of one line within their errors, which are small beside the approach of 3: at their mean, by no solution.
#[test]
fn nothing_is_asked_of_an_orbit() -> Result<(), Error> {
    let (found, solutions) = three_settled(3.0, ([[9.0, 1.0]; 3], 1e-3, 2e-3))?;
    assert!(found.is_some_and(|found| {
        check_events(&found, &[(0, 2.001), (1, 2.001), (2, 2.001)]);
        solutions == 0
    }));
    Ok(())
}

/// Node 1 sinks by 3/4 and 1/4 at the approach 3 if nodes 0 and 2, at 2 m, carry before it.
#[test]
fn gaps_are_those_with_all_events_before() -> Result<(), Error> {
    let mut run = test_chain::solved(&[0.0, 2.5, 2.0, 9.0], &[0], 1.0)?;
    let window = alone(&[2, 1], &[[9.0, 1.0]; 2]);
    let events = events(&[(0, 1.0), (1, 2.0)]);
    let iterations = &mut Altered::inexact(0.0);
    let mut gaps = |done: usize, nodes: &[usize]| {
        let question = Question { events: &events, done, error: 0.0 };
        values_before(&mut run, iterations, (&window, question, nodes), 1.0)
    };
    close(&gaps(1, &[1])?, &[0.5]);
    // At the approach 2 node 0 carries alone.
    close(&gaps(0, &[2, 1])?, &[0.0, 1.0]);
    Ok(())
}
