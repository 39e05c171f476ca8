//! Single loads with a hardness, against paths of events from dense solutions.

use std::path::Path;

use asperity::io::read_npy;
use asperity::kernel::KernelTable;
use asperity::surface::{Amplitude, FlatPunch, HeightMap, Paraboloid, SelfAffine};
use asperity::{
    Boundary, Boussinesq, ContactGrowth, ContactTarget, Error, FixedLoadSolution, FixedLoadSolver,
    Grid, InfluenceKernel, KernelError, PeriodicBoussinesq, Spectral,
};
use nalgebra::DMatrix;

const E_STAR: f64 = 115e9;
const HARDNESS: f64 = 3e9;

/// An event of a path: 16 × 12 nodes, from the first touch to full yielding (see `tests/data/README.md`).
struct Event {
    yields: bool,
    node: usize,
    approach: f64,
    load: f64,
    mean_gap: f64,
    interfacial_stiffness: f64,
    plastic_work: f64,
    plastic_volume: f64,
}

fn events(name: &str) -> Vec<Event> {
    let text = std::fs::read_to_string(data(&format!("{name}_events.csv"))).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let place = |name: &str| header.iter().position(|column| *column == name).unwrap();
    lines
        .map(|line| {
            let number = |name: &str| line[place(name)].parse::<f64>().unwrap();
            Event {
                yields: line[place("event")] == "yield",
                node: number("ix") as usize + 16 * number("iy") as usize,
                approach: number("approach"),
                load: number("load"),
                mean_gap: number("mean_gap"),
                interfacial_stiffness: number("interfacial_stiffness"),
                plastic_work: number("plastic_work"),
                plastic_volume: number("plastic_volume"),
            }
        })
        .collect()
}

fn data(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/hardness").join(name)
}

fn grid() -> Grid {
    Grid::new(16, 12, 2e-5, 3e-5).unwrap()
}

fn surface(name: &str) -> HeightMap {
    HeightMap::new(read_npy(data(&format!("{name}.npy"))).unwrap()).unwrap()
}

