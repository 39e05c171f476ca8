//! The conductivity of a mixture, in the mean field of itself.

/// Bruggeman's conductivity in two dimensions: the one at which `Σ (κ − K) / (κ + K)` vanishes, with closed nodes at κ
/// = 0. It is 0 from the half of the nodes closed on, where this theory sees the last channel close.
pub(super) fn bruggeman(conductivity: &[f64]) -> f64 {
    let open = || conductivity.iter().copied().filter(|conductivity| *conductivity > 0.0);
    let (least, greatest) = open().fold((f64::INFINITY, 0.0_f64), |(a, b), k| (a.min(k), b.max(k)));
    if 2 * open().count() <= conductivity.len() || least == greatest {
        let all_open = open().count() == conductivity.len();
        // Equal nodes among closed ones: (n₁ (κ − K) / (κ + K) = n₀) has a closed form.
        let share = open().count() as f64 / conductivity.len() as f64;
        return match (all_open, 2.0 * share > 1.0) {
            (true, _) => greatest,
            (false, true) => greatest * (2.0 * share - 1.0),
            (false, false) => 0.0,
        };
    }
    // The sum falls with K. It is no less at 0 than the share of open nodes over that of closed ones, so that a root is
    // there; below the least conductivity it may lie far.
    let excess = |k: f64| conductivity.iter().map(|c| (c - k) / (c + k)).sum::<f64>();
    let (mut low, mut high) = (least.ln() - 60.0, greatest.ln());
    // Sixty halves of at most 480: to rounding.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if excess(middle.exp()) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    (0.5 * (low + high)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closed forms: one conductivity; equal shares of two, whose geometric mean it is; one among closed nodes, c (2 f
    /// − 1).
    #[test]
    fn closed_forms_of_mixtures() {
        assert_eq!(bruggeman(&[0.3; 5]), 0.3);
        let two = bruggeman(&[1.0, 1e-8, 1e-8, 1.0]);
        assert!((two / 1e-4 - 1.0).abs() < 1e-12, "{two}");
        let closed = bruggeman(&[0.5, 0.5, 0.5, 0.0]);
        assert!((closed / 0.25 - 1.0).abs() < 1e-12, "{closed}");
        assert_eq!(bruggeman(&[1.0, 0.0]), 0.0);
        assert_eq!(bruggeman(&[1.0, 0.5, 0.0, 0.0]), 0.0);
        assert_eq!(bruggeman(&[0.0; 3]), 0.0);
    }

    /// The equation itself, by hand on three nodes: (1 − K)/(1 + K) + (½ − K)/(½ + K) = 1 gives 3 K² + 1.5 K − 0.5 = 0.
    #[test]
    fn the_mean_field_is_that_of_the_equation() {
        let k = bruggeman(&[1.0, 0.5, 0.0]);
        let expected = (-1.5 + (1.5_f64 * 1.5 + 4.0 * 3.0 * 0.5).sqrt()) / 6.0;
        assert!((k - expected).abs() < 1e-14, "{k} {expected}");
    }
}
