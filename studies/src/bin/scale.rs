//! Long paths: how time and memory grow with the number of contact nodes.
//!
//! A self-affine surface, roll-off at a quarter of the side and short cut-off at four cells, up to a
//! given number of nodes in contact. With `--compare`, the path in mixed precision against the one in
//! double precision, state by state.

use std::error::Error;
use std::time::Instant;

use asperity::surface::{Amplitude, SelfAffine};
use asperity::updater::{
    CholeskyTimings, Handover, LinearUpdater, MixedCholesky, RecursiveCholesky,
};
use asperity::{Boussinesq, Grid, LoadingSolver, LoadingState};
use asperity_studies::peak_memory::peak_memory;
use asperity_studies::phases;
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};

/// Times long paths.
#[derive(Parser)]
struct Options {
    /// Nodes a side of the grid.
    #[arg(long, default_value_t = 256)]
    nodes: usize,
    /// Contact nodes at which the path ends.
    #[arg(long, default_value_t = 9830)]
    contact_nodes: usize,
    /// The factor in single precision.
    #[arg(long)]
    mixed: bool,
    /// Both precisions, compared state by state.
    #[arg(long)]
    compare: bool,
    /// The factor up to a memory budget of so many MB, conjugate gradients after.
    #[arg(long)]
    budget: Option<usize>,
    /// Nodes to watch at a time.
    #[arg(long)]
    window: Option<usize>,
    /// Seed of the surface.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn run<U: LinearUpdater>(
    options: &Options,
    updater: U,
    timings: Option<fn(&U) -> CholeskyTimings>,
) -> Result<Vec<LoadingState>, Box<dyn Error>> {
    const SIDE: f64 = 1e-2;
    let rolloff = SIDE / 4.0;
    let cutoff = 4.0 * SIDE / options.nodes as f64;
    let roughness = Amplitude::RmsHeight(50e-6);
    let surface = SelfAffine::new(0.8, rolloff, cutoff, roughness, options.seed)?;
    let kernel = Boussinesq::new(Grid::square(options.nodes, SIDE)?, 1.0)?;
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} nodes {elapsed}");
    let bar = ProgressBar::new(options.contact_nodes as u64)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let start = Instant::now();
    let mut builder = LoadingSolver::builder(&surface, &kernel)
        .updater(updater)
        .max_nodes(options.contact_nodes);
    if let Some(megabytes) = options.budget {
        builder = builder.memory_budget(megabytes * 1_000_000);
    }
    if let Some(size) = options.window {
        builder = builder.window_size(size);
    }
    let mut path = builder.build()?;
    let mut states = Vec::new();
    for state in path.by_ref() {
        states.push(state?);
        if states.len() % 128 == 0 {
            bar.set_position(states.len() as u64);
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    let n = states.len() as f64;
    let certificate = path.certificate()?;
    let in_sq = certificate.length / path.problem().rms_height();
    let peak = peak_memory().unwrap_or(f64::NAN);
    println!(
        "{} nodes ({:.1} %) in {seconds:.2} s: {:.1} GFLOP/s as n^3/3 a second, {} windows, \
         peak memory {:.0} MB = {:.3} x 4n^2",
        states.len(),
        100.0 * n / (options.nodes * options.nodes) as f64,
        n.powi(3) / 3.0 / seconds / 1e9,
        path.timings().windows,
        peak / 1e6,
        peak / (4.0 * n * n)
    );
    println!(
        "  least pressure {:.1e} of the mean, least gap {:.1e} Sq, gap in contact {:.1e} Sq",
        certificate.least_pressure,
        certificate.least_gap * in_sq,
        certificate.greatest_contact_gap * in_sq
    );
    if let Some(timings) = timings {
        phases::print(path.timings(), timings(path.updater()));
    }
    Ok(states)
}

fn compare(exact: &[LoadingState], mixed: &[LoadingState]) {
    type Column = fn(&LoadingState) -> f64;
    let pairs = || exact.iter().zip(mixed);
    let order = pairs().take_while(|(e, m)| e.node == m.node).count();
    println!("same node at the first {order} of {} events", exact.len());
    let columns: [(&str, Column); 5] = [
        ("approach", |state| state.approach),
        ("load", |state| state.load),
        ("mean gap", |state| state.mean_gap),
        ("contact stiffness", |state| {
            state.contact_stiffness.unwrap_or(f64::NAN)
        }),
        ("interfacial stiffness", |state| {
            state.interfacial_stiffness.unwrap_or(f64::NAN)
        }),
    ];
    for (name, column) in columns {
        let errors = pairs().map(|(e, m)| (column(m) - column(e)).abs() / column(e));
        let worst = errors.filter(|error| error.is_finite()).fold(0.0, f64::max);
        println!("  {name:<22} within {worst:.1e}");
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let exact = || {
        let timings = RecursiveCholesky::timings;
        run(&options, RecursiveCholesky::new(), Some(timings))
    };
    let mixed = || {
        let timings = MixedCholesky::timings;
        run(&options, RecursiveCholesky::mixed(), Some(timings))
    };
    if options.compare {
        compare(&exact()?, &mixed()?);
    } else if options.mixed {
        mixed()?;
    } else if options.budget.is_some() {
        run(&options, Handover::new(), None)?;
    } else {
        exact()?;
    }
    Ok(())
}
