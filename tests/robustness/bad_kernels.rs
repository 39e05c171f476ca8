//! Kernels that are not positive definite, that promise a growth of contact which they do not keep, or
//! under which contact does not only grow: an error that names the node and the approach where there is
//! no path, and otherwise the right one.

use crate::common::with_window;
use asperity::loading::{ContactEvent, LoadingSolver};
use asperity::surface::HeightMap;
use asperity::{Boundary, ContactGrowth, Error, Grid, InfluenceKernel};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// Coefficients along a strip, by distance.
#[derive(Debug, Clone)]
struct Strip(Vec<f64>);

impl InfluenceKernel for Strip {
    fn grid(&self) -> Grid {
        Grid::new(self.0.len(), 1, 1.0, 1.0).unwrap()
    }
    fn boundary(&self) -> Boundary {
        Boundary::Free
    }

    fn coefficient(&self, di: isize, _dj: isize) -> f64 {
        self.0[di.unsigned_abs()]
    }
}

impl Strip {
    fn matrix(&self, nodes: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(nodes.len(), nodes.len(), |i, j| self.0[nodes[i].abs_diff(nodes[j])])
    }
}

/// A kernel that promises more than it knows.
#[derive(Debug, Clone)]
struct Promising(Strip, ContactGrowth);

impl InfluenceKernel for Promising {
    fn grid(&self) -> Grid {
        self.0.grid()
    }
    fn boundary(&self) -> Boundary {
        self.0.boundary()
    }
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        self.0.coefficient(di, dj)
    }
    fn contact_growth(&self) -> ContactGrowth {
        self.1
    }
}

fn solver(kernel: &dyn InfluenceKernel, gaps: &[f64], window: Option<usize>) -> LoadingSolver {
    let heights = DMatrix::from_fn(gaps.len(), 1, |ix, _| -gaps[ix]);
    let heights = HeightMap::new(heights).unwrap();
    let builder = LoadingSolver::builder(&heights, kernel);
    with_window(builder, window).build().unwrap()
}

#[test]
fn a_kernel_that_is_not_positive_definite_names_node_and_approach() {
    // The determinant of all three nodes is (1 - d)(1 + d - 2 c²) < 0, those of two are positive.
    let (c, d) = (0.8, 0.2);
    let kernel = Strip(vec![1.0, c, d]);
    // Node 1 touches at 0.1 / (1 - c) = 0.5; then node 2, at gap + u = approach with
    // u = d p0 + c p1, p the solution of the two nodes.
    let gaps = [0.0, 0.1, 1.0];
    let pair = kernel.matrix(&[0, 1]).lu();
    let y1 = -pair.solve(&DVector::from_row_slice(&gaps[..2])).unwrap();
    let y2 = pair.solve(&DVector::from_element(2, 1.0)).unwrap();
    let row = DVector::from_row_slice(&[d, c]);
    let expected = (gaps[2] + row.dot(&y1)) / (1.0 - row.dot(&y2));
    let determinant = (1.0 - d) * (1.0 + d - 2.0 * c * c) / (1.0 - c * c);
    for window in [Some(1), Some(2), None] {
        let mut path = solver(&kernel, &gaps, window);
        let first = path.next().unwrap().unwrap();
        let second = path.next().unwrap().unwrap();
        assert_eq!((first.node, second.node), ((0, 0), (1, 0)));
        // Three nodes, a handful of rounding errors.
        assert!((second.contact.approach - 0.5).abs() < 1e-14);
        let error = path.next().unwrap().unwrap_err();
        let Error::NotPositiveDefinite { ix, iy, approach, pivot } = error else {
            panic!("{error}");
        };
        assert_eq!((ix, iy), (2, 0));
        assert!((approach - expected).abs() < 1e-13 * expected, "{approach} {expected}");
        assert!((pivot - determinant).abs() < 1e-13, "{pivot} {determinant}");
        assert!(path.next().is_none() && path.next().is_none());
        // What came before stays.
        assert_eq!(path.state(), Some(second));
        assert_eq!(path.contact_order(), [0, 1]);
        let certificate = path.certificate().unwrap();
        assert!(certificate.least_pressure >= -1e-12, "{certificate:?}");
    }
}

