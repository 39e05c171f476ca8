//! Proposals of both kinds, and solutions behind yields, against dense ones.

use nalgebra::{DMatrix, DVector};

use super::*;
use crate::surface::{Amplitude, SelfAffine};
use crate::updater::conjugate_gradient::ConjugateGradient;
use crate::updater::{Behind, Beside, Dense, Iterations, LinearUpdater, Proposal, Solution};
use crate::{Boundary, Boussinesq, Grid, InfluenceKernel, PeriodicBoussinesq, Spectral};

/// A rough surface on three bodies, of `nx` × `ny` nodes.
fn problems(nx: usize, ny: usize) -> Result<Vec<Problem>, Error> {
    let grid = Grid::new(nx, ny, 1.0, 1.25)?;
    let surface = SelfAffine::new(0.8, 8.0, 3.0, Amplitude::RmsHeight(0.1), 3)?;
    let kernels: [&dyn InfluenceKernel; 3] = [
        &Boussinesq::new(grid, 2.0)?,
        &PeriodicBoussinesq::new(grid, 2.0)?,
        &Spectral::new(grid, 2.0)?,
    ];
    kernels.into_iter().map(|kernel| Problem::new(&surface, kernel)).collect()
}

/// Nodes in the order of their gaps.
fn by_gap(problem: &Problem) -> Vec<usize> {
    let gap = problem.initial_gap();
    let mut nodes: Vec<usize> = (0..gap.len()).collect();
    nodes.sort_by(|a, b| gap[*a].total_cmp(&gap[*b]));
    nodes
}

/// Displacements under pressures on some nodes.
fn displaced(problem: &Problem, pressures: &[(usize, f64)]) -> Result<Vec<f64>, Error> {
    let mut field = vec![0.0; problem.grid().nodes()];
    pressures.iter().for_each(|&(node, p)| field[node] += p);
    let mut displacement = vec![0.0; field.len()];
    problem.convolution().apply(&field, &mut displacement)?;
    Ok(displacement)
}

/// The nodes that have yielded, their pressures, and what these displace.
struct Load {
    nodes: Vec<(usize, f64)>,
    load: Vec<f64>,
    unit: Vec<f64>,
}

impl Load {
    fn of(problem: &Problem, nodes: &[(usize, f64)]) -> Result<Self, Error> {
        let ones: Vec<(usize, f64)> = nodes.iter().map(|&(node, _)| (node, 1.0)).collect();
        let (load, unit) = (displaced(problem, nodes)?, displaced(problem, &ones)?);
        Ok(Self { nodes: nodes.to_vec(), load, unit })
    }

    fn on(&self, surface: &Problem) -> Problem {
        surface.under_load(&self.load, &self.unit)
    }

    /// With a hardness for each node, or one for all of them.
    fn beside<'a>(&'a self, surface: &Problem, hardness: Option<f64>) -> Beside<'a> {
        let row_sum = (surface.boundary() == Boundary::Periodic).then(|| surface.row_sums()[0]);
        Beside { unit: &self.unit, load: &self.load, hardness, row_sum }
    }
}

/// The matrix M and what sums answer, from dense solutions.
fn dense(
    problem: &Problem,
    contact: &ContactSequence,
    [outside, inside]: [&[usize]; 2],
    load: &Load,
) -> Result<(Schur, Vec<[f64; 3]>), Error> {
    let place = |node: &usize| contact.order().iter().position(|other| other == node);
    let positions: Vec<usize> = inside.iter().filter_map(place).collect();
    let mut schur = Schur::default();
    Dense.watch_both(problem, contact, outside, &positions, &mut schur)?;
    let rhs = |node: usize| [problem.row_sums()[node], -load.unit[node], -load.load[node]];
    let mut sums: Vec<[f64; 3]> = outside.iter().map(|&node| rhs(node)).collect();
    sums.extend(vec![[0.0; 3]; inside.len()]);
    for k in 0..3 {
        let mut solved: Vec<[f64; 2]> =
            contact.order().iter().map(|&node| [rhs(node)[k], 0.0]).collect();
        Dense.solve_for(problem, contact, &mut solved)?;
        for (sum, &node) in sums.iter_mut().zip(outside) {
            for (&other, [value, _]) in contact.order().iter().zip(&solved) {
                sum[k] -= problem.coefficient(node, other).unwrap_or(f64::NAN) * value;
            }
        }
        for (sum, &position) in sums[outside.len()..].iter_mut().zip(&positions) {
            sum[k] = solved[position][0];
        }
    }
    Ok((schur, sums))
}

/// The greatest difference from dense entries, each over the root of both diagonals.
fn apart(found: &Schur, exact: &Schur) -> f64 {
    let mut worst: f64 = 0.0;
    for j in 0..exact.size() {
        for i in j..exact.size() {
            let scale = (exact.entry(i, i) * exact.entry(j, j)).abs().sqrt();
            worst = worst.max((found.entry(i, j) - exact.entry(i, j)).abs() / scale);
        }
    }
    worst
}

