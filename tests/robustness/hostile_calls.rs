//! User-defined parts that contradict themselves, and calls in an order that no path makes: errors or
//! nonsense, and never a panic.

use std::cell::Cell;

use asperity::contact::ContactSequence;
use asperity::convolution::{Convolution, direct_sum};
use asperity::kernel::{self, KernelTable};
use asperity::surface::{HeightMap, Paraboloid};
use asperity::updater::{
    ConjugateGradient, Dense, Handover, Left, LinearUpdater, RecursiveCholesky, Schur, Solution,
    WindowFactor,
};
use asperity::{
    Boundary, Boussinesq, ContactGrowth, FixedLoadSolver, Grid, InfluenceKernel, LoadingSolver,
    LoadingState, PeriodicBoussinesq, Problem, Spectral,
};
use nalgebra::DMatrix;
use proptest::prelude::*;

/// A kernel that lives on another grid whenever it is asked.
struct Restless {
    asked: Cell<usize>,
    grids: [Grid; 2],
    boundaries: [Boundary; 2],
}

impl Restless {
    fn new(first: usize) -> Self {
        Self {
            asked: Cell::new(first),
            grids: [(3, 7), (8, 2)].map(|(nx, ny)| Grid::new(nx, ny, 1.0, 1.0).unwrap()),
            boundaries: [Boundary::Free, Boundary::Periodic],
        }
    }

    fn turn(&self) -> usize {
        self.asked.set(self.asked.get() + 1);
        self.asked.get() % 2
    }
}

impl InfluenceKernel for Restless {
    fn grid(&self) -> Grid {
        self.grids[self.turn()]
    }

    fn boundary(&self) -> Boundary {
        self.boundaries[self.turn()]
    }

    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        if (di, dj) == (0, 0) { 1.0 } else { 0.0 }
    }

    fn contact_growth(&self) -> ContactGrowth {
        [ContactGrowth::Convex, ContactGrowth::Unknown][self.turn()]
    }
}

#[test]
fn kernels_that_change_their_grid() {
    for first in 0..2 {
        let restless = || Restless::new(first);
        let sphere = Paraboloid::new(10.0).unwrap();
        for shape in [(3, 7), (8, 2)] {
            // Whichever grid counts, it does so throughout.
            let pressure = DMatrix::from_element(shape.0, shape.1, 2.0);
            if let Ok(u) = direct_sum(&restless(), &pressure) {
                assert_eq!(u, pressure);
            }
        }
        assert!(KernelTable::new(&restless()).is_ok());
        assert!(Convolution::new(&restless()).is_ok());
        let _ = kernel::check(&restless());
        assert!(Problem::new(&sphere, &restless()).is_ok());
        if let Ok(path) = LoadingSolver::new(&sphere, &restless()) {
            for state in path {
                let _ = state;
            }
        }
        if let Ok(mut solver) = FixedLoadSolver::new(&sphere, &restless()) {
            let _ = solver.solve(1.0);
        }
    }
}

#[test]
fn offsets_and_nodes_that_are_none() {
    let grid = Grid::new(5, 4, 1.0, 2.0).unwrap();
    let kernels: [&dyn InfluenceKernel; 3] = [
        &Boussinesq::new(grid, 1.0).unwrap(),
        &PeriodicBoussinesq::new(grid, 1.0).unwrap(),
        &Spectral::new(grid, 1.0).unwrap(),
    ];
    let extreme = [isize::MIN, isize::MIN + 1, -1, 0, 1, isize::MAX];
    for kernel in kernels {
        let table = KernelTable::new(kernel).unwrap();
        for (di, dj) in extreme.into_iter().flat_map(|i| extreme.map(|j| (i, j))) {
            assert!(kernel.coefficient(di, dj).is_finite(), "{di} {dj}");
            let is_between = di.unsigned_abs() < 5 && dj.unsigned_abs() < 4;
            assert_eq!(table.coefficient(di, dj).is_some(), is_between);
        }
    }
    for far in [5, usize::MAX - 1, usize::MAX] {
        assert_eq!(grid.node(far, 0), None);
        assert_eq!(grid.node(0, far), None);
        assert_eq!(grid.node(far, far), None);
    }
    let problem = Problem::new(&Paraboloid::new(1.0).unwrap(), kernels[0]).unwrap();
    assert_eq!(problem.coefficient(0, usize::MAX), None);
    assert!(problem.coefficient(19, 0).is_some());
}

