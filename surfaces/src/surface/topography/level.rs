//! What a measurement has of tilt and form, by least squares.

use nalgebra::{DMatrix, SMatrix, SVector};

use super::Topography;
use crate::surface::count_missing;
use crate::surface::placement::all_finite;
use crate::{Error, Grid};

/// What is taken for the trend of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Trend {
    /// The mean height.
    Mean,
    /// The plane of least squares.
    Plane,
    /// The polynomial of second degree of least squares: tilt and curvature.
    Quadratic,
}

/// A polynomial that was fitted to a map, about the centre (x₀, y₀) of the map:
///
/// ```math
/// t(x, y) = c + s_x X + s_y Y
///     + \tfrac12 \kappa_{xx} X^2 + \kappa_{xy} X Y + \tfrac12 \kappa_{yy} Y^2,
///     \qquad X = x - x_0, \quad Y = y - y_0
/// ```
///
/// Made by [`Topography::trend`], and where nodes are missing by [`FittedTrend::of_measured`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedTrend {
    center: (f64, f64),
    height: f64,
    slopes: (f64, f64),
    curvatures: (f64, f64, f64),
}

getters!(FittedTrend {
    /// Height c of the polynomial at the centre of the map \[m\].
    height: f64,
    /// Slopes (s_x, s_y) at the centre of the map, without unit.
    slopes: (f64, f64),
    /// Second derivatives (κ_xx, κ_xy, κ_yy) \[1/m\], 0 unless quadratic. A cap of radius R has
    /// κ_xx = κ_yy = −1/R.
    curvatures: (f64, f64, f64),
});

impl FittedTrend {
    /// Angle between the tangent plane at the centre of the map and the horizontal \[rad\]:
    /// $`\arctan \sqrt{s_x^2 + s_y^2}`$.
    #[must_use]
    pub fn tilt(&self) -> f64 {
        libm::atan(libm::hypot(self.slopes.0, self.slopes.1))
    }

    /// Height of the polynomial \[m\] at a position \[m\], as by [`Grid::position`](crate::Grid::position).
    #[must_use]
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let (x, y) = (x - self.center.0, y - self.center.1);
        let (xx, xy, yy) = self.curvatures;
        let tilted = self.height + self.slopes.0 * x + self.slopes.1 * y;
        tilted + 0.5 * xx * x * x + xy * x * y + 0.5 * yy * y * y
    }

    /// The polynomial that is closest, in the sense of least squares, to the heights that were measured; the others are
    /// NaN or infinite. Where none is missing it is [`Topography::trend`]. A slope needs measured nodes on two lines
    /// across it, and a curvature on three: on fewer it is 0.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] between grid and heights, [`Error::NothingMeasured`] without a finite height.
    pub fn of_measured(grid: &Grid, heights: &DMatrix<f64>, trend: Trend) -> Result<Self, Error> {
        let missing = count_missing(heights);
        if missing == 0 {
            return Ok(Topography::new(*grid, heights.clone())?.trend(trend));
        }
        grid.check_shape(heights.shape())?;
        let Some(span) = Span::of(heights) else {
            let (nx, ny) = heights.shape();
            return Err(Error::NothingMeasured { nx, ny });
        };
        let coefficients = span.fit(heights, trend);
        let [height, sx, sy, xx, xy, yy] = coefficients;
        let [(x, a), (y, b)] = [(span.x, grid.dx()), (span.y, grid.dy())]
            .map(|(axis, cell)| (axis.center * cell, axis.half * cell));
        let about_span = Self {
            center: (x, y),
            height,
            slopes: (sx / a, sy / b),
            curvatures: (2.0 * xx / a / a, xy / a / b, 2.0 * yy / b / b),
        };
        Ok(about_span.about(grid.center()))
    }

    /// The same polynomial about another point.
    fn about(&self, center: (f64, f64)) -> Self {
        let (x, y) = (center.0 - self.center.0, center.1 - self.center.1);
        let (xx, xy, yy) = self.curvatures;
        let slopes = (self.slopes.0 + xx * x + xy * y, self.slopes.1 + xy * x + yy * y);
        Self { center, height: self.at(center.0, center.1), slopes, ..*self }
    }

    /// Heights less those of the polynomial; exactly 0 where no more is left than what rounds.
    fn taken_off(&self, grid: &Grid, heights: &DMatrix<f64>) -> DMatrix<f64> {
        let (nx, ny) = grid.shape();
        let mut left = DMatrix::from_fn(nx, ny, |ix, iy| {
            let (x, y) = grid.position(ix, iy);
            heights[(ix, iy)] - self.at(x, y)
        });
        let greatest = |heights: &DMatrix<f64>| {
            heights
                .iter()
                .filter(|z| !z.is_nan())
                .fold(0.0_f64, |greatest, z| greatest.max(z.abs()))
        };
        if greatest(&left) <= ROUNDING * greatest(heights) {
            left.apply(|z| {
                if z.is_finite() {
                    *z = 0.0
                }
            });
        }
        left
    }
}

