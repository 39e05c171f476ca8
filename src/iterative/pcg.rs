//! Preconditioned conjugate gradients for one linear system on a contact set.

use super::{ContactSet, Operator, SparseInverse, add_scaled, dot, greatest};
use crate::Error;

/// How an iteration ended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LinearOutcome {
    /// Greatest component of the residual.
    pub(crate) residual: f64,
    pub(crate) iterations: usize,
    pub(crate) converged: bool,
}

/// Solves $C_{II} x = b$ from the start `x` until no component of the residual, which is left in
/// `b`, exceeds `tolerance`, in the unit of b.
///
/// # Errors
///
/// [`Error::FactorizationFailed`] if the matrix turns out not to be positive definite.
pub(crate) fn solve_linear(
    operator: &mut Operator,
    inverse: &mut SparseInverse,
    contact: &ContactSet,
    b: &mut [f64],
    x: &mut [f64],
    tolerance: f64,
    max_iterations: usize,
) -> Result<LinearOutcome, Error> {
    let residual = b;
    if x.iter().any(|value| *value != 0.0) {
        let image = operator.apply(contact, x)?;
        for (value, &node) in residual.iter_mut().zip(contact.nodes()) {
            *value -= image[node as usize];
        }
    }
    let worst = |residual: &[f64]| greatest(residual.len(), 0.0, |i| residual[i].abs());
    let mut outcome = LinearOutcome {
        residual: worst(residual),
        iterations: 0,
        converged: false,
    };
    let (mut z, mut direction, mut image) = (Vec::new(), vec![0.0; x.len()], Vec::new());
    let mut previous = 0.0;
    while outcome.residual > tolerance && outcome.iterations < max_iterations {
        inverse.apply(residual, &mut z);
        let product = dot(residual, &z);
        let factor = if previous > 0.0 {
            product / previous
        } else {
            0.0
        };
        previous = product;
        for (d, z) in direction.iter_mut().zip(&z) {
            *d = z + factor * *d;
        }
        contact.gather(operator.apply(contact, &direction)?, &mut image);
        let curvature = dot(&direction, &image);
        if curvature.is_nan() || curvature <= 0.0 {
            return Err(Error::FactorizationFailed {
                nodes: contact.len(),
            });
        }
        let step = product / curvature;
        add_scaled(x, step, &direction);
        add_scaled(residual, -step, &image);
        outcome.iterations += 1;
        outcome.residual = worst(residual);
    }
    outcome.converged = outcome.residual <= tolerance;
    Ok(outcome)
}
