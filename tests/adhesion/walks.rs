//! What holds of every path: energies balance, nothing is gained, closed minor loops restore the state, and every state
//! is on its law.

use asperity::adhesion::{Adhesion, AdhesiveFields, AdhesivePath, AdhesiveState, NodeState};
use asperity::surface::{Amplitude, SelfAffine};
use asperity::{
    Boussinesq, ContactTarget, Grid, InfluenceKernel, KernelTable, PeriodicBoussinesq, Spectral,
};
use nalgebra::DVector;
use proptest::prelude::*;

/// Law, gaps, pressures and energies of a state, from its pressures and nothing else.
fn check_state(path: &AdhesivePath, kernel: &KernelTable, state: &AdhesiveState) -> AdhesiveFields {
    let fields = path.fields_at(state).unwrap();
    let (problem, law, area) = (path.problem(), path.law(), path.grid().cell_area());
    let pressure = DVector::from_column_slice(fields.pressure.as_slice());
    let displaced: Vec<f64> = (0..pressure.len())
        .map(|i| {
            (0..pressure.len()).map(|j| problem.coefficient(i, j).unwrap() * pressure[j]).sum()
        })
        .collect();
    let approach = state.contact.approach + kernel.gauge().unwrap_or_default() * pressure.sum();
    let length = problem.greatest_gap() + approach.abs() + law.range();
    let mut energies = [0.0; 2];
    for (i, node) in fields.nodes.iter().enumerate() {
        let gap = problem.initial_gap()[i] + displaced[i] - approach;
        assert!((gap - fields.gap[i]).abs() < 1e-11 * length, "{gap} {}", fields.gap[i]);
        match node {
            NodeState::Contact => assert!(pressure[i] >= -law.stress() * (1.0 + 1e-9)),
            NodeState::Held => panic!("held outside of a jump"),
            _ => {
                assert!(gap > -1e-10 * length);
                assert!(
                    (pressure[i] + law.pull(gap)).abs() < 1e-8 * law.stress(),
                    "{node:?} {gap}"
                );
                let [least, most] = match node {
                    NodeState::Cohesive => [0.0, law.flat_range()],
                    NodeState::Soft => [law.flat_range(), law.range()],
                    _ => [law.range(), f64::INFINITY],
                };
                // Of a gap as that of the pull.
                let rounding = 1e-8 * length;
                assert!(
                    gap >= least - rounding && gap <= most + rounding,
                    "{node:?} {gap} of {law:?}"
                );
            }
        }
        energies[0] += 0.5 * area * pressure[i] * displaced[i];
        energies[1] += area * law.energy(gap.max(0.0));
    }
    let count = |kind| fields.nodes.iter().filter(|node| **node == kind).count();
    assert_eq!(
        [state.soft_nodes, state.cohesive_nodes, state.contact.contact_nodes],
        [NodeState::Soft, NodeState::Cohesive, NodeState::Contact].map(count),
        "{state:?}"
    );
    // About the mean planes.
    energies[0] -= 0.5 * area * kernel.gauge().unwrap_or_default() * pressure.sum().powi(2);
    // Sums over all states before: rounding of the greatest, however little is left where all but come apart.
    let whole = law.work() * path.grid().nominal_area();
    let unit = state.work.abs() + energies[0].abs() + energies[1].abs() + whole;
    assert!((state.contact.energy - energies[0]).abs() < 1e-10 * unit, "{state:?} {energies:?}");
    assert!((state.adhesive_energy - energies[1]).abs() < 1e-10 * unit, "{state:?} {energies:?}");
    assert!(
        (area * pressure.sum() - state.contact.load).abs()
            < 1e-10 * area * law.stress() * pressure.len() as f64
    );
    fields
}

