//! Which branches of a merge tree are drawn, and in which row.

use asperity::patches::Branch;

/// A branch to be drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Leaf {
    /// Its place among all branches.
    pub(super) branch: usize,
    /// The row of the branch that it merges into.
    pub(super) into: Option<usize>,
}

/// The largest branches, row by row from above.
///
/// A branch that goes on at a merger is larger than the other one, so that it is here if the other is. Below each
/// branch are those that merge into it, earlier mergers nearer to it: what lies between a branch and the one it merges
/// into has ended by then, so that no lines cross.
pub(super) fn rows(branches: &[Branch], most: usize) -> Vec<Leaf> {
    let mut largest: Vec<usize> = (0..branches.len()).collect();
    largest.sort_by_key(|&place| std::cmp::Reverse(branches[place].nodes));
    largest.truncate(most);
    // Latest mergers last, and those that never merge by size: the order in which they leave a stack, reversed.
    let mut merging: Vec<Vec<usize>> = vec![Vec::new(); branches.len()];
    let mut waiting = Vec::new();
    for &place in largest.iter().rev() {
        match branches[place].merger {
            Some(merger) => merging[merger.into].push(place),
            None => waiting.push((place, None)),
        }
    }
    let mut leaves = Vec::new();
    while let Some((branch, into)) = waiting.pop() {
        let row = leaves.len();
        leaves.push(Leaf { branch, into });
        let mut parts = std::mem::take(&mut merging[branch]);
        parts.sort_by_key(|&part| {
            let step = branches[part].merger.map(|merger| merger.step);
            std::cmp::Reverse((step, part))
        });
        waiting.extend(parts.into_iter().map(|part| (part, Some(row))));
    }
    leaves
}

#[cfg(test)]
mod tests {
    use asperity::contact::ContactSequence;
    use asperity::patches::{Connectivity, MergeTree};
    use asperity::{Boundary, Error, Grid};

    use super::*;

    /// A path in an order without pattern: multiples of a number without a common divisor with 23 · 23.
    fn branches() -> Result<Vec<Branch>, Error> {
        let grid = Grid::square(23, 1.0)?;
        let nodes = grid.nodes();
        let order = (0..nodes * 3 / 4).map(|k| (k * k * 7 + k * 331) % nodes);
        let mut seen = vec![false; nodes];
        let once = order.filter(|&node| !std::mem::replace(&mut seen[node], true));
        let contact = ContactSequence::with_order(grid, once.collect::<Vec<_>>())?;
        let tree = MergeTree::new(&contact, Boundary::Free, Connectivity::Four);
        Ok(tree.branches().to_vec())
    }

    /// Every line across rows is compared with every line along a row: the definition of crossing.
    #[test]
    fn no_lines_cross() -> Result<(), Error> {
        let branches = branches()?;
        for most in [branches.len(), 20, 5] {
            let leaves = rows(&branches, most);
            assert_eq!(leaves.len(), most.min(branches.len()));
            for (row, leaf) in leaves.iter().enumerate() {
                let (Some(into), Some(merger)) = (leaf.into, branches[leaf.branch].merger) else {
                    continue;
                };
                assert_eq!(leaves[into].branch, merger.into);
                for between in &leaves[into + 1..row] {
                    let other = branches[between.branch];
                    let end = other.merger.map(|merger| merger.step);
                    assert!(end.is_some_and(|end| end <= merger.step));
                }
            }
        }
        Ok(())
    }

    #[test]
    fn every_merger_has_its_row_and_the_largest_patch_is_first() -> Result<(), Error> {
        let branches = branches()?;
        let leaves = rows(&branches, 12);
        let largest = branches.iter().map(|branch| branch.nodes).max();
        let first = leaves.first().map(|leaf| branches[leaf.branch].nodes);
        assert_eq!(first, largest);
        let mut drawn: Vec<usize> = leaves.iter().map(|leaf| leaf.branch).collect();
        drawn.sort_unstable();
        drawn.dedup();
        assert_eq!(drawn.len(), leaves.len());
        for leaf in &leaves {
            assert_eq!(leaf.into.is_some(), branches[leaf.branch].merger.is_some());
        }
        assert!(rows(&[], 12).is_empty());
        Ok(())
    }
}
