//! Budgets are looked at before memory is taken: the bytes that are allocated at the peak stay within them.

use allocation_counter::{AllocationInfo, measure};
use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::loading::LoadingBuilder;
use asperity::surface::{HeightMap, Paraboloid};
use asperity::updater::{ConjugateGradient, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boussinesq, ContactGrowth, Error, FixedLoadSolver, Grid, InfluenceKernel, LoadingSolver,
    PeriodicBoussinesq, Spectral,
};
use nalgebra::DMatrix;

/// What a thread takes for the products of matrices and for a window of watched nodes, however small the problem;
/// 4.8 MB were measured.
const WORKSPACE: usize = 5 << 20;

/// What some work allocates. It is counted by thread: all the work is in one.
fn allocated(work: impl FnOnce() + Send) -> AllocationInfo {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(|| measure(work))
}

/// Bytes at the peak of some work.
fn peak(work: impl FnOnce() + Send) -> usize {
    usize::try_from(allocated(work).bytes_max).unwrap()
}

/// A budget of 1 MiB on a grid of which a single field takes 8 MiB.
#[test]
fn nothing_large_is_allocated_before_the_budget_is_looked_at() {
    const BUDGET: usize = 1 << 20;
    let grid = Grid::square(1024, 1.0).unwrap();
    let sphere = Paraboloid::new(10.0).unwrap();
    let refused = |result: Result<(), Error>| {
        let Err(Error::MemoryBudget { needed, budget, .. }) = result else {
            panic!("{result:?}");
        };
        assert!(budget == BUDGET && needed > BUDGET);
    };
    let kernels: [Box<dyn InfluenceKernel + Sync>; 3] = [
        Box::new(Boussinesq::new(grid, 1.0).unwrap()),
        Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()),
        Box::new(Spectral::new(grid, 1.0).unwrap()),
    ];
    for kernel in &kernels {
        let path = peak(|| {
            let builder = LoadingSolver::builder(&sphere, kernel).memory_budget(BUDGET);
            refused(builder.build().map(drop));
        });
        let iterations = peak(|| {
            let builder = LoadingSolver::builder(&sphere, kernel).memory_budget(BUDGET);
            refused(builder.updater(ConjugateGradient::new()).build().map(drop));
        });
        let single = peak(|| {
            let builder = FixedLoadSolver::builder(&sphere, kernel).memory_budget(BUDGET);
            refused(builder.build().map(drop));
        });
        for bytes in [path, iterations, single] {
            assert!(bytes < BUDGET, "{bytes} bytes within a budget of {BUDGET}");
        }
    }
}

/// A rough surface without ties.
fn rough(grid: &Grid) -> HeightMap {
    let (nx, ny) = grid.shape();
    HeightMap::new(DMatrix::from_fn(nx, ny, |ix, iy| {
        let (x, y) = (ix as f64, iy as f64);
        (0.31 * x + 0.2 * y).sin() + (0.17 * y - 0.05 * x).cos() + 0.3 * (0.9 * x * y).sin()
    }))
    .unwrap()
}

/// Follows a path until it ends or the budget does: the number of its states.
fn follow<U: LinearUpdater>(builder: LoadingBuilder<'_, U>, budget: usize) -> Option<usize> {
    let mut path = match builder.memory_budget(budget).build() {
        Ok(path) => path,
        Err(Error::MemoryBudget { .. }) => return None,
        Err(error) => panic!("{error}"),
    };
    let mut count = 0;
    for state in path.by_ref() {
        match state {
            Ok(_) => count += 1,
            Err(Error::MemoryBudget { .. }) => break,
            Err(error) => panic!("{error}"),
        }
    }
    Some(count)
}

fn grids() -> [Grid; 3] {
    [(48, 48), (30, 80), (400, 4)].map(|(nx, ny)| Grid::new(nx, ny, 1.0, 1.0).unwrap())
}

/// Whatever the budget, a path with any updater stays within it, from before its first node to its end.
#[test]
fn paths_stay_within_their_budget() {
    let mut partial = 0;
    for grid in grids() {
        let map = rough(&grid);
        let kernels: [Box<dyn InfluenceKernel + Sync>; 2] = [
            Box::new(Boussinesq::new(grid, 1.0).unwrap()),
            Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()),
        ];
        for kernel in &kernels {
            for budget in [1, 2, 3, 4, 6, 8, 12, 20, 40].map(|megabytes| megabytes << 19) {
                let builder = || LoadingSolver::builder(&map, kernel).max_nodes(900);
                let mut counts = [None; 3];
                let peaks = [
                    peak(|| {
                        counts[0] = follow(builder().updater(RecursiveCholesky::new()), budget)
                    }),
                    peak(|| {
                        counts[1] = follow(builder().updater(ConjugateGradient::new()), budget)
                    }),
                    peak(|| counts[2] = follow(builder().updater(Handover::new()), budget)),
                ];
                for bytes in peaks {
                    assert!(
                        bytes <= budget + WORKSPACE,
                        "{bytes} bytes within a budget of {budget}"
                    );
                }
                partial += counts.iter().filter(|c| c.is_some_and(|c| c > 0 && c < 900)).count();
            }
        }
    }
    assert!(partial > 5, "{partial}");
}

