//! How pressures and gaps are distributed over the nodes.

use nalgebra::DMatrix;

use super::{Bins, Histogram};
use crate::{Error, Grid};

/// The distribution of a field over the nodes in contact, or over those out of contact.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FieldDistribution {
    /// The histogram of the nodes counted; its density has the integral 1 if none lies outside.
    pub histogram: Histogram,
    /// The share of nodes in contact, A/A₀.
    pub contact_area_fraction: f64,
}

/// The distribution of the pressure \[Pa\] over the nodes in contact.
///
/// Its density times [`contact_area_fraction`](FieldDistribution::contact_area_fraction) is that over the nominal area,
/// with the
/// integral A/A₀, which [`AreaLoadLaw::persson_density`](crate::reference::AreaLoadLaw::persson_density) is to be
/// compared with. The node that touches at a state of a path has no pressure yet, and is in contact.
///
/// # Errors
///
/// Those of [`Grid::new`] without nodes, [`Error::GridMismatch`] if the shapes differ, [`Error::FieldNotFinite`], and
/// those of [`Histogram::new`].
pub fn pressure_distribution(
    pressure: &DMatrix<f64>,
    contact_map: &DMatrix<bool>,
    bins: Bins,
) -> Result<FieldDistribution, Error> {
    over("pressure", pressure, contact_map, true, bins)
}

/// The distribution of the gap \[m\] over the nodes out of contact.
///
/// Over the nominal area the density of the gap is
/// ```math
/// P(g) = \frac{A}{A_0}\, \delta(g) + \left(1 - \frac{A}{A_0}\right) P_\mathrm{out}(g)
/// ```
/// with the density $`P_\mathrm{out}`$ of the histogram, and the [`contact_area_fraction`](FieldDistribution::contact_area_fraction)
/// A/A₀ as the weight of a closed gap.
///
/// # Errors
///
/// Those of [`pressure_distribution`].
pub fn gap_distribution(
    gap: &DMatrix<f64>,
    contact_map: &DMatrix<bool>,
    bins: Bins,
) -> Result<FieldDistribution, Error> {
    over("gap", gap, contact_map, false, bins)
}

/// Over the nodes that are in contact, or not.
fn over(
    name: &'static str,
    field: &DMatrix<f64>,
    contact_map: &DMatrix<bool>,
    in_contact: bool,
    bins: Bins,
) -> Result<FieldDistribution, Error> {
    let (nx, ny) = field.shape();
    let grid = Grid::new(nx, ny, 1.0, 1.0)?;
    grid.check_shape(contact_map.shape())?;
    grid.check_finite(name, field)?;
    let nodes = field.iter().zip(contact_map.iter());
    let counted = nodes.filter(|(_, is_in)| **is_in == in_contact);
    let touching = contact_map.iter().filter(|is_in| **is_in).count();
    Ok(FieldDistribution {
        histogram: Histogram::new(counted.map(|(value, _)| *value), bins)?,
        contact_area_fraction: touching as f64 / field.len() as f64,
    })
}
