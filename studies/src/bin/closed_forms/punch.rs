//! The two flat punches on a free half-space.

use asperity::reference::{CircularPunch, SQUARE_PUNCH_STIFFNESS};
use asperity::surface::{FlatPunch, HeightMap};
use asperity::{Error, Grid};
use nalgebra::DMatrix;

use crate::curve::{APEXES, Curve, Errors, LOADS, PUNCH_CELLS, Quantity, on_all};
use crate::round::{RING, grid_around, moved, pressure_ratio, solver};

/// Radii of the circular punch over the target, first and last.
const RADII: (f64, f64) = (0.9, 1.1);

/// The curves of the circular punch.
pub(crate) fn circular() -> Result<Vec<Curve>, Error> {
    // The pressure on the ring is that of a punch whose radius is wrong by a part of a cell.
    let edge = [(Quantity::Pressure, 1.0)];
    Ok(Curve::of("circular punch", &on_all(circular_punch)?, &edge))
}

/// Its contact is the face at any load, so that radii are varied instead; approach and energy have the error of the
/// stiffness.
fn circular_punch(cells: usize) -> Result<Errors, Error> {
    let cells = cells as f64;
    let grid = grid_around(cells, cells)?;
    let mut errors = Errors::default();
    for offset in APEXES {
        let apex = moved(&grid, offset);
        for k in 0..LOADS {
            let part = (k as f64 + 0.5) / LOADS as f64;
            let radius = cells * (RADII.0 + (RADII.1 - RADII.0) * part);
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
            let stiffness = solution.contact.contact_stiffness.unwrap_or(f64::NAN);
            errors.add(Quantity::Stiffness, stiffness, exact.contact_stiffness());
            let ring = (RING.0 * cells, RING.1 * cells);
            let pressure = |(x, y): (f64, f64)| exact.pressure(x.hypot(y), 1.0);
            let ratio = pressure_ratio(&solution, &grid, apex, Some(ring), pressure);
            errors.add(Quantity::Pressure, ratio, 1.0);
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
            Ok((n, solution.contact.contact_stiffness.unwrap_or(f64::NAN)))
        };
        Ok(Self { stiffness: PUNCH_CELLS.iter().map(stiffness).collect::<Result<_, Error>>()? })
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
