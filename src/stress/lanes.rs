//! Numbers side by side, whose loops the compiler makes vectors of where they are
//! [`vectorized`](crate::parallel::vectorized).

/// How many: two of the widest vectors that are common.
pub(super) const LANES: usize = 8;

pub(super) type Lanes = [f64; LANES];

/// One for each place.
#[inline(always)]
pub(super) fn each(of: impl Fn(usize) -> f64) -> Lanes {
    let mut values = [0.0; LANES];
    for (k, value) in values.iter_mut().enumerate() {
        *value = of(k);
    }
    values
}

/// e^(−x) of each x ≥ 0, to some 4·10⁻¹⁶ of itself; beyond 700, where nothing is left, that of 700.
#[inline(always)]
pub(super) fn fades(x: &Lanes) -> Lanes {
    /// A sum with it is rounded to an integer, which its last bits are.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    /// ln 2 in two parts, of which the first has 32 bits: its products with integers below 2¹⁰ are exact.
    const LN_2: (f64, f64) = (f64::from_bits(0x3FE6_2E42_FEE0_0000), 1.908_214_929_270_587_7e-10);
    each(|k| {
        let x = x[k].min(700.0);
        // x = n ln 2 + r with |r| ≤ ln 2 / 2, where Taylor's fourteenth term is 4·10⁻¹⁸.
        let shifted = x * std::f64::consts::LOG2_E + ROUND;
        let n = shifted - ROUND;
        let r = (x - n * LN_2.0) - n * LN_2.1;
        let mut sum = TAYLOR[ORDER - 1];
        for term in TAYLOR[..ORDER - 1].iter().rev() {
            sum = sum * r + term;
        }
        // 2⁻ⁿ by its exponent.
        sum * f64::from_bits((1023_u64 << 52).wrapping_sub(shifted.to_bits() << 52))
    })
}

const ORDER: usize = 14;

/// (−1)ⁿ/n!.
const TAYLOR: [f64; ORDER] = {
    let mut terms = [1.0; ORDER];
    let mut n = 1;
    while n < ORDER {
        terms[n] = -terms[n - 1] / n as f64;
        n += 1;
    }
    terms
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponentials_are_those_of_the_library() {
        for k in 0..100_000 {
            let x = 700.0 * (f64::from(k) / 1e5).powi(3);
            let found = fades(&[x; LANES]);
            let expected = libm::exp(-x);
            // Two roundings, and that of the library.
            assert!(found.iter().all(|found| (found / expected - 1.0).abs() < 5e-16), "{x}");
        }
        assert_eq!(fades(&[0.0; LANES]), [1.0; LANES]);
        assert!(fades(&[1e300; LANES])[0] < 1e-300);
    }
}
