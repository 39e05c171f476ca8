//! Long paths: how time and memory grow with the number of contact nodes.
//!
//! A self-affine surface, roll-off at a quarter of the side and short cut-off at four cells, up to a
//! given number of nodes in contact.

use std::error::Error;
use std::time::Instant;

use asperity::surface::{Amplitude, SelfAffine};
use asperity::updater::{CholeskyTimings, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{Boussinesq, Grid, LoadingSolver};
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
) -> Result<(), Box<dyn Error>> {
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
    let mut builder =
        LoadingSolver::builder(&surface, &kernel).updater(updater).max_nodes(options.contact_nodes);
    if let Some(megabytes) = options.budget {
        builder = builder.memory_budget(megabytes * 1_000_000);
    }
    if let Some(size) = options.window {
        builder = builder.window_size(size);
    }
    let mut path = builder.build()?;
    let mut states = 0_u32;
    for state in path.by_ref() {
        state?;
        states += 1;
        if states.is_multiple_of(128) {
            bar.set_position(states.into());
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    let n = f64::from(states);
    let certificate = path.certificate()?;
    let in_sq = certificate.length / path.problem().rms_height();
    let peak = peak_memory().unwrap_or(f64::NAN);
    println!(
        "{states} nodes ({:.1} %) in {seconds:.2} s: {:.1} GFLOP/s as n^3/3 a second, {} windows, \
         peak memory {:.0} MB = {:.3} x 4n^2",
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
    if let (Some(timings), Some(updater)) = (timings, path.updater()) {
        phases::print(path.timings(), timings(updater));
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    if options.budget.is_some() {
        run(&options, Handover::new(), None)
    } else {
        let timings = RecursiveCholesky::timings;
        run(&options, RecursiveCholesky::new(), Some(timings))
    }
}
