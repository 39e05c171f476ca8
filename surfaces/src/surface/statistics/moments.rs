//! Moments of the power spectrum.

use nalgebra::Vector6;

use crate::surface::Topography;
use crate::surface::fourier::Waves;

/// Moments of the power spectrum of a periodic map:
///
/// ```math
/// m_{ab} = \sum_{\mathbf q \ne 0} q_x^a\, q_y^b\, |\hat h_{\mathbf q}|^2 , \qquad
///    h(\mathbf x) = \bar h + \sum_{\mathbf q \ne 0} \hat h_{\mathbf q}\, e^{i \mathbf q \cdot \mathbf x}
/// ```
///
/// with q = 2π/λ \[rad/m\]; m₂₀ = ⟨h_x²⟩, m₀₄ = ⟨h_yy²⟩ and so on. Made by [`Topography::spectral_moments`]. They
/// belong to the trigonometric polynomial through the nodes, of which differences between nodes see less the shorter
/// the waves. A wave of exactly two cells counts once, with the frequency that it has.
///
/// # Profiles
///
/// [`m0`](Self::m0), [`m2`](Self::m2) and [`m4`](Self::m4) are what profiles of the surface have on average over all
/// directions, the numbers of Nayak's theory:
///
/// ```math
/// m_0 = \langle h^2 \rangle, \qquad m_2 = \tfrac12 \langle |\nabla h|^2 \rangle, \qquad
///    m_4 = \tfrac38 \langle (\nabla^2 h)^2 \rangle = \tfrac38 (m_{40} + 2 m_{22} + m_{04})
/// ```
///
/// since the mean of cos⁴ is 3/8. Of an isotropic surface every profile has them, and m₄ is as well
/// (m₄₀ + 3 m₂₂ + m₀₄)/3, which is what tamaas uses. A map of one row counts as a surface of ridges here: m₀, m₂₀ and
/// m₄₀ are those of the row itself.
///
/// # References
///
/// P. R. Nayak, Random process model of rough surfaces, J. Lubr. Technol. 93 (1971) 398; M. S. Longuet-Higgins, Phil.
/// Trans. R. Soc. A 249 (1957) 321.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectralMoments {
    m00: f64,
    m20: f64,
    m02: f64,
    m40: f64,
    m22: f64,
    m04: f64,
}

getters!(SpectralMoments {
    /// m₂₀ = ⟨h_x²⟩, without unit.
    m20: f64,
    /// m₀₂ = ⟨h_y²⟩, without unit.
    m02: f64,
    /// m₄₀ = ⟨h_xx²⟩ \[1/m²\].
    m40: f64,
    /// m₂₂ = ⟨h_xy²⟩ = ⟨h_xx h_yy⟩ \[1/m²\].
    m22: f64,
    /// m₀₄ = ⟨h_yy²⟩ \[1/m²\].
    m04: f64,
});

impl SpectralMoments {
    /// m₀, the mean square height \[m²\].
    #[must_use]
    pub fn m0(&self) -> f64 {
        self.m00
    }

    /// m₂, the mean square slope of profiles, averaged over their directions, without unit.
    #[must_use]
    pub fn m2(&self) -> f64 {
        0.5 * (self.m20 + self.m02)
    }

    /// m₄, the mean square second derivative of profiles, averaged over their directions \[1/m²\].
    #[must_use]
    pub fn m4(&self) -> f64 {
        0.375 * self.mean_square_laplacian()
    }

    /// Root mean square height S_q \[m\].
    #[must_use]
    pub fn rms_height(&self) -> f64 {
        self.m00.sqrt()
    }

    /// Root mean square gradient $`\sqrt{\langle |\nabla h|^2 \rangle} = \sqrt{2 m_2}`$, without unit.
    #[must_use]
    pub fn rms_gradient(&self) -> f64 {
        (self.m20 + self.m02).sqrt()
    }

    /// Root mean square Laplacian $`\sqrt{\langle (\nabla^2 h)^2 \rangle} = \sqrt{8 m_4 / 3}`$ \[1/m\].
    #[must_use]
    pub fn rms_laplacian(&self) -> f64 {
        self.mean_square_laplacian().sqrt()
    }

    /// Root mean square of the mean curvature ½ (κ₁ + κ₂) \[1/m\], half of the Laplacian.
    #[must_use]
    pub fn rms_curvature(&self) -> f64 {
        0.5 * self.rms_laplacian()
    }

    /// Nayak's parameter α = m₀ m₄ / m₂², the breadth of the spectrum: 3/2 for waves of one length in all directions,
    /// and greater the more lengths there are. NaN for a flat map.
    #[must_use]
    pub fn nayak_parameter(&self) -> f64 {
        self.m0() * (self.m4() / self.m2()) / self.m2()
    }

    /// Root mean square pressure of full contact about its mean, for a composite modulus E\* \[Pa\]:
    /// $`E^* h'_\mathrm{rms} / 2`$ with the gradient above; see [`Topography::full_contact_pressure`].
    #[must_use]
    pub fn rms_full_contact_pressure(&self, e_star: f64) -> f64 {
        0.5 * e_star * self.rms_gradient()
    }

    fn mean_square_laplacian(&self) -> f64 {
        self.m40 + 2.0 * self.m22 + self.m04
    }
}

impl Topography {
    /// Moments of the power spectrum of the map, taken as periodic.
    ///
    /// Of a map that is not, jumps at the border dominate m₂ and m₄: use differences
    /// ([`rms_gradient`](Self::rms_gradient), [`rms_laplacian`](Self::rms_laplacian)), or level it and put a
    /// [window](Self::window) on it before.
    #[must_use]
    pub fn spectral_moments(&self) -> SpectralMoments {
        let waves = self.waves();
        let mut sums = Vector6::zeros();
        // Line by line, to keep rounding small.
        let mut line = Vector6::zeros();
        let mut column = 0;
        for wave in waves.iter() {
            if wave.k.0 != column {
                column = wave.k.0;
                sums += std::mem::take(&mut line);
            }
            let (xx, yy) = (wave.q.0 * wave.q.0, wave.q.1 * wave.q.1);
            let terms = Vector6::new(1.0, xx, yy, xx * xx, xx * yy, yy * yy);
            line += wave.count as f64 * wave.power * terms;
        }
        let [m00, m20, m02, m40, m22, m04] = (sums + line).into();
        SpectralMoments { m00, m20, m02, m40, m22, m04 }
    }

    /// Root mean square gradient of the trigonometric polynomial through the nodes of a periodic map, without unit:
    /// [`SpectralMoments::rms_gradient`].
    #[must_use]
    pub fn rms_gradient_spectral(&self) -> f64 {
        self.spectral_moments().rms_gradient()
    }

    /// The waves of the map.
    pub(super) fn waves(&self) -> Waves {
        Waves::new(self.heights(), self.map().mean_height(), self.grid())
    }
}
