//! A window played anew with what the exact solution at its end shows.

use nalgebra::{Matrix2, Vector2};

use super::{Course, Window};
use crate::loading::tuning::{CERTAIN, LEAST_DETERMINANT, OF_LEFT_OUT};
use crate::updater::Schur;

/// Pressure and gap of a watched node, with their rates, by the solution at a window's end. Of a node that was in
/// contact when the window began it is overlap and pressure in their places.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::loading) struct AtEnd {
    /// Pressure and its rate: 0 if the node is out of contact.
    pub(in crate::loading) pressure: [f64; 2],
    /// Gap and minus its closing rate: 0 if the node is in contact.
    pub(in crate::loading) gap: [f64; 2],
}

/// A window that ends as the solution there says.
#[derive(Debug)]
pub(in crate::loading) struct Correction {
    /// With a corrected Schur complement, and courses for what is still missing at the end.
    pub(in crate::loading) window: Window,
    /// With the Schur complement as it was, and courses alone to make the end right.
    pub(in crate::loading) by_courses: Window,
    /// Whether the Schur complement could be corrected: otherwise both are the same.
    pub(in crate::loading) is_updated: bool,
}

impl Correction {
    /// The greatest part of a pivot that the correction changed.
    pub(in crate::loading) fn left_out(&self) -> f64 {
        let size = self.window.nodes().len();
        let left = |i| self.window.schur().entry(i, i) / self.by_courses.schur().entry(i, i);
        (0..size).fold(0.0, |most, i| f64::max((1.0 - left(i)).abs(), most))
    }
}

/// What the `times` of events in a window that ends after `span` may be off by besides their `errors`, if Schur
/// complements leave out a part of a pivot. Both ends are solutions; in between the correction, of rank two, does not
/// see all of what is left out.
pub(in crate::loading) fn widen(
    errors: &mut [f64],
    times: impl Iterator<Item = f64>,
    (left_out, span): (f64, f64),
) {
    if errors.len() < CERTAIN {
        return;
    }
    for (error, time) in errors.iter_mut().zip(times) {
        let way = (time / span).clamp(0.0, 1.0);
        *error += OF_LEFT_OUT * left_out * span * 4.0 * way * (1.0 - way);
    }
}

/// Corrects a Schur complement S̃ of lines `a − t b` by a window's end at `time`.
///
/// With the pressures at the end in the columns of W, the end shows `V = (S̃ − S) W`, and
///
/// ```math
/// S_2 = \tilde S - V (W^T V)^{-1} V^T
/// ```
///
/// (Nyström) acts on W as S does. `S̃ − S` is positive semidefinite, so that WᵀV should be positive definite; where
/// rounding, or too large an error of S̃, spoils that, S̃ stays as it is. Whatever is still missing at the end is added
/// to each gap as a cubic in time of zero value and slope at the beginning. Nodes in contact, which may yield, have
/// pressures in the place of gaps, and overlaps in that of pressures.
pub(in crate::loading) fn correct(window: &Window, ends: &[AtEnd], time: f64) -> Correction {
    let mut by_courses = window.clone();
    complete(&mut by_courses, window, ends, time);
    let mut updated = by_courses.clone();
    let is_updated = update(&mut updated, ends, time) && updated.is_sound();
    if is_updated {
        complete(&mut updated, window, ends, time);
    } else {
        updated.clone_from(&by_courses);
    }
    Correction { window: updated, by_courses, is_updated }
}

/// Bends the lines of a window so that they end as they should under the Schur complement of another one.
fn complete(target: &mut Window, window: &Window, ends: &[AtEnd], time: f64) {
    let explained = |schur: &Schur, i: usize, k: usize| -> f64 {
        let row = ends.iter().enumerate();
        row.map(|(j, other)| schur.entry(i, j) * other.pressure[k]).sum()
    };
    let courses: Vec<Course> = window
        .courses()
        .zip(ends)
        .enumerate()
        .map(|(i, (Course { line, .. }, end))| {
            let schur = target.schur();
            let gap = end.gap[0] - (line.gap - time * line.closing + explained(schur, i, 0));
            let slope = end.gap[1] - (explained(schur, i, 1) - line.closing);
            let curve = [
                (3.0 * gap - slope * time) / (time * time),
                (slope * time - 2.0 * gap) / (time * time * time),
            ];
            Course { line: *line, curve }
        })
        .collect();
    target.set_courses(courses.into_iter());
}

