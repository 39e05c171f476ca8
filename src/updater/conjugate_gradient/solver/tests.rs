use super::*;
use crate::updater::{Dense, LinearUpdater, Solution};
use crate::{Boussinesq, Grid, HeightMap, Spectral};

/// 16 × 15 nodes, every third of them in contact.
fn problem() -> Result<(Problem, ContactSequence), Error> {
    let grid = Grid::new(16, 15, 1.0, 1.0)?;
    let surface = HeightMap::new(nalgebra::DMatrix::zeros(16, 15))?;
    let problem = Problem::new(&surface, &Boussinesq::new(grid, 1.0)?)?;
    let contact = ContactSequence::with_order(grid, (0..grid.nodes()).step_by(3))?;
    Ok((problem, contact))
}

/// `C x = 1` from nothing, and pressures of a dense solution.
fn solved(
    tolerance: f64,
    most_drift: f64,
    base: &Field,
) -> Result<(Field, Field, Vec<f64>), Error> {
    let (problem, contact) = problem()?;
    let mut solver = Solver::new(&problem);
    solver.choose(&contact, contact.len());
    let equation = Equation { rhs: |_| 1.0, tolerance, most_drift, max_iterations: 1000 };
    let start = if base.is_known() { base.pressure.clone() } else { vec![0.0; 240] };
    let field = solver.solve(&equation, start, Cow::Borrowed(base), &mut Directions::default())?;
    let mut fresh = Field::of(field.pressure.clone());
    solver.complete(&mut fresh)?;
    let mut dense = Solution::default();
    Dense.solve(&problem, &contact, contact.len(), 0.0, &mut dense)?;
    let mut expected = vec![0.0; 240];
    for (&node, value) in contact.order().iter().zip(&dense.rate) {
        expected[node] = *value;
    }
    Ok((field, fresh, expected))
}

/// The greatest difference.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most, (a, b)| (a - b).abs().max(most))
}

/// The first residual is 1, and the first step begins with it: what the step may have spoilt of displacements is 2·10⁻⁷
/// of both of its residuals, and as much was there before it. Displacements are as good as that, and residuals as the
/// tolerance.
#[test]
fn what_single_precision_spoils_is_known() -> Result<(), Error> {
    let (field, fresh, expected) = solved(4e-6, f64::INFINITY, &Field::default())?;
    assert!(field.drift > SINGLE * 2.0_f64.sqrt(), "{:e}", field.drift);
    // It stands for one of them, not for the greatest of all nodes.
    assert!(distance(&field.displacement, &fresh.displacement) < 3.0 * field.drift);
    let left = |field: &Field| {
        let nodes = (0..240).step_by(3);
        nodes.fold(0.0, |most: f64, node| most.max((1.0 - field.displacement[node]).abs()))
    };
    assert!(left(&fresh) < 4e-6, "{:e}", left(&fresh));
    // Pressures are near 1 for each metre and cell, and the condition number is some ten.
    assert!(distance(&field.pressure, &expected) < 1e-3 * worst(&expected));
    // More exact than single precision: computed afresh, and nothing is spoilt.
    for (tolerance, most_drift) in [(1e-11, f64::INFINITY), (4e-6, 1e-12)] {
        let (field, fresh, expected) = solved(tolerance, most_drift, &Field::default())?;
        assert!(field.drift <= most_drift.min(0.5 * tolerance), "{:e}", field.drift);
        assert!(distance(&field.displacement, &fresh.displacement) < 1e-6 * tolerance.max(1e-6));
        assert!(left(&fresh) <= tolerance);
        assert!(distance(&field.pressure, &expected) < 1e3 * tolerance * worst(&expected));
    }
    // From a base that is right already nothing is left to do, and its drift stays.
    let (mut base, _, _) = solved(1e-11, f64::INFINITY, &Field::default())?;
    base.drift = 1e-7;
    let (field, _, _) = solved(1e-5, f64::INFINITY, &base)?;
    assert!(distance(&field.pressure, &base.pressure) == 0.0 && (field.drift - 1e-7).abs() < 1e-15);
    Ok(())
}

/// On cells 10⁴ times as long as wide short waves displace by 10⁻⁴ of what long ones do: pressures that take out what
/// is left of them are large, and what they spoil of long waves is far more than what they displace. Computed afresh,
/// no residual is above the tolerance; 31 of these 40 were, by a factor of up to 4.3, where only what is displaced was
/// counted.
#[test]
fn noise_of_long_cells_is_counted() -> Result<(), Error> {
    let grid = Grid::new(7, 7, 1.0, 1e-4)?;
    let surface = HeightMap::new(nalgebra::DMatrix::zeros(7, 7))?;
    let problem = Problem::new(&surface, &Spectral::new(grid, 1.0)?)?;
    for k in 1..=40 {
        let nodes = (0..49).filter(|node| (node * node * 7 + node * k) % 41 < 26);
        let contact = ContactSequence::with_order(grid, nodes)?;
        let mut solver = Solver::new(&problem);
        solver.choose(&contact, contact.len());
        let equation = Equation {
            rhs: |_| 1.0,
            tolerance: 1e-11,
            most_drift: f64::INFINITY,
            max_iterations: 1000,
        };
        let start = vec![0.0; 49];
        let base = Field::default();
        let field = solver.solve(&equation, start, Cow::Owned(base), &mut Directions::default())?;
        let mut fresh = Field::of(field.pressure);
        solver.complete(&mut fresh)?;
        let left = contact.order().iter();
        let left = left.map(|&node| (1.0 - fresh.displacement[node]).abs());
        let left = left.fold(0.0, f64::max);
        assert!(left <= 1e-11, "{k}: {left:e}");
    }
    Ok(())
}

#[test]
fn iterations_come_to_an_end() -> Result<(), Error> {
    let (problem, contact) = problem()?;
    let mut solver = Solver::new(&problem);
    solver.choose(&contact, contact.len());
    for (most, tolerance) in [(0, 1e-3), (2, 1e-12)] {
        let equation =
            Equation { rhs: |_| 1.0, tolerance, most_drift: f64::INFINITY, max_iterations: most };
        let failed =
            solver.solve(&equation, vec![0.0; 240], Cow::default(), &mut Directions::default());
        assert!(
            matches!(
                failed,
                Err(Error::NoConvergence { residual, tolerance: found, iterations })
                    if iterations == most && found == tolerance && residual > tolerance
            ),
            "{failed:?}"
        );
    }
    Ok(())
}
