//! Numbers at the ends of the range of double precision: an error or a finite path, never a panic.

use crate::common::with_window;
use asperity::loading::{History, LoadingEnd, LoadingSolver};
use asperity::surface::HeightMap;
use asperity::updater::ConjugateGradient;
use asperity::{
    Boundary, Boussinesq, ContactRule, ContactTarget, Error, FixedLoadSolver, Grid,
    InfluenceKernel, LoadingState, PeriodicBoussinesq,
};
use nalgebra::DMatrix;
use proptest::prelude::*;

/// Any positive number, most of them extreme.
fn positive() -> impl Strategy<Value = f64> {
    prop_oneof![
        prop::sample::select(vec![
            5e-324,
            1e-308,
            2.3e-308,
            1e-300,
            1e-200,
            1e-154,
            1e-150,
            1e-100,
            1e-30,
            1.0,
            1e30,
            1e100,
            1e150,
            1e154,
            1e200,
            1e300,
            1e308,
            f64::MAX,
        ]),
        (-323.0..308.0).prop_map(|exponent: f64| 10_f64.powf(exponent)),
    ]
}

/// Any number at all.
fn anything() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => positive(),
        2 => positive().prop_map(|x| -x),
        1 => prop::sample::select(vec![0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY]),
    ]
}

/// The sides of a cell: mostly of the same size.
fn cell() -> impl Strategy<Value = (f64, f64)> {
    prop_oneof![
        1 => (positive(), positive()),
        9 => (positive(), -3.0..3.0).prop_map(|(dx, aspect)| (dx, dx * 10_f64.powf(aspect))),
    ]
}

fn finite(state: &LoadingState) -> bool {
    let stiffness = state.contact.interfacial_stiffness.unwrap();
    [
        state.contact.approach,
        state.contact.load,
        state.contact.contact_area,
        state.contact.contact_area_fraction,
        state.contact.mean_gap,
        state.contact.contact_stiffness.unwrap(),
        state.contact.energy,
    ]
    .iter()
    .all(|value| value.is_finite())
        && !stiffness.is_nan()
        && (stiffness.is_finite() || state.contact.contact_area_fraction == 1.0)
}