fn kernels() -> [(&'static str, Box<dyn InfluenceKernel>); 3] {
    [
        ("free_16x12_0.1", Box::new(Boussinesq::new(grid(), E_STAR).unwrap())),
        ("periodic_love_16x12_0.5", Box::new(PeriodicBoussinesq::new(grid(), E_STAR).unwrap())),
        ("periodic_spectral_16x12_1.5", Box::new(Spectral::new(grid(), E_STAR).unwrap())),
    ]
}

fn near(found: f64, expected: f64, allowed: f64, context: &str) {
    assert!((found - expected).abs() <= allowed, "{context}: {found:e} {expected:e} {allowed:e}");
}

/// Halfway between two events everything but energies is the mean of both, and the sets are those of the events so far.
#[test]
fn states_lie_on_the_path() {
    for (name, kernel) in kernels() {
        let (events, heights) = (events(name), surface(name));
        assert_eq!(events.len(), 2 * grid().nodes());
        let mut solver = FixedLoadSolver::builder(&heights, &*kernel)
            .hardness(HARDNESS)
            .tolerance(1e-11)
            .build()
            .unwrap();
        let longest = events.last().unwrap().approach;
        let mut compared = 0;
        for k in (2..events.len() - 1).step_by(7) {
            let (this, next) = (&events[k], &events[k + 1]);
            // Where hardly any load lies between them the sets rest on rounding.
            if next.load - this.load < 1e-6 * next.load {
                continue;
            }
            let context = format!("{name} after event {k}");
            let mean = |of: fn(&Event) -> f64| 0.5 * (of(this) + of(next));
            let solution = solver.solve(mean(|event| event.load)).unwrap();
            let plastic = solution.contact.plastic.unwrap();
            for node in 0..grid().nodes() {
                let has = |yields| {
                    events[..=k].iter().any(|event| event.yields == yields && event.node == node)
                };
                assert_eq!(
                    solution.fields.contact_map.as_slice()[node],
                    has(false),
                    "{context}: {node}"
                );
                assert_eq!(
                    solution.fields.yielded_map.as_slice()[node],
                    has(true),
                    "{context}: {node}"
                );
            }
            let state = &solution.contact;
            // Gaps are right to 1e-11 of the approach; a plateau has none of its own.
            let allowed = 1e-9 * longest;
            near(state.approach, mean(|event| event.approach), allowed, &context);
            near(state.mean_gap, mean(|event| event.mean_gap), allowed, &context);
            let area = grid().nominal_area();
            near(plastic.volume, mean(|event| event.plastic_volume), allowed * area, &context);
            near(
                plastic.work,
                mean(|event| event.plastic_work),
                HARDNESS * allowed * area,
                &context,
            );
            // Until the next event the stiffness is that of this one. Rates are solved for to 10⁻¹⁰, and here as well
            // as below the condition number of some 10² comes to gaps right to 10⁻¹¹.
            if this.interfacial_stiffness.is_finite() {
                let found = state.interfacial_stiffness.unwrap();
                near(found / this.interfacial_stiffness, 1.0, 1e-8, &context);
            }
            conditions(&solution, &context);
            compared += 1;
            // In full contact mean planes stay where they are until a node yields.
            if next.approach - this.approach < 1e-6 * next.approach {
                continue;
            }
            let by_approach = solver.solve_approach(mean(|event| event.approach)).unwrap();
            assert_eq!(by_approach.fields.contact_map, solution.fields.contact_map, "{context}");
            let yielded = [&by_approach, &solution].map(|solution| &solution.fields.yielded_map);
            assert_eq!(yielded[0], yielded[1], "{context}");
            near(by_approach.contact.load / state.load, 1.0, 1e-8, &context);
        }
        assert!(compared > 40, "{name}: {compared}");
    }
}

/// 0 ≤ p ≤ H, gaps ≥ 0, pressure only where the gap is closed, plastic depth only where p = H.
fn conditions(solution: &FixedLoadSolution, context: &str) {
    let fields = &solution.fields;
    let length = 1e-9 * solution.certificate.length;
    for node in 0..solution.fields.pressure.len() {
        let (p, gap) = (solution.fields.pressure[node], solution.fields.gap[node]);
        let (depth, has_yielded) = (fields.plastic_depth[node], fields.yielded_map[node]);
        assert!((0.0..=HARDNESS).contains(&p) && depth >= 0.0, "{context}: {p} {depth}");
        assert!(gap >= -length && (p == 0.0 || gap <= length), "{context}: {p} {gap}");
        assert!(has_yielded || depth == 0.0, "{context}");
        assert!(!has_yielded || p == HARDNESS, "{context}: {p}");
    }
    let certificate = &solution.certificate;
    assert!(certificate.greatest_contact_gap <= 1e-9, "{context}: {certificate:?}");
    assert!(solution.contact.plastic.unwrap().yielded_nodes <= solution.contact.contact_nodes);
}

/// The surface less its plastic depth carries the same pressures elastically, at the approach less what is left of the
/// highest node.
#[test]
fn unloading_is_elastic_on_the_residual_surface() {
    for (name, kernel) in kernels() {
        let heights = surface(name);
        let events = events(name);
        let load = events[200].load;
        let mut solver = FixedLoadSolver::builder(&heights, &*kernel)
            .hardness(HARDNESS)
            .tolerance(1e-11)
            .build()
            .unwrap();
        let solution = solver.solve(load).unwrap();
        let residual = solution.residual_surface(&heights).unwrap();
        let mut elastic =
            FixedLoadSolver::builder(&residual, &*kernel).tolerance(1e-11).build().unwrap();
        let again = elastic.solve(load).unwrap();
        assert!(again.contact.plastic.is_none());
        let lowered = heights.max_height() - residual.max_height();
        near(again.contact.approach + lowered, solution.contact.approach, 1e-14, name);
        near(again.contact.energy / solution.contact.energy, 1.0, 1e-8, name);
        // Gaps of both solutions are right to 10⁻¹¹ of the approach, and pressures to that over the compliance of a
        // wave of two cells, some ten times as stiff as the contact.
        for (found, expected) in again.fields.pressure.iter().zip(&solution.fields.pressure) {
            near(*found, *expected, 1e-8 * HARDNESS, name);
        }
    }
}

/// C = ((2, 1), (1, 2)), g = (0, 1), H = 3/4, worked out by hand: touch 0 at 0, yield 0 at 3/2, touch 1 at 7/4, yield 1
/// at 13/4.
#[test]
fn two_nodes_by_hand() {
    let grid = Grid::new(2, 1, 1.0, 1.0).unwrap();
    let kernel = KernelTable::from_fn(grid, Boundary::Free, ContactGrowth::Monotone, |di, _| {
        if di == 0 { 2.0 } else { 1.0 }
    })
    .unwrap();
    let heights = HeightMap::new(DMatrix::from_row_slice(2, 1, &[0.0, -1.0])).unwrap();
    let mut solver = FixedLoadSolver::builder(&heights, &kernel)
        .hardness(0.75)
        .tolerance(1e-12)
        .build()
        .unwrap();
    // (approach, pressures, yielded, plastic depth of node 0)
    for (approach, pressures, yielded, depth) in [
        (1.0, [0.5, 0.0], [false, false], 0.0),
        (1.625, [0.75, 0.0], [true, false], 0.125),
        // 2 p₁ + 3/4 = δ − 1.
        (2.75, [0.75, 0.5], [true, false], 0.75),
        (4.0, [0.75, 0.75], [true, true], 1.75),
    ] {
        let solution = solver.solve_approach(approach).unwrap();
        for (found, expected) in solution.fields.pressure.iter().zip(pressures) {
            near(*found, expected, 1e-11, "pressure");
        }
        let fields = &solution.fields;
        assert_eq!(fields.yielded_map.as_slice(), yielded, "{approach}");
        near(fields.plastic_depth[0], depth, 1e-11, "depth");
        // On the plateau, and behind the end, the load stays what it is.
        let flat = [false, true, false, true]
            [[1.0, 1.625, 2.75, 4.0].iter().position(|a| *a == approach).unwrap()];
        assert_eq!(solution.contact.contact_stiffness == Some(0.0), flat, "{approach}");
    }
    for load in [1.5, 2.0] {
        assert!(matches!(
            solver.solve(load),
            Err(Error::BeyondHardness { load: found, mean_pressure, hardness })
                if found == load && mean_pressure / hardness == load / 1.5
        ));
    }
    near(solver.solve(1.25).unwrap().contact.approach, 2.75, 1e-11, "approach");
}

/// A hardness without end, or above all pressures, changes nothing.
#[test]
fn a_great_hardness_is_none() {
    let (name, kernel) = kernels().into_iter().next().unwrap();
    let heights = surface(name);
    let solve = |hardness: Option<f64>| {
        let builder = FixedLoadSolver::builder(&heights, &*kernel);
        let builder = hardness.map_or(builder, |hardness| builder.hardness(hardness));
        builder.build().unwrap().solve(100.0).unwrap()
    };
    let elastic = solve(None);
    assert_eq!(solve(Some(f64::INFINITY)), elastic);
    let high = solve(Some(10.0 * elastic.fields.max_pressure()));
    assert_eq!(high.fields.contact_map, elastic.fields.contact_map);
    assert_eq!(high.contact.plastic.unwrap().yielded_nodes, 0);
    // The greatest pressure is a tenth of it, to what is allowed of pressures below.
    near(high.certificate.excess_pressure.unwrap(), -0.9, 1e-8, "excess");
    assert_eq!(elastic.certificate.excess_pressure, None);
    for (found, expected) in high.fields.pressure.iter().zip(&elastic.fields.pressure) {
        near(*found, *expected, 1e-7 * elastic.fields.max_pressure(), "pressure");
    }
    // A map of one value is that value, and one that is infinite at places limits the others alone.
    let soft = solve(Some(HARDNESS));
    let map = DMatrix::from_element(16, 12, HARDNESS);
    let builder = FixedLoadSolver::builder(&heights, &*kernel).hardness_map(&map);
    assert_eq!(builder.build().unwrap().solve(100.0).unwrap(), soft);
    let mut map = map;
    let hardest = soft.fields.yielded_map.iter().position(|y| *y).unwrap();
    map[hardest] = f64::INFINITY;
    let builder = FixedLoadSolver::builder(&heights, &*kernel).hardness_map(&map);
    let mixed = builder.build().unwrap().solve(100.0).unwrap();
    assert!(
        mixed.fields.pressure[hardest] > HARDNESS
            && mixed.contact.plastic.unwrap().yielded_nodes > 0
    );
}

/// Area and mean gap as targets, and a sweep, lead to the states of the same loads.
#[test]
fn targets_and_sweeps() {
    for (name, kernel) in kernels() {
        let heights = surface(name);
        let builder =
            FixedLoadSolver::builder(&heights, &*kernel).hardness(HARDNESS).tolerance(1e-10);
        let mut solver = builder.build().unwrap();
        let load = events(name)[150].load * 1.001;
        let solution = solver.solve(load).unwrap();
        let target = ContactTarget::MeanGap(solution.contact.mean_gap);
        let found = solver.solve_target(target).unwrap();
        // The tolerance of gaps, 10⁻¹⁰, over what part of the approach the mean gap falls by.
        near(found.contact.load / load, 1.0, 1e-8, name);
        let pressure = ContactTarget::MeanPressure(load / grid().nominal_area());
        assert_eq!(
            solver.solve_target(pressure).unwrap().contact.contact_nodes,
            solution.contact.contact_nodes
        );
        let refused = solver.solve_target(ContactTarget::MeanPressure(0.0)).unwrap_err();
        assert!(matches!(refused, Error::NotPositive { quantity: "mean pressure", .. }));
        let fraction = solution.contact.contact_area_fraction;
        let found = solver.solve_target(ContactTarget::AreaFraction(fraction)).unwrap();
        assert_eq!(found.contact.contact_nodes, solution.contact.contact_nodes, "{name}");
        let loads = [0.5 * load, load, 0.7 * load].map(ContactTarget::Load);
        let swept: Vec<_> = solver.sweep(loads).map(Result::unwrap).collect();
        assert_eq!(swept[1].fields.contact_map, solution.fields.contact_map, "{name}");
        assert_eq!(swept[1].fields.yielded_map, solution.fields.yielded_map, "{name}");
        assert_eq!(swept.len(), 3);
    }
}

/// A sweep starts each load at the nodes that yielded at the one before, as long as loads grow, and comes to the states
/// of loads on their own: with stiffnesses and without, and from a solution given.
#[test]
fn sweeps_go_on_from_what_has_yielded() {
    for (name, kernel) in kernels() {
        let heights = surface(name);
        let builder =
            || FixedLoadSolver::builder(&heights, &*kernel).hardness(HARDNESS).tolerance(1e-10);
        let events = events(name);
        let first = events[120].load;
        let loads: Vec<f64> = [1.0, 1.0, 1.2, 1.4, 1.5, 2.9, 1.1, 1.2].map(|f| f * first).to_vec();
        for stiffness in [true, false] {
            let mut solver = builder().stiffness(stiffness).build().unwrap();
            let mut alone = builder().stiffness(stiffness).build().unwrap();
            let swept: Vec<_> = solver
                .sweep(loads.iter().map(|&load| ContactTarget::Load(load)))
                .map(Result::unwrap)
                .collect();
            let mut earlier: Option<FixedLoadSolution> = None;
            for (&load, found) in loads.iter().zip(&swept) {
                let expected = alone.solve(load).unwrap();
                let context = format!("{name} at {load}");
                conditions(found, &context);
                let from = earlier.map(|earlier| alone.solve_from(&earlier, load).unwrap());
                for found in from.iter().chain([found]) {
                    assert_eq!(found.fields.contact_map, expected.fields.contact_map, "{context}");
                    let [a, b] = [found, &expected].map(|s| &s.fields.yielded_map);
                    assert_eq!(a, b, "{context}");
                    // Gaps are right to 1e-10 of the approach.
                    let length = 1e-8 * expected.certificate.length;
                    near(found.contact.approach, expected.contact.approach, length, &context);
                    near(found.contact.load, load, 1e-12 * load, &context);
                    assert!(found.certificate.excess_pressure.unwrap().abs() <= 1e-15);
                    let [a, b] = [found, &expected].map(|s| s.contact.plastic.unwrap());
                    assert_eq!(a.yielded_nodes, b.yielded_nodes);
                    // Rates of the same set of nodes, to 10⁻¹⁰ times a condition number.
                    if stiffness {
                        near(a.work_per_load / b.work_per_load, 1.0, 1e-8, &context);
                    }
                }
                earlier = Some(expected);
            }
        }
    }
}

/// A load near the last one costs less than one on its own: in convolutions, which count the same on every machine.
#[test]
fn near_loads_cost_less() {
    let half_space = Boussinesq::new(Grid::square(64, 1e-3).unwrap(), 230e9).unwrap();
    let surface = SelfAffine::new(0.8, 2.5e-4, 6.25e-5, Amplitude::RmsHeight(1e-6), 3).unwrap();
    let mut solver = FixedLoadSolver::builder(&surface, &half_space)
        .hardness(HARDNESS)
        .stiffness(false)
        .build()
        .unwrap();
    let loads: Vec<f64> = (0..10).map(|k| 100.0 * 1.1_f64.powi(k)).collect();
    let convolutions = |solution: &FixedLoadSolution| {
        solution.effort.convolutions as f64 + solution.effort.coarse_convolutions
    };
    let swept: f64 = solver
        .sweep(loads.iter().map(|&load| ContactTarget::Load(load)))
        .map(|solution| convolutions(&solution.unwrap()))
        .sum();
    let alone: f64 = loads.iter().map(|&load| convolutions(&solver.solve(load).unwrap())).sum();
    println!("{swept} convolutions in a sweep, {alone} one by one");
    assert!(swept < 0.8 * alone, "{swept} {alone}");
}

/// The volume that yields on further loading is the difference between two states with the same sets.
#[test]
fn plastic_rates_are_derivatives() {
    for (name, kernel) in kernels() {
        let heights = surface(name);
        let mut solver = FixedLoadSolver::builder(&heights, &*kernel)
            .hardness(HARDNESS)
            .tolerance(1e-11)
            .build()
            .unwrap();
        let events = events(name);
        let mut compared = 0;
        for k in (100..250).step_by(11) {
            let (from, to) = (events[k].load, events[k + 1].load);
            if to - from < 1e-4 * to {
                continue;
            }
            let at = |part: f64| from + part * (to - from);
            let [a, b] = [0.2, 0.8].map(|part| solver.solve(at(part)).unwrap().contact);
            let [va, vb] = [a, b].map(|state| state.plastic.unwrap());
            // Gaps to 1e-11 of the approach, over 1e-4 of it, on at most all nodes; both have the same sets.
            let length = 1e-9 * b.approach * grid().nominal_area();
            near(vb.volume - va.volume, va.volume_per_load * (b.load - a.load), length, name);
            near(vb.work - va.work, va.work_per_load * (b.load - a.load), HARDNESS * length, name);
            compared += 1;
        }
        assert!(compared > 3, "{name}: {compared}");
    }
}

/// Everything yields at once: flat surfaces, and a hardness next to nothing.
#[test]
fn all_yield_together() {
    let grid = Grid::new(6, 6, 1.0, 1.0).unwrap();
    for kernel in [
        Box::new(Spectral::new(grid, 1.0).unwrap()) as Box<dyn InfluenceKernel>,
        Box::new(Boussinesq::new(grid, 1.0).unwrap()),
    ] {
        let mut solver = FixedLoadSolver::builder(&FlatPunch::default(), &*kernel)
            .hardness(2.0)
            .build()
            .unwrap();
        for part in [0.5, 0.99, 0.999_999] {
            let solution = solver.solve(72.0 * part).unwrap();
            assert_eq!(solution.contact.contact_nodes, 36);
            near(solution.fields.pressure.sum(), 72.0 * part, 1e-9, "sum");
            assert!(solution.fields.max_pressure() <= 2.0);
        }
    }
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    for hardness in [1e-3, 1e-9, 1e-30] {
        let surface = Paraboloid::new(10.0).unwrap();
        let mut solver =
            FixedLoadSolver::builder(&surface, &kernel).hardness(hardness).build().unwrap();
        let solution = solver.solve(18.5 * hardness).unwrap();
        // The bearing area: 18 nodes carry the hardness, and one or more what is left.
        assert!((18..=36).contains(&solution.contact.contact_nodes), "{hardness}");
        assert!(solution.fields.max_pressure() <= hardness);
        near(solution.fields.pressure.sum() / hardness, 18.5, 1e-7, "sum");
    }
}

#[test]
fn what_is_no_hardness_is_refused() {
    let grid = Grid::new(6, 5, 1.0, 1.0).unwrap();
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    let surface = Paraboloid::new(10.0).unwrap();
    for value in [0.0, -1.0, f64::NAN, f64::NEG_INFINITY] {
        let refused = FixedLoadSolver::builder(&surface, &kernel).hardness(value).build();
        assert!(matches!(refused, Err(Error::NotPositive { quantity: "hardness", .. })), "{value}");
    }
    let map = DMatrix::from_element(5, 6, 1.0);
    let refused = FixedLoadSolver::builder(&surface, &kernel).hardness_map(&map).build();
    assert!(matches!(refused, Err(Error::GridMismatch { .. })), "{refused:?}");
    let unknown = KernelTable::from_fn(grid, Boundary::Free, ContactGrowth::Unknown, |di, dj| {
        (-((di * di + dj * dj) as f64)).exp()
    })
    .unwrap();
    let refused = FixedLoadSolver::builder(&surface, &unknown).hardness(1.0).build();
    assert!(matches!(refused, Err(Error::Kernel(KernelError::GrowthUnknown))), "{refused:?}");
}

/// Nodes that have yielded stay so where others carry far more, or press them far up: beside one of infinite hardness,
/// and on a periodic surface whose height is little beside its displacement.
#[test]
fn yielded_nodes_stay_yielded() {
    let two = Grid::new(2, 1, 1.0, 1.0).unwrap();
    let love = Boussinesq::new(two, 1.0).unwrap();
    let flat = HeightMap::new(DMatrix::from_row_slice(2, 1, &[0.0, -1e-3])).unwrap();
    let map = DMatrix::from_row_slice(2, 1, &[1.0, f64::INFINITY]);
    let row = Grid::new(4, 1, 1.0, 1.0).unwrap();
    let periodic = PeriodicBoussinesq::new(row, 1.0).unwrap();
    let wave = HeightMap::new(DMatrix::from_row_slice(4, 1, &[0.0, -1e-3, -2e-3, -1e-3])).unwrap();
    let cases: [(FixedLoadSolver, f64, &[f64]); 2] = [
        (
            FixedLoadSolver::builder(&flat, &love).hardness_map(&map).build().unwrap(),
            100.0,
            &[1.0, 99.0],
        ),
        (FixedLoadSolver::builder(&wave, &periodic).hardness(1.0).build().unwrap(), 3.9995, &[1.0]),
    ];
    for (mut solver, load, expected) in cases {
        let solution = solver.solve(load).unwrap();
        assert!(
            (solution.fields.pressure.sum() / load - 1.0).abs() < 1e-12,
            "{}",
            solution.fields.pressure
        );
        for (found, expected) in solution.fields.pressure.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12 * load, "{}", solution.fields.pressure);
        }
        let yielded = solution.fields.yielded_map;
        assert!(yielded[0] && yielded.iter().any(|has_yielded| !has_yielded), "{yielded}");
    }
}