/// What is asked of an updater.
#[derive(Debug, Clone)]
enum Call {
    Watch(usize, Vec<usize>),
    Join(usize, Vec<usize>, usize),
    Solve(usize, usize, f64),
    Truncate(usize, usize),
    Release(usize, usize, usize),
    WatchBoth(usize, Vec<usize>, Vec<usize>),
    /// The contact changes, and the updater is not told.
    Push(usize),
    Remove(usize),
    MakeRoom(usize, usize),
}

fn node() -> impl Strategy<Value = usize> {
    prop_oneof![9 => 0_usize..14, 1 => Just(usize::MAX)]
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => 0.0..3.0,
        1 => prop::sample::select(vec![f64::NAN, f64::INFINITY, -1.0, 1e300, 0.0]),
    ]
}

fn call() -> impl Strategy<Value = Call> {
    // Of the two problems the first, mostly.
    let which = || prop_oneof![6 => Just(0_usize), 1 => Just(1_usize)];
    let nodes = || prop::collection::vec(node(), 0..5);
    prop_oneof![
        4 => (which(), nodes()).prop_map(|(p, nodes)| Call::Watch(p, nodes)),
        4 => (which(), prop::collection::vec(0_usize..5, 0..4), 0_usize..6)
            .prop_map(|(p, positions, size)| Call::Join(p, positions, size)),
        3 => (which(), 0_usize..8, number()).prop_map(|(p, n, a)| Call::Solve(p, n, a)),
        1 => (which(), 0_usize..6).prop_map(|(p, n)| Call::Truncate(p, n)),
        1 => (which(), node(), 0_usize..6).prop_map(|(p, n, at)| Call::Release(p, n, at)),
        1 => (which(), prop::collection::vec(node(), 0..4), prop::collection::vec(0_usize..6, 0..4))
            .prop_map(|(p, nodes, positions)| Call::WatchBoth(p, nodes, positions)),
        1 => node().prop_map(Call::Push),
        1 => node().prop_map(Call::Remove),
        1 => (which(), 0_usize..3_000_000).prop_map(|(p, bytes)| Call::MakeRoom(p, bytes)),
    ]
}

/// Edits the order of a contact, unless it is then no order of one.
fn edit(contact: &mut ContactSequence, edit: impl FnOnce(&mut Vec<usize>)) {
    let mut order = contact.order().to_vec();
    edit(&mut order);
    if let Ok(edited) = ContactSequence::with_order(contact.grid(), order) {
        *contact = edited;
    }
}