/// Runs a path to its end, asking for everything on the way; the states and the error, if any.
fn run(
    grid: Grid,
    e_star: f64,
    heights: &DMatrix<f64>,
    rule: ContactRule,
    window: Option<usize>,
) -> Result<Vec<LoadingState>, Error> {
    let kernel = Boussinesq::new(grid, e_star)?;
    let surface = HeightMap::new(heights.clone())?;
    let builder = LoadingSolver::builder(&surface, &kernel).rule(rule);
    let mut path = with_window(builder, window).build()?;
    let mut states = Vec::new();
    while let Some(state) = path.next() {
        states.push(state?);
        path.certificate()?;
        path.fields()?;
    }
    assert!(path.next().is_none());
    let history: History = states.iter().copied().collect();
    for target in [0.0, 1e-308, 1.0, f64::MAX, f64::INFINITY, f64::NAN, -1.0] {
        let readings =
            [history.at_load(target), history.at_approach(target), history.at_mean_gap(target)];
        for state in readings.iter().flatten() {
            let pressure = path.fields_at(state).map(|fields| fields.pressure);
            // Full contact is read at any load, also where it or its pressures over- or underflow.
            let mean = state.contact.load / grid.nominal_area() / grid.nodes() as f64;
            let is_in_range = finite(state) && (state.contact.load == 0.0 || mean.is_normal());
            if is_in_range || !matches!(pressure, Err(Error::NotOnPath { .. })) {
                pressure?;
            }
        }
    }
    Ok(states)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn grids_never_panic(nx in any::<usize>(), ny in any::<usize>(), small in 0_usize..70, lx in anything(), ly in anything()) {
        for (nx, ny) in [(nx, ny), (small, ny), (nx, small), (small, small)] {
            for grid in [Grid::new(nx, ny, lx, ly), Grid::with_sides(nx, ny, lx, ly)].into_iter().flatten() {
                prop_assert!(grid.nodes() > 0 && grid.dx() > 0.0 && grid.dy() > 0.0);
                let (sx, sy) = grid.sides();
                for value in [grid.cell_area(), grid.nominal_area(), sx, sy] {
                    prop_assert!(value > 0.0 && value.is_finite(), "{:?}", grid);
                }
            }
        }
    }

    /// Anything goes in; nothing panics, and no state is infinite or NaN.
    #[test]
    fn paths_of_any_numbers(
        (nx, ny) in (1_usize..5, 1_usize..5),
        (dx, dy) in cell(),
        e_star in positive(),
        heights in prop::collection::vec(anything(), 16),
        approximate in any::<bool>(),
        window in prop_oneof![Just(None), (1_usize..5).prop_map(Some)],
    ) {
        let Ok(grid) = Grid::new(nx, ny, dx, dy) else { return Ok(()) };
        let heights = DMatrix::from_fn(nx, ny, |ix, iy| heights[ix + 4 * iy]);
        let rule = if approximate { ContactRule::ApproximateOrder } else { ContactRule::FirstContact };
        if let Ok(states) = run(grid, e_star, &heights, rule, window) {
            prop_assert_eq!(states.len(), grid.nodes());
            for state in &states {
                prop_assert!(finite(state), "{:?}", state);
            }
        }
    }

    /// Consistent units of any size: heights, cells and moduli each of one order of magnitude.
    #[test]
    fn paths_in_any_units(
        (nx, ny) in (1_usize..5, 1_usize..5),
        aspect in -2.0..2.0,
        (height, cell, e_star) in (-310.0..300.0, -150.0..150.0, -300.0..300.0),
        heights in prop::collection::vec(0.0..1.0, 16),
        window in prop_oneof![Just(None), (1_usize..5).prop_map(Some)],
    ) {
        let power = |exponent: f64| 10_f64.powf(exponent);
        let Ok(grid) = Grid::new(nx, ny, power(cell), power(cell + aspect)) else { return Ok(()) };
        let heights = DMatrix::from_fn(nx, ny, |ix, iy| power(height) * heights[ix + 4 * iy]);
        if let Ok(states) = run(grid, power(e_star), &heights, ContactRule::FirstContact, window) {
            prop_assert_eq!(states.len(), grid.nodes());
            for pair in states.windows(2) {
                prop_assert!(finite(&pair[1]), "{:?}", pair[1]);
                prop_assert!(pair[1].contact.approach >= pair[0].contact.approach && pair[1].contact.load >= pair[0].contact.load);
            }
        }
    }
}

/// Units are only units: powers of two change the exponents of a path and not one bit else. (Those
/// of the influence coefficients must be even, for the sake of their square roots.)
#[test]
fn powers_of_two_scale_exactly() {
    let heights = DMatrix::from_fn(7, 6, |ix, iy| ((3 * ix + 5 * iy * iy) as f64).sin());
    let states = |length: i32, height: i32, modulus: i32| {
        let [cell, height, modulus] = [length, height, modulus].map(|e| 2_f64.powi(e));
        let grid = Grid::new(7, 6, cell, 3.0 * cell).unwrap();
        run(grid, modulus, &(&heights * height), ContactRule::FirstContact, None).unwrap()
    };
    let reference = states(0, 0, 0);
    assert_eq!(reference.len(), 42);
    for (length, height, modulus) in
        [(-30, -40, 38), (100, -200, 60), (-200, -300, -100), (150, 200, 90)]
    {
        let scaled = states(length, height, modulus);
        for (a, b) in reference.iter().zip(&scaled) {
            let scale = |value: f64, exponent: i32| value * 2_f64.powi(exponent);
            assert_eq!(a.node, b.node);
            assert_eq!(scale(a.contact.approach, height), b.contact.approach);
            assert_eq!(scale(a.contact.mean_gap, height), b.contact.mean_gap);
            assert_eq!(scale(a.contact.load, length + height + modulus), b.contact.load);
            assert_eq!(
                scale(a.contact.contact_stiffness.unwrap(), length + modulus),
                b.contact.contact_stiffness.unwrap()
            );
            assert_eq!(scale(a.contact.energy, length + 2 * height + modulus), b.contact.energy);
        }
    }
}

