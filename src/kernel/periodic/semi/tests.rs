use nalgebra::DMatrix;

use super::*;
use crate::kernel::{Boussinesq, KernelTable, check};

/// Long cells and short ones, grids of one row, and grids that are much longer than wide.
fn grids() -> Result<Vec<Grid>, Error> {
    let shapes = [
        (8, 6, 1.0, 1.5),
        (9, 5, 4.0, 1.0),
        (6, 12, 1.0, 10.0),
        (1, 7, 1.0, 1.0),
        (5, 1, 2.0, 1.0),
        (3, 40, 1e-6, 1e-6),
    ];
    let made = shapes.map(|(nx, ny, dx, dy)| Ok(Grid::new(nx, ny, dx, dy)?));
    made.into_iter().collect()
}

/// The sum over 2N + 1 images of Love's coefficient, and what is left of it for N to infinity.
///
/// Far from a cell, at (k L + x, y), 1/r for k and −k add up to 2/(k L) (1 + ρ² P₂/(k L)² + …), ρ² P₂ = x² − y²/2,
/// averaged over the cell. With n = N + ½ the sums of 1/k and 1/k³ beyond N, less that of the logarithm, are −1/(24 n²)
/// and 1/(2 n²), up to n⁻⁴.
#[test]
fn images_add_up() -> Result<(), Error> {
    const N: isize = 3000;
    let e_star = 2.0;
    for grid in grids()? {
        let love = Boussinesq::new(grid, e_star)?;
        let (nx, ny) = grid.shape();
        for along in [Axis::X, Axis::Y] {
            let kernel = SemiPeriodicBoussinesq::new(grid, e_star, along)?;
            let ((step_x, step_y), side) = match along {
                Axis::X => ((nx as isize, 0), grid.sides().0),
                Axis::Y => ((0, ny as isize), grid.sides().1),
            };
            let unit = 2.0 * grid.cell_area() / (PI * e_star * side);
            let n = N as f64 + 0.5;
            let length = 2.0 * n * side;
            let own = kernel.coefficient(0, 0);
            for (di, dj) in (0..nx).flat_map(|di| (0..ny).map(move |dj| (di, dj))) {
                let (di, dj) = (di as isize, dj as isize);
                // Small terms first.
                let mut sum = 0.0;
                for k in (1..=N).rev() {
                    sum += love.coefficient(di + k * step_x, dj + k * step_y);
                    sum += love.coefficient(di - k * step_x, dj - k * step_y);
                }
                sum += love.coefficient(di, dj);
                let x2 = (di as f64 * grid.dx()).powi(2) + grid.dx().powi(2) / 12.0;
                let y2 = (dj as f64 * grid.dy()).powi(2) + grid.dy().powi(2) / 12.0;
                let second = match along {
                    Axis::X => x2 - 0.5 * y2,
                    Axis::Y => y2 - 0.5 * x2,
                };
                let rest = (0.5 * second / (side * side) - 1.0 / 24.0) / (n * n);
                let expected = sum + unit * (rest - libm::log(length / kernel.reference_length()));
                let found = kernel.coefficient(di, dj);
                // Roundings of 6000 terms, some 10⁻¹⁴; orders n⁻⁴ = 10⁻¹⁴ of the width over the period to the fourth,
                // at most 120⁴ here where a row of one cell repeats.
                let ratio = (x2 + y2) / (side * side);
                let tolerance = 2e-14 + ratio * ratio * unit / own / n.powi(4);
                let error = (found - expected).abs() / own;
                assert!(error < tolerance, "{grid:?} {along:?} ({di}, {dj}): {error:e}");
            }
        }
    }
    Ok(())
}

/// With a long period images are far: differences of coefficients are Love's.
#[test]
fn with_a_long_period_it_is_free() -> Result<(), Error> {
    for nx in [64, 256, 1024] {
        let grid = Grid::new(nx, 4, 1.0, 1.0)?;
        let kernel = SemiPeriodicBoussinesq::new(grid, 1.0, Axis::X)?;
        let love = Boussinesq::new(grid, 1.0)?;
        for (di, dj) in [(1, 0), (0, 1), (3, 3), (0, 3)] {
            let found = kernel.coefficient(0, 0) - kernel.coefficient(di, dj);
            let expected = love.coefficient(0, 0) - love.coefficient(di, dj);
            // 2 A/(π L) Σ ρ² |P₂| / (k L)², with Σ k⁻³ = 1.202.
            let square = (di * di + dj * dj) as f64;
            let bound = 2.0 / (PI * nx as f64) * 1.21 * square / (nx * nx) as f64;
            let error = (found - expected).abs();
            assert!(error < bound + 1e-14, "{nx} ({di}, {dj}): {error:e} {bound:e}");
        }
    }
    Ok(())
}

