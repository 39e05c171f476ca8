//! Closed-form solutions of smooth contacts, and the laws rough ones are compared with.
//!
//! They share no code with the solver, so that each can check the other. Conventions:
//!
//! * A rigid shape is pressed by the *approach* `δ` \[m\], measured from first touch, into an
//!   elastic half-space of plane-strain modulus `E* = E/(1-ν²)` \[Pa\]
//!   (see [`plane_strain_modulus`](crate::plane_strain_modulus)).
//! * Pressure is positive in compression; the displacement `u` of the surface is positive into the
//!   half-space. With the shape's initial gap `g` at first touch, the gap is `g + u - δ ≥ 0`.
//! * The energy is the elastic energy stored, $`U = \int_0^\delta W \mathrm{d}\delta`$ \[J\].
//! * Outside the contact the pressure is zero. A negative approach, load or mean pressure means no
//!   contact and counts as zero; NaN in gives NaN out.
//!
//! | Contact | |
//! |---|---|
//! | sphere, elliptic paraboloid, cylinder | [`HertzSphere`], [`HertzEllipse`], [`HertzLine`] |
//! | cone | [`Cone`] |
//! | flat punches | [`CircularPunch`], [`SQUARE_PUNCH_STIFFNESS`] |
//! | wavy surfaces | [`Westergaard`], [`DoubleWave`] |
//! | sphere under a tangential load | [`SphereSlip`] |
//! | thin layers, waves on a layer | [`ThinLayer`], [`layer_compliance`] |
//! | area of rough contacts, and its pressures | [`AreaLoadLaw`] |
//! | electrical and thermal contact conductance | [`contact_conductance`] |

/// A closed form of positive parameters, of which the plane-strain modulus is the last.
macro_rules! closed_form {
    (
        $(#[$type_doc:meta])* $name:ident;
        $(#[$new_doc:meta])* new;
        $($(#[$doc:meta])* $parameter:ident: $quantity:literal),+
    ) => {
        $(#[$type_doc])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $name {
            $($parameter: f64,)+
            e_star: f64,
        }

        impl $name {
            $(#[$new_doc])*
            ///
            /// # Errors
            ///
            /// [`Error::NotPositive`](crate::Error::NotPositive) for any of them.
            pub fn new($($parameter: f64,)+ e_star: f64) -> Result<Self, crate::Error> {
                Ok(Self {
                    $($parameter: crate::Error::require_positive($quantity, $parameter)?,)+
                    e_star: crate::Error::require_positive("plane-strain modulus", e_star)?,
                })
            }

            $(
                $(#[$doc])*
                #[must_use]
                pub fn $parameter(&self) -> f64 {
                    self.$parameter
                }
            )+

            /// Plane-strain modulus \[Pa\].
            #[must_use]
            pub fn e_star(&self) -> f64 {
                self.e_star
            }
        }
    };
}

mod area_load;
mod conductance;
mod cone;
mod double_wave;
mod elliptic;
mod hertz_ellipse;
mod hertz_line;
mod hertz_sphere;
mod layer;
mod punch;
mod sphere_slip;
mod westergaard;

pub use area_load::AreaLoadLaw;
pub use conductance::contact_conductance;
pub use cone::Cone;
pub use double_wave::DoubleWave;
pub use hertz_ellipse::HertzEllipse;
pub use hertz_line::HertzLine;
pub use hertz_sphere::HertzSphere;
pub use layer::{ThinLayer, layer_compliance};
pub use punch::{CircularPunch, SQUARE_PUNCH_STIFFNESS};
pub use sphere_slip::SphereSlip;
pub use westergaard::Westergaard;

/// Zero for a negative value. Unlike `f64::max`, it lets NaN through.
fn positive_part(value: f64) -> f64 {
    if value < 0.0 { 0.0 } else { value }
}
