//! Periodic half-spaces: the whole surface repeats with the sides of the grid, or with one of them.

mod cells;
mod cosines;
mod even;
mod love;
mod semi;
mod spectral;
mod symmetric;

pub(crate) use cells::check_periodic_cells;
pub(super) use cosines::CosineSeries;
pub(crate) use cosines::sinc;
pub(super) use even::Even;
pub use love::PeriodicBoussinesq;
pub use semi::SemiPeriodicBoussinesq;
pub use spectral::Spectral;
pub(super) use symmetric::{inverse, least_gauge, wave_number};
