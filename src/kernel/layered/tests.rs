use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::*;
use crate::kernel::{Boussinesq, KernelTable, PeriodicBoussinesq, Spectral, check};
use crate::reference::layer_compliance;

/// Numbers that are the same every time.
struct Draw(ChaCha8Rng);

impl Draw {
    fn new() -> Self {
        Self(ChaCha8Rng::from_seed([7; 32]))
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * f64::from(self.0.next_u32()) / f64::from(u32::MAX)
    }

    fn power(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(self.between(low, high))
    }
}

fn layer(youngs_modulus: f64, poissons_ratio: f64, thickness: f64) -> Layer {
    Layer { youngs_modulus, poissons_ratio, thickness }
}

fn half_space(youngs_modulus: f64, poissons_ratio: f64) -> Base {
    Base::HalfSpace { youngs_modulus, poissons_ratio }
}

fn on_rigid(
    youngs_modulus: f64,
    poissons_ratio: f64,
    thickness: f64,
) -> Result<LayeredBody, Error> {
    LayeredBody::new(&[layer(youngs_modulus, poissons_ratio, thickness)], Base::Rigid)
}

/// Bodies of every kind: soft and stiff coats, thin and thick, on a rigid base, of several layers.
fn bodies(thickness: f64) -> Result<Vec<LayeredBody>, Error> {
    let h = thickness;
    let steel = half_space(1.0, 0.3);
    Ok(vec![
        LayeredBody::new(&[layer(0.1, 0.45, h)], steel)?,
        LayeredBody::new(&[layer(10.0, 0.2, h)], steel)?,
        LayeredBody::new(&[layer(3.0, 0.2, 0.3 * h), layer(0.2, 0.4, 0.7 * h)], steel)?,
        on_rigid(1.0, 0.3, h)?,
        on_rigid(1.0, 0.5, h)?,
        LayeredBody::new(&[layer(1.0, 0.3, 0.5 * h), layer(4.0, 0.1, 0.5 * h)], Base::Rigid)?,
        on_rigid(1.0, 0.3, h)?.against(2.0)?,
    ])
}

/// One layer, against Nogi and Kato's formula.
#[test]
fn one_layer_is_the_closed_form() -> Result<(), Error> {
    let mut draw = Draw::new();
    for case in 0..600 {
        let (youngs_modulus, other) = (draw.power(-2.0, 2.0), draw.power(-2.0, 2.0));
        let (nu, below) = (draw.between(-0.9, 0.5), draw.between(-0.9, 0.5));
        let (h, x) = (draw.power(-6.0, 1.0), draw.power(-2.0, 1.7));
        let (base, substrate) = if case % 3 == 0 {
            (Base::Rigid, None)
        } else {
            (half_space(other, below), Some((other, below)))
        };
        let body = LayeredBody::new(&[layer(youngs_modulus, nu, h)], base)?;
        let exact = layer_compliance(x / h, (youngs_modulus, nu, h), substrate)?;
        let found = body.compliance(x / h);
        // Both err by some 2e-14; the formula by 1e-16/x for x of 0.01.
        assert!((found / exact - 1.0).abs() < 1e-13, "{case} {x}: {found} {exact}");
        // The same layer in slices.
        let slices = [0.1, 0.5, 0.15, 0.25].map(|part| layer(youngs_modulus, nu, part * h));
        let sliced = LayeredBody::new(&slices, base)?.compliance(x / h);
        assert!((sliced / exact - 1.0).abs() < 1e-13, "{case} {x}: {sliced} {exact}");
    }
    Ok(())
}

