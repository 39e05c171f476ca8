//! Paths beside the factor, with windows in which nodes far from a watched one answer it in groups. Grids on which that pays have no
//! factor: here groups begin with fewer nodes.

use std::collections::HashMap;

use nalgebra::DMatrix;

use crate::kernel::KernelTable;
use crate::loading::LoadingState;
use crate::surface::{Amplitude, HeightMap, SelfAffine, Surface};
use crate::updater::{ConjugateGradient, LinearUpdater, RecursiveCholesky};
use crate::{
    Boussinesq, Error, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq, Spectral,
};

/// Nodes in contact from which on there are groups: from a quarter of the grid on.
const GROUPED: usize = 1000;
/// Events closer than this, relative to the approach that is computed with, are ties.
const TIE: f64 = 1e-9;

fn path<U: LinearUpdater>(
    surface: &HeightMap,
    kernel: &dyn InfluenceKernel,
    updater: U,
) -> Result<Vec<LoadingState>, Error> {
    LoadingSolver::builder(surface, kernel).updater(updater).build()?.collect()
}

fn rough(grid: Grid, seed: u64) -> Result<HeightMap, Error> {
    let side = grid.sides().0;
    let amplitude = Amplitude::RmsHeight(5e-3 * side);
    let surface = SelfAffine::new(0.8, side / 4.0, side / 16.0, amplitude, seed)?;
    Ok(HeightMap::sample(&surface, &grid)?)
}

/// Follows a path with groups and one with a factor: the same events up to ties, and states as near as between the ends of any windows.
/// Returns how many errors of the approach exceed their estimate, the greatest ratio to it, and both paths.
fn compare(
    surface: &HeightMap,
    kernel: &dyn InfluenceKernel,
) -> Result<(usize, f64, [Vec<LoadingState>; 2]), Error> {
    let exact = path(surface, kernel, RecursiveCholesky::new())?;
    let found = path(surface, kernel, ConjugateGradient::grouped_from(GROUPED))?;
    assert_eq!(found.len(), exact.len());
    let gauge = KernelTable::new(kernel)?.gauge().unwrap_or_default() / kernel.grid().cell_area();
    let place: HashMap<_, _> = exact.iter().enumerate().map(|(k, s)| (s.node, k)).collect();
    let tie = |k: usize| {
        let state = &exact[k].contact;
        (TIE * (state.approach + gauge * state.load)).max(1e-13 * exact[0].contact.mean_gap)
    };
    let (mut exceeded, mut worst) = (0, 0.0_f64);
    for (k, (state, expected)) in found.iter().zip(&exact).enumerate() {
        let own = &exact[place[&state.node]];
        let apart = (own.contact.approach - expected.contact.approach).abs();
        assert!(state.node == expected.node || apart <= tie(k), "{k}: {apart:e}, tie {:e}", tie(k));
        let error = (state.contact.approach - own.contact.approach).abs();
        // Both solutions may be off by their tolerance.
        let ratio = error / (state.approach_error + 0.2 * tie(k));
        exceeded += usize::from(ratio > 1.0);
        worst = worst.max(ratio);
        let next = exact.get(k + 1).map_or(f64::INFINITY, |next| next.contact.approach);
        if expected.contact.approach <= tie(k) || next - expected.contact.approach <= tie(k) {
            continue;
        }
        // Those of `tests/paths/without_factor.rs`, ten times what was measured on 128².
        let near = |a: f64, b: f64, part: f64| {
            assert!((a - b).abs() <= part * b, "{state:?} {expected:?}");
        };
        near(state.contact.load, expected.contact.load, 1e-4);
        let stiffness = |s: &LoadingState| s.contact.interfacial_stiffness.unwrap_or_default();
        if stiffness(expected).is_finite() {
            near(stiffness(state), stiffness(expected), 3e-4);
        }
    }
    Ok((exceeded, worst, [found, exact]))
}

/// Full contact on three half-spaces and on cells twice as long as wide.
#[test]
fn groups_find_the_events_of_the_factor() -> Result<(), Error> {
    let square = Grid::square(64, 1.0)?;
    let long = Grid::new(64, 92, 2.0, 1.0)?;
    let kernels: [Box<dyn InfluenceKernel>; 4] = [
        Box::new(Boussinesq::new(square, 1.0)?),
        Box::new(PeriodicBoussinesq::new(square, 1.0)?),
        Box::new(Spectral::new(square, 1.0)?),
        Box::new(Boussinesq::new(long, 1.0)?),
    ];
    let (mut events, mut all_exceeded) = (0, 0);
    for (seed, kernel) in (1..).zip(&kernels) {
        let surface = rough(kernel.grid(), seed)?;
        let (exceeded, worst, [found, _]) = compare(&surface, &**kernel)?;
        println!(
            "{:?}: {exceeded} errors exceed their estimate, worst {worst:.2}",
            kernel.boundary()
        );
        events += found.len();
        all_exceeded += exceeded;
    }
    // Estimates and no bounds: as many as elsewhere on grids as small as these.
    assert!(200 * all_exceeded <= events, "{all_exceeded} of {events}");
    Ok(())
}

/// Two by two copies of a tile: four nodes touch at a time, in the order of their indices, as with a factor.
#[test]
fn copies_of_a_node_touch_in_the_order_of_their_indices() -> Result<(), Error> {
    let n = 32;
    let tile = Grid::square(n, 1.0)?;
    let heights = rough(tile, 7)?.heights(&tile)?;
    let tiled = DMatrix::from_fn(2 * n, 2 * n, |ix, iy| heights[(ix % n, iy % n)]);
    let (surface, grid) = (HeightMap::new(tiled)?, Grid::square(2 * n, 2.0)?);
    for kernel in [
        Box::new(PeriodicBoussinesq::new(grid, 1.0)?) as Box<dyn InfluenceKernel>,
        Box::new(Spectral::new(grid, 1.0)?),
    ] {
        let (exceeded, worst, [found, exact]) = compare(&surface, &*kernel)?;
        println!("tiles: {exceeded} errors exceed their estimate, worst {worst:.2}");
        for states in [&found, &exact] {
            for orbit in states.chunks(4) {
                let index = |s: &LoadingState| s.node.0 + 2 * n * s.node.1;
                assert!(orbit.is_sorted_by_key(index), "{orbit:?}");
                let tile = |s: &LoadingState| (s.node.0 % n, s.node.1 % n);
                assert!(orbit.iter().all(|s| tile(s) == tile(&orbit[0])), "{orbit:?}");
            }
        }
    }
    Ok(())
}
