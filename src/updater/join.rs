//! Nodes that are all known to be in contact join it block by block.

use super::tuning::JOINED;
use super::{LinearUpdater, Schur, WindowFactor};
use crate::contact::ContactSequence;
use crate::{Error, Problem};

/// Lets nodes join a contact and its updater in their order, within `budget` bytes.
///
/// # Errors
///
/// [`Error::MemoryBudget`], [`Error::FactorizationFailed`], those of the contact and of the updater.
pub(crate) fn join_all(
    updater: &mut dyn LinearUpdater,
    problem: &Problem,
    contact: &mut ContactSequence,
    nodes: &[usize],
    budget: usize,
) -> Result<(), Error> {
    for block in nodes.chunks(JOINED) {
        let needed = updater
            .bytes(contact.len() + block.len(), block.len())
            .saturating_add(WindowFactor::bytes(block.len()));
        if needed > budget {
            return Err(Error::MemoryBudget { needed, budget, nodes_that_fit: contact.len() });
        }
        let mut schur = Schur::default();
        updater.watch(problem, contact, block, &mut schur)?;
        let positions: Vec<usize> = (0..block.len()).collect();
        let factor = WindowFactor::of(schur, &positions)?;
        block.iter().try_for_each(|&node| contact.push(node))?;
        updater.join(problem, contact, &factor)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_chain;
    use crate::updater::Dense;

    /// 300 nodes join in blocks of 256 and 44: of a dense updater 16 (256 + 256)² bytes and then 16 (300 + 44)², with
    /// 16 · 256² and 16 · 44² for the window.
    #[test]
    fn contacts_join_within_a_budget() -> Result<(), Error> {
        let problem = test_chain::problem(&[0.0; 300])?;
        let nodes: Vec<usize> = (0..300).rev().collect();
        let joined = |budget| {
            let mut contact = ContactSequence::new(problem.grid());
            let done = join_all(&mut Dense, &problem, &mut contact, &nodes, budget);
            (done, contact)
        };
        let most = 16 * (512 * 512 + 256 * 256);
        let (done, contact) = joined(most);
        assert!(done.is_ok() && contact.order() == nodes);
        let (done, contact) = joined(most - 1);
        assert!(contact.is_empty());
        assert!(
            matches!(done, Err(Error::MemoryBudget { needed, nodes_that_fit: 0, .. }) if needed == most),
            "{done:?}"
        );
        Ok(())
    }
}
