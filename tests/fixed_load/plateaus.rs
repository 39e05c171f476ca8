//! Single loads where all nodes in contact have yielded, against the path: the approach grows there, and the load
//! stays.

use std::path::Path;

use asperity::io::read_npy;
use asperity::loading::History;
use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity_testing::surfaces::scattered;
use nalgebra::DMatrix;

use asperity::{
    Boussinesq, ContactState, ContactTarget, Error, FixedLoadSolution, FixedLoadSolver, Grid,
    InfluenceKernel, LoadingSolver, PeriodicBoussinesq, Spectral, Surface,
};

const E_STAR: f64 = 100e9;

/// A rough surface of 16 × 16 nodes on which 20 plateaus or so lie between the first touch and the last yield.
fn small() -> HeightMap {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/hardness/plateaus_16.npy");
    HeightMap::new(read_npy(file).unwrap()).unwrap()
}

fn kernels(grid: Grid) -> [Box<dyn InfluenceKernel>; 3] {
    [
        Box::new(Boussinesq::new(grid, E_STAR).unwrap()),
        Box::new(PeriodicBoussinesq::new(grid, E_STAR).unwrap()),
        Box::new(Spectral::new(grid, E_STAR).unwrap()),
    ]
}

fn path(surface: &dyn Surface, kernel: &dyn InfluenceKernel, hardness: f64) -> History {
    let builder = LoadingSolver::builder(surface, kernel).hardness(hardness);
    builder.build().unwrap().collect::<Result<_, Error>>().unwrap()
}

/// Both ends of each plateau between the first touch and full contact that is longer than rounding.
fn plateaus(history: &History) -> Vec<[ContactState; 2]> {
    let pairs = history.states().windows(2).map(|pair| [pair[0].contact, pair[1].contact]);
    pairs
        .filter(|[near, far]| {
            let has_yielded = near.plastic.is_some_and(|p| p.yielded_nodes == near.contact_nodes);
            has_yielded && far.mean_gap > 0.0 && far.approach > near.approach * (1.0 + 1e-9)
        })
        .collect()
}

/// Pressures are known on a plateau, so that all else is right to rounding of lengths, which the path has too: 1e-12 of
/// the longest.
fn compare(found: &FixedLoadSolution, expected: &ContactState, length: f64, context: &str) {
    let (state, plastic) = (&found.contact, found.contact.plastic.unwrap());
    let of_path = expected.plastic.unwrap();
    assert_eq!(state.contact_nodes, expected.contact_nodes, "{context}");
    assert_eq!(plastic.yielded_nodes, of_path.yielded_nodes, "{context}");
    assert!((state.load / expected.load - 1.0).abs() < 1e-12, "{context}");
    let area = expected.contact_area / expected.contact_area_fraction;
    for (name, found, expected, scale) in [
        ("approach", state.approach, expected.approach, length),
        ("mean gap", state.mean_gap, expected.mean_gap, length),
        ("plastic volume", plastic.volume, of_path.volume, length * area),
        ("plastic work", plastic.work, of_path.work, length * expected.load),
    ] {
        let error = (found - expected).abs() / scale;
        assert!(error < 1e-11, "{context}: {name} {found:e} for {expected:e}: {error:e}");
    }
    assert_eq!(state.interfacial_stiffness, Some(0.0), "{context}");
}

/// At most so many plateaus of a path: its load goes with its beginning, and approaches and mean gaps along it with
/// states in between.
fn all_along(
    surface: &dyn Surface,
    kernel: &dyn InfluenceKernel,
    hardness: f64,
    most: usize,
) -> usize {
    let history = path(surface, kernel, hardness);
    let mut solver = FixedLoadSolver::builder(surface, kernel).hardness(hardness).build().unwrap();
    let length = history.states().last().unwrap().contact.approach;
    let mut targets = 0;
    let plateaus = plateaus(&history);
    for [near, far] in plateaus.iter().step_by(plateaus.len().div_ceil(most)) {
        let context = format!("{hardness:e} Pa, {} nodes in contact", near.contact_nodes);
        let found = solver.solve(near.load).unwrap();
        compare(&found, near, length, &context);
        for part in [0.03, 0.5, 0.96] {
            let between = |a: f64, b: f64| a + part * (b - a);
            let approach = between(near.approach, far.approach);
            let mean_gap = between(near.mean_gap, far.mean_gap);
            for target in [ContactTarget::Approach(approach), ContactTarget::MeanGap(mean_gap)] {
                let found = solver.solve_target(target).unwrap_or_else(|error| {
                    panic!("{context}, {target:?}: {error}");
                });
                let expected = history.at(target).unwrap().contact;
                compare(&found, &expected, length, &format!("{context}, {target:?}"));
                targets += 1;
            }
        }
    }
    targets
}

#[test]
fn a_small_surface_has_the_states_of_its_path() {
    let surface = small();
    let grid = Grid::square(16, 1e-3).unwrap();
    for kernel in kernels(grid) {
        let targets = all_along(&surface, &*kernel, 8e6, 100);
        assert!(targets >= 60, "{targets}");
    }
}

