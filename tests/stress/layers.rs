//! Layers.

use std::f64::consts::TAU;

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::stress::{Measure, Subsurface};
use asperity::{Boundary, Error, Grid, InfluenceKernel};
use nalgebra::{DMatrix, DVector};

use super::hertz;

const STEEL: (f64, f64) = (210e9, 0.3);
const COAT: (f64, f64) = (450e9, 0.22);

fn coated(
    layers: &[((f64, f64), f64)],
    (youngs_modulus, poissons_ratio): (f64, f64),
) -> Result<LayeredBody, Error> {
    let layer = |&((youngs_modulus, poissons_ratio), thickness): &((f64, f64), f64)| Layer {
        youngs_modulus,
        poissons_ratio,
        thickness,
    };
    let layers: Vec<Layer> = layers.iter().map(layer).collect();
    LayeredBody::new(&layers, Base::HalfSpace { youngs_modulus, poissons_ratio })
}

/// Uneven.
fn pressure(nx: usize, ny: usize) -> DMatrix<f64> {
    DMatrix::from_fn(nx, ny, |ix, iy| {
        let (x, y) = (ix as f64, iy as f64);
        1.0 + 0.7 * (1.3 * x + 0.2 * y * y).sin() + 0.2 * (x * y).cos()
    })
}

/// All three kernels of a body.
fn kernels(grid: Grid, body: &LayeredBody) -> Result<Vec<Layered>, Error> {
    Ok(vec![
        Layered::free(grid, body.clone())?,
        Layered::periodic(grid, body.clone())?,
        Layered::spectral(grid, body.clone())?,
    ])
}

/// A layer of the material below it changes nothing. Within it that is the half-space itself; below it, all comes from
/// the transfer matrices, Hankel transforms and integrals over cells.
#[test]
fn layers_of_one_material_are_a_half_space() -> Result<(), Error> {
    for (shape, sides) in [((7, 6), (1.0, 1.0)), ((5, 8), (1.0, 0.6))] {
        let grid = Grid::new(shape.0, shape.1, sides.0, sides.1)?;
        let load = pressure(shape.0, shape.1);
        let body = coated(&[(STEEL, 0.7), (STEEL, 1.1)], STEEL)?;
        for kernel in kernels(grid, &body)? {
            let layered = Subsurface::of(&kernel, 0.1)?;
            let boundary = kernel.boundary();
            let plain: Box<dyn InfluenceKernel> = match (boundary, kernel.origin()) {
                (Boundary::Free, _) => Box::new(asperity::Boussinesq::new(grid, 1.0)?),
                (_, asperity::kernel::KernelOrigin::SpectralLayered { .. }) => {
                    Box::new(asperity::Spectral::new(grid, 1.0)?)
                }
                _ => Box::new(asperity::PeriodicBoussinesq::new(grid, 1.0)?),
            };
            let plain = Subsurface::of(&*plain, STEEL.1)?;
            for z in [0.0, 0.4, 0.7, 0.71, 1.5, 1.8, 1.9, 6.0] {
                let (found, expected) = (layered.at_depth(&load, z)?, plain.at_depth(&load, z)?);
                for (c, (a, b)) in
                    found.components().into_iter().zip(expected.components()).enumerate()
                {
                    // Tables err by 2·10⁻¹³ of point loads of 1/z², and sums over 42 cells by some 10⁻¹² of the
                    // greatest.
                    let error = (a - b).amax();
                    assert!(error < 2e-11, "{boundary:?} {z} {c}: {error:e}");
                }
            }
        }
    }
    Ok(())
}

/// Across an interface tractions and the strains along it go on; stresses along it jump.
#[test]
fn interfaces_hold_together() -> Result<(), Error> {
    let rubber = (5e6, 0.5);
    for (layers, base) in [(vec![(COAT, 0.9)], STEEL), (vec![(STEEL, 0.5), (rubber, 1.0)], COAT)] {
        let grid = Grid::new(6, 7, 1.0, 0.8)?;
        let load = pressure(6, 7);
        let body = coated(&layers, base)?;
        for kernel in kernels(grid, &body)? {
            let below = Subsurface::of(&kernel, 0.3)?;
            let mut depth = 0.0;
            for (k, &(upper, thickness)) in layers.iter().enumerate() {
                depth += thickness;
                let lower = layers.get(k + 1).map_or(base, |(material, _)| *material);
                let sides =
                    [below.at_depth(&load, depth)?, below.at_depth(&load, depth.next_up())?];
                let [a, b] = &sides;
                let scale = load.max();
                for (a, b) in [(&a.zz, &b.zz), (&a.xz, &b.xz), (&a.yz, &b.yz)] {
                    assert!((a - b).amax() < 1e-10 * scale, "{:?} {k}", kernel.boundary());
                }
                let mut jumps = 0.0_f64;
                for node in 0..grid.nodes() {
                    let strains = |side: usize, (e, nu): (f64, f64)| {
                        let s = sides[side].at(node).unwrap();
                        let along = |a: f64, b: f64| (a - nu * (b + s.zz)) / e;
                        [along(s.xx, s.yy), along(s.yy, s.xx), (1.0 + nu) * s.xy / e]
                    };
                    let (up, down) = (strains(0, upper), strains(1, lower));
                    let most = scale / upper.0.min(lower.0);
                    for (a, b) in up.into_iter().zip(down) {
                        // The stress of the stiffer side errs by 10⁻¹⁰ of the load.
                        assert!(
                            (a - b).abs() < 1e-9 * most,
                            "{:?} {k}: {a} {b}",
                            kernel.boundary()
                        );
                    }
                    jumps = jumps.max((sides[0].xx[node] - sides[1].xx[node]).abs());
                }
                assert!(jumps > 0.1 * scale, "{jumps}");
            }
        }
    }
    Ok(())
}

