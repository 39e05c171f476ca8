//! Kernels under which nodes leave the contact: paths against an independent solver of the linear
//! complementarity problem, at and between events.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use std::collections::BTreeSet;

use asperity::loading::{ContactEvent, History, LoadingSolver};
use asperity::surface::HeightMap;
use asperity::updater::{
    ConjugateGradient, Dense, Handover, LinearUpdater, MixedCholesky, RecursiveCholesky, Schur,
    Solution, System, Touched,
};
use asperity::{Boundary, ContactGrowth, ContactState, Error, Grid, InfluenceKernel};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Coefficients by offset, for −nx < di < nx and −ny < dj < ny.
#[derive(Debug, Clone)]
struct Table {
    grid: Grid,
    boundary: Boundary,
    growth: ContactGrowth,
    coefficients: DMatrix<f64>,
}

impl InfluenceKernel for Table {
    fn grid(&self) -> Grid {
        self.grid
    }
    fn boundary(&self) -> Boundary {
        self.boundary
    }
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        let index = |d: isize, n: usize| (d + n as isize - 1) as usize;
        self.coefficients[(index(di, self.grid.nx()), index(dj, self.grid.ny()))]
    }
    fn contact_growth(&self) -> ContactGrowth {
        self.growth
    }
}

impl Table {
    /// 1 at offset 0 and `coefficient` elsewhere, made symmetric; scaled down away from 0 until the
    /// least eigenvalue of the matrix is 0.05 at least: the condition number is below 1e3.
    fn new(
        (nx, ny): (usize, usize),
        boundary: Boundary,
        mut coefficient: impl FnMut(isize, isize) -> f64,
    ) -> Self {
        let grid = Grid::new(nx, ny, 1.0, 1.0).unwrap();
        let (mx, my) = (2 * nx - 1, 2 * ny - 1);
        let random = DMatrix::from_fn(mx, my, |i, j| {
            coefficient(i as isize - nx as isize + 1, j as isize - ny as isize + 1)
        });
        let mut coefficients = DMatrix::from_fn(mx, my, |i, j| {
            random[(i, j)] + random[(mx - 1 - i, my - 1 - j)]
        });
        if boundary == Boundary::Periodic {
            let wrapped = coefficients.clone();
            let fold = |i: usize, n: usize| (i + 1) % n + n - 1;
            coefficients = DMatrix::from_fn(mx, my, |i, j| {
                let (i, j) = (fold(i, nx), fold(j, ny));
                wrapped[(i, j)] + wrapped[(fold(mx - 1 - i, nx), fold(my - 1 - j, ny))]
            });
        }
        coefficients[(nx - 1, ny - 1)] = 0.0;
        let mut table = Self {
            grid,
            boundary,
            growth: ContactGrowth::Unknown,
            coefficients,
        };
        let least = table.matrix().symmetric_eigenvalues().min();
        table.coefficients *= 0.95 / -least;
        table.coefficients[(nx - 1, ny - 1)] = 1.0;
        table
    }

    /// Random coefficients that fall off as a bell of a random width, or not at all: the smoother the
    /// kernel, the more it takes from the nodes between others.
    fn random(shape: (usize, usize), boundary: Boundary, random: &mut StdRng) -> Self {
        let width: f64 = random.random_range(0.8..1.6);
        let noise = [0.1, 0.5, 1.0][random.random_range(0..3)];
        Self::new(shape, boundary, |di, dj| {
            let bell = (-((di * di + dj * dj) as f64) / (width * width)).exp();
            bell * (1.0 - noise) + noise * random.random_range(-0.3..0.5)
        })
    }

    /// The influence matrix of all nodes.
    fn matrix(&self) -> DMatrix<f64> {
        let n = self.grid.nodes();
        DMatrix::from_fn(n, n, |i, j| {
            let ((ix, iy), (jx, jy)) = (self.grid.coordinates(i), self.grid.coordinates(j));
            let offset = |a: usize, b: usize| a as isize - b as isize;
            self.coefficient(offset(ix, jx), offset(iy, jy))
        })
    }

    fn path(&self, gaps: &[f64]) -> LoadingSolver<HeightMap, Self> {
        self.path_with(gaps, RecursiveCholesky::new())
    }

