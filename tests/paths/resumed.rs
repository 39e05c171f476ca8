//! A path that was interrupted is the one that was not, in every bit of every column.

use crate::common::surface;
use crate::problems::{grid, rough};
use asperity::loading::{History, LoadingBuilder};
use asperity::record::LoadingRecord;
use asperity::surface::{Axis, HeightMap};
use asperity::updater::{ConjugateGradient, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boussinesq, ContactEvent, ContactRule, ContactTarget, Grid, InfluenceKernel, LoadingSolver,
    LoadingState, PeriodicBoussinesq, SemiPeriodicBoussinesq, Spectral,
};
use asperity_testing::surfaces::scattered;
use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The half-spaces of a grid: free, and both periodic ones.
fn half_spaces(grid: Grid) -> [(&'static str, Box<dyn InfluenceKernel>); 3] {
    [
        ("free", Box::new(Boussinesq::new(grid, 1e9).unwrap())),
        ("Love", Box::new(PeriodicBoussinesq::new(grid, 1e9).unwrap())),
        ("spectral", Box::new(Spectral::new(grid, 1e9).unwrap())),
    ]
}

pub(crate) fn whole<U: LinearUpdater>(builder: LoadingBuilder<'_, U>) -> Vec<LoadingState> {
    builder.build().unwrap().map(Result::unwrap).collect()
}

/// What a record of a path holds that is written and read again.
#[cfg(feature = "io")]
pub(crate) fn through_a_file(record: &LoadingRecord) -> LoadingRecord {
    use std::sync::atomic::{AtomicUsize, Ordering};
    static NEXT: AtomicUsize = AtomicUsize::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let file = format!("asperity-resumed-{}-{number}.npz", std::process::id());
    let file = std::env::temp_dir().join(file);
    record.write_npz(&file, &[]).unwrap();
    let read = LoadingRecord::read_npz(&file);
    std::fs::remove_file(&file).unwrap();
    read.unwrap()
}

#[cfg(not(feature = "io"))]
pub(crate) fn through_a_file(record: &LoadingRecord) -> LoadingRecord {
    record.clone()
}

/// What compares the states of two paths behind an interruption, from the first on.
pub(crate) type Same<'a> = &'a dyn Fn(usize, &[LoadingState], &[LoadingState]);

/// Every bit, and none is NaN.
pub(crate) fn identical(at: usize, found: &[LoadingState], expected: &[LoadingState]) {
    assert_eq!(found.len(), expected.len(), "{at}");
    for (found, expected) in found.iter().zip(expected) {
        assert!(found == expected, "{at}: {found:?} {expected:?}");
    }
}

/// Interrupts a path behind so many states, and the one that goes on from its record behind the next number of them,
/// and so on. What follows is compared with the path that was not interrupted.
pub(crate) fn interrupt<U: LinearUpdater + Clone>(
    builder: &LoadingBuilder<'_, U>,
    all: &[LoadingState],
    at: &[usize],
    same: Same<'_>,
) {
    let mut path = builder.clone().build().unwrap();
    let mut states: Vec<LoadingState> = Vec::new();
    for &at in at {
        let more = at - states.len();
        states.extend(path.by_ref().take(more).map(Result::unwrap));
        let record = LoadingRecord::new(&path, states.iter().copied().collect()).unwrap();
        // The path itself goes on as if nothing had been asked.
        let rest: Vec<_> = path.map(Result::unwrap).collect();
        same(at, &rest, &all[at..]);
        let read = through_a_file(&record);
        let resumed = builder.clone().resume(read.history()).unwrap();
        let rest: Vec<_> = resumed.map(Result::unwrap).collect();
        same(at, &rest, &all[at..]);
        path = builder.clone().resume(record.history()).unwrap();
        assert_eq!(path.state(), Some(states[at - 1]));
    }
}

/// Some numbers of states, in order.
pub(crate) fn steps(seed: u64, count: usize, range: std::ops::Range<usize>) -> Vec<usize> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut steps: Vec<usize> = (0..count).map(|_| random.random_range(range.clone())).collect();
    steps.sort_unstable();
    steps.dedup();
    steps
}

