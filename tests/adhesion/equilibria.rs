//! Every equilibrium of a small grid, found by trying all states of all nodes: loading is at the one of the greatest
//! gaps, and unloading at that of the least.

use std::cell::Cell;

use asperity::adhesion::{Adhesion, AdhesiveEvent, AdhesivePath};
use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::surface::{Axis, HeightMap};
use asperity::{
    AdhesionError, Boussinesq, ContactGrowth, ContactTarget, Error, Grid, InfluenceKernel,
    PeriodicBoussinesq, SemiPeriodicBoussinesq,
};
use asperity_testing::equilibria::Equilibria;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};

/// How many states were compared, and at how many of them there were several equilibria.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Compared {
    states: usize,
    several: usize,
}

/// Compares states of both branches at some approaches, or at what else is asked for, with all equilibria there.
fn check(
    kernel: &dyn InfluenceKernel,
    heights: Vec<f64>,
    law: Adhesion,
    ends: &mut [f64],
    target: fn(f64) -> ContactTarget,
) -> Compared {
    let (nx, ny) = kernel.grid().shape();
    let surface = HeightMap::new(DMatrix::from_vec(nx, ny, heights)).unwrap();
    let mut path = AdhesivePath::builder(&surface, kernel, law).build().unwrap();
    let small = Equilibria::of(path.problem(), path.law());
    let kinds = if path.law().flat_range() > 0.0 { 4 } else { 3 };
    ends.sort_by(f64::total_cmp);
    let mut compared = Compared::default();
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
        compared.states += 1;
        compared.several += usize::from(all.len() > 1);
        let same = |gap: &DVector<f64>| (gap - &found).amax() < 1e-10;
        assert_eq!(all.iter().filter(|gap| same(gap)).count(), 1, "{state:?} of {}", all.len());
        // Elsewhere states are minima, and which of them is up to the program.
        for gap in all.iter().filter(|_| kernel.contact_growth() == ContactGrowth::Convex) {
            let beyond = if is_loading { gap - &found } else { &found - gap };
            assert!(beyond.max() < 1e-10, "{state:?}: {}", beyond.max());
        }
    };
    for &end in ends.iter() {
        if path.load_to(target(end)).is_ok() {
            compare(&mut path, true);
        }
    }
    path.load_to(ContactTarget::AreaFraction(1.0)).unwrap();
    path.by_ref().try_for_each(|state| state.map(|_| ())).unwrap();
    for &end in ends.iter().rev() {
        if path.unload_to(target(end)).is_ok() {
            compare(&mut path, false);
        }
    }
    compared
}

/// A layer on a body; half-spaces of the tests have E* = 1.
fn layer(youngs_modulus: f64, poissons_ratio: f64, thickness: f64, base: Base) -> LayeredBody {
    LayeredBody::new(&[Layer { youngs_modulus, poissons_ratio, thickness }], base).unwrap()
}

/// Every kind of body on which contact grows, under a grid of a side of some 1: half-spaces, sheets on a rigid base and
/// soft coats.
fn bodies(grid: Grid) -> Vec<(&'static str, Box<dyn InfluenceKernel>)> {
    let base = Base::HalfSpace { youngs_modulus: 1.0, poissons_ratio: 0.3 };
    let sheet = || layer(1.0, 0.3, 0.4, Base::Rigid);
    let incompressible = layer(1.0, 0.5, 0.4, Base::Rigid);
    let coat = || layer(0.2, 0.4, 0.2, base);
    let along = |axis| Box::new(SemiPeriodicBoussinesq::new(grid, 1.0, axis).unwrap());
    vec![
        ("free", Box::new(Boussinesq::new(grid, 1.0).unwrap())),
        ("periodic", Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap())),
        ("periodic x", along(Axis::X)),
        ("periodic y", along(Axis::Y)),
        ("sheet", Box::new(Layered::free(grid, sheet()).unwrap())),
        ("sheet, periodic", Box::new(Layered::periodic(grid, sheet()).unwrap())),
        ("incompressible", Box::new(Layered::periodic(grid, incompressible).unwrap())),
        ("coat", Box::new(Layered::free(grid, coat()).unwrap())),
        ("coat, periodic", Box::new(Layered::periodic(grid, coat()).unwrap())),
    ]
}

