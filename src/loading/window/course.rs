//! What a gap or a pressure does as long as nothing happens.

use crate::loading::gap_field::GapLine;
use crate::loading::tuning::NEWTON;

/// The course of a gap, or of the pressure of a node in contact, as long as nothing happens to a watched node: a line,
/// `gap − t closing`, and what is known of its curvature, `c₂ t² + c₃ t³`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::loading) struct Course {
    pub(in crate::loading) line: GapLine,
    pub(in crate::loading) curve: [f64; 2],
}

impl Course {
    /// The gap at a time.
    pub(in crate::loading) fn gap(&self, t: f64) -> f64 {
        let [c2, c3] = self.curve;
        self.line.gap - t * (self.line.closing - t * (c2 + t * c3))
    }

    /// How fast it closes.
    pub(in crate::loading) fn closing(&self, t: f64) -> f64 {
        let [c2, c3] = self.curve;
        self.line.closing - t * (2.0 * c2 + 3.0 * t * c3)
    }

    /// When the gap closes, not before `now`.
    pub(super) fn closes(&self, now: f64) -> f64 {
        if self.curve == [0.0; 2] {
            return self.line.touches().max(now);
        }
        let mut t = now;
        for _ in 0..NEWTON {
            let closing = self.closing(t);
            if closing.is_nan() || closing <= 0.0 {
                return f64::INFINITY;
            }
            t += self.gap(t) / closing;
        }
        if t.is_nan() { f64::INFINITY } else { t.max(now) }
    }

    /// What is left up to a limit that it rises to.
    pub(super) fn below(&self, limit: f64) -> Self {
        let Self { line: GapLine { gap, closing }, curve } = *self;
        let line = GapLine { gap: limit - gap, closing: -closing };
        Self { line, curve: curve.map(|c| -c) }
    }

    /// Subtracts a multiple of another course.
    pub(super) fn subtract(&mut self, factor: f64, other: &Self) {
        self.line.gap -= factor * other.line.gap;
        self.line.closing -= factor * other.line.closing;
        for (c, other) in self.curve.iter_mut().zip(other.curve) {
            *c -= factor * other;
        }
    }
}

impl From<GapLine> for Course {
    fn from(line: GapLine) -> Self {
        let curve = [0.0; 2];
        Self { line, curve }
    }
}

#[cfg(test)]
mod tests {
    use crate::loading::test_chain::course;

    /// `3 − 2 t + t²/2 + t³/4` and its slope, in numbers that are short in binary.
    #[test]
    fn courses_are_cubics() {
        let course = course([3.0, 2.0, 0.5, 0.25]);
        assert_eq!([course.gap(0.0), course.gap(2.0)], [3.0, 3.0]);
        assert_eq!([course.closing(0.0), course.closing(2.0)], [2.0, -3.0]);
    }

    /// The root of `(1 − t) (1 + t²/10)`, which Newton's steps find to rounding, and that of a line; none of a
    /// gap that opens; and none before the present.
    #[test]
    fn gaps_close_at_their_roots() {
        let cubic = course([1.0, 1.0, 0.1, -0.1]);
        assert!((cubic.closes(0.0) - 1.0).abs() < 1e-15);
        assert_eq!(cubic.closes(1.25), 1.25);
        // `1.1 − t − t³/10`, and `(1 − t)(1 − t/4)`: one of both powers alone.
        for of_one_power in [[1.1, 1.0, 0.0, -0.1], [1.0, 1.25, 0.25, 0.0]] {
            assert!((course(of_one_power).closes(0.0) - 1.0).abs() < 1e-15);
        }
        let line = course([3.0, 2.0, 0.0, 0.0]);
        assert_eq!([line.closes(0.0), line.closes(2.0)], [1.5, 2.0]);
        for opening in [
            [1.0, -1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0, 0.0],
            [1.0, -1.0, 0.5, 0.0],
            [f64::NAN, 1.0, 0.1, 0.0],
        ] {
            assert_eq!(course(opening).closes(0.0), f64::INFINITY);
        }
    }
}
