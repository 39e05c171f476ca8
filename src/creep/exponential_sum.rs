//! Where a sum of exponentials first turns negative.

/// `f(z) = a + b z + Σ cₘ e^(−z/τₘ)` for z ≥ 0.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ExponentialSum {
    pub(super) constant: f64,
    pub(super) linear: f64,
    /// (cₘ, τₘ).
    pub(super) terms: Vec<(f64, f64)>,
}

impl ExponentialSum {
    pub(super) fn at(&self, z: f64) -> f64 {
        let terms = self.terms.iter().map(|(c, time)| c * (-z / time).exp());
        self.constant + self.linear * z + terms.sum::<f64>()
    }

    fn derivative(&self) -> Self {
        let terms = self.terms.iter().map(|(c, time)| (-c / time, *time)).collect();
        Self { constant: self.linear, linear: 0.0, terms }
    }

    /// What rounding may make of the sum at z: some units in the last place of its greatest parts.
    fn rounding(&self, z: f64) -> f64 {
        let terms = self.terms.iter().map(|(c, time)| c.abs() * (-z / time).exp());
        let parts = self.constant.abs() + (self.linear * z).abs() + terms.sum::<f64>();
        4.0 * f64::EPSILON * parts
    }

    /// Bounds on an interval: each term is monotone, so that its ends bound it.
    fn bounds(&self, from: f64, to: f64) -> (f64, f64) {
        let (mut low, mut high) = (self.constant, self.constant);
        let ends = |c: f64, time: f64| (c * (-from / time).exp(), c * (-to / time).exp());
        let terms = self.terms.iter().map(|(c, time)| ends(*c, *time));
        for (a, b) in terms.chain([(self.linear * from, self.linear * to)]) {
            low += a.min(b);
            high += a.max(b);
        }
        (low, high)
    }

    /// The first z up to `end` from which on the sum is negative, by more than rounding.
    ///
    /// Numbers so far apart that bounds overflow have no answer: then the first interval without one counts as
    /// negative, since that is what is refused.
    ///
    /// Intervals are halved until bounds of the function, its derivative or its second derivative decide: until it has
    /// one sign, is monotone, convex or concave. Roots are then between ends of different sign.
    pub(super) fn first_negative(&self, end: f64) -> Option<f64> {
        let first = self.derivative();
        let all = [self.clone(), first.derivative(), first];
        let [function, second, first] = &all;
        let mut waiting = vec![(0.0, end)];
        let mut looked_at = 0;
        while let Some((from, to)) = waiting.pop() {
            looked_at += 1;
            if looked_at > MOST_INTERVALS {
                return Some(from);
            }
            match function.decide(first, second, from, to) {
                Some(None) => (),
                Some(found) => return found,
                None => {
                    // The first of the decades between 0 and the end are the shortest.
                    let is_long = from < to / 16.0;
                    let middle = from + (to - from) * if is_long { 0.0625 } else { 0.5 };
                    waiting.push((middle, to));
                    waiting.push((from, middle));
                }
            }
        }
        None
    }

    /// On one interval: where it turns negative if it does, `None` if that is not to be seen.
    fn decide(&self, first: &Self, second: &Self, from: f64, to: f64) -> Option<Option<f64>> {
        let is_negative = |z: f64| self.at(z) < -self.rounding(z);
        if self.bounds(from, to).0 >= 0.0 {
            return Some(None);
        }
        if is_negative(from) {
            return Some(Some(from));
        }
        // More than rounding below zero at the end: then its sign says where the root is.
        let up_to = |z: f64| is_negative(z).then(|| bisect(from, z, |z| self.at(z) < 0.0));
        let (slowest, fastest) = first.bounds(from, to);
        if slowest >= 0.0 {
            return Some(None);
        }
        let (least, greatest) = second.bounds(from, to);
        if fastest <= 0.0 || greatest <= 0.0 || is_no_interval(from, to) {
            return Some(up_to(to));
        }
        if least >= 0.0 {
            let lowest = bisect(from, to, |z| first.at(z) >= 0.0);
            return Some(up_to(lowest));
        }
        None
    }
}