/// Heights, cells and moduli far from 1 are fine as long as pressures, loads and energies are.
#[test]
fn sensible_paths_far_from_one() {
    let heights = DMatrix::from_fn(4, 5, |ix, iy| ((3 * ix + 7 * iy) as f64).cos());
    for (height, cell, e_star) in [
        (1e-130, 1e100, 1e100),
        (1e-60, 1e-60, 1e60),
        (1e100, 1e-50, 1e-50),
        (1e-9, 1e-9, 1e11),
        (1e80, 1e100, 1e-15),
    ] {
        let grid = Grid::new(4, 5, cell, cell).unwrap();
        let states = run(grid, e_star, &(&heights * height), ContactRule::FirstContact, None);
        match states {
            Ok(states) => assert!(states.len() == 20 && states.iter().all(finite)),
            Err(error) => panic!("height {height:e}, cell {cell:e}, E* {e_star:e}: {error}"),
        }
    }
}

/// Beyond that they are refused before anything is computed, whatever it is that would not be a number: the
/// square of a length, a pressure, a load, an energy.
#[test]
fn scales_too_far_apart_are_refused_at_the_door() {
    let heights = DMatrix::from_fn(4, 5, |ix, iy| ((3 * ix + 7 * iy) as f64).cos());
    for (height, cell, e_star) in [
        (1e-150, 1.0, 1.0),
        (1e150, 1.0, 1.0),
        (5e-324, 1.0, 1.0),
        (1e-100, 1.0, 1e-50),
        (1e100, 1.0, 1e50),
        (1.0, 1e150, 1.0),
        (1.0, 1.0, 1e150),
        (1e-300, 1e150, 1.0),
        (1e-130, 1e-100, 1.0),
        (1e120, 1e60, 1.0),
    ] {
        let grid = Grid::new(4, 5, cell, cell).unwrap();
        let kernel = Boussinesq::new(grid, e_star).unwrap();
        let surface = HeightMap::new(&heights * height).unwrap();
        let refused = [
            LoadingSolver::new(&surface, &kernel).map(drop),
            FixedLoadSolver::new(&surface, &kernel).map(drop),
        ];
        for refused in refused {
            assert!(
                matches!(refused, Err(Error::OutOfRange { .. })),
                "height {height:e}, cell {cell:e}, E* {e_star:e}: {refused:?}"
            );
        }
    }
}

/// A gap so small that it, or its pressure, underflows is closed: the node is one of those that touch first,
/// and its neighbours do not come into it.
#[test]
fn gaps_that_underflow_are_closed() {
    let grid = Grid::new(4, 3, 1.0, 1.0).unwrap();
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    let order = |tiny: f64| {
        let mut heights = DMatrix::from_fn(4, 3, |ix, iy| -((1 + ix + 4 * iy) as f64));
        heights[(1, 1)] = 0.0;
        heights[(3, 1)] = -tiny;
        heights[(2, 2)] = -2.0 * tiny;
        let surface = HeightMap::new(heights).unwrap();
        for iterations in [false, true] {
            let builder = LoadingSolver::builder(&surface, &kernel);
            let states: Vec<_> = if iterations {
                let path = builder.updater(ConjugateGradient::new()).build().unwrap();
                path.map(Result::unwrap).collect()
            } else {
                builder.build().unwrap().map(Result::unwrap).collect()
            };
            assert_eq!(states.len(), 12);
            assert!(states.iter().all(finite));
            let first: Vec<_> = states[..3].iter().map(|state| state.node).collect();
            assert_eq!(first, [(1, 1), (3, 1), (2, 2)]);
            // Iterations take what is so close for ties.
            assert_eq!(states[2].contact.approach == 0.0, iterations || tiny < 1e-140);
        }
    };
    for tiny in [5e-324, 1e-310, 1e-200, 1e-141, 1e-100, 1e-30] {
        order(tiny);
    }
}