/// The same random cases each time, on all bodies; at least so many states of each have to be compared, and
/// where gaps are convex so many of them beside other equilibria.
fn on_all_bodies<S: Strategy>(
    grid: Grid,
    cases: &S,
    floor: [usize; 2],
    compared: impl Fn(&dyn InfluenceKernel, S::Value) -> Compared,
) {
    for (name, kernel) in bodies(grid) {
        assert!(kernel.contact_growth() > ContactGrowth::Unknown, "{name}");
        let sum = Cell::new(Compared::default());
        let config = ProptestConfig {
            failure_persistence: None,
            rng_seed: RngSeed::Fixed(1),
            ..ProptestConfig::with_cases(8)
        };
        let all = TestRunner::new(config).run(cases, |case| {
            let (so_far, more) = (sum.get(), compared(&*kernel, case));
            let (states, several) = (so_far.states + more.states, so_far.several + more.several);
            sum.set(Compared { states, several });
            Ok(())
        });
        assert!(all.is_ok(), "{name}: {all:?}");
        let Compared { states, several } = sum.get();
        println!("{name} {:?}: {states} {several}", kernel.contact_growth());
        let branches = kernel.contact_growth() == ContactGrowth::Convex;
        assert!(states >= floor[0], "{name}: {states}");
        assert!(several >= floor[1] || !branches, "{name}: {several} of {states}");
    }
}

#[test]
fn triangles_on_four_by_two_nodes() {
    let cases = (
        prop::collection::vec(-0.03..0.03_f64, 8),
        0.01..0.04_f64,
        0.3..0.8_f64,
        prop::collection::vec(-0.03..0.04_f64, 3),
    );
    let grid = Grid::new(4, 2, 0.25, 0.25).unwrap();
    on_all_bodies(grid, &cases, [10, 0], |kernel, (heights, range, resolution, mut ends)| {
        let unit = Adhesion::work(1e-9).range(1.0).on(kernel).unwrap().resolution();
        let law = Adhesion::work(1e-9 * resolution / unit * range * range).range(range);
        check(kernel, heights, law, &mut ends, ContactTarget::Approach)
    });
}

#[test]
fn trapezoids_on_three_by_two_nodes() {
    let cases = (
        prop::collection::vec(-0.03..0.03_f64, 6),
        0.01..0.04_f64,
        0.05..0.8_f64,
        0.3..0.8_f64,
        prop::collection::vec(-0.03..0.04_f64, 3),
    );
    let grid = Grid::new(3, 2, 1.0 / 3.0, 1.0 / 3.0).unwrap();
    on_all_bodies(grid, &cases, [10, 0], |kernel, (heights, range, part, resolution, mut ends)| {
        let law = Adhesion::work(1e-9).range(1.0).on(kernel).unwrap();
        let compliance = law.resolution() / law.slope();
        let stress = resolution / compliance * range * (1.0 - part);
        let law = Adhesion::maugis(0.5 * stress * range * (1.0 + part), stress).range(range);
        check(kernel, heights, law, &mut ends, ContactTarget::Approach)
    });
}

/// Where there are several minima the branches differ: nearly flat surfaces, and a law as steep as there may be. Mean
/// planes of half-spaces that repeat jump past approaches, but not past loads.
#[test]
fn branches_differ_where_there_are_several_equilibria() {
    let cases = (
        prop::collection::vec(0.0..0.004_f64, 8),
        prop::collection::vec(-0.024..-0.012_f64, 2),
        prop::collection::vec(-0.9..0.0_f64, 2),
    );
    let grid = Grid::new(4, 2, 0.25, 0.25).unwrap();
    on_all_bodies(grid, &cases, [10, 1], |kernel, (heights, mut approaches, mut pressures)| {
        let unit = Adhesion::work(1e-9).range(1.0).on(kernel).unwrap().resolution();
        let law = Adhesion::work(1e-9 * 0.79 / unit * 0.02 * 0.02).range(0.02);
        let stress = law.on(kernel).unwrap().stress();
        pressures.iter_mut().for_each(|part| *part *= stress);
        let [a, b] = [
            check(kernel, heights.clone(), law, &mut approaches, ContactTarget::Approach),
            check(kernel, heights, law, &mut pressures, ContactTarget::MeanPressure),
        ];
        Compared { states: a.states + b.states, several: a.several + b.several }
    });
}

/// A coat so stiff that contact may lose nodes while the approach grows has no branch of the greatest gaps.
#[test]
fn stiff_coats_are_refused() {
    let grid = Grid::new(16, 12, 1.0 / 16.0, 1.0 / 16.0).unwrap();
    let surface = HeightMap::new(DMatrix::from_fn(16, 12, |x, y| ((x * y) as f64).sin())).unwrap();
    let base = Base::HalfSpace { youngs_modulus: 0.01, poissons_ratio: 0.3 };
    let body = layer(1.0, 0.3, 0.1, base);
    for made in [Layered::free, Layered::periodic, Layered::spectral] {
        let kernel = made(grid, body.clone()).unwrap();
        assert_eq!(kernel.contact_growth(), ContactGrowth::Unknown);
        let refused = AdhesivePath::builder(&surface, &kernel, Adhesion::work(1e-6)).build().err();
        let is_refused = matches!(refused, Some(Error::Adhesion(AdhesionError::GrowthUnknown)));
        assert!(is_refused, "{refused:?}");
    }
}
