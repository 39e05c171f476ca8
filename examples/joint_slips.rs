//! How much does my joint give way under a tangential load, and how much energy does each cycle cost?
//!
//! One path of normal loading answers for every tangential load: nodes under low pressure slip long before the joint
//! slides as a whole. The dissipation is that of a steady cycle, and needs some 50 slipping nodes to be one of the
//! surface rather than of the grid.
//!
//! ```text
//! cargo run --release --example joint_slips
//! ```
//!
//! It prints:
//!
//! ```text
//! under 50 N the joint slides at 15.0 N, after 0.215 µm
//! T/μP   U [µm]   sticks [%]   T/U [N/m]   lost in a cycle [J]   loss factor   slipping nodes
//! 0.05   0.0025         95.3     2.978e8             6.318e-11       1.06e-2               75
//!  0.1   0.0052         90.4     2.901e8             5.467e-10       2.24e-2              153
//!  0.2   0.0110         80.1     2.737e8              5.003e-9       4.84e-2              317
//!  0.5   0.0340         51.4     2.208e8              1.138e-7       1.42e-1              774
//!  0.8   0.0768         21.2     1.563e8              8.899e-7       3.07e-1             1255
//! 0.95   0.1295          6.3     1.100e8              2.812e-6       4.85e-1             1492
//! 1592 elements; those that slip first:
//!   1.52e5 N/m, slips at 1.42e-12 m
//!   1.07e5 N/m, slips at 2.98e-11 m
//!   1.35e5 N/m, slips at 6.42e-11 m
//! P =  50.0 N, T =   0.00 N: U =   0.0000 µm, 0.000e0 J lost so far
//! P =  50.0 N, T =   7.50 N: U =   0.0340 µm, 2.845e-8 J lost so far
//! P =  55.0 N, T =  10.50 N: U =   0.0495 µm, 6.438e-8 J lost so far
//! P =  40.0 N, T =  -3.00 N: U =  -0.0122 µm, 9.032e-8 J lost so far
//! P =  55.0 N, T =  10.50 N: U =   0.0495 µm, 1.422e-7 J lost so far
//! P =  40.0 N, T =  -3.00 N: U =  -0.0122 µm, 1.681e-7 J lost so far
//! greatest work of friction in a cycle of half the sliding load: 15.577 J/m²
//! ```

use asperity::bed::Bed;
use asperity::slip::{Friction, PartialSlip, SlipHistory};
use asperity::surface::Amplitude;
use asperity::{Error, Grid, LoadingSolver, PeriodicBoussinesq, SelfAffine, composite_modulus};

const FRICTION: f64 = 0.3;
const MEAN_PRESSURE: f64 = 50e6; // [Pa]

fn main() -> Result<(), Error> {
    let steel = (210e9, 0.3);
    let side = 1e-3;
    let grid = Grid::square(128, side)?;
    // A piece of a larger joint, so that what gives way is the interface: displacements are those of the mean planes.
    let half_space = PeriodicBoussinesq::new(grid, composite_modulus(steel, steel)?)?;
    let surface = SelfAffine::new(0.8, side / 4.0, side / 16.0, Amplitude::RmsHeight(0.3e-6), 1)?;
    let load = MEAN_PRESSURE * grid.nominal_area();
    let mut path = LoadingSolver::builder(&surface, &half_space).max_load(1.2 * load).build()?;
    let history = path.run()?;

    let bed = Bed::new(&history)?;
    let friction = Friction::between(FRICTION, steel, Some(steel))?;
    let joint = PartialSlip::new(&bed, load, friction)?;
    println!(
        "under {load} N the joint slides at {:.1} N, after {:.3} µm",
        joint.sliding_load(),
        1e6 * joint.sliding_displacement()
    );
    println!(
        "T/μP   U [µm]   sticks [%]   T/U [N/m]   lost in a cycle [J]   loss factor   slipping nodes"
    );
    for share in [0.05, 0.1, 0.2, 0.5, 0.8, 0.95] {
        let force = share * joint.sliding_load();
        let (state, cycle) = (joint.monotone(force)?, joint.cycle(force)?);
        println!(
            "{share:4} {:8.4} {:12.1} {:11.3e} {:21.3e} {:13.2e} {:16}{}",
            1e6 * cycle.displacement,
            100.0 * state.stick_area / (state.stick_area + state.slip_area),
            cycle.secant_stiffness,
            cycle.dissipation,
            cycle.loss_factor,
            cycle.slipping_nodes,
            if cycle.has_few_nodes() { "  (few)" } else { "" }
        );
    }

    // The joint for a finite element program: springs with sliders, side by side.
    let mut elements: Vec<_> = joint.jenkins_elements().collect();
    elements.reverse();
    println!("{} elements; those that slip first:", elements.len());
    for element in elements.iter().take(3) {
        println!("  {:.2e} N/m, slips at {:.2e} m", element.stiffness, element.slip_displacement);
    }

    // Both loads vary, in and out of phase.
    let mut sheared = SlipHistory::new(&bed, friction);
    for (normal, tangential) in
        [(1.0, 0.0), (1.0, 0.5), (1.1, 0.7), (0.8, -0.2), (1.1, 0.7), (0.8, -0.2)]
    {
        let state = sheared.to(normal * load, tangential * joint.sliding_load())?;
        println!(
            "P = {:5.1} N, T = {:6.2} N: U = {:8.4} µm, {:.3e} J lost so far",
            state.load,
            state.tangential_load,
            1e6 * state.displacement,
            sheared.dissipation()
        );
    }

    // What fretting wears: the work of friction of each node.
    let work = joint.friction_work(&mut path, 0.5 * joint.sliding_load())?;
    println!(
        "greatest work of friction in a cycle of half the sliding load: {:.3} J/m²",
        work.max()
    );
    Ok(())
}
