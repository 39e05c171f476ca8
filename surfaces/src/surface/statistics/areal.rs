//! Texture of a map: ISO 25178-2.

use super::material_ratio::{CoreParameters, MaterialRatio};
use crate::Error;
use crate::surface::fourier::Waves;
use crate::surface::{Topography, Trend};

/// The autocorrelation that a surface has no memory below.
const DECAYED: f64 = 0.2;

/// Parameters of a map by ISO 25178-2, without its tilt; filter it before where that is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ArealParameters {
    /// Arithmetical mean height Sa \[m\].
    pub sa: f64,
    /// Root mean square height Sq \[m\].
    pub sq: f64,
    /// Maximum height Sz \[m\], of the highest peak Sp over the mean and the deepest pit Sv below.
    pub sz: f64,
    /// Height Sp of the highest peak over the mean \[m\].
    pub sp: f64,
    /// Depth Sv of the deepest pit below the mean \[m\].
    pub sv: f64,
    /// Skewness Ssk; NaN if the map is flat.
    pub ssk: f64,
    /// Kurtosis Sku, 3 for a normal distribution; NaN if the map is flat.
    pub sku: f64,
    /// Root mean square gradient Sdq, from [forward differences](Topography::rms_gradient).
    pub sdq: f64,
    /// Developed area ratio Sdr: by how much the surface is greater than its projection, over that. Each quadrangle of
    /// four nodes is the mean of both pairs of triangles.
    pub sdr: f64,
    /// Autocorrelation length Sal \[m\]: the shortest way on which the autocorrelation falls to 0.2. `None` if it does
    /// not within the map.
    pub sal: Option<f64>,
    /// Texture aspect ratio Str: Sal over the longest such way, 1 for an isotropic surface and near 0 for a lay. Where
    /// the autocorrelation does not fall to 0.2 within the map, the way to the border is taken. `None` with Sal.
    pub str: Option<f64>,
    /// Core, peaks and dales of the material ratio curve.
    pub core: CoreParameters,
}

impl Topography {
    /// The texture of the map without its tilt.
    ///
    /// ```
    /// use asperity_surfaces::Grid;
    /// use asperity_surfaces::surface::{Amplitude, SelfAffine, Topography};
    ///
    /// # fn main() -> Result<(), asperity_surfaces::Error> {
    /// let surface = SelfAffine::new(0.8, 1e-4, 2e-5, Amplitude::RmsHeight(1e-6), 1)?;
    /// let map = Topography::sample(&surface, Grid::square(128, 1e-3)?)?;
    /// let texture = map.areal_parameters()?;
    /// assert!(texture.sku > 2.0 && texture.sku < 4.0);
    /// assert!(texture.str.is_some_and(|str| str > 0.5)); // isotropic
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`Topography::level`].
    pub fn areal_parameters(&self) -> Result<ArealParameters, Error> {
        let levelled = self.level(Trend::Plane)?;
        let map = levelled.map();
        let mean = map.mean_height();
        let ways = decay(&levelled);
        Ok(ArealParameters {
            sa: map.mean_absolute_height(),
            sq: map.rms_height(),
            sz: map.peak_to_valley(),
            sp: map.max_height() - mean,
            sv: mean - map.min_height(),
            ssk: map.skewness(),
            sku: map.kurtosis(),
            sdq: levelled.rms_gradient(),
            sdr: developed(&levelled),
            sal: ways.map(|[shortest, _]| shortest),
            str: ways.map(|[shortest, longest]| shortest / longest),
            core: MaterialRatio::of(map).core(),
        })
    }
}

/// The area of all quadrangles over that of their projection, less one.
fn developed(map: &Topography) -> f64 {
    let (heights, grid) = (map.heights(), map.grid());
    let (nx, ny) = grid.shape();
    let (dx, dy) = (grid.dx(), grid.dy());
    // √(1 + s²) − 1 without cancellation.
    let excess = |along_x: f64, along_y: f64| {
        let square = along_x * along_x + along_y * along_y;
        square / (1.0 + (1.0 + square).sqrt())
    };
    let (last_x, last_y) = (nx.saturating_sub(1).max(1), ny.saturating_sub(1).max(1));
    let (step_x, step_y) = (usize::from(nx > 1), usize::from(ny > 1));
    let mut sum = 0.0;
    for iy in 0..last_y {
        let mut row = 0.0;
        for ix in 0..last_x {
            let at = |i: usize, j: usize| heights[(ix + i * step_x, iy + j * step_y)];
            let along_x = [0, 1].map(|j| (at(1, j) - at(0, j)) / dx);
            let along_y = [0, 1].map(|i| (at(i, 1) - at(i, 0)) / dy);
            // Two triangles on one diagonal take slopes of the sides that meet opposite of it, and so on the other.
            row += excess(along_x[0], along_y[0])
                + excess(along_x[1], along_y[1])
                + excess(along_x[0], along_y[1])
                + excess(along_x[1], along_y[0]);
        }
        sum += 0.25 * row;
    }
    sum / (last_x * last_y) as f64
}

