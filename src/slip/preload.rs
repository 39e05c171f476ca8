//! Tangential loading at constant load.

use std::f64::consts::PI;

use nalgebra::DMatrix;

use super::Friction;
use super::state::{SAME_LOAD, SlipState, borne};
use crate::bed::{Bed, BedState};
use crate::kernel::Theory;
use crate::{Error, LoadingPath, SlipError};

/// A joint under a constant load P: what a tangential load does to it. See the [module](super).
///
/// Making it takes O(N) for N states of the path, each answer O(log N).
#[derive(Debug, Clone)]
pub struct PartialSlip<'a> {
    bed: &'a Bed<'a>,
    friction: Friction,
    preload: BedState,
    /// Twice the area between the curve W(δ) and its chord, from each knot below the preload up to it \[J\].
    lens: Vec<f64>,
}

/// A cycle of the tangential load between −T and T.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct SlipCycle {
    /// Amplitude of the tangential load, T \[N\].
    pub amplitude: f64,
    /// Amplitude of the displacement, U \[m\].
    pub displacement: f64,
    /// The same of the [interfacial displacement](SlipState::interfacial_displacement) \[m\].
    pub interfacial_displacement: f64,
    /// Energy lost in a steady cycle, D \[J\].
    pub dissipation: f64,
    /// Secant stiffness `T/U` \[N/m\].
    pub secant_stiffness: f64,
    /// Loss factor `D/(π T U)`: the energy lost over 2π times ½ T U.
    pub loss_factor: f64,
    /// P* \[N\]: nodes in contact at this load stick throughout.
    pub stick_load: f64,
    /// Nodes that slip. Below some [50](PartialSlip::FEW_NODES) of them the dissipation is that of the grid.
    pub slipping_nodes: usize,
}

/// An element of Jenkins: a spring and a slider in series.
///
/// A joint under a constant load is made of N of them side by side (Iwan, J. Appl. Mech. 34 (1967) 612), one for each
/// node in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct JenkinsElement {
    /// Tangential stiffness, k = ΔK/κ \[N/m\]. See [`Spring::stiffness`](crate::bed::Spring::stiffness) for paths
    /// without a factor.
    pub stiffness: f64,
    /// Displacement at which it slips, φ \[m\].
    pub slip_displacement: f64,
}

impl JenkinsElement {
    /// Force at which it slips, kφ \[N\].
    #[must_use]
    pub fn slip_force(&self) -> f64 {
        self.stiffness * self.slip_displacement
    }

    /// Energy that it loses in a cycle of the displacement between −U and U \[J\]: `4 k φ (U − φ)` if U exceeds φ.
    #[must_use]
    pub fn dissipation(&self, displacement: f64) -> f64 {
        4.0 * self.slip_force() * (displacement - self.slip_displacement).max(0.0)
    }
}

/// What a node does under a tangential load.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum SlipZone {
    /// It is out of contact.
    Open,
    /// It sticks.
    Stick,
    /// It slips.
    Slip,
}

impl<'a> PartialSlip<'a> {
    /// Slipping nodes below which the dissipation of a cycle depends on the grid by more than some 15 %.
    pub const FEW_NODES: usize = 50;

    /// How often the change of the approach over the slip zone must exceed the error of the path for a dissipation.
    pub const ABOVE_PATH_ERROR: f64 = 10.0;

    /// The contact of a bed under a load P \[N\].
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for a load that is not; [`Error::NotHomogeneous`] for a path on layers;
    /// [`BedError::PathEndsBefore`](crate::BedError::PathEndsBefore).
    pub fn new(bed: &'a Bed<'a>, load: f64, friction: Friction) -> Result<Self, Error> {
        bed.history().layering().check(Theory::Slip)?;
        let preload = bed.at_load(Error::require_positive("load", load)?)?;
        let mut lens = vec![0.0; preload.interval + 1];
        // A fan of triangles from the preload: W(δ) is convex, so that none of them is negative.
        for knot in (0..preload.interval).rev() {
            let (start, end) = (knot, knot + 1);
            lens[start] = lens[end] + triangle(&preload, at(bed, start), at(bed, end));
        }
        Ok(Self { bed, friction, preload, lens })
    }

