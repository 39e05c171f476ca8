//! Coated, thin and graded bodies: thin layers under spheres and punches, paths on soft and stiff coats, and their
//! records.

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::reference::ThinLayer;
use asperity::surface::Paraboloid;
#[cfg(feature = "io")]
use asperity::{ContactEvent, loading::History, record::LoadingRecord};
use asperity::{
    ContactGrowth, Error, FixedLoadSolver, Grid, InfluenceKernel, LoadingSolver, LoadingState,
    MeanDisplacement, SelfAffine,
};

const STEEL: Base = Base::HalfSpace { youngs_modulus: 210e9, poissons_ratio: 0.3 };

fn coat(youngs_modulus: f64, thickness: f64) -> LayeredBody {
    LayeredBody::new(&[Layer { youngs_modulus, poissons_ratio: 0.3, thickness }], STEEL).unwrap()
}

fn rough(n: usize) -> (SelfAffine, Grid) {
    let grid = Grid::square(n, 1e-3).unwrap();
    let cell = grid.dx();
    let amplitude = asperity::surface::Amplitude::RmsHeight(1e-6);
    (SelfAffine::new(0.8, 0.5e-3, 4.0 * cell, amplitude, 3).unwrap(), grid)
}

/// W(δ) of a sphere over that of a thin layer, less 1, with a contact radius of 32 cells.
fn errors_of_a_sphere(poissons_ratio: f64, thicknesses: [f64; 3]) -> [f64; 3] {
    let (n, radius, youngs_modulus) = (96, 4000.0, 1.0);
    let grid = Grid::square(n, n as f64).unwrap();
    let sphere = Paraboloid::new(radius).unwrap();
    thicknesses.map(|thickness: f64| {
        let layer = ThinLayer::new(youngs_modulus, poissons_ratio, thickness).unwrap();
        let body = Layer { youngs_modulus, poissons_ratio, thickness };
        let kernel = Layered::free(grid, LayeredBody::new(&[body], Base::Rigid).unwrap()).unwrap();
        let mut solver = FixedLoadSolver::new(&sphere, &kernel).unwrap();
        let found = solver.solve_approach(layer.sphere_approach(radius, 32.0)).unwrap();
        found.contact.load / layer.sphere_load(radius, 32.0) - 1.0
    })
}

#[test]
fn a_sphere_on_a_thin_layer() {
    // Nothing of first order is left of a compressible layer, whose pressure is zero at the edge: the errors are below
    // (h/a)²/5, and below those of 32 cells to the radius, 2 × 10⁻⁴.
    for (error, h) in errors_of_a_sphere(0.3, [8.0, 4.0, 2.0]).into_iter().zip([8.0, 4.0, 2.0]) {
        assert!(error.abs() < 0.2 * (h / 32.0_f64).powi(2) + 2e-4, "{h}: {error}");
    }
    let errors = errors_of_a_sphere(0.5, [6.0, 3.0, 1.5]);
    for pair in errors.windows(2) {
        // An incompressible layer carries nothing at the edge either: second order, a quarter each time.
        assert!((0.2..0.3).contains(&(pair[1] / pair[0])), "{errors:?}");
    }
}

/// The same of the stiffness of a flat punch.
#[test]
fn a_punch_on_a_thin_layer() {
    let n = 96_usize;
    let grid = Grid::square(n, n as f64).unwrap();
    for (poissons_ratio, thicknesses) in [(0.5, [6.0, 3.0, 1.5]), (0.3, [8.0, 4.0, 2.0])] {
        let errors = thicknesses.map(|thickness: f64| {
            let layer = ThinLayer::new(1.0, poissons_ratio, thickness).unwrap();
            let body = Layer { youngs_modulus: 1.0, poissons_ratio, thickness };
            let body = LayeredBody::new(&[body], Base::Rigid).unwrap();
            let kernel = Layered::free(grid, body).unwrap();
            let disc = disc_of(n, 32.0);
            let cells = disc.matrix().iter().filter(|height| **height == 0.0).count();
            let radius = (cells as f64 / std::f64::consts::PI).sqrt();
            let mut solver = FixedLoadSolver::new(&disc, &kernel).unwrap();
            let found = solver.solve_approach(1e-3).unwrap();
            found.contact.load / 1e-3 / layer.punch_stiffness(radius) - 1.0
        });
        for pair in errors.windows(2) {
            // First order, what is left of the second, and the steps of the outline.
            let ratio = pair[1] / pair[0];
            assert!((0.3..0.65).contains(&ratio), "{poissons_ratio}: {errors:?}");
        }
    }
}

