//! Flat punches on a half-space.

use super::positive_part;
use std::f64::consts::PI;

/// Contact stiffness of a rigid square punch of side `L`, divided by `E* L`.
///
/// `K = 1.152297 E* L`: in the units where a disc of radius `a` has the electrostatic capacity
/// `2a/π`, the stiffness of a punch is `π E*` times the capacity of its face, and that of the
/// unit square is 0.3667874. No closed form is known; the digits of the capacity are right, to within one
/// unit of the last. This is where the stiffness of *any* surface on a square nominal
/// area ends when contact is complete.
pub const SQUARE_PUNCH_STIFFNESS: f64 = PI * 0.366_787_4;

closed_form! {
    /// Contact of a rigid cylinder's flat end of radius `a`.
    ///
    /// The contact is complete from first touch on, and everything is proportional to the approach.
    ///
    /// Johnson, *Contact Mechanics*, §3.6 and §5.1.
    CircularPunch;

    /// A punch of radius `radius` \[m\] on a half-space of modulus `e_star` \[Pa\].
    new;

    /// Radius of the face \[m\].
    radius: "radius"
}

impl CircularPunch {
    /// Contact area `πa²` \[m²\].
    #[must_use]
    pub fn contact_area(&self) -> f64 {
        PI * self.radius * self.radius
    }

    /// Contact stiffness `dW/dδ = 2 E* a` \[N/m\].
    #[must_use]
    pub fn contact_stiffness(&self) -> f64 {
        2.0 * self.e_star * self.radius
    }

    /// Load `W = 2E* a δ` \[N\].
    #[must_use]
    pub fn load(&self, approach: f64) -> f64 {
        self.contact_stiffness() * positive_part(approach)
    }

    /// Approach under a load, $`W/(2E^\ast a)`$ \[m\].
    #[must_use]
    pub fn approach_at_load(&self, load: f64) -> f64 {
        positive_part(load) / self.contact_stiffness()
    }

    /// Mean pressure over the face, $`2 E^\ast \delta / (\pi a)`$ \[Pa\].
    #[must_use]
    pub fn mean_pressure(&self, approach: f64) -> f64 {
        2.0 / PI * self.e_star * positive_part(approach) / self.radius
    }

    /// Elastic energy `U = E* a δ²` \[J\].
    #[must_use]
    pub fn energy(&self, approach: f64) -> f64 {
        0.5 * self.load(approach) * positive_part(approach)
    }

    /// Pressure at distance `r` from the axis, $`E^\ast \delta / (\pi \sqrt{a^2 - r^2})`$ \[Pa\].
    ///
    /// Infinite on the edge, `r` = `a`, of a loaded punch; least, half the mean, at the centre.
    #[must_use]
    pub fn pressure(&self, r: f64, approach: f64) -> f64 {
        let (r, a, approach) = (r.abs(), self.radius, positive_part(approach));
        if r > a || approach == 0.0 {
            return 0.0;
        }
        self.e_star * approach / (PI * ((a - r) * (a + r)).sqrt())
    }

    /// Displacement of the surface at distance `r` from the axis: `δ` under the punch,
    /// $`\frac{2\delta}{\pi} \arcsin\frac{a}{r}`$ outside \[m\].
    #[must_use]
    pub fn displacement(&self, r: f64, approach: f64) -> f64 {
        let (r, approach) = (r.abs(), positive_part(approach));
        if r <= self.radius {
            return approach;
        }
        2.0 / PI * approach * (self.radius / r).asin()
    }
}
