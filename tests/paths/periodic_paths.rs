//! Periodic paths against event files of a dense solver that shares no code with this crate, in the
//! columns that do not depend on the gauge.

use crate::common::{surface, with_window};
use asperity::updater::ConjugateGradient;
use asperity::{
    ContactGrowth, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq, Spectral, Surface,
};
use asperity_testing::surfaces::rough;
use asperity_testing::table;

/// Same node at every event to full contact, every column within 1e-9: both sides come from
/// triangular solves with a condition number of some 10³, and the last mean gaps lose five digits
/// more. Worst measured: 6e-12, of a mean gap.
fn compare(kernel: &dyn InfluenceKernel, name: &str, window: Option<usize>) {
    let heights = surface("periodic_32x24");
    let builder = LoadingSolver::builder(&heights, kernel);
    let mut solver = with_window(builder, window).build().unwrap();
    let path =
        format!("{}/tests/data/periodic_32x24_{name}_events.csv", env!("CARGO_MANIFEST_DIR"));
    let mut events = 0;
    let (mut first_gap, mut last): (Option<f64>, Option<(f64, f64, f64)>) = (None, None);
    for event in table::read(path) {
        let [step, ix, iy] = [0, 1, 2].map(|column| event[column] as usize);
        let [load, area, fraction, mean_gap, stiffness] = event[3..].try_into().unwrap();
        let state = solver.next().unwrap().unwrap();
        assert_eq!((state.step, state.node), (step, (ix, iy)), "{name}");
        for (column, found, expected) in [
            ("load", state.contact.load, load),
            ("contact area", state.contact.contact_area, area),
            ("area fraction", state.contact.contact_area_fraction, fraction),
            ("mean gap", state.contact.mean_gap, mean_gap),
            ("interfacial stiffness", state.contact.interfacial_stiffness.unwrap(), stiffness),
        ] {
            let error = ((found - expected) / expected).abs();
            assert!(
                found == expected || error < 1e-9,
                "{name}, step {step}: {column} {found:e} instead of {expected:e}: {error:e}"
            );
        }
        // The mean planes approach by what the mean gap closes, from first touch on.
        let first = *first_gap.get_or_insert(state.contact.mean_gap);
        let closed = first - state.contact.mean_gap;
        assert!((state.contact.approach - closed).abs() < 1e-12 * first, "{name}, step {step}");
        assert_eq!(state.contact.contact_stiffness, None);
        // Energy grows by trapezoids of load over that approach: both sides round at 1e-13 of it.
        if let Some((load, approach, energy)) = last {
            let work: f64 = 0.5 * (load + state.contact.load) * (state.contact.approach - approach);
            let error = (state.contact.energy - energy - work).abs();
            assert!(error <= 1e-11 * state.contact.energy, "{name}, step {step}: {error:e}");
        }
        last = Some((state.contact.load, state.contact.approach, state.contact.energy));
        events += 1;
    }
    assert!(solver.next().is_none());
    assert_eq!(events, 32 * 24);
}

fn grid() -> Grid {
    Grid::new(32, 24, 2e-5, 3e-5).unwrap()
}

#[test]
fn love() {
    compare(&PeriodicBoussinesq::new(grid(), 1.0).unwrap(), "love", None);
}

#[test]
fn love_in_a_larger_gauge() {
    let kernel = PeriodicBoussinesq::new(grid(), 1.0).unwrap();
    let gauge = 5.0 * kernel.gauge();
    compare(&kernel.with_gauge(gauge).unwrap(), "love", None);
}

/// Gaps of this kernel are not convex: windows are checked at their ends.
#[test]
fn spectral() {
    for window in [None, Some(200), Some(7), Some(1)] {
        compare(&Spectral::new(grid(), 1.0).unwrap(), "spectral", window);
    }
}

/// Nor are those of Love's kernel in a gauge that is too small, in which its contact still grows.
#[test]
fn love_in_a_smaller_gauge() {
    let kernel = PeriodicBoussinesq::new(grid(), 1.0).unwrap();
    let gauge = 0.1 * kernel.gauge();
    let kernel = kernel.with_gauge(gauge).unwrap();
    assert_eq!(kernel.contact_growth(), ContactGrowth::Monotone);
    for window in [None, Some(7)] {
        compare(&kernel, "love", window);
    }
}

/// The updater without a factor gives the same periodic path, and its preconditioner the same
/// operator in any gauge.
#[test]
fn conjugate_gradients_follow_a_periodic_path() {
    let grid = Grid::new(20, 16, 1.0, 1.0).unwrap();
    let map = rough(&grid, 19);
    let love = PeriodicBoussinesq::new(grid, 1.0).unwrap();
    let spectral = Spectral::new(grid, 1.0).unwrap();
    let kernels: [&dyn InfluenceKernel; 2] = [&love, &spectral];
    for kernel in kernels {
        let factored: Vec<_> =
            LoadingSolver::new(&map, kernel).unwrap().map(Result::unwrap).collect();
        let iterated: Vec<_> = LoadingSolver::builder(&map, kernel)
            .updater(ConjugateGradient::new())
            .window_size(12)
            .build()
            .unwrap()
            .map(Result::unwrap)
            .collect();
        assert_eq!(factored.len(), iterated.len());
        let first = factored[0].contact.mean_gap;
        for (a, b) in factored.iter().zip(&iterated) {
            assert_eq!((a.step, a.node), (b.step, b.node));
            // Between the ends of windows; see `without_factor`.
            assert!(
                (a.contact.load - b.contact.load).abs() <= 1e-5 * a.contact.load,
                "{a:?} {b:?}"
            );
            let error = (a.contact.mean_gap - b.contact.mean_gap).abs();
            assert!(error <= 1e-6 * first, "{a:?} {b:?}");
        }
    }
}

/// The fields of a path do not depend on the gauge either: its displacement is about the mean.
#[test]
fn fields_of_a_path_in_two_gauges() {
    let grid = Grid::new(24, 18, 1.0, 1.0).unwrap();
    let map = rough(&grid, 23);
    let kernel = PeriodicBoussinesq::new(grid, 1.0).unwrap();
    let larger = kernel.gauge() * 4.0;
    let [mut a, mut b] = [kernel.clone(), kernel.with_gauge(larger).unwrap()]
        .map(|kernel| LoadingSolver::new(&map, &kernel).unwrap());
    for step in 1..=grid.nodes() {
        let states = [a.next().unwrap().unwrap(), b.next().unwrap().unwrap()];
        assert_eq!(states[0].node, states[1].node);
        if step % 60 != 0 && step != grid.nodes() {
            continue;
        }
        let [u, v] = [&mut a, &mut b].map(|path| path.fields().unwrap().displacement);
        // Rounding of the uniform displacement, which is some ten times as large in the second.
        assert!((&u - &v).amax() < 1e-11 * u.amax(), "step {step}");
        assert!(u.mean().abs() < 1e-12 * u.amax(), "step {step}");
        let expected = a.fields().unwrap().gap;
        let gap = map.heights(&grid).unwrap();
        let gap = gap.map(|height| gap.max() - height) + u;
        let gap = gap.map(|value| value - states[0].contact.approach);
        assert!((gap - expected).amax() < 1e-12 * v.amax(), "step {step}");
    }
}
