use super::*;
use crate::surface::{Amplitude, SelfAffine};
use crate::updater::Dense;
use crate::{Boussinesq, Grid, HeightMap, Spectral};

/// 480 bytes for each of 240 nodes, and 1000 for each one in contact.
#[test]
fn bytes_are_in_proportion_to_the_grid() -> Result<(), Error> {
    let problem = problem()?;
    let mut updater = ConjugateGradient::new();
    let fixed = 240 * 480;
    updater.make_room(&problem, fixed)?;
    assert_eq!(
        [updater.bytes(0, 9), updater.bytes(7, 9)],
        [fixed, fixed + 7000]
    );
    updater.check_room(&problem, fixed + 7000, 7)?;
    let refused = updater.check_room(&problem, fixed + 6999, 7);
    assert!(
        matches!(
            refused,
            Err(Error::MemoryBudget { needed, budget, nodes_that_fit: 6 })
                if needed == fixed + 7000 && budget == fixed + 6999
        ),
        "{refused:?}"
    );
    assert!(updater.make_room(&problem, fixed - 1).is_err());
    Ok(())
}

#[test]
fn tolerances_lie_between_0_and_1() {
    for (tolerance, is_one) in [
        (0.0, false),
        (1.0, false),
        (-1e-9, false),
        (f64::NAN, false),
        (1e-300, true),
        (0.99, true),
    ] {
        let updater = ConjugateGradient::with_tolerance(tolerance);
        assert_eq!(updater.is_ok(), is_one, "{tolerance}");
        assert!(updater.is_ok_and(|updater| updater.profile().tolerance == tolerance) == is_one);
    }
}

/// A rough surface of 16 × 15 nodes.
pub(super) fn problem() -> Result<Problem, Error> {
    let grid = Grid::new(16, 15, 1.0, 1.0)?;
    let surface = SelfAffine::new(0.8, 8.0, 3.0, Amplitude::RmsHeight(0.1), 3)?;
    Problem::new(&surface, &Boussinesq::new(grid, 1.0)?)
}

/// The greatest difference from a dense solution, over its greatest value.
fn error(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let most = expected
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    let errors = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    errors.fold(0.0, f64::max) / most
}

/// A window of a path: 60 nodes in contact are solved, ten watched, six of them join and are solved again. Then other parts of the
/// contact are asked for, inside the window and before it, without a rate and as exactly as it goes; and the whole once
/// more. All are those of a dense solution, whatever was known before.
#[test]
fn any_part_of_the_contact_can_be_asked_for() -> Result<(), Error> {
    let problem = problem()?;
    let gap = problem.initial_gap();
    let mut nodes: Vec<usize> = (0..240).collect();
    nodes.sort_by(|a, b| gap[*a].total_cmp(&gap[*b]));
    let (approach, span) = (3.0, 0.1);
    let mut contact = ContactSequence::with_order(problem.grid(), nodes[..60].iter().copied())?;
    let mut updater = ConjugateGradient::new();
    let mut solution = Solution::default();
    let of_path = |contact: &ContactSequence| SolveRequest {
        span,
        ..SolveRequest::exact(contact.len(), approach)
    };
    updater.solve(&problem, &contact, of_path(&contact), &mut solution)?;
    let mut schur = Schur::default();
    updater.watch(&problem, &contact, &nodes[60..70], &mut schur)?;
    let positions: Vec<usize> = (0..6).collect();
    let touched = WindowFactor::of(schur, &positions)?;
    for &node in &nodes[60..66] {
        contact.push(node)?;
    }
    updater.join(&problem, &contact, &touched)?;
    updater.solve(&problem, &contact, of_path(&contact), &mut solution)?;
    let end = solution.clone();
    for (count, asked_span, at) in [
        (63, 0.0, approach),
        (60, 0.0, approach),
        (30, 0.0, approach),
        (63, f64::INFINITY, approach),
        (30, f64::INFINITY, approach),
        (66, f64::INFINITY, approach),
        (66, f64::INFINITY, 2.5),
        (66, 0.0, 3.5),
    ] {
        let request = SolveRequest {
            span: asked_span,
            ..SolveRequest::exact(count, at)
        };
        updater.solve(&problem, &contact, request, &mut solution)?;
        let mut expected = Solution::default();
        Dense.solve(&problem, &contact, request, &mut expected)?;
        // Exact solutions leave 10⁻¹⁰ of the approach, those inside a path some 10⁻⁸, and the condition number is some ten.
        let allowed = if asked_span > 0.0 { 1e-7 } else { 1e-5 };
        let found = error(&solution.pressure, &expected.pressure);
        assert!(found < allowed, "{count} {asked_span} {at}: {found:e}");
        if asked_span > 0.0 {
            assert!(error(&solution.rate, &expected.rate) < allowed);
        }
    }
    // The path has noticed nothing.
    updater.solve(&problem, &contact, of_path(&contact), &mut solution)?;
    assert_eq!(solution, end);
    Ok(())
}

