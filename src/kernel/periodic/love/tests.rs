//! The periodised cell against sums over aliases, closed forms, and tables.

use std::f64::consts::PI;

use super::*;

/// The sum over aliases for E* = 1 itself, accelerated.
///
/// On each side of m = 0, and along either axis, the aliases alternate in sign and fall off
/// monotonically: Cohen, Villegas and Zagier's weights (Exp. Math. 9 (2000) 3, algorithm 1) sum them
/// with an error of 5.8⁻ⁿ for n terms.
fn alias_sum(grid: &Grid, kx: usize, ky: usize) -> f64 {
    let weights = alternating_weights::<26>();
    // (Q / 2π, weight × sinc) of all aliases along one axis.
    let axis = |k: usize, n: usize, spacing: f64| -> Vec<(f64, f64)> {
        if k == 0 {
            return vec![(0.0, 1.0)];
        }
        let kappa = k as f64 / n as f64;
        let sine = (PI * kappa).sin() / PI;
        [kappa, 1.0 - kappa]
            .into_iter()
            .flat_map(|first| {
                weights.iter().enumerate().map(move |(m, weight)| {
                    let wave = first + m as f64;
                    (wave / spacing, weight * sine / wave)
                })
            })
            .collect()
    };
    let along_y = axis(ky, grid.ny(), grid.dy());
    let mut sum = 0.0;
    for (qx, x) in axis(kx, grid.nx(), grid.dx()) {
        sum += x * along_y.iter().map(|(qy, y)| y / qx.hypot(*qy)).sum::<f64>();
    }
    sum / PI
}

/// Weights, with alternating signs, of the first N terms of an alternating series.
fn alternating_weights<const N: usize>() -> [f64; N] {
    let n = N as f64;
    let d = (3.0 + 8.0_f64.sqrt()).powi(N as i32);
    let d = 0.5 * (d + 1.0 / d);
    let (mut b, mut c) = (-1.0, -d);
    std::array::from_fn(|k| {
        let k = k as f64;
        c = b - c;
        b *= (k + n) * (k - n) / ((k + 0.5) * (k + 1.0));
        c / d
    })
}

fn kernel(nx: usize, ny: usize, dx: f64, dy: f64) -> Result<PeriodicBoussinesq, Error> {
    PeriodicBoussinesq::new(Grid::new(nx, ny, dx, dy)?, 1.0)
}

#[track_caller]
fn assert_close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(
        error <= tolerance * expected.abs(),
        "{what}: {found:e} instead of {expected:e}, relative error {:e}",
        error / expected.abs()
    );
}

#[test]
fn symbol_is_the_sum_over_aliases() -> Result<(), Error> {
    let shapes = [
        (8, 8, 1.0, 1.0),
        (8, 6, 1.0, 1.5),
        (9, 7, 1.0, 1.0),
        (12, 10, 0.7, 1.1),
        (8, 8, 4.0, 1.0),
        (7, 16, 1.0, 4.0),
        (1, 16, 1.0, 1.0),
        (5, 1, 2.0, 1.0),
        (2, 3, 1.0, 1.0),
        (64, 31, 1.0, 1.0),
        (12, 9, 20.0, 1.0),
        (6, 8, 1.0, 100.0),
        (6, 8, 1.0, 1000.0),
    ];
    for (nx, ny, dx, dy) in shapes {
        let kernel = kernel(nx, ny, dx, dy)?;
        let aspect = (dx / dy).max(dy / dx);
        let mut worst = 0.0_f64;
        for ky in 0..=ny / 2 {
            for kx in 0..=nx / 2 {
                if (kx, ky) == (0, 0) {
                    continue;
                }
                let exact = alias_sum(&kernel.grid(), kx, ky);
                let found = kernel.symbol(kx as isize, ky as isize);
                worst = worst.max((found / exact - 1.0).abs());
            }
        }
        // All of S together is 4.5 D; the smallest symbol is about 0.6 short sides. Measured, with
        // the sum's own rounding: 1.6e-15 up to 4 : 1, 6e-15 at 20 : 1, 3e-13 at 1000 : 1.
        assert!(worst < 5e-16 * aspect.max(8.0), "{nx} x {ny}, {dx} x {dy}: {worst:e}");
    }
    Ok(())
}

#[test]
fn half_the_waves_along_an_axis_is_catalan() -> Result<(), Error> {
    const CATALAN: f64 = 0.915_965_594_177_219;
    for n in [2, 8, 30, 256] {
        let e_star = 3e9;
        let d = 1e-6;
        let kernel = PeriodicBoussinesq::new(Grid::new(n, 3, d, d)?, e_star)?;
        let found = e_star * kernel.symbol(n as isize / 2, 0) / d;
        // Some 30 rounding errors of a sum of 4.5 in terms of 0.74, most of them far smaller.
        assert_close(found, 8.0 * CATALAN / (PI * PI), 1e-14, "8 G / π²");
    }
    Ok(())
}

