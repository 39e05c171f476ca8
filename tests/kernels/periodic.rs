//! Periodic kernels through the public interface: gauges, inverses, symmetry, errors.

use asperity::kernel::KernelTable;
use asperity::{Boundary, Error, Grid, InfluenceKernel, KernelError, PeriodicBoussinesq, Spectral};
use asperity_testing::dense::influence_matrix;
use nalgebra::DMatrix;

/// The greatest element off the diagonal of the inverse, and the least row sum.
fn signs_of_inverse(kernel: &impl InfluenceKernel) -> Result<(f64, f64), Error> {
    let matrix = influence_matrix(kernel);
    let Some(inverse) = matrix.try_inverse() else {
        return Ok((f64::NAN, f64::NAN));
    };
    let mut off_diagonal = f64::NEG_INFINITY;
    for (i, row) in inverse.row_iter().enumerate() {
        for (j, &value) in row.iter().enumerate() {
            if i != j {
                off_diagonal = off_diagonal.max(value);
            }
        }
    }
    let row_sum = inverse.column_sum().min();
    Ok((off_diagonal, row_sum))
}

const GRIDS: [(usize, usize, f64, f64); 5] =
    [(8, 8, 1.0, 1.0), (9, 7, 1.0, 1.0), (12, 10, 1.0, 1.4), (16, 4, 1.0, 1.0), (5, 6, 1.0, 4.0)];

#[test]
fn love_is_an_inverse_m_matrix_from_the_least_gauge_on() -> Result<(), Error> {
    for (nx, ny, dx, dy) in GRIDS {
        let kernel = PeriodicBoussinesq::new(Grid::new(nx, ny, dx, dy)?, 1.0)?;
        let least = kernel.least_gauge().unwrap_or(f64::NAN);
        assert!((kernel.gauge() / least - 1.02).abs() < 1e-12, "{nx} x {ny}: {least}");
        let (off_diagonal, row_sum) = signs_of_inverse(&kernel)?;
        assert!(off_diagonal < 0.0, "{nx} x {ny}: {off_diagonal:e}");
        assert!(row_sum > 0.0, "{nx} x {ny}: {row_sum:e}");
        // At the least gauge itself the greatest is zero: rounding of an inverse whose elements are
        // of order 1, with a condition number below 100.
        let (off_diagonal, _) = signs_of_inverse(&kernel.clone().with_gauge(least)?)?;
        assert!(off_diagonal.abs() < 1e-13, "{nx} x {ny}: {off_diagonal:e}");
        let (off_diagonal, row_sum) = signs_of_inverse(&kernel.with_gauge(0.98 * least)?)?;
        assert!(off_diagonal > 1e-13, "{nx} x {ny}: {off_diagonal:e}");
        assert!(row_sum > 0.0, "{nx} x {ny}: {row_sum:e}");
    }
    Ok(())
}

#[test]
fn the_spectral_kernel_is_not_in_any_gauge() -> Result<(), Error> {
    for (nx, ny, dx, dy) in GRIDS {
        let kernel = Spectral::new(Grid::new(nx, ny, dx, dy)?, 1.0)?;
        assert_eq!(kernel.least_gauge(), None);
        for factor in [1.0, 1e4] {
            let moved = kernel.clone().with_gauge(factor * kernel.gauge())?;
            let (off_diagonal, row_sum) = signs_of_inverse(&moved)?;
            assert!(off_diagonal > 1e-3, "{nx} x {ny}: {off_diagonal:e}");
            assert!(row_sum > 0.0);
        }
    }
    // Two cells away on the axis, in units of the diagonal, in any gauge that is large.
    let kernel = Spectral::new(Grid::new(24, 24, 1.0, 1.0)?, 1.0)?.with_gauge(1e6)?;
    let inverse = influence_matrix(&kernel).try_inverse().unwrap();
    // 2.12 % on large grids, 2.7 % on 8 × 8.
    let ratio = inverse[(2, 0)] / inverse[(0, 0)];
    assert!((ratio - 0.0212).abs() < 1e-3, "{ratio}");
    Ok(())
}

#[test]
fn pressures_and_gaps_do_not_depend_on_the_gauge() -> Result<(), Error> {
    // Contact of some nodes of a rough surface under a given total pressure, in two gauges.
    let grid = Grid::new(9, 7, 1.0, 1.3)?;
    let kernel = PeriodicBoussinesq::new(grid, 1.0)?;
    let contact: Vec<usize> = (0..grid.nodes()).filter(|node| node * node % 7 < 3).collect();
    let gap = DMatrix::from_fn(grid.nodes(), 1, |i, _| (i as f64 * 1.7).sin() + 1.0);
    let total = 10.0;
    let mut results = Vec::new();
    for factor in [1.0, 2.0, 30.0] {
        let kernel = kernel.clone().with_gauge(factor * kernel.gauge())?;
        let matrix = influence_matrix(&kernel);
        let own = matrix.select_rows(&contact).select_columns(&contact);
        let inverse = own.try_inverse().unwrap();
        let y1 = -&inverse * gap.select_rows(&contact);
        let y2 = &inverse * DMatrix::repeat(contact.len(), 1, 1.0);
        let approach = (total - y1.sum()) / y2.sum();
        let pressure = y1 + approach * y2;
        let displacement = matrix.select_columns(&contact) * &pressure;
        let gaps = (&gap + displacement).map(|value| value - approach);
        let table = KernelTable::new(&kernel)?;
        let gauge = table.gauge().unwrap_or(f64::NAN);
        results.push((pressure, gaps, approach - gauge * total));
    }
    assert_eq!(results.len(), 3);
    for (pressure, gaps, approach) in &results {
        // A condition number below 100, times 30 for the greatest gauge.
        assert!((pressure - &results[0].0).amax() < 1e-12);
        assert!((gaps - &results[0].1).amax() < 1e-12);
        assert!((approach - results[0].2).abs() < 1e-12);
    }
    Ok(())
}

