//! What the rows of a window do to soft nodes.

use super::soft::Half;

/// The columns of the soft nodes, one for each row and for two sums behind them.
pub(super) struct Rows {
    /// The nodes of the rows, ascending.
    pub(super) nodes: Vec<usize>,
    pub(super) half: Half,
    /// 1, or −1 where what is given of a row lowers the pressures of soft nodes as its column in `half` raises them.
    pub(super) signs: Vec<f64>,
}

/// Where the columns of rows come from.
pub(super) struct Sources {
    /// The place among those that are known, or else among those that are solved for.
    pub(super) columns: Vec<Result<usize, usize>>,
    /// Those that are solved for.
    pub(super) new: Vec<usize>,
}

impl Sources {
    /// Of rows of nodes in ascending order.
    pub(super) fn of(nodes: &[usize], known: Option<&Rows>) -> Self {
        let mut sources = Self { columns: Vec::with_capacity(nodes.len() + 2), new: Vec::new() };
        for column in 0..nodes.len() + 2 {
            let place = known.and_then(|known| match nodes.get(column) {
                Some(node) => known.nodes.binary_search(node).ok(),
                None => Some(column - nodes.len() + known.nodes.len()),
            });
            sources.columns.push(place.ok_or(sources.new.len()));
            if place.is_none() {
                sources.new.push(column);
            }
        }
        sources
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;
    use crate::adhesion::soft::Soft;
    use crate::updater::Schur;

    /// Of the nodes 2, 4, 7 and 9 the second and the last are known, and so are the sums.
    #[test]
    fn rows_that_are_known_are_found() -> Result<(), Error> {
        let sources = Sources::of(&[2, 4], None);
        assert_eq!(sources.columns, [Err(0), Err(1), Err(2), Err(3)]);
        assert_eq!(sources.new, [0, 1, 2, 3]);
        let none = Soft::of(&Schur::default(), Vec::new(), 1.0);
        let none = none.ok_or(Error::FactorizationFailed { nodes: 0 })?;
        let half = none.half(Vec::new(), 5);
        let known = Rows { nodes: vec![4, 5, 9], half, signs: vec![1.0; 3] };
        let sources = Sources::of(&[2, 4, 7, 9], Some(&known));
        assert_eq!(sources.columns, [Err(0), Ok(0), Err(1), Ok(2), Ok(3), Ok(4)]);
        assert_eq!(sources.new, [0, 2]);
        Ok(())
    }
}