/// So do paths on which nodes yield, and paths on which nodes leave.
#[test]
fn paths_on_which_nodes_yield_or_leave_stay_within_their_budget() {
    let mut partial = 0;
    for grid in grids() {
        let map = rough(&grid);
        let free = Boussinesq::new(grid, 1.0).unwrap();
        let coat = Layer { youngs_modulus: 100.0, poissons_ratio: 0.3, thickness: 6.0 };
        let base = Base::HalfSpace { youngs_modulus: 1.0, poissons_ratio: 0.3 };
        let body = LayeredBody::new(&[coat], base).unwrap();
        let coated = Layered::free(grid, body).unwrap();
        assert_eq!(coated.contact_growth(), ContactGrowth::Unknown);
        for budget in [1, 2, 3, 4, 6, 8, 12, 20].map(|megabytes| megabytes << 19) {
            let yielding = || LoadingSolver::builder(&map, &free).hardness(0.05).max_nodes(900);
            let leaving = || LoadingSolver::builder(&map, &coated).max_nodes(900);
            let mut counts = [None; 4];
            let peaks = [
                peak(|| counts[0] = follow(yielding().updater(RecursiveCholesky::new()), budget)),
                peak(|| counts[1] = follow(yielding().updater(Handover::new()), budget)),
                peak(|| counts[2] = follow(leaving().updater(RecursiveCholesky::new()), budget)),
                peak(|| counts[3] = follow(leaving().updater(Handover::new()), budget)),
            ];
            for bytes in peaks {
                assert!(bytes <= budget + WORKSPACE, "{bytes} bytes within a budget of {budget}");
            }
            partial += counts.iter().filter(|c| c.is_some_and(|c| c > 0 && c < 900)).count();
        }
    }
    assert!(partial > 5, "{partial}");
}

/// The same of single loads, up to full contact, and on grids so thin that working memory is most of it.
#[test]
fn single_loads_stay_within_their_budget() {
    let mut partial = 0;
    let larger = [(200, 200, 20), (40, 900, 40), (1, 9000, 20), (3000, 4, 30)]
        .map(|(nx, ny, megabytes)| (Grid::new(nx, ny, 1.0, 1.0).unwrap(), megabytes));
    for (grid, megabytes) in grids().map(|grid| (grid, 1)).into_iter().chain(larger) {
        let map = rough(&grid);
        let kernels: [Box<dyn InfluenceKernel + Sync>; 2] = [
            Box::new(Boussinesq::new(grid, 1.0).unwrap()),
            Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()),
        ];
        for kernel in &kernels {
            for tenths in [5, 8, 10, 12, 14, 20] {
                let budget = (megabytes << 20) * tenths / 10;
                let mut solved = 0;
                let bytes = peak(|| {
                    let builder = FixedLoadSolver::builder(&map, kernel).memory_budget(budget);
                    let Ok(mut solver) = builder.build() else {
                        return;
                    };
                    for load in [1.0, 1e7] {
                        match solver.solve(load) {
                            Ok(_) => solved += 1,
                            Err(Error::MemoryBudget { .. }) => {}
                            Err(error) => panic!("{error}"),
                        }
                    }
                });
                let shape = grid.shape();
                assert!(
                    bytes <= budget,
                    "{bytes} bytes within a budget of {budget} on {shape:?}, {solved} loads"
                );
                partial += usize::from(solved == 1);
            }
        }
    }
    assert!(partial > 2, "{partial}");
}

/// What a solver says that it holds has been allocated and not given back, before its first load and behind it.
#[test]
fn single_loads_tell_what_they_hold() {
    for (nx, ny) in [(200, 200), (40, 900)] {
        let grid = Grid::new(nx, ny, 1.0, 1.0).unwrap();
        let map = rough(&grid);
        let kernels: [Box<dyn InfluenceKernel + Sync>; 2] = [
            Box::new(Boussinesq::new(grid, 1.0).unwrap()),
            Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()),
        ];
        for kernel in &kernels {
            let mut made = None;
            let built = allocated(|| made = Some(FixedLoadSolver::new(&map, kernel).unwrap()));
            let mut solver = made.unwrap();
            let is_told = |told: usize, held: i64| {
                // Plans, and what lists have room for beyond their length, are not counted.
                let ratio = told as f64 / held as f64;
                assert!((ratio - 1.0).abs() < 0.25, "{nx} x {ny}: {told} of {held} bytes");
            };
            is_told(solver.bytes(), built.bytes_current);
            let solved = allocated(|| drop(solver.solve(1e3).unwrap()));
            is_told(solver.bytes(), built.bytes_current + solved.bytes_current);
        }
    }
}
