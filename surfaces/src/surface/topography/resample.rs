//! The same surface on another number of nodes.

use asperity_fft::Plan;
use nalgebra::DMatrix;
use num_complex::Complex64;

use super::Topography;
use crate::surface::placement::all_finite;
use crate::surface::{HeightMap, turns};
use crate::{Error, Grid};

/// How heights between nodes follow from those at nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Interpolation {
    /// The trigonometric polynomial through the nodes, for a periodic map.
    ///
    /// Exact for every map without waves shorter than two cells, old and new. On more nodes the
    /// surface is the same; on fewer, waves that the new nodes cannot carry are left out. A wave of
    /// exactly two cells is taken with its crests at the nodes.
    Fourier,
    /// Linear along x and along y between the four nodes around a point, for any map.
    ///
    /// Within half a cell of the border, beyond the outermost nodes, heights are those of the nearest
    /// point between nodes. Fewer nodes are a sample and not a mean: take short waves out before, by
    /// [`Topography::low_pass`].
    Bilinear,
}

impl Topography {
    /// The surface over the same rectangle on `nx` × `ny` nodes, at the centres of their cells.
    ///
    /// # Errors
    ///
    /// Those of [`Grid::with_sides`], and [`Error::HeightNotFinite`] if sums of heights overflow.
    pub fn resample(
        &self,
        nx: usize,
        ny: usize,
        interpolation: Interpolation,
    ) -> Result<Self, Error> {
        let (lx, ly) = self.grid.sides();
        let mut grid = Grid::with_sides(nx, ny, lx, ly)?;
        if (nx, ny) == self.grid.shape() {
            grid = self.grid;
        }
        let along_x = match interpolation {
            Interpolation::Fourier => fourier_along_x,
            Interpolation::Bilinear => linear_along_x,
        };
        let mean = self.map.mean_height();
        let half = along_x(&self.heights().add_scalar(-mean), nx).transpose();
        let heights = along_x(&half, ny).transpose().add_scalar(mean);
        Ok(Self { grid, map: HeightMap::of_finite(all_finite(heights)?) })
    }
}

/// Columns of `nodes` heights in place of those given, by their Fourier series.
fn fourier_along_x(heights: &DMatrix<f64>, nodes: usize) -> DMatrix<f64> {
    let old = heights.nrows();
    if nodes == old {
        return heights.clone();
    }
    let (forward, inverse) = (f64::real_forward(old), f64::real_inverse(nodes));
    let mut line = forward.make_input_vec();
    let (mut spectrum, mut resampled) = (forward.make_output_vec(), inverse.make_input_vec());
    let mut scratch = forward.make_scratch_vec();
    let mut inverse_scratch = inverse.make_scratch_vec();
    // Node 0 moves from half an old cell to half a new one.
    let shift = |k: usize| 0.5 * k as f64 * (1.0 / nodes as f64 - 1.0 / old as f64);
    let factors: Vec<_> =
        (0..=old.min(nodes) / 2).map(|k| turns::cis(shift(k)) / old as f64).collect();
    let mut result = DMatrix::zeros(nodes, heights.ncols());
    let columns = result.as_mut_slice().chunks_exact_mut(nodes);
    for (column, source) in columns.zip(heights.as_slice().chunks_exact(old)) {
        line.copy_from_slice(source);
        let done = forward.process_with_scratch(&mut line, &mut spectrum, &mut scratch);
        // Lengths are all it could complain of, and they come from the plan.
        debug_assert!(done.is_ok(), "{done:?}");
        resampled.fill(Complex64::ZERO);
        for (k, ((to, from), factor)) in
            resampled.iter_mut().zip(&spectrum).zip(&factors).enumerate()
        {
            let wave = from * factor;
            *to = if 2 * k == old {
                // One wave, its own conjugate, becomes two.
                0.5 * wave
            } else if 2 * k == nodes {
                // Two waves become one, which is real.
                Complex64::new(2.0 * wave.re, 0.0)
            } else {
                wave
            };
        }
        resampled[0].im = 0.0;
        let done = inverse.process_with_scratch(&mut resampled, column, &mut inverse_scratch);
        // Lengths again, and imaginary parts, which are zero.
        debug_assert!(done.is_ok(), "{done:?}");
    }
    result
}

