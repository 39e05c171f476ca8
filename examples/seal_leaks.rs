//! How much leaks through my seal, and how hard must I press until it does not matter?
//!
//! Reynolds' equation on the gap of each state: a fluid is pressed from one edge of the surface to the opposite one, and contact is closed.
//! Leak rates fall by many decades before the last channel closes, and one constriction takes more and more of the pressure drop.
//!
//! Pictures of such a path: `asperity path --periodic love --max-area-fraction 0.6 --record path.npz`, then
//! `asperity leak path.npz --viscosity 1e-3 --pressure-drop 1e5 --along x`.
//!
//! ```text
//! cargo run --release --example seal_leaks
//! ```

use asperity::leak::Seal;
use asperity::loading::History;
use asperity::surface::{Amplitude, Axis};
use asperity::{ContactTarget, Error, Grid, LoadingSolver, PeriodicBoussinesq, SelfAffine};

/// A polymer on something hard \[Pa\].
const E_STAR: f64 = 3e9;
/// Water \[Pa s\] under 1 bar \[Pa\].
const VISCOSITY: f64 = 1e-3;
const PRESSURE_DROP: f64 = 1e5;

fn main() -> Result<(), Error> {
    let side = 1e-3;
    let grid = Grid::square(96, side)?;
    let surface = SelfAffine::new(0.8, side / 6.0, side / 24.0, Amplitude::RmsHeight(1e-6), 1)?;
    let half_space = PeriodicBoussinesq::new(grid, E_STAR)?;
    let mut path = LoadingSolver::builder(&surface, &half_space).max_area_fraction(0.6).build()?;
    let history: History = path.by_ref().collect::<Result<_, _>>()?;

    let seal = Seal::new(VISCOSITY, PRESSURE_DROP, Axis::X)?;
    let curve = seal.curve(&mut path, &history, 20)?;
    println!(
        "pressure [MPa]   contact [%]   leak rate [m³/s]   mean field [m³/s]   narrowest gap [nm]   its share of Δp [%]"
    );
    for point in &curve.points {
        let (gap, share) = match point.constriction {
            Some(narrowest) => (1e9 * narrowest.gap, 100.0 * narrowest.pressure_drop),
            None => (0.0, 0.0),
        };
        println!(
            "{:14.2} {:13.2} {:18.3e} {:19.3e} {gap:20.2} {share:21.2}",
            point.state.contact.mean_pressure() / 1e6,
            100.0 * point.state.contact.contact_area_fraction,
            point.leak_rate,
            point.mean_field_leak_rate,
        );
    }
    match curve.closing {
        Some(state) => {
            println!("tight from {:.1} MPa on", state.contact.mean_pressure() / 1e6);
        }
        None => println!("it still leaks at the end of the path"),
    }

    // The fields of one state, in both directions.
    let state = history.at(ContactTarget::AreaFraction(0.3))?;
    println!("at 30 % contact, permeabilities [m³/(Pa s)]:");
    for along in [Axis::X, Axis::Y] {
        let leak = Seal::new(VISCOSITY, PRESSURE_DROP, along)?.leak_at(&mut path, &state)?;
        println!(
            "  along {along:?} {:.3e}, across {:.3e}; {} of {} nodes conduct, {} pools; greatest flux {:.2e} m²/s",
            leak.permeability,
            leak.transverse_permeability.unwrap_or(0.0),
            leak.flowing_nodes,
            grid.nodes(),
            leak.pools,
            leak.flux_x.zip_map(&leak.flux_y, f64::hypot).max()
        );
    }
    Ok(())
}
