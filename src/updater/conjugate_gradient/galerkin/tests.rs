use super::*;
use crate::contact::ContactSequence;
use crate::krylov::NodeSet;
use crate::updater::conjugate_gradient::local::Neighbourhood;
use crate::updater::{Dense, LinearUpdater, Schur};
use crate::{Boussinesq, Error, HeightMap, PeriodicBoussinesq};

fn flat(grid: Grid, periodic: bool) -> Result<Problem, Error> {
    let surface = HeightMap::new(nalgebra::DMatrix::zeros(grid.nx(), grid.ny()))?;
    if periodic {
        Problem::new(&surface, &PeriodicBoussinesq::new(grid, 1.0)?)
    } else {
        Problem::new(&surface, &Boussinesq::new(grid, 1.0)?)
    }
}

/// Nine offsets have six points, at multiples of 8/5 rounded; fewer are points themselves.
#[test]
fn points_lie_between_the_ends() {
    for (offsets, expected) in [
        (&[5, -3, 0][..], &[-3, -1, 0, 2, 3, 5][..]),
        (&[-2, 3], &[-2, -1, 0, 1, 2, 3]),
        (&[6, 4], &[4, 5, 6]),
        (&[2], &[2]),
    ] {
        let axis = Axis::of(offsets.iter().copied());
        assert_eq!(&axis.points[..axis.count], expected);
        assert_eq!((axis.first(), axis.last()), (expected[0], expected[expected.len() - 1]));
    }
}

