//! A contact that is known as a whole, joined block by block.

use super::{LinearUpdater, Schur, Touched};
use crate::contact::ContactSequence;
use crate::{Error, Problem};

/// Nodes that join at a time: so many that a factor grows at the speed of a matrix product.
pub(crate) const JOINED: usize = 256;

/// Lets nodes join a contact and its updater in their order, within `budget` bytes. An updater that is not exact
/// learns of the rest when it is asked to solve.
///
/// # Errors
///
/// [`Error::MemoryBudget`], [`Error::FactorizationFailed`], those of the contact and of the updater.
pub(crate) fn join_all(
    updater: &mut (impl LinearUpdater + ?Sized),
    problem: &Problem,
    contact: &mut ContactSequence,
    nodes: &[usize],
    budget: usize,
) -> Result<(), Error> {
    for block in nodes.chunks(JOINED) {
        if updater.profile().exact {
            let needed = updater
                .bytes(contact.len() + block.len(), block.len())
                .saturating_add(Touched::bytes(block.len()));
            if needed > budget {
                return Err(Error::MemoryBudget {
                    needed,
                    budget,
                    nodes_that_fit: contact.len(),
                });
            }
            let mut schur = Schur::default();
            updater.watch(problem, contact, block, &mut schur)?;
            let positions: Vec<usize> = (0..block.len()).collect();
            let touched = Touched::of(schur, &positions)?;
            block.iter().try_for_each(|&node| contact.push(node))?;
            updater.join(problem, contact, &touched)?;
        } else {
            block.iter().try_for_each(|&node| contact.push(node))?;
        }
    }
    Ok(())
}
