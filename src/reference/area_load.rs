//! How the contact area of a rough surface grows with the load.

use std::f64::consts::PI;

use super::positive_part;

closed_form! {
    /// Laws of contact area against load for a randomly rough surface of large nominal area.
    ///
    /// With the root-mean-square gradient $`h' = \sqrt{\langle |\nabla h|^2 \rangle}`$ of the surface (Sdq; of both
    /// directions together, $`\sqrt2`$ times that of a profile) every one of them is a function of
    /// $`\bar p / (E^\ast h')`$ alone, and at light load a straight line of slope `κ`:
    /// ```math
    /// \frac{A}{A_0} = \kappa \frac{\bar p}{E^\ast h'}
    /// ```
    /// The theories are for surfaces without an edge, Gaussian and isotropic.
    AreaLoadLaw;

    /// The laws for a surface of root-mean-square gradient `rms_gradient` on a half-space of modulus
    /// `e_star` \[Pa\].
    new;

    /// Root-mean-square gradient.
    rms_gradient: "root-mean-square gradient"
}

impl AreaLoadLaw {
    /// $`\kappa = \sqrt{2\pi}`$ of the asperity theory of Bush, Gibson & Thomas, Wear 35 (1975) 87.
    pub const BUSH_GIBSON_THOMAS: f64 = 2.506_628_274_631_000_7;

    /// $`\kappa = \sqrt{8/\pi}`$ of Persson's theory at light load, J. Chem. Phys. 115 (2001) 3840.
    pub const PERSSON: f64 = 1.595_769_121_605_731;

    /// `κ = 2`: finite-element results of Hyun, Pei, Molinari & Robbins, Phys. Rev. E 70 (2004)
    /// 026117, rounded as in Zhang, Zhang & Jin, Friction 8 (2020) 970.
    pub const HYUN: f64 = 2.0;

    /// p̄/E*h′, not negative.
    fn reduced(&self, mean_pressure: f64) -> f64 {
        positive_part(mean_pressure) / (self.e_star * self.rms_gradient)
    }

    /// Contact area over nominal area, $`\kappa \bar p / (E^\ast h')`$, but at most 1.
    ///
    /// `kappa` is one of the constants of this type or a number of the caller's. The line is meant
    /// for light loads, `A/A₀` up to about 0.1.
    #[must_use]
    pub fn proportional(&self, kappa: f64, mean_pressure: f64) -> f64 {
        let fraction = positive_part(kappa) * self.reduced(mean_pressure);
        if fraction > 1.0 { 1.0 } else { fraction }
    }

    /// Contact area over nominal area at any load, Persson's
    /// $`\operatorname{erf}(\sqrt2 \bar p / (E^\ast h'))`$.
    ///
    /// Persson, J. Chem. Phys. 115 (2001) 3840, in the form of Manners & Greenwood, Wear 261 (2006) 600.
    #[must_use]
    pub fn persson(&self, mean_pressure: f64) -> f64 {
        libm::erf(std::f64::consts::SQRT_2 * self.reduced(mean_pressure))
    }

    /// Root mean square of the pressure about its mean in full contact, $`\sqrt V = \frac12 E^\ast h'`$ \[Pa\].
    ///
    /// A wave of amplitude a and wave number q is closed by a wave of pressure of amplitude ½ E\* q a, and
    /// q a is the amplitude of its gradient.
    #[must_use]
    pub fn full_contact_deviation(&self) -> f64 {
        0.5 * self.e_star * self.rms_gradient
    }

