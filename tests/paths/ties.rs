//! Nodes that touch at the same instant: flat punches, plateaus and symmetric shapes.

use crate::common::{half_way, with_window};
use asperity::loading::{History, LoadingSolver};
use asperity::surface::{Amplitude, HeightMap, Paraboloid, SelfAffine, Wave};
use asperity::surface::{Axis, BiWave, Cone, Cylinder, EllipticParaboloid, FlatPunch};
use asperity::{Boussinesq, Grid, LoadingState, Surface};
use nalgebra::DMatrix;

const WINDOWS: [Option<usize>; 3] = [Some(1), Some(7), None];
/// Events closer than this, relative to the approach, are one instant that rounding has torn apart:
/// ratios r1 / r2 are good to some 1e-14, and the shells of the shapes here are 1e-4 apart or more.
const SAME: f64 = 1e-10;
/// Pressures of nodes that mirror each other: the order of elimination differs, so that the solves
/// differ by the condition number, below 1e3, times 1e-16.
const SYMMETRIC: f64 = 1e-11;

fn solver(surface: &dyn Surface, grid: Grid, window: Option<usize>) -> LoadingSolver {
    let kernel = Boussinesq::new(grid, 2.0).unwrap();
    let builder = LoadingSolver::builder(surface, &kernel);
    with_window(builder, window).build().unwrap()
}

/// Every number is finite, except the interfacial stiffness of full contact; nothing goes backwards.
fn check_numbers(states: &[LoadingState], nodes: usize) {
    assert_eq!(states.len(), nodes);
    for (k, s) in states.iter().enumerate() {
        assert_eq!(s.step, k + 1);
        for value in [
            s.contact.approach,
            s.contact.load,
            s.contact.contact_stiffness.unwrap(),
            s.contact.energy,
        ] {
            assert!(value.is_finite() && value >= 0.0, "{s:?}");
        }
        // A difference of lengths like the approach: where the last nodes touch at once, it may
        // miss zero by their rounding.
        assert!(
            s.contact.mean_gap.is_finite() && s.contact.mean_gap >= -1e-13 * s.contact.approach,
            "{s:?}"
        );
        assert!(
            s.contact.contact_stiffness > Some(0.0) && s.contact.interfacial_stiffness > Some(0.0),
            "{s:?}"
        );
        let interfacial = s.contact.interfacial_stiffness.unwrap();
        assert_eq!(interfacial.is_finite(), s.step < nodes, "{s:?}");
    }
    for pair in states.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        assert!(
            a.contact.approach <= b.contact.approach && a.contact.load <= b.contact.load,
            "{a:?} {b:?}"
        );
        assert!(a.contact.contact_stiffness <= b.contact.contact_stiffness, "{a:?} {b:?}");
    }
}

/// The field mirrored in x, in y, and (on square grids) in the diagonal.
fn images<T: nalgebra::Scalar + Copy>(field: &DMatrix<T>, diagonal: bool) -> Vec<DMatrix<T>> {
    let (nx, ny) = field.shape();
    let mut images = vec![
        DMatrix::from_fn(nx, ny, |ix, iy| field[(nx - 1 - ix, iy)]),
        DMatrix::from_fn(nx, ny, |ix, iy| field[(ix, ny - 1 - iy)]),
    ];
    if diagonal {
        images.push(field.transpose());
    }
    images
}

/// Runs a mirror-symmetric shape to full contact. Returns the number of complete shells, at which
/// contact and pressure must be symmetric.
fn check_symmetric(shape: &dyn Surface, grid: Grid, diagonal: bool) -> usize {
    let mut counts = Vec::new();
    for window in WINDOWS {
        let states: Vec<_> = solver(shape, grid, window).map(Result::unwrap).collect();
        check_numbers(&states, grid.nodes());
        let mut path = solver(shape, grid, window);
        let mut shells = 0;
        for (k, state) in states.iter().enumerate() {
            assert_eq!(path.next().unwrap().unwrap(), *state);
            let complete = states.get(k + 1).is_none_or(|next| {
                next.contact.approach > state.contact.approach * (1.0 + SAME) + f64::MIN_POSITIVE
            });
            if !complete {
                continue;
            }
            shells += 1;
            let context = format!("window {window:?}, {state:?}");
            let map = path.contact_map();
            // Half-way to the next event, where no pressure of the contact is zero any more.
            let later = half_way(*state, states.get(k + 1).copied());
            let pressure = path.fields_at(&later).unwrap().pressure;
            for image in images(&map, diagonal) {
                assert_eq!(map, image, "{context}");
            }
            for image in images(&pressure, diagonal) {
                let error = (&pressure - image).amax() / pressure.amax();
                assert!(error <= SYMMETRIC, "{context}: {error:e}");
            }
            let certificate = path.certificate().unwrap();
            // As everywhere: pressure and gap of an exact state, to rounding.
            assert!(certificate.least_pressure >= -1e-12, "{context}: {certificate:?}");
            assert!(certificate.least_gap >= -1e-12, "{context}: {certificate:?}");
        }
        assert!(path.next().is_none());
        counts.push(shells);
    }
    assert!(counts.iter().all(|count| *count == counts[0]), "{counts:?}");
    counts[0]
}

