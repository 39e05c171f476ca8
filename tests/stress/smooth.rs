//! Smooth contacts: sphere and cylinder, at rest and sliding.

use asperity::stress::{Measure, Subsurface};
use asperity::{Boundary, Error, Grid};
use nalgebra::DMatrix;

use super::hertz;

/// On the axis of a sphere, Johnson (3.45), in units of p₀ and a: radial and axial.
fn on_the_axis(z: f64, nu: f64) -> (f64, f64) {
    let beside = 1.0 / (1.0 + z * z);
    let angle = if z == 0.0 { 0.0 } else { z * (1.0 / z).atan() };
    (-(1.0 + nu) * (1.0 - angle) + 0.5 * beside, -beside)
}

/// Cells average the pressure, which errs with the square of their width: four times less on cells half as wide.
#[test]
fn the_axis_of_a_sphere_converges() -> Result<(), Error> {
    for nu in [0.0, 0.3, 0.5] {
        for z in [0.2, 0.48, 1.0, 2.0] {
            let mut errors = Vec::new();
            for cells in [8, 16, 32] {
                let (grid, pressure) = hertz(cells, cells + 1);
                let body = Subsurface::new(grid, Boundary::Free, nu)?;
                let field = body.at_depth(&pressure, z)?;
                let (radial, axial) = on_the_axis(z, nu);
                let middle = field.at(grid.nodes() / 2).unwrap();
                assert!(middle.xz.abs() < 1e-13 && middle.xy.abs() < 1e-13);
                let error = (middle.xx - radial).hypot(middle.zz - axial);
                errors.push(error.max((middle.yy - radial).hypot(middle.zz - axial)));
            }
            // From the second derivative of the pressure, times the width squared over 24, and from the ring at the
            // edge, where there is none.
            assert!(errors[2] < 1.5e-3, "{nu} {z}: {errors:?}");
            assert!(
                errors[0] > 3.0 * errors[1] && errors[1] > 3.0 * errors[2],
                "{nu} {z}: {errors:?}"
            );
        }
    }
    Ok(())
}

/// The greatest shear lies at 0.481 a on the axis, 0.310 p₀, and von Mises' stress there is 0.620 p₀.
#[test]
fn where_a_sphere_yields() -> Result<(), Error> {
    let (grid, pressure) = hertz(32, 40);
    let body = Subsurface::new(grid, Boundary::Free, 0.3)?;
    let found = body.survey(&pressure, None)?;
    for (measure, expected) in [(Measure::VonMises, 0.620), (Measure::GreatestShear, 0.310)] {
        let greatest = found.greatest(measure);
        assert!((greatest.value - expected).abs() < 1e-3, "{measure:?}: {greatest:?}");
        // A maximum is flat: its place follows from its value with the root of the error.
        assert!((greatest.depth - 0.481).abs() < 0.01, "{measure:?}: {greatest:?}");
        assert_eq!(greatest.node, (40, 40));
    }
    // At the rim of the contact, on the surface, (1 − 2ν)/3 p₀ pulls outwards; beyond, it falls as 1/r².
    let surface = body.at_depth(&pressure, 0.0)?;
    for ix in [76, 78, 80] {
        let r = (ix as f64 - 40.0) / 32.0;
        let expected = 0.4 / 3.0 / (r * r);
        assert!((surface.xx[(ix, 40)] - expected).abs() < 1e-4, "{ix}");
        assert!((surface.yy[(ix, 40)] + expected).abs() < 1e-4, "{ix}");
    }
    Ok(())
}

