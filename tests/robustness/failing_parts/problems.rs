//! Small problems on which every method of an updater is called.

use asperity::kernel::KernelTable;
use asperity::loading::LoadingBuilder;
use asperity::surface::HeightMap;
use asperity::updater::{ConjugateGradient, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boundary, Boussinesq, ContactGrowth, Grid, InfluenceKernel, LoadingSolver, LoadingState,
    PeriodicBoussinesq, Problem,
};
use asperity_testing::dense::{complementary, from_first_touch, influence_matrix};
use asperity_testing::surfaces::with_gaps;
use nalgebra::{DMatrix, DVector};

use super::updater::{Failing, Fault, failing};

/// Errors of solutions by a factor, relative to approach and greatest gap: the condition numbers of these matrices are
/// below 10³, which loses three digits of sixteen.
const EXACT: f64 = 1e-12;
/// The same of paths by iterations, which say themselves how far an approach may be off and pin the rest to 10⁻⁸.
const ITERATED: f64 = 1e-8;

/// A surface on a half-space, with its dense matrix.
pub(super) struct Small {
    pub(super) name: &'static str,
    kernel: KernelTable,
    heights: HeightMap,
    gaps: Vec<f64>,
    matrix: DMatrix<f64>,
    window: usize,
}

/// A path whose updater fails once.
pub(super) type Path = LoadingSolver<Failing<Box<dyn LinearUpdater>>>;

