//! My body is no plain half-space: how do I bring its own response?
//!
//! A kernel says how far the surface gives way at an offset of (di, dj) cells from a cell under unit
//! pressure \[m/Pa\]. Here a thin soft coating lies on the half-space.
//!
//! ```text
//! cargo run --release --example own_kernel
//! ```
//!
//! It prints:
//!
//! ```text
//! coating [m/Pa]    load [N]  radius of contact [m]
//!            0e0    5.0000e1              1.2087e-4
//!          1e-16    5.0000e1              1.2714e-4
//!          1e-15    5.0000e1              1.5671e-4
//!          1e-14    5.0000e1              2.4746e-4
//! ```

use asperity::surface::Paraboloid;
use asperity::{Boundary, Boussinesq, Error, Grid, InfluenceKernel, LoadingSolver};

struct Coated {
    half_space: Boussinesq,
    /// Thickness of the coating over its confined modulus [m/Pa].
    compliance: f64,
}

impl InfluenceKernel for Coated {
    fn grid(&self) -> Grid {
        self.half_space.grid()
    }

    fn boundary(&self) -> Boundary {
        self.half_space.boundary()
    }

    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        let coating = if (di, dj) == (0, 0) { self.compliance } else { 0.0 };
        self.half_space.coefficient(di, dj) + coating
    }
}

fn main() -> Result<(), Error> {
    let grid = Grid::square(64, 1e-3)?;
    let sphere = Paraboloid::new(5e-3)?; // radius 5 mm
    println!("coating [m/Pa]    load [N]  radius of contact [m]");
    for compliance in [0.0, 1e-16, 1e-15, 1e-14] {
        let coated = Coated { half_space: Boussinesq::new(grid, 115e9)?, compliance };
        let path = LoadingSolver::builder(&sphere, &coated).max_load(50.0).build()?;
        if let Some(last) = path.last() {
            let contact = last?.contact;
            let radius = (contact.contact_area / std::f64::consts::PI).sqrt();
            println!("{compliance:14.0e} {:11.4e} {radius:22.4e}", contact.load);
        }
    }
    Ok(())
}
