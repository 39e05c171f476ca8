//! How does a rubber seal creep under its load: when is the last channel closed, what load is left if it is clamped at
//! one approach, and what does it lose under vibration?
//!
//! The path is elastic, of the modulus at once. Everything over time follows from it without another solution.
//!
//! Pictures of such a path: `asperity path --material rubber --periodic love --max-area-fraction 0.6 --record
//! rubber.npz`, then `asperity creep rubber.npz --prony 0.1,0.3 10,0.5 --load 1 --time 1e4`.
//!
//! ```text
//! cargo run --release --example rubber_creeps
//! ```
//!
//! It prints:
//!
//! ```text
//! time [s]   contact [%]   mean gap [µm]   greatest pressure [MPa]   (load 0.03 N)
//!        1        17.072          1.5168                    0.6128
//!        3        19.757          1.3629                    0.5464
//!       10        26.306          1.0881                    0.3924
//!       30        37.518          0.7433                    0.2524
//!      100        47.955          0.5078                    0.2268
//!     1000        49.475          0.4788                    0.2267
//! the last channel along x closes after 28.87 s
//! clamped, it bears 0.0300 N at once and 0.0060 N after 1000 s
//! unloaded by half, contact recedes from 61.000 s on
//! after 61 s 44.849 % in contact
//! after 62 s 28.571 % in contact
//! after 122 s 28.735 % in contact
//! at    10 Hz a cycle loses 1.594e-11 J, loss factor 0.046
//! at     1 Hz a cycle loses 7.479e-11 J, loss factor 0.173
//! at   0.1 Hz a cycle loses 6.600e-11 J, loss factor 0.133
//! at  0.01 Hz a cycle loses 4.368e-10 J, loss factor 0.534
//! at 0.001 Hz a cycle loses 2.399e-10 J, loss factor 0.151
//! ```

use asperity::bed::Bed;
use asperity::creep::{
    ControlHistory, Creep, CycleSettings, PiecewiseLinear, Prony, Relaxation, Steps,
    ViscoelasticBed,
};
use asperity::patches::{Connectivity, Percolation};
use asperity::surface::Amplitude;
use asperity::{
    Boundary, Error, Grid, LoadingSolver, PeriodicBoussinesq, SelfAffine, plane_strain_modulus,
};

fn main() -> Result<(), Error> {
    let side = 1e-3;
    let grid = Grid::square(128, side)?;
    let surface = SelfAffine::new(0.8, side / 4.0, side / 16.0, Amplitude::RmsHeight(2e-6), 1)?;
    // The modulus at once, 6 MPa, of which 0.3 relaxes in 0.1 s and 0.5 in 10 s.
    let half_space = PeriodicBoussinesq::new(grid, plane_strain_modulus(6e6, 0.5)?)?;
    let rubber = Prony::shares(&[(0.1, 0.3), (10.0, 0.5)])?;

    let mut path = LoadingSolver::builder(&surface, &half_space).max_area_fraction(0.7).build()?;
    let history = path.run()?;
    let bed = Bed::new(&history)?;

    // A load put on within a second and held: in closed form.
    let load = 0.03; // [N], a mean pressure of 0.03 MPa
    let creep = Creep::new(&bed, &rubber, &PiecewiseLinear::ramp(load, 1.0)?)?;
    println!("time [s]   contact [%]   mean gap [µm]   greatest pressure [MPa]   (load {load} N)");
    for time in [1.0, 3.0, 10.0, 30.0, 100.0, 1000.0] {
        let state = creep.at(time)?;
        let pressure = creep.pressure(time, 40)?.pressure(&bed, &mut path)?;
        println!(
            "{time:8} {:13.3} {:15.4} {:25.4}",
            100.0 * state.contact_area_fraction,
            1e6 * state.mean_gap,
            1e-6 * pressure.max()
        );
    }
    let contact = history.contact_sequence(grid)?;
    let found = Percolation::of(&contact, Boundary::Periodic, Connectivity::Eight);
    let times = creep.times();
    match found.seal_x.and_then(|nodes| times.get(nodes - 1)) {
        Some(time) => println!("the last channel along x closes after {time:.2} s"),
        None => println!("a channel along x stays open"),
    }

    // Clamped at the approach that the load has at once.
    let approach = bed.at_load(load)?.approach;
    let clamped = Relaxation::new(&bed, &rubber, &PiecewiseLinear::step(approach)?)?;
    println!(
        "clamped, it bears {:.4} N at once and {:.4} N after 1000 s",
        clamped.at(0.0)?.load,
        clamped.at(1000.0)?.load
    );

    // Half of the load taken away after a minute: contact recedes, and the bed is stepped in time.
    let course = PiecewiseLinear::ramp(load, 1.0)?.hold(60.0)?.to(0.5 * load, 1.0)?.hold(60.0)?;
    let creep = Creep::new(&bed, &rubber, &course)?;
    if let Some(recession) = creep.recession() {
        println!("unloaded by half, contact recedes from {:.3} s on", recession.time);
    }
    let times = Steps::default().times(&rubber, &course, course.end())?;
    let mut contact = ViscoelasticBed::new(&bed, &rubber)?;
    let states = contact.follow(&ControlHistory::Load(course), &times)?;
    for time in [61.0, 62.0, 122.0] {
        // The last state up to then: every corner of the load's course has one of its own.
        if let Some(state) = states.iter().rfind(|state| state.time <= time) {
            println!("after {time} s {:.3} % in contact", 100.0 * state.contact_area_fraction);
        }
    }

    // Vibration around half of the load, to 10⁻³ of the product of both amplitudes.
    let settings = CycleSettings { tolerance: 1e-3, ..CycleSettings::default() };
    let mut contact = ViscoelasticBed::new(&bed, &rubber)?;
    contact.settle(0.5 * load)?;
    for frequency in [10.0, 1.0, 0.1, 0.01, 0.001] {
        let cycle = contact.cycle(0.5 * load, 0.1 * load, 1.0 / frequency, settings)?;
        println!(
            "at {frequency:5} Hz a cycle loses {:.3e} J, loss factor {:.3}",
            cycle.dissipation, cycle.loss_factor
        );
    }
    Ok(())
}
