//! Cone on a half-space.

use super::positive_part;
use std::f64::consts::PI;

closed_form! {
    /// Contact of a cone of slope `t`, `g(r) = t r`.
    ///
    /// The contact grows in proportion to the approach, and the mean pressure never changes.
    ///
    /// Love, Q. J. Math. 10 (1939) 161; Johnson, *Contact Mechanics*, §5.2.
    Cone;

    /// A cone whose flanks rise by `slope` (the tangent of their angle with the surface) on a
    /// half-space of modulus `e_star` \[Pa\].
    new;

    /// Slope of the flanks.
    slope: "slope"
}

impl Cone {
    /// Contact radius $`a = 2\delta/(\pi t)`$ \[m\].
    #[must_use]
    pub fn contact_radius(&self, approach: f64) -> f64 {
        2.0 / PI * positive_part(approach) / self.slope
    }

    /// Contact area `πa²` \[m²\].
    #[must_use]
    pub fn contact_area(&self, approach: f64) -> f64 {
        let a = self.contact_radius(approach);
        PI * a * a
    }

    /// Load $`W = 2E^\ast \delta^2/(\pi t)`$ \[N\].
    #[must_use]
    pub fn load(&self, approach: f64) -> f64 {
        self.e_star * self.contact_radius(approach) * positive_part(approach)
    }

    /// Approach under a load, $`\sqrt{\pi t W / (2E^\ast)}`$ \[m\].
    #[must_use]
    pub fn approach_at_load(&self, load: f64) -> f64 {
        (0.5 * PI * self.slope * positive_part(load) / self.e_star).sqrt()
    }

    /// Mean pressure over the contact, `E* t / 2` at any approach \[Pa\].
    #[must_use]
    pub fn mean_pressure(&self) -> f64 {
        0.5 * self.e_star * self.slope
    }

    /// Contact stiffness `dW/dδ = 2 E* a` \[N/m\].
    #[must_use]
    pub fn contact_stiffness(&self, approach: f64) -> f64 {
        2.0 * self.e_star * self.contact_radius(approach)
    }

    /// Elastic energy `U = 2 E* δ³ / (3πt)` \[J\].
    #[must_use]
    pub fn energy(&self, approach: f64) -> f64 {
        self.load(approach) * positive_part(approach) / 3.0
    }

    /// Pressure at distance `r` from the axis, $`\frac12 E^\ast t \operatorname{arcosh}(a/r)`$ \[Pa\].
    ///
    /// Infinite under the apex, `r` = 0, where it grows like a logarithm.
    #[must_use]
    pub fn pressure(&self, r: f64, approach: f64) -> f64 {
        let (r, a) = (r.abs(), self.contact_radius(approach));
        if r >= a {
            return 0.0;
        }
        // arcosh(a/r) = arsinh(√(a² − r²)/r), which keeps its digits at the edge.
        self.mean_pressure() * (((a - r) * (a + r)).sqrt() / r).asinh()
    }

    /// Displacement of the surface at distance `r` from the axis \[m\].
    ///
    /// Inside the contact `δ - t r`; outside
    /// $`t \left( a \arcsin\frac{a}{r} - r + \sqrt{r^2 - a^2} \right)`$.
    #[must_use]
    pub fn displacement(&self, r: f64, approach: f64) -> f64 {
        let (r, a) = (r.abs(), self.contact_radius(approach));
        if r <= a {
            return positive_part(approach) - self.slope * r;
        }
        // r − √(r² − a²) without its cancellation far away. Both terms are functions of one a/r, so that what it has lost
        // at the edge, where either is steep, cancels.
        let sine = a / r;
        let rest = a * (sine / (1.0 + ((1.0 - sine) * (1.0 + sine)).sqrt()));
        self.slope * (a * sine.asin() - rest)
    }
}
