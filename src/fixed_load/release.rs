//! Nodes with tension are set free, their neighbours corrected without a convolution.

use super::level::Prescribed;
use super::tuning::{ACCURACY, STEPS};
use crate::krylov::{SparseInverse, add_scaled, dot, sum};

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
    let free: Vec<bool> = x.iter().map(|x| *x < 0.0).collect();
    if free.contains(&true) {
        let change = correction(inverse, &free, x);
        for ((x, free), change) in x.iter_mut().zip(&free).zip(&change) {
            *x = if *free { 0.0 } else { *x - change };
        }
    }
    // The correction pulls few nodes more into tension.
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
        *x = if total > 0.0 { *x / total * target } else { target / free.len() as f64 };
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

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::kernel::KernelTable;
    use crate::krylov::NodeSet;
    use crate::{Boussinesq, Error, Grid};

    const NODES: usize = 64;
    /// Nodes with tension: two neighbours and one by itself.
    const TENSION: [usize; 3] = [9, 10, 45];

    /// The sparse inverse M of a contact of all nodes, as an operator and as a matrix.
    fn inverse() -> Result<(SparseInverse, DMatrix<f64>), Error> {
        let grid = Grid::square(8, 1.0)?;
        let table = KernelTable::new(&Boussinesq::new(grid, 1.0)?)?;
        let mut contact = NodeSet::new(NODES);
        contact.assign(|_| true);
        let mut inverse = SparseInverse::new(&table);
        inverse.update(&contact);
        let mut dense = DMatrix::zeros(NODES, NODES);
        let (mut unit, mut column) = (vec![0.0; NODES], Vec::new());
        for j in 0..NODES {
            unit[j] = 1.0;
            inverse.apply(&unit, &mut column);
            dense.column_mut(j).copy_from_slice(&column);
            unit[j] = 0.0;
        }
        Ok((inverse, dense))
    }

    /// Pressures, three of them negative, with what comes of them by a dense solution, and how far that may
    /// be missed: the residual that is left on D reaches other nodes through `M_OD M_DD⁻¹`.
    fn problem(dense: &DMatrix<f64>) -> Result<(Vec<f64>, DVector<f64>, f64), Error> {
        let mut x: Vec<f64> = (0..NODES).map(|i| 2.0 + (i as f64).sin()).collect();
        for (place, node) in TENSION.into_iter().enumerate() {
            x[node] = -0.1 - 0.05 * place as f64;
        }
        let own = dense.select_columns(&TENSION);
        let block = own.select_rows(&TENSION);
        let tension = DVector::from_iterator(3, TENSION.iter().map(|&node| x[node]));
        let inverse = (block.try_inverse()).ok_or(Error::FactorizationFailed { nodes: 3 })?;
        let expected = DVector::from_column_slice(&x) - &own * (&inverse * &tension);
        let reach = (own * inverse).norm();
        Ok((x, expected, (ACCURACY * reach + 1e-5) * tension.norm()))
    }

    /// Nodes with tension end without pressure, and the others change by `−M λ`, in whatever unit.
    #[test]
    fn tension_is_set_free() -> Result<(), Error> {
        let (mut inverse, dense) = inverse()?;
        let (start, expected, tolerance) = problem(&dense)?;
        for unit in [1.0, 1e-6, 1e6] {
            let mut x: Vec<f64> = start.iter().map(|x| unit * x).collect();
            release(&mut inverse, &mut x, &[], Prescribed::Approach(1.0));
            for (node, (x, expected)) in x.iter().zip(&expected).enumerate() {
                let x = x / unit;
                if TENSION.contains(&node) {
                    assert_eq!(x, 0.0, "node {node}");
                } else {
                    assert!((x - expected).abs() <= tolerance, "{node}: {x} {expected}");
                }
            }
        }
        Ok(())
    }

    /// A sum that is missing comes back along the weights, and to nodes that carry only.
    #[test]
    fn the_sum_is_restored() -> Result<(), Error> {
        let (mut inverse, dense) = inverse()?;
        let (start, expected, tolerance) = problem(&dense)?;
        let weights: Vec<f64> = (0..NODES).map(|i| 1.0 + 0.5 * (3.0 * i as f64).cos()).collect();
        let mut x = start.clone();
        let target = 3.0 * sum(&start);
        release(&mut inverse, &mut x, &weights, Prescribed::Sum(target));
        // Rounding of a sum of 64 terms.
        assert!((sum(&x) / target - 1.0).abs() < 1e-14, "{}", sum(&x));
        let carrying: Vec<usize> = (0..NODES).filter(|node| !TENSION.contains(node)).collect();
        let before: f64 = carrying.iter().map(|&node| expected[node]).sum();
        let capacity: f64 = carrying.iter().map(|&node| weights[node]).sum();
        let factor = (target - before) / capacity;
        // The error of every node changes what is missing.
        let allowed = tolerance * (1.0 + NODES as f64 * 1.5 / capacity);
        for (node, x) in x.iter().enumerate() {
            if TENSION.contains(&node) {
                assert_eq!(*x, 0.0, "node {node}");
            } else {
                let expected = expected[node] + factor * weights[node];
                assert!((x - expected).abs() <= allowed, "{node}: {x} {expected}");
            }
        }
        // Without weights pressures stay in proportion.
        let before: Vec<f64> = (1..=NODES).map(|i| i as f64).collect();
        let mut x = before.clone();
        release(&mut inverse, &mut x, &[0.0; NODES], Prescribed::Sum(2.0 * sum(&before)));
        for (x, before) in x.iter().zip(&before) {
            assert!((x / before - 2.0).abs() < 1e-14, "{before}: {x}");
        }
        Ok(())
    }

    /// Where all have tension nothing is left, and a load that is prescribed is spread evenly.
    #[test]
    fn nothing_is_left() -> Result<(), Error> {
        let (mut inverse, _) = inverse()?;
        for (prescribed, expected) in
            [(Prescribed::Approach(1.0), 0.0), (Prescribed::Sum(128.0), 2.0)]
        {
            let mut x = vec![-1.0; NODES];
            release(&mut inverse, &mut x, &[1.0; NODES], prescribed);
            assert_eq!(x, [expected; NODES]);
        }
        Ok(())
    }
}
