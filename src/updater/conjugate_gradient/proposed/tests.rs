use super::*;
use crate::updater::Solution;
use crate::{Error, test_chain};

/// Nodes 1 and 3 of a row are watched beside 0 and 2 in contact: x = (1/4, 1/4) and 1/4 of node 2, and
/// S = (4 − 1/2, −1/4; −1/4, 4 − 1/4). Their gaps are 1 m and 3 m.
fn proposed() -> Result<(Problem, Proposed), Error> {
    let problem = test_chain::problem(&[0.0, 1.0, 2.0, 3.0, 9.0])?;
    let local = |node: usize, contact: &[u32]| Local {
        node,
        contact: contact.to_vec(),
        weights: vec![0.25; contact.len()],
    };
    let mut complement = Schur::default();
    complement.resize(2)?;
    // Above the diagonal there is nothing.
    let matrix = [3.5, -0.25, f64::NAN, 3.75];
    complement.as_mut_slice().copy_from_slice(&matrix);
    complement.row_sums_mut().copy_from_slice(&[7.0, 1.5]);
    let proposed = Proposed {
        locals: vec![local(1, &[0, 2]), local(3, &[2])],
        outside: 2,
        count: 2,
        complement,
    };
    Ok((problem, proposed))
}

fn near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        // Rounding errors of a few numbers up to 10.
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
}

/// At the approach 4 nodes 0 and 2 carry 1 and 1/2, and node 1 sinks by 1.5 of the 3 m that it overlaps: it takes
/// 1.5/3.5, and a quarter of that off each neighbour.
#[test]
fn nodes_that_join_are_carried() -> Result<(), Error> {
    let (problem, proposed) = proposed()?;
    let mut field = Field {
        pressure: vec![1.0, 0.0, 0.5, 0.0, 0.0],
        displacement: vec![4.0, 1.5, 2.0, 0.5, 0.0],
        drift: 0.0,
    };
    let overlap = |node: usize| 4.0 - problem.initial_gap()[node];
    let one = 1.5 / 3.5;
    // Ways are pressures times what they displace, 4.
    let carried = |field: &Field, joined: &[usize]| {
        let (pressure, way) =
            proposed.carried(&problem, field, Change { joined, fixed: &[] }, overlap);
        (pressure, way / 4.0)
    };
    let (pressure, sum) = carried(&field, &[1]);
    near(&pressure, &[1.0 - one / 4.0, one, 0.5 - one / 4.0, 0.0, 0.0]);
    near(&[sum], &[one]);
    // Both, with what is left of 3 m and 1 m: 1.5 and 0.5. 3.5 · 3.75 − 1/16 = 13.0625.
    let p1 = (1.5 * 3.75 + 0.5 * 0.25) / 13.0625;
    let p3 = (0.5 * 3.5 + 1.5 * 0.25) / 13.0625;
    for joined in [[1, 3], [3, 1]] {
        let (pressure, sum) = carried(&field, &joined);
        near(&pressure, &[1.0 - p1 / 4.0, p1, 0.5 - p1 / 4.0 - p3 / 4.0, p3, 0.0]);
        near(&[sum], &[p1 + p3]);
    }
    // Nobody, a node that was not watched, and displacements that are not known.
    for joined in [&[][..], &[4], &[1, 4]] {
        assert_eq!(carried(&field, joined), (field.pressure.clone(), 0.0));
    }
    field.displacement.clear();
    assert_eq!(carried(&field, &[1]), (field.pressure.clone(), 0.0));
    Ok(())
}

/// Row sums of 7 and 1.5 are left: 7/3.5 is carried by node 1.
#[test]
fn row_sums_are_carried() -> Result<(), Error> {
    let (problem, proposed) = proposed()?;
    for (contact, follows, expected) in [
        (&[0, 2][..], true, [1.0; 5]),
        (&[2, 0, 1], true, [0.5, 3.0, 0.5, 1.0, 1.0]),
        (&[0, 2, 4], false, [1.0; 5]),
        (&[0], true, [1.0; 5]),
    ] {
        let contact = ContactSequence::with_order(problem.grid(), contact.iter().copied())?;
        let mut pressure = vec![1.0; 5];
        assert_eq!(proposed.carry_row_sums(&contact, &mut pressure), follows);
        near(&pressure, &expected);
    }
    Ok(())
}

/// The same as found from the problem: in single precision, and with row sums as they are told.
#[test]
fn nodes_are_proposed() -> Result<(), Error> {
    let (problem, expected) = proposed()?;
    let contact = ContactSequence::with_order(problem.grid(), [0, 2])?;
    let mut solver = Solver::new(&problem);
    solver.choose(&contact, 2);
    let beside = (&Neighbourhood::new(&problem), &solver);
    let mut found = Proposed::new(&problem, beside, [&[1, 3], &[]], 2)?;
    found.tell_row_sums(|local| local.node as f64);
    assert_eq!((found.count, found.complement().size()), (2, 2));
    assert_eq!(found.complement().row_sums(), [1.0, 3.0]);
    for (i, j) in [(0, 0), (1, 0), (1, 1)] {
        let [found, expected] = [&found, &expected].map(|all| all.complement().entry(i, j));
        assert!((found - expected).abs() < 1e-6, "{i} {j}: {found}");
    }
    Ok(())
}

