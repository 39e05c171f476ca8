//! Whether the numbers of states follow from each other.
//!
//! Between two events a path is linear in the approach: its load, mean gap, energy and what has yielded follow at each
//! state from the one before and its stiffnesses. First touch follows from the surface, areas from the number of nodes,
//! and a node that touches makes a contact stiffer. A number that was changed afterwards contradicts one of these.

use nalgebra::DMatrix;

use super::inconsistent;
use super::stiffnesses::{SAME_STIFFNESS, Stiffnesses};
use crate::contact::ContactState;
use crate::kernel::KernelOrigin;
use crate::loading::LoadingState;
use crate::surface::HeightMap;
use crate::{Error, Grid};

/// What rounding may change, relative to the greatest numbers of a path: sums over up to 10⁶ events, each to 10⁻¹⁶ of
/// them, and the 10⁻¹⁰ to which a path that goes on from a record is the one that was not interrupted.
pub(super) const ROUNDING: f64 = 1e-9;
/// Products and sums of the numbers of nodes and cells.
const FEW_ROUNDINGS: f64 = 1e-14;
/// What load and energy may be off by beside that, as a part of themselves, where the approach is estimated: what a
/// solution leaves of sums, which nodes that are nearly all plastic make large.
const ESTIMATED: [f64; 2] = [1e-7, 1e-6];
/// The greatest part of the approach that a state may be off by and still say something.
const GREATEST_ERROR: f64 = 0.1;

/// A quantity of a state: its value, what it should be, and by how much it may be off.
pub(super) struct Found {
    pub(super) quantity: &'static str,
    pub(super) value: f64,
    pub(super) expected: f64,
    pub(super) tolerance: f64,
    pub(super) reason: &'static str,
}

impl Found {
    pub(super) fn at(self, step: usize) -> Result<(), Error> {
        let Self { quantity, value, expected, tolerance, reason } = self;
        if (value - expected).abs() <= tolerance {
            return Ok(());
        }
        Err(inconsistent(step, quantity, [value, expected], reason))
    }
}

/// Checks the states of a path on a surface.
///
/// Estimated errors of the approach are taken at their word: loads and gaps are off by what they are at an approach
/// that is off by so much.
pub(super) fn check(
    grid: &Grid,
    heights: &HeightMap,
    (origin, hardness): (&KernelOrigin, Option<&DMatrix<f64>>),
    states: &[LoadingState],
) -> Result<(), Error> {
    let (Some(first), Some(last)) = (states.first(), states.last()) else {
        return Ok(());
    };
    let (ix, iy) = first.node;
    let mean_gap = -heights.matrix().mean();
    Found {
        quantity: "height of the node below the highest one",
        value: -heights.matrix().get((ix, iy)).copied().unwrap_or(f64::NAN),
        expected: 0.0,
        // Of nodes that tie any may touch first.
        tolerance: ROUNDING * mean_gap.abs(),
        reason: "is what first touch has",
    }
    .at(first.step)?;
    first_touch(first, mean_gap)?;
    // On a flat surface nothing is left of lengths but the rounding of displacements: of what the load displaces on
    // average, or those of strains below 1.
    let stiffnesses = Stiffnesses::new(grid, origin);
    let (lx, ly) = grid.sides();
    let displaced = lx.max(ly).max(stiffnesses.displaced(last.contact.load));
    // A sum over all nodes, each of which has some dozens of roundings of its own: products, and transforms of numbers
    // of nodes that are primes.
    let roundings = 16.0 * (grid.nodes() + 16) as f64;
    let displaced = roundings * f64::EPSILON * displaced / ROUNDING;
    let length = mean_gap.abs() + last.contact.approach.abs() + displaced;
    for state in states {
        areas(grid, state.step, &state.contact)?;
        let most = GREATEST_ERROR * length;
        if !(0.0..=most).contains(&state.approach_error) {
            let quantity = "estimated error of the approach";
            let reason = "is the most, a tenth of approach and mean gap";
            return Err(inconsistent(state.step, quantity, [state.approach_error, most], reason));
        }
    }
    stiffnesses.check(None, first)?;
    if let Some(hardness) = hardness {
        for state in states {
            plastic(state, hardness, length)?;
        }
    }
    for (before, state) in states.iter().zip(&states[1..]) {
        increments(before, state, length)?;
        stiffnesses.check(Some(before), state)?;
    }
    Ok(())
}

