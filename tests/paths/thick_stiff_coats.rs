//! Stiff coats about as thick as the grid is long: waves longer than the grid feel what lies below, and nodes leave.

use asperity::kernel::{Base, Layer, Layered, LayeredBody, check};
use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity::updater::{ConjugateGradient, Handover, LinearUpdater};
use asperity::{ContactEvent, ContactGrowth, Grid, InfluenceKernel, LoadingSolver, LoadingState};
use asperity_testing::dense::{influence_matrix, initial_gap};
use nalgebra::{DMatrix, DVector};

use crate::common::surface;

/// A coat on an n × n grid of side 1.
fn coated(n: usize, [ratio, thickness]: [f64; 2], is_free: bool) -> Layered {
    let grid = Grid::square(n, 1.0).unwrap();
    let coat = Layer { youngs_modulus: ratio, poissons_ratio: 0.3, thickness };
    let body =
        LayeredBody::new(&[coat], Base::HalfSpace { youngs_modulus: 1.0, poissons_ratio: 0.3 })
            .unwrap();
    if is_free { Layered::free(grid, body) } else { Layered::periodic(grid, body) }.unwrap()
}

fn followed<U: LinearUpdater>(
    heights: &HeightMap,
    kernel: &Layered,
    updater: U,
    fraction: f64,
) -> Vec<LoadingState> {
    let path = LoadingSolver::builder(heights, kernel).updater(updater);
    path.max_area_fraction(fraction).build().unwrap().map(Result::unwrap).collect()
}

/// At the load half way to the next event the contact behind each event solves the contact problem: no node of it is
/// pulled, and no other overlaps. There is no other solution, for the matrix is positive definite. Events closer than
/// their estimates are not told apart. Returns the releases.
fn solves_the_contact_problem(
    (matrix, area): (&DMatrix<f64>, f64),
    heights: &HeightMap,
    states: &[LoadingState],
    case: &str,
) -> usize {
    let gaps = initial_gap(heights.matrix());
    let mut contact: Vec<usize> = Vec::new();
    let nx = heights.matrix().nrows();
    let (mut releases, mut told) = (0, 0);
    let (scale, area) = (matrix[(0, 0)], area);
    for pair in states.windows(2) {
        let [state, next] = [pair[0], pair[1]];
        let node = state.node.0 + nx * state.node.1;
        match state.event {
            ContactEvent::Touch => contact.push(node),
            _ => {
                releases += 1;
                contact.retain(|other| *other != node);
            }
        }
        assert_eq!(contact.len(), state.contact.contact_nodes, "{case}");
        let [begin, end] = [state, next].map(|state| state.contact);
        // What the loads may be off by: approaches times the stiffness, and some 10⁻⁵ behind an estimate.
        let width = end.load - begin.load;
        let stiffness = width / (end.approach - begin.approach);
        let error = state.approach_error + next.approach_error;
        let error =
            stiffness * error + 1e-9 * end.load + if error > 0.0 { 1e-5 * end.load } else { 0.0 };
        if width < 4.0 * error || stiffness.is_nan() {
            continue;
        }
        told += 1;
        let load = 0.5 * (begin.load + end.load);
        // C p − δ = −g, and Σ p A = W.
        let count = contact.len();
        let bordered =
            DMatrix::from_fn(count + 1, count + 1, |i, j| match (i < count, j < count) {
                (true, true) => matrix[(contact[i], contact[j])],
                (false, false) => 0.0,
                _ => -scale,
            });
        let rhs = contact.iter().map(|&node| -gaps[node]).chain([-scale * load / area]);
        let solved = bordered.lu().solve(&DVector::from_iterator(count + 1, rhs)).unwrap();
        let mut pressure = DVector::zeros(gaps.len());
        for (&node, value) in contact.iter().zip(&solved) {
            pressure[node] = *value;
        }
        let own = pressure.sum() * area;
        assert!((own / load - 1.0).abs() < 1e-8, "{case}: {own} {load}");
        let approach = scale * solved[count];
        let gap = matrix * &pressure + DVector::from_row_slice(&gaps);
        let gap = gap.add_scalar(-approach);
        // Condition numbers of some 10⁵ of sixteen digits.
        let rounding = 1e-10 * (approach.abs() + heights.matrix().amax());
        let least = pressure.min() * matrix[(0, 0)];
        assert!(least > -rounding, "{case}: pressure {least:e} {state:?}");
        assert!(gap.min() > -rounding, "{case}: gap {:e} {state:?}", gap.min());
    }
    assert!(2 * told > states.len(), "{case}: {told} of {}", states.len());
    releases
}

