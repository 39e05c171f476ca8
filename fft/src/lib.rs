//! Plans of Fourier transforms.
//!
//! rustfft and realfft are generic in the precision: each crate that plans with them compiles all their butterflies,
//! which takes as long as the rest of a solver. Here they are compiled once, for both precisions. Those who call
//! [`Plan`] compile no transform.
//!
//! ```
//! use asperity_fft::{Fft, Plan};
//! use num_complex::Complex64;
//!
//! let mut values = vec![Complex64::new(1.0, 0.0); 4];
//! f64::complex_forward(4).process(&mut values);
//! assert_eq!(values[0].re, 4.0);
//! ```

use std::sync::Arc;

use realfft::RealFftPlanner;
use rustfft::{FftNum, FftPlanner};

pub use realfft::{ComplexToReal, RealToComplex};
pub use rustfft::Fft;

/// A precision for which transforms of any length are planned. None is normalised.
///
/// A plan depends on its length alone, and on what instructions the processor has.
pub trait Plan: FftNum {
    /// X_k = Σ_j x_j exp(−2πi jk/n) of n complex numbers.
    fn complex_forward(length: usize) -> Arc<dyn Fft<Self>>;

    /// x_j = Σ_k X_k exp(2πi jk/n) of n complex numbers.
    fn complex_inverse(length: usize) -> Arc<dyn Fft<Self>>;

    /// X_k = Σ_j x_j exp(−2πi jk/n) of n real numbers, for 0 ≤ k ≤ n/2.
    fn real_forward(length: usize) -> Arc<dyn RealToComplex<Self>>;

    /// The n real numbers x_j = Σ_k X_k exp(2πi jk/n), given X_k for 0 ≤ k ≤ n/2.
    fn real_inverse(length: usize) -> Arc<dyn ComplexToReal<Self>>;
}

macro_rules! plan {
    ($precision:ty) => {
        impl Plan for $precision {
            #[inline(never)]
            fn complex_forward(length: usize) -> Arc<dyn Fft<Self>> {
                FftPlanner::new().plan_fft_forward(length)
            }

            #[inline(never)]
            fn complex_inverse(length: usize) -> Arc<dyn Fft<Self>> {
                FftPlanner::new().plan_fft_inverse(length)
            }

            #[inline(never)]
            fn real_forward(length: usize) -> Arc<dyn RealToComplex<Self>> {
                RealFftPlanner::new().plan_fft_forward(length)
            }

            #[inline(never)]
            fn real_inverse(length: usize) -> Arc<dyn ComplexToReal<Self>> {
                RealFftPlanner::new().plan_fft_inverse(length)
            }
        }
    };
}

plan!(f32);
plan!(f64);

#[cfg(test)]
mod tests {
    use num_complex::Complex;

    use super::*;

    /// Transforms of both directions and kinds against their sums, with values of modulus 1 at most.
    fn agrees_with_sums<T: Plan>(epsilon: f64, real: impl Fn(f64) -> T, wide: impl Fn(T) -> f64) {
        let turn = |j: usize, k: usize, n: usize| {
            Complex::cis(std::f64::consts::TAU * (j * k % n) as f64 / n as f64)
        };
        // Products of small primes, primes, and powers of two.
        for n in [1, 2, 3, 4, 5, 6, 7, 12, 13, 16, 31, 37, 64, 67, 90, 97, 128, 210] {
            // Each stage of a transform rounds sums that grow to n; a prime length goes by one of twice the length at
            // least.
            let close = 8.0 * epsilon * n as f64 * (1.0 + (n as f64).log2());
            let x: Vec<f64> = (0..n).map(|j| (0.618 * (j * j) as f64).fract()).collect();
            let narrow: Vec<T> = x.iter().map(|x| real(*x)).collect();
            let sums = |sign: f64| -> Vec<Complex<f64>> {
                let term = |j: usize, k: usize| {
                    let turn = turn(j, k, n);
                    Complex::new(turn.re, sign * turn.im) * x[j]
                };
                (0..n).map(|k| (0..n).map(|j| term(j, k)).sum()).collect()
            };
            let check = |found: &[Complex<T>], expected: &[Complex<f64>]| {
                for (found, expected) in found.iter().zip(expected) {
                    let found = Complex::new(wide(found.re), wide(found.im));
                    assert!((found - expected).norm() < close, "{n}: {found} {expected}");
                }
            };
            let zero = Complex::new(T::zero(), T::zero());
            for (plan, sign) in [(T::complex_forward(n), -1.0), (T::complex_inverse(n), 1.0)] {
                let mut values: Vec<_> =
                    narrow.iter().map(|x| Complex::new(*x, T::zero())).collect();
                plan.process(&mut values);
                check(&values, &sums(sign));
            }
            let mut line = narrow.clone();
            let mut half = vec![zero; n / 2 + 1];
            assert!(T::real_forward(n).process(&mut line, &mut half).is_ok());
            check(&half, &sums(-1.0));
            // And back: n times the values.
            half[0].im = T::zero();
            if n.is_multiple_of(2) {
                half[n / 2].im = T::zero();
            }
            assert!(T::real_inverse(n).process(&mut half, &mut line).is_ok());
            for (found, x) in line.iter().zip(&x) {
                let found = wide(*found);
                // The errors of n values of the spectrum add up.
                assert!((found - n as f64 * x).abs() < n as f64 * close, "{n}: {found} {x}");
            }
        }
    }

    #[test]
    fn transforms_are_their_sums() {
        agrees_with_sums::<f64>(f64::EPSILON, |x| x, |x| x);
        agrees_with_sums::<f32>(f64::from(f32::EPSILON), |x| x as f32, f64::from);
    }
}
