//! Rectangles beside integrals of point forces, in the formulas of Johnson, Contact Mechanics, (3.20) and (3.76).

use std::f64::consts::TAU;

use asperity::stress::{Measure, Stress, Subsurface};
use asperity::{Boundary, Error, Grid};
use nalgebra::DMatrix;

/// xx, yy, zz, yz, xz, xy.
type Tensor = [f64; 6];

/// Under a force of 1, at (x, y, z) for Poisson's ratio ν.
type Point = fn(f64, f64, f64, f64) -> Tensor;

/// Boussinesq: a force of 1 into the body.
fn normal(x: f64, y: f64, z: f64, nu: f64) -> Tensor {
    let (r2, rho) = (x * x + y * y, (x * x + y * y + z * z).sqrt());
    let rho5 = rho.powi(5);
    let k = 1.0 - 2.0 * nu;
    let side = |x: f64, y: f64| {
        k / r2 * ((1.0 - z / rho) * (x * x - y * y) / r2 + z * y * y / rho.powi(3))
            - 3.0 * z * x * x / rho5
    };
    // The factor of 2, which the book lacks, is that of a tensor: (σr − σθ) xy/r².
    let xy = k / r2 * (2.0 * (1.0 - z / rho) * x * y / r2 - x * y * z / rho.powi(3))
        - 3.0 * x * y * z / rho5;
    let down = [-3.0 * z.powi(3), -3.0 * y * z * z, -3.0 * x * z * z].map(|s| s / rho5);
    [side(x, y), side(y, x), down[0], down[1], down[2], xy].map(|s| s / TAU)
}

/// Cerruti: a force of 1 along x.
fn along_x(x: f64, y: f64, z: f64, nu: f64) -> Tensor {
    let rho = (x * x + y * y + z * z).sqrt();
    let (rho3, rho5, b) = (rho.powi(3), rho.powi(5), rho + z);
    let k = 1.0 - 2.0 * nu;
    let common = |a: f64| a / (rho3 * b * b) + 2.0 * a / (rho * rho * b.powi(3));
    let xx = -3.0 * x.powi(3) / rho5 + k * (x / rho3 - 3.0 * x / (rho * b * b) + common(x.powi(3)));
    let yy = -3.0 * x * y * y / rho5 + k * (x / rho3 - x / (rho * b * b) + common(x * y * y));
    let xy = -3.0 * x * x * y / rho5 + k * (-y / (rho * b * b) + common(x * x * y));
    let down = [-3.0 * x * z * z, -3.0 * x * y * z, -3.0 * x * x * z].map(|s| s / rho5);
    [xx, yy, down[0], down[1], down[2], xy].map(|s| s / TAU)
}

/// The same along y.
fn along_y(x: f64, y: f64, z: f64, nu: f64) -> Tensor {
    let [yy, xx, zz, xz, yz, xy] = along_x(y, x, z, nu);
    [xx, yy, zz, yz, xz, xy]
}

/// Over a rectangle about the origin, seen from (x, y, z): Gauss's rule of five points in parts of it.
fn integrated(point: Point, (dx, dy): (f64, f64), (x, y, z): (f64, f64, f64), nu: f64) -> Tensor {
    const RULE: [(f64, f64); 5] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    const PARTS: usize = 16;
    let nodes = |side: f64| -> Vec<(f64, f64)> {
        let half = 0.5 * side / PARTS as f64;
        let middle = move |part: usize| (part as f64 + 0.5) * 2.0 * half - 0.5 * side;
        (0..PARTS)
            .flat_map(|part| RULE.map(|(node, weight)| (middle(part) + half * node, half * weight)))
            .collect()
    };
    let mut sum = [0.0; 6];
    for (eta, weight_y) in nodes(dy) {
        for (xi, weight_x) in nodes(dx) {
            let found = point(x - xi, y - eta, z, nu);
            sum.iter_mut().zip(found).for_each(|(sum, s)| *sum += weight_x * weight_y * s);
        }
    }
    sum
}

