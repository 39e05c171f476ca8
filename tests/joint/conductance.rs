//! Conductance of contacts and gaps, and Barber's bounds.

use asperity::joint::{Carrier, Conduction};
use asperity::kernel::Layering;
use asperity::loading::History;
use asperity::reference::contact_conductance;
use asperity::surface::{HeightMap, Paraboloid};
use asperity::{
    Boussinesq, ContactEvent, ContactState, Error, Grid, InfluenceKernel, LoadingState,
    PeriodicBoussinesq,
};
use nalgebra::DMatrix;

use super::{history, rough};

const E_STAR: f64 = 115e9;
const COPPER: f64 = 1.7e-8;

#[test]
fn conduction_takes_the_stiffness_of_the_half_space() {
    let grid = Grid::square(32, 1.25e-3).unwrap();
    let current = Conduction::electrical(E_STAR, 2.0 * COPPER).unwrap();
    assert_eq!(current.carrier(), Carrier::Current);
    let free = Boussinesq::new(grid, E_STAR).unwrap();
    let periodic = PeriodicBoussinesq::new(grid, E_STAR).unwrap();
    let kernels: [&dyn InfluenceKernel; 2] = [&free, &periodic];
    for kernel in kernels {
        for state in history(&rough(), kernel, 0.2).states() {
            let contact = &state.contact;
            let interfacial = contact.interfacial_stiffness.unwrap();
            let stiffness = contact.contact_stiffness.unwrap_or(interfacial);
            let expected = |k| Some(contact_conductance(k, E_STAR, 2.0 * COPPER).unwrap());
            assert_eq!(current.of(contact, Layering::HalfSpace).unwrap(), expected(stiffness));
            assert_eq!(
                current.of_interface(contact, Layering::HalfSpace).unwrap(),
                expected(interfacial)
            );
        }
    }
    let without = ContactState::new(&grid, 3, 1.0, 1.0, 1.0);
    assert_eq!(current.of(&without, Layering::Unknown).unwrap(), None);
    assert_eq!(current.of_interface(&without, Layering::Unknown).unwrap(), None);
}

/// By hand: 20 nodes of 1 m², 5 in contact, a mean gap of 3 m, so that the gap of the open 15 m² is 4 m on average.
#[test]
fn the_gap_conducts_in_parallel() {
    let grid = Grid::new(4, 5, 1.0, 1.0).unwrap();
    let mut contact = ContactState::new(&grid, 5, 1.0, 1.0, 3.0);
    contact.interfacial_stiffness = Some(7.0);
    let solid = Conduction::thermal(2.0, 0.5).unwrap();
    assert_eq!(solid.carrier(), Carrier::Heat);
    assert_eq!(solid.of(&contact, Layering::Unknown).unwrap(), Some(14.0));
    let with_gap = solid.with_gap(0.1, 2.0).unwrap();
    assert_eq!(with_gap.of(&contact, Layering::Unknown).unwrap(), Some(14.0 + 0.1 * 15.0 / 6.0));
    // In full contact there is no gap.
    let mut full = ContactState::new(&grid, 20, 1.0, 1.0, 0.0);
    full.interfacial_stiffness = Some(f64::INFINITY);
    assert_eq!(with_gap.of(&full, Layering::Unknown).unwrap(), Some(f64::INFINITY));
    full.interfacial_stiffness = Some(1.0);
    assert_eq!(
        with_gap.of(&full, Layering::Unknown).unwrap(),
        solid.of(&full, Layering::Unknown).unwrap()
    );
}

#[test]
fn what_conducts_nothing_is_refused() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Conduction::electrical(bad, 1.0), Err(Error::NotPositive { .. })));
        assert!(matches!(Conduction::thermal(1.0, bad), Err(Error::NotPositive { .. })));
        let one = Conduction::thermal(1.0, 1.0).unwrap();
        assert!(matches!(one.with_gap(bad, 0.0), Err(Error::NotPositive { .. })));
        if bad != 0.0 {
            assert!(matches!(one.with_gap(1.0, bad), Err(Error::OutOfRange { .. })));
            let none = History::default();
            assert!(matches!(one.bounds(&none, bad), Err(Error::OutOfRange { .. })));
        }
    }
    let mut contact = ContactState::new(&Grid::square(4, 1.0).unwrap(), 5, 1.0, 1.0, 3.0);
    contact.contact_stiffness = Some(f64::NAN);
    assert!(Conduction::thermal(1.0, 1.0).unwrap().of(&contact, Layering::HalfSpace).is_err());
}

