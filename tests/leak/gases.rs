//! Gases, and gaps through which nothing flows any more.

use asperity::leak::Seal;
use asperity::loading::History;
use asperity::surface::Axis;
use asperity::{Boundary, Error, Grid, LoadingSolver, PeriodicBoussinesq, SelfAffine};
use nalgebra::DMatrix;

use super::leak;

/// Through a uniform gap of 1 a gas of 3 bar flows into one of 1: `(p₁² − p₂²) / 2 p₂` drives it, and its pressure is
/// the root of a line.
#[test]
fn gases_flow_by_the_square_of_their_pressure() {
    let grid = Grid::with_sides(16, 4, 4.0, 2.0).unwrap();
    let gap = DMatrix::from_element(16, 4, 1.0);
    let open = gap.map(|_| false);
    let on = (&grid, Boundary::Free);
    let (inlet, outlet) = (3e5, 1e5);
    let liquid = Seal::new(1.0 / 12.0, inlet - outlet, Axis::X).unwrap();
    let gas = liquid.with_gas(outlet).unwrap();
    assert_eq!([liquid, gas].map(|seal| seal.outlet_pressure()), [None, Some(outlet)]);
    let found = gas.leak(&gap, &open, on).unwrap();
    let expected = 2.0 / 4.0 * (inlet * inlet - outlet * outlet) / (2.0 * outlet);
    assert!((found.leak_rate / expected - 1.0).abs() < 1e-11, "{} {expected}", found.leak_rate);
    for ix in 0..16 {
        let share = 1.0 - (ix as f64 + 0.5) / 16.0;
        let squared = outlet * outlet + share * (inlet * inlet - outlet * outlet);
        let pressure = found.pressure[(ix, 1)] + outlet;
        assert!((pressure / squared.sqrt() - 1.0).abs() < 1e-11, "{ix}: {pressure}");
        assert!((found.flux_x[(ix, 2)] / (expected / 2.0) - 1.0).abs() < 1e-10);
    }
    // Under a small drop it is a liquid, and a permeability is that of the gap.
    let slight = Seal::new(1.0 / 12.0, 1e-3, Axis::X).unwrap();
    let [liquid, gas] =
        [slight, slight.with_gas(1e5).unwrap()].map(|seal| seal.leak(&gap, &open, on).unwrap());
    assert!((gas.leak_rate / liquid.leak_rate - 1.0).abs() < 1e-8);
    assert_eq!(gas.permeability, liquid.permeability);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(slight.with_gas(bad), Err(Error::NotPositive { .. })));
    }
}

/// The equation is that of a liquid for p²: through any gap rates and fluxes are those of a liquid, times one number, and
/// shares and permeabilities the same.
#[test]
fn gases_take_the_way_of_liquids() {
    let grid = Grid::new(9, 7, 1.5, 1.0).unwrap();
    let gap = DMatrix::from_fn(9, 7, |ix, iy| 0.1 + ((ix * 31 + iy * 17 + ix * iy) % 7) as f64);
    let (open, on) = (gap.map(|_| false), (&grid, Boundary::Periodic));
    let liquid = Seal::new(1.0 / 12.0, 3.0, Axis::Y).unwrap();
    let gas = liquid.with_gas(0.5).unwrap();
    let [liquid, gas] = [liquid, gas].map(|seal| seal.leak(&gap, &open, on).unwrap());
    // 1 + Δp / 2 p₂; one network is solved once, and then a few roundings.
    let same = |found: f64, expected: f64| {
        assert!((found - expected).abs() <= 1e-14 * expected.abs(), "{found:e} {expected:e}");
    };
    let many = |found: &[f64], expected: &[f64]| {
        assert_eq!(found.len(), expected.len());
        found.iter().zip(expected).for_each(|(found, expected)| same(*found, 4.0 * expected));
    };
    many(&[gas.leak_rate], &[liquid.leak_rate]);
    many(&[gas.mean_field_leak_rate], &[liquid.mean_field_leak_rate]);
    many(&gas.sections, &liquid.sections);
    many(gas.flux_x.as_slice(), liquid.flux_x.as_slice());
    many(gas.flux_y.as_slice(), liquid.flux_y.as_slice());
    same(gas.permeability, liquid.permeability);
    same(gas.transverse_permeability.unwrap(), liquid.transverse_permeability.unwrap());
    assert!(liquid.constriction.is_some());
    assert_eq!(gas.constriction, liquid.constriction);
}

/// Rows of gaps 1, 2 and 3: what is not wider than 2 is as good as in contact.
#[test]
fn nothing_flows_through_the_narrowest_gaps() {
    let grid = Grid::square(6, 1.0).unwrap();
    let gap = DMatrix::from_fn(6, 6, |_, iy| (1 + iy % 3) as f64);
    let open = gap.map(|_| false);
    let seal = Seal::new(1.0 / 12.0, 1.0, Axis::X).unwrap();
    let limited =
        seal.with_least_gap(2.0).unwrap().leak(&gap, &open, (&grid, Boundary::Free)).unwrap();
    let wide =
        leak(&gap.map(|gap| if gap > 2.0 { gap } else { 0.0 }), &grid, Boundary::Free, Axis::X);
    assert_eq!(limited.leak_rate, wide.unwrap().leak_rate);
    assert_eq!(limited.flowing_nodes, 12);
    let closed = seal.with_least_gap(3.0).unwrap();
    assert!(closed.leak(&gap, &open, (&grid, Boundary::Free)).unwrap().is_closed());
    // What overlaps is refused all the same.
    let mut overlapping = gap.clone();
    overlapping[(1, 1)] = -0.5;
    assert!(closed.leak(&overlapping, &open, (&grid, Boundary::Free)).is_err());
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(seal.with_least_gap(bad), Err(Error::OutOfRange { .. })));
    }
}

/// A seal closes earlier on its path then, at the first state that does not leak.
#[test]
fn a_least_gap_closes_a_seal_earlier() {
    let half_space = PeriodicBoussinesq::new(Grid::square(32, 1.25e-3).unwrap(), 115e9).unwrap();
    let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space).build().unwrap();
    let history: History = path.by_ref().collect::<Result<_, _>>().unwrap();
    let seal = Seal::new(1e-3, 1e5, Axis::X).unwrap();
    let by_contact = seal.curve(&mut path, &history, 12).unwrap().closing.unwrap();
    let limited = seal.with_least_gap(10e-6).unwrap();
    let curve = limited.curve(&mut path, &history, 12).unwrap();
    let closing = curve.closing.unwrap();
    assert!(closing.step < by_contact.step, "{} {}", closing.step, by_contact.step);
    let before = history.states()[closing.step - 2];
    assert!(!limited.leak_at(&mut path, &before).unwrap().is_closed());
    assert!(limited.leak_at(&mut path, &closing).unwrap().is_closed());
    assert!(curve.points.iter().all(|point| point.state.step <= closing.step));
}
