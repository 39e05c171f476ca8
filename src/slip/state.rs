//! The tangential state of a contact.

use super::Friction;
use crate::Error;
use crate::bed::{Bed, BedState};

/// The tangential state of a contact under a load.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct SlipState {
    /// Load P \[N\].
    pub load: f64,
    /// Tangential load T \[N\], of either sign.
    pub tangential_load: f64,
    /// Tangential displacement U \[m\]: that of distant points of both bodies against each other, and of the mean
    /// planes on a periodic half-space. Where the whole contact slips it is that at which sliding begins.
    pub displacement: f64,
    /// What the joint itself gives way \[m\]: the relative displacement of the two surfaces, averaged over the nominal
    /// area, as the mean gap is for the approach. It does not depend on the size of the bodies.
    pub interfacial_displacement: f64,
    /// P* \[N\]: nodes in contact at this load of the path stick, all others slip or have just slipped.
    pub stick_load: f64,
    /// Nodes that stick.
    pub stick_nodes: usize,
    /// Nodes that slip: those of the present slip zone, at the limit of friction.
    pub slipping_nodes: usize,
    /// Area that sticks \[m²\].
    pub stick_area: f64,
    /// Area that slips \[m²\].
    pub slip_area: f64,
    /// Tangent stiffness `dT/dU = K(P*)/κ` \[N/m\], if T goes on at constant load as it went; 0 where the whole contact
    /// slips.
    pub tangential_stiffness: f64,
}

impl SlipState {
    /// The state with a stick zone up to `stick`.
    pub(super) fn new(
        bed: &Bed,
        friction: &Friction,
        load: &BedState,
        stick: &BedState,
        [tangential_load, displacement, interfacial_displacement]: [f64; 3],
    ) -> Self {
        // Without a load nothing slips.
        let slips_all = stick.load == 0.0 && load.load > 0.0;
        let (stick_nodes, stick_area) =
            if slips_all { (0, 0.0) } else { (stick.contact_nodes, stick.contact_area) };
        let stiffness = if slips_all { 0.0 } else { stiffness_below(bed, stick) };
        Self {
            load: load.load,
            tangential_load,
            displacement,
            interfacial_displacement,
            stick_load: stick.load,
            stick_nodes,
            slipping_nodes: load.contact_nodes.saturating_sub(stick_nodes),
            stick_area,
            slip_area: (load.contact_area - stick_area).max(0.0),
            tangential_stiffness: stiffness / friction.compliance_ratio(),
        }
    }
}

/// The stiffness on the way down from a state: at a knot that of the interval below.
fn stiffness_below(bed: &Bed, state: &BedState) -> f64 {
    let knots = bed.loads().partition_point(|load| *load < state.load);
    knots
        .checked_sub(1)
        .and_then(|knot| bed.stiffnesses().get(knot))
        .map_or(state.stiffness, |k| *k)
}

/// `Ok` with T if friction bears it under a load; what is beyond the limit by the rounding of so great a load is put on
/// it.
pub(super) fn borne(
    friction: &Friction,
    (load, greatest): (f64, f64),
    tangential_load: f64,
) -> Result<f64, Error> {
    let limit = friction.coefficient() * load;
    let rounding = LIMIT_ROUNDING * friction.coefficient() * greatest;
    let is_finite = tangential_load.is_finite();
    Error::require("tangential load", tangential_load, is_finite, "finite")?;
    if tangential_load.abs() > limit + rounding {
        return Err(crate::SlipError::JointSlides { tangential_load, load, limit }.into());
    }
    Ok(tangential_load.clamp(-limit, limit))
}

/// Loads that differ by less than this part of them are the same: what rounding leaves of a loop that closes, and of a
/// quotient.
pub(super) const SAME_LOAD: f64 = 1e-14;

/// By how much a tangential load may exceed μP and still be meant to be μP: products such as 0.3 · P are rounded.
const LIMIT_ROUNDING: f64 = 1e-12;
