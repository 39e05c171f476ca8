use super::*;
use crate::loading::state::ContactEvent;
use crate::loading::test_chain::{self, Altered};
use crate::updater::Dense;

fn tolerances(tolerance: f64) -> WindowTolerances {
    test_chain::tolerances(1.0, tolerance, 1e-9)
}

/// A path with node 0 in contact at the approach 1, all scalars known, and the nodes out of contact ranked.
fn begun(gaps: &[f64]) -> Result<(LoadingRun, Estimated), Error> {
    let mut run = test_chain::solved(gaps, &[0], 1.0)?;
    let mut estimated = Estimated::new(None, true);
    estimated.survey(&mut run, &tolerances(1e-9))?;
    Ok((run, estimated))
}

#[test]
fn windows_have_their_sizes() {
    let size = |size, settles| Estimated::new(size, settles).size;
    assert_eq!([size(None, true), size(None, false)], [60, 128]);
    assert_eq!([size(Some(3), true), size(Some(20), false)], [8, 20]);
}

/// Nodes 2, 4 and 6 are watched beside node 0 from the approach 1 on, and the first two join before 2. There gaps may
/// overlap by 100 · 10⁻⁵ · 2, and pressures times a compliance be a multiple of that below nothing.
#[test]
fn contradictions_at_the_end_are_found() -> Result<(), Error> {
    let far = 20.0;
    // The node that is off, by how much, and how much earlier it was not, if it is contradicted.
    for (node, x, until) in [
        (6, 1.9e-3, None),
        (6, 2.1e-3, Some(-2.1e-3)),
        (10, 2.1e-3, Some(-2.1e-3)),
        (4, -1.9e-3 * OF_RESIDUAL, None),
        // A tension may have been there from the beginning.
        (4, -2.1e-3 * OF_RESIDUAL, Some(f64::NEG_INFINITY)),
    ] {
        let mut gaps = [0.0, far, 1.5, far, 1.5, far, far, far, far, far, far, far];
        gaps[node] = 2.0 - x;
        let mut run = test_chain::solved(&gaps, &[0], 1.0)?;
        let events = [(2, ContactEvent::Touch), (4, ContactEvent::Touch)];
        let trial = Trial::of(&run, &events)?;
        go_to(&mut run, &mut Altered::inexact(0.0), &trial, (2.0, 1.0))?;
        let at = (1.0, false);
        let found = Estimated::contradicted(&run, &trial, &tolerances(1e-5), None, at);
        match (found, until) {
            (Some(found), Some(until)) if until.is_finite() => {
                assert!((found - until).abs() < 1e-13, "{node}: {found} {until}");
            }
            _ => assert_eq!(found, until, "{node} {x}"),
        }
        assert_eq!((run.contact.order(), run.scalars.approach()), (&[0][..], 1.0));
        assert_eq!(trial.contact.order(), [0, 2, 4]);
    }
    Ok(())
}

/// Rates that serve as far as the last event are left alone; where they have to serve more than twice as far, they have
/// to be more than twice as exact.
#[test]
fn rates_are_found_again_if_they_have_to_serve_much_further() -> Result<(), Error> {
    let gaps = [0.0, 9.0, 1.25, 9.0, 1.5, 9.0];
    let (_, estimated) = begun(&gaps)?;
    let furthest = estimated.ranking.iter().map(|(time, _)| *time).fold(0.0, f64::max);
    for (part, is_again) in [(0.55, false), (0.45, true)] {
        let (mut run, mut estimated) = begun(&gaps)?;
        estimated.rate_span = part * furthest;
        let iterations = &mut Altered::inexact(0.0);
        // Rates to 4·10⁻⁶ over that way: between the bounds of what is asked for.
        let tolerances = tolerances(4e-6 * furthest);
        let candidates = estimated.prepare(&mut run, iterations, &tolerances)?;
        let span = if is_again { furthest } else { part * furthest };
        assert_eq!((estimated.rate_span, candidates.nodes.len()), (span, 5));
    }
    Ok(())
}

/// A window begins with a solution, the ranking and the scalars of the present approach, which are computed once.
#[test]
fn a_window_begins_with_a_solution() -> Result<(), Error> {
    let (mut run, mut iterations) =
        (test_chain::run(&[0.0, 9.0, 1.25, 9.0])?, Altered::inexact(0.0));
    run.contact.push(0)?;
    run.scalars.place_at(1.0);
    let mut estimated = Estimated::new(None, true);
    estimated.begin(&mut run, &mut iterations, &tolerances(1e-9))?;
    assert!(run.field.belongs_to(&run.contact, 1.0));
    assert_eq!(estimated.rate_span, f64::INFINITY);
    assert_eq!(estimated.ranked, Some((run.contact.revision(), 1.0)));
    let nodes: Vec<usize> = estimated.ranking.iter().map(|(_, node)| *node).collect();
    assert_eq!(nodes, [1, 2, 3]);
    // What belongs to the present approach is left alone.
    estimated.ranking.clear();
    estimated.begin(&mut run, &mut iterations, &tolerances(1e-9))?;
    assert!(estimated.ranking.is_empty());
    run.scalars.place_at(1.1);
    estimated.rate_span = 0.5;
    estimated.begin(&mut run, &mut iterations, &tolerances(1e-9))?;
    assert_eq!((estimated.ranking.len(), estimated.rate_span), (3, 0.5));
    Ok(())
}

