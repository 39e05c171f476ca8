//! Which node touches next: the exact rule against the paper's, in numbers.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin rule_comparison
//! ```
//!
//! Follows the loading path of several rough surfaces to 30 % contact by both rules, and looks at
//! every state: its pressure, its gap, its approach. `docs/theory.md` quotes the table.

use std::error::Error;

use asperity::convolution::Convolution;
use asperity::surface::{Amplitude, HeightMap};
use asperity::{Boussinesq, ContactRule, ContactState, Grid, LoadingSolver, SelfAffine};

const SIDE: f64 = 1e-2;
const FRACTION: f64 = 0.3;
const SEEDS: u64 = 4;
/// Relative to the mean pressure, and to Sq: what counts as more than rounding.
const ROUNDING: f64 = 1e-10;

/// What a path looks like, state by state.
#[derive(Debug, Default)]
struct Findings {
    steps: usize,
    /// Steps that took another node than the one that touches first.
    other_node: usize,
    negative_steps: usize,
    least_pressure: f64,
    backward_steps: usize,
    overlap_steps: usize,
    least_gap: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "{:>5} {:>5} {:14} {:>6} {:>10} {:>10} {:>11} {:>9} {:>10} {:>11}",
        "nodes",
        "seed",
        "rule",
        "steps",
        "other node",
        "p < 0 in",
        "least p",
        "backward",
        "overlap in",
        "least gap"
    );
    println!(
        "{:>5} {:>5} {:14} {:>6} {:>10} {:>10} {:>11} {:>9} {:>10} {:>11}",
        "", "", "", "", "% of steps", "steps", "/ mean p", "steps", "steps", "/ Sq"
    );
    for nodes in [32, 64] {
        for seed in 1..=SEEDS {
            for rule in [ContactRule::FirstContact, ContactRule::SmallestGap] {
                let found = examine(nodes, seed, rule)?;
                println!(
                    "{:>5} {:>5} {:14} {:>6} {:>10.1} {:>10} {:>11.1e} {:>9} {:>10} {:>11.1e}",
                    nodes,
                    seed,
                    format!("{rule:?}"),
                    found.steps,
                    100.0 * found.other_node as f64 / found.steps as f64,
                    found.negative_steps,
                    found.least_pressure,
                    found.backward_steps,
                    found.overlap_steps,
                    found.least_gap,
                );
            }
        }
    }
    Ok(())
}

/// Follows one path by one rule.
fn examine(nodes: usize, seed: u64, rule: ContactRule) -> Result<Findings, Box<dyn Error>> {
    let grid = Grid::square(nodes, SIDE)?;
    let surface = SelfAffine::new(
        0.8,
        SIDE / 4.0,
        2.0 * SIDE / nodes as f64,
        Amplitude::RmsHeight(5e-5),
        seed,
    )?;
    let heights = HeightMap::sample(&surface, &grid)?;
    let mut path = LoadingSolver::builder(heights, Boussinesq::new(grid, 1.0)?)
        .rule(rule)
        .max_area_fraction(FRACTION)
        .build()?;

    let mut convolution = Convolution::new(path.kernel())?;
    let mut found = Findings::default();
    let mut first_to_touch = None;
    let mut previous = 0.0;
    while let Some(state) = path.next() {
        let state = state?;
        if let Some(first) = first_to_touch {
            found.other_node += usize::from(first != state.node);
        }
        found.steps += 1;
        found.backward_steps += usize::from(state.approach < previous);
        previous = state.approach;

        let certificate = path.certificate()?;
        found.negative_steps += usize::from(certificate.least_pressure < -ROUNDING);
        found.overlap_steps += usize::from(certificate.least_gap < -ROUNDING);
        found.least_pressure = found.least_pressure.min(certificate.least_pressure);
        found.least_gap = found.least_gap.min(certificate.least_gap);
        first_to_touch = next_contact(&mut path, &state, &mut convolution)?;
    }
    Ok(found)
}

/// The node whose gap closes first as the approach grows, whatever the rule of the path: the
/// smallest r1 / r2, from the gaps r1 - δ r2 at the present state and at a later approach with the
/// same contact.
fn next_contact(
    path: &mut LoadingSolver<HeightMap, Boussinesq>,
    state: &ContactState,
    convolution: &mut Convolution,
) -> Result<Option<(usize, usize)>, Box<dyn Error>> {
    let gap = path.gap()?;
    // Of the order of Sq, so that differences keep their digits.
    let change = 1e-4;
    let later = path.pressure_at(&state.at_approach(state.approach + change))?;
    let closing = later - path.pressure()?;
    let contact = path.contact_map();
    let displaced = convolution.convolve(&closing)?;
    let mut first: Option<(f64, (usize, usize))> = None;
    for iy in 0..gap.ncols() {
        for ix in 0..gap.nrows() {
            let closed = change - displaced[(ix, iy)];
            if contact[(ix, iy)] || closed <= 0.0 {
                continue;
            }
            let time = gap[(ix, iy)] / closed;
            if first.is_none_or(|(earliest, _)| time < earliest) {
                first = Some((time, (ix, iy)));
            }
        }
    }
    Ok(first.map(|(_, node)| node))
}
