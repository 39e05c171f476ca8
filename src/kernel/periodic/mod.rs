//! Periodic half-spaces: the whole surface repeats with the sides of the grid.

mod even;
mod love;
mod spectral;
mod symmetric;

pub use love::PeriodicBoussinesq;
pub use spectral::Spectral;
