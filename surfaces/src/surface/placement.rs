//! Where a shape stands on the grid, and the distances of the nodes from there.

use nalgebra::DMatrix;

use super::missing::count_missing;
use crate::{Error, Grid};

/// A direction of the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Along x, the first index of every field.
    X,
    /// Along y, the second index.
    Y,
}

impl Axis {
    /// That of two things, one along x and one along y, which belongs to this direction.
    pub(super) fn of<T>(self, (x, y): (T, T)) -> T {
        match self {
            Self::X => x,
            Self::Y => y,
        }
    }
}

/// The reference point of a shape: the centre of whatever grid it is put on, or a fixed point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Placement(Option<(f64, f64)>);

impl Placement {
    /// A fixed reference point \[m\].
    pub(super) fn at(x: f64, y: f64) -> Result<Self, Error> {
        let x = Error::require_finite("centre x", x)?;
        Ok(Self(Some((x, Error::require_finite("centre y", y)?))))
    }

    /// Heights `height(x, y)`, x and y measured from the reference point.
    pub(super) fn heights(
        self,
        grid: &Grid,
        height: impl Fn(f64, f64) -> f64,
    ) -> Result<DMatrix<f64>, Error> {
        let (cx, cy) = match self.0 {
            Some((x, y)) => (Some(x), Some(y)),
            None => (None, None),
        };
        let xs = offsets(grid.nx(), grid.dx(), cx);
        let ys = offsets(grid.ny(), grid.dy(), cy);
        all_finite(DMatrix::from_fn(grid.nx(), grid.ny(), |ix, iy| {
            // One zero only: -0 is equal to 0, but not bit for bit.
            height(xs[ix], ys[iy]) + 0.0
        }))
    }
}

/// Distances of the nodes of one direction from `center`, or from the middle of the grid.
///
/// They are counted in cells, and a centre that lies on a node or midway between two, up to
/// rounding, is taken to lie there exactly: nodes that mirror each other then get distances that
/// are opposite bit for bit.
fn offsets(nodes: usize, cell: f64, center: Option<f64>) -> Vec<f64> {
    let origin = match center {
        None => 0.5 * (nodes as f64 - 1.0),
        Some(center) => {
            let doubled = 2.0 * (center / cell) - 1.0;
            let half_integer = doubled.round_ties_even();
            let rounding = 4.0 * f64::EPSILON * (1.0 + doubled.abs());
            if (doubled - half_integer).abs() <= rounding {
                0.5 * half_integer
            } else {
                0.5 * doubled
            }
        }
    };
    (0..nodes).map(|i| (i as f64 - origin) * cell).collect()
}

/// The heights, if all of them are finite.
pub(super) fn all_finite(heights: DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
    match heights.iter().position(|z| !z.is_finite()) {
        None => Ok(heights),
        Some(node) => Err(Error::HeightNotFinite {
            ix: node % heights.nrows(),
            iy: node / heights.nrows(),
            value: heights[node],
            count: count_missing(&heights),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn offsets_are_positions_relative_to_the_centre(
            nodes in 1_usize..200, cell in 1e-9_f64..1e3, relative in -2.0_f64..3.0,
        ) {
            let grid = Grid::new(nodes, 1, cell, 1.0).map_err(|e| TestCaseError::fail(e.to_string()))?;
            let side = grid.sides().0;
            for center in [Some(relative * side), None] {
                for (i, x) in offsets(nodes, cell, center).into_iter().enumerate() {
                    let expected = grid.position(i, 0).0 - center.unwrap_or(grid.center().0);
                    // Both sides round quantities of at most 3 sides a handful of times.
                    prop_assert!((x - expected).abs() <= 20.0 * f64::EPSILON * side);
                }
            }
        }

        #[test]
        fn a_centre_on_a_node_or_midway_mirrors_exactly(
            twice in 0_usize..80, cell in 1e-9_f64..1e3,
        ) {
            // Computed the way a user would, with its rounding.
            let center = (0.5 * twice as f64 + 0.5) * cell;
            let x = offsets(41, cell, Some(center));
            for i in 0..=twice.min(40) {
                if let Some(mirrored) = x.get(twice - i) {
                    prop_assert_eq!(x[i], -mirrored);
                }
            }
        }
    }

    #[test]
    fn a_centre_must_be_finite() {
        assert!(matches!(
            Placement::at(0.0, f64::NAN),
            Err(Error::OutOfRange { quantity: "centre y", .. })
        ));
        assert!(Placement::at(f64::INFINITY, 0.0).is_err());
    }
}
