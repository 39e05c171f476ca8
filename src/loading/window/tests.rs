use nalgebra::DMatrix;

use super::*;
use crate::loading::test_chain::{self, course, pairs};

/// Nodes 7, 8 and 9 with S = C and σ = row sums of C, before any contact and from the approach 0 on.
fn window(c: [[f64; 3]; 3], lines: [[f64; 2]; 3], horizon: f64) -> Window {
    let matrix = DMatrix::from_fn(3, 3, |i, j| c[i][j]);
    let sums = c.map(|row| row.iter().sum());
    let lines = [0, 1, 2].map(|k| (7 + k, lines[k]));
    let mut window = test_chain::window(&lines, &matrix, &sums, horizon);
    window.approach = 0.0;
    window
}

/// (node, time) of the events.
fn found(window: &Window) -> Vec<(usize, f64)> {
    let times = window.events().iter().map(|event| event.time);
    window.touched().zip(times).collect()
}

const C: [[f64; 3]; 3] = [[2.0, 1.0, 0.0], [1.0, 2.0, 1.0], [0.0, 1.0, 2.0]];
/// Nodes that do not act on each other.
const ALONE: [[f64; 3]; 3] = [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];

#[test]
fn a_node_that_touches_delays_its_neighbour() {
    // Node 7 touches at 0; then node 8 rises by half of the approach, and touches at 2 instead of 1.
    let mut window = window(C, [[0.0, 1.0], [1.0, 1.0], [5.0, 1.0]], 10.0);
    assert_eq!(window.nodes(), [7, 8, 9]);
    assert_eq!(window.play(2), None);
    let found = found(&window);
    assert_eq!(found[0], (7, 0.0));
    // A few rounding errors of numbers near 1.
    assert!(found[1].0 == 8 && (found[1].1 - 2.0).abs() < 1e-14, "{found:?}");
    let added: Vec<f64> = window.increments().map(|[stiffness, _]| stiffness).collect();
    let [first, second] = added[..] else {
        unreachable!("two were asked for");
    };
    // eᵀ C⁻¹ e of the first node alone, and of the first two: 1/2 and 2/3.
    assert!((first - 0.5).abs() < 1e-15);
    assert!((first + second - 2.0 / 3.0).abs() < 1e-15);
    assert_eq!(window.untouched().collect::<Vec<_>>(), [9]);
}

