//! The path as a bed of independent springs, and superpositions of its increments.
//!
//! Between two events the pressure grows as that of a flat punch on the nodes in contact. Let `s` be the load that
//! labels an increment of the path, $`\mathrm{d}p(s)`$ its pressure and $`\mathrm{d}\delta(s)`$ its approach. Many
//! problems of contact that are not elastic or not normal have solutions of the form
//! ```math
//! p = \int \varphi(s)\, \mathrm{d}p(s)
//! ```
//! with a weight $`\varphi(s)`$ that obeys at each s a law of its own: a friction limit ([`slip`](crate::slip)), the
//! creep of a material. All scalars of such a state are then in the record of the path, and its fields are sums of
//! pressures of the path:
//! ```math
//! W = \int \varphi\, \mathrm{d}s, \qquad
//! \delta = \int \varphi\, \mathrm{d}\delta(s), \qquad
//! \bar g = \bar g_0 + \int \varphi\, \mathrm{d}\bar g(s), \qquad
//! U = \int \varphi(s) \left[ \int_s \varphi\, \mathrm{d}\delta \right] \mathrm{d}s
//! ```
//! The last follows from $`\mathrm{d}p(s) \cdot \mathrm{d}u(t) = \mathrm{d}s\, \mathrm{d}\delta(t) / \Delta A`$ for s <
//! t: nodes that carry dp(s) are in contact at t, and move as one.
//!
//! # Springs
//!
//! In other words, the contact *is* a bed of springs that know nothing of each other. The one of event n has the
//! stiffness $`\Delta K_n = K_n - K_{n-1} > 0`$ and the initial gap δₙ, the approach at which node n touches: `W = Σ
//! ΔKₙ (δ − δₙ)` over the springs that are reached. For bodies of revolution this is the method of dimensionality
//! reduction (Popov & Heß, *Method of Dimensionality Reduction in Contact Mechanics and Friction*, Springer 2015). For
//! a discretised surface it holds as it is, whatever its shape.
//!
//! # What it takes
//!
//! Two properties of the contacts of the path: pressures and contact only grow ($`\mathrm{d}p \ge 0`$), and gaps only
//! close. Every path has them on which no node leaves the contact or yields; others are [refused](crate::BedError). On
//! a periodic half-space, which has no distant point at rest, the approach is that of the mean planes and the stiffness
//! the interfacial one. That becomes infinite in full contact, so that everything here is written in loads.
//!
//! ```
//! use asperity::bed::{Bed, Superposition};
//! use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine};
//!
//! # fn main() -> Result<(), asperity::Error> {
//! let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
//! let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space)
//!     .max_load(500.0)
//!     .build()?;
//! let history = path.run()?;
//! let bed = Bed::new(&history)?;
//!
//! // The increments up to 200 N in full, and those from there to 500 N by half.
//! let state = Superposition::new([(200.0, 1.0), (500.0, 0.5)])?;
//! assert_eq!(state.load(), 350.0);
//! let approach = state.scalars(&bed)?.approach;
//! let between = bed.at_load(200.0)?.approach..bed.at_load(500.0)?.approach;
//! assert!(between.contains(&approach));
//! let pressure = state.pressure(&bed, &mut path)?;
//! assert!((pressure.sum() * path.grid().cell_area() / 350.0 - 1.0).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```

mod superposition;
/// What a load or an approach may exceed the last of a path by, relative to it, and still be meant to be it.
const AT_THE_END: f64 = 1e-12;
/// By what part of its size a quantity may go back from one state to the next: where a kernel promises nothing, each state
/// of a tie has been solved for by itself, by iterations perhaps.
const ROUNDING: f64 = 1e-10;

#[cfg(test)]
mod tests;

pub use superposition::{Piece, Superposed, Superposition};

use crate::loading::{ContactEvent, History, LoadingState};
use crate::record::LoadingRecord;
use crate::{BedError, ContactTarget, Error};

