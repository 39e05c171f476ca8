//! Cylinder on a half-space (Hertz).

use super::positive_part;
use std::f64::consts::PI;

closed_form! {
    /// Hertz contact of a cylinder of radius `R`, that is of the trough $`g(x) = x^2/(2R)`$, in plane strain.
    ///
    /// A line contact has no approach of its own: the displacement of a half-space under a line load
    /// grows like a logarithm without end. All is therefore given by the load per length, `F/L` \[N/m\].
    ///
    /// Eq. (20) of Zhang, Zhang & Jin, Friction 8 (2020) 970; Johnson, *Contact Mechanics*, §4.2(c).
    HertzLine;

    /// A cylinder of radius `radius` \[m\] on a half-space of modulus `e_star` \[Pa\].
    new;

    /// Radius of curvature \[m\].
    radius: "radius"
}

impl HertzLine {
    /// Half the width of the contact, $`a = \sqrt{4FR/(\pi L E^\ast)}`$ \[m\].
    #[must_use]
    pub fn half_width(&self, load_per_length: f64) -> f64 {
        (4.0 / PI * positive_part(load_per_length) / self.e_star * self.radius).sqrt()
    }

    /// Load per length for a half-width `a`, $`\pi E^\ast a^2/(4R)`$ \[N/m\].
    #[must_use]
    pub fn load_at_half_width(&self, half_width: f64) -> f64 {
        let a = positive_part(half_width);
        0.25 * PI * self.e_star * a * a / self.radius
    }

    /// Pressure on the centre line, $`p_0 = \sqrt{F E^\ast / (\pi L R)}`$ \[Pa\].
    #[must_use]
    pub fn max_pressure(&self, load_per_length: f64) -> f64 {
        (positive_part(load_per_length) * self.e_star / (PI * self.radius)).sqrt()
    }

    /// Mean pressure over the contact, $`\frac{\pi}{4} p_0`$ \[Pa\].
    #[must_use]
    pub fn mean_pressure(&self, load_per_length: f64) -> f64 {
        0.25 * PI * self.max_pressure(load_per_length)
    }

    /// Pressure at distance `x` from the centre line, $`p_0 \sqrt{1 - x^2/a^2}`$ \[Pa\].
    #[must_use]
    pub fn pressure(&self, x: f64, load_per_length: f64) -> f64 {
        let (x, a) = (x.abs(), self.half_width(load_per_length));
        if x >= a {
            return 0.0;
        }
        self.max_pressure(load_per_length) * ((a - x) * (a + x)).sqrt() / a
    }
}