#[test]
fn flat_punches_fill_in_order_of_the_index() {
    // A height that is no power of two: differences must vanish exactly all the same.
    for height in [0.0, 0.3, -1e-7] {
        for (nx, ny, dx, dy) in [(12, 12, 1e-3, 1e-3), (9, 14, 1e-3, 4e-3), (1, 40, 1.0, 0.2)] {
            let grid = Grid::new(nx, ny, dx, dy).unwrap();
            let punch = FlatPunch::new(height).unwrap();
            for window in WINDOWS {
                let mut path = solver(&punch, grid, window);
                let states: Vec<_> = path.by_ref().map(Result::unwrap).collect();
                check_numbers(&states, grid.nodes());
                let order: Vec<_> = (0..grid.nodes()).collect();
                assert_eq!(path.contact_order(), order, "window {window:?}");
                for state in &states {
                    assert_eq!(
                        (
                            state.contact.approach,
                            state.contact.load,
                            state.contact.mean_gap,
                            state.contact.energy
                        ),
                        (0.0, 0.0, 0.0, 0.0)
                    );
                }
                // Loaded, the pressure is symmetric, and highest in the corners.
                let history: History = states.into_iter().collect();
                let loaded = history.at_load(1.0).unwrap();
                let pressure = path.fields_at(&loaded).unwrap().pressure;
                for image in images(&pressure, nx == ny) {
                    assert!((&pressure - image).amax() <= SYMMETRIC * pressure.amax());
                }
                assert!(pressure[(0, 0)] >= pressure.max() * (1.0 - SYMMETRIC));
                // Sums of some hundred pressures.
                let load = pressure.sum() * grid.cell_area();
                assert!((load - 1.0).abs() < 1e-13, "{load}");
            }
        }
    }
}

#[test]
fn a_single_node_is_a_path() {
    let grid = Grid::new(1, 1, 1e-3, 2e-3).unwrap();
    for window in WINDOWS {
        let states: Vec<_> =
            solver(&FlatPunch::default(), grid, window).map(Result::unwrap).collect();
        check_numbers(&states, 1);
    }
}

#[test]
fn a_worn_plateau_fills_in_order_and_before_the_rest() {
    let grid = Grid::square(20, 1e-2).unwrap();
    let rough = SelfAffine::new(0.8, 5e-3, 1e-3, Amplitude::RmsHeight(1e-5), 5).unwrap();
    let worn = rough.heights(&grid).unwrap().map(|height| height.min(5e-6));
    let plateau: Vec<_> = (0..grid.nodes()).filter(|&node| worn[node] == 5e-6).collect();
    assert!(plateau.len() > 50 && plateau.len() < 200, "{}", plateau.len());
    let map = HeightMap::new(worn).unwrap();
    for window in WINDOWS {
        let mut path = solver(&map, grid, window);
        let states: Vec<_> = path.by_ref().map(Result::unwrap).collect();
        check_numbers(&states, grid.nodes());
        assert_eq!(path.contact_order()[..plateau.len()], plateau);
        assert_eq!(states[plateau.len() - 1].contact.load, 0.0);
        assert!(states[plateau.len()].contact.load > 0.0);
        let mut path = solver(&map, grid, window);
        while path.next().is_some() {
            let certificate = path.certificate().unwrap();
            assert!(certificate.least_pressure >= -1e-12, "{certificate:?}");
            assert!(certificate.least_gap >= -1e-12, "{certificate:?}");
        }
    }
}

#[test]
fn paraboloids_grow_in_shells() {
    // The eight images of a node touch at once, and the grid tells most others apart.
    for n in [15, 16] {
        let grid = Grid::square(n, 1e-2).unwrap();
        let shells = check_symmetric(&Paraboloid::new(0.5).unwrap(), grid, true);
        let octant = n.div_ceil(2) * (n.div_ceil(2) + 1) / 2;
        assert!(shells > octant / 2 && shells <= octant, "{shells}");
    }
}

#[test]
fn cones_grow_in_shells() {
    for n in [13, 14] {
        let grid = Grid::square(n, 1e-2).unwrap();
        let shells = check_symmetric(&Cone::new(0.05).unwrap(), grid, true);
        let octant = n.div_ceil(2) * (n.div_ceil(2) + 1) / 2;
        assert!(shells > octant / 2 && shells <= octant, "{shells}");
    }
}

#[test]
fn oblong_shapes_grow_in_shells() {
    let grid = Grid::new(15, 10, 1e-3, 2e-3).unwrap();
    let quadrant = 8 * 5;
    for shells in [
        check_symmetric(&EllipticParaboloid::new(0.5, 0.9).unwrap(), grid, false),
        check_symmetric(&Cylinder::new(0.5, Axis::Y).unwrap(), grid, false),
        check_symmetric(&Paraboloid::new(0.5).unwrap(), grid, false),
    ] {
        assert!(shells > quadrant / 2 && shells <= quadrant, "{shells}");
    }
}

#[test]
fn symmetric_waves_grow_in_shells() {
    let side = 1e-2;
    for n in [16, 17] {
        let grid = Grid::square(n, side).unwrap();
        let wave = BiWave::new(1e-5, side / 2.0, side / 2.0).unwrap();
        assert!(check_symmetric(&wave, grid, true) > n);
        let wave = Wave::new(1e-5, side / 2.0, Axis::X).unwrap();
        assert!(check_symmetric(&wave, grid, false) > n);
    }
}
