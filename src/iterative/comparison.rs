//! Preconditioners beside each other: not a test of anything, but the table in
//! `docs/performance.md` and the choice of [`NEIGHBOURS`](super::sparse_inverse::NEIGHBOURS) rest on it.
//!
//! ```text
//! cargo test --release --lib preconditioners -- --ignored --nocapture
//! ```

use std::time::Instant;

use super::{ContactSet, Directions, Operator, SparseInverse, add_scaled, dot, greatest};
use crate::convolution::Convolution;
use crate::kernel::KernelTable;
use crate::surface::{Amplitude, HeightMap, SelfAffine};
use crate::{Boussinesq, Error, FixedLoadSolver, Grid};

const SIDE: usize = 512;
const TOLERANCE: f64 = 1e-10;

/// An approximate inverse of the influence matrix of a contact set.
type Preconditioner<'a> = Box<dyn FnMut(&[f64], &mut Vec<f64>) + 'a>;

/// Iterations and seconds for $C_{II}\\, y_2 = e$ in double precision.
fn solve(
    operator: &mut Operator,
    contact: &ContactSet,
    mut apply: Preconditioner,
) -> Result<(usize, f64), Error> {
    let start = Instant::now();
    let mut residual = vec![1.0_f64; contact.len()];
    let mut x = vec![0.0; contact.len()];
    let (mut z, mut directions) = (Vec::new(), Directions::default());
    let mut iterations = 0;
    while greatest(residual.len(), 0.0, |i| residual[i].abs()) > TOLERANCE && iterations < 2000 {
        apply(&residual, &mut z);
        let direction = directions.conjugate(&z);
        let mut image = Vec::new();
        contact.gather(operator.apply(contact, &direction)?, &mut image);
        let curvature = dot(&direction, &image);
        let step = dot(&residual, &direction) / curvature;
        add_scaled(&mut x, step, &direction);
        add_scaled(&mut residual, -step, &image);
        directions.push(direction, image, curvature);
        iterations += 1;
    }
    Ok((iterations, start.elapsed().as_secs_f64()))
}

/// The sparse inverse with K neighbours: seconds to build it, iterations, seconds.
fn sparse<const K: usize>(
    table: &KernelTable,
    operator: &mut Operator,
    contact: &ContactSet,
) -> Result<(f64, usize, f64), Error> {
    let mut inverse = SparseInverse::<K>::new(table);
    let start = Instant::now();
    inverse.update(contact);
    let build = start.elapsed().as_secs_f64();
    let (iterations, seconds) = solve(operator, contact, Box::new(|x, y| inverse.apply(x, y)))?;
    Ok((build, iterations, seconds))
}

#[test]
#[ignore = "prints a table, takes minutes"]
fn preconditioners() -> Result<(), Error> {
    let grid = Grid::square(SIDE, 1.0)?;
    let surface = SelfAffine::new(0.8, 0.25, 4.0 / SIDE as f64, Amplitude::RmsHeight(5e-3), 1)?;
    let unit = surface.spectrum(&grid)?.rms_gradient();
    let map = HeightMap::sample(&surface, &grid)?;
    let kernel = Boussinesq::new(grid, 1.0)?;
    let table = KernelTable::new(&kernel)?;
    let convolution = Convolution::from_table(&table)?;
    let mut operator = Operator::new(convolution.clone());
    let mut solver = FixedLoadSolver::builder(&map, &kernel)
        .stiffness(false)
        .build()?;
    // The inverse of the symbol on the padded grid, which is |q| E*/2 but for the cell.
    let mut spectral = convolution.inverted();
    let mut delta = vec![0.0; grid.nodes()];
    let middle = SIDE / 2;
    delta[grid.index(middle, middle)] = 1.0;
    let mut response = vec![0.0; grid.nodes()];
    spectral.apply(&delta, &mut response)?;
    let stencil: Vec<(isize, f64)> = (-3..=3)
        .flat_map(|dj: isize| (-3..=3).map(move |di: isize| (di, dj)))
        .map(|(di, dj)| {
            let at = |d: isize| middle.wrapping_add_signed(d);
            (
                di + SIDE as isize * dj,
                response[grid.index(at(di), at(dj))],
            )
        })
        .collect();
    println!("contact | preconditioner | iterations | seconds to build + to solve");
    for load in [0.004, 0.04, 0.15, 0.35, 1.05] {
        let solution = solver.solve(load * unit)?;
        let mut contact = ContactSet::new(grid.nodes());
        contact.assign(|node| solution.pressure[node] > 0.0);
        let percent = 100.0 * solution.state.contact_area_fraction;
        let print = |name: &str, (build, iterations, seconds): (f64, usize, f64)| {
            println!("{percent:.1} % | {name} | {iterations} | {build:.3} + {seconds:.3}");
        };
        let none = solve(&mut operator, &contact, Box::new(|x, y| x.clone_into(y)))?;
        print("none", (0.0, none.0, none.1));
        let (mut field, mut image) = (vec![0.0; grid.nodes()], vec![0.0; grid.nodes()]);
        let found = solve(
            &mut operator,
            &contact,
            Box::new(|x, y| {
                field.fill(0.0);
                contact.scatter(x, &mut field);
                if spectral.apply(&field, &mut image).is_ok() {
                    contact.gather(&image, y);
                }
            }),
        )?;
        print("|q| spectral", (0.0, found.0, found.1));
        let found = solve(
            &mut operator,
            &contact,
            Box::new(|x, y| {
                let places = contact.places();
                y.clear();
                y.extend(contact.nodes().iter().map(|&node| {
                    let column = (node as usize % SIDE) as isize;
                    let terms = stencil.iter().map(|&(offset, weight)| {
                        // Offsets along x that leave the row wrap into another.
                        let other = node as isize + offset;
                        let near = (other.rem_euclid(SIDE as isize) - column).abs() <= 3;
                        let place = usize::try_from(other).ok().and_then(|o| places.get(o));
                        match place {
                            Some(&place) if near && place != ContactSet::NONE => {
                                weight * x[place as usize]
                            }
                            _ => 0.0,
                        }
                    });
                    terms.sum::<f64>()
                }));
            }),
        )?;
        print("7 x 7 stencil", (0.0, found.0, found.1));
        print("KL 8", sparse::<8>(&table, &mut operator, &contact)?);
        print("KL 16", sparse::<16>(&table, &mut operator, &contact)?);
        print("KL 32", sparse::<32>(&table, &mut operator, &contact)?);
    }
    Ok(())
}
