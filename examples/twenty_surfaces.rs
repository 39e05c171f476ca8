//! How much do results differ from one surface to the next of the same statistics?
//!
//! Twenty seeds, one path for each, all threads at work; then mean and standard deviation at common loads.
//! `asperity path --seeds` and `asperity gather` do the same with files.
//!
//! ```text
//! cargo run --release --example twenty_surfaces
//! ```
//!
//! It prints:
//!
//! ```text
//! pressure [MPa]      contact [%]       mean gap [µm]    interfacial stiffness [GN/m³]
//!              2     0.216 ± 0.040      2.7456 ± 0.2617             9532 ± 1748
//!              5     0.435 ± 0.094      2.4989 ± 0.2077            16897 ± 4635
//!             10     0.797 ± 0.163      2.2630 ± 0.1424            30094 ± 8370
//!             20     1.461 ± 0.191      1.9982 ± 0.0813            52927 ± 9303
//!             50     3.353 ± 0.267      1.6158 ± 0.0480           114574 ± 10903
//!            100     6.407 ± 0.367      1.3052 ± 0.0369           216126 ± 14542
//! ```

use asperity::loading::History;
use asperity::surface::Amplitude;
use asperity::{
    ContactState, ContactTarget, Error, Grid, LoadingSolver, PeriodicBoussinesq, SelfAffine,
};
use rayon::prelude::*;

const E_STAR: f64 = 115e9;
const SEEDS: std::ops::RangeInclusive<u64> = 1..=20;
/// Loads over the nominal area \[Pa\].
const PRESSURES: [f64; 6] = [2e6, 5e6, 10e6, 20e6, 50e6, 100e6];

fn path(seed: u64) -> Result<History, Error> {
    let side = 1e-3;
    let half_space = PeriodicBoussinesq::new(Grid::square(64, side)?, E_STAR)?;
    let height = Amplitude::RmsHeight(1e-6);
    let surface = SelfAffine::new(0.8, side / 4.0, side / 16.0, height, seed)?;
    let [.., greatest] = PRESSURES;
    LoadingSolver::builder(&surface, &half_space).max_mean_pressure(greatest).build()?.collect()
}

/// Mean and standard deviation of a sample.
fn spread(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares = values.iter().map(|value| (value - mean).powi(2));
    (mean, (squares.sum::<f64>() / (count - 1.0)).sqrt())
}

fn main() -> Result<(), Error> {
    let seeds: Vec<u64> = SEEDS.collect();
    // Results are the same with any number of threads.
    let paths: Vec<History> = seeds.par_iter().map(|&seed| path(seed)).collect::<Result<_, _>>()?;

    println!(
        "pressure [MPa]      contact [%]       mean gap [µm]    interfacial stiffness [GN/m³]"
    );
    let area = 1e-3 * 1e-3;
    for pressure in PRESSURES {
        let target = ContactTarget::MeanPressure(pressure);
        let at_target = |path: &History| path.at(target).map(|state| state.contact);
        let states: Vec<ContactState> = paths.iter().map(at_target).collect::<Result<_, _>>()?;
        let column = |value: fn(&ContactState) -> f64| {
            let values: Vec<f64> = states.iter().map(value).collect();
            spread(&values)
        };
        let contact = column(|state| 100.0 * state.contact_area_fraction);
        let gap = column(|state| 1e6 * state.mean_gap);
        let stiffness = column(|state| state.interfacial_stiffness.unwrap_or(f64::NAN));
        println!(
            "{:14.0} {:9.3} ± {:5.3} {:11.4} ± {:6.4} {:16.0} ± {:.0}",
            pressure / 1e6,
            contact.0,
            contact.1,
            gap.0,
            gap.1,
            stiffness.0 / area / 1e9,
            stiffness.1 / area / 1e9
        );
    }
    Ok(())
}
