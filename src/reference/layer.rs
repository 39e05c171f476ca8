//! One elastic layer: what a wave of pressure displaces, and thin layers under spheres and punches.

use std::f64::consts::PI;

use crate::{Error, plane_strain_modulus};

/// Displacement over pressure Ĉ(q) \[m/Pa\] of a wave of wave number `q` \[rad/m\] on a layer (E₁, ν₁, h) bonded to an
/// elastic half-space (E₂, ν₂), or to a rigid base (`None`), without friction.
///
/// Nogi and Kato's formula, see [`LayeredBody`](crate::kernel::LayeredBody), with differences of like numbers taken
/// before they are evaluated: with x = q h, u = 1 − Λ and w = 1 − κ
///
/// ```math
/// \hat C = \frac{1 - \nu_1}{G_1 q}\, \frac
///     {2 (\sinh 2x - 2x) + 4x (1 + \kappa) + (1 - \Lambda \kappa)\, e^{-2x}}
///     {4 (\sinh^2 x - x^2) + 4 w x^2 + (u + w) (1 - e^{-2x}) + u w\, e^{-2x}} .
/// ```
///
/// T. Nogi and T. Kato, J. Tribol. 119 (1997) 493; R. H. Bentall and K. L. Johnson, Int. J. Mech. Sci. 10 (1968) 637.
///
/// # Errors
///
/// [`Error::NotPositive`] for a modulus, the thickness or the wave number; [`Error::OutOfRange`] for a Poisson's ratio.
pub fn layer_compliance(
    q: f64,
    (youngs_modulus, poissons_ratio, thickness): (f64, f64, f64),
    half_space: Option<(f64, f64)>,
) -> Result<f64, Error> {
    let e_star = plane_strain_modulus(youngs_modulus, poissons_ratio)?;
    let q = Error::require_positive("wave number", q)?;
    let x = q * Error::require_positive("thickness of a layer", thickness)?;
    let alone = 2.0 / (e_star * q);
    let shear = |youngs_modulus: f64, nu: f64| youngs_modulus / (2.0 * (1.0 + nu));
    let (m, below) = match half_space {
        Some((other, nu)) => {
            plane_strain_modulus(other, nu)?;
            (shear(youngs_modulus, poissons_ratio) / shear(other, nu), 3.0 - 4.0 * nu)
        }
        None => (0.0, 1.0),
    };
    if x > 300.0 {
        return Ok(alone);
    }
    let own = 3.0 - 4.0 * poissons_ratio;
    let (first, second) = (1.0 + m * below, m + own);
    let (u, w) = ((1.0 + own) / first, (1.0 + own) / second);
    let one_less_product = m * (1.0 + own) * (1.0 + below) / (first * second);
    let one_more_kappa = (2.0 * m + 2.0 - 4.0 * poissons_ratio) / second;
    let fades = (-2.0 * x).exp();
    let odd = sinh_less(2.0 * x);
    let even = cosh_less(2.0 * x);
    let above = 2.0 * odd + 4.0 * x * one_more_kappa + one_less_product * fades;
    let beneath = 2.0 * even + 4.0 * w * x * x - (u + w) * (-2.0 * x).exp_m1() + u * w * fades;
    Ok(alone * above / beneath)
}

/// sinh y − y.
fn sinh_less(y: f64) -> f64 {
    if y > 2.0 { y.sinh() - y } else { series(y * y * y / 6.0, y, 3.0) }
}

/// cosh y − 1 − y²/2.
fn cosh_less(y: f64) -> f64 {
    if y > 2.0 { y.cosh() - 1.0 - 0.5 * y * y } else { series(y.powi(4) / 24.0, y, 4.0) }
}

/// The rest of an exponential series of every other power from the term y^k / k! on.
fn series(mut term: f64, y: f64, mut k: f64) -> f64 {
    let mut sum = 0.0;
    while term > 1e-18 * sum {
        sum += term;
        term *= y * y / ((k + 1.0) * (k + 2.0));
        k += 2.0;
    }
    sum
}

