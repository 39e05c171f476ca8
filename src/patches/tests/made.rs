//! Patches of one state, orders of contact, and contacts made so that the answer is known.

use approx::assert_relative_eq;
use nalgebra::DMatrix;
use proptest::prelude::*;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::super::*;
use super::cases;
use crate::contact::ContactSequence;
use crate::loading::History;
use crate::reference::HertzSphere;
use crate::surface::Paraboloid;
use crate::{Boundary, Boussinesq, Error, Grid, LoadingSolver, SurfaceError};

/// A map from a picture of rows along x.
fn map(rows: &[&str]) -> DMatrix<bool> {
    let nx = rows.first().map_or(0, |row| row.len());
    DMatrix::from_fn(nx, rows.len(), |ix, iy| rows[iy].as_bytes()[ix] == b'#')
}

proptest! {
    #[test]
    fn labels_and_loads_are_those_of_a_flood_fill(case in cases()) {
        let grid = case.grid()?;
        let contact = case.contact()?.map_at(case.order.len());
        let patches = Patches::new(&contact, &grid, case.boundary, case.connectivity)?;
        let pressure = DMatrix::from_fn(grid.nx(), grid.ny(), |ix, iy| 1.0 + (ix * iy) as f64);
        let loads = patches.loads(&pressure)?;
        let picture = case.picture(case.order.len());
        let pools = picture.pools();
        prop_assert_eq!(patches.patches().len(), pools.len());
        prop_assert_eq!(loads.len(), pools.len());
        let labelled = patches.labels().iter().filter(|label| **label > 0).count();
        prop_assert_eq!(labelled, case.order.len());
        let parts = patches.patches().iter().zip(&loads).zip(pools);
        for (((patch, carried), pool), label) in parts.zip(1..) {
            let nodes = pool.nodes.len();
            prop_assert_eq!(patch.nodes, nodes);
            prop_assert!(pool.nodes.keys().all(|&node| patches.labels()[node] == label));
            prop_assert_eq!(patch.wraps, pool.endless);
            let perimeter = patch.perimeter;
            let found = [perimeter.along_x, perimeter.along_y];
            let border = [perimeter.border_along_x, perimeter.border_along_y];
            prop_assert_eq!([found, border].concat(), picture.sides(pool.nodes.keys().copied()));
            // Whole numbers: sums are exact, and the rest rounds a few times.
            let pressures = pool.nodes.keys().map(|&node| pressure[node]);
            let sum: f64 = pressures.clone().sum();
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-14 * b.abs();
            prop_assert!(close(carried.load, sum * grid.cell_area()));
            prop_assert!(close(carried.mean_pressure, sum / nodes as f64));
            prop_assert!(close(carried.mean_pressure * patch.area, carried.load));
            prop_assert_eq!(carried.max_pressure, pressures.fold(0.0, f64::max));
            let mean = |sum: i64| sum as f64 / nodes as f64 + 0.5;
            let x = mean(pool.nodes.values().map(|place| place.0).sum()) * grid.dx();
            let y = mean(pool.nodes.values().map(|place| place.1).sum()) * grid.dy();
            let (lx, ly) = grid.sides();
            for (center, expected, side, endless) in [
                (patch.centroid.0, x.rem_euclid(lx), lx, pool.endless.0),
                (patch.centroid.1, y.rem_euclid(ly), ly, pool.endless.1),
            ] {
                let away = (center - expected).abs();
                let same = (0.0..side).contains(&center) && away.min(side - away) < 1e-13 * side;
                prop_assert_eq!(center.is_nan(), endless);
                prop_assert!(endless || same, "{} instead of {}", center, expected);
            }
        }
    }
}

