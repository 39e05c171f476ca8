//! What is the contact under one load, on a grid too large for the whole path?
//!
//! The memory of a fixed load grows with the grid, and not with the contact.
//!
//! ```text
//! cargo run --release --example one_load
//! ```
//!
//! It prints:
//!
//! ```text
//! 5356 of 1048576 nodes in contact, 0.51 %
//! approach           7.7573e-6 m
//! mean gap           1.0211e-5 m
//! greatest pressure  7.7590e9 Pa
//! contact stiffness  3.8494e8 N/m
//! found in 18 iterations, gaps in contact within 7e-14 m
//! ```

use asperity::surface::Amplitude;
use asperity::{Boussinesq, Error, FixedLoadSolver, Grid, SelfAffine};

fn main() -> Result<(), Error> {
    let nodes = 1024;
    let side = 1e-2;
    let grid = Grid::square(nodes, side)?;
    // Hurst exponent 0.8, from a quarter of the side down to four cells.
    let shortest = 4.0 * side / nodes as f64;
    let surface = SelfAffine::new(0.8, side / 4.0, shortest, Amplitude::RmsHeight(5e-6), 1)?;
    let half_space = Boussinesq::new(grid, 115e9)?;

    let mut solver = FixedLoadSolver::builder(&surface, &half_space).build()?;
    let solution = solver.solve(1000.0)?; // [N]
    let state = solution.contact;
    println!(
        "{} of {} nodes in contact, {:.2} %",
        state.contact_nodes,
        grid.nodes(),
        100.0 * state.contact_area_fraction
    );
    println!("approach           {:.4e} m", state.approach);
    println!("mean gap           {:.4e} m", state.mean_gap);
    println!("greatest pressure  {:.4e} Pa", solution.fields.pressure.max());
    if let Some(stiffness) = state.contact_stiffness {
        println!("contact stiffness  {stiffness:.4e} N/m");
    }
    let certificate = solution.certificate;
    println!(
        "found in {} iterations, gaps in contact within {:.0e} m",
        solution.effort.iterations,
        certificate.greatest_contact_gap * certificate.length
    );
    Ok(())
}