    fn path_with<U: LinearUpdater>(
        &self,
        gaps: &[f64],
        updater: U,
    ) -> LoadingSolver<HeightMap, Self, U> {
        let (nx, ny) = self.grid.shape();
        let heights = DMatrix::from_fn(nx, ny, |ix, iy| -gaps[self.grid.node(ix, iy).unwrap()]);
        LoadingSolver::builder(HeightMap::new(heights).unwrap(), self.clone())
            .updater(updater)
            .build()
            .unwrap()
    }
}

/// Gaps whose least is zero, as a path measures them.
fn from_first_touch(gaps: &[f64]) -> Vec<f64> {
    let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    gaps.iter().map(|gap| gap - least).collect()
}

fn restrict(matrix: &DMatrix<f64>, nodes: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(nodes.len(), nodes.len(), |i, j| {
        matrix[(nodes[i], nodes[j])]
    })
}

/// p ≥ 0, g + C p − δ ≥ 0, one of them zero at each node: least squares with bounds after Lawson and
/// Hanson (1974), which grows the set of free nodes one at a time from nothing, at this δ alone.
fn complementary(matrix: &DMatrix<f64>, gaps: &[f64], approach: f64) -> DVector<f64> {
    let n = gaps.len();
    let rhs = DVector::from_iterator(n, gaps.iter().map(|gap| approach - gap));
    let mut p = DVector::zeros(n);
    let mut free: Vec<usize> = Vec::new();
    loop {
        let residual = &rhs - matrix * &p;
        let outside = (0..n).filter(|i| !free.contains(i));
        let worst = outside.max_by(|&a, &b| residual[a].total_cmp(&residual[b]));
        // Rounding of a residual of numbers up to the approach.
        let Some(worst) = worst.filter(|&i| residual[i] > 1e-14 * (approach + 1.0)) else {
            return p;
        };
        free.push(worst);
        loop {
            let b = DVector::from_iterator(free.len(), free.iter().map(|&i| rhs[i]));
            let solved = restrict(matrix, &free).cholesky().unwrap().solve(&b);
            let blocking = free.iter().zip(&solved).filter(|(_, s)| **s <= 0.0);
            let step = blocking
                .map(|(&i, s)| p[i] / (p[i] - s))
                .fold(1.0, f64::min);
            for (&i, s) in free.iter().zip(&solved) {
                p[i] += step * (s - p[i]);
            }
            if step >= 1.0 {
                break;
            }
            let nodes = free.iter().zip(&solved);
            let out: Vec<usize> = nodes
                .filter(|&(&i, s)| *s <= 0.0 && p[i] <= 1e-15 * p.max())
                .map(|(&i, _)| i)
                .collect();
            for &i in &out {
                p[i] = 0.0;
            }
            free.retain(|i| !out.contains(i));
        }
    }
}

/// Both sides solve with matrices of condition 1e3 at most, which loses three digits of sixteen.
const EXACT: f64 = 1e-12;
/// Solutions that are refined or iterated to residuals of 1e-12 and 1e-14: times the condition number.
const ITERATED: f64 = 1e-10;

