//! A surface, a kernel and an updater of one's own, by the public interface alone.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use asperity::kernel::KernelTable;
use asperity::loading::LoadingSolver;
use asperity::surface::{FlatPunch, Paraboloid};
use asperity::updater::{
    Dense, LinearUpdater, RecursiveCholesky, Schur, Solution, System, Touched,
};
use asperity::{Boundary, Boussinesq, ContactState, Error, Grid, InfluenceKernel, Surface};
use nalgebra::{DMatrix, DVector};

/// Facets of different heights and slopes: nothing in it is symmetric.
struct Facets {
    facets: Vec<[f64; 3]>,
}

impl Facets {
    fn new() -> Self {
        let facets = (0..9).map(|k| {
            let k = f64::from(k);
            [
                (1.3 * k).sin(),
                (2.1 * k + 0.4).cos(),
                0.2 * (3.7 * k).sin(),
            ]
        });
        Self {
            facets: facets.collect(),
        }
    }
}

impl Surface for Facets {
    fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, Error> {
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
struct Grains {
    grid: Grid,
    e_star: f64,
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
}

/// An explicit inverse, bordered by one node at a time (paper, eqs. 7-13).
#[derive(Default)]
struct Bordering {
    contact: Vec<usize>,
    inverse: DMatrix<f64>,
}

impl Bordering {
    fn influence(system: &System, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
            system.coefficient(rows[i], columns[j]).unwrap()
        })
    }

    fn rhs(system: &System, nodes: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(nodes.len(), System::RHS, |i, c| {
            system.rhs(nodes[i]).unwrap()[c]
        })
    }

    fn push(&mut self, system: &System, node: usize) {
        let n = self.contact.len();
        let c = Self::influence(system, &self.contact, &[node])
            .column(0)
            .into_owned();
        let x = &self.inverse * &c;
        let pivot = system.coefficient(node, node).unwrap() - c.dot(&x);
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
        self.contact.push(node);
    }
}

