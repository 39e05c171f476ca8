//! Half-spaces that repeat in one direction: a cylinder, rough paths, single loads, records.

use std::f64::consts::PI;

use asperity::kernel::SemiPeriodicBoussinesq;
#[cfg(feature = "io")]
#[cfg(feature = "io")]
use asperity::record::LoadingRecord;
use asperity::reference::HertzLine;
use asperity::surface::{Amplitude, Axis};
use asperity::updater::{ConjugateGradient, RecursiveCholesky};
use asperity::{
    ContactGrowth, ContactTarget, Error, FixedLoadSolver, Grid, HeightMap, InfluenceKernel,
    LoadingSolver, LoadingState, SelfAffine,
};
use nalgebra::DMatrix;

fn rough(nx: usize, ny: usize) -> (SelfAffine, Grid) {
    let grid = Grid::new(nx, ny, 1e-5, 1e-5).unwrap();
    let amplitude = Amplitude::RmsHeight(1e-6);
    let side = grid.sides().0.min(grid.sides().1);
    (SelfAffine::new(0.8, 0.5 * side, 4e-5, amplitude, 5).unwrap(), grid)
}

/// A cylinder along the period is a plane problem: Hertz' line contact, and the approach from its reference length, δ =
/// 2F/(πE*L) (ln(2R/a) + 1/2): the displacement by half an ellipse of pressure of the width 2a, in the middle of it.
#[test]
fn a_cylinder_is_a_line_contact() {
    let (radius, e_star) = (400.0, 2.0);
    for along in [Axis::X, Axis::Y] {
        for period in [1, 5, 64] {
            let across = 96;
            let (nx, ny) = if along == Axis::X { (period, across) } else { (across, period) };
            let grid = Grid::new(nx, ny, 1.0, 1.0).unwrap();
            let heights = DMatrix::from_fn(nx, ny, |ix, iy| {
                let across_at = if along == Axis::X { iy } else { ix };
                let x = across_at as f64 + 0.5 - 0.5 * across as f64;
                -x * x / (2.0 * radius)
            });
            let surface = HeightMap::new(heights).unwrap();
            let kernel = SemiPeriodicBoussinesq::new(grid, e_star, along).unwrap();
            let hertz = HertzLine::new(radius, e_star).unwrap();
            let half_width = 30.0;
            let line = hertz.load_at_half_width(half_width);
            let mut solver =
                FixedLoadSolver::builder(&surface, &kernel).tolerance(1e-10).build().unwrap();
            let found = solver.solve(line * period as f64).unwrap();
            // Cells of a sixtieth of the width: their error is of second order but for the edge, some (a/Δ)^(−3/2) =
            // 0.006 of the greatest pressure, and less in the middle.
            let error = found.fields.max_pressure() / hertz.max_pressure(line) - 1.0;
            assert!(error.abs() < 1e-3, "{along:?} {period}: {error:e}");
            let reference = kernel.reference_length();
            let logarithm = (2.0 * reference / half_width).ln() + 0.5;
            let approach = 2.0 * line / (PI * e_star) * logarithm;
            // Cells half a cell from the middle: (Δ/2)²/2R more of the height, 10⁻⁵ of the approach; and the edge
            // again.
            let error = found.contact.approach / approach - 1.0;
            assert!(error.abs() < 1e-3, "{along:?} {period}: {error:e}");
            // dδ/dF = 2/(πE*) (ln(2R/a) + 1/2 − 1/2), since a² grows as F.
            let stiffness =
                PI * e_star * period as f64 / (2.0 * (2.0 * reference / half_width).ln());
            let found = found.contact.contact_stiffness.unwrap();
            // The contact grows in steps of a cell on either side: between two of them a is too small by up to a cell,
            // a thirtieth of it, over a logarithm of 2.8 and more.
            assert!(
                (found / stiffness - 1.0).abs() < 0.015,
                "{along:?} {period}: {found} {stiffness}"
            );
        }
    }
}

fn followed<U: asperity::LinearUpdater>(
    kernel: &SemiPeriodicBoussinesq,
    surface: &SelfAffine,
    fraction: f64,
    updater: U,
) -> (LoadingSolver<U>, Vec<LoadingState>) {
    let builder = LoadingSolver::builder(surface, kernel).updater(updater);
    let mut path = builder.max_area_fraction(fraction).build().unwrap();
    let states: Result<Vec<_>, Error> = path.by_ref().collect();
    (path, states.unwrap())
}

