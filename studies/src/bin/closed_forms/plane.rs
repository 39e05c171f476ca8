//! Plane contacts: the cylinder on a free half-space, and a wave on a periodic one. A single row of cells is enough,
//! each a bar across the whole strip.

use asperity::reference::{HertzLine, Westergaard};
use asperity::surface::{Axis, Cylinder, Wave};
use asperity::{Boussinesq, Error, FixedLoadSolution, FixedLoadSolver, Grid};
use asperity_cli::half_space::{Periodic, half_space};

use crate::curve::{APEXES, Curve, Errors, Quantity, TOLERANCE, loads, on_all};

/// Length of the strip under the cylinder over the width of the grid: what is left of its ends is of second order in
/// the inverse, 10⁻⁸.
const LENGTH: f64 = 1e4;
/// Width of the grid over the half-width of the contact at the target.
const WIDTH: f64 = 2.9;
const RADIUS: f64 = 100.0;
/// Load at the target over that of full contact: the contact is half a wavelength wide.
const RATIO: f64 = 0.5;
const AMPLITUDE: f64 = 0.01;

pub(crate) fn curves() -> Result<Vec<Curve>, Error> {
    let mut curves = Vec::new();
    curves.extend(Curve::of("cylinder", &on_all(cylinder)?, &[]));
    for (name, kernel) in [("wave, Love", Periodic::Love), ("wave, spectral", Periodic::Spectral)] {
        curves.extend(Curve::of(name, &on_all(|cells| wave(cells, kernel))?, &[]));
    }
    Ok(curves)
}

/// The greatest pressure, and how far from `x` it is.
fn peak(solution: &FixedLoadSolution, grid: &Grid, x: f64) -> (f64, f64) {
    let (ix, iy) = solution.fields.pressure.iamax_full();
    (solution.fields.pressure[(ix, iy)], grid.position(ix, iy).0 - x)
}

fn cylinder(cells: usize) -> Result<Errors, Error> {
    let a = cells as f64;
    let hertz = HertzLine::new(RADIUS * a, 1.0)?;
    let nx = (WIDTH * a) as usize;
    let length = LENGTH * nx as f64;
    let grid = Grid::new(nx, 1, 1.0, length)?;
    let kernel = Boussinesq::new(grid, 1.0)?;
    let mut errors = Errors::default();
    for (offset, _) in APEXES {
        let x = grid.center().0 + offset;
        let surface = Cylinder::new(RADIUS * a, Axis::Y)?.centered_at(x, 0.0)?;
        let mut solver =
            FixedLoadSolver::builder(&surface, &kernel).tolerance(TOLERANCE).build()?;
        for solution in solver.sweep(loads(hertz.load_at_half_width(a) * length)) {
            let solution = solution?;
            let load = solution.contact.load / length;
            let width = solution.contact.contact_area / length;
            errors.add(Quantity::Area, width, 2.0 * hertz.half_width(load));
            let (found, x) = peak(&solution, &grid, x);
            errors.add(Quantity::Pressure, found, hertz.pressure(x, load));
        }
    }
    Ok(errors)
}

fn wave(cells: usize, kernel: Periodic) -> Result<Errors, Error> {
    let nodes = 4 * cells;
    let exact = Westergaard::new(AMPLITUDE, 1.0, 1.0)?;
    let grid = Grid::with_sides(nodes, 1, 1.0, 1.0)?;
    let kernel = half_space(Some(kernel), grid, 1.0)?;
    let mut errors = Errors::default();
    for (offset, _) in APEXES {
        let x = grid.center().0 + offset * grid.dx();
        let surface = Wave::new(AMPLITUDE, 1.0, Axis::X)?.centered_at(x, 0.0)?;
        let mut solver =
            FixedLoadSolver::builder(&surface, &kernel).tolerance(TOLERANCE).build()?;
        for solution in solver.sweep(loads(RATIO * exact.full_contact_pressure())) {
            let solution = solution?;
            // On the unit square loads are mean pressures.
            let (state, mean) = (&solution.contact, solution.contact.load);
            let area = exact.contact_area_fraction(mean);
            errors.add(Quantity::Area, state.contact_area_fraction, area);
            errors.add(Quantity::Distance, state.mean_gap, exact.mean_gap(mean));
            let stiffness = state.interfacial_stiffness.unwrap_or(f64::NAN);
            let interfacial = exact.interfacial_stiffness(mean);
            errors.add(Quantity::Stiffness, stiffness, interfacial);
            errors.add(Quantity::Energy, state.energy, exact.energy(mean));
            let (found, x) = peak(&solution, &grid, x);
            errors.add(Quantity::Pressure, found, exact.pressure(x, mean));
        }
    }
    Ok(errors)
}
