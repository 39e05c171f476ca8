//! Periodic half-spaces: the whole surface repeats with the sides of the grid.

mod cells;
mod even;
mod love;
mod spectral;
mod symmetric;

pub(crate) use cells::check_periodic_cells;
pub use love::PeriodicBoussinesq;
pub use spectral::Spectral;
