use super::*;
use crate::loading::test_chain;
use crate::updater::Dense;

fn scales(tolerance: f64) -> Scales {
    Scales {
        length: 1.0,
        tolerance,
        tie: 1e-9,
    }
}

#[test]
fn windows_have_their_sizes() {
    let size = |size, settles| Corrected::new(size, settles).size;
    assert_eq!([size(None, true), size(None, false)], [60, 128]);
    assert_eq!([size(Some(3), true), size(Some(20), false)], [8, 20]);
}

#[test]
fn any_contradiction_is_one() {
    assert!(Contradictions::default().is_empty());
    let tension = Contradictions {
        tension: vec![1],
        ..Contradictions::default()
    };
    let overlap = Contradictions {
        overlap: vec![1],
        ..Contradictions::default()
    };
    let outside = Contradictions {
        outside: vec![(0.0, 1)],
        ..Contradictions::default()
    };
    assert!(
        ![tension, overlap, outside]
            .iter()
            .any(Contradictions::is_empty)
    );
}

/// Nodes 2, 4 and 6 are watched beside node 0 from the approach 1 on, and the first two join before 2. There gaps may overlap by
/// 100 · 10⁻⁵ · 2, and pressures times a compliance be as far below nothing.
#[test]
fn contradictions_at_the_end_are_found() -> Result<(), Error> {
    let far = 20.0;
    for (x, tension, overlap, outside) in [
        (1.9e-3, &[][..], &[][..], &[][..]),
        (2.1e-3, &[1], &[2], &[10, 8]),
    ] {
        let gaps = [
            0.0,
            far,
            1.5,
            far,
            2.0 + x,
            far,
            2.0 - x,
            far,
            2.0 - x,
            far,
            2.0 - 1.04 * x,
            far,
        ];
        let mut run = test_chain::solved(&gaps, &[0], 1.0)?;
        let watched = Watched {
            nodes: vec![2, 4, 6],
            lines: vec![[1.0; 2]; 3],
            schur: DMatrix::from_diagonal_element(3, 3, 4.0),
            row_sums: vec![6.0; 3],
            horizon: 9.0,
        };
        let mut corrected = Corrected::new(None, true);
        corrected.last_span = 0.25;
        let found = corrected.go_to_end(&mut run, &scales(1e-5), &watched, &[0, 1], 1.0)?;
        assert_eq!(
            (&found.tension[..], &found.overlap[..]),
            (tension, overlap),
            "{x}"
        );
        // At the rate 1; node 10 has overlapped for longer.
        let nodes: Vec<usize> = found.outside.iter().map(|(_, node)| *node).collect();
        assert_eq!(nodes, outside);
        for ((time, _), expected) in found.outside.iter().zip([-1.04 * x, -x]) {
            assert!((time - expected).abs() < 1e-13, "{time} {expected}");
        }
        assert_eq!((run.front.approach(), corrected.rate_span), (2.0, 1.0));
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
    let watched = Watched {
        nodes: vec![2],
        lines: vec![[1.0; 2]],
        schur: DMatrix::from_diagonal_element(1, 1, 4.0),
        row_sums: vec![6.0],
        horizon: 9.0,
    };
    let mut corrected = Corrected::new(None, true);
    let tolerance = 1.0 / 4096.0;
    let found = corrected.go_to_end(&mut run, &scales(tolerance), &watched, &[0], 1.0)?;
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
        let mut corrected = Corrected::new(None, true);
        corrected.rate_span = 0.1;
        let mut choice = Choice {
            watched: vec![(0.05, 2), (last, 4)],
            horizon,
            group: None,
        };
        corrected.refine(&mut run, &scales(1e-6), &mut choice, &[])?;
        assert_eq!(corrected.rate_span, rate_span, "{horizon} {last}");
        // Then nodes are chosen anew: all five.
        assert_eq!(choice.watched.len(), if rate_span > 0.1 { 5 } else { 2 });
    }
    Ok(())
}

/// Everything is known of the front after the beginning of a window, and found once.
#[test]
fn a_window_begins_with_a_solution() -> Result<(), Error> {
    let mut run = test_chain::run(&[0.0, 9.0, 1.25, 9.0], Dense)?;
    run.contact.push(0)?;
    run.front.place_at(1.0);
    let mut corrected = Corrected::new(None, true);
    corrected.begin(&mut run)?;
    assert!(run.field.belongs_to(&run.contact, 1.0));
    assert_eq!(corrected.rate_span, f64::INFINITY);
    assert_eq!(corrected.ranked, Some((run.contact.revision(), 1.0)));
    let nodes: Vec<usize> = corrected.ranking.iter().map(|(_, node)| *node).collect();
    assert_eq!(nodes, [1, 2, 3]);
    // What belongs to the front is left alone.
    corrected.ranking.clear();
    corrected.begin(&mut run)?;
    assert!(corrected.ranking.is_empty());
    run.front.place_at(1.1);
    corrected.rate_span = 0.5;
    corrected.begin(&mut run)?;
    assert_eq!((corrected.ranking.len(), corrected.rate_span), (3, 0.5));
    Ok(())
}

