//! Complete elliptic integrals by the arithmetic-geometric mean.

use std::f64::consts::PI;

/// The complete elliptic integrals of modulus `k`, `m = k²`.
///
/// In addition to `K` and `E` the Hertz problem needs the ratio of
/// `D = (K - E)/m` and `B = (E - (1-m) K)/m`; both differences cancel as `m → 0`, so that ratio
/// is formed from the sum of the AGM instead, all of whose terms are positive.
#[derive(Debug, Clone, Copy)]
pub(super) struct CompleteElliptic {
    /// First kind, K.
    pub(super) first: f64,
    /// Second kind, E.
    pub(super) second: f64,
    /// ln(D/B): zero at m = 0, growing with m.
    pub(super) log_ratio: f64,
}

impl CompleteElliptic {
    /// From ln k′, k′ = √(1 − m) being the complementary modulus: m keeps all its digits near
    /// k′ = 1 and k′ all its own near m = 1. Abramowitz & Stegun 17.6.
    ///
    /// `log_complement` is at most 0.
    pub(super) fn from_log_complement(log_complement: f64) -> Self {
        let m = -(2.0 * log_complement).exp_m1();
        let mut a = 1.0_f64;
        let mut g = log_complement.exp();
        // Half of sum 2^n c_n²/m over the steps n = 1, 2, … of the mean, where c_n² = a_n² − g_n²
        // is carried as square = c_n²/m to stay clear of 0/0.
        let mut square = 1.0;
        let mut weight = 1.0;
        let mut half_sum = 0.0;
        // a − g squares at each step; once it is down to rounding, the rest of the sum, of the
        // order of (a − g)², is nothing. The modulus 0 takes one step, 1e-300 a dozen.
        loop {
            let next = 0.5 * (a + g);
            g = (a * g).sqrt();
            a = next;
            square *= square * m / (16.0 * a * a);
            half_sum += weight * square;
            weight *= 2.0;
            if a - g <= 4.0 * f64::EPSILON * a || a.is_nan() {
                break;
            }
        }
        let first = PI / (2.0 * a);
        Self {
            first,
            second: first * (1.0 - m * (0.5 + half_sum)),
            // D/K = 1/2 + half_sum and B/K = 1/2 − half_sum.
            log_ratio: 2.0 * (2.0 * half_sum).atanh(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::FRAC_PI_2;

    /// The defining integrals by the midpoint rule, which converges geometrically for these smooth
    /// periodic integrands.
    fn by_midpoint(complement: f64) -> (f64, f64, f64) {
        let m = (1.0 - complement) * (1.0 + complement);
        let n = 2000;
        let (mut first, mut second, mut d, mut b) = (0.0, 0.0, 0.0, 0.0);
        for i in 0..n {
            let sin = (FRAC_PI_2 * (f64::from(i) + 0.5) / f64::from(n)).sin();
            let root = (1.0 - m * sin * sin).sqrt();
            first += 1.0 / root;
            second += root;
            d += sin * sin / root;
            b += (1.0 - sin * sin) / root;
        }
        let width = FRAC_PI_2 / f64::from(n);
        (first * width, second * width, (d / b).ln())
    }

    #[test]
    fn the_mean_agrees_with_the_defining_integrals() {
        for complement in [0.999_999, 0.9, 0.5, 0.1, 0.02] {
            let (first, second, log_ratio) = by_midpoint(complement);
            let agm = CompleteElliptic::from_log_complement(complement.ln());
            // Rounding of sums of 2000 terms.
            assert_relative_eq!(agm.first, first, epsilon = 0.0, max_relative = 1e-13);
            assert_relative_eq!(agm.second, second, epsilon = 0.0, max_relative = 1e-13);
            assert_relative_eq!(agm.log_ratio, log_ratio, epsilon = 1e-13);
        }
    }

    /// K E′ + E K′ − K K′ = π/2 ties each modulus to its complement.
    #[test]
    fn legendres_relation_holds() {
        for complement in [1e-3_f64, 0.1, 0.5, 0.7] {
            let k = ((1.0 - complement) * (1.0 + complement)).sqrt();
            let one = CompleteElliptic::from_log_complement(complement.ln());
            let other = CompleteElliptic::from_log_complement(k.ln());
            let sum = one.first * other.second + one.second * other.first - one.first * other.first;
            // A few rounding errors of terms of size up to 13.
            assert_relative_eq!(sum, FRAC_PI_2, epsilon = 0.0, max_relative = 2e-14);
        }
    }

    #[test]
    fn both_ends_of_the_range_are_right() {
        let circle = CompleteElliptic::from_log_complement(0.0);
        assert_eq!((circle.first, circle.second, circle.log_ratio), (FRAC_PI_2, FRAC_PI_2, 0.0));
        // ln(D/B) = m/4 + O(m²), with every digit although m is only 2e-12: the rest is 1e-24.
        let nearly = CompleteElliptic::from_log_complement(-1e-12);
        assert_relative_eq!(nearly.log_ratio, 0.5e-12, epsilon = 0.0, max_relative = 1e-11);
        // K → ln(4/k′), E → 1, to O(k′² ln k′) = 1e-19; the rounding of E is that of K.
        let slender = CompleteElliptic::from_log_complement(1e-10_f64.ln());
        assert_relative_eq!(slender.first, 4e10_f64.ln(), epsilon = 0.0, max_relative = 1e-15);
        assert_relative_eq!(slender.second, 1.0, epsilon = 0.0, max_relative = 2e-14);
    }

    #[test]
    fn nan_comes_back() {
        assert!(CompleteElliptic::from_log_complement(f64::NAN).first.is_nan());
    }
}
