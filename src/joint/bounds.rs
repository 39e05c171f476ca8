//! Bounds of the conductance when the surface has more roughness than the grid.

use super::Conduction;
use super::conduction::has_distant_point;
use crate::kernel::{Layering, Theory};
use crate::loading::History;
use crate::{Error, JointError, LoadingState};

/// Loads of the two ends of a chord differ by this part of them at least: those of nodes that touch together by rounding.
const APART: f64 = 1e-9;

/// Between what the conductance of a rougher surface lies.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct ConductanceBounds {
    /// It conducts at least this \[S, W/K\].
    pub lower: f64,
    /// It conducts at most this \[S, W/K\]: infinity where the path tells of no bound.
    pub upper: f64,
}

impl Conduction {
    /// Barber's bounds of the conductance at every state of a path, for a surface with more roughness than the grid
    /// resolves, of at most s \[m\] from its deepest valley to its highest peak.
    ///
    /// Such a surface lies between this one and this one raised by s, so that its approach δᵣ at each load lies between
    /// δ and δ + s; and δᵣ is a concave function of the load, since contact grows. Chords then bound its slope,
    /// ```math
    /// \max_{W_2 > W} \frac{\delta(W_2) - \delta(W) - s}{W_2 - W} \le \delta_r'(W) \le \min_{W_1 < W} \frac{\delta(W) + s - \delta(W_1)}{W - W_1} ,
    /// ```
    /// and the slope is 2/(ρE\*) times the conductance's reciprocal. On a periodic half-space δ is what the mean gap has
    /// closed. So it is on one that repeats along one side, with 2 s in place of s: as the mean displacement depends on
    /// where the load is, the mean gap of the rougher surface is between those of the known curve at approaches of s
    /// less and s more. Without s both bounds are the stiffness before and behind the event. The upper one needs a path
    /// well beyond the load. Between two events, those of the earlier one are no bounds. The gap is as at the state.
    ///
    /// Barber, Proc. R. Soc. A 459 (2003) 53.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a roughness that is negative or not finite, and for stiffnesses that are negative or
    /// NaN; [`JointError::BoundsWithYielding`](crate::JointError) for a path on which nodes yield: its approach is not
    /// that of one elastic shape. The contact that is left conducts as the elastic one of the residual surface, whose
    /// path has bounds. [`Error::NotHomogeneous`] for a path on layers.
    pub fn bounds(
        &self,
        history: &History,
        unresolved: f64,
    ) -> Result<Vec<ConductanceBounds>, Error> {
        let is_one = (0.0..f64::INFINITY).contains(&unresolved);
        Error::require("unresolved roughness", unresolved, is_one, "finite and not negative")?;
        history.layering().check(Theory::Conductance)?;
        let body = history.layering();
        let apart = if has_distant_point(body) { unresolved } else { 2.0 * unresolved };
        let states = history.states();
        if let Some(state) = states.iter().find(|state| state.contact.yielded_nodes() > 0) {
            return Err(JointError::BoundsWithYielding { step: state.step }.into());
        }
        // Chords between nodes that touch together are noise.
        let mut points: Vec<(f64, f64)> = Vec::with_capacity(states.len());
        for point in states.iter().map(|state| compression(state, body)) {
            if points.last().is_none_or(|last| last.0 < point.0 * (1.0 - APART)) {
                points.push(point);
            }
        }
        let stiffness = |slope: f64| if slope > 0.0 { 1.0 / slope } else { f64::INFINITY };
        let bounds = states.iter().map(|state| {
            let (load, depth) = compression(state, body);
            // Slopes of chords from an earlier point, and to a later one.
            let before = |i: usize| (depth + apart - points[i].1) / (load - points[i].0);
            let after = |i: usize| (points[i].1 - depth - apart) / (points[i].0 - load);
            let first = points.partition_point(|point| point.0 < load * (1.0 - APART));
            let next = points.partition_point(|point| point.0 * (1.0 - APART) <= load);
            // There is no earlier point at first touch, and no later one at the end.
            let lower = match first > 0 {
                true => stiffness(before(best(0..first, before))),
                false => 0.0,
            };
            let upper = match next < points.len() {
                true => stiffness(after(best(next..points.len(), |i| -after(i)))),
                false => f64::INFINITY,
            };
            Ok(ConductanceBounds {
                lower: self.at_stiffness(lower, &state.contact)?,
                upper: self.at_stiffness(upper, &state.contact)?,
            })
        });
        bounds.collect()
    }
}

/// Load and compression: the approach where it is that of a distant point, else what the mean gap has closed, up to a
/// constant.
fn compression(state: &LoadingState, body: Layering) -> (f64, f64) {
    let contact = &state.contact;
    let depth = match contact.contact_stiffness {
        Some(_) if has_distant_point(body) => contact.approach,
        _ => -contact.mean_gap,
    };
    (contact.load, depth)
}

/// Where a function with one valley is least. Its values are chords of loads that are [`APART`]: rounding moves them, and
/// what is found, by 10⁻⁷ at most.
fn best(places: std::ops::Range<usize>, value: impl Fn(usize) -> f64) -> usize {
    let (mut low, mut high) = (places.start, places.end - 1);
    while low < high {
        let middle = low + (high - low) / 2;
        if value(middle + 1) < value(middle) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low
}
