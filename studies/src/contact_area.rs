//! The area of a contact without what whole cells count too much along its border.

use asperity::patches::{Connectivity, Patches};
use asperity::{Boundary, Error, Grid};
use nalgebra::DMatrix;

/// The corrected contact area over the nominal area, of all patches together: see
/// [`Perimeter::corrected_area`](asperity::patches::Perimeter::corrected_area).
pub fn corrected_area_fraction(
    contact_map: &DMatrix<bool>,
    grid: &Grid,
    boundary: Boundary,
) -> Result<f64, Error> {
    let patches = Patches::new(contact_map, grid, boundary, Connectivity::Four)?;
    let each = patches.patches().iter();
    let area: f64 = each.map(|patch| patch.perimeter.corrected_area(patch.nodes, grid)).sum();
    Ok(area / grid.nominal_area())
}
