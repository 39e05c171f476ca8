//! My surface has a formula: how do I press that?
//!
//! A surface gives its heights on any grid, positive towards the half-space. Here they are parallel
//! ridges, pressed alone and with roughness on top.
//!
//! ```text
//! cargo run --release --example own_surface
//! ```

use std::f64::consts::TAU;

use asperity::{Boussinesq, Error, Grid, LoadingSolver, SelfAffine, Surface, SurfaceError};
use nalgebra::DMatrix;

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
    println!("{name}\ncontact [%]    load [N]  approach [m]");
    for state in path.step_by(200) {
        let contact = state?.contact;
        let area = 100.0 * contact.contact_area_fraction;
        println!("{area:11.2} {:11.4e} {:13.4e}", contact.load, contact.approach);
    }
    Ok(())
}

fn main() -> Result<(), Error> {
    let ridges = Ridges { amplitude: 20e-6, wavelength: 0.5e-3 };
    press("ridges", ridges)?;
    press("rough ridges", ridges.plus(SelfAffine::zhang2020(1)))
}