/// Three layers, against the boundary-value problem: Airy functions (A + Bz) e^(−qz) + (C + Dz) e^(qz) in each.
#[test]
fn several_layers_solve_the_boundary_value_problem() -> Result<(), Error> {
    /// Pressure, shear traction, displacements along and into the body of an Airy function with this derivatives.
    fn state(f: [f64; 4], q: f64, (youngs_modulus, nu): (f64, f64)) -> [f64; 4] {
        let twice_shear = youngs_modulus / (1.0 + nu);
        [
            -q * q * f[0],
            q * f[1],
            ((1.0 - nu) * f[2] + nu * q * q * f[0]) / (q * twice_shear),
            ((1.0 - nu) * f[3] + (nu - 2.0) * q * q * f[1]) / (q * q * twice_shear),
        ]
    }
    fn airy(s: f64, z: f64, linear: bool) -> [f64; 4] {
        let e = (s * z).exp();
        if linear {
            [z * e, (1.0 + s * z) * e, (2.0 + s * z) * s * e, (3.0 + s * z) * s * s * e]
        } else {
            [e, s * e, s * s * e, s * s * s * e]
        }
    }
    let mut draw = Draw::new();
    for case in 0..100 {
        let q = draw.power(-0.7, 0.3);
        let layers: Vec<Layer> = (0..3)
            .map(|_| layer(draw.power(-1.0, 1.0), draw.between(-0.5, 0.49), draw.between(0.2, 1.0)))
            .collect();
        let base = (draw.power(-1.0, 1.0), draw.between(-0.5, 0.5));
        let mut matrix = DMatrix::zeros(14, 14);
        let mut rhs = DVector::zeros(14);
        // Depth counted from the upper side of each material.
        let functions = [(-q, false), (-q, true), (q, false), (q, true)];
        for (i, own) in layers.iter().enumerate() {
            let material = (own.youngs_modulus, own.poissons_ratio);
            for (j, &(s, linear)) in functions.iter().enumerate() {
                let upper = state(airy(s, 0.0, linear), q, material);
                let lower = state(airy(s, own.thickness, linear), q, material);
                for k in 0..4 {
                    if i == 0 && k < 2 {
                        matrix[(k, j)] = upper[k];
                    }
                    if i > 0 {
                        matrix[(4 * i - 2 + k, 4 * i + j)] = -upper[k];
                    }
                    matrix[(4 * i + 2 + k, 4 * i + j)] = lower[k];
                }
            }
        }
        for (j, &(s, linear)) in functions[..2].iter().enumerate() {
            let upper = state(airy(s, 0.0, linear), q, base);
            for k in 0..4 {
                matrix[(10 + k, 12 + j)] = -upper[k];
            }
        }
        rhs[0] = -1.0;
        let Some(solution) = matrix.lu().solve(&rhs) else {
            return Err(Error::OutOfRange { quantity: "q", value: q, expected: "regular" });
        };
        let top = (layers[0].youngs_modulus, layers[0].poissons_ratio);
        let displacement: f64 = functions
            .iter()
            .enumerate()
            .map(|(j, &(s, linear))| solution[j] * state(airy(s, 0.0, linear), q, top)[3])
            .sum();
        let body = LayeredBody::new(&layers, half_space(base.0, base.1))?;
        let found = body.compliance(q);
        // A matrix with a condition number of some e^(2 q h) × 1e3, moduli and wave numbers squared: 1e7.
        assert!((found / displacement - 1.0).abs() < 1e-9, "{case}: {found} {displacement}");
    }
    Ok(())
}