fn on_threads(threads: usize, work: impl FnOnce() + Send) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(work);
}

/// With a factor and a hardness, of all nodes and of each, to the yield of the last node: also where windows begin with
/// a solution of the factor before nodes yielded, on plateaus, and in windows that watch one node.
#[test]
fn with_a_factor_and_a_hardness() {
    with_a_hardness(&RecursiveCholesky::new());
}

/// The same without a factor: matrices, sums and loads beside nodes that have yielded are those of the windows before.
#[test]
fn without_a_factor_and_with_a_hardness() {
    with_a_hardness(&ConjugateGradient::new());
}

/// On small grids, behind every state: windows end with no elastic node in contact, or begin where the first node is about
/// to yield, and terraces yield together.
#[test]
fn behind_every_state_of_small_grids_with_a_hardness() {
    let rough = |seed: u64, nx: usize, ny: usize| {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        DMatrix::from_fn(nx, ny, |_, _| random.random_range(-1e-6..1e-6))
    };
    let terraces = rough(7, 8, 8).map(|height| if height > 0.0 { 1e-6 } else { 0.0 });
    // In the end of a window all of it has yielded.
    let soft = 1e-9 * scattered((7, 5), 1009, 2);
    for (heights, hardness) in [
        (rough(1, 6, 6), 1e8),
        (rough(4, 5, 8), 6e9),
        (rough(2, 7, 1), 2e9),
        (soft, 1e6),
        (terraces, 1e9),
    ] {
        let (nx, ny) = heights.shape();
        let grid = Grid::new(nx, ny, 1e-5, 1e-5).unwrap();
        let heights = HeightMap::new(heights).unwrap();
        for (_, kernel) in half_spaces(grid) {
            let builder = || LoadingSolver::builder(&heights, &*kernel).hardness(hardness);
            let exact = builder().updater(RecursiveCholesky::new());
            let all = whole(exact.clone());
            let at: Vec<usize> = (1..all.len()).collect();
            interrupt(&exact, &all, &at, &identical);
            let iterative = builder().updater(ConjugateGradient::new());
            let all = whole(iterative.clone());
            let at: Vec<usize> = (1..all.len()).collect();
            interrupt(&iterative, &all, &at, &identical);
            // A factor goes on behind each of these states too, to the same end.
            let full = all.last().unwrap().contact.load;
            for at in at {
                let before: History = all[..at].iter().copied().collect();
                let resumed = exact.clone().resume(&before).unwrap();
                let last = resumed.map(Result::unwrap).last().unwrap();
                assert!((last.contact.load / full - 1.0).abs() < 1e-6, "{at}: {last:?}");
            }
        }
    }
}

/// What the sums at the end of a window lack, where all nodes but a few are plastic, a record may have.
#[test]
fn records_hold_paths_that_are_estimated_to_their_plastic_end() {
    let rows = [[0, 0, 0, 0, 1], [1, 1, 1, 1, 1], [0, 0, 0, 1, 0]];
    let heights = DMatrix::from_fn(5, 3, |ix, iy| 1e-6 * f64::from(rows[iy][ix]));
    let heights = HeightMap::new(heights).unwrap();
    let grid = Grid::new(5, 3, 1e-5, 1e-5).unwrap();
    let kernel = SemiPeriodicBoussinesq::new(grid, 1e11, Axis::X).unwrap();
    for hardness in [1e10, 1.3e10, 1.319e10] {
        let builder = LoadingSolver::builder(&heights, &kernel).hardness(hardness);
        let mut path = builder.updater(ConjugateGradient::new()).build().unwrap();
        let states: History = path.by_ref().map(Result::unwrap).collect();
        let record = LoadingRecord::new(&path, states).unwrap();
        assert_eq!(through_a_file(&record).states(), record.states());
    }
}

