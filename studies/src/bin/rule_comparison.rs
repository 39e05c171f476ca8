//! Which node touches next: the exact rule against the paper's, in numbers.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin rule_comparison
//! ```
//!
//! Follows the loading path of several rough surfaces to 30 % contact by both rules, and looks at
//! every state: its pressure, its gap, its approach. `docs/theory.md` quotes the figures.

use std::error::Error;

use asperity::convolution::Convolution;
use asperity::surface::{Amplitude, HeightMap};
use asperity::{Boussinesq, Grid, LoadingSolver, Problem, SelfAffine};
use asperity_studies::smallest_gap::{EitherPath, SmallestGap};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

const SIDE: f64 = 1e-2;
const FRACTION: f64 = 0.3;
const SEEDS: u64 = 4;
/// Pressures over their mean, and gaps over Sq, count as negative only below minus this.
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
            for rule in ["FirstContact", "SmallestGap"] {
                let found = examine(nodes, seed, rule)?;
                println!(
                    "{:>5} {:>5} {:14} {:>6} {:>10.1} {:>10} {:>11.1e} {:>9} {:>10} {:>11.1e}",
                    nodes,
                    seed,
                    rule,
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
fn examine(nodes: usize, seed: u64, rule: &str) -> Result<Findings, Box<dyn Error>> {
    let grid = Grid::square(nodes, SIDE)?;
    let surface = SelfAffine::new(
        0.8,
        SIDE / 4.0,
        2.0 * SIDE / nodes as f64,
        Amplitude::RmsHeight(5e-5),
        seed,
    )?;
    let heights = HeightMap::sample(&surface, &grid)?;
    let half_space = Boussinesq::new(grid, 1.0)?;
    let most_nodes = grid.nodes_in(FRACTION)?;
    let mut path: Box<dyn EitherPath> = match rule {
        "SmallestGap" => Box::new(SmallestGap::new(&heights, &half_space, most_nodes)?),
        _ => Box::new(
            LoadingSolver::builder(&heights, &half_space)
                .max_nodes(most_nodes)
                .build()?
                .into_path(),
        ),
    };

    let mut rates = Rates::new(path.problem());
    let mut found = Findings::default();
    let mut first_to_touch = None;
    let mut previous = 0.0;
    while let Some(state) = path.next() {
        let state = state?;
        if let Some(first) = first_to_touch {
            found.other_node += usize::from(first != state.node);
        }
        found.steps += 1;
        found.backward_steps += usize::from(state.contact.approach < previous);
        previous = state.contact.approach;

        let extremes = path.extremes()?;
        found.negative_steps += usize::from(extremes.pressure < -ROUNDING);
        found.overlap_steps += usize::from(extremes.gap < -ROUNDING);
        found.least_pressure = found.least_pressure.min(extremes.pressure);
        found.least_gap = found.least_gap.min(extremes.gap);

        rates.join(path.problem(), state.node)?;
        first_to_touch = rates.first_to_touch(&path.gap()?, &path.contact_map())?;
    }
    Ok(found)
}

/// How fast gaps close with the contact as it is, whatever the rule of the path.
struct Rates {
    convolution: Convolution,
    /// Nodes in contact in the order in which they joined.
    contact: Vec<usize>,
    /// The factor of their influence matrix.
    factor: Cholesky<f64, Dyn>,
}

impl Rates {
    /// Before first touch.
    fn new(problem: &Problem) -> Self {
        Self {
            convolution: problem.convolution(),
            contact: Vec::new(),
            factor: Cholesky::new_unchecked(DMatrix::zeros(0, 0)),
        }
    }

    /// Takes a node into the contact.
    fn join(&mut self, problem: &Problem, (ix, iy): (usize, usize)) -> Result<(), Box<dyn Error>> {
        let outside = "a node outside the grid";
        let node = problem.grid().node(ix, iy).ok_or(outside)?;
        self.contact.push(node);
        let column = self.contact.iter();
        let column = column.map(|&other| problem.coefficient(node, other));
        let column: Vec<f64> = column.collect::<Option<_>>().ok_or(outside)?;
        let column = DVector::from_vec(column);
        self.factor = self.factor.insert_column(column.len() - 1, column);
        Ok(())
    }

    /// The node whose gap closes first as the approach grows, from the present gaps: the smallest quotient
    /// of a gap and the rate at which it closes, 1 − C y₂ with y₂ = C_II⁻¹ e on the contact I.
    fn first_to_touch(
        &mut self,
        gap: &DMatrix<f64>,
        contact: &DMatrix<bool>,
    ) -> Result<Option<(usize, usize)>, Box<dyn Error>> {
        let y2 = self.factor.solve(&DVector::from_element(self.contact.len(), 1.0));
        let (nx, ny) = gap.shape();
        let mut pressure = DMatrix::zeros(nx, ny);
        for (&node, rate) in self.contact.iter().zip(&y2) {
            pressure.as_mut_slice()[node] = *rate;
        }
        let displacement = self.convolution.convolve(&pressure)?;
        let mut first: Option<(f64, (usize, usize))> = None;
        for iy in 0..ny {
            for ix in 0..nx {
                let closing = 1.0 - displacement[(ix, iy)];
                if contact[(ix, iy)] || closing <= 0.0 {
                    continue;
                }
                let change = gap[(ix, iy)] / closing;
                if first.is_none_or(|(earliest, _)| change < earliest) {
                    first = Some((change, (ix, iy)));
                }
            }
        }
        Ok(first.map(|(_, node)| node))
    }
}
