//! Kernels that break what they promise of their contact, and what a window makes of them.

use nalgebra::DMatrix;

use crate::surface::HeightMap;
use crate::updater::{ConjugateGradient, LinearUpdater, RecursiveCholesky};
use crate::{Boundary, ContactGrowth, Error, Grid, InfluenceKernel, LoadingSolver, LoadingState};

/// Coefficients along a strip, by distance, and a promise.
#[derive(Debug)]
struct Strip {
    grid: Grid,
    coefficients: Vec<f64>,
    growth: ContactGrowth,
}

impl Strip {
    fn new(coefficients: &[f64], growth: ContactGrowth) -> Result<Self, Error> {
        Ok(Self {
            grid: Grid::new(coefficients.len(), 1, 1.0, 1.0)?,
            coefficients: coefficients.to_vec(),
            growth,
        })
    }

    fn path<U: LinearUpdater>(&self, gaps: &[f64], updater: U) -> Result<LoadingSolver<U>, Error> {
        let heights = DMatrix::from_fn(gaps.len(), 1, |ix, _| -gaps[ix]);
        LoadingSolver::builder(&HeightMap::new(heights)?, self).updater(updater).build()
    }

    /// The states without a factor, how often a window was taken back, and how the path failed.
    fn without_factor(&self, gaps: &[f64]) -> Result<Outcome, Error> {
        let mut path = self.path(gaps, ConjugateGradient::new())?;
        let (mut states, mut failure) = (Vec::new(), None);
        for item in path.by_ref() {
            match item {
                Ok(state) => states.push(state),
                Err(error) => failure = Some(error),
            }
        }
        Ok((states, path.timings().taken_back, failure))
    }
}

type Outcome = (Vec<LoadingState>, usize, Option<Error>);

impl InfluenceKernel for Strip {
    fn grid(&self) -> Grid {
        self.grid
    }

    fn boundary(&self) -> Boundary {
        Boundary::Free
    }

    fn coefficient(&self, di: isize, _dj: isize) -> f64 {
        self.coefficients[di.unsigned_abs()]
    }

    fn contact_growth(&self) -> ContactGrowth {
        self.growth
    }
}

/// A cell raises the surface at a distance of 12: node 1, which touches at 0.1, lifts node 13 to the indenter at
/// 0.26 − 0.4 (t − 0.1) = t, 0.214. Its bound was 0.26, so that the window from first touch to 0.225, the middle
/// of the widest spacing behind most of its events, does not watch it, and finds it overlapping at its end. The
/// window is taken back, and the path is the one that is found an event at a time, with a factor.
#[test]
fn a_node_that_overlaps_unwatched_is_watched() -> Result<(), Error> {
    let mut coefficients = [0.0; 16];
    (coefficients[0], coefficients[12]) = (1.0, -0.4);
    let gaps =
        [0.0, 0.1, 0.15, 0.16, 0.17, 0.18, 0.19, 0.20, 0.25, 5.0, 6.0, 7.0, 8.0, 0.26, 9.0, 10.0];
    let exact = Strip::new(&coefficients, ContactGrowth::Unknown)?;
    let exact = exact.path(&gaps, RecursiveCholesky::new())?;
    let exact: Vec<LoadingState> = exact.collect::<Result<_, _>>()?;
    let kernel = Strip::new(&coefficients, ContactGrowth::Monotone)?;
    let (found, taken_back, failure) = kernel.without_factor(&gaps)?;
    assert!(failure.is_none(), "{failure:?}");
    assert!(taken_back > 0);
    assert_eq!((found.len(), exact[8].node), (16, (13, 0)));
    for (state, exact) in found.iter().zip(&exact) {
        assert_eq!(state.node, exact.node);
        let error = (state.contact.approach - exact.contact.approach).abs();
        // What the state says of itself, and rounding.
        let allowed = state.approach_error + 1e-13 * exact.contact.approach;
        assert!(error <= allowed, "{error:e} of {allowed:e}: {state:?}");
    }
    Ok(())
}

/// Between two nodes in contact the surface sinks faster than they do, 2 · 0.7 / (1 + 0.2) > 1: the third never
/// touches.
#[test]
fn a_gap_that_never_closes_is_named() -> Result<(), Error> {
    let kernel = Strip::new(&[1.0, 0.7, 0.2], ContactGrowth::Monotone)?;
    let (states, _, failure) = kernel.without_factor(&[0.0, 5.0, 0.01])?;
    let nodes: Vec<usize> = states.iter().map(|state| state.node.0).collect();
    assert_eq!(nodes, [0, 2]);
    let Some(Error::NotMonotone {
        quantity: "closing rate of the gap",
        ix: 1,
        iy: 0,
        approach,
        value: 0.0,
    }) = failure
    else {
        unreachable!("{failure:?}");
    };
    // Where the window ended, at most a twentieth behind its last event at 0.01 / (1 − 0.2).
    assert!((0.0125..0.0125 * 1.06).contains(&approach), "{approach}");
    Ok(())
}

/// The determinant of all three nodes is (1 − d)(1 + d − 2 c²) < 0, those of two are positive: the third cannot touch.
#[test]
fn a_kernel_that_is_not_positive_definite_names_the_node() -> Result<(), Error> {
    let (c, d) = (0.8, 0.2);
    let kernel = Strip::new(&[1.0, c, d], ContactGrowth::Monotone)?;
    let gaps = [0.0, 0.1, 1.0];
    let (states, _, failure) = kernel.without_factor(&gaps)?;
    let nodes: Vec<usize> = states.iter().map(|state| state.node.0).collect();
    assert_eq!(nodes, [0, 1]);
    // Pressures of two nodes at an approach t, by Cramer's rule, and when 1 + d p₀ + c p₁ = t.
    let determinant = 1.0 - c * c;
    let [p0, p1] = [[-c * -gaps[1], 1.0 - c], [-gaps[1], 1.0 - c]];
    let at = |k: usize| (d * p0[k] + c * p1[k]) / determinant;
    let touches = (gaps[2] + at(0)) / (1.0 - at(1));
    let expected = (1.0 - d) * (1.0 + d - 2.0 * c * c) / determinant;
    let Some(Error::NotPositiveDefinite { ix: 2, iy: 0, approach, pivot }) = failure else {
        unreachable!("{failure:?}");
    };
    // Solutions to 1e-10 of the length.
    assert!((approach / touches - 1.0).abs() < 1e-8, "{approach} {touches}");
    // Complements without a factor are in single precision: rounding errors of 6e-8, a sum of 1.2 and a condition of 9.
    assert!((pivot - expected).abs() < 1e-6, "{pivot} {expected}");
    Ok(())
}
