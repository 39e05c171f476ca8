//! How does my measured surface take load?
//!
//! Heights from a NumPy file, `z[ix, iy]` in metres and positive towards the half-space. Those of a
//! matrix go the same way: `HeightMap::new(matrix)`.
//!
//! ```text
//! cargo run --release --example measured_surface
//! ```
//!
//! It prints:
//!
//! ```text
//! 48 x 48 nodes, rms height 5.000e-5 m, rms gradient 1.605
//! contact [%]    load [N]  approach [m]  mean gap [m]
//!        0.04    0.0000e0      0.0000e0     1.4658e-4
//!        2.21    2.2493e3     7.0805e-5     8.5254e-5
//!        4.38    5.0146e3     9.6572e-5     7.0967e-5
//!        6.55    7.8577e3     1.1744e-4     6.1740e-5
//!        8.72    1.0466e4     1.3324e-4     5.6372e-5
//!       10.89    1.2859e4     1.4663e-4     5.2480e-5
//!       13.06    1.6103e4     1.6362e-4     4.8286e-5
//!       15.23    1.8991e4     1.7794e-4     4.5295e-5
//!       17.40    2.2491e4     1.9473e-4     4.2236e-5
//!       19.57    2.5742e4     2.0994e-4     3.9739e-5
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
