//! Closed forms of channels in parallel and in series, pools, and symmetries.

use std::f64::consts::TAU;

use asperity::leak::Seal;
use asperity::surface::Axis;
use asperity::{Boundary, Grid};
use nalgebra::DMatrix;

use super::{BOUNDARIES, SAME, assert_conserved, leak};

fn assert_rate(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < SAME, "{found:e} {expected:e}");
}

/// Gaps in no order, between 0.1 and 1.
fn some(k: usize) -> f64 {
    0.1 + 0.9 * ((k * 7919 + 13) % 101) as f64 / 100.0
}

/// Channels side by side: each conducts by itself, so that cubes add up.
#[test]
fn channels_in_parallel() {
    let grid = Grid::new(12, 9, 0.5, 0.25).unwrap();
    let gap = DMatrix::from_fn(12, 9, |_, iy| some(iy));
    let sum: f64 = (0..9).map(|iy| some(iy).powi(3)).sum();
    for boundary in BOUNDARIES {
        let found = leak(&gap, &grid, boundary, Axis::X).unwrap();
        assert_rate(found.leak_rate, sum * 0.25 / (12.0 * 0.5));
        assert_rate(found.permeability, sum / 9.0);
        assert_conserved(&found);
        // The pressure falls evenly, in halves of a cell from the edges on, and nothing flows across.
        for (place, pressure) in found.pressure.iter().enumerate() {
            let expected = 1.0 - ((place % 12) as f64 + 0.5) / 12.0;
            assert!((pressure - expected).abs() < 1e-9);
        }
        for (place, flux) in found.flux_x.iter().enumerate() {
            assert!((flux / (some(place / 12).powi(3) / 6.0) - 1.0).abs() < 1e-9);
        }
        assert!(found.flux_y.iter().all(|flux| flux.abs() < 1e-9));
        let across = found.transverse_permeability;
        assert_eq!(across.is_some(), boundary == Boundary::Periodic);
        assert!(across.unwrap_or(0.0).abs() < 1e-10);
    }
}

/// One behind the other: resistances add up, the halves of the first and of the last cell with the others. The
/// narrowest place has the largest share.
#[test]
fn channels_in_series() {
    let grid = Grid::new(12, 9, 0.5, 0.25).unwrap();
    let gap = DMatrix::from_fn(12, 9, |ix, _| some(ix));
    let resistance: f64 = (0..12).map(|ix| 0.5 / some(ix).powi(3)).sum();
    for boundary in BOUNDARIES {
        let found = leak(&gap, &grid, boundary, Axis::X).unwrap();
        assert_rate(found.leak_rate, 9.0 * 0.25 / resistance);
        assert_conserved(&found);
        let narrowest = (0..12).min_by(|a, b| some(*a).total_cmp(&some(*b))).unwrap();
        let constriction = found.constriction.unwrap();
        assert_eq!((constriction.node.0, constriction.gap), (narrowest, some(narrowest)));
        let share = 0.5 / some(narrowest).powi(3) / resistance;
        assert!((constriction.pressure_drop / share - 1.0).abs() < 1e-9);
        // All that is lost in the 9 columns about it; all 9 rows lie in the square if it is in the middle or goes
        // around.
        let columns = narrowest.saturating_sub(4)..(narrowest + 5).min(12);
        let share: f64 = columns.map(|ix| 0.5 / some(ix).powi(3)).sum::<f64>() / resistance;
        let rows = match boundary {
            Boundary::Periodic | Boundary::PeriodicY => 9,
            Boundary::Free | Boundary::PeriodicX => {
                let iy = constriction.node.1;
                (iy + 5).min(9) - iy.saturating_sub(4)
            }
        };
        let share = share * rows as f64 / 9.0;
        assert!((constriction.dissipation / share - 1.0).abs() < 1e-9);
    }
}

