//! The Boussinesq kernel against Love's closed form in arbitrary precision.

use asperity::{Boussinesq, Error, Grid, InfluenceKernel};
use astro_float_num::{BigFloat, Consts, RoundingMode};

/// Sides of the cells, long over short; each is tried both ways round. The last is far beyond what
/// the documentation promises.
const ASPECTS: [f64; 9] = [1.0, 1.001, 1.5, 2.0, 3.0, 10.0, 31.6, 100.0, 1e6];

/// What the crate promises at every offset up to `FARTHEST` cells.
const PROMISED: f64 = 1e-14;

/// Twice what was measured, which is two units in the last place.
const EXPECTED: f64 = 1e-15;

const FARTHEST: usize = 4096;

/// Love's formula, eq. (3) of the paper for a rectangle, at 320 bits.
///
/// At (4096, 4096) and an aspect of 100 its terms are some 2^60 times the sum, and the logarithms
/// of negative offsets lose 40 bits more: 200 bits and more remain.
struct Oracle {
    constants: Consts,
    dx: BigFloat,
    dy: BigFloat,
    pi_e_star: BigFloat,
}

const BITS: usize = 320;
const NEAREST: RoundingMode = RoundingMode::ToEven;

fn big(value: f64) -> BigFloat {
    BigFloat::from_f64(value, BITS)
}
fn add(a: &BigFloat, b: &BigFloat) -> BigFloat {
    a.add(b, BITS, NEAREST)
}
fn sub(a: &BigFloat, b: &BigFloat) -> BigFloat {
    a.sub(b, BITS, NEAREST)
}
fn mul(a: &BigFloat, b: &BigFloat) -> BigFloat {
    a.mul(b, BITS, NEAREST)
}
fn div(a: &BigFloat, b: &BigFloat) -> BigFloat {
    a.div(b, BITS, NEAREST)
}

/// The nearest double, or its neighbour.
fn to_f64(value: &BigFloat) -> f64 {
    if value.is_zero() {
        return 0.0;
    }
    let (words, _, sign, exponent, _) = value.as_raw_parts().expect("not a number");
    let mantissa = words[words.len() - 1] as f64 * 0.5f64.powi(64);
    let magnitude = mantissa * 2f64.powi(exponent);
    if sign.is_positive() { magnitude } else { -magnitude }
}

impl Oracle {
    fn new(grid: Grid, e_star: f64) -> Self {
        let mut constants = Consts::new().expect("constants");
        let pi = constants.pi(BITS, NEAREST);
        Self {
            constants,
            dx: big(grid.dx()),
            dy: big(grid.dy()),
            pi_e_star: mul(&pi, &big(e_star)),
        }
    }

    fn coefficient(&mut self, di: usize, dj: usize) -> BigFloat {
        let x = |shift: f64| mul(&big(di as f64 + shift), &self.dx);
        let y = |shift: f64| mul(&big(dj as f64 + shift), &self.dy);
        let (xm, xp, ym, yp) = (x(-0.5), x(0.5), y(-0.5), y(0.5));
        let r = |x: &BigFloat, y: &BigFloat| add(&mul(x, x), &mul(y, y)).sqrt(BITS, NEAREST);
        let (rmm, rmp, rpm, rpp) = (r(&xm, &ym), r(&xm, &yp), r(&xp, &ym), r(&xp, &yp));
        let mut term = |factor: &BigFloat, upper: [&BigFloat; 2], lower: [&BigFloat; 2]| {
            let ratio = div(&add(upper[0], upper[1]), &add(lower[0], lower[1]));
            mul(factor, &ratio.ln(BITS, NEAREST, &mut self.constants))
        };
        let terms = [
            term(&xp, [&yp, &rpp], [&ym, &rpm]),
            term(&yp, [&xp, &rpp], [&xm, &rmp]),
            term(&xm, [&ym, &rmm], [&yp, &rmp]),
            term(&ym, [&xm, &rmm], [&xp, &rpm]),
        ];
        let sum = terms.iter().fold(big(0.0), |sum, term| add(&sum, term));
        div(&sum, &self.pi_e_star)
    }
}

