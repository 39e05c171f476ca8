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

/// `Ok` if a path on a grid gets to full contact.
pub(crate) fn check(grid: &Grid, boundary: Boundary) -> Result<(), Fault> {
    if fits(grid, boundary)? {
        return Ok(());
    }
    // The largest side that fits, by halves.
    let (mut largest, mut beyond) = (1, grid.nx().max(grid.ny()));
    while largest + 1 < beyond {
        let middle = largest.midpoint(beyond);
        match Grid::square(middle, 1.0).is_ok_and(|grid| fits(&grid, boundary) == Ok(true)) {
            true => largest = middle,
            false => beyond = middle,
        }
    }
    let (nx, ny) = grid.shape();
    Err(Fault {
        kind: Kind::Memory,
        message: format!(
            "a browser gives this page 2 GB of memory, which is not enough for {nx} × {ny} nodes: the largest square grid has {largest} × \
             {largest}. Use a part of the surface or a coarser grid here, or the program, which may use all memory of the machine"
        ),
    })
}

fn fits(grid: &Grid, boundary: Boundary) -> Result<bool, Fault> {
    let budget = budget(grid);
    if budget == 0 {
        return Ok(false);
    }
    match LoadingSolver::check_room_to_full_contact(grid, boundary, Some(budget)) {
        Ok(()) => Ok(true),
        Err(Error::MemoryBudget { .. }) => Ok(false),
        Err(error) => Err(error.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1024² nodes fit, which take some 0.7 GB; what does not is told with what does.
    #[test]
    fn the_largest_grid_is_told() -> Result<(), Fault> {
        assert_eq!(check(&Grid::square(1024, 1.0)?, Boundary::Free), Ok(()));
        for side in [4096, 40_000, 400_000] {
            let refused = check(&Grid::square(side, 1.0)?, Boundary::Free);
            let fault = refused.err().unwrap_or_else(|| Fault::new("none"));
            assert_eq!(fault.kind, Kind::Memory, "{side}");
            assert!(fault.message.contains(&format!("{side} × {side} nodes")), "{}", fault.message);
            let largest =
                fault.message.split("has ").nth(1).and_then(|text| text.split(' ').next());
            let largest: usize = largest.and_then(|text| text.parse().ok()).unwrap_or(0);
            assert!((1024..4096).contains(&largest), "{largest}");
            assert_eq!(check(&Grid::square(largest, 1.0)?, Boundary::Free), Ok(()));
            assert!(check(&Grid::square(largest + 1, 1.0)?, Boundary::Free).is_err());
        }
        Ok(())
    }
}
