//! Leakage through the gap between surfaces: Reynolds' equation on the gap of any state.
//!
//! A viscous fluid fills the gap g between the surfaces. Where slopes are small it flows as between parallel plates, by
//! ```math
//! \nabla \cdot \left( \frac{g^3}{12 \eta}\, \nabla p \right) = 0 ,
//! ```
//! with the viscosity η and the fluid pressure p; the pressure is given on two opposite edges of the grid and differs
//! by Δp, nothing flows through nodes in contact, and the other two edges are closed, or joined where the
//! [`Boundary`](crate::Boundary) repeats across the flow.
//!
//! ```
//! use asperity::leak::Seal;
//! use asperity::surface::Axis;
//! use asperity::{ContactTarget, Grid, LoadingSolver, PeriodicBoussinesq, SelfAffine};
//!
//! # fn main() -> Result<(), asperity::Error> {
//! let half_space = PeriodicBoussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
//! let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space).build()?;
//! let history = path.run()?;
//!
//! // Water under 10 bar, from x = 0 to the other end.
//! let seal = Seal::new(1e-3, 1e6, Axis::X)?;
//! let state = history.at(ContactTarget::AreaFraction(0.2))?;
//! let leak = seal.leak_at(&mut path, &state)?;
//! println!("{:e} m³/s under {:e} N", leak.leak_rate, state.contact.load);
//! # assert!(leak.leak_rate > 0.0);
//!
//! // At states of the whole path:
//! let curve = seal.curve(&mut path, &history, 12)?;
//! for point in &curve.points {
//!     println!("{:e} Pa: {:e} m³/s", point.state.contact.mean_pressure(), point.leak_rate);
//! }
//! // In full contact it is closed.
//! assert!(curve.closing.is_some());
//! # Ok(())
//! # }
//! ```
//!
//! # How it is solved
//!
//! Cells are finite volumes: between two nodes flows what the halves of their cells conduct in series, the harmonic
//! mean of g³/12η. The system is symmetric and positive definite, and its conductances differ by ten orders of
//! magnitude and more near the closing of the last channel. Nodes are eliminated in the order of nested dissection,
//! from stars to meshes of conductances: all of them sums and products of positive numbers, so that none loses a digit,
//! whatever the contrast. Above 2²⁰ nodes memory counts: there it is solved by conjugate gradients with an algebraic
//! multigrid preconditioner of aggregates, and by elimination where these do not converge. Pressures are sums of four
//! numbers, and what is lost at all nodes together is at most 10⁻¹¹ of the leak rate, so that the small differences of
//! pressures in wide places, which carry the same flow, are right too.
//!
//! Pools that no channel joins to an edge are left out: their pressure is any. If no channel is left the leak rate is
//! exactly 0. Channels pass through the sides of cells, not across corners.
//!
//! # What it leaves out
//!
//! The pressure of the fluid does not open the gap; surfaces do not slip on the fluid; nothing adheres; slopes are
//! small. The leak rate is that of the grid: constrictions of few cells are narrower or wider than in the continuum,
//! and near the closing of the last channel, where one constriction of a few cells decides, its leak rate is that of
//! one sample. `docs/seals_that_leak.md` shows how it converges.

mod curve;
mod elimination;
mod expansion;
mod flow;
mod graph;
mod hierarchy;
mod mean_field;
mod network;
mod rate;
mod seal;

pub use curve::{LeakCurve, LeakPoint};
pub use rate::{CriticalConstriction, Leak};
pub use seal::Seal;
