//! How stiff is my bolted joint at its preload?
//!
//! Two stiffnesses, each per nominal area. The *interfacial* one, −dp̄/d(mean gap), is what the rough interface adds in
//! series to the bodies: it belongs to the joint, whatever the size of the piece that is computed. The *contact*
//! stiffness, dp̄/dδ, has the half-space under the piece in it, and there is none where both repeat without end.
//!
//! ```text
//! cargo run --release --example joint_stiffness
//! ```
//!
//! It prints:
//!
//! ```text
//! half-space  pressure [MPa]  contact [%]  mean gap [µm]  interfacial [N/m³]  contact [N/m³]
//! periodic              50.0         2.50          1.625            1.156e14               -
//! periodic              90.0         4.29          1.359            1.950e14               -
//! periodic             100.0         4.86          1.311            2.241e14               -
//! periodic             110.0         5.29          1.269            2.437e14               -
//! free                  50.0         2.42          1.633            1.165e14        6.042e13
//! free                  90.0         4.22          1.377            2.023e14        7.800e13
//! free                 100.0         4.63          1.329            2.221e14        8.087e13
//! free                 110.0         5.14          1.287            2.488e14        8.436e13
//!
//! the interface of the joint at its preload of 40000 N: 8.962e10 N/m
//! ```

use asperity::surface::Amplitude;
use asperity::{
    Boussinesq, ContactTarget, Error, FixedLoadSolver, Grid, InfluenceKernel, PeriodicBoussinesq,
    SelfAffine, composite_modulus,
};

/// Preload of the bolt \[N\], and the area that it presses together \[m²\].
const PRELOAD: f64 = 40e3;
const JOINT_AREA: f64 = 4e-4;
/// Half the preload, the preload, and what an outer load may add.
const PARTS: [f64; 4] = [0.5, 0.9, 1.0, 1.1];

fn main() -> Result<(), Error> {
    let steel = (210e9, 0.3);
    let e_star = composite_modulus(steel, steel)?;
    // A piece of the joint; heights are those of both faces together.
    let side = 1e-3;
    let grid = Grid::square(128, side)?;
    let surface = SelfAffine::new(0.8, side / 4.0, side / 32.0, Amplitude::RmsHeight(1e-6), 1)?;
    let half_spaces: [(&str, Box<dyn InfluenceKernel>); 2] = [
        ("periodic", Box::new(PeriodicBoussinesq::new(grid, e_star)?)),
        ("free", Box::new(Boussinesq::new(grid, e_star)?)),
    ];

    let preload_pressure = PRELOAD / JOINT_AREA;
    println!(
        "half-space  pressure [MPa]  contact [%]  mean gap [µm]  interfacial [N/m³]  contact [N/m³]"
    );
    for (name, half_space) in &half_spaces {
        let mut solver = FixedLoadSolver::new(&surface, half_space)?;
        let loads = PARTS.map(|part| part * preload_pressure * grid.nominal_area());
        for solution in solver.sweep(loads.map(ContactTarget::Load)) {
            let state = solution?.contact;
            let per_area = |stiffness: Option<f64>| match stiffness {
                Some(stiffness) => format!("{:.3e}", stiffness / grid.nominal_area()),
                None => "-".to_string(),
            };
            println!(
                "{name:10} {:15.1} {:12.2} {:14.3} {:>19} {:>15}",
                state.mean_pressure() / 1e6,
                100.0 * state.contact_area_fraction,
                1e6 * state.mean_gap,
                per_area(state.interfacial_stiffness),
                per_area(state.contact_stiffness)
            );
        }
    }

    let at_preload = FixedLoadSolver::new(&surface, &half_spaces[0].1)?
        .solve(preload_pressure * grid.nominal_area())?
        .contact;
    if let Some(stiffness) = at_preload.interfacial_stiffness {
        let joint = stiffness / grid.nominal_area() * JOINT_AREA;
        println!("\nthe interface of the joint at its preload of {PRELOAD} N: {joint:.3e} N/m");
    }
    Ok(())
}