/// A cylinder, whose pressure repeats along it: Johnson (4.46), and 0.300 p₀ at 0.786 a.
#[test]
fn below_a_cylinder() -> Result<(), Error> {
    let (cells, reach, nu) = (32, 48, 0.3);
    let n = 2 * reach + 1;
    let width = 1.0 / cells as f64;
    // ∫ √(1 − x²) dx.
    let integral = |x: f64| {
        let x = x.clamp(-1.0, 1.0);
        0.5 * (x * (1.0 - x * x).sqrt() + x.asin())
    };
    let of_cell = |i: usize| {
        let x = (i as f64 - reach as f64) * width;
        (integral(x + 0.5 * width) - integral(x - 0.5 * width)) / width
    };
    for along_y in [true, false] {
        let (shape, boundary) =
            if along_y { ((n, 2), Boundary::PeriodicY) } else { ((2, n), Boundary::PeriodicX) };
        let grid = Grid::new(shape.0, shape.1, width, width)?;
        let across = |ix: usize, iy: usize| if along_y { ix } else { iy };
        let pressure = DMatrix::from_fn(shape.0, shape.1, |ix, iy| of_cell(across(ix, iy)));
        let body = Subsurface::new(grid, boundary, nu)?;
        let middle = if along_y { (reach, 0) } else { (0, reach) };
        for z in [0.01, 0.3, 0.786, 2.0] {
            let field = body.at_depth(&pressure, z)?;
            let root = (1.0 + z * z).sqrt();
            let (side, down) = (-((1.0 + 2.0 * z * z) / root - 2.0 * z), -1.0 / root);
            let stress = field.at(grid.index(middle.0, middle.1)).unwrap();
            let (over, along) =
                if along_y { (stress.xx, stress.yy) } else { (stress.yy, stress.xx) };
            // As on the axis of the sphere.
            for (found, expected) in [(over, side), (stress.zz, down), (along, nu * (side + down))]
            {
                assert!((found - expected).abs() < 1e-3, "{along_y} {z}: {found} {expected}");
            }
            assert!(stress.xy.abs() < 1e-12 && stress.xz.abs() < 1e-12 && stress.yz.abs() < 1e-12);
        }
        let found = body.survey(&pressure, None)?.greatest(Measure::GreatestShear);
        assert!((found.value - 0.300).abs() < 1e-3, "{found:?}");
        assert!((found.depth - 0.786).abs() < 0.02, "{found:?}");
    }
    Ok(())
}

/// A sphere that slides: friction moves the greatest von Mises stress to the surface, at its trailing edge. On the
/// surface below the middle the stresses are those of Hamilton (Proc. Inst. Mech. Eng. 197C (1983) 53): the traction q₀
/// √(1 − r²) along x adds σxx = −q₀ π (4 + ν) x / 8 and σyy = −3 q₀ π ν x / 8, σxy = q₀ π (ν − 2) y / 8 inside the
/// contact.
#[test]
fn a_sliding_sphere() -> Result<(), Error> {
    use std::f64::consts::PI;
    let (nu, mu) = (0.3, 0.5);
    let mut worst = Vec::new();
    for cells in [8, 16, 32] {
        let (grid, pressure) = hertz(cells, cells + 1);
        let body = Subsurface::new(grid, Boundary::Free, nu)?;
        let none = DMatrix::zeros(grid.nx(), grid.ny());
        let pulled = body.under_traction((&none, 0.0), [&pressure, &none])?;
        let mut greatest = 0.0_f64;
        // Eighths of the radius from the middle.
        for (i, j) in [(0, 0), (3, 0), (0, -3), (-2, 2), (4, 2)] {
            let at = |eighths: isize| (eighths * cells as isize / 8 + cells as isize + 1) as usize;
            let (ix, iy) = (at(i), at(j));
            let (x, y) = (0.125 * i as f64, 0.125 * j as f64);
            let stress = pulled.at(grid.index(ix, iy)).unwrap();
            for (found, expected) in [
                (stress.xx, -PI * (4.0 + nu) * x / 8.0),
                (stress.yy, -3.0 * PI * nu * x / 8.0),
                (stress.xy, PI * (nu - 2.0) * y / 8.0),
                (stress.zz, 0.0),
                (stress.xz, -pressure[(ix, iy)]),
                (stress.yz, 0.0),
            ] {
                greatest = greatest.max((found - expected).abs());
            }
        }
        worst.push(greatest);
    }
    // A derivative of the traction, from values at the middles of cells: the order is 1.
    assert!(worst[2] < 1e-2 && worst[0] > 1.8 * worst[1] && worst[1] > 1.8 * worst[2], "{worst:?}");
    let (grid, pressure) = hertz(32, 40);
    let body = Subsurface::new(grid, Boundary::Free, nu)?;
    let at_rest = body.survey(&pressure, None)?.greatest(Measure::VonMises);
    let sliding = body.sliding(mu, 0.0)?;
    let found = sliding.survey(&pressure, Some(&[0.0, 0.1, 0.5]))?.greatest(Measure::VonMises);
    assert!(found.depth == 0.0 && found.value > 1.2 * at_rest.value, "{found:?} {at_rest:?}");
    assert_eq!(found.node.1, 40);
    // Pulled along y, all is turned.
    let turned = Subsurface::new(grid, Boundary::Free, nu)?.sliding(mu, 0.5 * PI)?;
    let (along_x, along_y) = (sliding.at_depth(&pressure, 0.3)?, turned.at_depth(&pressure, 0.3)?);
    // A right angle is rounded, and so is its cosine.
    assert!((along_x.xx.transpose() - &along_y.yy).amax() < 1e-12);
    assert!((along_x.xy.transpose() - &along_y.xy).amax() < 1e-12);
    assert!((along_x.xz.transpose() - &along_y.yz).amax() < 1e-12);
    Ok(())
}
