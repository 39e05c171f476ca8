//! A plateau and a power law, fitted to the densities of rings.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use crate::Error;

/// Improvement of twice the logarithm of the likelihood, over the dispersion, that a plateau has to bring. By
/// chance it exceeds 10 once in 600 times (χ² of one degree of freedom).
const IMPROVEMENT: f64 = 10.0;

/// Rings that a plateau has at least.
const PLATEAU: usize = 3;

/// Rings that the power law has at least.
const POWER_LAW: usize = 4;

/// Roll-offs tried before the best of them is refined.
const TRIALS: usize = 100;

/// Steps of the golden section, each of which leaves 0.62 of an interval: to 10⁻⁸ of it.
const SECTIONS: usize = 40;

/// Steps of the iteration for level and exponent: it converges quadratically, but from far above the densities, as
/// where some of them are rounding, each step gains a factor of e.
const STEPS: usize = 100;

/// The mean density of some waves of the same length.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ring {
    /// ln q.
    pub(super) x: f64,
    /// Density, of the order of 1 or less.
    pub(super) density: f64,
    /// Number of independent waves.
    pub(super) weight: f64,
}

/// ln C = plateau − exponent max(0, x − rolloff).
#[derive(Debug, Clone, Copy)]
pub(super) struct Law {
    pub(super) plateau: f64,
    pub(super) exponent: f64,
    pub(super) rolloff: f64,
    pub(super) dispersion: f64,
    /// Standard error of the exponent, if the mean square of relative residuals is 1.
    pub(super) exponent_error: f64,
    /// The same of the roll-off; `None` where the law has no plateau.
    pub(super) rolloff_error: Option<f64>,
}

impl Law {
    /// The density at x = ln q.
    pub(super) fn density(&self, x: f64) -> f64 {
        libm::exp(self.plateau - self.exponent * (x - self.rolloff).max(0.0))
    }
}

/// The law of greatest likelihood, with a plateau or without.
///
/// # Errors
///
/// [`Error::NoConvergence`].
pub(super) fn fit(rings: &[Ring]) -> Result<Law, Error> {
    // At this roll-off all rings but the first lie on the power law.
    let straight = Line::fit(rings, rings[0].x)?;
    let best = best_rolloff(rings)?;
    let bent = Line::fit(rings, best)?;
    let on_plateau = rings.iter().take_while(|ring| ring.x < best).count();
    let dispersion = bent.dispersion(rings, 3);
    let improvement = 2.0 * (straight.misfit - bent.misfit);
    if on_plateau >= PLATEAU && improvement > IMPROVEMENT * dispersion {
        bent.with_errors(rings, dispersion, true)
    } else {
        straight.with_errors(rings, straight.dispersion(rings, 2), false)
    }
}