/// A path from first touch to its end, checked at every event and between events. Returns the number
/// of releases.
///
/// Everything within `tolerance` of the greatest pressure or load. With a factor in double precision
/// that is [`EXACT`].
fn check<U: LinearUpdater>(
    kernel: &Table,
    gaps: &[f64],
    mut path: LoadingSolver<HeightMap, Table, U>,
    tolerance: f64,
) -> usize {
    let matrix = kernel.matrix();
    let gaps = from_first_touch(gaps);
    let mut contact = BTreeSet::new();
    let mut states: Vec<ContactState> = Vec::new();
    let compare = |pressure: &DMatrix<f64>, state: &ContactState| {
        let expected = complementary(&matrix, &gaps, state.approach_in(kernel));
        let scale = expected.max().max(1e-3);
        let error = (DVector::from_column_slice(pressure.as_slice()) - &expected).amax();
        assert!(
            error <= tolerance * scale,
            "{state:?}: pressure {error:e} of {scale:e}"
        );
        let error = (expected.sum() - state.load).abs();
        assert!(
            error <= tolerance * scale * gaps.len() as f64,
            "{state:?}: load {error:e}"
        );
        let displacement = (&matrix * &expected).mean();
        let mean_gap =
            DVector::from_column_slice(&gaps).mean() + displacement - state.approach_in(kernel);
        let error = (mean_gap - state.mean_gap).abs();
        assert!(
            error <= tolerance * (1.0 + state.approach_in(kernel)),
            "{state:?}: {error:e}"
        );
    };
    while let Some(state) = path.next() {
        let state = state.unwrap();
        let node = kernel.grid.node(state.node.0, state.node.1).unwrap();
        match state.event {
            ContactEvent::Touch => assert!(contact.insert(node), "{state:?}"),
            ContactEvent::Release => assert!(contact.remove(&node), "{state:?}"),
        }
        assert_eq!(state.step, states.len() + 1);
        assert_eq!(state.contact_nodes, contact.len());
        assert_eq!(state.contact_area, contact.len() as f64);
        let order: BTreeSet<usize> = path.contact_order().iter().copied().collect();
        assert_eq!(
            (order.len(), &order),
            (path.contact_order().len(), &contact)
        );
        let map = path.contact_map();
        assert!((0..gaps.len()).all(|node| map.as_slice()[node] == contact.contains(&node)));
        // Gaps are relative to Sq, some 0.3, and round like the approach in the gauge of the kernel.
        let slack = 30.0 * tolerance * (1.0 + state.approach_in(kernel));
        let certificate = path.certificate().unwrap();
        assert!(certificate.least_pressure >= -slack, "{certificate:?}");
        assert!(certificate.least_gap >= -slack, "{certificate:?}");
        assert!(certificate.greatest_contact_gap <= slack, "{certificate:?}");
        compare(&path.pressure().unwrap(), &state);
        if let Some(last) = states.last() {
            assert!(state.load >= last.load);
            // Half way from the last event to this one the contact is that after the last.
            let middle = last.at_load(0.5 * (last.load + state.load));
            compare(&path.pressure_at(&middle).unwrap(), &middle);
            let work = 0.5 * (last.load + state.load) * (state.approach - last.approach);
            let error = (state.energy - last.energy - work).abs();
            assert!(error <= tolerance * (1.0 + state.energy.abs()), "{error:e}");
        }
        states.push(state);
    }
    assert!(path.next().is_none());

    // Every earlier state, whatever left since, and the state that a history reads.
    for state in states.iter().step_by(3) {
        compare(&path.pressure_at(state).unwrap(), state);
    }
    let last = *states.last().unwrap();
    let history: History = states.iter().copied().collect();
    let half = history.at_load(0.5 * last.load).unwrap();
    compare(&path.pressure_at(&half).unwrap(), &half);
    let first_half = history.at_area_fraction(0.5);
    let expected = states
        .iter()
        .find(|state| state.contact_area_fraction >= 0.5);
    assert_eq!(first_half.as_ref(), expected);
    // Nothing happens any more: the same contact far beyond.
    let beyond = last.at_load(10.0 * last.load + 1.0);
    compare(&path.pressure_at(&beyond).unwrap(), &beyond);
    let releases = states
        .iter()
        .filter(|state| state.event == ContactEvent::Release);
    releases.count()
}

trait InGauge {
    /// The approach for which gap = g + C p − δ with the coefficients as they are.
    fn approach_in(&self, kernel: &Table) -> f64;
}

impl InGauge for ContactState {
    fn approach_in(&self, kernel: &Table) -> f64 {
        match kernel.boundary {
            Boundary::Free => self.approach,
            Boundary::Periodic => self.approach + kernel.matrix().mean() * self.load,
        }
    }
}

/// A random kernel with random gaps.
fn case(seed: u64) -> (Table, Vec<f64>) {
    let mut random = StdRng::seed_from_u64(seed);
    let shapes = [(20, 1), (5, 4), (6, 6), (1, 30), (3, 7), (8, 9)];
    let shape = shapes[random.random_range(0..shapes.len())];
    let boundary = if random.random_bool(0.5) {
        Boundary::Free
    } else {
        Boundary::Periodic
    };
    let kernel = Table::random(shape, boundary, &mut random);
    let gaps = (0..kernel.grid.nodes()).map(|_| random.random_range(0.0..1.0));
    let gaps = gaps.collect();
    (kernel, gaps)
}

#[test]
fn random_kernels_against_an_independent_solver() {
    let mut releases = 0;
    for seed in 0..250 {
        let (kernel, gaps) = case(seed);
        releases += check(&kernel, &gaps, kernel.path(&gaps), EXACT);
    }
    println!("{releases} releases");
    assert!(releases >= 100, "{releases}");
}