#[test]
fn rectangles_are_integrals_of_point_forces() -> Result<(), Error> {
    for (sides, nu) in [((1.0, 1.0), 0.3), ((2.0, 0.7), 0.0), ((0.4, 0.9), 0.5), ((1.0, 1.5), -0.5)]
    {
        // Any unit of length.
        let unit = 1e-7;
        let grid = Grid::new(5, 6, sides.0 * unit, sides.1 * unit)?;
        let body = Subsurface::new(grid, Boundary::Free, nu)?;
        let mut one = DMatrix::zeros(5, 6);
        one[(2, 3)] = 1.0;
        let none = DMatrix::zeros(5, 6);
        for z in [0.3, 1.0, 7.0] {
            let loads: [(Point, [&DMatrix<f64>; 3]); 3] = [
                (normal, [&one, &none, &none]),
                (along_x, [&none, &one, &none]),
                (along_y, [&none, &none, &one]),
            ];
            for (point, [pressure, x, y]) in loads {
                let found = body.under_traction((pressure, z * unit), [x, y])?;
                for iy in 0..6 {
                    for ix in 0..5 {
                        let at = |i: usize, from: f64, side: f64| (i as f64 - from) * side;
                        // The middle of the cell is a removable singularity of the formulas.
                        let place = (at(ix, 2.0, sides.0) + 1e-9, at(iy, 3.0, sides.1) + 1e-9, z);
                        let expected = integrated(point, sides, place, nu);
                        for (c, (field, expected)) in
                            found.components().iter().zip(expected).enumerate()
                        {
                            // Gauss's rule on parts of 1/16 of a cell, 1/5 of the least depth, and the shift of 10⁻⁹
                            // times gradients of some 3.
                            let error = field[(ix, iy)] - expected;
                            assert!(
                                error.abs() < 2e-8,
                                "{sides:?} {nu} {z} ({ix}, {iy}) {c}: {error:e}"
                            );
                        }
                    }
                }
            }
        }
    }
    Ok(())
}

/// A square on the surface: minus the pressure below it, and sideways (1 + 2ν)/2 of it in its middle; outside, what
/// compresses one way pulls the other.
#[test]
fn the_surface_itself() -> Result<(), Error> {
    let nu = 0.3;
    let grid = Grid::square(21, 21.0)?;
    let body = Subsurface::new(grid, Boundary::Free, nu)?;
    let inside = |i: usize| (7..14).contains(&i);
    let pressure =
        DMatrix::from_fn(21, 21, |ix, iy| if inside(ix) && inside(iy) { 2.0 } else { 0.0 });
    let found = body.at_depth(&pressure, 0.0)?;
    for iy in 0..21 {
        for ix in 0..21 {
            // Sums of 49 responses, each a few roundings of some 1.
            let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-13);
            close(found.zz[(ix, iy)], -pressure[(ix, iy)]);
            close(found.xz[(ix, iy)], 0.0);
            close(found.yz[(ix, iy)], 0.0);
            close(found.xx[(ix, iy)] + found.yy[(ix, iy)], -(1.0 + 2.0 * nu) * pressure[(ix, iy)]);
        }
    }
    assert!((found.xx[(10, 10)] + (1.0 + 2.0 * nu)).abs() < 1e-13);
    Ok(())
}

/// The point force once more, without differences of what is alike below it.
fn far_below(x: f64, y: f64, z: f64, nu: f64) -> Tensor {
    let rho = (x * x + y * y + z * z).sqrt();
    let (b, k) = (rho + z, 1.0 - 2.0 * nu);
    let (rho3, rho5) = (rho.powi(3), rho.powi(5));
    let turned = (2.0 * rho + z) / (rho3 * b * b);
    let side = |x: f64| k * (z / rho3 - 1.0 / (rho * b) + x * x * turned) - 3.0 * x * x * z / rho5;
    let xy = k * x * y * turned - 3.0 * x * y * z / rho5;
    let down = [-3.0 * z.powi(3), -3.0 * y * z * z, -3.0 * x * z * z].map(|s| s / rho5);
    [side(x), side(y), down[0], down[1], down[2], xy].map(|s| s / TAU)
}

