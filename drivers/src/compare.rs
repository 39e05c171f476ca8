//! Two paths that ought to be one, one of them found without a factor.

use std::collections::{HashMap, HashSet};

use asperity::LoadingState;

use crate::dense::Dense;
use crate::verdict::{Tally, Violation, ensure};

/// Events closer than this, relative to the approach, are ties: `asperity::loading` says so.
const TIE: f64 = 1e-9;
/// The same relative to the mean initial gap, where there is no approach yet, and to the greatest one, as whose part
/// rounding of heights counts.
const FIRST_TIE: f64 = 1e-13;
const TIE_OF_HEIGHTS: f64 = 1e-14;
/// Approaches closer than this, relative to the one that is computed with, are one.
const ROUNDING: f64 = 1e-13;

/// By how much errors of the approach may exceed their estimate at worst.
const FAR_OFF: f64 = 10.0;

/// How far states between the ends of windows may be off beside what they say themselves, relatively.
pub(crate) struct Bounds {
    pub(crate) load: f64,
    pub(crate) stiffness: f64,
    pub(crate) interfacial: f64,
    /// Of closing rates over that of the approach. The interfacial stiffness is made of their mean, a small difference
    /// near full contact.
    pub(crate) closing: f64,
    /// Relative to the initial one.
    pub(crate) mean_gap: f64,
    /// By how much an error may exceed its estimate, and by how much where the order of events follows from it.
    pub(crate) excess: f64,
    pub(crate) order: f64,
}

impl Bounds {
    /// Of contacts that a local solution takes in as a whole: `asperity::loading` speaks of 1e-5 at worst on large
    /// grids, and a window is a large part of so short a path as these. Between the ends of windows closing rates are
    /// solved for to 1e-3 of their mean; on large grids what is left averages out, to 3e-4 at worst, and on so few
    /// nodes it need not. Up to 0.3 % of the errors of an approach exceed their estimate, by a factor of two.
    pub(crate) const SMALL: Self = Self {
        load: 1e-4,
        stiffness: 3e-5,
        interfacial: 2e-3,
        closing: 0.0,
        mean_gap: 5e-6,
        excess: 2.0,
        order: 0.0,
    };
    /// The same where nodes yield. Ties are settled by solutions whose gaps are off by 1e-10 of the approach. Where
    /// nearly all of it is plastic depth, elastic gaps are not much larger, and events are in order as far as they say,
    /// or are off at worst.
    pub(crate) const SMALL_YIELDING: Self = Self { order: FAR_OFF, ..Self::SMALL };
    /// Of larger ones on cells up to 100 times as long as wide: some three times the worst of 3000 paths, and for the
    /// interfacial stiffness twice the worst of 17 000, on 15 × 24 nodes where a window is an eighth of the path. With 4
    /// nodes of 308 open, closing at 1.6e-3 of the approach in the mean, that was off by 3.7e-5 of the approach; with 1
    /// of 441, periodic, by 3.0e-5 of a node's own displacement.
    pub(crate) const LARGE: Self = Self {
        load: 1e-3,
        stiffness: 1e-3,
        interfacial: 1e-2,
        closing: 1e-4,
        mean_gap: 1e-4,
        excess: FAR_OFF,
        order: FAR_OFF,
    };
}

