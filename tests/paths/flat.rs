//! Flat surfaces, with nothing out of contact from the beginning: what a state says of mean gap and stiffness.

use asperity::loading::{History, LoadingState};
use asperity::surface::{FlatPunch, HeightMap};
use asperity::updater::{ConjugateGradient, Dense, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boussinesq, FixedLoadSolver, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq, Spectral,
};
use nalgebra::DMatrix;

use crate::without_factor::half_spaces;

/// In full contact the mean gap is exactly 0 and the interfacial stiffness infinite, by identity: in a path with a
/// factor and without one, read from its record under a load, and under a fixed load, however few nodes there are.
/// Before, among nodes that touch together, there is a stiffness, and the mean gap is 0 as well.
#[test]
fn nothing_out_of_contact_is_no_gap_and_infinite_stiffness() {
    for (nx, ny) in [(1, 1), (1, 2), (2, 1), (2, 2), (1, 3), (3, 3), (4, 3)] {
        let grid = Grid::new(nx, ny, 1.0, 1.5).unwrap();
        let kernels: [Box<dyn InfluenceKernel>; 3] = [
            Box::new(Boussinesq::new(grid, 1.0).unwrap()),
            Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()),
            Box::new(Spectral::new(grid, 1.0).unwrap()),
        ];
        for kernel in &kernels {
            for height in [0.0, 0.3, -1e-7] {
                on_flat(&FlatPunch::new(height).unwrap(), &**kernel);
            }
        }
    }
}

fn on_flat(punch: &FlatPunch, kernel: &dyn InfluenceKernel) {
    let nodes = kernel.grid().nodes();
    let fixed = FixedLoadSolver::builder(punch, kernel).tolerance(1e-12);
    let fixed = fixed.build().unwrap().solve(1.0).unwrap().contact;
    let is_full = |found: &LoadingState| {
        let context = format!("{found:?}");
        assert_eq!(found.contact.contact_nodes, nodes, "{context}");
        assert_eq!(found.contact.mean_gap, 0.0, "{context}");
        assert_eq!(found.contact.interfacial_stiffness, Some(f64::INFINITY));
        match (found.contact.contact_stiffness, fixed.contact_stiffness) {
            (Some(found), Some(fixed)) => assert!((found / fixed - 1.0).abs() < 1e-11, "{context}"),
            (found, fixed) => assert_eq!(found, fixed, "{context}"),
        }
    };
    assert_eq!((fixed.contact_nodes, fixed.mean_gap), (nodes, 0.0));
    assert_eq!(fixed.interfacial_stiffness, Some(f64::INFINITY));
    let updaters: [Box<dyn LinearUpdater>; 4] = [
        Box::new(Dense),
        Box::new(RecursiveCholesky::new()),
        Box::new(ConjugateGradient::new()),
        Box::new(Handover::new()),
    ];
    for updater in updaters {
        let path = LoadingSolver::builder(punch, kernel).updater(updater);
        let history: History = path.build().unwrap().map(Result::unwrap).collect();
        let (last, before) = history.states().split_last().unwrap();
        for state in before {
            assert_eq!((state.contact.load, state.contact.mean_gap), (0.0, 0.0), "{state:?}");
            let stiffness = state.contact.interfacial_stiffness.unwrap();
            assert!(stiffness > 0.0 && stiffness.is_finite(), "{state:?}");
        }
        is_full(last);
        assert_eq!(last.contact.load, 0.0);
        let loaded = history.at_load(1.0).unwrap();
        is_full(&loaded);
        // On a periodic half-space both are 0 but for rounding.
        assert!((loaded.contact.approach - fixed.approach).abs() < 1e-11, "{loaded:?}");
    }
}