/// The shortest and the longest way on which the autocorrelation falls to 0.2, around no way at all.
fn decay(map: &Topography) -> Option<[f64; 2]> {
    let grid = map.grid();
    let (nx, ny) = grid.shape();
    let correlation = Correlation::of(map)?;
    // All of them twice: those of opposite ways are the same.
    let (most_x, most_y) = (nx as i64 - 1, ny as i64 - 1);
    let place = |(i, j): (i64, i64)| (i + most_x) as usize + (2 * nx - 1) * (j + most_y) as usize;
    let mut is_in = vec![false; (2 * nx - 1) * (2 * ny - 1)];
    let mut waiting = vec![(0, 0)];
    is_in[place((0, 0))] = true;
    let way = |i: f64, j: f64| libm::hypot(i * grid.dx(), j * grid.dy());
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
    while let Some((i, j)) = waiting.pop() {
        let here = correlation.at(i, j);
        for (di, dj) in [(-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)] {
            let (a, b) = (i + di, j + dj);
            if a.abs() > most_x || b.abs() > most_y {
                longest = longest.max(way(i as f64, j as f64));
                continue;
            }
            let there = correlation.at(a, b);
            if there >= DECAYED {
                if !std::mem::replace(&mut is_in[place((a, b))], true) {
                    waiting.push((a, b));
                }
                continue;
            }
            let part = (here - DECAYED) / (here - there);
            let crossed = way(i as f64 + part * di as f64, j as f64 + part * dj as f64);
            shortest = shortest.min(crossed);
            longest = longest.max(crossed);
        }
    }
    (shortest.is_finite() && longest > 0.0).then_some([shortest, longest])
}

/// The autocorrelation of a map of mean 0, over the area that it has in common with itself.
struct Correlation {
    shape: (usize, usize),
    /// Of twice as many nodes either way, half of them empty.
    sums: nalgebra::DMatrix<f64>,
}

impl Correlation {
    /// `None` of a flat map.
    fn of(map: &Topography) -> Option<Self> {
        let grid = map.grid();
        let (nx, ny) = grid.shape();
        let wide = grid.padded();
        let mut padded = nalgebra::DMatrix::zeros(wide.nx(), wide.ny());
        let mean = map.map().mean_height();
        let heights = map.heights().map(|height| height - mean);
        padded.view_mut((0, 0), (nx, ny)).copy_from(&heights);
        let mut waves = Waves::new(&padded, 0.0, &wide);
        waves.square();
        let sums = waves.restore();
        (sums[(0, 0)] > 0.0).then_some(Self { shape: (nx, ny), sums })
    }