/// Compares states with exact ones: events up to ties, and scalars where no tie makes the order of equals matter.
/// `dense` is the problem in the gauge of paths.
pub(crate) fn same_path(
    (found, exact): (&[LoadingState], &[LoadingState]),
    bounds: &Bounds,
    dense: &Dense,
    tally: &mut Tally,
) -> Result<(), Violation> {
    let Some(first) = exact.first() else {
        return Ok(());
    };
    let initial = first.contact.mean_gap;
    // A node may touch and yield.
    let place: HashMap<_, _> =
        exact.iter().enumerate().map(|(k, s)| ((s.event, s.node), k)).collect();
    let last = exact.last().map(|state| state.contact);
    let plastic = last.and_then(|contact| contact.plastic).unwrap_or_default();
    // Where nodes yield the energy falls again, and to nothing on a periodic half-space.
    let yields = plastic.yielded_nodes > 0;
    let energies = exact.iter().map(|state| state.contact.energy);
    let greatest = if yields { energies.fold(0.0, f64::max) } else { 0.0 };
    // Of the approach that is computed with, in which the load is contained.
    let computed = |state: &LoadingState| {
        state.contact.approach + dense.uniform_displacement(state.contact.load)
    };
    // States at one approach joined together, as a window began: ties as far as they may be off. What would have joined
    // with the last one of a path that ends before is not there.
    let is_together = |k: usize| {
        if k + 1 == found.len() && found.len() < exact.len() {
            return true;
        }
        let neighbours = [k.checked_sub(1), Some(k + 1)];
        let mut neighbours = neighbours.into_iter().flatten().filter_map(|k| found.get(k));
        let own = found[k].contact.approach;
        neighbours
            .any(|other| (other.contact.approach - own).abs() <= ROUNDING * computed(&found[k]))
    };
    let tie = |k: usize| {
        let of_heights = (FIRST_TIE * initial).max(TIE_OF_HEIGHTS * dense.greatest_gap());
        let tie = (TIE * computed(&exact[k])).max(of_heights);
        let off = if is_together(k) { bounds.excess * found[k].approach_error } else { 0.0 };
        tie.max(off)
    };
    // What has happened on one of the paths alone so far.
    let mut pending = HashSet::new();
    for (k, (state, expected)) in found.iter().zip(exact).enumerate() {
        for event in [(state.event, state.node), (expected.event, expected.node)] {
            if !pending.insert(event) {
                pending.remove(&event);
            }
        }
        let context = || format!("{state:?} in place of {expected:?}");
        ensure!(
            state.step == expected.step
                && (yields || state.contact.contact_nodes == expected.contact.contact_nodes),
            "{}",
            context()
        );
        let Some(&own) = place.get(&(state.event, state.node)) else {
            return Err(Violation::new(context()));
        };
        let apart = (exact[own].contact.approach - expected.contact.approach).abs();
        // Between its place and the one where it was found, as far as the path goes.
        let uncertain = found.iter().take(own.max(k) + 1).skip(own.min(k));
        let uncertain = uncertain.fold(0.0, |most: f64, state| most.max(state.approach_error));
        let is_other = (state.event, state.node) != (expected.event, expected.node);
        if is_other && apart > tie(k).max(bounds.order * uncertain) {
            return Err(Violation::new(format!("{}: {apart:e} apart", context())));
        }
        let next = exact.get(k + 1).map_or(f64::INFINITY, |next| next.contact.approach);
        if next - expected.contact.approach <= tie(k) || expected.contact.approach <= tie(k) {
            continue;
        }
        ensure!(
            is_other || state.contact.contact_nodes == expected.contact.contact_nodes,
            "{}",
            context()
        );
        // What the state itself says of its approach, or what that is off by, and what follows from it.
        let off = (state.contact.approach - expected.contact.approach).abs();
        let error = (bounds.excess * state.approach_error).max(off);
        let rate = |state: &LoadingState| {
            let contact = &state.contact;
            let rate = contact.contact_stiffness.or(contact.interfacial_stiffness);
            // In full contact the mean planes come closer by what sinks in alone.
            let sinks =
                contact.plastic.map(|plastic| contact.contact_area / plastic.volume_per_load);
            [rate, sinks].into_iter().flatten().find(|rate| rate.is_finite())
        };
        // Full contact has none where the mean displacement is arbitrary: there it is the rate on the way to it.
        let before = k.checked_sub(1).and_then(|before| rate(&exact[before]));
        let here = rate(expected);
        // A yield takes from it, on a plateau all of it: of what there is on the way, the greatest.
        let ends = [state, expected].map(|state| state.contact.approach);
        let way = ends[0].min(ends[1])..=ends[0].max(ends[1]);
        let rate = if yields {
            let on_way = exact.iter().filter(|state| way.contains(&state.contact.approach));
            before.into_iter().chain(here).chain(on_way.filter_map(rate)).reduce(f64::max)
        } else {
            here.or(before)
        };
        let by_error = error * rate.unwrap_or(0.0);
        // The energy is what comes in, which goes with the approach, less plastic work, which a window knows in parts
        // of what is done from its beginning to its end.
        let of_work_in = 3.0 * bounds.load * expected.contact.energy.max(greatest)
            + (expected.contact.load + by_error) * error;
        let of_work = bounds.load * plastic.work + error * last.map_or(0.0, |last| last.load);
        let work = |state: &LoadingState| state.contact.plastic.unwrap_or_default().work;
        let work_in = |state: &LoadingState| state.contact.energy + work(state);
        let mut scalars = [
            (
                "approach",
                state.contact.approach,
                expected.contact.approach,
                FAR_OFF * state.approach_error + tie(k),
            ),
            (
                "load",
                state.contact.load,
                expected.contact.load,
                bounds.load * expected.contact.load + by_error,
            ),
            (
                "energy",
                state.contact.energy,
                expected.contact.energy,
                of_work_in + if yields { of_work } else { 0.0 },
            ),
            ("work that comes in", work_in(state), work_in(expected), of_work_in),
            (
                "mean gap",
                state.contact.mean_gap,
                expected.contact.mean_gap,
                bounds.mean_gap * initial + error,
            ),
        ]
        .to_vec();
        // The mean closing rate over that of the approach is the ratio of both stiffnesses. Where the mean displacement
        // is arbitrary, a node's own displacement takes the place of the approach.
        let exact = (expected.contact.interfacial_stiffness, expected.contact.contact_stiffness);
        let of_closing = match exact {
            (Some(interfacial), Some(contact)) if contact > 0.0 => {
                bounds.closing * interfacial / contact
            }
            (Some(_), None) => bounds.closing * dense.closing_of_own(&expected.contact),
            _ => 0.0,
        };
        // A window over a plateau may be as long as the approach: its rates are off by its error over that.
        let of_window =
            if yields { FAR_OFF * state.approach_error / computed(expected) } else { 0.0 };
        let pairs = [
            (
                state.contact.contact_stiffness,
                expected.contact.contact_stiffness,
                bounds.stiffness + of_window,
            ),
            (
                state.contact.interfacial_stiffness,
                expected.contact.interfacial_stiffness,
                bounds.interfacial + of_closing + of_window,
            ),
        ];
        for (a, b, allowed) in pairs {
            match (a, b) {
                // Of other nodes, where these may come in another order.
                (Some(_), Some(_)) if bounds.order > 0.0 && !pending.is_empty() => {}
                (Some(a), Some(b)) if b.is_finite() => {
                    scalars.push(("stiffness", a, b, allowed * b));
                }
                (a, b) => ensure!(a == b, "{}", context()),
            }
        }
        if let (Some(a), Some(b), Some(last)) =
            (state.contact.plastic, expected.contact.plastic, last)
        {
            ensure!(is_other || a.yielded_nodes == b.yielded_nodes, "{}", context());
            // What is yielded sinks no faster than the approach, under no more than the last load.
            let volume = bounds.load * plastic.volume + error * last.contact_area;
            scalars.push(("plastic volume", a.volume, b.volume, volume));
            scalars.push(("plastic work", a.work, b.work, of_work));
        }
        for (what, a, b, allowed) in scalars {
            tally.close(what, a, b, allowed).map_err(|violation| violation.during(context()))?;
        }
        tally.checked += 1;
    }
    Ok(())
}