/// The same by linear interpolation.
fn linear_along_x(heights: &DMatrix<f64>, nodes: usize) -> DMatrix<f64> {
    let last = heights.nrows() - 1;
    let ratio = heights.nrows() as f64 / nodes as f64;
    let places: Vec<_> = (0..nodes)
        .map(|i| {
            let place = ((i as f64 + 0.5) * ratio - 0.5).clamp(0.0, last as f64);
            // The cast rounds down.
            let below = (place as usize).min(last);
            (below, (below + 1).min(last), place - below as f64)
        })
        .collect();
    DMatrix::from_fn(nodes, heights.ncols(), |i, j| {
        let (below, above, t) = places[i];
        (1.0 - t) * heights[(below, j)] + t * heights[(above, j)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::fourier::tests::noise;
    use crate::surface::{Amplitude, SelfAffine};
    use std::f64::consts::TAU;

    /// A surface without waves shorter than two of the coarsest cells is the same on every grid: its
    /// own synthesis on the other grid is the oracle.
    #[test]
    fn band_limited_surfaces_are_exact() -> Result<(), Error> {
        let surface = SelfAffine::new(0.8, 0.5, 0.125, Amplitude::RmsHeight(1.0), 3)?;
        let on = |nx, ny| Topography::sample(&surface, Grid::with_sides(nx, ny, 1.0, 1.5)?);
        let shapes = [(17, 25), (18, 27), (32, 26), (45, 64), (100, 75)];
        for (nx, ny) in shapes {
            for (mx, my) in shapes {
                let resampled = on(nx, ny)?.resample(mx, my, Interpolation::Fourier)?;
                let error = (resampled.heights() - on(mx, my)?.heights()).amax();
                // Two transforms of at most 100 nodes of heights up to 3, and synthesis.
                assert!(error < 2e-14, "{nx} x {ny} to {mx} x {my}: {error:e}");
            }
        }
        Ok(())
    }

    /// Any map, with its waves of two cells, comes back from a finer grid.
    #[test]
    fn finer_and_back_is_the_same() -> Result<(), Error> {
        for (nx, ny) in [(1, 1), (2, 3), (8, 9), (15, 16)] {
            let heights = DMatrix::from_fn(nx, ny, |ix, iy| noise(ix + nx * iy));
            let map = Topography::new(Grid::new(nx, ny, 1.0, 2.0)?, heights)?;
            for (mx, my) in [(nx + 1, ny + 1), (2 * nx, 3 * ny), (3 * nx + 1, 2 * ny + 1)] {
                let fine = map.resample(mx, my, Interpolation::Fourier)?;
                let back = fine.resample(nx, ny, Interpolation::Fourier)?;
                // Rounding of four short transforms.
                assert!((back.heights() - map.heights()).amax() < 1e-14);
            }
        }
        Ok(())
    }

    #[test]
    fn waves_too_short_for_the_new_nodes_are_left_out() -> Result<(), Error> {
        let wave = |nodes: usize, k: f64| {
            DMatrix::from_fn(nodes, 3, |ix, _| (TAU * k * (ix as f64 + 0.5) / nodes as f64).cos())
        };
        let map =
            Topography::new(Grid::with_sides(40, 3, 1.0, 1.0)?, wave(40, 3.0) + wave(40, 11.0))?;
        let coarse = map.resample(21, 3, Interpolation::Fourier)?;
        // Rounding of angles up to 70.
        assert!((coarse.heights() - wave(21, 3.0)).amax() < 1e-13);
        // Eleven waves on 22 nodes are those at two nodes each, here with zeros at all of them.
        let at_nodes = map.resample(22, 3, Interpolation::Fourier)?;
        assert!((at_nodes.heights() - wave(22, 3.0)).amax() < 1e-13);
        Ok(())
    }

    /// Planes are linear; only beyond the outermost nodes they are cut off.
    #[test]
    fn a_plane_stays_a_plane() -> Result<(), Error> {
        let plane = |grid: &Grid| {
            DMatrix::from_fn(grid.nx(), grid.ny(), |ix, iy| {
                let (x, y) = grid.position(ix, iy);
                // Nodes of 10 × 8 cells reach from 0.05 to 0.95, and from 1/16 to 15/16.
                x.clamp(0.05, 0.95) - 2.0 * y.clamp(0.0625, 0.9375)
            })
        };
        let grid = Grid::with_sides(10, 8, 1.0, 1.0)?;
        let map = Topography::new(grid, plane(&grid))?;
        for (nx, ny) in [(10, 8), (25, 16), (5, 4), (1, 1), (33, 7)] {
            let resampled = map.resample(nx, ny, Interpolation::Bilinear)?;
            // A few rounding errors of heights below 2.
            let error = (resampled.heights() - plane(resampled.grid())).amax();
            assert!(error < 2e-15, "{nx} x {ny}: {error:e}");
        }
        Ok(())
    }

    #[test]
    fn no_nodes_are_refused() -> Result<(), Error> {
        let map = Topography::new(Grid::square(2, 1.0)?, DMatrix::zeros(2, 2))?;
        for interpolation in [Interpolation::Fourier, Interpolation::Bilinear] {
            let none = map.resample(0, 3, interpolation);
            assert!(matches!(none, Err(Error::EmptyGrid { .. })));
            let many = map.resample(3, usize::MAX, interpolation);
            assert!(matches!(many, Err(Error::GridTooLarge { .. })));
        }
        Ok(())
    }
}
