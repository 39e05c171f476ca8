//! Rubber and polymers: contact of linear viscoelastic bodies, from the elastic path.
//!
//! The displacement of a linear viscoelastic half-space is $`u(t) = C \int J(t - s)\, \mathrm{d}p(s)`$, C being the
//! influence matrix of E\* = 1 and J(t) the creep function of 1/E\*. Nothing else changes: contact is unilateral and
//! frictionless. Its solution is a superposition of the increments of the *elastic* path of the same surface
//! ([`bed`](crate::bed)), exactly so on the discretised surface, so that nothing is solved for it: areas, gaps and
//! loads over time come out of the record of the path.
//!
//! | question | answer |
//! |---|---|
//! | the modulus | [`Prony`]: relaxation or creep, one body or two |
//! | load or approach over time | [`PiecewiseLinear`] |
//! | contact under a load, as long as it grows | [`Creep`]: in closed form at any time, and the time of every event |
//! | contact at an approach that does not fall: stress relaxation | [`Relaxation`] |
//! | one unloading | [`Unloading`]: one root |
//! | anything else: cycles, rebound, separation and return | [`ViscoelasticBed`], in steps of time |
//! | energy lost in cycles | [`ViscoelasticBed::cycle`] |
//!
//! # Growing contact
//!
//! Contact and gaps at t are those of the elastic path at the *effective load* $`W_e(t) = E^\ast \int J(t - s)\,
//! \mathrm{d}W(s)`$, as long as that has not fallen. It is this load and not W that must not fall. Afterwards the
//! formula is wrong without any sign of it, by a hundred percent of the area before long. [`Creep`] finds the time in
//! closed form and refuses what comes after it, with [`ContactRecedes`](crate::CreepError::ContactRecedes).
//!
//! # Any history
//!
//! Each increment of the path is an element with an internal state of its own. The elements in contact are always the
//! first so many of them. With that the bed is exact of the contact problem in steps of time, whatever the history, for
//! Prony series of positive coefficients: see [`ViscoelasticBed`].
//!
//! # Conditions
//!
//! Those of the path, and: linear viscoelastic bodies with a Poisson's ratio that does not depend on time (or with the
//! creep function of 1/E\* as a whole); small strains at one temperature; no friction, adhesion or inertia. Only ratios
//! to the E\* of the path matter: see [`Prony::relative_to`]. Paths on which nodes leave or yield are refused
//! ([`BedError`](crate::BedError)).

mod control_history;
mod cycle;
mod exponential_sum;
mod growth;
mod hereditary;
mod load_controlled;
mod onset;
mod piecewise_linear;
mod prony;
mod relaxation;
mod secular;
mod state;
mod unloading;
mod viscoelastic_bed;
mod weights;

pub use control_history::{ControlHistory, Steps};
pub use cycle::{Cycle, CycleSettings};
pub use load_controlled::{Creep, Recession};
pub use piecewise_linear::PiecewiseLinear;
pub use prony::{Prony, PronyTerm};
pub use relaxation::Relaxation;
pub use state::CreepState;
pub use unloading::{Unloading, UnloadingState};
pub use viscoelastic_bed::{Control, ViscoelasticBed};
