//! A wave in two directions on a half-space (Johnson, Greenwood & Higginson).

use super::positive_part;
use std::f64::consts::{PI, SQRT_2};

closed_form! {
    /// Contact of the surface $`g(x,y) = D (1 - \cos\frac{2\pi x}{\lambda} \cos\frac{2\pi y}{\lambda})`$.
    ///
    /// It is a [`BiWave`](crate::surface::BiWave) of two equal wavelengths. Two crests and two valleys lie in each square `λ²`. Between its two limits this problem has no
    /// closed form; the methods name the limit they hold in. `P = p̄/p*`.
    ///
    /// Johnson, Greenwood & Higginson, Int. J. Mech. Sci. 27 (1985) 383; Johnson, *Contact Mechanics*,
    /// §13.2.
    DoubleWave;

    /// A wave of amplitude `amplitude` \[m\] and wavelength `wavelength` \[m\], the same along x and y,
    /// on a half-space of modulus `e_star` \[Pa\].
    new;

    /// Amplitude `D` \[m\].
    amplitude: "amplitude",
    /// Wavelength `λ` \[m\].
    wavelength: "wavelength"
}

impl DoubleWave {
    /// Mean pressure of complete contact, $`p^\ast = \sqrt2 \pi E^\ast D/\lambda`$ \[Pa\].
    #[must_use]
    pub fn full_contact_pressure(&self) -> f64 {
        SQRT_2 * PI * self.e_star * self.amplitude / self.wavelength
    }

    /// P, from 0 to 1.
    fn ratio(&self, mean_pressure: f64) -> f64 {
        let ratio = positive_part(mean_pressure) / self.full_contact_pressure();
        if ratio > 1.0 { 1.0 } else { ratio }
    }

    /// Contact area over nominal area as `P → 0`, $`\pi (3P/8\pi)^{2/3}`$: each crest is a Hertz
    /// contact by itself.
    ///
    /// Only the limit is right; at `P = 1` this expression gives 0.76.
    #[must_use]
    pub fn contact_area_fraction_light(&self, mean_pressure: f64) -> f64 {
        let root = (3.0 / (8.0 * PI) * self.ratio(mean_pressure)).cbrt();
        PI * root * root
    }

    /// Contact area over nominal area as `P → 1`, $`1 - \frac{3}{2\pi} (1 - P)`$: the gap in each
    /// valley is a circular crack by itself, open just so far that no tension is left at its edge.
    ///
    /// Only the limit is right; at `P = 0` this expression gives 0.52.
    #[must_use]
    pub fn contact_area_fraction_heavy(&self, mean_pressure: f64) -> f64 {
        1.0 - 1.5 / PI * (1.0 - self.ratio(mean_pressure))
    }
}