impl LinearUpdater for Bordering {
    fn schur(&mut self, system: &System, nodes: &[usize], schur: &mut Schur) -> Result<(), Error> {
        let coupling = Self::influence(system, &self.contact, nodes);
        let eliminated = coupling.transpose() * &self.inverse;
        let complement = Self::influence(system, nodes, nodes) - &eliminated * &coupling;
        let rhs = Self::rhs(system, nodes) - eliminated * Self::rhs(system, &self.contact);
        schur.resize(nodes.len());
        for (i, row) in schur.rhs_mut().iter_mut().enumerate() {
            *row = std::array::from_fn(|c| rhs[(i, c)]);
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

    fn commit(&mut self, system: &System, touched: &Touched) -> Result<(), Error> {
        for &node in touched.nodes() {
            self.push(system, node);
        }
        Ok(())
    }

    fn solve(
        &mut self,
        system: &System,
        touched: &Touched,
        count: usize,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let mut prefix = Self::default();
        for &node in self.contact.iter().chain(touched.nodes()).take(count) {
            prefix.push(system, node);
        }
        let solved = &prefix.inverse * Self::rhs(system, &prefix.contact);
        solution.y1 = solved.column(0).iter().map(|value| -value).collect();
        solution.y2 = solved.column(1).iter().copied().collect();
        Ok(())
    }
}

type Path = (Vec<ContactState>, Vec<usize>, Vec<DMatrix<f64>>);

/// States, order and three pressures of a path to full contact.
fn path<K: InfluenceKernel, U: LinearUpdater>(kernel: K, updater: U, window: usize) -> Path {
    let builder = LoadingSolver::builder(Facets::new(), kernel).updater(updater);
    let mut path = builder.window_size(window).build().unwrap();
    let states: Vec<_> = path.by_ref().map(Result::unwrap).collect();
    let order = path.contact_order().to_vec();
    let middle = states.len() / 2;
    let pressures = [
        states[middle],
        states[1].at_load(states[2].load),
        states[states.len() - 1],
    ]
    .map(|state| path.pressure_at(&state).unwrap());
    (states, order, pressures.to_vec())
}

fn assert_same_path(a: &Path, b: &Path) {
    assert_eq!(a.1, b.1);
    assert_eq!(a.0.len(), b.0.len());
    for (a, b) in a.0.iter().zip(&b.0) {
        assert_eq!((a.step, a.node), (b.step, b.node));
        // An explicit inverse, bordered some hundred times, loses a few digits more than a factor:
        // 1e-9 is what the crate promises of two ways to the same path.
        for (x, y) in [
            (a.approach, b.approach),
            (a.load, b.load),
            (a.contact_stiffness.unwrap(), b.contact_stiffness.unwrap()),
            (a.energy, b.energy),
        ] {
            assert!((x - y).abs() <= 1e-9 * x.abs(), "{a:?} {b:?}");
        }
    }
    for (a, b) in a.2.iter().zip(&b.2) {
        assert!((a - b).amax() <= 1e-9 * a.amax());
    }
}

#[test]
fn own_kernel_is_an_inverse_m_matrix() {
    // What exactness needs: positive definite, and no positive entry off the diagonal of the
    // inverse. Contact sets inherit both.
    let grid = Grid::new(9, 11, 2e-5, 1.5e-5).unwrap();
    let table = KernelTable::new(&Grains { grid, e_star: 1e9 }).unwrap();
    let nodes = grid.nodes();
    let matrix = DMatrix::from_fn(nodes, nodes, |a, b| {
        let ((ax, ay), (bx, by)) = (grid.coordinates(a), grid.coordinates(b));
        table
            .coefficient(ax as isize - bx as isize, ay as isize - by as isize)
            .unwrap()
    });
    let inverse = matrix.cholesky().unwrap().inverse();
    let diagonal = inverse.diagonal().min();
    for a in 0..nodes {
        for b in 0..a {
            // Rounding of the inverse: the condition number, below 1e2, times 1e-16.
            assert!(inverse[(a, b)] <= 1e-13 * diagonal, "{a} {b}");
        }
    }
    let row_sums = &inverse * DVector::from_element(nodes, 1.0);
    assert!(row_sums.min() > 0.0);
}

#[test]
fn own_surface_kernel_and_updater() {
    let grid = Grid::new(9, 11, 2e-5, 1.5e-5).unwrap();
    let kernel = Grains { grid, e_star: 1e9 };
    let reference = path(&kernel, RecursiveCholesky::new(), 16);
    for (k, state) in reference.0.iter().enumerate().skip(1) {
        assert!(state.approach > reference.0[k - 1].approach, "no ties here");
    }
    for window in [1, 7, 16, 200] {
        assert_same_path(&reference, &path(&kernel, Bordering::default(), window));
        assert_same_path(&reference, &path(&kernel, Dense::new(), window));
    }
    assert_eq!(reference.0.len(), grid.nodes());

    // The same updater on the crate's own half-space.
    let half_space = Boussinesq::new(grid, 1e9).unwrap();
    let reference = path(&half_space, RecursiveCholesky::new(), 16);
    assert_same_path(&reference, &path(&half_space, Bordering::default(), 16));
}

#[test]
fn own_parts_are_exact_at_every_event() {
    let grid = Grid::new(9, 11, 2e-5, 1.5e-5).unwrap();
    let builder = LoadingSolver::builder(Facets::new(), Grains { grid, e_star: 1e9 });
    let mut path = builder.updater(Bordering::default()).build().unwrap();
    let mut count = 0;
    while let Some(state) = path.next() {
        state.unwrap();
        count += 1;
        let certificate = path.certificate().unwrap();
        // The promise of the crate.
        assert!(certificate.least_pressure >= -1e-12, "{certificate:?}");
        assert!(certificate.least_gap >= -1e-12, "{certificate:?}");
        assert!(certificate.load_error.abs() < 1e-12, "{certificate:?}");
    }
    assert_eq!(count, grid.nodes());
}

#[test]
fn surfaces_by_reference_and_in_boxes() {
    let grid = Grid::square(8, 1e-3).unwrap();
    let kernel = Boussinesq::new(grid, 1e9).unwrap();
    let sphere = Paraboloid::new(0.1).unwrap();
    let states = |surface: &dyn Surface| -> Vec<ContactState> {
        let path = LoadingSolver::new(surface, &kernel).unwrap();
        path.map(Result::unwrap).collect()
    };
    let reference = states(&sphere);
    assert_eq!(reference.len(), 64);
    let boxed: Box<dyn Surface> = Box::new(sphere);
    assert_eq!(states(&boxed), reference);
    assert_eq!(states(&&sphere), reference);
    let mixed: Vec<Box<dyn Surface>> = vec![Box::new(FlatPunch::default()), Box::new(sphere)];
    for surface in mixed {
        let path = LoadingSolver::new(surface, &kernel).unwrap();
        assert_eq!(path.map(Result::unwrap).count(), 64);
    }
    // A kernel by reference through a trait object.
    let kernel: &dyn InfluenceKernel = &kernel;
    let path = LoadingSolver::new(sphere, kernel).unwrap();
    assert_eq!(path.map(Result::unwrap).collect::<Vec<_>>(), reference);
}
