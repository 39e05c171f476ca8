//! Where a branch is to end.

use super::state::Direction;
use crate::contact::{ContactState, ContactTarget};
use crate::error::AdhesionError;
use crate::kernel::Gauge;
use crate::{Error, Grid};

/// Where a branch is to end, the first of several.
#[derive(Debug, Clone, Default)]
pub(super) struct Targets {
    /// None of them a mean pressure, which is a load.
    targets: Vec<ContactTarget>,
    /// Nodes that fit into the least fraction of the area that was asked for.
    nodes: Option<usize>,
}

/// What a target is compared with, and its rates along the approach in the direction of the branch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measured {
    /// In the gauge of the kernel.
    pub(super) approach: f64,
    pub(super) load: [f64; 2],
    pub(super) mean_gap: [f64; 2],
    /// Rates of the load far below this stiffness are rounding \[N/m\].
    pub(super) stiffness: f64,
    /// Loads are differences of forces as large as this, and approaches and gaps of lengths.
    pub(super) units: [f64; 2],
    pub(super) contact_nodes: usize,
    /// Whether all nodes touch: mean planes of a periodic half-space do not approach any more then.
    pub(super) is_full: bool,
}

/// Rates below this part of their unit are rounding: of lengths 1, the rate of a free surface, and of loads
/// [`Measured::stiffness`].
const LEAST_RATE: f64 = 1e-11;

/// What is nearer than this part of its unit is at a target: a solution at the end of a window may be just beyond one
/// that the window just did not reach.
const NEAR: f64 = 1e-12;

/// The same of loads: their unit goes with a stiffness, which is not the same at both ends of a step or about the mean
/// planes.
const NEAR_LOAD: f64 = 10.0 * NEAR;

/// A state that was found at a target is off by less than this part of its unit.
const AT_TARGET: f64 = 2.0 * NEAR_LOAD;

/// What loads are differences of: forces, and what rounding of the greatest length moves at a stiffness. On stiff bodies
/// that sticks out of small loads.
pub(super) fn force_unit(pull: f64, load: f64, stiffness: f64, length: f64) -> f64 {
    pull + load.abs() + stiffness.abs() * length
}

impl Targets {
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for what is not finite, and for a fraction that is none.
    pub(super) fn of(targets: &[ContactTarget], grid: &Grid) -> Result<Self, Error> {
        let mut nodes: Option<usize> = None;
        let mut own = Vec::with_capacity(targets.len());
        for &target in targets {
            let (quantity, value) = match target {
                ContactTarget::AreaFraction(fraction) => {
                    let fit = grid.nodes_in(fraction)?;
                    nodes = Some(nodes.map_or(fit, |nodes| nodes.min(fit)));
                    own.push(target);
                    continue;
                }
                ContactTarget::Load(load) => ("load at which a branch ends", load),
                ContactTarget::MeanPressure(p) => ("mean pressure at which a branch ends", p),
                ContactTarget::Approach(approach) => ("approach at which a branch ends", approach),
                ContactTarget::MeanGap(gap) => ("mean gap at which a branch ends", gap),
            };
            if !value.is_finite() {
                return Err(Error::OutOfRange { quantity, value, expected: "finite" });
            }
            own.push(match target {
                ContactTarget::MeanPressure(p) => ContactTarget::Load(p * grid.nominal_area()),
                target => target,
            });
        }
        Ok(Self { targets: own, nodes })
    }

    /// All of them; a mean pressure is a load.
    pub(super) fn all(&self) -> &[ContactTarget] {
        &self.targets
    }

    /// The nearest of each kind, from first touch on.
    pub(super) fn nearest(&self) -> impl Iterator<Item = ContactTarget> {
        let mut nearest: [Option<(f64, ContactTarget)>; 4] = [None; 4];
        for &target in &self.targets {
            let (kind, way) = match target {
                ContactTarget::Load(load) | ContactTarget::MeanPressure(load) => (0, load),
                ContactTarget::Approach(approach) => (1, approach),
                ContactTarget::MeanGap(gap) => (2, -gap),
                ContactTarget::AreaFraction(fraction) => (3, fraction),
            };
            if nearest[kind].is_none_or(|(other, _)| way < other) {
                nearest[kind] = Some((way, target));
            }
        }
        nearest.into_iter().flatten().map(|(_, target)| target)
    }

    /// `Ok` if all lie ahead of a state, or at it but for rounding of the greatest length. From where the surfaces are
    /// apart a load that pulls does, if they stick.
    pub(super) fn check_ahead(
        &self,
        (grid, state, length): (&Grid, &ContactState, f64),
        direction: Direction,
        sticks: bool,
    ) -> Result<(), Error> {
        let sign = direction.sign();
        let stiffness = state.contact_stiffness.or(state.interfacial_stiffness);
        let stiffness = stiffness.filter(|stiffness| stiffness.is_finite()).unwrap_or(0.0);
        for target in &self.targets {
            let (quantity, value, present, sign) = match *target {
                ContactTarget::Load(load) => ("load", load, state.load, sign),
                ContactTarget::Approach(approach) => ("approach", approach, state.approach, sign),
                ContactTarget::MeanGap(gap) => ("mean gap", gap, state.mean_gap, -sign),
                ContactTarget::MeanPressure(_) => continue,
                ContactTarget::AreaFraction(fraction) => {
                    ("contact area fraction", fraction, state.contact_area_fraction, sign)
                }
            };
            let way = match *target {
                // A fraction need not be a whole number of nodes.
                ContactTarget::AreaFraction(fraction) => {
                    grid.nodes_in(fraction)? as f64 - state.contact_nodes as f64
                }
                _ => value - present,
            };
            let is_apart = state.contact_nodes == 0 && state.load == 0.0;
            let pulls = sticks && is_apart && direction == Direction::Loading;
            let greatest = value.abs().max(present.abs());
            let unit = match *target {
                ContactTarget::Load(_) => force_unit(0.0, greatest, stiffness, length),
                _ => greatest,
            };
            let rounding = NEAR * unit;
            if sign * way < -rounding && !(quantity == "load" && pulls) {
                return Err(AdhesionError::Behind { quantity, value, present }.into());
            }
        }
        Ok(())
    }

