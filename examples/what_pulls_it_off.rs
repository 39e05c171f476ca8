//! What force pulls my rough surface off, and how much of the work of pressing it on is lost?
//!
//! A soft body, E* = 1 MPa, with a work of adhesion of 50 mJ/m², as rubber has on glass, is pressed on with 100 Pa and
//! pulled off again. The smoother the surface, the more sticks. The force hardly depends on the mesh: of the smoothest
//! surface it is 31.8 µN on 32 × 32 nodes and 32.4 on 128 × 128. Contact and loop need finer cells.
//!
//! ```text
//! cargo run --release --example what_pulls_it_off
//! ```
//!
//! It prints:
//!
//! ```text
//! Sq [µm]   pressed on: contact [%]   pull-off [µN]   loop [pJ]   jumps
//!     2.0                      17.0           31.99       16.56      17
//!     3.0                       6.1           14.17        2.84      11
//!     4.0                       2.4           11.43        0.82       5
//! ```

use asperity::adhesion::{Adhesion, AdhesiveEvent, AdhesivePath};
use asperity::surface::Amplitude;
use asperity::{Boussinesq, ContactTarget, Error, Grid, SelfAffine};

fn main() -> Result<(), Error> {
    let side = 100e-6;
    let half_space = Boussinesq::new(Grid::square(64, side)?, 1e6)?;
    let load = 100.0 * side * side; // 100 Pa on average, about what gravity does to a small plate
    println!("Sq [µm]   pressed on: contact [%]   pull-off [µN]   loop [pJ]   jumps");
    for rms_height in [2e-6, 3e-6, 4e-6] {
        let surface =
            SelfAffine::new(0.8, side / 2.0, side / 4.0, Amplitude::RmsHeight(rms_height), 1)?;
        let builder = AdhesivePath::builder(&surface, &half_space, Adhesion::work(0.05));
        let mut path = builder.until(ContactTarget::Load(load)).build()?;
        let mut loop_of_both = path.run()?;
        let pressed = path.state().map_or(0.0, |state| state.contact.contact_area_fraction);
        path.unload()?;
        let unloading = path.run()?;
        loop_of_both.extend(unloading.states().iter().copied());
        let states = loop_of_both.states().iter();
        let jumps = states.filter(|state| state.event == AdhesiveEvent::JumpEnd).count();
        println!(
            "{:7.1} {:25.1} {:15.2} {:11.2} {jumps:7}",
            1e6 * rms_height,
            100.0 * pressed,
            1e6 * unloading.pull_off(),
            1e12 * loop_of_both.dissipated(),
        );
    }
    Ok(())
}
