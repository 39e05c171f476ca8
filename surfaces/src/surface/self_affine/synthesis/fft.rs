//! A Fourier transform whose result is the same on every computer.
//!
//! rustfft, which the rest of the crate uses, picks its algorithm by the instructions the
//! processor offers, and each rounds differently. A generated surface must not depend on that, so
//! its synthesis uses this transform: additions, subtractions and multiplications in one fixed
//! order, and twiddle factors that come from `libm`.

use num_complex::Complex64;

use crate::surface::turns;

/// The unnormalised inverse transform x_j = Σ_k X_k exp(2πi jk/n) of one length n.
///
/// Mixed-radix decimation in time; a prime factor p costs p operations a value.
pub(super) struct InverseFft {
    /// Prime factors of n, except that pairs of twos are fours; these come first.
    factors: Vec<usize>,
    /// exp(2πi k/n) for k = 0..n.
    twiddles: Vec<Complex64>,
}

impl InverseFft {
    pub(super) fn new(n: usize) -> Self {
        let twiddles = (0..n)
            .map(|k| {
                // Between -1/2 and 1/2 turn, where the quotient is rounded least.
                let signed = if 2 * k > n { k as f64 - n as f64 } else { k as f64 };
                turns::cis(signed / n as f64)
            })
            .collect();
        Self { factors: factors(n), twiddles }
    }

    /// Transforms `input` into `output`, both of length n. `scratch` is resized as needed.
    pub(super) fn process(
        &self,
        input: &[Complex64],
        output: &mut [Complex64],
        scratch: &mut Vec<Complex64>,
    ) {
        scratch.resize(self.factors.iter().copied().max().unwrap_or(1), Complex64::ZERO);
        self.recurse(input, 1, output, &self.factors, scratch);
    }

    /// Transforms every `stride`-th value of `input` into the whole of `output`.
    fn recurse(
        &self,
        input: &[Complex64],
        stride: usize,
        output: &mut [Complex64],
        factors: &[usize],
        scratch: &mut [Complex64],
    ) {
        let Some((&p, factors)) = factors.split_first() else {
            output[0] = input[0];
            return;
        };
        let m = output.len() / p;
        for (r, part) in output.chunks_exact_mut(m).enumerate() {
            self.recurse(&input[r * stride..], stride * p, part, factors, scratch);
        }
        for k in 0..m {
            match p {
                2 => self.butterfly_2(output, m, k, stride),
                4 => self.butterfly_4(output, m, k, stride),
                _ => self.butterfly(output, m, k, stride, &mut scratch[..p]),
            }
        }
    }

    fn butterfly_2(&self, x: &mut [Complex64], m: usize, k: usize, stride: usize) {
        let a = x[k];
        let b = x[k + m] * self.twiddles[k * stride];
        x[k] = a + b;
        x[k + m] = a - b;
    }

    fn butterfly_4(&self, x: &mut [Complex64], m: usize, k: usize, stride: usize) {
        let a = x[k];
        let b = x[k + m] * self.twiddles[k * stride];
        let c = x[k + 2 * m] * self.twiddles[2 * k * stride];
        let d = x[k + 3 * m] * self.twiddles[3 * k * stride];
        let (even, odd) = (a + c, a - c);
        let (sum, difference) = (b + d, b - d);
        let turned = Complex64::new(-difference.im, difference.re);
        x[k] = even + sum;
        x[k + m] = odd + turned;
        x[k + 2 * m] = even - sum;
        x[k + 3 * m] = odd - turned;
    }

    fn butterfly(
        &self,
        x: &mut [Complex64],
        m: usize,
        k: usize,
        stride: usize,
        parts: &mut [Complex64],
    ) {
        let p = parts.len();
        for (r, part) in parts.iter_mut().enumerate() {
            *part = x[k + r * m] * self.twiddles[r * k * stride];
        }
        // n/p twiddles make up one p-th of a turn.
        let step = m * stride;
        for s in 0..p {
            let mut sum = parts[0];
            let mut turn = 0;
            for part in &parts[1..] {
                turn = (turn + s) % p;
                sum += part * self.twiddles[turn * step];
            }
            x[k + s * m] = sum;
        }
    }
}

/// Factors of n in the order of use: fours, a two, odd primes.
fn factors(mut n: usize) -> Vec<usize> {
    let mut factors = Vec::new();
    let mut p = 4;
    while n > 1 {
        if n.is_multiple_of(p) {
            factors.push(p);
            n /= p;
        } else {
            p = match p {
                4 => 2,
                2 => 3,
                // What is left after all divisors up to its root have been tried is prime.
                _ if p * p > n => n,
                _ => p + 2,
            };
        }
    }
    factors
}

#[cfg(test)]
mod tests {
    use asperity_fft::Plan;

    use super::*;

    #[test]
    fn factors_multiply_to_the_length() {
        for n in 1..2000 {
            let factors = factors(n);
            assert_eq!(factors.iter().product::<usize>(), n);
            for p in factors {
                assert!(p == 4 || (2..p).all(|d| p % d != 0), "{p} in {n}");
            }
        }
    }

    #[test]
    fn agrees_with_rustfft() {
        let mut scratch = Vec::new();
        for n in (1..=130).chain([251, 256, 360, 1000, 1009, 1024, 2048, 2310]) {
            let input: Vec<_> =
                (0..n).map(|k| turns::cis(0.618_033_988_749_9 * (k * k) as f64)).collect();
            let mut expected = input.clone();
            f64::complex_inverse(n).process(&mut expected);
            let mut output = vec![Complex64::ZERO; n];
            InverseFft::new(n).process(&input, &mut output, &mut scratch);
            let norm = (n as f64).sqrt();
            for (a, b) in output.iter().zip(&expected) {
                // Values are of the order sqrt n. Each is a sum of n terms in log n stages, or in
                // one stage of p terms for a prime factor p: rounding grows like the root of that.
                assert!((a - b).norm() < 1e-13 * norm.max(1.0), "n = {n}");
            }
        }
    }
}