/// Events with a factor, without one, and single loads; on a grid turned by a right angle the same.
#[test]
fn paths_are_those_of_single_loads() {
    for (nx, ny) in [(48, 40), (33, 50)] {
        let (surface, grid) = rough(nx, ny);
        for along in [Axis::X, Axis::Y] {
            let kernel = SemiPeriodicBoussinesq::new(grid, 1e11, along).unwrap();
            assert_eq!(kernel.contact_growth(), ContactGrowth::Convex);
            let (mut path, states) = followed(&kernel, &surface, 0.6, RecursiveCholesky::new());
            let certificate = path.certificate().unwrap();
            // A thousand nodes with a condition number of 1e3.
            assert!(certificate.least_pressure > -1e-10 && certificate.least_gap > -1e-10);
            let (_, iterated) = followed(&kernel, &surface, 0.6, ConjugateGradient::new());
            let nodes = |states: &[LoadingState]| -> Vec<_> {
                states.iter().map(|state| state.node).collect()
            };
            assert_eq!(nodes(&iterated), nodes(&states));
            let mut solver =
                FixedLoadSolver::builder(&surface, &kernel).tolerance(1e-11).build().unwrap();
            for part in [8, 3, 1] {
                let state = states[states.len() / part - 1].contact;
                let found = solver.solve(state.load).unwrap().contact;
                // The tolerance, times a condition number of some 1e2.
                assert!((found.mean_gap / state.mean_gap - 1.0).abs() < 1e-9);
                assert!((found.approach / state.approach - 1.0).abs() < 1e-9);
                assert!(found.contact_stiffness.is_some() && found.interfacial_stiffness.is_some());
            }
        }
    }
}

/// A surface that repeats in both directions, with a wide flat margin, is pressed on a half-space that repeats along x,
/// and on one that repeats both ways: with a wide enough margin the mean gap in the middle differs by a uniform
/// displacement alone. So do events of one ridge.
#[test]
fn a_ridge_on_a_wide_periodic_grid_is_the_same() {
    let (nx, ny) = (24, 24);
    let ridge = |wide: usize| {
        let (surface, grid) = rough(nx, ny);
        let heights = asperity::Surface::heights(&surface, &grid).unwrap();
        let lowest = heights.min() - 1e-4;
        let first = (wide - ny) / 2;
        let heights = DMatrix::from_fn(nx, wide, |ix, iy| {
            let inside = iy >= first && iy < first + ny;
            if inside { heights[(ix, iy - first)] } else { lowest }
        });
        (HeightMap::new(heights).unwrap(), Grid::new(nx, wide, 1e-5, 1e-5).unwrap())
    };
    let (surface, grid) = ridge(ny);
    let kernel = SemiPeriodicBoussinesq::new(grid, 1e11, Axis::X).unwrap();
    let mut solver = FixedLoadSolver::builder(&surface, &kernel).tolerance(1e-11).build().unwrap();
    let expected = solver.solve_target(ContactTarget::AreaFraction(0.25)).unwrap();
    let mut errors = Vec::new();
    for times in [4, 8, 16] {
        let (surface, grid) = ridge(times * ny);
        let kernel = asperity::PeriodicBoussinesq::new(grid, 1e11).unwrap();
        let mut solver =
            FixedLoadSolver::builder(&surface, &kernel).tolerance(1e-11).build().unwrap();
        let found = solver.solve(expected.contact.load).unwrap();
        errors.push((found.fields.max_pressure() / expected.fields.max_pressure() - 1.0).abs());
    }
    // The plane images at the distance P across curve the displacement by (y/P)²: a quarter each time.
    for pair in errors.windows(2) {
        assert!((0.15..0.35).contains(&(pair[1] / pair[0])), "{errors:?}");
    }
    assert!(errors[2] < 2e-3, "{errors:?}");
}

/// A record names the half-space, and goes on in another process.
#[cfg(feature = "io")]
#[test]
fn records_are_gone_on_from() {
    let (surface, grid) = rough(32, 24);
    for along in [Axis::X, Axis::Y] {
        let kernel = SemiPeriodicBoussinesq::new(grid, 1e11, along).unwrap();
        let (_, whole) = followed(&kernel, &surface, 0.5, RecursiveCholesky::new());
        let builder = LoadingSolver::builder(&surface, &kernel).max_area_fraction(0.25);
        let mut path = builder.build().unwrap();
        let begun = path.run().unwrap();
        let mut all: Vec<LoadingState> = begun.events().to_vec();
        let record = LoadingRecord::new(&path, begun).unwrap();
        let name = format!("asperity-semi-{}-{along:?}.npz", std::process::id());
        let file = std::env::temp_dir().join(name);
        record.write_npz(&file, &[]).unwrap();
        let read = LoadingRecord::read_npz(&file);
        std::fs::remove_file(&file).unwrap();
        let read = read.unwrap();
        assert_eq!(read.kernel(), record.kernel());
        assert_eq!(read.kernel().origin, kernel.origin());
        assert_eq!(read.kernel().boundary, kernel.boundary());
        let mut path = read.resume().unwrap();
        path.continue_to(ContactTarget::AreaFraction(0.5)).unwrap();
        let more: Vec<LoadingState> = path.collect::<Result<_, _>>().unwrap();
        assert!(!all.is_empty() && !more.is_empty());
        all.extend(more);
        // No state is missing, and none is there twice.
        assert_eq!(all.len(), whole.len());
        for (found, expected) in all.iter().zip(&whole) {
            assert_eq!((found.step, found.event), (expected.step, expected.event));
            assert_eq!(found.node, expected.node);
            // Solutions in other windows, with a condition number of some 10³; and 0 where nothing touches.
            if expected.contact.load == 0.0 {
                assert_eq!(found.contact.load, 0.0);
                continue;
            }
            assert!((found.contact.load / expected.contact.load - 1.0).abs() < 1e-10);
        }
    }
}
