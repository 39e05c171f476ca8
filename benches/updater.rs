//! Time of each verb of the Cholesky updater, with n nodes in contact, as a real path uses them.
//!
//! Throughput is in floating-point operations where the processor is the bound (forward
//! substitution: k n², Schur complement: k² n) and in bytes of the factor where memory is
//! (solution, join). `cargo bench -p asperity-benches --bench updater -- solution/4000` runs some of them.

use std::error::Error;
use std::hint::black_box;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use asperity::contact::ContactSequence;
use asperity::surface::Paraboloid;
use asperity::updater::{
    CholeskyTimings, LinearUpdater, RecursiveCholesky, Schur, Solution, WindowFactor,
};
use asperity::{Boussinesq, Grid, LoadingSolver, Problem};
use asperity_benches::succeed;
use asperity_testing::{Altered, Call};
use criterion::measurement::WallTime;
use criterion::{BatchSize, BenchmarkGroup, Criterion, SamplingMode, Throughput};

/// New nodes at a time.
const NEW: usize = 256;

/// Bytes of a number of the factor.
const NUMBER: usize = size_of::<f64>();

/// What a path asked of its updater in one window.
struct Window {
    /// The updater before it.
    updater: RecursiveCholesky,
    /// The contact before it.
    contact: ContactSequence,
    watched: Vec<usize>,
    touched: WindowFactor,
    /// The contact after it.
    grown: ContactSequence,
}

/// A sphere on 128 × 128 nodes.
fn sphere() -> Result<(Paraboloid, Boussinesq), asperity::Error> {
    let half_space = Boussinesq::new(Grid::square(128, 1e-2)?, 1.0)?;
    Ok((Paraboloid::new(1.0)?, half_space))
}

/// The first window of the path of the sphere with at least `at` nodes in contact.
fn window(at: usize) -> Result<Window, Box<dyn Error>> {
    let complete = Arc::new(Mutex::new(None));
    let found = Arc::clone(&complete);
    let mut begun = None;
    let capture = Altered::new(RecursiveCholesky::new()).on_call(move |inner, call| {
        match call {
            Call::Watch { contact, nodes, .. } if contact.len() >= at => {
                begun.get_or_insert_with(|| Window {
                    updater: inner.clone(),
                    contact: contact.clone(),
                    watched: nodes.to_vec(),
                    touched: WindowFactor::default(),
                    grown: contact.clone(),
                });
            }
            Call::Join { contact, factor, .. } => {
                if let (Some(window), Ok(mut found)) = (begun.take(), found.lock()) {
                    let (touched, grown) = (factor.clone(), contact.clone());
                    found.get_or_insert(Window { touched, grown, ..window });
                }
            }
            _ => {}
        }
        call.ask(inner)
    });
    let (surface, kernel) = sphere()?;
    let mut path = LoadingSolver::builder(&surface, &kernel).updater(capture).build()?;
    loop {
        path.next().ok_or("the path is too short")??;
        let found = complete.lock().map_err(|_| "a panic")?.take();
        if let Some(window) = found {
            return Ok(window);
        }
    }
}

/// The time that `part` of the updater's timings grows by in `count` calls of `work`.
fn share(
    updater: &mut RecursiveCholesky,
    count: u64,
    part: impl Fn(CholeskyTimings) -> Duration,
    mut work: impl FnMut(&mut RecursiveCholesky, u64),
) -> Duration {
    let before = part(updater.timings());
    for i in 0..count {
        work(updater, i);
    }
    part(updater.timings()) - before
}

fn verbs(criterion: &mut Criterion, at: usize) -> Result<(), Box<dyn Error>> {
    let Window { updater, contact, watched, touched, grown } = window(at)?;
    let (surface, kernel) = sphere()?;
    let problem = Problem::new(&surface, &kernel)?;
    let n = contact.len();
    let id = at.to_string();

    // Two sets of nodes in turn, so that all are new to the updater every time.
    let mut out: Vec<usize> = (0..problem.grid().nodes()).collect();
    out.retain(|&node| !contact.contains(node));
    let sets = [&out[..NEW], &out[NEW..2 * NEW]];
    let mut schur = Schur::default();
    let mut borders = |updater: &mut RecursiveCholesky, i: u64| {
        succeed(updater.watch(&problem, &contact, sets[(i % 2) as usize], &mut schur));
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
    let mut solution = Solution::default();
    let approach = problem.mean_gap();
    let mut group = short_group(criterion, "solution");
    group.throughput(Throughput::Bytes((n * n / 2 * NUMBER) as u64));
    group.bench_function(&id, |bencher| {
        bencher.iter_custom(|count| {
            let mut time = Duration::ZERO;
            for _ in 0..count {
                succeed(working.solve(&problem, &contact, n - NEW, approach, &mut solution));
                let start = Instant::now();
                succeed(working.solve(&problem, &contact, n, approach, black_box(&mut solution)));
                time += start.elapsed();
            }
            time
        });
    });
    group.finish();

    let mut ready = updater.clone();
    succeed(ready.watch(&problem, &contact, &watched, &mut schur));
    let mut group = short_group(criterion, "join");
    group.throughput(Throughput::Bytes((n * touched.len() * NUMBER) as u64));
    group.bench_function(&id, |bencher| {
        bencher.iter_batched_ref(
            || ready.clone(),
            |updater| succeed(updater.join(&problem, &grown, &touched)),
            BatchSize::PerIteration,
        );
    });
    group.finish();

    // The whole window without its events: n² operations and more for each node that joins.
    let mut group = short_group(criterion, "window");
    group.throughput(Throughput::Elements((touched.len() * n * n) as u64));
    group.bench_function(&id, |bencher| {
        bencher.iter_batched_ref(
            || updater.clone(),
            |updater| {
                succeed(updater.watch(&problem, &contact, &watched, &mut schur));
                succeed(updater.join(&problem, &grown, &touched));
                succeed(updater.solve(&problem, &grown, grown.len(), approach, &mut solution));
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
        verbs(&mut criterion, at)?;
    }
    criterion.final_summary();
    Ok(())
}