    /// The bed.
    #[must_use]
    pub fn bed(&self) -> &'a Bed<'a> {
        self.bed
    }

    /// Friction.
    #[must_use]
    pub fn friction(&self) -> Friction {
        self.friction
    }

    /// The state of the contact under P.
    #[must_use]
    pub fn preload(&self) -> BedState {
        self.preload
    }

    /// The tangential load at which the joint slides, μP \[N\].
    #[must_use]
    pub fn sliding_load(&self) -> f64 {
        self.friction.coefficient() * self.preload.load
    }

    /// The displacement at which it begins to slide, κμδ(P) \[m\].
    #[must_use]
    pub fn sliding_displacement(&self) -> f64 {
        self.friction.displacement_per_approach() * self.preload.approach
    }

    /// The state under a tangential load T of either sign that has grown from zero.
    ///
    /// # Errors
    ///
    /// [`SlipError::JointSlides`] beyond μP, at which P* is 0 and U that of incipient sliding; [`Error::OutOfRange`]
    /// for what is not finite.
    pub fn monotone(&self, tangential_load: f64) -> Result<SlipState, Error> {
        let stick = self.stick(tangential_load)?;
        let (friction, preload) = (&self.friction, &self.preload);
        let scale = tangential_load.signum() * friction.displacement_per_approach();
        let displacement = scale * (preload.approach - stick.approach);
        let interfacial = scale * (stick.mean_gap - preload.mean_gap);
        let values = [tangential_load, displacement, interfacial];
        Ok(SlipState::new(self.bed, friction, preload, &stick, values))
    }

    /// The steady cycle of T between −`amplitude` and `amplitude`.
    ///
    /// ```math
    /// D = 8\kappa\mu^2 \times \text{the area between } W(\delta) \text{ and its chord from } P^\ast \text{ to } P
    ///   = 4 \sum_n k_n \varphi_n (U - \varphi_n)
    /// ```
    /// over the [elements](Self::jenkins_elements) that slip. Both are sums of positive terms; the first is used, since
    /// it needs no stiffness. It is a quantity of the *cycle*: with bodies that are not alike the first loading loses
    /// more than D/4.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for the amplitude; those of [`Self::monotone`]; [`SlipError::WithinPathError`] if the
    /// path has been computed without a factor and the slip zone is so thin that its estimated errors are a tenth of
    /// what D is made of.
    pub fn cycle(&self, amplitude: f64) -> Result<SlipCycle, Error> {
        let amplitude = Error::require_positive("amplitude of the tangential load", amplitude)?;
        let stick = self.stick(amplitude)?;
        let (bed, preload) = (self.bed, &self.preload);
        let change = preload.approach - stick.approach;
        let error = |state: &BedState| bed.history().states()[state.interval].approach_error;
        let approach_error = error(preload).max(error(&stick));
        // In full contact nothing slips, and the way there has no error.
        let slips = !(bed.is_full() && stick.load >= bed.last_load());
        if slips && change < Self::ABOVE_PATH_ERROR * approach_error {
            return Err(SlipError::WithinPathError { change, approach_error }.into());
        }
        let next = stick.interval + 1;
        let area = if next > preload.interval {
            0.0
        } else {
            let partial = triangle(preload, (stick.load, stick.approach), at(bed, next));
            self.lens[next] + partial
        };
        let state = self.monotone(amplitude)?;
        let scale = 4.0 * self.friction.displacement_per_approach() * self.friction.coefficient();
        Ok(SlipCycle::new(&state, scale * area.max(0.0)))
    }