#[test]
fn other_updaters_on_random_kernels() {
    let mut releases = 0;
    for seed in 250..310 {
        let (kernel, gaps) = case(seed);
        let own = check(&kernel, &gaps, kernel.path_with(&gaps, Dense::new()), EXACT);
        let mixed = kernel.path_with(&gaps, MixedCholesky::single_from(5));
        assert_eq!(check(&kernel, &gaps, mixed, ITERATED), own);
        let iterative = ConjugateGradient::with_tolerance(1e-14).unwrap();
        let iterative = kernel.path_with(&gaps, iterative);
        assert_eq!(check(&kernel, &gaps, iterative, ITERATED), own);
        let handover = kernel.path_with(&gaps, Handover::new());
        assert_eq!(check(&kernel, &gaps, handover, EXACT), own);
        releases += own;
    }
    println!("{releases} releases");
    assert!(releases >= 30, "{releases}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn any_seed(seed in any::<u64>()) {
        let (kernel, gaps) = case(seed);
        check(&kernel, &gaps, kernel.path(&gaps), EXACT);
    }
}

/// Gaps that are few small integers, kernels with the symmetry of the rectangle: many nodes touch
/// and leave together.
#[test]
fn nodes_that_touch_and_leave_together() {
    let mut releases = 0;
    for seed in 0..60 {
        let mut random = StdRng::seed_from_u64(1000 + seed);
        let shape = [(4, 4), (5, 3), (6, 5), (9, 1)][random.random_range(0..4)];
        let values: Vec<f64> = (0..36).map(|_| random.random_range(-0.6..1.0)).collect();
        let boundary = [Boundary::Free, Boundary::Periodic][seed as usize % 2];
        let kernel = Table::new(shape, boundary, |di, dj| {
            values[di.unsigned_abs() + 6 * dj.unsigned_abs()]
        });
        let steps = random.random_range(1..4);
        let levels: Vec<f64> = (0..36)
            .map(|_| f64::from(random.random_range(0..steps)))
            .collect();
        let (nx, ny) = shape;
        let gaps: Vec<f64> = (0..nx * ny)
            .map(|node| {
                let (ix, iy) = kernel.grid.coordinates(node);
                levels[ix.min(nx - 1 - ix) + 6 * iy.min(ny - 1 - iy)]
            })
            .collect();
        releases += check(&kernel, &gaps, kernel.path(&gaps), EXACT);
    }
    println!("{releases} releases");
    assert!(releases >= 50, "{releases}");
}

/// A release exists if and only if, for some set J of holes and some i outside J,
/// 1 − A_iJ A_JJ⁻¹ e < 0, with A the pseudo-inverse of the kernel in the zero gauge: the share of i
/// in a growing load is negative. From such a set a surface is made whose node i leaves.
#[test]
fn a_surface_whose_node_leaves_can_be_made_from_any_set_of_holes_that_says_so() {
    let mut made = 0;
    for seed in 0..40 {
        let mut random = StdRng::seed_from_u64(2000 + seed);
        let kernel = Table::random((3, 3), Boundary::Periodic, &mut random);
        let (n, matrix) = (9, kernel.matrix());
        // C⁻¹ = A + e eᵀ / (s M²) with s the gauge, the mean coefficient.
        let gauge = matrix.mean();
        let inverse = matrix.clone().cholesky().unwrap().inverse();
        let pseudo = inverse.map(|value| value - 1.0 / (gauge * (n * n) as f64));
        for holes in 0..(1_u32 << n) - 1 {
            let (out, inside): (Vec<usize>, Vec<usize>) =
                (0..n).partition(|&node| holes >> node & 1 == 1);
            let filled = restrict(&pseudo, &out).cholesky().unwrap();
            let filled = filled.solve(&DVector::from_element(out.len(), 1.0));
            let share = |i: usize| -> f64 {
                let terms = out.iter().zip(&filled);
                1.0 - terms.map(|(&j, x)| pseudo[(i, j)] * x).sum::<f64>()
            };
            let shares: Vec<f64> = inside.iter().map(|&i| share(i)).collect();
            let rates = restrict(&matrix, &inside).cholesky().unwrap();
            let rates = rates.solve(&DVector::from_element(inside.len(), 1.0));
            // The same sign as y2, in every gauge.
            let total = rates.sum();
            for (share, rate) in shares.iter().zip(&rates) {
                assert!(
                    (share / n as f64 - rate / total).abs() < 1e-10,
                    "{share} {rate}"
                );
            }
            let least = (0..inside.len())
                .min_by(|&a, &b| shares[a].total_cmp(&shares[b]))
                .unwrap();
            // Others that lose pressure do so from a thousand times as much, and later.
            if shares[least] > -0.05 || made > 200 {
                continue;
            }
            let leaving = inside[least];
            let mut pressure = DVector::zeros(n);
            for &i in &inside {
                pressure[i] = if i == leaving { 1e-3 } else { 1.0 };
            }
            // Gaps out of contact that nothing closes before.
            let displacement = &matrix * &pressure;
            let gaps: Vec<f64> = (0..n)
                .map(|i| if holes >> i & 1 == 1 { 10.0 } else { 0.0 } - displacement[i])
                .collect();
            let first = gaps.iter().copied().fold(f64::INFINITY, f64::min);
            // In this gauge and from first touch, the pressure above is that at −first.
            let expected = -first - 1e-3 / rates[least];
            let path = kernel.path(&gaps);
            let found = path
                .map(Result::unwrap)
                .find(|state| state.approach_in(&kernel) > -first * (1.0 + 1e-9));
            let found = found.unwrap();
            assert_eq!(found.event, ContactEvent::Release, "{found:?}");
            assert_eq!(found.node, kernel.grid.coordinates(leaving));
            let error = (found.approach_in(&kernel) - expected).abs();
            assert!(error < 1e-12 * (1.0 + expected), "{error:e}");
            made += 1;
        }
    }
    println!("{made} releases made");
    assert!(made >= 100, "{made}");
}

