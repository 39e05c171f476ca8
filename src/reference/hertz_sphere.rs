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

#[cfg(test)]
mod tests {
    use super::super::quadrature::{derivative, integrate, ring_displacement};
    use super::*;
    use crate::Error;
    use approx::assert_relative_eq;

    const APPROACHES: [f64; 3] = [1e-9, 3.7e-6, 1e-3];

    fn sphere() -> Result<HertzSphere, Error> {
        HertzSphere::new(0.013, 77e9)
    }

    #[test]
    fn pressure_adds_up_to_load_and_its_mean() -> Result<(), Error> {
        let sphere = sphere()?;
        for d in APPROACHES {
            let a = sphere.contact_radius(d);
            let load = integrate(|r| 2.0 * PI * r * sphere.pressure(r, d), 0.0, a);
            // Accuracy of the quadrature.
            assert_relative_eq!(load, sphere.load(d), max_relative = 1e-12);
            let mean = sphere.load(d) / sphere.contact_area(d);
            assert_relative_eq!(mean, sphere.mean_pressure(d), max_relative = 1e-14);
            assert_relative_eq!(sphere.contact_area(d), PI * a * a, max_relative = 1e-15);
            assert_eq!(sphere.pressure(0.0, d), sphere.max_pressure(d));
        }
        Ok(())
    }

    #[test]
    fn load_is_the_slope_of_energy_and_stiffness_that_of_load() -> Result<(), Error> {
        let sphere = sphere()?;
        for d in APPROACHES {
            let work = integrate(|x| sphere.load(x), 0.0, d);
            assert_relative_eq!(work, sphere.energy(d), max_relative = 1e-13);
            let slope = derivative(|x| sphere.load(x), d);
            // Stated error of the difference formula, with a margin of ten.
            assert_relative_eq!(slope, sphere.contact_stiffness(d), max_relative = 2e-12);
            let back = sphere.approach_at_load(sphere.load(d));
            assert_relative_eq!(back, d, max_relative = 1e-15);
        }
        Ok(())
    }

    #[test]
    fn displacement_is_that_of_the_pressure() -> Result<(), Error> {
        let sphere = sphere()?;
        let d = 3.7e-6;
        let a = sphere.contact_radius(d);
        // At the centre every ring of load lies at its own radius.
        let center = 2.0 / sphere.e_star() * integrate(|r| sphere.pressure(r, d), 0.0, a);
        assert_relative_eq!(center, sphere.displacement(0.0, d), max_relative = 1e-13);
        for ratio in [1.2, 1.9, 2.0, 2.1, 5.0, 40.0] {
            let r = ratio * a;
            let rings = ring_displacement(|s| sphere.pressure(s, d), a, r, sphere.e_star());
            // Accuracy of the quadrature, whose integrand is nearly singular close to the edge.
            assert_relative_eq!(rings, sphere.displacement(r, d), max_relative = 1e-12);
            assert!(sphere.displacement(r, d) + 0.5 * r * r / sphere.radius() > d);
        }
        // Far away, a point load: the next term is 0.1 (a/r)² = 1e-15.
        let r = 1e7 * a;
        let point = sphere.load(d) / (PI * sphere.e_star() * r);
        assert_relative_eq!(sphere.displacement(r, d), point, max_relative = 2e-15);
        Ok(())
    }

    #[test]
    fn both_branches_meet() -> Result<(), Error> {
        let sphere = sphere()?;
        let d = 1e-6;
        let a = sphere.contact_radius(d);
        // Across one rounding of r, at the edge and where the series takes over.
        for r in [a, 2.0 * a] {
            let beyond = sphere.displacement(r * (1.0 + 1e-15), d);
            assert_relative_eq!(sphere.displacement(r, d), beyond, max_relative = 1e-14);
        }
        assert_eq!(sphere.pressure(a, d), 0.0);
        assert_eq!(sphere.displacement(-0.3 * a, d), sphere.displacement(0.3 * a, d));
        Ok(())
    }

    #[test]
    fn no_approach_no_contact() -> Result<(), Error> {
        let sphere = sphere()?;
        for d in [0.0, -1e-6] {
            for value in [
                sphere.contact_radius(d),
                sphere.contact_area(d),
                sphere.load(d),
                sphere.approach_at_load(d),
                sphere.max_pressure(d),
                sphere.mean_pressure(d),
                sphere.contact_stiffness(d),
                sphere.energy(d),
                sphere.pressure(0.0, d),
                sphere.displacement(0.0, d),
                sphere.displacement(1e-3, d),
            ] {
                assert_eq!(value, 0.0);
            }
        }
        assert!(sphere.load(f64::NAN).is_nan());
        Ok(())
    }

    #[test]
    fn impossible_spheres_are_refused() {
        for (radius, e_star) in [(0.0, 1.0), (1.0, -1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
            assert!(matches!(HertzSphere::new(radius, e_star), Err(Error::NotPositive { .. })));
        }
    }
}