/// The roll-off of greatest likelihood.
fn best_rolloff(rings: &[Ring]) -> Result<f64, Error> {
    let last = rings.len() - POWER_LAW;
    let step = last.div_ceil(TRIALS).max(1);
    let candidates: Vec<_> = (0..=last).step_by(step).map(|ring| rings[ring].x).collect();
    let mut best = (f64::INFINITY, 0);
    for (candidate, &x) in candidates.iter().enumerate() {
        let misfit = Line::fit(rings, x)?.misfit;
        if misfit < best.0 {
            best = (misfit, candidate);
        }
    }
    let beyond = (best.1 + 1).min(candidates.len() - 1);
    let (mut low, mut high) = (candidates[best.1.saturating_sub(1)], candidates[beyond]);
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    for _ in 0..SECTIONS {
        let (a, b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        if Line::fit(rings, a)?.misfit <= Line::fit(rings, b)?.misfit {
            high = b;
        } else {
            low = a;
        }
    }
    Ok(0.5 * (low + high))
}

/// The law of a given roll-off.
#[derive(Debug, Clone, Copy)]
struct Line {
    rolloff: f64,
    /// Plateau and exponent.
    parameters: Vector2<f64>,
    /// −ln of the likelihood, but for a constant: Σ n (C/M + ln M).
    misfit: f64,
}

impl Line {
    /// Fits plateau and exponent.
    ///
    /// The misfit is a convex function of them, and Newton's steps, halved where they do not reduce it, find its
    /// minimum.
    fn fit(rings: &[Ring], rolloff: f64) -> Result<Self, Error> {
        let mut line = Self::first_guess(rings, rolloff);
        let (mut change, mut steps) = (f64::INFINITY, 0);
        while steps < STEPS {
            steps += 1;
            let mut hessian = Matrix2::zeros();
            let mut slope = Vector2::zeros();
            for ring in rings {
                let direction = line.direction(ring);
                let ratio = ring.density / line.density(ring);
                hessian += ring.weight * ratio * direction * direction.transpose();
                slope += ring.weight * (ratio - 1.0) * direction;
            }
            let step = hessian.try_inverse().map(|inverse| inverse * slope);
            let Some(step) = step.filter(|step| step.iter().all(|s| s.is_finite())) else {
                break;
            };
            let mut length = 1.0;
            let next = loop {
                let next = line.at(rings, line.parameters + length * step);
                if next.misfit <= line.misfit || length < 1e-6 {
                    break next;
                }
                length *= 0.5;
            };
            change = (next.parameters - line.parameters).amax();
            if next.misfit > line.misfit || change == 0.0 {
                // At the minimum, to rounding.
                return Ok(line);
            }
            line = next;
            if change <= 1e-11 * (1.0 + line.parameters.amax()) {
                return Ok(line);
            }
        }
        Err(Error::NoConvergence { residual: change, tolerance: 1e-11, iterations: steps })
    }

    /// The power law through the mean logarithms.
    fn first_guess(rings: &[Ring], rolloff: f64) -> Self {
        let line = Self { rolloff, parameters: Vector2::zeros(), misfit: 0.0 };
        let mut matrix = Matrix2::zeros();
        let mut right_side = Vector2::zeros();
        for ring in rings.iter().filter(|ring| ring.density > 0.0) {
            let direction = line.direction(ring);
            matrix += ring.weight * direction * direction.transpose();
            right_side += ring.weight * libm::log(ring.density) * direction;
        }
        let parameters = matrix.try_inverse().map(|inverse| inverse * right_side);
        line.at(rings, parameters.unwrap_or_default())
    }

    /// The same roll-off with other parameters.
    fn at(&self, rings: &[Ring], parameters: Vector2<f64>) -> Self {
        let mut line = Self { rolloff: self.rolloff, parameters, misfit: 0.0 };
        let terms = rings.iter().map(|ring| {
            let logarithm = parameters.dot(&line.direction(ring));
            ring.weight * (ring.density / libm::exp(logarithm) + logarithm)
        });
        line.misfit = terms.sum();
        line
    }

    /// Derivatives of ln M with respect to plateau and exponent.
    fn direction(&self, ring: &Ring) -> Vector2<f64> {
        Vector2::new(1.0, -(ring.x - self.rolloff).max(0.0))
    }

    /// M.
    fn density(&self, ring: &Ring) -> f64 {
        libm::exp(self.parameters.dot(&self.direction(ring)))
    }

    /// Mean square of the relative residuals for so many fitted parameters.
    fn dispersion(&self, rings: &[Ring], parameters: usize) -> f64 {
        let squares = rings.iter().map(|ring| {
            let residual = ring.density / self.density(ring) - 1.0;
            ring.weight * residual * residual
        });
        squares.sum::<f64>() / rings.len().saturating_sub(parameters).max(1) as f64
    }

    /// The law, with standard errors from the inverse of Fisher's information, as if waves were independent and the
    /// mean square of their relative residuals 1.
    fn with_errors(self, rings: &[Ring], dispersion: f64, bent: bool) -> Result<Law, Error> {
        let [plateau, exponent] = self.parameters.into();
        let mut information = Matrix3::zeros();
        for ring in rings {
            let [constant, slope] = self.direction(ring).into();
            let of_rolloff = if ring.x > self.rolloff { exponent } else { 0.0 };
            let direction = Vector3::new(constant, slope, if bent { of_rolloff } else { 0.0 });
            information += ring.weight * direction * direction.transpose();
        }
        if !bent {
            // Nothing is known of a roll-off, nor asked.
            information[(2, 2)] = 1.0;
        }
        let covariance = information.try_inverse().ok_or(Error::NoConvergence {
            residual: information.determinant(),
            tolerance: 0.0,
            iterations: 0,
        })?;
        let error = |place: usize| covariance[(place, place)].sqrt();
        Ok(Law {
            plateau,
            exponent,
            rolloff: self.rolloff,
            dispersion,
            exponent_error: error(1),
            rolloff_error: bent.then(|| error(2)),
        })
    }
}