fn has_releases((kernel, gaps): &(Table, Vec<f64>)) -> bool {
    let mut states = kernel.path(gaps).map(Result::unwrap);
    states.any(|state| state.event == ContactEvent::Release)
}

/// An updater that knows the three verbs that every path needs, and not how to let a node leave.
#[derive(Default)]
struct GrowsOnly(Dense);

impl LinearUpdater for GrowsOnly {
    fn schur(&mut self, system: &System, nodes: &[usize], schur: &mut Schur) -> Result<(), Error> {
        self.0.schur(system, nodes, schur)
    }
    fn commit(&mut self, system: &System, touched: &Touched) -> Result<(), Error> {
        self.0.commit(system, touched)
    }
    fn solve(
        &mut self,
        system: &System,
        touched: &Touched,
        count: usize,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        self.0.solve(system, touched, count, solution)
    }
}

#[test]
fn an_updater_that_cannot_let_nodes_leave_says_so() {
    let (kernel, gaps) = (0..).map(case).find(has_releases).unwrap();
    let mut complete = kernel.path(&gaps);
    let mut path = kernel.path_with(&gaps, GrowsOnly::default());
    loop {
        let expected = complete.next().unwrap().unwrap();
        match path.next().unwrap() {
            Ok(state) => assert_eq!((state.step, state.node), (expected.step, expected.node)),
            Err(Error::ReleaseNotSupported { ix, iy }) => {
                assert_eq!(expected.event, ContactEvent::Release);
                assert_eq!((ix, iy), expected.node);
                break;
            }
            Err(error) => panic!("{error}"),
        }
    }
    assert!(path.next().is_none());
    // What came before stays.
    let state = path.state().unwrap();
    assert_eq!(path.contact_order().len(), state.contact_nodes);
    assert!(path.certificate().unwrap().least_pressure > -1e-11);
}

/// An updater one of whose solutions is not a number.
struct Spoiled {
    inner: RecursiveCholesky,
    solutions: usize,
    spoiled: usize,
}

impl LinearUpdater for Spoiled {
    fn schur(&mut self, system: &System, nodes: &[usize], schur: &mut Schur) -> Result<(), Error> {
        self.inner.schur(system, nodes, schur)
    }
    fn commit(&mut self, system: &System, touched: &Touched) -> Result<(), Error> {
        self.inner.commit(system, touched)
    }
    fn release(&mut self, system: &System, node: usize) -> Result<(), Error> {
        self.inner.release(system, node)
    }
    fn solve(
        &mut self,
        system: &System,
        touched: &Touched,
        count: usize,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        self.inner.solve(system, touched, count, solution)?;
        self.solutions += 1;
        if self.solutions == self.spoiled {
            solution.y1.iter_mut().for_each(|y1| *y1 = f64::NAN);
        }
        Ok(())
    }
}