    /// The steady cycle of the displacement between −U and U \[m\]. Beyond [sliding](Self::sliding_displacement) the
    /// joint slides at T = μP for the rest of the way, which costs `4μP (U − κμδ)` more.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for the displacement, and those of [`Self::cycle`].
    pub fn cycle_of_displacement(&self, displacement: f64) -> Result<SlipCycle, Error> {
        let displacement = Error::require_positive("amplitude of the displacement", displacement)?;
        let beyond = displacement - self.sliding_displacement();
        if beyond < 0.0 {
            let change = displacement / self.friction.displacement_per_approach();
            let stick = self.bed.at_approach((self.preload.approach - change).max(0.0))?;
            let slipping = self.preload.load - stick.load;
            // So small a displacement moves the stick zone by less than rounding.
            let amplitude = if slipping > 0.0 {
                self.friction.coefficient() * slipping
            } else {
                displacement * self.monotone(0.0)?.tangential_stiffness
            };
            return Ok(SlipCycle { displacement, ..self.cycle(amplitude)? });
        }
        let limit = self.monotone(self.sliding_load())?;
        let at_limit = self.cycle(self.sliding_load())?;
        let dissipation = at_limit.dissipation + 4.0 * self.sliding_load() * beyond;
        let interfacial = limit.interfacial_displacement + beyond;
        let state = SlipState { displacement, interfacial_displacement: interfacial, ..limit };
        Ok(SlipCycle::new(&state, dissipation))
    }

    /// The elements of Jenkins that make up the joint, in the order in which nodes have touched: the last ones slip
    /// first.
    ///
    /// Element n has the stiffness `k = ΔKₙ/κ` and slips at `φ = κμ (δ − δₙ)`. Together they have the stiffness `K/κ`,
    /// and slip forces whose sum is μP. Their density of slip displacements weighted with k is that of Iwan's model,
    /// −d²T/dU² (Segalman, J. Appl. Mech. 72 (2005) 752).
    ///
    /// Behind full contact of a periodic half-space the last node makes the joint rigid up to μ(P − P_full), P_full the
    /// load of full contact. It is left out, and lacks in the sum of slip forces as much, and `4μ (P − P_full) U` in
    /// that of [dissipation](Self::cycle).
    pub fn jenkins_elements(&self) -> impl Iterator<Item = JenkinsElement> + '_ {
        let (friction, approach) = (self.friction, self.preload.approach);
        let reached = self.bed.springs().take_while(move |spring| spring.gap < approach);
        reached.filter(|spring| spring.stiffness.is_finite()).map(move |spring| JenkinsElement {
            stiffness: spring.stiffness / friction.compliance_ratio(),
            slip_displacement: friction.displacement_per_approach() * (approach - spring.gap),
        })
    }

    /// Traction `q = ±μ [p(P) − p(P*)]` \[Pa\] under a tangential load that has grown from zero: two fields of the
    /// path.
    ///
    /// # Errors
    ///
    /// Those of [`Self::monotone`] and of [`LoadingPath::fields_at`].
    pub fn traction(
        &self,
        path: &mut LoadingPath,
        tangential_load: f64,
    ) -> Result<DMatrix<f64>, Error> {
        let stick = self.stick(tangential_load)?;
        let full = path.pressure_at(&self.bed.path_state(self.preload.load)?)?;
        let sticking = path.pressure_at(&self.bed.path_state(stick.load)?)?;
        let scale = tangential_load.signum() * self.friction.coefficient();
        Ok((full - sticking) * scale)
    }

    /// Slip `±κμ g(P*)` \[m\] of the nodes in contact, 0 where they stick: a field of the path. In a steady cycle it is
    /// the amplitude of their slip.
    ///
    /// # Errors
    ///
    /// Those of [`Self::monotone`] and of [`LoadingPath::fields_at`].
    pub fn slip(
        &self,
        path: &mut LoadingPath,
        tangential_load: f64,
    ) -> Result<DMatrix<f64>, Error> {
        let stick = self.stick(tangential_load)?;
        let zones = self.zones(path, tangential_load)?;
        let gap = path.fields_at(&self.bed.path_state(stick.load)?)?.gap;
        let scale = tangential_load.signum() * self.friction.displacement_per_approach();
        Ok(gap.zip_map(&zones, |gap, zone| match zone {
            SlipZone::Slip => scale * gap.max(0.0),
            _ => 0.0,
        }))
    }

    /// Which nodes stick, and which slip.
    ///
    /// # Errors
    ///
    /// Those of [`Self::monotone`] and of [`LoadingPath::contact_map_at`].
    pub fn zones(
        &self,
        path: &LoadingPath,
        tangential_load: f64,
    ) -> Result<DMatrix<SlipZone>, Error> {
        let stick = self.stick(tangential_load)?;
        let contact = path.contact_map_at(&self.bed.path_state(self.preload.load)?)?;
        let sticking = path.contact_map_at(&self.bed.path_state(stick.load)?)?;
        Ok(contact.zip_map(&sticking, |is_in, sticks| match (is_in, sticks) {
            (false, _) => SlipZone::Open,
            (true, true) if stick.load > 0.0 => SlipZone::Stick,
            (true, _) => SlipZone::Slip,
        }))
    }

    /// Work of friction of each node in a steady cycle, per area: `4κμ² p(P) g(P*)` \[J/m²\]. Times the area of a cell
    /// it sums to [`SlipCycle::dissipation`]. Two fields of the path.
    ///
    /// # Errors
    ///
    /// Those of [`Self::slip`] and of [`LoadingPath::fields_at`].
    pub fn friction_work(
        &self,
        path: &mut LoadingPath,
        amplitude: f64,
    ) -> Result<DMatrix<f64>, Error> {
        let amplitude = Error::require_positive("amplitude of the tangential load", amplitude)?;
        let slip = self.slip(path, amplitude)?;
        let pressure = path.pressure_at(&self.bed.path_state(self.preload.load)?)?;
        let scale = 4.0 * self.friction.coefficient();
        Ok(slip.zip_map(&pressure, |slip, pressure| scale * slip * pressure.max(0.0)))
    }

    /// The state of the path whose contact sticks.
    fn stick(&self, tangential_load: f64) -> Result<BedState, Error> {
        let tangential_load =
            borne(&self.friction, (self.preload.load, self.preload.load), tangential_load)?;
        let lost = tangential_load.abs() / self.friction.coefficient();
        let stick = self.preload.load - lost;
        // At μP what is left is the rounding of the quotient.
        self.bed.at_load(if stick <= SAME_LOAD * self.preload.load { 0.0 } else { stick })
    }
}

