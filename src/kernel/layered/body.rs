//! What a layered body is made of.

use super::compliance::{Compliance, Material};
use crate::{Error, plane_strain_modulus};

/// A layer: Young's modulus, Poisson's ratio and thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Layer {
    /// Young's modulus E \[Pa\].
    pub youngs_modulus: f64,
    /// Poisson's ratio ν, above −1 and at most ½.
    pub poissons_ratio: f64,
    /// Thickness h \[m\].
    pub thickness: f64,
}

/// What the lowest layer is bonded to.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Base {
    /// A rigid plane.
    Rigid,
    /// An elastic half-space.
    HalfSpace {
        /// Young's modulus E \[Pa\].
        youngs_modulus: f64,
        /// Poisson's ratio ν, above −1 and at most ½.
        poissons_ratio: f64,
    },
}

/// Elastic layers, bonded to each other and to a [`Base`].
///
/// A wave of pressure $`p\, e^{i \mathbf q \cdot \mathbf x}`$ without friction displaces the surface by
/// $`\hat C(q)\, p\, e^{i \mathbf q \cdot \mathbf x}`$, with q = |**q**|: [`compliance`](Self::compliance).
///
/// # One layer
///
/// With the shear moduli G₁ and G₂ of layer and half-space, m = G₁/G₂, and
///
/// ```math
/// \kappa = \frac{m - 1}{m + 3 - 4 \nu_1}, \qquad
/// \Lambda = 1 - \frac{4 (1 - \nu_1)}{1 + m (3 - 4 \nu_2)}, \qquad \theta = e^{-2 q h},
/// ```
///
/// ```math
/// \hat C(q) = \frac{1 - \nu_1}{G_1 q}\,
///     \frac{1 + 4 q h \kappa \theta - \Lambda \kappa \theta^2}
///          {1 - (\Lambda + \kappa + 4 \kappa q^2 h^2)\, \theta + \Lambda \kappa \theta^2}
/// ```
///
/// (Nogi and Kato; m = 0 is the rigid base of Bentall and Johnson). Short waves see the layer alone, 2/(E₁\* q), long
/// ones the half-space, 2/(E₂\* q).
///
/// # Several layers
///
/// From the base to the surface, a layer at a time: displacements and tractions of a wave obey a linear differential
/// equation across a layer, which turns the compliance matrix of what lies below into that of the layer's upper side.
/// Nothing overflows, since compliances stay finite whatever the thickness, and thin layers cancel nothing, an
/// incompressible one on a rigid base included. Against the formula above, evaluated with 60 digits, one layer errs by
/// at most 3 × 10⁻¹⁴ for q h from 10⁻⁴ to 40 and ratios of the moduli from 10⁻⁴ to 10⁴. A graded body is a stack of
/// many thin layers.
///
/// # Example
///
/// ```
/// use asperity::kernel::{Base, Layer, LayeredBody};
///
/// // 5 µm of titanium nitride on steel.
/// let coat = Layer { youngs_modulus: 450e9, poissons_ratio: 0.25, thickness: 5e-6 };
/// let steel = Base::HalfSpace { youngs_modulus: 210e9, poissons_ratio: 0.3 };
/// let body = LayeredBody::new(&[coat], steel)?;
/// // Waves of 1 mm hardly see the coat, waves of 1 µm nothing else.
/// let modulus = |wavelength: f64| {
///     let q = std::f64::consts::TAU / wavelength;
///     2.0 / (q * body.compliance(q))
/// };
/// assert!((modulus(1e-3) / 230.8e9 - 1.0).abs() < 0.03);
/// assert!((modulus(1e-6) / 480e9 - 1.0).abs() < 1e-6);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # References
///
/// * R. H. Bentall and K. L. Johnson, Int. J. Mech. Sci. 10 (1968) 637, for the rigid base.
/// * T. Nogi and T. Kato, J. Tribol. 119 (1997) 493, for a layer on a half-space.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Parts", into = "Parts")
)]
pub struct LayeredBody {
    layers: Vec<Layer>,
    base: Base,
    counterpart: Option<f64>,
}

impl LayeredBody {
    /// `layers` on a base, the uppermost first.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for a Young's modulus or a thickness, or if there is no layer; [`Error::OutOfRange`] for
    /// a Poisson's ratio, and if moduli are more than 10¹² times as large as others, or thicknesses.
    pub fn new(layers: &[Layer], base: Base) -> Result<Self, Error> {
        Error::require_positive("number of layers", layers.len() as f64)?;
        let (mut moduli, mut thicknesses) = (Range::default(), Range::default());
        for layer in layers {
            moduli.add(plane_strain_modulus(layer.youngs_modulus, layer.poissons_ratio)?);
            thicknesses.add(Error::require_positive("thickness of a layer", layer.thickness)?);
        }
        if let Base::HalfSpace { youngs_modulus, poissons_ratio } = base {
            moduli.add(plane_strain_modulus(youngs_modulus, poissons_ratio)?);
        }
        moduli.check("greatest modulus of a layer or the base over the least")?;
        thicknesses.check("greatest thickness of a layer over the least")?;
        Ok(Self { layers: layers.to_vec(), base, counterpart: None })
    }

