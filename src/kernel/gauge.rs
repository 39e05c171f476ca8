//! The gauge of a periodic half-space, whose mean displacement is arbitrary: what it changes, and
//! which one to compute in.
//!
//! In the gauge s \[m/Pa\] the mean displacement under the pressures p is s Σp. Pressures, gaps and
//! the order of events are the same in every gauge; approach, displacement and energy are not, and
//! are reported relative to the mean planes.
//!
//! Two rules choose a gauge, because two different things are known where one is chosen:
//!
//! * [`least`], for the half-spaces of this crate as they are made ([`of_half_space`]), and for symbols. They tell
//!   the least gauge in which the matrix is an inverse M-matrix, and the promise that gaps are convex holds from there
//!   on only.
//! * [`of_coefficients`], for any table of coefficients, also a coarsened one or one of another body. It
//!   knows neither modulus nor symbol, promises nothing, and only has to keep a matrix well
//!   conditioned that would be singular in the zero gauge.

use crate::Grid;

/// A gauge: the uniform displacement that is added for each unit of load.
///
/// Zero for a body whose mean displacement is not arbitrary, where all conversions leave things as
/// they are.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Gauge {
    /// s/ΔA \[m/N\].
    per_load: f64,
}

impl Gauge {
    /// The gauge s = `coefficient` \[m/Pa\], a uniform part of all influence coefficients, on cells
    /// of `cell_area` = ΔA \[m²\]; zero for `None`.
    pub(crate) fn new(coefficient: Option<f64>, cell_area: f64) -> Self {
        Self { per_load: coefficient.unwrap_or_default() / cell_area }
    }

    /// Uniform displacement under a load W \[m\]: (s/ΔA) W.
    pub(crate) fn displacement(self, load: f64) -> f64 {
        self.per_load * load
    }

    /// The approach in this gauge \[m\] under a load W, from the approach δ₀ = `reported` of the mean
    /// planes: δ_s = δ₀ + (s/ΔA) W.
    pub(crate) fn approach(self, reported: f64, load: f64) -> f64 {
        reported + self.displacement(load)
    }

    /// The approach of the mean planes \[m\] under a load W, from the one in this gauge.
    pub(crate) fn reported_approach(self, approach: f64, load: f64) -> f64 {
        approach - self.displacement(load)
    }

    /// The elastic energy about the mean planes \[J\] under a load W, from the one in this gauge.
    pub(crate) fn reported_energy(self, energy: f64, load: f64) -> f64 {
        energy - 0.5 * self.per_load * load * load
    }

    /// The stiffness dW/dδ_s \[N/m\] in this gauge, from K₀ = `reported` = dW/dδ₀, which may be
    /// infinite: 1/K_s = 1/K₀ + s/ΔA.
    pub(crate) fn stiffness(self, reported: f64) -> f64 {
        1.0 / (1.0 / reported + self.per_load)
    }
}

/// Gauge of a half-space over the least one in which its matrix is an inverse M-matrix: near enough
/// for windows of events to be long, and far enough for the rounding of the least one, which is a
/// difference of numbers up to N³ times as large.
const ABOVE_LEAST: f64 = 1.02;
/// Beyond so many times a good one, digits of everything else are lost beside a gauge: a convex promise holds from a
/// least gauge on, which may be as far above a good one on long cells.
pub(super) const GREATEST_CONVEX_GAUGE: f64 = 1e3;

/// The gauge in which a half-space is made, in units of D / E*, where D is the long side of a cell
/// and `grid` has lengths in units of D.
///
/// Without a `least` gauge, or with any gauge being enough, it is 4/5 of the long side of the grid
/// over (E* M), which is of the size that least gauges have.
pub(super) fn of_half_space(grid: &Grid, least: Option<f64>) -> f64 {
    match least {
        Some(least) if least > 0.0 => ABOVE_LEAST * least,
        _ => {
            let (lx, ly) = grid.sides();
            0.8 * lx.max(ly) / grid.nodes() as f64
        }
    }
}