/// Goes to an approach, and checks all on the way that costs nothing: the dissipation only grows.
fn go(path: &mut AdhesivePath, to: f64) -> AdhesiveState {
    let present = path.state().map_or(f64::NEG_INFINITY, |state| state.contact.approach);
    let target = ContactTarget::Approach(to);
    if to >= present {
        path.load_to(target).unwrap()
    } else {
        path.unload_to(target).unwrap()
    }
    let mut dissipated = path.state().map_or(0.0, |state| state.dissipated);
    let unit = path.law().work() * path.grid().nominal_area();
    for state in path.by_ref() {
        let state = state.unwrap();
        assert!(state.dissipated >= dissipated - 1e-14 * unit, "{state:?} {dissipated}");
        dissipated = state.dissipated;
        let sum = state.contact.energy + state.adhesive_energy + state.dissipated;
        assert!((sum - state.work).abs() < 1e-12 * unit, "{state:?}");
    }
    path.state().unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(16) })]

    #[test]
    fn closed_loops_restore_the_state(
        seed in 0..10_000_u64,
        which in 0..3_usize,
        work in 1e-5..3e-3_f64,
        resolution in 0.3..0.75_f64,
        flat in prop::bool::ANY,
        turns in prop::collection::vec(0.0..1.0_f64, 5),
        window in 1..40_usize,
    ) {
        let grid = Grid::new(14, 10, 1.0 / 14.0, 0.1).unwrap();
        let kernels: [Box<dyn InfluenceKernel>; 3] = [
            Box::new(Boussinesq::new(grid, 1.0).unwrap()),
            Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()),
            Box::new(Spectral::new(grid, 1.0).unwrap()),
        ];
        let kernel: &dyn InfluenceKernel = kernels[which].as_ref();
        let surface = SelfAffine::new(0.8, 0.5, 0.3, Amplitude::RmsHeight(0.02), seed).unwrap();
        let unit = Adhesion::work(1e-9).range(1.0).on(kernel).unwrap().resolution();
        // A triangle of this slope, or a trapezoid of it.
        let range = (work * unit / (1e-9 * resolution)).sqrt();
        let law = if flat {
            // h₁ is a third of h₂: w = σ₀ (4/3) h₂ / 2, k = σ₀ / ((2/3) h₂).
            let range = range / 2.0_f64.sqrt();
            Adhesion::maugis(work, 1.5 * work / range).range(range)
        } else {
            Adhesion::work(work).range(range)
        };
        let Ok(_) = law.on(kernel) else { return Ok(()) };
        let table = KernelTable::new(kernel).unwrap();
        let builder = AdhesivePath::builder(&surface, kernel, law).window_size(window);
        let mut path = builder.build().unwrap();
        let at = |part: f64| -range + part * (0.03 + range);
        go(&mut path, at(1.0));
        // Loops within loops: each closes at the approach where it began.
        let mut levels = turns.clone();
        levels.sort_by(f64::total_cmp);
        let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|k| at(levels[k]));
        let first = go(&mut path, a);
        let start = check_state(&path, &table, &first);
        let up = go(&mut path, e);
        let top = check_state(&path, &table, &up);
        let down = go(&mut path, b);
        let inner = check_state(&path, &table, &down);
        let higher = go(&mut path, d);
        check_state(&path, &table, &higher);
        let low = go(&mut path, c);
        check_state(&path, &table, &low);
        go(&mut path, d);
        let again = go(&mut path, b);
        let is_exact = which < 2;
        if is_exact && table.gauge().is_none() {
            let same = check_state(&path, &table, &again);
            prop_assert_eq!(&same.nodes, &inner.nodes);
            prop_assert!((&same.gap - &inner.gap).amax() < 1e-10);
            let back = go(&mut path, e);
            let same = check_state(&path, &table, &back);
            prop_assert_eq!(&same.nodes, &top.nodes);
            let back = go(&mut path, a);
            let same = check_state(&path, &table, &back);
            prop_assert_eq!(&same.nodes, &start.nodes);
            prop_assert!((&same.pressure - &start.pressure).amax() < 1e-8 * path.law().stress());
        }
        path.unload().unwrap();
        for state in path.by_ref() {
            prop_assert!(state.is_ok());
        }
        let apart = path.state().unwrap();
        prop_assert_eq!((apart.contact.load, apart.contact.contact_nodes), (0.0, 0));
        prop_assert_eq!((apart.soft_nodes, apart.cohesive_nodes), (0, 0));
        // What the closed path has cost is what jumps took.
        prop_assert!((apart.work - apart.dissipated).abs() < 1e-12 * path.law().work() * grid.nominal_area());
    }
}
