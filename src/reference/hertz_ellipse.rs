//! Elliptic paraboloid on a half-space (Hertz).

use super::elliptic::CompleteElliptic;
use super::positive_part;
use crate::Error;
use std::f64::consts::PI;

/// Hertz contact of the elliptic paraboloid $`g(x,y) = x^2/(2R_x) + y^2/(2R_y)`$.
///
/// The contact is an ellipse, longer along the larger radius, whose axis ratio
/// $`b/a = \sqrt{1-e^2}`$ depends on the radii alone:
/// ```math
/// \frac{R_{\min}}{R_{\max}} = \frac{b^2}{a^2}
///   \frac{K(e) - E(e)}{E(e) - (b^2/a^2) K(e)}
/// ```
/// with the complete elliptic integrals of modulus `e`. Equal radii give [`HertzSphere`](super::HertzSphere).
///
/// Johnson, *Contact Mechanics*, §4.2(b).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HertzEllipse {
    radius_x: f64,
    radius_y: f64,
    e_star: f64,
    axis_ratio: f64,
    eccentricity: f64,
    /// K(e).
    first: f64,
    /// E(e).
    second: f64,
}

impl HertzEllipse {
    /// Smallest admissible ratio of the two radii; a contact still more slender is a
    /// [`HertzLine`](super::HertzLine).
    pub const MIN_RADIUS_RATIO: f64 = 1e-12;

    /// A paraboloid of curvature radii `radius_x` and `radius_y` \[m\], in either order, on a
    /// half-space of modulus `e_star` \[Pa\].
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for any of the three, [`Error::OutOfRange`] for radii whose ratio is
    /// below [`HertzEllipse::MIN_RADIUS_RATIO`].
    pub fn new(radius_x: f64, radius_y: f64, e_star: f64) -> Result<Self, Error> {
        let radius_x = Error::require_positive("radius along x", radius_x)?;
        let radius_y = Error::require_positive("radius along y", radius_y)?;
        let e_star = Error::require_positive("plane-strain modulus", e_star)?;
        let ratio = radius_x.min(radius_y) / radius_x.max(radius_y);
        let quantity = "ratio of the smaller to the larger radius";
        Error::require(quantity, ratio, ratio >= Self::MIN_RADIUS_RATIO, "at least 1e-12")?;
        let log_axis_ratio = log_axis_ratio(ratio.ln());
        let integrals = CompleteElliptic::from_log_complement(log_axis_ratio);
        Ok(Self {
            radius_x,
            radius_y,
            e_star,
            axis_ratio: log_axis_ratio.exp(),
            eccentricity: (-(2.0 * log_axis_ratio).exp_m1()).sqrt(),
            first: integrals.first,
            second: integrals.second,
        })
    }

    /// Radius of curvature along x \[m\].
    #[must_use]
    pub fn radius_x(&self) -> f64 {
        self.radius_x
    }

    /// Radius of curvature along y \[m\].
    #[must_use]
    pub fn radius_y(&self) -> f64 {
        self.radius_y
    }

    /// Plane-strain modulus \[Pa\].
    #[must_use]
    pub fn e_star(&self) -> f64 {
        self.e_star
    }

    /// Shorter over longer semi-axis of the contact, `b/a`: the same at every load.
    #[must_use]
    pub fn axis_ratio(&self) -> f64 {
        self.axis_ratio
    }

    /// Eccentricity of the contact, $`e = \sqrt{1 - b^2/a^2}`$.
    #[must_use]
    pub fn eccentricity(&self) -> f64 {
        self.eccentricity
    }

    /// Sum of the half curvatures, A + B of Johnson.
    fn curvature(&self) -> f64 {
        0.5 / self.radius_x + 0.5 / self.radius_y
    }

    /// Shorter semi-axis, b² = δ E / ((A + B) K).
    fn minor_semi_axis(&self, approach: f64) -> f64 {
        (positive_part(approach) * self.second / (self.curvature() * self.first)).sqrt()
    }

    /// Semi-axes of the contact along x and along y \[m\]; the shorter one is
    /// ```math
    /// b = \sqrt{\frac{2 \delta}{1/R_x + 1/R_y} \frac{E(e)}{K(e)}}
    /// ```
    #[must_use]
    pub fn semi_axes(&self, approach: f64) -> (f64, f64) {
        let minor = self.minor_semi_axis(approach);
        let major = minor / self.axis_ratio;
        if self.radius_x >= self.radius_y { (major, minor) } else { (minor, major) }
    }

    /// Contact area `πab` \[m²\].
    #[must_use]
    pub fn contact_area(&self, approach: f64) -> f64 {
        let (along_x, along_y) = self.semi_axes(approach);
        PI * along_x * along_y
    }