fn with_a_hardness<U: LinearUpdater + Clone>(updater: &U) {
    let heights = rough(&grid(), 5);
    for (k, (name, kernel)) in half_spaces(grid()).into_iter().enumerate() {
        let builder = || LoadingSolver::builder(&heights, &*kernel).updater(updater.clone());
        let full = whole(builder()).last().unwrap().contact;
        let hardness = 0.4 * full.load / (full.contact_area / full.contact_area_fraction);
        let (nx, ny) = grid().shape();
        let map = DMatrix::from_fn(nx, ny, |ix, iy| match (ix + 3 * iy) % 7 {
            0 => f64::INFINITY,
            k => hardness * (0.5 + 0.2 * k as f64),
        });
        for builder in [
            builder().hardness(hardness),
            builder().hardness(hardness).window_size(1),
            builder().hardness_map(&map),
        ] {
            let all = whole(builder.clone());
            let yields = all.iter().filter(|state| state.event == ContactEvent::Yield).count();
            println!("{name}: {} states, {yields} yields", all.len());
            assert!(2 * yields > all.len() - yields);
            interrupt(&builder, &all, &steps(70 + k as u64, 6, 1..all.len()), &identical);
        }
    }
}

/// Without a factor from the start, to full contact, with both rules and with windows of any size.
#[test]
fn without_a_factor() {
    let heights = rough(&grid(), 5);
    for (k, (name, kernel)) in half_spaces(grid()).into_iter().enumerate() {
        for (rule, window) in [
            (ContactRule::FirstContact, None),
            (ContactRule::FirstContact, Some(9)),
            (ContactRule::ApproximateOrder, None),
        ] {
            let mut builder = LoadingSolver::builder(&heights, &*kernel)
                .updater(ConjugateGradient::new())
                .rule(rule);
            if let Some(window) = window {
                builder = builder.window_size(window);
            }
            let all = whole(builder.clone());
            println!("{name}, {rule:?}: {} states", all.len());
            let mut at = steps(k as u64, 12, 1..all.len());
            at.insert(0, 1);
            at.dedup();
            interrupt(&builder, &all, &at, &identical);
        }
    }
}

/// The same on a grid with a coarse space, whose matrix is of an earlier contact, on one thread and on two.
#[test]
fn on_a_grid_with_a_coarse_space() {
    let heights = surface("selfaffine_128");
    for which in [0, 1] {
        let mut all = Vec::new();
        for threads in [1, 2] {
            let (heights, all) = (&heights, &mut all);
            on_threads(threads, move || {
                let (name, kernel) = &half_spaces(Grid::square(128, 1e-2).unwrap())[which];
                let builder = LoadingSolver::builder(heights, &**kernel)
                    .updater(ConjugateGradient::new())
                    .max_area_fraction(0.06);
                if all.is_empty() {
                    *all = whole(builder.clone());
                    println!("{name}: {} states", all.len());
                    assert!(all.len() > 900);
                }
                let at = steps(10 + threads as u64, 3, 350..all.len());
                interrupt(&builder, all, &at, &identical);
            });
        }
    }
}

/// With a factor, on both sides of the place where it is given up, and with one that stays.
#[test]
fn across_the_seam() {
    let heights = surface("selfaffine_48");
    for (k, (name, kernel)) in half_spaces(Grid::square(48, 1e-2).unwrap()).into_iter().enumerate()
    {
        let fixed = LoadingSolver::new(&heights, &*kernel).unwrap().bytes();
        let builder = LoadingSolver::builder(&heights, &*kernel).max_nodes(800);
        let handing_over = builder.clone().updater(Handover::new());
        let handing_over = handing_over.memory_budget(fixed + 2_000_000);
        let mut path = handing_over.clone().build().unwrap();
        let all: Vec<_> = path.by_ref().map(Result::unwrap).collect();
        let seam = path.handed_over_at().unwrap();
        println!("{name}: {} states, seam at {seam}", all.len());
        assert!(seam > 100 && seam + 200 < all.len());
        let mut at = steps(20 + k as u64, 4, seam + 1..all.len());
        at.splice(0..0, [1, seam - 1, seam]);
        at.splice(1..1, steps(30 + k as u64, 4, 2..seam - 1));
        interrupt(&handing_over, &all, &at, &identical);

        let with_a_factor = builder.updater(RecursiveCholesky::new());
        let all = whole(with_a_factor.clone());
        let at = steps(40 + k as u64, 6, 1..all.len());
        on_threads(1, || {
            let kernel = &half_spaces(Grid::square(48, 1e-2).unwrap())[k].1;
            let builder = LoadingSolver::builder(&heights, &**kernel)
                .max_nodes(800)
                .updater(RecursiveCholesky::new());
            interrupt(&builder, &all, &at, &identical);
        });
        interrupt(&with_a_factor, &all, &at, &identical);
    }
}