#[test]
fn an_overlap_under_a_broken_promise_names_node_and_approach() {
    // Positive definite, but a cell raises the surface at a distance of two.
    let kernel = Strip(vec![1.0, 0.0, -0.4, 0.0, 0.0]);
    assert!(kernel.matrix(&[0, 1, 2, 3, 4]).symmetric_eigenvalues().min() > 0.0);
    // Node 2 raises node 4 to the indenter before node 3, whose neighbours do nothing to it,
    // touches at 0.95. In a window of three nodes nobody watches node 4, whose bound was 1.
    let gaps = [0.0, 5.0, 0.1, 0.95, 1.0];
    let convex = Promising(kernel.clone(), ContactGrowth::Convex);
    let mut path = solver(&convex, &gaps, Some(3));
    let error = path.find_map(Result::err).unwrap();
    let Error::NotMonotone { ix, iy, approach, value, .. } = error else {
        panic!("{error}");
    };
    assert_eq!((ix, iy), (4, 0));
    assert!((approach - 0.95).abs() < 1e-14);
    // p2 = (0.85 + 0.4 * 0.95) / 0.84, gap = 1 - 0.4 p2 - 0.95.
    let gap = 1.0 - 0.4 * (0.85 + 0.4 * 0.95) / 0.84 - 0.95;
    assert!((value - gap).abs() < 1e-13, "{value} {gap}");
    assert!(path.next().is_none());
    // What is promised truly, or not at all, or with all nodes watched, gives the right path: no node
    // leaves, and node 3 is taken back where it came too early.
    for (growth, window) in [
        (ContactGrowth::Unknown, None),
        (ContactGrowth::Unknown, Some(3)),
        (ContactGrowth::Monotone, Some(1)),
        (ContactGrowth::Monotone, Some(3)),
        (ContactGrowth::Monotone, None),
        (ContactGrowth::Convex, Some(5)),
        (ContactGrowth::Convex, None),
    ] {
        let mut path = solver(&Promising(kernel.clone(), growth), &gaps, window);
        assert_eq!(path.by_ref().map(Result::unwrap).count(), 5);
        assert_eq!(path.contact_order(), [0, 2, 4, 3, 1]);
        let missed = growth != ContactGrowth::Convex && window == Some(3);
        assert_eq!(path.timings().taken_back, usize::from(missed));
    }
}

#[test]
fn nodes_that_leave_under_a_broken_promise_are_named() {
    // Positive definite, and the middle of three nodes is pulled down by its neighbours more than
    // it resists: y2 there has the sign of 1 + d - 2 c < 0.
    let (c, d) = (0.7, 0.2);
    let kernel = Strip(vec![1.0, c, d, 0.0]);
    assert!(kernel.matrix(&[0, 1, 2]).symmetric_eigenvalues().min() > 0.0);
    // The fourth node is far away: the three are all in contact long before.
    let gaps = [0.0, 0.01, 0.2, 100.0];
    // Of a convex kernel nothing is checked after the last window is opened.
    for (growth, window) in [
        (ContactGrowth::Monotone, None),
        (ContactGrowth::Monotone, Some(1)),
        (ContactGrowth::Monotone, Some(2)),
        (ContactGrowth::Convex, Some(1)),
    ] {
        let mut path = solver(&Promising(kernel.clone(), growth), &gaps, window);
        let mut states = 0;
        let error = loop {
            match path.next() {
                Some(Ok(_)) => states += 1,
                Some(Err(error)) => break error,
                None => panic!("no error after {states} states, window {window:?}"),
            }
        };
        let Error::NotMonotone { ix, iy, approach, value, .. } = error else {
            panic!("{error}");
        };
        assert_eq!(states, 3, "{growth:?}, window {window:?}");
        assert_eq!((ix, iy), (1, 0), "{growth:?}, window {window:?}");
        assert!(approach > 0.0 && value < 0.0);
        assert!(path.next().is_none());
    }

    // Without a promise it leaves, when the pressure that the three nodes give it is zero, and touches
    // again once the fourth has, which takes load from the third.
    let inverse = kernel.matrix(&[0, 1, 2]).try_inverse().unwrap();
    let y1 = -inverse.row(1).dot(&DVector::from_row_slice(&gaps[..3]).transpose());
    let expected = -y1 / inverse.row(1).sum();
    let mut path = solver(&kernel, &gaps, None);
    let states: Vec<_> = path.by_ref().map(Result::unwrap).collect();
    let events: Vec<_> = states.iter().map(|state| (state.event, state.node.0)).collect();
    let touch = |node| (ContactEvent::Touch, node);
    let leave = |node| (ContactEvent::Release, node);
    assert_eq!(events, [touch(0), touch(1), touch(2), leave(1), touch(3), touch(1)]);
    let counts: Vec<_> = states.iter().map(|state| state.contact.contact_nodes).collect();
    assert_eq!(counts, [1, 2, 3, 2, 3, 4]);
    let error = (states[3].contact.approach - expected).abs();
    assert!(error < 1e-13, "{} {expected}", states[3].contact.approach);
    assert_eq!(path.contact_order(), [0, 2, 3, 1]);
}

