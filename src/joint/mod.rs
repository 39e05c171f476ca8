//! A joint as other programs need it: its conductance with bounds, and its laws as tables for finite elements.
//!
//! Everything here is read from the states of a path ([`History`](crate::loading::History)); nothing is solved.
//!
//! ```
//! use asperity::joint::{Conduction, FeProgram, InterfaceTable};
//! use asperity::{Grid, LoadingSolver, PeriodicBoussinesq, SelfAffine};
//!
//! # fn main() -> Result<(), asperity::Error> {
//! let (e_star, steel) = (115e9, 1.0 / 45.0); // Pa; thermal resistivity [m K/W] of either body
//! let grid = Grid::square(32, 1.25e-3)?;
//! let half_space = PeriodicBoussinesq::new(grid, e_star)?;
//! let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space)
//!     .max_area_fraction(0.3)
//!     .build()?;
//! let history = path.run()?;
//!
//! let heat = Conduction::thermal(e_star, steel + steel)?;
//! let table = InterfaceTable::builder(&history).conduction(heat).friction(0.2, 1.2).tolerance(0.01).build()?;
//! println!("{}", table.text(FeProgram::Abaqus));
//! # assert!(table.rows().len() > 10);
//! # Ok(())
//! # }
//! ```

mod bounds;
mod conduction;
mod table;
mod text;

pub use bounds::ConductanceBounds;
pub use conduction::{Carrier, Conduction};
pub use table::{InterfaceRow, InterfaceTable, InterfaceTableBuilder};
pub use text::{FeProgram, FeUnits};
