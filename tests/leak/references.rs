//! Ten gap maps against sparse factors of scipy, some of them next to percolation: see `tests/data/README.md`.

use std::path::{Path, PathBuf};

use asperity::io::read_npy;
use asperity::surface::Axis;
use asperity::{Boundary, Grid};
use nalgebra::DMatrix;

use super::{assert_conserved, leak};

const SHAPE: (usize, usize) = (40, 32);

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/leak").join(name)
}

fn maps(name: &str) -> Vec<DMatrix<f64>> {
    let all = read_npy(data(name)).unwrap();
    (0..10).map(|k| all.columns(k * SHAPE.1, SHAPE.1).into_owned()).collect()
}

/// Leak rates to what may be lost, 10⁻¹¹, and pressures to what may change last, 10⁻⁹ of the pressure drop. Leak rates
/// span 17 decades, and conductances of one map up to 16.
#[test]
fn leaks_are_those_of_sparse_factors() {
    let grid = Grid::new(SHAPE.0, SHAPE.1, 2e-5, 3e-5).unwrap();
    let gaps = maps("gaps.npy");
    let pressures = maps("pressures.npy");
    let table = std::fs::read_to_string(data("leaks.csv")).unwrap();
    let mut closed = 0;
    for line in table.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [map, boundary, along, rate, across] = fields[..] else {
            panic!("{line}");
        };
        let map: usize = map.parse().unwrap();
        let (rate, across): (f64, f64) = (rate.parse().unwrap(), across.parse().unwrap());
        let boundary = if boundary == "periodic" { Boundary::Periodic } else { Boundary::Free };
        let axis = if along == "x" { Axis::X } else { Axis::Y };
        let found = leak(&gaps[map], &grid, boundary, axis).unwrap();
        // Of a viscosity of 1; here it is 1/12.
        let (expected, across) = (12.0 * rate, 12.0 * across);
        if rate == 0.0 {
            assert!(found.is_closed());
            closed += 1;
        } else {
            let error = found.leak_rate / expected - 1.0;
            assert!(error.abs() < 1.1e-11, "{line}: {error:e}");
            assert_conserved(&found);
        }
        match found.transverse_permeability {
            None => assert!(boundary == Boundary::Free),
            // A sum of flows in both directions: relative to that along.
            Some(found_across) => {
                assert!((found_across - across).abs() <= 1e-9 * found.permeability, "{line}");
            }
        }
        if axis == Axis::X {
            for (node, (own, expected)) in found.pressure.iter().zip(&pressures[map]).enumerate() {
                assert_eq!(own.is_nan(), expected.is_nan(), "{line}: node {node}");
                let error = (own - expected).abs();
                assert!(own.is_nan() || error < 1e-9, "{line}: node {node} {error:e}");
            }
        }
    }
    assert_eq!(closed, 1);
}
