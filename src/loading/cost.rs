//! How many nodes to watch at a time.

use crate::updater::WindowCost;

/// Nanoseconds for one product of the events inside a window.
const EVENT_PRODUCT: f64 = 0.08;
/// Fraction of the watched nodes that touch before the horizon.
const YIELD: f64 = 0.85;
/// The same, of almost all windows.
const LEAST_YIELD: f64 = 0.75;
/// Watched nodes that are always worth it.
const FEWEST: f64 = 16.0;
/// Watched nodes whose columns cost little however few nodes are in contact.
const NEGLIGIBLE: f64 = 320.0;

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
    // An updater of one's own may say anything, infinity too.
    let most = (cost.most_watched * n).clamp(NEGLIGIBLE, NEGLIGIBLE.max(nodes as f64));
    let mut best = FEWEST;
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

    #[test]
    fn absurd_costs_give_a_window_all_the_same() {
        for most_watched in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 0.05] {
            for schur in [0.0, f64::NAN, f64::INFINITY, 0.01] {
                let cost = WindowCost {
                    most_watched,
                    schur,
                    ..WindowCost::default()
                };
                let size = automatic_window(5000, 65_536, cost);
                assert!((16..=65_536).contains(&size), "{cost:?} {size}");
            }
        }
    }
}
