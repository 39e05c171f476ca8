//! Convolution against direct summation, the definition.

use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::tuning::{BLOCK, PARALLEL_NODES, PARTS};
use super::{Convolution, direct_sum};
use crate::kernel::KernelTable;
use crate::{
    Boundary, ContactGrowth, Error, Grid, InfluenceKernel, KernelError, MeanDisplacement,
    PeriodicBoussinesq, Spectral,
};

/// 1 / √(1 + r²): as slow a decay as Boussinesq's, so that a wrong padding shows.
struct Slow(Grid);

impl InfluenceKernel for Slow {
    fn grid(&self) -> Grid {
        self.0
    }
    fn boundary(&self) -> Boundary {
        Boundary::Free
    }
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        let (x, y) = (di as f64 * self.0.dx(), dj as f64 * self.0.dy());
        1.0 / (1.0 + x * x + y * y).sqrt()
    }
}

/// A skew Gaussian: C(−d) = C(d), but no mirror symmetry, C(di, −dj) ≠ C(di, dj).
struct Skew(Grid);

impl InfluenceKernel for Skew {
    fn grid(&self) -> Grid {
        self.0
    }
    fn boundary(&self) -> Boundary {
        Boundary::Free
    }
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        let (x, y) = (di as f64, dj as f64);
        (-(0.02 * x * x + 0.03 * x * y + 0.05 * y * y)).exp()
    }
}

/// The skew Gaussian and its images in all periods that it reaches.
struct SkewImages(Grid);

impl InfluenceKernel for SkewImages {
    fn grid(&self) -> Grid {
        self.0
    }
    fn boundary(&self) -> Boundary {
        Boundary::Periodic
    }
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        let (nx, ny) = (self.0.nx() as isize, self.0.ny() as isize);
        let (di, dj) = (di.rem_euclid(nx), dj.rem_euclid(ny));
        // Beyond 60 cells the Gaussian is below exp(−49), whatever the direction.
        let periods = |n: isize| -60 / n - 1..=60 / n;
        let images = periods(nx).flat_map(|a| periods(ny).map(move |b| (a * nx, b * ny)));
        let skew = Skew(self.0);
        images.map(|(x, y)| skew.coefficient(di + x, dj + y)).sum()
    }
}

fn random_field(grid: &Grid, seed: u64) -> DMatrix<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    DMatrix::from_fn(grid.nx(), grid.ny(), |_, _| rng.random_range(-1.0..1.0))
}

#[track_caller]
fn assert_same_field(found: &[f64], expected: &[f64], what: &str) {
    // A transform of N points errs by about eps log2 N, here 2.2e-16 * 14, of the root mean square.
    // Random signs make max |u| smaller than the sum of the |terms| by up to the square root of the
    // number of nodes, 65, and a few such errors add up: 1e-12. Worst error measured: 1e-15.
    const TOLERANCE: f64 = 1e-12;
    let scale = expected.iter().fold(0.0_f64, |max, u| max.max(u.abs()));
    for (node, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (found - expected).abs();
        assert!(
            error <= TOLERANCE * scale,
            "{what}, node {node}: {found} instead of {expected}, error / max |u| = {:e}",
            error / scale
        );
    }
}

fn compare_with_direct_sum(kernel: &dyn InfluenceKernel) -> Result<(), Error> {
    let grid = kernel.grid();
    let mut convolution = Convolution::new(kernel)?;
    let what = format!("{convolution:?}");
    let dense = random_field(&grid, 1);
    // Only every third row, and there only half of the nodes, carries pressure.
    let sparse = random_field(&grid, 2)
        .map_with_location(|_, iy, value| if iy % 3 == 1 { value.max(0.0) } else { 0.0 });
    let expected = [direct_sum(kernel, &dense)?, direct_sum(kernel, &sparse)?];
    for (pressure, expected) in [&dense, &sparse].into_iter().zip(&expected) {
        let found = convolution.convolve(pressure)?;
        assert_same_field(found.as_slice(), expected.as_slice(), &what);
    }
    let mut found = [vec![f64::NAN; grid.nodes()], vec![f64::NAN; grid.nodes()]];
    let [first, second] = &mut found;
    convolution.apply_two([dense.as_slice(), sparse.as_slice()], [first, second])?;
    for (found, expected) in found.iter().zip(&expected) {
        assert_same_field(found, expected.as_slice(), &what);
    }
    Ok(())
}

const SHAPES: [(usize, usize); 12] = [
    (1, 1),
    (1, 7),
    (13, 1),
    (2, 2),
    (3, 5),
    (8, 8),
    (9, 16),
    (17, 31),
    (31, 17),
    (24, 10),
    (16, 33),
    (40, 23),
];

#[test]
fn equals_direct_sum_with_a_slow_kernel() -> Result<(), Error> {
    for (nx, ny) in SHAPES {
        compare_with_direct_sum(&Slow(Grid::new(nx, ny, 1.0, 0.7)?))?;
    }
    Ok(())
}