/// The springs of a path. See the [module](self).
///
/// Knots are the states of the path; between two of them everything is linear in the load. Looking something up takes
/// O(log N) for N states, and making the bed O(N).
#[derive(Debug, Clone)]
pub struct Bed<'a> {
    history: &'a History,
    loads: Vec<f64>,
    approaches: Vec<f64>,
    mean_gaps: Vec<f64>,
    energies: Vec<f64>,
    stiffnesses: Vec<f64>,
    is_full: bool,
}

/// The elastic state of a bed at a load.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct BedState {
    /// Load W \[N\].
    pub load: f64,
    /// Approach δ \[m\].
    pub approach: f64,
    /// Mean gap \[m\].
    pub mean_gap: f64,
    /// Elastic energy ∫ W dδ \[J\].
    pub energy: f64,
    /// Tangent stiffness dW/dδ on further loading \[N/m\]: infinite in full contact of a periodic half-space.
    pub stiffness: f64,
    /// Nodes in contact; one that touches just here is among them.
    pub contact_nodes: usize,
    /// Their area \[m²\].
    pub contact_area: f64,
    /// The interval that the state lies in: that from [knot](Bed::loads) `interval` to the next.
    pub interval: usize,
}

/// A spring of a bed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Spring {
    /// Stiffness ΔK \[N/m\]. On a path without a factor, whose stiffnesses carry errors, it may have any sign, and only
    /// sums over many springs say something. On a periodic half-space that of the last node is infinite.
    pub stiffness: f64,
    /// Initial gap \[m\]: the approach at which it is reached.
    pub gap: f64,
    /// The load at which it is reached \[N\].
    pub load: f64,
}

impl<'a> Bed<'a> {
    /// The bed of a path from first touch on.
    ///
    /// # Errors
    ///
    /// [`BedError::Empty`]; [`BedError::NotFromFirstTouch`]; [`BedError::NotElasticGrowth`] if a node leaves the
    /// contact or yields; [`BedError::NotMonotone`] for loads or approaches that fall, mean gaps that rise, and scalars
    /// that are not finite; [`BedError::NoStiffness`]; [`Error::NotFinite`] if an energy overflows.
    pub fn new(history: &'a History) -> Result<Self, Error> {
        let states = history.states();
        let Some(first) = states.first() else {
            return Err(BedError::Empty.into());
        };
        let (load, approach) = (first.contact.load, first.contact.approach);
        if load != 0.0 || approach != 0.0 {
            return Err(BedError::NotFromFirstTouch { load, approach }.into());
        }
        let mut energies = Vec::with_capacity(states.len());
        let mut knots = Vec::with_capacity(states.len());
        let mut energy = 0.0;
        let mut last = [0.0, 0.0, first.contact.mean_gap];
        for state in states {
            check_event(state)?;
            let now = grown(last, state, first.contact.mean_gap)?;
            energy += (0.5 * last[0] + 0.5 * now[0]) * (now[1] - last[1]);
            if !energy.is_finite() {
                return Err(Error::NotFinite { step: state.step });
            }
            energies.push(energy);
            knots.push(now);
            last = now;
        }
        let last = states.last().unwrap_or(first).contact;
        let of = |quantity: usize| knots.iter().map(|knot| knot[quantity]).collect();
        Ok(Self {
            history,
            loads: of(0),
            approaches: of(1),
            mean_gaps: of(2),
            energies,
            stiffnesses: states.iter().map(stiffness).collect::<Result<_, _>>()?,
            // With a hardness nodes yield behind full contact.
            is_full: last.contact_area_fraction == 1.0 && last.plastic.is_none(),
        })
    }

    /// The bed of a record.
    ///
    /// # Errors
    ///
    /// Those of [`Self::new`].
    pub fn of_record(record: &'a LoadingRecord) -> Result<Self, Error> {
        Self::new(record.history())
    }