#[test]
fn tabulated_values() -> Result<(), Error> {
    // From 80-bit sums over aliases with Euler averaging.
    let square = kernel(8, 8, 1.0, 1.0)?;
    let rectangle = kernel(8, 6, 1.0, 1.5)?;
    let symbols = [
        (&square, 1, 0, 2.499_613_580_219_105_7),
        (&square, 4, 0, 0.742_453_745_421_544_3),
        (&square, 1, 1, 1.745_061_255_342_193),
        (&square, 4, 4, 0.580_693_127_908_502),
        (&rectangle, 1, 0, 2.499_613_580_219_105_7),
        (&rectangle, 0, 1, 2.784_201_545_330_791),
        (&rectangle, 4, 0, 0.742_453_745_421_544_3),
        (&rectangle, 0, 3, 1.113_680_618_132_316_5),
        (&rectangle, 4, 3, 0.676_619_621_918_876),
    ];
    for (kernel, kx, ky, expected) in symbols {
        // As for the sum over aliases.
        assert_close(kernel.symbol(kx, ky), expected, 1e-14, "symbol");
    }
    let coefficients = [
        (0, 0, 0.967_247_073_979_925_5),
        (1, 0, 0.176_902_858_452_887_1),
        (1, 1, 0.078_498_664_511_700_9),
        (4, 0, -0.044_850_088_413_543_6),
        (4, 4, -0.063_849_266_658_708_7),
    ];
    for (di, dj, expected) in coefficients {
        let found = square.coefficient(di, dj) - square.gauge();
        // The table has 16 decimal places, and the transform errs by a few ulps of C(0, 0).
        assert!((found - expected).abs() < 2e-15, "({di}, {dj}): {found}");
    }
    Ok(())
}

#[test]
fn scales_with_cell_and_modulus() -> Result<(), Error> {
    let unit = kernel(9, 4, 1.0, 0.6)?;
    let scaled = PeriodicBoussinesq::new(Grid::new(9, 4, 1e-9, 0.6e-9)?, 1e11)?;
    for (i, j) in [(0, 1), (3, 0), (4, 2)] {
        // Scales are powers of ten and round.
        assert_close(scaled.symbol(i, j), 1e-20 * unit.symbol(i, j), 1e-15, "symbol");
        let expected = 1e-20 * unit.coefficient(i, j);
        assert_close(scaled.coefficient(i, j), expected, 1e-14, "coefficient");
    }
    assert_close(scaled.gauge(), 1e-20 * unit.gauge(), 1e-14, "gauge");
    Ok(())
}

#[test]
fn near_the_cell_it_is_the_free_kernel_and_a_smooth_rest() -> Result<(), Error> {
    // The images of a large grid are far away: between neighbours their contribution is flat.
    let grid = Grid::new(256, 256, 1.0, 1.0)?;
    let periodic = PeriodicBoussinesq::new(grid, 1.0)?;
    let free = crate::Boussinesq::new(grid, 1.0)?;
    let rest = |di, dj| periodic.coefficient(di, dj) - free.coefficient(di, dj);
    for (di, dj) in [(1, 0), (0, 1), (2, 2)] {
        // The rest of the potential varies by (r / L)² of 1 / (π L), about.
        assert!((rest(di, dj) - rest(0, 0)).abs() < 1e-6);
    }
    Ok(())
}

#[test]
fn values_are_even_and_periodic() -> Result<(), Error> {
    let kernel = kernel(9, 6, 1.0, 0.8)?;
    for (i, j) in [(0, 0), (1, 2), (4, 3), (8, 5), (-7, 1)] {
        for (u, v) in [(-i, j), (i, -j), (i + 9, j), (i - 9, j - 6), (i, j + 12)] {
            assert_eq!(kernel.coefficient(u, v), kernel.coefficient(i, j));
            assert_eq!(kernel.symbol(u, v), kernel.symbol(i, j));
        }
    }
    assert_eq!(kernel.symbol(0, 0), 0.0);
    assert_eq!(kernel.boundary(), Boundary::Periodic);
    Ok(())
}

#[test]
fn least_gauges() -> Result<(), Error> {
    // s* M E* / (long side of the grid), to the digits of an independent computation.
    for (nx, ny, expected) in
        [(8, 8, 0.7672), (32, 32, 0.7612), (512, 512, 0.7608), (32, 16, 0.6436)]
    {
        let kernel = kernel(nx, ny, 1.0, 1.0)?;
        let least = kernel.least_gauge().unwrap_or(f64::NAN);
        let found = least * (nx * ny) as f64 / nx as f64;
        assert!((found - expected).abs() < 5.1e-5, "{nx} x {ny}: {found}");
        // The same division in other units.
        assert_close(kernel.gauge(), 1.02 * least, 1e-9, "gauge");
    }
    Ok(())
}

#[test]
fn there_is_a_least_gauge_on_every_grid() -> Result<(), Error> {
    for aspect in [0.01, 0.25, 0.9, 1.0, 2.0, 10.0, 100.0] {
        for (nx, ny) in [(1, 2), (2, 1), (2, 2), (3, 5), (17, 4), (1, 40), (16, 16)] {
            let kernel = kernel(nx, ny, aspect, 1.0)?;
            let least = kernel.least_gauge();
            assert!(least.is_some_and(|s| s > 0.0), "{nx} x {ny}, {aspect} : 1");
        }
    }
    let single = kernel(1, 1, 1.0, 1.0)?;
    assert_eq!(single.least_gauge(), Some(0.0));
    assert!(single.coefficient(0, 0) > 0.0);
    Ok(())
}

#[test]
fn refuses_what_makes_no_sense() -> Result<(), Error> {
    let grid = Grid::new(4, 4, 1.0, 1.0)?;
    for e_star in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(PeriodicBoussinesq::new(grid, e_star), Err(Error::NotPositive { .. })));
    }
    assert!(matches!(
        PeriodicBoussinesq::new(Grid::new(4, 4, 1.0, 1001.0)?, 1.0),
        Err(Error::OutOfRange { .. })
    ));
    // 1000.0000000000001 : 1.
    PeriodicBoussinesq::new(Grid::new(4, 4, 1e-3, 1e-6)?, 1.0)?;
    for gauge in [-1e-3, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            PeriodicBoussinesq::new(grid, 1.0)?.with_gauge(gauge),
            Err(Error::OutOfRange { .. })
        ));
    }
    let moved = PeriodicBoussinesq::new(grid, 1.0)?.with_gauge(0.5)?;
    assert_eq!(moved.gauge(), 0.5);
    Ok(())
}
