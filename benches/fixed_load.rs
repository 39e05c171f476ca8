//! Time of one cold fixed-load solve, set-up included, by grid size and load, without and with the
//! stiffness.
//!
//! `cargo bench -p asperity-benches --bench fixed_load`. Self-affine surfaces with λ_s = 4 cells and the roll-off at a
//! quarter of the side; loads are mean pressures over E* times the rms gradient.

use std::error::Error;

use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity::{Boussinesq, FixedLoadSolver, Grid};
use criterion::{BenchmarkId, Criterion};

fn main() -> Result<(), Box<dyn Error>> {
    let mut criterion = Criterion::default().configure_from_args();
    for side in [128, 256, 512, 1024] {
        let grid = Grid::square(side, 1.0)?;
        let cutoff = 4.0 / side as f64;
        let surface = SelfAffine::new(0.8, 0.25, cutoff, Amplitude::RmsHeight(5e-3), 1)?;
        let gradient = surface.spectrum(&grid)?.rms_gradient();
        let map = HeightMap::sample(&surface, &grid)?;
        let kernel = Boussinesq::new(grid, 1.0)?;
        let mut group = criterion.benchmark_group(format!("{side} x {side}, tolerance 1e-8"));
        group.sample_size(10);
        for load in [0.0015, 0.015, 0.06, 0.3] {
            for (name, stiffness) in [("pressure", false), ("with stiffness", true)] {
                group.bench_function(BenchmarkId::new(name, load), |bencher| {
                    bencher.iter(|| {
                        FixedLoadSolver::builder(&map, &kernel)
                            .stiffness(stiffness)
                            .build()
                            .and_then(|mut solver| solver.solve(load * gradient))
                            .map(|solution| solution.effort.iterations)
                            .unwrap_or_else(|error| unreachable!("{error}"))
                    });
                });
            }
        }
        group.finish();
    }
    criterion.final_summary();
    Ok(())
}
