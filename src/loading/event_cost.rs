//! What events cost with a factor and without, and when the rest of a path is cheaper without.

use super::tuning::{
    CHECKED, FACTOR, HANDOVER, ITERATIONS, RELEASE_BY_ITERATIONS, RELEASE_WITH_FACTOR, SAVED,
    WINDOW,
};

/// Seconds that an event with a factor of so many nodes takes on a machine with two cores: for telling how long a path
/// will take.
#[doc(hidden)]
#[must_use]
pub fn factor_seconds(contact: usize) -> f64 {
    FACTOR * (contact as f64).powi(2)
}

/// The same by iterations, with so many nodes in contact on a grid of `nodes`.
#[doc(hidden)]
#[must_use]
pub fn iteration_seconds(nodes: usize, contact: usize) -> f64 {
    WINDOW + ITERATIONS[0] * nodes as f64 + ITERATIONS[1] * contact as f64
}

/// Nodes in contact at which a factor costs as much as iterations on a grid of `nodes`: it is not given up before, if
/// memory allows.
#[doc(hidden)]
#[must_use]
pub fn last_factor(nodes: usize) -> usize {
    // Both costs grow with the contact, and that of a factor faster: one crossing.
    let (mut low, mut high) = (0, nodes);
    while low < high {
        let middle = low.midpoint(high);
        if factor_seconds(middle) > iteration_seconds(nodes, middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    low
}

/// Nodes in contact with which a path to `end` of them gives its factor up on a grid of `nodes`; `end` if it keeps it.
#[doc(hidden)]
#[must_use]
pub fn greatest_factor(nodes: usize, end: usize) -> usize {
    let last = last_factor(nodes);
    if last < end && Rest::growing(nodes, last, end).is_cheaper_without() { last } else { end }
}

/// What is left of a path, as far as it is known.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rest {
    /// Nodes of the grid.
    nodes: usize,
    /// Nodes that a factor holds now, and at the end.
    factor: [usize; 2],
    events: f64,
    /// Where nodes may leave: the part of the events that are releases.
    releases: Option<f64>,
}

impl Rest {
    /// Each event is a node more in the factor.
    pub(super) fn growing(nodes: usize, from: usize, to: usize) -> Self {
        let to = to.max(from);
        Self { nodes, factor: [from, to], events: (to - from) as f64, releases: None }
    }

    /// The factor stays about as large as it is.
    pub(super) fn steady(nodes: usize, contact: usize, events: usize) -> Self {
        Self { nodes, factor: [contact; 2], events: events as f64, releases: None }
    }

    /// The same where windows are checked at each event and nodes leave in this part of all events: half at most, since
    /// each of them has touched.
    pub(super) fn with_releases(self, part: f64) -> Self {
        Self { releases: Some(part.min(0.5)), ..self }
    }

    /// Whether the next event is cheaper without a factor, and all the rest as well, by [`SAVED`] of what it costs with
    /// one: a hand-over pays for itself, and no small gain makes estimates of states that a factor has exactly.
    pub(super) fn is_cheaper_without(self) -> bool {
        let [now, _] = self.factor;
        let next = Self { factor: [now; 2], events: 1.0, ..self };
        let with_factor = self.seconds_with_factor();
        let [node, contact_node] = HANDOVER;
        let handover = node * self.nodes as f64 + contact_node * now as f64;
        next.seconds_with_factor() > next.seconds_without()
            && handover + self.seconds_without() < (1.0 - SAVED) * with_factor
    }

    /// n² per event, on average over a factor that grows evenly.
    fn seconds_with_factor(self) -> f64 {
        let [from, to] = self.factor.map(|nodes| nodes as f64);
        let square = (from * from + from * to + to * to) / 3.0;
        let event = match self.releases {
            None => FACTOR * square,
            Some(part) => {
                let [solution, convolution] = RELEASE_WITH_FACTOR;
                let release = solution * square + convolution * self.nodes as f64;
                CHECKED * FACTOR * square + part * release
            }
        };
        self.events * event
    }

    fn seconds_without(self) -> f64 {
        let [from, to] = self.factor;
        // Linear in the contact: the mean is that of its middle.
        let in_windows =
            0.5 * (iteration_seconds(self.nodes, from) + iteration_seconds(self.nodes, to));
        let of_releases = self.releases.unwrap_or(0.0) * RELEASE_BY_ITERATIONS * self.nodes as f64;
        self.events * (in_windows + of_releases)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 10 ps · n², and 0.2 ms, 3.5 ns a node and 4 ns a node in contact.
    #[test]
    fn costs_of_an_event() {
        let is_near = |found: f64, cost: f64| {
            assert!((found / cost - 1.0).abs() < 1e-14, "{found:e} {cost:e}")
        };
        is_near(factor_seconds(1000), 1e-5);
        is_near(factor_seconds(10_000), 1e-3);
        is_near(iteration_seconds(10_000, 10_000), 2e-4 + 3.5e-5 + 4e-5);
        is_near(iteration_seconds(1_000_000, 100_000), 2e-4 + 3.5e-3 + 4e-4);
    }

    /// The root of `10⁻¹¹ n² = 2·10⁻⁴ + 3.5·10⁻⁹ N + 4·10⁻⁹ n`, rounded up; all nodes if there is none among them.
    #[test]
    fn events_cost_the_same_at_a_root() {
        for nodes in [128 * 128, 256 * 256, 512 * 512] {
            let fixed = 2e-4 + 3.5e-9 * nodes as f64;
            let root = (4e-9 + (16e-18 + 4e-11 * fixed).sqrt()) / 2e-11;
            assert_eq!(last_factor(nodes), root.ceil() as usize);
        }
        assert_eq!([100, 1000].map(last_factor), [100, 1000]);
    }

    /// From n to m nodes, by integrals: `10⁻¹¹ (m³ − n³) / 3` with a factor; without, `(2·10⁻⁴ + 3.5·10⁻⁹ N)(m − n) +
    /// 2·10⁻⁹ (m² − n²)`, and `1.3·10⁻⁶ N + 8·10⁻⁶ n` to begin with. The factor goes if that is less than four fifths.
    #[test]
    fn a_factor_is_given_up_for_a_fifth_of_what_is_left() {
        let is_cheaper = |nodes: f64, n: f64, m: f64| {
            let with_factor = 1e-11 * (m.powi(3) - n.powi(3)) / 3.0;
            let without = (2e-4 + 3.5e-9 * nodes) * (m - n) + 2e-9 * (m * m - n * n);
            1.3e-6 * nodes + 8e-6 * n + without < 0.8 * with_factor
        };
        for side in [128, 256, 512_usize] {
            let nodes = side * side;
            let last = last_factor(nodes);
            let (mut given_up, mut kept) = (0, 0);
            for end in (last + 50..nodes.min(3 * last)).step_by(97) {
                let found = greatest_factor(nodes, end);
                if is_cheaper(nodes as f64, last as f64, end as f64) {
                    assert_eq!(found, last, "{side} {end}");
                    given_up += 1;
                } else {
                    assert_eq!(found, end, "{side} {end}");
                    kept += 1;
                }
            }
            assert!(given_up > 10 && kept > 10, "{side}: {given_up} {kept}");
        }
        // The example of the program: a tenth of 256 × 256 nodes.
        assert_eq!(greatest_factor(256 * 256, 6553), 6553);
        assert_eq!(greatest_factor(64 * 64, 4096), 4096);
    }

    /// 8000 elastic nodes on 256 × 256: an event takes 0.64 ms with a factor, 0.46 ms without, and the hand-over 0.15
    /// s. Fewer nodes are cheaper in a factor for any number of events.
    #[test]
    fn a_factor_of_one_size_is_given_up_for_many_events() {
        let rest = |contact, events| Rest::steady(256 * 256, contact, events).is_cheaper_without();
        assert_eq!([1000, 2000, 10_000].map(|events| rest(8000, events)), [false, false, true]);
        assert!(!rest(6000, usize::MAX));
        // Where nodes may leave, 1.6 ms instead of 0.64, and 0.135 s for each that does; 0.131 s without a factor. Four
        // fifths of that are less than what iterations take, the hand-over included, from one event in 31.5 on.
        let rest = Rest::steady(256 * 256, 8000, 2000);
        let with = |part| rest.with_releases(part);
        let rests = [rest, with(0.0), with(0.031), with(0.033), with(f64::INFINITY)];
        let are_cheaper = rests.map(Rest::is_cheaper_without);
        assert_eq!(are_cheaper, [false, true, true, false, false]);
    }
}