/// Without unresolved roughness the bounds are the stiffnesses on both sides of an event; with more of it they widen,
/// and the conductance lies between them.
#[test]
fn bounds_enclose_the_conductance_and_widen_with_the_roughness() {
    let grid = Grid::square(32, 1.25e-3).unwrap();
    let conduction = Conduction::electrical(E_STAR, 2.0 * COPPER).unwrap();
    let free = Boussinesq::new(grid, E_STAR).unwrap();
    let periodic = PeriodicBoussinesq::new(grid, E_STAR).unwrap();
    let kernels: [&dyn InfluenceKernel; 2] = [&free, &periodic];
    for kernel in kernels {
        let history = history(&rough(), kernel, 0.5);
        let conductances: Vec<f64> = history
            .states()
            .iter()
            .map(|s| conduction.of(&s.contact, Layering::HalfSpace).unwrap().unwrap())
            .collect();
        let none = conduction.bounds(&history, 0.0).unwrap();
        // Loads and approaches are sums of some hundred increments, each right to rounding of the whole.
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-6;
        for k in 2..none.len() - 1 {
            let load = |k: usize| history.states()[k].contact.load;
            // Differences of neighbours need their distance.
            if load(k) - load(k - 1) > 1e-4 * load(k) && load(k + 1) - load(k) > 1e-4 * load(k) {
                assert!(near(none[k].lower, conductances[k - 1]), "{k}");
                assert!(near(none[k].upper, conductances[k]), "{k}");
            }
        }
        let mut before = none;
        for roughness in [1e-8, 1e-7, 1e-6] {
            let bounds = conduction.bounds(&history, roughness).unwrap();
            for ((bound, before), conductance) in bounds.iter().zip(&before).zip(&conductances) {
                assert!(bound.lower <= before.lower && bound.upper >= before.upper);
                assert!(bound.lower < *conductance && *conductance < bound.upper * (1.0 + 1e-9));
            }
            before = bounds;
        }
    }
}

/// On a path whose compression is 2 √W, by calculus. Under W = v² the chord from u² has the slope
/// (2 (v − u) + s) / (v² − u²), which is least where (v − u)² = u s, and the one to w² has (2 (w − v) − s) / (w² − v²),
/// greatest where (w − v)² = w s. At v = 2 and s = 1 these are 1, from u = 1, and 1/4, to w = 4. The gap is beside both.
#[test]
fn bounds_of_a_root_are_those_of_its_best_chords() {
    let grid = Grid::new(4, 5, 1.0, 1.0).unwrap();
    let conduction = Conduction::thermal(2.0, 0.5).unwrap().with_gap(0.1, 2.0).unwrap();
    // The approach where that is of a distant point, else what the mean gap closes; where a row of images makes neither
    // certain it counts twice.
    for (body, has_stiffness, roughness) in [
        (Layering::HalfSpace, true, 1.0),
        (Layering::HalfSpace, false, 1.0),
        (Layering::SemiPeriodicHalfSpace, true, 0.5),
    ] {
        let is_far = has_stiffness && body == Layering::HalfSpace;
        let states = (0..=20).map(|load| {
            let load = f64::from(load);
            let depth = 2.0 * load.sqrt();
            let (approach, mean_gap) =
                if is_far { (depth, 8.0 - 0.5 * depth) } else { (3.0 * depth, 10.0 - depth) };
            let mut contact = ContactState::new(&grid, 5, approach, load, mean_gap);
            contact.contact_stiffness = has_stiffness.then_some(7.0);
            contact.interfacial_stiffness = Some(7.0);
            LoadingState::new(1, ContactEvent::Touch, (0, 0), contact)
        });
        let history: History = states.collect();
        let bounds = conduction.bounds(&history.on(body), roughness).unwrap();
        // By ρ E* = 1, and an open area of 15 m² with a gap of 6 m · 20/15 on average.
        let gap = 0.1 * 15.0 / (8.0 + 2.0);
        // Some roundings.
        assert!((bounds[4].lower - (2.0 + gap)).abs() < 1e-14, "{body:?} {:?}", bounds[4]);
        assert!((bounds[4].upper - (8.0 + gap)).abs() < 1e-14, "{body:?} {:?}", bounds[4]);
        assert_eq!(bounds[20].upper, f64::INFINITY);
    }
}

