//! Where the widest channel between the surfaces is narrowest.

use nalgebra::DMatrix;

use super::lattice::Lattice;
use super::percolation::{CHANNELS, percolates};
use crate::surface::Axis;
use crate::{Boundary, Error, Grid};

/// The narrowest place of the widest channel: what a fluid has to pass, whichever way it takes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Constriction {
    /// The node, (ix, iy).
    pub node: (usize, usize),
    /// The gap there \[m\].
    pub gap: f64,
}

/// The narrowest place of the widest channel that leads along an axis through the nodes out of contact: of all channels
/// the one whose least gap is greatest. Channels lead from one end of the grid to the other through the sides of cells,
/// as in [`Percolation::of`](super::Percolation::of). `None` if none does: the contact seals.
///
/// It takes O(n log n) for n nodes out of contact.
///
/// # Errors
///
/// [`Error::GridMismatch`] if a field has another shape than the grid, and [`Error::FieldNotFinite`].
pub fn constriction(
    gap: &DMatrix<f64>,
    contact_map: &DMatrix<bool>,
    (grid, boundary): (&Grid, Boundary),
    axis: Axis,
) -> Result<Option<Constriction>, Error> {
    grid.check_shape(contact_map.shape())?;
    grid.check_finite("gap", gap)?;
    let mut open: Vec<usize> =
        (0..grid.nodes()).filter(|&node| !contact_map.as_slice()[node]).collect();
    let gap_of = |node: usize| gap.as_slice()[node];
    open.sort_by(|a, b| gap_of(*b).total_cmp(&gap_of(*a)));
    let lattice = Lattice::new(*grid, boundary, CHANNELS).cut(axis);
    let count = percolates(lattice, axis, open.iter().copied());
    Ok(count.and_then(|count| {
        let node = *open.get(count.checked_sub(1)?)?;
        Some(Constriction { node: grid.coordinates(node), gap: gap_of(node) })
    }))
}