/// Soft metals, of which most of a path is plateaus, and a harder one with some.
#[test]
fn rough_surfaces_have_the_states_of_their_paths() {
    let grid = Grid::square(24, 1e-3).unwrap();
    let surface = SelfAffine::new(0.8, 0.5e-3, 0.1e-3, Amplitude::RmsGradient(0.1), 5).unwrap();
    for kernel in kernels(grid) {
        for hardness in [1e5, 1e7, 3e8] {
            let targets = all_along(&surface, &*kernel, hardness, 3);
            assert!(targets >= 6, "{hardness:e}: {targets}");
        }
    }
}

/// Where the next node touches a plateau ends. There, and by rounding behind it, this node carries nothing yet.
#[test]
fn approaches_at_the_far_end_have_its_load() {
    let surface = small();
    let grid = Grid::square(16, 1e-3).unwrap();
    for kernel in kernels(grid) {
        let history = path(&surface, &*kernel, 8e6);
        let builder = FixedLoadSolver::builder(&surface, &*kernel).hardness(8e6);
        let mut solver = builder.build().unwrap();
        for [near, far] in plateaus(&history) {
            for part in [0.0, 1e-15, 1e-13, 1e-11] {
                let target = ContactTarget::Approach(far.approach * (1.0 + part));
                let found = solver.solve_target(target).unwrap_or_else(|error| {
                    panic!("{} nodes, {part:e} behind: {error}", near.contact_nodes)
                });
                // The tolerance of the approach, by the stiffness of the node that touches.
                let allowed = 1e-8 * far.approach * far.interfacial_stiffness.unwrap();
                let error = (found.contact.load - near.load).abs();
                assert!(error < allowed, "{} nodes, {part:e}: {error:e}", near.contact_nodes);
            }
        }
    }
}

/// Loads a little below a plateau and a little above lie on either side of it; in a sweep up through it as well.
#[test]
fn sweeps_pass_plateaus() {
    let surface = small();
    let grid = Grid::square(16, 1e-3).unwrap();
    for kernel in kernels(grid) {
        let history = path(&surface, &*kernel, 8e6);
        let length = history.states().last().unwrap().contact.approach;
        let builder = FixedLoadSolver::builder(&surface, &*kernel).hardness(8e6);
        let mut solver = builder.tolerance(1e-11).build().unwrap();
        let loads = plateaus(&history);
        let loads: Vec<f64> = loads
            .iter()
            .flat_map(|[near, _]| [1.0 - 1e-4, 1.0, 1.0 + 1e-4].map(|part| part * near.load))
            .collect();
        for (solution, load) in
            solver.sweep(loads.iter().copied().map(ContactTarget::Load)).zip(&loads)
        {
            let state = solution.unwrap().contact;
            let expected = history.at_load(*load).unwrap().contact;
            let error = (state.approach - expected.approach).abs() / length;
            assert!(error < 1e-8, "{load}: {error:e}");
        }
        // And down.
        for load in loads.iter().rev() {
            let state = solver.solve(*load).unwrap().contact;
            let expected = history.at_load(*load).unwrap().contact;
            assert!((state.approach - expected.approach).abs() < 1e-8 * length, "{load}");
        }
    }
}

/// An approach shortly before all nodes of a periodic half-space have yielded, where the load is the greatest but for a
/// part of 10⁻⁹.
#[test]
fn approaches_before_the_last_yield_of_a_periodic_half_space() {
    let heights =
        DMatrix::from_fn(2, 8, |ix, iy| if iy == 0 || (ix, iy) == (1, 1) { 1e-6 } else { 0.0 });
    let surface = HeightMap::new(heights).unwrap();
    let kernel = PeriodicBoussinesq::new(Grid::new(2, 8, 1e-5, 1e-5).unwrap(), E_STAR).unwrap();
    let hardness = 6_547_181_113.228_284;
    let history = path(&surface, &kernel, hardness);
    let solver = FixedLoadSolver::builder(&surface, &kernel).hardness(hardness);
    let mut solver = solver.tolerance(1e-12).build().unwrap();
    for approach in [9.999e-7, 9.999_99e-7, 9.999_999_99e-7] {
        let expected = history.at_approach(approach).unwrap().contact;
        let found = solver.solve_target(ContactTarget::Approach(approach)).unwrap().contact;
        assert!((found.load / expected.load - 1.0).abs() < 1e-8, "{approach:e}");
    }
}