/// Heights without the trend of those that were measured; missing ones, NaN or infinite, become NaN. Take the trend off
/// before [`fill_missing`](crate::surface::fill_missing): a gap that is filled first is tipped with the plane.
///
/// # Errors
///
/// Those of [`FittedTrend::of_measured`], and [`Error::HeightNotFinite`] if differences of heights overflow.
pub fn level_measured(
    grid: &Grid,
    heights: &DMatrix<f64>,
    trend: Trend,
) -> Result<DMatrix<f64>, Error> {
    let fitted = FittedTrend::of_measured(grid, heights, trend)?;
    let only_measured =
        |height: f64, found: f64, other| if found.is_finite() { height } else { other };
    let measured = heights.map(|z| only_measured(z, z, f64::NAN));
    let left = fitted.taken_off(grid, &measured);
    let left = all_finite(left.zip_map(heights, |left, z| only_measured(left, z, 0.0)))?;
    Ok(left.zip_map(heights, |left, z| only_measured(left, z, f64::NAN)))
}

impl Topography {
    /// The polynomial that is closest to the heights in the sense of least squares.
    ///
    /// In the coordinates of the nodes from the centre of the map, X of nx nodes and Y of ny, the
    /// polynomials 1, X, Y, X² − ⟨X²⟩, XY and Y² − ⟨Y²⟩ are orthogonal on every grid, so that each
    /// coefficient is a mean, ⟨hφ⟩/⟨φ²⟩, and no system of equations has to be solved. A slope needs
    /// two nodes in its direction, and a curvature three: with fewer it is 0.
    ///
    /// Ordinary least squares: differences are measured along z, which for the slopes of rough
    /// surfaces is the same as at right angles to the plane.
    #[must_use]
    pub fn trend(&self, trend: Trend) -> FittedTrend {
        let mean = self.map.mean_height();
        let (x, y) = (Gram::new(self.grid.nx()), Gram::new(self.grid.ny()));
        let mut fitted = FittedTrend {
            center: self.grid.center(),
            height: mean,
            slopes: (0.0, 0.0),
            curvatures: (0.0, 0.0, 0.0),
        };
        if trend == Trend::Mean {
            return fitted;
        }
        let (dx, dy) = (self.grid.dx(), self.grid.dy());
        let coefficient = |i: usize, j: usize| {
            let norm = x.norms[i] * y.norms[j];
            if norm > 0.0 {
                projection(self.heights(), mean, &x.values[i], &y.values[j]) / norm
            } else {
                0.0
            }
        };
        fitted.slopes = (coefficient(1, 0) / dx, coefficient(0, 1) / dy);
        if trend == Trend::Quadratic {
            let (xx, yy) = (coefficient(2, 0), coefficient(0, 2));
            let per_area = [2.0 * xx / dx / dx, coefficient(1, 1) / dx / dy, 2.0 * yy / dy / dy];
            fitted.curvatures = per_area.into();
            fitted.height -= xx * x.mean_square + yy * y.mean_square;
        }
        fitted
    }

