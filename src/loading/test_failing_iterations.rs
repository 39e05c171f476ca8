//! Iterations that work, but for one call: at the k-th call an error, a panic or a wrong answer, for every k of a small
//! path.
//!
//! The oracle of what was yielded before is the same path without a fault, bit for bit. What is yielded after a wrong
//! answer is compared with a solver of the linear complementarity problem that knows nothing of paths.

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex};

use nalgebra::{DMatrix, DVector};

use super::test_complementary::{complementary, from_first_touch};
use crate::contact::ContactSequence;
use crate::kernel::KernelTable;
use crate::loading::phase::Phase;
use crate::loading::{LoadingEnd, LoadingPath};
use crate::surface::HeightMap;
use crate::updater::{
    Behind, Beside, ConjugateGradient, Iterations, Proposal, Schur, Solution, Solved,
};
use crate::{
    Boundary, Boussinesq, ContactGrowth, ContactState, Error, Grid, InfluenceKernel, LoadingSolver,
    LoadingState, PeriodicBoussinesq, Problem,
};

/// What happens at the call.
#[derive(Debug, Clone, Copy)]
enum Fault {
    Refuse,
    /// A panic before the iterations are asked.
    PanicBefore,
    /// A panic once they have answered.
    PanicAfter,
    /// The call is not passed on.
    Forget,
    /// Another value in place of every number of an answer.
    Each(Part, fn(f64) -> f64),
    /// The same in place of the last number only.
    Last(Part, fn(f64) -> f64),
    /// Answers for so many nodes more or fewer.
    Length(isize),
    /// Another tolerance than the true one, at all calls.
    Tolerance(f64),
}

/// Numbers of an answer.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    Pressure,
    Rate,
    /// Displacements of all nodes.
    Field,
    Schur,
    RowSums,
    /// Displacements of proposed nodes.
    Proposed,
}

/// The error of [`Fault::Refuse`], which no part of the crate makes.
const REFUSED: Error = Error::FactorizationFailed { nodes: 123_456_789 };

fn is_refusal(error: &Error) -> bool {
    matches!(error, Error::FactorizationFailed { nodes: 123_456_789 })
}

/// Counts all calls and spoils one.
#[derive(Debug)]
struct Strike {
    fault: Fault,
    /// Which call it is, from 0.
    at: AtomicUsize,
    calls: AtomicUsize,
    /// The method that the fault struck.
    struck: Mutex<Option<&'static str>>,
}

impl Strike {
    fn new(fault: Fault, at: usize) -> Arc<Self> {
        let (at, calls, struck) = (AtomicUsize::new(at), AtomicUsize::new(0), Mutex::new(None));
        Arc::new(Self { fault, at, calls, struck })
    }

    fn struck(&self) -> Option<&'static str> {
        *self.struck.lock().unwrap()
    }

    /// Does `work` unless this is the call. Returns the fault if its answer is to be spoilt.
    fn call<T: Default>(
        &self,
        method: &'static str,
        work: impl FnOnce() -> Result<T, Error>,
    ) -> Result<(T, Option<Fault>), Error> {
        let call = self.calls.fetch_add(1, Relaxed);
        let advances = method.starts_with("advance");
        let solves = advances || ["probe", "solve_apart"].contains(&method);
        let proposes = method.starts_with("propose");
        let possible = match self.fault {
            Fault::Forget => method == "cut",
            Fault::Each(part, _) | Fault::Last(part, _) => match part {
                Part::Schur | Part::RowSums | Part::Proposed => proposes,
                Part::Pressure => solves,
                Part::Rate => solves && method != "probe",
                Part::Field => solves && method != "solve_apart",
            },
            Fault::Length(_) => solves || proposes,
            Fault::Tolerance(_) => false,
            _ => true,
        };
        if !possible || call != self.at.load(Relaxed) {
            return work().map(|answer| (answer, None));
        }
        *self.struck.lock().unwrap() = Some(method);
        match self.fault {
            Fault::Refuse => Err(REFUSED),
            Fault::Forget => Ok((T::default(), None)),
            // Without the hook that prints a message.
            Fault::PanicBefore => resume_unwind(Box::new(())),
            Fault::PanicAfter => {
                let _ = work();
                resume_unwind(Box::new(()))
            }
            fault => work().map(|answer| (answer, Some(fault))),
        }
    }
}