#[test]
fn a_patch_across_the_border_is_put_together() -> Result<(), Error> {
    let contact = map(&["##...#", "......", "......", "##...#"]);
    let grid = Grid::new(6, 4, 1.0, 2.0)?;
    let patches = Patches::new(&contact, &grid, Boundary::Periodic, Connectivity::Four)?;
    let [patch] = patches.patches() else {
        return Err(SurfaceError::EmptyGrid { nx: 0, ny: 0 }.into());
    };
    assert_eq!(patch.centroid, (0.5, 0.0));
    assert_eq!((patch.nodes, patch.area), (6, 12.0));
    assert_eq!((patch.perimeter.sides(), patch.perimeter.length(&grid)), (10, 14.0));
    let patches = Patches::new(&contact, &grid, Boundary::Free, Connectivity::Four)?;
    let centers: Vec<_> = patches.patches().iter().map(|patch| patch.centroid).collect();
    assert_eq!(centers, [(1.0, 1.0), (5.5, 1.0), (1.0, 7.0), (5.5, 7.0)]);
    let border: Vec<_> = patches.patches().iter().map(|patch| patch.perimeter).collect();
    assert_eq!((border[0].border_along_x, border[0].border_along_y), (2, 1));
    assert_eq!((border[0].along_x, border[0].along_y), (2, 1));
    assert_eq!(border[0].length(&grid), 8.0);
    Ok(())
}

/// A diagonal that climbs one period while it winds around once goes on along both directions, and so
/// do the channels beside it. On a free boundary there is contact from end to end, and no channel.
#[test]
fn a_patch_that_climbs_leads_along_both_directions() -> Result<(), Error> {
    let contact = ContactSequence::with_order(Grid::square(4, 1.0)?, [0, 5, 10, 15])?;
    let around = Percolation::winding(&contact, Boundary::Periodic, Connectivity::Eight);
    assert_eq!((around.contact_x, around.contact_y), (Some(4), Some(4)));
    assert_eq!((around.seal_x, around.seal_y), (None, None));
    let across = Percolation::winding(&contact, Boundary::Periodic, Connectivity::Four);
    assert_eq!((across.contact_x, across.contact_y), (None, None));
    // Between the ends as well, where channels pass the border across.
    let ends = Percolation::of(&contact, Boundary::Periodic, Connectivity::Eight);
    assert_eq!((ends.contact_x, ends.contact_y), (Some(4), Some(4)));
    assert_eq!((ends.seal_x, ends.seal_y), (None, None));
    let free = Percolation::of(&contact, Boundary::Free, Connectivity::Eight);
    assert_eq!((free.contact_x, free.contact_y), (Some(4), Some(4)));
    assert_eq!((free.seal_x, free.seal_y), (Some(4), Some(4)));
    Ok(())
}

#[test]
fn maps_and_fields_need_the_shape_of_the_grid() -> Result<(), Error> {
    let grid = Grid::new(3, 2, 1.0, 1.0)?;
    let all = DMatrix::from_element(2, 3, true);
    let refused = Patches::new(&all, &grid, Boundary::Free, Connectivity::Four);
    assert!(matches!(refused, Err(Error::GridMismatch { .. })));
    let all = all.transpose();
    let patches = Patches::new(&all, &grid, Boundary::Free, Connectivity::Four)?;
    let refused = patches.loads(&DMatrix::zeros(2, 3));
    assert!(matches!(refused, Err(Error::GridMismatch { .. })));
    let mut pressure = DMatrix::zeros(3, 2);
    pressure[(1, 1)] = f64::INFINITY;
    assert!(matches!(
        patches.loads(&pressure),
        Err(Error::FieldNotFinite { field: "pressure", ix: 1, iy: 1, .. })
    ));
    Ok(())
}

/// The states of a sphere on cells that are not square.
fn sphere(n: (usize, usize), fraction: f64) -> Result<(Grid, HertzSphere, History), Error> {
    let (e_star, radius) = (1.0, 10.0);
    let grid = Grid::with_sides(n.0, n.1, 1.0, 1.0)?;
    let half_space = Boussinesq::new(grid, e_star)?;
    let surface = Paraboloid::new(radius)?.centered_at(0.503, 0.4991)?;
    let path = LoadingSolver::builder(&surface, &half_space).max_area_fraction(fraction);
    let history = path.build()?.collect::<Result<_, _>>()?;
    Ok((grid, HertzSphere::new(radius, e_star)?, history))
}

