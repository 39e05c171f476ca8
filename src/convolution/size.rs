//! Lengths for which the Fourier transform is fast.

use super::tuning::{FACTORS, PER_POINT};

/// The cheapest transform length that is at least `minimum`.
///
/// Lengths with a prime factor above 11 are never chosen.
pub(crate) fn fast_size(minimum: usize) -> usize {
    let minimum = minimum.max(1);
    let power_of_two = minimum.next_power_of_two();
    (minimum..=power_of_two)
        .filter_map(|size| Some((cost(size)?, size)))
        .min()
        .map_or(power_of_two, |(_, size)| size)
}

/// Relative time of a transform of length `size`, or `None` with a large prime factor.
fn cost(size: usize) -> Option<usize> {
    let mut rest = size;
    let mut per_point = PER_POINT;
    for (prime, time) in FACTORS {
        while rest.is_multiple_of(prime) {
            rest /= prime;
            per_point += time;
        }
    }
    (rest == 1).then_some(size * per_point)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_stay() {
        for power in 0..16 {
            assert_eq!(fast_size(1 << power), 1 << power);
        }
    }

    #[test]
    fn awkward_lengths_grow_a_little() {
        // A prime, twice a prime, one more than a power of two, and an empty transform.
        assert_eq!(fast_size(127), 128);
        assert_eq!(fast_size(262), 288);
        assert_eq!(fast_size(1025), 1152);
        assert_eq!(fast_size(0), 1);
    }

    #[test]
    fn never_below_the_minimum_nor_far_above() {
        // Cheapest is not shortest: a power of two may be 30 % longer and still win.
        for minimum in 1..5000 {
            let size = fast_size(minimum);
            assert!(size >= minimum && size <= minimum.next_power_of_two());
            assert!(minimum < 100 || 10 * size <= 13 * minimum, "{minimum} -> {size}");
            assert!(cost(size).is_some());
        }
    }
}