    /// Pressure at the centre, $`p_0 = E^\ast \delta / (b K(e))`$ \[Pa\].
    #[must_use]
    pub fn max_pressure(&self, approach: f64) -> f64 {
        // With δ eliminated in favour of b, nothing is divided by zero at first touch.
        self.e_star * self.curvature() * self.minor_semi_axis(approach) / self.second
    }

    /// Mean pressure over the contact, $`\frac23 p_0`$ \[Pa\].
    #[must_use]
    pub fn mean_pressure(&self, approach: f64) -> f64 {
        2.0 / 3.0 * self.max_pressure(approach)
    }

    /// Load $`W = \frac23 \pi a b p_0`$, which grows as $`\delta^{3/2}`$ \[N\].
    #[must_use]
    pub fn load(&self, approach: f64) -> f64 {
        self.mean_pressure(approach) * self.contact_area(approach)
    }

    /// Approach under a load \[m\].
    #[must_use]
    pub fn approach_at_load(&self, load: f64) -> f64 {
        // W = (2π/3) E* (A + B) b³ / (k′ E), then δ = b² (A + B) K / E.
        let cube = 1.5 / PI * positive_part(load) / self.e_star * self.axis_ratio * self.second
            / self.curvature();
        let minor = cube.cbrt();
        minor * minor * self.curvature() * self.first / self.second
    }

    /// Contact stiffness $`\mathrm{d}W/\mathrm{d}\delta = \frac32 W/\delta = \pi E^\ast a / K(e)`$
    /// \[N/m\].
    #[must_use]
    pub fn contact_stiffness(&self, approach: f64) -> f64 {
        PI * self.e_star * self.minor_semi_axis(approach) / (self.axis_ratio * self.first)
    }

    /// Elastic energy $`U = \frac25 W \delta`$ \[J\].
    #[must_use]
    pub fn energy(&self, approach: f64) -> f64 {
        0.4 * self.load(approach) * positive_part(approach)
    }

    /// Pressure at (`x`, `y`) from the centre,
    /// $`p_0 \sqrt{1 - x^2/a_x^2 - y^2/a_y^2}`$ with the semi-axes $`a_x`$, $`a_y`$ \[Pa\].
    #[must_use]
    pub fn pressure(&self, x: f64, y: f64, approach: f64) -> f64 {
        let (along_x, along_y) = self.semi_axes(approach);
        let (x, y) = (x.abs(), y.abs());
        if x >= along_x || y >= along_y {
            return 0.0;
        }
        let y = y / along_y;
        let inside = (1.0 - x / along_x) * (1.0 + x / along_x) - y * y;
        self.max_pressure(approach) * positive_part(inside).sqrt()
    }
}

/// ln(b/a) from ln(R_min/R_max) ≤ 0: the root of 2 ln(b/a) + ln(D/B) = ln(R_min/R_max).
///
/// As b/a grows to 1, ln(D/B) falls to zero, at most half as fast as ln(b/a) grows. The fixed-point
/// iteration from b/a = √(R_min/R_max), which lies above the root, therefore descends to it without
/// ever passing it, and at least quarters its error each time.
fn log_axis_ratio(log_radius_ratio: f64) -> f64 {
    let mut log = 0.5 * log_radius_ratio;
    // A descent ends where rounding stops it: no tolerance is needed.
    loop {
        let next = 0.5 * (log_radius_ratio - CompleteElliptic::from_log_complement(log).log_ratio);
        // Written so that NaN, too, ends it.
        if next < log {
            log = next;
        } else {
            return log;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// b/a = 1/2, 1/5 and 1/10, and the ratios of radii, K and E that belong to them, from the
    /// defining integrals ∫ sin²/√(1−m sin²), ∫ cos²/√(1−m sin²) summed outside this crate.
    #[test]
    fn axis_ratio_agrees_with_the_defining_integrals() -> Result<(), Error> {
        for (axis_ratio, radius_ratio, first, second) in [
            (0.5, 0.351_771_642_284_186_06, 2.156_515_647_499_643, 1.211_056_027_568_459_4),
            (0.2, 0.084_555_312_401_679_4, 3.016_112_492_477_647, 1.050_502_226_984_45),
            (0.1, 0.027_370_194_883_873_69, 3.695_637_362_989_873, 1.015_993_545_025_224),
        ] {
            let ellipse = HertzEllipse::new(1.0, radius_ratio, 1.0)?;
            // Rounding of sums of 400 terms, and of the logarithms.
            assert_relative_eq!(
                ellipse.axis_ratio(),
                axis_ratio,
                epsilon = 0.0,
                max_relative = 2e-15
            );
            assert_relative_eq!(ellipse.first, first, epsilon = 0.0, max_relative = 2e-15);
            assert_relative_eq!(ellipse.second, second, epsilon = 0.0, max_relative = 2e-15);
        }
        Ok(())
    }
}