    /// The heights without their [trend](Topography::trend): above the mean, the plane or the
    /// polynomial of least squares. Where no more is left than what rounds, nothing is.
    ///
    /// # Errors
    ///
    /// [`Error::HeightNotFinite`] if differences of heights overflow.
    pub fn level(&self, trend: Trend) -> Result<Self, Error> {
        self.with_heights(self.trend(trend).taken_off(&self.grid, self.heights()))
    }
}

/// What a trend and its subtraction may round, of the greatest height.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The lines across an axis on which nodes were measured.
#[derive(Debug, Clone, Copy)]
struct Lines {
    /// Half-way from the first to the last, in cells from the border of the map.
    center: f64,
    /// Half of the way between the two, in cells; 1 if they are the same.
    half: f64,
    count: usize,
}

impl Lines {
    /// Of those that are marked; `None` without any.
    fn of(measured: &[bool]) -> Option<Self> {
        let first = measured.iter().position(|is_measured| *is_measured)?;
        let last = measured.iter().rposition(|is_measured| *is_measured)?;
        let half = if last > first { 0.5 * (last - first) as f64 } else { 1.0 };
        let count = measured.iter().filter(|is_measured| **is_measured).count();
        Some(Self { center: 0.5 * (first + last) as f64 + 0.5, half, count })
    }

    /// From −1 at the first line to 1 at the last.
    fn place(&self, line: usize) -> f64 {
        (line as f64 + 0.5 - self.center) / self.half
    }
}

/// The rectangle of all measured nodes.
struct Span {
    x: Lines,
    y: Lines,
}

impl Span {
    /// `None` without any.
    fn of(heights: &DMatrix<f64>) -> Option<Self> {
        let (nx, ny) = heights.shape();
        let (mut along_x, mut along_y) = (vec![false; nx], vec![false; ny]);
        for (k, _) in heights.iter().enumerate().filter(|(_, z)| z.is_finite()) {
            along_x[k % nx] = true;
            along_y[k / nx] = true;
        }
        Some(Self { x: Lines::of(&along_x)?, y: Lines::of(&along_y)? })
    }

    /// Coefficients of 1, X, Y, X², XY and Y², each place between −1 and 1; 0 of those that the trend or the nodes do
    /// not have.
    fn fit(&self, heights: &DMatrix<f64>, trend: Trend) -> [f64; 6] {
        let is_plane = trend != Trend::Mean;
        let is_curved = trend == Trend::Quadratic;
        let (across, along) = (self.x.count, self.y.count);
        let takes_part = [
            true,
            is_plane && across > 1,
            is_plane && along > 1,
            is_curved && across > 2,
            is_curved && across > 1 && along > 1,
            is_curved && along > 2,
        ];
        let measured = || heights.iter().filter(|z| z.is_finite());
        let unit = measured().fold(f64::MIN_POSITIVE, |unit, z| unit.max(z.abs()));
        let count = measured().count() as f64;
        let mean = measured().map(|z| z / unit).sum::<f64>() / count;
        let mut normal = SMatrix::<f64, 6, 6>::zeros();
        let mut right_side = SVector::<f64, 6>::zeros();
        for (iy, column) in heights.column_iter().enumerate() {
            let y = self.y.place(iy);
            for (ix, z) in column.iter().enumerate().filter(|(_, z)| z.is_finite()) {
                let x = self.x.place(ix);
                let mut terms = SVector::from([1.0, x, y, x * x, x * y, y * y]);
                for (term, takes_part) in terms.iter_mut().zip(takes_part) {
                    *term = if takes_part { *term } else { 0.0 };
                }
                normal += terms * terms.transpose() / count;
                right_side += terms * ((z / unit - mean) / count);
            }
        }
        // Directions in which the nodes do not differ, as on one slanting line, have no part in it.
        let eigen = normal.symmetric_eigen();
        let mut solution = SVector::<f64, 6>::zeros();
        for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *value > SINGULAR * eigen.eigenvalues.amax() {
                solution += vector * (vector.dot(&right_side) / value);
            }
        }
        solution[0] += mean;
        (solution * unit).into()
    }
}