/// A disc of height 0 in a plane far below.
fn disc_of(n: usize, radius: f64) -> asperity::HeightMap {
    let middle = 0.5 * n as f64;
    let height = |ix: usize, iy: usize| {
        let (x, y) = (ix as f64 + 0.5 - middle, iy as f64 + 0.5 - middle);
        if x.hypot(y) < radius { 0.0 } else { -100.0 }
    };
    asperity::HeightMap::new(asperity::nalgebra::DMatrix::from_fn(n, n, height)).unwrap()
}

fn followed(
    kernel: &Layered,
    surface: &SelfAffine,
    fraction: f64,
) -> (LoadingSolver, Vec<LoadingState>) {
    let mut path =
        LoadingSolver::builder(surface, kernel).max_area_fraction(fraction).build().unwrap();
    let states: Result<Vec<_>, Error> = path.by_ref().collect();
    (path, states.unwrap())
}

/// Paths on soft and stiff coats agree with single loads, and each state satisfies the contact conditions.
#[test]
fn paths_on_coats_are_those_of_single_loads() {
    let (surface, grid) = rough(32);
    for youngs_modulus in [20e9, 2000e9] {
        for made in [Layered::free, Layered::periodic, Layered::spectral] {
            let kernel = made(grid, coat(youngs_modulus, 15e-6)).unwrap();
            let is_soft = youngs_modulus < 210e9;
            assert_eq!(kernel.contact_growth() > ContactGrowth::Unknown, is_soft);
            let (mut path, states) = followed(&kernel, &surface, 0.5);
            let certificate = path.certificate().unwrap();
            // Some 500 nodes with a condition number of 1e3.
            assert!(certificate.least_pressure > -1e-10 && certificate.least_gap > -1e-10);
            let mut solver =
                FixedLoadSolver::builder(&surface, &kernel).tolerance(1e-11).build().unwrap();
            for part in [4, 2, 1] {
                let state = states[states.len() / part - 1];
                let found = solver.solve(state.contact.load).unwrap().contact;
                // The tolerance, times a condition number of some 1e2.
                let error = found.mean_gap / state.contact.mean_gap - 1.0;
                assert!(error.abs() < 1e-9, "{youngs_modulus} {error:e}");
                let error = found.approach / state.contact.approach - 1.0;
                assert!(error.abs() < 1e-9, "{youngs_modulus} {error:e}");
            }
        }
    }
}

/// A layer on a rigid base repeats: the approach contains the mean displacement, which is nothing if the layer is
/// incompressible.
#[test]
fn the_mean_displacement_is_that_of_the_layers() {
    let (surface, grid) = rough(24);
    for (poissons_ratio, mean) in
        [(0.3, MeanDisplacement::Physical), (0.5, MeanDisplacement::Arbitrary)]
    {
        let layers = [
            Layer { youngs_modulus: 1e9, poissons_ratio, thickness: 20e-6 },
            Layer { youngs_modulus: 3e9, poissons_ratio, thickness: 60e-6 },
        ];
        let body = LayeredBody::new(&layers, Base::Rigid).unwrap();
        let compliance = body.mean_compliance().unwrap();
        assert_eq!(compliance == 0.0, poissons_ratio == 0.5);
        for made in [Layered::periodic, Layered::spectral] {
            let kernel = made(grid, body.clone()).unwrap();
            assert_eq!(kernel.mean_displacement(), mean);
            let (mut path, states) = followed(&kernel, &surface, 1.0);
            let unloaded = states[0].contact.mean_gap;
            for state in &states {
                // ḡ = ḡ₀ + Ĉ(0) p̄ − δ.
                let uniform = compliance * state.contact.mean_pressure();
                let error = state.contact.mean_gap - (unloaded + uniform - state.contact.approach);
                assert!(
                    error.abs() <= 1e-10 * (unloaded + state.contact.approach),
                    "{poissons_ratio} {error:e}"
                );
            }
            let last = states[states.len() - 1];
            let displacement = path.fields().unwrap().displacement.mean();
            let uniform = compliance * last.contact.mean_pressure();
            assert!((displacement - uniform).abs() <= 1e-10 * unloaded, "{displacement} {uniform}");
        }
    }
}

