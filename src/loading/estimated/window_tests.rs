use std::sync::atomic::{AtomicU32, Ordering};

use super::*;
use crate::loading::test_chain::{self, Altered};
use crate::updater::Dense;

fn tolerances(tolerance: f64) -> WindowTolerances {
    test_chain::tolerances(1.0, tolerance, 1e-9)
}

/// A path with node 0 in contact at the approach 1, all scalars known, and the nodes out of contact ranked.
fn begun(gaps: &[f64]) -> Result<(LoadingRun, Refined), Error> {
    let mut run = test_chain::solved(gaps, &[0], 1.0)?;
    let mut refined = Refined::new(None, true);
    refined.survey(&mut run)?;
    Ok((run, refined))
}

#[test]
fn windows_have_their_sizes() {
    let size = |size, settles| Refined::new(size, settles).size;
    assert_eq!([size(None, true), size(None, false)], [60, 128]);
    assert_eq!([size(Some(3), true), size(Some(20), false)], [8, 20]);
}

#[test]
fn any_contradiction_is_one() {
    assert!(Contradictions::default().is_empty());
    let tension = Contradictions { tension: vec![1], ..Contradictions::default() };
    let overlap = Contradictions { overlap: vec![1], ..Contradictions::default() };
    let outside = Contradictions { outside: vec![(0.0, 1)], ..Contradictions::default() };
    assert!(![tension, overlap, outside].iter().any(Contradictions::is_empty));
}

/// Nodes 2, 4 and 6 are watched beside node 0 from the approach 1 on, and the first two join before 2. There gaps may overlap by
/// 100 · 10⁻⁵ · 2, and pressures times a compliance be as far below nothing.
#[test]
fn contradictions_at_the_end_are_found() -> Result<(), Error> {
    let far = 20.0;
    for (x, tension, overlap, outside) in
        [(1.9e-3, &[][..], &[][..], &[][..]), (2.1e-3, &[1], &[2], &[10, 8])]
    {
        let gaps =
            [0.0, far, 1.5, far, 2.0 + x, far, 2.0 - x, far, 2.0 - x, far, 2.0 - 1.04 * x, far];
        let mut run = test_chain::solved(&gaps, &[0], 1.0)?;
        let window = test_chain::apart(&[(2, 1.0), (4, 1.0), (6, 1.0)], 9.0);
        let mut refined = Refined::new(None, true);
        refined.last_span = 0.25;
        let found = refined.go_to_end(
            &mut run,
            &mut Altered::inexact(0.0),
            &tolerances(1e-5),
            &window,
            &[0, 1],
            1.0,
        )?;
        assert_eq!((&found.tension[..], &found.overlap[..]), (tension, overlap), "{x}");
        // At the rate 1; node 10 has overlapped for longer.
        let nodes: Vec<usize> = found.outside.iter().map(|(_, node)| *node).collect();
        assert_eq!(nodes, outside);
        for ((time, _), expected) in found.outside.iter().zip([-1.04 * x, -x]) {
            assert!((time - expected).abs() < 1e-13, "{time} {expected}");
        }
        assert_eq!((run.scalars.approach(), refined.rate_span), (2.0, 1.0));
        assert_eq!(run.contact.order(), [0, 2, 4]);
        assert!(run.field.belongs_to(&run.contact, 2.0));
    }
    Ok(())
}

/// A tension that is just what an overlap may go with is none: 100 · 2⁻¹² · 2, which is short in binary.
#[test]
fn what_is_allowed_is_no_contradiction() -> Result<(), Error> {
    let allowed = 200.0 / 4096.0;
    let mut run = test_chain::solved(&[0.0, 9.0, 2.0 + allowed, 9.0], &[0], 1.0)?;
    let window = test_chain::apart(&[(2, 1.0)], 9.0);
    let mut refined = Refined::new(None, true);
    let tolerance = 1.0 / 4096.0;
    let found = refined.go_to_end(
        &mut run,
        &mut Altered::inexact(0.0),
        &tolerances(tolerance),
        &window,
        &[0],
        1.0,
    )?;
    assert!(found.is_empty(), "{found:?}");
    Ok(())
}

