//! What there is room for: WebAssembly has addresses for 2 GB here, and whoever runs out of them ends without a word.

use asperity::{Boundary, Error, Grid, LoadingSolver};

use crate::fault::{Fault, Kind};

/// What `web/build` lets the module have \[bytes\].
const ALL: usize = 2 << 30;
/// For the program itself, and for what grows with the length of a path.
const OWN: usize = 64 << 20;
/// What a node takes besides the path \[bytes\]: heights here, in the page's surface and in records, 24 states with
/// fields while a page is made, three bytes each and again one as they are deflated, and the texts of that page.
const PER_NODE: usize = 4 * 8 + 24 * 4 + 3 * 15;

/// The memory that a path on a grid may take \[bytes\]; nothing is left on grids of some ten million nodes.
pub(crate) fn budget(grid: &Grid) -> usize {
    // Sides are less than 2³², so that this fits: addresses have 32 bits in a browser.
    let nodes = grid.nx() as u64 * grid.ny() as u64;
    let taken = nodes.saturating_mul(PER_NODE as u64).saturating_add(OWN as u64);
    (ALL as u64).saturating_sub(taken) as usize
}

/// `Ok` if a path on a grid can begin.
pub(crate) fn check(grid: &Grid, boundary: Boundary) -> Result<(), Fault> {
    let begins = |grid: &Grid| fits(grid, boundary, LoadingSolver::check_room);
    if begins(grid)? {
        return Ok(());
    }
    let largest = largest(grid, |grid| begins(grid) == Ok(true));
    let (nx, ny) = grid.shape();
    Err(Fault {
        kind: Kind::Memory,
        message: format!(
            "a browser gives this page 2 GB of memory, which is not enough for {nx} × {ny} nodes: the largest square \
             grid has {largest} × {largest}. Use a part of the surface or a coarser grid here, or the program, which \
             may use all memory of the machine"
        ),
    })
}

/// What is said of a grid on which a path may end for want of memory.
pub(crate) fn warning(grid: &Grid, boundary: Boundary) -> Option<String> {
    let is_enough =
        |grid: &Grid| fits(grid, boundary, LoadingSolver::check_room_to_full_contact) == Ok(true);
    if is_enough(grid) {
        return None;
    }
    let largest = largest(grid, is_enough);
    Some(format!(
        "a browser gives this page 2 GB of memory: a path on this grid may end before its target, and what is found \
         until then is kept. Up to {largest} × {largest} nodes there is enough to full contact; the program may use \
         all memory of the machine"
    ))
}

/// The largest side, less than that of a grid, whose square fits, by halves.
fn largest(grid: &Grid, fits: impl Fn(&Grid) -> bool) -> usize {
    let (mut largest, mut beyond) = (1, grid.nx().max(grid.ny()));
    while largest + 1 < beyond {
        let middle = largest.midpoint(beyond);
        match Grid::square(middle, 1.0).is_ok_and(|grid| fits(&grid)) {
            true => largest = middle,
            false => beyond = middle,
        }
    }
    largest
}

/// Whether the budget of a grid is enough.
fn fits(
    grid: &Grid,
    boundary: Boundary,
    check: fn(&Grid, Boundary, Option<usize>) -> Result<(), Error>,
) -> Result<bool, Fault> {
    let budget = budget(grid);
    if budget == 0 {
        return Ok(false);
    }
    match check(grid, boundary, Some(budget)) {
        Ok(()) => Ok(true),
        Err(Error::MemoryBudget { .. }) => Ok(false),
        Err(error) => Err(error.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The grid of 512² nodes has room to full contact; what does not fit is told with what does.
    #[test]
    fn the_largest_grid_is_told() -> Result<(), Fault> {
        assert_eq!(check(&Grid::square(512, 1.0)?, Boundary::Free), Ok(()));
        assert_eq!(warning(&Grid::square(512, 1.0)?, Boundary::Free), None);
        for side in [6000, 32_000] {
            let refused = check(&Grid::square(side, 1.0)?, Boundary::Free);
            let fault = refused.err().unwrap_or_else(|| Fault::new("none"));
            assert_eq!(fault.kind, Kind::Memory, "{side}");
            assert!(fault.message.contains(&format!("{side} × {side} nodes")), "{}", fault.message);
            let largest = number_behind(&fault.message, "grid has ");
            assert!((1024..6000).contains(&largest), "{largest}");
            assert_eq!(check(&Grid::square(largest, 1.0)?, Boundary::Free), Ok(()));
            assert!(check(&Grid::square(largest + 1, 1.0)?, Boundary::Free).is_err());
            let said = warning(&Grid::square(largest, 1.0)?, Boundary::Free).unwrap_or_default();
            let enough = number_behind(&said, "Up to ");
            assert!((512..largest).contains(&enough), "{said}");
        }
        Ok(())
    }

    fn number_behind(text: &str, words: &str) -> usize {
        let number = text.split(words).nth(1).and_then(|rest| rest.split(' ').next());
        number.and_then(|number| number.parse().ok()).unwrap_or(0)
    }
}