/// Lakes behind throats of 10⁻⁶ of their gap: conductances of 18 decades, in closed form.
#[test]
fn throats_of_eighteen_decades() {
    let grid = Grid::new(30, 5, 1.0, 1.0).unwrap();
    let is_throat = |ix: usize| ix == 9 || ix == 20;
    let gap = DMatrix::from_fn(30, 5, |ix, iy| match (is_throat(ix), iy) {
        (false, _) => 1.0,
        (true, 2) => 1e-6,
        (true, _) => 0.0,
    });
    let found = leak(&gap, &grid, Boundary::Free, Axis::X).unwrap();
    // Two throats of one cell; all else is below rounding beside them.
    assert_rate(found.leak_rate, 0.5e-18);
    assert_conserved(&found);
    for (ix, expected) in [(3, 1.0), (15, 0.5), (25, 0.0)] {
        assert!((found.pressure[(ix, 1)] - expected).abs() < 1e-9);
    }
    // By symmetry, either throat; half of the pressure drop falls there.
    let constriction = found.constriction.unwrap();
    assert!(is_throat(constriction.node.0) && constriction.gap == 1e-6);
    assert!((constriction.pressure_drop - 0.5).abs() < 1e-9);
    assert!((constriction.dissipation - 0.5).abs() < 1e-9);
}

/// A sinusoidal gap, g = g₀ (1 + ε cos), in closed form: along the flow the mean of g⁻³ is (1 + ε²/2) / (g₀³ (1 −
/// ε²)^(5/2)), across it that of g³ is g₀³ (1 + 3ε²/2). Means of 96 nodes of such waves are exact to ρ⁹⁶ with ρ = ε /
/// (1 + √(1 − ε²)) = 0.27 at ε = ½, far below rounding.
#[test]
fn a_sinusoidal_gap_along_and_across() {
    let (n, e) = (96, 0.5_f64);
    let grid = Grid::square(n, 3.0).unwrap();
    let wave = |k: usize| 1.0 + e * (TAU * (k as f64 + 0.5) / n as f64).cos();
    let series = (1.0 - e * e).powf(2.5) / (1.0 + 0.5 * e * e);
    let parallel = 1.0 + 1.5 * e * e;
    let along = DMatrix::from_fn(n, n, |ix, _| wave(ix));
    let across = along.transpose();
    for boundary in BOUNDARIES {
        for (gap, axis, expected) in [
            (&along, Axis::X, series),
            (&along, Axis::Y, parallel),
            (&across, Axis::X, parallel),
            (&across, Axis::Y, series),
        ] {
            let found = leak(gap, &grid, boundary, axis).unwrap();
            assert_rate(found.leak_rate, expected);
            assert_rate(found.permeability, expected);
        }
    }
}

/// Two channels; what hangs on them, and what does not, makes no difference. The pool has no pressure, and bays that of
/// their edge.
#[test]
fn pools_and_bays_are_left_out() {
    let grid = Grid::new(10, 8, 1.0, 1.0).unwrap();
    let mut gap = DMatrix::zeros(10, 8);
    for ix in 0..10 {
        gap[(ix, 0)] = 0.7;
        gap[(ix, 7)] = 0.2;
    }
    let expected = leak(&gap, &grid, Boundary::Free, Axis::X).unwrap();
    assert_eq!((expected.pools, expected.flowing_nodes), (0, 20));
    for node in [(4, 3), (5, 3), (7, 5)] {
        gap[node] = 0.9;
    }
    // From the edge where the fluid enters, from the other one, and a dead end of a channel.
    for node in [(0, 3), (1, 3), (9, 4), (3, 1)] {
        gap[node] = 0.5;
    }
    let found = leak(&gap, &grid, Boundary::Free, Axis::X).unwrap();
    assert_rate(found.leak_rate, expected.leak_rate);
    assert_eq!((found.pools, found.flowing_nodes), (2, 21));
    assert!(found.pressure[(4, 3)].is_nan() && found.pressure[(2, 4)].is_nan());
    assert_eq!((found.pressure[(1, 3)], found.pressure[(9, 4)]), (1.0, 0.0));
    assert!((found.pressure[(3, 1)] - found.pressure[(3, 0)]).abs() < 1e-9);
    // Corners let nothing pass: a diagonal is closed.
    let diagonal = DMatrix::from_fn(6, 6, |ix, iy| f64::from(u8::from(ix == iy)));
    let closed = leak(&diagonal, &Grid::square(6, 1.0).unwrap(), Boundary::Free, Axis::X).unwrap();
    assert!(closed.is_closed() && closed.pools == 4);
}

