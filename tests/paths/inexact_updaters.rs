//! Updaters whose Schur complements are wrong: the path corrects what follows from them.

use std::collections::HashSet;

use asperity::contact::ContactSequence;
use asperity::updater::{
    ConjugateGradient, LinearUpdater, RecursiveCholesky, Schur, Solution, SolveRequest,
    UpdaterProfile, WindowFactor,
};
use asperity::{Error, Grid, LoadingSolver, Problem};

use crate::without_factor::{Tolerances, compare, half_spaces, rough, states};

/// A factor whose Schur complements are wrong, and positive definite still: diagonals by up to `4 part²`.
struct Rounded {
    part: f64,
    inner: RecursiveCholesky,
    /// The contact in the order in which it was factored: the path may settle another one afterwards.
    factored: Option<ContactSequence>,
}

impl Rounded {
    fn by(part: f64) -> Self {
        Self {
            part,
            inner: RecursiveCholesky::new(),
            factored: None,
        }
    }
}

impl LinearUpdater for Rounded {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        let contact = self.factored.as_ref().unwrap_or(contact);
        self.inner.watch(problem, contact, nodes, schur)?;
        let size = nodes.len();
        let exact = schur.matrix().into_owned();
        for j in 0..size {
            for i in j..size {
                // v vᵀ of something small, different for every node.
                let part =
                    |k: usize| self.part * (1.0 + (nodes[k] as f64).sin()) * exact[(k, k)].sqrt();
                schur.matrix_mut()[(i, j)] += part(i) * part(j);
            }
        }
        Ok(())
    }

    /// The factor must be that of the exact complement, in whatever order the path decides: it is made anew
    /// at every solution.
    fn join(&mut self, _: &Problem, _: &ContactSequence, _: &WindowFactor) -> Result<(), Error> {
        Ok(())
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let mut inner = RecursiveCholesky::new();
        let before = ContactSequence::new(problem.grid());
        let nodes = &contact.order()[..request.count];
        let mut schur = Schur::default();
        inner.watch(problem, &before, nodes, &mut schur)?;
        let positions: Vec<usize> = (0..nodes.len()).collect();
        let touched = WindowFactor::of(schur, &positions)?;
        let joined = ContactSequence::with_order(problem.grid(), nodes.iter().copied())?;
        inner.join(problem, &joined, &touched)?;
        inner.solve(problem, &joined, request, solution)?;
        if request.count == contact.len() {
            self.inner = inner;
            self.factored = Some(joined);
        }
        Ok(())
    }

    fn truncate(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
        let request = SolveRequest::exact(contact.len(), 0.0);
        self.solve(problem, contact, request, &mut Solution::default())
    }

    fn profile(&self) -> UpdaterProfile {
        UpdaterProfile {
            exact: false,
            tolerance: 1e-10,
            ..self.inner.profile()
        }
    }
}

/// The correction belongs to the path and not to conjugate gradients.
#[test]
fn any_updater_that_is_not_exact_is_corrected() {
    let grid = Grid::square(20, 1.0).unwrap();
    let surface = rough(&grid, 0.8, 7);
    for (name, kernel) in half_spaces(grid) {
        let exact = states(&surface, &kernel, RecursiveCholesky::new(), None);
        let found = states(&surface, &kernel, Rounded::by(0.03), Some(24));
        // Pivots are off by a part in a thousand between the ends of windows.
        let allowed = Tolerances {
            load: 1e-3,
            stiffness: 5e-3,
            interfacial: 0.1,
            mean_gap: 1e-4,
        };
        compare(name, &found, &exact, &allowed);
    }
}

/// Schur complements that are wrong by half let the wrong nodes join. The contact at the end of a window is
/// mended until it contradicts nothing: at least there, the nodes in contact are those of the factor.
#[test]
fn the_ends_of_windows_are_mended() {
    let grid = Grid::square(20, 1.0).unwrap();
    let surface = rough(&grid, 0.8, 7);
    let window = 24;
    for (name, kernel) in half_spaces(grid) {
        let exact = states(&surface, &kernel, RecursiveCholesky::new(), None);
        let builder = LoadingSolver::builder(&surface, &kernel).updater(Rounded::by(0.5));
        let mut path = builder.window_size(window).build().unwrap();
        let found: Vec<_> = path.by_ref().map(Result::unwrap).collect();
        assert_eq!(found.len(), exact.len());
        // Nodes in one contact and not in the other.
        let mut different = HashSet::new();
        let (mut apart, mut longest) = (0, 0);
        for (found, exact) in found.iter().zip(&exact) {
            for node in [found.node, exact.node] {
                if !different.remove(&node) {
                    different.insert(node);
                }
            }
            apart = if different.is_empty() { 0 } else { apart + 1 };
            longest = longest.max(apart);
        }
        // The window, and what overlapped outside of it.
        assert!(longest < 2 * window, "{name}: wrong for {longest} states");
        let timings = path.timings();
        for count in [timings.taken_back, timings.ties] {
            assert!((1..exact.len()).contains(&count), "{name}: {timings:?}");
        }
    }
}

#[test]
fn tolerances_that_make_no_sense_are_refused() {
    for bad in [0.0, 1.0, -1e-10, f64::NAN, f64::INFINITY] {
        let refused = ConjugateGradient::with_tolerance(bad);
        let Err(Error::OutOfRange {
            quantity: "tolerance",
            value,
            ..
        }) = refused
        else {
            panic!("{bad}: {refused:?}");
        };
        assert_eq!(value.to_bits(), bad.to_bits());
    }
    let strict = ConjugateGradient::with_tolerance(1e-13).unwrap();
    assert_eq!(strict.profile().tolerance, 1e-13);
}