    /// Density of the pressure over the nominal area \[1/Pa\] in Persson's theory, for p ≥ 0 \[Pa\]:
    /// ```math
    /// P(p) = \frac{1}{\sqrt{2\pi V}} \left[ \exp\left(-\frac{(p - \bar p)^2}{2V}\right)
    ///     - \exp\left(-\frac{(p + \bar p)^2}{2V}\right) \right], \qquad
    /// V = \frac14 (E^\ast h')^2
    /// ```
    /// Its integral is the contact area fraction [`persson`](Self::persson), and that of `p P(p)` the mean
    /// pressure. Divided by the fraction it is the density over the contact.
    ///
    /// Persson, J. Chem. Phys. 115 (2001) 3840; the mirror image keeps P(0) = 0: Manners & Greenwood, Wear 261 (2006)
    /// 600.
    #[must_use]
    pub fn persson_density(&self, pressure: f64, mean_pressure: f64) -> f64 {
        let deviation = self.full_contact_deviation();
        if pressure < 0.0 {
            return 0.0;
        }
        let (p, mean) = (pressure / deviation, positive_part(mean_pressure) / deviation);
        // The ratio of the two exponentials is exp(−2 p p̄ / V): no digit is lost where they almost cancel.
        let gauss = libm::exp(-0.5 * (p - mean) * (p - mean));
        gauss * -libm::expm1(-2.0 * p * mean) / ((2.0 * PI).sqrt() * deviation)
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate;
    use super::*;
    use crate::Error;
    use approx::assert_relative_eq;

    fn law() -> Result<AreaLoadLaw, Error> {
        AreaLoadLaw::new(0.2, 50e9)
    }

    /// The integral of the density over p > 0 is the area, and its first moment the load: two closed forms that the
    /// density does not use.
    #[test]
    fn perssons_area_is_that_of_his_pressure_distribution() -> Result<(), Error> {
        let law = law()?;
        for mean in [1e3, 1e7, 1e9, 2e10] {
            let density = |p: f64| law.persson_density(p, mean);
            let far = mean + 12.0 * law.full_contact_deviation();
            // The quadrature has a few hundred terms of rounding.
            assert_relative_eq!(
                integrate(density, 0.0, far),
                law.persson(mean),
                max_relative = 1e-12
            );
            let load = integrate(|p| p * density(p), 0.0, far);
            assert_relative_eq!(load, mean, max_relative = 1e-12);
        }
        Ok(())
    }

    /// Against the difference of two Gaussians as it is written, which loses digits by cancellation: where the
    /// smaller is below half of the larger, no more than a factor of three.
    #[test]
    fn perssons_density_is_a_gaussian_less_its_image() -> Result<(), Error> {
        let law = law()?;
        let deviation = law.full_contact_deviation();
        for mean in [0.5, 1.0, 3.0] {
            for p in [0.7, 1.0, 2.0, 5.0] {
                let gauss = |z: f64| (-0.5 * z * z).exp() / (2.0 * PI).sqrt() / deviation;
                let expected = gauss(p - mean) - gauss(p + mean);
                let found = law.persson_density(p * deviation, mean * deviation);
                // Arguments of up to 32 in the exponential carry as many roundings.
                assert_relative_eq!(found, expected, max_relative = 1e-13);
            }
        }
        assert_eq!(law.persson_density(0.0, 1e9), 0.0);
        assert_eq!(law.persson_density(-1.0, 1e9), 0.0);
        assert_eq!(law.persson_density(1e9, 0.0), 0.0);
        assert_eq!(law.persson_density(1e9, -1.0), 0.0);
        assert!(law.persson_density(1e9, f64::NAN).is_nan());
        assert!(law.persson_density(f64::NAN, 1e9).is_nan());
        Ok(())
    }

    #[test]
    fn perssons_curve_starts_along_his_line_and_ends_at_one() -> Result<(), Error> {
        let law = law()?;
        // erf x departs from its tangent by x²/3, here 7e-13.
        let light = 1e4;
        let line = law.proportional(AreaLoadLaw::PERSSON, light);
        assert_relative_eq!(law.persson(light), line, max_relative = 1e-12);
        for mean in [1e8, 1e9, 1e10] {
            assert!(law.persson(mean) < law.proportional(AreaLoadLaw::PERSSON, mean));
        }
        assert_eq!(law.persson(1e12), 1.0);
        assert_eq!(law.proportional(AreaLoadLaw::HYUN, 1e12), 1.0);
        Ok(())
    }

    #[test]
    fn slopes_are_what_their_formulas_say() {
        // The constants are rounded once, the roots of a rounded π twice.
        assert_relative_eq!(
            AreaLoadLaw::BUSH_GIBSON_THOMAS,
            (2.0 * PI).sqrt(),
            max_relative = 4e-16
        );
        assert_relative_eq!(AreaLoadLaw::PERSSON, (8.0 / PI).sqrt(), max_relative = 4e-16);
        // The asperity theory gives π/2 times the area of Persson's.
        assert_relative_eq!(
            AreaLoadLaw::BUSH_GIBSON_THOMAS / AreaLoadLaw::PERSSON,
            0.5 * PI,
            max_relative = 1e-15
        );
    }

    #[test]
    fn no_load_no_contact() -> Result<(), Error> {
        let law = law()?;
        for mean in [0.0, -1.0] {
            assert_eq!(law.persson(mean), 0.0);
            assert_eq!(law.proportional(AreaLoadLaw::HYUN, mean), 0.0);
        }
        assert!(law.persson(f64::NAN).is_nan());
        Ok(())
    }

    /// Gradient and modulus are kept, and not exchanged.
    #[test]
    fn a_law_says_what_it_is_for() -> Result<(), Error> {
        let law = law()?;
        assert_eq!((law.rms_gradient(), law.e_star()), (0.2, 50e9));
        Ok(())
    }

    #[test]
    fn impossible_surfaces_are_refused() {
        for (gradient, e_star) in [(0.0, 1.0), (1.0, f64::NAN)] {
            assert!(matches!(AreaLoadLaw::new(gradient, e_star), Err(Error::NotPositive { .. })));
        }
    }
}