/// What is left of an eigenvalue that is 0, relative to the greatest; a map with a hole has some 1e-3, and a frame of one
/// node around a hole more than 1e-6.
const SINGULAR: f64 = 1e-12;

/// The first three polynomials that are orthogonal on equidistant nodes, with cells of 1 and about
/// their centre (Gram's).
struct Gram {
    /// 1, X and X² − ⟨X²⟩.
    values: [Vec<f64>; 3],
    /// The means of their squares.
    norms: [f64; 3],
    /// ⟨X²⟩.
    mean_square: f64,
}

impl Gram {
    fn new(nodes: usize) -> Self {
        let n = nodes as f64;
        let mean_square = (n * n - 1.0) / 12.0;
        let x: Vec<f64> = (0..nodes).map(|i| i as f64 - 0.5 * (n - 1.0)).collect();
        let second = x.iter().map(|x| x * x - mean_square).collect();
        // Exactly 0 where there are too few nodes.
        let norms = [1.0, mean_square, mean_square * (n * n - 4.0) / 15.0];
        Self { values: [vec![1.0; nodes], x, second], norms, mean_square }
    }
}

/// ⟨(h − mean) φ(x) ψ(y)⟩, summed column by column.
fn projection(heights: &DMatrix<f64>, mean: f64, phi: &[f64], psi: &[f64]) -> f64 {
    let columns = heights.column_iter().zip(psi);
    let sum: f64 = columns
        .map(|(column, psi)| {
            let row = column.iter().zip(phi).map(|(z, phi)| (z - mean) * phi);
            psi * row.sum::<f64>()
        })
        .sum();
    sum / heights.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Grid;
    use crate::surface::fourier::tests::noise;

    #[test]
    fn a_polynomial_is_found_and_taken_away() -> Result<(), Error> {
        for (nx, ny) in [(30, 41), (3, 3), (7, 64)] {
            let grid = Grid::new(nx, ny, 2e-6, 3e-6)?;
            let (lx, ly) = grid.sides();
            let (cx, cy) = grid.center();
            let polynomial = |x: f64, y: f64| {
                let (x, y) = ((x - cx) / lx, (y - cy) / ly);
                1e-6 * (4.0 + 0.5 * x - 0.25 * y + 3.0 * x * x - 1.5 * x * y - 2.0 * y * y)
            };
            let heights = DMatrix::from_fn(nx, ny, |ix, iy| {
                let (x, y) = grid.position(ix, iy);
                polynomial(x, y)
            });
            let map = Topography::new(grid, heights)?;
            let fitted = map.trend(Trend::Quadratic);
            // Rounding of sums over at most 1230 nodes of heights of 5e-6.
            let close = |a: f64, b: f64, unit: f64| {
                assert!((a - b).abs() < 1e-13 * unit, "{a} {b}");
            };
            close(fitted.height(), 4e-6, 1e-6);
            close(fitted.slopes().0, 0.5e-6 / lx, 1e-6 / lx);
            close(fitted.slopes().1, -0.25e-6 / ly, 1e-6 / ly);
            let (xx, xy, yy) = fitted.curvatures();
            close(xx, 6e-6 / lx / lx, 1e-5 / lx / lx);
            close(xy, -1.5e-6 / lx / ly, 1e-5 / lx / ly);
            close(yy, -4e-6 / ly / ly, 1e-5 / ly / ly);
            close(fitted.at(0.3 * lx, 0.8 * ly), polynomial(0.3 * lx, 0.8 * ly), 1e-5);
            assert!(map.level(Trend::Quadratic)?.heights().amax() < 1e-18);
        }
        Ok(())
    }

    /// What is left of noise is orthogonal to the whole family: the condition of least squares.
    #[test]
    fn what_is_left_has_no_trend() -> Result<(), Error> {
        let grid = Grid::new(23, 18, 1.5, 0.5)?;
        let map = Topography::new(grid, DMatrix::from_fn(23, 18, |i, j| noise(i + 23 * j)))?;
        for trend in [Trend::Mean, Trend::Plane, Trend::Quadratic] {
            let left = map.level(trend)?;
            let again = left.trend(trend);
            // Rounding of means of numbers below 1.
            assert!(again.height().abs() < 1e-15);
            assert!(again.tilt() < 1e-15);
            let (xx, xy, yy) = again.curvatures();
            assert!(xx.abs().max(xy.abs()).max(yy.abs()) < 1e-15);
            assert!(left.map().rms_height() <= map.map().rms_height());
        }
        Ok(())
    }

    /// A plane on an offset a million times its height loses six digits and no more.
    #[test]
    fn a_tilt_is_an_angle() -> Result<(), Error> {
        let grid = Grid::square(50, 1.0)?;
        let slope = (30.0_f64).to_radians().tan();
        let heights = DMatrix::from_fn(50, 50, |ix, iy| {
            let (x, y) = grid.position(ix, iy);
            1e6 + slope * (0.6 * x - 0.8 * y)
        });
        let fitted = Topography::new(grid, heights)?.trend(Trend::Plane);
        // Heights are rounded to 1e-10, which averages out over 2500 nodes.
        assert!((fitted.tilt().to_degrees() - 30.0).abs() < 1e-8);
        assert!((fitted.slopes().0 / slope - 0.6).abs() < 1e-10);
        assert_eq!(fitted.curvatures(), (0.0, 0.0, 0.0));
        Ok(())
    }

    /// Half of the nodes missing, all of one side among them: what is known of the rest is exact, and what is left of
    /// noise is orthogonal to the polynomials on the measured nodes.
    #[test]
    fn missing_nodes_have_no_part_in_a_trend() -> Result<(), Error> {
        let (nx, ny) = (23, 18);
        let grid = Grid::new(nx, ny, 1.5, 0.5)?;
        let is_measured = |ix: usize, iy: usize| ix > 6 && noise(7 * ix + 31 * iy) > -0.3;
        let holed = |height: &dyn Fn(f64, f64, usize) -> f64| {
            DMatrix::from_fn(nx, ny, |ix, iy| {
                let (x, y) = grid.position(ix, iy);
                if is_measured(ix, iy) { height(x, y, ix + nx * iy) } else { f64::NAN }
            })
        };
        let form =
            |x: f64, y: f64| 4.0 + 0.5 * x - 0.2 * y + 0.03 * x * x - 0.1 * x * y - 0.2 * y * y;
        let fitted =
            FittedTrend::of_measured(&grid, &holed(&|x, y, _| form(x, y)), Trend::Quadratic)?;
        for (x, y) in [(0.0, 0.0), (17.0, 4.0), (34.5, 9.0)] {
            // Rounding of a system of condition 1e3, of heights up to 60.
            assert!((fitted.at(x, y) - form(x, y)).abs() < 1e-11, "{x} {y}");
        }
        let (xx, xy, yy) = fitted.curvatures();
        assert!((xx - 0.06).abs().max((xy + 0.1).abs()).max((yy + 0.4).abs()) < 1e-11);
        let rough = holed(&|x, y, k| form(x, y) + noise(k));
        let left = level_measured(&grid, &rough, Trend::Quadratic)?;
        let again = FittedTrend::of_measured(&grid, &left, Trend::Quadratic)?;
        assert!(again.at(0.0, 0.0).abs() < 1e-11 && again.tilt() < 1e-11);
        assert!(rough.iter().zip(&left).all(|(found, left)| found.is_nan() == left.is_nan()));
        // With no node missing it is the trend of the whole, bit for bit.
        let whole = DMatrix::from_fn(nx, ny, |ix, iy| noise(ix + nx * iy));
        for trend in [Trend::Mean, Trend::Plane, Trend::Quadratic] {
            let levelled = Topography::new(grid, whole.clone())?.level(trend)?;
            assert_eq!(&level_measured(&grid, &whole, trend)?, levelled.heights());
        }
        Ok(())
    }

    #[test]
    fn measured_nodes_on_few_lines_have_no_slope_across() -> Result<(), Error> {
        let grid = Grid::square(5, 1.0)?;
        let mut heights = DMatrix::from_element(5, 5, f64::NAN);
        let refused = FittedTrend::of_measured(&grid, &heights, Trend::Plane);
        assert!(matches!(refused, Err(Error::NothingMeasured { nx: 5, ny: 5 })));
        heights[(1, 2)] = 7.0;
        let one = FittedTrend::of_measured(&grid, &heights, Trend::Quadratic)?;
        assert_eq!(
            (one.height(), one.slopes(), one.curvatures()),
            (7.0, (0.0, 0.0), (0.0, 0.0, 0.0))
        );
        heights[(4, 2)] = 10.0;
        let two = FittedTrend::of_measured(&grid, &heights, Trend::Quadratic)?;
        // 3 over three cells of 0.2; rounding.
        assert!((two.slopes().0 - 5.0).abs() < 1e-13 && two.slopes().1 == 0.0);
        assert_eq!(two.curvatures(), (0.0, 0.0, 0.0));
        // The greatest numbers there are: their difference overflows, and is no missing height.
        heights[(1, 2)] = -f64::MAX;
        heights[(4, 2)] = f64::MAX;
        heights[(2, 0)] = f64::MAX;
        let refused = level_measured(&grid, &heights, Trend::Mean);
        assert!(matches!(refused, Err(Error::HeightNotFinite { .. })), "{refused:?}");
        Ok(())
    }

    #[test]
    fn too_few_nodes_have_no_slope_and_no_curvature() -> Result<(), Error> {
        let trend = |nx, ny, values: &[f64]| -> Result<FittedTrend, Error> {
            let map = DMatrix::from_column_slice(nx, ny, values);
            Ok(Topography::new(Grid::new(nx, ny, 1.0, 1.0)?, map)?.trend(Trend::Quadratic))
        };
        let flat = (0.0, 0.0, 0.0);
        let one = trend(1, 1, &[7.0])?;
        assert_eq!((one.height(), one.slopes(), one.curvatures()), (7.0, (0.0, 0.0), flat));
        let two = trend(2, 1, &[1.0, 3.0])?;
        assert_eq!((two.height(), two.slopes(), two.curvatures()), (2.0, (2.0, 0.0), flat));
        let three = trend(1, 3, &[1.0, 0.0, 1.0])?;
        // Eighths and thirds: a few rounding errors.
        assert!((three.curvatures().2 - 2.0).abs() < 1e-15 && three.height().abs() < 1e-15);
        Ok(())
    }

    #[test]
    fn overflow_is_refused() -> Result<(), Error> {
        let heights = DMatrix::from_column_slice(2, 1, &[f64::MAX, -f64::MAX]);
        let map = Topography::new(Grid::new(2, 1, 1e-3, 1.0)?, heights)?;
        let refused = map.level(Trend::Plane);
        assert!(matches!(refused, Err(Error::HeightNotFinite { .. })));
        // As well where nothing is left that is a number.
        let square = DMatrix::from_fn(8, 8, |ix, iy| f64::MAX * [1.0, -1.0][(ix + iy) % 2]);
        let map = Topography::new(Grid::square(8, 1e-3)?, square)?;
        let refused = map.level(Trend::Quadratic);
        assert!(matches!(refused, Err(Error::HeightNotFinite { .. })), "{refused:?}");
        Ok(())
    }
}
