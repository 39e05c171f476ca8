//! Paths on bodies on which nodes may leave: windows until one does, with a factor and without, beside paths of single
//! events with a factor.

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::loading::History;
use asperity::surface::{Amplitude, SelfAffine};
use asperity::updater::{ConjugateGradient, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{
    ContactEvent, ContactGrowth, ContactTarget, Grid, InfluenceKernel, LoadingSolver, LoadingState,
};

/// A coat of E₁/E₂ and a thickness in cells, on cells of 1.
fn coated(n: usize, ratio: f64, thickness: f64, is_free: bool) -> Layered {
    let grid = Grid::square(n, n as f64).unwrap();
    let coat = Layer { youngs_modulus: ratio, poissons_ratio: 0.3, thickness };
    let body =
        LayeredBody::new(&[coat], Base::HalfSpace { youngs_modulus: 1.0, poissons_ratio: 0.3 })
            .unwrap();
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

/// One event at a time, each from a solution that is exact to rounding.
fn of_single_events(surface: &SelfAffine, kernel: &Layered, nodes: usize) -> Vec<LoadingState> {
    let builder = LoadingSolver::builder(surface, kernel).updater(RecursiveCholesky::new());
    let path = builder.window_size(1).max_nodes(nodes).build().unwrap();
    path.map(Result::unwrap).collect()
}

/// Nodes along a side, ratio of moduli, thickness and shortest wavelength in cells, and a seed.
const CASES: [([f64; 4], u64); 9] = [
    ([20.0, 10.0, 0.4, 2.0], 1),
    ([24.0, 10.0, 1.0, 2.0], 1),
    // Gaps that close and open again within a window.
    ([28.0, 30.0, 0.4, 3.0], 20),
    // Another node touches first if nothing is looked at between the ends of windows.
    ([28.0, 30.0, 0.4, 3.0], 6),
    ([32.0, 10.0, 1.0, 2.0], 6),
    // Nodes that touch between the ends of a window.
    ([32.0, 30.0, 1.0, 4.0], 20),
    // Gaps that are all but closed behind nodes that left.
    ([36.0, 10.0, 2.0, 6.0], 29),
    ([40.0, 100.0, 4.0, 3.0], 10),
    ([48.0, 10.0, 4.0, 4.0], 11),
];

/// A case on one of both half-spaces.
struct Case {
    name: String,
    surface: SelfAffine,
    kernel: Layered,
    nodes: usize,
    exact: Vec<LoadingState>,
}

impl Case {
    fn all() -> impl Iterator<Item = Self> {
        CASES.into_iter().flat_map(|case| [true, false].map(|is_free| Self::of(case, is_free)))
    }

    fn of(([n, ratio, thickness, shortest], seed): ([f64; 4], u64), is_free: bool) -> Self {
        let kernel = coated(n as usize, ratio, thickness, is_free);
        let amplitude = Amplitude::RmsHeight(1.0);
        let surface = SelfAffine::new(0.8, 0.5 * n, shortest, amplitude, seed).unwrap();
        let nodes = (0.9 * n * n) as usize;
        let exact = of_single_events(&surface, &kernel, nodes);
        let name = format!("{n} {ratio} {thickness} {shortest} {seed} {is_free}");
        Self { name, surface, kernel, nodes, exact }
    }

    /// The path of an updater, whose events have to be those of single events, and its states beside the exact ones.
    fn followed<U: LinearUpdater>(&self, updater: U) -> (LoadingSolver<U>, Vec<[LoadingState; 2]>) {
        let (path, found) = followed(&self.surface, &self.kernel, updater, self.nodes);
        assert_eq!(found.len(), self.exact.len(), "{}", self.name);
        let pairs = found.into_iter().zip(&self.exact).map(|(found, &exact)| [found, exact]);
        let pairs: Vec<[LoadingState; 2]> = pairs.collect();
        for pair in &pairs {
            let [found, exact] = pair.map(|s| (s.event, s.node, s.step, s.contact.contact_nodes));
            assert_eq!(found, exact, "{}", self.name);
        }
        (path, pairs)
    }

    fn releases(&self) -> usize {
        self.exact.iter().filter(|state| state.event == ContactEvent::Release).count()
    }
}

/// With a factor windows are what single events are, to rounding: sums over 2000 events of numbers that are right to some
/// 10⁻¹⁵ of the last.
#[test]
fn windows_with_a_factor_are_single_events() {
    let (mut releases, mut windows, mut events) = (0, 0, 0);
    for case in Case::all() {
        let (path, states) = case.followed(RecursiveCholesky::new());
        let [first, last] =
            [case.exact[0], case.exact[case.exact.len() - 1]].map(|state| state.contact);
        for [found, exact] in &states {
            let (a, b) = (found.contact, exact.contact);
            for (a, b, scale) in [
                (a.approach, b.approach, last.approach),
                (a.load, b.load, last.load),
                (a.energy, b.energy, last.energy),
                (a.mean_gap, b.mean_gap, first.mean_gap),
            ] {
                assert!((a - b).abs() <= 1e-11 * scale, "{}: {a:e} {b:e}: {found:?}", case.name);
            }
        }
        releases += case.releases();
        windows += path.timings().windows;
        events += states.len();
    }
    println!("{events} events, {releases} releases, {windows} windows");
    assert!(releases > 100, "{releases}");
    assert!(4 * windows < events, "{windows} {events}");
}

/// Windows have the events of single steps with a factor, each of which has a solution that is exact to rounding:
/// touches and releases, in the same order. Approaches are off by no more than states say, and loads by a part of some
/// 10⁻⁵, which is asked to be 10⁻⁴; at least behind the first few, whose loads are nearly nothing.
#[test]
fn windows_have_the_events_of_single_steps() {
    let (mut releases, mut events, mut convolutions) = (0, 0, 0);
    for case in Case::all() {
        let (path, states) = case.followed(ConjugateGradient::new());
        for [found, exact] in &states {
            let error = (found.contact.approach - exact.contact.approach).abs();
            let allowed = found.approach_error + 1e-10 * exact.contact.approach;
            assert!(error <= allowed, "{}: {error:e} of {allowed:e}: {found:?}", case.name);
            let error = (found.contact.load / exact.contact.load - 1.0).abs();
            assert!(found.step < 10 || error < 1e-4, "{}: {error:e}: {found:?}", case.name);
        }
        releases += case.releases();
        events += states.len();
        convolutions += path.convolutions().unwrap();
    }
    println!("{events} events, {releases} releases, {convolutions} convolutions");
    assert!(releases > 100, "{releases}");
    // Single steps take 15 convolutions each, as the first hundred events do here.
    assert!(convolutions < 3 * events, "{convolutions} {events}");
}

/// A path that hands over to iterations, here for want of memory, has the same events, and one that ends and goes on, or
/// is resumed from its states, as well.
#[test]
fn paths_hand_over_and_go_on() {
    let (n, nodes) = (80, 1200);
    let kernel = coated(n, 10.0, 1.0, true);
    let amplitude = Amplitude::RmsHeight(1.0);
    let surface = SelfAffine::new(0.8, 20.0, 4.0, amplitude, 3).unwrap();
    let exact = of_single_events(&surface, &kernel, nodes);
    let fixed = LoadingSolver::new(&surface, &kernel).unwrap().bytes();
    let builder = LoadingSolver::builder(&surface, &kernel).updater(Handover::new());
    // Ten blocks of 256 by 256 numbers are a factor of 1024 nodes.
    let builder = builder.memory_budget(fixed + 6_000_000);
    let mut path = builder.max_nodes(nodes).build().unwrap();
    let found: Vec<LoadingState> = path.by_ref().map(Result::unwrap).collect();
    assert!(path.handed_over_at().is_some_and(|at| (100..1024).contains(&at)));
    let events = |states: &[LoadingState]| -> Vec<_> {
        states.iter().map(|state| (state.event, state.node)).collect()
    };
    let releases = exact.iter().filter(|state| state.event == ContactEvent::Release).count();
    println!("{:?}, {releases} releases", path.handed_over_at());
    assert!(releases > 0 && events(&found) == events(&exact));

    let builder = || LoadingSolver::builder(&surface, &kernel);
    let mut path = builder().max_nodes(700).build().unwrap();
    let mut continued: Vec<LoadingState> = path.by_ref().map(Result::unwrap).collect();
    let history: History = continued.iter().copied().collect();
    let rest = |path: LoadingSolver| -> Vec<LoadingState> { path.map(Result::unwrap).collect() };
    let resumed = rest(builder().max_nodes(nodes).resume(&history).unwrap());
    let fraction = nodes as f64 / (n * n) as f64;
    path.continue_to(ContactTarget::AreaFraction(fraction)).unwrap();
    let begun = continued.len();
    continued.extend(rest(path));
    assert_eq!(events(&continued), events(&exact));
    assert_eq!(events(&resumed), events(&exact[begun..]));
}
