//! All influence coefficients of a grid, ready for look-up without index arithmetic.

use super::{Boundary, InfluenceKernel};
use crate::{Error, Grid};

/// The coefficients C(di, dj) for all offsets |di| < nx, |dj| < ny of a kernel.
///
/// Each node has a *place* in the table, such that the coefficient between two nodes is found at
/// the difference of their places: filling a column of the influence matrix costs one subtraction
/// and one load per element.
#[derive(Debug, Clone)]
pub struct KernelTable {
    grid: Grid,
    boundary: Boundary,
    /// (2 nx − 1) × (2 ny − 1) coefficients, di fastest, offset (0, 0) in the middle.
    values: Vec<f64>,
}

impl KernelTable {
    /// Evaluates `kernel` at every offset of its grid.
    ///
    /// # Errors
    ///
    /// [`Error::KernelNotFinite`], [`Error::KernelNotSymmetric`], [`Error::KernelNotPeriodic`] if
    /// the boundary is periodic and the coefficients are not, and [`Error::NotPositiveDefinite`] if
    /// C(0, 0) is not positive.
    pub fn new<K: InfluenceKernel + ?Sized>(kernel: &K) -> Result<Self, Error> {
        let grid = kernel.grid();
        let (nx, ny) = (grid.nx() as isize, grid.ny() as isize);
        let mut values = Vec::with_capacity((2 * grid.nx() - 1) * (2 * grid.ny() - 1));
        for dj in 1 - ny..ny {
            for di in 1 - nx..nx {
                let value = kernel.coefficient(di, dj);
                if !value.is_finite() {
                    return Err(Error::KernelNotFinite { di, dj, value });
                }
                values.push(value);
            }
        }
        let boundary = kernel.boundary();
        let table = Self {
            grid,
            boundary,
            values,
        };
        table.check_reciprocity()?;
        if boundary == Boundary::Periodic {
            table.check_periodicity()?;
        }
        let self_influence = table.self_influence();
        if self_influence <= 0.0 {
            return Err(Error::NotPositiveDefinite {
                ix: 0,
                iy: 0,
                approach: 0.0,
                pivot: self_influence,
            });
        }
        Ok(table)
    }

    fn check_reciprocity(&self) -> Result<(), Error> {
        let opposites = self.values.iter().zip(self.values.iter().rev());
        for (place, (&value, &opposite)) in opposites.enumerate().take(self.center()) {
            if !self.agree(value, opposite) {
                let (di, dj) = self.offset(place);
                return Err(Error::KernelNotSymmetric {
                    di,
                    dj,
                    value,
                    opposite,
                });
            }
        }
        Ok(())
    }

    /// Compares every coefficient with those one period further, where the table has them.
    fn check_periodicity(&self) -> Result<(), Error> {
        let (nx, ny) = self.grid.shape();
        let width = 2 * nx - 1;
        for (place, &value) in self.values.iter().enumerate() {
            let (column, row) = (place % width, place / width);
            let along_x = (column + nx < width).then_some(place + nx);
            let along_y = (row + ny < 2 * ny - 1).then_some(place + ny * width);
            for image in [along_x, along_y].into_iter().flatten() {
                let repeated = self.values[image];
                if !self.agree(value, repeated) {
                    let (di, dj) = self.offset(place);
                    let (image_di, image_dj) = self.offset(image);
                    return Err(Error::KernelNotPeriodic {
                        di,
                        dj,
                        value,
                        image_di,
                        image_dj,
                        repeated,
                    });
                }
            }
        }
        Ok(())
    }

    /// Whether two coefficients that ought to be the same are.
    fn agree(&self, value: f64, other: f64) -> bool {
        // Twice a few ulps: a formula may be evaluated in another order for another offset.
        const TOLERANCE: f64 = 1e-14;
        let scale = self.self_influence().abs();
        (value - other).abs() <= TOLERANCE * value.abs().max(other.abs()).max(scale * 1e-2)
    }

    /// The offset at a place of the table.
    fn offset(&self, place: usize) -> (isize, isize) {
        let (nx, ny) = self.grid.shape();
        let width = 2 * nx - 1;
        let signed = |index: usize, n: usize| index as isize - (n as isize - 1);
        (signed(place % width, nx), signed(place / width, ny))
    }