    /// When the first is reached that is not an area; infinity if none is as long as nothing happens.
    pub(super) fn time(&self, gauge: Gauge, measured: &Measured, direction: Direction) -> f64 {
        let sign = direction.sign();
        let Measured { approach, load, mean_gap, stiffness, units: [force, length], .. } =
            *measured;
        let Measured { contact_nodes, is_full, .. } = *measured;
        let ([load, load_rate], [gap, gap_rate]) = (load, mean_gap);
        let stands = is_full && gauge.displacement(1.0) > 0.0;
        let times = self.targets.iter().map(|target| {
            let (left, near, rate, unit) = match *target {
                // Surfaces that are drawn together bear none when some nodes press as much as others pull.
                ContactTarget::Load(to)
                    if (0.0..=NEAR_LOAD * force).contains(&to)
                        && contact_nodes == 0
                        && direction == Direction::Loading =>
                {
                    return f64::INFINITY;
                }
                // The load may rise or fall on either branch.
                ContactTarget::Load(to) => {
                    let left = to - load;
                    (left.abs(), NEAR_LOAD * force, left.signum() * load_rate, stiffness)
                }
                ContactTarget::Approach(to) => (
                    sign * (to - gauge.reported_approach(approach, load)),
                    NEAR * length,
                    if stands { 0.0 } else { 1.0 - sign * gauge.displacement(load_rate) },
                    1.0,
                ),
                ContactTarget::MeanGap(to) => {
                    let rate = if is_full { 0.0 } else { -sign * gap_rate };
                    (sign * (gap - to), NEAR * length, rate, 1.0)
                }
                ContactTarget::AreaFraction(_) | ContactTarget::MeanPressure(_) => {
                    return f64::INFINITY;
                }
            };
            // All lie ahead where the branch begins: what is behind has just been passed.
            if left <= near {
                0.0
            } else if rate > LEAST_RATE * unit {
                left / rate
            } else {
                f64::INFINITY
            }
        });
        times.fold(f64::INFINITY, f64::min)
    }

    /// Whether one more node in contact would be too many.
    pub(super) fn is_full(&self, contact_nodes: usize, direction: Direction) -> bool {
        direction == Direction::Loading && self.nodes.is_some_and(|nodes| contact_nodes >= nodes)
    }

    /// Whether unloading has come down to an area.
    pub(super) fn is_reached(&self, contact_nodes: usize, direction: Direction) -> bool {
        direction == Direction::Unloading && self.nodes.is_some_and(|nodes| contact_nodes <= nodes)
    }

    /// Whether a state is beyond a target behind a jump, or unloading has come down to an area. Loads do not count: in
    /// a jump they go against the branch.
    pub(super) fn is_past(&self, state: &ContactState, direction: Direction) -> bool {
        let is_beyond = |target: &ContactTarget| match *target {
            ContactTarget::Load(_) | ContactTarget::MeanPressure(_) => false,
            ContactTarget::Approach(to) => direction.sign() * (state.approach - to) > 0.0,
            ContactTarget::MeanGap(gap) => direction.sign() * (gap - state.mean_gap) > 0.0,
            ContactTarget::AreaFraction(_) => {
                direction == Direction::Loading
                    && self.nodes.is_some_and(|nodes| state.contact_nodes > nodes)
            }
        };
        self.is_reached(state.contact_nodes, direction) || self.targets.iter().any(is_beyond)
    }

    /// Whether a state behind which nothing happens is at a target: one that was asked for in full contact has no state of
    /// its own.
    pub(super) fn are_met(&self, state: &ContactState, direction: Direction) -> bool {
        self.is_full(state.contact_nodes, direction)
            || self.targets.iter().any(|target| match *target {
                ContactTarget::Load(load) | ContactTarget::MeanPressure(load) => state.load == load,
                ContactTarget::Approach(approach) => state.approach == approach,
                ContactTarget::MeanGap(gap) => state.mean_gap == gap,
                ContactTarget::AreaFraction(_) => false,
            })
    }

    /// Gives a state at a target the very value that was asked for; the units are those of [`Measured`].
    pub(super) fn place(&self, state: &mut ContactState, [force, length]: [f64; 2]) {
        let is_near = |a: f64, b: f64, unit: f64| (a - b).abs() <= AT_TARGET * unit;
        for target in &self.targets {
            match *target {
                ContactTarget::Load(load) if is_near(load, state.load, force) => {
                    state.load = load;
                }
                ContactTarget::Approach(to) if is_near(to, state.approach, length) => {
                    state.approach = to;
                }
                ContactTarget::MeanGap(gap) if is_near(gap, state.mean_gap, length) => {
                    state.mean_gap = gap;
                }
                _ => {}
            }
        }
    }
}