    /// The path.
    #[must_use]
    pub fn history(&self) -> &'a History {
        self.history
    }

    /// Loads Wₖ of the knots \[N\], from 0 on; equal ones where nodes touch together.
    #[must_use]
    pub fn loads(&self) -> &[f64] {
        &self.loads
    }

    /// Approaches δₖ of the knots \[m\], from 0 on.
    #[must_use]
    pub fn approaches(&self) -> &[f64] {
        &self.approaches
    }

    /// Mean gaps of the knots \[m\]: they fall.
    #[must_use]
    pub fn mean_gaps(&self) -> &[f64] {
        &self.mean_gaps
    }

    /// Elastic energies of the knots, ∫ W dδ \[J\].
    #[must_use]
    pub fn energies(&self) -> &[f64] {
        &self.energies
    }

    /// Tangent stiffnesses dW/dδ behind the knots \[N/m\], as the path has them.
    #[must_use]
    pub fn stiffnesses(&self) -> &[f64] {
        &self.stiffnesses
    }

    /// The greatest load that the bed can be read at \[N\]: that of the last state, and any behind full contact, where
    /// all is linear.
    #[must_use]
    pub fn greatest_load(&self) -> f64 {
        if self.is_full { f64::INFINITY } else { self.last_load() }
    }

    /// The load of the last state \[N\].
    #[must_use]
    pub fn last_load(&self) -> f64 {
        self.loads.last().copied().unwrap_or(0.0)
    }

    /// Whether the last state is in full contact.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.is_full
    }

    /// The springs, in the order in which they are reached.
    pub fn springs(&self) -> impl Iterator<Item = Spring> + '_ {
        let before = std::iter::once(0.0).chain(self.stiffnesses.iter().copied());
        let states = self.history.states().iter().zip(before).zip(&self.stiffnesses);
        states.filter(|((state, _), _)| state.event == ContactEvent::Touch).map(
            |((state, before), &stiffness)| Spring {
                stiffness: stiffness - before,
                gap: state.contact.approach,
                load: state.contact.load,
            },
        )
    }

    /// First touch.
    #[must_use]
    pub fn first(&self) -> BedState {
        let interval = self.loads.partition_point(|knot| *knot <= 0.0).saturating_sub(1);
        self.within(interval, 0.0)
    }

    /// Whether it can be read behind its last approach: full contact of a half-space that has a stiffness.
    fn gives_way(&self) -> bool {
        self.is_full && self.stiffnesses.last().is_some_and(|stiffness| stiffness.is_finite())
    }

    /// The elastic state at a load; what is beyond the last by rounding is the last.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a load that is negative or no number, [`BedError::PathEndsBefore`].
    pub fn at_load(&self, load: f64) -> Result<BedState, Error> {
        let is_load = load.is_finite() && load >= 0.0;
        Error::require("load", load, is_load, "finite and not negative")?;
        let greatest = self.greatest_load();
        if load > greatest * (1.0 + AT_THE_END) {
            return Err(self.ends_before("load", load, self.last_load()));
        }
        let load = load.min(greatest);
        // The first knot has the load 0.
        let interval = self.loads.partition_point(|knot| *knot <= load).saturating_sub(1);
        let state = self.within(interval, load);
        let is_finite = state.approach.is_finite() && state.energy.is_finite();
        Error::require("load", load, is_finite, "one whose approach and energy are numbers")?;
        Ok(state)
    }

    /// The elastic state at an approach; what is beyond the last by rounding is the last.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for an approach that is negative or no number, [`BedError::PathEndsBefore`].
    pub fn at_approach(&self, approach: f64) -> Result<BedState, Error> {
        let is_one = approach.is_finite() && approach >= 0.0;
        Error::require("approach", approach, is_one, "finite and not negative")?;
        let approach = match self.approaches.last() {
            Some(&last) if !self.gives_way() && approach <= last * (1.0 + AT_THE_END) => {
                approach.min(last)
            }
            _ => approach,
        };
        let interval = self.approaches.partition_point(|knot| *knot <= approach).saturating_sub(1);
        let (start, load) = (self.approaches[interval], self.loads[interval]);
        let advance = approach - start;
        let load = match self.loads.get(interval + 1) {
            // The next knot has a greater approach.
            Some(end) => load + (end - load) * (advance / (self.approaches[interval + 1] - start)),
            None if advance == 0.0 => load,
            None if self.is_full => load + self.stiffnesses[interval] * advance,
            None => f64::INFINITY,
        };
        if !load.is_finite() {
            return Err(self.ends_before("approach", approach, start));
        }
        Ok(BedState { approach, ..self.within(interval, load) })
    }

    /// The state at a load in an interval.
    fn within(&self, interval: usize, load: f64) -> BedState {
        let (start, stiffness) = (self.loads[interval], self.stiffnesses[interval]);
        let (approach, mean_gap) = (self.approaches[interval], self.mean_gaps[interval]);
        let advance = match self.loads.get(interval + 1) {
            Some(end) if end > &start => {
                let part = (load - start) / (end - start);
                let to = |from: f64, knots: &[f64]| part * (knots[interval + 1] - from);
                (to(approach, &self.approaches), to(mean_gap, &self.mean_gaps))
            }
            Some(_) => (0.0, 0.0),
            // In full contact the mean gap stays.
            None => ((load - start) / stiffness, 0.0),
        };
        let contact = &self.history.states()[interval].contact;
        BedState {
            load,
            approach: approach + advance.0,
            mean_gap: mean_gap + advance.1,
            energy: self.energies[interval] + 0.5 * (start + load) * advance.0,
            stiffness,
            contact_nodes: contact.contact_nodes,
            contact_area: contact.contact_area,
            interval,
        }
    }

    /// The state of the path at a load, with which [`LoadingPath::fields_at`](crate::LoadingPath::fields_at) and its
    /// like compute fields.
    ///
    /// # Errors
    ///
    /// Those of [`Self::at_load`].
    pub fn path_state(&self, load: f64) -> Result<LoadingState, Error> {
        let load = self.at_load(load)?.load;
        self.history.at(ContactTarget::Load(load))
    }

    fn ends_before(&self, quantity: &'static str, value: f64, end: f64) -> Error {
        BedError::PathEndsBefore { quantity, value, end }.into()
    }
}

