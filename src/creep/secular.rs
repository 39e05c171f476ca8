//! Roots of secular functions: sums of simple poles, which say how creep and relaxation belong together.

/// A pole of `Σ wᵢ/(x − λᵢ)`, with a positive weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pole {
    pub(super) place: f64,
    pub(super) weight: f64,
}

/// A root, with `Σ wᵢ/(x − λᵢ)²` there, the weight of the pole that the inverse function has at this place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Root {
    pub(super) place: f64,
    pub(super) slope: f64,
}

/// The roots of `Σ wᵢ/(x − λᵢ) = c` with c ≥ 0, of poles in ascending order, no two in one place: one between each pole
/// and the next, and for c > 0 one behind the last.
///
/// The function falls from +∞ to −∞ between two poles, so that bisection finds each root. Roots are kept as their
/// distance from the nearer pole, which makes all differences exact to rounding, however close roots and poles are.
pub(super) fn roots(poles: &[Pole], c: f64) -> Vec<Root> {
    let mut roots = Vec::with_capacity(poles.len());
    for (k, pair) in poles.windows(2).enumerate() {
        let half = 0.5 * (pair[1].place - pair[0].place);
        // Above c in the middle: the root is nearer to the upper pole.
        let is_upper = sum(poles, pair[0].place, half) > c;
        let origin = if is_upper { pair[1].place } else { pair[0].place };
        let sign = if is_upper { -1.0 } else { 1.0 };
        let is_beyond = |distance: f64| (sum(poles, origin, sign * distance) > c) == is_upper;
        let offset = sign * least(half, is_beyond);
        roots.push(root(poles, origin, offset));
        debug_assert_eq!(roots.len(), k + 1);
    }
    if let (Some(last), true) = (poles.last(), c > 0.0) {
        // Σ wᵢ/(x − λᵢ) is at most the sum of weights over the distance from the last pole.
        let far = 2.0 * poles.iter().map(|pole| pole.weight).sum::<f64>() / c;
        let offset = least(far, |distance| sum(poles, last.place, distance) <= c);
        roots.push(root(poles, last.place, offset));
    }
    roots
}

/// The sum of poles at a place given by its offset from one of them.
fn sum(poles: &[Pole], origin: f64, offset: f64) -> f64 {
    poles.iter().map(|pole| pole.weight / ((origin - pole.place) + offset)).sum()
}

fn root(poles: &[Pole], origin: f64, offset: f64) -> Root {
    let squares = poles.iter().map(|pole| {
        let distance = (origin - pole.place) + offset;
        pole.weight / distance / distance
    });
    Root { place: origin + offset, slope: squares.sum() }
}

/// The least number up to `most` that is so; all above it are. Bisection of the bits of a positive number: to the last
/// of them, in 64 steps, however small it is.
fn least(most: f64, is_so: impl Fn(f64) -> bool) -> f64 {
    let (mut below, mut at) = (0_u64, most.to_bits());
    while at - below > 1 {
        let middle = below + (at - below) / 2;
        if is_so(f64::from_bits(middle)) {
            at = middle;
        } else {
            below = middle;
        }
    }
    f64::from_bits(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1/(x − 1) + 2/(x − 4) = 0 at x = 2; with c = 1 x² − 8x + 10 = 0.
    #[test]
    fn roots_of_two_poles() {
        let poles = [Pole { place: 1.0, weight: 1.0 }, Pole { place: 4.0, weight: 2.0 }];
        let between = roots(&poles, 0.0);
        assert_eq!(between.len(), 1);
        assert!((between[0].place - 2.0).abs() < 1e-15);
        // 1/1 + 2/4 there.
        assert!((between[0].slope - 1.5).abs() < 1e-15);
        let all = roots(&poles, 1.0);
        let expected = [4.0 - 6.0_f64.sqrt(), 4.0 + 6.0_f64.sqrt()];
        assert_eq!(all.len(), 2);
        for (root, expected) in all.iter().zip(expected) {
            assert!((root.place / expected - 1.0).abs() < 4e-16, "{root:?}");
        }
    }

    /// The second of two poles 12 decades apart, with a weight of 10⁻¹⁸: the root is a part in 10¹⁸ before it, which no
    /// difference of places shows.
    #[test]
    fn a_root_beside_a_pole_is_known_by_its_distance() {
        let poles = [Pole { place: 1.0, weight: 1.0 }, Pole { place: 1e12, weight: 1e-18 }];
        let roots = roots(&poles, 0.0);
        // 1/(x − 1) = w/(λ − x): a distance of w (λ − 1) to first order.
        let distance = 1e-18 * (1e12 - 1.0);
        let slope = 1.0 / 1e24 + 1e-18 / distance / distance;
        assert!((roots[0].slope / slope - 1.0).abs() < 1e-9, "{roots:?}");
        assert!(super::roots(&[], 1.0).is_empty());
    }
}
