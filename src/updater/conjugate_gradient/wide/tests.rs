use super::*;
use crate::contact::ContactSequence;
use crate::krylov::NodeSet;
use crate::updater::{Dense, LinearUpdater, Schur};
use crate::{Boussinesq, Error, Grid, HeightMap, PeriodicBoussinesq};

fn flat(grid: Grid, periodic: bool) -> Result<Problem, Error> {
    let surface = HeightMap::new(nalgebra::DMatrix::zeros(grid.nx(), grid.ny()))?;
    if periodic {
        Problem::new(&surface, &PeriodicBoussinesq::new(grid, 1.0)?)
    } else {
        Problem::new(&surface, &Boussinesq::new(grid, 1.0)?)
    }
}

/// Nodes in patches of contact, some three in five.
fn is_in(grid: Grid) -> impl Fn(usize) -> bool {
    move |node| {
        let (ix, iy) = grid.coordinates(node);
        let [x, y] = [ix, iy].map(|i| i as f64);
        libm::sin(0.7 * x + 0.2 * y) + libm::cos(0.9 * y - 0.3 * x) + 0.6 * libm::sin(2.3 * x * y)
            > -0.3
    }
}

/// The answers to some nodes, and their complement relative to the coefficient of a node on itself.
fn complement(problem: &Problem, watched: &[usize]) -> (Vec<Wide>, nalgebra::DMatrix<f64>) {
    let grid = problem.grid();
    let mut set = NodeSet::new(grid.nodes());
    set.assign(is_in(grid));
    let neighbourhood = Neighbourhood::new(problem);
    let (table, grouping) = (problem.table(), neighbourhood.grouping(problem.table()));
    let answer = |&node: &usize| neighbourhood.solve_wide(table, &set, grouping, node);
    let answers: Vec<Wide> = watched.iter().map(answer).collect();
    let size = watched.len();
    let mut matrix = nalgebra::DMatrix::zeros(size, size);
    schur(problem, &answers, (&neighbourhood, grouping), matrix.as_mut_slice());
    (answers, matrix / problem.table().self_influence())
}

/// `s_iᵀ C s_j` as it stands.
fn energy(problem: &Problem, a: &Local, b: &Local) -> f64 {
    let table = problem.table();
    let terms = |local: &Local| -> Vec<(usize, f64)> {
        let answers = local.contact.iter().zip(&local.weights);
        std::iter::once((table.place(local.node), 1.0))
            .chain(answers.map(|(&node, x)| (table.place(node as usize), -x)))
            .collect()
    };
    let b = terms(b);
    terms(a).iter().map(|&(place, p)| p * displacement(table, place, &b)).sum()
}

/// Nodes out of contact closest to some places.
fn watched(grid: Grid, places: &[(usize, usize)]) -> Vec<usize> {
    let is_in = is_in(grid);
    let free = |&(x, y): &(usize, usize)| {
        let away = |node: &usize| {
            let (ix, iy) = grid.coordinates(*node);
            ix.abs_diff(x).pow(2) + iy.abs_diff(y).pow(2)
        };
        (0..grid.nodes()).filter(|&node| !is_in(node)).min_by_key(away).unwrap_or_default()
    };
    places.iter().map(free).collect()
}

/// Of a source with itself to rounding; of others near and far as it stands, but for what groups outside of a patch and sources far
/// away are interpolated by.
#[test]
fn complements_are_those_of_their_sources() -> Result<(), Error> {
    for periodic in [false, true] {
        let grid = Grid::new(200, 40, 1.0, 1.0)?;
        let problem = flat(grid, periodic)?;
        let nodes = watched(
            grid,
            &[(10, 20), (16, 22), (40, 5), (60, 30), (100, 20), (150, 10), (190, 20)],
        );
        let (answers, found) = complement(&problem, &nodes);
        let unit = problem.table().self_influence();
        for (j, b) in answers.iter().enumerate() {
            assert!(b.nearest >= 80 && b.groups.len() > 20, "{} {}", b.nearest, b.groups.len());
            for (i, a) in answers.iter().enumerate().skip(j) {
                let expected = energy(&problem, &a.local, &b.local) / unit;
                let error = (found[(i, j)] - expected).abs();
                // Rounding of a transform; and a thousandth of what two sources with a net pressure of some hundredths do to each other.
                let most = if i == j { 1e-11 } else { 1e-5 };
                assert!(error < most, "{periodic} {i} {j}: {error:e} of {expected:e}");
            }
        }
    }
    Ok(())
}

/// The exact complement is less, and closer than without groups.
#[test]
fn groups_leave_out_less() -> Result<(), Error> {
    for periodic in [false, true] {
        let grid = Grid::new(40, 36, 1.0, 1.0)?;
        let problem = flat(grid, periodic)?;
        let nodes = watched(grid, &[(20, 18), (23, 17), (9, 30), (35, 3)]);
        let (answers, found) = complement(&problem, &nodes);
        let size = nodes.len();
        let alone: Vec<Local> = answers.iter().map(Wide::nearest_alone).collect();
        let mut without = nalgebra::DMatrix::zeros(size, size);
        galerkin::schur(&problem, &alone, without.as_mut_slice());
        let mut exact = Schur::default();
        let is_in = is_in(grid);
        let contact = (0..grid.nodes()).filter(|&node| is_in(node));
        let contact = ContactSequence::with_order(grid, contact)?;
        Dense.watch(&problem, &contact, &nodes, &mut exact)?;
        let unit = problem.table().self_influence();
        for k in 0..size {
            let exact = exact.entry(k, k) / unit;
            let (own, alone) = (found[(k, k)] - exact, without[(k, k)] / unit - exact);
            // Weights are of single precision, and enter by their square.
            assert!(own > -1e-9 && own < 0.25 * alone, "{periodic} {k}: {own:e} {alone:e}");
        }
    }
    Ok(())
}
