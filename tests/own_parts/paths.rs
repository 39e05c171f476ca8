//! Paths of a user-defined surface, kernel and updater.

use crate::parts::{Facets, Grains};
use asperity::kernel::{self, KernelTable};
use asperity::loading::History;
use asperity::updater::{self, Dense, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boundary, Boussinesq, ContactGrowth, Error, Grid, InfluenceKernel, KernelError, LoadingSolver,
    LoadingState, Problem, UpdaterError,
};
use asperity_testing::bordering::Bordering;
use asperity_testing::{Altered, Call};
use nalgebra::{DMatrix, DVector};

/// What [`own_kernel_is_an_inverse_m_matrix`] shows of it is not said yet.
fn grains(grid: Grid) -> Grains {
    let growth = ContactGrowth::Unknown;
    Grains { grid, e_star: 1e9, growth }
}

type Path = (Vec<LoadingState>, Vec<usize>, Vec<DMatrix<f64>>);

/// States, order and three pressures of a path to full contact.
fn path<U: LinearUpdater>(kernel: &dyn InfluenceKernel, updater: U, window: usize) -> Path {
    let surface = Facets::new();
    let builder = LoadingSolver::builder(&surface, kernel).updater(updater);
    let mut path = builder.window_size(window).build().unwrap();
    let states: Vec<_> = path.by_ref().map(Result::unwrap).collect();
    let order = path.contact_order();
    let history: History = states.iter().copied().collect();
    let pressures = [
        states[states.len() / 2],
        history.at_load(0.5 * (states[1].contact.load + states[2].contact.load)).unwrap(),
        states[states.len() - 1],
    ]
    .map(|state| path.fields_at(&state).unwrap().pressure);
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
            (a.contact.approach, b.contact.approach),
            (a.contact.load, b.contact.load),
            (a.contact.contact_stiffness.unwrap(), b.contact.contact_stiffness.unwrap()),
            (a.contact.energy, b.contact.energy),
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
    let table = KernelTable::new(&grains(grid)).unwrap();
    let nodes = grid.nodes();
    let matrix = DMatrix::from_fn(nodes, nodes, |a, b| {
        let ((ax, ay), (bx, by)) = (grid.coordinates(a), grid.coordinates(b));
        table.coefficient(ax as isize - bx as isize, ay as isize - by as isize).unwrap()
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

/// What the documentation tells those to do who write a kernel or an updater.
#[test]
fn own_kernel_and_updater_stand_their_checks() {
    let grid = Grid::new(9, 11, 2e-5, 1.5e-5).unwrap();
    let growth = ContactGrowth::Convex;
    let convex = Grains { growth, ..grains(grid) };
    let report = kernel::check(&convex).unwrap();
    assert_eq!(report.promised_growth, ContactGrowth::Convex);
    assert_eq!(report.supported_growth, ContactGrowth::Convex);
    assert_eq!(report.largest_contact, grid.nodes());
    let report = kernel::check(&grains(grid)).unwrap();
    assert_eq!(report.promised_growth, ContactGrowth::Unknown);

    let problem = Problem::new(&Facets::new(), &convex).unwrap();
    let report = updater::check(&mut Bordering::default(), &problem).unwrap();
    assert_eq!((report.truncates, report.releases), (false, false));
    assert!(report.contact_nodes > 80, "{report:?}");
    // An explicit inverse, bordered a hundred times.
    assert!(report.schur_error < 1e-12, "{report:?}");
    assert!(report.solution_error < 1e-12, "{report:?}");
}

/// The same parts with what they promise broken: the checks say so.
#[test]
fn the_checks_can_fail() {
    let grid = Grid::square(6, 1e-4).unwrap();
    // Neighbours pull harder than a node resists: it would leave.
    let coefficient = |di: isize, dj: isize| match di.abs() + dj.abs() {
        0 => 1.0,
        1 => 0.45,
        _ => 0.0,
    };
    let growth = ContactGrowth::Monotone;
    let broken = KernelTable::from_fn(grid, Boundary::Free, growth, coefficient).unwrap();
    let error = kernel::check(&broken).unwrap_err();
    assert!(
        matches!(
            error,
            Error::Kernel(KernelError::BrokenPromise { .. })
                | Error::FactorizationFailed { .. }
                | Error::NotPositiveDefinite { .. }
        ),
        "{error}"
    );
    let problem = Problem::new(&Facets::new(), &grains(grid)).unwrap();
    // One that forgets about the row sums of the contact.
    let mut forgetful = Altered::new(Bordering::default()).on_call(|inner, call| {
        call.ask(inner)?;
        if let Call::Watch { problem, nodes, schur, .. } = call {
            for (sum, &node) in schur.row_sums_mut().iter_mut().zip(*nodes) {
                *sum = problem.row_sums()[node];
            }
        }
        Ok(())
    });
    let error = updater::check(&mut forgetful, &problem).unwrap_err();
    assert!(matches!(error, Error::Updater(UpdaterError::UpdaterWrong { .. })), "{error}");
}

#[test]
fn own_surface_kernel_and_updater() {
    let grid = Grid::new(9, 11, 2e-5, 1.5e-5).unwrap();
    let kernel = grains(grid);
    let reference = path(&kernel, RecursiveCholesky::new(), 16);
    for (k, state) in reference.0.iter().enumerate().skip(1) {
        assert!(state.contact.approach > reference.0[k - 1].contact.approach, "no ties here");
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
    let (surface, kernel) = (Facets::new(), grains(grid));
    let builder = LoadingSolver::builder(&surface, &kernel);
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
