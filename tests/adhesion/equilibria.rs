//! Every equilibrium of a small grid, found by trying all states of all nodes: loading is at the one of the greatest
//! gaps, and unloading at that of the least.

use asperity::adhesion::{Adhesion, AdhesiveEvent, AdhesiveFields, AdhesivePath, CohesiveLaw};
use asperity::surface::HeightMap;
use asperity::{Boussinesq, ContactTarget, Grid, InfluenceKernel, PeriodicBoussinesq, Problem};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// Influence, initial gaps and law.
struct Small {
    matrix: DMatrix<f64>,
    gap: DVector<f64>,
    law: CohesiveLaw,
}

const OPEN: usize = 0;
const SOFT: usize = 1;
const CONTACT: usize = 2;
const COHESIVE: usize = 3;

impl Small {
    fn of(problem: &Problem, law: CohesiveLaw) -> Self {
        let nodes = problem.initial_gap().len();
        Self {
            matrix: DMatrix::from_fn(nodes, nodes, |i, j| problem.coefficient(i, j).unwrap()),
            gap: DVector::from_column_slice(problem.initial_gap()),
            law,
        }
    }

    /// The approach in the gauge of the kernel.
    fn approach(&self, fields: &AdhesiveFields) -> f64 {
        let pressure = DVector::from_column_slice(fields.pressure.as_slice());
        (&self.gap + &self.matrix * pressure)[0] - fields.gap[0]
    }

    /// Gaps of the state with nodes so, if that is a strict minimum of the energy.
    fn equilibrium(&self, nodes: &[usize], approach: f64) -> Option<DVector<f64>> {
        let law = &self.law;
        let size = nodes.len();
        let free: Vec<usize> = (0..size).filter(|&i| matches!(nodes[i], SOFT | CONTACT)).collect();
        let mut pressure =
            DVector::from_fn(size, |i, _| if nodes[i] == COHESIVE { -law.stress() } else { 0.0 });
        let base = &self.gap + &self.matrix * &pressure;
        let shift = |i: usize| if nodes[i] == SOFT { 1.0 / law.slope() } else { 0.0 };
        let reduced = DMatrix::from_fn(free.len(), free.len(), |i, j| {
            self.matrix[(free[i], free[j])] - if i == j { shift(free[i]) } else { 0.0 }
        });
        let right = DVector::from_fn(free.len(), |i, _| {
            let range = if nodes[free[i]] == SOFT { law.range() } else { 0.0 };
            range + approach - base[free[i]]
        });
        let solved =
            if free.is_empty() { right.clone() } else { reduced.clone().lu().solve(&right)? };
        free.iter().zip(solved.iter()).for_each(|(&i, &p)| pressure[i] = p);
        let gap = &self.gap + &self.matrix * &pressure - DVector::from_element(size, approach);
        let is_on_law = (0..size).all(|i| match nodes[i] {
            OPEN => gap[i] > law.range(),
            SOFT => gap[i] < law.range() && gap[i] > law.flat_range(),
            COHESIVE => gap[i] < law.flat_range() && gap[i] > 0.0,
            _ => pressure[i] > -law.stress(),
        });
        let soft = nodes.iter().filter(|&&node| node == SOFT).count();
        let is_stable = || {
            let values = match free.len() {
                0 => Vec::new(),
                1 => vec![reduced[(0, 0)]],
                _ => reduced.clone().symmetric_eigenvalues().as_slice().to_vec(),
            };
            values.iter().filter(|&&value| value < 0.0).count() == soft
        };
        (is_on_law && is_stable()).then_some(gap)
    }

    fn all(&self, kinds: usize, approach: f64) -> Vec<DVector<f64>> {
        let size = self.gap.len() as u32;
        let states = (0..kinds.pow(size))
            .map(|code| (0..size).map(|i| code / kinds.pow(i) % kinds).collect::<Vec<usize>>());
        states.filter_map(|nodes| self.equilibrium(&nodes, approach)).collect()
    }
}

