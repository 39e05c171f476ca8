//! The conductance of a contact, and of the gap beside it.

use crate::kernel::{Layering, Theory};
use crate::reference::contact_conductance;
use crate::{ContactState, Error, JointError};

/// What is conducted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Carrier {
    /// Electrical current: resistivities in Ω m, conductances in S.
    Current,
    /// Heat: resistivities in m K/W, conductances in W/K.
    Heat,
}

impl Carrier {
    /// The name of its conductance in tables: `thermal_conductance` or `electrical_conductance`.
    #[must_use]
    pub fn column(self) -> &'static str {
        match self {
            Self::Heat => "thermal_conductance",
            Self::Current => "electrical_conductance",
        }
    }
}

/// Conduction through a joint: Barber's constriction conductance of the contact, `1/R = 2 K / (ρ E*)`, and optionally
/// the gap in parallel.
///
/// See [`contact_conductance`] for what the formula assumes, and which stiffness K it takes: the contact stiffness on a
/// free half-space, and the interfacial one on those that repeat along both sides or one.
///
/// ```
/// use asperity::joint::Conduction;
/// use asperity::kernel::Layering;
/// use asperity::{ContactState, Grid};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let mut contact = ContactState::new(&Grid::square(64, 1e-3)?, 100, 1e-7, 5.0, 2e-6);
/// contact.contact_stiffness = Some(2e7);
/// let copper = Conduction::electrical(70e9, 1.7e-8 + 1.7e-8)?;
/// let conductance = copper.of(&contact, Layering::HalfSpace)?.unwrap_or_default();
/// assert!((conductance - 2.0 * 2e7 / (70e9 * 3.4e-8)).abs() < 1e-9 * conductance);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conduction {
    carrier: Carrier,
    e_star: f64,
    resistivity: f64,
    /// Conductivity of what fills the gap, and its jump distance.
    gap: Option<(f64, f64)>,
}

impl Conduction {
    /// Of current, between bodies of the composite modulus E\* \[Pa\] and the resistivity ρ = ρ₁ + ρ₂ \[Ω m\], the sum
    /// of both.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for either.
    pub fn electrical(e_star: f64, resistivity: f64) -> Result<Self, Error> {
        Self::new(Carrier::Current, e_star, resistivity)
    }

    /// Of heat, with the thermal resistivity ρ = 1/k₁ + 1/k₂ \[m K/W\] of both bodies.
    ///
    /// # Errors
    ///
    /// Those of [`Self::electrical`].
    pub fn thermal(e_star: f64, resistivity: f64) -> Result<Self, Error> {
        Self::new(Carrier::Heat, e_star, resistivity)
    }

    fn new(carrier: Carrier, e_star: f64, resistivity: f64) -> Result<Self, Error> {
        Ok(Self {
            carrier,
            e_star: Error::require_positive("plane-strain modulus", e_star)?,
            resistivity: Error::require_positive("resistivity", resistivity)?,
            gap: None,
        })
    }

    /// The same with the gap in parallel, filled by a medium of the conductivity k \[W/(m K), S/m\] with the jump
    /// distance M \[m\] (the sum of the temperature jump distances of a gas at both surfaces; 0 for a liquid): over the
    /// open area $`A_0 - A`$
    /// ```math
    /// h = k\, \frac{A_0 - A}{\bar g_\mathrm{open} + M} ,
    /// ```
    /// with the mean gap of the open nodes, $`\bar g_\mathrm{open} = \bar g A_0 / (A_0 - A)`$. It is a model: the two
    /// ways share nothing but their ends; and h takes the mean gap, although the mean of k/(g + M) over all gaps is
    /// never less, since 1/(g + M) is convex in g.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for the conductivity, and [`Error::OutOfRange`] for a jump distance that is negative or
    /// not finite.
    pub fn with_gap(mut self, conductivity: f64, jump_distance: f64) -> Result<Self, Error> {
        let conductivity = Error::require_positive("conductivity of the gap", conductivity)?;
        let is_one = (0.0..f64::INFINITY).contains(&jump_distance);
        let jump =
            Error::require("jump distance", jump_distance, is_one, "finite and not negative")?;
        self.gap = Some((conductivity, jump));
        Ok(self)
    }

