//! The two precisions of transforms.

use asperity_fft::Plan;
use num_complex::Complex;

/// A number that transforms can be done with.
pub(crate) trait Real: Plan + Default {
    /// Zero as a complex number.
    const ZERO: Complex<Self>;

    /// The nearest to `value`.
    fn rounded(value: f64) -> Self;

    /// The same in double precision.
    fn widened(self) -> f64;
}

impl Real for f64 {
    const ZERO: Complex<Self> = Complex { re: 0.0, im: 0.0 };

    #[inline(always)]
    fn rounded(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn widened(self) -> f64 {
        self
    }
}

impl Real for f32 {
    const ZERO: Complex<Self> = Complex { re: 0.0, im: 0.0 };

    #[inline(always)]
    fn rounded(value: f64) -> Self {
        value as f32
    }

    #[inline(always)]
    fn widened(self) -> f64 {
        f64::from(self)
    }
}