/// What is asked of a single load is as far from zero and infinity as what it is computed from.
#[test]
fn extreme_loads_and_approaches_are_refused() {
    let grid = Grid::new(6, 5, 1.0, 1.0).unwrap();
    let heights = DMatrix::from_fn(6, 5, |ix, iy| ((3 * ix + 7 * iy) as f64).cos());
    let surface = HeightMap::new(heights).unwrap();
    let kernels: [Box<dyn InfluenceKernel>; 2] = [
        Box::new(Boussinesq::new(grid, 1.0).unwrap()),
        Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()),
    ];
    for kernel in &kernels {
        for tolerance in [1e-8, 0.999] {
            let builder = FixedLoadSolver::builder(&surface, kernel).tolerance(tolerance);
            let mut solver = builder.build().unwrap();
            // From the least number that is not 0 to the greatest.
            for exponent in -322..=308 {
                let value = format!("1e{exponent}").parse().unwrap();
                for target in [ContactTarget::Load(value), ContactTarget::Approach(value)] {
                    match solver.solve_target(target) {
                        Ok(solution) => {
                            let state = solution.contact;
                            for value in [state.approach, state.load] {
                                assert!(value.is_normal() && value > 0.0, "{target:?}: {state:?}");
                            }
                            // Far beyond full contact of a periodic half-space, where the tolerance is relative to
                            // the pressure, nothing is left of the energy of the gaps.
                            let free = kernel.boundary() == Boundary::Free;
                            assert!(state.energy.is_finite() && (state.energy > 0.0 || !free));
                            let fields = [
                                &solution.fields.pressure,
                                &solution.fields.gap,
                                &solution.fields.displacement,
                                &solution.pressure_rate,
                            ];
                            let mut values = fields.into_iter().flatten();
                            assert!(values.all(|value| value.is_finite()), "{target:?}");
                            assert!(state.mean_gap.is_finite(), "{target:?}: {state:?}");
                        }
                        Err(Error::OutOfRange { .. }) => {
                            assert!(!(1e-130..1e130).contains(&value), "{target:?}");
                        }
                        Err(Error::ApproachNotReached { .. }) => (),
                        Err(error) => panic!("{target:?}, tolerance {tolerance}: {error}"),
                    }
                }
            }
        }
    }
}

/// A hardness beyond all pressures in the units of the input: the error is returned, and the path has not ended by itself.
#[test]
fn what_breaks_off_behind_full_contact_is_told() {
    let grid = Grid::new(5, 6, 1e-5, 1e-5).unwrap();
    let kernel = Boussinesq::new(grid, 1e11).unwrap();
    let heights = DMatrix::from_fn(5, 6, |ix, iy| 1e-7 * ((7 * ix + 3 * iy) % 11) as f64);
    let surface = HeightMap::new(heights).unwrap();
    for hardness in [1e165, 1e170] {
        let builder = LoadingSolver::builder(&surface, &kernel).hardness(hardness);
        let mut path = builder.build().unwrap();
        let last = path.by_ref().last();
        assert!(matches!(last, Some(Err(Error::NotFinite { .. }))), "{hardness:e}: {last:?}");
        assert_eq!(path.end(), Some(LoadingEnd::Failed), "{hardness:e}");
    }
}

/// Statistics of maps whose squares would not be numbers.
#[test]
fn statistics_of_heights_of_any_size() {
    let heights = DMatrix::from_row_slice(2, 2, &[1.0, 3.0, -1.0, 1.0]);
    for height in [1e-300, 1e-200, 1e-154, 1.0, 1e154, 1e200, 5e307] {
        let map = HeightMap::new(&heights * height).unwrap();
        // A few rounding errors.
        let near = |value: f64, expected: f64| (value / height - expected).abs() < 1e-14;
        assert!(near(map.mean_height(), 1.0), "{height:e}");
        assert!(near(map.mean_absolute_height(), 1.0), "{height:e}");
        assert!(near(map.rms_height(), 2_f64.sqrt()), "{height:e}");
    }
}
