//! The equations of one level: each node with its four neighbours.

use nalgebra::DMatrix;

use crate::parallel::{for_each_chunk, vectorized};

/// Rows that a thread takes at a time.
const BAND: usize = 16;

/// How strongly given neighbours hold a node of the next coarser level, relative to all of their weights.
///
/// A coarse node that averages two by two nodes lies between half a cell and a cell and a half of its own from the
/// given ones; the best number depends on the pattern. Steps of the iteration on 2048 × 2048 nodes with 1/2, 3/4 and 1:
/// 50, 17 and 17 with one node in a hundred given, 28, 19 and 21 with the border alone.
const HOLD: f64 = 0.75;

/// A field on the nodes of a level, with a frame of zeros round it, so that every node has four neighbours.
#[derive(Debug, Clone)]
pub(super) struct Field {
    nx: usize,
    values: Vec<f64>,
}

impl Field {
    /// Zeros on nx × ny nodes.
    pub(super) fn zeros(nx: usize, ny: usize) -> Self {
        Self { nx, values: vec![0.0; (nx + 2) * (ny + 2)] }
    }

    /// The values of the nodes, x first.
    pub(super) fn values(&self) -> impl Iterator<Item = f64> {
        (1..self.values.len() / self.pitch() - 1).flat_map(|iy| self.row(iy)).copied()
    }

    /// Greatest absolute value; NaN if one is.
    pub(super) fn greatest(&self) -> f64 {
        let greater = |most: f64, value: &f64| {
            // `f64::max` would pass over NaN.
            if value.abs() > most || value.is_nan() { value.abs() } else { most }
        };
        self.values.iter().fold(0.0, greater)
    }

    /// `work(iy, row)` for all rows, counted from 1.
    pub(super) fn fill_rows(&mut self, work: impl Fn(usize, &mut [f64]) + Sync + Send) {
        let pitch = self.pitch();
        let end = self.values.len() - pitch;
        for_each_chunk(&mut self.values[pitch..end], pitch * BAND, |band, rows| {
            for (row, iy) in rows.chunks_mut(pitch).zip(1 + band * BAND..) {
                vectorized(
                    #[inline(always)]
                    || work(iy, &mut row[1..pitch - 1]),
                );
            }
        });
    }

    fn pitch(&self) -> usize {
        self.nx + 2
    }

    /// The values of a row, counted from 1.
    #[inline(always)]
    pub(super) fn row(&self, iy: usize) -> &[f64] {
        self.shifted(iy, 1)
    }

    /// The values to the left (0), at (1) or to the right (2) of those of a row.
    #[inline(always)]
    fn shifted(&self, iy: usize, by: usize) -> &[f64] {
        &self.values[iy * self.pitch() + by..][..self.nx]
    }
}

/// The matrix of one level, symmetric and positive definite: for node i with neighbours j
///
/// ```math
/// (A x)_i = d_i x_i - \sum_j w_{ij} x_j, \qquad d_i = \sum_j w_{ij} + g_i
/// ```
///
/// with weights w between missing nodes and the weight g of given neighbours, whose values are part of the right side.
/// Nodes that are given have d = 0 and no weights. Numbers of single precision are enough: those of the map itself are
/// small integers, and those of coarser levels only precondition.
#[derive(Debug, Clone)]
pub(super) struct Stencil {
    nx: usize,
    ny: usize,
    /// Weight of the neighbour at ix + 1, framed as a [`Field`].
    east: Vec<f32>,
    /// Weight of the neighbour at iy + 1.
    north: Vec<f32>,
    diagonal: Vec<f32>,
}

impl Stencil {
    /// The equations of a map whose missing nodes are NaN or infinite: matrix, weights g and right side.
    pub(super) fn of_map(heights: &DMatrix<f64>) -> (Self, Vec<f32>, Field) {
        let (nx, ny) = heights.shape();
        let mut right_side = Field::zeros(nx, ny);
        let pitch = right_side.pitch();
        let mut given = vec![0.0; right_side.values.len()];
        let mut stencil =
            Self { nx, ny, east: given.clone(), north: given.clone(), diagonal: Vec::new() };
        let mut connect = |a: usize, b: usize, heights: [f64; 2], weights: &mut [f32]| {
            let mut hold = |node: usize, height: f64| {
                given[node] += 1.0;
                right_side.values[node] += height;
            };
            match heights.map(f64::is_finite) {
                [true, true] => {}
                [true, false] => hold(b, heights[0]),
                [false, true] => hold(a, heights[1]),
                [false, false] => weights[a] = 1.0,
            }
        };
        for iy in 0..ny {
            for ix in 0..nx {
                let (node, height) = (ix + 1 + pitch * (iy + 1), heights[(ix, iy)]);
                if ix + 1 < nx {
                    let pair = [height, heights[(ix + 1, iy)]];
                    connect(node, node + 1, pair, &mut stencil.east);
                }
                if iy + 1 < ny {
                    let pair = [height, heights[(ix, iy + 1)]];
                    connect(node, node + pitch, pair, &mut stencil.north);
                }
            }
        }
        stencil.set_diagonal(&given);
        (stencil, given, right_side)
    }

    /// Nodes along x and y.
    pub(super) fn shape(&self) -> (usize, usize) {
        (self.nx, self.ny)
    }