/// A dense updater that may know displacements of watched nodes better: 1/2, and 1/4 of rates.
fn knowing(knows: bool) -> test_chain::Altered {
    test_chain::Altered::complements(move |schur| {
        if knows {
            schur.set_displacements(vec![[0.5, 0.25]; schur.size()]);
        }
    })
}

/// Nodes 1 and 3 beside node 0, which carries 1/4 at the approach 1: gaps of 5 + 1/4 − 1 and 7 − 1 that close at 3/4 and 1, unless
/// the updater knows better. S = (4 − 1/4, 0; 0, 4), and row sums of 6 − 5/4 and 6.
#[test]
fn lines_and_complement_of_watched_nodes() -> Result<(), Error> {
    for (knows, lines) in [
        (false, [[4.25, 0.75], [6.0, 1.0]]),
        (true, [[4.5, 0.75], [6.5, 0.75]]),
    ] {
        let mut run = test_chain::run(&[0.0, 5.0, 9.0, 7.0, 9.0], knowing(knows))?;
        run.contact.push(0)?;
        run.front.place_at(1.0);
        run.solve_field(1.0, f64::INFINITY)?;
        let choice = Choice {
            watched: vec![(2.0, 1), (3.0, 3)],
            horizon: 8.0,
            group: None,
        };
        let found = Corrected::new(None, true).watch(&mut run, choice, 5.0)?;
        assert_eq!((&found.nodes[..], found.horizon), (&[1, 3][..], 5.0));
        let matrix = [3.75, 0.0, 0.0, 4.0];
        let pairs = found.lines.iter().flatten().zip(lines.iter().flatten());
        let pairs = pairs.chain(found.schur.iter().zip(&matrix));
        for (found, expected) in pairs.chain(found.row_sums.iter().zip(&[4.75, 6.0])) {
            // Roundings of a transform of numbers up to 9.
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
        let mut run = test_chain::solved(&[0.0, 9.0, 1.5, 9.0, 2.5, 9.0], &[0], 1.0)?;
        run.front.renew_load(&run.problem, &run.contact, &run.field);
        let mut corrected = Corrected::new(None, true);
        corrected.survey(&mut run)?;
        let watched = Watched {
            nodes: vec![4, 2],
            lines: vec![[1.5, 1.0], [0.5, 1.0]],
            schur: DMatrix::from_diagonal_element(2, 2, 4.0),
            row_sums: vec![6.0; 2],
            horizon: 2.7,
        };
        let advanced = corrected.advance(&mut run, &scales(1e-9), &watched, most)?;
        assert!(advanced.is_ok());
        let found: Vec<_> = run
            .queue
            .iter()
            .map(|state| (state.step, state.node.0))
            .collect();
        assert_eq!(found, [(2, 2), (3, 4)][..nodes]);
        // In the middle of 1.5 and 2.5, or of 2.5 and the horizon at 3.7.
        assert!((run.front.approach() - end).abs() < 1e-12);
        assert!((corrected.last_span - (end - 1.0)).abs() < 1e-12);
        assert_eq!(run.contact.order(), &[0, 2, 4][..=nodes]);
        assert_eq!(
            corrected.ranked,
            Some((run.contact.revision(), run.front.approach()))
        );
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
    let mut run = test_chain::solved(&[0.0, 9.0, 1.5, 9.0, 2.5, 9.0, 1.25, 9.0], &[0], 1.0)?;
    run.front.renew_load(&run.problem, &run.contact, &run.field);
    let mut corrected = Corrected::new(None, true);
    corrected.survey(&mut run)?;
    let watched = Watched {
        nodes: vec![2, 4],
        lines: vec![[0.5, 1.0], [1.5, 1.0]],
        schur: DMatrix::from_diagonal_element(2, 2, 4.0),
        row_sums: vec![6.0; 2],
        horizon: 1.0,
    };
    let advanced = corrected.advance(&mut run, &scales(1e-9), &watched, 9)?;
    // From 1 to the middle of 1.5 and 2.
    let Err((outside, time)) = advanced else {
        unreachable!("node 6 overlaps");
    };
    assert!((time - 0.75).abs() < 1e-12);
    assert!(outside.len() == 1 && outside[0].1 == 6 && (outside[0].0 + 0.5).abs() < 1e-12);
    assert_eq!((run.contact.order(), run.front.approach()), (&[0][..], 1.0));
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
    let builder = crate::LoadingSolver::builder(&surface, &kernel)
        .updater(test_chain::Altered::inexact(1e-6));
    let mut run = builder.build()?.run;
    let mut corrected = Corrected::new(Some(8), true);
    assert!(corrected.produce(&mut run, 30)?.is_none());
    assert_eq!((run.timings.taken_back, run.timings.windows), (1, 2));
    // Then the window is shorter, and ends before it touches.
    let found: Vec<_> = run.queue.iter().map(|state| state.node.0).collect();
    assert!(
        found.len() > 5 && found.iter().enumerate().all(|(k, node)| *node == 2 * k),
        "{found:?}"
    );
    assert!(run.front.approach() < 0.7, "{}", run.front.approach());
    Ok(())
}

/// From the approach 1 on a watched node, 4, is thought to touch after 0.6 m, which it does after 1.6 m; or after 3 m, which it
/// does after 0.8 m. At the window's end it is under tension, or overlaps: it leaves, or joins, and once that is done nothing is
/// contradicted.
#[test]
fn contacts_at_the_end_are_mended() -> Result<(), Error> {
    for (thought, gap, order) in [(0.6, 2.6, &[0, 2][..]), (3.0, 1.8, &[0, 2, 4])] {
        let mut run = test_chain::run(
            &[0.0, 9.0, 1.5, 9.0, gap, 9.0],
            test_chain::Altered::inexact(1e-6),
        )?;
        run.contact.push(0)?;
        run.front.place_at(1.0);
        let mut corrected = Corrected::new(None, true);
        corrected.begin(&mut run)?;
        let watched = Watched {
            nodes: vec![2, 4],
            lines: vec![[0.5, 1.0], [thought, 1.0]],
            schur: DMatrix::from_diagonal_element(2, 2, 4.0),
            row_sums: vec![6.0; 2],
            horizon: 1.4,
        };
        let advanced = corrected.advance(&mut run, &scales(1e-9), &watched, 9)?;
        assert!(advanced.is_ok());
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
        let windows = std::cell::Cell::new(0);
        let updater = test_chain::Altered::estimates(1e-6, move |schur| {
            let window = windows.replace(windows.get() + 1);
            if window < wrong {
                // From the middle of 0.1 and 0.105 to the next one.
                let approach = 0.1025 * f64::from(window);
                schur.set_displacements(vec![[approach - 2.4, 0.0]; schur.size()]);
            }
        });
        let mut run = test_chain::run(&[0.0, 2.5], updater)?;
        run.contact.push(0)?;
        let found = Corrected::new(None, true).produce(&mut run, 2);
        if fails {
            assert!(
                matches!(found, Err(Error::NotMonotone { ix: 1, iy: 0, .. })),
                "{found:?}"
            );
            continue;
        }
        assert!(found?.is_none());
        let states: Vec<_> = run.queue.iter().collect();
        assert_eq!(
            (states.len(), states[0].node, states[0].step),
            (1, (1, 0), 2)
        );
        let approach = states[0].contact.approach;
        assert!((approach - 10.0 / 3.0).abs() < 1e-6, "{wrong}: {approach}");
        // Node 0 bears a quarter of the approach on 2 m², and the work is half of their product.
        assert!((states[0].contact.energy - approach * approach / 4.0).abs() < 1e-5);
    }
    Ok(())
}

/// Watched nodes 2, 4, 6 and 8 touch half a metre after each other from 1.5 on. What was left out of pivots bounds the number of events,
/// but one event there always is, and ties stay together.
#[test]
fn windows_have_fewer_events_where_more_is_left_out() -> Result<(), Error> {
    let mut corrected = Corrected::new(None, true);
    for (left_out, most) in [(0.0, 9), (1e-3, 9), (0.0625, 3), (0.2, 1), (0.5, 1)] {
        corrected.left_out = left_out;
        assert_eq!(corrected.most_events().min(9), most, "{left_out}");
    }
    let events = [0.5, 1.0, 1.0 + 1e-10, 2.0].map(|time| Played { position: 0, time });
    for (most, kept) in [(0, 1), (1, 1), (2, 3), (3, 3), (4, 4), (9, 4)] {
        assert_eq!(with_ties(&events, most, &scales(0.0)), kept, "{most}");
    }
    Ok(())
}

/// The Schur complement says that no node acts on another one, and its pivots are twice what they are: at the end of a window of
/// three events two fifths of a pivot are taken off, which is too much for three. Nothing has happened then, and the next window has
/// one event.
#[test]
fn windows_that_leave_out_much_are_taken_back() -> Result<(), Error> {
    let gaps = [0.0, 9.0, 1.5, 9.0, 2.0, 9.0, 2.5, 9.0];
    let mut run = test_chain::solved(&gaps, &[0], 1.0)?;
    run.front.renew_load(&run.problem, &run.contact, &run.field);
    let mut corrected = Corrected::new(None, true);
    corrected.survey(&mut run)?;
    let watched = Watched {
        nodes: vec![2, 4, 6],
        lines: vec![[0.5, 1.0], [1.0, 1.0], [1.5, 1.0]],
        schur: DMatrix::from_diagonal_element(3, 3, 8.0),
        row_sums: vec![6.0; 3],
        horizon: 3.0,
    };
    let advanced = corrected.advance(&mut run, &scales(1e-9), &watched, 9)?;
    assert!(matches!(advanced, Err((outside, f64::INFINITY)) if outside.is_empty()));
    assert_eq!((run.contact.order(), run.front.approach()), (&[0][..], 1.0));
    assert!(run.queue.is_empty() && run.timings.taken_back == 1);
    assert_eq!(corrected.most_events(), 1);
    let advanced = corrected.advance(&mut run, &scales(1e-9), &watched, 9)?;
    assert!(advanced.is_ok() && run.contact.order() == [0, 2]);
    Ok(())
}
