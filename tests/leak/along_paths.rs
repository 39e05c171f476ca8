//! Leaks of the states of paths.

use asperity::kernel::{Base, Layer, LayeredBody};
use asperity::leak::Seal;
use asperity::loading::History;
use asperity::patches::{Connectivity, Percolation};
use asperity::surface::{Axis, HeightMap};
use asperity::updater::ConjugateGradient;
use asperity::{
    Boussinesq, ContactEvent, ContactTarget, Error, Grid, InfluenceKernel, Layered, LoadingSolver,
    PeriodicBoussinesq, SelfAffine, Spectral,
};
use nalgebra::DMatrix;

fn path(half_space: &dyn InfluenceKernel, area: f64) -> (LoadingSolver, History) {
    let surface = SelfAffine::zhang2020(1);
    let builder = LoadingSolver::builder(&surface, half_space).max_area_fraction(area);
    let mut path = builder.build().unwrap();
    let history = path.by_ref().collect::<Result<_, Error>>().unwrap();
    (path, history)
}

fn grid() -> Grid {
    Grid::square(32, 1.25e-3).unwrap()
}

/// The leak rate falls with every state, ends at the state at which `patches` finds no channel any more, and not
/// before; the curve has as many points as were asked for, and no two of them are far apart.
#[test]
fn leaks_end_where_the_last_channel_closes() {
    let free = Boussinesq::new(grid(), 115e9).unwrap();
    let periodic = PeriodicBoussinesq::new(grid(), 115e9).unwrap();
    let kernels: [&dyn InfluenceKernel; 2] = [&free, &periodic];
    for kernel in kernels {
        let (mut path, history) = path(kernel, 1.0);
        let contact = history.contact_sequence(grid()).unwrap();
        let found = Percolation::of(&contact, kernel.boundary(), Connectivity::Eight);
        for (axis, closing) in [(Axis::X, found.seal_x), (Axis::Y, found.seal_y)] {
            let seal = Seal::new(1e-3, 1e5, axis).unwrap();
            let closing = history.states()[closing.unwrap() - 1];
            let curve = seal.curve(&mut path, &history, 40).unwrap();
            assert_eq!(curve.closing, Some(closing));
            assert_eq!(curve.points.len(), 40);
            for pair in curve.points.windows(2) {
                let [before, after] = pair else { continue };
                assert!(before.state.step < after.state.step);
                assert!(before.leak_rate > after.leak_rate);
                let narrower = after.constriction.map_or(0.0, |narrowest| narrowest.gap);
                assert!(before.constriction.unwrap().gap >= narrower);
                assert!(after.imbalance <= 1e-11);
            }
            let [.., last_open, last] = &curve.points[..] else { panic!("no points") };
            assert_eq!((last.state, last.leak_rate), (closing, 0.0));
            assert_eq!(last_open.state.step + 1, closing.step);
            assert!(last_open.leak_rate > 0.0 && last.constriction.is_none());
            // The first is that of surfaces that just touch.
            assert_eq!(curve.points[0].state.contact.load, 0.0);
        }
    }
}

/// A path that does not seal has no closing, and ends with a leak.
#[test]
fn a_path_that_does_not_seal() {
    let half_space = PeriodicBoussinesq::new(grid(), 115e9).unwrap();
    let (mut path, history) = path(&half_space, 0.1);
    let seal = Seal::new(1e-3, 1e5, Axis::X).unwrap();
    let curve = seal.curve(&mut path, &history, 5).unwrap();
    assert_eq!((curve.closing, curve.points.len()), (None, 5));
    let last = curve.points.last().unwrap();
    assert_eq!(Some(&last.state), history.states().last());
    assert!(last.leak_rate > 0.0);
    // More points than there are states are all of them.
    let all = seal.curve(&mut path, &history, 10_000).unwrap();
    assert_eq!(all.points.len(), history.states().len());
    for states in [0, 1] {
        assert!(matches!(seal.curve(&mut path, &history, states), Err(Error::OutOfRange { .. })));
    }
    let none = seal.curve(&mut path, &History::default(), 5).unwrap();
    assert!(none.points.is_empty() && none.closing.is_none());
}

