//! Contact of a measured surface under given loads, one line for each.
//!
//! ```text
//! cargo run --release --example fixed_load -- --surface FILE.npy --side M --e-star PA \
//!     --load N [--load N ...] [--periodic love|spectral] [--tolerance T] [--save DIR]
//! ```
//!
//! Heights in metres, `z[ix, iy]`, positive towards the half-space; `--side` is the length along x,
//! cells are square. Loads are forces. Results go to stdout, progress to stderr. With `--periodic` the
//! approach is that of the mean planes, and there is no contact stiffness but the interfacial one.

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use asperity::io::write_npy;
use asperity::surface::HeightMap;
use asperity::{FixedLoadSolver, Grid};
use clap::Parser;
use half_space::{HalfSpace, Periodic};

#[allow(dead_code)] // shared: each example uses its part
#[path = "common/half_space.rs"]
mod half_space;

#[derive(Debug, Parser)]
#[command(about = "Contact of a rough surface with an elastic half-space under given loads")]
struct Arguments {
    /// Heights of the surface [m], a .npy file with z[ix, iy].
    #[arg(long)]
    surface: PathBuf,
    /// Length of the surface along x [m]; cells are square.
    #[arg(long)]
    side: f64,
    /// Composite modulus E* [Pa].
    #[arg(long)]
    e_star: f64,
    /// Load [N]; may be given several times.
    #[arg(long, required = true)]
    load: Vec<f64>,
    /// Make surface and half-space periodic, with this kernel.
    #[arg(long, value_enum)]
    periodic: Option<Periodic>,
    /// Greatest error of gaps relative to the approach.
    #[arg(long, default_value_t = 1e-8)]
    tolerance: f64,
    /// Directory for pressure_K.npy and gap_K.npy, K counting the loads from 0.
    #[arg(long)]
    save: Option<PathBuf>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let map = HeightMap::from_npy(&arguments.surface)?;
    let (nx, ny) = map.shape();
    let cell = arguments.side / nx as f64;
    let grid = Grid::new(nx, ny, cell, cell)?;
    let kernel = HalfSpace::new(arguments.periodic, grid, arguments.e_star)?;
    let start = Instant::now();
    let mut solver = FixedLoadSolver::builder(map, kernel)
        .tolerance(arguments.tolerance)
        .stiffness(false)
        .build()?;
    eprintln!(
        "{nx} x {ny} nodes, set up in {:.3} s, {} MB",
        start.elapsed().as_secs_f64(),
        solver.memory() / 1_000_000
    );
    if let Some(directory) = &arguments.save {
        std::fs::create_dir_all(directory)?;
    }
    for (k, &load) in arguments.load.iter().enumerate() {
        eprintln!("load {} of {}: {load} N", k + 1, arguments.load.len());
        let start = Instant::now();
        let mut solution = solver.solve(load)?;
        let seconds = start.elapsed().as_secs_f64();
        solver.add_stiffness(&mut solution)?;
        let seconds_more = start.elapsed().as_secs_f64() - seconds;
        let state = solution.state;
        println!(
            "load={:e} contact_nodes={} max_pressure={:e} mean_gap={:e} approach={:e} \
             contact_stiffness={} interfacial_stiffness={} iterations={} seconds={seconds:.6}",
            state.load,
            state.contact_nodes,
            state.max_pressure,
            state.mean_gap,
            state.approach,
            printed(state.contact_stiffness),
            printed(state.interfacial_stiffness),
            solution.iterations,
        );
        eprintln!(
            "  {:.3} % in contact, {} convolutions and {:.1} on coarser grids, {seconds_more:.3} s \
             more for the stiffness, errors: complementarity {:.1e}, gap in contact {:.1e}, least gap {:.1e}",
            100.0 * state.contact_area_fraction,
            solution.convolutions,
            solution.coarse_convolutions,
            solution.certificate.complementarity,
            solution.certificate.greatest_contact_gap,
            solution.certificate.least_gap,
        );
        if let Some(directory) = &arguments.save {
            write_npy(
                directory.join(format!("pressure_{k}.npy")),
                &solution.pressure,
            )?;
            write_npy(directory.join(format!("gap_{k}.npy")), &solution.gap)?;
        }
    }
    Ok(())
}

/// Nothing where there is none.
fn printed(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| format!("{value:e}"))
}
