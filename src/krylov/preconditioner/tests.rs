use std::borrow::Cow;

use nalgebra::DMatrix;

use super::*;
use crate::convolution::Convolution;
use crate::krylov::{Directions, Equation, Field, LinearSystem, Operator};
use crate::surface::{Amplitude, SelfAffine};
use crate::{Boussinesq, Error, FixedLoadSolver, Grid, PeriodicBoussinesq};

fn free(nx: usize, ny: usize) -> Result<KernelTable, Error> {
    KernelTable::new(&Boussinesq::new(Grid::new(nx, ny, 1.0, 1.2)?, 1.0)?)
}

fn periodic(nx: usize, ny: usize) -> Result<KernelTable, Error> {
    let table = KernelTable::new(&PeriodicBoussinesq::new(Grid::new(nx, ny, 1.0, 1.2)?, 1.0)?)?;
    let gauge = table.computing_gauge().unwrap_or_default();
    Ok(table.in_gauge(gauge))
}

/// Strips of contact with holes.
fn strips(table: &KernelTable) -> NodeSet {
    let (nx, ny) = table.grid().shape();
    let mut contact = NodeSet::new(nx * ny);
    contact.assign(|node| {
        let (x, y) = (node % nx, node / nx);
        (x + 2 * y) % 37 < 9 && (node * 7919) % 5 != 0 && x < 2 * nx / 3
    });
    contact
}

#[test]
fn symmetric_and_positive_definite() -> Result<(), Error> {
    for table in [free(96, 96)?, periodic(101, 90)?, free(40, 256)?] {
        let mut contact = strips(&table);
        // Few enough for a dense matrix, enough for hat functions.
        let (nodes, places) = (contact.nodes().to_vec(), contact.places().to_vec());
        let step = (nodes.len() as u32).div_ceil(450);
        contact.assign(|node| places[node] != NodeSet::NONE && places[node] % step == 0);
        let mut preconditioner = Preconditioner::new(&table);
        preconditioner.update(&contact);
        let useful = preconditioner.coarse.as_ref().map(CoarseSpace::is_useful);
        assert_eq!(useful, Some(true), "{} nodes", contact.len());
        let n = contact.len();
        let mut dense = DMatrix::zeros(n, n);
        let (mut unit, mut column) = (vec![0.0; n], Vec::new());
        for j in 0..n {
            unit[j] = 1.0;
            preconditioner.apply(&unit, &mut column);
            dense.column_mut(j).copy_from_slice(&column);
            unit[j] = 0.0;
        }
        let asymmetry = (&dense - dense.transpose()).amax();
        assert!(asymmetry < 1e-5 * dense.amax(), "{asymmetry:e}");
        let eigenvalues = ((&dense + dense.transpose()) / 2.0).symmetric_eigenvalues();
        let least = eigenvalues.min() * table.self_influence();
        assert!(least > 0.1, "{least}");
    }
    Ok(())
}

#[test]
fn takes_fewer_steps_than_the_sparse_inverse() -> Result<(), Error> {
    let grid = Grid::square(96, 1.0)?;
    let kernel = Boussinesq::new(grid, 1.0)?;
    let surface = SelfAffine::new(0.8, 0.5, 4.0 / 96.0, Amplitude::RmsHeight(1e-3), 3)?;
    let mut solver = FixedLoadSolver::builder(&surface, &kernel).stiffness(false).build()?;
    let solution = solver.solve(0.03)?;
    let table = KernelTable::new(&kernel)?;
    let mut contact = NodeSet::new(grid.nodes());
    contact.assign(|node| solution.fields.contact_map[node]);
    assert!(contact.len() > grid.nodes() / 3, "{} nodes", contact.len());
    let mut preconditioner = Preconditioner::new(&table);
    preconditioner.update(&contact);
    let mut operator = Operator::new(Convolution::from_table(&table)?);
    let mut steps = |preconditioner: &mut Preconditioner| {
        let mut system =
            LinearSystem { operator: &mut operator, preconditioner, contact: &contact };
        let equation = Equation {
            rhs: |_| 1.0,
            tolerance: 1e-9,
            most_drift: f64::INFINITY,
            max_iterations: 1000,
        };
        let nothing = Field::zero(grid.nodes());
        let start = nothing.pressure.clone();
        let solved =
            system.solve(&equation, start, Cow::Owned(nothing), &mut Directions::default());
        solved.map(|(_, iterations)| iterations)
    };
    let two = steps(&mut preconditioner)?;
    preconditioner.coarse = None;
    let one = steps(&mut preconditioner)?;
    assert!(4 * two <= 3 * one, "{two} steps instead of {one}");
    Ok(())
}

/// Few nodes less, and back: the sparse part and the sums of hat functions are those of the set at any time.
#[test]
fn follows_small_changes() -> Result<(), Error> {
    for table in [free(200, 130)?, periodic(128, 96)?, periodic(130, 99)?] {
        let mut contact = strips(&table);
        let mut followed = Preconditioner::new(&table);
        followed.update(&contact);
        let all = contact.nodes().to_vec();
        let mut inside: Vec<bool> =
            (0..table.grid().nodes()).map(|node| contact.places()[node] != NodeSet::NONE).collect();
        let mut node = 12_345;
        for round in 0..6 {
            for _ in 0..contact.len() / 200 {
                node = (node * 1_103_515_245 + 12_345) % all.len();
                let toggled = &mut inside[all[node] as usize];
                *toggled = !*toggled;
            }
            contact.assign(|node| inside[node]);
            followed.update(&contact);
            let mut fresh = Preconditioner::new(&table);
            fresh.update(&contact);
            let r: Vec<f64> = (0..contact.len()).map(|i| (0.1 * i as f64).cos()).collect();
            let (mut z, mut expected) = (Vec::new(), Vec::new());
            followed.sparse().apply(&r, &mut z);
            fresh.sparse().apply(&r, &mut expected);
            assert_eq!(z, expected, "round {round}");
            followed.apply(&r, &mut z);
            fresh.apply(&r, &mut expected);
            let (mut error, mut scale) = (0.0_f64, 0.0_f64);
            for (z, expected) in z.iter().zip(&expected) {
                error = error.max((z - expected).abs());
                scale = scale.max(expected.abs());
            }
            // E is that of an earlier set.
            assert!(error < 0.05 * scale, "{error:e} of {scale:e}");
        }
    }
    Ok(())
}

#[test]
fn the_same_with_any_number_of_threads() -> Result<(), Error> {
    let table = free(160, 170)?;
    let contact = strips(&table);
    let apply = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.map(|pool| {
            pool.install(|| {
                let mut preconditioner = Preconditioner::new(&table);
                preconditioner.update(&contact);
                let r: Vec<f64> = (0..contact.len()).map(|i| (0.3 * i as f64).sin()).collect();
                let mut z = Vec::new();
                preconditioner.apply(&r, &mut z);
                z
            })
        })
    };
    let results = [1, 2, 3].map(|threads| apply(threads).ok());
    assert!(results[0].is_some());
    assert_eq!(results[0], results[1]);
    assert_eq!(results[0], results[2]);
    Ok(())
}