#[test]
fn the_activation_map_holds_every_contact_map() -> Result<(), Error> {
    let (grid, _, history) = sphere((12, 9), 0.4)?;
    let step = activation_map(&grid, history.states(), |state| state.step as f64)?;
    let approach = activation_map(&grid, history.states(), |state| state.contact.approach)?;
    let contact = history.contact_sequence(grid)?;
    assert_eq!(contact.len(), 43);
    for state in history.states() {
        let map = contact.map_at(state.step);
        assert_eq!(step.map(|touched| touched <= state.step as f64), map);
        // Without ties, as here.
        assert_eq!(approach.map(|touched| touched <= state.contact.approach), map);
    }
    assert_eq!(step.iter().filter(|touched| touched.is_nan()).count(), 108 - 43);
    let small = Grid::new(9, 12, 1.0, 1.0)?;
    let refused = activation_map(&small, history.states(), |state| state.contact.load);
    assert!(matches!(refused, Err(Error::NodeOutOfGrid { .. })));
    Ok(())
}

/// Against Hertz, from 200 nodes in contact on.
#[test]
fn the_corrected_area_is_closer_to_that_of_hertz() -> Result<(), Error> {
    // (pi - 1 + ln 2) / 24 by hand.
    assert_relative_eq!(
        Perimeter::AREA_CORRECTION,
        0.118_114_159_8,
        epsilon = 0.0,
        max_relative = 1e-6
    );
    for n in [(40, 40), (48, 32)] {
        let (grid, hertz, history) = sphere(n, 0.5)?;
        let contact = history.contact_sequence(grid)?;
        let patches = PatchHistory::new(&contact, Boundary::Free, Connectivity::Four);
        let (mut error, mut corrected) = (0.0, 0.0);
        for (patches, state) in patches.zip(history.states()).skip(200) {
            let radius = (0.75 * state.contact.load * hertz.radius() / hertz.e_star()).cbrt();
            let area = std::f64::consts::PI * radius * radius;
            assert_eq!(patches.patches, 1);
            error += state.contact.contact_area - area;
            corrected += patches.corrected_area(&grid) - area;
        }
        // Measured: -0.24 on square cells, -0.27 on others: the correction is a mean over directions and places.
        assert!((corrected / error).abs() < 0.35, "{n:?}: {}", corrected / error);
    }
    Ok(())
}

/// The border of the grid cuts no cell.
#[test]
fn the_corrected_area_of_full_contact_is_the_nominal_one() -> Result<(), Error> {
    let grid = Grid::new(5, 4, 1.0, 2.0)?;
    let contact = ContactSequence::with_order(grid, 0..20)?;
    for boundary in [Boundary::Free, Boundary::Periodic] {
        let last = PatchHistory::new(&contact, boundary, Connectivity::Four).last();
        assert_eq!(last.map(|state| state.corrected_area(&grid)), Some(40.0));
        let sides = last.map(|state| state.perimeter.sides());
        assert_eq!(sides, Some(if boundary == Boundary::Free { 18 } else { 0 }));
    }
    Ok(())
}

/// Nodes in random order: contact percolates at the threshold of site percolation on the square lattice, 0.592746 with
/// four neighbours (Newman & Ziff, Phys. Rev. Lett. 85 (2000) 4104) and one less that with eight, to within
/// the width of the transition, some (512)^(-3/4) = 0.009.
#[test]
fn random_contact_percolates_at_the_threshold_of_the_square_lattice() -> Result<(), Error> {
    let grid = Grid::square(512, 1.0)?;
    let mut order: Vec<usize> = (0..grid.nodes()).collect();
    order.shuffle(&mut ChaCha8Rng::seed_from_u64(1));
    let contact = ContactSequence::with_order(grid, order)?;
    let four = 0.592_746;
    for (connectivity, threshold) in [(Connectivity::Four, four), (Connectivity::Eight, 1.0 - four)]
    {
        for boundary in [Boundary::Free, Boundary::Periodic] {
            let found = Percolation::of(&contact, boundary, connectivity);
            // Channels pass through sides, as patches without corners do.
            let contact = [found.contact_x, found.contact_y].map(|step| (step, threshold));
            let leaks = [found.seal_x, found.seal_y].map(|step| (step, 1.0 - four));
            for (step, threshold) in contact.into_iter().chain(leaks) {
                let share = step.map(|step| step as f64 / grid.nodes() as f64);
                assert!(share.is_some_and(|share| (share - threshold).abs() < 0.009), "{found:?}");
            }
        }
    }
    Ok(())
}
