use super::*;
use crate::{PeriodicBoussinesq, Spectral};

const E_STAR: f64 = 3.0;

/// 2 / (E* q), and nonsense at q = 0, where it must not be looked at.
fn half_space(qx: f64, qy: f64) -> f64 {
    2.0 / (E_STAR * qx.hypot(qy))
}

/// The symbol of a layer of thickness h bonded to a rigid base, times E* (Bentall and Johnson 1968).
fn layer(q: f64, h: f64, nu: f64) -> f64 {
    if q == 0.0 {
        return h * (1.0 - 2.0 * nu) / (1.0 - nu).powi(2);
    }
    let (a, kappa) = ((q * h).min(40.0), 3.0 - 4.0 * nu);
    let above = 2.0 * kappa * (2.0 * a).sinh() - 4.0 * a;
    let below = 2.0 * kappa * (2.0 * a).cosh() + 4.0 * a * a + kappa * kappa + 1.0;
    2.0 / q * above / below
}

#[test]
fn the_layer_of_these_tests_has_its_limits() {
    // Thick: the half-space, up to exp(−2 q h) times (q h)².
    assert!((layer(50.0, 0.3, 0.2) / (2.0 / 50.0) - 1.0).abs() < 1e-10);
    // Long waves: continuous down to the uniform compression, up to (q h)².
    assert!((layer(1e-4, 0.3, 0.2) / layer(0.0, 0.3, 0.2) - 1.0).abs() < 1e-7);
    // Thin and incompressible: the flow of a film, h³ q² / (3 G) with E* = 4 G.
    let (q, h) = (0.1, 0.3_f64);
    let film = 4.0 * h.powi(3) * q * q / 3.0;
    // The next order is (q h)² = 9e-4 times a number near 1.
    assert!((layer(q, h, 0.5) / film - 1.0).abs() < 3e-3);
}

#[test]
fn another_gauge_is_a_uniform_displacement() -> Result<(), Error> {
    let grid = Grid::new(12, 9, 1.0, 1.0)?;
    let kernel = PeriodicBoussinesq::new(grid, 1.0)?;
    let table = KernelTable::new(&kernel)?;
    let zero = table.in_gauge(0.0);
    // Means of 108 numbers near 1.
    assert!(zero.gauge().is_some_and(|gauge| gauge.abs() < 1e-15));
    let own = table.coefficient(5, 4).unwrap_or(f64::NAN) - kernel.gauge();
    let found = zero.coefficient(5, 4).unwrap_or(f64::NAN);
    assert!((found - own).abs() < 1e-15);
    // Of the size of the least gauge that makes the kernel an inverse M-matrix.
    let ratio =
        table.computing_gauge().unwrap_or(f64::NAN) / kernel.least_gauge().unwrap_or(f64::NAN);
    assert!((0.8..1.3).contains(&ratio), "{ratio}");
    Ok(())
}

/// Paths are followed in the gauge of the kernel, unless a coefficient is negative in it or it is beyond ten good ones,
/// beyond a thousand under a convex promise.
#[test]
fn gauges_that_spoil_a_path_are_exchanged() -> Result<(), Error> {
    let grid = Grid::new(7, 6, 1.0, 40.0)?;
    let spectral = KernelTable::new(&Spectral::new(grid, 1.0)?)?;
    let love = KernelTable::new(&PeriodicBoussinesq::new(grid, 1.0)?)?;
    assert_eq!([spectral.growth, love.growth], [ContactGrowth::Monotone, ContactGrowth::Convex]);
    for (table, greatest) in [(spectral, 10.0), (love, 1000.0)] {
        let good = table.computing_gauge().unwrap_or(f64::NAN);
        // A good gauge is 1.5 times the one in which the least coefficient is 0.
        for (part, expected) in [
            (0.0, 1.0),
            (0.1, 1.0),
            (0.66, 1.0),
            (0.67, 0.67),
            (0.99 * greatest, 0.99 * greatest),
            (1.01 * greatest, LARGE_GAUGE),
        ] {
            let chosen = table.in_gauge(part * good).regular();
            assert!(chosen.least() >= 0.0, "{part}");
            // A mean of 42 numbers up to 1000 times as large as it.
            let found = chosen.gauge().unwrap_or(f64::NAN) / good;
            assert!((found / expected - 1.0).abs() < 1e-12, "{part}: {found}");
        }
    }
    Ok(())
}

