//! The end of paths that would not come to one.

use crate::Error;

/// Events at a single approach, for each node of the grid, after which no end of them is expected.
///
/// Nodes that touch and leave together are sorted out by the least index among them, which comes to an end (Murty,
/// Opsearch 11 (1974) 123–130), in practice after one or two events a node. With adhesion a node passes through five
/// states at most; but where a pull may open a gap, nodes of one height may take turns.
const MOST: usize = 20;

/// How many events there were at the present approach of a path.
#[derive(Debug, Default)]
pub(crate) struct TiedEvents {
    count: usize,
}

impl TiedEvents {
    /// Counts some more, which have led to an approach on a grid of so many nodes: from none where the path has moved
    /// with them.
    ///
    /// # Errors
    ///
    /// [`Error::Cycling`] for too many.
    pub(crate) fn add(
        &mut self,
        events: usize,
        has_moved: bool,
        (approach, nodes): (f64, usize),
    ) -> Result<(), Error> {
        self.count = if has_moved { 0 } else { self.count + events };
        if self.count > MOST * (nodes + 1) {
            return Err(Error::Cycling { approach, events: self.count });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twenty events for each of five nodes and one more, all at one approach, and as many behind the next.
    #[test]
    fn events_at_one_approach_come_to_an_end() -> Result<(), Error> {
        let mut tied = TiedEvents::default();
        for (approach, has_moved) in [(1.0, false), (1.5, true)] {
            tied.add(7, has_moved, (approach, 5))?;
            let others = if has_moved { 120 } else { 113 };
            (0..others).try_for_each(|_| tied.add(1, false, (approach, 5)))?;
        }
        let refused = tied.add(1, false, (1.5, 5));
        let expected = matches!(refused, Err(Error::Cycling { approach: 1.5, events: 121 }));
        assert!(expected, "{refused:?}");
        Ok(())
    }
}