/// Between two events, and from a record: the same leak as on the path.
#[test]
fn leaks_of_any_state() {
    let half_space = Boussinesq::new(grid(), 115e9).unwrap();
    let (mut path, history) = path(&half_space, 0.3);
    let seal = Seal::new(1e-3, 1e5, Axis::Y).unwrap();
    let states = history.states();
    let load = 0.5 * (states[100].contact.load + states[101].contact.load);
    let between = history.at(ContactTarget::Load(load)).unwrap();
    let leak = seal.leak_at(&mut path, &between).unwrap();
    let around = [100, 101].map(|k| seal.leak_at(&mut path, &states[k]).unwrap().leak_rate);
    assert!(around[0] > leak.leak_rate && leak.leak_rate > around[1]);
    let record = asperity::record::LoadingRecord::new(&path, history.clone()).unwrap();
    let again = seal.leak_at(&mut record.replay().unwrap(), &between).unwrap();
    // Gaps of iterations are right to 10⁻¹⁰ of the approach or so, and rates go with their cubes.
    assert!((again.leak_rate / leak.leak_rate - 1.0).abs() < 1e-7);
    let mut beyond = between;
    beyond.step = states.len() + 1;
    assert!(matches!(seal.leak_at(&mut path, &beyond), Err(Error::StateNotReached { .. })));
}

/// Whether fluid gets from one end of an axis to the other through sides of cells, by a flood of one map: it shares
/// nothing with the library. Across the flow it may pass the border of a periodic grid.
fn leads_through(is_open: &[bool], (nx, ny): (usize, usize), along: Axis, wraps: bool) -> bool {
    let at = |a: usize, c: usize| match along {
        Axis::X => a + nx * c,
        Axis::Y => c + nx * a,
    };
    let (length, width) = if along == Axis::X { (nx, ny) } else { (ny, nx) };
    let mut is_wet = vec![false; nx * ny];
    let mut wet: Vec<(usize, usize)> = (0..width).map(|c| (0, c)).collect();
    wet.retain(|&(a, c)| is_open[at(a, c)]);
    wet.iter().for_each(|&(a, c)| is_wet[at(a, c)] = true);
    while let Some((a, c)) = wet.pop() {
        if a + 1 == length {
            return true;
        }
        let mut beside = vec![(a + 1, c)];
        beside.extend(a.checked_sub(1).map(|a| (a, c)));
        let (left, right) = ((c + width - 1) % width, (c + 1) % width);
        if wraps || c > 0 {
            beside.push((a, left));
        }
        if wraps || c + 1 < width {
            beside.push((a, right));
        }
        for (a, c) in beside {
            if is_open[at(a, c)] && !is_wet[at(a, c)] {
                is_wet[at(a, c)] = true;
                wet.push((a, c));
            }
        }
    }
    false
}

/// The gap seals at the state at which a flood of each contact map says so, on every boundary; the curve closes there,
/// and a percolation with patches of either kind says the same. Around a periodic grid the last channel closes sooner
/// on two of these surfaces.
#[test]
fn the_gap_seals_when_a_flood_of_each_state_says_so() {
    let grid = Grid::square(64, 1.25e-3).unwrap();
    let mut sooner = 0;
    for seed in 1..=4 {
        for periodic in [true, false] {
            let surface = SelfAffine::zhang2020(seed);
            let half_space: Box<dyn InfluenceKernel> = if periodic {
                Box::new(PeriodicBoussinesq::new(grid, 115e9).unwrap())
            } else {
                Box::new(Boussinesq::new(grid, 115e9).unwrap())
            };
            let builder = LoadingSolver::builder(&surface, &*half_space).max_area_fraction(0.6);
            let mut path = builder.build().unwrap();
            let history: History = path.by_ref().collect::<Result<_, Error>>().unwrap();
            let contact = history.contact_sequence(grid).unwrap();
            for along in [Axis::X, Axis::Y] {
                let mut is_open = vec![true; grid.nodes()];
                let closes = |&node: &usize| {
                    is_open[node] = false;
                    !leads_through(&is_open, grid.shape(), along, periodic)
                };
                let expected = contact.order().iter().position(closes).map(|place| place + 1);
                assert!(expected.is_some(), "seed {seed}: the path is too short");
                for connectivity in [Connectivity::Four, Connectivity::Eight] {
                    let of = |found: Percolation| match along {
                        Axis::X => found.seal_x,
                        Axis::Y => found.seal_y,
                    };
                    let boundary = half_space.boundary();
                    let ends = of(Percolation::of(&contact, boundary, connectivity));
                    assert_eq!(ends, expected, "seed {seed}, periodic {periodic}, {along:?}");
                    let around = of(Percolation::winding(&contact, boundary, connectivity));
                    assert!(around <= ends && (periodic || around == ends));
                    sooner += usize::from(along == Axis::X && around < ends);
                }
                let seal = Seal::new(1e-3, 1e5, along).unwrap();
                let curve = seal.curve(&mut path, &history, 3).unwrap();
                assert_eq!(curve.closing.map(|state| state.contact.contact_nodes), expected);
            }
        }
    }
    assert!(sooner >= 2, "the two questions are the same on these surfaces");
}