/// On a symmetric surface nodes touch together, four or eight of them: bounds are those of all chords between loads that
/// differ by more than rounding.
#[test]
fn bounds_beside_nodes_that_touch_together_are_those_of_the_best_chords() {
    let heights = DMatrix::from_fn(12, 12, |ix, iy| {
        let height = |x: usize, y: usize| libm::sin((7 * x * x + 13 * y + 5 * x * y) as f64);
        let (a, b) = (ix.min(11 - ix), iy.min(11 - iy));
        1e-6 * (height(a, b) + height(b, a))
    });
    let surface = HeightMap::new(heights).unwrap();
    let grid = Grid::square(12, 1.2e-4).unwrap();
    let kernel = PeriodicBoussinesq::new(grid, 1e11).unwrap();
    let history = history(&surface, &kernel, 1.0);
    // ρ E* = 2 makes a conductance of a stiffness.
    let conduction = Conduction::electrical(1e11, 2e-11).unwrap();
    let points: Vec<(f64, f64)> =
        history.states().iter().map(|s| (s.contact.load, -s.contact.mean_gap)).collect();
    for roughness in [0.0, 1e-8] {
        let bounds = conduction.bounds(&history, roughness).unwrap();
        for (&(load, depth), bound) in points.iter().zip(&bounds) {
            let apart = |other: f64| (other - load).abs() > 2e-9 * load.max(other);
            let chords = |way: f64| {
                let others = points.iter().filter(move |p| apart(p.0) && way * (p.0 - load) > 0.0);
                others.map(move |p| (p.1 - depth - roughness) / (p.0 - load))
            };
            let (before, after) = (chords(-1.0), chords(1.0));
            let lower = before.reduce(f64::min).map_or(0.0, f64::recip);
            let upper = after.reduce(f64::max).filter(|slope| *slope > 0.0);
            let upper = upper.map_or(f64::INFINITY, f64::recip);
            // Chords between loads that are 10⁻⁹ apart have seven digits.
            let near = |a: f64, b: f64| a == b || (a / b - 1.0).abs() < 1e-6;
            assert!(near(bound.lower, lower), "{load}: {} {lower}", bound.lower);
            assert!(near(bound.upper, upper), "{load}: {} {upper}", bound.upper);
        }
    }
}

/// A surface, and the same with more roughness: its conductance lies within the bounds of the first, which know nothing
/// of it but its height.
#[test]
fn a_rougher_surface_conducts_within_the_bounds() {
    let grid = Grid::square(24, 1e-3).unwrap();
    let kernel = Boussinesq::new(grid, 1e9).unwrap();
    let smooth = HeightMap::sample(&Paraboloid::new(5e-3).unwrap(), &grid).unwrap();
    let height = 1e-6;
    // In no order, from 0 to `height`.
    let more =
        |ix: usize, iy: usize| height * ((ix * 37 + iy * 101 + ix * iy * 17) % 97) as f64 / 96.0;
    let rough =
        HeightMap::new(DMatrix::from_fn(24, 24, |ix, iy| smooth.matrix()[(ix, iy)] + more(ix, iy)))
            .unwrap();
    let conduction = Conduction::thermal(1e9, 0.02).unwrap();
    let first = history(&smooth, &kernel, 0.6);
    let bounds = conduction.bounds(&first, height).unwrap();
    let second = history(&rough, &kernel, 0.6);
    let mut compared = 0;
    for (state, bound) in first.states().iter().zip(&bounds) {
        if let Some(other) = second.at_load(state.contact.load) {
            let found = conduction.of(&other.contact, Layering::HalfSpace).unwrap().unwrap();
            assert!(bound.lower <= found && found <= bound.upper, "{found} {bound:?}");
            compared += 1;
        }
    }
    assert!(compared > 100);
    // They say something: within a factor of 3 in the middle of the path.
    let middle = bounds[bounds.len() / 2];
    assert!(middle.upper / middle.lower < 3.0, "{middle:?}");
}