/// Rates to 10⁻⁵ serve a tenth of a metre here; twice as far they have to be twice as exact, and no less than that is worth a
/// solution.
#[test]
fn rates_are_found_again_if_they_have_to_serve_much_further() -> Result<(), Error> {
    for (horizon, last, rate_span) in [
        (0.19, 9.0, 0.1),
        (0.21, 9.0, 0.21),
        // Without a horizon as far as the last node that touches.
        (f64::INFINITY, 0.19, 0.1),
        (f64::INFINITY, 0.21, 0.21),
        (f64::INFINITY, f64::INFINITY, 0.1),
    ] {
        let mut run = test_chain::solved(&[0.0, 9.0, 1.25, 9.0, 1.5, 9.0], &[0], 1.0)?;
        let mut refined = Refined::new(None, true);
        refined.rate_span = 0.1;
        let mut candidates = Candidates { nodes: vec![(0.05, 2), (last, 4)], horizon, group: None };
        let iterations = &mut Altered::inexact(0.0);
        refined.improve_rates(&mut run, iterations, &tolerances(1e-6), &mut candidates, &[])?;
        assert_eq!(refined.rate_span, rate_span, "{horizon} {last}");
        // Then nodes are chosen anew: all five.
        assert_eq!(candidates.nodes.len(), if rate_span > 0.1 { 5 } else { 2 });
    }
    Ok(())
}

/// Everything is known of the front after the beginning of a window, and found once.
#[test]
fn a_window_begins_with_a_solution() -> Result<(), Error> {
    let (mut run, mut iterations) =
        (test_chain::run(&[0.0, 9.0, 1.25, 9.0])?, Altered::inexact(0.0));
    run.contact.push(0)?;
    run.scalars.place_at(1.0);
    let mut refined = Refined::new(None, true);
    refined.begin(&mut run, &mut iterations)?;
    assert!(run.field.belongs_to(&run.contact, 1.0));
    assert_eq!(refined.rate_span, f64::INFINITY);
    assert_eq!(refined.ranked, Some((run.contact.revision(), 1.0)));
    let nodes: Vec<usize> = refined.ranking.iter().map(|(_, node)| *node).collect();
    assert_eq!(nodes, [1, 2, 3]);
    // What belongs to the front is left alone.
    refined.ranking.clear();
    refined.begin(&mut run, &mut iterations)?;
    assert!(refined.ranking.is_empty());
    run.scalars.place_at(1.1);
    refined.rate_span = 0.5;
    refined.begin(&mut run, &mut iterations)?;
    assert_eq!((refined.ranking.len(), refined.rate_span), (3, 0.5));
    Ok(())
}