/// Without a channel the leak rate is exactly 0: in full contact, behind a wall, and along one direction only.
#[test]
fn what_is_closed_leaks_nothing() {
    let grid = Grid::square(6, 1.0).unwrap();
    let wall = DMatrix::from_fn(6, 6, |ix, _| if ix == 2 { 0.0 } else { 0.5 });
    for boundary in BOUNDARIES {
        let found = leak(&DMatrix::zeros(6, 6), &grid, boundary, Axis::X).unwrap();
        assert!(found.is_closed() && found.leak_rate == 0.0 && found.constriction.is_none());
        assert_eq!((found.flowing_nodes, found.pools), (0, 0));
        assert!(found.sections.iter().all(|section| *section == 0.0));
        let found = leak(&wall, &grid, boundary, Axis::X).unwrap();
        assert!(found.is_closed());
        assert_eq!((found.pressure[(1, 1)], found.pressure[(3, 1)]), (1.0, 0.0));
        // Five channels that a wall ends at the sides.
        let found = leak(&wall, &grid, boundary, Axis::Y).unwrap();
        assert_rate(found.leak_rate, 5.0 * 0.125 / 6.0);
    }
}

/// A gap map in no order: mirrored and transposed it leaks as much, and the fields are mirrored and transposed.
#[test]
fn mirrored_and_transposed_gaps_leak_the_same() {
    let (nx, ny) = (17, 14);
    let gap = DMatrix::from_fn(nx, ny, |ix, iy| {
        let value = some(ix * 31 + iy * 17 + ix * iy);
        if value < 0.35 { 0.0 } else { value }
    });
    let grid = Grid::new(nx, ny, 1.5, 1.0).unwrap();
    for boundary in BOUNDARIES {
        let found = leak(&gap, &grid, boundary, Axis::X).unwrap();
        assert!(found.leak_rate > 0.0);
        assert_conserved(&found);
        let mirror = DMatrix::from_fn(nx, ny, |ix, iy| gap[(nx - 1 - ix, iy)]);
        let mirrored = leak(&mirror, &grid, boundary, Axis::X).unwrap();
        assert_rate(mirrored.leak_rate, found.leak_rate);
        let transposed = leak(&gap.transpose(), &grid.transposed(), boundary, Axis::Y).unwrap();
        assert_rate(transposed.leak_rate, found.leak_rate);
        assert_rate(transposed.mean_field_leak_rate, found.mean_field_leak_rate);
        assert_rate(mirrored.mean_field_leak_rate, found.mean_field_leak_rate);
        let greatest = found.flux_x.amax().max(found.flux_y.amax());
        for ix in 0..nx {
            for iy in 0..ny {
                let (own, other) = (found.pressure[(ix, iy)], mirrored.pressure[(nx - 1 - ix, iy)]);
                assert_eq!(own.is_nan(), other.is_nan());
                assert!(own.is_nan() || (own + other - 1.0).abs() < 1e-9);
                let along = mirrored.flux_x[(nx - 1 - ix, iy)] - found.flux_x[(ix, iy)];
                let across = mirrored.flux_y[(nx - 1 - ix, iy)] + found.flux_y[(ix, iy)];
                assert!(along.abs().max(across.abs()) < 1e-9 * greatest);
                let along = transposed.flux_y[(iy, ix)] - found.flux_x[(ix, iy)];
                let across = transposed.flux_x[(iy, ix)] - found.flux_y[(ix, iy)];
                assert!(along.abs().max(across.abs()) < 1e-9 * greatest);
            }
        }
        if let (Some(own), Some(other)) =
            (found.transverse_permeability, mirrored.transverse_permeability)
        {
            assert!(own.abs() > 1e-6 * found.permeability);
            // The mean flux across over the mean gradient along, of a drop of 1.
            let expected = found.flux_y.mean() * grid.sides().0;
            assert!((own - expected).abs() < 1e-9 * found.permeability, "{own:e} {expected:e}");
            assert!((own + other).abs() < 1e-9 * found.permeability);
        }
    }
}

