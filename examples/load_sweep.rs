//! How do area, gap and stiffness follow many loads on one large surface?
//!
//! A sweep starts each state from the tangent of the one before.
//!
//! ```text
//! cargo run --release --example load_sweep
//! ```
//!
//! It prints:
//!
//! ```text
//!    load [N]  contact [%]  mean gap [m]  interfacial stiffness [N/m]
//!    2.3000e0        0.108     2.6470e-6                     9.8587e6
//!    3.6453e0        0.172     2.5397e-6                     1.5087e7
//!    5.7773e0        0.259     2.4193e-6                     2.0261e7
//!    9.1565e0        0.397     2.2729e-6                     2.7741e7
//!    1.4512e1        0.636     2.1197e-6                     4.2918e7
//!    2.3000e1        0.941     1.9542e-6                     6.1679e7
//!    3.6453e1        1.482     1.7795e-6                     9.2193e7
//!    5.7773e1        2.277     1.5850e-6                     1.2858e8
//!    9.1565e1        3.600     1.3782e-6                     2.1078e8
//!    1.4512e2        5.629     1.1754e-6                     3.3005e8
//!    2.3000e2        8.629     9.7167e-7                     5.0918e8
//!    3.6453e2       13.246     7.6231e-7                     7.9226e8
//!    5.7773e2       20.168     5.5763e-7                     1.3519e9
//!    9.1565e2       29.973     3.7101e-7                     2.4095e9
//!    1.4512e3       43.373     2.1133e-7                     4.7485e9
//!    2.3000e3       61.079     9.3077e-8                    1.1320e10
//! ```

use asperity::surface::Amplitude;
use asperity::{ContactTarget, Error, FixedLoadSolver, Grid, PeriodicBoussinesq, SelfAffine};

const E_STAR: f64 = 115e9;

fn main() -> Result<(), Error> {
    let side = 1e-3;
    let grid = Grid::square(256, side)?;
    let surface = SelfAffine::new(0.8, side / 4.0, side / 64.0, Amplitude::RmsHeight(1e-6), 1)?;
    // A representative piece of a larger surface: both repeat.
    let half_space = PeriodicBoussinesq::new(grid, E_STAR)?;
    let mut solver = FixedLoadSolver::builder(&surface, &half_space).build()?;

    // Three decades, five loads in each. Approaches, areas and mean gaps are targets, too.
    let greatest = 0.02 * E_STAR * grid.nominal_area();
    let loads = (0..=15).map(|k| greatest * 10_f64.powf(f64::from(k - 15) / 5.0));
    println!("   load [N]  contact [%]  mean gap [m]  interfacial stiffness [N/m]");
    for solution in solver.sweep(loads.map(ContactTarget::Load)) {
        let state = solution?.contact;
        println!(
            "{:11.4e} {:12.3} {:13.4e} {:28.4e}",
            state.load,
            100.0 * state.contact_area_fraction,
            state.mean_gap,
            state.interfacial_stiffness.unwrap_or(f64::NAN)
        );
    }
    Ok(())
}
