//! What does a coat change? The same rough surface on steel, on steel with a hard coat, and on steel with a soft one.
//!
//! ```text
//! cargo run --release --example coated_body
//! ```
//!
//! It prints:
//!
//! ```text
//! 5 µm of               contact [%]  greatest pressure [GPa]  K_i [GN/m]
//! steel                        5.80                     6.63        0.46
//! titanium nitride             4.86                     7.93        0.46
//! silver                       7.11                     5.21        0.46
//! PTFE                        64.39                     0.61        0.60
//! ```

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::surface::Amplitude;
use asperity::{Error, FixedLoadSolver, Grid, SelfAffine};

fn main() -> Result<(), Error> {
    let grid = Grid::square(128, 1e-3)?; // 1 mm × 1 mm
    let surface = SelfAffine::new(0.8, 0.25e-3, 8.0 * grid.dx(), Amplitude::RmsHeight(0.5e-6), 1)?;
    let steel = Base::HalfSpace { youngs_modulus: 210e9, poissons_ratio: 0.3 };
    let coat =
        |youngs_modulus, poissons_ratio| Layer { youngs_modulus, poissons_ratio, thickness: 5e-6 };
    let load = 0.1e9 * grid.nominal_area(); // 100 MPa on average
    println!("5 µm of               contact [%]  greatest pressure [GPa]  K_i [GN/m]");
    for (name, layer) in [
        ("steel", coat(210e9, 0.3)),
        ("titanium nitride", coat(450e9, 0.25)),
        ("silver", coat(83e9, 0.37)),
        ("PTFE", coat(0.5e9, 0.46)),
    ] {
        let kernel = Layered::free(grid, LayeredBody::new(&[layer], steel)?)?;
        let solution = FixedLoadSolver::new(&surface, &kernel)?.solve(load)?;
        println!(
            "{name:20} {:12.2} {:24.2} {:11.2}",
            100.0 * solution.contact.contact_area_fraction,
            solution.fields.max_pressure() / 1e9,
            solution.contact.interfacial_stiffness.unwrap_or(f64::NAN) / 1e9
        );
    }
    Ok(())
}
