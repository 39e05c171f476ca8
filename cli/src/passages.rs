//! What happens once as contact grows: it percolates, and the gap seals.

use asperity::Boundary;
use asperity::contact::ContactSequence;
use asperity::patches::{Connectivity, Percolation};

/// Something that happens once as contact grows, if it does.
pub(crate) struct Passage<T> {
    /// What holds from then on, in few words.
    pub(crate) name: &'static str,
    /// The same for programs.
    pub(crate) key: &'static str,
    /// Where it happens first.
    pub(crate) at: Option<T>,
}

/// From end to end of the surface; `at` makes something of the number of nodes in contact.
pub(crate) fn from_end_to_end<T>(
    contact: &ContactSequence,
    boundary: Boundary,
    connectivity: Connectivity,
    at: impl Fn(usize) -> Option<T>,
) -> [Passage<T>; 4] {
    let found = Percolation::of(contact, boundary, connectivity);
    let passage = |name, key, nodes: Option<usize>| {
        let at = nodes.and_then(&at);
        Passage { name, key, at }
    };
    [
        passage("percolates along x", "percolates_x", found.contact_x),
        passage("percolates along y", "percolates_y", found.contact_y),
        passage("seals along x", "seals_x", found.seal_x),
        passage("seals along y", "seals_y", found.seal_y),
    ]
}

/// Around the grid, along the directions in which the half-space repeats.
pub(crate) fn around<T>(
    contact: &ContactSequence,
    boundary: Boundary,
    connectivity: Connectivity,
    at: impl Fn(usize) -> Option<T>,
) -> Vec<Passage<T>> {
    let found = Percolation::winding(contact, boundary, connectivity);
    let [x, y] = boundary.repeats();
    let passages = [
        (x, "a patch winds along x", "patch_winds_x", found.contact_x),
        (y, "a patch winds along y", "patch_winds_y", found.contact_y),
        (x, "no channel winds along x", "no_channel_winds_x", found.seal_x),
        (y, "no channel winds along y", "no_channel_winds_y", found.seal_y),
    ];
    let repeats = passages.into_iter().filter(|(repeats, ..)| *repeats);
    repeats.map(|(_, name, key, nodes)| Passage { name, key, at: nodes.and_then(&at) }).collect()
}