/// With all of the contact near each node matrices are exact but for single precision, and lines are those of the dense
/// solution, residuals and all. What sums answer is solved for to 3·10⁻³ of the right-hand side.
#[test]
fn proposals_beside_few_nodes_are_exact() -> Result<(), Error> {
    for problem in problems(14, 12)? {
        let nodes = by_gap(&problem);
        let yielded: Vec<(usize, f64)> =
            nodes[..20].iter().map(|&node| (node, 0.5 + 0.01 * (node % 7) as f64)).collect();
        let load = Load::of(&problem, &yielded)?;
        let elastic = load.on(&problem);
        let contact = ContactSequence::with_order(problem.grid(), nodes[20..100].iter().copied())?;
        let (outside, inside) = (&nodes[100..112], &nodes[20..32]);
        let mut updater = ConjugateGradient::new();
        let mut solved = Solved::default();
        updater.advance(&Behind::on(&elastic, &contact, 30.0), 1.0, &mut solved)?;
        let mut schur = Schur::default();
        for hardness in [None, Some(0.5)] {
            let beside = load.beside(&problem, hardness);
            let found: Proposal = updater.propose(
                &elastic,
                &contact,
                [outside, inside],
                Some(&beside),
                &mut schur,
            )?;
            let (exact, sums) = dense(&elastic, &contact, [outside, inside], &load)?;
            let error = apart(&schur, &exact);
            assert!(error < 1e-5, "{error:e}");
            let mut solution = Solution::default();
            Dense.solve(&elastic, &contact, contact.len(), 30.0, &mut solution)?;
            let pressed: Vec<(usize, f64)> =
                contact.order().iter().copied().zip(solution.pressure.iter().copied()).collect();
            let displacement = displaced(&problem, &pressed)?;
            for (k, &node) in outside.iter().chain(inside).enumerate() {
                let expected = match k.checked_sub(outside.len()) {
                    None => displacement[node],
                    Some(q) => solution.pressure[q],
                };
                // Residuals of 3·10⁻⁷ of the approach, of which local solutions know all but single precision.
                let error = (found.lines[k][0] - expected).abs();
                assert!(error < 1e-8 * 30.0, "{k}: {} {expected}", found.lines[k][0]);
            }
            for which in 0..3 {
                if which == 2 && hardness.is_some() {
                    // Another hardness than that of the load: a multiple.
                    assert!(found.sums.iter().all(|sums| sums[2] == 0.5 * sums[1]));
                    continue;
                }
                for part in [0..outside.len(), outside.len()..sums.len()] {
                    let most =
                        sums[part.clone()].iter().map(|s| s[which].abs()).fold(0.0, f64::max);
                    for k in part {
                        let error = (found.sums[k][which] - sums[k][which]).abs();
                        assert!(error < 1e-2 * most, "{which} {k}: {error:e} of {most:e}");
                    }
                }
            }
        }
    }
    Ok(())
}

/// Beside 260 nodes, of which local solutions see 144: errors of second order, and never of the other sign.
#[test]
fn proposals_beside_many_nodes_are_of_second_order() -> Result<(), Error> {
    for problem in problems(20, 20)? {
        let nodes = by_gap(&problem);
        let load = Load::of(&problem, &[])?;
        let elastic = load.on(&problem);
        let contact = ContactSequence::with_order(problem.grid(), nodes[..260].iter().copied())?;
        let (outside, inside) = (&nodes[260..280], &nodes[..20]);
        let mut updater = ConjugateGradient::new();
        updater.advance(&Behind::on(&elastic, &contact, 30.0), 1.0, &mut Solved::default())?;
        let mut schur = Schur::default();
        let beside = load.beside(&problem, Some(1.0));
        updater.propose(&elastic, &contact, [outside, inside], Some(&beside), &mut schur)?;
        let (exact, _) = dense(&elastic, &contact, [outside, inside], &load)?;
        let error = apart(&schur, &exact);
        assert!(error < 5e-3, "{error:e}");
        let size = schur.size();
        let scale = |i: usize| exact.entry(i, i).abs().sqrt().recip();
        let excess = DMatrix::from_fn(size, size, |i, j| {
            scale(i) * scale(j) * (schur.entry(i, j) - exact.entry(i, j))
        });
        let least = excess.symmetric_eigenvalues().min();
        // Single precision.
        assert!(least > -1e-5, "{least:e}");
    }
    Ok(())
}