#[test]
fn offsets_beyond_the_grid_have_no_coefficient() -> Result<(), Error> {
    let table = KernelTable::new(&Spectral::new(Grid::new(4, 3, 1.0, 1.0)?, 1.0)?)?;
    for beyond in [isize::MIN, -4, 4, isize::MAX] {
        assert_eq!(table.coefficient(beyond, 0), None);
        assert_eq!(table.coefficient(0, beyond), None);
        assert!(InfluenceKernel::coefficient(&table, beyond, beyond).is_nan());
    }
    assert!(table.coefficient(-3, 2).is_some());
    Ok(())
}

#[test]
fn a_table_is_the_kernel_it_was_made_from() -> Result<(), Error> {
    let kernel = PeriodicBoussinesq::new(Grid::new(6, 5, 1.0, 0.7)?, 1.0)?;
    let table = KernelTable::new(&kernel)?;
    let boxed: Box<dyn InfluenceKernel + Send + Sync> = Box::new(table.clone());
    let again = KernelTable::new(&std::sync::Arc::new(boxed))?;
    assert_eq!(again.values, table.values);
    assert_eq!(again.contact_growth(), kernel.contact_growth());
    assert_eq!(again.mean_displacement(), MeanDisplacement::Arbitrary);
    assert_eq!(again.gauge(), table.gauge());
    Ok(())
}

#[test]
fn the_symbol_of_the_half_space_gives_the_spectral_kernel() -> Result<(), Error> {
    for (nx, ny, dx, dy) in [
        (8, 8, 1.0, 1.0),
        (9, 6, 2e-6, 3e-6),
        (7, 11, 1.0, 1.0),
        (1, 5, 1.0, 1.0),
        (64, 2, 1.0, 7.0),
    ] {
        let grid = Grid::new(nx, ny, dx, dy)?;
        let mean = MeanDisplacement::Arbitrary;
        let table = KernelTable::from_symbol(grid, mean, ContactGrowth::Monotone, half_space)?;
        let spectral = KernelTable::new(&Spectral::new(grid, E_STAR)?)?;
        let (found, expected) = (table.in_gauge(0.0), spectral.in_gauge(0.0));
        let scale = expected.self_influence();
        for (a, b) in found.values.iter().zip(&expected.values) {
            // Two Fourier transforms of at most 128 values, and gauges added and taken away.
            assert!((a - b).abs() < 1e-14 * scale, "{nx} x {ny}: {a} {b}");
        }
        // A gauge that was chosen, and a matrix that is not singular in it.
        assert!(table.gauge().is_some_and(|gauge| gauge > 0.0));
    }
    Ok(())
}

#[test]
fn uniform_pressure_compresses_a_layer_on_a_rigid_base() -> Result<(), Error> {
    let (h, nu) = (0.3, 0.2);
    let grid = Grid::new(10, 7, 0.1, 0.2)?;
    let symbol = |qx: f64, qy: f64| layer(qx.hypot(qy), h, nu);
    let mean = MeanDisplacement::Physical;
    let table = KernelTable::from_symbol(grid, mean, ContactGrowth::Unknown, symbol)?;
    // The strain of a layer that cannot spread is p (1 + ν)(1 − 2ν) / (E (1 − ν)), E* = E / (1 − ν²).
    let modulus = (1.0 - nu * nu) * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let compression = grid.nodes() as f64 * table.mean_coefficient();
    // A sum of 70 terms.
    assert!((compression / (h / modulus) - 1.0).abs() < 1e-13, "{compression}");
    assert_eq!((table.gauge(), table.computing_gauge()), (None, None));
    assert_eq!(table.gauge_per_load(), Gauge::default());
    assert_eq!(table.in_gauge(0.0).values, table.values);
    let (coarse, _) = table.coarsened()?;
    assert_eq!(coarse.gauge(), None);
    Ok(())
}

/// No uniform pressure compresses it, and yet it is a body like others.
#[test]
fn an_incompressible_layer_on_a_rigid_base_has_no_mean_displacement() -> Result<(), Error> {
    let (h, grid) = (0.3, Grid::new(10, 7, 0.1, 0.2)?);
    let symbol = |qx: f64, qy: f64| layer(qx.hypot(qy), h, 0.5);
    let mean = MeanDisplacement::Physical;
    let table = KernelTable::from_symbol(grid, mean, ContactGrowth::Unknown, symbol)?;
    assert_eq!(table.mean_displacement(), MeanDisplacement::Arbitrary);
    // In the gauge that it computes in; otherwise zero, to the rounding of 70 terms.
    assert!(table.gauge().is_some_and(|gauge| gauge > 0.0));
    assert!(table.in_gauge(0.0).mean_coefficient().abs() < 1e-15 * table.self_influence());
    assert!(crate::kernel::check(&table).is_ok());
    Ok(())
}

