use super::*;
use crate::convolution::Convolution;
use crate::loading::LoadingSolver;
use crate::loading::phase::Phase;
use crate::loading::ranking::rank;
use crate::loading::test_chain::{self, Altered};
use crate::surface::{Amplitude, SelfAffine};
use crate::updater::Left;
use crate::updater::{ConjugateGradient, Dense, RecursiveCholesky, join_all};
use crate::{Boussinesq, InfluenceKernel, PeriodicBoussinesq};

/// The ranking takes 16 bytes for each of 15 nodes, a problem two fields, a table of 9 × 5 coefficients and a
/// convolution, all gaps four fields and another convolution.
#[test]
fn bytes_of_the_grid_add_up() -> Result<(), Error> {
    let grid = Grid::new(5, 3, 1.0, 1.0)?;
    for boundary in [Boundary::Free, Boundary::Periodic] {
        let found = LoadingRun::bytes_on(&grid, boundary);
        let convolutions = 2 * Convolution::bytes_on(&grid, boundary);
        let contact = ContactSequence::bytes_on(&grid);
        assert_eq!(found - convolutions - contact, 240 + 240 + 360 + 480);
    }
    Ok(())
}

/// k nodes watched beside three in contact take 16 (3 + 2 k)² bytes of a dense updater, and 16 k² of the window.
#[test]
fn windows_are_halved_until_they_fit() -> Result<(), Error> {
    let mut run = test_chain::solved(&[0.0; 9], &[0, 1, 2], 1.0)?;
    let fixed = run.memory.fixed;
    let needed = |k: usize| 16 * ((3 + 2 * k).pow(2) + k * k);
    for (budget, size) in [(needed(8), 8), (needed(8) - 1, 4), (needed(4) - 1, 2), (needed(1), 1)] {
        run.memory.budget = fixed + budget;
        assert_eq!(run.affordable(&Dense, 8)?, size);
    }
    run.memory.budget = fixed + needed(1) - 1;
    let refused = run.affordable(&Dense, 8);
    assert!(
        matches!(
            refused,
            Err(Error::MemoryBudget { needed: found, budget, nodes_that_fit: 3 })
                if found == fixed + needed(1) && budget == found - 1
        ),
        "{refused:?}"
    );
    Ok(())
}

/// A contact before the last release is factored anew, beside the updater as it is.
#[test]
fn earlier_contacts_need_room_of_their_own() -> Result<(), Error> {
    let mut run = test_chain::solved(&[0.0, 9.0, 1.0, 9.0, 2.0], &[0, 2], 3.0)?;
    // 0, 2 and 4 touch, and 2 leaves as the fourth event; then it touches again.
    run.contact.remove(2)?;
    run.contact.push(4)?;
    run.releases.push(4, Left { node: 2, position: 1 });
    run.contact.push(2)?;
    let (mut phase, mut solution) = (Phase::new(Dense, None), Solution::default());
    // 16 · 3² bytes of a dense updater.
    run.memory.budget = run.memory.fixed + 144 + RecursiveCholesky::bytes_of(3);
    assert_eq!(phase.solve_at(&run, (3, 3.0), &mut solution)?, [0, 2, 4]);
    for (found, expected) in solution.pressure.iter().zip([0.75, 0.5, 0.25]) {
        assert!((found - expected).abs() < 1e-15);
    }
    run.memory.budget -= 1;
    let refused = phase.solve_at(&run, (3, 3.0), &mut solution);
    assert!(
        matches!(
            refused,
            Err(Error::MemoryBudget { needed, budget, nodes_that_fit: 3 }) if needed == budget + 1
        ),
        "{refused:?}"
    );
    // What the updater holds needs no room.
    assert_eq!(phase.solve_at(&run, (5, 3.0), &mut solution)?, [0, 4, 2]);
    Ok(())
}