/// Waves along one axis and random ridges: the nodes of a ridge or of a valley touch together, and what rounding leaves
/// of their gaps is of either sign. The first ridge seals across at once, and along the ridges nothing leaks from the
/// state on at which the first node of the last valleys touches. Two waves across, with a gap that counts as closed.
#[test]
fn nodes_that_touch_together_close_at_once() {
    let height = 1e-5;
    let wave =
        |n: usize, ix: usize| height * (std::f64::consts::TAU * (ix as f64 + 0.5) / n as f64).cos();
    let mut random = 7_u64;
    let ridges = [(); 16].map(|()| {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        height * (random >> 11) as f64 / (1_u64 << 53) as f64
    });
    let profiles = [8, 16].map(|n| (0..n).map(|ix| wave(n, ix)).collect()).into_iter();
    for profile in profiles.chain([ridges.to_vec()]) {
        let n = profile.len();
        let grid = Grid::square(n, 1e-3 / n as f64).unwrap();
        let kernels: [Box<dyn InfluenceKernel>; 2] = [
            Box::new(PeriodicBoussinesq::new(grid, 1e9).unwrap()),
            Box::new(Spectral::new(grid, 1e9).unwrap()),
        ];
        for kernel in kernels {
            let surface = HeightMap::new(DMatrix::from_fn(n, n, |ix, _| profile[ix])).unwrap();
            let mut path = LoadingSolver::builder(&surface, &*kernel).build().unwrap();
            let history = path.run().unwrap();
            let states = history.states();
            // Heights of a wave are the same to some units in the last place.
            let deepest = profile[states[states.len() - 1].node.0];
            let valleys = profile.iter().filter(|h| (*h - deepest).abs() < 1e-12 * height).count();
            for (axis, first) in [(Axis::X, 1), (Axis::Y, states.len() - valleys * n + 1)] {
                let seal = Seal::new(1e-3, 1e5, axis).unwrap();
                let curve = seal.curve(&mut path, &history, 30).unwrap();
                assert_eq!(curve.closing.map(|state| state.step), Some(first), "{axis:?}");
                let (last, others) = curve.points.split_last().unwrap();
                assert_eq!((last.state.step, last.leak_rate), (first, 0.0));
                assert!(others.iter().all(|point| point.leak_rate > 0.0));
                // The same gaps leak as much to twice what may be lost.
                let falls = |a: f64, b: f64| b <= a * (1.0 + 2.1e-11);
                assert!(curve.points.is_sorted_by(|a, b| falls(a.leak_rate, b.leak_rate)));
                for state in states {
                    let leak = seal.leak_at(&mut path, state).unwrap();
                    assert_eq!(leak.is_closed(), state.step >= first, "{axis:?} {}", state.step);
                }
            }
        }
    }
    let grid = Grid::square(8, 1.25e-4).unwrap();
    let kernel = Spectral::new(grid, 1e9).unwrap();
    let heights = DMatrix::from_fn(8, 8, |ix, iy| wave(8, ix) + wave(8, iy));
    let surface = HeightMap::new(heights).unwrap();
    let mut path = LoadingSolver::builder(&surface, &kernel).build().unwrap();
    let history = path.run().unwrap();
    for axis in [Axis::X, Axis::Y] {
        let seal = Seal::new(1e-3, 1e5, axis).unwrap();
        let limited = seal.with_least_gap(1e-6).unwrap();
        for state in history.states() {
            let [all, wide] =
                [&seal, &limited].map(|seal| seal.leak_at(&mut path, state).unwrap().leak_rate);
            assert!(wide <= all * (1.0 + 2.1e-11), "{}: {wide:e} {all:e}", state.step);
        }
        let closing = [&seal, &limited]
            .map(|seal| seal.curve(&mut path, &history, 20).unwrap().closing.unwrap().step);
        assert!(closing[1] <= closing[0]);
    }
}