/// Cells across that are short beside the period: five periods are more nodes than a grid can have.
#[test]
fn long_periods_of_short_cells() -> Result<(), Error> {
    let e_star = 1e11;
    let kernel = SemiPeriodicBoussinesq::new(Grid::new(700, 1, 1e-5, 1e-6)?, e_star, Axis::X)?;
    let love = Boussinesq::new(kernel.grid(), e_star)?;
    let sum = |di: isize| {
        let images = (1..=300).rev().map(|k| 700 * k);
        let far = images.map(|at| love.coefficient(di + at, 0) + love.coefficient(di - at, 0));
        far.sum::<f64>() + love.coefficient(di, 0)
    };
    let own = kernel.coefficient(0, 0);
    for di in [1, 7, 350] {
        let found = own - kernel.coefficient(di, 0);
        // 2 A/(π E* k L) x²/(k L)² of both neighbours beyond, with Σ k⁻³ = 1/(2 × 300.5²).
        let x = di as f64 / 700.0;
        let beyond = 2.0 * 1e-11 / (PI * e_star * 7e-3) * x * x / (2.0 * 300.5 * 300.5);
        let error = (found - (sum(0) - sum(di) - beyond)).abs() / own;
        // Roundings of 600 terms.
        assert!(error < 2e-14, "{di}: {error:e}");
    }
    Ok(())
}

/// Waves along the period do not feel the images across of the periodic kernel, beyond exp(−2π × 6) = 4 × 10⁻¹⁷ of
/// them.
#[test]
fn waves_are_those_of_the_periodic_kernel() -> Result<(), Error> {
    let (nx, ny) = (8, 96);
    let grid = Grid::new(nx, ny, 1.0, 1.0)?;
    let kernel = SemiPeriodicBoussinesq::new(grid, 1.0, Axis::X)?;
    let periodic = PeriodicBoussinesq::new(grid, 1.0)?;
    for wave in 1..=nx / 2 {
        for dj in 0..=ny / 2 {
            let answer = |kernel: &dyn InfluenceKernel| -> f64 {
                let terms = (0..nx).map(|di| {
                    let turn = (wave * di) as f64 / nx as f64;
                    kernel.coefficient(di as isize, dj as isize) * libm::cos(2.0 * PI * turn)
                });
                terms.sum()
            };
            let error = (answer(&kernel) - answer(&periodic)).abs();
            // Rounding of eight terms near 1.
            assert!(error < 1e-14, "{wave} {dj}: {error:e}");
        }
    }
    Ok(())
}

/// The inverse of the whole matrix has no positive element off the diagonal, and no negative row sum.
#[test]
fn it_is_an_inverse_m_matrix() -> Result<(), Error> {
    for (nx, ny, dx, dy) in [
        (2, 1, 1.0, 1.0),
        (1, 2, 1.0, 1.0),
        (1, 80, 1.0, 1.0),
        (2, 2, 1.0, 1.0),
        (20, 20, 1.0, 1.0),
        (4, 90, 1.0, 1.0),
        (90, 4, 1.0, 1.0),
        (40, 1, 1.0, 1.0),
        (12, 12, 10.0, 1.0),
        (12, 12, 1.0, 10.0),
        (10, 10, 100.0, 1.0),
        (10, 10, 1.0, 100.0),
        (6, 6, 1.0, 900.0),
        (6, 6, 900.0, 1.0),
    ] {
        let grid = Grid::new(nx, ny, dx, dy)?;
        for along in [Axis::X, Axis::Y] {
            let kernel = SemiPeriodicBoussinesq::new(grid, 1.0, along)?;
            let table = KernelTable::new(&kernel)?;
            let places: Vec<usize> = (0..grid.nodes()).map(|node| table.place(node)).collect();
            let nodes = grid.nodes();
            let matrix = DMatrix::from_fn(nodes, nodes, |i, j| table.between(places[i], places[j]));
            let Some(factor) = matrix.cholesky() else {
                return Err(Error::NotPositiveDefinite { ix: 0, iy: 0, approach: 0.0, pivot: 0.0 });
            };
            let inverse = factor.inverse();
            let most = inverse.amax();
            for i in 0..nodes {
                let sum: f64 = inverse.row(i).sum();
                assert!(sum > 0.0, "{grid:?} {along:?} {i}: {sum:e}");
                for j in 0..i {
                    // Rounding of an inverse, whose condition number is up to 10⁵ here.
                    assert!(inverse[(i, j)] < 1e-12 * most, "{grid:?} {along:?} ({i}, {j})");
                }
            }
            if nodes <= 144 {
                check(&kernel)?;
            }
        }
    }
    Ok(())
}

#[test]
fn bad_half_spaces_are_refused() -> Result<(), Error> {
    let grid = Grid::new(4, 4, 1.0, 1.0)?;
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let made = SemiPeriodicBoussinesq::new(grid, bad, Axis::X);
        assert!(matches!(made, Err(Error::NotPositive { .. })), "{made:?}");
    }
    // 32768 × (1 + 5 × 32768) nodes.
    let wide = SemiPeriodicBoussinesq::new(Grid::new(1, 32768, 1.0, 1.0)?, 1.0, Axis::Y);
    assert!(matches!(wide, Err(Error::OutOfRange { value, .. }) if value > 5e9), "{wide:?}");
    let long = Grid::new(4, 4, 1e4, 1.0)?;
    for along in [Axis::X, Axis::Y] {
        let made = SemiPeriodicBoussinesq::new(long, 1.0, along);
        assert!(matches!(made, Err(Error::OutOfRange { value: 1e4, .. })), "{made:?}");
        let kernel = SemiPeriodicBoussinesq::new(grid, 3.0, along)?;
        assert_eq!((kernel.e_star(), kernel.along()), (3.0, along));
        let beyond = match along {
            Axis::X => kernel.coefficient(0, 4),
            Axis::Y => kernel.coefficient(-4, 0),
        };
        assert!(beyond.is_nan());
    }
    Ok(())
}