/// A path that ended at a target and goes on to a further one is the path to that one.
#[test]
fn beyond_a_target() {
    let heights = rough(&grid(), 7);
    for (name, kernel) in half_spaces(grid()) {
        let builder =
            || LoadingSolver::builder(&heights, &*kernel).updater(ConjugateGradient::new());
        let all = whole(builder());
        let load = 0.5 * (all[120].contact.load + all[121].contact.load);
        let fraction = all[140].contact.contact_area_fraction;
        for (target, events) in
            [(ContactTarget::Load(load), 121), (ContactTarget::AreaFraction(fraction), 141)]
        {
            let mut path = builder().until(target).build().unwrap();
            let history = path.run().unwrap();
            assert_eq!(history.events(), &all[..events], "{name} {target:?}");
            let record = through_a_file(&LoadingRecord::new(&path, history).unwrap());
            let (history, end) =
                record.history().ending_at(&grid(), &[ContactTarget::AreaFraction(1.0)]).unwrap();
            assert_eq!(end, None);
            let resumed = builder().resume(&history).unwrap();
            identical(events, &resumed.map(Result::unwrap).collect::<Vec<_>>(), &all[events..]);
            path.continue_to(ContactTarget::AreaFraction(1.0)).unwrap();
            identical(events, &path.map(Result::unwrap).collect::<Vec<_>>(), &all[events..]);
        }
    }
}

/// What cannot go on so goes on from the states: with a factor, with another tolerance or rule.
#[test]
fn otherwise_than_it_was() {
    let heights: HeightMap = rough(&grid(), 8);
    let [(_, kernel), ..] = half_spaces(grid());
    let builder = || LoadingSolver::builder(&heights, &*kernel);
    let all = whole(builder().updater(RecursiveCholesky::new()));
    let record = |mut path: LoadingSolver<ConjugateGradient>| {
        let history: History = path.by_ref().take(100).collect::<Result<_, _>>().unwrap();
        LoadingRecord::new(&path, history).unwrap()
    };
    let exact = record(builder().updater(ConjugateGradient::new()).build().unwrap());
    let nodes = |states: Vec<LoadingState>| states.iter().map(|s| s.node).collect::<Vec<_>>();
    let expected = nodes(all[100..].to_vec());
    let history = exact.history();
    let resumed = builder().updater(RecursiveCholesky::new()).resume(history).unwrap();
    assert_eq!(nodes(resumed.map(Result::unwrap).collect()), expected);
    let other = ConjugateGradient::with_tolerance(1e-11).unwrap();
    let resumed = builder().updater(other).resume(history).unwrap();
    assert_eq!(nodes(resumed.map(Result::unwrap).collect()), expected);
    let approximate = builder().updater(ConjugateGradient::new());
    let approximate = approximate.rule(ContactRule::ApproximateOrder);
    assert_eq!(approximate.resume(history).unwrap().count(), expected.len());
    // The default takes over the iterations that the path went on with.
    let resumed = builder().resume(history).unwrap();
    assert_eq!((resumed.handed_over_at(), resumed.updater().is_none()), (None, true));
    assert_eq!(nodes(resumed.map(Result::unwrap).collect()), expected);
}