    /// The grid of the coefficients.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// What surrounds the grid.
    #[must_use]
    pub fn boundary(&self) -> Boundary {
        self.boundary
    }

    /// The gauge s of a periodic kernel \[m/Pa\]: the mean of its coefficients; `None` if the
    /// boundary is free.
    ///
    /// With it the mean displacement under pressures p is $\bar u = s \sum p$, and what does not
    /// depend on the gauge follows from an approach δ and a displacement u in this one: the approach
    /// of the mean planes is $\delta - s \sum p$, the displacement about its mean $u - s \sum p$.
    #[must_use]
    pub fn gauge(&self) -> Option<f64> {
        let (nx, ny) = self.grid.shape();
        let periodic = self.boundary == Boundary::Periodic;
        periodic.then(|| {
            // The offsets that are not negative are one period.
            let rows = self.values[self.center()..].chunks(2 * nx - 1).take(ny);
            let sum: f64 = rows.map(|row| row[..nx].iter().sum::<f64>()).sum();
            sum / self.grid.nodes() as f64
        })
    }

    /// The same kernel with a uniform displacement added, so that the gauge becomes `gauge`; itself if
    /// the boundary is free.
    pub(crate) fn in_gauge(&self, gauge: f64) -> Self {
        let mut table = self.clone();
        if let Some(present) = self.gauge() {
            for value in &mut table.values {
                *value = *value - present + gauge;
            }
        }
        table
    }

    /// The gauge for computing: of the size of the least one in which a kernel like Love's is an
    /// inverse M-matrix, and of no influence on results. `None` if the boundary is free.
    ///
    /// In the zero gauge the least coefficient is that of the farthest node. That gauge is 1.5 times
    /// its absolute value, on a square of many nodes with Love's kernel: 0.74 L / (E* M), near s\*.
    pub(crate) fn computing_gauge(&self) -> Option<f64> {
        let mean = self.gauge()?;
        let least = self.values.iter().copied().fold(f64::INFINITY, f64::min) - mean;
        // A single node has no other, and nothing but its gauge.
        Some(if least < 0.0 { -1.5 * least } else { mean })
    }

    /// The coefficient at offset (di, dj), or `None` if it lies outside the grid.
    #[must_use]
    pub fn coefficient(&self, di: isize, dj: isize) -> Option<f64> {
        let (nx, ny) = (self.grid.nx() as isize, self.grid.ny() as isize);
        if di.abs() >= nx || dj.abs() >= ny {
            return None;
        }
        let index = (di + nx - 1) + (dj + ny - 1) * (2 * nx - 1);
        self.values.get(index as usize).copied()
    }

    /// The coefficients between blocks of 2 × 2 cells under a common pressure, displacements
    /// averaged over a block: exactly what remains of this kernel for pressures that are uniform
    /// on blocks. A direction with a single node stays as it is.
    ///
    /// Where the number of nodes is odd, the last block of a free kernel reaches beyond the grid, where
    /// the kernel is continued by its last value; those of a periodic one are a little smaller than two
    /// cells, so that they fit the period, and weighted by how much they overlap.
    ///
    /// # Errors
    ///
    /// Those of [`Grid::new`].
    pub(crate) fn coarsened(&self) -> Result<Self, Error> {
        match self.boundary {
            Boundary::Free => self.coarsened_free(),
            Boundary::Periodic => self.coarsened_periodic(),
        }
    }

