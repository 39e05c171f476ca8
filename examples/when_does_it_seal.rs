//! How hard must I press until nothing leaks through?
//!
//! The last channel from end to end closes when patches of contact have joined all the way across it, through corners
//! too: channels pass through sides of cells, as a leak does. Around the periodic grid it closes no later.
//!
//! Pictures of such a path: `asperity path --periodic love --max-area-fraction 0.6 --record path.npz`, then
//! `asperity patches path.npz`.
//!
//! ```text
//! cargo run --release --example when_does_it_seal
//! ```
//!
//! It prints:
//!
//! ```text
//! which way          event                       load [MPa]   contact [%]   mean gap [µm]
//! from end to end    a patch along x                  39.63         48.45           0.261
//! from end to end    a patch along y                  29.45         38.76           0.373
//! from end to end    no channel along x               29.45         38.76           0.373
//! from end to end    no channel along y               40.70         49.36           0.251
//! around the grid    a patch along x                  39.63         48.45           0.261
//! around the grid    a patch along y                  29.45         38.76           0.373
//! around the grid    no channel along x               29.45         38.76           0.373
//! around the grid    no channel along y               39.63         48.45           0.261
//! ```

use asperity::patches::{Connectivity, Percolation};
use asperity::surface::Amplitude;
use asperity::{Error, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq, SelfAffine};

/// A polymer on something hard \[Pa\].
const E_STAR: f64 = 3e9;

fn main() -> Result<(), Error> {
    let side = 1e-3;
    let grid = Grid::square(96, side)?;
    // Much shorter waves than the side: a piece stands for the whole seal.
    let surface = SelfAffine::new(0.8, side / 6.0, side / 24.0, Amplitude::RmsHeight(1e-6), 1)?;
    let half_space = PeriodicBoussinesq::new(grid, E_STAR)?;
    let mut path = LoadingSolver::builder(&surface, &half_space).max_area_fraction(0.6).build()?;
    let history = path.run()?;
    let events = history.events();
    let contact = history.contact_sequence(grid)?;

    println!(
        "which way          event                       load [MPa]   contact [%]   mean gap [µm]"
    );
    let (boundary, corners) = (half_space.boundary(), Connectivity::Eight);
    for (name, found) in [
        ("from end to end", Percolation::of(&contact, boundary, corners)),
        ("around the grid", Percolation::winding(&contact, boundary, corners)),
    ] {
        for (what, nodes) in [
            ("a patch along x", found.contact_x),
            ("a patch along y", found.contact_y),
            ("no channel along x", found.seal_x),
            ("no channel along y", found.seal_y),
        ] {
            // The number of nodes in contact is the number of the state.
            let state = nodes.and_then(|nodes| events.get(nodes.checked_sub(1)?));
            match state.map(|state| state.contact) {
                Some(contact) => println!(
                    "{name:18} {what:20} {:17.2} {:13.2} {:15.3}",
                    contact.mean_pressure() / 1e6,
                    100.0 * contact.contact_area_fraction,
                    1e6 * contact.mean_gap
                ),
                None => println!("{name:18} {what:20} not on this path"),
            }
        }
    }
    Ok(())
}
