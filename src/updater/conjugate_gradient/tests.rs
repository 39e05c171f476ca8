use super::*;
use crate::surface::{Amplitude, SelfAffine};
use crate::updater::test_altered::Altered;
use crate::updater::{Dense, Left, check};
use crate::{Boussinesq, Grid, HeightMap, InfluenceKernel, PeriodicBoussinesq, Spectral};

/// 480 bytes for each of 240 nodes, and 1000 for each one in contact: as iterations on any grid, and as an updater on
/// that of the problem once it is known.
#[test]
fn bytes_are_in_proportion_to_the_grid() -> Result<(), Error> {
    let mut updater = ConjugateGradient::new();
    let bytes = |updater: &ConjugateGradient, contact| {
        let of_grid = Iterations::bytes(updater, 240, contact);
        [of_grid, LinearUpdater::bytes(updater, contact, 9)]
    };
    let fixed = 240 * 480;
    assert_eq!(bytes(&updater, 0), [fixed, 0]);
    let problem = problem()?;
    let contact = ContactSequence::new(problem.grid());
    updater.solve(&problem, &contact, 0, 0.0, &mut Solution::default())?;
    assert_eq!(bytes(&updater, 0), [fixed; 2]);
    assert_eq!(bytes(&updater, 7), [fixed + 7000; 2]);
    assert_eq!(bytes(&updater, usize::MAX), [usize::MAX; 2]);
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
        (1e-13, true),
        (0.99, true),
    ] {
        let updater = ConjugateGradient::with_tolerance(tolerance);
        assert_eq!(updater.is_ok(), is_one, "{tolerance}");
        assert!(updater.is_ok_and(|updater| updater.tolerance() == tolerance) == is_one);
    }
}

/// Whatever span, approach or error is asked for, in whatever order: an error, or pressures that are finite; and after
/// it a question that makes sense has its answer.
#[test]
fn senseless_numbers_are_survived() -> Result<(), Error> {
    let problem = problem()?;
    let contact = ContactSequence::with_order(problem.grid(), (0..60).step_by(2))?;
    let numbers = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, 1e-300, 1e-9, 1.0, 1e300];
    let mut updater = ConjugateGradient::new();
    let mut solved = Solved::default();
    for approach in numbers {
        for span in numbers {
            if updater.advance(&Behind::on(&problem, &contact, approach), span, &mut solved).is_ok()
            {
                let Solution { pressure, rate } = &solved.solution;
                assert!(pressure.iter().chain(rate).all(|x| x.is_finite()), "{approach} {span}");
            }
            let mut part = contact.clone();
            part.truncate(20);
            let probed = updater.probe(&Behind::on(&problem, &part, approach), span);
            assert!(probed.is_err() || approach.is_finite(), "{approach} {span}");
        }
        updater.advance(&Behind::on(&problem, &contact, 3.0), f64::INFINITY, &mut solved)?;
        let mut exact = Solution::default();
        Dense.solve(&problem, &contact, 30, 3.0, &mut exact)?;
        // To the tolerance of gaps, times the condition of so few nodes.
        assert!(error(&solved.solution.pressure, &exact.pressure) < 1e-7, "{approach}");
    }
    Ok(())
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
    let most = expected.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let errors = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    errors.fold(0.0, f64::max) / most
}

/// Nodes in the order of their gaps.
pub(super) fn by_gap(problem: &Problem) -> Vec<usize> {
    let gap = problem.initial_gap();
    let mut nodes: Vec<usize> = (0..gap.len()).collect();
    nodes.sort_by(|a, b| gap[*a].total_cmp(&gap[*b]));
    nodes
}

/// A dense solution, and the displacements that it causes.
fn dense(
    problem: &Problem,
    contact: &ContactSequence,
    (count, approach): (usize, f64),
) -> Result<(Solution, Vec<f64>), Error> {
    let mut solution = Solution::default();
    Dense.solve(problem, contact, count, approach, &mut solution)?;
    let mut pressure = vec![0.0; problem.grid().nodes()];
    for (&node, value) in contact.order().iter().zip(&solution.pressure) {
        pressure[node] = *value;
    }
    let mut displacement = vec![0.0; pressure.len()];
    problem.convolution().apply(&pressure, &mut displacement)?;
    Ok((solution, displacement))
}

/// A window of a path: 60 nodes in contact are solved, ten proposed, six of them join and are solved again. Then other
/// parts of the contact are asked for, inside the window and before it, displacements alone and solutions as exact as
/// they go; and the whole once more. All are those of a dense solution, whatever was known before.
#[test]
fn any_part_of_the_contact_can_be_asked_for() -> Result<(), Error> {
    let problem = problem()?;
    let nodes = by_gap(&problem);
    let (approach, span) = (3.0, 0.1);
    let mut contact = ContactSequence::with_order(problem.grid(), nodes[..60].iter().copied())?;
    let mut updater = ConjugateGradient::new();
    let (mut solved, mut schur) = (Solved::default(), Schur::default());
    updater.advance(&Behind::on(&problem, &contact, approach), span, &mut solved)?;
    updater.propose(&problem, &contact, [&nodes[60..70], &[]], None, &mut schur)?;
    assert_eq!(schur.size(), 10);
    for &node in &nodes[60..66] {
        contact.push(node)?;
    }
    let mut end = Solved::default();
    updater.advance(&Behind::on(&problem, &contact, approach), span, &mut end)?;
    for (count, at) in
        [(63, approach), (60, approach), (30, approach), (66, approach), (66, 2.5), (66, 3.5)]
    {
        let (expected, displacement) = dense(&problem, &contact, (count, at))?;
        let mut part = contact.clone();
        part.truncate(count);
        let [found, _] = updater.probe(&Behind::on(&problem, &part, at), 0.0)?.displacement;
        // Gaps are exact to some 10⁻⁸ of the approach inside a path.
        let off = error(&found, &displacement);
        assert!(off < 1e-7, "{count} {at}: {off:e}");
        // Exact solutions leave 10⁻¹⁰ of it, and the condition number is some ten.
        let mut found = Solution::default();
        updater.solve_apart(&problem, &contact, count, at, &mut found)?;
        let off = error(&found.pressure, &expected.pressure);
        assert!(off < 1e-7, "{count} {at}: {off:e}");
        assert!(error(&found.rate, &expected.rate) < 1e-7);
    }
    // The path has noticed nothing.
    updater.advance(&Behind::on(&problem, &contact, approach), span, &mut solved)?;
    assert_eq!(solved.solution, end.solution);
    assert_eq!(solved.displacement, end.displacement);
    Ok(())
}

