//! What is there when the nominal pressure reaches the one that I have?
//!
//! ```text
//! cargo run --release --example stop_at_pressure
//! ```
//!
//! It prints:
//!
//! ```text
//! the path ended by    Some(Load)
//! nodes in contact     69
//! contact area         0.0042 of the nominal
//! approach             1.5836e-5 m
//! mean gap             8.8912e-5 m
//! mean pressure there  1.1872e10 Pa
//! greatest pressure    3.1038e10 Pa
//! ```

use asperity::{Boussinesq, Error, Grid, LoadingSolver, SelfAffine};

/// Load over the nominal area \[Pa\].
const PRESSURE: f64 = 50e6;
const E_STAR: f64 = 115e9;

fn main() -> Result<(), Error> {
    let grid = Grid::square(128, 2.5e-3)?;
    let half_space = Boussinesq::new(grid, E_STAR)?;
    let surface = SelfAffine::zhang2020(1);
    let mut path =
        LoadingSolver::builder(&surface, &half_space).max_mean_pressure(PRESSURE).build()?;
    for state in path.by_ref() {
        state?;
    }

    // The path has ended at exactly this pressure, unless all nodes were in contact before.
    println!("the path ended by    {:?}", path.end());
    let contact = path.present()?.contact;
    let pressure = path.fields()?.pressure;
    println!("nodes in contact     {}", contact.contact_nodes);
    println!("contact area         {:.4} of the nominal", contact.contact_area_fraction);
    println!("approach             {:.4e} m", contact.approach);
    println!("mean gap             {:.4e} m", contact.mean_gap);
    println!("mean pressure there  {:.4e} Pa", contact.load / contact.contact_area);
    println!("greatest pressure    {:.4e} Pa", pressure.max());
    Ok(())
}
