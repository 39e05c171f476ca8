//! Half-spaces that repeat in one direction, beside ContactMechanics.

use asperity::convolution::{Convolution, direct_sum};
use asperity::kernel::{KernelTable, SemiPeriodicBoussinesq};
use asperity::surface::Axis;
use asperity::{Boundary, Error, Grid, InfluenceKernel, KernelError};
use nalgebra::DMatrix;

/// It sums up the images −N … N, as a row of the length ℓ = (2N + 1) L: less the logarithm of ℓ/R this is the kernel,
/// up to what the images beyond do to the shape, of the order (d/ℓ)².
#[test]
fn the_sums_of_contact_mechanics() {
    let text = include_str!("../data/semi_periodic.csv");
    let mut lines = 0;
    for line in text.lines().skip(1) {
        let numbers: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let [nx, ny, lx, ly, e_star, images, di, dj, expected] = numbers[..] else {
            panic!("{line}");
        };
        let grid = Grid::with_sides(nx as usize, ny as usize, lx, ly).unwrap();
        let kernel = SemiPeriodicBoussinesq::new(grid, e_star, Axis::Y).unwrap();
        let length = (2.0 * images + 1.0) * ly;
        let unit = 2.0 * grid.cell_area() / (std::f64::consts::PI * e_star * ly);
        let found = kernel.coefficient(di as isize, dj as isize)
            + unit * (length / kernel.reference_length()).ln();
        // Terms of second order: the curvature of the images beyond, and 1/24 of the sum of 1/k against the logarithm.
        // Its images lie evenly around the nearest one.
        let (x2, y2) = ((di * grid.dx()).powi(2), (dj.min(ny - dj) * grid.dy()).powi(2));
        let n = images + 0.5;
        let second = (0.5 * (y2 - 0.5 * x2) / (ly * ly) - 1.0 / 24.0) / (n * n);
        let cells = (grid.dx().powi(2) + grid.dy().powi(2)) / (24.0 * ly * ly * n * n);
        let fourth = (1.0 + (x2 + y2) / (ly * ly)).powi(2) / n.powi(4);
        let error = (found - expected - unit * second).abs();
        // What the size of a cell adds to the curvature, fourth order, and rounding: its formula of a rectangle loses
        // as many digits as the images are cells away, three.
        assert!(error < unit * (cells + fourth + 1e-12), "{line}: {error:e}");
        lines += 1;
    }
    assert_eq!(lines, 28);
}

/// Along the period nothing is padded, across it all is.
#[test]
fn convolutions_are_sums() -> Result<(), Error> {
    for (nx, ny) in [(8, 6), (7, 9), (1, 5), (6, 1), (12, 5)] {
        let grid = Grid::new(nx, ny, 1.0, 1.3)?;
        for along in [Axis::X, Axis::Y] {
            let kernel = SemiPeriodicBoussinesq::new(grid, 1.0, along)?;
            let pressure = DMatrix::from_fn(nx, ny, |ix, iy| ((3 * ix + 7 * iy) % 11) as f64);
            let expected = direct_sum(&kernel, &pressure)?;
            let mut found = DMatrix::zeros(nx, ny);
            Convolution::new(&kernel)?.apply(pressure.as_slice(), found.as_mut_slice())?;
            // A Fourier transform of some hundred values of up to 10.
            assert!((&found - &expected).amax() < 1e-14 * expected.amax(), "{nx} x {ny} {along:?}");
            // Shifted along the period everything is the same.
            let moved = DMatrix::from_fn(nx, ny, |ix, iy| match along {
                Axis::X => pressure[((ix + 1) % nx, iy)],
                Axis::Y => pressure[(ix, (iy + 1) % ny)],
            });
            let displacement = direct_sum(&kernel, &moved)?;
            for (ix, iy) in (0..nx).flat_map(|ix| (0..ny).map(move |iy| (ix, iy))) {
                let from = match along {
                    Axis::X => ((ix + 1) % nx, iy),
                    Axis::Y => (ix, (iy + 1) % ny),
                };
                let error = displacement[(ix, iy)] - expected[from];
                assert!(error.abs() < 1e-14 * expected.amax());
            }
        }
    }
    Ok(())
}

/// A table that repeats along one direction is checked there, and not along the other.
#[test]
fn coefficients_that_do_not_repeat_are_refused() -> Result<(), Error> {
    let grid = Grid::new(6, 4, 1.0, 1.0)?;
    let kernel = SemiPeriodicBoussinesq::new(grid, 1.0, Axis::X)?;
    let table = |boundary| {
        let growth = kernel.contact_growth();
        KernelTable::from_fn(grid, boundary, growth, |di, dj| kernel.coefficient(di, dj))
    };
    let made = table(Boundary::PeriodicX)?;
    assert_eq!((made.boundary(), made.gauge()), (Boundary::PeriodicX, None));
    for boundary in [Boundary::PeriodicY, Boundary::Periodic] {
        let refused = table(boundary);
        assert!(matches!(refused, Err(Error::Kernel(KernelError::NotPeriodic { .. }))));
    }
    Ok(())
}
