//! Surface, boundary, kernel and updater chosen at run time, as a program with options does.

use crate::parts::{Facets, Grains};
use asperity::kernel::SemiPeriodicBoussinesq;
use asperity::surface::{Amplitude, Axis, FlatPunch, Paraboloid};
use asperity::updater::{ConjugateGradient, Dense, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boundary, Boussinesq, ContactGrowth, Error, FixedLoadSolver, Grid, InfluenceKernel,
    LoadingSolver, LoadingState, PeriodicBoussinesq, SelfAffine, Spectral, Surface,
};
use asperity_testing::bordering::Bordering;

fn rough() -> Result<SelfAffine, asperity::SurfaceError> {
    SelfAffine::new(0.8, 1.2e-3, 4.5e-4, Amplitude::RmsHeight(1e-6), 3)
}

fn surface(name: &str) -> Result<Box<dyn Surface>, Error> {
    Ok(match name {
        "sphere" => Box::new(Paraboloid::new(1e-2)?),
        "rough" => Box::new(rough()?),
        "both" => Box::new(Paraboloid::new(1e-2)?.plus(rough()?)),
        _ => Box::new(Facets::new()),
    })
}

fn kernel(name: &str, boundary: Boundary, grid: Grid) -> Result<Box<dyn InfluenceKernel>, Error> {
    let e_star = 1e11;
    Ok(match (name, boundary) {
        ("spectral", _) => Box::new(Spectral::new(grid, e_star)?),
        ("own", _) => Box::new(Grains { grid, e_star, growth: ContactGrowth::Convex }),
        (_, Boundary::Free) => Box::new(Boussinesq::new(grid, e_star)?),
        (_, Boundary::Periodic) => Box::new(PeriodicBoussinesq::new(grid, e_star)?),
        (_, Boundary::PeriodicX) => Box::new(SemiPeriodicBoussinesq::new(grid, e_star, Axis::X)?),
        (_, Boundary::PeriodicY) => Box::new(SemiPeriodicBoussinesq::new(grid, e_star, Axis::Y)?),
    })
}

fn updater(name: &str) -> Box<dyn LinearUpdater> {
    match name {
        "factor" => Box::new(RecursiveCholesky::new()),
        "iterations" => Box::new(ConjugateGradient::new()),
        "handover" => Box::new(Handover::new()),
        "own" => Box::new(Bordering::default()),
        _ => Box::new(Dense::new()),
    }
}

#[test]
fn every_choice_gives_every_field() -> Result<(), Error> {
    let grid = Grid::new(14, 12, 2.5e-3 / 14.0, 2.5e-3 / 14.0)?;
    for surface_name in ["sphere", "rough", "both", "own"] {
        for (kernel_name, boundary) in [
            ("love", Boundary::Free),
            ("love", Boundary::Periodic),
            ("love", Boundary::PeriodicX),
            ("love", Boundary::PeriodicY),
            ("spectral", Boundary::Periodic),
            ("own", Boundary::Free),
        ] {
            let surface = surface(surface_name)?;
            let kernel = kernel(kernel_name, boundary, grid)?;
            assert_eq!(kernel.boundary(), boundary);
            let mut reference: Option<LoadingState> = None;
            for updater_name in ["factor", "iterations", "handover", "own", "dense"] {
                // Of bordering and iterations with a kernel that is not convex events may have to be
                // taken back, which the updater of these tests cannot.
                if (kernel_name, updater_name) == ("spectral", "own") {
                    continue;
                }
                let context =
                    format!("{surface_name}, {kernel_name}, {boundary:?}, {updater_name}");
                let mut path = LoadingSolver::builder(&surface, &kernel)
                    .updater(updater(updater_name))
                    .max_area_fraction(0.4)
                    .build()?;
                let state = match path.by_ref().last() {
                    Some(Ok(state)) => state,
                    other => panic!("{context}: {other:?}"),
                };
                assert_eq!(state.contact.contact_nodes, 67, "{context}");
                let expected = *reference.get_or_insert(state);
                // Iterations: changes inside a window err by some 1e-7.
                let error = (state.contact.load / expected.contact.load - 1.0).abs();
                assert!(error < 1e-6, "{context}: {error:e}");

                let (pressure, gap) = (path.fields()?.pressure, path.fields()?.gap);
                let (displacement, map) = (path.fields()?.displacement, path.contact_map());
                let load = pressure.sum() * grid.cell_area();
                assert!((load / state.contact.load - 1.0).abs() < 1e-6, "{context}: {load}");
                for field in [&pressure, &gap, &displacement] {
                    assert_eq!(field.shape(), grid.shape());
                }
                assert_eq!(map.iter().filter(|inside| **inside).count(), 67);
                let greatest = displacement.amax().max(state.contact.approach);
                for (node, inside) in map.iter().enumerate() {
                    if *inside {
                        assert!(pressure[node] >= -1e-6 * pressure.max(), "{context}");
                        assert!(gap[node].abs() <= 1e-6 * greatest, "{context}");
                    } else {
                        assert_eq!(pressure[node], 0.0);
                        assert!(gap[node] >= -1e-6 * greatest, "{context}");
                    }
                }
            }
            // One load alone, between the last two events: the same contact.
            let mut path = LoadingSolver::builder(&surface, &kernel).build()?;
            let states = path.by_ref().take(68).collect::<Result<Vec<_>, _>>()?;
            let load = 0.5 * (states[66].contact.load + states[67].contact.load);
            if load > states[66].contact.load * (1.0 + 1e-6) {
                let solution = FixedLoadSolver::new(&surface, &kernel)?.solve(load)?;
                let map = path_map(&path.contact_order()[..67], grid);
                assert_eq!(solution.fields.contact_map, map, "{surface_name}, {kernel_name}");
            }
        }
    }
    Ok(())
}

fn path_map(order: &[usize], grid: Grid) -> nalgebra::DMatrix<bool> {
    let mut map = nalgebra::DMatrix::from_element(grid.nx(), grid.ny(), false);
    for &node in order {
        map[node] = true;
    }
    map
}

#[test]
fn surfaces_and_kernels_by_reference_and_in_boxes() {
    let grid = Grid::square(8, 1e-3).unwrap();
    let kernel = Boussinesq::new(grid, 1e9).unwrap();
    let sphere = Paraboloid::new(0.1).unwrap();
    let states = |surface: &dyn Surface, kernel: &dyn InfluenceKernel| -> Vec<LoadingState> {
        let path = LoadingSolver::new(surface, kernel).unwrap();
        path.map(Result::unwrap).collect()
    };
    let reference = states(&sphere, &kernel);
    assert_eq!(reference.len(), 64);
    let boxed: Box<dyn Surface> = Box::new(sphere);
    assert_eq!(states(&boxed, &kernel), reference);
    assert_eq!(states(&*boxed, &&kernel), reference);
    assert_eq!(states(&&sphere, &kernel), reference);
    let mixed: Vec<Box<dyn Surface>> = vec![Box::new(FlatPunch::default()), Box::new(sphere)];
    for surface in mixed {
        assert_eq!(states(&surface, &kernel).len(), 64);
    }
    let boxed: Box<dyn InfluenceKernel> = Box::new(kernel);
    assert_eq!(states(&sphere, &boxed), reference);
    assert_eq!(states(&sphere, &*boxed), reference);
    let shared: std::sync::Arc<dyn InfluenceKernel> = std::sync::Arc::from(boxed);
    assert_eq!(states(&sphere, &shared), reference);
}