#[test]
fn equals_direct_sum_without_mirror_symmetry() -> Result<(), Error> {
    for (nx, ny) in SHAPES {
        compare_with_direct_sum(&Skew(Grid::new(nx, ny, 1.0, 1.0)?))?;
    }
    Ok(())
}

#[test]
fn equals_direct_sum_on_periodic_grids() -> Result<(), Error> {
    for (nx, ny) in SHAPES {
        let grid = Grid::new(nx, ny, 1.0, 0.7)?;
        compare_with_direct_sum(&PeriodicBoussinesq::new(grid, 1.0)?)?;
        compare_with_direct_sum(&Spectral::new(grid, 1.0)?)?;
        compare_with_direct_sum(&SkewImages(grid))?;
    }
    Ok(())
}

#[test]
fn equals_direct_sum_on_periodic_grids_with_several_parts() -> Result<(), Error> {
    compare_with_direct_sum(&PeriodicBoussinesq::new(parallel_grid()?, 1.0)?)
}

#[test]
fn periodic_grids_are_not_padded() -> Result<(), Error> {
    // Two primes, which no fast length comes near.
    let grid = Grid::new(37, 53, 1.0, 1.0)?;
    let convolution = Convolution::new(&Spectral::new(grid, 1.0)?)?;
    assert_eq!(convolution.engine.padded(), (37, 53));
    Ok(())
}

#[test]
fn a_wave_answers_with_the_symbol_and_a_constant_with_the_gauge() -> Result<(), Error> {
    for (nx, ny) in [(9, 14), (16, 5), (1, 8), (1, 1)] {
        let kernel = PeriodicBoussinesq::new(Grid::new(nx, ny, 1.0, 1.3)?, 1.0)?;
        let mut convolution = Convolution::new(&kernel)?;
        let scale = kernel.gauge() * (nx * ny) as f64;
        let uniform = convolution.convolve(&DMatrix::repeat(nx, ny, 2.0))?;
        for (kx, ky) in [(0, 1), (nx / 2, 0), (nx / 3, ny / 2)] {
            let wave = DMatrix::from_fn(nx, ny, |ix, iy| {
                let turns = (kx * ix) as f64 / nx as f64 + (ky * iy) as f64 / ny as f64;
                (std::f64::consts::TAU * turns).cos()
            });
            if (kx, ky % ny) == (0, 0) {
                continue;
            }
            let symbol = kernel.symbol(kx as isize, ky as isize);
            let expected = symbol * &wave;
            // Tables, coefficients and transforms round relative to the largest symbol, the
            // constant's; the wave's argument is rounded too.
            let error = (convolution.convolve(&wave)? - expected).amax();
            assert!(error < 1e-14 * scale, "({kx}, {ky}): {error:e}");
        }
        let error = uniform.map(|u| (u - 2.0 * scale).abs()).amax();
        assert!(error < 1e-14 * scale, "{nx} x {ny}: {error:e}");
    }
    Ok(())
}

/// A grid just large enough for threads, with incomplete blocks on both sides.
fn parallel_grid() -> Result<Grid, Error> {
    let grid = Grid::new(100, 93, 1.0, 1.0)?;
    assert!(grid.nodes() >= PARALLEL_NODES);
    Ok(grid)
}

#[test]
fn equals_direct_sum_with_several_parts() -> Result<(), Error> {
    compare_with_direct_sum(&Skew(parallel_grid()?))
}

#[test]
fn parts_and_threads_do_not_change_a_bit() -> Result<(), Box<dyn std::error::Error>> {
    let kernel = Slow(parallel_grid()?);
    let pressure = random_field(&kernel.grid(), 3);
    let mut convolution = Convolution::new(&kernel)?;
    let parts = convolution.engine.spectra.scratch.len();
    let mut one_part = convolution.clone();
    one_part.engine.spectra.scratch.truncate(1);
    let expected = one_part.convolve(&pressure)?;
    #[cfg(feature = "rayon")]
    for threads in [1, 2, 3] {
        assert!(parts > 1);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let (fresh, used) = pool.build()?.install(|| {
            let fresh = Convolution::new(&kernel)?.convolve(&pressure)?;
            Ok::<_, Error>((fresh, convolution.convolve(&pressure)?))
        })?;
        assert_eq!(fresh, expected);
        assert_eq!(used, expected);
    }
    #[cfg(not(feature = "rayon"))]
    {
        assert_eq!(parts, 1);
        assert_eq!(convolution.convolve(&pressure)?, expected);
    }
    Ok(())
}

#[test]
fn a_field_leaves_no_trace_in_the_next() -> Result<(), Error> {
    let kernel = Slow(Grid::new(12, 9, 1.0, 1.0)?);
    let mut convolution = Convolution::new(&kernel)?;
    let nothing = DMatrix::zeros(12, 9);
    let before = convolution.convolve(&random_field(&kernel.grid(), 4))?;
    assert!(before.amax() > 0.0);
    assert_eq!(convolution.convolve(&nothing)?, nothing);
    let again = convolution.convolve(&random_field(&kernel.grid(), 4))?;
    assert_eq!(again, before);
    Ok(())
}