/// Three nodes of which the second feels half of what the first carries, and the third nothing:
/// `2 − t + (t − 1)/2` closes at t = 3.
#[test]
fn a_node_that_carries_holds_its_neighbours_back() {
    let schur = DMatrix::from_row_slice(3, 3, &[1.0, 0.5, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 1.0]);
    let lines = [(7, [1.0, 1.0]), (8, [2.0, 1.0]), (9, [2.5, 1.0])];
    let window = test_chain::window(&lines, &schur, &[3.0, 2.0, 5.0], f64::INFINITY);
    let mut all = window.clone();
    assert!(all.play(9).is_none());
    assert_eq!(pairs(all.events()), [(0, 1.0), (2, 2.5), (1, 3.0)]);
    // Up to the horizon, that included, and up to a number; the first is played in any case.
    for (horizon, count) in [(2.5, 2), (2.4, 1), (0.5, 1)] {
        let [mut until, mut other] = [window.clone(), window.clone()];
        until.horizon = horizon;
        assert_eq!([until.play(9), other.play_until(horizon)], [None; 2]);
        assert_eq!([until.events().len(), other.events().len()], [count; 2]);
        assert_eq!(other.horizon(), horizon);
    }
    let mut few = window.clone();
    assert_eq!((few.play(2), few.events().len()), (None, 2));
    // 1 / (1 − 1/4) of what is left of closing rate and row sum, 1/2 and 2 − 3/2.
    let mut two = window;
    for (position, time) in [(0, 1.0), (1, 3.0)] {
        assert_eq!(two.happen(position, time), Ok(()));
    }
    let expected = [1.0, 3.0, 0.25 / 0.75, 0.25 / 0.75];
    for (found, expected) in two.increments().flatten().zip(expected) {
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
}

#[test]
fn the_horizon_ends_a_window_but_not_before_its_first_event() {
    let mut early = window(C, [[0.5, 1.0], [1.0, 1.0], [5.0, 1.0]], 0.1);
    assert_eq!(early.play(3), None);
    assert_eq!(early.events().len(), 1);
    // Until the horizon, and at it.
    let lines = [[0.0, 1.0], [1.0, 1.0], [9.0, 1.0]];
    let mut free = window(C, lines, 100.0);
    free.play(2);
    let second = free.events()[1].time;
    for (horizon, events) in [(second, 2), (second * (1.0 - 1e-12), 1)] {
        let mut until = window(C, lines, horizon);
        assert_eq!(until.play(3), None);
        assert_eq!(until.events().len(), events, "horizon {horizon}");
    }
    let mut late = window(C, [[0.5, 1.0], [1.0, 1.0], [5.0, 1.0]], 100.0);
    assert_eq!(late.play(3), None);
    assert_eq!(late.events().len(), 3);
}

/// A gap that is nothing and does not close is no contact, and keeps no other one from being found.
#[test]
fn gaps_that_do_not_close_never_touch() {
    let mut window = window(C, [[0.0, 0.0], [1.0, 1.0], [5.0, -1.0]], 100.0);
    assert_eq!(window.play(3), None);
    assert_eq!(found(&window), [(8, 1.0)]);
}

#[test]
fn ties_go_to_the_lowest_index_and_times_never_fall() {
    let (near, far) = ([0.0, 1.0], [1.0, 1.0]);
    for (c, lines, order) in [
        (C, [far, near, near], [8, 9, 7]),
        (ALONE, [[2.0, 1.0], far, far], [8, 9, 7]),
        (ALONE, [far, [2.0, 1.0], far], [7, 9, 8]),
    ] {
        let mut window = window(c, lines, 100.0);
        assert_eq!(window.play(3), None);
        assert!(window.touched().eq(order));
        assert!(window.events().is_sorted_by(|a, b| a.time <= b.time));
    }
    // Wherever they are among the watched ones.
    let mut window = test_chain::apart(&[(9, 1.0), (8, 2.0), (7, 1.0)], 100.0);
    assert_eq!(window.play(3), None);
    assert!(window.touched().eq([7, 9, 8]));
}

/// Node 9 seems to touch first, by less than a tie: node 8 comes first all the same, and both at times that do not
/// fall. However slowly they close, it is their gaps that tell.
#[test]
fn rounding_does_not_order_ties() {
    let fast = [[5.0, 1.0], [1.0, 1.0], [1.0 - 1e-12, 1.0]];
    let slow = [[5.0, 1.0], [1e-3, 1e-3], [1e-3 - 1e-12, 1e-3]];
    // 10⁻¹³ of the approach, 1 and 21.
    for (approach, lines, order) in
        [(0.0, fast, [9, 8]), (20.0, fast, [8, 9]), (0.0, slow, [9, 8]), (20.0, slow, [8, 9])]
    {
        let mut window = window(ALONE, lines, 4.0);
        window.approach = approach;
        assert_eq!(window.play(3), None);
        assert!(window.touched().eq(order));
        assert!(window.events().is_sorted_by(|a, b| a.time <= b.time));
    }
}

/// A pivot that is not positive names its node and when it would have touched, and ends the window. Then nothing has
/// changed.
#[test]
fn bad_pivots_are_named() {
    for (matrix, second, time, pivot) in [
        // 4 − t − 2 (t − 1) closes at t = 2, with the pivot 1 − 4.
        ([1.0, -2.0, -2.0, 1.0], [4.0, 1.0], 2.0, -3.0),
        // 4 − 2 t and what the first one carries, t − 1, closes at t = 3: with nothing left of its pivot, or NaN.
        ([1.0, 1.0, 1.0, 1.0], [4.0, 2.0], 3.0, 0.0),
        ([1.0, 1.0, 1.0, f64::NAN], [4.0, 2.0], 3.0, f64::NAN),
    ] {
        let matrix = DMatrix::from_row_slice(2, 2, &matrix);
        let lines = [(7, [1.0, 1.0]), (8, second)];
        let mut window = test_chain::window(&lines, &matrix, &[0.0; 2], f64::INFINITY);
        let bad = window.play(9);
        assert!(bad.is_some_and(|bad| (bad.node, bad.time) == (8, time)));
        assert!(bad.is_some_and(|bad| bad.pivot == pivot || pivot.is_nan() && bad.pivot.is_nan()));
        assert_eq!((window.events().len(), window.factor.len()), (1, 1));
        assert_eq!(window.untouched().collect::<Vec<_>>(), [8]);
    }
    let singular = [[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut window = window(singular, [[0.0, 1.0], [0.0, 2.0], [9.0, 1.0]], 100.0);
    let bad = window.play(3);
    assert!(bad.is_some_and(|bad| (bad.node, bad.pivot) == (8, 0.0)), "{bad:?}");
    assert_eq!(window.events().len(), 1);
}

#[test]
fn nodes_of_forgotten_events_are_not_watched_any_more() {
    let mut window = window(C, [[0.0, 1.0], [1.0, 1.0], [5.0, 1.0]], 100.0);
    window.play(2);
    window.truncate(1);
    assert_eq!((window.events().len(), window.factor.len()), (1, 1));
    assert_eq!((window.increments().len(), window.touched().len()), (1, 1));
    assert_eq!(window.untouched().collect::<Vec<_>>(), [9]);
}

/// Node 7 has touched at 1: of C it leaves (3/2, 1; 1, 2), of row sums 4 − 3/2 and 3, of rates 1 − 1/2 and 1 − 1/4.
#[test]
fn what_remains_is_a_window() -> Result<(), crate::Error> {
    let mut window = window(C, [[1.0, 1.0], [2.0, 1.0], [5.0, 1.0]], 100.0);
    window.set_courses(
        [[1.0, 1.0, 0.0, 0.0], [2.0, 1.0, 0.0, 0.0], [5.0, 1.0, 0.125, 0.0]]
            .map(course)
            .into_iter(),
    );
    assert_eq!(window.happen(0, 1.0), Ok(()));
    let remaining = window.remaining(&[2, 1], 1.0, &[0.25, 0.5])?;
    assert_eq!(remaining.nodes(), [9, 8]);
    assert_eq!((remaining.approach, remaining.horizon), (1.0, f64::INFINITY));
    assert_eq!((remaining.position(8), remaining.position(7)), (Some(1), None));
    let schur = remaining.schur();
    let found = [
        schur.entry(0, 0),
        schur.entry(0, 1),
        schur.entry(1, 1),
        schur.row_sums()[0],
        schur.row_sums()[1],
    ];
    let lines = remaining.courses().map(|course| [course.line.gap, course.line.closing]);
    let lines: Vec<f64> = lines.flatten().collect();
    let expected = [2.0, 1.0, 1.5, 3.0, 2.5, 0.25, 0.75, 0.5, 0.5];
    for (found, expected) in found.iter().chain(&lines).zip(expected) {
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
    let mut remaining = remaining;
    // Node 9 after 1/3; node 8 rises by half of that rate then: 1/2 − t/2 + (3/4) (t − 1/3)/2.
    assert_eq!(remaining.play(9), None);
    assert_eq!(remaining.touched().collect::<Vec<_>>(), [9, 8]);
    Ok(())
}

/// Two nodes with C = (2, 1; 1, 2), gaps 0 and 1 and these hardnesses, of which none is in contact.
fn two(hardness: [f64; 2], horizon: f64) -> Result<Window, crate::Error> {
    let mut schur = Schur::default();
    schur.resize(2)?;
    schur.as_mut_slice().copy_from_slice(&[2.0, 1.0, f64::NAN, 2.0]);
    let watched = [0, 1].map(|k| Watched {
        node: 7 + k,
        is_elastic: false,
        hardness: hardness[k],
        line: test_chain::gap_line([k as f64, 1.0]),
        sums: [3.0, 0.0, 0.0],
    });
    let mut window = Window { schur, ..Window::default() };
    window.begin_both((0.0, horizon), &watched, 0);
    Ok(window)
}

const NOTHING: Rates = Rates { unit_stiffness: 0.0, closing: 2.0, plastic: [0.0; 2] };

/// (kind, place, time) of the events.
fn kinds(window: &Window) -> Vec<(ContactEvent, usize, f64)> {
    window.events().iter().map(|event| (event.kind, event.position, event.time)).collect()
}

/// Touch at 0, yield at 3/2, touch at 7/4, yield at 13/4. With one node elastic the other sinks half as fast as the
/// approach; with none all gaps close, and overlaps grow, as fast as that.
#[test]
fn both_kinds_of_events() -> Result<(), crate::Error> {
    use ContactEvent::{Touch, Yield};
    let expected = [
        (Touch, 0, 0.0, 0.5, 0.5, [0.0, 0.0]),
        (Yield, 0, 1.5, 0.0, 1.0, [1.0, 0.75]),
        (Touch, 1, 1.75, 0.5, 0.0, [0.5, 0.375]),
        (Yield, 1, 3.25, 0.0, 0.0, [2.0, 1.5]),
    ];
    for most in [4, 2, 9] {
        let mut window = two([0.75; 2], f64::INFINITY)?;
        assert_eq!(window.play(most), None);
        assert_eq!(window.events().len(), most.min(4));
        let rates = window.rates(NOTHING);
        for ((event, rates), (kind, position, time, unit, closing, plastic)) in
            window.events().iter().zip(rates).zip(expected)
        {
            assert_eq!((event.kind, event.position), (kind, position));
            let found = [event.time, rates.unit_stiffness, rates.closing];
            let found = found.into_iter().chain(rates.plastic);
            for (found, expected) in found.zip([time, unit, closing, plastic[0], plastic[1]]) {
                // A few rounding errors of numbers near 1.
                assert!((found - expected).abs() < 1e-14, "{kind:?}: {found} {expected}");
            }
        }
        if most < 4 {
            continue;
        }
        // Pressures are at the hardness. One has yielded by 7/4 − 3/4, and the other has only just; both overlap as
        // fast as the approach grows.
        let found = window.answers(usize::MAX, 3.25);
        let expected = [[0.75, 0.0], [1.0, 1.0], [0.75, 0.0], [0.0, 1.0]];
        for (found, expected) in found.iter().flatten().zip(expected.as_flattened()) {
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }
    Ok(())
}

/// Nodes 7 and 8 touch and yield in turn. Those to which nothing is left to have happened stay watched.
#[test]
fn what_is_taken_back_stays_watched() -> Result<(), crate::Error> {
    for (stand, watched) in [(4, &[][..]), (3, &[]), (2, &[8]), (1, &[8]), (0, &[7, 8])] {
        let mut window = two([0.75; 2], f64::INFINITY)?;
        assert_eq!(window.play(4), None);
        window.take_back(stand);
        assert_eq!(window.events().len(), stand);
        assert_eq!(window.untouched().collect::<Vec<_>>(), watched, "{stand}");
    }
    Ok(())
}

/// Until a horizon, though the first event always counts; not beyond so many that touch; and an infinite hardness is
/// never reached.
#[test]
fn windows_end() -> Result<(), crate::Error> {
    for (horizon, touches, events) in
        [(1.6, 2, 2), (-1.0, 2, 1), (f64::INFINITY, 1, 1), (f64::INFINITY, 0, 0)]
    {
        let mut window = two([0.75; 2], horizon)?;
        assert_eq!(window.play_touches(touches), None);
        assert_eq!(window.events().len(), events, "{horizon} {touches}");
    }
    let mut hard = two([f64::INFINITY; 2], f64::INFINITY)?;
    assert_eq!(hard.play(9), None);
    let [(ContactEvent::Touch, 0, first), (ContactEvent::Touch, 1, second)] = kinds(&hard)[..]
    else {
        unreachable!("two touch");
    };
    // A few rounding errors.
    assert!(first == 0.0 && (second - 2.0).abs() < 1e-14);
    Ok(())
}

/// Elastic nodes at equal pressures yield in the order of their indices, and the stiffness is what is left of their
/// rates.
#[test]
fn nodes_that_yield_at_once_are_in_order() -> Result<(), crate::Error> {
    let mut schur = Schur::default();
    schur.resize(2)?;
    // C⁻¹ = (2, −1; −1, 2)/3, of overlaps.
    schur.as_mut_slice().copy_from_slice(&[-2.0 / 3.0, 1.0 / 3.0, f64::NAN, -2.0 / 3.0]);
    let watched = [9, 4].map(|node| Watched {
        node,
        is_elastic: true,
        hardness: 1.0,
        line: test_chain::gap_line([0.5, -1.0 / 3.0]),
        sums: [0.0; SUMS],
    });
    let mut window = Window { schur, ..Window::default() };
    window.begin_both((1.0, f64::INFINITY), &watched, 2);
    assert_eq!(window.play_touches(0), None);
    assert!(window.events().is_empty());
    assert_eq!(window.play(9), None);
    assert_eq!(kinds(&window).iter().map(|event| event.1).collect::<Vec<_>>(), [1, 0]);
    assert!((kinds(&window)[0].2 - 1.5).abs() < 1e-15);
    // 2/3 of both, then 1/2 of one alone, then nothing.
    let rates = window.rates(Rates { unit_stiffness: 2.0 / 3.0, ..NOTHING });
    for (rates, expected) in rates.iter().zip([0.5, 0.0]) {
        assert!((rates.unit_stiffness - expected).abs() < 1e-15, "{rates:?}");
    }
    Ok(())
}

/// What remains of a window is one of its own: both nodes alone at 8/5, when node 7 has yielded and node 8 has been
/// found 1/16 away from the surface. It touches that much later, and yields 3/2 after that.
#[test]
fn what_remains_may_yield() -> Result<(), crate::Error> {
    use ContactEvent::{Touch, Yield};
    let mut window = two([0.75; 2], f64::INFINITY)?;
    for time in [0.0, 1.5] {
        assert_eq!(window.happen(0, time), Ok(()));
    }
    assert_eq!(kinds(&window), [(Touch, 0, 0.0), (Yield, 0, 1.5)]);
    let mut remaining = window.remaining(&[1], 1.625, &[0.0625])?;
    assert_eq!((remaining.nodes(), remaining.own_time(0)), (&[8][..], Some(0.0625)));
    // Moved back, all of it comes later.
    remaining.move_back(0.25);
    assert_eq!(remaining.own_time(0), Some(0.3125));
    assert_eq!(remaining.play(9), None);
    let events = kinds(&remaining);
    assert_eq!(events[0], (Touch, 0, 0.3125));
    // S of node 8 alone is 2, so that 3/4 take 3/2 of approach.
    assert!(events[1].0 == Yield && (events[1].2 - 1.8125).abs() < 1e-14, "{events:?}");
    Ok(())
}

/// Of what is elastic when it remains, the pressure is known: 1/2 of 3/4, which takes as much approach again as 2 ·
/// 1/4.
#[test]
fn what_remains_may_be_elastic() -> Result<(), crate::Error> {
    let mut window = two([0.75; 2], f64::INFINITY)?;
    assert_eq!(window.happen(0, 0.0), Ok(()));
    let mut remaining = window.remaining(&[0], 1.0, &[0.5])?;
    assert!(remaining.is_elastic(0));
    assert_eq!(remaining.play(9), None);
    let [(ContactEvent::Yield, 0, time)] = kinds(&remaining)[..] else {
        unreachable!("one yields");
    };
    assert!((time - 0.5).abs() < 1e-14, "{time}");
    Ok(())
}
