//! Paths without a factor on bodies on which nodes may leave: windows until one does, beside paths of single events with a factor.

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::surface::{Amplitude, SelfAffine};
use asperity::updater::{ConjugateGradient, LinearUpdater, RecursiveCholesky};
use asperity::{ContactEvent, ContactGrowth, Grid, InfluenceKernel, LoadingSolver, LoadingState};

/// A coat of E₁/E₂ and a thickness in cells, on cells of 1.
fn coated(n: usize, ratio: f64, thickness: f64, is_free: bool) -> Layered {
    let grid = Grid::square(n, n as f64).unwrap();
    let coat = Layer { young: ratio, poisson: 0.3, thickness };
    let body = LayeredBody::new(&[coat], Base::HalfSpace { young: 1.0, poisson: 0.3 }).unwrap();
    let kernel =
        if is_free { Layered::free(grid, body) } else { Layered::periodic(grid, body) }.unwrap();
    assert_eq!(kernel.contact_growth(), ContactGrowth::Unknown);
    kernel
}

fn followed<U: LinearUpdater>(
    surface: &SelfAffine,
    kernel: &Layered,
    updater: U,
    nodes: usize,
) -> (LoadingSolver<U>, Vec<LoadingState>) {
    let builder = LoadingSolver::builder(surface, kernel).updater(updater);
    let mut path = builder.max_nodes(nodes).build().unwrap();
    let states = path.by_ref().map(Result::unwrap).collect();
    (path, states)
}

#[test]
fn explore() {
    let (mut all, mut left) = (0, 0);
    for (seed, n, ratio, thickness, shortest) in [
        (1, 20, 10.0, 0.4, 2.0),
        (2, 20, 10.0, 0.4, 2.0),
        (3, 24, 10.0, 0.4, 2.0),
        (4, 24, 10.0, 0.4, 4.0),
        (5, 32, 10.0, 0.4, 2.0),
        (6, 32, 10.0, 1.0, 2.0),
        (7, 32, 30.0, 0.4, 3.0),
        (8, 48, 10.0, 0.4, 2.0),
        (9, 40, 100.0, 2.0, 2.0),
        (10, 40, 100.0, 4.0, 3.0),
        (11, 48, 10.0, 4.0, 4.0),
    ] {
        for is_free in [true, false] {
            let kernel = coated(n, ratio, thickness, is_free);
            let surface =
                SelfAffine::new(0.8, 0.5 * n as f64, shortest, Amplitude::RmsHeight(1.0), seed);
            let surface = surface.unwrap();
            let nodes = n * n * 9 / 10;
            let (_, exact) = followed(&surface, &kernel, RecursiveCholesky::new(), nodes);
            let start = std::time::Instant::now();
            let (path, found) = followed(&surface, &kernel, ConjugateGradient::new(), nodes);
            let releases = exact.iter().filter(|s| s.event == ContactEvent::Release).count();
            let event = |s: &LoadingState| (s.event, s.node);
            let first = exact.iter().zip(&found).position(|(a, b)| event(a) != event(b));
            let same = exact.iter().zip(&found).filter(|(a, b)| event(a) == event(b)).count();
            let worst = exact.iter().zip(&found).filter(|(a,b)| a.node==b.node).map(|(a, b)| {
                (a.contact.approach - b.contact.approach).abs() / (b.approach_error + 1e-10 * a.contact.approach)
            }).fold(0.0, f64::max);
            let load = exact.iter().zip(&found).skip(10).map(|(a, b)| {
                (a.contact.load / b.contact.load - 1.0).abs()
            }).fold(0.0, f64::max);
            println!(
                "{seed} {n} {ratio} {thickness} {is_free}: {} {} events, {releases} releases, {same} same, first {first:?}, {:.2} conv, {:?}, err {worst:.2} load {load:.1e} {:.1}s",
                exact.len(), found.len(),
                path.convolutions().unwrap_or(0) as f64 / found.len() as f64,
                (path.timings().windows, path.timings().taken_back, path.timings().ties), start.elapsed().as_secs_f64()
            );
            all += exact.len();
            left += releases;
        }
    }
    println!("{all} {left}");
}