/// Schur complements are exact to the tolerance, on a kernel of free and of periodic boundaries, and after nodes have
/// been taken back: everything that is asked of an updater.
#[test]
fn as_an_updater_it_is_exact() -> Result<(), Error> {
    let grid = Grid::new(14, 12, 1.0, 1.5)?;
    let surface = SelfAffine::new(0.8, 8.0, 3.0, Amplitude::RmsHeight(0.1), 3)?;
    let kernels: [&dyn InfluenceKernel; 3] = [
        &Boussinesq::new(grid, 1.0)?,
        &PeriodicBoussinesq::new(grid, 1.0)?,
        &Spectral::new(grid, 1.0)?,
    ];
    for kernel in kernels {
        let problem = Problem::new(&surface, kernel)?;
        for tolerance in [1e-10, 1e-6] {
            let mut updater = ConjugateGradient::with_tolerance(tolerance)?;
            let report = check(&mut updater, &problem)?;
            assert!(report.truncates && report.releases && report.yields, "{report:?}");
            // Of the coefficient of a node on itself.
            assert!(report.schur_error < 10.0 * tolerance, "{report:?}");
        }
    }
    Ok(())
}

/// Nodes that have not joined the contact have not touched: 60 and six, and only three of them are there.
#[test]
fn nodes_that_touched_are_in_the_contact() -> Result<(), Error> {
    let problem = problem()?;
    let mut contact = ContactSequence::with_order(problem.grid(), 0..60)?;
    let mut updater = ConjugateGradient::new();
    let mut solution = Solution::default();
    updater.solve(&problem, &contact, 60, 3.0, &mut solution)?;
    let mut schur = Schur::default();
    updater.watch(&problem, &contact, &[70, 71, 72, 73, 74, 75], &mut schur)?;
    let touched = WindowFactor::of(schur, &[0, 1, 2, 3, 4, 5])?;
    for node in 70..73 {
        contact.push(node)?;
    }
    assert!(matches!(
        updater.join(&problem, &contact, &touched),
        Err(Error::LengthMismatch { expected: 66, found: 63 })
    ));
    for node in 73..77 {
        contact.push(node)?;
    }
    // More may join.
    updater.join(&problem, &contact, &touched)?;
    assert!(matches!(
        updater.solve(&problem, &contact, 68, 3.0, &mut solution),
        Err(Error::LengthMismatch { expected: 67, found: 68 })
    ));
    contact.truncate(59);
    assert!(updater.join(&problem, &contact, &WindowFactor::default()).is_err());
    let propose = |updater: &mut ConjugateGradient, contact: &_| {
        updater.propose(&problem, contact, [&[90], &[]], None, &mut Schur::default())
    };
    assert!(propose(&mut updater, &contact).is_err());
    // Told of the cut, and of a node that has left, it goes on from there.
    updater.truncate(&problem, &contact)?;
    propose(&mut updater, &contact)?;
    let position = contact.remove(7)?;
    updater.release(&problem, &contact, &[Left { node: 7, position }])?;
    propose(&mut updater, &contact).map(drop)
}

/// On periodic cells that are too long nothing is proposed; pressures on a known contact are those of a dense solution.
#[test]
fn on_long_periodic_cells_nothing_is_proposed() -> Result<(), Error> {
    let grid = Grid::new(6, 5, 1.0, 1e4)?;
    let heights = nalgebra::DMatrix::from_fn(6, 5, |ix, iy| ((ix * ix + 3 * iy) as f64).sin());
    let problem = Problem::new(&HeightMap::new(heights)?, &Spectral::new(grid, 1.0)?)?;
    let contact = ContactSequence::with_order(grid, (0..30).step_by(3))?;
    let mut updater = ConjugateGradient::new();
    let refused = updater.propose(&problem, &contact, [&[1], &[]], None, &mut Schur::default());
    assert!(matches!(refused, Err(Error::OutOfRange { value: 1e4, .. })), "{refused:?}");
    let mut found = Solution::default();
    updater.solve(&problem, &contact, 10, 3.0, &mut found)?;
    let (expected, _) = dense(&problem, &contact, (10, 3.0))?;
    // Gaps are exact to 1e-10, and the condition number of the matrix is some 1e5.
    assert!(error(&found.pressure, &expected.pressure) < 1e-5);
    Ok(())
}

/// A box passes on what it is told.
#[test]
fn boxes_pass_everything_on() -> Result<(), Error> {
    let problem = problem()?;
    let mut boxed: Box<dyn LinearUpdater> = Box::new(Altered::needing(1000));
    assert!(boxed.make_room(&problem, 999).is_err());
    boxed.make_room(&problem, 1000)?;
    boxed = Box::new(ConjugateGradient::with_tolerance(1e-6)?);
    assert_eq!(boxed.bytes(1, 0), 1000);
    Ok(())
}
