//! Far from the cell: the multipoles of a uniformly loaded rectangle.
//!
//! With the observer at (r, φ), a source at (s, θ) of the same plane contributes
//!
//! ```math
//! \frac1{|\mathbf r - \mathbf s|} = \frac1r \Bigl(1 - \tfrac sr e^{i(\theta-\varphi)}\Bigr)^{-1/2}
//!    \Bigl(1 - \tfrac sr e^{-i(\theta-\varphi)}\Bigr)^{-1/2}.
//! ```
//!
//! Both binomial series together, averaged over the rectangle (odd powers vanish), give
//!
//! ```math
//! \Bigl\langle \frac1{|\mathbf r - \mathbf s|} \Bigr\rangle = \frac1r \sum_k r^{-2k}
//!    \sum_{j \le k} c_{kj} \cos 2j\varphi, \qquad
//!    c_{kj} = (2 - \delta_{j0})\, a_{k-j}\, a_{k+j}\, \langle s^{2k} \cos 2j\theta \rangle,
//! ```
//!
//! with $`a_m = \binom{2m}{m} / 4^m`$. The sum over j is a polynomial in cos 2φ.

/// Highest order k that is summed: on square cells it serves from some 4 cells on.
const MAX_ORDER: usize = 8;

/// The orders at which the sum may end, from far to near.
const ORDERS: [usize; 5] = [2, 3, 4, 6, 8];

/// What may be left out, relative to the whole: less than half a unit in the last place.
const NEGLIGIBLE: f64 = 1e-16;

/// Multipoles of a cell, and from which distance on how many of them are enough.
///
/// Lengths are in units of the short side, x along the long one.
#[derive(Debug, Clone)]
pub(super) struct Far {
    /// Long side / (π E*): with the average of 1/r it makes the coefficient.
    scale: f64,
    /// Square of the half diagonal of the cell, R².
    radius2: f64,
    /// Square of the distance from which on the order in `ORDERS` is enough.
    reach2: [f64; ORDERS.len()],
    /// Row k − 1: order k as a polynomial in cos 2φ, in units of R²ᵏ.
    rows: [[f64; MAX_ORDER + 1]; MAX_ORDER],
}

impl Far {
    pub(super) fn new(aspect: f64, scale: f64) -> Self {
        let radius2 = 0.25 * (aspect * aspect + 1.0);
        let mut rows = [[0.0; MAX_ORDER + 1]; MAX_ORDER];
        for (row, k) in rows.iter_mut().zip(1..) {
            *row = powers_of_cosine(&multipoles(aspect, k));
        }
        // The orders fall off at least as fast as powers of (R / r)² < 1/30: the first one left
        // out, at its worst angle, stands for all.
        let reach2 = ORDERS.map(|order| {
            let first_left_out: f64 = multipoles(aspect, order + 1).iter().map(|c| c.abs()).sum();
            radius2 * (first_left_out / NEGLIGIBLE).powf(1.0 / (order as f64 + 1.0))
        });
        Self { scale, radius2, reach2, rows }
    }

    /// Square of the distance from which on [`Far::value`] may be used.
    pub(super) fn reach2(&self) -> f64 {
        self.reach2[ORDERS.len() - 1]
    }

    /// The coefficient at (x, y), at the squared distance `r2` = x² + y².
    pub(super) fn value(&self, x: f64, y: f64, r2: f64) -> f64 {
        let inverse = 1.0 / r2;
        let q = self.radius2 * inverse;
        let cos_2phi = (x - y) * (x + y) * inverse;
        let correction = if r2 >= self.reach2[0] {
            self.sum::<{ ORDERS[0] }>(q, cos_2phi)
        } else if r2 >= self.reach2[1] {
            self.sum::<{ ORDERS[1] }>(q, cos_2phi)
        } else if r2 >= self.reach2[2] {
            self.sum::<{ ORDERS[2] }>(q, cos_2phi)
        } else if r2 >= self.reach2[3] {
            self.sum::<{ ORDERS[3] }>(q, cos_2phi)
        } else {
            self.sum::<{ ORDERS[4] }>(q, cos_2phi)
        };
        self.scale * (r2.sqrt() * inverse) * (1.0 + correction)
    }

    /// The orders 1 to K, relative to the monopole.
    #[inline]
    fn sum<const K: usize>(&self, q: f64, cos_2phi: f64) -> f64 {
        let mut sum = 0.0;
        for k in (1..=K).rev() {
            let row = &self.rows[k - 1];
            let mut angular = row[k];
            for j in (0..k).rev() {
                angular = angular * cos_2phi + row[j];
            }
            sum = (sum + angular) * q;
        }
        sum
    }
}

/// As many as the first order left out has.
type Row = [f64; MAX_ORDER + 2];

