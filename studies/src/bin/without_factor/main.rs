//! The path without a factor against the path with one: order of events, errors, time and memory.

mod compare;
mod fixed_loads;
mod recorded;
mod stretches;
mod surfaces;

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use asperity::kernel::KernelTable;
use asperity::loading::{LoadingState, LoadingTimings};
use asperity::record::LoadingRecord;
use asperity::surface::HeightMap;
use asperity::updater::{ConjugateGradient, LinearUpdater, RecursiveCholesky};
use asperity::{Boussinesq, ContactRule, LoadingSolver, PeriodicBoussinesq, Spectral};
use asperity_studies::peak_memory::peak_memory;
use clap::{Parser, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use recorded::Event;
use surfaces::Shape;

/// Follows a surface without a factor, and compares with the path of a factor.
#[derive(Parser)]
struct Options {
    /// Nodes along x.
    #[arg(long, default_value_t = 128)]
    nodes: usize,
    /// Nodes along y, as many as along x unless given.
    #[arg(long)]
    ny: Option<usize>,
    /// Side of a cell along x over its side along y.
    #[arg(long, default_value_t = 1.0)]
    aspect: f64,
    #[arg(long, value_enum, default_value_t = Shape::Rough)]
    surface: Shape,
    #[arg(long, default_value_t = 0.8)]
    hurst: f64,
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[arg(long, value_enum, default_value_t = HalfSpace::Free)]
    half_space: HalfSpace,
    /// Contact nodes at which the path ends; full contact unless given.
    #[arg(long)]
    contact_nodes: Option<usize>,
    /// Nodes to watch at a time.
    #[arg(long)]
    window: Option<usize>,
    /// Leaves near ties as they are.
    #[arg(long)]
    approximate: bool,
    /// Only the path without a factor.
    #[arg(long)]
    alone: bool,
    /// Says how far it is, every 4096 events.
    #[arg(long)]
    list: bool,
    /// Compares the contacts at so many loads with single solutions.
    #[arg(long, default_value_t = 0)]
    fixed_loads: usize,
    /// Takes the path from a file of `asperity path` instead of following it.
    #[arg(long, value_name = "path.csv")]
    path: Option<PathBuf>,
    /// Takes a path from a record, and follows stretches of it again with an exact solution at every event.
    #[arg(long, value_name = "path.npz")]
    record: Option<PathBuf>,
    /// How many stretches, spread evenly over the path.
    #[arg(long, default_value_t = 20)]
    stretches: usize,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum HalfSpace {
    Free,
    Periodic,
    Spectral,
}

/// Runs a path, and returns its states.
fn run<U: LinearUpdater>(
    options: &Options,
    surface: &HeightMap,
    kernel: &KernelTable,
    updater: U,
) -> Result<(Vec<LoadingState>, LoadingTimings, f64), Box<dyn Error>> {
    let nodes = kernel.grid().nodes();
    let most = options.contact_nodes.unwrap_or(nodes);
    let start = Instant::now();
    let mut builder = LoadingSolver::builder(surface, kernel).updater(updater).max_nodes(most);
    if let Some(size) = options.window {
        builder = builder.window_size(size);
    }
    if options.approximate {
        builder = builder.rule(ContactRule::ApproximateOrder);
    }
    let mut path = builder.build()?;
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} nodes {elapsed}");
    let bar = ProgressBar::new(most as u64)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let mut states = Vec::with_capacity(most);
    while let Some(state) = path.next() {
        match state {
            Ok(state) => states.push(state),
            Err(error) => {
                println!("  ended by: {error}");
                break;
            }
        }
        if states.len().is_multiple_of(256) {
            bar.set_position(states.len() as u64);
            if options.list && states.len().is_multiple_of(4096) {
                let seconds = start.elapsed().as_secs_f64();
                println!("{} nodes {seconds:.1} s {:?}", states.len(), path.timings());
            }
        }
    }
    bar.finish_and_clear();
    if states.len() < most {
        println!("  ended by: {:?}", path.end());
    }
    Ok((states, path.timings(), start.elapsed().as_secs_f64()))
}

/// What a comparison with fixed loads needs of states.
fn events(states: &[LoadingState]) -> Vec<Event> {
    let event = |state: &LoadingState| Event {
        node: state.node,
        approach: state.contact.approach,
        load: state.contact.load,
        contact_stiffness: state.contact.contact_stiffness.unwrap_or(f64::NAN),
    };
    states.iter().map(event).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    if let Some(file) = &options.record {
        return stretches::compare(&LoadingRecord::read_npz(file)?, options.stretches);
    }
    let ny = options.ny.unwrap_or(options.nodes);
    let (grid, surface) = surfaces::make(
        options.surface,
        (options.nodes, ny, options.aspect),
        (options.hurst, options.seed),
    )?;
    let kernel = match options.half_space {
        HalfSpace::Free => KernelTable::new(&Boussinesq::new(grid, 1.0)?)?,
        HalfSpace::Periodic => KernelTable::new(&PeriodicBoussinesq::new(grid, 1.0)?)?,
        HalfSpace::Spectral => KernelTable::new(&Spectral::new(grid, 1.0)?)?,
    };
    if let Some(file) = &options.path {
        let states = recorded::read(file)?;
        return fixed_loads::compare(&states, &surface, &kernel, options.fixed_loads);
    }
    let (states, timings, seconds) = run(&options, &surface, &kernel, ConjugateGradient::new())?;
    let peak = peak_memory().unwrap_or(f64::NAN) / 1e6;
    println!(
        "without a factor: {} events in {seconds:.2} s, {peak:.0} MB, {} windows, {} ties settled, {} taken back",
        states.len(),
        timings.windows,
        timings.ties,
        timings.taken_back
    );
    if options.fixed_loads > 0 {
        fixed_loads::compare(&events(&states), &surface, &kernel, options.fixed_loads)?;
    }
    if options.alone {
        return Ok(());
    }
    let (exact, _, seconds) = run(&options, &surface, &kernel, RecursiveCholesky::new())?;
    println!("with a factor: {} events in {seconds:.2} s", exact.len());
    let uniform = kernel.gauge().unwrap_or(0.0) / grid.cell_area();
    compare::print(&states, &exact, uniform);
    Ok(())
}
