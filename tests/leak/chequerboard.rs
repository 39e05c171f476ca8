//! Keller and Dykhne's chequerboard: two conductivities in equal squares conduct as their geometric mean.

use std::f64::consts::PI;

use asperity::Grid;
use asperity::surface::Axis;
use nalgebra::DMatrix;

use super::{BOUNDARIES, assert_conserved, leak};

/// One period from the middle of a square to that of the next but one, along both directions: mirror lines, on which
/// the pressure is even, so that it is the board without end. `m` cells to half a square.
fn board(m: usize, conductivities: [f64; 2]) -> (Grid, DMatrix<f64>) {
    let n = 4 * m;
    let square = |k: usize| (k + m) / (2 * m);
    let gap = DMatrix::from_fn(n, n, |ix, iy| conductivities[(square(ix) + square(iy)) % 2].cbrt());
    (Grid::square(n, 1.0).unwrap(), gap)
}

/// At the corners the flux is infinite with the power λ − 1 of the distance, `tan(π λ / 4) = √(k₂ / k₁)`: energies, and
/// with them the conductivity, converge with the order 2λ. Fields are the same with closed sides and with joined ones,
/// since sides are mirrors.
#[test]
fn a_chequerboard_conducts_as_the_geometric_mean() {
    for contrast in [2.0_f64, 10.0] {
        let expected = contrast.sqrt();
        let order = 8.0 / PI * (1.0 / contrast).sqrt().atan();
        for boundary in BOUNDARIES {
            let errors = [4, 8, 16, 32].map(|m| {
                let (grid, gap) = board(m, [1.0, contrast]);
                let found = leak(&gap, &grid, boundary, Axis::X).unwrap();
                assert_conserved(&found);
                found.permeability / expected - 1.0
            });
            for pair in errors.windows(2) {
                let found = (pair[0] / pair[1]).log2();
                assert!((found - order).abs() < 0.12, "{found} {order}: {errors:?}");
            }
            // Extrapolated by that order to cells without size.
            let factor = 2_f64.powf(order);
            let limit = (factor * errors[3] - errors[2]) / (factor - 1.0);
            assert!(limit.abs() < 0.05 * errors[3].abs(), "{limit} {errors:?}");
        }
    }
}
