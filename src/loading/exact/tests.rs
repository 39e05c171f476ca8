use super::*;
use crate::loading::test_chain;
use crate::updater::Dense;

fn exact(size: Option<usize>) -> Exact {
    Exact::new(ContactGrowth::Monotone, size)
}

/// What is chosen of ten nodes, of which node k touches at 10 − k.
fn chosen(open_nodes: &[usize], size: usize, multiple: usize) -> (Vec<usize>, f64) {
    let mut windows = exact(None);
    let nodes: Vec<(usize, f64)> = open_nodes.iter().map(|&node| (node, 1.0)).collect();
    windows.window = test_chain::apart(&nodes, f64::INFINITY);
    windows.ranking = (0..10).map(|node| (10.0 - node as f64, node)).collect();
    let (size, horizon) = windows.choose(size, multiple, [0.0, 1.0]);
    let nodes = windows.ranking[..size].iter().map(|(_, node)| *node);
    (nodes.collect(), horizon)
}

/// Six of ten nodes tie with one that touches after 1: of these the lowest are watched, and played whatever the others
/// do, up to rounding of the approach of 10⁴. What ties after 2 is not played unless all of it is watched.
#[test]
fn of_nodes_that_touch_at_once_the_lowest_are_chosen() {
    let (approach, tie) = (1e4, 1e-9);
    for (size, expected, horizon) in [
        (4, vec![1, 3, 5, 6], 1.0 + 5e-10 + tie),
        (6, vec![1, 3, 5, 6, 8, 9], 2.0),
        (8, vec![1, 2, 3, 4, 5, 6, 8, 9], 2.0 + 2e-10),
        (10, (0..10).collect(), f64::INFINITY),
    ] {
        let mut windows = exact(None);
        let early = [1, 3, 5, 6, 8, 9].into_iter().rev().zip(0..);
        let early = early.map(|(node, k)| (1.0 + 1e-10 * f64::from(k), node));
        let late = [(2.0 + 3e-10, 0), (2.0, 2), (2.0 + 1e-10, 4), (2.0 + 2e-10, 7)];
        windows.ranking = early.chain(late).collect();
        let (found, until) = windows.choose(size, 1, [approach, 1.0 + 5e-10]);
        let nodes: Vec<usize> = windows.ranking[..found].iter().map(|(_, n)| *n).collect();
        let nodes = nodes.into_iter().collect::<std::collections::BTreeSet<_>>();
        assert!(nodes.into_iter().eq(expected), "{size}");
        // Rounding errors of the approach.
        assert!(until == horizon || (until - horizon).abs() < 1e-11, "{size}: {until}");
    }
}

#[test]
fn the_next_nodes_are_chosen() {
    // The last three by index, up to the time of the fourth from behind.
    let (nodes, horizon) = chosen(&[], 3, 1);
    assert!(nodes == [7, 8, 9] && horizon == 4.0);
    assert_eq!(chosen(&[], 10, 1), ((0..10).collect(), f64::INFINITY));
    // In multiples of four, unless there are no more.
    for (size, count) in [(3, 3), (4, 4), (5, 4), (7, 4), (8, 8), (9, 8)] {
        let (nodes, horizon) = chosen(&[], size, 4);
        assert_eq!(nodes, (10 - count..10).collect::<Vec<_>>(), "{size}");
        assert_eq!(horizon, 1.0 + count as f64);
    }
    // Two that were watched before come first, in the order in which they were, and count for nothing new: six are two
    // and four, seven one more, which is left out. Node 0 is far away.
    for (size, multiple, expected) in [
        (6, 4, vec![8, 5, 4, 6, 7, 9]),
        (7, 4, vec![8, 5, 4, 6, 7, 9]),
        (7, 1, vec![8, 5, 3, 4, 6, 7, 9]),
        (3, 4, vec![8, 7, 9]),
    ] {
        let (nodes, horizon) = chosen(&[8, 0, 5], size, multiple);
        assert_eq!(nodes, expected);
        let until = 1.0 + expected.len() as f64;
        assert_eq!(horizon, until);
    }
}

