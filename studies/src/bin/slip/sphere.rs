//! A sphere on finer and finer meshes, against Cattaneo and Mindlin.

use std::fmt::Write as _;

use asperity::bed::Bed;
use asperity::loading::History;
use asperity::reference::{HertzSphere, SphereSlip};
use asperity::slip::{Friction, PartialSlip};
use asperity::surface::Paraboloid;
use asperity::{Boussinesq, Error, Grid, LoadingSolver};

const RADIUS: f64 = 10.0;
const SHARES: [f64; 3] = [0.1, 0.25, 0.9];

pub(crate) fn write(text: &mut String) -> Result<(), Error> {
    text.push_str(
        "\n### A sphere over meshes\n\nA sphere on a free half-space under the load at which Hertz' contact radius is \
         3/8 of the side. Errors of the displacement U and of the dissipation D of a cycle against Cattaneo–Mindlin \
         and Mindlin–Deresiewicz (`reference::SphereSlip`). The dissipation needs a ring of slip some two cells \
         wide.\n\n\
         | nodes | T/μP | error of U | error of D | cells across the ring |\n|---|---|---|---|---|\n",
    );
    let surface = Paraboloid::new(RADIUS)?;
    let sphere = HertzSphere::new(RADIUS, 1.0)?;
    let radius = 0.375;
    let load = sphere.load(radius * radius / RADIUS);
    let friction = Friction::new(0.3, 1.2)?;
    for nodes in [64, 128] {
        let kernel = Boussinesq::new(Grid::square(nodes, 1.0)?, 1.0)?;
        let path = LoadingSolver::builder(&surface, &kernel).max_load(load).build()?;
        let history: History = path.collect::<Result<_, _>>()?;
        let bed = Bed::new(&history)?;
        let joint = PartialSlip::new(&bed, load, friction)?;
        let exact =
            SphereSlip::new(sphere, load, friction.coefficient(), friction.compliance_ratio())?;
        for share in SHARES {
            let force = share * joint.sliding_load();
            let cycle = joint.cycle(force)?;
            // Writing to a text cannot fail.
            let _ = writeln!(
                text,
                "| {nodes}² | {share} | {:.1e} | {:.1e} | {:.1} |",
                cycle.displacement / exact.displacement(force) - 1.0,
                cycle.dissipation / exact.dissipation(force) - 1.0,
                (radius - exact.stick_radius(force)) * f64::from(nodes as u32),
            );
        }
    }
    Ok(())
}