/// Gaps of 0, 1, 2 and 5 m at the approach δ, before any contact: a mean of 2 − δ. An overlap of 10⁻¹⁰ (5 + δ) m is
/// rounding.
#[test]
fn a_survey_takes_the_mean_gap() -> Result<(), Error> {
    let mut run = test_chain::run(&[0.0, 1.0, 2.0, 5.0])?;
    run.scalars.place_at(0.5);
    let mut seen = Vec::new();
    run.survey(None, |node, line| seen.push((node, line.gap, line.closing)))?;
    assert_eq!(seen, [(0, -0.5, 1.0), (1, 0.5, 1.0), (2, 1.5, 1.0), (3, 4.5, 1.0)]);
    assert_eq!(run.scalars.state(0).mean_gap, 1.5);
    // One metre of approach takes one off.
    run.scalars.advance(1.5);
    assert_eq!(run.scalars.state(0).mean_gap, 0.5);
    for (approach, is_refused) in [(4.9e-10, false), (5.1e-10, true)] {
        run.scalars.place_at(approach);
        assert_eq!(run.survey(Some(0.0), |_, _| ()).is_err(), is_refused, "{approach:e}");
        run.survey(None, |_, _| ())?;
    }
    // Node 3 alone is out of contact, and the greatest gap is that of node 2: 10⁻¹⁰ (5 + 3) m.
    let mut run = test_chain::run(&[0.0, 1.0, 5.0, 3.0])?;
    for node in 0..3 {
        run.contact.push(node)?;
    }
    for (overlap, is_refused) in [(7.9e-10, false), (8.1e-10, true)] {
        run.scalars.place_at(3.0 + overlap);
        let found = run.survey(Some(0.0), |_, _| ());
        assert_eq!(found.is_err(), is_refused, "{overlap:e} {found:?}");
        // And what a solution may leave, if that is more.
        assert!(run.survey(Some(1e-9), |_, _| ()).is_ok());
        assert_eq!(run.survey(Some(1e-12), |_, _| ()).is_err(), is_refused);
    }
    Ok(())
}

/// Node 0 carries 1 at the approach 4; node 2, at the gap 4 + x, carries −x/4, of which 10⁻¹⁰ and a quarter of an
/// overlap are allowed.
#[test]
fn tension_beyond_rounding_is_found() -> Result<(), Error> {
    for (x, overlap, is_found) in [
        (3.9e-10, 0.0, false),
        (4.1e-10, 0.0, true),
        (7.9e-10, 4e-10, false),
        (8.1e-10, 4e-10, true),
    ] {
        let run = test_chain::solved(&[0.0, 8.0, 4.0 + x], &[0, 2], 4.0)?;
        let found = run.negative_pressure(4.0, overlap);
        assert_eq!(found.map(|(node, _)| node), is_found.then_some(2), "{x:e}");
        // A hundredth further it is pressure.
        assert!(run.negative_pressure(4.01, overlap).is_none());
    }
    let mut run = test_chain::run(&[0.0, 8.0])?;
    run.contact.push(0)?;
    let mut given = Altered::given(vec![f64::NAN], vec![1.0]);
    run.advance_field(&mut given, 1.0, 1.0)?;
    assert!(run.negative_pressure(1.0, 0.0).is_some());
    Ok(())
}

/// The rates of a node alone, of two neighbours, and of none.
#[test]
fn the_greatest_rate_is_found() -> Result<(), Error> {
    for (contact, rate) in [(&[0, 3, 4][..], 0.25), (&[3, 4], 0.2), (&[], 0.0)] {
        let run = test_chain::solved(&[0.0; 6], contact, 1.0)?;
        assert!((run.greatest_rate() - rate).abs() < 1e-15);
    }
    Ok(())
}

/// Dense solutions whose pressures and rates are too large by a part.
fn off(pressure: f64, rate: f64) -> Altered {
    Altered::solutions(move |solution| {
        let values = [&mut solution.pressure, &mut solution.rate];
        for (values, part) in values.into_iter().zip([pressure, rate]) {
            values.iter_mut().for_each(|value| *value *= 1.0 + part);
        }
    })
}

/// Node 0 carries 1/2 at the approach 2: 10⁻¹⁰ (4 + 2 + 4/2) m may be left of its gap, and 10⁻¹⁰ (1 + 4/4) of the rate.
#[test]
fn solutions_close_the_contact() -> Result<(), Error> {
    for (pressure, rate, refused) in [
        (3.9e-10, 1.9e-10, None),
        (-3.9e-10, -1.9e-10, None),
        (4.1e-10, 0.0, Some("gap")),
        (-4.1e-10, 0.0, Some("gap")),
        (0.0, 2.1e-10, Some("rate of the gap")),
        (0.0, -2.1e-10, Some("rate of the gap")),
        (f64::NAN, 0.0, Some("gap")),
    ] {
        let mut run = test_chain::run(&[0.0, 4.0, 4.0])?;
        run.contact.push(0)?;
        match (run.renew_field(&mut off(pressure, rate), 2.0), refused) {
            (Ok(()), None) => {}
            (
                Err(Error::Updater(UpdaterError::ContactNotClosed {
                    quantity, ix: 0, iy: 0, ..
                })),
                Some(refused),
            ) => assert_eq!(quantity, refused),
            (found, _) => unreachable!("{pressure:e} {rate:e}: {found:?}"),
        }
    }
    Ok(())
}