#[test]
fn paths_solve_the_contact_problem_at_every_event() {
    let (mut releases, mut events) = (0, 0);
    let mut promised = [0; 2];
    for n in [12_usize, 22] {
        for ratio in [3.0, 30.0, 300.0, 1000.0] {
            for thickness in [0.2, 0.4, 0.7, 1.0, 3.0] {
                for is_free in [true, false] {
                    let kernel = coated(n, [ratio, thickness], is_free);
                    promised[usize::from(kernel.contact_growth() > ContactGrowth::Unknown)] += 1;
                    check(&kernel).unwrap();
                    let matrix = influence_matrix(&kernel);
                    for seed in 1..=if n == 12 { 2 } else { 1 } {
                        let amplitude = Amplitude::RmsHeight(1e-2);
                        let shortest = [2.0, 4.0][seed as usize % 2] / n as f64;
                        let rough = SelfAffine::new(0.8, 0.5, shortest, amplitude, seed).unwrap();
                        let heights = HeightMap::sample(&rough, &kernel.grid()).unwrap();
                        let case = format!("{n} {ratio} {thickness} {is_free} {seed}");
                        let found = followed(&heights, &kernel, ConjugateGradient::new(), 0.5);
                        let exact = followed(&heights, &kernel, Handover::new(), 0.5);
                        for (name, states) in [("iterative", &found), ("factor", &exact)] {
                            let case = format!("{case} {name}");
                            let of = (&matrix, kernel.grid().cell_area());
                            releases += solves_the_contact_problem(of, &heights, states, &case);
                        }
                        events += found.len() + exact.len();
                    }
                }
            }
        }
    }
    println!("{events} events, {releases} releases, {promised:?}");
    assert!(releases > 100 && promised[1] > 20, "{releases} {promised:?}");
}

/// 32 × 32 nodes on glass of 0.7 sides on rubber: it had 307 events and no release without a factor, and broke off with
/// one.
#[test]
fn glass_on_rubber() {
    let grid = Grid::square(32, 1e-3).unwrap();
    let glass = Layer { youngs_modulus: 70e9, poissons_ratio: 0.22, thickness: 7e-4 };
    let rubber = Base::HalfSpace { youngs_modulus: 2e6, poissons_ratio: 0.5 };
    let body = LayeredBody::new(&[glass], rubber).unwrap();
    let kernel = Layered::free(grid, body).unwrap();
    assert_eq!(kernel.contact_growth(), ContactGrowth::Unknown);
    check(&kernel).unwrap();
    let heights = surface("coat32");
    let found = followed(&heights, &kernel, ConjugateGradient::new(), 0.3);
    let exact = followed(&heights, &kernel, Handover::new(), 0.3);
    let events = |states: &[LoadingState]| -> Vec<_> {
        states.iter().map(|state| (state.event, state.node)).collect()
    };
    assert!(events(&found) == events(&exact));
    let releases = exact.iter().filter(|state| state.event == ContactEvent::Release).count();
    println!("{} events, {releases} releases", exact.len());
    let matrix = influence_matrix(&kernel);
    for (name, states) in [("iterative", &found), ("factor", &exact)] {
        let matrix = (&matrix, grid.cell_area());
        assert_eq!(solves_the_contact_problem(matrix, &heights, states, name), releases);
    }
    assert_eq!(exact.len(), 366);
}

/// A body that loses pressure, which promises what it does not keep.
struct Promising {
    body: Layered,
    growth: ContactGrowth,
}

impl InfluenceKernel for Promising {
    fn grid(&self) -> Grid {
        self.body.grid()
    }
    fn boundary(&self) -> asperity::Boundary {
        self.body.boundary()
    }
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        self.body.coefficient(di, dj)
    }
    fn contact_growth(&self) -> ContactGrowth {
        self.growth
    }
}