/// A ratio that is ½ but for rounding has a mean compliance that rounding would hide, and the path of ½.
#[test]
fn a_layer_may_be_incompressible_to_rounding() {
    let (surface, _) = rough(16);
    let grid = Grid::square(16, 1e-3).unwrap();
    for thickness in [20e-6, 200e-6] {
        for made in [Layered::periodic, Layered::spectral] {
            let paths = [0.5, 0.499_999_999_999_999_9].map(|poissons_ratio| {
                let layer = Layer { youngs_modulus: 3e6, poissons_ratio, thickness };
                let body = LayeredBody::new(&[layer], Base::Rigid).unwrap();
                assert_eq!(body.mean_compliance().unwrap() > 0.0, poissons_ratio < 0.5);
                let kernel = made(grid, body).unwrap();
                assert_eq!(kernel.mean_displacement(), MeanDisplacement::Arbitrary);
                followed(&kernel, &surface, 0.9).1
            });
            assert_eq!(paths[0].len(), paths[1].len());
            for (one, other) in paths[0].iter().zip(&paths[1]) {
                assert_eq!(one.event, other.event);
                let (one, other) = (one.contact, other.contact);
                // Some 200 nodes with a condition number of 1e4.
                let is_close = |a: f64, b: f64| (a - b).abs() <= 1e-10 * a.abs();
                assert!(is_close(one.load, other.load), "{} {}", one.load, other.load);
                assert!(is_close(one.approach, other.approach));
                assert!(is_close(one.mean_gap, other.mean_gap));
            }
        }
    }
}

/// A record names the layers, and goes on in another process, releases included.
#[cfg(feature = "io")]
#[test]
fn records_of_layered_bodies_are_gone_on_from() {
    let (surface, grid) = rough(32);
    let graded = LayeredBody::new(
        &[
            Layer { youngs_modulus: 30e9, poissons_ratio: 0.4, thickness: 5e-6 },
            Layer { youngs_modulus: 80e9, poissons_ratio: 0.35, thickness: 10e-6 },
        ],
        STEEL,
    );
    let bodies = [coat(20e9, 15e-6), coat(2000e9, 15e-6), graded.unwrap().against(70e9).unwrap()];
    for (k, body) in bodies.into_iter().enumerate() {
        for (j, made) in
            [Layered::free, Layered::periodic, Layered::spectral].into_iter().enumerate()
        {
            let kernel = made(grid, body.clone()).unwrap();
            let (_, whole) = followed(&kernel, &surface, 0.4);
            let (path, begun) = followed(&kernel, &surface, 0.2);
            let history: History = begun.iter().copied().collect();
            let record = LoadingRecord::new(&path, history).unwrap();
            let file = std::env::temp_dir()
                .join(format!("asperity-layers-{}-{k}-{j}.npz", std::process::id()));
            record.write_npz(&file, &[]).unwrap();
            let read = LoadingRecord::read_npz(&file);
            std::fs::remove_file(&file).unwrap();
            let read = read.unwrap();
            assert_eq!(read.kernel(), record.kernel());
            assert_eq!(read.kernel().origin, kernel.origin());
            let mut path = read.resume().unwrap();
            path.continue_to(asperity::ContactTarget::AreaFraction(0.4)).unwrap();
            let more: Result<Vec<_>, Error> = path.collect();
            let more = more.unwrap();
            let events = |states: &[LoadingState]| -> Vec<_> {
                let all = states.iter().filter(|state| state.event != ContactEvent::Limit);
                all.map(|state| (state.event, state.node)).collect()
            };
            let mut all = events(&begun);
            let later = events(&more);
            assert!(!all.is_empty() && !later.is_empty(), "{k} {j}");
            // None is missing, and none is there twice.
            all.extend(later);
            assert_eq!(all, events(&whole), "{k} {j}");
            let (found, expected) = (more[more.len() - 1].contact, whole[whole.len() - 1].contact);
            assert!((found.load / expected.load - 1.0).abs() < 1e-9);
        }
    }
}
