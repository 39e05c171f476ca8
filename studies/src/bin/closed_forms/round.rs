//! Round contacts of a free half-space: sphere, ellipse and cone.

use asperity::reference::{Cone as Sneddon, HertzEllipse, HertzSphere};
use asperity::surface::{Cone, EllipticParaboloid, Paraboloid};
use asperity::{Boundary, Boussinesq, Error, FixedLoadSolution, FixedLoadSolver, Grid, Surface};

use crate::curve::{APEXES, Curve, Errors, Quantity, TOLERANCE, loads, on_all};
use asperity_studies::contact_area::corrected_area_fraction;

/// Width of the grid over the radius of the contact at the target.
const WIDTH: f64 = 2.9;
/// Radius of curvature over that of the contact, and slope of the cone; the problem is linear.
const CURVATURE: f64 = 100.0;
const SLOPE: f64 = 0.01;
/// Ratio of the radii of the elliptic paraboloid.
const RADII: f64 = 4.0;
/// Where pressures are compared that are infinite in the middle or on the edge: distances over the radius.
pub(crate) const RING: (f64, f64) = (0.35, 0.65);

/// The closed form at one load.
struct Exact {
    area: f64,
    approach: f64,
    stiffness: f64,
    energy: f64,
}

/// One contact on one grid; cells are of unit size, and E* = 1.
struct Contact<'a> {
    grid: Grid,
    surface: &'a dyn Surface,
    apex: (f64, f64),
    exact: &'a dyn Fn(f64) -> Exact,
    /// Pressure at a place relative to the apex under a load.
    pressure: &'a dyn Fn((f64, f64), f64) -> f64,
    /// Distances from the apex between which pressures are compared; `None` for the greatest alone.
    ring: Option<(f64, f64)>,
}

impl Contact<'_> {
    /// Adds the errors at all loads around a target.
    fn compare(&self, target: f64, errors: &mut Errors) -> Result<(), Error> {
        // How far the highest node lies below the apex, which no node need sample.
        let depth = -self.surface.heights(&self.grid)?.max();
        let mut solver = solver(self.surface, self.grid)?;
        for solution in solver.sweep(loads(target)) {
            let solution = solution?;
            let state = &solution.contact;
            let exact = (self.exact)(state.load);
            let fraction =
                corrected_area_fraction(&solution.fields.contact_map, &self.grid, Boundary::Free)?;
            let corrected = fraction * self.grid.nominal_area();
            errors.add(Quantity::Area, state.contact_area, exact.area);
            errors.add(Quantity::CorrectedArea, corrected, exact.area);
            errors.add(Quantity::Distance, state.approach + depth, exact.approach);
            let stiffness = state.contact_stiffness.unwrap_or(f64::NAN);
            errors.add(Quantity::Stiffness, stiffness, exact.stiffness);
            errors.add(Quantity::Energy, state.energy, exact.energy);
            let pressure = |place| (self.pressure)(place, state.load);
            let ratio = pressure_ratio(&solution, &self.grid, self.apex, self.ring, pressure);
            errors.add(Quantity::Pressure, ratio, 1.0);
        }
        Ok(())
    }
}

/// Pressure over its closed form: of the greatest pressure, or the mean over a ring around the apex.
pub(crate) fn pressure_ratio(
    solution: &FixedLoadSolution,
    grid: &Grid,
    apex: (f64, f64),
    ring: Option<(f64, f64)>,
    exact: impl Fn((f64, f64)) -> f64,
) -> f64 {
    let ratio = |(ix, iy): (usize, usize)| {
        let (x, y) = grid.position(ix, iy);
        let place = (x - apex.0, y - apex.1);
        let inside = |(from, to): (f64, f64)| (from..to).contains(&place.0.hypot(place.1));
        let counts = ring.is_none_or(inside);
        counts.then(|| solution.fields.pressure[(ix, iy)] / exact(place))
    };
    let nodes = match ring {
        None => vec![solution.fields.pressure.iamax_full()],
        Some(_) => (0..grid.nodes()).map(|node| grid.coordinates(node)).collect(),
    };
    let ratios: Vec<f64> = nodes.into_iter().filter_map(ratio).collect();
    ratios.iter().sum::<f64>() / ratios.len() as f64
}

