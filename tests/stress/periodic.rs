//! Grids that repeat, beside Fourier series and sums over images.

use std::f64::consts::TAU;

use asperity::stress::Subsurface;
use asperity::{Boundary, Error, Grid, Spectral};
use nalgebra::{Complex, DMatrix};

/// Smooth and uneven.
fn pressure(nx: usize, ny: usize) -> DMatrix<f64> {
    DMatrix::from_fn(nx, ny, |ix, iy| {
        let (x, y) = (ix as f64, iy as f64);
        1.0 + 0.7 * (1.3 * x + 0.2 * y * y).sin() + 0.2 * (x * y).cos()
    })
}

/// xx, yy, zz, yz, xz, xy below a wave of pressure of 1: Airy's function of a plane through the wave, and ν of it
/// across.
fn below_a_wave((qx, qy): (f64, f64), z: f64, nu: f64) -> [Complex<f64>; 6] {
    let q = qx.hypot(qy);
    let (c, s) = (qx / q, qy / q);
    let fades = (-q * z).exp();
    let (along, down) = (-(1.0 - q * z) * fades, -(1.0 + q * z) * fades);
    let across = nu * (along + down);
    let shear = q * z * fades;
    let real = |value: f64| Complex::new(value, 0.0);
    [
        real(along * c * c + across * s * s),
        real(along * s * s + across * c * c),
        real(down),
        Complex::new(0.0, shear * s),
        Complex::new(0.0, shear * c),
        real((along - across) * c * s),
    ]
}

/// The Fourier series of uniform pressures on cells, summed up to waves of which nothing is left at the depth.
fn series(pressure: &DMatrix<f64>, (dx, dy): (f64, f64), z: f64, nu: f64) -> [DMatrix<f64>; 6] {
    let (nx, ny) = pressure.shape();
    let most = 37.0 / z;
    let reach = |n: usize, side: f64| (most * n as f64 * side / TAU).ceil() as i32;
    let mut sums = [(); 6].map(|()| DMatrix::from_element(nx, ny, 0.0));
    let sinc = |x: f64| if x == 0.0 { 1.0 } else { (0.5 * TAU * x).sin() / (0.5 * TAU * x) };
    let (reach_x, reach_y) = (reach(nx, dx), reach(ny, dy));
    for ky in -reach_y..=reach_y {
        for kx in -reach_x..=reach_x {
            let turns = (f64::from(kx) / nx as f64, f64::from(ky) / ny as f64);
            let (qx, qy) = (TAU * turns.0 / dx, TAU * turns.1 / dy);
            if qx.hypot(qy) > most {
                continue;
            }
            let phase = |ix: usize, iy: usize| {
                Complex::new(0.0, TAU * (turns.0 * ix as f64 + turns.1 * iy as f64)).exp()
            };
            let mut amplitude = Complex::new(0.0, 0.0);
            for iy in 0..ny {
                for ix in 0..nx {
                    amplitude += phase(ix, iy).conj() * pressure[(ix, iy)];
                }
            }
            amplitude *= sinc(turns.0) * sinc(turns.1) / (nx * ny) as f64;
            let uniform = -nu / (1.0 - nu);
            let below = if (kx, ky) == (0, 0) {
                [uniform, uniform, -1.0, 0.0, 0.0, 0.0].map(|value| Complex::new(value, 0.0))
            } else {
                below_a_wave((qx, qy), z, nu)
            };
            for (sum, below) in sums.iter_mut().zip(below) {
                for iy in 0..ny {
                    for ix in 0..nx {
                        sum[(ix, iy)] += (amplitude * below * phase(ix, iy)).re;
                    }
                }
            }
        }
    }
    sums
}

/// At depths at which waves are summed, and at shallow ones, which are extrapolated.
#[test]
fn cells_that_repeat_are_fourier_series() -> Result<(), Error> {
    for (shape, sides, nu) in [
        ((6, 5), (1.0, 1.0), 0.3),
        ((4, 6), (1.0, 0.6), 0.0),
        ((1, 4), (0.5, 1.0), 0.5),
        ((3, 1), (1.0, 1.0), -0.3),
    ] {
        let grid = Grid::new(shape.0, shape.1, sides.0, sides.1)?;
        let body = Subsurface::new(grid, Boundary::Periodic, nu)?;
        let pressure = pressure(shape.0, shape.1);
        for z in [0.5, 0.9, 1.0, 3.0, 40.0] {
            let found = body.at_depth(&pressure, z)?;
            let expected = series(&pressure, sides, z, nu);
            for (c, (found, expected)) in found.components().into_iter().zip(&expected).enumerate()
            {
                // What is extrapolated errs by 10⁻¹², and its weights of up to 1023 times roundings by some 10⁻¹³ for
                // each of up to 400 terms.
                let error = (found - expected).amax();
                assert!(error < 1e-11, "{shape:?} {nu} {z} {c}: {error:e}");
            }
        }
    }
    Ok(())
}

