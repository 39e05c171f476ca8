use nalgebra::{DVector, dmatrix};
use proptest::prelude::*;

use super::*;

/// The missing heights by a dense solve of the documented equations.
fn dense(heights: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let (nx, ny) = heights.shape();
    let missing: Vec<_> = (0..nx * ny).filter(|&node| !heights[node].is_finite()).collect();
    let mut matrix = DMatrix::zeros(missing.len(), missing.len());
    let mut right_side = DVector::zeros(missing.len());
    for (row, &node) in missing.iter().enumerate() {
        let (ix, iy) = (node % nx, node / nx);
        let neighbours = [
            (ix > 0).then(|| node - 1),
            (ix + 1 < nx).then_some(node + 1),
            (iy > 0).then(|| node - nx),
            (iy + 1 < ny).then_some(node + nx),
        ];
        for neighbour in neighbours.into_iter().flatten() {
            matrix[(row, row)] += 1.0;
            match missing.binary_search(&neighbour) {
                Ok(column) => matrix[(row, column)] -= 1.0,
                Err(_) => right_side[row] += heights[neighbour],
            }
        }
    }
    let solution = matrix.cholesky()?.solve(&right_side);
    let mut filled = heights.clone();
    for (&node, &value) in missing.iter().zip(solution.iter()) {
        filled[node] = value;
    }
    Some(filled)
}

/// Marks the nodes of which `missing(ix, iy)` holds.
fn without(mut heights: DMatrix<f64>, missing: impl Fn(usize, usize) -> bool) -> DMatrix<f64> {
    let nx = heights.nrows();
    for (node, height) in heights.iter_mut().enumerate() {
        if missing(node % nx, node / nx) {
            *height = f64::NAN;
        }
    }
    heights
}

/// Numbers between −1 and 1 that look random.
fn noise(node: usize) -> f64 {
    2.0 * crate::surface::fourier::tests::noise(node) - 1.0
}

#[test]
fn a_whole_map_stays_as_it_is() -> Result<(), Error> {
    let map = dmatrix![-0.0, 1.0; 2.0, 3.0];
    let filled = fill_missing(map.clone())?;
    assert!(filled.iter().zip(map.iter()).all(|(a, b)| a.to_bits() == b.to_bits()));
    Ok(())
}

#[test]
fn nothing_to_fill_from_is_refused() {
    for (nx, ny) in [(1, 1), (3, 2)] {
        let refused = fill_missing(DMatrix::from_element(nx, ny, f64::NAN));
        assert!(
            matches!(refused, Err(Error::NothingMeasured { nx: x, ny: y }) if (x, y) == (nx, ny)),
            "{refused:?}"
        );
    }
    for (nx, ny) in [(0, 0), (0, 3), (3, 0)] {
        let refused = fill_missing(DMatrix::zeros(nx, ny));
        assert!(matches!(refused, Err(Error::EmptyGrid { .. })));
    }
}

#[test]
fn missing_are_nan_and_infinite() -> Result<(), Error> {
    let map = dmatrix![1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1.0];
    assert_eq!(count_missing(&map), 3);
    // One value alone has no range: all become it exactly.
    assert_eq!(fill_missing(map)?, DMatrix::from_element(1, 5, 1.0));
    Ok(())
}

#[test]
fn a_row_is_filled_linearly_and_constantly_beyond_its_ends() -> Result<(), Error> {
    let nan = f64::NAN;
    let filled = fill_missing(dmatrix![nan, nan, 1.0, nan, nan, nan, 3.0, nan])?;
    let expected = dmatrix![1.0, 1.0, 1.0, 1.5, 2.0, 2.5, 3.0, 3.0];
    // 10⁻¹⁰ of the range 2, as promised.
    assert!((&filled - &expected).amax() < 2e-10);
    Ok(())
}

/// x² − y² and a plane are harmonic for the five-point Laplacian as well, so that they are the only answer.
#[test]
fn a_harmonic_polynomial_returns() -> Result<(), Error> {
    let (nx, ny) = (67, 90);
    let polynomial = DMatrix::from_fn(nx, ny, |ix, iy| {
        let (x, y) = (ix as f64 / 30.0 - 1.0, iy as f64 / 30.0 - 1.5);
        1e-6 * (x * x - y * y + 0.3 * x - 0.7 * y + 5.0)
    });
    let range = polynomial.max() - polynomial.min();
    let holes: [&dyn Fn(usize, usize) -> bool; 4] = [
        &|ix, iy| ix > 0 && iy > 0 && ix < nx - 1 && iy < ny - 1,
        &|ix, iy| ix.abs_diff(30).pow(2) + iy.abs_diff(40).pow(2) < 600,
        &|ix, iy| ix > 0 && ix < nx - 1 && iy > 0 && iy < ny - 1 && iy % 16 != 0,
        &|ix, iy| (20..22).contains(&ix) && (5..80).contains(&iy),
    ];
    for (number, hole) in holes.into_iter().enumerate() {
        let filled = fill_missing(without(polynomial.clone(), hole))?;
        let error = (&filled - &polynomial).amax();
        // As promised.
        assert!(error < 1e-10 * range, "{number}: {error:e}");
    }
    Ok(())
}