/// An event whose state fails is not yielded, whether a node touched or left; what came before stays.
#[test]
fn states_before_a_failure_stay() {
    let (kernel, gaps) = (0..).map(case).find(has_releases).unwrap();
    let expected: Vec<ContactState> = kernel.path(&gaps).map(Result::unwrap).collect();
    // One solution before first touch, one at every event.
    for good in 0..expected.len() {
        let updater = Spoiled {
            inner: RecursiveCholesky::new(),
            solutions: 0,
            spoiled: good + 2,
        };
        let mut path = kernel.path_with(&gaps, updater);
        for expected in &expected[..good] {
            assert_eq!(path.next().unwrap().unwrap(), *expected);
        }
        let error = path.next().unwrap().unwrap_err();
        assert!(matches!(error, Error::NotMonotone { .. }), "{error}");
        assert!(path.next().is_none());
        assert_eq!(path.state().as_ref(), expected[..good].last());
        for state in &expected[..good] {
            let approach = state.approach_in(&kernel);
            let exact = complementary(&kernel.matrix(), &from_first_touch(&gaps), approach);
            let found = path.pressure_at(state).unwrap();
            let error = (DVector::from_column_slice(found.as_slice()) - &exact).amax();
            assert!(
                error <= EXACT * exact.max().max(1e-3),
                "{state:?}: {error:e}"
            );
        }
        let nodes = path.state().map_or(0, |state| state.contact_nodes);
        assert_eq!(path.contact_order().len(), nodes);
    }
}

/// Where contact happens to grow, the same path with windows that are checked at their ends; gaps of
/// these kernels are far from convex, so that events are taken back.
#[test]
fn windows_of_kernels_whose_gaps_are_not_convex() {
    let (mut paths, mut taken_back) = (0, 0);
    for seed in 0..400 {
        let mut random = StdRng::seed_from_u64(3000 + seed);
        let mut kernel = Table::random((6, 4), Boundary::Free, &mut random);
        kernel
            .coefficients
            .apply(|value| *value *= if *value == 1.0 { 1.0 } else { 0.35 });
        let gaps: Vec<f64> = (0..24).map(|_| random.random_range(0.0..0.5)).collect();
        let expected: Vec<ContactState> = kernel.path(&gaps).map(Result::unwrap).collect();
        let matrix = kernel.matrix();
        let mut order = Vec::new();
        let monotone = expected.iter().all(|state| {
            order.push(kernel.grid.node(state.node.0, state.node.1).unwrap());
            let own = restrict(&matrix, &order).cholesky();
            let y2 = own.map(|own| own.solve(&DVector::from_element(order.len(), 1.0)));
            let rates = y2.map(|y2| {
                (0..24).all(|i| {
                    order
                        .iter()
                        .zip(&y2)
                        .map(|(&j, y)| matrix[(i, j)] * y)
                        .sum::<f64>()
                        < 1.0 + 1e-12
                })
            });
            state.event == ContactEvent::Touch && rates == Some(true)
        });
        if !monotone {
            continue;
        }
        kernel.growth = ContactGrowth::Monotone;
        for window in [None, Some(1), Some(3), Some(8)] {
            let heights = DMatrix::from_fn(6, 4, |ix, iy| -gaps[kernel.grid.node(ix, iy).unwrap()]);
            let builder = LoadingSolver::builder(HeightMap::new(heights).unwrap(), &kernel);
            let builder = match window {
                Some(size) => builder.window_size(size),
                None => builder,
            };
            let mut path = builder.build().unwrap();
            for expected in &expected {
                let state = path.next().unwrap().unwrap();
                assert_eq!((state.step, state.node), (expected.step, expected.node));
                for (found, expected) in [
                    (state.approach, expected.approach),
                    (state.load, expected.load),
                    (state.mean_gap, expected.mean_gap),
                    (state.energy, expected.energy),
                    (
                        state.contact_stiffness.unwrap(),
                        expected.contact_stiffness.unwrap(),
                    ),
                ] {
                    assert!(
                        (found - expected).abs() < 1e-12 * (1.0 + expected),
                        "{state:?}"
                    );
                }
            }
            assert!(path.next().is_none());
            taken_back += path.timings().taken_back;
        }
        paths += 1;
    }
    println!("{paths} paths, {taken_back} events taken back");
    assert!(paths >= 10 && taken_back >= 30, "{paths} {taken_back}");
}