#[test]
fn refuses_wrong_lengths_and_shapes() -> Result<(), Error> {
    let mut convolution = Convolution::new(&Slow(Grid::new(4, 3, 1.0, 1.0)?))?;
    let (right, mut wrong) = (vec![0.0; 12], vec![0.0; 11]);
    let mut displacement = vec![0.0; 12];
    let mut second = vec![0.0; 12];
    let refused = |result| matches!(result, Err(Error::LengthMismatch { expected: 12, found: 11 }));
    assert!(refused(convolution.apply(&wrong, &mut displacement)));
    assert!(refused(convolution.apply(&right, &mut wrong)));
    let result = convolution.apply_two([&right, &wrong], [&mut displacement, &mut second]);
    assert!(refused(result));
    let result = convolution.apply_two([&right, &right], [&mut displacement, &mut wrong]);
    assert!(refused(result));
    assert!(matches!(
        convolution.convolve(&DMatrix::zeros(3, 4)),
        Err(Error::GridMismatch { expected: (4, 3), found: (3, 4) })
    ));
    Ok(())
}

#[test]
fn refuses_values_that_are_not_finite() -> Result<(), Error> {
    let mut convolution = Convolution::new(&Slow(Grid::new(4, 3, 1.0, 1.0)?))?;
    let mut pressure = DMatrix::zeros(4, 3);
    pressure[(3, 1)] = f64::INFINITY;
    assert!(matches!(
        convolution.convolve(&pressure),
        Err(Error::FieldNotFinite { field: "pressure", ix: 3, iy: 1, .. })
    ));
    Ok(())
}

#[test]
fn refuses_a_kernel_whose_sum_overflows() -> Result<(), Error> {
    struct Huge(Grid);
    impl InfluenceKernel for Huge {
        fn grid(&self) -> Grid {
            self.0
        }
        fn boundary(&self) -> Boundary {
            Boundary::Free
        }
        fn coefficient(&self, _: isize, _: isize) -> f64 {
            1e308
        }
    }
    let kernel = Huge(Grid::new(2, 2, 1.0, 1.0)?);
    assert!(matches!(Convolution::new(&kernel), Err(Error::OutOfRange { .. })));
    Ok(())
}

#[test]
fn memory_counts_symbol_and_spectra() -> Result<(), Error> {
    let grid = Grid::new(100, 100, 1.0, 1.0)?;
    let convolution = Convolution::new(&Slow(grid))?;
    let (px, py) = convolution.engine.padded();
    assert!(px >= 199 && py >= 199);
    let columns = px / 2 + 1;
    let least = 8 * columns * py + 2 * 16 * columns * grid.ny();
    // Working memory: each part has the columns of a block, and less than as much again.
    let working = 2 * PARTS * BLOCK * py * 16;
    assert!(convolution.bytes() > least && convolution.bytes() < least + working);
    Ok(())
}

/// Short waves that hardly displace anything are positive still, as far as rounding of a sum of all
/// coefficients can tell: some 10⁻¹⁵ of the greatest.
#[test]
fn waves_that_hardly_answer_are_accepted() -> Result<(), Error> {
    let grid = Grid::square(32, 1.0)?;
    let shortest = std::f64::consts::PI * 32.0 * std::f64::consts::SQRT_2;
    let check = |least: f64| {
        let symbol = |qx: f64, qy: f64| least.powf(qx.hypot(qy) / shortest);
        let (mean, growth) = (MeanDisplacement::Physical, ContactGrowth::Unknown);
        let table = KernelTable::from_symbol(grid, mean, growth, symbol)?;
        Convolution::from_table(&table)?.check_definite(&table)
    };
    check(1e-9)?;
    let rounded = check(1e-18);
    assert!(
        matches!(rounded, Err(Error::Kernel(KernelError::SymbolNotPositive { .. }))),
        "{rounded:?}"
    );
    Ok(())
}

/// What is said before there is a convolution is what it says itself.
#[test]
fn memory_is_known_beforehand() -> Result<(), Error> {
    for (nx, ny) in [(100, 37), (1, 50), (64, 64)] {
        let grid = Grid::new(nx, ny, 1.0, 1.0)?;
        let free = Convolution::new(&Slow(grid))?.bytes();
        assert_eq!(Convolution::bytes_on(&grid, Boundary::Free), free);
        let periodic = Convolution::new(&PeriodicBoussinesq::new(grid, 1.0)?)?.bytes();
        assert_eq!(Convolution::bytes_on(&grid, Boundary::Periodic), periodic);
    }
    Ok(())
}

/// The tables themselves would fill the screen.
#[test]
fn a_convolution_shows_its_size() -> Result<(), Error> {
    let grid = Grid::new(8, 6, 1.0, 0.5)?;
    let convolution = Convolution::new(&Spectral::new(grid, 1.0)?)?;
    let (double, single) = (&convolution, convolution.to_single());
    for shown in [format!("{double:?}"), format!("{single:?}")] {
        assert!(shown.contains("padded: (8, 6)"), "{shown}");
        assert!(shown.len() < 200, "{shown}");
    }
    Ok(())
}
