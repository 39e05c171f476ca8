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
        mut target: MatMut<'_, f64>,
        scale: f64,
        a: MatRef<'_, Self>,
        b: MatRef<'_, Self>,
    ) {
        let (rows, columns) = (target.nrows(), target.ncols());
        // In the order of the target, so that neither factor is repacked.
        let by_rows = target.col_stride() == 1;
        let mut product = if by_rows {
            Mat::<Self>::zeros(columns, rows)
        } else {
            Mat::<Self>::zeros(rows, columns)
        };
        for start in (0..a.ncols()).step_by(SUMS * DEPTH) {
            let end = a.ncols().min(start + SUMS * DEPTH);
            for first in (start..end).step_by(DEPTH) {
                let depth = DEPTH.min(end - first);
                let (a, b) = (a.subcols(first, depth), b.subrows(first, depth));
                let sum = if by_rows {
                    product.as_mut().transpose_mut()
                } else {
                    product.as_mut()
                };
                let accum = if first == start {
                    Accum::Replace
                } else {
                    Accum::Add
                };
                matmul(sum, accum, a, b, 1.0, Par::Seq);
            }
            let (target, sum) = if by_rows {
                (target.as_mut().transpose_mut(), product.as_ref())
            } else {
                (target.as_mut(), product.as_ref())
            };
            for (target, sum) in target.col_iter_mut().zip(sum.col_iter()) {
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