impl Fault {
    /// Spoils numbers of a kind.
    fn spoil(self, part: Part, values: &mut Vec<f64>) {
        match self {
            Self::Each(of, change) if of == part => values.iter_mut().for_each(|x| *x = change(*x)),
            Self::Last(of, change) if of == part => {
                values.iter_mut().rev().take(1).for_each(|x| *x = change(*x));
            }
            Self::Length(more) => {
                let length = values.len().saturating_add_signed(more);
                values.resize(length, 1.0);
            }
            _ => {}
        }
    }

    fn spoil_solved(self, solved: &mut Solved) {
        self.spoil(Part::Pressure, &mut solved.solution.pressure);
        self.spoil(Part::Rate, &mut solved.solution.rate);
        for field in &mut solved.displacement {
            self.spoil(Part::Field, field);
        }
    }

    fn spoil_proposal(self, schur: &mut Schur, known: &mut Vec<[f64; 2]>) {
        let size = schur.size();
        match self {
            Self::Length(more) => {
                // What is in it is unspecified.
                let _ = schur.resize(size.saturating_add_signed(more));
                schur.matrix_mut().fill_with_identity();
                let length = known.len().saturating_add_signed(more);
                known.resize(length, [1.0; 2]);
            }
            Self::Each(Part::Schur, change) => schur.matrix_mut().apply(|x| *x = change(*x)),
            Self::Last(Part::Schur, change) if size > 0 => {
                let mut matrix = schur.matrix_mut();
                for k in 0..size {
                    matrix[(size - 1, k)] = change(matrix[(size - 1, k)]);
                }
            }
            Self::Each(Part::RowSums, _) | Self::Last(Part::RowSums, _) => {
                let mut sums = schur.row_sums_mut().to_vec();
                self.spoil(Part::RowSums, &mut sums);
                schur.row_sums_mut().copy_from_slice(&sums);
            }
            Self::Each(Part::Proposed, change) => {
                known.as_flattened_mut().iter_mut().for_each(|x| *x = change(*x));
            }
            Self::Last(Part::Proposed, change) => {
                known.iter_mut().rev().take(1).for_each(|pair| *pair = pair.map(change));
            }
            _ => {}
        }
    }
}

/// Conjugate gradients that go wrong at one call.
#[derive(Debug)]
struct Failing {
    inner: ConjugateGradient,
    /// Whether all Schur complements are wrong: then windows are taken back.
    misleads: bool,
    strike: Arc<Strike>,
}

impl Iterations for Failing {
    fn tolerance(&self) -> f64 {
        match self.strike.fault {
            Fault::Tolerance(tolerance) => tolerance,
            _ => self.inner.tolerance(),
        }
    }

    fn take_over(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        approach: f64,
        solution: &Solution,
    ) -> Result<(), Error> {
        self.inner.take_over(problem, contact, approach, solution)
    }

    fn propose(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: [&[usize]; 2],
        beside: Option<&Beside<'_>>,
        schur: &mut Schur,
    ) -> Result<Proposal, Error> {
        let Self { inner, strike, .. } = self;
        let work = || inner.propose(problem, contact, nodes, beside, schur);
        let method = if beside.is_some() { "propose beside yielded nodes" } else { "propose" };
        let (mut proposal, fault) = strike.call(method, work)?;
        if self.misleads {
            for (k, &node) in nodes[0].iter().chain(nodes[1]).enumerate() {
                schur.matrix_mut()[(k, k)] *= 1.5 + libm::sin(node as f64);
            }
        }
        if let Some(fault) = fault {
            fault.spoil_proposal(schur, &mut proposal.lines);
            let sums = proposal.sums.as_flattened_mut();
            match fault {
                Fault::Each(Part::RowSums, change) => sums.iter_mut().for_each(|x| *x = change(*x)),
                Fault::Last(Part::RowSums, change) => {
                    sums.iter_mut().rev().take(1).for_each(|x| *x = change(*x));
                }
                _ => {}
            }
        }
        Ok(proposal)
    }

