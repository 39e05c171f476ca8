//! The composite roughness of two surfaces.

use nalgebra::DMatrix;

use super::placement::all_finite;
use crate::{Error, Grid, Surface};

/// The sum h₁ + h₂ of two surfaces, made by [`Surface::plus`].
///
/// Two rough elastic bodies touch like one rigid surface and one flat half-space, if the heights
/// are added, each pointing towards the other body, and the compliances too (see
/// `composite_modulus` of the crate `asperity`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sum<A, B> {
    pub(super) first: A,
    pub(super) second: B,
}

impl<A: Surface, B: Surface> Surface for Sum<A, B> {
    fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, Error> {
        let mut heights = self.first.heights(grid)?;
        grid.check_shape(heights.shape())?;
        let second = self.second.heights(grid)?;
        grid.check_shape(second.shape())?;
        heights += second;
        all_finite(heights)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::surface::{FlatPunch, HeightMap, Paraboloid};

    #[test]
    fn two_spheres_touch_like_one() -> Result<(), Error> {
        let grid = Grid::square(12, 1e-3)?;
        let sum = Paraboloid::new(0.2)?.plus(Paraboloid::new(0.3)?);
        let one = Paraboloid::new(0.12)?.heights(&grid)?;
        let deviation = (sum.heights(&grid)? - &one).amax();
        // Each height is rounded a few times.
        assert!(deviation <= 4.0 * f64::EPSILON * one.amax());
        Ok(())
    }

    #[test]
    fn works_through_pointers() -> Result<(), Error> {
        let grid = Grid::square(3, 1.0)?;
        let punch = FlatPunch::new(1.0)?;
        let boxed: Box<dyn Surface> = Box::new(FlatPunch::new(2.0)?);
        let shared: Arc<dyn Surface> = Arc::new(FlatPunch::new(3.0)?);
        let heights = (&punch).plus(boxed).plus(shared).heights(&grid)?;
        assert_eq!(heights, DMatrix::from_element(3, 3, 6.0));
        Ok(())
    }

    #[test]
    fn mismatch_and_overflow_are_refused() -> Result<(), Error> {
        let grid = Grid::square(3, 1.0)?;
        let map = HeightMap::new(DMatrix::zeros(3, 4))?;
        let mismatch = FlatPunch::default().plus(map).heights(&grid);
        assert!(matches!(mismatch, Err(Error::GridMismatch { .. })));
        let high = FlatPunch::new(1e308)?;
        let overflow = high.plus(high).heights(&grid);
        assert!(matches!(overflow, Err(Error::HeightNotFinite { .. })));
        Ok(())
    }
}
