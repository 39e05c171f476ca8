//! Every equilibrium of a small grid, found by trying all states of all nodes: loading is at the one of the greatest
//! gaps, and unloading at that of the least.

use asperity::adhesion::{Adhesion, AdhesiveEvent, AdhesivePath};
use asperity::surface::HeightMap;
use asperity::{Boussinesq, ContactTarget, Grid, InfluenceKernel, PeriodicBoussinesq};
use asperity_testing::equilibria::Equilibria;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

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
    let small = Equilibria::of(path.problem(), path.law());
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