    fn advance(
        &mut self,
        behind: &Behind<'_>,
        span: f64,
        solved: &mut Solved,
    ) -> Result<(), Error> {
        let Self { inner, strike, .. } = self;
        let method = if behind.yielded.is_empty() { "advance" } else { "advance behind yields" };
        let work = || inner.advance(behind, span, solved);
        if let ((), Some(fault)) = strike.call(method, work)? {
            fault.spoil_solved(solved);
        }
        Ok(())
    }

    fn probe(&mut self, behind: &Behind<'_>, error: f64) -> Result<Solved, Error> {
        let Self { inner, strike, .. } = self;
        let (mut solved, fault) = strike.call("probe", || inner.probe(behind, error))?;
        if let Some(fault) = fault {
            fault.spoil_solved(&mut solved);
        }
        Ok(solved)
    }

    fn solve_apart(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let Self { inner, strike, .. } = self;
        let work = || Iterations::solve_apart(inner, problem, contact, count, approach, solution);
        if let ((), Some(fault)) = strike.call("solve_apart", work)? {
            fault.spoil(Part::Pressure, &mut solution.pressure);
            fault.spoil(Part::Rate, &mut solution.rate);
        }
        Ok(())
    }

    fn cut(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
        let Self { inner, strike, .. } = self;
        strike.call("cut", || inner.cut(problem, contact)).map(drop)
    }

    fn bytes(&self, nodes: usize, contact: usize) -> usize {
        Iterations::bytes(&self.inner, nodes, contact)
    }

    fn check_cells(&self, problem: &Problem) -> Result<(), Error> {
        self.inner.check_cells(problem)
    }
}

/// A surface on a half-space, with its dense matrix.
struct Small {
    name: &'static str,
    kernel: KernelTable,
    heights: HeightMap,
    gaps: Vec<f64>,
    matrix: DMatrix<f64>,
    window: usize,
    hardness: Option<f64>,
    /// See [`Failing::misleads`].
    misleads: bool,
}

impl Small {
    fn new(
        name: &'static str,
        kernel: &dyn InfluenceKernel,
        gaps: &[f64],
        window: usize,
    ) -> Result<Self, Error> {
        let grid = kernel.grid();
        let (nx, ny) = grid.shape();
        let offset = |a: usize, b: usize| a as isize - b as isize;
        Ok(Self {
            name,
            heights: HeightMap::new(DMatrix::from_fn(nx, ny, |ix, iy| -gaps[ix + nx * iy]))?,
            gaps: from_first_touch(gaps),
            matrix: DMatrix::from_fn(nx * ny, nx * ny, |i, j| {
                let ((ix, iy), (jx, jy)) = (grid.coordinates(i), grid.coordinates(j));
                kernel.coefficient(offset(ix, jx), offset(iy, jy))
            }),
            kernel: KernelTable::new(kernel)?,
            window,
            hardness: None,
            misleads: false,
        })
    }