/// Updates the Schur complement of a window whose courses end as they should; false, and nothing has changed, if `WᵀV`
/// has no inverse.
fn update(window: &mut Window, ends: &[AtEnd], time: f64) -> bool {
    let t = time;
    // V, minus what the lines and S̃ lack at the end, both columns in the unit of a rate.
    let missing: Vec<Vector2<f64>> = window
        .courses()
        .map(|Course { curve: [c2, c3], .. }| {
            Vector2::new(-t * (c2 + t * c3), -t * (2.0 * c2 + 3.0 * t * c3))
        })
        .collect();
    let mut products = Matrix2::zeros();
    for (end, v) in ends.iter().zip(&missing) {
        products += Vector2::new(end.pressure[0] / t, end.pressure[1]) * v.transpose();
    }
    let Some(inverse) = inverse(0.5 * (products + products.transpose())) else {
        return false;
    };
    let taken = |i: usize, j: usize| (missing[i].transpose() * inverse * missing[j])[0];
    let size = missing.len();
    let mut matrix = window.schur_mut().matrix_mut();
    for j in 0..size {
        for i in j..size {
            matrix[(i, j)] -= taken(i, j);
        }
    }
    true
}

/// The inverse of a positive semidefinite `WᵀV`, the pseudoinverse if the error of S̃ has but one direction;
/// `None` if it is not positive semidefinite.
fn inverse(products: Matrix2<f64>) -> Option<Matrix2<f64>> {
    // Where one of the diagonal is not positive, neither this nor the determinant is a finite number.
    let roots = [products[(0, 0)].sqrt(), products[(1, 1)].sqrt()];
    let correlation = products[(0, 1)] / (roots[0] * roots[1]);
    let determinant = 1.0 - correlation * correlation;
    // With unit diagonal.
    let (own, other) = if determinant > LEAST_DETERMINANT {
        (1.0 / determinant, -correlation / determinant)
    } else if determinant > -LEAST_DETERMINANT {
        (0.25, 0.25_f64.copysign(correlation))
    } else {
        return None;
    };
    let scaled = |value: f64, i: usize, j: usize| value / (roots[i] * roots[j]);
    Some(Matrix2::new(
        scaled(own, 0, 0),
        scaled(other, 0, 1),
        scaled(other, 1, 0),
        scaled(own, 1, 1),
    ))
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::loading::test_chain;

    const TIME: f64 = 2.0;
    /// Pressures and rates at the end of two nodes that have joined, and of one that has not.
    const PRESSURES: [[f64; 2]; 3] = [[2.0, 1.0], [1.0, 1.0], [0.0, 0.0]];
    /// a, b of lines that end so under S, and the gap of the third node and its slope there: with S p = (7, 5, 1) and S
    /// q = (4, 4, 1) it is b = S q and a = 2 b − S p in contact, and 10 − 2 · 2 + 1 = 7 and 1 − 2 beside.
    const LINES: [[f64; 2]; 3] = [[1.0, 4.0], [3.0, 4.0], [10.0, 2.0]];
    const LAST: [f64; 2] = [7.0, -1.0];

    fn exact() -> DMatrix<f64> {
        DMatrix::from_row_slice(3, 3, &[3.0, 1.0, 0.0, 1.0, 3.0, 1.0, 0.0, 1.0, 3.0])
    }

    /// S and an error of some rank.
    fn with_error(parts: &[(f64, [f64; 3])]) -> DMatrix<f64> {
        let mut schur = exact();
        for (factor, u) in parts {
            for i in 0..3 {
                for j in 0..3 {
                    schur[(i, j)] += factor * u[i] * u[j];
                }
            }
        }
        schur
    }

    fn corrected(schur: &DMatrix<f64>) -> Correction {
        let ends = PRESSURES.map(|pressure| AtEnd {
            pressure,
            gap: if pressure == [0.0; 2] { LAST } else { [0.0; 2] },
        });
        correct(&window(schur, &LINES), &ends, TIME)
    }

    fn window(schur: &DMatrix<f64>, lines: &[[f64; 2]]) -> Window {
        let lines: Vec<_> = (0..).zip(lines.iter().copied()).collect();
        test_chain::window(&lines, schur, &vec![0.0; lines.len()], f64::INFINITY)
    }

    /// An error of rank two, or one, is seen whole at the end. With E = S̃ − S of (1, 0, 1/2) and (0, 1, 1) the end
    /// lacks E p = (2, 1, 2) and E q = (1, 1, 3/2), and the cubics that add −E p and −E q at t = 2 are
    /// `((−3 E p + 2 E q)/4, (−2 E q + 2 E p)/8)`.
    #[test]
    fn what_the_end_shows_of_an_error_is_taken_off() {
        let two = corrected(&with_error(&[(1.0, [1.0, 0.0, 0.5]), (1.0, [0.0, 1.0, 1.0])]));
        let cubics = [[-1.0, 0.25], [-0.25, 0.0], [-0.75, 0.125]];
        let courses = two.by_courses.courses();
        for ((course, [a, b]), [c2, c3]) in courses.zip(LINES).zip(cubics) {
            assert_eq!(*course, test_chain::course([a, b, c2, c3]));
        }
        // The same and the opposite sign of what p and q see of the error.
        let one = corrected(&with_error(&[(1.0, [1.0, 1.0, 0.5])]));
        let opposite = corrected(&with_error(&[(1.0, [1.0, -1.5, 0.5])]));
        for correction in [two, one, opposite] {
            assert!(correction.is_updated);
            // Rounding errors of numbers up to 5, times a condition number of 40.
            let error = (test_chain::matrix(&correction.window) - exact()).abs().max();
            assert!(error < 1e-12, "{error:e}");
            for (course, line) in correction.window.courses().zip(LINES) {
                assert_eq!([course.line.gap, course.line.closing], line);
                let [c2, c3] = course.curve;
                assert!(c2.abs() < 1e-12 && c3.abs() < 1e-12, "{c2:e} {c3:e}");
            }
        }
    }

    /// An error that is no error of a Galerkin solution leaves S̃ as it is, and cubics make the end right.
    #[test]
    fn an_error_of_the_wrong_sign_is_no_error() {
        for parts in
            [&[(-1.0, [1.0, 0.0, 0.5])][..], &[(1.0, [1.0, 0.0, 0.0]), (-1.5, [0.0, 1.0, 0.0])]]
        {
            let schur = with_error(parts);
            let correction = corrected(&schur);
            let Correction { window, by_courses, .. } = &correction;
            assert!(!correction.is_updated && correction.left_out() == 0.0);
            assert_eq!(test_chain::matrix(window), schur);
            assert!(window.courses().eq(by_courses.courses()));
        }
        // One node of which less than nothing, or nothing, would be left: 1 − 2 and 1 − 1.
        for (a, left) in [(1.0, -1.0), (1.0, 0.0), (1.0, 0.5)] {
            let end = AtEnd { pressure: [1.0, 1.0], gap: [0.0; 2] };
            // With t = 1: b = S q = left, and a = b − S p = 0.
            let line = [0.0, left];
            let schur = DMatrix::from_element(1, 1, a);
            let correction = correct(&window(&schur, &[line]), &[end], 1.0);
            assert_eq!(correction.is_updated, left > 0.0, "{left}");
        }
    }

    /// (4, 1; 1, 1) has the determinant 3. Correlations near 1 are those of an error in one direction, and beyond it
    /// of none.
    #[test]
    fn inverses_of_two_by_two() {
        let inverse_of = |a: f64, b: f64, c: f64| {
            let inverse = inverse(Matrix2::new(a, b, b, c))?;
            Some([inverse[(0, 0)], inverse[(0, 1)], inverse[(1, 0)], inverse[(1, 1)]])
        };
        let close = |found: Option<[f64; 4]>, expected: [f64; 4], error: f64| {
            let found = found.unwrap_or([f64::NAN; 4]);
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < error, "{found} {expected}");
            }
        };
        let third = 1.0 / 3.0;
        close(inverse_of(4.0, 1.0, 1.0), [third, -third, -third, 4.0 * third], 1e-15);
        // Determinants of 2·10⁻⁶, which cancellation leaves ten digits of, and of half a millionth on either side of 0.
        let correlation = |determinant: f64| (1.0 - determinant).sqrt();
        let regular = correlation(2e-6);
        let [own, other] = [5e5, -5e5 * regular];
        close(inverse_of(1.0, regular, 1.0), [own, other, other, own], 1e-9);
        for determinant in [5e-7, -5e-7] {
            let c = correlation(determinant);
            assert_eq!(inverse_of(1.0, c, 1.0), Some([0.25; 4]));
            assert_eq!(inverse_of(1.0, -c, 1.0), Some([0.25, -0.25, -0.25, 0.25]));
        }
        assert_eq!(inverse_of(1.0, correlation(-2e-6), 1.0), None);
        for (a, c) in
            [(0.0, 1.0), (1.0, 0.0), (0.0, 0.0), (-1.0, 1.0), (1.0, -1.0), (f64::NAN, 1.0)]
        {
            assert_eq!(inverse_of(a, 0.5, c), None, "{a} {c}");
            assert_eq!(inverse_of(a, 0.0, c), None, "{a} {c}");
        }
    }

    /// A fifth of a tenth of the span of 2 in the middle, three quarters of that at a quarter of the way, and nothing
    /// at the ends.
    #[test]
    fn times_are_most_uncertain_between_the_ends() {
        let times = [0.0, 0.5, 1.0, 2.0, 2.1];
        let mut errors = [1.0; 5];
        widen(&mut errors, times.into_iter(), (0.1, 2.0));
        for (found, expected) in errors.into_iter().zip([1.0, 1.03, 1.04, 1.0, 1.0]) {
            assert!((found - expected).abs() < 1e-15, "{found}");
        }
        // The end determines a single one.
        let mut errors = [1.0];
        widen(&mut errors, times.into_iter().skip(1), (0.1, 2.0));
        assert_eq!(errors, [1.0]);
    }

    /// The pivots of nodes alone are 4, 4 and 17/4, of which the error is 1, 1 and 5/4.
    #[test]
    fn the_greatest_part_of_a_pivot_is_told() {
        let correction = corrected(&with_error(&[(1.0, [1.0, 0.0, 0.5]), (1.0, [0.0, 1.0, 1.0])]));
        let left_out = correction.left_out();
        assert!((left_out - 1.25 / 4.25).abs() < 1e-12, "{left_out}");
    }
}
