//! How many nodes to watch at a time.

use super::tuning::{
    CONVOLUTION, EVENT_PRODUCT, LEAST_YIELD, MOST_WATCHED, NEGLIGIBLE, SCHUR, SOLVE, WORTH_IT,
    YIELD,
};

/// What the work of a window costs, in nanoseconds.
#[derive(Debug, Clone, Copy)]
pub(super) struct WindowCost {
    /// A solution on n contact nodes, per n².
    solve: f64,
    /// A Schur complement of k nodes, per k² n.
    schur: f64,
    /// Convolutions, per node of the grid.
    convolution: f64,
    /// Greatest number of watched nodes, as a fraction of the contact nodes.
    most_watched: f64,
}

/// With a factor.
pub(super) const WITH_FACTOR: WindowCost =
    WindowCost { solve: SOLVE, schur: SCHUR, convolution: CONVOLUTION, most_watched: MOST_WATCHED };

/// The number of watched nodes that makes an event cheapest with `contact` nodes in contact on a
/// grid of `nodes`, by a model of the work of a window.
pub(super) fn automatic_window(contact: usize, nodes: usize, cost: WindowCost) -> usize {
    let n = contact as f64;
    let refresh = cost.convolution * nodes as f64 + cost.solve * n * n;
    let per_event = |k: f64| {
        let events = YIELD * k;
        let schur = cost.schur * k * k * n;
        let inside = EVENT_PRODUCT * k * events * events / 2.0;
        (refresh + schur + inside) / events
    };
    let most = (cost.most_watched * n).clamp(NEGLIGIBLE, NEGLIGIBLE.max(nodes as f64));
    let mut best = WORTH_IT;
    let mut k = best;
    while k <= most {
        if per_event(k) < per_event(best) {
            best = k;
        }
        k *= 1.05;
    }
    best as usize
}

/// How many nodes to watch so that `events` of them touch: the columns of others would be of no use.
pub(super) fn watched_for(events: usize) -> usize {
    (events as f64 / LEAST_YIELD).ceil() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Costs of a window of which only some count.
    fn cost(convolution: f64, solve: f64, schur: f64, most_watched: f64) -> WindowCost {
        WindowCost { solve, schur, convolution, most_watched }
    }

    /// With k nodes watched an event costs `(R + s n k² + 0.08 · 0.85² k³ / 2) / (0.85 k)` for a refresh of R, which is
    /// least at `R = s n k² + 0.0578 k³`. Sizes are tried in steps of a twentieth.
    #[test]
    fn windows_are_the_cheapest() {
        let near = |(contact, nodes): (usize, usize), cost: WindowCost, best: f64| {
            let found = automatic_window(contact, nodes, cost) as f64 / best;
            assert!((0.94..1.05).contains(&found), "{cost:?}: {found} of {best}");
        };
        // 0.0578 · 200³ = 462 400, of convolutions, of solutions, and of both.
        near((10_000, 10_000), cost(46.24, 0.0, 0.0, 1.0), 200.0);
        near((1000, 10_000), cost(0.0, 0.4624, 0.0, 1.0), 200.0);
        near((1000, 10_000), cost(23.12, 0.2312, 0.0, 1.0), 200.0);
        // 0.1 · 1000 · 50² + 0.0578 · 50³ = 257 225.
        near((1000, 10_000), cost(25.7225, 0.0, 0.1, 1.0), 50.0);
        // Where nothing has to be shared, as few as are worth it.
        assert_eq!(automatic_window(1000, 10_000, cost(0.0, 0.0, 0.1, 1.0)), 16);
    }

    /// The greatest size tried is at most a twentieth below the bound.
    #[test]
    fn windows_end_at_their_bounds() {
        for (contact, nodes, most_watched, most) in [
            // A part of the contact; what costs little; the grid, unless that is less.
            (1000, 10_000, 0.5, 500),
            (1000, 10_000, 0.25, 320),
            (100, 10_000, 0.05, 320),
            (1000, 400, f64::INFINITY, 400),
            (1000, 100, f64::INFINITY, 320),
        ] {
            let cost = cost(1e9, 0.0, 0.0, most_watched);
            let size = automatic_window(contact, nodes, cost);
            assert!(size <= most && 21 * size > 20 * (most - 2), "{size} {most}");
        }
    }

    /// Three of four touch.
    #[test]
    fn a_third_more_is_watched_than_is_wanted() {
        for (events, watched) in [(0, 0), (1, 2), (3, 4), (4, 6), (75, 100), (76, 102)] {
            assert_eq!(watched_for(events), watched);
        }
    }
}
