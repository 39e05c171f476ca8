//! Time of each verb of the Cholesky updaters, with n nodes in contact, as a real path uses them.
//!
//! Throughput is in floating-point operations where the processor is the bound (forward
//! substitution: k n², Schur complement: k² n) and in bytes of the factor where memory is
//! (solution, commit). `cargo bench --bench updater -- solution/4000` runs some of them.

use std::error::Error;
use std::hint::black_box;
use std::time::{Duration, Instant};

use asperity::surface::Paraboloid;
use asperity::updater::{
    CholeskyTimings, LinearUpdater, MixedCholesky, RecursiveCholesky, Schur, Solution, System,
    Touched, WindowCost,
};
use asperity::{Boussinesq, Grid, LoadingSolver};
use criterion::measurement::WallTime;
use criterion::{BatchSize, BenchmarkGroup, Criterion, SamplingMode, Throughput};

/// New nodes at a time.
const NEW: usize = 256;

/// An updater that says where its time went.
trait Timed: LinearUpdater + Clone {
    /// Bytes of a number of the factor.
    const NUMBER: usize;

    fn timings(&self) -> CholeskyTimings;
}

impl Timed for RecursiveCholesky {
    const NUMBER: usize = size_of::<f64>();

    fn timings(&self) -> CholeskyTimings {
        Self::timings(self)
    }
}

impl Timed for MixedCholesky {
    const NUMBER: usize = size_of::<f32>();

    fn timings(&self) -> CholeskyTimings {
        Self::timings(self)
    }
}

/// What a path asked of its updater in one window.
#[derive(Clone)]
struct Window<U> {
    /// The updater before it.
    updater: U,
    system: System,
    watched: Vec<usize>,
    touched: Touched,
}

/// An updater that keeps the first window with at least `at` nodes in contact.
struct Capture<U> {
    inner: U,
    at: usize,
    contact: usize,
    window: Option<Window<U>>,
    complete: bool,
}

impl<U: Timed> LinearUpdater for Capture<U> {
    fn schur(
        &mut self,
        system: &System,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), asperity::Error> {
        if self.contact >= self.at && self.window.is_none() {
            self.window = Some(Window {
                updater: self.inner.clone(),
                system: system.clone(),
                watched: nodes.to_vec(),
                touched: Touched::default(),
            });
        }
        self.inner.schur(system, nodes, schur)
    }

    fn commit(&mut self, system: &System, touched: &Touched) -> Result<(), asperity::Error> {
        self.contact += touched.len();
        if let Some(window) = self.window.as_mut().filter(|_| !self.complete) {
            window.touched = touched.clone();
            self.complete = true;
        }
        self.inner.commit(system, touched)
    }

    fn solve(
        &mut self,
        system: &System,
        touched: &Touched,
        count: usize,
        solution: &mut Solution,
    ) -> Result<(), asperity::Error> {
        self.inner.solve(system, touched, count, solution)
    }

    fn window_cost(&self) -> WindowCost {
        self.inner.window_cost()
    }

    fn is_exact(&self) -> bool {
        self.inner.is_exact()
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        self.inner.bytes(contact, watched)
    }
}

/// A window of the path of a sphere on 128 × 128 nodes, and the nodes in contact before it.
fn window<U: Timed>(updater: U, at: usize) -> Result<(Window<U>, Vec<usize>), Box<dyn Error>> {
    let capture = Capture {
        inner: updater,
        at,
        contact: 0,
        window: None,
        complete: false,
    };
    let kernel = Boussinesq::new(Grid::square(128, 1e-2)?, 1.0)?;
    let mut path = LoadingSolver::builder(Paraboloid::new(1.0)?, kernel)
        .updater(capture)
        .build()?;
    while !path.updater().complete {
        path.next().ok_or("the path is too short")??;
    }
    let window = path.updater().window.clone().ok_or("no window")?;
    let before = path.updater().contact - window.touched.len();
    Ok((window, path.contact_order()[..before].to_vec()))
}

