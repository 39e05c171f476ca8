//! The settings of a solver, which never change while it runs.

use crate::Error;

/// Settings of a solver.
#[derive(Debug, Clone, Copy)]
pub(super) struct Settings {
    pub(super) tolerance: f64,
    pub(super) max_iterations: usize,
    /// Whether to start from coarser grids.
    pub(super) nested: bool,
    /// Whether stiffnesses come with every solution.
    pub(super) stiffness: bool,
    /// Bytes held at most, `None` for the default.
    pub(super) memory_budget: Option<usize>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            max_iterations: 5000,
            nested: true,
            stiffness: true,
            memory_budget: None,
        }
    }
}

impl Settings {
    /// `Ok` if the settings make sense.
    pub(super) fn check(&self) -> Result<(), Error> {
        if self.tolerance > 0.0 && self.tolerance < 1.0 {
            return Ok(());
        }
        Err(Error::OutOfRange {
            quantity: "tolerance",
            value: self.tolerance,
            expected: "above 0 and below 1",
        })
    }
}
