//! Time of whole paths, of a pressure on demand, and of a table of influence coefficients.
//!
//! Throughput of a path of n nodes is in n³/3 floating-point operations, those of the Cholesky factorisation of its
//! last contact set. `cargo bench -p asperity-benches --bench path -- sphere/256` runs some of them.

use std::error::Error;
use std::time::Duration;

use asperity::kernel::KernelTable;
use asperity::loading::LoadingBuilder;
use asperity::surface::Paraboloid;
use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine, Surface};
use asperity_benches::succeed;
use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, SamplingMode, Throughput};

/// Side of the grid [m].
const SIDE: f64 = 2.5e-3;
/// Nodes a side, and the contact area fraction at which the path ends.
const CASES: [(usize, f64); 3] = [(64, 0.3), (128, 0.2), (256, 0.05)];

/// Floating-point operations of a factorisation of n nodes.
fn flops(nodes: usize, fraction: f64) -> u64 {
    let n = ((nodes * nodes) as f64 * fraction).floor();
    (n.powi(3) / 3.0) as u64
}

fn bench(group: &mut BenchmarkGroup<'_, WallTime>, id: String, builder: &LoadingBuilder<'_>) {
    group.bench_function(id, |bencher| {
        bencher.iter(|| {
            let path = succeed(builder.clone().build());
            path.map(succeed).count()
        });
    });
}

fn paths(
    criterion: &mut Criterion,
    name: &str,
    surface: &dyn Surface,
) -> Result<(), asperity::Error> {
    let mut group = short_group(criterion, name);
    for (nodes, fraction) in CASES {
        group.throughput(Throughput::Elements(flops(nodes, fraction)));
        let kernel = Boussinesq::new(Grid::square(nodes, SIDE)?, 1.0)?;
        let builder = LoadingSolver::builder(surface, &kernel).max_area_fraction(fraction);
        bench(&mut group, nodes.to_string(), &builder);
        if nodes == 64 {
            bench(&mut group, "64/window 1".to_owned(), &builder.window_size(1));
        }
    }
    group.finish();
    Ok(())
}

/// The pressure at the end of a path; throughput in bytes of the factor. The last two states in turn,
/// since the solution of the one asked for last is kept.
fn pressure(criterion: &mut Criterion) -> Result<(), asperity::Error> {
    let mut group = short_group(criterion, "pressure");
    let surface = SelfAffine::zhang2020(1);
    for (nodes, fraction) in CASES {
        let kernel = Boussinesq::new(Grid::square(nodes, SIDE)?, 1.0)?;
        let mut path =
            LoadingSolver::builder(&surface, &kernel).max_area_fraction(fraction).build()?;
        let mut states = Vec::new();
        let n = (nodes * nodes) as f64 * fraction;
        group.throughput(Throughput::Bytes((4.0 * n * n) as u64));
        group.bench_function(nodes.to_string(), |bencher| {
            // Only if this bench was asked for.
            if states.is_empty() {
                states.extend(path.by_ref().map(succeed));
            }
            let mut last = states.iter().rev().take(2).cycle();
            bencher.iter(|| {
                last.next()
                    .map(|state| succeed(path.fields_at(state).map(|fields| fields.pressure)))
            });
        });
    }
    group.finish();
    Ok(())
}

/// All coefficients of a grid, as a solver evaluates them when it is built.
fn table(criterion: &mut Criterion) -> Result<(), asperity::Error> {
    let mut group = short_group(criterion, "table");
    let nodes = 256;
    let kernel = Boussinesq::new(Grid::square(nodes, SIDE)?, 1.0)?;
    let side = 2 * nodes as u64 - 1;
    group.throughput(Throughput::Elements(side * side));
    group.bench_function(nodes.to_string(), |bencher| {
        bencher.iter(|| succeed(KernelTable::new(&kernel)));
    });
    group.finish();
    Ok(())
}

/// A group whose benches take a few seconds each.
fn short_group<'a>(criterion: &'a mut Criterion, name: &str) -> BenchmarkGroup<'a, WallTime> {
    let mut group = criterion.benchmark_group(name);
    group
        .sample_size(10)
        .sampling_mode(SamplingMode::Flat)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3));
    group
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut criterion = Criterion::default().configure_from_args();
    paths(&mut criterion, "sphere", &Paraboloid::new(1.0)?)?;
    paths(&mut criterion, "self-affine", &SelfAffine::zhang2020(1))?;
    pressure(&mut criterion)?;
    table(&mut criterion)?;
    criterion.final_summary();
    Ok(())
}