/// The edges across the flow are inlet and outlet: whether the body repeats there makes no difference, bit for bit.
#[test]
fn only_the_sides_along_the_flow_are_open_to_each_other() {
    let grid = Grid::new(11, 8, 1.5, 1.0).unwrap();
    let gap = DMatrix::from_fn(11, 8, |ix, iy| some(ix * 31 + iy * 17 + ix * iy));
    let leaks = |boundary: Boundary, along: Axis| leak(&gap, &grid, boundary, along).unwrap();
    let pairs = [
        (Axis::X, Boundary::PeriodicY, Boundary::Periodic),
        (Axis::X, Boundary::PeriodicX, Boundary::Free),
        (Axis::Y, Boundary::PeriodicX, Boundary::Periodic),
        (Axis::Y, Boundary::PeriodicY, Boundary::Free),
    ];
    for (along, boundary, same) in pairs {
        // Every field is in it.
        let [found, expected] = [boundary, same].map(|it| format!("{:?}", leaks(it, along)));
        assert_eq!(found, expected, "{boundary:?}");
        let [found, other] = [Boundary::Periodic, Boundary::Free].map(|it| leaks(it, along));
        assert!((found.leak_rate / other.leak_rate - 1.0).abs() > 1e-6);
    }
}

/// By dimensions: rates go with the cube of the gap and the pressure drop, and against the viscosity. Powers of two
/// change no digit.
#[test]
fn rates_scale_with_gap_pressure_and_viscosity() {
    let grid = Grid::square(9, 2.0).unwrap();
    let gap = DMatrix::from_fn(9, 9, |ix, iy| some(ix + 9 * iy));
    let open = gap.map(|_| false);
    let rate = |viscosity: f64, drop: f64, gap: &DMatrix<f64>| {
        let seal = Seal::new(viscosity, drop, Axis::Y).unwrap();
        seal.leak(gap, &open, (&grid, Boundary::Free)).unwrap()
    };
    let one = rate(1.0, 1.0, &gap);
    assert_eq!(rate(0.25, 8.0, &gap).leak_rate, 32.0 * one.leak_rate);
    let wide = rate(1.0, 1.0, &(2.0 * &gap));
    assert_eq!(wide.leak_rate, 8.0 * one.leak_rate);
    assert_eq!(wide.permeability, 8.0 * one.permeability);
    assert_eq!(wide.mean_field_leak_rate, 8.0 * one.mean_field_leak_rate);
    assert_eq!(rate(1.0, 4.0, &gap).pressure, 4.0 * one.pressure);
}

/// Single nodes and single rows, on either boundary: one cell conducts as one does, and a periodic row not onto itself.
#[test]
fn the_smallest_grids() {
    for boundary in BOUNDARIES {
        for (nx, ny) in [(1, 1), (1, 5), (5, 1), (2, 2), (3, 2)] {
            let grid = Grid::new(nx, ny, 2.0, 3.0).unwrap();
            let gap = DMatrix::from_element(nx, ny, 0.5);
            let found = leak(&gap, &grid, boundary, Axis::X).unwrap();
            assert_rate(found.leak_rate, 0.125 * (3.0 * ny as f64) / (2.0 * nx as f64));
            assert_conserved(&found);
            assert_eq!(
                found.mean_field_leak_rate / found.permeability,
                (3.0 * ny as f64) / (2.0 * nx as f64) * (0.125 / found.permeability)
            );
        }
    }
}
