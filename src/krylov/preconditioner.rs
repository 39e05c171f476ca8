//! A preconditioner of two levels for conjugate gradients on a contact set.

use super::coarse::CoarseSpace;
use super::{NodeSet, SparseInverse};
use crate::kernel::KernelTable;

/// With V the sparse inverse and P, Q of the coarse space,
///
/// ```math
/// M = Q + (1 - P)\, V\, (1 - P) ,
/// ```
///
/// symmetric and positive definite. V turns smooth displacements into spurious pressures everywhere,
/// since the weights of each of its columns sum to less than one: long waves are taken from it, and
/// solved for on hat functions.
/// Where the grid or the contact is too small for hat functions, M = V.
#[derive(Debug, Clone)]
pub(crate) struct Preconditioner {
    inverse: SparseInverse,
    coarse: Option<CoarseSpace>,
    rest: Vec<f64>,
}

impl Preconditioner {
    /// Bytes taken for each node in contact at most.
    pub(crate) const BYTES_A_NODE: usize =
        <SparseInverse>::BYTES_A_NODE + size_of::<f64>() + size_of::<u32>();

    /// For an empty contact set.
    pub(crate) fn new(table: &KernelTable) -> Self {
        Self {
            inverse: SparseInverse::new(table),
            coarse: CoarseSpace::new(table),
            rest: Vec::new(),
        }
    }

    /// Makes it that of another contact set. Few nodes more or less cost little.
    pub(crate) fn update(&mut self, contact: &NodeSet) {
        if self.inverse.update(contact)
            && let Some(coarse) = &mut self.coarse
        {
            coarse.update(contact);
        }
    }

    /// The contact set that the coarse matrix was computed for, which depends on the sets that came before the present
    /// one; nothing else does.
    pub(crate) fn coarse_nodes(&self) -> &[u32] {
        self.coarse.as_ref().map_or(&[], CoarseSpace::inverted)
    }

    /// Makes it that of a contact set, with the coarse matrix of the set `coarse` as long as that serves.
    pub(crate) fn recall(&mut self, coarse: &NodeSet, contact: &NodeSet) {
        self.inverse.update(contact);
        if let Some(space) = &mut self.coarse {
            space.invert_anew(coarse);
            space.update(contact);
        }
    }

    /// z = M r for values at the nodes in contact.
    pub(crate) fn apply(&mut self, r: &[f64], z: &mut Vec<f64>) {
        match &mut self.coarse {
            Some(coarse) if coarse.is_useful() => {
                coarse.project_out(self.inverse.contact(), r, &mut self.rest);
                self.inverse.apply(&self.rest, z);
                coarse.complete(self.inverse.contact(), z);
            }
            _ => self.inverse.apply(r, z),
        }
    }

    /// V alone, for what concerns a few nodes and their neighbours.
    pub(crate) fn sparse(&mut self) -> &mut SparseInverse {
        &mut self.inverse
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        let coarse = self.coarse.as_ref().map_or(0, CoarseSpace::bytes);
        self.inverse.bytes() + coarse + size_of_val(&self.rest[..])
    }
}

#[cfg(test)]
mod tests;
