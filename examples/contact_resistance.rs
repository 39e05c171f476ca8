//! How large is the electrical resistance of my contact, and how does it fall with the load?
//!
//! Current and further displacement solve the same problem, so that the resistance follows from a stiffness. On a free
//! half-space it is that of the contact stiffness, between points far off in both bodies. On a periodic one
//! it is that of the interfacial stiffness: what the interface adds to bodies with a uniform current. Put thermal
//! resistivities \[m K/W\] in, and thermal resistances come out.
//!
//! A surface that has more roughness than the grid, of a known height, has a resistance between two bounds. The last lines are a table of
//! the same interface for a finite element program.
//!
//! ```text
//! cargo run --release --example contact_resistance
//! ```

use asperity::joint::{Conduction, FeProgram, InterfaceTable};
use asperity::loading::History;
use asperity::surface::Amplitude;
use asperity::{
    Boussinesq, Error, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq, SelfAffine,
    composite_modulus,
};

/// Copper: Young's modulus \[Pa\] and Poisson's ratio, and resistivity \[Ω m\].
const COPPER: (f64, f64) = (120e9, 0.34);
const RESISTIVITY: f64 = 1.7e-8;
const LOADS: [f64; 5] = [0.1, 0.3, 1.0, 3.0, 10.0];

/// Roughness finer than the grid, from valley to peak \[m\].
const UNRESOLVED: f64 = 10e-9;

/// The path to twice the greatest load: bounds need to look beyond it.
fn history(surface: &SelfAffine, half_space: &dyn InfluenceKernel) -> Result<History, Error> {
    let [.., greatest] = LOADS;
    LoadingSolver::builder(surface, half_space).max_load(2.0 * greatest).build()?.collect()
}

/// The resistance \[Ω\] at each load, and the contact area fraction there.
fn resistances(history: &History, copper: &Conduction) -> Result<Vec<(f64, f64)>, Error> {
    let mut resistances = Vec::new();
    for state in LOADS.iter().filter_map(|&load| history.at_load(load)) {
        // From the contact stiffness if there is one, which is on a free half-space.
        let conductance = copper.of(&state.contact)?.unwrap_or(0.0);
        resistances.push((1.0 / conductance, state.contact.contact_area_fraction));
    }
    Ok(resistances)
}

fn main() -> Result<(), Error> {
    let e_star = composite_modulus(COPPER, COPPER)?;
    let side = 1e-3;
    let grid = Grid::square(128, side)?;
    let surface = SelfAffine::new(0.8, side / 4.0, side / 32.0, Amplitude::RmsHeight(1e-6), 1)?;
    // The sum over both bodies.
    let copper = Conduction::electrical(e_star, RESISTIVITY + RESISTIVITY)?;
    let free = resistances(&history(&surface, &Boussinesq::new(grid, e_star)?)?, &copper)?;
    let path = history(&surface, &PeriodicBoussinesq::new(grid, e_star)?)?;
    let periodic = resistances(&path, &copper)?;

    println!("            free half-space            periodic half-space");
    println!("load [N]    contact [%]     R [mΩ]     contact [%]     R [mΩ]");
    for ((load, (free, free_area)), (periodic, area)) in LOADS.iter().zip(free).zip(periodic) {
        println!(
            "{load:8.1} {:14.4} {:10.4} {:15.4} {:10.4}",
            100.0 * free_area,
            1e3 * free,
            100.0 * area,
            1e3 * periodic
        );
    }
    println!("\nThe difference is the constriction into the nominal square, in both bodies.");

    println!(
        "\nBounds on the periodic half-space, with {} nm of finer roughness:",
        1e9 * UNRESOLVED
    );
    let bounds = copper.bounds(&path, UNRESOLVED)?;
    for load in LOADS {
        // The last state up to this load.
        let place = path.states().partition_point(|state| state.contact.load <= load) - 1;
        let bound = bounds[place];
        println!("{load:8.1} N: R from {:.4} to {:.4} mΩ", 1e3 / bound.upper, 1e3 / bound.lower);
    }

    let table = InterfaceTable::builder(&path).conduction(copper).tolerance(0.1).build()?;
    println!("\n{}", table.text(FeProgram::CalculiX));
    Ok(())
}
