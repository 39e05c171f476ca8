//! Every state of a path against flood fills of it.

use proptest::prelude::*;

use super::super::*;
use super::flood::{Picture, Pool};
use super::{Case, cases};
use crate::Boundary;
use crate::surface::Axis;

fn sides(perimeter: &Perimeter) -> [usize; 4] {
    [perimeter.along_x, perimeter.along_y, perimeter.border_along_x, perimeter.border_along_y]
}

/// The first state at which something holds, looked at state by state.
fn first(case: &Case, holds: impl Fn(Picture) -> bool) -> Option<usize> {
    (0..=case.order.len()).find(|&step| holds(case.picture(step)))
}

/// What happened between two states: how many patches of the former are part of that of the new node.
fn joined(before: &[Pool], after: &[Pool], node: usize) -> usize {
    let touched = after.iter().find(|pool| pool.nodes.contains_key(&node));
    let is_part = |pool: &&Pool| {
        touched
            .is_some_and(|touched| pool.nodes.keys().any(|node| touched.nodes.contains_key(node)))
    };
    before.iter().filter(is_part).count()
}

proptest! {
    #[test]
    fn every_state_has_the_patches_of_a_flood_fill(case in cases()) {
        let contact = case.contact()?;
        let history: Vec<_> = PatchHistory::new(&contact, case.boundary, case.connectivity).collect();
        prop_assert_eq!(history.len(), case.order.len());
        let mut before = Vec::new();
        for (state, step) in history.iter().zip(1..) {
            let picture = case.picture(step);
            let pools = picture.pools();
            let node = case.order[step - 1];
            prop_assert_eq!(state.step, step);
            prop_assert_eq!(state.node, case.grid()?.coordinates(node));
            prop_assert_eq!(state.patches, pools.len());
            prop_assert_eq!(Some(state.largest), pools.iter().map(|pool| pool.nodes.len()).max());
            let expected = match joined(&before, &pools, node) {
                0 => PatchEvent::Birth,
                1 => PatchEvent::Growth,
                patches => PatchEvent::Merge { patches },
            };
            prop_assert_eq!(state.event, expected);
            let found = picture.sides(case.order[..step].iter().copied());
            prop_assert_eq!(sides(&state.perimeter), found);
            prop_assert_eq!(state.perimeter.sides(), found.iter().sum::<usize>());
            before = pools;
        }
    }

    #[test]
    fn percolation_and_leakage_come_when_flood_fills_say(case in cases()) {
        let contact = case.contact()?;
        let spans = |now: &Picture, axis| now.cut(axis).percolates(axis);
        let found = Percolation::of(&contact, case.boundary, case.connectivity);
        prop_assert_eq!(found.contact_x, first(&case, |now| spans(&now, Axis::X)));
        prop_assert_eq!(found.contact_y, first(&case, |now| spans(&now, Axis::Y)));
        prop_assert_eq!(found.seal_x, first(&case, |now| !spans(&now.channels(), Axis::X)));
        prop_assert_eq!(found.seal_y, first(&case, |now| !spans(&now.channels(), Axis::Y)));

        let ends = found;
        let found = Percolation::winding(&contact, case.boundary, case.connectivity);
        let never = |step: Option<usize>| step.unwrap_or(usize::MAX);
        prop_assert!(never(ends.contact_x) <= never(found.contact_x));
        prop_assert!(never(ends.contact_y) <= never(found.contact_y));
        prop_assert!(never(ends.seal_x) >= never(found.seal_x));
        prop_assert!(never(ends.seal_y) >= never(found.seal_y));
        prop_assert_eq!(found.contact_x, first(&case, |now| now.percolates(Axis::X)));
        prop_assert_eq!(found.contact_y, first(&case, |now| now.percolates(Axis::Y)));
        prop_assert_eq!(found.seal_x, first(&case, |now| !now.channels().percolates(Axis::X)));
        prop_assert_eq!(found.seal_y, first(&case, |now| !now.channels().percolates(Axis::Y)));
    }

    /// A theorem of the plane, which neither side of the comparison uses: a channel from end to end and a patch
    /// across it exclude each other, and one of them is there.
    #[test]
    fn on_a_free_boundary_leakage_ends_as_contact_percolates_across(case in cases()) {
        let found = Percolation::of(&case.contact()?, Boundary::Free, Connectivity::Eight);
        prop_assert_eq!(found.seal_x, found.contact_y);
        prop_assert_eq!(found.seal_y, found.contact_x);
    }

    /// A patch of the tree is named by its first node: at every state it must be the oldest node of its flood.
    #[test]
    fn the_tree_has_the_patches_of_every_state(case in cases()) {
        let tree = MergeTree::new(&case.contact()?, case.boundary, case.connectivity);
        let grid = case.grid()?;
        let mut births: Vec<usize> = Vec::new();
        for branch in tree.branches() {
            births.push(branch.birth);
            let first = case.order[branch.birth - 1];
            prop_assert_eq!(branch.node, grid.coordinates(first));
            // At its end, or at the last state.
            let last = branch.merger.map_or(case.order.len(), |merger| merger.step - 1);
            let pools = case.picture(last).pools();
            let own = pools.iter().find(|pool| pool.nodes.contains_key(&first));
            prop_assert_eq!(own.map(|pool| pool.nodes.len()), Some(branch.nodes));
            if let Some(merger) = branch.merger {
                let heir = &tree.branches()[merger.into];
                prop_assert!(heir.birth < branch.birth && heir.lives_at(merger.step));
                let pools = case.picture(merger.step).pools();
                let common = pools.iter().find(|pool| pool.nodes.contains_key(&first));
                let other = case.order[heir.birth - 1];
                prop_assert!(common.is_some_and(|pool| pool.nodes.contains_key(&other)));
            }
        }
        prop_assert!(births.is_sorted());
        for step in 1..=case.order.len() {
            let pools = case.picture(step).pools();
            let mut oldest: Vec<usize> = pools
                .iter()
                .filter_map(|pool| case.order.iter().position(|node| pool.nodes.contains_key(node)))
                .map(|place| place + 1)
                .collect();
            oldest.sort_unstable();
            let living = tree.branches().iter().filter(|branch| branch.lives_at(step));
            let living: Vec<usize> = living.map(|branch| branch.birth).collect();
            prop_assert_eq!(living, oldest);
        }
    }
}