/// With a kernel of the waves of the grid alone, a wave answers as Westergaard's: at the depth z, with −(1 − q z) e^(−q
/// z) along it.
#[test]
fn waves_of_the_grid() -> Result<(), Error> {
    let (n, nu, z) = (12, 0.3, 0.4);
    let kernel = Spectral::new(Grid::square(n, 12.0)?, 1.0)?;
    let body = Subsurface::of(&kernel, nu)?;
    for (kx, ky) in [(1, 0), (0, 2), (3, 1), (5, 4)] {
        let (qx, qy) = (TAU * f64::from(kx) / n as f64, TAU * f64::from(ky) / n as f64);
        let phase = |ix: usize, iy: usize| qx * ix as f64 + qy * iy as f64;
        let pressure = DMatrix::from_fn(n, n, |ix, iy| phase(ix, iy).cos());
        let found = body.at_depth(&pressure, z)?;
        for (field, below) in found.components().into_iter().zip(below_a_wave((qx, qy), z, nu)) {
            let expected = DMatrix::from_fn(n, n, |ix, iy| {
                (below * Complex::new(0.0, phase(ix, iy)).exp()).re
            });
            // Rounding of a transform.
            assert!((field - expected).amax() < 1e-14, "({kx}, {ky})");
        }
    }
    Ok(())
}

/// One side repeats: sums over more and more images, extrapolated to all of them.
#[test]
fn one_side_that_repeats_is_a_sum_over_images() -> Result<(), Error> {
    let (nx, ny, nu) = (6, 5, 0.3);
    let load = pressure(nx, ny);
    for sides in [(1.0, 1.0), (1.0, 0.7)] {
        let body = Subsurface::new(Grid::new(nx, ny, sides.0, sides.1)?, Boundary::PeriodicX, nu)?;
        for z in [0.0, 0.4, 2.0] {
            // With m images on either side the error goes with powers of 1/(m + 1/2).
            let with_images = |m: usize| -> Result<Vec<DMatrix<f64>>, Error> {
                let long = nx * (2 * m + 1);
                let grid = Grid::new(long, ny, sides.0, sides.1)?;
                let tiled = DMatrix::from_fn(long, ny, |ix, iy| load[(ix % nx, iy)]);
                let found = Subsurface::new(grid, Boundary::Free, nu)?.at_depth(&tiled, z)?;
                let middle = |field: &DMatrix<f64>| field.rows(m * nx, nx).into_owned();
                Ok(found.components().map(middle).into())
            };
            let counts = [7, 22, 67, 202];
            let mut sums = counts.map(with_images).into_iter().collect::<Result<Vec<_>, _>>()?;
            // (m + 1/2) grows by 3 each time.
            for power in 1..counts.len() {
                let ratio = 3.0_f64.powi(power as i32);
                for k in 0..counts.len() - power {
                    let finer = sums[k + 1].clone();
                    for (coarse, fine) in sums[k].iter_mut().zip(&finer) {
                        *coarse = (ratio * fine - &*coarse) / (ratio - 1.0);
                    }
                }
            }
            let found = body.at_depth(&load, z)?;
            for (c, (field, expected)) in found.components().into_iter().zip(&sums[0]).enumerate() {
                // What the fourth power leaves: 1/(7.5 × 22.5 × 67.5 × 202.5) of the terms, which are below 10.
                let error = (field - expected).amax();
                assert!(error < 1e-6, "{sides:?} {z} {c}: {error:e}");
            }
        }
    }
    Ok(())
}

/// x and y are exchanged.
#[test]
fn the_other_side_that_repeats() -> Result<(), Error> {
    let (nx, ny, nu) = (6, 5, 0.3);
    let load = pressure(nx, ny);
    let along_x = Subsurface::new(Grid::new(nx, ny, 1.0, 0.7)?, Boundary::PeriodicX, nu)?;
    let along_y = Subsurface::new(Grid::new(ny, nx, 0.7, 1.0)?, Boundary::PeriodicY, nu)?;
    for z in [0.2, 1.5] {
        let x = along_x.clone().sliding(0.4, 0.3)?.at_depth(&load, z)?;
        let angle = std::f64::consts::FRAC_PI_2 - 0.3;
        let y = along_y.clone().sliding(0.4, angle)?.at_depth(&load.transpose(), z)?;
        for (a, b) in [
            (&x.xx, &y.yy),
            (&x.yy, &y.xx),
            (&x.zz, &y.zz),
            (&x.yz, &y.xz),
            (&x.xz, &y.yz),
            (&x.xy, &y.xy),
        ] {
            // Rounding of sums of thirty responses, extrapolated ones with weights of up to 1023.
            assert!((a.transpose() - b).amax() < 1e-12);
        }
    }
    Ok(())
}
