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

#[cfg(test)]
mod tests {
    use super::super::HertzSphere;
    use super::super::quadrature::{integrate, ring_displacement};
    use super::*;
    use crate::Error;
    use approx::assert_relative_eq;

    fn punch() -> Result<CircularPunch, Error> {
        CircularPunch::new(0.003, 50e9)
    }

    #[test]
    fn pressure_adds_up_to_load_and_its_mean() -> Result<(), Error> {
        let punch = punch()?;
        let d = 1e-6;
        let a = punch.radius();
        // Up to the infinite edge the quadrature is good to √ε; short of it, where the disc of
        // radius ca carries 1 − √(1 − c²) of the load, to rounding.
        for (c, tolerance) in [(0.3_f64, 1e-12), (0.9, 1e-12), (1.0, 1e-7)] {
            let inner = integrate(|r| 2.0 * PI * r * punch.pressure(r, d), 0.0, c * a);
            let share = 1.0 - (1.0 - c * c).sqrt();
            assert_relative_eq!(inner, share * punch.load(d), max_relative = tolerance);
        }
        let mean = punch.load(d) / punch.contact_area();
        assert_relative_eq!(mean, punch.mean_pressure(d), max_relative = 1e-15);
        let center = punch.pressure(0.0, d);
        assert_relative_eq!(center, 0.5 * mean, max_relative = 1e-15);
        Ok(())
    }

    #[test]
    fn displacement_is_that_of_the_pressure() -> Result<(), Error> {
        let punch = punch()?;
        let d = 1e-6;
        let a = punch.radius();
        for ratio in [1.2, 2.0, 40.0] {
            let r = ratio * a;
            let rings = ring_displacement(|s| punch.pressure(s, d), a, r, punch.e_star());
            // √ε of the quadrature, as above.
            assert_relative_eq!(rings, punch.displacement(r, d), max_relative = 1e-7);
        }
        // Far away, a point load: the next term is (a/r)²/6 = 2e-17.
        let r = 1e8 * a;
        let point = punch.load(d) / (PI * punch.e_star() * r);
        assert_relative_eq!(punch.displacement(r, d), point, max_relative = 1e-15);
        Ok(())
    }

    /// Each step of approach of a round shape is a step of a punch as wide as the contact, so the
    /// fields of the sphere are sums over punches.
    #[test]
    fn a_sphere_is_a_sequence_of_punches() -> Result<(), Error> {
        let sphere = HertzSphere::new(0.01, 50e9)?;
        let d = 1e-6;
        let step = |x: f64| CircularPunch::new(sphere.contact_radius(x), 50e9);
        let sum = |field: &dyn Fn(CircularPunch) -> f64| {
            integrate(|x| step(x).map_or(f64::NAN, field), 0.0, d)
        };
        let far = 1.7 * sphere.contact_radius(d);
        for (punches, whole) in [
            (sum(&|p| p.load(1.0)), sphere.load(d)),
            (sum(&|p| p.pressure(0.0, 1.0)), sphere.max_pressure(d)),
            (sum(&|p| p.displacement(far, 1.0)), sphere.displacement(far, d)),
        ] {
            // Accuracy of the quadrature.
            assert_relative_eq!(punches, whole, max_relative = 1e-12);
        }
        Ok(())
    }

    #[test]
    fn energy_is_work_and_load_inverts() -> Result<(), Error> {
        let punch = punch()?;
        let d = 1e-6;
        let work = integrate(|x| punch.load(x), 0.0, d);
        assert_relative_eq!(work, punch.energy(d), max_relative = 1e-14);
        let back = punch.approach_at_load(punch.load(d));
        assert_relative_eq!(back, d, max_relative = 1e-15);
        Ok(())
    }

    #[test]
    fn edge_and_rest() -> Result<(), Error> {
        let punch = punch()?;
        let a = punch.radius();
        assert_eq!(punch.pressure(a, 1e-6), f64::INFINITY);
        assert_eq!(punch.pressure(1.001 * a, 1e-6), 0.0);
        assert_eq!(punch.displacement(a, 1e-6), 1e-6);
        for d in [0.0, -1e-6] {
            for value in [
                punch.load(d),
                punch.approach_at_load(d),
                punch.mean_pressure(d),
                punch.energy(d),
                punch.pressure(a, d),
                punch.displacement(0.0, d),
                punch.displacement(2.0 * a, d),
            ] {
                assert_eq!(value, 0.0);
            }
        }
        Ok(())
    }

    /// Capacity grows with the body, and of all plates of one area the disc has the least
    /// (Pólya & Szegő 1951).
    #[test]
    fn square_lies_between_the_discs_that_bound_it() -> Result<(), Error> {
        let same_area = CircularPunch::new(1.0 / PI.sqrt(), 1.0)?;
        let around = CircularPunch::new(0.5_f64.sqrt(), 1.0)?;
        assert!(same_area.contact_stiffness() < SQUARE_PUNCH_STIFFNESS);
        assert!(SQUARE_PUNCH_STIFFNESS < around.contact_stiffness());
        Ok(())
    }

    #[test]
    fn impossible_punches_are_refused() {
        for (radius, e_star) in [(0.0, 1.0), (1.0, f64::NAN)] {
            assert!(matches!(CircularPunch::new(radius, e_star), Err(Error::NotPositive { .. })));
        }
    }
}