#[test]
fn windows_have_no_more_nodes_than_there_are() -> Result<(), Error> {
    let mut run = test_chain::run(&[0.0; 100])?;
    assert_eq!(exact(Some(7)).next_size(&run, &FactorLog::default(), 100), 7);
    assert_eq!(exact(Some(1000)).next_size(&run, &FactorLog::default(), 100), 100);
    // Four to have three of them touch.
    assert_eq!(exact(None).next_size(&run, &FactorLog::default(), 3), 4);
    for node in 0..90 {
        run.contact.push(node)?;
    }
    assert_eq!(exact(Some(1000)).next_size(&run, &FactorLog::default(), 10), 10);
    assert_eq!(exact(None).next_size(&run, &FactorLog::default(), 3), 4);
    assert_eq!(exact(Some(7)).multiple(), 1);
    assert_eq!(exact(None).multiple(), 96);
    Ok(())
}

/// The approach until which nothing was wrong, if something is at an approach.
fn right_until(run: &LoadingRun, approach: f64) -> Option<f64> {
    let there = (&run.problem, &run.contact, &[][..]);
    let until = contradiction(run, there, (approach, slack_at(run, there, approach)));
    until.map(|until| approach + until)
}

/// Node 0 carries a quarter of the approach: 0.15 m of overlap beside it, where gaps close at 3/4, began a fifth of a
/// metre ago, and half a metre far from it half a metre ago.
#[test]
fn the_first_contradiction_is_found() -> Result<(), Error> {
    let near = |found: Option<f64>, expected: f64| {
        assert!(found.is_some_and(|found| (found - expected).abs() < 1e-14), "{found:?}");
    };
    near(right_until(&test_chain::solved(&[0.0, 0.6, 9.0, 9.0], &[0], 1.0)?, 1.0), 0.8);
    near(right_until(&test_chain::solved(&[0.0, 0.6, 9.0, 0.5], &[0], 1.0)?, 1.0), 0.5);
    // From a solution at the approach 1 to one at 1.5.
    near(right_until(&test_chain::solved(&[0.0, 9.0, 9.0, 1.25], &[0], 1.0)?, 1.5), 1.25);
    assert_eq!(right_until(&test_chain::solved(&[0.0, 0.8, 9.0, 9.0], &[0], 1.0)?, 1.0), None);
    // A millionth of a metre is left at node 0, so that eight of them are what rounds.
    for (overlap, is_one) in [(7.99e-6, false), (8.01e-6, true)] {
        let mut given = test_chain::Altered::given(vec![0.25 * (1.0 - 1e-6)], vec![0.25]);
        let mut run = test_chain::run(&[0.0, 9.0, 1.0 - overlap])?;
        run.contact.push(0)?;
        run.advance_field(&mut given, 1.0, 1.0)?;
        assert_eq!(right_until(&run, 1.0).is_some(), is_one, "{overlap:e}");
    }
    // Where next to nothing is left it is eight times 2⁻⁵² of 9 + 1 m, 1.8·10⁻¹⁴ m.
    for (overlap, is_one) in [(1e-14, false), (3e-14, true)] {
        let run = test_chain::solved(&[0.0, 9.0, 1.0 - overlap], &[0], 1.0)?;
        assert_eq!(right_until(&run, 1.0).is_some(), is_one, "{overlap:e}");
    }
    // When tension began is not known, nor when a gap overlapped that does not close: between two nodes that push it
    // down by 3/4 m each for each metre.
    let tension = test_chain::solved(&[0.0, 9.0, 1.5], &[0, 2], 1.0)?;
    assert_eq!(right_until(&tension, 1.0), Some(f64::NEG_INFINITY));
    let mut given = test_chain::Altered::given(vec![1.0; 2], vec![0.75; 2]);
    let mut run = test_chain::run(&[0.0, 1.5, 0.0, 9.0])?;
    run.contact.push(0)?;
    run.contact.push(2)?;
    run.advance_field(&mut given, 4.0, 1.0)?;
    assert_eq!(right_until(&run, 4.0), Some(f64::NEG_INFINITY));
    Ok(())
}

