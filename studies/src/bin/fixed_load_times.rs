//! Times of cold fixed-load solves, and the surfaces, to measure other solvers on.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin fixed_load_times -- \
//!     --out DIR [--nodes 128 --nodes 512] [--load L ...]
//! ```
//!
//! Self-affine surfaces with λ_s = 4 cells, the roll-off at a quarter of the side and a side of 1;
//! loads are mean pressures over E* times the rms gradient. Every time is the median of three and
//! includes the set-up: table of the kernel, plans and symbols of the transforms, all grids. For each
//! grid a line gives the loads as mean pressures over E*, as other solvers want them.

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use asperity::io::write_npy;
use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity::{Boussinesq, FixedLoadSolver, Grid};
use clap::Parser;

#[derive(Debug, Parser)]
#[command(about = "Times of cold fixed-load solves, and the surfaces they were measured on")]
struct Arguments {
    /// Nodes a side; may be given several times.
    #[arg(long, default_values_t = [128, 256, 512, 1024])]
    nodes: Vec<usize>,
    /// Mean pressure over E* h'rms; may be given several times.
    #[arg(long, default_values_t = [0.0015, 0.015, 0.06, 0.3])]
    load: Vec<f64>,
    /// Greatest error of gaps relative to the approach.
    #[arg(long, default_value_t = 1e-8)]
    tolerance: f64,
    /// Directory for self_affine_N.npy.
    #[arg(long)]
    out: PathBuf,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    std::fs::create_dir_all(&arguments.out)?;
    for &nodes in &arguments.nodes {
        let grid = Grid::square(nodes, 1.0)?;
        let cutoff = 4.0 / nodes as f64;
        let surface = SelfAffine::new(0.8, 0.25, cutoff, Amplitude::RmsHeight(5e-3), 1)?;
        let unit = surface.spectrum(&grid)?.rms_gradient();
        let map = HeightMap::sample(&surface, &grid)?;
        let path = arguments.out.join(format!("self_affine_{nodes}.npy"));
        write_npy(&path, map.matrix())?;
        let loads: Vec<_> = arguments.load.iter().map(|l| (l * unit).to_string()).collect();
        println!("{} 1 {}", path.display(), loads.join(" "));
        let kernel = Boussinesq::new(grid, 1.0)?;
        for &load in &arguments.load {
            for stiffness in [false, true] {
                let mut seconds = Vec::new();
                let mut last = None;
                for _ in 0..3 {
                    let start = Instant::now();
                    let mut solver = FixedLoadSolver::builder(&map, &kernel)
                        .tolerance(arguments.tolerance)
                        .stiffness(stiffness)
                        .build()?;
                    let solution = solver.solve(load * unit)?;
                    seconds.push(start.elapsed().as_secs_f64());
                    last = Some(solution);
                }
                seconds.sort_by(f64::total_cmp);
                let Some(solution) = last else { continue };
                let effort = solution.effort;
                println!(
                    "asperity {nodes} load {load}, stiffness {stiffness}: {:.3} s, {} nodes ({:.1} %), \
                     greatest pressure {:.9e}, {} + {} iterations, {} + {:.1} convolutions",
                    seconds[1],
                    solution.contact.contact_nodes,
                    100.0 * solution.contact.contact_area_fraction,
                    solution.fields.max_pressure(),
                    effort.iterations,
                    effort.stiffness_iterations,
                    effort.convolutions,
                    effort.coarse_convolutions,
                );
            }
        }
    }
    Ok(())
}
