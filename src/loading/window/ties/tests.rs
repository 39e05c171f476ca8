mod settling;

use nalgebra::DMatrix;

use super::*;
use crate::loading::test_chain::{self, course, events, pairs, tolerances};

/// Nodes that do not act on each other, with `[gap, closing]` of each.
fn alone(nodes: &[usize], lines: &[[f64; 2]]) -> Window {
    let lines: Vec<_> = nodes.iter().copied().zip(lines.iter().copied()).collect();
    let size = lines.len();
    let matrix = DMatrix::identity(size, size);
    test_chain::window(&lines, &matrix, &vec![0.0; size], f64::INFINITY)
}

/// A correction that found another Schur complement.
fn correction(window: &Window, matrix: &DMatrix<f64>) -> Correction {
    let mut window = window.clone();
    window.schur_mut().matrix_mut().copy_from(matrix);
    Correction { by_courses: window.clone(), window, is_updated: true }
}

fn close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        // Rounding errors of a few operations, and of a transform where gaps come from one.
        assert!((found - expected).abs() < 1e-13, "{found} {expected}");
    }
}

/// Five nodes in a window that ends at 4: two that the corrections and the first pass know at other times, one at the
/// very end, one behind it, and one that did not join.
#[test]
fn errors_are_what_the_passes_differ_by() {
    let closing = [[9.0, 0.5], [9.0, 0.25], [9.0, 1.0], [9.0, 1.0], [9.0, 1.0]];
    let window = alone(&[10, 11, 12, 13, 14], &closing);
    let of = |times: [f64; 5]| {
        let lines = times.into_iter().zip(closing);
        lines.map(|(time, [_, rate])| course([rate * time, rate, 0.0, 0.0]))
    };
    let first = events(&[(0, 1.0), (1, 2.0), (2, 4.0), (3, 4.5)]);
    let mut correction = correction(&window, &DMatrix::identity(5, 5));
    correction.window.set_courses(of([1.25, 3.5, 4.0, 4.5, 3.0]));
    correction.by_courses.set_courses(of([1.25, 3.0, 4.0, 4.5, 3.0]));
    let settled = second_pass(&correction, &first, 4.0);
    // What has not touched by the end is put there.
    let expected = [(0, 1.25), (1, 3.5), (2, 4.0), (3, 4.0)];
    assert_eq!(pairs(&settled.events), expected);
    // Changes of 0.25, 1.5, 0 and 0.5: a tenth of that and of their mean of 0.5625. Corrections differ by 0, 0.5 and 0,
    // which counts twice, and of the last the other knows nothing: twice the window. To that 5e-7 of time over rate.
    let rates = [1.25 / 0.5, 3.5 / 0.25, 4.0, 4.0].map(|time| 5e-7 * time);
    let of_rates = |errors: [f64; 4]| [0, 1, 2, 3].map(|k| errors[k] + rates[k]);
    close(&settled.errors, &of_rates([0.081_25, 1.0, 0.056_25, 8.0]));
    // Half of the changes.
    correction.is_updated = false;
    let settled = second_pass(&correction, &first, 4.0);
    close(&settled.errors, &of_rates([0.406_25, 1.031_25, 0.281_25, 8.0]));
    // Where all agree, a thousandth of the mean spacing: 4 over 2.
    let same = events(&[(0, 1.25), (1, 3.0)]);
    correction.window = correction.by_courses.clone();
    let settled = second_pass(&correction, &same, 4.0);
    let rates = [1.25 / 0.5, 3.0 / 0.25].map(|time| 5e-7 * time);
    close(&settled.errors, &[0.002 + rates[0], 0.002 + rates[1]]);
}

/// Events with errors in a corrected window that began at the approach 1 with one node in contact.
fn ties<'a>(
    window: &'a Window,
    tolerances: &'a WindowTolerances,
    pairs: &[(usize, f64)],
    errors: &[f64],
) -> Ties<'a> {
    let beginning = Beginning { approach: 1.0, count: 1, is_certain: false };
    let settled = Settled { events: events(pairs), errors: errors.to_vec() };
    Ties { window, tolerances, beginning, settled, asked: None }
}