#[test]
fn limits_of_the_symbol() -> Result<(), Error> {
    let (youngs_modulus, nu, h) = (3.0, 0.3, 0.01);
    let shear = youngs_modulus / (2.0 * (1.0 + nu));
    let e_star = youngs_modulus / (1.0 - nu * nu);
    let homogeneous =
        LayeredBody::new(&[layer(youngs_modulus, nu, h)], half_space(youngs_modulus, nu))?;
    let soft = LayeredBody::new(&[layer(0.1, 0.4, h)], half_space(youngs_modulus, nu))?;
    let soft_star = 0.1 / (1.0 - 0.16);
    for q in [1e-3, 1.0, 100.0, 1e4, 1e9] {
        // Thirty roundings.
        let ratio = homogeneous.compliance(q) / (2.0 / (e_star * q));
        assert!((ratio - 1.0).abs() < 3e-14, "{q}: {ratio}");
        // Short waves see the layer: e^(−2qh) (2qh)² is below 1e-80 at q h = 100. Long waves see the base, to q h times
        // the ratio of the moduli.
        let ratio = soft.compliance(q) * soft_star * q / 2.0;
        assert!(q < 1e4 || (ratio - 1.0).abs() < 1e-14, "{q}: {ratio}");
        let ratio = soft.compliance(q) * e_star * q / 2.0;
        assert!(q > 1e-2 || (ratio - 1.0).abs() < 60.0 * q * h, "{q}: {ratio}");
    }
    // Thin on a rigid base: h (1 − 2ν) / (2 G (1 − ν)), and h³ q² / (3 G) if incompressible; the next orders are (q
    // h)².
    for x in [1e-6, 1e-4, 1e-2] {
        let compressible = on_rigid(youngs_modulus, nu, h)?;
        let uniform = h * (1.0 - 2.0 * nu) / (2.0 * shear * (1.0 - nu));
        let mean = compressible.mean_compliance().unwrap_or(f64::NAN);
        assert!((mean / uniform - 1.0).abs() < 1e-15);
        assert_eq!(compressible.compliance(0.0), mean);
        let ratio = compressible.compliance(x / h) / uniform;
        assert!((ratio - 1.0).abs() < 2.0 * x * x + 1e-15, "{x}: {ratio}");
        let film = on_rigid(youngs_modulus, 0.5, h)?;
        assert_eq!(film.mean_compliance(), Some(0.0));
        let ratio = film.compliance(x / h) / (h * x * x / youngs_modulus);
        assert!((ratio - 1.0).abs() < 2.0 * x * x + 1e-15, "{x}: {ratio}");
    }
    // A base that is nearly rigid.
    let stiff = LayeredBody::new(&[layer(1.0, 0.2, h)], half_space(1e9, 0.3))?;
    let rigid = on_rigid(1.0, 0.2, h)?;
    for x in [0.1, 1.0, 10.0] {
        // The base gives way by the ratio of the moduli, over x.
        let ratio = stiff.compliance(x / h) / rigid.compliance(x / h);
        assert!((ratio - 1.0).abs() < 1e-7, "{x}: {ratio}");
    }
    // The other body is added.
    let pair = rigid.clone().against(4.0)?;
    assert_eq!(pair.mean_compliance(), None);
    assert_eq!(pair.compliance(2.0), rigid.compliance(2.0) + 0.25);
    assert!((pair.surface_modulus() - 1.0 / (0.96 + 0.25)).abs() < 1e-15);
    Ok(())
}

#[test]
fn bad_layers_are_refused() -> Result<(), Error> {
    let good = layer(1.0, 0.3, 1e-3);
    let make = |changed: Layer, base: Base| LayeredBody::new(&[good, changed, good], base);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let thickness = make(Layer { thickness: bad, ..good }, Base::Rigid);
        assert!(matches!(thickness, Err(Error::NotPositive { .. })), "{thickness:?}");
        for refused in [
            make(Layer { youngs_modulus: bad, ..good }, Base::Rigid),
            make(good, half_space(bad, 0.3)),
        ] {
            assert!(refused.is_err());
        }
        assert!(make(good, Base::Rigid)?.against(bad).is_err());
    }
    for bad in [-1.0, 0.51, f64::NAN, f64::NEG_INFINITY] {
        for refused in [
            make(Layer { poissons_ratio: bad, ..good }, Base::Rigid),
            make(good, half_space(1.0, bad)),
        ] {
            assert!(matches!(refused, Err(Error::OutOfRange { .. })), "{refused:?}");
        }
    }
    assert!(LayeredBody::new(&[], Base::Rigid).is_err());
    assert!(make(layer(1e13, 0.3, 1e-3), Base::Rigid).is_err());
    assert!(make(layer(1.0, 0.3, 1e10), Base::Rigid).is_err());
    // Nothing can be computed of cells that are nothing beside a layer, and the other way round.
    let grid = Grid::square(8, 1.0)?;
    for thickness in [1e-13, 1e13] {
        let body = on_rigid(1.0, 0.3, thickness)?;
        for made in [Layered::free, Layered::periodic, Layered::spectral] {
            assert!(matches!(made(grid, body.clone()), Err(Error::OutOfRange { .. })));
        }
    }
    Ok(())
}

