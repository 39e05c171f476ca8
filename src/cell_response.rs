//! The sizes of numbers that a contact problem may have.

use crate::Error;
use crate::kernel::KernelTable;

/// Lengths, compliances and pressures lie between 1 / `GREATEST` and this. Their products in pairs, which
/// iterations need, then have all their digits, residuals 10¹⁰ times as small included.
const GREATEST: f64 = 1e140;
const RANGE: &str = "between 1e-140 and 1e140 in the units of the input";
/// The same for products of two of them and an area.
const GREATEST_PRODUCT: f64 = 1e280;
const PRODUCT_RANGE: &str = "between 1e-280 and 1e280 in the units of the input";

/// How a single cell answers its own pressure: what turns lengths into pressures, loads and energies of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CellResponse {
    /// C(0, 0).
    own: f64,
    cell_area: f64,
}

impl CellResponse {
    /// For the displacement of a cell of some area under its own unit pressure.
    pub(crate) fn new(own: f64, cell_area: f64) -> Self {
        Self { own, cell_area }
    }

    /// That of a kernel.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] if C(0, 0) or the stiffness of a cell is beyond what can be computed with.
    pub(crate) fn of(table: &KernelTable) -> Result<Self, Error> {
        let (own, cell_area) = (table.self_influence(), table.grid().cell_area());
        check("influence coefficient C(0, 0)", own)?;
        check_product("stiffness of a cell, its area over C(0, 0)", cell_area / own)?;
        Ok(Self::new(own, cell_area))
    }

    /// `Ok` if a cell can be displaced by a length, what is computed being numbers.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] otherwise.
    pub(crate) fn check(self, length: f64) -> Result<(), Error> {
        let pressure = length / self.own;
        let load = self.cell_area * pressure;
        check("greatest gap or displacement", length)?;
        check("pressure of a cell under that displacement", pressure)?;
        check_product("load of a cell under that displacement", load)?;
        check_product("energy of a cell under that displacement", load * length)
    }

    /// The gap below which it, or the pressure that closes it, is too small to compute with.
    pub(crate) fn negligible_gap(self) -> f64 {
        self.own.max(1.0) / GREATEST
    }

    /// The displacement of a cell under its own pressure.
    pub(crate) fn displacement(self, pressure: f64) -> f64 {
        self.own * pressure
    }
}

fn check(quantity: &'static str, value: f64) -> Result<(), Error> {
    within(quantity, value, GREATEST, RANGE)
}

fn check_product(quantity: &'static str, value: f64) -> Result<(), Error> {
    within(quantity, value, GREATEST_PRODUCT, PRODUCT_RANGE)
}

fn within(
    quantity: &'static str,
    value: f64,
    greatest: f64,
    expected: &'static str,
) -> Result<(), Error> {
    let is_within = value >= greatest.recip() && value <= greatest;
    Error::require(quantity, value, is_within, expected).map(drop)
}
