//! Nodes that left the linear system, and the contact before they did.

use super::state::ContactEvent;
use crate::updater::Left;

/// A node that left the linear system.
#[derive(Debug, Clone, Copy)]
struct Release {
    /// The number of the event.
    step: usize,
    node: usize,
    /// Where it was in the order of contact.
    position: usize,
    /// Whether it yielded, and stays in contact with its hardness.
    has_yielded: bool,
}

/// All nodes that left, in the order in which they did.
#[derive(Debug, Clone, Default)]
pub(super) struct Releases {
    log: Vec<Release>,
    /// From this step on, contacts are prefixes of what the updater holds.
    prefix_since: usize,
}

impl Releases {
    /// Number of events up to a contact of so many nodes.
    pub(super) fn steps(&self, contact_nodes: usize) -> usize {
        // A node that touched and left is two events, and not in contact.
        contact_nodes + 2 * self.log.len()
    }

    /// How many nodes have left.
    pub(super) fn count(&self) -> usize {
        self.log.len()
    }

    /// Notes that a node left at the event number `step`.
    pub(super) fn push(&mut self, step: usize, Left { node, position }: Left) {
        self.note(Release { step, node, position, has_yielded: false });
    }

    /// Notes that a node yielded at the event number `step`.
    pub(super) fn push_yielded(&mut self, step: usize, Left { node, position }: Left) {
        self.note(Release { step, node, position, has_yielded: true });
    }

    /// Notes either, as the event says.
    pub(super) fn push_event(&mut self, step: usize, event: ContactEvent, left: Left) {
        match event {
            ContactEvent::Yield => self.push_yielded(step, left),
            _ => self.push(step, left),
        }
    }

    fn note(&mut self, release: Release) {
        self.prefix_since = release.step;
        self.log.push(release);
    }

    /// Says that the updater does not hold the contact of any state up to the event number `step`; returns from which
    /// on it did.
    pub(super) fn forget(&mut self, step: usize) -> usize {
        std::mem::replace(&mut self.prefix_since, step + 1)
    }

    /// Says again from which state on it does.
    pub(super) fn remember(&mut self, step: usize) {
        self.prefix_since = step;
    }

    /// The nodes that had yielded after `step` events, in the order in which they did.
    pub(super) fn yielded_at(&self, step: usize) -> impl Iterator<Item = usize> {
        let log = self.log.iter().take_while(move |release| release.step <= step);
        log.filter(|release| release.has_yielded).map(|release| release.node)
    }

    /// Takes back the last one; returns its place and node. The updater stays without it.
    pub(super) fn pop(&mut self) -> Option<(usize, usize)> {
        let last = self.log.pop()?;
        Some((last.position, last.node))
    }

    /// Puts the nodes that had yielded after `step` events back among those of the contact that had not, in the order
    /// of joining.
    pub(super) fn with_yielded(&self, mut elastic: Vec<usize>, step: usize) -> Vec<usize> {
        let log = self.log.iter().rev().filter(|release| release.step <= step);
        for release in log.filter(|release| release.has_yielded) {
            elastic.insert(release.position, release.node);
        }
        elastic
    }

    /// Whether the contact after `step` events is a prefix of what the updater holds.
    pub(super) fn is_prefix(&self, step: usize) -> bool {
        step >= self.prefix_since
    }

    /// The contact after `step` events, in the order of joining, from the present one.
    pub(super) fn contact_at(&self, present: &[usize], step: usize) -> Vec<usize> {
        let mut contact = present.to_vec();
        let mut last = self.steps(present.len());
        let later = self.log.iter().rev();
        for release in later.take_while(|release| release.step > step) {
            // Those that touched after it.
            contact.truncate(contact.len() + release.step - last);
            contact.insert(release.position, release.node);
            last = release.step - 1;
        }
        contact.truncate((contact.len() + step).saturating_sub(last));
        contact
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contacts_before_releases_are_found_again() {
        // Touch 4, 5, 6, release 5, touch 7, release 4, touch 5.
        let mut releases = Releases::default();
        releases.push(4, Left { node: 5, position: 1 });
        releases.push(6, Left { node: 4, position: 0 });
        let present = [6, 7, 5];
        assert_eq!(releases.steps(present.len()), 7);
        let contacts: Vec<_> = (0..=7).map(|k| releases.contact_at(&present, k)).collect();
        let expected: [&[usize]; 8] =
            [&[], &[4], &[4, 5], &[4, 5, 6], &[4, 6], &[4, 6, 7], &[6, 7], &[6, 7, 5]];
        assert_eq!(contacts, expected);
        assert!(releases.is_prefix(6) && !releases.is_prefix(5));
        // The last ones first: node 4 from the first place, node 5 from the second.
        assert_eq!([0, 1, 2].map(|_| releases.pop()), [Some((0, 4)), Some((1, 5)), None]);
        assert_eq!(releases.steps(3), 3);
    }
}
