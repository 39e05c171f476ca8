//! One step of an internal variable under a load that is linear in it.

/// The step of `τ s′ + s = x` over z = h/τ, with x linear: `s(t + h) = keep s(t) + old x(t) + now x(t + h)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Weights {
    /// `e⁻ᶻ`.
    pub(super) keep: f64,
    /// `(1 − e⁻ᶻ)/z − e⁻ᶻ`.
    pub(super) old: f64,
    /// `1 − (1 − e⁻ᶻ)/z`.
    pub(super) now: f64,
    /// `(1 − e⁻ᶻ)/z`: the mean of `e⁻ˣ` up to z. Of a long time it is small, and 1 less the weight above loses its
    /// digits.
    pub(super) mean: f64,
}

impl Weights {
    pub(super) fn of(z: f64) -> Self {
        if z < SMALL {
            // The differences below lose digits there: Σ −(−z)ᵏ/(k + 1)! and Σ −(−z)ᵏ k/(k + 1)! from k = 1 on.
            let (mut power, mut now, mut old) = (-1.0, 0.0, 0.0);
            for k in 1..TERMS {
                let k = f64::from(k);
                power *= -z / (k + 1.0);
                now += power;
                old += power * k;
            }
            return Self { keep: (-z).exp(), old, now, mean: 1.0 - now };
        }
        let keep = (-z).exp();
        let mean = (1.0 - keep) / z;
        Self { keep, old: mean - keep, now: 1.0 - mean, mean }
    }
}

/// Below it series lose nothing.
const SMALL: f64 = 0.5;
/// Enough for them: ½ᵏ k/(k + 1)! is below 10⁻¹⁸ from k = 16 on.
const TERMS: u32 = 17;

#[cfg(test)]
mod tests {
    use super::*;

    /// A constant stays what it is; both forms agree where one takes over from the other, and with their leading terms.
    #[test]
    fn weights_are_those_of_a_linear_load() {
        for z in [0.0, 1e-300, 1e-12, 1e-3, 0.3, 0.499_999, 0.5, 0.7, 3.0, 50.0, 1e9, f64::INFINITY]
        {
            let Weights { keep, old, now, .. } = Weights::of(z);
            // Roundings of three numbers up to 1, and of their sums.
            assert!((keep + old + now - 1.0).abs() < 5e-16, "{z}");
            assert!(old >= 0.0 && now >= 0.0 && keep >= 0.0, "{z}");
        }
        let (below, above) = (Weights::of(SMALL * (1.0 - 1e-15)), Weights::of(SMALL));
        // Differences of numbers around 1 over the weight, 0.2, and 10⁻¹⁵ of z.
        assert!((below.now / above.now - 1.0).abs() < 4e-15, "{below:?} {above:?}");
        assert!((below.old / above.old - 1.0).abs() < 4e-15, "{below:?} {above:?}");
        // Of terms of a microsecond after years too.
        for z in [0.5, 3.0, 50.0, 1e9, 1e15, 1e20] {
            let mean = Weights::of(z).mean;
            assert!((mean * z / (1.0 - (-z).exp()) - 1.0).abs() < 5e-16, "{z}: {mean}");
        }
        let tiny = Weights::of(1e-9);
        assert!((tiny.now / (0.5e-9 - 1e-18 / 6.0) - 1.0).abs() < 1e-15);
        assert!((tiny.old / (0.5e-9 - 1e-18 / 3.0) - 1.0).abs() < 1e-15);
    }
}