impl SlipCycle {
    fn new(state: &SlipState, dissipation: f64) -> Self {
        let (amplitude, displacement) = (state.tangential_load, state.displacement);
        let work = PI * amplitude * displacement;
        Self {
            amplitude,
            displacement,
            interfacial_displacement: state.interfacial_displacement,
            dissipation,
            // A load that moves the stick zone by less than rounding slips nothing.
            secant_stiffness: if displacement > 0.0 {
                amplitude / displacement
            } else {
                state.tangential_stiffness
            },
            // What does not give way loses nothing.
            loss_factor: if work > 0.0 { dissipation / work } else { 0.0 },
            stick_load: state.stick_load,
            slipping_nodes: state.slipping_nodes,
        }
    }

    /// Whether so [few nodes](PartialSlip::FEW_NODES) slip that the dissipation depends on the grid.
    #[must_use]
    pub fn has_few_nodes(&self) -> bool {
        self.slipping_nodes < PartialSlip::FEW_NODES
    }
}

/// Load and approach of a knot.
fn at(bed: &Bed, knot: usize) -> (f64, f64) {
    (bed.loads()[knot], bed.approaches()[knot])
}

/// Twice the area of the triangle of an apex and two points below it on W(δ), each (W, δ).
fn triangle(apex: &BedState, start: (f64, f64), end: (f64, f64)) -> f64 {
    (apex.load - end.0) * (end.1 - start.1) - (apex.approach - end.1) * (end.0 - start.0)
}
