//! A path against single loads, each solved by itself.

use std::error::Error;

use asperity::contact::ContactSequence;
use asperity::kernel::KernelTable;
use asperity::surface::HeightMap;
use asperity::updater::{ConjugateGradient, LinearUpdater, Solution};
use asperity::{FixedLoadSolver, Problem};

use crate::recorded::Event;

/// Residuals of the fixed loads, relative to the lengths of the problem.
const TOLERANCE: f64 = 1e-11;

/// Solves for loads half-way between two events, spread evenly over the path, and prints how contact and
/// stiffness differ.
pub(crate) fn compare(
    states: &[Event],
    surface: &HeightMap,
    kernel: &KernelTable,
    loads: usize,
) -> Result<(), Box<dyn Error>> {
    let problem = Problem::new(surface, kernel)?;
    let grid = problem.grid();
    let order: Vec<usize> =
        states.iter().map(|event| event.node.0 + grid.nx() * event.node.1).collect();
    let mut solver = FixedLoadSolver::builder(surface, kernel).tolerance(TOLERANCE).build()?;
    let (mut sets, mut worst) = (0, 0.0_f64);
    for k in 1..=loads {
        let count = (states.len() - 2) * k / (loads + 1) + 1;
        let (state, next) = (&states[count - 1], &states[count]);
        let load = 0.5 * (state.load + next.load);
        let solution = solver.solve(load)?;
        let mut expected = vec![false; grid.nodes()];
        order[..count].iter().for_each(|&node| expected[node] = true);
        let different = expected.iter().zip(&solution.fields.contact_map);
        let different = different.filter(|(a, b)| a != b).count();
        sets += usize::from(different > 0);
        // The exact stiffness of the path's contact.
        let contact = ContactSequence::with_order(grid, order[..count].iter().copied())?;
        let mut exact = Solution::default();
        let approach = state.approach;
        ConjugateGradient::new().solve(&problem, &contact, count, approach, &mut exact)?;
        let stiffness = grid.cell_area() * exact.rate.iter().sum::<f64>();
        let found = solution.contact.contact_stiffness.unwrap_or(f64::NAN);
        let error = (stiffness / found - 1.0).abs();
        let between = (state.contact_stiffness / found - 1.0).abs();
        worst = worst.max(error);
        println!(
            "  {count} nodes, load {load:e}: {different} nodes differ, stiffness of the contact {error:.1e}, \
             of the state {between:.1e}"
        );
    }
    println!("{loads} fixed loads: {sets} other contacts, stiffness within {worst:.1e}");
    Ok(())
}