/// Layers of the material of the half-space change nothing.
#[test]
fn layers_of_the_base_are_the_half_space() -> Result<(), Error> {
    let grid = Grid::new(12, 9, 1.0, 1.5)?;
    let e_star = 1.0 / (1.0 - 0.09);
    for h in [0.01, 0.7, 30.0] {
        let body = LayeredBody::new(&[layer(1.0, 0.3, h)], half_space(1.0, 0.3))?;
        let pairs: [(Layered, Box<dyn InfluenceKernel>); 3] = [
            (Layered::free(grid, body.clone())?, Box::new(Boussinesq::new(grid, e_star)?)),
            (
                Layered::periodic(grid, body.clone())?,
                Box::new(PeriodicBoussinesq::new(grid, e_star)?),
            ),
            (Layered::spectral(grid, body)?, Box::new(Spectral::new(grid, e_star)?)),
        ];
        for (found, expected) in pairs {
            let scale = expected.coefficient(0, 0);
            let (found, expected) = (KernelTable::new(&found)?, KernelTable::new(&expected)?);
            let (found, expected) = (found.in_gauge(0.0), expected.in_gauge(0.0));
            for (di, dj) in (0..12).flat_map(|di| (0..9).map(move |dj| (di, dj))) {
                let at = |table: &KernelTable| table.coefficient(di, dj).unwrap_or(f64::NAN);
                // Relative rounding of 1e-14 in the symbol.
                let error = (at(&found) - at(&expected)).abs() / scale;
                assert!(error < 3e-14, "{h} ({di}, {dj}): {error:e}");
            }
        }
    }
    Ok(())
}

/// On a strip of an even number of nodes the inverse of 1/q is zero at every even distance: no gauge makes gaps convex.
#[test]
fn strips_of_the_base_are_the_half_space() -> Result<(), Error> {
    let body = LayeredBody::new(&[layer(1.0, 0.3, 1e-3)], half_space(1.0, 0.3))?;
    for (n, cell) in [(4, 10.0), (118, 1.0), (178, 1.0), (206, 1.0), (746, 1.0)] {
        for (nx, ny) in [(n, 1), (1, n)] {
            let grid = Grid::new(nx, ny, cell, cell)?;
            let found = Layered::spectral(grid, body.clone())?;
            assert_eq!(found.contact_growth(), ContactGrowth::Monotone, "{nx} x {ny}");
            let expected = Spectral::new(grid, 1.0 / (1.0 - 0.09))?;
            let at = |kernel: &dyn InfluenceKernel, d: isize| {
                kernel.coefficient(d.min(nx as isize - 1), d.min(ny as isize - 1))
            };
            let own = at(&expected, 0);
            for d in 0..n as isize {
                // Gauges differ.
                let found = at(&found, d) - at(&found, 0);
                let error = (found - (at(&expected, d) - own)).abs() / own;
                // As on other grids.
                assert!(error < 3e-14, "{nx} x {ny} at {d}: {error:e}");
            }
        }
    }
    Ok(())
}

/// One cell on a coat that is much stiffer than what lies below, by its shear modulus too: its whole displacement comes
/// from waves thousands to millions of thicknesses long.
#[test]
fn stiff_coats_feel_the_longest_waves() -> Result<(), Error> {
    let cell = Grid::square(1, 1.0)?;
    // Integrals of the closed form over wave numbers, from panels of 10⁻¹⁶ on, with 30 digits; of these moduli as they
    // are rounded, since 1 + ν has four digits less.
    for (coat, base, expected) in [
        (layer(200e9, 0.3, 1.0), half_space(5e6, 0.0), 3.248_504_728_551_500_2e-9),
        (layer(3e6, 0.3, 1.0), half_space(1.0, 0.0), 3.871_215_617_660_964e-3),
        (layer(1.0, -0.9999, 1.0), half_space(1.0, 0.3), 3.613_202_043_834_654e-2),
    ] {
        let body = LayeredBody::new(&[coat], base)?;
        let error = Layered::free(cell, body)?.coefficient(0, 0) / expected - 1.0;
        // The compliance errs by 3e-14.
        assert!(error.abs() < 3e-14, "{coat:?}: {error:e}");
    }
    Ok(())
}

