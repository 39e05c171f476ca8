//! What has happened to nodes on a path, by which its states are found again.

use super::board::Change;
use super::state::NodeState;
use crate::Error;
use crate::error::AdhesionError;

/// All changes of nodes on a path, and for each of its states how many there were up to it and its approach in the
/// gauge of the kernel.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Trace {
    pub(crate) changes: Vec<Change>,
    pub(crate) marks: Vec<(usize, f64)>,
}

impl Trace {
    /// Forgets what came behind so many states.
    pub(super) fn truncate(&mut self, states: usize) {
        self.marks.truncate(states);
        self.changes.truncate(self.marks.last().map_or(0, |mark| mark.0));
    }

    /// Follows the nodes of a grid from state to state: `each` gets the number of the state from 0 on and how many
    /// nodes are soft, cohesive and in contact. Returns all nodes at the last state.
    ///
    /// # Errors
    ///
    /// [`AdhesionError::WrongChanges`] for changes that no path has, and those of `each`.
    pub(crate) fn follow(
        &self,
        nodes: usize,
        mut each: impl FnMut(usize, [usize; 3]) -> Result<(), Error>,
    ) -> Result<Vec<NodeState>, Error> {
        const COUNTED: [NodeState; 3] = [NodeState::Soft, NodeState::Cohesive, NodeState::Contact];
        let mut states = vec![NodeState::Open; nodes];
        let (mut counts, mut held, mut done) = ([0_usize; 3], 0_usize, 0);
        for (place, &(changes, approach)) in self.marks.iter().enumerate() {
            let wrong = || Error::from(AdhesionError::WrongChanges { step: place + 1 });
            let some = self.changes.get(done..changes).ok_or_else(wrong)?;
            for change in some {
                let state = states.get_mut(change.node).ok_or_else(wrong)?;
                if *state != change.from || change.from == change.to {
                    return Err(wrong());
                }
                *state = change.to;
                for (count, counted) in counts.iter_mut().zip(COUNTED) {
                    *count -= usize::from(change.from == counted);
                    *count += usize::from(change.to == counted);
                }
                held -= usize::from(change.from == NodeState::Held);
                held += usize::from(change.to == NodeState::Held);
            }
            // Between jumps all nodes are on their law.
            if held > 0 || !approach.is_finite() {
                return Err(wrong());
            }
            each(place, counts)?;
            done = changes;
        }
        if done < self.changes.len() {
            return Err(AdhesionError::WrongChanges { step: self.marks.len() + 1 }.into());
        }
        Ok(states)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_belong_to_states() {
        let touch = |node| Change { node, from: NodeState::Open, to: NodeState::Contact };
        let trace = |changes: &[Change]| Trace { changes: changes.to_vec(), marks: vec![(1, 0.5)] };
        let nodes = trace(&[touch(1)]).follow(2, |_, _| Ok(()));
        assert_eq!(nodes.ok(), Some(vec![NodeState::Open, NodeState::Contact]));
        for (changes, step) in [(&[][..], 1), (&[touch(2)], 1), (&[touch(1), touch(0)], 2)] {
            let found = match trace(changes).follow(2, |_, _| Ok(())) {
                Err(Error::Adhesion(AdhesionError::WrongChanges { step })) => Some(step),
                _ => None,
            };
            assert_eq!(found, Some(step));
        }
    }
}