/// Nodes 1 and 3 beside node 0, which carries 1/4 at the approach 1: gaps of 5 + 1/4 − 1 and 7 − 1 that close at 3/4
/// and 1, unless the iterations know better. S = (4 − 1/4, 0; 0, 4), and row sums of 6 − 5/4 and 6.
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
        let found =
            Estimated::new(None, true).propose(&mut run, &mut iterations, candidates, 5.0)?;
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

/// From the approach 1 on nodes 2 and 4 touch at 1.5 and 2.5; nothing else is near. The window ends behind both, and
/// their states wait.
#[test]
fn windows_are_gone_through() -> Result<(), Error> {
    let (mut run, mut estimated) = begun(&[0.0, 9.0, 1.5, 9.0, 2.5, 9.0])?;
    let window = test_chain::apart(&[(4, 1.5), (2, 0.5)], 2.7);
    let iterations = &mut Altered::inexact(0.0);
    let ended = estimated.follow(&mut run, iterations, &tolerances(1e-9), &window)?;
    assert!(matches!(ended, Outcome::Done));
    let found: Vec<_> = run.queue.iter().map(|state| (state.step, state.node.0)).collect();
    assert_eq!(found, [(2, 2), (3, 4)]);
    // In the middle of 2.5 and the horizon at 3.7.
    assert!((run.scalars.approach() - 3.1).abs() < 1e-12);
    assert!((estimated.last_span - 2.1).abs() < 1e-12);
    assert_eq!(run.contact.order(), [0, 2, 4]);
    assert_eq!(estimated.joined, [2, 4]);
    assert_eq!(estimated.ranked, Some((run.contact.revision(), run.scalars.approach())));
    for (state, approach) in run.queue.iter().zip([1.5, 2.5]) {
        assert!((state.contact.approach - approach).abs() < 1e-12);
    }
    Ok(())
}

/// Node 6, which is not watched, touches at 1.6, before the window ends in the middle of 1.5 and 2: it becomes shorter.
#[test]
fn windows_end_before_nodes_that_are_not_watched() -> Result<(), Error> {
    let (mut run, mut estimated) = begun(&[0.0, 9.0, 1.5, 9.0, 2.5, 9.0, 1.6, 9.0])?;
    let window = test_chain::apart(&[(2, 0.5), (4, 1.5)], 1.0);
    let iterations = &mut Altered::inexact(0.0);
    let ended = estimated.follow(&mut run, iterations, &tolerances(1e-9), &window)?;
    assert!(matches!(ended, Outcome::Done));
    assert_eq!((run.contact.order(), run.timings.taken_back), (&[0, 2][..], 1));
    assert!((run.scalars.approach() - 1.5).abs() < 1e-12 && run.queue.len() == 1);
    Ok(())
}

/// One that touches before the first event contradicts the window itself, however short it is. Nothing has happened
/// then.
#[test]
fn windows_that_cannot_be_are_errors() -> Result<(), Error> {
    let (mut run, mut estimated) = begun(&[0.0, 9.0, 1.5, 9.0, 2.5, 9.0, 1.25, 9.0])?;
    let window = test_chain::apart(&[(2, 0.5), (4, 1.5)], 1.0);
    let iterations = &mut Altered::inexact(0.0);
    let ended = estimated.follow(&mut run, iterations, &tolerances(1e-9), &window);
    assert!(matches!(ended, Err(Error::NotMonotone { ix: 2, iy: 0, .. })));
    assert_eq!((run.contact.order(), run.scalars.approach()), (&[0][..], 1.0));
    assert!(run.queue.is_empty());
    Ok(())
}

/// Where nodes lift their neighbours towards the surface, a node between two in contact touches before the time at
/// which it would alone: node 1, of 1 m, is the tenth and not watched; at the end of the window, near 0.75 m, it
/// overlaps. Once.
#[test]
fn nodes_that_come_sooner_make_windows_shorter() -> Result<(), Error> {
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
    let mut run = builder.build()?.into_path().run;
    let mut estimated = Estimated::new(Some(8), true);
    estimated.produce(&mut run, &mut Altered::inexact(1e-6))?;
    assert_eq!((run.timings.taken_back, run.timings.windows), (1, 1));
    // Then the window is shorter, and ends before it touches.
    let found: Vec<_> = run.queue.iter().map(|state| state.node.0).collect();
    assert!(
        found.len() > 5 && found.iter().enumerate().all(|(k, node)| *node == 2 * k),
        "{found:?}"
    );
    assert!(run.scalars.approach() < 0.7, "{}", run.scalars.approach());
    Ok(())
}