/// A layer that is thin beside the contact, bonded to a rigid base, without friction.
///
/// A compressible layer answers as a mattress, u = h p / M with the confined modulus M = E (1 − ν) / ((1 + ν)(1 − 2ν)).
/// An incompressible one, ν = ½, flows like a film, u = −h³ ∇²p / E. Errors of the load are of the order (h/a)² under a
/// sphere with the contact radius a, and h/a under a punch of that radius. They are greater for ν near ½.
///
/// K. L. Johnson, *Contact Mechanics*, §5.8; M. J. Jaffar, Int. J. Mech. Sci. 31 (1989) 229.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThinLayer {
    youngs_modulus: f64,
    poissons_ratio: f64,
    thickness: f64,
}

impl ThinLayer {
    /// A layer of this Young's modulus \[Pa\], Poisson's ratio and thickness \[m\].
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for modulus or thickness; [`Error::OutOfRange`] for Poisson's ratio.
    pub fn new(youngs_modulus: f64, poissons_ratio: f64, thickness: f64) -> Result<Self, Error> {
        plane_strain_modulus(youngs_modulus, poissons_ratio)?;
        let thickness = Error::require_positive("thickness of a layer", thickness)?;
        Ok(Self { youngs_modulus, poissons_ratio, thickness })
    }

    /// Whether Poisson's ratio is ½.
    #[must_use]
    pub fn is_incompressible(&self) -> bool {
        self.poissons_ratio == 0.5
    }

