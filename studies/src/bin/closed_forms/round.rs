//! Contacts of a free half-space in three dimensions: sphere, ellipse, cone and the two punches.

use asperity::reference::{
    CircularPunch, Cone as Sneddon, HertzEllipse, HertzSphere, SQUARE_PUNCH_STIFFNESS,
};
use asperity::surface::{Cone, EllipticParaboloid, FlatPunch, HeightMap, Paraboloid};
use asperity::{Boundary, Boussinesq, Error, FixedLoadSolution, FixedLoadSolver, Grid, Surface};
use nalgebra::DMatrix;

use crate::curve::{APEXES, CELLS, Curve, Errors, LOADS, PUNCH_CELLS, Quantity, TOLERANCE};
use asperity_studies::contact_area::corrected_area_fraction;

/// Width of the grid over the radius of the contact at the target.
const WIDTH: f64 = 2.9;
/// Radius of curvature over that of the contact, and slope of the cone; the problem is linear.
const CURVATURE: f64 = 100.0;
const SLOPE: f64 = 0.01;
/// Ratio of the radii of the elliptic paraboloid.
const RADII: f64 = 4.0;
/// Where pressures are compared that are infinite in the middle or on the edge: distances over the radius.
const RING: (f64, f64) = (0.35, 0.65);
/// Radii of the circular punch over the target, first and last.
const PUNCH_RADII: (f64, f64) = (0.9, 1.1);

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
        let loads = (0..LOADS).map(|k| target * (0.75 + 0.5 * (k as f64 + 0.5) / LOADS as f64));
        for solution in solver.sweep(loads) {
            let solution = solution?;
            let state = &solution.state;
            let exact = (self.exact)(state.load);
            let fraction =
                corrected_area_fraction(&solution.contact_map, &self.grid, Boundary::Free)?;
            let corrected = fraction * self.grid.nominal_area();
            errors.add(Quantity::Area, state.contact_area, exact.area);
            errors.add(Quantity::CorrectedArea, corrected, exact.area);
            errors.add(Quantity::Distance, state.approach + depth, exact.approach);
            let stiffness = state.contact_stiffness.unwrap_or(f64::NAN);
            errors.add(Quantity::Stiffness, stiffness, exact.stiffness);
            errors.add(Quantity::Energy, state.energy, exact.energy);
            self.compare_pressure(&solution, errors);
        }
        Ok(())
    }

    fn compare_pressure(&self, solution: &FixedLoadSolution, errors: &mut Errors) {
        let load = solution.state.load;
        let ratio = |node: usize| {
            let (ix, iy) = self.grid.coordinates(node);
            let (x, y) = self.grid.position(ix, iy);
            let place = (x - self.apex.0, y - self.apex.1);
            let inside = |(from, to): (f64, f64)| (from..to).contains(&place.0.hypot(place.1));
            let counts = self.ring.is_none_or(inside);
            counts.then(|| solution.pressure[(ix, iy)] / (self.pressure)(place, load))
        };
        let found = match self.ring {
            None => {
                let (ix, iy) = solution.pressure.iamax_full();
                self.grid.node(ix, iy).and_then(ratio)
            }
            Some(_) => {
                let ratios: Vec<f64> = (0..self.grid.nodes()).filter_map(ratio).collect();
                Some(ratios.iter().sum::<f64>() / ratios.len() as f64)
            }
        };
        errors.add(Quantity::Pressure, found.unwrap_or(f64::NAN), 1.0);
    }
}

fn solver(surface: &dyn Surface, grid: Grid) -> Result<FixedLoadSolver, Error> {
    let kernel = Boussinesq::new(grid, 1.0)?;
    FixedLoadSolver::builder(surface, &kernel)
        .tolerance(TOLERANCE)
        .build()
}

/// A grid of unit cells around a contact of these semi-axes.
fn grid_around(x: f64, y: f64) -> Result<Grid, Error> {
    Grid::new((WIDTH * x) as usize, (WIDTH * y) as usize, 1.0, 1.0)
}

fn moved(grid: &Grid, offset: (f64, f64)) -> (f64, f64) {
    let center = grid.center();
    (center.0 + offset.0, center.1 + offset.1)
}