/// Some ten for each of a hundred terms over hundreds of decades.
const MOST_INTERVALS: usize = 100_000;

/// Whether two numbers are next to each other, or as good as.
fn is_no_interval(from: f64, to: f64) -> bool {
    to - from <= 4.0 * f64::EPSILON * to || to < f64::MIN_POSITIVE
}

/// The first number of an interval from which on something is so, if it stays so: `to` if it never is before.
pub(super) fn bisect(from: f64, to: f64, is_so: impl Fn(f64) -> bool) -> f64 {
    let (mut below, mut above) = (from, to);
    if is_so(from) {
        return from;
    }
    while !is_no_interval(below, above) {
        let middle = below + 0.5 * (above - below);
        if middle <= below || middle >= above {
            break;
        }
        if is_so(middle) {
            above = middle;
        } else {
            below = middle;
        }
    }
    above
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(constant: f64, linear: f64, terms: &[(f64, f64)]) -> ExponentialSum {
        ExponentialSum { constant, linear, terms: terms.to_vec() }
    }

    /// e⁻ᶻ − ½ and 1 − z: roots in closed form.
    #[test]
    fn simple_roots() {
        let root = sum(-0.5, 0.0, &[(1.0, 1.0)]).first_negative(10.0);
        assert!(root.is_some_and(|z| (z - 2.0_f64.ln()).abs() < 1e-15), "{root:?}");
        let root = sum(1.0, -1.0, &[]).first_negative(10.0);
        assert!(root.is_some_and(|z| (z - 1.0).abs() < 1e-15), "{root:?}");
        assert_eq!(sum(1.0, -1.0, &[]).first_negative(0.9), None);
        assert_eq!(sum(-1.0, 0.0, &[]).first_negative(1.0), Some(0.0));
        assert_eq!(sum(0.0, 0.0, &[]).first_negative(1.0), None);
    }

    /// (x − ½)² − d with x = e⁻ᶻ dips below zero by d: from the greater root of x on, between z = 0.69 ± 2 √d. With d =
    /// 0 it touches zero, and is not negative.
    #[test]
    fn a_narrow_dip_is_found_and_a_touch_is_none() {
        for depth in [1e-2, 1e-6, 1e-10, 1e-14] {
            let dip = sum(0.25 - depth, 0.0, &[(-1.0, 1.0), (1.0, 0.5)]);
            let expected = -(0.5 + depth.sqrt()).ln();
            // A rounding of 10⁻¹⁶ moves a root of slope 2 √d by 10⁻¹⁶/√d.
            let tolerance = 1e-15 / depth.sqrt();
            for end in [5.0, 1e6] {
                let root = dip.first_negative(end);
                assert!(root.is_some_and(|z| (z - expected).abs() < tolerance), "{depth} {root:?}");
            }
        }
        assert_eq!(sum(0.25, 0.0, &[(-1.0, 1.0), (1.0, 0.5)]).first_negative(1e3), None);
    }

    /// Terms of either sign over twelve decades: against a dense search on a logarithmic grid.
    #[test]
    fn many_terms_over_many_decades() {
        let terms = [(3.0, 1e-6), (-4.0, 1e-4), (2.0, 1e-1), (-0.5, 10.0), (0.2, 1e5)];
        let function = sum(0.3, 0.0, &terms);
        let found = function.first_negative(1e6);
        let mut grid = (0..400_000).map(|k| 10_f64.powf(-8.0 + 14.0 * f64::from(k) / 4e5));
        let expected = grid.find(|z| function.at(*z) < 0.0);
        let (Some(found), Some(expected)) = (found, expected) else {
            unreachable!("{found:?} {expected:?}");
        };
        // The grid is 8·10⁻⁵ of z apart.
        assert!(found <= expected && expected / found - 1.0 < 1e-4, "{found} {expected}");
    }
}
