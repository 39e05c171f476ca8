//! Time of one convolution: one field and two, by grid size and number of threads; free and periodic.
//!
//! `cargo bench -p asperity-benches --bench convolution`, or with `--no-default-features` for plain loops.

use std::error::Error;

use asperity::convolution::Convolution;
use asperity::{Boundary, Grid, InfluenceKernel, Spectral};
use criterion::{Criterion, Throughput};

/// The time does not depend on the values: a point load's 1 / r with a rounded peak will do.
struct PointLoad(Grid);

impl InfluenceKernel for PointLoad {
    fn grid(&self) -> Grid {
        self.0
    }
    fn boundary(&self) -> Boundary {
        Boundary::Free
    }
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        1.0 / (1.0 + (di * di + dj * dj) as f64).sqrt()
    }
}

/// Threads in which a convolution runs.
struct Threads {
    name: String,
    #[cfg(feature = "rayon")]
    pool: rayon::ThreadPool,
}

impl Threads {
    #[cfg(feature = "rayon")]
    fn all() -> Result<Vec<Self>, Box<dyn Error>> {
        let available = std::thread::available_parallelism().map_or(1, usize::from);
        let mut counts = vec![1, available];
        counts.dedup();
        let mut threads = Vec::new();
        for count in counts {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build()?;
            let name = format!("{count} threads");
            threads.push(Self { name, pool });
        }
        Ok(threads)
    }

    #[cfg(not(feature = "rayon"))]
    fn all() -> Result<Vec<Self>, Box<dyn Error>> {
        let name = "without rayon".to_owned();
        Ok(vec![Self { name }])
    }

    fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        #[cfg(feature = "rayon")]
        return self.pool.install(work);
        #[cfg(not(feature = "rayon"))]
        work()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut criterion = Criterion::default().configure_from_args();
    let all_threads = Threads::all()?;
    for side in [128, 256, 512, 1024] {
        let grid = Grid::square(side, 1.0)?;
        let mut convolution = Convolution::new(&PointLoad(grid))?;
        // Nowhere zero: no row is skipped.
        let pressure: Vec<f64> =
            (0..grid.nodes()).map(|node| 2.0 + (node as f64 * 0.1).sin()).collect();
        let mut first = vec![0.0; grid.nodes()];
        let mut second = vec![0.0; grid.nodes()];
        let mut group = criterion.benchmark_group(format!("convolution of {side} x {side}"));
        group.throughput(Throughput::Elements(grid.nodes() as u64));
        for threads in &all_threads {
            group.bench_function(format!("one field, {}", threads.name), |bencher| {
                bencher.iter(|| threads.run(|| convolution.apply(&pressure, &mut first)));
            });
            group.bench_function(format!("two fields, {}", threads.name), |bencher| {
                bencher.iter(|| {
                    let displacements = [&mut first[..], &mut second[..]];
                    threads.run(|| convolution.apply_two([&pressure, &pressure], displacements))
                });
            });
        }
        group.finish();
    }
    let mut group = criterion.benchmark_group("periodic convolution");
    // Powers of two, 270 = 2 × 3³ × 5, and two primes.
    for side in [128, 251, 256, 270, 509, 512, 1024] {
        let grid = Grid::square(side, 1.0)?;
        let mut convolution = Convolution::new(&Spectral::new(grid, 1.0)?)?;
        let pressure: Vec<f64> =
            (0..grid.nodes()).map(|node| 2.0 + (node as f64 * 0.1).sin()).collect();
        let mut displacement = vec![0.0; grid.nodes()];
        group.throughput(Throughput::Elements(grid.nodes() as u64));
        for threads in &all_threads {
            group.bench_function(format!("{side} x {side}, {}", threads.name), |bencher| {
                bencher.iter(|| threads.run(|| convolution.apply(&pressure, &mut displacement)));
            });
        }
    }
    group.finish();
    criterion.final_summary();
    Ok(())
}