    /// The same body in contact with an elastic half-space in place of a rigid one: its compliance is added. `e_star`
    /// is the [plane-strain modulus](plane_strain_modulus) E/(1 − ν²) of that half-space \[Pa\].
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`].
    pub fn against(mut self, e_star: f64) -> Result<Self, Error> {
        let e_star = Error::require_positive("plane-strain modulus of the other body", e_star)?;
        self.counterpart = Some(e_star);
        Ok(self)
    }

    /// The layers, the uppermost first.
    #[must_use]
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// What they are bonded to.
    #[must_use]
    pub fn base(&self) -> Base {
        self.base
    }

    /// Plane-strain modulus of the other body \[Pa\], `None` if it is rigid.
    #[must_use]
    pub fn counterpart(&self) -> Option<f64> {
        self.counterpart
    }

    /// Sum of the thicknesses \[m\].
    #[must_use]
    pub fn thickness(&self) -> f64 {
        self.layers.iter().map(|layer| layer.thickness).sum()
    }

    /// The composite modulus E\* that short waves see \[Pa\]: of the uppermost layer and the other body.
    #[must_use]
    pub fn surface_modulus(&self) -> f64 {
        let top = self.top_modulus();
        self.counterpart.map_or(top, |other| 1.0 / (1.0 / top + 1.0 / other))
    }

    /// Ĉ(q) \[m/Pa\], displacement over pressure of a wave of wave number `q` \[rad/m\]; infinite at q = 0 unless the
    /// base is rigid and so is the other body.
    #[must_use]
    pub fn compliance(&self, q: f64) -> f64 {
        let q = q.abs();
        if q == 0.0 {
            return self.mean_compliance().unwrap_or(f64::INFINITY);
        }
        self.reduced_compliance(q) / q + self.counterpart.map_or(0.0, |other| 2.0 / (other * q))
    }

    /// What a uniform pressure does, Ĉ(0) \[m/Pa\], on a rigid base against a rigid body; `None` for other bodies,
    /// which have no distant point at rest:
    ///
    /// ```math
    /// \hat C(0) = \sum_i \frac{h_i (1 + \nu_i)(1 - 2 \nu_i)}{E_i (1 - \nu_i)} .
    /// ```
    ///
    /// It is zero if all layers are incompressible, ν = ½: a periodic pressure then displaces no volume.
    #[must_use]
    pub fn mean_compliance(&self) -> Option<f64> {
        if self.base != Base::Rigid || self.counterpart.is_some() {
            return None;
        }
        let of_layer = |layer: &Layer| {
            let nu = layer.poissons_ratio;
            layer.thickness * (1.0 + nu) * (1.0 - 2.0 * nu) / (layer.youngs_modulus * (1.0 - nu))
        };
        Some(self.layers.iter().map(of_layer).sum())
    }

    /// q Ĉ(q) \[1/Pa\] without the other body, for q > 0.
    pub(super) fn reduced_compliance(&self, q: f64) -> f64 {
        let mut below = match self.base {
            Base::Rigid => Compliance::RIGID,
            Base::HalfSpace { youngs_modulus, poissons_ratio } => {
                Compliance::half_space(Material::new(youngs_modulus, poissons_ratio))
            }
        };
        for layer in self.layers.iter().rev() {
            let material = Material::new(layer.youngs_modulus, layer.poissons_ratio);
            below = below.under(material, q * layer.thickness);
        }
        below.normal()
    }

    /// Least shear modulus of a layer or the base over the greatest: Young's moduli do not tell how stiff a material is
    /// whose Poisson's ratio is near −1.
    pub(super) fn softest_over_stiffest(&self) -> f64 {
        let mut moduli = Range::default();
        let mut add = |youngs_modulus, poissons_ratio| {
            moduli.add(Material::new(youngs_modulus, poissons_ratio).shear)
        };
        self.layers.iter().for_each(|layer| add(layer.youngs_modulus, layer.poissons_ratio));
        if let Base::HalfSpace { youngs_modulus, poissons_ratio } = self.base {
            add(youngs_modulus, poissons_ratio);
        }
        moduli.0 / moduli.1
    }

    /// Plane-strain modulus of the uppermost layer \[Pa\].
    pub(super) fn top_modulus(&self) -> f64 {
        let plane_strain = |youngs_modulus: f64, poissons_ratio: f64| {
            youngs_modulus / (1.0 - poissons_ratio * poissons_ratio)
        };
        self.layers
            .first()
            .map_or(f64::NAN, |top| plane_strain(top.youngs_modulus, top.poissons_ratio))
    }

    /// Thickness of the uppermost layer \[m\].
    pub(super) fn top_thickness(&self) -> f64 {
        self.layers.first().map_or(f64::NAN, |top| top.thickness)
    }
}

/// Least and greatest of some numbers.
#[derive(Debug)]
struct Range(f64, f64);

impl Default for Range {
    fn default() -> Self {
        Self(f64::INFINITY, 0.0)
    }
}

impl Range {
    fn add(&mut self, value: f64) {
        *self = Self(self.0.min(value), self.1.max(value));
    }

    fn check(&self, quantity: &'static str) -> Result<(), Error> {
        // Beyond, digits of the softer or thinner one are lost.
        let ratio = self.1 / self.0;
        Error::require(quantity, ratio, ratio <= 1e12, "at most 1e12").map(drop)
    }
}

/// A body as plain data.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct Parts {
    layers: Vec<Layer>,
    base: Base,
    #[serde(default)]
    counterpart: Option<f64>,
}

#[cfg(feature = "serde")]
impl From<LayeredBody> for Parts {
    fn from(body: LayeredBody) -> Self {
        Self { layers: body.layers, base: body.base, counterpart: body.counterpart }
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Parts> for LayeredBody {
    type Error = Error;

    fn try_from(parts: Parts) -> Result<Self, Error> {
        let body = Self::new(&parts.layers, parts.base)?;
        match parts.counterpart {
            Some(e_star) => body.against(e_star),
            None => Ok(body),
        }
    }
}