/// Nodes 1 and 3 beside node 0, which carries 1/4 at the approach 1: gaps of 5 + 1/4 − 1 and 7 − 1 that close at 3/4 and 1, unless
/// the iterations know better. S = (4 − 1/4, 0; 0, 4), and row sums of 6 − 5/4 and 6.
#[test]
fn lines_and_complement_of_watched_nodes() -> Result<(), Error> {
    for (knows, lines) in [(false, [[4.25, 0.75], [6.0, 1.0]]), (true, [[4.5, 0.75], [6.5, 0.75]])]
    {
        let mut iterations = Altered::estimates(0.0, move |(_, displacements)| {
            if knows {
                displacements.fill([0.5, 0.25]);
            }
        });
        let mut run = test_chain::run(&[0.0, 5.0, 9.0, 7.0, 9.0])?;
        run.contact.push(0)?;
        run.scalars.place_at(1.0);
        run.advance_field(&mut iterations, 1.0, f64::INFINITY)?;
        let candidates = Candidates { nodes: vec![(2.0, 1), (3.0, 3)], horizon: 8.0, group: None };
        let found = Refined::new(None, true).propose(&mut run, &mut iterations, candidates, 5.0)?;
        assert_eq!((found.nodes(), found.horizon()), (&[1, 3][..], 5.0));
        let matrix = test_chain::matrix(&found);
        let found_lines = found.courses().map(|course| course.line);
        let found_lines = found_lines.flat_map(|line| [line.gap, line.closing]);
        let expected = lines.concat();
        let pairs = found_lines.zip(&expected);
        let pairs = pairs.chain(matrix.iter().copied().zip(&[3.75, 0.0, 0.0, 4.0]));
        let row_sums = found.schur().row_sums().iter().copied();
        for (found, expected) in pairs.chain(row_sums.zip(&[4.75, 6.0])) {
            // Rounding errors of a transform of numbers up to 9.
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
        assert_eq!(run.timings.windows, 1);
    }
    Ok(())
}

/// From the approach 1 on nodes 2 and 4 touch at 1.5 and 2.5; nothing else is near. The window ends behind the first of them, or
/// behind both, and their states wait.
#[test]
fn windows_are_gone_through() -> Result<(), Error> {
    for (most, nodes, end) in [(9, 2, 3.1), (1, 1, 2.0)] {
        let (mut run, mut refined) = begun(&[0.0, 9.0, 1.5, 9.0, 2.5, 9.0])?;
        let window = test_chain::apart(&[(4, 1.5), (2, 0.5)], 2.7);
        let iterations = &mut Altered::inexact(0.0);
        let ended = refined.follow(&mut run, iterations, &tolerances(1e-9), &window, most)?;
        assert!(matches!(ended, Outcome::Done));
        let found: Vec<_> = run.queue.iter().map(|state| (state.step, state.node.0)).collect();
        assert_eq!(found, [(2, 2), (3, 4)][..nodes]);
        // In the middle of 1.5 and 2.5, or of 2.5 and the horizon at 3.7.
        assert!((run.scalars.approach() - end).abs() < 1e-12);
        assert!((refined.last_span - (end - 1.0)).abs() < 1e-12);
        assert_eq!(run.contact.order(), &[0, 2, 4][..=nodes]);
        assert_eq!(refined.ranked, Some((run.contact.revision(), run.scalars.approach())));
        for (state, approach) in run.queue.iter().zip([1.5, 2.5]) {
            assert!((state.contact.approach - approach).abs() < 1e-12);
        }
    }
    Ok(())
}

/// Node 6, which is not watched, touches at 1.25: the window is not gone through, and says what overlapped
/// and how long it was.
#[test]
fn windows_with_overlap_outside_are_taken_back() -> Result<(), Error> {
    let (mut run, mut refined) = begun(&[0.0, 9.0, 1.5, 9.0, 2.5, 9.0, 1.25, 9.0])?;
    let window = test_chain::apart(&[(2, 0.5), (4, 1.5)], 1.0);
    let iterations = &mut Altered::inexact(0.0);
    let ended = refined.follow(&mut run, iterations, &tolerances(1e-9), &window, 9)?;
    // From 1 to the middle of 1.5 and 2.
    let Outcome::Overlap { outside, time } = ended else {
        unreachable!("node 6 overlaps");
    };
    assert!((time - 0.75).abs() < 1e-12);
    assert!(outside.len() == 1 && outside[0].1 == 6 && (outside[0].0 + 0.5).abs() < 1e-12);
    assert_eq!((run.contact.order(), run.scalars.approach()), (&[0][..], 1.0));
    assert!(run.queue.is_empty());
    Ok(())
}

/// Where nodes lift their neighbours towards the surface, a node between two in contact touches before the time at which it
/// would alone: node 1, of 1 m, is the tenth and not watched; at the end of the window, near 0.75 m, it overlaps. Once.
#[test]
fn what_overlapped_is_watched_then() -> Result<(), Error> {
    let coefficient =
        |di: isize, _: isize| [4.0, -1.0].get(di.unsigned_abs()).copied().unwrap_or(0.0);
    let kernel = crate::KernelTable::from_fn(
        crate::test_chain::grid(30)?,
        crate::Boundary::Free,
        crate::ContactGrowth::Monotone,
        coefficient,
    )?;
    let mut gaps = [5.0; 30];
    for k in 0..9 {
        gaps[2 * k] = 0.0625 * k as f64;
    }
    gaps[1] = 1.0;
    let surface = crate::test_chain::surface(&gaps)?;
    let builder = crate::LoadingSolver::builder(&surface, &kernel).updater(Dense);
    let mut run = builder.build()?.run;
    let mut refined = Refined::new(Some(8), true);
    refined.produce(&mut run, &mut Altered::inexact(1e-6), 30)?;
    assert_eq!((run.timings.taken_back, run.timings.windows), (1, 2));
    // Then the window is shorter, and ends before it touches.
    let found: Vec<_> = run.queue.iter().map(|state| state.node.0).collect();
    assert!(
        found.len() > 5 && found.iter().enumerate().all(|(k, node)| *node == 2 * k),
        "{found:?}"
    );
    assert!(run.scalars.approach() < 0.7, "{}", run.scalars.approach());
    Ok(())
}

/// From the approach 1 on a watched node, 4, is thought to touch after 0.6 m, which it does after 1.6 m; or after 3 m, which it
/// does after 0.8 m. At the window's end it is under tension, or overlaps: it leaves, or joins, and once that is done nothing is
/// contradicted.
#[test]
fn contacts_at_the_end_are_mended() -> Result<(), Error> {
    for (thought, gap, order) in [(0.6, 2.6, &[0, 2][..]), (3.0, 1.8, &[0, 2, 4])] {
        let mut run = test_chain::run(&[0.0, 9.0, 1.5, 9.0, gap, 9.0])?;
        let mut iterations = Altered::inexact(1e-6);
        run.contact.push(0)?;
        run.scalars.place_at(1.0);
        let mut refined = Refined::new(None, true);
        refined.begin(&mut run, &mut iterations)?;
        let window = test_chain::apart(&[(2, 0.5), (4, thought)], 1.4);
        let ended = refined.follow(&mut run, &mut iterations, &tolerances(1e-9), &window, 9)?;
        assert!(matches!(ended, Outcome::Done));
        assert_eq!((run.contact.order(), run.timings.taken_back), (order, 1));
        assert_eq!(run.queue.len(), order.len() - 1);
    }
    Ok(())
}

/// Node 1 touches at 10/3 beside node 0: its 2.5 m close at the rate 3/4. In some windows it seems to be 0.1 m away, and the window
/// ends a little further, without an event. Ten of them in a row are gone through; an eleventh is an error, and no end of the path.
#[test]
fn windows_without_events_are_gone_through() -> Result<(), Error> {
    for (wrong, fails) in [(0, false), (1, false), (10, false), (11, true)] {
        let windows = AtomicU32::new(0);
        let mut iterations = Altered::estimates(1e-6, move |(_, displacements)| {
            let window = windows.fetch_add(1, Ordering::Relaxed);
            if window < wrong {
                // From the middle of 0.1 and 0.105 to the next one.
                displacements.fill([0.1025 * f64::from(window) - 2.4, 0.0]);
            }
        });
        let mut run = test_chain::run(&[0.0, 2.5])?;
        run.contact.push(0)?;
        let found = Refined::new(None, true).produce(&mut run, &mut iterations, 2);
        if fails {
            assert!(matches!(found, Err(Error::NotMonotone { ix: 1, iy: 0, .. })), "{found:?}");
            continue;
        }
        found?;
        let states: Vec<_> = run.queue.iter().collect();
        assert_eq!((states.len(), states[0].node, states[0].step), (1, (1, 0), 2));
        let approach = states[0].contact.approach;
        assert!((approach - 10.0 / 3.0).abs() < 1e-6, "{wrong}: {approach}");
        // Node 0 bears a quarter of the approach on 2 m², and the work is half of their product.
        assert!((states[0].contact.energy - approach * approach / 4.0).abs() < 1e-5);
    }
    Ok(())
}

/// What was left out of pivots bounds the number of events, but one event there always is.
#[test]
fn windows_have_fewer_events_where_more_is_left_out() {
    let mut refined = Refined::new(None, true);
    for (left_out, most) in [(0.0, 9), (1e-3, 9), (0.0625, 3), (0.2, 1), (0.5, 1)] {
        refined.left_out = left_out;
        assert_eq!(refined.most_events().min(9), most, "{left_out}");
    }
}

/// The Schur complement says that no node acts on another one, and its pivots are twice what they are: at the end of a window of
/// three events two fifths of a pivot are taken off, which is too much for three. Nothing has happened then, and the next window has
/// one event.
#[test]
fn windows_that_leave_out_much_are_taken_back() -> Result<(), Error> {
    let gaps = [0.0, 9.0, 1.5, 9.0, 2.0, 9.0, 2.5, 9.0];
    let (mut run, mut refined) = begun(&gaps)?;
    let mut iterations = Altered::inexact(0.0);
    let mut window = test_chain::apart(&[(2, 0.5), (4, 1.0), (6, 1.5)], 3.0);
    window.schur_mut().matrix_mut().scale_mut(2.0);
    let ended = refined.follow(&mut run, &mut iterations, &tolerances(1e-9), &window, 9)?;
    assert!(matches!(ended, Outcome::TakenBack));
    assert_eq!((run.contact.order(), run.scalars.approach()), (&[0][..], 1.0));
    assert!(run.queue.is_empty());
    assert_eq!(refined.most_events(), 1);
    let ended = refined.follow(&mut run, &mut iterations, &tolerances(1e-9), &window, 9)?;
    assert!(matches!(ended, Outcome::Done) && run.contact.order() == [0, 2]);
    // A path counts them, and goes on.
    let (mut run, mut refined) = begun(&gaps)?;
    let mut iterations = Altered::estimates(1e-9, |(schur, _)| schur.matrix_mut().scale_mut(2.0));
    run.advance_field(&mut iterations, 1.0, 1.0)?;
    refined.produce(&mut run, &mut iterations, 8)?;
    assert_eq!((run.contact.order(), run.timings.taken_back), (&[0, 2][..], 1));
    Ok(())
}
