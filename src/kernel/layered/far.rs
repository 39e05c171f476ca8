//! Integrals over the cells of a grid of a function of the distance, far from where it varies: from its values at the
//! centres.
//!
//! With the central difference δ of a function between neighbouring cells, its mean over a cell is
//!
//! ```math
//! \frac{\delta/2}{\operatorname{arsinh}(\delta/2)}\, f = \Bigl( 1 + \frac{\delta^2}{24} - \frac{17\, \delta^4}{5760}
//!     + \frac{367\, \delta^6}{967680} - \frac{27859\, \delta^8}{464486400} + \dots \Bigr) f ,
//! ```
//!
//! along x and along y. The next term is 1.06 × 10⁻⁵ δ¹⁰. With the nearest singularity d cells away, the tenth
//! derivative of 1/√(r² + s²) is at most 10!/d¹⁰ of it.

use super::cell::Smoothness;
use crate::Grid;
use crate::parallel::for_each_chunk;

/// Cells from the nearest singularity from which on the next term is below 10⁻¹⁶ of the function.
const FAR: f64 = 60.0;
/// Neighbours on either side.
const REACH: usize = 4;
/// Of the cell itself and of its neighbours: the four terms above.
const WEIGHTS: [f64; REACH + 1] = [
    41_208_059.0 / 46_448_640.0,
    3_629_953.0 / 58_060_800.0,
    -801_973.0 / 116_121_600.0,
    49_879.0 / 58_060_800.0,
    -27_859.0 / 464_486_400.0,
];
/// Distances at a time.
const LANES: usize = 4;

/// Values at the centres of cells at offsets i, j ≥ 0, those that cells of the grid need.
pub(super) struct Far {
    grid: Grid,
    smoothness: Smoothness,
    /// i fastest.
    values: Vec<f64>,
}

impl Far {
    /// The greatest distance at which the function is asked for, and more.
    pub(super) fn distance(grid: &Grid) -> f64 {
        let along = |cells: usize, side: f64| (cells + REACH) as f64 * side;
        libm::hypot(along(grid.nx(), grid.dx()), along(grid.ny(), grid.dy()))
    }

    /// Of `f`, at some distances at a time.
    pub(super) fn new(
        grid: &Grid,
        smoothness: Smoothness,
        f: impl Fn([f64; LANES]) -> [f64; LANES] + Sync,
    ) -> Self {
        let (nx, ny) = grid.shape();
        let mut far = Self { grid: *grid, smoothness, values: Vec::new() };
        if !far.serves(nx - 1, ny - 1) {
            return far;
        }
        let columns = nx + REACH;
        let mut values = vec![0.0; columns * (ny + REACH)];
        for_each_chunk(&mut values, columns, |j, row| {
            let y = j as f64 * grid.dy();
            for (count, part) in row.chunks_mut(LANES).enumerate() {
                let found = f(std::array::from_fn(|lane| {
                    let x = (count * LANES + lane).min(columns - 1) as f64 * grid.dx();
                    (x * x + y * y).sqrt()
                }));
                part.copy_from_slice(&found[..part.len()]);
            }
        });
        far.values = values;
        far
    }

    /// Whether a cell is far enough from all singularities.
    pub(super) fn serves(&self, ix: usize, iy: usize) -> bool {
        let (dx, dy) = (self.grid.dx(), self.grid.dy());
        let (x, y) = (ix as f64 * dx, iy as f64 * dy);
        let Smoothness { depth, most } = self.smoothness;
        (x * x + y * y + depth * depth).sqrt().min(most) >= FAR * dx.max(dy)
    }

    /// For the cells of a row.
    pub(super) fn row(&self, iy: usize) -> FarRow {
        let columns = self.grid.nx() + REACH;
        let rows = self.values.chunks_exact(columns);
        let rows: Vec<&[f64]> = rows.collect();
        let mut means = Vec::new();
        if !rows.is_empty() {
            means.extend((0..columns).map(|i| mean(iy, |j| rows[j][i])));
        }
        FarRow { means, cell_area: self.grid.cell_area() }
    }
}

/// Means along y.
pub(super) struct FarRow {
    means: Vec<f64>,
    cell_area: f64,
}

impl FarRow {
    /// The integral over a cell that is [far enough](Far::serves).
    pub(super) fn integral(&self, ix: usize) -> f64 {
        self.cell_area * mean(ix, |i| self.means[i])
    }
}

/// The mean over the cell at an offset of an even function with these values at offsets.
fn mean(at: usize, value: impl Fn(usize) -> f64) -> f64 {
    let mut sum = WEIGHTS[0] * value(at);
    for (k, weight) in WEIGHTS.iter().enumerate().skip(1) {
        sum += weight * (value(at.abs_diff(k)) + value(at + k));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::cell::integral;
    use super::*;
    use crate::Error;

    /// Beside Gauss's rules, where both serve, and on long cells: from the first row, whose neighbours mirror it, to
    /// the last corner.
    #[test]
    fn far_cells_are_those_of_gauss() -> Result<(), Error> {
        for (sides, depth) in
            [((1.0, 1.0), 0.1), ((1.0, 0.4), 8.0), ((0.3, 1.0), 30.0), ((1.0, 1.0), 61.0)]
        {
            let grid = Grid::new(90, 70, sides.0, sides.1)?;
            let f = |r: f64| {
                let square = r * r + depth * depth;
                1.0 / square.sqrt() + 50.0 / (square * square.sqrt())
            };
            let smoothness = Smoothness { depth, most: f64::INFINITY };
            let far = Far::new(&grid, smoothness, |r| r.map(f));
            let mut served = 0;
            for iy in 0..70 {
                let row = far.row(iy);
                for ix in (0..90).filter(|&ix| far.serves(ix, iy)) {
                    let center = (ix as f64 * sides.0, iy as f64 * sides.1);
                    let expected = integral(&|r| r.map(f), smoothness, center, sides);
                    let error = row.integral(ix) / expected - 1.0;
                    // Ten roundings, and 10⁻¹⁶ of the first part; of the second, which is at most 1/72 of the first, 66
                    // times that.
                    assert!(error.abs() < 3e-15, "{sides:?} {depth} ({ix}, {iy}): {error:e}");
                    served += 1;
                }
            }
            assert!(served > 500, "{sides:?} {depth}: {served}");
        }
        Ok(())
    }

    #[test]
    fn near_cells_are_not_served() -> Result<(), Error> {
        let small = Grid::square(40, 40.0)?;
        let smoothness = Smoothness { depth: 1.0, most: f64::INFINITY };
        let far = Far::new(&small, smoothness, |r| r);
        assert!(!far.serves(39, 39) && far.values.is_empty() && far.row(3).means.is_empty());
        let grid = Grid::square(80, 80.0)?;
        let far = Far::new(&grid, Smoothness { depth: 1.0, most: 50.0 }, |r| r);
        assert!(!far.serves(79, 79));
        Ok(())
    }
}
