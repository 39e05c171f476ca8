//! A kernel one call of which goes wrong, for every call that the crate makes.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use asperity::kernel::KernelTable;
use asperity::surface::HeightMap;
use asperity::{
    Boundary, Boussinesq, ContactGrowth, Error, FixedLoadSolver, Grid, InfluenceKernel,
    KernelError, LoadingSolver, LoadingState, MeanDisplacement,
};
use nalgebra::DMatrix;

use super::problems::{MAKERS, Small};
use super::updater::Fault;

/// What happens at the call.
#[derive(Debug, Clone, Copy)]
enum Wrong {
    Panic,
    /// Another coefficient in place of the right one.
    Coefficient(fn(f64) -> f64),
    Grid(usize, usize),
    Boundary,
    Growth(ContactGrowth),
    Mean,
}

/// A free half-space that counts all questions and answers one of them wrong.
struct Failing {
    inner: Boussinesq,
    wrong: Wrong,
    at: usize,
    calls: Cell<usize>,
    struck: Cell<bool>,
}

impl Failing {
    fn new(wrong: Wrong, at: usize) -> Self {
        let grid = Grid::new(5, 4, 1.0, 1.0).unwrap();
        Self {
            inner: Boussinesq::new(grid, 1.0).unwrap(),
            wrong,
            at,
            calls: Cell::new(0),
            struck: Cell::new(false),
        }
    }

    fn ask<T>(&self, right: T, wrong: impl FnOnce(&T) -> Option<T>) -> T {
        let call = self.calls.get();
        self.calls.set(call + 1);
        if call != self.at {
            return right;
        }
        if let Wrong::Panic = self.wrong {
            self.struck.set(true);
            resume_unwind(Box::new(()));
        }
        match wrong(&right) {
            Some(answer) => {
                self.struck.set(true);
                answer
            }
            None => right,
        }
    }
}

impl InfluenceKernel for Failing {
    fn grid(&self) -> Grid {
        self.ask(self.inner.grid(), |_| match self.wrong {
            Wrong::Grid(nx, ny) => Some(Grid::new(nx, ny, 1.0, 1.0).unwrap()),
            _ => None,
        })
    }
    fn boundary(&self) -> Boundary {
        self.ask(self.inner.boundary(), |_| {
            matches!(self.wrong, Wrong::Boundary).then_some(Boundary::Periodic)
        })
    }
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        self.ask(self.inner.coefficient(di, dj), |value| match self.wrong {
            Wrong::Coefficient(change) => Some(change(*value)),
            _ => None,
        })
    }
    fn contact_growth(&self) -> ContactGrowth {
        self.ask(self.inner.contact_growth(), |_| match self.wrong {
            Wrong::Growth(growth) => Some(growth),
            _ => None,
        })
    }
    fn mean_displacement(&self) -> MeanDisplacement {
        self.ask(self.inner.mean_displacement(), |_| {
            matches!(self.wrong, Wrong::Mean).then_some(MeanDisplacement::Physical)
        })
    }
}

fn heights() -> HeightMap {
    let height = |ix: usize, iy: usize| (3 * ix + 5 * iy * iy) as f64;
    HeightMap::new(DMatrix::from_fn(5, 4, |ix, iy| height(ix, iy).sin())).unwrap()
}

fn states(kernel: &dyn InfluenceKernel) -> Result<Vec<LoadingState>, Error> {
    LoadingSolver::new(&heights(), kernel)?.collect()
}

const WRONGS: [Wrong; 13] = [
    Wrong::Panic,
    Wrong::Coefficient(|_| f64::NAN),
    Wrong::Coefficient(|_| f64::INFINITY),
    Wrong::Coefficient(|value| -value),
    Wrong::Coefficient(|_| 0.0),
    Wrong::Coefficient(|value| 1e300 * value),
    Wrong::Grid(4, 5),
    Wrong::Grid(3, 3),
    Wrong::Grid(40, 40),
    Wrong::Boundary,
    Wrong::Growth(ContactGrowth::Monotone),
    Wrong::Growth(ContactGrowth::Unknown),
    Wrong::Mean,
];

