//! The number types a factor can be stored in.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, DivAssign, Mul, SubAssign};

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};

use crate::parallel::vectorized;

/// Products of single precision that are summed one after the other: few enough to lose little more
/// than storing the factors does, enough for GEMM at full speed.
const DEPTH: usize = 256;
/// Such sums that are added in single precision before the total goes to double precision.
const SUMS: usize = 4;

/// A number type of the factor: `f64`, or `f32` for half the memory and twice the speed.
pub(super) trait Precision:
    faer::traits::RealField
    + Copy
    + Default
    + Debug
    + Send
    + Sync
    + Add<Output = Self>
    + AddAssign
    + Mul<Output = Self>
    + SubAssign
    + DivAssign
    + Into<f64>
    + 'static
{
    /// The nearest number of this type.
    fn of(value: f64) -> Self;

    /// target −= scale A B.
    fn subtract_product(
        target: MatMut<'_, f64>,
        scale: f64,
        a: MatRef<'_, Self>,
        b: MatRef<'_, Self>,
    );
}

impl Precision for f64 {
    fn of(value: f64) -> Self {
        value
    }

    fn subtract_product(
        target: MatMut<'_, f64>,
        scale: f64,
        a: MatRef<'_, Self>,
        b: MatRef<'_, Self>,
    ) {
        matmul(target, Accum::Add, a, b, -scale, Par::Seq);
    }
}

impl Precision for f32 {
    #[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
    fn of(value: f64) -> Self {
        value as Self
    }

    fn subtract_product(
        target: MatMut<'_, f64>,
        scale: f64,
        a: MatRef<'_, Self>,
        b: MatRef<'_, Self>,
    ) {
        // Column by column in any case: the transposed product where the target is stored by rows, so
        // that neither factor is repacked.
        let (mut target, a, b) = if target.col_stride() == 1 {
            (target.transpose_mut(), b.transpose(), a.transpose())
        } else {
            (target, a, b)
        };
        let mut product = Mat::<Self>::zeros(target.nrows(), target.ncols());
        for start in (0..a.ncols()).step_by(SUMS * DEPTH) {
            let end = a.ncols().min(start + SUMS * DEPTH);
            let mut accum = Accum::Replace;
            for first in (start..end).step_by(DEPTH) {
                let depth = DEPTH.min(end - first);
                let (a, b) = (a.subcols(first, depth), b.subrows(first, depth));
                matmul(product.as_mut(), accum, a, b, 1.0, Par::Seq);
                accum = Accum::Add;
            }
            for (target, sum) in target.as_mut().col_iter_mut().zip(product.col_iter()) {
                let columns = target.try_as_col_major_mut().zip(sum.try_as_col_major());
                let Some((target, sum)) = columns else {
                    continue;
                };
                let (target, sum) = (target.as_slice_mut(), sum.as_slice());
                vectorized(
                    #[inline(always)]
                    || {
                        for (target, sum) in target.iter_mut().zip(sum) {
                            *target -= scale * f64::from(*sum);
                        }
                    },
                );
            }
        }
    }
}