/// Nothing is pressed yet, and the mean gap is that of the surface.
fn first_touch(state: &LoadingState, mean_gap: f64) -> Result<(), Error> {
    let ContactState { approach, load, energy, .. } = state.contact;
    let reason = "is what first touch has";
    for (quantity, value) in [("approach", approach), ("load", load), ("energy", energy)] {
        Found { quantity, value, expected: 0.0, tolerance: 0.0, reason }.at(state.step)?;
    }
    let value = state.contact.mean_gap;
    let tolerance = ROUNDING * mean_gap.abs();
    Found { quantity: "mean gap", value, expected: mean_gap, tolerance, reason }.at(state.step)
}

/// Areas follow from the number of nodes in contact.
pub(super) fn areas(grid: &Grid, step: usize, contact: &ContactState) -> Result<(), Error> {
    let nodes = contact.contact_nodes as f64;
    let fraction = nodes / grid.nodes() as f64;
    let area = nodes * grid.cell_area();
    for (quantity, value, expected) in [
        ("contact area", contact.contact_area, area),
        ("contact area fraction", contact.contact_area_fraction, fraction),
    ] {
        let reason = "follows from the number of nodes in contact";
        let tolerance = FEW_ROUNDINGS * expected;
        Found { quantity, value, expected, tolerance, reason }.at(step)?;
    }
    Ok(())
}

/// What follows from the state before.
fn increments(before: &LoadingState, state: &LoadingState, length: f64) -> Result<(), Error> {
    let (start, end) = (&before.contact, &state.contact);
    let predicted =
        if start.is_plateau() { start.at_approach(end.approach) } else { start.at_load(end.load) };
    // None without stiffnesses, which states made of data may be.
    let Some(predicted) = predicted else {
        return Ok(());
    };
    let reason = "follows from the state before";
    let load = start.load.abs().max(end.load.abs());
    let is_estimated = before.approach_error + state.approach_error > 0.0;
    let [load_off, energy_off] = if is_estimated { ESTIMATED } else { [ROUNDING, 0.0] };
    let over = |stiffness: Option<f64>| {
        let off = load_off * load / stiffness.unwrap_or(f64::INFINITY).abs();
        if start.is_plateau() || off.is_nan() { 0.0 } else { off }
    };
    // Lengths: what is estimated, what rounding takes from the approach, and what it takes from the load.
    let off = before.approach_error + state.approach_error + ROUNDING * length;
    let off = off + over(start.interfacial_stiffness) + over(start.contact_stiffness);
    let area = end.nominal_area;
    let work_off = off * load + energy_off * end.energy.abs().max(start.energy.abs());
    let [plastic, before] = [end.plastic, predicted.plastic].map(Option::unwrap_or_default);
    for (quantity, value, expected, tolerance) in [
        ("approach", end.approach, predicted.approach, off),
        ("load", end.load, predicted.load, load_off * load),
        ("mean gap", end.mean_gap, predicted.mean_gap, off),
        ("energy", end.energy, predicted.energy, work_off),
        ("plastic volume", plastic.volume, before.volume, off * area),
        ("plastic work", plastic.work, before.work, work_off),
    ] {
        Found { quantity, value, expected, tolerance, reason }.at(state.step)?;
    }
    Ok(())
}

/// The work of each yielded node is its hardness times its depth.
fn plastic(state: &LoadingState, hardness: &DMatrix<f64>, length: f64) -> Result<(), Error> {
    let contact = &state.contact;
    let plastic = contact.plastic.unwrap_or_default();
    let finite = || hardness.iter().copied().filter(|hardness| hardness.is_finite());
    let (least, most) = (finite().fold(f64::INFINITY, f64::min), finite().fold(0.0, f64::max));
    let volume_off = (state.approach_error + ROUNDING * length) * contact.contact_area;
    let rate_off = SAME_STIFFNESS * plastic.volume_per_load.abs();
    for (quantity, value, depth, off) in [
        ("plastic work", plastic.work, plastic.volume, volume_off),
        ("plastic work per load", plastic.work_per_load, plastic.volume_per_load, rate_off),
    ] {
        let (low, high) = (least.min(most) * (depth - off), most * (depth + off));
        let is_one = value >= 0.0 && (low..=high).contains(&value);
        if !is_one {
            let expected = if value < low { low } else { high };
            let reason = "is what its volume and the hardness allow";
            return Err(inconsistent(state.step, quantity, [value, expected], reason));
        }
    }
    Ok(())
}
