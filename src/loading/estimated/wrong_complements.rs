//! Paths with Schur complements that are wrong, with another source of them than conjugate gradients.

use std::collections::HashSet;

use crate::loading::LoadingState;
use crate::surface::{Amplitude, HeightMap, SelfAffine};
use crate::updater::RecursiveCholesky;
use crate::updater::altered::{Altered, Proposal};
use crate::{
    Boussinesq, Error, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq, Spectral,
};

/// A rough surface of 20 × 20 nodes, and a body under it.
fn problems() -> Result<(HeightMap, [Box<dyn InfluenceKernel>; 3]), Error> {
    let grid = Grid::square(20, 1.0)?;
    let surface = SelfAffine::new(0.8, 5.0, 4.0 / 20.0, Amplitude::RmsHeight(5e-3), 7)?;
    let kernels: [Box<dyn InfluenceKernel>; 3] = [
        Box::new(Boussinesq::new(grid, 1.0)?),
        Box::new(PeriodicBoussinesq::new(grid, 1.0)?),
        Box::new(Spectral::new(grid, 1.0)?),
    ];
    Ok((HeightMap::sample(&surface, &grid)?, kernels))
}

/// Exact solutions, and Schur complements that are positive definite still: diagonals are off by up to `4 part²`.
fn off_by(part: f64) -> Altered {
    Altered::estimates(1e-10, move |(schur, _): &mut Proposal| {
        let size = schur.size();
        let exact = schur.matrix().into_owned();
        // v vᵀ of something small, different for every node.
        let part = |k: usize| {
            let unlike = exact[(k, k)] * 1e3;
            part * (1.0 + libm::sin(unlike + k as f64)) * exact[(k, k)].sqrt()
        };
        for j in 0..size {
            for i in j..size {
                schur.matrix_mut()[(i, j)] += part(i) * part(j);
            }
        }
    })
}

/// All states of the path with a factor.
fn exact(surface: &HeightMap, kernel: &dyn InfluenceKernel) -> Result<Vec<LoadingState>, Error> {
    let builder = LoadingSolver::builder(surface, kernel);
    builder.updater(RecursiveCholesky::new()).build()?.collect()
}

/// The correction belongs to the path and not to conjugate gradients: the same events, and pivots that are off by a part in a
/// thousand between the ends of windows.
#[test]
fn any_iterations_are_corrected() -> Result<(), Error> {
    let (surface, kernels) = problems()?;
    for kernel in &kernels {
        let exact = exact(&surface, &**kernel)?;
        let builder = LoadingSolver::builder(&surface, &**kernel).updater(off_by(0.03));
        let found: Vec<_> = builder.window_size(24).build()?.collect::<Result<_, _>>()?;
        assert_eq!(found.len(), exact.len());
        let initial = exact[0].contact.mean_gap;
        for (state, expected) in found.iter().zip(&exact) {
            assert_eq!(state.node, expected.node, "{state:?}");
            let (found, expected) = (state.contact, expected.contact);
            let context = format!("{found:?} {expected:?}");
            assert!((found.load - expected.load).abs() <= 1e-3 * expected.load, "{context}");
            assert!((found.mean_gap - expected.mean_gap).abs() <= 1e-4 * initial, "{context}");
            let stiffnesses = [
                (found.contact_stiffness, expected.contact_stiffness, 5e-3),
                (found.interfacial_stiffness, expected.interfacial_stiffness, 0.1),
            ];
            for (found, expected, allowed) in stiffnesses {
                match (found, expected) {
                    (Some(found), Some(expected)) if expected.is_finite() => {
                        assert!((found / expected - 1.0).abs() <= allowed, "{context}");
                    }
                    (found, expected) => assert_eq!(found, expected, "{context}"),
                }
            }
        }
    }
    Ok(())
}

/// Schur complements that are wrong by half let the wrong nodes join. The contact at the end of a window is
/// mended until it contradicts nothing: at least there, the nodes in contact are those of the factor.
#[test]
fn the_ends_of_windows_are_mended() -> Result<(), Error> {
    let (surface, kernels) = problems()?;
    let window = 24;
    for kernel in &kernels {
        let exact = exact(&surface, &**kernel)?;
        let builder = LoadingSolver::builder(&surface, &**kernel).updater(off_by(0.5));
        let mut path = builder.window_size(window).build()?;
        let found: Vec<_> = path.by_ref().collect::<Result<_, _>>()?;
        assert_eq!(found.len(), exact.len());
        // Nodes in one contact and not in the other.
        let mut different = HashSet::new();
        let (mut apart, mut longest) = (0, 0);
        for (found, exact) in found.iter().zip(&exact) {
            for node in [found.node, exact.node] {
                if !different.remove(&node) {
                    different.insert(node);
                }
            }
            apart = if different.is_empty() { 0 } else { apart + 1 };
            longest = longest.max(apart);
        }
        // The window, and what overlapped outside of it.
        assert!(longest < 2 * window, "wrong for {longest} states");
        let timings = path.timings();
        for count in [timings.taken_back, timings.ties] {
            assert!((1..exact.len()).contains(&count), "{timings:?}");
        }
    }
    Ok(())
}