/// All curves of the round contacts.
pub(crate) fn curves() -> Result<Vec<Curve>, Error> {
    let mut curves = Vec::new();
    let on_all = |errors: &dyn Fn(f64) -> Result<Errors, Error>| {
        let each = CELLS
            .iter()
            .map(|&cells| Ok((cells, errors(cells as f64)?)));
        each.collect::<Result<Vec<_>, Error>>()
    };
    curves.extend(Curve::of("sphere", &on_all(&sphere)?, &[]));
    curves.extend(Curve::of("ellipse", &on_all(&ellipse)?, &[]));
    curves.extend(Curve::of("cone", &on_all(&cone)?, &[]));
    // Its ring is under the pressure of a punch whose radius is wrong by a part of a cell.
    let edge = [(Quantity::Pressure, 1.0)];
    curves.extend(Curve::of(
        "circular punch",
        &on_all(&circular_punch)?,
        &edge,
    ));
    Ok(curves)
}

fn sphere(cells: f64) -> Result<Errors, Error> {
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

fn ellipse(cells: f64) -> Result<Errors, Error> {
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

fn cone(cells: f64) -> Result<Errors, Error> {
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

/// Its contact is the face at any load, so that radii are varied instead; approach and energy have the error of the
/// stiffness.
fn circular_punch(cells: f64) -> Result<Errors, Error> {
    let grid = grid_around(cells, cells)?;
    let mut errors = Errors::default();
    for offset in APEXES {
        let apex = moved(&grid, offset);
        for k in 0..LOADS {
            let part = (k as f64 + 0.5) / LOADS as f64;
            let radius = cells * (PUNCH_RADII.0 + (PUNCH_RADII.1 - PUNCH_RADII.0) * part);
            let exact = CircularPunch::new(radius, 1.0)?;
            // Everything is in proportion to the approach, as long as the rest stays out of contact.
            let load = exact.load(1.0);
            let distance = |ix: usize, iy: usize| {
                let (x, y) = grid.position(ix, iy);
                (x - apex.0).hypot(y - apex.1)
            };
            let face = |ix, iy| if distance(ix, iy) < radius { 0.0 } else { -4.0 };
            let heights = HeightMap::new(DMatrix::from_fn(grid.nx(), grid.ny(), face))?;
            let solution = solver(&heights, grid)?.solve(load)?;
            let stiffness = solution.state.contact_stiffness.unwrap_or(f64::NAN);
            errors.add(Quantity::Stiffness, stiffness, exact.contact_stiffness());
            let contact = Contact {
                grid,
                surface: &heights,
                apex,
                exact: &|_| Exact {
                    area: exact.contact_area(),
                    approach: 1.0,
                    stiffness: exact.contact_stiffness(),
                    energy: exact.energy(1.0),
                },
                pressure: &|(x, y), load| exact.pressure(x.hypot(y), exact.approach_at_load(load)),
                ring: Some((RING.0 * cells, RING.1 * cells)),
            };
            contact.compare_pressure(&solution, &mut errors);
        }
    }
    Ok(errors)
}

/// The square punch, for whose stiffness only numbers are known.
pub(crate) struct SquarePunch {
    /// (cells along the side, K/(E* L)).
    pub(crate) stiffness: Vec<(usize, f64)>,
}

impl SquarePunch {
    pub(crate) fn new() -> Result<Self, Error> {
        let stiffness = |half: &usize| {
            let n = 2 * half;
            let grid = Grid::square(n, 1.0)?;
            let solution = solver(&FlatPunch::default(), grid)?.solve(1.0)?;
            Ok((n, solution.state.contact_stiffness.unwrap_or(f64::NAN)))
        };
        Ok(Self {
            stiffness: PUNCH_CELLS
                .iter()
                .map(stiffness)
                .collect::<Result<_, Error>>()?,
        })
    }

    /// Richardson's extrapolation from each two grids, first order: the pressure is singular along the edge.
    pub(crate) fn richardson(&self) -> Vec<f64> {
        let pairs = self.stiffness.windows(2);
        pairs.map(|pair| 2.0 * pair[1].1 - pair[0].1).collect()
    }

    /// Aitken's extrapolation of these: the order of the corners is not an integer.
    pub(crate) fn limit(&self) -> f64 {
        let richardson = self.richardson();
        let Some([a, b, c]) = richardson.last_chunk::<3>() else {
            return f64::NAN;
        };
        c - (c - b) * (c - b) / ((c - b) - (b - a))
    }

    pub(crate) fn curve(&self) -> Curve {
        let error =
            |(n, k): &(usize, f64)| (0.5 * *n as f64, (k / SQUARE_PUNCH_STIFFNESS - 1.0).abs());
        Curve {
            contact: "square punch",
            quantity: Quantity::Stiffness,
            expected: 1.0,
            points: self.stiffness.iter().map(error).collect(),
        }
    }
}