/// Every offset up to 20 cells, and rays in five directions on which each distance is 2 % above
/// the last: whatever the kernel does from some distance on is met within 2 % of it.
fn offsets(aspect_x: f64) -> Vec<(usize, usize)> {
    let mut offsets = Vec::new();
    for di in 0..=20 {
        for dj in 0..=20 {
            offsets.push((di, dj));
        }
    }
    for direction in 0..=4 {
        let angle = f64::from(direction) * std::f64::consts::FRAC_PI_8;
        // In units of the shorter side.
        let unit_x = aspect_x.max(1.0);
        let unit_y = (1.0 / aspect_x).max(1.0);
        let mut distance = 20.0;
        loop {
            let di = (distance * angle.cos() / unit_x).round() as usize;
            let dj = (distance * angle.sin() / unit_y).round() as usize;
            if di > FARTHEST || dj > FARTHEST {
                break;
            }
            offsets.push((di, dj));
            distance *= 1.02;
        }
    }
    let far = [0, 1, 63, 511, 2047, FARTHEST - 1, FARTHEST];
    for di in far {
        for dj in far {
            offsets.push((di, dj));
        }
    }
    offsets.sort_unstable();
    offsets.dedup();
    offsets
}

/// Greatest relative error, and the offset at which it is found.
fn worst_error(dx: f64, dy: f64, e_star: f64) -> (f64, (usize, usize), usize) {
    let grid = Grid::new(8, 8, dx, dy).expect("grid");
    let kernel = Boussinesq::new(grid, e_star).expect("kernel");
    let mut oracle = Oracle::new(grid, e_star);
    let mut worst = (0.0, (0, 0));
    let offsets = offsets(dx / dy);
    for &(di, dj) in &offsets {
        let exact = oracle.coefficient(di, dj);
        let value = big(kernel.coefficient(di as isize, dj as isize));
        let error = to_f64(&div(&sub(&value, &exact), &exact)).abs();
        assert!(error.is_finite());
        if error > worst.0 {
            worst = (error, (di, dj));
        }
    }
    (worst.0, worst.1, offsets.len())
}

#[test]
fn agrees_with_love_in_arbitrary_precision() {
    // A modulus and a cell without any special binary digits.
    let (side, e_star) = (1.3e-7, 2.1e11);
    let shapes: Vec<(f64, f64)> = ASPECTS
        .iter()
        .flat_map(|&aspect| [(side * aspect, side), (side, side * aspect)])
        .skip(1)
        .collect();
    let results: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = shapes
            .iter()
            .map(|&(dx, dy)| scope.spawn(move || worst_error(dx, dy, e_star)))
            .collect();
        threads.into_iter().map(|thread| thread.join()).collect()
    });
    for (&(dx, dy), result) in shapes.iter().zip(results) {
        let (error, offset, count) = result.expect("thread");
        println!(
            "{:>7.3} : {:<7.3} worst relative error {error:.2e} at {offset:?} of {count} offsets",
            dx / side,
            dy / side
        );
        assert!(error < PROMISED, "{error:e} at {offset:?} on {dx} x {dy}");
        assert!(error < EXPECTED, "{error:e} at {offset:?} on {dx} x {dy}");
    }
}

fn square_kernel() -> Boussinesq {
    // Δ / (π E*) = 1 to rounding.
    let grid = Grid::new(16, 16, std::f64::consts::PI, std::f64::consts::PI).expect("grid");
    Boussinesq::new(grid, 1.0).expect("kernel")
}

#[test]
fn agrees_with_tabulated_values() {
    // (π E* / Δ) C from the closed form at 40 digits, rounded to the nearest double.
    let table = [
        ((0, 0), 3.525494348078172),
        ((1, 0), 1.038049735904756),
        ((1, 1), 0.72469743813433),
        ((2, 0), 0.5050919830751175),
        ((2, 1), 0.45108898834921984),
        ((3, 0), 0.3348613702143002),
        ((10, 0), 0.10004163016690379),
        ((10, 7), 0.08194614720844572),
        ((100, 0), 0.010000041666302079),
        ((1000, 3), 0.0009999955416964753),
    ];
    let kernel = square_kernel();
    for ((di, dj), expected) in table {
        let value = kernel.coefficient(di, dj);
        // The kernel's own 5e-16, and the rounding of the table and of Δ / (π E*) = 1.
        assert!((value / expected - 1.0).abs() < 1e-15, "({di}, {dj}): {value}");
    }
}

#[test]
fn own_cell_of_a_square() {
    let grid = Grid::square(128, 1e-3).expect("grid");
    let kernel = Boussinesq::new(grid, 7.3e10).expect("kernel");
    let exact =
        4.0 * (1.0 + 2f64.sqrt()).ln() * grid.dx() / (std::f64::consts::PI * kernel.e_star());
    // Rounding errors of the formula here, and of the kernel.
    assert!((kernel.coefficient(0, 0) / exact - 1.0).abs() < 1e-15);
}