#[test]
fn spectral_symbol_is_the_formula() -> Result<(), Error> {
    for (nx, ny, dx, dy) in
        [(8, 8, 1.0, 1.0), (9, 6, 2e-6, 3e-6), (1, 5, 1.0, 1.0), (4, 1, 1.0, 7.0)]
    {
        let kernel = Spectral::new(Grid::new(nx, ny, dx, dy)?, 2.5)?;
        assert_eq!(kernel.e_star(), 2.5);
        // 4/5 of the long side over E* and the number of nodes.
        let gauge = 0.8 * (nx as f64 * dx).max(ny as f64 * dy) / (2.5 * (nx * ny) as f64);
        assert!((kernel.gauge() / gauge - 1.0).abs() < 1e-14, "{nx} x {ny}: {}", kernel.gauge());
        // As numpy.fft.fftfreq: from 0 up, then the negative ones up to -1.
        let signed = |k: usize, n: usize| {
            if 2 * k < n { k as f64 } else { k as f64 - n as f64 }
        };
        for ky in 0..ny {
            for kx in 0..nx {
                let qx = std::f64::consts::TAU * signed(kx, nx) / (nx as f64 * dx);
                let qy = std::f64::consts::TAU * signed(ky, ny) / (ny as f64 * dy);
                let q = qx.hypot(qy);
                let expected = if q > 0.0 { 2.0 / (2.5 * q) } else { 0.0 };
                let found = kernel.symbol(kx as isize, ky as isize);
                // A handful of rounding errors on either side.
                assert!((found - expected).abs() <= 2e-15 * expected, "({kx}, {ky}): {found:e}");
            }
        }
    }
    Ok(())
}

#[test]
fn kernels_of_the_two_boundaries_approach_each_other_at_long_waves() -> Result<(), Error> {
    let grid = Grid::new(256, 256, 1.0, 1.0)?;
    let love = PeriodicBoussinesq::new(grid, 1.0)?;
    let spectral = Spectral::new(grid, 1.0)?;
    for (kx, ky) in [(1, 0), (2, 1), (0, 5)] {
        // sinc falls by (π k / n)² / 6, at most 6e-4 here; aliases add (k / n)² with like factors.
        let ratio = love.symbol(kx, ky) / spectral.symbol(kx, ky);
        assert!((ratio - 1.0).abs() < 2e-3, "({kx}, {ky}): {ratio}");
    }
    Ok(())
}

#[test]
fn tables_know_boundary_and_gauge() -> Result<(), Error> {
    for (nx, ny) in [(9, 6), (1, 5), (1, 1), (40, 31)] {
        let grid = Grid::new(nx, ny, 1e-6, 2e-6)?;
        let love = PeriodicBoussinesq::new(grid, 1e9)?;
        let spectral = Spectral::new(grid, 1e9)?;
        let tables = [
            (KernelTable::new(&love)?, love.gauge()),
            (KernelTable::new(&spectral)?, spectral.gauge()),
        ];
        for (table, gauge) in tables {
            assert_eq!(table.boundary(), Boundary::Periodic);
            let found = table.gauge().unwrap_or(f64::NAN);
            // A sum of at most 1240 terms of which the greatest is some 40 times the mean.
            assert!((found / gauge - 1.0).abs() < 1e-13, "{found:e} instead of {gauge:e}");
        }
    }
    let free = asperity::Boussinesq::new(Grid::new(3, 3, 1.0, 1.0)?, 1.0)?;
    let table = KernelTable::new(&free)?;
    assert_eq!((table.boundary(), table.gauge()), (Boundary::Free, None));
    Ok(())
}

/// Love's kernel on an unbounded half-space, wrongly said to be periodic.
struct Mistaken(asperity::Boussinesq);

impl InfluenceKernel for Mistaken {
    fn grid(&self) -> Grid {
        self.0.grid()
    }
    fn boundary(&self) -> Boundary {
        Boundary::Periodic
    }
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        self.0.coefficient(di, dj)
    }
}

#[test]
fn a_kernel_that_does_not_repeat_is_refused() -> Result<(), Error> {
    let kernel = Mistaken(asperity::Boussinesq::new(Grid::new(4, 3, 1.0, 1.0)?, 1.0)?);
    let Err(Error::Kernel(KernelError::NotPeriodic {
        di,
        dj,
        value,
        image_di,
        image_dj,
        repeated,
    })) = KernelTable::new(&kernel)
    else {
        return Err(asperity::SurfaceError::EmptyGrid { nx: 4, ny: 3 }.into());
    };
    assert_eq!((di, dj, image_di, image_dj), (-3, -2, 1, -2));
    assert_eq!(value, kernel.coefficient(-3, -2));
    assert_eq!(repeated, kernel.coefficient(1, -2));
    // Nothing repeats on a single node, which every kernel passes.
    let single = Mistaken(asperity::Boussinesq::new(Grid::new(1, 1, 1.0, 1.0)?, 1.0)?);
    assert!(KernelTable::new(&single).is_ok());
    Ok(())
}