/// The other body adds what it answers alone, near and far: of a thin layer on a rigid base nothing else is left there.
#[test]
fn the_other_body_is_added() -> Result<(), Error> {
    for (nx, ny) in [(12, 9), (96, 3)] {
        let grid = Grid::new(nx, ny, 1.0, 1.5)?;
        let other = Boussinesq::new(grid, 2.0)?;
        for (place, body) in bodies(0.05)?[..5].iter().enumerate() {
            let alone = Layered::free(grid, body.clone())?;
            let pair = body.clone().against(2.0)?;
            let love = Boussinesq::new(grid, pair.surface_modulus())?;
            let pair = Layered::free(grid, pair)?;
            let (nx, ny) = (nx as isize, ny as isize);
            for (di, dj) in (0..nx).flat_map(|di| (0..ny).map(move |dj| (di, dj))) {
                let found = pair.coefficient(di, dj);
                let expected = alone.coefficient(di, dj) + other.coefficient(di, dj);
                // Three of Love's coefficients, right to 5e-16, and as many sums.
                let allowed = 4e-15 * (love.coefficient(di, dj) + found.abs());
                let error = (found - expected).abs();
                assert!(error < allowed, "{nx} {place} ({di}, {dj}): {found} {expected} {error:e}");
            }
            // A layer on a rigid base is not felt 200 thicknesses away.
            let end = alone.coefficient(nx - 1, ny - 1);
            assert_eq!(end == 0.0, matches!(body.base(), Base::Rigid), "{nx} {place}: {end:e}");
        }
    }
    Ok(())
}

/// Waves answer with the compliance.
#[test]
fn the_spectral_kernel_is_made_of_the_compliance() -> Result<(), Error> {
    let grid = Grid::new(10, 7, 1.0, 1.5)?;
    for body in bodies(2.0)? {
        let kernel = Layered::spectral(grid, body.clone())?;
        let table = KernelTable::from_symbol(
            grid,
            kernel.mean_displacement(),
            ContactGrowth::Unknown,
            |qx, qy| body.compliance(qx.hypot(qy)),
        )?;
        let own = KernelTable::new(&kernel)?;
        let (own, table) = (own.in_gauge(0.0), table.in_gauge(0.0));
        for (di, dj) in (0..10).flat_map(|di| (0..7).map(move |dj| (di, dj))) {
            let error = own.coefficient(di, dj).unwrap_or(f64::NAN)
                - table.coefficient(di, dj).unwrap_or(f64::NAN);
            // Two Fourier transforms.
            assert!(error.abs() < 1e-14 * own.self_influence(), "{error:e}");
        }
    }
    Ok(())
}

/// The symbol of uniform pressure on cells is a sum over all waves that look alike on the grid, however thin the layer.
#[test]
fn cells_add_up_all_waves() -> Result<(), Error> {
    let grid = Grid::new(6, 5, 1.0, 0.7)?;
    // The difference from the half-space of the uppermost layer, whose sum converges.
    const MOST: isize = 60;
    for thickness in [0.3, 1.0, 8.0] {
        for body in bodies(thickness)? {
            let mean = body.mean_compliance().unwrap_or_default();
            let symbol = periodic::cells(&grid, &body, mean)?;
            let love = PeriodicBoussinesq::new(grid, body.surface_modulus())?;
            let top = body.top_modulus();
            for (kx, ky) in [(1, 0), (0, 1), (3, 0), (2, 2), (3, 1)] {
                let mut sum = love.symbol(kx, ky);
                for (mx, my) in (-MOST..=MOST).flat_map(|mx| (-MOST..=MOST).map(move |my| (mx, my)))
                {
                    let x = kx as f64 / 6.0 + mx as f64;
                    let y = ky as f64 / 5.0 + my as f64;
                    let weight = super::super::periodic::sinc(x) * super::super::periodic::sinc(y);
                    let q = TAU * x.hypot(y / 0.7);
                    if weight.abs() > 1e-15 {
                        sum += weight * (body.reduced_compliance(q) - 2.0 / top) / q;
                    }
                }
                let found = symbol.at(kx, ky);
                // Waves beyond are left out: the uppermost of two layers is 0.09 thick, e^(−2 q h) (q h)² is 1e-27
                // there. What is added up is of the size of the symbol of the uppermost layer.
                let scale = found.max(love.symbol(kx, ky));
                let error = (found - sum).abs() / scale;
                assert!(
                    error < 1e-13,
                    "{thickness} {body:?} ({kx}, {ky}): {found} {sum} {error:e}"
                );
            }
        }
    }
    Ok(())
}