/// Every pattern that measurements have, in any unit, against the dense solution.
#[test]
fn patterns_agree_with_a_dense_solution() -> Result<(), Error> {
    let (nx, ny) = (29, 34);
    let heights = DMatrix::from_fn(nx, ny, |ix, iy| noise(ix + nx * iy));
    let patterns: [&dyn Fn(usize, usize) -> bool; 7] = [
        &|ix, iy| noise(7 * (ix + 31 * iy)) > 0.0,
        &|ix, iy| noise(7 * (ix + 31 * iy)) > -0.98,
        &|ix, _| ix < nx / 2,
        &|_, iy| iy % 3 != 1,
        &|ix, iy| (ix, iy) != (0, 0),
        &|ix, iy| (ix, iy) != (nx / 2, ny - 1),
        &|ix, iy| ix.abs_diff(14).pow(2) + iy.abs_diff(17).pow(2) < 150,
    ];
    for (number, pattern) in patterns.into_iter().enumerate() {
        for (unit, offset) in [(1.0, 0.0), (1e-9, 1e-3), (1e300, 0.0), (1e-300, 0.0)] {
            let map = without(heights.map(|z| offset + unit * z), pattern);
            let expected = dense(&map);
            let filled = fill_missing(map)?;
            let error = expected.map(|expected| (&filled - &expected).amax());
            // The error promised, of a range of 2 units, and the last digits of the offset times the number of nodes,
            // which is what the dense solution may lose.
            let allowed = 2e-10 * unit + 1e3 * f64::EPSILON * offset;
            assert!(error.is_some_and(|e| e < allowed), "{number} {unit} {error:?}");
        }
    }
    Ok(())
}

/// Heights whose range overflows are filled all the same.
#[test]
fn the_greatest_numbers_are_filled() -> Result<(), Error> {
    let filled = fill_missing(dmatrix![f64::MAX, f64::NAN, f64::NAN, f64::NAN, -f64::MAX])?;
    // The promised error, of a range of 2.
    for (ix, expected) in [0.5, 0.0, -0.5].into_iter().enumerate() {
        assert!((filled[ix + 1] / f64::MAX - expected).abs() < 2e-10);
    }
    Ok(())
}

proptest! {
    #[test]
    fn random_masks_agree_with_a_dense_solution(
        nx in 1_usize..14, ny in 1_usize..14, bits in prop::collection::vec(any::<(f64, u8)>(), 196),
        share in any::<u8>(),
    ) {
        let fill = |node: usize| {
            let (seed, random) = bits[node];
            // Of any pattern of bits, the fraction; not finite ones are missing as well.
            if random < share { seed.fract() } else { f64::NAN }
        };
        let map = DMatrix::from_fn(nx, ny, |ix, iy| fill(ix + nx * iy));
        let measured: Vec<f64> = map.iter().copied().filter(|z| z.is_finite()).collect();
        let filled = fill_missing(map.clone());
        if measured.is_empty() {
            let refused = matches!(filled, Err(Error::NothingMeasured { .. }));
            prop_assert!(refused);
            return Ok(());
        }
        let filled = filled.map_err(|error| TestCaseError::fail(error.to_string()))?;
        let expected = dense(&map).ok_or_else(|| TestCaseError::fail("no dense solution"))?;
        let highest = measured.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let lowest = measured.iter().copied().fold(f64::INFINITY, f64::min);
        // The error promised, and a few rounding errors of heights below 1.
        let allowed = 1e-10 * (highest - lowest) + 1e-14;
        for (node, z) in filled.iter().enumerate() {
            if map[node].is_finite() {
                prop_assert_eq!(z.to_bits(), map[node].to_bits());
            } else {
                prop_assert!((z - expected[node]).abs() <= allowed, "{} {}", z, expected[node]);
                // The maximum principle.
                prop_assert!(*z <= highest + allowed && *z >= lowest - allowed);
            }
        }
    }
}

/// The number of steps hardly grows with the map: what would take thousands without multigrid is solved, and a plane
/// comes back. 300 × 280 nodes of which most are missing, in the patterns that are worst for coarse levels.
#[test]
fn large_holes_are_filled() -> Result<(), Error> {
    let (nx, ny) = (300, 280);
    let plane = DMatrix::from_fn(nx, ny, |ix, iy| 0.4 * ix as f64 - 1.1 * iy as f64);
    let range = plane.max() - plane.min();
    let border = |ix, iy| ix == 0 || iy == 0 || ix == nx - 1 || iy == ny - 1;
    let kept: [&dyn Fn(usize, usize) -> bool; 3] =
        [&|_, _| false, &|ix, iy| noise(7 * (ix + 311 * iy)) > 0.98, &|ix, iy| {
            ix % 16 == 3 && iy % 64 != 5
        }];
    for (number, kept) in kept.into_iter().enumerate() {
        let holed = without(plane.clone(), |ix, iy| !border(ix, iy) && !kept(ix, iy));
        let error = (fill_missing(holed)? - &plane).amax();
        // As promised.
        assert!(error < 1e-10 * range, "{number}: {error:e}");
    }
    Ok(())
}

/// Heights up to the greatest number there is: what is filled lies between them, and rounding adds nothing.
#[test]
fn the_greatest_heights_stay_finite() -> Result<(), Error> {
    for n in 3..12 {
        let heights = without(DMatrix::from_element(n, n, f64::MAX), |ix, iy| ix * iy == 1);
        let mut heights = without(heights, |ix, iy| ix + iy > n);
        heights[(0, 0)] = f64::MIN;
        let filled = fill_missing(heights)?;
        assert!(filled.iter().all(|height| height.is_finite()), "{n}");
    }
    Ok(())
}
