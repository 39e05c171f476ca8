//! What holds of every path: energies balance, nothing is gained, closed minor loops restore the state, and every state
//! is on its law.

use std::cell::Cell;

use asperity::adhesion::{
    Adhesion, AdhesiveEvent, AdhesiveFields, AdhesivePath, AdhesiveState, NodeState,
};
use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::surface::{Amplitude, Axis, HeightMap, SelfAffine};
use asperity::{
    Boussinesq, ContactGrowth, ContactTarget, Grid, InfluenceKernel, KernelTable,
    PeriodicBoussinesq, SemiPeriodicBoussinesq, Spectral,
};
use asperity_testing::surfaces::scattered;
use nalgebra::DVector;
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};

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

/// A random walk: surface, law, where it turns, and how many nodes are watched.
#[derive(Debug)]
struct Walk {
    seed: u64,
    work: f64,
    resolution: f64,
    flat: bool,
    turns: Vec<f64>,
    window: usize,
}

fn walks() -> impl Strategy<Value = Walk> {
    let law = (1e-5..3e-3_f64, 0.3..0.75_f64, prop::bool::ANY);
    (0..10_000_u64, law, prop::collection::vec(0.0..1.0_f64, 5), 1..40_usize).prop_map(
        |(seed, (work, resolution, flat), turns, window)| Walk {
            seed,
            work,
            resolution,
            flat,
            turns,
            window,
        },
    )
}

/// The approach of a state in the gauge of the kernel, in which jumps stand still.
fn in_gauge(path: &AdhesivePath, kernel: &KernelTable, state: &AdhesiveState) -> f64 {
    let sum = state.contact.load / path.grid().cell_area();
    state.contact.approach + kernel.gauge().unwrap_or_default() * sum
}

/// Walks up and down, with loops within loops; returns how many of three closed and were compared.
fn loops(kernel: &dyn InfluenceKernel, walk: Walk) -> usize {
    let Walk { seed, work, resolution, flat, turns: mut levels, window } = walk;
    let surface = SelfAffine::new(0.8, 0.5, 0.3, Amplitude::RmsHeight(0.02), seed).unwrap();
    let unit = Adhesion::work(1e-9).range(1.0).on(kernel).unwrap().resolution();
    // A triangle of this slope, or a trapezoid of it.
    let range = (work * unit / (1e-9 * resolution)).sqrt();
    let law = if flat {
        // h₁ is a third of h₂: w = σ₀ (4/3) h₂ / 2, k = σ₀ / ((2/3) h₂) = (9/4) w / h₂², that of a triangle 2w / h₂².
        let range = range * 1.125_f64.sqrt();
        Adhesion::maugis(work, 1.5 * work / range).range(range)
    } else {
        Adhesion::work(work).range(range)
    };
    let found = law.on(kernel).unwrap().resolution();
    assert!((found / resolution - 1.0).abs() < 1e-9, "{found} {resolution}");
    let table = KernelTable::new(kernel).unwrap();
    let builder = AdhesivePath::builder(&surface, kernel, law).window_size(window);
    let mut path = builder.build().unwrap();
    let at = |part: f64| -range + part * (0.03 + range);
    go(&mut path, at(1.0));
    // Loops within loops: each closes at the approach where it began.
    levels.sort_by(f64::total_cmp);
    let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|k| at(levels[k]));
    let turn = |path: &mut AdhesivePath, to: f64| {
        let state = go(path, to);
        (in_gauge(path, &table, &state), check_state(path, &table, &state))
    };
    let [start, top, inner, higher, _] = [a, e, b, d, c].map(|to| turn(&mut path, to));
    let mut closed = 0;
    for (to, began) in [(d, &higher), (b, &inner), (e, &top), (a, &start)] {
        let (approach, fields) = turn(&mut path, to);
        // Mean planes that have approached as far need not be at the same state: a jump may lie between. Once a loop
        // has not closed the path is another one.
        if kernel.contact_growth() != ContactGrowth::Convex || (approach - began.0).abs() > 1e-10 {
            break;
        }
        assert_eq!(fields.nodes, began.1.nodes);
        assert!((&fields.gap - &began.1.gap).amax() < 1e-10);
        let error = (&fields.pressure - &began.1.pressure).amax();
        assert!(error < 1e-8 * path.law().stress(), "{error:e}");
        closed += 1;
    }
    path.unload().unwrap();
    path.by_ref().for_each(|state| assert!(state.is_ok()));
    let apart = path.state().unwrap();
    assert_eq!((apart.contact.load, apart.contact.contact_nodes), (0.0, 0));
    assert_eq!((apart.soft_nodes, apart.cohesive_nodes), (0, 0));
    // What the closed path has cost is what jumps took.
    let whole = path.law().work() * path.grid().nominal_area();
    assert!((apart.work - apart.dissipated).abs() < 1e-12 * whole);
    closed
}