/// Six points give polynomials of the fifth degree as they are, and three of the second.
#[test]
fn interpolation_is_exact_for_polynomials() {
    for (first, last, polynomial) in [
        (-3, 5, [1.0, -2.0, 0.5, 0.25, -1.0, 0.125]),
        (4, 6, [3.0, 1.0, -0.5, 0.0, 0.0, 0.0]),
        (7, 7, [2.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ] {
        let at = |x: i32| polynomial.iter().rev().fold(0.0, |sum, c| sum * f64::from(x) + c);
        let axis = Axis::of([first, last].into_iter());
        for offset in first..=last {
            let weights = axis.weights(offset);
            let points = &axis.points[..axis.count];
            let found: f64 = points.iter().zip(weights).map(|(&x, weight)| at(x) * weight).sum();
            // Rounding errors of numbers up to 10³.
            assert!((found - at(offset)).abs() < 1e-11, "{offset}: {found}");
        }
    }
}

#[test]
fn distances_go_the_shorter_way() -> Result<(), Error> {
    let grid = Grid::new(10, 10, 1.0, 2.0)?;
    let between = |boundary, a, b| distance(grid, boundary, a, b);
    assert_eq!(between(Boundary::Free, [1.0, 4.0], [9.0, 19.0]), 17.0);
    assert_eq!(between(Boundary::Periodic, [1.0, 2.0], [8.0, 18.0]), 5.0);
    assert_eq!(between(Boundary::Periodic, [8.0, 2.0], [5.0, 6.0]), 5.0);
    Ok(())
}

/// Places of the table, sorted by node.
fn nodes_of(problem: &Problem, pressures: &[(usize, f64)]) -> Vec<(usize, f64)> {
    let node = |place: usize| {
        let nodes = 0..problem.grid().nodes();
        nodes.into_iter().find(|&node| problem.table().place(node) == place)
    };
    let mut found: Vec<(usize, f64)> =
        pressures.iter().map(|&(place, p)| (node(place).unwrap_or(usize::MAX), p)).collect();
    found.sort_by_key(|(node, _)| *node);
    found
}

/// Node (1, 3), answered by nodes two cells before it, round the edge, and one behind and above: the box goes from −2
/// to 1 and from 0 to 1, and so small a box is not interpolated.
#[test]
fn sources_are_as_large_as_their_contact() -> Result<(), Error> {
    let grid = Grid::new(12, 5, 0.5, 2.0)?;
    for (periodic, first) in [(true, 11), (false, 3)] {
        let problem = flat(grid, periodic)?;
        let local = Local {
            node: grid.index(if periodic { 1 } else { 5 }, 3),
            contact: vec![
                grid.index(first, 3) as u32,
                grid.index(first + 3 - 12 * usize::from(periodic), 4) as u32,
            ],
            weights: vec![0.5, 0.25],
        };
        let source = Source::new(&problem, &local);
        let x = if periodic { 1.0 } else { 5.0 };
        assert_eq!(source.centre, [(x - 0.5) * 0.5, 3.5 * 2.0]);
        assert_eq!(source.radius, 0.75_f64.hypot(1.0));
        assert_eq!(source.own, problem.table().place(local.node));
        let mut expected = vec![
            (local.node, 1.0),
            (local.contact[0] as usize, -0.5),
            (local.contact[1] as usize, -0.25),
        ];
        expected.sort_by_key(|(node, _)| *node);
        assert_eq!(nodes_of(&problem, &source.near), expected);
        let far: Vec<(usize, f64)> =
            nodes_of(&problem, &source.far).into_iter().filter(|(_, p)| p.abs() > 1e-12).collect();
        assert_eq!(source.far.len(), 8);
        assert_eq!(far.len(), 3);
        for ((node, p), (expected_node, expected)) in far.into_iter().zip(expected) {
            assert!(node == expected_node && (p - expected).abs() < 1e-14);
        }
    }
    Ok(())
}

/// `(e_i − x_i)ᵀ C (e_j − x_j)` as it stands.
fn energy(problem: &Problem, a: &Local, b: &Local) -> f64 {
    let terms = |local: &Local| -> Vec<(usize, f64)> {
        let answers = local.contact.iter().zip(&local.weights);
        std::iter::once((local.node, 1.0))
            .chain(answers.map(|(&node, x)| (node as usize, -x)))
            .collect()
    };
    let mut sum = 0.0;
    for (i, p) in terms(a) {
        for (j, q) in terms(b) {
            sum += p * q * problem.coefficient(i, j).unwrap_or(f64::NAN);
        }
    }
    sum
}

/// Of sources far from each other: as it stands where boxes are small, and with an error of (4/30)⁶ for boxes of nine
/// cells, 30 cells apart.
#[test]
fn sources_far_away_are_interpolated() -> Result<(), Error> {
    for periodic in [false, true] {
        let grid = Grid::new(64, 9, 1.0, 1.0)?;
        let problem = flat(grid, periodic)?;
        let local = |ix: usize, half: usize| {
            let answers: Vec<usize> = (ix - half..=ix + half).filter(|&x| x != ix).collect();
            Local {
                node: grid.index(ix, 4),
                contact: answers.iter().map(|&x| grid.index(x, 3 + x % 3) as u32).collect(),
                weights: answers.iter().map(|&x| 0.3 / (1.0 + x.abs_diff(ix) as f64)).collect(),
            }
        };
        for (half, error) in [(2, 1e-13), (4, 1e-5)] {
            let locals = [local(6, half), local(36, half)];
            let mut matrix = vec![0.0; 4];
            schur(&problem, &locals, &mut matrix);
            let expected = energy(&problem, &locals[0], &locals[1]);
            assert!((matrix[1] / expected - 1.0).abs() < error, "{half}: {} {expected}", matrix[1]);
            // Nothing is written above the diagonal.
            assert_eq!(matrix[2], 0.0);
        }
    }
    Ok(())
}

/// With all nodes in contact near every watched one the complement is that of a dense solution, but for the single
/// precision of local solutions.
#[test]
fn sources_near_each_other_are_exact() -> Result<(), Error> {
    for periodic in [false, true] {
        let grid = Grid::new(9, 10, 1.0, 1.5)?;
        let problem = flat(grid, periodic)?;
        let is_in = |node: usize| node % 3 == 1 || node % 7 == 2;
        let contact: Vec<usize> = (0..grid.nodes()).filter(|&node| is_in(node)).collect();
        let watched: Vec<usize> =
            (0..grid.nodes()).filter(|&node| !is_in(node)).step_by(4).collect();
        let mut set = NodeSet::new(grid.nodes());
        set.assign(is_in);
        let neighbourhood = Neighbourhood::new(&problem);
        let locals: Vec<Local> =
            watched.iter().map(|&node| neighbourhood.solve(problem.table(), &set, node)).collect();
        let size = watched.len();
        let mut found = vec![0.0; size * size];
        schur(&problem, &locals, &mut found);
        let mut expected = Schur::default();
        let contact = ContactSequence::with_order(grid, contact)?;
        Dense.watch(&problem, &contact, &watched, &mut expected)?;
        let unit = problem.table().self_influence();
        for j in 0..size {
            for i in j..size {
                let error = (found[i + size * j] - expected.matrix()[(i, j)]) / unit;
                assert!(error.abs() < 1e-5, "{i} {j}: {error:e}");
            }
        }
    }
    Ok(())
}

/// Whatever the weights are, nodes that answer the other one feel nothing of it, but for that one itself: of the first
/// these are nodes 4 and 6, of the second node 6.
#[test]
fn nodes_that_answer_feel_nothing() -> Result<(), Error> {
    let problem = crate::test_chain::problem(&[0.0; 9])?;
    let local = |node: usize, contact: &[u32]| Local {
        node,
        contact: contact.to_vec(),
        weights: vec![0.5; contact.len()],
    };
    let locals = [local(5, &[4, 6]), local(7, &[6, 5])];
    let mut matrix = vec![0.0; 4];
    schur(&problem, &locals, &mut matrix);
    // Node 5 on itself: 4 − 1/2 − 1/2. Node 7: u = 4 − 1/2. Of the second on the first, only node 7 feels nothing of
    // node 5 and −1/2 of node 6; node 5 is the first one itself and feels 4 − 1/2 − 1/2, times −1/2.
    assert_eq!([matrix[0], matrix[1], matrix[3]], [3.0, -0.5 - 1.5, 3.5]);
    Ok(())
}

/// 5 · 5 with itself, and 5 · 64 for each of three.
#[test]
fn products_of_a_column() {
    assert_eq!(products(5, 3), 25 + 960);
}