/// c_kj for j = 0..=k, in units of R²ᵏ.
fn multipoles(aspect: f64, k: usize) -> Row {
    // ⟨ξ²ᵐ η²ᵖ⟩ = (A²)ᵐ (B²)ᵖ / ((2m + 1)(2p + 1)) for half sides A and B, A² + B² = R² = 1.
    let b2 = 1.0 / (aspect * aspect + 1.0);
    let a2 = 1.0 - b2;
    let moment = |m: usize, p: usize| {
        a2.powi(m as i32) * b2.powi(p as i32) / ((2 * m + 1) as f64 * (2 * p + 1) as f64)
    };
    let mut multipoles = [0.0; MAX_ORDER + 2];
    for (j, multipole) in multipoles.iter_mut().enumerate().take(k + 1) {
        // s²ᵏ cos 2jθ = (ξ² + η²)ᵏ⁻ʲ Re (ξ + iη)²ʲ, by powers of η².
        let mut powers = [0.0; MAX_ORDER + 2];
        let mut binomial = 1.0;
        for (p, power) in powers.iter_mut().enumerate().take(j + 1) {
            *power = binomial;
            let (n, i) = ((2 * j) as f64, (2 * p) as f64);
            binomial *= -(n - i) * (n - i - 1.0) / ((i + 1.0) * (i + 2.0));
        }
        for _ in j..k {
            for p in (1..=k).rev() {
                powers[p] += powers[p - 1];
            }
        }
        let average: f64 = (0..=k).map(|p| powers[p] * moment(k - p, p)).sum();
        let twice = if j == 0 { 1.0 } else { 2.0 };
        *multipole = twice * central(k - j) * central(k + j) * average;
    }
    multipoles
}

/// Binomial coefficient of 2m over m, divided by 4ᵐ.
fn central(m: usize) -> f64 {
    (1..=m).map(|i| 1.0 - 0.5 / i as f64).product()
}

/// Rewrites Σ c_j cos 2jφ as a polynomial in cos 2φ.
fn powers_of_cosine(multipoles: &Row) -> [f64; MAX_ORDER + 1] {
    let mut row = [0.0; MAX_ORDER + 1];
    // Chebyshev polynomials by T_{j+1} = 2 t T_j − T_{j−1}, from T_{−1} = T_1.
    let mut previous = [0.0; MAX_ORDER + 1];
    let mut present = [0.0; MAX_ORDER + 1];
    previous[1] = 1.0;
    present[0] = 1.0;
    for c in &multipoles[..=MAX_ORDER] {
        let mut next = [0.0; MAX_ORDER + 1];
        for i in 0..=MAX_ORDER {
            row[i] += c * present[i];
            let raised = if i > 0 { present[i - 1] } else { 0.0 };
            next[i] = 2.0 * raised - previous[i];
        }
        (previous, present) = (present, next);
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrupole_of_a_rectangle() {
        // ⟨ξ²⟩ = A²/3 and ⟨η²⟩ = B²/3 with A = 3 B, in units of R² = 10 B².
        let (xi2, eta2) = (0.9 / 3.0, 0.1 / 3.0);
        let quadrupole = multipoles(3.0, 1);
        assert!((quadrupole[0] - 0.25 * (xi2 + eta2)).abs() < 1e-16);
        assert!((quadrupole[1] - 0.75 * (xi2 - eta2)).abs() < 1e-16);
    }

    #[test]
    fn on_the_axis_of_a_needle_every_order_is_a_moment() {
        // 1 / (r − ξ) is the geometric series, and ⟨ξ²ᵏ⟩ = A²ᵏ / (2k + 1).
        for k in 1..=MAX_ORDER + 1 {
            let sum: f64 = multipoles(1e9, k).iter().sum();
            let exact = 1.0 / (2 * k + 1) as f64;
            // The needle has a width of 1e-9, and sums of k terms round.
            assert!((sum - exact).abs() < 1e-15, "order {k}: {sum}");
        }
    }

    #[test]
    fn square_has_only_fourfold_orders() {
        for k in 1..=MAX_ORDER + 1 {
            for (j, c) in multipoles(1.0, k).iter().enumerate() {
                if j % 2 == 1 {
                    // Alternating binomials up to C(18, 8) = 43758, halved k times by the moments.
                    assert!(c.abs() < 1e-14, "c({k}, {j}) = {c}");
                }
            }
        }
    }

    #[test]
    fn polynomial_in_the_cosine_is_the_multipole_sum() {
        let multipoles = multipoles(2.0, MAX_ORDER);
        let row = powers_of_cosine(&multipoles);
        for step in 0..=16 {
            let angle = f64::from(step) * 0.2;
            let direct: f64 =
                (0..=MAX_ORDER).map(|j| multipoles[j] * (j as f64 * angle).cos()).sum();
            let power = row.iter().rev().fold(0.0, |sum, c| sum * angle.cos() + c);
            // Coefficients of Chebyshev polynomials of degree 8 reach 256.
            assert!((direct - power).abs() < 256.0 * f64::EPSILON);
        }
    }
}