/// Nodes that have not joined the contact have not touched: 60 and six, and only three of them are there.
#[test]
fn nodes_that_touched_are_in_the_contact() -> Result<(), Error> {
    let problem = problem()?;
    let mut contact = ContactSequence::with_order(problem.grid(), 0..60)?;
    let mut updater = ConjugateGradient::new();
    let mut solution = Solution::default();
    updater.solve(
        &problem,
        &contact,
        SolveRequest::exact(60, 3.0),
        &mut solution,
    )?;
    let mut schur = Schur::default();
    updater.watch(&problem, &contact, &[70, 71, 72, 73, 74, 75], &mut schur)?;
    let touched = WindowFactor::of(schur, &[0, 1, 2, 3, 4, 5])?;
    for node in 70..73 {
        contact.push(node)?;
    }
    assert!(matches!(
        updater.join(&problem, &contact, &touched),
        Err(Error::LengthMismatch {
            expected: 66,
            found: 63
        })
    ));
    for node in 73..77 {
        contact.push(node)?;
    }
    // More may join.
    updater.join(&problem, &contact, &touched)?;
    assert!(matches!(
        updater.solve(
            &problem,
            &contact,
            SolveRequest::exact(68, 3.0),
            &mut solution
        ),
        Err(Error::LengthMismatch {
            expected: 67,
            found: 68
        })
    ));
    contact.truncate(59);
    assert!(
        updater
            .join(&problem, &contact, &WindowFactor::default())
            .is_err()
    );
    let mut schur = Schur::default();
    let refused = updater.watch(&problem, &contact, &[90], &mut schur);
    assert!(refused.is_err());
    // Told of the cut, and of a node that has left, it goes on from there.
    updater.truncate(&problem, &contact)?;
    updater.watch(&problem, &contact, &[90], &mut schur)?;
    let position = contact.remove(7)?;
    updater.release(&problem, &contact, 7, position)?;
    updater.watch(&problem, &contact, &[90], &mut schur)
}

/// On periodic cells that are too long nothing is watched; pressures on a known contact are those of a dense solution.
#[test]
fn long_periodic_cells_are_not_watched() -> Result<(), Error> {
    let grid = Grid::new(6, 5, 1.0, 1e4)?;
    let heights = nalgebra::DMatrix::from_fn(6, 5, |ix, iy| ((ix * ix + 3 * iy) as f64).sin());
    let problem = Problem::new(&HeightMap::new(heights)?, &Spectral::new(grid, 1.0)?)?;
    let contact = ContactSequence::with_order(grid, (0..30).step_by(3))?;
    let mut updater = ConjugateGradient::new();
    let refused = updater.watch(&problem, &contact, &[1], &mut Schur::default());
    assert!(
        matches!(refused, Err(Error::OutOfRange { value: 1e4, .. })),
        "{refused:?}"
    );
    let request = SolveRequest::exact(10, 3.0);
    let (mut found, mut expected) = (Solution::default(), Solution::default());
    updater.solve(&problem, &contact, request, &mut found)?;
    Dense.solve(&problem, &contact, request, &mut expected)?;
    // Gaps are exact to 1e-10, and the condition number of the matrix is some 1e5.
    assert!(error(&found.pressure, &expected.pressure) < 1e-5);
    Ok(())
}

/// A box passes on what it is told.
#[test]
fn boxes_pass_everything_on() -> Result<(), Error> {
    let problem = problem()?;
    let mut boxed: Box<dyn LinearUpdater> = Box::new(ConjugateGradient::with_tolerance(1e-6)?);
    assert!(boxed.make_room(&problem, 240 * 480 - 1).is_err());
    boxed.make_room(&problem, 240 * 480)?;
    assert_eq!(boxed.bytes(1, 0), 240 * 480 + 1000);
    assert!(!boxed.profile().exact && boxed.profile().tolerance == 1e-6);
    Ok(())
}
