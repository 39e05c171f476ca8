//! Leaks of the states of paths.

use asperity::leak::Seal;
use asperity::loading::History;
use asperity::patches::{Connectivity, Percolation};
use asperity::surface::Axis;
use asperity::{
    Boussinesq, ContactTarget, Error, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq,
    SelfAffine,
};

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
        for (axis, closing) in [(Axis::X, found.leak_x), (Axis::Y, found.leak_y)] {
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
                        Axis::X => found.leak_x,
                        Axis::Y => found.leak_y,
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
