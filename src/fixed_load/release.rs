//! Nodes with tension are set free, their neighbours corrected without a convolution.

use super::level::Prescribed;
use crate::krylov::{SparseInverse, add_scaled, dot, sum};

/// How often nodes that the correction of others has pulled into tension are set free as well.
const PASSES: usize = 3;
/// Steps of conjugate gradients for each correction, and their relative tolerance: it only has to
/// be as good as the preconditioner.
const STEPS: usize = 6;
const ACCURACY: f64 = 0.03;

/// Makes the pressures `x` of the contact set of the preconditioner M non-negative.
///
/// Nodes D with tension become zero; the least change of energy, measured with M⁻¹ for C, is `−M λ`
/// with λ on D such that `(M λ)_D = x_D`. Then the sum is restored along `weights`, M times the unit
/// vector.
pub(super) fn release(
    inverse: &mut SparseInverse,
    x: &mut [f64],
    weights: &[f64],
    prescribed: Prescribed,
) {
    let mut free = vec![false; x.len()];
    for _ in 0..PASSES {
        let mut any = false;
        for (free, x) in free.iter_mut().zip(x.iter()) {
            any |= *x < 0.0;
            *free |= *x < 0.0;
        }
        if !any {
            break;
        }
        let change = correction(inverse, &free, x);
        for ((x, free), change) in x.iter_mut().zip(&free).zip(&change) {
            *x = if *free { 0.0 } else { *x - change };
        }
    }
    for x in x.iter_mut() {
        *x = x.max(0.0);
    }
    let Prescribed::Sum(target) = prescribed else {
        return;
    };
    let (mut capacity, missing) = (0.0, target - sum(x));
    for (weight, x) in weights.iter().zip(x.iter()) {
        if *x > 0.0 {
            capacity += weight.max(0.0);
        }
    }
    if capacity > 0.0 {
        for (x, weight) in x.iter_mut().zip(weights) {
            if *x > 0.0 {
                *x = (*x + missing / capacity * weight.max(0.0)).max(0.0);
            }
        }
    }
    let total = sum(x);
    for x in x.iter_mut() {
        // Nothing left: a load too small for the numbers it came from.
        *x = if total > 0.0 {
            *x / total * target
        } else {
            target / free.len() as f64
        };
    }
}

/// M λ with λ on D such that `(M λ)_D = x_D`, D the nodes set free.
fn correction(inverse: &mut SparseInverse, free: &[bool], x: &[f64]) -> Vec<f64> {
    let mask = |values: &mut [f64]| {
        for (value, free) in values.iter_mut().zip(free) {
            if !free {
                *value = 0.0;
            }
        }
    };
    let mut residual = x.to_vec();
    mask(&mut residual);
    let mut direction = residual.clone();
    let mut result = vec![0.0; x.len()];
    let mut image = Vec::new();
    let mut product = dot(&residual, &residual);
    let enough = ACCURACY * ACCURACY * product;
    for _ in 0..STEPS {
        if product <= enough {
            break;
        }
        inverse.apply(&direction, &mut image);
        let curvature = dot(&direction, &image);
        if curvature.is_nan() || curvature <= 0.0 {
            break;
        }
        let step = product / curvature;
        add_scaled(&mut result, step, &image);
        mask(&mut image);
        add_scaled(&mut residual, -step, &image);
        let next = dot(&residual, &residual);
        for (d, r) in direction.iter_mut().zip(&residual) {
            *d = r + next / product * *d;
        }
        product = next;
    }
    result
}
