//! Dissipation of one rough surface on finer and finer grids.

use std::fmt::Write as _;

use asperity::bed::Bed;
use asperity::loading::History;
use asperity::slip::{Friction, PartialSlip};
use asperity::surface::Amplitude;
use asperity::{Boussinesq, Error, Grid, HeightMap, LoadingSolver, SelfAffine};
use nalgebra::DMatrix;

/// Nodes along a side of the finest grid, and of those that take every so many of them.
const FINEST: usize = 128;
const STEPS: [usize; 3] = [4, 2, 1];
const SHARES: [f64; 4] = [0.1, 0.2, 0.4, 0.8];

pub(crate) fn write(text: &mut String) -> Result<(), Error> {
    text.push_str(
        "\n### How many nodes must slip\n\nOne surface (H = 0.8, roll-off at half the side, shortest wave a quarter of \
         that) under one load: the dissipation of a cycle over that on the finest grid, and in brackets the nodes that \
         slip.\n\n| T/μP |",
    );
    let side = 1.0;
    let shortest = side / 32.0 * 4.0;
    let surface = SelfAffine::new(0.8, side / 2.0, shortest, Amplitude::RmsHeight(0.01), 4)?;
    let fine = HeightMap::sample(&surface, &Grid::square(FINEST, side)?)?;
    let friction = Friction::new(0.3, 1.2)?;
    let mut columns = Vec::new();
    let mut load = 0.0;
    for step in STEPS.iter().rev() {
        let nodes = FINEST / step;
        let heights =
            DMatrix::from_fn(nodes, nodes, |ix, iy| fine.matrix()[(step * ix, step * iy)]);
        let kernel = Boussinesq::new(Grid::square(nodes, side)?, 1.0)?;
        let heights = HeightMap::new(heights)?;
        let builder = LoadingSolver::builder(&heights, &kernel);
        // The load of 15 % in contact on the finest grid.
        let path =
            if load == 0.0 { builder.max_area_fraction(0.15) } else { builder.max_load(load) };
        let history: History = path.build()?.collect::<Result<_, _>>()?;
        let bed = Bed::new(&history)?;
        load = if load == 0.0 { bed.last_load() } else { load };
        let joint = PartialSlip::new(&bed, load, friction)?;
        let cycles: Vec<_> = SHARES
            .iter()
            .map(|share| joint.cycle(share * joint.sliding_load()))
            .collect::<Result<_, _>>()?;
        columns.push((nodes, cycles));
    }
    columns.reverse();
    // Writing to a text cannot fail.
    for (nodes, _) in &columns {
        let _ = write!(text, " {nodes}² |");
    }
    text.push_str("\n|---|---|---|---|\n");
    for (row, share) in SHARES.iter().enumerate() {
        let _ = write!(text, "| {share} |");
        let finest = columns.last().map_or(f64::NAN, |(_, cycles)| cycles[row].dissipation);
        for (_, cycles) in &columns {
            let cycle = &cycles[row];
            let _ = write!(text, " {:.2} ({}) |", cycle.dissipation / finest, cycle.slipping_nodes);
        }
        text.push('\n');
    }
    let finest = columns.last().map(|(_, cycles)| cycles.clone()).unwrap_or_default();
    let off = columns.iter().take(columns.len().saturating_sub(1)).map(|(nodes, cycles)| {
        let off = cycles
            .iter()
            .zip(&finest)
            .map(|(cycle, finest)| (cycle.secant_stiffness / finest.secant_stiffness - 1.0).abs());
        format!("{:.1e} on {nodes}²", off.fold(0.0, f64::max))
    });
    let off: Vec<String> = off.collect();
    let _ = writeln!(
        text,
        "\nSecant stiffnesses differ from those on the finest grid by at most {}.",
        off.join(" and ")
    );
    Ok(())
}
