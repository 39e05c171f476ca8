//! How do area, gap and stiffness follow many loads on one large surface?
//!
//! A sweep starts each state from the tangent of the one before.
//!
//! ```text
//! cargo run --release --example load_sweep
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
        let state = solution?.state;
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
