//! A window played anew with what the exact solution at its end shows.

use nalgebra::{DMatrix, Matrix2, Vector2};

use super::play::Course;

/// The least determinant of `WᵀV`, relative to the product of its diagonal, with which it is inverted.
const LEAST_DETERMINANT: f64 = 1e-6;

/// What the solution at the end says of a watched node.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct AtEnd {
    /// Pressure and its rate: 0 if the node is out of contact.
    pub(super) pressure: [f64; 2],
    /// Gap and minus its closing rate: 0 if the node is in contact.
    pub(super) gap: [f64; 2],
}

/// A Schur complement that explains the end of a window, and what courses then lack.
#[derive(Debug)]
pub(super) struct Correction {
    pub(super) schur: DMatrix<f64>,
    pub(super) courses: Vec<Course>,
    /// Courses corrected without the update, each by the cubic that makes its end right.
    pub(super) hermite: Vec<Course>,
    /// Whether the Schur complement was updated.
    pub(super) updated: bool,
}

/// Corrects a Schur complement S̃ of lines `a − t b` by a window's end at `time`.
///
/// With the pressures at the end in the columns of W, the end shows `V = (S̃ − S) W`, and
///
/// ```math
/// S_2 = \tilde S - V (W^T V)^{-1} V^T
/// ```
///
/// (Nyström) acts on W as S does. `S̃ − S` is positive semidefinite, so that WᵀV should be positive
/// definite; where rounding, or too large an error of S̃, spoils that, S̃ stays as it is. Whatever is still
/// missing at the end is added to each gap as a cubic in time of zero value and slope at the
/// beginning.
pub(super) fn correct(
    schur: &DMatrix<f64>,
    lines: &[[f64; 2]],
    ends: &[AtEnd],
    time: f64,
) -> Correction {
    let hermite = complete(schur, lines, ends, time);
    match nystrom(schur, &hermite, ends, time) {
        Some(updated) => Correction {
            courses: complete(&updated, lines, ends, time),
            schur: updated,
            hermite,
            updated: true,
        },
        None => Correction {
            schur: schur.clone(),
            courses: hermite.clone(),
            hermite,
            updated: false,
        },
    }
}

/// Courses that end as they should under a Schur complement.
fn complete(schur: &DMatrix<f64>, lines: &[[f64; 2]], ends: &[AtEnd], time: f64) -> Vec<Course> {
    let course = |(i, ([a, b], end)): (usize, (&[f64; 2], &AtEnd))| {
        let explained = |k: usize| -> f64 {
            let row = ends.iter().enumerate();
            row.map(|(j, other)| schur[(i, j)] * other.pressure[k])
                .sum()
        };
        let gap = end.gap[0] - (a - time * b + explained(0));
        let slope = end.gap[1] - (explained(1) - b);
        Course([
            *a,
            *b,
            (3.0 * gap - slope * time) / (time * time),
            (slope * time - 2.0 * gap) / (time * time * time),
        ])
    };
    lines.iter().zip(ends).enumerate().map(course).collect()
}

/// The updated Schur complement, if it is one.
fn nystrom(
    schur: &DMatrix<f64>,
    courses: &[Course],
    ends: &[AtEnd],
    time: f64,
) -> Option<DMatrix<f64>> {
    let t = time;
    // −V: what the lines and S̃ lack at the end, both columns in the unit of a rate.
    let missing: Vec<Vector2<f64>> = courses
        .iter()
        .map(|Course([_, _, c2, c3])| {
            Vector2::new(-t * (c2 + t * c3), -t * (2.0 * c2 + 3.0 * t * c3))
        })
        .collect();
    let mut products = Matrix2::zeros();
    for (end, v) in ends.iter().zip(&missing) {
        products += Vector2::new(end.pressure[0] / t, end.pressure[1]) * v.transpose();
    }
    let inverse = inverse(0.5 * (products + products.transpose()))?;
    let mut updated = schur.clone();
    for (i, v) in missing.iter().enumerate() {
        let row = v.transpose() * inverse;
        for (j, other) in missing.iter().enumerate() {
            updated[(i, j)] -= row[0] * other[0] + row[1] * other[1];
        }
    }
    updated
        .diagonal()
        .iter()
        .all(|pivot| *pivot > 0.0)
        .then_some(updated)
}

/// The inverse of a positive semidefinite `WᵀV`, the pseudoinverse if the error of S̃ has but one direction;
/// `None` if it is not positive semidefinite.
fn inverse(products: Matrix2<f64>) -> Option<Matrix2<f64>> {
    let [first, second] = [products[(0, 0)], products[(1, 1)]];
    if !(first > 0.0 && second > 0.0) {
        return None;
    }
    let roots = [first.sqrt(), second.sqrt()];
    let correlation = products[(0, 1)] / (roots[0] * roots[1]);
    let determinant = 1.0 - correlation * correlation;
    // With unit diagonal.
    let (own, other) = if determinant > LEAST_DETERMINANT {
        (1.0 / determinant, -correlation / determinant)
    } else if determinant > -LEAST_DETERMINANT {
        (0.25, 0.25 * correlation.signum())
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