#[test]
fn errors_say_where_the_path_is() -> Result<(), Error> {
    let mut run = test_chain::run(&[0.0; 6])?;
    run.contact.push(3)?;
    run.scalars.place_at(1.5);
    let bad = BadPivot { node: 5, time: 0.25, pivot: -1.0 };
    assert!(matches!(
        run.not_positive_definite(bad),
        Error::NotPositiveDefinite { ix: 5, iy: 0, approach: 1.75, pivot: -1.0 }
    ));
    assert!(matches!(
        run.not_monotone("gap", 4, -2.0),
        Error::NotMonotone { quantity: "gap", ix: 4, iy: 0, approach: 1.5, value: -2.0 }
    ));
    assert!(matches!(run.not_finite(), Error::NotFinite { step: 2 }));
    Ok(())
}

/// Nodes that are taken back are out of contact, and what solves on it goes back as well.
#[test]
fn nodes_are_taken_back() -> Result<(), Error> {
    let mut run = test_chain::surveyed(&[0.0, 9.0, 1.0, 9.0, 2.0, 9.0], &[0, 2, 4], 2.5)?;
    let mut updater = RecursiveCholesky::default();
    join_all(
        &mut updater,
        &run.problem,
        &mut ContactSequence::new(run.problem.grid()),
        &[0, 2, 4],
        usize::MAX,
    )?;
    run.cut(&mut updater, 2)?;
    assert_eq!(run.contact.order(), [0, 2]);
    updater.solve(&run.problem, &run.contact, 2, 1.5, &mut Solution::default())?;
    Ok(())
}

/// The events of a window on nodes until a horizon.
fn played(
    run: &mut LoadingRun,
    updater: &mut dyn LinearUpdater,
    (nodes, horizon): (&[usize], f64),
) -> Result<Window, Error> {
    let mut window = Window::default();
    run.watch(updater, &mut window, nodes.iter().copied(), horizon)?;
    assert_eq!(window.play(usize::MAX), None);
    Ok(window)
}

/// The events of a window are the same whoever eliminates the contact from its Schur complement, to what that leaves.
#[test]
fn windows_are_those_of_any_updater() -> Result<(), Error> {
    let grid = Grid::new(14, 12, 1.0, 1.5)?;
    let surface = SelfAffine::new(0.8, 8.0, 3.0, Amplitude::RmsHeight(0.1), 3)?;
    let kernels: [&dyn InfluenceKernel; 2] =
        [&Boussinesq::new(grid, 1.0)?, &PeriodicBoussinesq::new(grid, 1.0)?];
    for kernel in kernels {
        let builder = LoadingSolver::builder(&surface, kernel).updater(RecursiveCholesky::new());
        let mut path = builder.max_nodes(40).build()?.into_path();
        path.by_ref().try_for_each(|state| state.map(drop))?;
        let Phase::Factor { updater, .. } = &mut path.phase else {
            unreachable!("a factor stays");
        };
        let run = &mut path.run;
        assert_eq!(run.contact.len(), 40);
        run.renew_field(updater.as_mut(), run.scalars.approach())?;
        let mut ranking = Vec::new();
        rank(run, &mut ranking)?;
        ranking.sort_by(|a, b| a.0.total_cmp(&b.0));
        let nodes: Vec<usize> = ranking[..12].iter().map(|&(_, node)| node).collect();
        let opened = (&nodes[..], ranking[12].0);
        let expected = played(run, &mut Dense, opened)?;
        assert!(expected.events().len() > 2);
        for found in [
            played(run, updater.as_mut(), opened)?,
            played(run, &mut ConjugateGradient::new(), opened)?,
        ] {
            assert!(found.touched().eq(expected.touched()));
            for (found, expected) in found.events().iter().zip(expected.events()) {
                let error = (found.time - expected.time).abs();
                assert!(error < 1e-8 * opened.1, "{error:e}");
            }
            let increments = found.increments().flatten();
            for (found, expected) in increments.zip(expected.increments().flatten()) {
                assert!((found - expected).abs() < 1e-8 * expected.abs(), "{found} {expected}");
            }
        }
    }
    Ok(())
}
