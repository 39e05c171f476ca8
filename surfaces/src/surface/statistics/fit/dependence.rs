//! How far waves next to each other depend on each other.

use std::ops::RangeInclusive;

use nalgebra::DMatrix;

use crate::surface::fourier::Waves;

/// Waves so far apart along either axis, or nearer, may be smeared over each other: Hann's window reaches two waves
/// far.
const NEAR: i64 = 2;

/// Waves so far apart are not, and what they have in common is their place in the spectrum: a law that does not hold, a
/// spectrum that is not the same in all directions.
const FAR: RangeInclusive<i64> = 4..=7;

/// The variance of a mean of relative residuals over many waves, times their number: their mean square, and their
/// covariances with all neighbours, as far as these are greater than those of distant waves.
///
/// `expected` is the power of a wave by the law, and counts between two wavevectors.
pub(super) fn variance(waves: &Waves, band: (f64, f64), expected: impl Fn(f64) -> f64) -> f64 {
    let (nx, ny) = waves.grid().shape();
    let middle = ((nx / 2) as i64, (ny / 2) as i64);
    let mut residuals = DMatrix::zeros(2 * (nx / 2) + 1, 2 * (ny / 2) + 1);
    // 1 where there is a wave.
    let mut present = residuals.clone();
    for wave in waves.iter() {
        let q = libm::hypot(wave.q.0, wave.q.1);
        if !(band.0..=band.1).contains(&q) {
            continue;
        }
        // The wave and its conjugate.
        for sign in [1, -1] {
            let (kx, ky) = (middle.0 + sign * wave.k.0, middle.1 + sign * wave.k.1);
            let place = (kx as usize, ky as usize);
            residuals[place] = wave.power / expected(q) - 1.0;
            present[place] = 1.0;
        }
    }
    let covariance = |a: i64, b: i64| {
        let pairs = products(&present, a, b);
        (pairs > 0.0).then(|| products(&residuals, a, b) / pairs)
    };
    // One of each lag and its opposite.
    let lags = |reach: i64| {
        let lags = (0..=reach).flat_map(move |a| (-reach..=reach).map(move |b| (a, b)));
        lags.filter(|(a, b)| *a > 0 || *b > 0)
    };
    let distant = lags(*FAR.end()).filter(|(a, b)| FAR.contains(&(*a).max(b.abs())));
    let distant: Vec<f64> = distant.filter_map(|(a, b)| covariance(a, b)).collect();
    let common = distant.iter().sum::<f64>() / distant.len().max(1) as f64;
    let neighbours = lags(NEAR).filter_map(|(a, b)| Some(covariance(a, b)? - common));
    covariance(0, 0).unwrap_or_default() + 2.0 * neighbours.sum::<f64>()
}

/// The sum of the products of all elements with those `a` ≥ 0 rows and `b` columns further.
fn products(values: &DMatrix<f64>, a: i64, b: i64) -> f64 {
    let (rows, columns) = values.shape();
    let shift = a.unsigned_abs() as usize;
    let across = b.unsigned_abs() as usize;
    let mut sum = 0.0;
    for column in 0..columns.saturating_sub(across) {
        let (first, second) =
            if b < 0 { (column + across, column) } else { (column, column + across) };
        let line = |column: usize| &values.as_slice()[column * rows..(column + 1) * rows];
        let later = line(second).iter().skip(shift);
        sum += line(first).iter().zip(later).map(|(x, y)| x * y).sum::<f64>();
    }
    sum
}
