//! Updaters that skip calls, or answer them for another contact: an error or nonsense, and never a panic.

use asperity::contact::ContactSequence;
use asperity::surface::HeightMap;
use asperity::updater::{
    ConjugateGradient, LinearUpdater, RecursiveCholesky, Schur, Solution, WindowCost, WindowFactor,
};
use asperity::{Boussinesq, Grid, InfluenceKernel, LoadingSolver, Problem, Spectral};
use nalgebra::DMatrix;

/// An updater that skips every n-th call of a kind, or answers it for another contact.
struct Lying {
    inner: Box<dyn LinearUpdater>,
    what: &'static str,
    calls: usize,
    turn: usize,
}

impl Lying {
    fn lies(&mut self, what: &str) -> bool {
        if self.what != what {
            return false;
        }
        self.calls += 1;
        self.calls.is_multiple_of(self.turn)
    }
}

impl LinearUpdater for Lying {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), asperity::Error> {
        if self.lies("watch others") {
            let all = 0..problem.grid().nodes();
            let others: Vec<usize> = all.rev().take(nodes.len()).collect();
            return self.inner.watch(problem, contact, &others, schur);
        }
        if self.lies("watch nothing") {
            return schur.resize(nodes.len());
        }
        self.inner.watch(problem, contact, nodes, schur)?;
        if self.lies("huge complement") {
            schur.matrix_mut().fill(f64::MAX);
        }
        if self.lies("negative complement") {
            schur.matrix_mut().fill(-1.0);
        }
        if self.lies("infinite sums") {
            schur.row_sums_mut().fill(f64::INFINITY);
        }
        Ok(())
    }

    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        touched: &WindowFactor,
    ) -> Result<(), asperity::Error> {
        if self.lies("join nothing") {
            return Ok(());
        }
        self.inner.join(problem, contact, touched)
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), asperity::Error> {
        self.inner.solve(problem, contact, count, approach, solution)?;
        for (what, value) in [
            ("NaN pressure", f64::NAN),
            ("infinite pressure", f64::INFINITY),
            ("no pressure", 0.0),
            ("negative pressure", -1.0),
        ] {
            if self.lies(what) {
                solution.pressure.fill(value);
            }
        }
        for (what, value) in [
            ("NaN rate", f64::NAN),
            ("infinite rate", f64::INFINITY),
            ("no rate", 0.0),
            ("negative rate", -1.0),
        ] {
            if self.lies(what) {
                solution.rate.fill(value);
            }
        }
        Ok(())
    }

    fn truncate(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
    ) -> Result<(), asperity::Error> {
        if self.lies("truncate nothing") {
            return Ok(());
        }
        self.inner.truncate(problem, contact)
    }

    fn release(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        node: usize,
        position: usize,
    ) -> Result<(), asperity::Error> {
        if self.lies("release nothing") {
            return Ok(());
        }
        self.inner.release(problem, contact, node, position)
    }

    fn window_cost(&self) -> WindowCost {
        let mut cost = self.inner.window_cost();
        match self.what {
            "multiple" => cost.multiple = usize::MAX,
            "NaN cost" => cost.solve = f64::NAN,
            _ => (),
        }
        cost
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        match self.what {
            "all memory" => usize::MAX,
            _ => self.inner.bytes(contact, watched),
        }
    }
}

const LIES: [&str; 19] = [
    "watch others",
    "watch nothing",
    "huge complement",
    "negative complement",
    "infinite sums",
    "join nothing",
    "NaN pressure",
    "infinite pressure",
    "no pressure",
    "negative pressure",
    "NaN rate",
    "infinite rate",
    "no rate",
    "negative rate",
    "truncate nothing",
    "release nothing",
    "multiple",
    "NaN cost",
    "all memory",
];

/// A path with such an updater comes to an end, and delivers no state that is not finite.
#[test]
fn lying_updaters() {
    let grid = Grid::new(6, 5, 1.0, 1.0).unwrap();
    let heights = DMatrix::from_fn(6, 5, |ix, iy| ((3 * ix + 5 * iy * iy) as f64).sin());
    let rough = HeightMap::new(heights).unwrap();
    let kernels: [&dyn InfluenceKernel; 2] =
        [&Boussinesq::new(grid, 1.0).unwrap(), &Spectral::new(grid, 1.0).unwrap()];
    for kernel in kernels {
        for what in LIES {
            for turn in 1..4 {
                for exact in [true, false] {
                    let inner: Box<dyn LinearUpdater> = if exact {
                        Box::new(RecursiveCholesky::new())
                    } else {
                        Box::new(ConjugateGradient::new())
                    };
                    let updater = Lying { inner, what, calls: 0, turn };
                    let builder = LoadingSolver::builder(&rough, kernel).updater(updater);
                    let Ok(mut path) = builder.window_size(4).build() else {
                        continue;
                    };
                    let mut count = 0;
                    while let Some(item) = path.next() {
                        count += 1;
                        assert!(count < 1000, "{what} has no end");
                        let Ok(state) = item else { continue };
                        for value in [
                            state.contact.approach,
                            state.contact.load,
                            state.contact.mean_gap,
                            state.contact.energy,
                        ] {
                            assert!(value.is_finite(), "{what}: {state:?}");
                        }
                        let _ = (path.pressure(), path.gap(), path.certificate());
                    }
                }
            }
        }
    }
}