/// What `check` finds of events of nodes 9, 8, 7 … with errors.
fn with_ties<T>(
    events: &[(usize, f64)],
    errors: &[f64],
    lines: &[[f64; 2]],
    tolerances: WindowTolerances,
    check: impl FnOnce(Ties<'_>) -> T,
) -> T {
    let nodes: Vec<usize> = (0..lines.len()).map(|k| 9 - k).collect();
    let window = alone(&nodes, lines);
    check(ties(&window, &tolerances, events, errors))
}

#[test]
fn neighbours_are_close_within_their_errors() {
    let events = [(0, 1.0), (1, 2.0), (2, 3.0), (3, 4.0), (4, 6.0)];
    // 1 is no less than 0.5 + 0.5, but less than 0.5 + 0.75 and 0.75 + 0.5; 2 is not.
    let errors = [0.5, 0.5, 0.75, 0.5, 0.5];
    // A poor error would be one above a thousandth of 1 + t: make all of them poor but the first two.
    let tolerances = tolerances(1.0, 0.0, 1e-9);
    with_ties(&events, &errors, &[[1.0; 2]; 5], tolerances, |mut ties| {
        let found = [0, 1, 2, 3, 4].map(|event| ties.is_close(event));
        assert_eq!(found, [false, true, true, false, false]);
        let runs = [0, 1, 2, 3, 4].map(|event| ties.run_from(event));
        assert_eq!(runs, [Some(0), Some(3), Some(3), Some(3), Some(4)]);
        // 2 mm are a thousandth of 1 + 1 m.
        for (error, poor) in [(1.9e-3, false), (POOR * 2.0, false), (2.1e-3, true)] {
            ties.settled.errors[0] = error;
            assert_eq!(ties.is_poor(0), poor, "{error}");
            assert_eq!(ties.run_from(0), poor.then_some(0));
        }
    });
}

/// The same gap, closing rate and time: within 20 · 10⁻¹⁰ · 2, within 2·10⁻⁵ of the rate, and within a tie or both
/// errors, but no more than the way on which such a gap closes.
#[test]
fn nodes_that_symmetry_maps_are_told_by_their_lines() {
    let good = [1e-4; 2];
    let found = |second: [f64; 2], time: f64, errors: [f64; 2]| {
        let (events, lines) = ([(0, 1.0), (1, time)], [[1.0, 1.0], second]);
        let tolerances = tolerances(2.0, 1e-10, 0.25);
        with_ties(&events, &errors, &lines, tolerances, |ties| {
            let images = ties.are_images(0, 1);
            assert_eq!(images, ties.are_images(1, 0));
            images
        })
    };
    for (a, b, images) in [
        (0.0, 0.0, true),
        (3.9e-9, 0.0, true),
        (-3.9e-9, 0.0, true),
        (4.1e-9, 0.0, false),
        (-4.1e-9, 0.0, false),
        (0.0, 1.9e-5, true),
        (0.0, -1.9e-5, true),
        (0.0, 2.1e-5, false),
        (0.0, -2.1e-5, false),
    ] {
        let second = [1.0 + a, 1.0 + b];
        assert_eq!(found(second, 1.0, good), images, "{a} {b}");
    }
    assert!(found([1.0, 1.0], 1.25, good) && !found([1.0, 1.0], 1.3, good));
    // A fifth of the length, over the rate.
    let far = |length: f64, error: f64| {
        let (events, lines) = ([(0, 1.0), (1, 1.3)], [[1.0, 0.5]; 2]);
        let tolerances = tolerances(length, 1e-2, 1e-9);
        with_ties(&events, &[error, 0.15], &lines, tolerances, |ties| ties.are_images(0, 1))
    };
    assert!(far(1.0, 0.16) && !far(1.0, 0.14) && !far(0.7, 0.16));
}

/// Before first touch all lines have one rate, and only ties are images; and pivots differ by 10⁻⁴ at most.
#[test]
fn images_give_way_alike() {
    let (events, errors) = ([(0, 1.0), (1, 1.3)], [0.2; 2]);
    let (window, tolerances) = (alone(&[9, 8], &[[1.0; 2]; 2]), tolerances(2.0, 1e-2, 1e-9));
    for (pivot, images) in [(1.0, true), (1.0 + 9.9e-5, true), (1.0 + 1.1e-4, false)] {
        let matrix = DMatrix::from_diagonal(&nalgebra::dvector![1.0, pivot]);
        let correction = correction(&window, &matrix);
        let mut ties = ties(&correction.window, &tolerances, &events, &errors);
        assert_eq!(ties.are_images(0, 1), images, "{pivot}");
        ties.beginning.count = 0;
        assert!(!ties.are_images(0, 1));
    }
}

#[test]
fn rates_of_gaps_that_hardly_close_are_compared_with_a_thousandth() {
    for (other, images) in [(1e-6 + 1.9e-8, true), (1e-6 + 2.1e-8, false)] {
        let lines = [[1.0, 1e-6], [1.0, other]];
        let (events, tolerances) = ([(0, 1.0), (1, 1.0)], tolerances(2.0, 1e-10, 0.25));
        let found = with_ties(&events, &[0.0; 2], &lines, tolerances, |ties| ties.are_images(0, 1));
        assert_eq!(found, images, "{other:e}");
    }
}

/// An orbit has more than one event, all at one time, and no error above a thousandth of the approach, 2.
#[test]
fn orbits_are_images_at_one_time() {
    let found = |times: [f64; 3], errors: [f64; 3], last: usize| {
        let (events, lines) = ([0, 1, 2].map(|k| (k, times[k])), [[1.0; 2]; 3]);
        let tolerances = tolerances(2.0, 1e-10, 0.25);
        with_ties(&events, &errors, &lines, tolerances, |ties| ties.is_orbit(0, last))
    };
    let good = [1e-4; 3];
    assert!(found([1.0; 3], good, 2) && found([1.0, 1.0, 1.1], good, 1));
    assert!(!found([1.0; 3], good, 0) && !found([1.0, 1.0, 1.1], good, 2));
    for poor in 0..3 {
        let mut errors = good;
        errors[poor] = 3e-3;
        assert!(!found([1.0; 3], errors, 2), "{poor}");
    }
}

/// Nodes 9, 8 and 7 have one line, and touch within their errors at 7.5 / 3; nodes 6 and 5 have another one, and are
/// too far from each other.
#[test]
fn orbits_touch_at_their_mean_time() {
    let events = [(4, 0.5), (0, 2.0), (2, 2.25), (1, 3.25), (3, 9.0)];
    let lines = [[1.0; 2], [1.0; 2], [1.0; 2], [2.0; 2], [2.0; 2]];
    let errors = [0.5, 1.0, 0.75, 0.5, 0.25];
    let tolerances = tolerances(1.0, 0.1, 1e-9);
    with_ties(&events, &errors, &lines, tolerances, |mut ties| {
        ties.make_orbits_equal(0..5);
        let expected = [(4, 0.5), (2, 2.5), (1, 2.5), (0, 2.5), (3, 9.0)];
        assert_eq!(pairs(&ties.settled.events), expected);
        assert_eq!(ties.settled.errors, [0.5, 1.0, 1.0, 1.0, 0.25]);
    });
}

/// Ten times its error and a tie from where it was expected: 1.25.
#[test]
fn solutions_far_from_what_was_expected_contradict() {
    let pairs = [(0, 1.0), (1, 2.0)];
    let tolerances = tolerances(1.0, 0.0, 0.025);
    with_ties(&pairs, &[0.1; 2], &[[1.0; 2]; 2], tolerances, |ties| {
        for (time, contradicted) in [(3.24, false), (3.26, true), (0.76, false), (0.74, true)] {
            let found = events(&[(1, time), (0, 1.0)]);
            assert!(!ties.is_contradicted(0, &found));
            assert_eq!(ties.is_contradicted(1, &found), contradicted, "{time}");
        }
    });
}

#[test]
fn ties_come_in_the_order_of_their_nodes() {
    // 0.2 apart one after the other, then by a tie, which is none.
    let mut events = events(&[(0, 1.0), (2, 1.2), (1, 1.4), (4, 2.0), (3, 2.25)]);
    let tolerances = tolerances(1.0, 0.0, 0.25);
    with_ties(&[], &[], &[[1.0; 2]; 5], tolerances, |ties| {
        ties.order_ties(&mut events);
    });
    let expected = [(2, 1.0), (1, 1.0), (0, 1.0), (4, 2.0), (3, 2.25)];
    assert_eq!(pairs(&events), expected);
}

/// A twenty-fifth of the least error, 0.001 25, times the least rate, 0.5; of a thousandth of the approach, 1 + 2,
/// where all errors are greater; none if that was not enough.
#[test]
fn solutions_are_as_exact_as_errors_ask() {
    let events = [(0, 1.0), (1, 2.0), (2, 3.0), (3, 4.0)];
    let lines = [[1.0, 0.1], [1.0, 0.75], [1.0, 0.5], [1.0, 0.1]];
    let tolerances = tolerances(1.0, 0.0, 1e-9);
    for (errors, sufficient) in
        [([1e-4, 0.002_5, 0.001_25, 1e-4], 2.5e-5), ([0.01, 0.25, 0.125, 0.01], 6e-5)]
    {
        with_ties(&events, &errors, &lines, tolerances, |mut ties| {
            close(&[ties.sufficient_error(1, 2)], &[sufficient]);
            ties.asked = Some(2);
            close(&[ties.sufficient_error(1, 2)], &[sufficient]);
            ties.asked = Some(1);
            assert_eq!(ties.sufficient_error(1, 2), 0.0);
        });
    }
}

/// `(4, 2, 1; 2, 4, 1; 1, 1, 4)` without its first node: 4 − 1, 1 − 1/2, 4 − 1/4; and at the time 2, at which the first
/// closes at the rate 1 − 2 · 2/8, the others at 1 − 1/2 · 1/2 and 2 − 1/4 · 1/2.
#[test]
fn events_before_are_eliminated() -> Result<(), Error> {
    let mut window = alone(&[7, 8, 9], &[[1.0; 2]; 3]);
    let courses = [[1.0, 1.0, 0.125, 0.0], [1.0, 1.0, 0.0, 0.0], [1.0, 2.0, 0.0, 0.0]];
    window.set_courses(courses.map(course).into_iter());
    let mut matrix = DMatrix::from_row_slice(3, 3, &[4.0, 2.0, 1.0, 2.0, 4.0, 1.0, 1.0, 1.0, 4.0]);
    let found = correction(&window, &matrix);
    matrix[(0, 0)] = -1.0;
    let without = correction(&window, &matrix);
    let (pairs, tolerances) = ([(0, 1.0), (1, 2.0), (2, 2.5)], tolerances(1.0, 0.0, 1e-9));
    let eliminated = |correction: &Correction, first, positions: &[usize]| {
        let ties = ties(&correction.window, &tolerances, &pairs, &[0.0; 3]);
        ties.eliminated(first, positions, &[0.25, 0.75])
    };
    let check = |found: Option<Window>, expected: &[f64]| {
        let found = found.unwrap_or_default();
        let lines = found.courses().map(|course| course.line);
        assert!(lines.clone().map(|line| line.gap).eq([0.25, 0.75]));
        let closing: Vec<f64> = lines.map(|line| line.closing).collect();
        close(&[test_chain::matrix(&found).as_slice(), &closing].concat(), expected);
    };
    check(eliminated(&found, 1, &[1, 2])?, &[3.0, 0.5, 0.5, 3.75, 0.75, 1.875]);
    // With no event before nothing is: at the time 1 the first closes at 1 − 2/8.
    check(eliminated(&found, 0, &[0, 1])?, &[4.0, 2.0, 2.0, 4.0, 0.75, 1.0]);
    // No factor.
    assert!(eliminated(&without, 1, &[1, 2])?.is_none());
    Ok(())
}
