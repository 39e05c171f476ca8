//! How large a grid the memory is enough for.

use asperity::{Error, Grid, SurfaceError};
use asperity_cli::outcome::Failure;

/// A failure because of an error. If that is for want of memory, or because a grid is larger than any, the largest
/// square grid that `check` has room for is told with it.
pub(crate) fn failure(
    what: String,
    error: Error,
    check: impl Fn(&Grid) -> Result<(), Error>,
) -> Failure {
    let is_too_large = matches!(
        error,
        Error::MemoryBudget { .. } | Error::Surface(SurfaceError::GridTooLarge { .. })
    );
    let failure = Failure::new(what, error);
    if !is_too_large {
        return failure;
    }
    let fits = |side: usize| {
        let grid = Grid::square(side, 1.0);
        grid.is_ok_and(|grid| check(&grid).is_ok())
    };
    // The first power of two that does not fit, and then by halves.
    let mut beyond = 1;
    while fits(beyond) {
        beyond *= 2;
    }
    let mut largest = beyond / 2;
    while largest + 1 < beyond {
        let middle = largest.midpoint(beyond);
        if fits(middle) {
            largest = middle;
        } else {
            beyond = middle;
        }
    }
    match largest {
        0 => failure,
        side => failure.with_advice(&format!(
            "the largest square grid that fits into the memory at any load has {side} x {side} nodes"
        )),
    }
}