/// Under a wave of pressure of 1 on one layer on a half-space: minus σzz, σxz over i, σxx along the wave, at the depth
/// z, and σyy across. Airy's functions (A + B z) e^(−qz) + (C + D z) e^(qz) and (E + F z) e^(−qz), whose factors six
/// conditions give.
fn one_layer(q: f64, z: f64, ((e1, nu1), h): ((f64, f64), f64), (e2, nu2): (f64, f64)) -> [f64; 4] {
    // φ and its derivatives by depth, of the four functions; e^(qz) is counted from the interface, so that nothing
    // overflows.
    let functions = |z: f64| -> [[f64; 4]; 4] {
        let (down, up) = ((-q * z).exp(), (q * (z - h)).exp());
        [
            [down, -q * down, q * q * down, -q.powi(3) * down],
            [
                z * down,
                (1.0 - q * z) * down,
                (q * z - 2.0) * q * down,
                (3.0 - q * z) * q * q * down,
            ],
            [up, q * up, q * q * up, q.powi(3) * up],
            [z * up, (1.0 + q * z) * up, (q * z + 2.0) * q * up, (3.0 + q * z) * q * q * up],
        ]
    };
    // σzz = −q² φ, σxz = −i q φ', σxx = φ''. Strains: i q u = (1 + ν)/E ((1 − ν) σxx − ν σzz), and
    // σxz (1 + ν)/E · 2 = u' + i q w. From these u over i and w.
    let strain =
        |f: &[f64; 4], e: f64, nu: f64| (1.0 + nu) / e * ((1.0 - nu) * f[2] + nu * q * q * f[0]);
    let slope =
        |f: &[f64; 4], e: f64, nu: f64| (1.0 + nu) / e * ((1.0 - nu) * f[3] + nu * q * q * f[1]);
    // u = −i strain/q, so u' = −i slope/q, and i q w = 2 (1 + ν)/E (−i q φ') + i slope/q.
    let sink =
        |f: &[f64; 4], e: f64, nu: f64| -2.0 * (1.0 + nu) / e * f[1] + slope(f, e, nu) / (q * q);
    let (top, low) = (functions(0.0), functions(h));
    let mut matrix = DMatrix::zeros(6, 6);
    let unit = 1e9;
    for k in 0..4 {
        matrix[(0, k)] = -q * q * top[k][0];
        matrix[(1, k)] = top[k][1];
        matrix[(2, k)] = low[k][0];
        matrix[(3, k)] = low[k][1];
        matrix[(4, k)] = unit * strain(&low[k], e1, nu1);
        matrix[(5, k)] = unit * sink(&low[k], e1, nu1);
    }
    for k in 0..2 {
        matrix[(2, 4 + k)] = -low[k][0];
        matrix[(3, 4 + k)] = -low[k][1];
        matrix[(4, 4 + k)] = -unit * strain(&low[k], e2, nu2);
        matrix[(5, 4 + k)] = -unit * sink(&low[k], e2, nu2);
    }
    let mut rhs = DVector::zeros(6);
    rhs[0] = -1.0;
    let factors = matrix.lu().solve(&rhs).unwrap();
    let here = functions(z);
    let (range, nu) = if z <= h { (0..4, nu1) } else { (4..6, nu2) };
    let sum = |derivative: usize| -> f64 {
        range.clone().map(|k| factors[k] * here[k % 4][derivative]).sum()
    };
    let (zz, along) = (-q * q * sum(0), sum(2));
    [-zz, -q * sum(1), along, nu * (along + zz)]
}