    /// With a hardness and without: windows on a free and on a periodic body, near ties, and windows that are taken
    /// back; without, one event at a time, and nodes that leave.
    fn all() -> Result<Vec<Self>, Error> {
        let grid = Grid::new(5, 4, 1.0, 1.0)?;
        let gaps: Vec<f64> = (0..grid.nodes())
            .map(|node| 1.0 + (2.3 * node as f64 + 0.7 * (node * node) as f64).sin())
            .collect();
        // Pairs of gaps that the error of a window does not tell apart.
        let near: Vec<f64> = gaps.iter().zip(0..).map(|(gap, k)| gap + 1e-9 * k as f64).collect();
        let near: Vec<f64> = (0..grid.nodes())
            .map(|node| near[node - node % 2] + 1e-7 * (node % 2) as f64)
            .collect();
        let free = Boussinesq::new(grid, 1.0)?;
        let periodic = PeriodicBoussinesq::new(grid, 1.0)?;
        // Positive definite, as its transform is a bell too.
        let bell = |di: isize, dj: isize| (-((di * di + dj * dj) as f64) / 2.0).exp();
        let bell = KernelTable::from_fn(grid, Boundary::Free, ContactGrowth::Unknown, bell)?;
        // The middle of three nodes is pulled down by its neighbours more than it resists.
        let strip = Grid::new(4, 1, 1.0, 1.0)?;
        let pulling = |di: isize, _| [1.0, 0.7, 0.2, 0.0][di.unsigned_abs()];
        let pulling = KernelTable::from_fn(strip, Boundary::Free, ContactGrowth::Unknown, pulling)?;
        let wide = Grid::new(8, 5, 1.0, 1.0)?;
        let wide_gaps: Vec<f64> = (0..wide.nodes())
            .map(|k| 1.0 + (2.3 * k as f64 + 0.7 * (k * k) as f64).sin())
            .collect();
        let taken_back = Self::new("taken back", &Boussinesq::new(wide, 1.0)?, &wide_gaps, 24)?;
        let harden = |small: Self| Self { hardness: Some(0.2), ..small };
        let misled = Self::new("misled", &Boussinesq::new(wide, 1.0)?, &wide_gaps, 24)?;
        Ok(vec![
            harden(Self::new("yielding", &free, &gaps, 8)?),
            harden(Self::new("yielding, periodic", &periodic, &gaps, 12)?),
            harden(Self::new("yielding, near ties", &free, &near, 16)?),
            harden(Self { misleads: true, ..misled }),
            Self { misleads: true, ..taken_back },
            Self::new("free", &free, &gaps, 3)?,
            Self::new("periodic", &periodic, &gaps, 4)?,
            Self::new("near ties", &free, &near, 8)?,
            Self::new("bell", &bell, &gaps, 1)?,
            Self::new("released", &pulling, &[0.0, 0.01, 0.2, 100.0], 1)?,
        ])
    }

    /// The path with a fault.
    fn path(&self, strike: &Arc<Strike>) -> Result<LoadingPath, Error> {
        let (strike, misleads) = (Arc::clone(strike), self.misleads);
        let iterations = Failing { inner: ConjugateGradient::new(), misleads, strike };
        let builder = LoadingSolver::builder(&self.heights, &self.kernel).window_size(self.window);
        let builder = self.hardness.into_iter().fold(builder, |all, value| all.hardness(value));
        builder.settings.build(Phase::Iterations(Box::new(iterations)))
    }

    /// All states of the path without a fault, and how many calls they take.
    fn states(&self) -> Result<(Vec<LoadingState>, usize), Error> {
        let strike = Strike::new(Fault::Refuse, usize::MAX);
        let states: Vec<LoadingState> = self.path(&strike)?.collect::<Result<_, _>>()?;
        assert!(states.len() >= self.gaps.len(), "{}", self.name);
        for state in states.iter().filter(|_| !self.misleads) {
            assert_eq!(self.violation(state), None, "{}", self.name);
        }
        Ok((states, strike.calls.load(Relaxed)))
    }

    /// The approach for which gap = g + C p − δ with the coefficients as they are.
    fn own_approach(&self, state: &ContactState) -> f64 {
        match self.kernel.boundary() {
            Boundary::Free | Boundary::PeriodicX | Boundary::PeriodicY => state.approach,
            Boundary::Periodic => state.approach + self.matrix.mean() * state.load,
        }
    }