#[test]
fn far_away_a_square_is_almost_a_point() {
    let kernel = square_kernel();
    for (di, dj) in [(300, 0), (0, 500), (800, 900), (4096, 4095), (-3000, 77)] {
        let r = (di as f64).hypot(dj as f64);
        let tail = (1.0 + 1.0 / (24.0 * r * r)) / r;
        // The next multipole is at most <s^4> / r^4 of the whole, <s^4> = 7/180 on a unit square.
        let tolerance = 1e-15 + 0.039 / r.powi(4);
        let value = kernel.coefficient(di, dj);
        assert!((value / tail - 1.0).abs() < tolerance, "({di}, {dj})");
    }
}

#[test]
fn symmetries_hold_bit_for_bit() {
    for (dx, dy) in [(1.0, 1.0), (2.5, 1.0), (0.3, 7.0)] {
        let kernel = Boussinesq::new(Grid::new(4, 4, dx, dy).expect("grid"), 3.0).expect("kernel");
        let turned = Boussinesq::new(Grid::new(4, 4, dy, dx).expect("grid"), 3.0).expect("kernel");
        for di in 0..40 {
            for dj in 0..40 {
                let value = kernel.coefficient(di, dj);
                assert_eq!(value, kernel.coefficient(-di, dj));
                assert_eq!(value, kernel.coefficient(di, -dj));
                assert_eq!(value, kernel.coefficient(-di, -dj));
                assert_eq!(value, turned.coefficient(dj, di));
                if dx == dy {
                    assert_eq!(value, kernel.coefficient(dj, di));
                }
            }
        }
    }
}

#[test]
fn falls_with_distance_across_every_switch() {
    for (dx, dy) in [(1.0, 1.0), (10.0, 1.0), (1.0, 100.0)] {
        let kernel = Boussinesq::new(Grid::new(4, 4, dx, dy).expect("grid"), 1.0).expect("kernel");
        for d in 0..FARTHEST as isize {
            assert!(kernel.coefficient(d + 1, 0) < kernel.coefficient(d, 0));
            assert!(kernel.coefficient(0, d + 1) < kernel.coefficient(0, d));
            assert!(kernel.coefficient(d + 1, d + 1) < kernel.coefficient(d, d));
        }
    }
}

#[test]
fn scales_exactly_with_cell_and_modulus() {
    // Powers of two: nothing rounds.
    let unit = Boussinesq::new(Grid::new(4, 4, 3.0, 1.0).expect("grid"), 1.0).expect("kernel");
    let (cell, modulus) = (2f64.powi(-500), 2f64.powi(400));
    let grid = Grid::new(4, 4, 3.0 * cell, cell).expect("grid");
    let tiny = Boussinesq::new(grid, modulus).expect("kernel");
    for (di, dj) in [(0, 0), (1, 0), (0, 1), (3, 5), (17, 2), (4096, 4096)] {
        assert_eq!(tiny.coefficient(di, dj), unit.coefficient(di, dj) * cell / modulus);
    }
}

#[test]
fn absurd_offsets_and_cells_are_answered() {
    for aspect in [1.0, 100.0, 1e100] {
        let grid = Grid::new(4, 4, aspect, 1.0).expect("grid");
        let kernel = Boussinesq::new(grid, 1.0).expect("kernel");
        let extremes = [isize::MIN, -1, 0, 1, isize::MAX];
        for di in extremes {
            for dj in extremes {
                let value = kernel.coefficient(di, dj);
                assert!(value.is_finite() && value > 0.0, "({di}, {dj}): {value}");
            }
        }
    }
}

#[test]
fn refuses_what_has_no_answer() {
    let grid = Grid::new(4, 4, 1e-6, 1e-6).expect("grid");
    for e_star in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Boussinesq::new(grid, e_star), Err(Error::NotPositive { .. })));
    }
    // C(0, 0) overflows.
    let huge = Grid::new(4, 4, 1e120, 1e120).expect("grid");
    assert!(matches!(Boussinesq::new(huge, 1e-300), Err(Error::NotPositive { .. })));
    let needle = Grid::new(4, 4, 1e60, 1e-60).expect("grid");
    assert!(matches!(Boussinesq::new(needle, 1.0), Err(Error::OutOfRange { .. })));
}
