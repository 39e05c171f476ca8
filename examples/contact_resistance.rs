//! How large is the electrical resistance of my contact, and how does it fall with the load?
//!
//! Current and further displacement solve the same problem, so that the resistance follows from a stiffness. On a free
//! half-space it is that of the contact stiffness, between points far off in both bodies. On a periodic one
//! it is that of the interfacial stiffness: what the interface adds to bodies with a uniform current. Put thermal
//! resistivities \[m K/W\] in, and thermal resistances come out.
//!
//! ```text
//! cargo run --release --example contact_resistance
//! ```

use asperity::loading::History;
use asperity::reference::contact_conductance;
use asperity::surface::Amplitude;
use asperity::{
    Boussinesq, Error, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq, SelfAffine,
    composite_modulus,
};

/// Copper: Young's modulus \[Pa\] and Poisson's ratio, and resistivity \[Ω m\].
const COPPER: (f64, f64) = (120e9, 0.34);
const RESISTIVITY: f64 = 1.7e-8;
const LOADS: [f64; 5] = [0.1, 0.3, 1.0, 3.0, 10.0];

/// The resistance \[Ω\] at each load, and the contact area fraction there.
fn resistances(
    surface: &SelfAffine,
    half_space: &dyn InfluenceKernel,
    e_star: f64,
) -> Result<Vec<(f64, f64)>, Error> {
    let [.., greatest] = LOADS;
    let path = LoadingSolver::builder(surface, half_space).max_load(greatest).build()?;
    let history: History = path.collect::<Result<_, _>>()?;
    let mut resistances = Vec::new();
    for state in LOADS.iter().filter_map(|&load| history.at_load(load)) {
        let contact = state.contact;
        // The contact stiffness if there is one, which is on a free half-space.
        let stiffness = contact.contact_stiffness.or(contact.interfacial_stiffness);
        let conductance = contact_conductance(
            stiffness.unwrap_or(0.0),
            e_star,
            // The sum over both bodies.
            RESISTIVITY + RESISTIVITY,
        )?;
        resistances.push((1.0 / conductance, contact.contact_area_fraction));
    }
    Ok(resistances)
}

fn main() -> Result<(), Error> {
    let e_star = composite_modulus(COPPER, COPPER)?;
    let side = 1e-3;
    let grid = Grid::square(128, side)?;
    let surface = SelfAffine::new(0.8, side / 4.0, side / 32.0, Amplitude::RmsHeight(1e-6), 1)?;
    let free = resistances(&surface, &Boussinesq::new(grid, e_star)?, e_star)?;
    let periodic = resistances(&surface, &PeriodicBoussinesq::new(grid, e_star)?, e_star)?;

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
    Ok(())
}