    /// The pressures of the contact at the approach of a state.
    fn pressure(&self, state: &ContactState) -> DVector<f64> {
        let approach = self.own_approach(state);
        match self.hardness {
            Some(hardness) => bounded(&self.matrix, &self.gaps, hardness, approach),
            None => complementary(&self.matrix, &self.gaps, approach),
        }
    }

    /// Errors of lengths and of pressures that a state may have: gaps are pinned to 10⁻⁸, and the sum of all moduli of
    /// C⁻¹ bounds what a length changes of a pressure.
    fn allowed(&self, state: &LoadingState) -> [f64; 2] {
        let greatest = self.gaps.iter().copied().fold(0.0, f64::max);
        let length = 1e-8 * (self.own_approach(&state.contact) + greatest) + state.approach_error;
        let inverse = self.matrix.clone().try_inverse().unwrap();
        [length, length * inverse.iter().map(|value| value.abs()).sum::<f64>()]
    }

    /// What in a state contradicts the conditions of contact at its approach.
    fn violation(&self, state: &LoadingState) -> Option<String> {
        let found = &state.contact;
        let approach = self.own_approach(found);
        if !approach.is_finite() || approach < 0.0 {
            return Some(format!("approach {approach}"));
        }
        let pressure = self.pressure(found);
        let gap =
            &self.matrix * &pressure + DVector::from_column_slice(&self.gaps).add_scalar(-approach);
        let [length, force] = self.allowed(state);
        let is_off = |quantity: &str, found: f64, expected: f64, allowed: f64| {
            // NaN is off as well.
            let is_near = (found - expected).abs() <= allowed;
            (!is_near).then(|| format!("{quantity} {found}, not {expected}: {state:?}"))
        };
        let pressed = pressure.iter().filter(|p| **p > force).count();
        let closed = gap.iter().filter(|gap| **gap <= length).count();
        if !(pressed..=closed).contains(&found.contact_nodes) {
            return Some(format!("{pressed} to {closed} nodes touch: {state:?}"));
        }
        // Where a node has yielded there is none.
        let open = if self.hardness.is_some() { gap.map(|gap| gap.max(0.0)) } else { gap };
        is_off("load", found.load, pressure.sum(), force)
            .or_else(|| is_off("mean gap", found.mean_gap, open.mean(), length))
    }

    /// After its end a path yields nothing and does not go on; what it has yielded it still knows. Returns for how many
    /// states it answered.
    fn is_over(&self, path: &mut LoadingPath, states: &[LoadingState], context: &str) -> usize {
        assert_eq!(path.end(), Some(LoadingEnd::Failed), "{context}");
        for _ in 0..3 {
            assert!(path.next().is_none(), "{context}");
        }
        assert_eq!(path.size_hint(), (0, Some(0)), "{context}");
        let target = crate::ContactTarget::Load(1e9);
        assert!(matches!(
            path.continue_to(target),
            Err(Error::CannotContinue { steps }) if steps == states.len()
        ));
        assert_eq!(path.state(), states.last().copied(), "{context}");
        let nodes = states.last().map_or(0, |state| state.contact.contact_nodes);
        assert_eq!(path.contact_order().len(), nodes, "{context}");
        let mut answered = 0;
        for state in states {
            let map = path.contact_map_at(state).unwrap();
            let in_contact = map.iter().filter(|in_contact| **in_contact).count();
            assert_eq!(in_contact, state.contact.contact_nodes, "{context}");
            // Of iterations that have failed once anything but a wrong answer is welcome.
            if let Ok(pressure) = path.pressure_at(state) {
                answered += 1;
                if self.misleads {
                    continue;
                }
                let [_, allowed] = self.allowed(state);
                for (found, expected) in pressure.iter().zip(&self.pressure(&state.contact)) {
                    assert!((found - expected).abs() <= allowed, "{context}: {state:?}");
                }
            }
        }
        answered
    }
}

