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
        // r − √(r² − a²) without its cancellation far away.
        let rest = a * (a / (r + ((r - a) * (r + a)).sqrt()));
        self.slope * (a * (a / r).asin() - rest)
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::{derivative, integrate, ring_displacement};
    use super::*;
    use crate::Error;
    use approx::assert_relative_eq;

    const APPROACHES: [f64; 3] = [1e-9, 2.3e-6, 1e-3];

    fn cone() -> Result<Cone, Error> {
        Cone::new(0.07, 64e9)
    }

    #[test]
    fn pressure_adds_up_to_load_and_its_mean() -> Result<(), Error> {
        let cone = cone()?;
        for d in APPROACHES {
            let a = cone.contact_radius(d);
            let load = integrate(|r| 2.0 * PI * r * cone.pressure(r, d), 0.0, a);
            // Accuracy of the quadrature.
            assert_relative_eq!(load, cone.load(d), max_relative = 1e-12);
            let mean = cone.load(d) / cone.contact_area(d);
            assert_relative_eq!(mean, cone.mean_pressure(), max_relative = 1e-14);
        }
        Ok(())
    }

    #[test]
    fn load_is_the_slope_of_energy_and_stiffness_that_of_load() -> Result<(), Error> {
        let cone = cone()?;
        for d in APPROACHES {
            let work = integrate(|x| cone.load(x), 0.0, d);
            assert_relative_eq!(work, cone.energy(d), max_relative = 1e-13);
            let slope = derivative(|x| cone.load(x), d);
            // Stated error of the difference formula, with a margin of ten.
            assert_relative_eq!(slope, cone.contact_stiffness(d), max_relative = 2e-12);
            let back = cone.approach_at_load(cone.load(d));
            assert_relative_eq!(back, d, max_relative = 1e-15);
        }
        Ok(())
    }

    #[test]
    fn displacement_is_that_of_the_pressure() -> Result<(), Error> {
        let cone = cone()?;
        let d = 2.3e-6;
        let a = cone.contact_radius(d);
        // At the apex every ring of load lies at its own radius.
        let apex = 2.0 / cone.e_star() * integrate(|r| cone.pressure(r, d), 0.0, a);
        assert_relative_eq!(apex, cone.displacement(0.0, d), max_relative = 1e-12);
        for ratio in [1.2, 2.0, 5.0, 40.0] {
            let r = ratio * a;
            let rings = ring_displacement(|s| cone.pressure(s, d), a, r, cone.e_star());
            // Accuracy of the quadrature, whose integrand is nearly singular close to the edge.
            assert_relative_eq!(rings, cone.displacement(r, d), max_relative = 1e-12);
            assert!(cone.displacement(r, d) + cone.slope() * r > d);
        }
        // Far away, a point load: the next term is of order (a/r)² = 1e-16.
        let r = 1e8 * a;
        let point = cone.load(d) / (PI * cone.e_star() * r);
        assert_relative_eq!(cone.displacement(r, d), point, max_relative = 1e-15);
        Ok(())
    }

    #[test]
    fn edge_and_apex() -> Result<(), Error> {
        let cone = cone()?;
        let d = 1e-6;
        let a = cone.contact_radius(d);
        assert_eq!(cone.pressure(a, d), 0.0);
        assert_eq!(cone.pressure(0.0, d), f64::INFINITY);
        // The slope of the surface is continuous at the edge, so one rounding of r is one of u.
        let beyond = cone.displacement(a * (1.0 + 1e-15), d);
        assert_relative_eq!(cone.displacement(a, d), beyond, max_relative = 1e-14);
        Ok(())
    }

    #[test]
    fn no_approach_no_contact() -> Result<(), Error> {
        let cone = cone()?;
        for d in [0.0, -1e-6] {
            for value in [
                cone.contact_radius(d),
                cone.contact_area(d),
                cone.load(d),
                cone.approach_at_load(d),
                cone.contact_stiffness(d),
                cone.energy(d),
                cone.pressure(0.0, d),
                cone.displacement(0.0, d),
                cone.displacement(1e-3, d),
            ] {
                assert_eq!(value, 0.0);
            }
        }
        Ok(())
    }

    #[test]
    fn impossible_cones_are_refused() {
        for (slope, e_star) in [(0.0, 1.0), (1.0, f64::NAN)] {
            assert!(matches!(Cone::new(slope, e_star), Err(Error::NotPositive { .. })));
        }
    }
}
