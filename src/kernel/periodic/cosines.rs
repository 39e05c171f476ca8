//! Sums of cosines of fractions of a turn.

use super::even::cosine_of_turn;

/// Sums f(0) + 2 Σ f(a) cos 2πak/n.
#[derive(Debug, Clone)]
pub(in crate::kernel) struct CosineSeries {
    /// 2 cos 2πj/n for j = 0..n.
    twice_cosines: Vec<f64>,
}

impl CosineSeries {
    /// For periods of n.
    pub(in crate::kernel) fn new(n: usize) -> Self {
        Self { twice_cosines: (0..n).map(|j| 2.0 * cosine_of_turn(j, n)).collect() }
    }

    /// The sum for the terms f(0), f(1), … and a k < n, from the small terms at the end to the large ones.
    pub(in crate::kernel) fn sum(&self, terms: &[f64], k: usize) -> f64 {
        let n = self.twice_cosines.len();
        let Some((first, terms)) = terms.split_first() else {
            return 0.0;
        };
        let mut sum = 0.0;
        let mut phase = (terms.len() + 1) * k % n;
        for term in terms.iter().rev() {
            phase = if phase < k { phase + n - k } else { phase - k };
            sum += term * self.twice_cosines[phase];
        }
        sum + first
    }
}

/// sin πx / πx.
pub(crate) fn sinc(x: f64) -> f64 {
    let x = std::f64::consts::PI * x;
    if x == 0.0 { 1.0 } else { libm::sin(x) / x }
}