/// Nodes that touch at once, more of them than a window watches: stiffnesses of every contact in between are those of
/// the factor.
///
/// They are exact as long as local solutions see the whole contact, which is 144 nodes. Behind that pivots are off by
/// some 10⁻³ of themselves, and scaled so that a window of at most 180 nodes ends where its solution is: measured
/// 2.0e-4 of the stiffness. Of the last gaps the interfacial stiffness says how fast they close, which changes by its
/// own size within a window.
#[test]
fn stiffnesses_among_nodes_that_touch_at_once_are_those_of_the_factor() {
    for (n, side) in [(24, 24), (32, 20), (32, 32)] {
        let grid = Grid::square(n, 1.0).unwrap();
        let from = (n - side) / 2;
        let is_in = |i: usize| (from..from + side).contains(&i);
        let heights =
            DMatrix::from_fn(n, n, |ix, iy| if is_in(ix) && is_in(iy) { 0.0 } else { -1.0 });
        let surface = HeightMap::new(heights).unwrap();
        for (name, kernel) in half_spaces(grid) {
            let of = |updater: Box<dyn LinearUpdater>| -> Vec<LoadingState> {
                let path = LoadingSolver::builder(&surface, &*kernel).updater(updater);
                path.build().unwrap().take(side * side).map(Result::unwrap).collect()
            };
            let found = of(Box::new(ConjugateGradient::new()));
            let exact = of(Box::new(RecursiveCholesky::new()));
            let mut worst = [0.0_f64; 2];
            assert_eq!(found.len(), exact.len());
            for (found, exact) in found.iter().zip(&exact) {
                assert_eq!((found.step, found.node), (exact.step, exact.node), "{n} {name}");
                let stiffnesses = |state: &LoadingState| {
                    [state.contact.contact_stiffness, state.contact.interfacial_stiffness]
                };
                for (k, pair) in stiffnesses(found).into_iter().zip(stiffnesses(exact)).enumerate()
                {
                    match pair {
                        (Some(a), Some(b)) if b.is_finite() && b > 0.0 => {
                            let error = (a / b - 1.0).abs();
                            worst[k] = worst[k].max(error);
                            // Rates of solutions in between are solved to 1.5e-5, and their sums are better than that.
                            assert!(exact.step > 144 || error < 1e-5, "{n} {name}: {found:?}");
                        }
                        pair => assert_eq!(pair.0, pair.1, "{n} {name}"),
                    }
                }
            }
            println!("{n}, {side}, {name}: {:.1e} {:.1e}", worst[0], worst[1]);
            let most_interfacial = if side == n { 1e-2 } else { 1e-3 };
            assert!(worst[0] < 5e-4 && worst[1] < most_interfacial, "{n} {name}: {worst:?}");
        }
    }
}

/// A window that is greater than the grid is one of all its nodes.
#[test]
fn windows_of_any_size_hold_all_nodes() {
    let grid = Grid::square(16, 1.0).unwrap();
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    let flat = FlatPunch::new(0.0).unwrap();
    for window in [usize::MAX, usize::MAX / 3 + 1, 256] {
        let builder = LoadingSolver::builder(&flat, &kernel).window_size(window);
        let exact: Vec<_> = builder.clone().build().unwrap().map(Result::unwrap).collect();
        let path = builder.updater(ConjugateGradient::new()).build().unwrap();
        let found: Vec<_> = path.map(Result::unwrap).collect();
        assert_eq!([exact.len(), found.len()], [256; 2], "{window}");
    }
}

/// A flat surface at first touch carries nothing, without a factor too, when some of it has yielded since.
#[test]
fn first_touch_of_a_flat_surface_has_no_pressures() {
    let grid = Grid::new(2, 4, 1e-5, 1e-5).unwrap();
    let kernel = Boussinesq::new(grid, 1e11).unwrap();
    let map = DMatrix::from_fn(2, 4, |_, iy| if iy == 0 { 2e8 } else { f64::INFINITY });
    let flat = HeightMap::new(DMatrix::zeros(2, 4)).unwrap();
    let builder = LoadingSolver::builder(&flat, &kernel).hardness_map(&map);
    let mut path = builder.updater(ConjugateGradient::new()).build().unwrap();
    let states: Vec<LoadingState> = path.by_ref().map(Result::unwrap).collect();
    for state in states.iter().filter(|state| state.contact.load == 0.0) {
        let fields = path.fields_at(state).unwrap();
        assert_eq!(fields.pressure.amax(), 0.0, "{state:?}");
    }
}