/// A path with nodes 0, 2, 4, 6 and 8 in contact, the last four of a window that began at the approach 1/2; node 10
/// closes at `watcher`.
fn verified(gap_of_8: f64, watcher: f64) -> Result<(LoadingRun, usize), Error> {
    let far = 20.0;
    let gaps = [0.0, far, 1.0, far, 1.25, far, 1.75, far, gap_of_8, far, watcher];
    let mut run = test_chain::run(&gaps)?;
    run.contact.push(0)?;
    run.scalars.place_at(0.5);
    let mut windows = exact(Some(8));
    let watched = [(2, 0.5), (4, 0.75), (6, 1.25), (8, 1.5)];
    windows.window = test_chain::apart(&watched, f64::INFINITY);
    assert_eq!(windows.window.play(4), None);
    windows.follow(&mut run, &mut Dense, &mut FactorLog::default(), None)?;
    Ok((run, windows.window.events().len()))
}

#[test]
fn events_behind_a_contradiction_are_taken_back() -> Result<(), Error> {
    // Events at 1, 1.25, 1.75 and 2. None, the last one, the last two.
    for (watcher, left) in [(3.0, 4), (1.9, 3), (1.5, 2), (1.1, 1)] {
        let (run, events) = verified(2.0, watcher)?;
        assert_eq!(events, left, "{watcher}");
        assert_eq!(run.contact.order(), &[0, 2, 4, 6, 8][..=left]);
        assert_eq!(run.timings.taken_back, 4 - left);
    }
    // Tension says nothing of when, and the first event follows from a solution.
    let (run, events) = verified(3.0, 9.0)?;
    assert_eq!((events, run.timings.taken_back), (1, 3));
    Ok(())
}

/// Events of a window become states: at 1/2 + 1/2 and 1/2 + 3/4 two nodes touch, and each adds 1/4 to the stiffness
/// over the cell area of 2 m².
#[test]
fn events_become_states() -> Result<(), Error> {
    let mut run = test_chain::run(&[0.0, 20.0, 1.0, 20.0, 1.25])?;
    run.scalars.place_at(0.5);
    let mut windows = exact(Some(8));
    windows.window = test_chain::apart(&[(2, 0.5), (4, 0.75)], f64::INFINITY);
    windows.window.play(2);
    let (before, rates) = (Carried::of(&run), run.scalars.rates());
    windows.enqueue(&mut run, before, rates)?;
    let found: Vec<_> = run
        .queue
        .iter()
        .map(|state| (state.step, state.contact.contact_nodes, state.node, state.contact.approach))
        .collect();
    assert_eq!(found, [(1, 1, (2, 0), 1.0), (2, 2, (4, 0), 1.25)]);
    let found: Vec<_> = run
        .queue
        .iter()
        .map(|state| (state.contact.load, state.contact.contact_stiffness))
        .collect();
    // 1/4 m with one node.
    assert_eq!(found, [(0.0, Some(0.5)), (0.125, Some(1.0))]);
    Ok(())
}

#[test]
fn the_first_node_that_is_left_is_named() -> Result<(), Error> {
    let run = test_chain::run(&[0.0; 9])?;
    let mut windows = exact(None);
    windows.ranking = vec![(1.0, 5), (3.0, 3), (2.0, 8)];
    assert!(matches!(
        windows.growth_stopped(&run),
        Error::NotMonotone { ix: 3, iy: 0, value: 0.0, .. }
    ));
    Ok(())
}