/// An anisotropic symbol that is not even along x and y alone.
#[test]
fn waves_answer_with_their_symbol_in_every_direction() -> Result<(), Error> {
    let symbol = |qx: f64, qy: f64| 1.0 / (1.0 + qx * qx + 0.8 * qx * qy + qy * qy);
    for (nx, ny) in [(6, 8), (7, 5), (4, 3)] {
        let grid = Grid::new(nx, ny, 0.9, 1.3)?;
        let mean = MeanDisplacement::Physical;
        let table = KernelTable::from_symbol(grid, mean, ContactGrowth::Unknown, symbol)?;
        let turn = std::f64::consts::TAU;
        for (kx, ky) in [(0, 0), (1, 0), (1, 1), (1, -1), (nx as i32 / 2, 1)] {
            let (mut cosines, mut sines) = (0.0, 0.0);
            for node in 0..grid.nodes() {
                let (ix, iy) = grid.coordinates(node);
                let turns =
                    f64::from(kx) * ix as f64 / nx as f64 + f64::from(ky) * iy as f64 / ny as f64;
                let c = table.coefficient(ix as isize, iy as isize).unwrap_or(f64::NAN);
                cosines += c * (turn * turns).cos();
                sines += c * (turn * turns).sin();
            }
            let (lx, ly) = grid.sides();
            let at = |kx: i32| symbol(turn * f64::from(kx) / lx, turn * f64::from(ky) / ly);
            let expected = if 2 * kx as usize == nx { 0.5 * (at(kx) + at(-kx)) } else { at(kx) };
            // Sums of at most 48 terms below 1.
            assert!((cosines - expected).abs() < 1e-14, "{nx} x {ny}, ({kx}, {ky})");
            assert!(sines.abs() < 1e-14, "{nx} x {ny}, ({kx}, {ky}): {sines}");
        }
    }
    Ok(())
}

#[test]
fn impossible_symbols_are_refused() -> Result<(), Error> {
    let grid = Grid::new(4, 4, 1.0, 1.0)?;
    let make = |mean, symbol: fn(f64, f64) -> f64| {
        KernelTable::from_symbol(grid, mean, ContactGrowth::Unknown, symbol)
    };
    let (arbitrary, physical) = (MeanDisplacement::Arbitrary, MeanDisplacement::Physical);
    // A half-space has no mean displacement of its own, and cannot be said to have one.
    let refused = make(physical, half_space);
    assert!(matches!(
        refused,
        Err(Error::Kernel(KernelError::SymbolNotPositive { q: (0.0, 0.0), value })) if value.is_infinite()
    ));
    assert!(make(arbitrary, half_space).is_ok());
    for bad in [|_, _| f64::NAN, |qx, _| -qx, |_, _| 0.0] as [fn(f64, f64) -> f64; 3] {
        assert!(matches!(
            make(arbitrary, bad),
            Err(Error::Kernel(KernelError::SymbolNotPositive { .. }))
        ));
    }
    assert!(matches!(
        make(physical, |qx, _| 10.0 + qx),
        Err(Error::Kernel(KernelError::SymbolNotEven { .. }))
    ));
    let single = Grid::new(1, 1, 1.0, 1.0)?;
    let unknown = KernelTable::from_symbol(single, arbitrary, ContactGrowth::Unknown, half_space);
    assert!(matches!(unknown, Err(Error::NotPositiveDefinite { .. })));
    Ok(())
}

