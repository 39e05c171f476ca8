//! Pieces, mirror images and multiples of a map.

use std::ops::{Bound, Range, RangeBounds};

use nalgebra::DMatrix;

use super::Topography;
use crate::surface::{Axis, HeightMap};
use crate::{Error, Grid};

impl Topography {
    /// The nodes `ix` × `iy` alone, with the cell as it is: `crop(10..90, ..)`.
    ///
    /// # Errors
    ///
    /// [`Error::CropOutOfGrid`] for nodes that the map does not have, and [`Error::EmptyGrid`] if
    /// none is left.
    pub fn crop(
        &self,
        ix: impl RangeBounds<usize>,
        iy: impl RangeBounds<usize>,
    ) -> Result<Self, Error> {
        let ix = within('x', &ix, self.grid.nx())?;
        let iy = within('y', &iy, self.grid.ny())?;
        let grid = Grid::new(ix.len(), iy.len(), self.grid.dx(), self.grid.dy())?;
        let piece = self.heights().view((ix.start, iy.start), grid.shape());
        Ok(Self { grid, map: HeightMap::of_finite(piece.into_owned()) })
    }

    /// The same surface seen from below: −h. Peaks become valleys.
    #[must_use]
    pub fn invert(&self) -> Self {
        Self { grid: self.grid, map: HeightMap::of_finite(-self.heights()) }
    }

    /// The map with x and y exchanged, cell included: what turns an image `[row, column]` into
    /// `[(ix, iy)]`.
    #[must_use]
    pub fn transpose(&self) -> Self {
        Self { grid: self.grid.transposed(), map: HeightMap::of_finite(self.heights().transpose()) }
    }

    /// The mirror image in which the order of the nodes along `axis` is reversed.
    #[must_use]
    pub fn flip(&self, axis: Axis) -> Self {
        let mut heights = self.heights().clone();
        let (nx, ny) = heights.shape();
        match axis {
            Axis::X => (0..nx / 2).for_each(|ix| heights.swap_rows(ix, nx - 1 - ix)),
            Axis::Y => (0..ny / 2).for_each(|iy| heights.swap_columns(iy, ny - 1 - iy)),
        }
        Self { grid: self.grid, map: HeightMap::of_finite(heights) }
    }

    /// The surface moved by whole nodes along x and y; what leaves it at one edge comes in at the opposite one, as on a
    /// surface that repeats.
    #[must_use]
    pub fn shift(&self, along_x: isize, along_y: isize) -> Self {
        let heights = self.heights();
        let (nx, ny) = heights.shape();
        // Grids are never empty, and far smaller than the greatest number.
        let from =
            |k: usize, shift: isize, n: usize| (k + n - shift.rem_euclid(n as isize) as usize) % n;
        let moved = DMatrix::from_fn(nx, ny, |ix, iy| {
            heights[(from(ix, along_x, nx), from(iy, along_y, ny))]
        });
        Self { grid: self.grid, map: HeightMap::of_finite(moved) }
    }

    /// Heights multiplied by `factor`, which may be negative or 0.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a factor that is not finite, and [`Error::HeightNotFinite`] if a
    /// product overflows.
    pub fn scaled(&self, factor: f64) -> Result<Self, Error> {
        Error::require_finite("factor of the heights", factor)?;
        self.with_heights(self.heights() * factor)
    }
}