/// dW/dδ for the approach that the state has.
fn stiffness(state: &LoadingState) -> Result<f64, Error> {
    let stiffness = state.contact.contact_stiffness.or(state.contact.interfacial_stiffness);
    match stiffness {
        Some(positive) if positive > 0.0 => Ok(positive),
        _ => Err(BedError::NoStiffness { step: state.step, stiffness }.into()),
    }
}

fn check_event(state: &LoadingState) -> Result<(), Error> {
    let (happens, instead) = match state.event {
        ContactEvent::Touch | ContactEvent::Limit => return Ok(()),
        ContactEvent::Release => (
            "leaves the contact",
            "A path that ends before this event has them; on layers of several materials neither slip nor creep follows from them",
        ),
        ContactEvent::Yield => (
            "yields",
            "Unload, and follow the elastic path of the residual surface: up to the load before unloading it is that of this contact",
        ),
    };
    let (ix, iy) = state.node;
    Err(BedError::NotElasticGrowth { event: state.step, ix, iy, happens, instead }.into())
}

/// Load, approach and mean gap of a state behind others, which fall and rise by no more than rounding there. A mean gap
/// is a difference of lengths as great as that at first touch.
fn grown(last: [f64; 3], state: &LoadingState, open: f64) -> Result<[f64; 3], Error> {
    let now = [state.contact.load, state.contact.approach, state.contact.mean_gap];
    let grown = [now[0].max(last[0]), now[1].max(last[1]), now[2].min(last[2])];
    let quantities = [
        ("load", "finite, and no less"),
        ("approach", "finite, and no less"),
        ("mean gap", "finite, and no more"),
    ];
    for (k, (quantity, expected)) in quantities.into_iter().enumerate() {
        let (value, before) = (now[k], last[k]);
        let size = [before.abs(), before.abs(), open][k];
        let is_right = (value - grown[k]).abs() <= ROUNDING * size;
        if !is_right || !value.is_finite() {
            let step = state.step;
            return Err(BedError::NotMonotone { step, quantity, value, before, expected }.into());
        }
    }
    Ok(grown)
}
