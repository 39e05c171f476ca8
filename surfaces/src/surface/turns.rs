//! Sines and cosines of angles counted in whole turns.
//!
//! The reduction to an eighth of a turn is exact, so mirrored or shifted angles give mirrored
//! values bit for bit, and quarter turns give exact zeros and ones. `libm` is used rather than the
//! standard library because the latter calls the platform's own, whose last bit varies.

use std::f64::consts::TAU;

use num_complex::Complex64;

/// cos 2πt + i sin 2πt.
pub(super) fn cis(turns: f64) -> Complex64 {
    let t = turns - turns.round_ties_even();
    // t = quarters / 4 + rest with |rest| <= 1/8; both steps are exact.
    let quarters = (4.0 * t).round_ties_even();
    let rest = t - 0.25 * quarters;
    let (sin, cos) = libm::sincos(TAU * rest);
    match quarters as i8 {
        0 => Complex64::new(cos, sin),
        1 => Complex64::new(-sin, cos),
        -1 => Complex64::new(sin, -cos),
        _ => Complex64::new(-cos, -sin),
    }
}

/// cos 2πt.
pub(super) fn cos(turns: f64) -> f64 {
    cis(turns).re
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        let expected = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
        for k in -8_i32..=8 {
            let value = cis(0.25 * f64::from(k));
            let (re, im) = expected[k.rem_euclid(4) as usize];
            assert_eq!((value.re, value.im), (re, im), "{k} quarters");
        }
    }

    #[test]
    fn agrees_with_the_standard_library_and_is_even() {
        for k in -1000_i32..=1000 {
            let t = 0.001_37 * f64::from(k);
            let value = cis(t);
            // |t| <= 1.37: the reference rounds an angle below 8.7 to 9e-16, plus its last bit.
            assert!((value.re - (TAU * t).cos()).abs() < 2e-15);
            assert!((value.im - (TAU * t).sin()).abs() < 2e-15);
            assert_eq!(cos(t).to_bits(), cos(-t).to_bits());
        }
    }
}