    /// Pressure over displacement of a wide uniform pressure, M / h \[Pa/m\]; infinite if incompressible.
    #[must_use]
    pub fn foundation_modulus(&self) -> f64 {
        let nu = self.poissons_ratio;
        self.youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu) * self.thickness)
    }

    /// Approach under a sphere of radius R = `radius` \[m\] with a contact of radius a: a²/(2R), and a²/(4R) if
    /// incompressible.
    #[must_use]
    pub fn sphere_approach(&self, radius: f64, contact_radius: f64) -> f64 {
        let depth = contact_radius * contact_radius / (2.0 * radius);
        if self.is_incompressible() { 0.5 * depth } else { depth }
    }

    /// Load on that sphere \[N\]: π M a⁴ / (4 R h), and π E a⁶ / (96 R h³) if incompressible.
    #[must_use]
    pub fn sphere_load(&self, radius: f64, contact_radius: f64) -> f64 {
        let square = contact_radius * contact_radius;
        if self.is_incompressible() {
            PI * self.youngs_modulus * square.powi(3) / (96.0 * radius * self.thickness.powi(3))
        } else {
            PI * self.foundation_modulus() * square * square / (4.0 * radius)
        }
    }

    /// Pressure under it \[Pa\] at the distance `r` from the axis: M (a² − r²) / (2 R h), and E (a² − r²)² / (32 R h³)
    /// if incompressible.
    #[must_use]
    pub fn sphere_pressure(&self, radius: f64, contact_radius: f64, r: f64) -> f64 {
        let inside = (contact_radius * contact_radius - r * r).max(0.0);
        if self.is_incompressible() {
            self.youngs_modulus * inside * inside / (32.0 * radius * self.thickness.powi(3))
        } else {
            self.foundation_modulus() * inside / (2.0 * radius)
        }
    }

    /// Stiffness of a flat punch of radius a = `radius` \[N/m\]: π a² M / h, and π E a⁴ / (8 h³) if incompressible.
    #[must_use]
    pub fn punch_stiffness(&self, radius: f64) -> f64 {
        let square = radius * radius;
        if self.is_incompressible() {
            PI * self.youngs_modulus * square * square / (8.0 * self.thickness.powi(3))
        } else {
            PI * square * self.foundation_modulus()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The formula as it is printed, where nothing cancels in it.
    #[test]
    fn the_formula_is_that_of_nogi_and_kato() -> Result<(), Error> {
        for (m, nu1, nu2) in [(0.2, 0.1, 0.4), (7.0, 0.45, 0.0), (1.0, 0.3, 0.3), (1.0, -0.2, 0.5)]
        {
            for x in [0.3_f64, 1.0, 4.0] {
                let (g2, h) = (3.0, 0.7);
                let (g1, q) = (m * g2, x / h);
                let theta = (-2.0 * x).exp();
                let kappa = (m - 1.0) / (m + 3.0 - 4.0 * nu1);
                let lambda = 1.0 - 4.0 * (1.0 - nu1) / (1.0 + m * (3.0 - 4.0 * nu2));
                let above = 1.0 + 4.0 * x * kappa * theta - lambda * kappa * theta * theta;
                let below = 1.0 - (lambda + kappa + 4.0 * kappa * x * x) * theta
                    + lambda * kappa * theta * theta;
                let expected = (1.0 - nu1) / (g1 * q) * above / below;
                let youngs_modulus = |g: f64, nu: f64| 2.0 * g * (1.0 + nu);
                let found = layer_compliance(
                    q,
                    (youngs_modulus(g1, nu1), nu1, h),
                    Some((youngs_modulus(g2, nu2), nu2)),
                )?;
                // Some twenty roundings of numbers near 1.
                assert!((found / expected - 1.0).abs() < 1e-14, "{m} {x}: {found} {expected}");
            }
        }
        Ok(())
    }

    /// Bentall and Johnson's, and the film h³ q² / E at ν = ½, to the next order (q h)².
    #[test]
    fn a_rigid_base_is_the_limit() -> Result<(), Error> {
        let (youngs_modulus, h) = (2.0, 0.1);
        for x in [1e-5_f64, 0.5, 3.0] {
            for nu in [0.0, 0.3, 0.5] {
                let kappa = 3.0 - 4.0 * nu;
                let above = 2.0 * kappa * (2.0 * x).sinh() - 4.0 * x;
                let below = 2.0 * kappa * (2.0 * x).cosh() + 4.0 * x * x + kappa * kappa + 1.0;
                let expected = 2.0 * (1.0 - nu * nu) * h / (youngs_modulus * x) * above / below;
                let found = layer_compliance(x / h, (youngs_modulus, nu, h), None)?;
                if nu < 0.5 || x > 0.1 {
                    // At ν = ½ and x = ½ a digit cancels in the first.
                    assert!((found / expected - 1.0).abs() < 2e-14, "{nu} {x}");
                } else {
                    let film = h * x * x / youngs_modulus;
                    assert!((found / film - 1.0).abs() < 2.0 * x * x, "{x}: {found} {film}");
                }
            }
        }
        Ok(())
    }

    /// Loads are integrals of pressures, and the approach is where they come from: dW = (area of the punch of the
    /// contact's outline) stiffness × dδ.
    #[test]
    fn spheres_on_thin_layers_are_consistent() -> Result<(), Error> {
        for nu in [0.3, 0.5] {
            let layer = ThinLayer::new(5.0, nu, 0.1)?;
            let (radius, a) = (30.0, 2.0);
            let steps = 4000;
            let rings = (0..steps).map(|k| {
                let r = a * (f64::from(k) + 0.5) / f64::from(steps);
                layer.sphere_pressure(radius, a, r) * 2.0 * PI * r * a / f64::from(steps)
            });
            let load: f64 = rings.sum();
            // The midpoint rule errs by 1 / steps².
            assert!((load / layer.sphere_load(radius, a) - 1.0).abs() < 1e-6);
            let step = 1e-5;
            let slope = (layer.sphere_load(radius, a + step) - layer.sphere_load(radius, a - step))
                / (layer.sphere_approach(radius, a + step)
                    - layer.sphere_approach(radius, a - step));
            // Central differences.
            assert!((slope / layer.punch_stiffness(a) - 1.0).abs() < 1e-8, "{nu}: {slope}");
        }
        assert!(ThinLayer::new(1.0, 0.6, 1.0).is_err());
        assert!(ThinLayer::new(1.0, 0.3, 0.0).is_err());
        Ok(())
    }
}
