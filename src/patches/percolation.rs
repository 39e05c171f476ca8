//! When contact percolates, and when the last channel between the surfaces closes.

use super::Connectivity;
use super::forest::Forest;
use super::lattice::Lattice;
use crate::Boundary;
use crate::contact::ContactSequence;
use crate::surface::Axis;

/// Which nodes out of contact are neighbours: fluid flows through the sides of cells.
pub(super) const CHANNELS: Connectivity = Connectivity::Four;

/// The states at which contact percolates and at which the gap seals, each given as a number of nodes in contact.
///
/// *Contact percolates* along x at the first state at which one patch alone leads all the way along x. *The gap seals*
/// along x at the first state at which no channel through the nodes out of contact does: from there on nothing leaks
/// along x. `None` stands for what had not happened at the last state. There are two questions:
///
/// * [`of`](Self::of), *from end to end*: a patch or a channel leads from one end of the grid to the other. Where the
///   boundary repeats along the other direction it may lead across that border; the border between the ends is cut.
///   This is a seal, with the fluid before one end and behind the other, and what percolation and sealing mean
///   everywhere in this crate: [`Seal`](crate::leak::Seal) finds a leak exactly before `seal_x`.
/// * [`winding`](Self::winding), *around the grid*: along a direction in which the boundary repeats, a patch or a
///   channel winds around the grid, and so goes on without end in the repeated surface. One that climbs as it winds
///   around goes on along both directions. What winds around leads from end to end as well, but what leads from end to
///   end need not meet its own beginning across the border: contact percolates no later than it winds, and the gap
///   seals no sooner than the last channel that winds is closed. Where the boundary does not repeat both are the same.
///
/// Patches have the `connectivity` given. Channels pass through the sides of cells, as [flow](crate::leak) does,
/// whatever the connectivity, so that a patch and a channel never cross. With [`Connectivity::Eight`] on a free
/// boundary one of the two leads along one direction exactly if the other does not lead along the other: `seal_x` is
/// `contact_y`, and `seal_y` is `contact_x`.
///
/// Nodes that never touch are open throughout. Both take O(n α(n)), the channels from the last state backwards.
///
/// ```
/// use asperity::contact::ContactSequence;
/// use asperity::patches::{Connectivity, Percolation};
/// use asperity::{Boundary, Grid};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let grid = Grid::square(3, 1.0)?;
/// // A row along x, from end to end at the third node.
/// let contact = ContactSequence::with_order(grid, [3, 5, 4])?;
/// let found = Percolation::of(&contact, Boundary::Free, Connectivity::Eight);
/// assert_eq!((found.contact_x, found.contact_y), (Some(3), None));
/// assert_eq!((found.seal_x, found.seal_y), (None, Some(3)));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Percolation {
    /// The first state at which a patch percolates along x.
    pub contact_x: Option<usize>,
    /// The same along y.
    pub contact_y: Option<usize>,
    /// The first state at which no channel leads along x: it seals.
    pub seal_x: Option<usize>,
    /// The same along y.
    pub seal_y: Option<usize>,
}

impl Percolation {
    /// From one end of the grid to the other.
    #[must_use]
    pub fn of(contact: &ContactSequence, boundary: Boundary, connectivity: Connectivity) -> Self {
        Self::on(contact, boundary, connectivity, Lattice::cut)
    }

    /// Around the grid, where the boundary repeats.
    #[must_use]
    pub fn winding(
        contact: &ContactSequence,
        boundary: Boundary,
        connectivity: Connectivity,
    ) -> Self {
        Self::on(contact, boundary, connectivity, |lattice, _| lattice)
    }

    /// On the lattices that `ends` makes for each direction.
    fn on(
        contact: &ContactSequence,
        boundary: Boundary,
        connectivity: Connectivity,
        ends: impl Fn(Lattice, Axis) -> Lattice,
    ) -> Self {
        let nodes = contact.grid().nodes();
        let last = contact.len();
        let of_contact = |axis| {
            let lattice = Lattice::new(contact.grid(), boundary, connectivity);
            percolates(ends(lattice, axis), axis, contact.order().iter().copied())
        };
        let of_channels = |axis| {
            let lattice = Lattice::new(contact.grid(), boundary, CHANNELS);
            let never = (0..nodes).filter(|&node| !contact.contains(node));
            let backwards = contact.order().iter().rev().copied();
            let open = percolates(ends(lattice, axis), axis, never.chain(backwards))?;
            // With so many nodes out of contact there is a channel, with one less there is none.
            let step = nodes - open + 1;
            (step <= last).then_some(step)
        };
        Self {
            contact_x: of_contact(Axis::X),
            contact_y: of_contact(Axis::Y),
            seal_x: of_channels(Axis::X),
            seal_y: of_channels(Axis::Y),
        }
    }
}

/// How many nodes it takes, in this order, until one patch of them percolates along an axis.
pub(super) fn percolates(
    lattice: Lattice,
    axis: Axis,
    mut nodes: impl Iterator<Item = usize>,
) -> Option<usize> {
    let mut forest = Forest::new(lattice);
    let before = nodes.position(|node| {
        forest.add(node);
        forest.percolates(node, axis)
    })?;
    Some(before + 1)
}
