//! Periodic kernels whose waves answer negatively, or whose gauge makes their matrix singular or indefinite.

use asperity::kernel::KernelTable;
use asperity::loading::LoadingSolver;
use asperity::surface::HeightMap;
use asperity::{
    Boundary, ContactGrowth, Error, FixedLoadSolver, Grid, InfluenceKernel, KernelError, Spectral,
};
use nalgebra::DMatrix;

/// A periodic bump of Gauss's shape, summed over its images: its waves answer like another such bump, and
/// turn negative where it is cut off.
#[derive(Debug)]
struct Bump {
    grid: Grid,
    width: f64,
}

impl InfluenceKernel for Bump {
    fn grid(&self) -> Grid {
        self.grid
    }
    fn boundary(&self) -> Boundary {
        Boundary::Periodic
    }
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        let (nx, ny) = self.grid.shape();
        // The nearest image only.
        let distance = |d: isize, n: usize| {
            let d = d.rem_euclid(n as isize);
            d.min(n as isize - d) as f64
        };
        let (x, y) = (distance(di, nx), distance(dj, ny));
        (-(x * x + y * y) / (2.0 * self.width * self.width)).exp()
    }
}

/// The least eigenvalue of the matrix of all nodes, with uniform pressure left out, which the mean displacement
/// makes arbitrary.
fn least_eigenvalue(kernel: &Bump) -> f64 {
    let grid = kernel.grid;
    let nodes = grid.nodes();
    let place = |node: usize| grid.coordinates(node);
    let matrix = DMatrix::from_fn(nodes, nodes, |i, j| {
        let ((ax, ay), (bx, by)) = (place(i), place(j));
        kernel.coefficient(ax as isize - bx as isize, ay as isize - by as isize)
    });
    let mean = matrix.mean();
    // Uniform pressure is an eigenvector: its eigenvalue goes to the top.
    let shifted = matrix.add_scalar(-mean + 10.0);
    shifted.symmetric_eigenvalues().min()
}

/// A periodic kernel that is not positive definite is refused at the door, with the wave that shows it; one that
/// is has a path to full contact.
#[test]
fn periodic_kernels_that_are_not_positive_definite() {
    let (mut refused, mut accepted) = (0, 0);
    for (nx, ny) in [(3, 5), (4, 4), (1, 7), (6, 2)] {
        for width in [0.3, 0.5, 0.8, 1.0, 1.3, 2.0] {
            let grid = Grid::new(nx, ny, 1.0, 1.0).unwrap();
            let kernel = Bump { grid, width };
            let least = least_eigenvalue(&kernel);
            let heights = DMatrix::from_fn(nx, ny, |ix, iy| ((3 * ix + 5 * iy) as f64).sin());
            let surface = HeightMap::new(heights).unwrap();
            let built = LoadingSolver::new(&surface, &kernel);
            let single = FixedLoadSolver::new(&surface, &kernel).map(drop);
            // Far from rounding, which is some 1e-15.
            assert!(least.abs() > 1e-12, "{nx} × {ny}, {width}: {least:e}");
            if least > 0.0 {
                single.unwrap();
                let states: Vec<_> = built.unwrap().map(Result::unwrap).collect();
                let last = states.last().unwrap();
                assert_eq!(last.contact.contact_nodes, nx * ny, "{nx} × {ny}, {width}");
                for state in &states {
                    assert!(
                        state.contact.energy >= 0.0
                            && state.contact.interfacial_stiffness > Some(0.0)
                    );
                }
                accepted += 1;
                continue;
            }
            for error in [built.map(drop).unwrap_err(), single.unwrap_err()] {
                let Error::Kernel(KernelError::SymbolNotPositive { q, value }) = error else {
                    panic!("{nx} × {ny}, {width}: {error}");
                };
                // An eigenvalue of the matrix, not below the least one, at a wave of the grid.
                assert!(value < 0.0 && value >= least - 1e-13, "{value} {least}");
                assert!(q != (0.0, 0.0) && q.0.is_finite() && q.1.is_finite());
            }
            refused += 1;
        }
    }
    assert!(refused >= 4 && accepted >= 4, "{refused} {accepted}");
}

/// The gauge of a periodic kernel changes nothing, also where it makes the matrix singular or
/// indefinite.
#[test]
fn any_gauge_has_the_same_path() {
    let grid = Grid::new(6, 5, 1.0, 1.0).unwrap();
    let kernel = Spectral::new(grid, 1.0).unwrap();
    let heights = DMatrix::from_fn(6, 5, |ix, iy| ((3 * ix + 5 * iy * iy) as f64).sin());
    let surface = HeightMap::new(heights).unwrap();
    let expected: Vec<_> =
        LoadingSolver::new(&surface, &kernel).unwrap().map(Result::unwrap).collect();
    for growth in [ContactGrowth::Unknown, ContactGrowth::Monotone] {
        for gauge in [-10.0, -1.0, -1e-3, 0.0, 1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e5, 1e7, 1e9] {
            let coefficient = |di, dj| {
                // In units of its own gauge.
                kernel.coefficient(di, dj) + kernel.gauge() * (gauge - 1.0)
            };
            let Ok(table) = KernelTable::from_fn(grid, Boundary::Periodic, growth, coefficient)
            else {
                // C(0, 0) is not positive.
                assert!(gauge < 0.0);
                continue;
            };
            let path = LoadingSolver::new(&surface, &table).unwrap();
            let states: Vec<_> = path.map(Result::unwrap).collect();
            assert_eq!(states.len(), expected.len());
            for (state, expected) in states.iter().zip(&expected) {
                assert_eq!(state.node, expected.node, "gauge {gauge}");
                // Some rounding errors of coefficients that are so much larger.
                let allowed = 1e-13 * f64::max(gauge, 1e3);
                for (a, b) in [
                    (state.contact.load, expected.contact.load),
                    (state.contact.approach, expected.contact.approach),
                ] {
                    assert!((a - b).abs() <= allowed * b, "gauge {gauge}: {a} {b}");
                }
            }
        }
    }
}