/// The pressures from 0 to a hardness that leave gaps of the right sign, one node after the other (Gauss and Seidel)
/// until none changes by more than 10⁻¹³ of the hardness.
fn bounded(matrix: &DMatrix<f64>, gaps: &[f64], hardness: f64, approach: f64) -> DVector<f64> {
    let mut pressure = DVector::zeros(gaps.len());
    for _ in 0..2000 {
        let mut most: f64 = 0.0;
        for (node, gap) in gaps.iter().enumerate() {
            // It is symmetric.
            let left = gap - approach + matrix.column(node).dot(&pressure);
            let next = (pressure[node] - left / matrix[(node, node)]).clamp(0.0, hardness);
            most = most.max((next - pressure[node]).abs());
            pressure[node] = next;
        }
        if most < 1e-13 * hardness {
            break;
        }
    }
    pressure
}

#[test]
fn an_error_at_any_call_is_the_last_item() -> Result<(), Error> {
    let (mut refused, mut answered, mut methods) = (0, 0, BTreeSet::new());
    for small in Small::all()? {
        let (expected, calls) = small.states()?;
        for at in 0..calls {
            let context = format!("{}, call {at}", small.name);
            let strike = Strike::new(Fault::Refuse, at);
            let mut path = small.path(&strike)?;
            let (mut states, mut failure) = (Vec::new(), None);
            for item in path.by_ref() {
                match item {
                    Ok(state) => states.push(state),
                    Err(error) => {
                        assert!(failure.is_none(), "{context}: two errors");
                        failure = Some(error);
                    }
                }
            }
            assert!(states == expected[..states.len()], "{context}");
            assert!(failure.is_some_and(|error| is_refusal(&error)), "{context}");
            methods.extend(strike.struck());
            refused += 1;
            answered += small.is_over(&mut path, &states, &context);
        }
    }
    let methods: Vec<_> = methods.into_iter().collect();
    let expected = ["advance", "advance behind yields", "cut", "probe", "propose"];
    let expected: Vec<_> = expected.into_iter().chain(["propose beside yielded nodes"]).collect();
    assert_eq!(methods, expected);
    assert!(refused > 100 && answered > refused, "{refused} {answered}");
    Ok(())
}

#[test]
fn nothing_is_yielded_after_a_panic_at_any_call() -> Result<(), Error> {
    let (mut answered, mut methods) = (0, BTreeSet::new());
    for small in Small::all()? {
        let (expected, calls) = small.states()?;
        for fault in [Fault::PanicBefore, Fault::PanicAfter] {
            for at in 0..calls {
                let context = format!("{}, {fault:?} at call {at}", small.name);
                let strike = Strike::new(fault, at);
                let mut path = small.path(&strike)?;
                let mut states = Vec::new();
                let has_panicked = loop {
                    match catch_unwind(AssertUnwindSafe(|| path.next())) {
                        Ok(Some(state)) => states.push(state?),
                        Ok(None) => break false,
                        Err(_) => break true,
                    }
                };
                assert!(has_panicked && states == expected[..states.len()], "{context}");
                methods.extend(strike.struck());
                answered += small.is_over(&mut path, &states, &context);
            }
        }
    }
    let methods: Vec<_> = methods.into_iter().collect();
    let expected = ["advance", "advance behind yields", "cut", "probe", "propose"];
    let expected: Vec<_> = expected.into_iter().chain(["propose beside yielded nodes"]).collect();
    assert_eq!(methods, expected);
    assert!(answered > 200, "{answered}");
    Ok(())
}

