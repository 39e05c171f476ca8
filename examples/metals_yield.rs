//! How much of my metal joint yields, and what is left of its roughness after unloading?
//!
//! Cells yield where the pressure reaches the hardness H: perfectly plastic, without hardening, and each loses height
//! where it is (no volume moves to its neighbours). Compare H with E* times the rms gradient: far below, nearly all of
//! the contact yields, and its area is the load over H; far above, nothing does.
//!
//! ```text
//! cargo run --release --example metals_yield
//! ```
//!
//! It prints:
//!
//! ```text
//! load [N]   contact if elastic [%]   contact [%]   yielded [%]   lost [J]
//!     1.00                    0.037         0.049         0.024    5.45e-8
//!    10.00                    0.177         0.439         0.354    2.70e-6
//!    50.00                    0.873         2.148         1.886    2.28e-5
//!   100.00                    1.538         4.272         3.748    5.33e-5
//! the first cell yields at 2.93e-1 N
//! at half the load: 2.148 % in contact on loading, 3.632 % on unloading; Sq 2.000 µm before, 1.955 µm after
//! ```

use asperity::loading::History;
use asperity::surface::Amplitude;
use asperity::{
    Boussinesq, ContactEvent, ContactTarget, Error, Grid, LoadingSolver, SelfAffine,
    plane_strain_modulus,
};

const HARDNESS: f64 = 2.5e9; // [Pa]
const MEAN_PRESSURE: f64 = 100e6; // [Pa]

fn main() -> Result<(), Error> {
    let side = 1e-3;
    let grid = Grid::square(128, side)?;
    let surface = SelfAffine::new(0.8, side / 4.0, side / 16.0, Amplitude::RmsHeight(2e-6), 1)?;
    let half_space = Boussinesq::new(grid, plane_strain_modulus(210e9, 0.3)?)?;
    let load = MEAN_PRESSURE * grid.nominal_area();

    let builder = || LoadingSolver::builder(&surface, &half_space).max_load(load);
    let elastic: History = builder().build()?.collect::<Result<_, _>>()?;
    let mut path = builder().hardness(HARDNESS).build()?;
    let yielding = path.run()?;

    println!("load [N]   contact if elastic [%]   contact [%]   yielded [%]   lost [J]");
    for part in [0.01, 0.1, 0.5, 1.0] {
        let at = ContactTarget::Load(part * load);
        let (elastic, state) = (elastic.at(at)?.contact, yielding.at(at)?.contact);
        let plastic = state.plastic.unwrap_or_default();
        println!(
            "{:8.2} {:24.3} {:13.3} {:13.3} {:10.2e}",
            state.load,
            100.0 * elastic.contact_area_fraction,
            100.0 * state.contact_area_fraction,
            100.0 * plastic.yielded_area_fraction,
            plastic.work
        );
    }
    let first = yielding.states().iter().find(|state| state.event == ContactEvent::Yield);
    if let Some(state) = first {
        println!("the first cell yields at {:.2e} N", state.contact.load);
    }

    // Unloading and loading again is the elastic path of the surface that is left.
    let left = path.residual_surface()?;
    let back = LoadingSolver::builder(&left, &half_space).max_load(load).build()?;
    let back: History = back.collect::<Result<_, _>>()?;
    let half = ContactTarget::Load(load / 2.0);
    println!(
        "at half the load: {:.3} % in contact on loading, {:.3} % on unloading; Sq {:.3} µm before, {:.3} µm after",
        100.0 * yielding.at(half)?.contact.contact_area_fraction,
        100.0 * back.at(half)?.contact.contact_area_fraction,
        1e6 * path.problem().rms_height(),
        1e6 * left.rms_height()
    );
    Ok(())
}