    /// At so many cells along x and y.
    fn at(&self, i: i64, j: i64) -> f64 {
        let (nx, ny) = self.shape;
        let wide = self.sums.shape();
        let around = |k: i64, n: usize| k.rem_euclid(n as i64) as usize;
        let common = |k: i64, n: usize| n as f64 / (n as i64 - k.abs()) as f64;
        let sum = self.sums[(around(i, wide.0), around(j, wide.1))] / self.sums[(0, 0)];
        sum * common(i, nx) * common(j, ny)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use nalgebra::DMatrix;

    use super::*;
    use crate::Grid;

    fn map(
        (nx, ny): (usize, usize),
        (dx, dy): (f64, f64),
        height: impl Fn(f64, f64) -> f64,
    ) -> Result<Topography, Error> {
        let heights = DMatrix::from_fn(nx, ny, |ix, iy| height(ix as f64 * dx, iy as f64 * dy));
        Topography::new(Grid::new(nx, ny, dx, dy)?, heights)
    }

    /// Two crossed waves of wavevector k: the autocorrelation `(cos kx + cos ky)/2` falls to 0.2 first along the
    /// diagonals, at √2 arccos 0.2 / k, and last along the axes, at arccos(−0.6)/k. What the map has not in common with
    /// itself makes some of 1/(k L) of that.
    #[test]
    fn crossed_waves() -> Result<(), Error> {
        let k = TAU / 10.0;
        let crossed = map((400, 600), (1.0, 0.5), |x, y| (k * x).cos() + (k * y).cos())?;
        let found = crossed.areal_parameters()?;
        let (sal, longest) = (2_f64.sqrt() * 0.2_f64.acos() / k, (-0.6_f64).acos() / k);
        // Ways are interpolated between cells, of a tenth of a wave.
        assert!((found.sal.unwrap_or_default() / sal - 1.0).abs() < 0.02, "{found:?}");
        assert!((found.str.unwrap_or_default() / (sal / longest) - 1.0).abs() < 0.03, "{found:?}");
        Ok(())
    }

    /// A lay along y: Sal is arccos 0.2 / k, and nothing falls along the lay but at the border.
    #[test]
    fn a_lay() -> Result<(), Error> {
        let k = TAU / 16.0;
        let found = map((320, 100), (1.0, 1.0), |x, _| (k * x).sin())?.areal_parameters()?;
        let sal = 0.2_f64.acos() / k;
        assert!((found.sal.unwrap_or_default() / sal - 1.0).abs() < 0.02, "{found:?}");
        assert!(found.str.is_some_and(|str| str < 0.05), "{found:?}");
        Ok(())
    }

    /// Slopes of ±1/2 along x, and of ±1/4 along y as well: √(1 + 1/4) − 1 and √(1 + 5/16) − 1, whatever the cells.
    #[test]
    fn roofs_are_longer_than_their_base() -> Result<(), Error> {
        let roof = |x: f64, side: f64| 0.5 * (x - side).abs();
        for cell in [(1.0, 1.0), (0.5, 2.0)] {
            let middle = [20.0 * cell.0, 20.0 * cell.1];
            let along = map((41, 41), cell, |x, _| roof(x, middle[0]))?.areal_parameters()?;
            assert!((along.sdr - (1.25_f64.sqrt() - 1.0)).abs() < 1e-12, "{along:?}");
            let both = |x: f64, y: f64| roof(x, middle[0]) + 0.5 * roof(y, middle[1]);
            let both = map((41, 41), cell, both)?.areal_parameters()?;
            assert!((both.sdr - (1.3125_f64.sqrt() - 1.0)).abs() < 1e-12, "{both:?}");
            // From 0 up to 10 cells along x, with a mean of 20 · 21 / (2 · 41) of half a cell.
            let [mean, most] = [210.0 / 41.0 * cell.0, 10.0 * cell.0];
            assert!((along.sv - mean).abs() < 1e-12 && (along.sp - most + mean).abs() < 1e-12);
        }
        Ok(())
    }

    /// A tilt is no texture, and what is flat has none.
    #[test]
    fn flat_maps() -> Result<(), Error> {
        let flat = map((8, 4), (1.0, 1.0), |_, _| 3.0)?.areal_parameters()?;
        assert_eq!((flat.sq, flat.sdr, flat.sal, flat.str), (0.0, 0.0, None, None));
        assert_eq!((flat.core.sk, flat.core.spk, flat.core.svk), (0.0, 0.0, 0.0));
        let single = map((1, 1), (1.0, 1.0), |_, _| 3.0)?.areal_parameters()?;
        assert_eq!((single.sz, single.sdr, single.sal), (0.0, 0.0, None));
        Ok(())
    }

    /// Nor has one whose mean rounds.
    #[test]
    fn flat_maps_have_no_shape() -> Result<(), Error> {
        for shape in [(3, 1), (7, 3)] {
            let flat = map(shape, (1.0, 1.0), |_, _| 0.1)?;
            assert!(flat.map().skewness().is_nan() && flat.map().kurtosis().is_nan());
            let found = flat.areal_parameters()?;
            assert!(found.ssk.is_nan() && found.sku.is_nan(), "{found:?}");
            assert_eq!((found.sq, found.sal, found.core.sk), (0.0, None, 0.0));
        }
        let profile = map((3, 1), (1.0, 1.0), |_, _| 0.1)?.profile_parameters(None)?;
        assert!(profile.rsk.is_nan() && profile.rku.is_nan() && profile.rq == 0.0, "{profile:?}");
        Ok(())
    }

    /// Twice as many nodes as this are more than a grid can have.
    #[test]
    fn long_maps_have_lengths_too() -> Result<(), Error> {
        let k = TAU / 25.0;
        let found = map((20_000, 3), (1.0, 1.0), |x, _| (k * x).sin())?.areal_parameters()?;
        let sal = 0.2_f64.acos() / k;
        assert!((found.sal.unwrap_or_default() / sal - 1.0).abs() < 0.02, "{found:?}");
        Ok(())
    }

    /// Of a profile ways are along it.
    #[test]
    fn profiles() -> Result<(), Error> {
        let k = TAU / 25.0;
        let found = map((1000, 1), (1.0, 1.0), |x, _| (k * x).sin())?.areal_parameters()?;
        let sal = 0.2_f64.acos() / k;
        assert!((found.sal.unwrap_or_default() / sal - 1.0).abs() < 0.02, "{found:?}");
        assert!(found.str.is_some_and(|str| (str - 1.0).abs() < 0.02), "{found:?}");
        Ok(())
    }
}