/// A question of fields that fails is that question's failure: the path goes on as if it had not been asked.
#[test]
fn questions_that_fail_do_not_disturb_the_path() -> Result<(), Error> {
    let (mut failed, mut methods) = (0, BTreeSet::new());
    for small in Small::all()?.iter().filter(|small| !small.misleads) {
        let (expected, _) = small.states()?;
        for fault in [Fault::Refuse, Fault::PanicBefore, Fault::PanicAfter] {
            for ahead in 0..3 {
                let context = format!("{}, {fault:?}", small.name);
                let strike = Strike::new(fault, usize::MAX);
                let mut path = small.path(&strike)?;
                let mut states = Vec::new();
                while let Some(state) = path.next() {
                    states.push(state?);
                    let earlier = states[states.len() / 2];
                    strike.at.store(strike.calls.load(Relaxed) + ahead, Relaxed);
                    let asked = catch_unwind(AssertUnwindSafe(|| {
                        path.fields()?;
                        path.pressure_at(&earlier)?;
                        path.certificate()
                    }));
                    failed += match asked {
                        Ok(Ok(_)) => 0,
                        Ok(Err(error)) => {
                            assert!(is_refusal(&error), "{context}: {error}");
                            1
                        }
                        Err(_) => 1,
                    };
                    strike.at.store(usize::MAX, Relaxed);
                }
                methods.extend(strike.struck());
                assert!(states == expected, "{context}");
            }
        }
    }
    assert!(methods.contains("solve_apart") && failed > 150, "{methods:?} {failed}");
    Ok(())
}

/// Answers of another size, that are no numbers, or to calls that were not passed on, and tolerances that are none:
/// whatever it is, the path ends and no wrong state follows.
#[test]
fn what_no_answer_can_be_is_refused() -> Result<(), Error> {
    let values: [fn(f64) -> f64; 3] = [|_| f64::NAN, |_| f64::INFINITY, |_| f64::NEG_INFINITY];
    let parts =
        [Part::Pressure, Part::Rate, Part::Field, Part::Schur, Part::RowSums, Part::Proposed];
    let mut lies = vec![Fault::Forget, Fault::Length(1), Fault::Length(-1)];
    for part in parts {
        lies.extend(
            values
                .into_iter()
                .flat_map(|value| [Fault::Each(part, value), Fault::Last(part, value)]),
        );
    }
    lies.extend([f64::NAN, 0.0, -1.0, f64::INFINITY].map(Fault::Tolerance));
    for small in Small::all()?.iter().filter(|small| !small.misleads) {
        let (expected, calls) = small.states()?;
        for &fault in &lies {
            // Some calls more, for a path that looks again.
            for at in 0..calls + 5 {
                let context = format!("{}, {fault:?} at call {at}", small.name);
                let strike = Strike::new(fault, at);
                let mut path = match small.path(&strike) {
                    Ok(path) => path,
                    Err(error) => {
                        assert!(matches!(fault, Fault::Tolerance(_)), "{context}: {error}");
                        break;
                    }
                };
                let (mut count, mut failures) = (0, 0);
                for item in path.by_ref() {
                    let Ok(state) = item else {
                        failures += 1;
                        continue;
                    };
                    let unspoilt =
                        strike.struck().is_none() && !matches!(fault, Fault::Tolerance(_));
                    assert!(!unspoilt || state == expected[count], "{context}: {state:?}");
                    count += 1;
                    assert!(count <= 2 * expected.len() + 20, "{context} has no end");
                    if matches!(fault, Fault::Tolerance(_)) {
                        // Errors are estimated from it.
                        let ContactState { approach, load, mean_gap, energy, .. } = state.contact;
                        assert!([approach, load, mean_gap, energy].iter().all(|x| x.is_finite()));
                    } else {
                        assert_eq!(small.violation(&state), None, "{context}");
                    }
                }
                assert!(failures <= 1, "{context}: {failures} errors");
                if strike.struck().is_some() {
                    let wrong_size = matches!(fault, Fault::Length(_));
                    assert!(!wrong_size || failures == 1, "{context}: not refused");
                } else if matches!(fault, Fault::Tolerance(_)) {
                    break;
                } else {
                    assert_eq!((count, failures), (expected.len(), 0), "{context}");
                }
            }
        }
    }
    Ok(())
}