/// A kernel is asked while a solver is built, and never again: either the solver is refused, or it is that of the
/// kernel without the fault. Growth says what a path costs, and the mean displacement matters on periodic half-spaces
/// alone.
#[test]
fn a_wrong_answer_at_any_call_is_refused_or_changes_nothing() {
    let right = Failing::new(Wrong::Mean, usize::MAX);
    let expected = states(&right).unwrap();
    let single = |kernel: &dyn InfluenceKernel| {
        let mut solver = FixedLoadSolver::new(&heights(), kernel)?;
        solver.solve(1.0)
    };
    let load = single(&right).unwrap().contact;
    for wrong in WRONGS {
        let (mut refused, mut panicked) = (0, 0);
        for at in 0..right.calls.get() {
            let context = format!("{wrong:?}, call {at}");
            let failing = [Failing::new(wrong, at), Failing::new(wrong, at)];
            let found = catch_unwind(AssertUnwindSafe(|| states(&failing[0])));
            let found_load = catch_unwind(AssertUnwindSafe(|| single(&failing[1])));
            match (found, failing[0].struck.get()) {
                (Err(_), _) => panicked += 1,
                (Ok(Err(error)), struck) => {
                    assert!(struck, "{context}: {error}");
                    let typed = match wrong {
                        Wrong::Coefficient(_) => matches!(
                            error,
                            Error::Kernel(
                                KernelError::NotFinite { .. } | KernelError::NotSymmetric { .. }
                            ) | Error::NotPositiveDefinite { .. }
                                | Error::OutOfRange { .. }
                        ),
                        Wrong::Boundary => {
                            matches!(error, Error::Kernel(KernelError::NotPeriodic { .. }))
                        }
                        _ => matches!(error, Error::GridMismatch { .. }),
                    };
                    assert!(typed, "{context}: {error}");
                    refused += 1;
                }
                (Ok(Ok(states)), struck) => {
                    // A number in place of a coefficient is always noticed.
                    assert!(!struck || !matches!(wrong, Wrong::Coefficient(_)), "{context}");
                    for (state, expected) in states.iter().zip(&expected) {
                        // Rounding of windows and of events that are found one at a time.
                        let change = (state.contact.load - expected.contact.load).abs();
                        assert!(change <= 1e-12 * expected.contact.load, "{context}: {state:?}");
                    }
                    assert_eq!(states.len(), expected.len(), "{context}");
                }
            }
            if let Ok(Ok(solution)) = found_load {
                let change = solution.contact.approach - load.approach;
                // The tolerance of a single load.
                assert!(change.abs() <= 1e-8 * load.approach, "{context}");
            }
        }
        match wrong {
            Wrong::Panic => assert!(panicked > 60, "{panicked}"),
            Wrong::Coefficient(_) => assert_eq!(refused, 63, "{wrong:?}"),
            Wrong::Grid(..) | Wrong::Boundary => assert!(refused > 0, "{wrong:?}"),
            Wrong::Growth(_) | Wrong::Mean => assert_eq!((refused, panicked), (0, 0)),
        }
    }
}

/// Coefficients that are symmetric and negative at one distance belong to some body, which may not be positive
/// definite: an error, or the path of that very body.
#[test]
fn a_negated_distance_is_refused_or_followed() {
    let half_space = Failing::new(Wrong::Mean, usize::MAX).inner;
    let (mut refused, mut followed) = (0, 0);
    for (di, dj) in (-4..5).flat_map(|di| (0..4).map(move |dj| (di, dj))) {
        for growth in [ContactGrowth::Unknown, ContactGrowth::Monotone, ContactGrowth::Convex] {
            let coefficient = |i, j| {
                let value = half_space.coefficient(i, j);
                if (i, j) == (di, dj) || (-i, -j) == (di, dj) { -value } else { value }
            };
            let table =
                KernelTable::from_fn(half_space.grid(), Boundary::Free, growth, coefficient);
            let Ok(table) = table else {
                assert_eq!((di, dj), (0, 0));
                refused += 1;
                continue;
            };
            let gaps: Vec<f64> = heights().matrix().iter().map(|z| -z).collect();
            let small = Small::new("negated", &table, &gaps, 4);
            let maker = MAKERS[0];
            let mut path = small.path(maker, Fault::Refuse, usize::MAX).unwrap();
            let mut states = Vec::new();
            let mut failure = None;
            for item in path.by_ref() {
                match item {
                    Ok(state) => states.push(state),
                    Err(error) => failure = Some(error),
                }
            }
            // A promise of growth that is broken may be noticed at the end of a window only, by an error.
            let trusted = growth == ContactGrowth::Convex && failure.is_some();
            if !trusted && small.is_positive_definite() {
                for state in &states {
                    let violation = small.violation(state, maker);
                    assert_eq!(violation, None, "({di}, {dj}), {growth:?}");
                }
            }
            match failure {
                Some(_) => refused += 1,
                None => followed += 1,
            }
        }
    }
    assert!(refused > 10 && followed > 10, "{refused} {followed}");
}