/// The nodes that `range` means, if all of them are among `nodes`; none if it ends before it starts.
fn within(
    axis: char,
    range: &impl RangeBounds<usize>,
    nodes: usize,
) -> Result<Range<usize>, Error> {
    let start = match range.start_bound() {
        Bound::Included(&start) => start,
        Bound::Excluded(&before) => before.saturating_add(1),
        Bound::Unbounded => 0,
    };
    let end = match range.end_bound() {
        Bound::Included(&last) => last.saturating_add(1),
        Bound::Excluded(&end) => end,
        Bound::Unbounded => nodes,
    };
    if end > nodes || start > nodes {
        return Err(Error::CropOutOfGrid { axis, start, end, nodes });
    }
    Ok(start..end.max(start))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Surface;
    use nalgebra::dmatrix;

    fn map() -> Result<Topography, Error> {
        let heights = dmatrix![1.0, 2.0, 3.0; 4.0, 5.0, 6.0];
        Topography::new(Grid::new(2, 3, 1e-3, 2e-3)?, heights)
    }

    #[test]
    fn pieces() -> Result<(), Error> {
        let piece = map()?.crop(1.., 0..=1)?;
        assert_eq!(*piece.heights(), dmatrix![4.0, 5.0]);
        assert_eq!(*piece.grid(), Grid::new(1, 2, 1e-3, 2e-3)?);
        assert_eq!(map()?.crop(.., ..)?, map()?);
        Ok(())
    }

    #[test]
    #[expect(clippy::reversed_empty_ranges, reason = "a user may give one")]
    fn pieces_that_are_none() -> Result<(), Error> {
        let map = map()?;
        for refused in [map.crop(0..3, ..), map.crop(3.., ..), map.crop(..=usize::MAX, ..)] {
            let told = matches!(refused, Err(Error::CropOutOfGrid { axis: 'x', nodes: 2, .. }));
            assert!(told, "{refused:?}");
        }
        let beyond = map.crop(.., 1..4);
        assert!(matches!(
            beyond,
            Err(Error::CropOutOfGrid { axis: 'y', start: 1, end: 4, nodes: 3 })
        ));
        for empty in [map.crop(1..1, ..), map.crop(.., 2..1), map.crop(2.., ..)] {
            assert!(matches!(empty, Err(Error::EmptyGrid { .. })), "{empty:?}");
        }
        Ok(())
    }

    #[test]
    fn mirror_images_and_multiples() -> Result<(), Error> {
        let map = map()?;
        assert_eq!(*map.flip(Axis::X).heights(), dmatrix![4.0, 5.0, 6.0; 1.0, 2.0, 3.0]);
        assert_eq!(*map.flip(Axis::Y).heights(), dmatrix![3.0, 2.0, 1.0; 6.0, 5.0, 4.0]);
        let transposed = map.transpose();
        assert_eq!(*transposed.heights(), dmatrix![1.0, 4.0; 2.0, 5.0; 3.0, 6.0]);
        assert_eq!(*transposed.grid(), Grid::new(3, 2, 2e-3, 1e-3)?);
        assert_eq!(transposed.transpose(), map);
        assert_eq!(map.invert(), map.scaled(-1.0)?);
        // A topography is a surface on its own grid.
        assert_eq!(Surface::heights(&map.scaled(2.0)?, map.grid())?, 2.0 * map.heights());
        Ok(())
    }

    #[test]
    fn what_leaves_at_an_edge_comes_in_at_the_other() -> Result<(), Error> {
        let map = map()?;
        assert_eq!(*map.shift(0, 1).heights(), dmatrix![3.0, 1.0, 2.0; 6.0, 4.0, 5.0]);
        assert_eq!(*map.shift(-1, -2).heights(), dmatrix![6.0, 4.0, 5.0; 3.0, 1.0, 2.0]);
        for (ix, iy) in [(0, 0), (2, 3), (-4, 6), (0, -3)] {
            assert_eq!(map.shift(ix, iy), map);
        }
        let extreme = map.shift(isize::MIN, isize::MAX);
        assert_eq!(extreme.shift(isize::MIN, 0).shift(0, -isize::MAX), map);
        Ok(())
    }

    #[test]
    fn factors_that_are_none() -> Result<(), Error> {
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(matches!(map()?.scaled(bad), Err(Error::OutOfRange { .. })));
        }
        let overflow = map()?.scaled(1e308);
        assert!(matches!(overflow, Err(Error::HeightNotFinite { count: 5, ix: 1, iy: 0, .. })));
        Ok(())
    }
}
