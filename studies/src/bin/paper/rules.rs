//! The two rules for the next contact on the surface of Table 1.

use asperity::{Boussinesq, LoadingSolver, LoadingState};
use asperity_studies::smallest_gap::{EitherPath, SmallestGap};

use crate::surfaces::{E_STAR, Rough, grid};
use asperity_cli::outcome::Failure;

/// Both are followed to so many nodes; the paper's rule costs a convolution for each.
const NODES: usize = 1311;
/// One in so many states is examined for its pressures and gaps.
const EVERY: usize = 10;
/// More than rounding, relative to the mean pressure and to Sq.
const ROUNDING: f64 = 1e-10;

/// What a path looks like.
#[derive(Debug, Clone, Default)]
pub(crate) struct Findings {
    /// Steps in which the approach goes back.
    pub(crate) backward: usize,
    /// Number of states examined, with negative pressure, and with overlap.
    pub(crate) examined: usize,
    pub(crate) negative: usize,
    pub(crate) overlapping: usize,
    /// Least pressure over the mean on the contact.
    pub(crate) least_pressure: f64,
    /// Least gap over Sq.
    pub(crate) least_gap: f64,
    order: Vec<usize>,
    states: Vec<LoadingState>,
}

/// Both rules side by side.
pub(crate) struct Rules {
    pub(crate) nodes: usize,
    pub(crate) steps: usize,
    pub(crate) exact: Findings,
    pub(crate) smallest_gap: Findings,
    /// The first step at which they take another node.
    pub(crate) parted: Option<usize>,
    /// States in which the contact sets differ.
    pub(crate) other_sets: usize,
    /// Greatest difference of the load at equal number of nodes, beyond 100 nodes, relative.
    pub(crate) load: f64,
    /// The same of the approach over Sq, all states.
    pub(crate) approach: f64,
}

impl Rules {
    pub(crate) fn new(nodes: usize) -> Result<Self, Failure> {
        let failed = |error: asperity::Error| Failure::new("the comparison of rules", error);
        let grid = grid(nodes).map_err(failed)?;
        let heights = Rough::Table1.heights(&grid, 1).map_err(failed)?;
        let steps = NODES.min(grid.nodes() / 5);
        eprintln!("rules: {steps} nodes of {nodes} x {nodes} by each");
        let half_space = Boussinesq::new(grid, E_STAR).map_err(failed)?;
        let exact = LoadingSolver::builder(&heights, &half_space).max_nodes(steps).build();
        let exact = exact.and_then(|path| examine(path.into_path())).map_err(failed)?;
        let smallest_gap = SmallestGap::new(&heights, &half_space, steps);
        let smallest_gap = smallest_gap.and_then(examine).map_err(failed)?;
        let sq = heights.rms_height();
        let pairs = || exact.states.iter().zip(&smallest_gap.states);
        let load = pairs().skip(100).map(|(a, b)| (b.contact.load / a.contact.load - 1.0).abs());
        let approach = pairs().map(|(a, b)| (b.contact.approach - a.contact.approach).abs() / sq);
        let nodes_of = |findings: &Findings| findings.order.clone();
        let (first, second) = (nodes_of(&exact), nodes_of(&smallest_gap));
        Ok(Self {
            nodes,
            steps,
            parted: first.iter().zip(&second).position(|(a, b)| a != b),
            other_sets: different_sets(&first, &second, grid.nodes()),
            load: load.fold(0.0, f64::max),
            approach: approach.fold(0.0, f64::max),
            exact,
            smallest_gap,
        })
    }
}

fn examine(mut path: impl EitherPath) -> Result<Findings, asperity::Error> {
    let mut found = Findings::default();
    while let Some(state) = path.next() {
        let state = state?;
        let previous = found.states.last().map_or(0.0, |s| s.contact.approach);
        found.backward += usize::from(state.contact.approach < previous);
        found.states.push(state);
        if state.step % EVERY == 0 {
            let extremes = path.extremes()?;
            found.examined += 1;
            found.negative += usize::from(extremes.pressure < -ROUNDING);
            found.overlapping += usize::from(extremes.gap < -ROUNDING);
            found.least_pressure = found.least_pressure.min(extremes.pressure);
            found.least_gap = found.least_gap.min(extremes.gap);
        }
    }
    found.order = path.contact_order();
    Ok(found)
}

/// In how many states of two orders of nodes the sets differ.
fn different_sets(first: &[usize], second: &[usize], nodes: usize) -> usize {
    // +1 for a node that only the first has, −1 for one that only the second has.
    let mut balance = vec![0_i8; nodes];
    let mut unequal = 0_usize;
    let mut states = 0;
    for (a, b) in first.iter().zip(second) {
        for (node, change) in [(*a, 1), (*b, -1)] {
            let before = balance[node];
            balance[node] += change;
            if before == 0 {
                unequal += 1;
            } else if balance[node] == 0 {
                unequal -= 1;
            }
        }
        states += usize::from(unequal > 0);
    }
    states
}
