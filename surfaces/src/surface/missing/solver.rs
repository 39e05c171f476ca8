//! Conjugate gradients for the missing heights.

use super::multigrid::Multigrid;
use super::stencil::{Field, Stencil};
use crate::Error;
use crate::parallel::for_each_chunk;

/// Error allowed, for heights between −1 and 1: 10⁻¹⁰ of their range.
const ERROR: f64 = 2e-10;

/// What a cycle of multigrid makes of the residual is an estimate of the error, and ends the iteration at this part of
/// the allowed one: errors were up to 1.4 times the estimate (x² − y² on 2048 × 2048 nodes, in ten patterns).
const MARGIN: f64 = 0.1;

/// Steps that no pattern should need: 19 are the most that any was found to.
const MAX_STEPS: usize = 200;

/// The solution of A x = `right_side`, for values between −1 and 1.
///
/// # Errors
///
/// [`Error::NoConvergence`], with the estimated error in units of the range.
pub(super) fn solve(stencil: Stencil, given: Vec<f32>, right_side: &Field) -> Result<Field, Error> {
    let (nx, ny) = stencil.shape();
    let zeros = || Field::zeros(nx, ny);
    let mut multigrid = Multigrid::new(stencil, given);
    let (mut x, mut direction) = (zeros(), zeros());
    let mut residual = right_side.clone();
    let mut partial = vec![0.0; ny];
    let mut last = f64::INFINITY;
    let mut fresh = true;
    let mut steps = 0;
    loop {
        multigrid.cycle(&residual);
        let level = multigrid.finest();
        let error = level.solution.greatest();
        if error <= MARGIN * ERROR {
            if fresh {
                return Ok(x);
            }
            // The residual was carried along: what it has become has to be seen.
            level.stencil.residual(right_side, &x, &mut residual);
            (last, fresh) = (f64::INFINITY, true);
            continue;
        }
        if !error.is_finite() || steps == MAX_STEPS {
            return Err(Error::NoConvergence {
                residual: 0.5 * error,
                tolerance: 0.5 * MARGIN * ERROR,
                iterations: steps,
            });
        }
        let product = dot(&residual, &level.solution, &mut partial);
        // From a fresh residual on a steepest descent: 1/∞ = 0.
        add(&mut direction, product / last, &level.solution, 1.0);
        level.stencil.apply(&direction, &mut level.scratch);
        let length = product / dot(&direction, &level.scratch, &mut partial);
        add(&mut x, 1.0, &direction, length);
        add(&mut residual, 1.0, &level.scratch, -length);
        (last, fresh) = (product, false);
        steps += 1;
    }
}

/// `x` = a x + b y.
fn add(x: &mut Field, a: f64, y: &Field, b: f64) {
    x.fill_rows(
        #[inline(always)]
        |iy, x| {
            for (x, y) in x.iter_mut().zip(y.row(iy)) {
                *x = a * *x + b * y;
            }
        },
    );
}

/// Σ a b, summed row by row whatever the number of threads.
fn dot(a: &Field, b: &Field, partial: &mut [f64]) -> f64 {
    const ROWS: usize = 16;
    for_each_chunk(partial, ROWS, |chunk, sums| {
        for (sum, iy) in sums.iter_mut().zip(1 + chunk * ROWS..) {
            *sum = row_product(a.row(iy), b.row(iy));
        }
    });
    partial.iter().sum()
}

/// Σ a b in several sums at once, which a processor adds in parallel.
fn row_product(a: &[f64], b: &[f64]) -> f64 {
    const SUMS: usize = 8;
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<SUMS>(), b.as_chunks::<SUMS>());
    let mut sums = [0.0; SUMS];
    for (a, b) in a.iter().zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    /// Numbers that are none come to an end at once, and say so. Heights cannot bring them: they are finite, and
    /// between −1 and 1 here.
    #[test]
    fn what_is_no_number_ends_the_iteration() -> Result<(), Error> {
        let holed = dmatrix![0.0, 1.0, 0.5; 1.0, f64::NAN, 0.25; 0.5, f64::NAN, 1.0];
        let (stencil, given, right_side) = Stencil::of_map(&holed);
        assert!(solve(stencil.clone(), given.clone(), &right_side).is_ok());
        for bad in [f64::NAN, f64::INFINITY] {
            let mut wrong = right_side.clone();
            wrong.fill_rows(|_, row| row.fill(bad));
            let found = solve(stencil.clone(), given.clone(), &wrong).map(drop);
            // Errors are of the range, of which heights between −1 and 1 have two.
            assert!(
                matches!(
                    found,
                    Err(Error::NoConvergence { residual, tolerance, iterations: 0 })
                        if !residual.is_finite() && tolerance == 0.5 * MARGIN * ERROR
                ),
                "{found:?}"
            );
        }
        Ok(())
    }
}
