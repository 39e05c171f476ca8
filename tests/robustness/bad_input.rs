//! Bad input: a typed error that names what is wrong, never a panic.

use asperity::loading::{LoadingEnd, LoadingSolver};
use asperity::surface::{Amplitude, FlatPunch, HeightMap, SelfAffine};
use asperity::updater::RecursiveCholesky;
use asperity::{
    Boundary, Boussinesq, Error, Grid, InfluenceKernel, KernelError, Surface, SurfaceError,
    UpdaterError,
};
use asperity_testing::{Altered, Call};
use nalgebra::DMatrix;

const NOT_POSITIVE: [f64; 5] = [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// A surface that returns what it is told, whatever the grid.
#[derive(Debug)]
struct Told(DMatrix<f64>);

impl Surface for Told {
    fn heights(&self, _grid: &Grid) -> Result<DMatrix<f64>, SurfaceError> {
        Ok(self.0.clone())
    }
}

/// A surface that cannot be sampled.
#[derive(Debug)]
struct Refuses;

impl Surface for Refuses {
    fn heights(&self, _grid: &Grid) -> Result<DMatrix<f64>, SurfaceError> {
        Err(SurfaceError::TooFewWaves { found: 1, needed: 2 })
    }
}

/// A kernel from a function.
#[derive(Debug)]
struct Kernel(Grid, fn(isize, isize) -> f64);

impl InfluenceKernel for Kernel {
    fn grid(&self) -> Grid {
        self.0
    }
    fn boundary(&self) -> Boundary {
        Boundary::Free
    }

    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        self.1(di, dj)
    }
}

fn half_space(n: usize) -> Boussinesq {
    Boussinesq::new(Grid::square(n, 1.0).unwrap(), 1.0).unwrap()
}

#[test]
fn grids() {
    for (nx, ny) in [(0, 0), (0, 5), (5, 0)] {
        assert!(matches!(Grid::new(nx, ny, 1.0, 1.0), Err(SurfaceError::EmptyGrid { .. })));
        assert!(matches!(Grid::with_sides(nx, ny, 1.0, 1.0), Err(SurfaceError::EmptyGrid { .. })));
    }
    assert!(matches!(Grid::square(0, 1.0), Err(SurfaceError::EmptyGrid { .. })));
    for n in [Grid::MAX_SIDE + 1, usize::MAX / 2, usize::MAX] {
        for (nx, ny) in [(n, 1), (1, n), (n, n)] {
            assert!(matches!(Grid::new(nx, ny, 1.0, 1.0), Err(SurfaceError::GridTooLarge { .. })));
            let sides = Grid::with_sides(nx, ny, 1.0, 1.0);
            assert!(matches!(sides, Err(SurfaceError::GridTooLarge { .. })));
        }
    }
    for bad in NOT_POSITIVE {
        for grid in [
            Grid::new(4, 4, bad, 1.0),
            Grid::new(4, 4, 1.0, bad),
            Grid::with_sides(4, 4, bad, 1.0),
            Grid::with_sides(4, 4, 1.0, bad),
            Grid::square(4, bad),
        ] {
            assert!(matches!(grid, Err(SurfaceError::NotPositive { .. })), "{bad}");
        }
    }
    // Areas that over- or underflow.
    for cell in [1e200, 1e-200] {
        assert!(matches!(Grid::new(4, 4, cell, cell), Err(SurfaceError::NotPositive { .. })));
    }
}

#[test]
fn moduli() {
    let grid = Grid::square(4, 1.0).unwrap();
    for bad in NOT_POSITIVE {
        assert!(matches!(Boussinesq::new(grid, bad), Err(Error::NotPositive { .. })), "{bad}");
    }
    // 1/E* overflows.
    assert!(matches!(Boussinesq::new(grid, 5e-324), Err(Error::NotPositive { .. })));
}

