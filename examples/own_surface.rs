//! My surface has a formula: how do I press that?
//!
//! A surface gives its heights on any grid, positive towards the half-space. Here they are parallel
//! ridges, pressed alone and with roughness on top.
//!
//! ```text
//! cargo run --release --example own_surface
//! ```
//!
//! It prints:
//!
//! ```text
//! ridges
//! contact [%]   load [kN]  approach [µm]
//!        0.01       0.000          0.000
//!        3.06       0.011          0.079
//!        6.11       0.521          2.191
//!        9.16       1.557          6.232
//!       12.21       2.738         10.638
//!       15.26       5.242         19.727
//!       18.32       6.932         25.713
//!       21.37      10.463         37.950
//!       24.42      14.208         50.719
//!       27.47      16.032         56.845
//! rough ridges
//! contact [%]   load [kN]  approach [µm]
//!        0.01       0.000          0.000
//!        3.06       2.791         45.334
//!        6.11       6.196         67.281
//!        9.16      10.378         88.317
//!       12.21      15.030        109.002
//!       15.26      20.231        130.033
//!       18.32      24.835        147.584
//!       21.37      30.064        166.553
//!       24.42      35.829        186.673
//!       27.47      41.485        205.902
//! ```

use std::f64::consts::TAU;

use asperity::nalgebra::DMatrix;
use asperity::{Boussinesq, Error, Grid, LoadingSolver, SelfAffine, Surface, SurfaceError};

/// Parallel ridges, a wavelength apart.
#[derive(Clone, Copy)]
struct Ridges {
    amplitude: f64,
    wavelength: f64,
}

impl Surface for Ridges {
    fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, SurfaceError> {
        Ok(DMatrix::from_fn(grid.nx(), grid.ny(), |ix, iy| {
            let (x, _) = grid.position(ix, iy);
            self.amplitude * (TAU * x / self.wavelength).cos()
        }))
    }
}

/// Contact area and approach as the load grows.
fn press(name: &str, surface: impl Surface) -> Result<(), Error> {
    let half_space = Boussinesq::new(Grid::square(128, 2.5e-3)?, 115e9)?;
    let path = LoadingSolver::builder(&surface, &half_space).max_area_fraction(0.3).build()?;
    println!("{name}\ncontact [%]   load [kN]  approach [µm]");
    for state in path.step_by(500) {
        let contact = state?.contact;
        let area = 100.0 * contact.contact_area_fraction;
        println!("{area:11.2} {:11.3} {:14.3}", 1e-3 * contact.load, 1e6 * contact.approach);
    }
    Ok(())
}

fn main() -> Result<(), Error> {
    let ridges = Ridges { amplitude: 20e-6, wavelength: 0.5e-3 };
    press("ridges", ridges)?;
    press("rough ridges", ridges.plus(SelfAffine::zhang2020(1)))
}