pub(crate) fn solver(surface: &dyn Surface, grid: Grid) -> Result<FixedLoadSolver, Error> {
    let kernel = Boussinesq::new(grid, 1.0)?;
    FixedLoadSolver::builder(surface, &kernel).tolerance(TOLERANCE).build()
}

/// A grid of unit cells around a contact of these semi-axes.
pub(crate) fn grid_around(x: f64, y: f64) -> Result<Grid, asperity::SurfaceError> {
    Grid::new((WIDTH * x) as usize, (WIDTH * y) as usize, 1.0, 1.0)
}

pub(crate) fn moved(grid: &Grid, offset: (f64, f64)) -> (f64, f64) {
    let center = grid.center();
    (center.0 + offset.0, center.1 + offset.1)
}

/// All curves of the round contacts.
pub(crate) fn curves() -> Result<Vec<Curve>, Error> {
    let mut curves = Vec::new();
    curves.extend(Curve::of("sphere", &on_all(sphere)?, &[]));
    curves.extend(Curve::of("ellipse", &on_all(ellipse)?, &[]));
    curves.extend(Curve::of("cone", &on_all(cone)?, &[]));
    Ok(curves)
}

fn sphere(cells: usize) -> Result<Errors, Error> {
    let cells = cells as f64;
    let radius = CURVATURE * cells;
    let hertz = HertzSphere::new(radius, 1.0)?;
    let grid = grid_around(cells, cells)?;
    let mut errors = Errors::default();
    for offset in APEXES {
        let apex = moved(&grid, offset);
        let contact = Contact {
            grid,
            surface: &Paraboloid::new(radius)?.centered_at(apex.0, apex.1)?,
            apex,
            exact: &|load| {
                let approach = hertz.approach_at_load(load);
                Exact {
                    area: hertz.contact_area(approach),
                    approach,
                    stiffness: hertz.contact_stiffness(approach),
                    energy: hertz.energy(approach),
                }
            },
            pressure: &|(x, y), load| hertz.pressure(x.hypot(y), hertz.approach_at_load(load)),
            ring: None,
        };
        contact.compare(hertz.load(cells * cells / radius), &mut errors)?;
    }
    Ok(errors)
}

fn ellipse(cells: usize) -> Result<Errors, Error> {
    let cells = cells as f64;
    let radii = (CURVATURE * cells, RADII * CURVATURE * cells);
    let hertz = HertzEllipse::new(radii.0, radii.1, 1.0)?;
    let target = (cells / hertz.semi_axes(1.0).0).powi(2);
    let (a, b) = hertz.semi_axes(target);
    let grid = grid_around(a, b)?;
    let mut errors = Errors::default();
    for offset in APEXES {
        let apex = moved(&grid, offset);
        let shape = EllipticParaboloid::new(radii.0, radii.1)?;
        let contact = Contact {
            grid,
            surface: &shape.centered_at(apex.0, apex.1)?,
            apex,
            exact: &|load| {
                let approach = hertz.approach_at_load(load);
                Exact {
                    area: hertz.contact_area(approach),
                    approach,
                    stiffness: hertz.contact_stiffness(approach),
                    energy: hertz.energy(approach),
                }
            },
            pressure: &|(x, y), load| hertz.pressure(x, y, hertz.approach_at_load(load)),
            ring: None,
        };
        contact.compare(hertz.load(target), &mut errors)?;
    }
    Ok(errors)
}

fn cone(cells: usize) -> Result<Errors, Error> {
    let cells = cells as f64;
    let sneddon = Sneddon::new(SLOPE, 1.0)?;
    let target = sneddon.load(0.5 * std::f64::consts::PI * SLOPE * cells);
    let grid = grid_around(cells, cells)?;
    let mut errors = Errors::default();
    for offset in APEXES {
        let apex = moved(&grid, offset);
        let contact = Contact {
            grid,
            surface: &Cone::new(SLOPE)?.centered_at(apex.0, apex.1)?,
            apex,
            exact: &|load| {
                let approach = sneddon.approach_at_load(load);
                Exact {
                    area: sneddon.contact_area(approach),
                    approach,
                    stiffness: sneddon.contact_stiffness(approach),
                    energy: sneddon.energy(approach),
                }
            },
            pressure: &|(x, y), load| sneddon.pressure(x.hypot(y), sneddon.approach_at_load(load)),
            ring: Some((RING.0 * cells, RING.1 * cells)),
        };
        contact.compare(target, &mut errors)?;
    }
    Ok(errors)
}