/// From a state on one plateau to mean gaps off it, up and down, in one sweep.
#[test]
fn sweeps_leave_plateaus_for_other_mean_gaps() {
    let surface = small();
    let grid = Grid::square(16, 1e-3).unwrap();
    for kernel in kernels(grid) {
        let history = path(&surface, &*kernel, 8e6);
        let length = history.states().last().unwrap().contact.approach;
        let all = plateaus(&history);
        let middle = |[near, far]: &[ContactState; 2]| 0.5 * (near.mean_gap + far.mean_gap);
        let [first, last] = [middle(all.first().unwrap()), middle(all.last().unwrap())];
        let between = history.states()[history.states().len() / 2].contact.mean_gap;
        let gaps = [first, between, last, between, first];
        let builder = FixedLoadSolver::builder(&surface, &*kernel).hardness(8e6);
        let mut solver = builder.tolerance(1e-11).build().unwrap();
        for gap in gaps {
            let expected = history.at_mean_gap(gap).unwrap().contact;
            let found = solver.solve_target(ContactTarget::MeanGap(gap)).unwrap().contact;
            assert!((found.load / expected.load - 1.0).abs() < 1e-8, "{gap}");
        }
        let targets = gaps.map(ContactTarget::MeanGap);
        for (solution, gap) in solver.sweep(targets).zip(gaps) {
            let found = solution.unwrap_or_else(|error| panic!("{gap}: {error}")).contact;
            assert!((found.mean_gap - gap).abs() < 1e-10 * length, "{gap}");
            let expected = history.at_mean_gap(gap).unwrap().contact;
            assert!((found.load / expected.load - 1.0).abs() < 1e-8, "{gap}");
        }
    }
}

fn white(shape: (usize, usize), seed: usize) -> HeightMap {
    HeightMap::new(1e-9 * scattered(shape, 1009, seed)).unwrap()
}

/// Where all nodes have yielded none is out of contact: the interface is as stiff as on the path.
#[test]
fn behind_the_last_yield_the_interface_is_closed() {
    let surface = white((4, 3), 0);
    for kernel in kernels(Grid::new(4, 3, 1e-5, 1e-5).unwrap()) {
        let history = path(&surface, &*kernel, 1e9);
        let approach = 1.3 * history.states().last().unwrap().contact.approach;
        let builder = FixedLoadSolver::builder(&surface, &*kernel).hardness(1e9).stiffness(true);
        let mut solver = builder.build().unwrap();
        let found = solver.solve_target(ContactTarget::Approach(approach)).unwrap().contact;
        assert_eq!(found.interfacial_stiffness, Some(f64::INFINITY));
        let expected = history.at_approach(approach).unwrap().contact;
        assert_eq!(found.interfacial_stiffness, expected.interfacial_stiffness);
        // And on from there.
        let states = solver.sweep([1.0, 1.1].map(|part| ContactTarget::Approach(part * approach)));
        assert!(states.map(Result::unwrap).all(|state| state.contact.load == found.load));
    }
}

/// A periodic half-space that is in full contact before any node yields: its approach stays until one does. Just behind
/// that an approach is found, and one of 10⁻¹² of the mean gap as exactly as any other.
#[test]
fn approaches_about_full_contact() {
    for seed in 0..12 {
        let grid = Grid::new(3 + seed % 5, 3 + seed % 7, 1e-5, 1e-5).unwrap();
        let surface = white(grid.shape(), seed);
        let gradient = surface.rms_gradient(&grid).unwrap();
        let [_, periodic @ ..] = kernels(grid);
        for kernel in periodic {
            for times in [5.0, 30.0] {
                let hardness = times * gradient * E_STAR;
                let history = path(&surface, &*kernel, hardness);
                let open = history.states()[0].contact.mean_gap;
                let builder = FixedLoadSolver::builder(&surface, &*kernel).hardness(hardness);
                let mut solver = builder.tolerance(1e-10).build().unwrap();
                let behind = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2].map(|part| open * (1.0 + part));
                let before = [1e-12, 1e-10, 1e-8, 1e-4, 0.5].map(|part| open * part);
                for approach in behind.into_iter().chain(before) {
                    let expected = history.at_approach(approach).unwrap().contact;
                    let found = solver.solve_target(ContactTarget::Approach(approach));
                    let found = found.unwrap_or_else(|error| panic!("{seed} {approach:e} {error}"));
                    let off = (found.contact.load / expected.load - 1.0).abs();
                    // 1e-10 of the approach, by the stiffness of a few nodes; and by what is left of it at the first yield.
                    let error = 1e-8 + 1e-8 * f64::from(u8::from(approach > open)) / 1e-2;
                    assert!(off < error, "{seed} {times} {:e}: {off:e}", approach / open);
                }
            }
        }
    }
}

/// A tolerance that lets nodes yield and recover in turns is no reason to give up.
#[test]
fn loose_tolerances_are_decided() {
    for seed in 0..6 {
        for n in [8, 16] {
            let grid = Grid::square(n, n as f64 * 1e-5).unwrap();
            let surface = white(grid.shape(), seed);
            let hardness = 0.2 * surface.rms_gradient(&grid).unwrap() * E_STAR;
            for kernel in kernels(grid) {
                for tolerance in [0.1, 0.03, 0.01] {
                    let builder = FixedLoadSolver::builder(&surface, &*kernel).hardness(hardness);
                    // Each elastic solution takes less, all of them together more.
                    let builder = builder.tolerance(tolerance).max_iterations(60);
                    let mut solver = builder.build().unwrap();
                    for fraction in [0.1, 0.3, 0.5, 0.6, 0.75, 0.9] {
                        let found = solver.solve_target(ContactTarget::AreaFraction(fraction));
                        assert!(found.is_ok(), "{seed} {n} {tolerance} {fraction}: {found:?}");
                    }
                }
            }
        }
    }
}
