//! Random kernels.

use asperity::surface::HeightMap;
use asperity::updater::{LinearUpdater, RecursiveCholesky};
use asperity::{Boundary, ContactGrowth, Grid, InfluenceKernel, LoadingSolver, LoadingState};
use asperity_testing::dense::influence_matrix;
use asperity_testing::surfaces::with_gaps;
use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;

/// Coefficients by offset, for −nx < di < nx and −ny < dj < ny.
#[derive(Debug, Clone)]
pub(super) struct Table {
    pub(super) grid: Grid,
    pub(super) boundary: Boundary,
    pub(super) growth: ContactGrowth,
    pub(super) coefficients: DMatrix<f64>,
}

impl InfluenceKernel for Table {
    fn grid(&self) -> Grid {
        self.grid
    }
    fn boundary(&self) -> Boundary {
        self.boundary
    }
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        let index = |d: isize, n: usize| (d + n as isize - 1) as usize;
        self.coefficients[(index(di, self.grid.nx()), index(dj, self.grid.ny()))]
    }
    fn contact_growth(&self) -> ContactGrowth {
        self.growth
    }
}

impl Table {
    /// 1 at offset 0 and `coefficient` elsewhere, made symmetric; scaled down away from 0 until the
    /// least eigenvalue of the matrix is 0.05 at least: the condition number is below 1e3.
    pub(super) fn new(
        (nx, ny): (usize, usize),
        boundary: Boundary,
        mut coefficient: impl FnMut(isize, isize) -> f64,
    ) -> Self {
        let grid = Grid::new(nx, ny, 1.0, 1.0).unwrap();
        let (mx, my) = (2 * nx - 1, 2 * ny - 1);
        let random = DMatrix::from_fn(mx, my, |i, j| {
            coefficient(i as isize - nx as isize + 1, j as isize - ny as isize + 1)
        });
        let mut coefficients =
            DMatrix::from_fn(mx, my, |i, j| random[(i, j)] + random[(mx - 1 - i, my - 1 - j)]);
        if boundary == Boundary::Periodic {
            let wrapped = coefficients.clone();
            let fold = |i: usize, n: usize| (i + 1) % n + n - 1;
            coefficients = DMatrix::from_fn(mx, my, |i, j| {
                let (i, j) = (fold(i, nx), fold(j, ny));
                wrapped[(i, j)] + wrapped[(fold(mx - 1 - i, nx), fold(my - 1 - j, ny))]
            });
        }
        coefficients[(nx - 1, ny - 1)] = 0.0;
        let mut table = Self { grid, boundary, growth: ContactGrowth::Unknown, coefficients };
        let least = table.matrix().symmetric_eigenvalues().min();
        table.coefficients *= 0.95 / -least;
        table.coefficients[(nx - 1, ny - 1)] = 1.0;
        table
    }

    /// Random coefficients that fall off as a bell of a random width, or not at all: the smoother the
    /// kernel, the more it takes from the nodes between others.
    pub(super) fn random(
        shape: (usize, usize),
        boundary: Boundary,
        random: &mut ChaCha12Rng,
    ) -> Self {
        let width: f64 = random.random_range(0.8..1.6);
        let noise = [0.1, 0.5, 1.0][random.random_range(0..3)];
        Self::new(shape, boundary, |di, dj| {
            let bell = (-((di * di + dj * dj) as f64) / (width * width)).exp();
            bell * (1.0 - noise) + noise * random.random_range(-0.3..0.5)
        })
    }

    /// The influence matrix of all nodes.
    pub(super) fn matrix(&self) -> DMatrix<f64> {
        influence_matrix(self)
    }

    /// A surface with these initial gaps.
    pub(super) fn heights(&self, gaps: &[f64]) -> HeightMap {
        with_gaps(&self.grid, gaps)
    }

    /// The approach for which gap = g + C p − δ with the coefficients as they are.
    pub(super) fn own_approach(&self, state: &LoadingState) -> f64 {
        match self.boundary {
            Boundary::Free | Boundary::PeriodicX | Boundary::PeriodicY => state.contact.approach,
            Boundary::Periodic => {
                state.contact.approach + self.matrix().mean() * state.contact.load
            }
        }
    }

    pub(super) fn path(&self, gaps: &[f64]) -> LoadingSolver<RecursiveCholesky> {
        self.path_with(gaps, RecursiveCholesky::new())
    }

    pub(super) fn path_with<U: LinearUpdater>(&self, gaps: &[f64], updater: U) -> LoadingSolver<U> {
        let heights = self.heights(gaps);
        LoadingSolver::builder(&heights, self).updater(updater).build().unwrap()
    }
}

/// A random kernel with random gaps.
pub(super) fn case(seed: u64) -> (Table, Vec<f64>) {
    let mut random = ChaCha12Rng::seed_from_u64(seed);
    let shapes = [(20, 1), (5, 4), (6, 6), (1, 30), (3, 7), (8, 9)];
    let shape = shapes[random.random_range(0..shapes.len())];
    let boundary = if random.random_bool(0.5) { Boundary::Free } else { Boundary::Periodic };
    let kernel = Table::random(shape, boundary, &mut random);
    let gaps = (0..kernel.grid.nodes()).map(|_| random.random_range(0.0..1.0));
    let gaps = gaps.collect();
    (kernel, gaps)
}