/// A solution at the approach 4 that leaves 1/2, 1 and 1/4 at nodes 0, 1 and 2, and 1/4, 1/2 and 1 of the rates.
fn solved(count: usize) -> Equilibrium {
    let of = |displacement: [f64; 5]| Field {
        pressure: vec![1.0; 5],
        displacement: displacement.to_vec(),
        drift: 0.0,
    };
    Equilibrium {
        count,
        approach: 4.0,
        serves: 1.0,
        load: of([3.5, 2.0, 1.75, 0.5, 0.0]),
        rate: of([0.75, 0.5, 0.0, 0.25, 0.0]),
    }
}

/// Displacements and what residuals nearby add to them: (1/2 + 1/4)/4 and 1/16, and of rates (1/4 + 1)/4 and 1/4.
#[test]
fn residuals_improve_displacements() -> Result<(), Error> {
    let (problem, proposed) = proposed()?;
    let improved = proposed.improved(&problem, &solved(2));
    near(&improved.concat(), &[2.1875, 0.8125, 0.5625, 0.5]);
    Ok(())
}

/// Nodes 3 and 1 have joined in this order, and the contact has been put into another one since: what changes is found
/// by node.
#[test]
fn improvements_follow_a_contact_into_another_order() -> Result<(), Error> {
    let (problem, proposed) = proposed()?;
    let improved = |order: [usize; 4]| -> Result<Vec<f64>, Error> {
        let contact = ContactSequence::with_order(problem.grid(), order)?;
        let mut found = Solved {
            solution: Solution { pressure: vec![0.0; 4], rate: vec![0.0; 4] },
            displacement: [vec![0.0; 5], vec![0.0; 5]],
        };
        let change = Change { joined: &[3, 1], fixed: &[] };
        proposed.improve(&problem, &contact, &solved(4), change, &mut found);
        let Solution { pressure, rate } = found.solution;
        let places = contact.places();
        let of_nodes = [0, 2, 1, 3].map(|node| places[node].map(|k| [pressure[k], rate[k]]));
        Ok(of_nodes.into_iter().flatten().flatten().collect())
    };
    let found = improved([0, 2, 1, 3])?;
    assert!(found[4..].iter().all(|value| value.abs() > 1e-3), "{found:?}");
    near(&found, &improved([0, 2, 3, 1])?);
    Ok(())
}

/// Of node 1, which has joined, 1 − 3/16 is left, so that its pressure changes by 13/16 over 3.5, and the displacement
/// of node 3 by 1/16 and −1/4 of that. Of rates it is 1/2 − 5/16, and 1/4.
#[test]
fn residuals_improve_solutions_inside_a_window() -> Result<(), Error> {
    let (problem, proposed) = proposed()?;
    let contact = ContactSequence::with_order(problem.grid(), [0, 2, 1])?;
    let fresh = || Solved {
        solution: Solution { pressure: vec![1.0, 2.0, 3.0], rate: vec![4.0, 5.0, 6.0] },
        displacement: [vec![0.0; 5], vec![10.0; 5]],
    };
    let flat = |solved: &Solved| {
        let (Solution { pressure, rate }, [u, u_rate]) = (&solved.solution, &solved.displacement);
        [&pressure[..], rate, u, u_rate].concat()
    };
    let improved = |equilibrium: &Equilibrium| {
        let mut solved = fresh();
        let mut contact = contact.clone();
        contact.truncate(equilibrium.count);
        let change = Change { joined: &contact.order()[2..], fixed: &[] };
        proposed.improve(&problem, &contact, equilibrium, change, &mut solved);
        flat(&solved)
    };
    let [change, of_rate] = [0.8125 / 3.5, 0.1875 / 3.5];
    let found = improved(&solved(3));
    let mut expected = fresh();
    expected.solution.pressure[2] += change;
    expected.solution.rate[2] += of_rate;
    expected.displacement[0][3] += 0.0625 - 0.25 * change;
    expected.displacement[1][3] += 0.25 - 0.25 * of_rate;
    near(&found, &flat(&expected));
    // Without a rate that stays as it is.
    let mut without = solved(3);
    without.rate.displacement.clear();
    let found = improved(&without);
    (expected.solution.rate, expected.displacement[1]) = (fresh().solution.rate, vec![10.0; 5]);
    near(&found, &flat(&expected));
    // Before any of them has joined, all displacements improve and no pressure does.
    let found = improved(&solved(2));
    expected = fresh();
    expected.displacement[0][1] += 0.1875;
    expected.displacement[0][3] += 0.0625;
    expected.displacement[1][1] += 0.3125;
    expected.displacement[1][3] += 0.25;
    near(&found, &flat(&expected));
    // Where a node has joined that was not proposed, nothing is known.
    let mut same = fresh();
    let change = Change { joined: &[4], fixed: &[] };
    proposed.improve(&problem, &contact, &solved(3), change, &mut same);
    assert_eq!(flat(&same), flat(&fresh()));
    Ok(())
}
