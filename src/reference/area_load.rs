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
