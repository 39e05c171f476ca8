//! Where does my contact begin to yield, under which load, and what does sliding change?
//!
//! A ball of 10 mm on steel, whose greatest stresses lie half a contact radius below the surface. The same goes for any
//! surface: the path gives the pressure of every load, and the pressure the stresses at every depth.
//!
//! ```text
//! cargo run --release --example where_it_yields
//! ```
//!
//! It prints:
//!
//! ```text
//! under 300 N the greatest pressure is 3.139 GPa
//! friction   von Mises [GPa]   at a depth of [µm]   greatest tension [GPa]
//!        0             1.946                102.7                    0.398
//!      0.1             1.959                101.5                    0.796
//!      0.2             2.001                 97.5                    1.222
//!      0.3             2.070                 91.1                    1.648
//!      0.4             2.355                  0.0                    2.074
//!      0.5             2.872                  0.0                    2.501
//! with friction 0 it yields first under 70.4 N, 63.3 µm deep, with 365 nodes in contact
//! with friction 0.3 it yields first under 58.5 N, 53.2 µm deep, with 325 nodes in contact
//! ```

use asperity::stress::{Measure, Subsurface};
use asperity::surface::Paraboloid;
use asperity::{Boussinesq, Error, Grid, LoadingSolver, composite_modulus};

const YIELD_STRESS: f64 = 1.2e9; // [Pa], of a hard steel

fn main() -> Result<(), Error> {
    let steel = (210e9, 0.3);
    let half_space = Boussinesq::new(Grid::square(65, 0.8e-3)?, composite_modulus(steel, steel)?)?;
    let mut path =
        LoadingSolver::builder(&Paraboloid::new(5e-3)?, &half_space).max_load(300.0).build()?;
    let history = path.run()?;
    let pressure = path.fields()?.pressure;

    let below = Subsurface::of(&half_space, steel.1)?;
    println!("under 300 N the greatest pressure is {:.3} GPa", 1e-9 * pressure.max());
    println!("friction   von Mises [GPa]   at a depth of [µm]   greatest tension [GPa]");
    for friction in [0.0, 0.1, 0.2, 0.3, 0.4, 0.5] {
        let survey = below.clone().sliding(friction, 0.0)?.survey(&pressure, None)?;
        let von_mises = survey.greatest(Measure::VonMises);
        println!(
            "{friction:8} {:17.3} {:20.1} {:24.3}",
            1e-9 * von_mises.value,
            1e6 * von_mises.depth,
            1e-9 * survey.greatest(Measure::GreatestTension).value
        );
    }

    for friction in [0.0, 0.3] {
        let body = below.clone().sliding(friction, 0.0)?;
        match body.first_yield(&mut path, &history, YIELD_STRESS)? {
            Some(first) => println!(
                "with friction {friction} it yields first under {:.1} N, {:.1} µm deep, with {} nodes in contact",
                first.state.contact.load,
                1e6 * first.greatest.depth,
                first.state.contact.contact_nodes
            ),
            None => println!("with friction {friction} it does not yield"),
        }
    }
    Ok(())
}