/// A square of 3 x 3 cells, whose width of 10⁻⁶ of the depth matters by its square.
#[test]
fn cells_far_above_are_point_forces() -> Result<(), Error> {
    let nu = 0.3;
    let body = Subsurface::new(Grid::square(7, 7.0)?, Boundary::Free, nu)?;
    let inside = |i: usize| (2..5).contains(&i);
    let pressure =
        DMatrix::from_fn(7, 7, |ix, iy| if inside(ix) && inside(iy) { 1.0 } else { 0.0 });
    for z in [1e6, 1e7, 1e8, 1e20, 1e30] {
        let found = body.at_depth(&pressure, z)?;
        for iy in 0..7 {
            for ix in 0..7 {
                let place = [ix, iy].map(|i: usize| i as f64 - 3.0);
                let expected = far_below(place[0], place[1], z, nu).map(|s| 9.0 * s);
                let unit = expected[2].abs();
                for (field, expected) in found.components().into_iter().zip(expected) {
                    let error = (field[(ix, iy)] - expected) / unit;
                    assert!(error.abs() < 1e-10, "{z:e} ({ix}, {iy}): {error:e}");
                }
                let expected = Stress::new(expected);
                for measure in Measure::ALL {
                    let ratio = found.map(measure)[(ix, iy)] / expected.measure(measure);
                    assert!((ratio - 1.0).abs() < 1e-10, "{z:e} {measure:?} ({ix}, {iy}): {ratio}");
                }
            }
        }
        assert!(body.survey(&pressure, Some(&[z])).is_ok());
    }
    for z in [1.1e30, 1e150, f64::MAX] {
        assert!(matches!(body.at_depth(&pressure, z), Err(Error::OutOfRange { .. })), "{z:e}");
    }
    Ok(())
}

/// One side repeats: far below it is a line load.
#[test]
fn strips_far_above_are_lines() -> Result<(), Error> {
    let body = Subsurface::new(Grid::square(4, 4.0)?, Boundary::PeriodicX, 0.3)?;
    for z in [1e4, 1e7, 1e10] {
        let found = body.at_depth(&DMatrix::from_element(4, 4, 1.0), z)?;
        let expected = -4.0 * 4.0 / (TAU * z);
        // The width of 4 matters by its square.
        let allowed = 1e-13 + 16.0 / (z * z);
        assert!(found.zz.iter().all(|zz| (zz / expected - 1.0).abs() < allowed), "{z:e}");
        assert!(found.xx.iter().all(|xx| (xx / expected - 0.3).abs() < allowed), "{z:e}");
        assert!(found.yy.iter().all(|yy| (yy / expected).abs() < allowed), "{z:e}");
        // Along the line the shear is y/z of the pressure.
        let slope = (found.yz[(0, 3)] - found.yz[(0, 2)]) * z / expected;
        assert!((slope - 1.0).abs() < 1e-3, "{z:e} {slope}");
    }
    Ok(())
}

/// Where point forces take over from differences between corners.
#[test]
fn stresses_go_on_where_points_take_over() -> Result<(), Error> {
    for ((dx, dy), boundary) in [
        ((1.0, 1.0), Boundary::Free),
        ((0.3, 1.0), Boundary::Free),
        ((1.0, 0.2), Boundary::Free),
        ((1.0, 1.0), Boundary::PeriodicX),
        ((1.0, 0.2), Boundary::PeriodicY),
    ] {
        let body = Subsurface::new(Grid::new(6, 5, dx, dy)?, boundary, 0.2)?;
        let load = DMatrix::from_fn(6, 5, |ix, iy| 1.0 + (ix * iy % 3) as f64);
        for change in [64.0 * dx, 64.0 * dy] {
            let at = |z: f64| body.under_traction((&load, z), [&(0.4 * &load), &(0.3 * &load)]);
            let (above, below) = (at(change * (1.0 - 1e-13))?, at(change * (1.0 + 1e-13))?);
            let unit = above.zz.amax();
            for (above, below) in above.components().into_iter().zip(below.components()) {
                // Corners lose 10⁻¹² there.
                let error = (above - below).amax() / unit;
                assert!(error < 1e-11, "{dx} {dy} {boundary:?}: {error:e}");
            }
        }
    }
    Ok(())
}