/// On a rigid base nothing is felt far away: the periodic kernel is the free one, repeated.
#[test]
fn free_layers_on_a_rigid_base_repeat_to_periodic_ones() -> Result<(), Error> {
    for (thickness, n) in [(0.05, 40), (0.3, 48), (1.0, 80)] {
        let grid = Grid::new(n, n / 2, 1.0, 2.0)?;
        for nu in [0.0, 0.3, 0.5] {
            let body = on_rigid(1.0, nu, thickness)?;
            let free = Layered::free(grid, body.clone())?;
            let symbol = periodic::cells(&grid, &body, body.mean_compliance().unwrap_or_default())?;
            let periodic = symbol.inverse_transform();
            let scale = free.coefficient(0, 0);
            let mut total = 0.0;
            let (nx, ny) = (n as isize, n as isize / 2);
            for (di, dj) in (0..nx).flat_map(|di| (0..ny).map(move |dj| (di, dj))) {
                let image =
                    |at: isize, period: isize| at - if 2 * at > period { period } else { 0 };
                let value = free.coefficient(image(di, nx), image(dj, ny));
                total += value;
                // Images are 20 to 40 cells away, 40 thicknesses and more: e^(−40) of it is left.
                let error = (value - periodic.at(di, dj)).abs() / scale;
                // A film that a cell hardly displaces at its own centre: C(0, 0) is 10⁻¹⁰ then.
                let allowed = if nu == 0.5 { 3e-14 * (0.1 / scale).max(1.0) } else { 3e-14 };
                assert!(error < allowed, "{thickness} {nu} ({di}, {dj}): {error:e}");
            }
            // All cells under the same pressure.
            let mean = body.mean_compliance().unwrap_or_default();
            let error = (total - mean).abs() / scale;
            // Of 800 to 3200 coefficients, which cancel where nothing is left on average: 3200 ε is 7·10⁻¹³.
            let allowed = if nu == 0.5 { 1e-12 * (0.1 / scale).max(1.0) } else { 1e-13 };
            assert!(error < allowed, "{thickness} {nu}: {total} {mean}");
        }
    }
    Ok(())
}

/// On an elastic half-space the difference from it falls as r⁻³: periods of 256 cells change differences of near
/// coefficients by less than rounding.
#[test]
fn free_coats_are_periodic_ones_of_long_periods() -> Result<(), Error> {
    let n = 256;
    let e_star = 1.0 / (1.0 - 0.09);
    for (dy, thicknesses) in [(1.0, &[0.05, 0.8, 2.0][..]), (1.5, &[0.8][..])] {
        let large = Grid::new(n, n, 1.0, dy)?;
        let small = Grid::new(10, 8, 1.0, dy)?;
        let below = PeriodicBoussinesq::new(large, e_star)?.with_gauge(0.0)?;
        let love = Boussinesq::new(small, e_star)?;
        for &h in thicknesses {
            for body in &bodies(h)?[..3] {
                let symbol = periodic::cells(&large, body, 0.0)?;
                let periodic = symbol.inverse_transform();
                let free = Layered::free(small, body.clone())?;
                let scale = free.coefficient(0, 0);
                let difference = |di: isize, dj: isize| {
                    let far = periodic.at(di, dj) - below.coefficient(di, dj);
                    let near = free.coefficient(di, dj) - love.coefficient(di, dj);
                    far - near
                };
                let first = difference(0, 0);
                for (di, dj) in (0..10).flat_map(|di| (0..8).map(move |dj| (di, dj))) {
                    let error = (difference(di, dj) - first).abs() / scale;
                    // Images change the sum of the second differences of r⁻³ by some 45 d² / 256⁵, and the coefficient
                    // of r⁻³ is h² / (2π E) at most ten times over. Longer cells have fewer images.
                    let square = (di * di) as f64 + dy * dy * (dj * dj) as f64;
                    let images = 4e-10 * h * h * square;
                    let context = format!("{dy} {h} {body:?} ({di}, {dj})");
                    assert!(error < 1e-12 + images, "{context}: {error:e}");
                }
            }
        }
    }
    Ok(())
}

