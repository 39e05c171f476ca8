//! How does my measured surface take load?
//!
//! Heights from a NumPy file, `z[ix, iy]` in metres and positive towards the half-space. Those of a
//! matrix go the same way: `HeightMap::new(matrix)`.
//!
//! ```text
//! cargo run --release --example measured_surface
//! ```

use std::error::Error;

use asperity::{Boussinesq, Grid, HeightMap, LoadingSolver, plane_strain_modulus};

/// Your file, and its length along x \[m\].
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/selfaffine_48.npy");
const SIDE: f64 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let heights = HeightMap::new(asperity::io::read_npy(FILE)?)?;
    let (nx, ny) = heights.shape();
    let cell = SIDE / nx as f64;
    let grid = Grid::new(nx, ny, cell, cell)?;
    println!(
        "{nx} x {ny} nodes, rms height {:.3e} m, rms gradient {:.3}",
        heights.rms_height(),
        heights.rms_gradient(&grid)?
    );

    // Steel against something rigid.
    let half_space = Boussinesq::new(grid, plane_strain_modulus(210e9, 0.3)?)?;
    let path = LoadingSolver::builder(&heights, &half_space).max_area_fraction(0.2).build()?;

    // One state for each node that touches; every 50th is enough to look at.
    println!("contact [%]    load [N]  approach [m]  mean gap [m]");
    for state in path.step_by(50) {
        let contact = state?.contact;
        println!(
            "{:11.2} {:11.4e} {:13.4e} {:13.4e}",
            100.0 * contact.contact_area_fraction,
            contact.load,
            contact.approach,
            contact.mean_gap
        );
    }
    Ok(())
}
