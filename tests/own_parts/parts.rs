//! A surface, a kernel and an updater of one's own.

use asperity::contact::ContactSequence;
use asperity::updater::{LinearUpdater, Schur, Solution, WindowFactor};
use asperity::{
    Boundary, ContactGrowth, Error, Grid, InfluenceKernel, Problem, Surface, SurfaceError,
};
use nalgebra::{DMatrix, DVector};

/// Facets of different heights and slopes: nothing in it is symmetric.
pub(crate) struct Facets {
    facets: Vec<[f64; 3]>,
}

impl Facets {
    pub(crate) fn new() -> Self {
        let facets = (0..9).map(|k| {
            let k = f64::from(k);
            [(1.3 * k).sin(), (2.1 * k + 0.4).cos(), 0.2 * (3.7 * k).sin()]
        });
        Self { facets: facets.collect() }
    }
}

impl Surface for Facets {
    fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, SurfaceError> {
        let (lx, ly) = grid.sides();
        Ok(DMatrix::from_fn(grid.nx(), grid.ny(), |ix, iy| {
            let (x, y) = grid.position(ix, iy);
            let plane = |[a, b, c]: &[f64; 3]| a * x / lx + b * y / ly + c;
            // The lower envelope of the planes, rippled so that no two nodes touch at once.
            let roof = self.facets.iter().map(plane).fold(f64::INFINITY, f64::min);
            1e-6 * (roof + 0.05 * (71.0 * x / lx + 57.0 * (y / ly).powi(2)).sin())
        }))
    }
}

/// Grains on springs, coupled by a half-space that sees them from a depth: a point force, with its
/// singularity taken away at the distance of a cell, on top of a Winkler foundation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grains {
    pub(crate) grid: Grid,
    pub(crate) e_star: f64,
    pub(crate) growth: ContactGrowth,
}

impl InfluenceKernel for Grains {
    fn grid(&self) -> Grid {
        self.grid
    }

    fn boundary(&self) -> Boundary {
        Boundary::Free
    }

    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        let (dx, dy) = (self.grid.dx(), self.grid.dy());
        let (x, y) = (di as f64 * dx, dj as f64 * dy);
        let own = if (di, dj) == (0, 0) { 1.0 } else { 0.0 };
        // The transform of 1/sqrt(r² + d²) is positive, 2π exp(-q d)/q: positive definite.
        let depth = 0.3 * dx.min(dy);
        let point = dx * dy / (std::f64::consts::PI * self.e_star * x.hypot(y).hypot(depth));
        point + own * 0.5 * dx.min(dy) / self.e_star
    }

    fn contact_growth(&self) -> ContactGrowth {
        self.growth
    }
}

/// An explicit inverse, bordered by one node at a time (paper, eqs. 7-13).
#[derive(Debug, Default)]
pub(crate) struct Bordering {
    inverse: DMatrix<f64>,
}

impl Bordering {
    fn influence(problem: &Problem, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
            problem.coefficient(rows[i], columns[j]).unwrap()
        })
    }

    /// Borders the inverse for the nodes of `order` that it does not have yet.
    fn grow(&mut self, problem: &Problem, order: &[usize]) {
        for n in self.inverse.nrows()..order.len() {
            let (contact, node) = (&order[..n], order[n]);
            let c = Self::influence(problem, contact, &[node]).column(0).into_owned();
            let x = &self.inverse * &c;
            let pivot = problem.coefficient(node, node).unwrap() - c.dot(&x);
            let mut inverse = DMatrix::zeros(n + 1, n + 1);
            inverse
                .view_mut((0, 0), (n, n))
                .copy_from(&(&self.inverse + &x * x.transpose() / pivot));
            for (k, value) in x.iter().enumerate() {
                inverse[(k, n)] = -value / pivot;
                inverse[(n, k)] = -value / pivot;
            }
            inverse[(n, n)] = 1.0 / pivot;
            self.inverse = inverse;
        }
    }
}

impl LinearUpdater for Bordering {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        let order = contact.order();
        let coupling = Self::influence(problem, order, nodes);
        let eliminated = coupling.transpose() * &self.inverse;
        let complement = Self::influence(problem, nodes, nodes) - &eliminated * &coupling;
        schur.resize(nodes.len())?;
        let sums = problem.row_sums();
        for (i, &node) in nodes.iter().enumerate() {
            let inside = eliminated.row(i);
            let explained: f64 = inside.iter().zip(order).map(|(e, &k)| e * sums[k]).sum();
            schur.row_sums_mut()[i] = sums[node] - explained;
        }
        let mut matrix = schur.matrix_mut();
        for j in 0..nodes.len() {
            for i in 0..nodes.len() {
                // Nobody may look at the upper triangle.
                matrix[(i, j)] = if i >= j { complement[(i, j)] } else { f64::NAN };
            }
        }
        Ok(())
    }

    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        touched: &WindowFactor,
    ) -> Result<(), Error> {
        assert_eq!(self.inverse.nrows() + touched.len(), contact.len());
        self.grow(problem, contact.order());
        Ok(())
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let order = &contact.order()[..count];
        let mut prefix = Self::default();
        let inverse = if count == self.inverse.nrows() {
            &self.inverse
        } else {
            prefix.grow(problem, order);
            &prefix.inverse
        };
        let gap = order.iter().map(|&node| problem.initial_gap()[node]);
        let overlap = DVector::from_iterator(count, gap.map(|gap| approach - gap));
        solution.pressure = (inverse * overlap).data.into();
        solution.rate = inverse.column_sum().data.into();
        Ok(())
    }
}