/// On kernels on which gaps are convex; on the others energies balance all the same.
#[test]
fn closed_loops_restore_the_state() {
    let grid = Grid::new(14, 10, 1.0 / 14.0, 0.1).unwrap();
    let along = |axis| Box::new(SemiPeriodicBoussinesq::new(grid, 1.0, axis).unwrap());
    let kernels: [(Box<dyn InfluenceKernel>, usize); 5] = [
        (Box::new(Boussinesq::new(grid, 1.0).unwrap()), 1),
        (Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()), 1),
        (along(Axis::X), 1),
        (along(Axis::Y), 1),
        (Box::new(Spectral::new(grid, 1.0).unwrap()), 0),
    ];
    for (kernel, floor) in kernels {
        let closed = Cell::new(0);
        let config = ProptestConfig {
            failure_persistence: None,
            rng_seed: RngSeed::Fixed(1),
            ..ProptestConfig::with_cases(6)
        };
        let all = TestRunner::new(config).run(&walks(), |walk| {
            closed.set(closed.get() + loops(&*kernel, walk));
            Ok(())
        });
        println!("{:?} {}", kernel.origin(), closed.get());
        assert!(all.is_ok(), "{:?}: {all:?}", kernel.origin());
        assert!(closed.get() >= floor, "{:?}: {}", kernel.origin(), closed.get());
    }
}

/// Where a pull may open gaps elsewhere, a node that parts while the approach grows may close others.
#[test]
fn nodes_part_and_others_close() {
    let grid = Grid::new(32, 1, 1.0, 1.0).unwrap();
    let layer = Layer { youngs_modulus: 1.0, poissons_ratio: 0.49, thickness: 8.0 };
    let sheet = LayeredBody::new(&[layer], Base::Rigid).unwrap();
    let kernel = Layered::periodic(grid, sheet).unwrap();
    assert_eq!(kernel.contact_growth(), ContactGrowth::Monotone);
    let table = KernelTable::new(&kernel).unwrap();
    let unit = Adhesion::work(1e-3).range(1.0).on(&kernel).unwrap().resolution();
    let range: f64 = 2.4;
    let law = Adhesion::work(1e-3 * 0.45 / unit * range.powi(2)).range(range);
    let mut parted = 0;
    for seed in 0..20 {
        let surface = HeightMap::new(scattered(grid.shape(), 10_007, seed) / 10_007.0).unwrap();
        let mut path = AdhesivePath::builder(&surface, &kernel, law).build().unwrap();
        path.load_to(ContactTarget::Approach(-0.5)).unwrap();
        let loading = path.run().unwrap();
        let events = loading.states().iter().map(|state| state.event);
        parted += events.filter(|&event| event == AdhesiveEvent::Part).count();
        for to in [-1.2, 1.0] {
            let state = go(&mut path, to);
            check_state(&path, &table, &state);
        }
    }
    assert!(parted > 30, "{parted}");
}