#[test]
fn waves_are_those_of_airy() -> Result<(), Error> {
    let n = 16;
    let grid = Grid::square(n, 16.0)?;
    for (h, upper, lower) in [(0.6, COAT, STEEL), (3.0, STEEL, COAT), (1.0, (5e9, 0.45), STEEL)] {
        let body = coated(&[(upper, h)], lower)?;
        let below = Subsurface::of(&Layered::spectral(grid, body)?, 0.3)?;
        for (kx, ky) in [(1, 0), (0, 3), (2, 5), (7, 7)] {
            let (qx, qy) = (TAU * f64::from(kx) / n as f64, TAU * f64::from(ky) / n as f64);
            let q = qx.hypot(qy);
            let (cx, cy) = (qx / q, qy / q);
            let phase = |ix: usize, iy: usize| qx * ix as f64 + qy * iy as f64;
            let load = DMatrix::from_fn(n, n, |ix, iy| phase(ix, iy).cos());
            for z in [0.0, 0.3 * h, h, h.next_up(), 1.7 * h] {
                let [p, shear, along, across] = one_layer(q, z, (upper, h), lower);
                let field = below.at_depth(&load, z)?;
                for (ix, iy) in [(0, 0), (3, 1), (5, 11)] {
                    let (cos, sin) = (phase(ix, iy).cos(), phase(ix, iy).sin());
                    let stress = field.at(grid.index(ix, iy)).unwrap();
                    for (found, expected) in [
                        (stress.zz, -p * cos),
                        (stress.xz, -shear * cx * sin),
                        (stress.yz, -shear * cy * sin),
                        (stress.xx, (along * cx * cx + across * cy * cy) * cos),
                        (stress.yy, (along * cy * cy + across * cx * cx) * cos),
                        (stress.xy, (along - across) * cx * cy * cos),
                    ] {
                        // The matrix of six has a condition number of some 10⁶ with functions from 1 to e^(−qh), of up
                        // to 27.
                        assert!(
                            (found - expected).abs() < 1e-8,
                            "{h} ({kx}, {ky}) {z}: {found} {expected}"
                        );
                    }
                }
            }
        }
    }
    Ok(())
}

/// A coated sphere: stresses on the axis by an own Hankel integral of Airy's waves, whose load is 2 (sin q − q cos
/// q)/q³ of Hertz's.
#[test]
fn a_coated_sphere() -> Result<(), Error> {
    let h = 0.4;
    let on_the_axis = |z: f64| -> (f64, f64) {
        let (mut down, mut side) = (0.0, 0.0);
        // Midpoints up to where waves have faded.
        let (step, end) = (5e-3, 36.0 / z.max(0.2));
        let mut q = 0.5 * step;
        while q < end {
            let [p, _, along, across] = one_layer(q, z, (COAT, h), STEEL);
            let weight = (q.sin() - q * q.cos()) / (q * q) * step;
            down -= p * weight;
            side += 0.5 * (along + across) * weight;
            q += step;
        }
        (down, side)
    };
    for z in [0.2, h, h.next_up(), 0.9] {
        let (down, side) = on_the_axis(z);
        let mut errors = Vec::new();
        for cells in [8, 16, 32] {
            let (grid, load) = hertz(cells, cells + 1);
            let body = coated(&[(COAT, h)], STEEL)?;
            let below = Subsurface::of(&Layered::free(grid, body)?, 0.3)?;
            let stress = below.at_depth(&load, z)?.at(grid.nodes() / 2).unwrap();
            assert!((stress.xx - stress.yy).abs() < 1e-10 && stress.xz.abs() < 1e-10);
            errors.push((stress.zz - down).hypot(stress.xx - side));
        }
        // As of the sphere without a coat.
        assert!(errors[2] < 2e-3, "{z}: {errors:?}");
        assert!(errors[0] > 3.0 * errors[1] && errors[1] > 3.0 * errors[2], "{z}: {errors:?}");
    }
    Ok(())
}

/// A coat that is thick is all there is, and of one that is thin the base sees nothing.
#[test]
fn thick_and_thin_coats() -> Result<(), Error> {
    let (grid, load) = hertz(8, 10);
    let plain = |nu: f64| Subsurface::new(grid, Boundary::Free, nu);
    let of = |h: f64| Subsurface::of(&Layered::free(grid, coated(&[(COAT, h)], STEEL)?)?, 0.3);
    let greatest = |a: &asperity::stress::StressField, b: &asperity::stress::StressField| {
        a.components()
            .into_iter()
            .zip(b.components())
            .map(|(a, b)| (a - b).amax())
            .fold(0.0, f64::max)
    };
    let mut left = Vec::new();
    for h in [10.0, 100.0] {
        left.push(greatest(&of(h)?.at_depth(&load, 0.5)?, &plain(COAT.1)?.at_depth(&load, 0.5)?));
    }
    // What the base adds goes with 1/h².
    assert!(left[0] < 1e-2 && left[1] < 0.02 * left[0], "{left:?}");
    let mut left = Vec::new();
    for h in [1e-2, 1e-3] {
        left.push(greatest(&of(h)?.at_depth(&load, 0.5)?, &plain(STEEL.1)?.at_depth(&load, 0.5)?));
    }
    // What the coat takes over goes with h.
    assert!(left[0] < 0.05 && left[1] < 0.15 * left[0], "{left:?}");
    // A stiff coat bears more than what lies below it, and its lower side is pulled.
    let body = of(0.3)?;
    let survey = body.survey(&load, None)?;
    let greatest = survey.greatest(Measure::GreatestTension);
    assert!(greatest.depth <= 0.3 && greatest.value > 0.0, "{greatest:?}");
    for depth in [0.3, 0.3_f64.next_up()] {
        assert!(survey.depths.iter().any(|other| other.depth == depth));
    }
    Ok(())
}