    /// What is conducted.
    #[must_use]
    pub fn carrier(&self) -> Carrier {
        self.carrier
    }

    /// Conductance \[S, W/K\] at a state; `None` without a stiffness. In full contact of a periodic half-space, which
    /// adds nothing to the bodies, it is infinite.
    ///
    /// It holds on homogeneous half-spaces, and takes another stiffness where these repeat along one side:
    /// [`History::layering`](crate::loading::History::layering) and
    /// [`KernelOrigin::layering`](crate::kernel::KernelOrigin::layering) say which body it is.
    ///
    /// Nodes that have yielded conduct as well: with a hardness it takes the stiffness on *unloading*, of all nodes in
    /// contact, which [`LoadingPath::add_unloading_stiffness`](crate::LoadingPath::add_unloading_stiffness) and
    /// [`FixedLoadSolver::add_unloading_stiffness`](crate::FixedLoadSolver::add_unloading_stiffness) add to states.
    ///
    /// # Errors
    ///
    /// [`Error::NotHomogeneous`] on layers; [`Error::OutOfRange`] for a stiffness that is negative or NaN;
    /// [`JointError::NoUnloadingStiffness`](crate::JointError) if nodes have yielded and that stiffness is missing.
    pub fn of(&self, contact: &ContactState, body: Layering) -> Result<Option<f64>, Error> {
        let [of_contact, interfacial] = stiffnesses(contact)?;
        self.by(of_contact.filter(|_| has_distant_point(body)).or(interfacial), contact, body)
    }

    /// Conductance of the interface \[S, W/K\]: what it adds to bodies with a uniform current, by the interfacial
    /// stiffness on either half-space. It is what a finite element model of both bodies needs, which has the
    /// constriction into the nominal area itself.
    ///
    /// # Errors
    ///
    /// Those of [`Self::of`].
    pub fn of_interface(
        &self,
        contact: &ContactState,
        body: Layering,
    ) -> Result<Option<f64>, Error> {
        let [_, interfacial] = stiffnesses(contact)?;
        self.by(interfacial, contact, body)
    }

    fn by(
        &self,
        stiffness: Option<f64>,
        contact: &ContactState,
        body: Layering,
    ) -> Result<Option<f64>, Error> {
        body.check(Theory::Conductance)?;
        stiffness.map(|stiffness| self.at_stiffness(stiffness, contact)).transpose()
    }

    /// The conductance that a stiffness has, with the gap.
    pub(super) fn at_stiffness(
        &self,
        stiffness: f64,
        contact: &ContactState,
    ) -> Result<f64, Error> {
        let solid = contact_conductance(stiffness, self.e_star, self.resistivity)?;
        Ok(solid + self.through_gap(contact))
    }

    /// Conductance of the gap alone.
    fn through_gap(&self, contact: &ContactState) -> f64 {
        let open = 1.0 - contact.contact_area_fraction;
        match self.gap {
            Some((conductivity, jump)) if open > 0.0 => {
                let area = open * contact.nominal_area;
                conductivity * area / ((contact.mean_gap / open).max(0.0) + jump)
            }
            _ => 0.0,
        }
    }
}

/// Whether the approach of a body is that of a distant point, and no convention.
pub(super) fn has_distant_point(body: Layering) -> bool {
    body != Layering::SemiPeriodicHalfSpace
}

/// Stiffnesses of the nodes in contact: that of a distant point, if there is one, and the interfacial one. Those of a
/// path are of the elastic nodes, which are all unless some have yielded.
pub(super) fn stiffnesses(contact: &ContactState) -> Result<[Option<f64>; 2], Error> {
    match &contact.plastic {
        Some(plastic) if plastic.interfacial_unloading_stiffness.is_some() => {
            Ok([plastic.contact_unloading_stiffness, plastic.interfacial_unloading_stiffness])
        }
        Some(plastic) if plastic.yielded_nodes > 0 => {
            let (yielded_nodes, contact_nodes) = (plastic.yielded_nodes, contact.contact_nodes);
            Err(JointError::NoUnloadingStiffness { yielded_nodes, contact_nodes }.into())
        }
        _ => Ok([contact.contact_stiffness, contact.interfacial_stiffness]),
    }
}
