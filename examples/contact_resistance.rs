//! How large is the electrical resistance of my contact, and how does it fall with the load?
//!
//! Current and further displacement solve the same problem, so that the resistance follows from a stiffness. On a free
//! half-space it is that of the contact stiffness, between points far off in both bodies. On a periodic one
//! it is that of the interfacial stiffness: what the interface adds to bodies with a uniform current. Put thermal
//! resistivities \[m K/W\] in, and thermal resistances come out.
//!
//! A surface that has more roughness than the grid, of a known height, has a resistance between two bounds. The last
//! lines are a table of the same interface for a finite element program.
//!
//! ```text
//! cargo run --release --example contact_resistance
//! ```
//!
//! It prints:
//!
//! ```text
//!             free half-space            periodic half-space
//! load [N]    contact [%]     R [mΩ]     contact [%]     R [mΩ]
//!      0.1         0.0183     1.2050          0.0183     1.1839
//!      0.3         0.0366     0.6305          0.0366     0.6198
//!      1.0         0.1099     0.2515          0.1099     0.2360
//!      3.0         0.3113     0.1214          0.3113     0.1049
//!     10.0         0.9399     0.0564          0.9460     0.0410
//!
//! The difference is the constriction into the nominal square, in both bodies.
//!
//! Bounds on the periodic half-space, with 10 nm of finer roughness:
//!      0.1 N: R from 0.7793 to 2.2510 mΩ
//!      0.3 N: R from 0.4887 to 0.8707 mΩ
//!      1.0 N: R from 0.1869 to 0.3300 mΩ
//!      3.0 N: R from 0.0877 to 0.1415 mΩ
//!     10.0 N: R from 0.0318 to 0.0503 mΩ
//!
//! ** interface law of a rough surface by asperity 0.1.0, in SI units
//! ** overclosure: what the mean gap has closed since first touch; all quantities per nominal area
//! ** 14 rows; between them values err by at most 1e-1 of themselves (pressures below a thousandth of the greatest: of that thousandth)
//! *SURFACE INTERACTION, NAME=ROUGH_INTERFACE
//! *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR
//! 0.000000000000e0, 0.000000000000e0
//! 8.273215569071e4, 1.736529026698e-7
//! 9.940795785854e4, 1.961993469403e-7
//! 1.222964256588e5, 2.196936884460e-7
//! 2.581360342645e5, 3.122514109417e-7
//! 3.435643685612e5, 3.581618455985e-7
//! 7.554398824212e5, 5.161417877146e-7
//! 7.824835023349e5, 5.251986153752e-7
//! 8.287618479512e5, 5.373804736673e-7
//! 8.291696467919e5, 5.374833132773e-7
//! 2.169815118325e6, 7.591069306615e-7
//! 4.915617881836e6, 9.940346779847e-7
//! 8.581239540314e6, 1.176786578307e-6
//! 2.000000000000e7, 1.480092222723e-6
//! ** electrical, by the analogy with heat: temperatures are potentials
//! *GAP CONDUCTANCE
//! 4.130863606563e8, 0.000000000000e0
//! 6.412940876849e8, 8.273215569071e4
//! 8.446990505547e8, 9.940795785854e4
//! 1.253236164004e9, 1.222964256588e5
//! 1.613389016793e9, 2.581360342645e5
//! 2.034492387152e9, 3.435643685612e5
//! 2.589031186763e9, 7.554398824212e5
//! 3.017450794012e9, 7.824835023349e5
//! 3.438223687260e9, 8.287618479512e5
//! 3.853166124740e9, 8.291696467919e5
//! 7.181268466921e9, 2.169815118325e6
//! 1.335357236040e10, 4.915617881836e6
//! 2.184731509954e10, 8.581239540314e6
//! 4.531601942135e10, 2.000000000000e7
//! ```

use asperity::joint::{Conduction, FeProgram, InterfaceTable};
use asperity::loading::History;
use asperity::surface::Amplitude;
use asperity::{
    Boussinesq, ContactTarget, Error, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq,
    SelfAffine, composite_modulus,
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
    let resistance = |load| {
        let state = history.at(ContactTarget::Load(load))?;
        // From the contact stiffness if there is one, which is on a free half-space.
        let conductance = copper.of(&state.contact, history.layering())?.unwrap_or(0.0);
        Ok((1.0 / conductance, state.contact.contact_area_fraction))
    };
    LOADS.into_iter().map(resistance).collect()
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