/// What the updaters of this crate are called, and how they are made.
pub(super) type Maker = (&'static str, fn() -> Box<dyn LinearUpdater>);

pub(super) const MAKERS: [Maker; 3] = [
    ("Cholesky", || Box::new(RecursiveCholesky::new())),
    ("iterations", || Box::new(ConjugateGradient::new())),
    ("handover", || Box::new(Handover::new())),
];

impl Small {
    pub(super) fn new(
        name: &'static str,
        kernel: &dyn InfluenceKernel,
        gaps: &[f64],
        window: usize,
    ) -> Self {
        Self {
            name,
            heights: with_gaps(&kernel.grid(), gaps),
            gaps: from_first_touch(gaps),
            matrix: influence_matrix(kernel),
            kernel: KernelTable::new(kernel).unwrap(),
            window,
        }
    }

    /// One for each procedure: windows, windows whose last events are taken back, one event at a time with nodes that
    /// leave.
    pub(super) fn all() -> Vec<Self> {
        let grid = Grid::new(5, 4, 1.0, 1.0).unwrap();
        let gaps: Vec<f64> = (0..grid.nodes())
            .map(|node| 1.0 + (2.3 * node as f64 + 0.7 * (node * node) as f64).sin())
            .collect();
        let free = Boussinesq::new(grid, 1.0).unwrap();
        let periodic = PeriodicBoussinesq::new(grid, 1.0).unwrap();
        // In a window of three nodes nobody watches node 4, which node 2 raises.
        let strip = Grid::new(5, 1, 1.0, 1.0).unwrap();
        let raising = |di: isize, _| [1.0, 0.0, -0.4, 0.0, 0.0][di.unsigned_abs()];
        let raising =
            KernelTable::from_fn(strip, Boundary::Free, ContactGrowth::Monotone, raising).unwrap();
        // Positive definite, as its transform is a bell too.
        let bell = |di: isize, dj: isize| (-((di * di + dj * dj) as f64) / 2.0).exp();
        let bell =
            KernelTable::from_fn(grid, Boundary::Free, ContactGrowth::Unknown, bell).unwrap();
        // The middle of three nodes is pulled down by its neighbours more than it resists.
        let strip = Grid::new(4, 1, 1.0, 1.0).unwrap();
        let pulling = |di: isize, _| [1.0, 0.7, 0.2, 0.0][di.unsigned_abs()];
        let pulling =
            KernelTable::from_fn(strip, Boundary::Free, ContactGrowth::Unknown, pulling).unwrap();
        vec![
            Self::new("free", &free, &gaps, 3),
            Self::new("periodic", &periodic, &gaps, 4),
            Self::new("taken back", &raising, &[0.0, 5.0, 0.1, 0.95, 1.0], 3),
            Self::new("bell", &bell, &gaps, 1),
            Self::new("released", &pulling, &[0.0, 0.01, 0.2, 100.0], 1),
        ]
    }

    pub(super) fn nodes(&self) -> usize {
        self.gaps.len()
    }

    fn builder(&self) -> LoadingBuilder<'_> {
        LoadingSolver::builder(&self.heights, &self.kernel).window_size(self.window)
    }

    /// The path with a fault at a call.
    pub(super) fn path(
        &self,
        (name, make): Maker,
        fault: Fault,
        at: usize,
    ) -> Result<Path, asperity::Error> {
        let updater = failing(make(), fault, at);
        self.builder().updater(updater).hand_over(name == "handover").build()
    }

    pub(super) fn problem(&self) -> Problem {
        Problem::new(&self.heights, &self.kernel).unwrap()
    }

    /// All states of the path without a fault.
    pub(super) fn states(&self, maker: Maker) -> Vec<LoadingState> {
        let path = self.path(maker, Fault::Refuse, usize::MAX).unwrap();
        let states: Vec<LoadingState> = path.map(Result::unwrap).collect();
        assert!(states.len() >= self.nodes(), "{}", self.name);
        for state in &states {
            assert_eq!(self.violation(state, maker), None, "{}", self.name);
        }
        states
    }

    /// The approach for which gap = g + C p − δ with the coefficients as they are.
    fn own_approach(&self, state: &LoadingState) -> f64 {
        match self.kernel.boundary() {
            Boundary::Free | Boundary::PeriodicX | Boundary::PeriodicY => state.contact.approach,
            Boundary::Periodic => state.contact.approach + self.matrix.mean() * state.contact.load,
        }
    }

    /// The pressures of the contact at the approach of a state.
    pub(super) fn pressure(&self, state: &LoadingState) -> DVector<f64> {
        complementary(&self.matrix, &self.gaps, self.own_approach(state))
    }

    /// Errors of lengths that a state may have.
    pub(super) fn allowed(&self, state: &LoadingState, maker: Maker) -> f64 {
        let greatest = self.gaps.iter().copied().fold(0.0, f64::max);
        let relative = match maker.0 {
            "Cholesky" => EXACT,
            _ => ITERATED,
        };
        relative * (self.own_approach(state) + greatest) + state.approach_error
    }

    /// Whether there is one state of contact at any approach.
    pub(super) fn is_positive_definite(&self) -> bool {
        self.matrix.clone().cholesky().is_some()
    }

    /// Greatest change of a pressure with a length: the sum of all moduli of C⁻¹ bounds it.
    pub(super) fn stiffness(&self) -> f64 {
        let inverse = self.matrix.clone().try_inverse().unwrap();
        inverse.iter().map(|value| value.abs()).sum()
    }

    /// What in a state contradicts the conditions of contact at its approach.
    pub(super) fn violation(&self, state: &LoadingState, maker: Maker) -> Option<String> {
        let approach = self.own_approach(state);
        if !approach.is_finite() || approach < 0.0 {
            return Some(format!("approach {approach}"));
        }
        let pressure = self.pressure(state);
        let gap =
            &self.matrix * &pressure + DVector::from_column_slice(&self.gaps).add_scalar(-approach);
        let (length, force) = {
            let length = self.allowed(state, maker);
            (length, length * self.stiffness())
        };
        let is_off = |quantity: &str, found: f64, expected: f64, allowed: f64| {
            // NaN is off as well.
            let is_near = (found - expected).abs() <= allowed;
            (!is_near).then(|| format!("{quantity} {found}, not {expected}: {state:?}"))
        };
        let pressed = pressure.iter().filter(|p| **p > force).count();
        let closed = gap.iter().filter(|gap| **gap <= length).count();
        if !(pressed..=closed).contains(&state.contact.contact_nodes) {
            return Some(format!("{pressed} to {closed} nodes touch: {state:?}"));
        }
        is_off("load", state.contact.load, pressure.sum(), force)
            .or_else(|| is_off("mean gap", state.contact.mean_gap, gap.mean(), length))
    }
}