/// What is promised of the growth of contact: soft coats and layers on a rigid base yes, stiff coats no.
#[test]
fn promises_are_those_of_the_body() -> Result<(), Error> {
    let grid = Grid::square(14, 14.0)?;
    let coat = |ratio: f64, nu: f64, h: f64| {
        LayeredBody::new(&[layer(ratio, nu, h)], half_space(1.0, 0.3))
    };
    for h in [0.05, 0.4, 2.0] {
        for body in [
            coat(0.1, 0.3, h)?,
            coat(0.01, 0.4999, h)?,
            on_rigid(1.0, 0.3, h)?,
            on_rigid(1.0, 0.4999, h)?,
            on_rigid(1.0, 0.5, h)?,
        ] {
            for made in [Layered::free, Layered::periodic, Layered::spectral] {
                let kernel = made(grid, body.clone())?;
                // Waves ring where the compliance of an incompressible layer still rises at the shortest, q = π; cells
                // do not.
                let rings = matches!(kernel.origin(), KernelOrigin::SpectralLayered { .. })
                    && body.compliance(0.505 * TAU) > body.compliance(0.5 * TAU)
                    && body.layers()[0].poissons_ratio > 0.49;
                let grows = kernel.contact_growth() >= ContactGrowth::Monotone;
                assert_eq!(grows, !rings, "{body:?}");
                check(&kernel)?;
            }
        }
    }
    for made in [Layered::free, Layered::periodic, Layered::spectral] {
        assert_eq!(made(grid, coat(10.0, 0.3, 0.4)?)?.contact_growth(), ContactGrowth::Unknown);
    }
    Ok(())
}

/// Waves of a thin incompressible layer ring: contact sets lose nodes, and nothing is promised.
#[test]
fn nothing_is_promised_of_thin_films_on_waves() -> Result<(), Error> {
    for (nx, ny) in [(40, 1), (1, 40)] {
        let grid = Grid::new(nx, ny, 1.0, 1.0)?;
        let film = Layered::spectral(grid, on_rigid(2.11, 0.5, 0.1101)?)?;
        assert_eq!(film.contact_growth(), ContactGrowth::Unknown, "{nx} x {ny}");
        assert_eq!(check(&film)?.supported_growth, ContactGrowth::Unknown, "{nx} x {ny}");
    }
    Ok(())
}

/// The thinner a coat, the less of it is left, in proportion; its cost does not grow. On one node any gauge will do.
#[test]
fn very_thin_coats_and_single_nodes() -> Result<(), Error> {
    let grid = Grid::new(6, 5, 1.0, 1.0)?;
    let steel = half_space(1.0, 0.3);
    let bare = PeriodicBoussinesq::new(grid, 1.0 / (1.0 - 0.09))?.with_gauge(0.0)?;
    for youngs_modulus in [0.1, 10.0] {
        let of_coat = |h: f64| -> Result<f64, Error> {
            let body = LayeredBody::new(&[layer(youngs_modulus, 0.2, h)], steel)?;
            let values = periodic::cells(&grid, &body, 0.0)?.inverse_transform();
            Ok(values.at(0, 0) - bare.coefficient(0, 0))
        };
        let [thick, thin, least] = [of_coat(2e-4)?, of_coat(1e-4)?, of_coat(1e-6)?];
        // The next order, h² ln h, is 10⁻³ of the first; what is left of 10⁻⁶ has ten digits.
        assert!((thick / thin - 2.0).abs() < 1e-2, "{youngs_modulus}: {thick:e} {thin:e}");
        assert!((thin / least / 100.0 - 1.0).abs() < 1e-2, "{youngs_modulus}: {thin:e} {least:e}");
    }
    let single = Grid::new(1, 1, 2.0, 1.0)?;
    for body in bodies(0.4)? {
        for made in [Layered::periodic, Layered::spectral] {
            assert!(KernelTable::new(&made(single, body.clone())?)?.self_influence() > 0.0);
        }
    }
    Ok(())
}