#[test]
fn heights() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut heights = DMatrix::zeros(5, 4);
        heights[(3, 2)] = value;
        let error = HeightMap::new(heights.clone()).unwrap_err();
        assert!(matches!(error, SurfaceError::HeightNotFinite { ix: 3, iy: 2, .. }), "{error}");
        let kernel = Boussinesq::new(Grid::new(5, 4, 1.0, 1.0).unwrap(), 1.0).unwrap();
        let error = LoadingSolver::new(&Told(heights), &kernel).unwrap_err();
        assert!(
            matches!(error, Error::Surface(SurfaceError::HeightNotFinite { ix: 3, iy: 2, .. })),
            "{error}"
        );
    }
    assert!(matches!(HeightMap::new(DMatrix::zeros(0, 3)), Err(SurfaceError::EmptyGrid { .. })));
    for shape in [(4, 5), (5, 5), (20, 1), (0, 0)] {
        let heights = Told(DMatrix::zeros(shape.0, shape.1));
        let kernel = Boussinesq::new(Grid::new(5, 4, 1.0, 1.0).unwrap(), 1.0).unwrap();
        let Err(Error::GridMismatch { expected, found }) = LoadingSolver::new(&heights, &kernel)
        else {
            panic!("{shape:?} accepted");
        };
        assert_eq!((expected, found), ((5, 4), shape));
    }
    // Each height is finite, their difference is not.
    let mut heights = DMatrix::from_element(4, 4, -1e308);
    heights[(1, 1)] = 1e308;
    let error = LoadingSolver::new(&Told(heights), &half_space(4)).unwrap_err();
    assert!(matches!(error, Error::OutOfRange { .. }), "{error}");
    // The surface's own error arrives as it is.
    let error = LoadingSolver::new(&Refuses, &half_space(4)).unwrap_err();
    assert!(
        matches!(error, Error::Surface(SurfaceError::TooFewWaves { found: 1, needed: 2 })),
        "{error}"
    );
    // Waves too short for the grid.
    let rough = SelfAffine::new(0.8, 1.0, 0.1, Amplitude::RmsHeight(1.0), 1).unwrap();
    let error = LoadingSolver::new(&rough, &half_space(4)).unwrap_err();
    assert!(matches!(error, Error::Surface(SurfaceError::CutoffBelowGrid { .. })), "{error}");
}

#[test]
fn malformed_updaters() {
    for what in ["size", "pressure", "rate", "nan", "nan rate"] {
        // What is made of an answer.
        let updater = Altered::new(RecursiveCholesky::new()).on_call(move |inner, call| {
            call.ask(inner)?;
            match (what, call) {
                ("size", Call::Watch { nodes, schur, .. }) => schur.resize(nodes.len() + 1)?,
                ("nan", Call::Watch { schur, .. }) => schur.matrix_mut().fill(f64::NAN),
                ("pressure", Call::Solve { solution, .. }) => solution.pressure.push(0.0),
                ("rate", Call::Solve { solution, .. }) => solution.rate.clear(),
                ("nan rate", Call::Solve { solution, .. }) => solution.rate.fill(f64::NAN),
                _ => (),
            }
            Ok(())
        });
        let (punch, kernel) = (FlatPunch::default(), half_space(4));
        let builder = LoadingSolver::builder(&punch, &kernel);
        let mut path = builder.updater(updater).window_size(3).build().unwrap();
        let error = path.find_map(Result::err).unwrap();
        let typed = match what {
            "nan" => matches!(error, Error::NotFinite { step: 1 }),
            "nan rate" => matches!(error, Error::Updater(UpdaterError::ContactNotClosed { .. })),
            _ => matches!(error, Error::Updater(UpdaterError::UpdaterMismatch { .. })),
        };
        assert!(typed, "{what}: {error}");
        assert!(path.next().is_none());
        assert_eq!(path.end(), Some(LoadingEnd::Failed));
    }
}

#[test]
fn kernels_that_are_no_kernels() {
    let grid = Grid::square(4, 1.0).unwrap();
    let build = |coefficient: fn(isize, isize) -> f64| {
        LoadingSolver::new(&FlatPunch::default(), &Kernel(grid, coefficient)).unwrap_err()
    };
    for error in [
        build(|di, dj| if (di, dj) == (2, -1) { f64::NAN } else { 1.0 }),
        build(|di, dj| if (di, dj) == (2, -1) { f64::INFINITY } else { 1.0 }),
    ] {
        assert!(
            matches!(error, Error::Kernel(KernelError::NotFinite { di: 2, dj: -1, .. })),
            "{error}"
        );
    }
    let error = build(|di, dj| if (di, dj) == (2, -1) { 0.6 } else { 0.5 });
    let Error::Kernel(KernelError::NotSymmetric { di, dj, value, opposite }) = error else {
        panic!("{error}");
    };
    assert!([(2, -1), (-2, 1)].contains(&(di, dj)));
    assert_eq!((value + opposite, (value - opposite).abs() < 0.11), (1.1, true));
    for error in [build(|_, _| 0.0), build(|di, dj| if (di, dj) == (0, 0) { -1.0 } else { 0.0 })] {
        assert!(matches!(error, Error::NotPositiveDefinite { .. }), "{error}");
    }
}