/// From the approach 1 on a watched node, 4, is thought to touch after 0.6 m, which it does after 1.6 m; or after 3 m,
/// which it does after 0.8 m. At the window's end it is under tension, or overlaps: the window ends before.
#[test]
fn ends_that_are_contradicted_come_sooner() -> Result<(), Error> {
    for (thought, gap) in [(0.6, 2.6), (3.0, 1.8)] {
        let (mut run, mut estimated) = begun(&[0.0, 9.0, 1.5, 9.0, gap, 9.0])?;
        let iterations = &mut Altered::inexact(1e-6);
        let window = test_chain::apart(&[(2, 0.5), (4, thought)], 1.4);
        let ended = estimated.follow(&mut run, iterations, &tolerances(1e-9), &window)?;
        assert!(matches!(ended, Outcome::Done));
        assert_eq!((run.contact.order(), run.timings.taken_back), (&[0, 2][..], 1));
        assert_eq!(run.queue.len(), 1);
    }
    Ok(())
}

/// What was left out of pivots bounds the number of events, but one event there always is.
#[test]
fn windows_have_fewer_events_where_more_is_left_out() {
    let mut estimated = Estimated::new(None, true);
    for (left_out, most) in [(0.0, 9), (1e-3, 9), (0.0625, 3), (0.2, 1), (0.5, 1)] {
        estimated.left_out = left_out;
        assert_eq!(estimated.most_events().min(9), most, "{left_out}");
    }
}

/// The Schur complement says that no node acts on another one, and its pivots are twice what they are: at the end of a
/// window of three events two fifths of a pivot are taken off, which is too much for three. Nothing has happened then,
/// and the next window has one event.
#[test]
fn windows_that_leave_out_much_are_taken_back() -> Result<(), Error> {
    let gaps = [0.0, 9.0, 1.5, 9.0, 2.0, 9.0, 2.5, 9.0];
    let (mut run, mut estimated) = begun(&gaps)?;
    let mut iterations = Altered::inexact(0.0);
    let mut window = test_chain::apart(&[(2, 0.5), (4, 1.0), (6, 1.5)], 3.0);
    window.schur_mut().matrix_mut().scale_mut(2.0);
    let ended = estimated.follow(&mut run, &mut iterations, &tolerances(1e-9), &window)?;
    assert!(matches!(ended, Outcome::TakenBack));
    assert_eq!((run.contact.order(), run.scalars.approach()), (&[0][..], 1.0));
    assert!(run.queue.is_empty());
    assert_eq!(estimated.most_events(), 1);
    let ended = estimated.follow(&mut run, &mut iterations, &tolerances(1e-9), &window)?;
    assert!(matches!(ended, Outcome::Done) && run.contact.order() == [0, 2]);
    // A path counts them, and goes on.
    let (mut run, mut estimated) = begun(&gaps)?;
    let mut iterations = Altered::estimates(1e-9, |(schur, _)| schur.matrix_mut().scale_mut(2.0));
    run.advance_field(&mut iterations, 1.0, 1.0)?;
    estimated.produce(&mut run, &mut iterations)?;
    assert_eq!((run.contact.order(), run.timings.taken_back), (&[0, 2][..], 1));
    Ok(())
}

/// Of nodes that joined pressure and rate, of others gap and slope: with nodes 0 and 2 in contact at the approach 3,
/// which carry 3/4 and 1/2, node 1 between them has sunk by 5/4 and sinks by a half more for each metre.
#[test]
fn the_end_of_a_window_is_that_of_its_solution() -> Result<(), Error> {
    let mut run = test_chain::solved(&[0.0, 4.0, 1.0, 8.0], &[], 0.0)?;
    let trial = Trial::of(&run, &[(0, ContactEvent::Touch), (2, ContactEvent::Touch)])?;
    go_to(&mut run, &mut Altered::inexact(0.0), &trial, (3.0, 1.0))?;
    let of_node = [
        ([0.75, 0.25], [0.0; 2]),
        ([0.0; 2], [2.25, -0.5]),
        ([0.5, 0.25], [0.0; 2]),
        ([0.0; 2], [5.5, -0.75]),
    ];
    for nodes in [&[1, 2, 3][..], &[2], &[3, 2, 1, 0]] {
        let gaps: Vec<_> = nodes.iter().map(|&node| (node, 0.0)).collect();
        let window = test_chain::apart(&gaps, 1.0);
        let ends = at_end(&run, &window, (&trial, 3.0));
        assert_eq!(ends.len(), nodes.len());
        for (end, &node) in ends.iter().zip(nodes) {
            let (pressure, gap) = of_node[node];
            for k in 0..2 {
                // Rounding errors of a transform of numbers up to 8.
                let errors = [end.pressure[k] - pressure[k], end.gap[k] - gap[k]];
                assert!(errors.iter().all(|error| error.abs() < 1e-13), "{node} {end:?}");
            }
        }
    }
    Ok(())
}