/// On a stiff coat gaps may widen under load though no node leaves: a seal with a least gap closes where nothing leaks
/// from there on, and not where it is closed for a while.
#[test]
fn a_seal_on_a_coat_may_open_again() {
    let grid = Grid::square(4, 4e-5).unwrap();
    let (youngs_modulus, thickness) = (200e9, 5e-6);
    let base = Base::HalfSpace { youngs_modulus: 7.4e9, poissons_ratio: 0.3 };
    let body = LayeredBody::new(&[Layer { youngs_modulus, poissons_ratio: 0.3, thickness }], base)
        .unwrap();
    let kernel = Layered::free(grid, body).unwrap();
    // In nanometres, rows along x.
    let rows = [139, 1, 15, 935, 433, 183, 274, 762, 118, 348, 467, 126, 269, 586, 827, 23];
    let heights = DMatrix::from_fn(4, 4, |ix, iy| 1e-9 * f64::from(rows[ix + 4 * iy]));
    let surface = HeightMap::new(heights).unwrap();
    let builder = LoadingSolver::builder(&surface, &kernel);
    let mut path = builder.max_area_fraction(0.8).build().unwrap();
    let history = path.run().unwrap();
    assert!(history.states().iter().all(|state| state.event != ContactEvent::Release));
    let seal = Seal::new(1e-3, 1.0, Axis::X).unwrap().with_least_gap(2.459e-7).unwrap();
    let leaks: Vec<bool> = history
        .states()
        .iter()
        .map(|state| !seal.leak_at(&mut path, state).unwrap().is_closed())
        .collect();
    let opens_again = leaks.windows(2).any(|pair| !pair[0] && pair[1]);
    assert!(opens_again, "{leaks:?}");
    let curve = seal.curve(&mut path, &history, 20).unwrap();
    let last = leaks.iter().rposition(|leaks| *leaks).unwrap();
    assert_eq!(curve.closing.unwrap(), history.states()[last + 1]);
    let mut points = curve.points.iter().filter(|point| point.leak_rate > 0.0);
    assert_eq!(points.next_back().unwrap().state, history.states()[last]);
}

/// Without a factor the approach at which nodes touch together is an estimate, and they overlap by what it is off: no
/// state is refused, and the leaks are those of the exact path.
#[test]
fn nodes_that_touch_together_without_a_factor() {
    let grid = Grid::square(16, 6.25e-5).unwrap();
    let kernel = PeriodicBoussinesq::new(grid, 1e9).unwrap();
    let wave = |ix: usize| 1e-5 * (std::f64::consts::TAU * (ix as f64 + 0.5) / 16.0).cos();
    let surfaces = [
        DMatrix::from_fn(16, 16, |ix, _| wave(ix)),
        DMatrix::from_fn(16, 16, |ix, iy| wave(ix) + wave(iy)),
    ];
    let seal = Seal::new(1e-3, 1e5, Axis::Y).unwrap();
    for heights in surfaces {
        let surface = HeightMap::new(heights).unwrap();
        let builder = || LoadingSolver::builder(&surface, &kernel);
        let mut exact = builder().build().unwrap();
        let exact_history = exact.run().unwrap();
        let mut path = builder().updater(ConjugateGradient::new()).build().unwrap();
        let history = path.run().unwrap();
        let open = seal.leak_at(&mut exact, &exact_history.states()[0]).unwrap().leak_rate;
        assert!(history.states().iter().any(|state| state.approach_error > 0.0));
        assert_eq!(history.states().len(), exact_history.states().len());
        for (state, expected) in history.states().iter().zip(exact_history.states()) {
            let leak = seal.leak_at(&mut path, state).unwrap().leak_rate;
            let expected = seal.leak_at(&mut exact, expected).unwrap().leak_rate;
            // Gaps are off by 10⁻⁵ of the heights or so, and nodes that touch together come in any order.
            assert!((leak - expected).abs() < 1e-4 * open, "{}: {leak:e} {expected:e}", state.step);
        }
    }
}