    fn coarsened_periodic(&self) -> Result<Self, Error> {
        let (nx, ny) = self.grid.shape();
        let (lx, ly) = self.grid.sides();
        let [cx, cy] = [nx, ny].map(|nodes| nodes.div_ceil(2));
        let grid = Grid::with_sides(cx, cy, lx, ly)?;
        // For each offset of blocks the offsets of cells, and their weights: sums over the sources,
        // averages over the observers.
        let overlaps = |nodes: usize, blocks: usize| -> Vec<[(usize, f64); 4]> {
            let width = nodes as f64 / blocks as f64;
            (0..blocks)
                .map(|offset| {
                    let at = offset as f64 * width;
                    let first = at as isize - 1;
                    let weight = |cell: isize| (1.0 - (cell as f64 - at).abs() / width).max(0.0);
                    let sum: f64 = (first..first + 4).map(weight).sum();
                    std::array::from_fn(|i| {
                        let cell = first + i as isize;
                        let place = cell.rem_euclid(nodes as isize) as usize;
                        (place, weight(cell) * width / sum)
                    })
                })
                .collect()
        };
        let (along_x, along_y) = (overlaps(nx, cx), overlaps(ny, cy));
        let width = 2 * nx - 1;
        let (cx, cy) = (cx as isize, cy as isize);
        let mut values = Vec::with_capacity(((2 * cx - 1) * (2 * cy - 1)) as usize);
        for dj in 1 - cy..cy {
            for di in 1 - cx..cx {
                // By symmetry offsets need no sign: C(−di, −dj) = C(di, dj).
                let (di, dj) = if dj < 0 { (-di, -dj) } else { (di, dj) };
                let mut sum = 0.0;
                for &(j, wj) in &along_y[dj as usize] {
                    let row = self.center() + j * width;
                    for &(i, wi) in &along_x[di.rem_euclid(cx) as usize] {
                        sum += wi * wj * self.values[row + i];
                    }
                }
                values.push(sum);
            }
        }
        Ok(Self {
            grid,
            boundary: self.boundary,
            values,
        })
    }

    fn coarsened_free(&self) -> Result<Self, Error> {
        let (nx, ny) = self.grid.shape();
        let factor = |nodes: usize| if nodes > 1 { 2 } else { 1 };
        let (fx, fy) = (factor(nx), factor(ny));
        let grid = Grid::new(
            nx.div_ceil(fx),
            ny.div_ceil(fy),
            self.grid.dx() * fx as f64,
            self.grid.dy() * fy as f64,
        )?;
        // Differences between the places of two cells within their blocks, and how often each
        // occurs; sums over the sources, averages over the observers.
        let differences = |factor: usize| -> &'static [(isize, f64)] {
            if factor == 2 {
                &[(-1, 0.5), (0, 1.0), (1, 0.5)]
            } else {
                &[(0, 1.0)]
            }
        };
        let (nx, ny) = (nx as isize, ny as isize);
        let (cx, cy) = (grid.nx() as isize, grid.ny() as isize);
        let width = 2 * nx - 1;
        let mut values = Vec::with_capacity(((2 * cx - 1) * (2 * cy - 1)) as usize);
        for dj in 1 - cy..cy {
            for di in 1 - cx..cx {
                let mut sum = 0.0;
                for &(oj, wj) in differences(fy) {
                    let j = (dj * fy as isize + oj).clamp(1 - ny, ny - 1) + ny - 1;
                    for &(oi, wi) in differences(fx) {
                        let i = (di * fx as isize + oi).clamp(1 - nx, nx - 1) + nx - 1;
                        sum += wi * wj * self.values[(i + j * width) as usize];
                    }
                }
                values.push(sum);
            }
        }
        let boundary = self.boundary;
        Ok(Self {
            grid,
            boundary,
            values,
        })
    }

    /// The displacement of a cell under its own unit pressure, C(0, 0).
    #[must_use]
    pub fn self_influence(&self) -> f64 {
        self.values[self.center()]
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        self.values.len() * size_of::<f64>()
    }

    /// Place of offset (0, 0).
    fn center(&self) -> usize {
        self.values.len() / 2
    }

    /// Place of a node, for [`KernelTable::between`].
    pub(crate) fn place(&self, node: usize) -> usize {
        let (ix, iy) = self.grid.coordinates(node);
        ix + iy * (2 * self.grid.nx() - 1)
    }

    /// The coefficient between two nodes given by their places.
    #[inline]
    pub(crate) fn between(&self, place: usize, other: usize) -> f64 {
        self.values[self.center() + place - other]
    }

    /// Writes the coefficients between the node at `place` and those at `others` into `column`.
    pub(crate) fn fill_column(&self, place: usize, others: &[usize], column: &mut [f64]) {
        let base = self.center() + place;
        for (value, &other) in column.iter_mut().zip(others) {
            *value = self.values[base - other];
        }
    }
}
