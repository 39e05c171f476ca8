//! Sphere on a half-space (Hertz).

use super::positive_part;
use std::f64::consts::PI;

closed_form! {
    /// Hertz contact of a sphere of radius `R`, that is of the paraboloid $`g(r) = r^2/(2R)`$.
    ///
    /// Johnson, *Contact Mechanics*, §3.4 and §4.2.
    HertzSphere;

    /// A sphere of radius `radius` \[m\] on a half-space of modulus `e_star` \[Pa\].
    new;

    /// Radius of curvature \[m\].
    radius: "radius"
}

impl HertzSphere {
    /// Contact radius $`a = \sqrt{R\delta}`$ \[m\].
    #[must_use]
    pub fn contact_radius(&self, approach: f64) -> f64 {
        (self.radius * positive_part(approach)).sqrt()
    }

    /// Contact area `π R δ` \[m²\].
    #[must_use]
    pub fn contact_area(&self, approach: f64) -> f64 {
        PI * self.radius * positive_part(approach)
    }

    /// Load $`W = \frac43 E^\ast \sqrt{R} \delta^{3/2}`$ \[N\].
    #[must_use]
    pub fn load(&self, approach: f64) -> f64 {
        4.0 / 3.0 * self.e_star * self.contact_radius(approach) * positive_part(approach)
    }

    /// Approach under a load, `δ = a²/R` with $`a^3 = 3WR/(4E^\ast)`$ \[m\].
    #[must_use]
    pub fn approach_at_load(&self, load: f64) -> f64 {
        let a = (0.75 * positive_part(load) / self.e_star * self.radius).cbrt();
        a * a / self.radius
    }

    /// Pressure at the centre, $`p_0 = \frac{2E^\ast}{\pi} \sqrt{\delta/R}`$ \[Pa\].
    #[must_use]
    pub fn max_pressure(&self, approach: f64) -> f64 {
        2.0 / PI * self.e_star * (positive_part(approach) / self.radius).sqrt()
    }

    /// Mean pressure over the contact, $`\frac23 p_0`$ \[Pa\].
    #[must_use]
    pub fn mean_pressure(&self, approach: f64) -> f64 {
        2.0 / 3.0 * self.max_pressure(approach)
    }

    /// Contact stiffness `dW/dδ = 2E* a` \[N/m\].
    #[must_use]
    pub fn contact_stiffness(&self, approach: f64) -> f64 {
        2.0 * self.e_star * self.contact_radius(approach)
    }

    /// Elastic energy $`U = \frac{8}{15} E^\ast \sqrt{R} \delta^{5/2}`$ \[J\].
    #[must_use]
    pub fn energy(&self, approach: f64) -> f64 {
        0.4 * self.load(approach) * positive_part(approach)
    }

    /// Pressure at distance `r` from the centre, $`p_0 \sqrt{1 - r^2/a^2}`$ \[Pa\].
    #[must_use]
    pub fn pressure(&self, r: f64, approach: f64) -> f64 {
        let (r, a) = (r.abs(), self.contact_radius(approach));
        if r >= a {
            return 0.0;
        }
        self.max_pressure(approach) * ((a - r) * (a + r)).sqrt() / a
    }

    /// Displacement of the surface at distance `r` from the centre \[m\].
    ///
    /// Inside the contact $`\delta - r^2/(2R)`$; outside
    /// $`\frac{1}{\pi R} \left( (2a^2 - r^2) \arcsin\frac{a}{r} + a \sqrt{r^2 - a^2} \right)`$,
    /// which tends to that of a point load, $`W / (\pi E^\ast r)`$.
    #[must_use]
    pub fn displacement(&self, r: f64, approach: f64) -> f64 {
        let (r, approach) = (r.abs(), positive_part(approach));
        let a = self.contact_radius(approach);
        if r <= a {
            return approach - 0.5 * r * r / self.radius;
        }
        approach / PI * outside(a / r)
    }
}

/// π u/δ outside the contact, for s = a/r < 1:
/// ((2s² − 1) arcsin s + s √(1 − s²))/s² = 4/s² ∫₀ˢ t arcsin t dt.
fn outside(s: f64) -> f64 {
    let square = s * s;
    if s > 0.5 {
        let root = ((1.0 - s) * (1.0 + s)).sqrt();
        return ((2.0 * square - 1.0) * s.asin() + s * root) / square;
    }
    // The two terms cancel as s falls, so integrate the series of the arcsine. Its terms fall by
    // s² ≤ 1/4, and 26 of them reach 4^-26 = 2e-16.
    let mut power = 4.0 * s;
    let mut sum = 0.0;
    for k in 0..26 {
        let odd = f64::from(2 * k + 1);
        sum += power / (odd * (odd + 2.0));
        power *= square * odd / (odd + 1.0);
    }
    sum
}
