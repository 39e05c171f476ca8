//! Tangential loading of a contact: partial slip, stiffness and dissipation, from the normal path alone.
//!
//! A joint under a normal load P carries a tangential load T. Where the pressure is low the surfaces slip long before
//! the joint slides as a whole, and each cycle of T costs energy. With Coulomb friction of coefficient μ and bodies
//! whose tangential compliance is κ times the normal one, all of it follows from the path of normal loading (Cattaneo
//! 1938; Mindlin 1949; Jäger, Arch. Appl. Mech. 65 (1995) 478; Ciavarella, Int. J. Solids Struct. 35 (1998) 2349):
//! ```math
//! T = \mu\,(P - P^\ast), \qquad q = \mu\,[p(P) - p(P^\ast)], \qquad U = \kappa\mu\,[\delta(P) - \delta(P^\ast)]
//! ```
//! Nodes in contact at P* stick. A node beyond them slips by κμ times its gap at P*.
//!
//! | question | items |
//! |---|---|
//! | displacement, stick area and stiffness under a growing T | [`PartialSlip::monotone`] |
//! | dissipation, secant stiffness and loss factor of a cycle ±T | [`PartialSlip::cycle`] |
//! | the same for a given displacement, beyond sliding too | [`PartialSlip::cycle_of_displacement`] |
//! | the joint as elements of Jenkins: Iwan's distribution | [`PartialSlip::jenkins_elements`] |
//! | any history of P and T | [`SlipHistory`] |
//! | traction, slip, stick and slip zones, friction work of each node | [`PartialSlip::traction`] and its like |
//! | κ and Dundurs' β of two bodies | [`Friction`] |
//!
//! ```
//! use asperity::bed::Bed;
//! use asperity::slip::{Friction, PartialSlip};
//! use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine};
//!
//! # fn main() -> Result<(), asperity::Error> {
//! let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
//! let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space)
//!     .max_load(500.0)
//!     .build()?;
//! let history = path.run()?;
//!
//! let bed = Bed::new(&history)?;
//! let steel = (210e9, 0.3);
//! let joint = PartialSlip::new(&bed, 500.0, Friction::between(0.3, steel, Some(steel))?)?;
//! let cycle = joint.cycle(75.0)?; // ±75 N: half of what friction bears
//! println!("{} J a cycle, from {} slipping nodes", cycle.dissipation, cycle.slipping_nodes);
//! # assert!(cycle.dissipation > 0.0 && cycle.loss_factor < 1.0);
//! # Ok(())
//! # }
//! ```
//!
//! # When it is exact
//!
//! The discrete problem is solved exactly if
//!
//! 1. displacements under tangential tractions are κ times those under pressures, in one direction. Cerruti's
//!    half-space does that for ν = 0; κ is its mean over directions. At ν = 0.3 isotropic rough surfaces had T within
//!    0.5 %, and dissipations within 4 % from a third of the sliding displacement on; ridges along or across T 2.4 % and
//!    5.1 %.
//! 2. tangential tractions do not move surfaces normally: Dundurs' β is 0, as of bodies alike. A rigid surface on a
//!    body of ν = 0.3 has 0.29. T of the first loading is then up to 6 % less, and steady cycles dissipate 2 to 10 %
//!    more, at a tenth of the sliding displacement 9 % less to 29 % more. *The first loading dissipates several times
//!    as much*, since pressing has left tractions that the first shear releases: every dissipation here is that of a
//!    cycle. See [`Friction::is_coupled`].
//! 3. contact grows on the path ([`bed`](crate::bed)), T keeps its direction, and the joint does not slide.
//!
//! The dissipation of a small cycle comes from few nodes, and depends on the grid: some 15 % with 50 slipping nodes, a
//! few per cent with 150. [`SlipCycle::slipping_nodes`] says how many there were.
//!
//! The page `docs/joints_that_slip.md` has the proof, and comparisons with solutions that do not assume any of this.

mod friction;
mod history;
mod preload;
mod state;

pub use friction::Friction;
pub use history::SlipHistory;
pub use preload::{JenkinsElement, PartialSlip, SlipCycle, SlipZone};
pub use state::SlipState;