/// Makes the calls, with a contact on the larger grid; the answers do not matter.
fn make_calls(updater: &mut dyn LinearUpdater, problems: &[Problem; 2], calls: &[Call]) {
    let mut contact = ContactSequence::new(problems[0].grid());
    let mut watched: Vec<usize> = Vec::new();
    let mut schur = Schur::default();
    for call in calls {
        match call {
            Call::Watch(p, nodes) => {
                watched.clone_from(nodes);
                let _ = updater.watch(&problems[*p], &contact, nodes, &mut schur);
                let _ = updater.relief(&problems[*p], &contact, &nodes[nodes.len() / 2..]);
            }
            Call::Join(p, positions, size) => {
                // Of the last window, or of one that has never been.
                let own = *size == watched.len();
                let mut other = Schur::default();
                other.resize(*size).unwrap();
                other.matrix_mut().fill_with_identity();
                let given = if own { schur.clone() } else { other };
                let Ok(touched) = WindowFactor::of(given, positions) else {
                    continue;
                };
                for &position in positions {
                    let node = watched.get(position).copied().unwrap_or(position);
                    edit(&mut contact, |order| order.push(node));
                }
                let _ = updater.join(&problems[*p], &contact, &touched);
            }
            Call::Solve(p, count, approach) => {
                let mut solution = Solution::default();
                let _ = updater.solve(&problems[*p], &contact, *count, *approach, &mut solution);
            }
            Call::Truncate(p, count) => {
                edit(&mut contact, |order| order.truncate(*count));
                let _ = updater.truncate(&problems[*p], &contact);
            }
            Call::Release(p, node, position) => {
                let _ = updater.release(
                    &problems[*p],
                    &contact,
                    &[Left { node: *node, position: *position }],
                );
            }
            Call::WatchBoth(p, nodes, positions) => {
                let mut schur = Schur::default();
                let updated =
                    updater.watch_both(&problems[*p], &contact, nodes, positions, &mut schur);
                let mut rhs = vec![[1.0, 2.0]; contact.len() + positions.len() % 2];
                let _ = (updated, updater.solve_for(&problems[*p], &contact, &mut rhs));
                let _ = updater.relief(&problems[*p], &contact, nodes);
            }
            Call::Push(node) => {
                edit(&mut contact, |order| order.push(*node));
            }
            Call::Remove(node) => {
                edit(&mut contact, |order| order.retain(|other| other != node));
            }
            Call::MakeRoom(p, bytes) => {
                let _ = updater.make_room(&problems[*p], *bytes);
            }
        }
        let _ = updater.bytes(usize::MAX, usize::MAX);
    }
}

/// Iterations that have solved on one kernel answer on another as new ones do, alone and on a path.
#[test]
fn iterations_forget_another_kernel() {
    let heights = DMatrix::from_fn(7, 5, |ix, iy| ((3 * ix + 5 * iy) as f64).sin());
    let surface = HeightMap::new(heights).unwrap();
    let kernels = [1.0, 2.0].map(|e_star| {
        Boussinesq::new(Grid::new(7, 5, 1.0 / e_star, 1.0).unwrap(), e_star).unwrap()
    });
    let problems = kernels.each_ref().map(|kernel| Problem::new(&surface, kernel).unwrap());
    let solve = |updater: &mut ConjugateGradient, problem: &Problem| -> Vec<f64> {
        let contact = ContactSequence::with_order(problem.grid(), [3, 11, 17, 24]).unwrap();
        let mut solution = Solution::default();
        updater.solve(problem, &contact, 4, 3.0, &mut solution).unwrap();
        solution.pressure
    };
    let mut used = ConjugateGradient::new();
    let first = solve(&mut used, &problems[0]);
    let second = solve(&mut used, &problems[1]);
    assert_eq!(second, solve(&mut ConjugateGradient::new(), &problems[1]));
    assert!(first != second);
    let path = |updater: ConjugateGradient| -> Vec<LoadingState> {
        let builder = LoadingSolver::builder(&surface, &kernels[0]).updater(updater);
        builder.build().unwrap().map(Result::unwrap).collect()
    };
    assert_eq!(path(used), path(ConjugateGradient::new()));
}

fn problems() -> [Problem; 2] {
    [(4, 3), (3, 2)].map(|(nx, ny)| {
        let kernel = Boussinesq::new(Grid::new(nx, ny, 1.0, 1.0).unwrap(), 1.0).unwrap();
        let heights = DMatrix::from_fn(nx, ny, |ix, iy| ((3 * ix + 5 * iy) as f64).sin());
        Problem::new(&HeightMap::new(heights).unwrap(), &kernel).unwrap()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn no_order_of_calls_makes_an_updater_panic(calls in prop::collection::vec(call(), 1..25)) {
        let problems = problems();
        make_calls(&mut RecursiveCholesky::new(), &problems, &calls);
        make_calls(&mut ConjugateGradient::new(), &problems, &calls);
        make_calls(&mut Handover::new(), &problems, &calls);
        make_calls(&mut Dense, &problems, &calls);
    }
}
