//! A wave in one direction on a half-space (Westergaard).

use super::positive_part;
use std::f64::consts::PI;

closed_form! {
    /// Contact of the wavy surface $`g(x) = D (1 - \cos 2\pi x/\lambda)`$, in plane strain.
    ///
    /// Crests touch at multiples of the wavelength `λ`. Everything is given by the mean pressure
    /// `p̄` over the nominal area, which is in the ratio
    /// $`P = \bar p / p^\ast = \sin^2(\pi a/\lambda)`$ to that of complete contact; `a` is the half-width
    /// of each contact. Beyond complete contact, `P > 1`, the solution goes on: the gap stays closed
    /// and the pressure rises evenly. Amplitude means `D`, half the height from valley to crest.
    ///
    /// Westergaard, J. Appl. Mech. 6 (1939) A49; Johnson, *Contact Mechanics*, §13.2; eq. (21) of Zhang,
    /// Zhang & Jin, Friction 8 (2020) 970, whose `Δ` is this `D` and whose
    /// $`p_0 = p^\ast \sin^2(\pi a/\lambda)`$.
    Westergaard;

    /// A wave of amplitude `amplitude` \[m\] and wavelength `wavelength` \[m\] on a half-space of
    /// modulus `e_star` \[Pa\].
    new;

    /// Amplitude `D` \[m\].
    amplitude: "amplitude",
    /// Wavelength `λ` \[m\].
    wavelength: "wavelength"
}

impl Westergaard {
    /// Mean pressure of complete contact, `p* = π E* D/λ` \[Pa\].
    #[must_use]
    pub fn full_contact_pressure(&self) -> f64 {
        PI * self.e_star * self.amplitude / self.wavelength
    }

    /// P, from 0 to 1.
    fn ratio(&self, mean_pressure: f64) -> f64 {
        let ratio = positive_part(mean_pressure) / self.full_contact_pressure();
        if ratio > 1.0 { 1.0 } else { ratio }
    }

    /// Contact area over nominal area, $`2a/\lambda = \frac{2}{\pi} \arcsin\sqrt{P}`$.
    #[must_use]
    pub fn contact_area_fraction(&self, mean_pressure: f64) -> f64 {
        2.0 / PI * self.ratio(mean_pressure).sqrt().asin()
    }

    /// Half the width of each contact, `a` \[m\]: from 0 to `λ/2`.
    #[must_use]
    pub fn contact_half_width(&self, mean_pressure: f64) -> f64 {
        0.5 * self.wavelength * self.contact_area_fraction(mean_pressure)
    }

    /// Mean pressure for a half-width `a`, $`p^\ast \sin^2(\pi a/\lambda)`$ \[Pa\].
    ///
    /// Half-widths beyond `λ/2` count as that.
    #[must_use]
    pub fn mean_pressure_at_half_width(&self, half_width: f64) -> f64 {
        let fraction = positive_part(half_width) / self.wavelength;
        let sin = if fraction > 0.5 { 1.0 } else { (PI * fraction).sin() };
        self.full_contact_pressure() * sin * sin
    }

    /// |sin| and |cos| of πx/λ, from the distance to the nearest crest.
    fn phase(&self, x: f64) -> (f64, f64) {
        let periods = x / self.wavelength;
        let (sin, cos) = (PI * (periods - periods.round())).sin_cos();
        (sin.abs(), cos.abs())
    }

    /// Pressure at `x` from a crest \[Pa\]:
    /// ```math
    /// p(x) = 2 p^\ast \cos\frac{\pi x}{\lambda}
    ///   \sqrt{\sin^2\frac{\pi a}{\lambda} - \sin^2\frac{\pi x}{\lambda}}
    /// ```
    /// in contact, and beyond complete contact $`\bar p + p^\ast \cos(2\pi x/\lambda)`$.
    #[must_use]
    pub fn pressure(&self, x: f64, mean_pressure: f64) -> f64 {
        let (sin, cos) = self.phase(x);
        let full = self.full_contact_pressure();
        if mean_pressure >= full {
            return mean_pressure - full + 2.0 * full * cos * cos;
        }
        let edge = self.ratio(mean_pressure).sqrt();
        if sin >= edge {
            return 0.0;
        }
        2.0 * full * cos * ((edge - sin) * (edge + sin)).sqrt()
    }

    /// Gap at `x` from a crest \[m\]: with $`\chi^2 = \sin^2(\pi x/\lambda) - P`$,
    /// ```math
    /// 2D \left( \chi \sin\frac{\pi x}{\lambda} -
    ///   P \ln\frac{\sin(\pi x/\lambda) + \chi}{\sqrt{P}} \right)
    /// ```
    /// out of contact, zero in contact.
    #[must_use]
    pub fn gap(&self, x: f64, mean_pressure: f64) -> f64 {
        let (sin, _) = self.phase(x);
        let ratio = self.ratio(mean_pressure);
        let edge = ratio.sqrt();
        if sin <= edge {
            return 0.0;
        }
        let chi = ((sin - edge) * (sin + edge)).sqrt();
        // P ln(…) = P arsinh(χ/√P), which vanishes with P.
        let log = if ratio == 0.0 { 0.0 } else { ratio * (chi / edge).asinh() };
        // The two terms agree to third order at the edge, where rounding may leave either sign.
        positive_part(2.0 * self.amplitude * (chi * sin - log))
    }

    /// Gap averaged over a wavelength, $`\bar g = D (1 - P + P \ln P)`$ \[m\]: from `D` to 0.
    #[must_use]
    pub fn mean_gap(&self, mean_pressure: f64) -> f64 {
        let ratio = self.ratio(mean_pressure);
        if ratio == 0.0 {
            return self.amplitude;
        }
        self.amplitude * positive_part(1.0 - ratio + ratio * ratio.ln())
    }

    /// Interfacial stiffness per nominal area,
    /// $`-\mathrm{d}\bar p/\mathrm{d}\bar g = p^\ast / (D \ln(1/P))`$ \[Pa/m\].
    ///
    /// Zero without load, infinite in complete contact.
    #[must_use]
    pub fn interfacial_stiffness(&self, mean_pressure: f64) -> f64 {
        // |ln P| rather than −ln P: at P = 1 the zero must be a positive one.
        let log = self.ratio(mean_pressure).ln().abs();
        self.full_contact_pressure() / (self.amplitude * log)
    }

    /// Elastic energy per nominal area,
    /// $`\int \bar p (-\mathrm{d}\bar g) = D p^\ast P^2 (\frac14 - \frac12 \ln P)`$ \[J/m²\].
    ///
    /// It no longer grows beyond complete contact, since the gap no longer shrinks. (That of
    /// compressing the half-space as a whole is infinite, and not part of it.)
    #[must_use]
    pub fn energy(&self, mean_pressure: f64) -> f64 {
        let ratio = self.ratio(mean_pressure);
        if ratio == 0.0 {
            return 0.0;
        }
        let scale = self.amplitude * self.full_contact_pressure();
        scale * ratio * ratio * (0.25 - 0.5 * ratio.ln())
    }
}