/// What goes wrong behind events that are taken back is no part of the path: a window of four nodes finds a
/// pivot that is not positive only in an order of contact that its end contradicts. The path goes on, to where
/// single events come to.
#[test]
fn a_failure_goes_with_the_events_before_it() {
    for (coefficients, gaps, window) in [
        ([1.0, 0.4, -0.35, 0.4, -0.2, -0.3], [0.4, 2.0, 2.0, 0.0, 0.1, 1.8], 4),
        ([1.0, -0.4, -0.55, 0.45, 0.2, -0.15], [0.7, 0.8, 1.9, 0.2, 1.3, 0.9], 3),
    ] {
        let kernel = Promising(Strip(coefficients.to_vec()), ContactGrowth::Monotone);
        let outcome = |window: usize| {
            let mut path = solver(&kernel, &gaps, Some(window));
            let (mut nodes, mut failure) = (Vec::new(), None);
            for state in path.by_ref() {
                match state {
                    Ok(state) => nodes.push(state.node.0),
                    Err(error) => failure = Some(error),
                }
            }
            (nodes, failure, path.timings().taken_back)
        };
        let (expected, single, _) = outcome(1);
        let (found, failure, taken_back) = outcome(window);
        assert_eq!(found, expected);
        assert!(taken_back > 0);
        let (
            Some(Error::NotPositiveDefinite { ix, approach: at, .. }),
            Some(Error::NotPositiveDefinite { ix: other, approach, .. }),
        ) = (single, failure)
        else {
            panic!("{gaps:?}");
        };
        assert!(ix == other && (at - approach).abs() < 1e-12 * at, "{ix} {other}");
    }
}

/// Whether pressures and gaps of a state have the right sign, straight from the influence matrix.
fn exact(kernel: &Strip, gaps: &[f64], contact: &[usize], approach: f64) -> bool {
    let rhs = contact.iter().map(|&i| approach - gaps[i]);
    let rhs = DVector::from_iterator(contact.len(), rhs);
    let pressure = kernel.matrix(contact).lu().solve(&rhs).unwrap();
    let displacement = |i: usize| -> f64 {
        let terms = contact.iter().zip(&pressure);
        terms.map(|(&j, p)| kernel.0[i.abs_diff(j)] * p).sum()
    };
    // Far above rounding: the condition number is below 1e3.
    let slack = 1e-9 * (approach + gaps.iter().copied().fold(0.0, f64::max));
    let mut outside = (0..gaps.len()).filter(|i| !contact.contains(i));
    let overlap = outside.any(|i| gaps[i] + displacement(i) - approach < -slack);
    !overlap && pressure.iter().all(|p| *p >= -slack / kernel.0[0])
}

/// A positive definite kernel with any coefficients, scaled down if they are too large for one.
fn kernel() -> impl Strategy<Value = Strip> {
    prop::collection::vec(-0.6..0.9, 7).prop_map(|coefficients| {
        let mut kernel = Strip(vec![0.0]);
        kernel.0.extend(coefficients);
        let all: Vec<_> = (0..kernel.0.len()).collect();
        let least = kernel.matrix(&all).symmetric_eigenvalues().min();
        let scale = (0.95 / -least).min(1.0);
        kernel.0.iter_mut().for_each(|value| *value *= scale);
        kernel.0[0] = 1.0;
        kernel
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// A path of a kernel that promises nothing never fails, and is exact at every event; nor is any
    /// state wrong before the first release under a promise, if windows are of one node.
    #[test]
    fn no_path_is_wrong(
        kernel in kernel(),
        gaps in prop::collection::vec(0.0..1.0, 8),
        promise in prop_oneof![Just(ContactGrowth::Monotone), Just(ContactGrowth::Convex)],
    ) {
        let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        let heights: Vec<f64> = gaps.iter().map(|gap| gap - least).collect();
        let mut path = solver(&kernel, &gaps, None);
        let mut states = Vec::new();
        while let Some(state) = path.next() {
            let state = state.unwrap();
            prop_assert!(exact(&kernel, &heights, &path.contact_order(), state.contact.approach), "{:?}", state);
            states.push(state);
        }
        let mut promised = solver(&Promising(kernel.clone(), promise), &gaps, Some(1));
        for (done, expected) in states.iter().enumerate() {
            match promised.next() {
                Some(Ok(state)) => prop_assert_eq!(
                    (state.step, state.node, state.event),
                    (expected.step, expected.node, expected.event)
                ),
                Some(Err(Error::NotMonotone { ix, iy, approach, .. })) => {
                    prop_assert!(ix < 8 && iy == 0 && approach >= 0.0);
                    break;
                }
                // No further node can touch, but one may leave.
                None => {
                    prop_assert_eq!(done, 8);
                    break;
                }
                Some(Err(error)) => prop_assert!(false, "{}", error),
            }
        }
        prop_assert!(promised.next().is_none_or(|more| more.is_err()));
    }
}
