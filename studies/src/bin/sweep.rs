//! Many loads on one surface: what a sweep takes, in time and convolutions, compared with cold solves.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin sweep -- \
//!     [--nodes 512] [--loads 100] [--from 3e-4] [--to 0.3]
//! ```
//!
//! A self-affine surface with λ_s = 4 cells and the roll-off at a quarter of the side; loads are mean
//! pressures over E* times the rms gradient.

use std::error::Error;
use std::time::Instant;

use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity::{Boussinesq, ContactTarget, FixedLoadSolver, Grid};
use clap::Parser;

#[derive(Debug, Parser)]
#[command(about = "A load sweep compared with cold solves")]
struct Arguments {
    /// Nodes a side.
    #[arg(long, default_value_t = 512)]
    nodes: usize,
    /// Number of loads.
    #[arg(long, default_value_t = 100)]
    loads: usize,
    /// Least mean pressure over E* h'rms.
    #[arg(long, default_value_t = 3e-4)]
    from: f64,
    /// Greatest mean pressure over E* h'rms.
    #[arg(long, default_value_t = 0.3)]
    to: f64,
    /// Greatest error of gaps relative to the approach.
    #[arg(long, default_value_t = 1e-8)]
    tolerance: f64,
    /// How many of the loads to solve cold.
    #[arg(long, default_value_t = 12)]
    cold: usize,
    /// Whether to print every state.
    #[arg(long)]
    verbose: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let grid = Grid::square(arguments.nodes, 1.0)?;
    let cutoff = 4.0 / arguments.nodes as f64;
    let surface = SelfAffine::new(0.8, 0.25, cutoff, Amplitude::RmsHeight(5e-3), 1)?;
    let unit = surface.spectrum(&grid)?.rms_gradient();
    let map = HeightMap::sample(&surface, &grid)?;
    let kernel = Boussinesq::new(grid, 1.0)?;
    let ratio = arguments.to / arguments.from;
    let load = |part: f64| unit * arguments.from * ratio.powf(part);
    for stiffness in [true, false] {
        let start = Instant::now();
        let mut solver = FixedLoadSolver::builder(&map, &kernel)
            .tolerance(arguments.tolerance)
            .stiffness(stiffness)
            .build()?;
        let setup = start.elapsed().as_secs_f64();
        let (mut seconds, mut convolutions) = (0.0, 0.0);
        for i in 0..arguments.cold {
            let load = load((i as f64 + 0.5) / arguments.cold as f64);
            let start = Instant::now();
            let solution = solver.solve(load)?;
            let time = start.elapsed().as_secs_f64();
            let effort = solution.effort;
            if arguments.verbose {
                eprintln!(
                    "cold {:.2} %: {time:.3} s, {} + {} iterations, {} + {:.1} convolutions",
                    100.0 * solution.contact.contact_area_fraction,
                    effort.iterations,
                    effort.stiffness_iterations,
                    effort.convolutions,
                    effort.coarse_convolutions
                );
            }
            seconds += time;
            convolutions += effort.convolutions as f64 + effort.coarse_convolutions;
        }
        let cold = arguments.cold as f64;
        let (cold_seconds, cold_convolutions) = (seconds / cold, convolutions / cold);
        let loads = (0..arguments.loads)
            .map(|i| load(i as f64 / (arguments.loads.max(2) - 1) as f64))
            .map(ContactTarget::Load);
        let (mut convolutions, mut worst) = (0.0, 0.0_f64);
        let start = Instant::now();
        let mut last = 0.0;
        for solution in solver.sweep(loads) {
            let solution = solution?;
            let effort = solution.effort;
            convolutions += effort.convolutions as f64 + effort.coarse_convolutions;
            let certificate = solution.certificate;
            // Relative to the approach, as the tolerance is.
            let scale = certificate.length / solution.contact.approach;
            worst = worst
                .max(certificate.greatest_contact_gap * scale)
                .max(-certificate.least_gap * scale);
            if arguments.verbose {
                let now = start.elapsed().as_secs_f64();
                eprintln!(
                    "sweep {:.2} %: {:.3} s, {} + {} iterations, {} + {:.1} convolutions",
                    100.0 * solution.contact.contact_area_fraction,
                    now - last,
                    effort.iterations,
                    effort.stiffness_iterations,
                    effort.convolutions,
                    effort.coarse_convolutions
                );
                last = now;
            }
        }
        let seconds = start.elapsed().as_secs_f64();
        println!(
            "{0} x {0}, {1} loads, stiffness {stiffness}: set-up {setup:.3} s; mean cold solve \
             {cold_seconds:.3} s, {cold_convolutions:.1} convolutions; sweep {seconds:.2} s, \
             {convolutions:.0} convolutions, worst error {worst:.1e}; that is {2:.1} cold solves by \
             time, {3:.1} by convolutions",
            arguments.nodes,
            arguments.loads,
            seconds / cold_seconds,
            convolutions / cold_convolutions,
        );
    }
    Ok(())
}
