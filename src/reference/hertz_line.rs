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

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate;
    use super::*;
    use crate::Error;
    use approx::assert_relative_eq;

    const LOADS: [f64; 3] = [1e-3, 250.0, 4e6];

    fn line() -> Result<HertzLine, Error> {
        HertzLine::new(0.02, 115e9)
    }

    #[test]
    fn pressure_adds_up_to_the_load() -> Result<(), Error> {
        let line = line()?;
        for load in LOADS {
            let a = line.half_width(load);
            let sum = integrate(|x| line.pressure(x, load), -a, a);
            // Accuracy of the quadrature.
            assert_relative_eq!(sum, load, max_relative = 1e-12);
            let mean = load / (2.0 * a);
            assert_relative_eq!(mean, line.mean_pressure(load), max_relative = 1e-14);
            assert_relative_eq!(line.load_at_half_width(a), load, max_relative = 1e-14);
            assert_eq!(line.pressure(0.0, load), line.max_pressure(load));
            assert_eq!(line.pressure(a, load), 0.0);
            assert_eq!(line.pressure(2.0 * a, load), 0.0);
        }
        Ok(())
    }

    /// Relative to the centre, the line loads −(2/πE*) p ln|x − s| must bend the surface to the
    /// cylinder inside the contact and leave it clear of the cylinder outside.
    #[test]
    fn displacement_of_the_pressure_fits_the_cylinder() -> Result<(), Error> {
        let line = line()?;
        let load = 250.0;
        let a = line.half_width(load);
        let logarithmic = |x: f64| {
            // Both sides from x, so that the singular point is an end of the quadrature.
            let left = |t: f64| line.pressure(x - t, load) * (t / a).ln();
            let right = |t: f64| line.pressure(x + t, load) * (t / a).ln();
            let near = (x - a).max(0.0);
            let sum = integrate(left, near, x + a) + integrate(right, 0.0, (a - x).max(0.0));
            -2.0 / (PI * line.e_star()) * sum
        };
        let center = logarithmic(0.0);
        let depth = 0.5 * a * a / line.radius();
        for ratio in [0.1, 0.5, 0.9, 1.0] {
            let bent = logarithmic(ratio * a) - center;
            // Accuracy of the quadrature, in units of the depth of the contact.
            assert_relative_eq!(bent / depth, -ratio * ratio, max_relative = 1e-11);
        }
        for ratio in [1.1, 2.0, 10.0] {
            let bent = logarithmic(ratio * a) - center;
            assert!(bent / depth > -ratio * ratio);
        }
        Ok(())
    }

    #[test]
    fn no_load_no_contact() -> Result<(), Error> {
        let line = line()?;
        for load in [0.0, -1.0] {
            for value in [
                line.half_width(load),
                line.load_at_half_width(load),
                line.max_pressure(load),
                line.mean_pressure(load),
                line.pressure(0.0, load),
            ] {
                assert_eq!(value, 0.0);
            }
        }
        Ok(())
    }

    #[test]
    fn impossible_cylinders_are_refused() {
        for (radius, e_star) in [(0.0, 1.0), (1.0, f64::NAN)] {
            assert!(matches!(HertzLine::new(radius, e_star), Err(Error::NotPositive { .. })));
        }
    }
}
