//! Periodic half-spaces: the whole surface repeats with the sides of the grid.

mod cells;
mod cosines;
mod even;
mod love;
mod spectral;
mod symmetric;

pub(crate) use cells::check_periodic_cells;
pub(super) use cosines::{CosineSeries, sinc};
pub(super) use even::Even;
pub use love::PeriodicBoussinesq;
pub use spectral::Spectral;
pub(super) use symmetric::{least_gauge, wave_number};