/// Compares states of both branches at some approaches with all equilibria there; returns how many there were at most.
fn check(
    kernel: &dyn InfluenceKernel,
    heights: Vec<f64>,
    law: Adhesion,
    ends: &mut [f64],
) -> usize {
    let (nx, ny) = kernel.grid().shape();
    let surface = HeightMap::new(DMatrix::from_vec(nx, ny, heights)).unwrap();
    let mut path = AdhesivePath::builder(&surface, kernel, law).build().unwrap();
    let small = Small::of(path.problem(), path.law());
    let kinds = if path.law().flat_range() > 0.0 { 4 } else { 3 };
    ends.sort_by(f64::total_cmp);
    let mut most = 0;
    let mut compare = |path: &mut AdhesivePath, is_loading: bool| {
        path.by_ref().try_for_each(|state| state.map(|_| ())).unwrap();
        // Behind a jump that went past the end a node may be at a corner of its law; and mean planes approach so far
        // and no further.
        let Some(state) = path.state().filter(|state| state.event == AdhesiveEvent::Limit) else {
            return;
        };
        let fields = path.fields_at(&state).unwrap();
        let approach = small.approach(&fields);
        let found = DVector::from_column_slice(fields.gap.as_slice());
        let all = small.all(kinds, approach);
        most = most.max(all.len());
        let same = |gap: &DVector<f64>| (gap - &found).amax() < 1e-10;
        assert_eq!(all.iter().filter(|gap| same(gap)).count(), 1, "{state:?} of {}", all.len());
        for gap in all {
            let beyond = if is_loading { &gap - &found } else { &found - &gap };
            assert!(beyond.max() < 1e-10, "{state:?}: {}", beyond.max());
        }
    };
    for &end in ends.iter() {
        if path.load_to(ContactTarget::Approach(end)).is_ok() {
            compare(&mut path, true);
        }
    }
    path.load_to(ContactTarget::AreaFraction(1.0)).unwrap();
    path.by_ref().try_for_each(|state| state.map(|_| ())).unwrap();
    for &end in ends.iter().rev() {
        if path.unload_to(ContactTarget::Approach(end)).is_ok() {
            compare(&mut path, false);
        }
    }
    most
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(24) })]

    #[test]
    fn triangles_on_four_by_two_nodes(
        heights in prop::collection::vec(-0.03..0.03_f64, 8),
        range in 0.01..0.04_f64,
        resolution in 0.3..0.8_f64,
        mut ends in prop::collection::vec(-0.03..0.04_f64, 3),
        is_periodic: bool,
    ) {
        let grid = Grid::new(4, 2, 0.25, 0.25).unwrap();
        let free = Boussinesq::new(grid, 1.0).unwrap();
        let periodic = PeriodicBoussinesq::new(grid, 1.0).unwrap();
        let kernel: &dyn InfluenceKernel = if is_periodic { &periodic } else { &free };
        let unit = Adhesion::work(1e-9).range(1.0).on(kernel).unwrap().resolution();
        let law = Adhesion::work(1e-9 * resolution / unit * range * range).range(range);
        check(kernel, heights, law, &mut ends);
    }

    #[test]
    fn trapezoids_on_three_by_two_nodes(
        heights in prop::collection::vec(-0.03..0.03_f64, 6),
        range in 0.01..0.04_f64,
        part in 0.05..0.8_f64,
        resolution in 0.3..0.8_f64,
        mut ends in prop::collection::vec(-0.03..0.04_f64, 3),
        is_periodic: bool,
    ) {
        let grid = Grid::new(3, 2, 1.0 / 3.0, 1.0 / 3.0).unwrap();
        let free = Boussinesq::new(grid, 1.0).unwrap();
        let periodic = PeriodicBoussinesq::new(grid, 1.0).unwrap();
        let kernel: &dyn InfluenceKernel = if is_periodic { &periodic } else { &free };
        let law = Adhesion::work(1e-9).range(1.0).on(kernel).unwrap();
        let compliance = law.resolution() / law.slope();
        let stress = resolution / compliance * range * (1.0 - part);
        let law = Adhesion::maugis(0.5 * stress * range * (1.0 + part), stress).range(range);
        check(kernel, heights, law, &mut ends);
    }
}

/// Surfaces on which there are several minima, so that the branches differ.
#[test]
fn branches_differ_where_there_are_several_equilibria() {
    let grid = Grid::new(4, 2, 0.25, 0.25).unwrap();
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    let heights = vec![0.0; 8];
    let unit = Adhesion::work(1e-9).range(1.0).on(&kernel).unwrap().resolution();
    let law = Adhesion::work(1e-9 * 0.79 / unit * 0.02 * 0.02).range(0.02);
    let most = check(&kernel, heights, law, &mut [-0.0225, -0.021, -0.0195]);
    assert!(most > 1, "{most}");
}