/// The time that `part` of the updater's timings grows by in `count` calls of `work`.
fn share<U: Timed>(
    updater: &mut U,
    count: u64,
    part: impl Fn(CholeskyTimings) -> Duration,
    mut work: impl FnMut(&mut U, u64),
) -> Duration {
    let before = part(updater.timings());
    for i in 0..count {
        work(updater, i);
    }
    part(updater.timings()) - before
}

/// Criterion takes no errors; a bench that fails must not be reported as fast.
fn succeed<T>(result: Result<T, asperity::Error>) -> T {
    match result {
        Ok(value) => value,
        Err(error) => unreachable!("{error}"),
    }
}

fn verbs<U: Timed>(
    criterion: &mut Criterion,
    name: &str,
    updater: U,
    at: usize,
) -> Result<(), Box<dyn Error>> {
    let (window, contact) = window(updater, at)?;
    let Window {
        updater,
        system,
        watched,
        touched,
    } = window;
    let n = contact.len();
    let id = format!("{at}/{name}");

    // Two sets of nodes in turn, so that all are new to the updater every time.
    let mut out: Vec<usize> = (0..system.gap().len()).collect();
    let mut inside = vec![false; out.len()];
    for &node in &contact {
        inside[node] = true;
    }
    out.retain(|&node| !inside[node]);
    let sets = [&out[..NEW], &out[NEW..2 * NEW]];
    let mut schur = Schur::default();
    let mut borders = |updater: &mut U, i: u64| {
        succeed(updater.schur(&system, sets[(i % 2) as usize], &mut schur));
    };
    // Whichever set the last sample ended with.
    let mut turn = 0;
    let mut working = updater.clone();
    let mut bench = |group: &str, flops: usize, part: fn(CholeskyTimings) -> Duration| {
        let mut group = short_group(criterion, group);
        group.throughput(Throughput::Elements(flops as u64));
        group.bench_function(&id, |bencher| {
            bencher.iter_custom(|count| {
                share(&mut working, count, part, |updater, _| {
                    turn += 1;
                    borders(updater, turn);
                })
            });
        });
        group.finish();
    };
    bench("forward", NEW * n * n, |timings| timings.forward);
    bench("schur", NEW * NEW * n, |timings| timings.schur);

    // From the solution on the nodes before the last window, as at a refresh.
    let none = Touched::default();
    let mut solution = Solution::default();
    let mut group = short_group(criterion, "solution");
    group.throughput(Throughput::Bytes((n * n / 2 * U::NUMBER) as u64));
    group.bench_function(&id, |bencher| {
        bencher.iter_custom(|count| {
            let mut time = Duration::ZERO;
            for _ in 0..count {
                succeed(working.solve(&system, &none, n - NEW, &mut solution));
                let start = Instant::now();
                succeed(working.solve(&system, &none, n, black_box(&mut solution)));
                time += start.elapsed();
            }
            time
        });
    });
    group.finish();

    let mut ready = updater.clone();
    succeed(ready.schur(&system, &watched, &mut schur));
    let mut group = short_group(criterion, "commit");
    group.throughput(Throughput::Bytes((n * touched.len() * U::NUMBER) as u64));
    group.bench_function(&id, |bencher| {
        bencher.iter_batched_ref(
            || ready.clone(),
            |updater| succeed(updater.commit(&system, &touched)),
            BatchSize::PerIteration,
        );
    });
    group.finish();

    // The whole window but for its events: n² operations and more for each node that joins.
    let joined = n + touched.len();
    let mut group = short_group(criterion, "window");
    group.throughput(Throughput::Elements((touched.len() * n * n) as u64));
    group.bench_function(&id, |bencher| {
        bencher.iter_batched_ref(
            || updater.clone(),
            |updater| {
                succeed(updater.schur(&system, &watched, &mut schur));
                succeed(updater.commit(&system, &touched));
                succeed(updater.solve(&system, &none, joined, &mut solution));
            },
            BatchSize::PerIteration,
        );
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
        .measurement_time(Duration::from_secs(2));
    group
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut criterion = Criterion::default().configure_from_args();
    for at in [1000, 4000] {
        verbs(&mut criterion, "f64", RecursiveCholesky::new(), at)?;
        verbs(&mut criterion, "mixed", MixedCholesky::single_from(0), at)?;
    }
    criterion.final_summary();
    Ok(())
}