/// Whatever a kernel promises, no window ends in tension: every state up to the error is one without, and the error
/// names the node.
#[test]
fn no_window_ends_in_tension() {
    use asperity::updater::RecursiveCholesky;
    fn ends<U: LinearUpdater>(
        heights: &HeightMap,
        kernel: &Promising,
        updater: U,
        hardness: Option<f64>,
    ) -> bool {
        let mut builder = LoadingSolver::builder(heights, kernel).updater(updater);
        if let Some(hardness) = hardness {
            builder = builder.hardness(hardness);
        }
        let mut path = builder.max_area_fraction(0.5).build().unwrap();
        let mut broken = false;
        while let Some(state) = path.next() {
            let Ok(state) = state else {
                let error = state.unwrap_err();
                assert!(matches!(error, asperity::Error::NotMonotone { .. }), "{error}");
                broken = true;
                continue;
            };
            // The last state of a window, which lies before its end: what an estimate of its approach leaves of
            // pressures, as a path that is resumed allows, and rounding of heights.
            if path.waiting() > 0 {
                continue;
            }
            let pressure = path.fields_at(&state).unwrap().pressure;
            let rounding = 1e-9 * heights.matrix().amax() / kernel.coefficient(0, 0);
            let least = pressure.min();
            assert!(least >= -1e-4 * pressure.max() - rounding, "{least:e}: {state:?}");
        }
        broken
    }
    let heights = surface("coat32");
    let glass = Layer { youngs_modulus: 70e9, poissons_ratio: 0.22, thickness: 7e-4 };
    let rubber = Base::HalfSpace { youngs_modulus: 2e6, poissons_ratio: 0.5 };
    let body = LayeredBody::new(&[glass], rubber).unwrap();
    let body = Layered::free(Grid::square(32, 1e-3).unwrap(), body).unwrap();
    for growth in [ContactGrowth::Monotone, ContactGrowth::Convex] {
        let kernel = Promising { body: body.clone(), growth };
        // Some hundred times the mean pressure: few nodes yield.
        for hardness in [None, Some(1e12)] {
            assert!(ends(&heights, &kernel, RecursiveCholesky::new(), hardness), "{growth:?}");
            assert!(ends(&heights, &kernel, ConjugateGradient::new(), hardness), "{growth:?}");
        }
    }
}

/// Three nodes in a row that press the one in the middle out, slowly: with 1, 3/4 and 1/2 − 3/20000 their rates are
/// 2/3, −4·10⁻⁴ and 2/3 of what one would have alone. No other node feels another one.
struct Row(Grid);

impl InfluenceKernel for Row {
    fn grid(&self) -> Grid {
        self.0
    }
    fn boundary(&self) -> asperity::Boundary {
        asperity::Boundary::Free
    }
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        match (di.abs(), dj) {
            (0, 0) => 1.0,
            (1, 0) => 0.75,
            (2, 0) => 0.49985,
            _ => 0.0,
        }
    }
    fn contact_growth(&self) -> ContactGrowth {
        ContactGrowth::Convex
    }
}

/// Where more nodes touch together than can be watched, the end is looked at as that of a window is. On the way there
/// the rate of the middle one is within what rates may be off, and its tension is not.
#[test]
fn no_plateau_ends_in_tension() {
    let grid = Grid::new(32, 40, 1.0, 1.0).unwrap();
    let heights = nalgebra::DMatrix::from_fn(32, 40, |ix, iy| match (ix, iy) {
        (0..=2, 0) => 0.0,
        (10.., 1..) if ix % 3 == 1 => -1.0,
        _ => -1e3,
    });
    let heights = HeightMap::new(heights).unwrap();
    let kernel = Row(grid);
    let builder = LoadingSolver::builder(&heights, &kernel).updater(ConjugateGradient::new());
    let mut path = builder.hardness(10.0).max_nodes(200).build().unwrap();
    let states: Vec<_> = path.by_ref().take(3).map(Result::unwrap).collect();
    assert_eq!(states[2].contact.approach, 0.0);
    let error = path.next().unwrap().unwrap_err();
    assert!(
        matches!(error, asperity::Error::NotMonotone { quantity: "pressure", ix: 1, iy: 0, value, .. }
            if (value + 4e-4).abs() < 1e-5),
        "{error}"
    );
    assert!(path.next().is_none());
}
