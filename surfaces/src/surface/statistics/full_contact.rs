//! The pressure that presses a rough surface flat.

use nalgebra::DMatrix;

use crate::Error;
use crate::surface::Topography;

impl Topography {
    /// Pressure of full contact about its mean \[Pa\], on a periodic half-space of composite modulus `e_star` = E\*
    /// \[Pa\].
    ///
    /// Where the half-space follows every valley, the displacement is the map itself, and each wave needs
    ///
    /// ```math
    /// \hat p_{\mathbf q} = \tfrac12 E^* |\mathbf q|\, \hat h_{\mathbf q} , \qquad \mathbf q \ne 0
    /// ```
    ///
    /// as under the half-space `Spectral` of the crate `asperity`. The mean pressure is free, but must be at least the
    /// negative of the least value of this field: from there on no pressure is negative and full contact is possible.
    /// The root mean square of the field is E\* h'/2 with the spectral gradient,
    /// [`SpectralMoments::rms_full_contact_pressure`].
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for `e_star`, and [`Error::FieldNotFinite`] if pressures overflow.
    ///
    /// [`SpectralMoments::rms_full_contact_pressure`]: crate::surface::SpectralMoments::rms_full_contact_pressure
    pub fn full_contact_pressure(&self, e_star: f64) -> Result<DMatrix<f64>, Error> {
        let e_star = Error::require_positive("composite modulus", e_star)?;
        let mut waves = self.waves().without_mean();
        waves.multiply(|qx, qy| 0.5 * e_star * libm::hypot(qx, qy));
        let pressure = waves.restore();
        self.grid().check_finite("pressure of full contact", &pressure)?;
        Ok(pressure)
    }
}
