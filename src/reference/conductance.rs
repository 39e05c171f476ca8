//! Conductance of a contact from its stiffness.

use crate::Error;

/// Electrical conductance of a contact, from its stiffness:
/// ```math
/// \frac{1}{R} = \frac{2}{\rho E^\ast} \frac{\mathrm{d}W}{\mathrm{d}\delta}
/// ```
///
/// `contact_stiffness` is `dW/dδ` \[N/m\] and `e_star` the composite modulus \[Pa\]; `resistivity` is
/// `ρ = ρ₁ + ρ₂`, the *sum* over both bodies \[Ω m\]. The result \[S\] is the conductance of the
/// constriction alone, between half-spaces without films. It holds for any shape of the contact: the
/// potential under a current and the displacement under a further load solve the same problem.
/// With thermal resistivities \[m K/W\] the result is the thermal conductance \[W/K\]. A stiffness per
/// area gives a conductance per area.
///
/// # Which stiffness
///
/// The incremental one: the derivative on further loading of the nodes in contact, which every state of a path has. The
/// secant W/δ has no such meaning. Where nodes have yielded it is the one on *unloading*, of all nodes in contact:
/// [`Conduction`](crate::joint::Conduction) takes it.
///
/// * *Free half-space* ([`Boussinesq`](crate::Boussinesq)): `contact_stiffness`, dW/dδ for the approach of distant
///   points. The resistance is that between points far off in both bodies, with the constriction of the current into
///   the nominal area as a whole, so that it stays finite in full contact: a punch has a resistance too.
/// * *Periodic half-space* ([`PeriodicBoussinesq`](crate::PeriodicBoussinesq), [`Spectral`](crate::Spectral)):
///   `interfacial_stiffness`, −dW/dḡ. The resistance is what the interface adds to that of the
///   bodies with a uniform current, for one period of the surface. In full contact it adds nothing, and the
///   conductance is infinite.
///
/// * *Half-space that repeats along one side* ([`SemiPeriodicBoussinesq`](crate::SemiPeriodicBoussinesq)):
///   `interfacial_stiffness`, and the same meaning. A row of contacts without end has no resistance to a distant point:
///   it grows with the logarithm of the distance, and dW/dδ with the convention of the approach.
///
/// `contact.contact_stiffness.or(contact.interfacial_stiffness)` is the right one on the first two. A layer, or a
/// graded body, has no such analogy: current and displacement solve different problems there.
///
/// ```
/// use asperity::reference::contact_conductance;
/// use asperity::{Grid, LoadingSolver, PeriodicBoussinesq, SelfAffine};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let (e_star, copper) = (115e9, 1.7e-8);
/// let half_space = PeriodicBoussinesq::new(Grid::square(32, 1.25e-3)?, e_star)?;
/// let mut last = 0.0;
/// for state in LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space).build()? {
///     let contact = state?.contact;
///     if let Some(stiffness) = contact.contact_stiffness.or(contact.interfacial_stiffness) {
///         last = contact_conductance(stiffness, e_star, copper + copper)?;
///         println!("{} N: {last} S", contact.load);
///     }
/// }
/// assert_eq!(last, f64::INFINITY); // full contact
/// # Ok(())
/// # }
/// ```
///
/// Barber, Proc. R. Soc. A 459 (2003) 53.
///
/// # Errors
///
/// [`Error::NotPositive`] for `e_star` and `resistivity`; [`Error::OutOfRange`] for a stiffness that
/// is negative or NaN.
pub fn contact_conductance(
    contact_stiffness: f64,
    e_star: f64,
    resistivity: f64,
) -> Result<f64, Error> {
    let is_one = contact_stiffness >= 0.0;
    Error::require("contact stiffness", contact_stiffness, is_one, "not negative")?;
    let e_star = Error::require_positive("plane-strain modulus", e_star)?;
    let resistivity = Error::require_positive("resistivity", resistivity)?;
    Ok(2.0 * contact_stiffness / e_star / resistivity)
}
