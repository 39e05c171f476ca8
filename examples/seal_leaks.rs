//! How much leaks through my seal, and how hard must I press until it does not matter?
//!
//! Reynolds' equation on the gap of each state: a fluid is pressed from one edge of the surface to the opposite one,
//! and contact is closed. Leak rates fall by many decades before the last channel closes, and one constriction takes
//! more and more of the pressure drop.
//!
//! Pictures of such a path: `asperity path --periodic love --max-area-fraction 0.6 --record path.npz`, then
//! `asperity leak path.npz --viscosity 1e-3 --pressure-drop 1e5 --along x`.
//!
//! ```text
//! cargo run --release --example seal_leaks
//! ```
//!
//! It prints:
//!
//! ```text
//! pressure [MPa]   contact [%]   leak rate [m³/s]   mean field [m³/s]   narrowest gap [nm]   its share of Δp [%]
//!           0.00          0.01          3.081e-10           3.123e-10              3214.04                  1.84
//!           2.69          4.85          1.349e-11           1.599e-11              1051.85                  1.65
//!           5.66          9.69          4.196e-12           6.017e-12               679.39                  4.51
//!           8.97         14.53          1.441e-12           2.550e-12               514.07                  6.65
//!          12.58         19.38          4.540e-13           1.094e-12               335.20                  8.01
//!          16.15         24.22          1.285e-13           4.992e-13               215.81                  9.11
//!          18.28         26.64          5.263e-14           3.096e-13               157.25                 28.82
//!          20.19         29.06          2.103e-14           2.006e-13               127.36                 29.15
//!          22.26         31.48          6.589e-15           1.235e-13                97.68                 28.76
//!          24.55         33.90          1.358e-15           6.971e-14                64.60                 27.88
//!          26.88         36.32          1.541e-16           3.704e-14                36.28                 30.32
//!          28.12         37.53          3.264e-17           2.561e-14                20.76                 21.55
//!          28.77         38.14          5.509e-18           2.088e-14                 9.52                 57.08
//!          29.09         38.44          6.264e-19           1.883e-14                 4.39                 88.05
//!          29.26         38.60          8.045e-20           1.777e-14                 2.15                 96.99
//!          29.37         38.67          5.778e-21           1.714e-14                 0.89                 99.63
//!          29.41         38.70          5.800e-22           1.691e-14                 0.41                 99.95
//!          29.43         38.73          4.855e-23           1.680e-14                 0.18                100.00
//!          29.44         38.75          6.766e-25           1.673e-14                 0.04                100.00
//!          29.45         38.76            0.000e0           1.671e-14                 0.00                  0.00
//! tight from 29.4 MPa on
//! at 30 % contact, permeabilities [m³/(Pa s)]:
//!   along X 1.420e-19, across 1.771e-20; 6421 of 9216 nodes conduct, 8 pools; greatest flux 5.42e-10 m²/s
//!   along Y 1.764e-18, across 3.179e-19; 6409 of 9216 nodes conduct, 8 pools; greatest flux 7.51e-9 m²/s
//! ```

use asperity::leak::Seal;
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
    let history = path.run()?;

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