    /// The same for means of two by two nodes, from the weights g of this level; with those of the coarser one.
    ///
    /// Weights are half the sums of those between the nodes of two means: a mean is twice as far from the next one as a
    /// node. On a whole grid they are 1 again.
    pub(super) fn coarser(&self, given: &[f32]) -> (Self, Vec<f32>) {
        let (nx, ny) = (self.nx.div_ceil(2), self.ny.div_ceil(2));
        let (pitch, coarse_pitch) = (self.nx + 2, nx + 2);
        let mut held = vec![0.0; coarse_pitch * (ny + 2)];
        let mut coarse =
            Self { nx, ny, east: held.clone(), north: held.clone(), diagonal: Vec::new() };
        for iy in 1..=self.ny {
            for ix in 1..=self.nx {
                let node = ix + pitch * iy;
                let mean = ix.div_ceil(2) + coarse_pitch * iy.div_ceil(2);
                held[mean] += HOLD as f32 * given[node];
                if ix.is_multiple_of(2) {
                    coarse.east[mean] += 0.5 * self.east[node];
                }
                if iy.is_multiple_of(2) {
                    coarse.north[mean] += 0.5 * self.north[node];
                }
            }
        }
        coarse.set_diagonal(&held);
        (coarse, held)
    }

    fn set_diagonal(&mut self, given: &[f32]) {
        let pitch = self.nx + 2;
        self.diagonal = given.to_vec();
        for iy in 1..=self.ny {
            let first = pitch * iy + 1;
            let diagonal = &mut self.diagonal[first..first + self.nx];
            for (diagonal, node) in diagonal.iter_mut().zip(first..) {
                let (east, west) = (self.east[node], self.east[node - 1]);
                let (north, south) = (self.north[node], self.north[node - pitch]);
                *diagonal += east + west + north + south;
            }
        }
    }

    /// `image` = A x.
    pub(super) fn apply(&self, x: &Field, image: &mut Field) {
        image.fill_rows(
            #[inline(always)]
            |iy, image| {
                self.visit(x, iy, |i, sum, diagonal, x| image[i] = diagonal * x - sum);
            },
        );
    }

    /// `residual` = b − A x.
    pub(super) fn residual(&self, b: &Field, x: &Field, residual: &mut Field) {
        residual.fill_rows(
            #[inline(always)]
            |iy, residual| {
                let b = b.row(iy);
                self.visit(x, iy, |i, sum, diagonal, x| {
                    residual[i] = b[i] + sum - diagonal * x;
                });
            },
        );
    }

    /// `next` = x + ω D⁻¹ (b − A x): a step of Jacobi's iteration, damped or exaggerated.
    pub(super) fn relax(&self, omega: f64, b: &Field, x: &Field, next: &mut Field) {
        next.fill_rows(
            #[inline(always)]
            |iy, next| {
                let b = b.row(iy);
                self.visit(x, iy, |i, sum, diagonal, x| {
                    let step = (b[i] + sum) / diagonal - x;
                    next[i] = if diagonal > 0.0 { x + omega * step } else { 0.0 };
                });
            },
        );
    }

    /// `next` = ω D⁻¹ b: such a step from zero.
    pub(super) fn relax_zero(&self, omega: f64, b: &Field, next: &mut Field) {
        next.fill_rows(
            #[inline(always)]
            |iy, next| {
                let (b, diagonal) = (b.row(iy), self.row(&self.diagonal, iy, 1));
                for ((next, b), &diagonal) in next.iter_mut().zip(b).zip(diagonal) {
                    let step = omega * b / f64::from(diagonal);
                    *next = if diagonal > 0.0 { step } else { 0.0 };
                }
            },
        );
    }

    /// `x` += the values of the means they belong to, at missing nodes.
    pub(super) fn add_means(&self, means: &Field, x: &mut Field) {
        x.fill_rows(
            #[inline(always)]
            |iy, x| {
                let (means, diagonal) =
                    (means.row(iy.div_ceil(2)), self.row(&self.diagonal, iy, 1));
                let pairs = x.chunks_mut(2).zip(diagonal.chunks(2));
                for ((x, diagonal), &mean) in pairs.zip(means) {
                    for (x, &diagonal) in x.iter_mut().zip(diagonal) {
                        *x += if diagonal > 0.0 { mean } else { 0.0 };
                    }
                }
            },
        );
    }

    /// `visit(i, Σ w x, d, x)` for the nodes of a row.
    #[inline(always)]
    fn visit(&self, x: &Field, iy: usize, mut visit: impl FnMut(usize, f64, f64, f64)) {
        let (here, left, right) = (x.row(iy), x.shifted(iy, 0), x.shifted(iy, 2));
        let (below, above) = (x.row(iy - 1), x.row(iy + 1));
        let (west, east) = (self.row(&self.east, iy, 0), self.row(&self.east, iy, 1));
        let (south, north) = (self.row(&self.north, iy - 1, 1), self.row(&self.north, iy, 1));
        let diagonal = self.row(&self.diagonal, iy, 1);
        for i in 0..self.nx {
            let along_x = f64::from(west[i]) * left[i] + f64::from(east[i]) * right[i];
            let along_y = f64::from(south[i]) * below[i] + f64::from(north[i]) * above[i];
            visit(i, along_x + along_y, f64::from(diagonal[i]), here[i]);
        }
    }

    #[inline(always)]
    fn row<'a>(&self, weights: &'a [f32], iy: usize, by: usize) -> &'a [f32] {
        &weights[iy * (self.nx + 2) + by..][..self.nx]
    }
}

/// Sums of two by two nodes, the transpose of [`Stencil::add_means`]; zero stays at given nodes.
pub(super) fn sum_means(fine: &Field, sums: &mut Field) {
    let rows = fine.values.len() / fine.pitch() - 2;
    sums.fill_rows(|iy, sums| {
        let first = fine.row(2 * iy - 1);
        // The last row of an odd number stands alone; the frame, which is zero, is the other.
        let second = fine.row((2 * iy).min(rows + 1));
        let pairs = first.chunks(2).zip(second.chunks(2));
        for (sum, (first, second)) in sums.iter_mut().zip(pairs) {
            *sum = first.iter().sum::<f64>() + second.iter().sum::<f64>();
        }
    });
}