/// The least gauge s* of an inverse M-matrix, from the coefficients of the pseudo-inverse of its matrix on one period,
/// the first of which is that of a node on itself.
///
/// In the gauge s the inverse is A + 1 / (s M²) everywhere, of M nodes. Its elements off the diagonal are not positive
/// if all those of A are negative and $`s \ge s^* = 1 / (M^2 \min_{\mathbf r \ne 0} (-A(\mathbf r)))`$; its row sums are
/// 1 / (s M). With a single node nothing is off the diagonal, and any gauge will do: zero.
pub(super) fn least(nodes: usize, inverse: &[f64]) -> Option<f64> {
    let greatest = inverse[1..].iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let nodes = nodes as f64;
    (greatest < 0.0).then(|| 1.0 / (nodes * nodes * -greatest))
}

/// The gauge in which a kernel with this `least` one can promise that gaps are convex, given a `good` one to compute
/// in; `None` if that would take all digits: where an element of the inverse is zero, rounding says whether there is a
/// least gauge, and any number of times too great.
pub(super) fn convex(least: Option<f64>, good: f64) -> Option<f64> {
    let gauge = least.map(|least| if least > 0.0 { ABOVE_LEAST * least } else { good });
    gauge.filter(|gauge| *gauge <= GREATEST_CONVEX_GAUGE * good)
}

/// A gauge for any coefficients, given their mean and the least of them \[m/Pa\].
///
/// In the zero gauge the least coefficient is the one of the farthest node, and negative. The gauge is
/// 1.5 times its absolute value; with Love's kernel on a square of many nodes this is 0.74 L / (E* M),
/// near the least gauge in which that kernel is an inverse M-matrix, though not always above it. The
/// coefficient of a single node is nothing but its gauge, which is kept.
pub(super) fn of_coefficients(mean: f64, least: f64) -> f64 {
    let least = least - mean;
    if least < 0.0 { -1.5 * least } else { mean }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;

    #[test]
    fn conversions_undo_each_other() {
        let gauge = Gauge::new(Some(3.0), 2.0);
        // Powers of two and small integers: nothing rounds.
        assert_eq!(gauge.displacement(4.0), 6.0);
        assert_eq!(gauge.approach(1.0, 4.0), 7.0);
        assert_eq!(gauge.reported_approach(7.0, 4.0), 1.0);
        assert_eq!(gauge.reported_energy(13.0, 4.0), 1.0);
        assert_eq!(gauge.stiffness(2.0), 0.5);
        assert_eq!(gauge.stiffness(f64::INFINITY), 2.0 / 3.0);
        let none = Gauge::new(None, 2.0);
        assert_eq!(none, Gauge::default());
        assert_eq!(none.approach(1.0, 4.0), 1.0);
        assert_eq!(none.reported_energy(1.0, 4.0), 1.0);
        assert_eq!(none.stiffness(2.0), 2.0);
    }

    /// The energy is the work done along the approach, whichever gauge that is in.
    #[test]
    fn energy_in_a_gauge_is_the_work_along_its_approach() {
        let gauge = Gauge::new(Some(0.7), 1.3);
        // W = k δ₀² with its energy k δ₀³ / 3, and the trapezoidal rule along δ_s.
        let (k, steps) = (2.5, 20_000);
        let at = |step: i32| {
            let reported = f64::from(step) / f64::from(steps);
            let load = k * reported * reported;
            (gauge.approach(reported, load), load)
        };
        let work: f64 = (0..steps)
            .map(|step| {
                let ((a, w), (b, v)) = (at(step), at(step + 1));
                0.5 * (w + v) * (b - a)
            })
            .sum();
        // The rule errs by some 1 / steps².
        assert!((gauge.reported_energy(work, k) - k / 3.0).abs() < 1e-8);
    }

    #[test]
    fn a_single_node_takes_any_gauge() -> Result<(), Error> {
        let grid = Grid::new(1, 1, 2.0, 1.0)?;
        assert_eq!(of_half_space(&grid, Some(0.0)), 1.6);
        assert_eq!(of_coefficients(0.3, 0.3), 0.3);
        Ok(())
    }
}