/// A coefficient that is not that of one period further is found along either direction, and named.
#[test]
fn what_does_not_repeat_is_refused() -> Result<(), Error> {
    let grid = Grid::new(4, 5, 1.0, 1.0)?;
    let make = |odd: (isize, isize)| {
        KernelTable::from_fn(grid, Boundary::Periodic, ContactGrowth::Unknown, move |di, dj| {
            // By distance around the period, but for one offset and its opposite.
            let (x, y) = (di.rem_euclid(4), dj.rem_euclid(5));
            let (x, y) = (x.min(4 - x) as f64, y.min(5 - y) as f64);
            let wrong = (di, dj) == odd || (-di, -dj) == odd;
            if wrong { 0.3 } else { 1.0 / (1.0 + x + 2.0 * y) }
        })
    };
    assert!(make((9, 9)).is_ok());
    for (odd, period) in [((0, 3), (0, 5)), ((3, 0), (4, 0)), ((0, -1), (0, 5))] {
        let made = make(odd);
        assert!(made.is_err(), "{odd:?}");
        let Err(Error::Kernel(KernelError::NotPeriodic {
            di,
            dj,
            image_di,
            image_dj,
            value,
            repeated,
        })) = made
        else {
            return made.map(drop);
        };
        assert_eq!((image_di - di, image_dj - dj), period);
        let named = [(di, dj), (image_di, image_dj)];
        let opposite = (-odd.0, -odd.1);
        assert!(named.contains(&odd) || named.contains(&opposite), "{named:?}");
        assert!(value == 0.3 || repeated == 0.3);
    }
    Ok(())
}

/// A promise of convex gaps holds from a least gauge on. The symbol is one over the square root of the discrete
/// Laplacian, whose inverse has no element off the diagonal that is not negative.
#[test]
fn a_convex_promise_holds_in_the_gauge_of_its_table() -> Result<(), Error> {
    for (nx, ny) in [(8, 8), (9, 6), (24, 3)] {
        let grid = Grid::new(nx, ny, 1.0, 1.0)?;
        let symbol = |qx: f64, qy: f64| (4.0 - 2.0 * qx.cos() - 2.0 * qy.cos()).sqrt().recip();
        let mean = MeanDisplacement::Arbitrary;
        let table = KernelTable::from_symbol(grid, mean, ContactGrowth::Convex, symbol)?;
        let greatest = |table: &KernelTable| {
            let nodes: Vec<_> =
                (0..ny as isize).flat_map(|y| (0..nx as isize).map(move |x| (x, y))).collect();
            let matrix = nalgebra::DMatrix::from_fn(nodes.len(), nodes.len(), |i, j| {
                let (a, b) = (nodes[i], nodes[j]);
                table.coefficient(a.0 - b.0, a.1 - b.1).unwrap_or(f64::NAN)
            });
            let inverse = matrix.try_inverse().unwrap_or_default();
            (1..nodes.len()).map(|j| inverse[(0, j)]).fold(f64::NEG_INFINITY, f64::max)
        };
        assert!(greatest(&table) < 0.0, "{nx} x {ny}");
        // 2 % above the least, where the greatest is none to rounding.
        let least = table.in_gauge(table.gauge().unwrap_or_default() / 1.02);
        assert!(greatest(&least).abs() < 1e-13, "{nx} x {ny}: {:e}", greatest(&least));
    }
    Ok(())
}

/// On strips of an even number of nodes the inverse of 1/q is zero at even distances, and negative by rounding at best:
/// the gauge is that of any other promise, and no gauge of 10¹³ times the coefficients, of which a convex promise is not
/// kept.
#[test]
fn no_gauge_is_made_of_rounding() -> Result<(), Error> {
    for n in [4, 118, 178, 206, 746] {
        let grid = Grid::new(1, n, 1.0, 1.0)?;
        let made = |growth: ContactGrowth| {
            let symbol = |qx: f64, qy: f64| 2.0 / qx.hypot(qy);
            KernelTable::from_symbol(grid, MeanDisplacement::Arbitrary, growth, symbol)
        };
        let (found, expected) = (made(ContactGrowth::Convex)?, made(ContactGrowth::Unknown)?);
        assert_eq!(found.values, expected.values, "{n}");
        // On one of these rounding makes a least gauge.
        assert!(n != 118 || found.growth == ContactGrowth::Monotone);
    }
    Ok(())
}

/// An inverse Fourier transform rounds small coefficients as it does the greatest.
#[test]
fn coefficients_may_be_off_by_rounding_of_the_greatest() -> Result<(), Error> {
    let grid = Grid::new(5, 4, 1.0, 1.0)?;
    let make = |error: f64| {
        KernelTable::from_fn(grid, Boundary::Free, ContactGrowth::Unknown, move |di, dj| {
            let value = 1e-3 / (1.0 + (di * di + dj * dj) as f64);
            if (di, dj) == (0, 0) { 1.0 } else { value + if di > 0 { error } else { 0.0 } }
        })
    };
    assert!(make(1e-15).is_ok());
    assert!(matches!(make(1e-13), Err(Error::Kernel(KernelError::NotSymmetric { .. }))));
    Ok(())
}
