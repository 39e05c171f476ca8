//! Gaps, fluids and grids that make no sense, and numbers at the ends of double precision.

use asperity::leak::Seal;
use asperity::surface::Axis;
use asperity::{Boundary, Error, Grid};
use nalgebra::DMatrix;

use super::leak;

#[test]
fn fluids_that_are_none_are_refused() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for refused in [Seal::new(bad, 1.0, Axis::X), Seal::new(1.0, bad, Axis::X)] {
            assert!(matches!(refused, Err(Error::NotPositive { .. })));
        }
    }
}

#[test]
fn gaps_that_are_none_are_refused() {
    let grid = Grid::square(4, 1.0).unwrap();
    let seal = Seal::new(1.0, 1.0, Axis::X).unwrap();
    let open = DMatrix::from_element(4, 4, false);
    let good = DMatrix::from_element(4, 4, 1.0);
    let on = (&grid, Boundary::Free);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut gap = good.clone();
        gap[(2, 3)] = bad;
        let refused = seal.leak(&gap, &open, on);
        assert!(matches!(refused, Err(Error::FieldNotFinite { ix: 2, iy: 3, .. })));
        // In contact too: what gives such a gap is wrong elsewhere as well.
        assert!(seal.leak(&gap, &gap.map(|gap| gap != 1.0), on).is_err());
    }
    let mut gap = good.clone();
    gap[(1, 1)] = -0.5;
    let refused = seal.leak(&gap, &open, on);
    assert!(matches!(refused, Err(Error::OutOfRange { value, .. }) if value == -0.5));
    // Rounding, and any gap of a node in contact, are no overlap.
    let in_contact = gap.map(|gap| gap < 0.0);
    let expected = seal.leak(&gap, &in_contact, on).unwrap().leak_rate;
    gap[(1, 1)] = -1e-6;
    assert_eq!(seal.leak(&gap, &open, on).unwrap().leak_rate, expected);
    for shape in [(4, 3), (3, 4), (0, 0), (1, 1)] {
        let other = DMatrix::from_element(shape.0, shape.1, 1.0);
        let closed = other.map(|_| false);
        assert!(matches!(seal.leak(&other, &open, on), Err(Error::GridMismatch { .. })));
        assert!(matches!(seal.leak(&good, &closed, on), Err(Error::GridMismatch { .. })));
    }
}

/// Numbers whose rate is none are refused with what is out of range; all others are answered.
#[test]
fn rates_beyond_numbers_are_refused() {
    let grid = Grid::square(5, 1.0).unwrap();
    let on = (&grid, Boundary::Periodic);
    let open = DMatrix::from_element(5, 5, false);
    let rate = |viscosity: f64, drop: f64, gap: f64| {
        let seal = Seal::new(viscosity, drop, Axis::Y).unwrap();
        seal.leak(&DMatrix::from_element(5, 5, gap), &open, on).map(|leak| leak.leak_rate)
    };
    for (viscosity, drop, gap) in [
        (1.0, 1.0, 1e-110),
        (1.0, 1.0, 1e104),
        (1e-300, 1e300, 1.0),
        (1e300, 1e-300, 1.0),
        (1e-3, 1.0, 1e300),
    ] {
        let refused = rate(viscosity, drop, gap);
        assert!(
            matches!(refused, Err(Error::OutOfRange { .. } | Error::NotPositive { .. })),
            "{refused:?}"
        );
    }
    for (viscosity, drop, gap) in
        [(1e-200, 1.0, 1e-150), (1e250, 1e200, 1e50), (1e-280, 1e-20, 1.0)]
    {
        let expected = gap * gap / 12.0 / viscosity * gap * drop;
        let found = rate(viscosity, drop, gap).unwrap();
        assert!((found / expected - 1.0).abs() < 1e-10, "{found:e} {expected:e}");
    }
}

/// A throat of 10⁻¹¹ of the greatest gap leaks 10⁻³³ of a square; one of 10⁻¹³ counts as closed. Long cells too.
#[test]
fn gaps_that_are_far_apart() {
    let with_throat = |throat: f64, aspect: f64| {
        let gap = DMatrix::from_fn(7, 5, |ix, iy| match (ix, iy) {
            (3, 2) => throat,
            (3, _) => 0.0,
            _ => 1.0,
        });
        leak(&gap, &Grid::new(7, 5, 1.0, aspect).unwrap(), Boundary::Free, Axis::X)
    };
    for aspect in [1.0, 1e-3, 1e3] {
        let found = with_throat(1e-11, aspect).unwrap();
        // All other cells together are no more than 10⁻²⁰ of its resistance.
        assert!((found.leak_rate / (1e-33 * aspect) - 1.0).abs() < 2e-11, "{found:?}");
    }
    assert!(with_throat(1e-13, 1.0).unwrap().is_closed());
    assert!(matches!(with_throat(1.0, 1e-7), Err(Error::OutOfRange { .. })));
}
