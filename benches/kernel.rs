//! Time per influence coefficient: whole tables, and each regime of the Boussinesq kernel; time to
//! make a periodic kernel.

use std::hint::black_box;

use asperity::{Boussinesq, Grid, InfluenceKernel, PeriodicBoussinesq, Spectral};
use asperity_benches::succeed;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// A kernel on cells `aspect` times as long along x as along y.
fn kernel(nodes: usize, aspect: f64) -> Boussinesq {
    let grid = succeed(Grid::new(nodes, nodes, 1e-6 * aspect, 1e-6));
    succeed(Boussinesq::new(grid, 1e11))
}

/// The quadrant 0 ≤ di, dj < nodes, all that a table of an even kernel needs.
fn quadrants(c: &mut Criterion) {
    let mut group = c.benchmark_group("boussinesq_quadrant");
    group.sample_size(10);
    for (nodes, aspect) in [(64, 1.0), (512, 1.0), (2048, 1.0), (512, 10.0), (512, 100.0)] {
        let kernel = kernel(nodes, aspect);
        group.throughput(Throughput::Elements((nodes * nodes) as u64));
        let id = BenchmarkId::new(format!("aspect_{aspect}"), nodes);
        group.bench_function(id, |b| {
            b.iter(|| {
                let mut sum = 0.0;
                for dj in 0..nodes as isize {
                    for di in 0..nodes as isize {
                        sum += kernel.coefficient(di, dj);
                    }
                }
                sum
            });
        });
    }
    group.finish();
}

/// One coefficient at a time, at distances that meet each number of terms.
fn offsets(c: &mut Criterion) {
    let mut group = c.benchmark_group("boussinesq_offset");
    group.throughput(Throughput::Elements(1));
    let kernel = kernel(4096, 1.0);
    for offset in [(0, 0), (0, 1), (1, 2), (3, 3), (5, 5), (9, 9), (15, 15), (40, 40), (400, 400)] {
        let id = BenchmarkId::from_parameter(format!("{},{}", offset.0, offset.1));
        group.bench_with_input(id, &offset, |b, &(di, dj)| {
            b.iter(|| kernel.coefficient(black_box(di), black_box(dj)));
        });
    }
    group.finish();
}

/// Symbol, coefficients and gauge of the periodic half-space.
fn periodic(c: &mut Criterion) {
    let mut group = c.benchmark_group("periodic");
    group.sample_size(10);
    for (nodes, aspect) in [(64, 1.0), (512, 1.0), (1024, 1.0), (64, 100.0)] {
        let grid = succeed(Grid::new(nodes, nodes, aspect, 1.0));
        group.throughput(Throughput::Elements((nodes * nodes) as u64));
        let id = BenchmarkId::new(format!("love, aspect_{aspect}"), nodes);
        group.bench_function(id, |b| b.iter(|| succeed(PeriodicBoussinesq::new(grid, 1.0))));
        let id = BenchmarkId::new(format!("spectral, aspect_{aspect}"), nodes);
        group.bench_function(id, |b| b.iter(|| succeed(Spectral::new(grid, 1.0))));
    }
    group.finish();
}

criterion_group!(benches, quadrants, offsets, periodic);
criterion_main!(benches);