/// From a solution on: two of the contact yield, three nodes join, and one touches and yields. Pressures, rates and
/// displacements there, and at a state in between, are those of dense solutions; going back, all is as before.
#[test]
fn solutions_behind_yields_are_exact() -> Result<(), Error> {
    for problem in problems(14, 12)? {
        let nodes = by_gap(&problem);
        let before = Load::of(&problem, &[(nodes[0], 0.75), (nodes[3], 0.5)])?;
        let elastic = before.on(&problem);
        let order = nodes[..60].iter().copied().filter(|node| ![nodes[0], nodes[3]].contains(node));
        let contact = ContactSequence::with_order(problem.grid(), order)?;
        let mut updater = ConjugateGradient::new();
        let mut solved = Solved::default();
        updater.advance(&Behind::on(&elastic, &contact, 12.0), 0.5, &mut solved)?;
        let mut schur = Schur::default();
        let proposed = [&nodes[60..70], &nodes[4..12]];
        let beside = before.beside(&problem, None);
        updater.propose(&elastic, &contact, proposed, Some(&beside), &mut schur)?;
        // At the end, and in between.
        let end =
            (vec![nodes[60], nodes[62], nodes[61]], vec![nodes[5], nodes[9], nodes[64]], 12.5);
        let between = (vec![nodes[60]], vec![nodes[5]], 12.25);
        for (joined, yields, approach) in [end.clone(), between, end] {
            let yielded: Vec<(usize, f64)> = yields.iter().map(|&node| (node, 0.8)).collect();
            let load = Load::of(&problem, &yielded)?;
            let behind = load.on(&elastic);
            let mut after = contact.clone();
            for node in yields {
                let _ = after.remove(node);
            }
            for node in joined {
                after.push(node)?;
            }
            let mut exact = Solution::default();
            Dense.solve(&behind, &after, after.len(), approach, &mut exact)?;
            let of = |values: &[f64]| -> Vec<(usize, f64)> {
                after.order().iter().copied().zip(values.iter().copied()).collect()
            };
            let displacements = [&exact.pressure, &exact.rate].map(|p| displaced(&problem, &of(p)));
            let state = Behind {
                problem: &behind,
                contact: &after,
                yielded: &load.nodes,
                load: &load.load,
                approach,
            };
            let off = |found: &[f64], expected: &[f64]| {
                let expected = DVector::from_column_slice(expected);
                (DVector::from_column_slice(found) - &expected).amax() / expected.amax()
            };
            if approach == 12.25 {
                let found = updater.probe(&state, 0.0)?;
                let [u, _] = displacements;
                // Gaps are exact to some 10⁻⁸ of the approach inside a path.
                let errors = [
                    off(&found.solution.pressure, &exact.pressure),
                    off(&found.displacement[0], &u?),
                ];
                assert!(errors.iter().all(|error| *error < 1e-6), "{errors:?}");
                continue;
            }
            updater.advance(&state, 0.5, &mut solved)?;
            let [u, u_rate] = displacements;
            let errors = [
                off(&solved.solution.pressure, &exact.pressure),
                off(&solved.displacement[0], &u?),
                off(&solved.solution.rate, &exact.rate),
                off(&solved.displacement[1], &u_rate?),
            ];
            // Rates have residuals of 10⁻⁵.
            assert!(errors[..2].iter().all(|error| *error < 1e-6), "{errors:?}");
            assert!(errors[2..].iter().all(|error| *error < 1e-4), "{errors:?}");
            let mut alone = Solution::default();
            updater.solve_apart(&behind, &after, after.len(), approach, &mut alone)?;
            assert!(off(&alone.pressure, &exact.pressure) < 1e-8);
            // What sums answer follows.
            let all = Load::of(&problem, &[&before.nodes[..], &load.nodes].concat())?;
            let beside = all.beside(&problem, None);
            let next = [&nodes[70..75], &nodes[20..25]];
            if updater.solutions.as_ref().is_some_and(|known| known.count() == after.len()) {
                let mut clone = updater.clone();
                let found = clone.propose(&behind, &after, next, Some(&beside), &mut schur)?;
                let (_, sums) = dense(&behind, &after, next, &all)?;
                for which in 0..3 {
                    for part in [0..5, 5..10] {
                        let sums = &sums[part.clone()];
                        let most = sums.iter().map(|s| s[which].abs()).fold(0.0, f64::max);
                        for (found, exact) in found.sums[part].iter().zip(sums) {
                            let error = (found[which] - exact[which]).abs();
                            assert!(error < 1e-2 * most, "{which}: {error:e} of {most:e}");
                        }
                    }
                }
            }
            updater.cut(&elastic, &contact)?;
            let mut back = Solved::default();
            updater.advance(&Behind::on(&elastic, &contact, 12.0), 0.5, &mut back)?;
            let mut exact = Solution::default();
            Dense.solve(&elastic, &contact, contact.len(), 12.0, &mut exact)?;
            assert!(off(&back.solution.pressure, &exact.pressure) < 1e-6);
        }
    }
    Ok(())
}
