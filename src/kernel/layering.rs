//! What theories of homogeneous half-spaces ask of a body.

use super::{Base, Boundary, KernelOrigin, LayeredBody};
use crate::Error;

/// What a body is made of, as far as theories of homogeneous half-spaces depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Layering {
    /// A kernel of the user's own, or states of which nothing else is known.
    #[default]
    Unknown,
    /// Homogeneous half-spaces.
    HalfSpace,
    /// Homogeneous half-spaces, or a kernel of the user's own, under a row of images along one side: what their approach
    /// is counted from is a convention.
    SemiPeriodicHalfSpace,
    /// Layers of one material on a rigid base, against a rigid body: every displacement goes with 1/E of that material.
    OneMaterial,
    /// Layers of several materials, with an elastic base or body against them among these.
    Several,
}

/// A theory by which a path is read, and which holds for some bodies alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Theory {
    /// Barber's relation of conductance and stiffness.
    Conductance,
    /// Tangential over normal stiffness, κ.
    TangentialStiffness,
    /// Partial slip after Ciavarella and Jäger.
    Slip,
    /// One creep function for the whole body.
    Creep,
    /// Stresses below the surface of a half-space under tractions along it.
    Traction,
}

impl Layering {
    /// `Ok` unless the body is known to be none of the theory.
    ///
    /// # Errors
    ///
    /// [`Error::NotHomogeneous`].
    pub fn check(self, theory: Theory) -> Result<(), Error> {
        let (asked, reason) = match theory {
            Theory::Conductance => (
                "a conductance",
                "current and displacement solve the same problem on a half-space alone. It takes the current through the same contact into a \
                 conductor with these layers, which is not computed here",
            ),
            Theory::TangentialStiffness => (
                "a tangential stiffness",
                "tangential over normal compliance is one number on a half-space alone, and in layers another one for each wavelength. It takes the \
                 stiffness by the tangential influence coefficients of the layers, which are not computed here",
            ),
            Theory::Slip => (
                "partial slip",
                "it holds for tangential influence coefficients in proportion to normal ones, and those of layers are not. It takes a solution with \
                 both, which is not computed here",
            ),
            Theory::Creep => (
                "creep",
                "one relaxation function would let all materials creep alike, also an elastic base. It takes one for each material; here layers of one \
                 material on a rigid base, against a rigid body, may creep",
            ),
            Theory::Traction => (
                "the stress below tractions",
                "it is that of a half-space. It takes the stress by the transfer matrices of the layers, which is computed here for pressures alone",
            ),
        };
        let holds = match self {
            Self::Unknown | Self::HalfSpace | Self::SemiPeriodicHalfSpace => true,
            Self::OneMaterial => theory == Theory::Creep,
            Self::Several => false,
        };
        if holds { Ok(()) } else { Err(Error::NotHomogeneous { asked, reason }) }
    }
}

impl LayeredBody {
    /// What the body is made of.
    #[must_use]
    pub fn layering(&self) -> Layering {
        let mut layers =
            self.layers().iter().map(|layer| (layer.youngs_modulus, layer.poissons_ratio));
        let Some(first) = layers.next() else {
            return Layering::Unknown;
        };
        let is_one = layers.all(|other| other == first);
        match self.base() {
            Base::HalfSpace { youngs_modulus, poissons_ratio }
                if is_one && (youngs_modulus, poissons_ratio) == first =>
            {
                Layering::HalfSpace
            }
            Base::Rigid if is_one && self.counterpart().is_none() => Layering::OneMaterial,
            _ => Layering::Several,
        }
    }
}

impl KernelOrigin {
    /// What the body is made of, in these surroundings.
    #[must_use]
    pub fn layering(&self, boundary: Boundary) -> Layering {
        match self {
            Self::Boussinesq { .. } | Self::PeriodicBoussinesq { .. } | Self::Spectral { .. } => {
                Layering::HalfSpace
            }
            Self::SemiPeriodicBoussinesq { .. } => Layering::SemiPeriodicHalfSpace,
            Self::Layered { body }
            | Self::PeriodicLayered { body }
            | Self::SpectralLayered { body } => body.layering(),
            Self::Other => match boundary {
                Boundary::PeriodicX | Boundary::PeriodicY => Layering::SemiPeriodicHalfSpace,
                Boundary::Free | Boundary::Periodic => Layering::Unknown,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Layer;

    #[test]
    fn bodies_are_told_by_their_materials() -> Result<(), Error> {
        let layer =
            |youngs_modulus, thickness| Layer { youngs_modulus, poissons_ratio: 0.3, thickness };
        let half_space = |youngs_modulus| Base::HalfSpace { youngs_modulus, poissons_ratio: 0.3 };
        let coat = [layer(2.0, 1.0)];
        let two = [layer(2.0, 1.0), layer(2.0, 3.0)];
        let graded = [layer(2.0, 1.0), layer(3.0, 1.0)];
        for (layers, base, counterpart, expected) in [
            (&coat[..], Base::Rigid, None, Layering::OneMaterial),
            (&two, Base::Rigid, None, Layering::OneMaterial),
            (&graded, Base::Rigid, None, Layering::Several),
            (&coat, Base::Rigid, Some(5.0), Layering::Several),
            (&two, half_space(2.0), None, Layering::HalfSpace),
            (&two, half_space(2.0), Some(5.0), Layering::HalfSpace),
            (&coat, half_space(5.0), None, Layering::Several),
            (&graded, half_space(3.0), None, Layering::Several),
        ] {
            let mut body = LayeredBody::new(layers, base)?;
            if let Some(e_star) = counterpart {
                body = body.against(e_star)?;
            }
            assert_eq!(KernelOrigin::Layered { body }.layering(Boundary::Free), expected);
        }
        for (boundary, expected) in [
            (Boundary::Free, Layering::Unknown),
            (Boundary::Periodic, Layering::Unknown),
            (Boundary::PeriodicX, Layering::SemiPeriodicHalfSpace),
            (Boundary::PeriodicY, Layering::SemiPeriodicHalfSpace),
        ] {
            assert_eq!(KernelOrigin::Other.layering(boundary), expected);
        }
        let spectral = KernelOrigin::Spectral { e_star: 1.0 };
        assert_eq!(spectral.layering(Boundary::Periodic), Layering::HalfSpace);
        Ok(())
    }

    #[test]
    fn theories_hold_for_their_bodies() {
        use Theory::{Conductance, Creep, Slip, TangentialStiffness, Traction};
        for theory in [Conductance, TangentialStiffness, Slip, Creep, Traction] {
            assert!(Layering::Unknown.check(theory).is_ok());
            assert!(Layering::HalfSpace.check(theory).is_ok());
            assert!(Layering::SemiPeriodicHalfSpace.check(theory).is_ok());
            assert_eq!(Layering::OneMaterial.check(theory).is_ok(), theory == Creep);
            let refused = Layering::Several.check(theory).err().map(|error| error.to_string());
            assert!(
                refused.is_some_and(|told| told.contains("layers") && told.contains("t takes"))
            );
        }
    }
}
