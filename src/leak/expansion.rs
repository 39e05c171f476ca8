//! Numbers as sums of four, each small beside the one before it: 64 digits, so that small differences of large
//! pressures are not lost.

/// A number, from its greatest part on.
pub(super) type Expansion = [f64; 4];

/// A sum of two numbers, and what rounding takes from it: both together are exact (Knuth).
fn exact(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    let part = sum - a;
    [sum, (a - (sum - part)) + (b - part)]
}

/// A number and one more.
pub(super) fn sum(mut parts: Expansion, more: f64) -> Expansion {
    let mut rest = more;
    for part in &mut parts {
        [*part, rest] = exact(*part, rest);
    }
    // Parts may have cancelled each other: what is behind them moves up.
    for _ in 0..2 {
        for k in (0..3).rev() {
            [parts[k], parts[k + 1]] = exact(parts[k], parts[k + 1]);
        }
    }
    parts
}

/// The difference of two numbers, to rounding of itself and of the difference of their last parts.
pub(super) fn difference(a: Expansion, b: Expansion) -> f64 {
    let [first, after_first] = exact(a[0], -b[0]);
    let [second, after_second] = exact(a[1], -b[1]);
    let [third, after_third] = exact(a[2], -b[2]);
    // From the greatest on, since they may cancel each other; what rounding takes from that is small beside the sum.
    let (mut total, mut rest) = (first, 0.0);
    for part in [second, after_first, third, after_second, a[3] - b[3]] {
        let [sum, taken] = exact(total, part);
        total = sum;
        rest += taken;
    }
    total + (rest + after_third)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_keep_what_rounding_takes() {
        let total = |all: &[f64]| all.iter().fold([0.0; 4], |total, more| sum(total, *more));
        assert_eq!(total(&[1.0, 1e-20, 1e-38, -1.0])[0], 1e-20);
        assert_eq!(total(&[1.0, 1e-20, 1e-40, 1e-58, -1.0, -1e-20, -1e-40])[0], 1e-58);
        let (first, second) =
            (total(&[1.0, 1e-20, 1e-38, 3e-54]), total(&[1.0, 1e-20, 1e-38, 1e-54]));
        // Of 1e-54 the last number keeps ten digits.
        assert!((difference(first, second) / 2e-54 - 1.0).abs() < 1e-9);
        assert_eq!(difference(first, [1.0, 0.0, 0.0, 0.0]), 1e-20);
        assert_eq!(difference(second, first), -difference(first, second));
        assert_eq!(difference(first, first), 0.0);
    }

    /// Numbers on both sides of a power of two: their greatest parts differ by rounding, and the next ones make up for
    /// it.
    #[test]
    fn differences_across_a_power_of_two() {
        let half = f64::EPSILON / 2.0;
        let (a, b) = ([1.0, -half / 2.0, 1e-40, 0.0], [1.0 - half, half / 2.0, -1e-40, 0.0]);
        assert_eq!((difference(a, b), difference(b, a)), (2e-40, -2e-40));
    }
}
