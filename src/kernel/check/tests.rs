use super::*;
use crate::{Boussinesq, Grid, MeanDisplacement, PeriodicBoussinesq, Spectral};

/// Coefficients along a strip, by distance, with a promise.
fn strip(coefficients: &[f64], promised: ContactGrowth) -> Result<KernelTable, Error> {
    let grid = Grid::new(coefficients.len(), 1, 1.0, 1.0)?;
    KernelTable::from_fn(grid, Boundary::Free, promised, |di, _| coefficients[di.unsigned_abs()])
}

/// The promise, quantity, contact set and node of an error.
fn broken(result: Result<KernelReport, Error>) -> Option<(&'static str, Vec<usize>, usize)> {
    match result {
        Err(Error::Kernel(KernelError::BrokenPromise { promise, contact, node, .. })) => {
            Some((promise, contact, node.0))
        }
        _ => None,
    }
}

#[test]
fn the_half_spaces_of_this_crate_keep_their_promises() -> Result<(), Error> {
    for (nx, ny, dx, dy) in [
        (3, 3, 1.0, 1.0),
        (12, 9, 1.0, 1.0),
        (16, 16, 1.0, 2.5),
        (200, 1, 1.0, 1.0),
        (40, 31, 1e-6, 1e-6),
    ] {
        let grid = Grid::new(nx, ny, dx, dy)?;
        let free = check(&Boussinesq::new(grid, 1e9)?)?;
        assert_eq!(free.supported_growth, ContactGrowth::Convex, "{nx} x {ny}");
        assert_eq!(free.least_symbol, None);
        let kernel = PeriodicBoussinesq::new(grid, 1e9)?;
        let love = check(&kernel)?;
        // On all waves but the one of length zero. A Fourier transform rounds relative to the greatest value, which is
        // a hundred times the least.
        let waves = (0..nx as isize).flat_map(|kx| (0..ny as isize).map(move |ky| (kx, ky)));
        let symbol = waves.skip(1).map(|(kx, ky)| kernel.symbol(kx, ky));
        let least = symbol.fold(f64::INFINITY, f64::min);
        let found = love.least_symbol.unwrap_or(f64::NAN);
        assert!((found / least - 1.0).abs() < 1e-12, "{nx} x {ny}: {found:e} {least:e}");
        assert_eq!(love.promised_growth, ContactGrowth::Convex);
        assert_eq!(love.supported_growth, ContactGrowth::Convex, "{nx} x {ny}");
        let spectral = check(&Spectral::new(grid, 1e9)?)?;
        assert_eq!(spectral.promised_growth, ContactGrowth::Monotone);
        assert!(spectral.supported_growth >= ContactGrowth::Monotone);
        assert_eq!(free.exhaustive, nx * ny <= 10);
        if nx * ny <= 256 {
            assert_eq!(free.largest_contact, nx * ny);
        } else {
            // Nodes of sets that are drawn.
            assert!((32..=64).contains(&free.largest_contact), "{free:?}");
        }
        // Some 250 of more than ten nodes, of which all sets are tried.
        assert!(free.exhaustive || (200..=250).contains(&free.contact_sets), "{free:?}");
    }
    // Waves ring on any grid of some size: gaps are not convex.
    let spectral = check(&Spectral::new(Grid::square(12, 1.0)?, 1.0)?)?;
    assert_eq!(spectral.supported_growth, ContactGrowth::Monotone);
    Ok(())
}

#[test]
fn the_symbol_is_found_again() -> Result<(), Error> {
    let kernel = Spectral::new(Grid::new(9, 6, 1.0, 1.5)?, 2.0)?;
    let least = kernel.symbol(4, 3);
    let found = check(&kernel)?.least_symbol.unwrap_or(f64::NAN);
    // Two Fourier transforms of numbers up to some ten times as large.
    assert!((found / least - 1.0).abs() < 1e-13, "{found} {least}");
    // In the zero gauge the matrix is singular, and that is no fault of the kernel.
    assert!(check(&kernel.with_gauge(0.0)?).is_ok());
    Ok(())
}

#[test]
fn all_sets_of_a_small_grid_are_tried() -> Result<(), Error> {
    let report = check(&Boussinesq::new(Grid::new(3, 2, 1.0, 1.0)?, 1.0)?)?;
    assert_eq!((report.contact_sets, report.largest_contact), (63, 6));
    assert!(report.exhaustive);
    Ok(())
}

#[test]
fn a_kernel_that_is_not_positive_definite_is_found_out() -> Result<(), Error> {
    // The determinant of all three nodes is (1 − d)(1 + d − 2 c²) < 0, those of two are positive.
    let kernel = strip(&[1.0, 0.8, 0.2], ContactGrowth::Unknown)?;
    let found = broken(check(&kernel));
    assert_eq!(found, Some(("positive definite", vec![0, 1, 2], 2)));
    // On a strip of 400 nodes, of which no set drawn has more than 64, close ones are enough.
    let mut long = vec![0.0; 400];
    long[..3].copy_from_slice(&[1.0, 0.8, 0.2]);
    assert!(broken(check(&strip(&long, ContactGrowth::Unknown)?)).is_some());
    Ok(())
}

#[test]
fn broken_promises_of_growth_are_found_out() -> Result<(), Error> {
    // Positive definite, and a cell raises the surface two cells away: pushed down by its other
    // neighbours a node keeps its gap, but the gap of one that is raised closes faster.
    let raising = [1.0, 0.0, -0.4, 0.0, 0.0];
    // By hand, for contact at 0 and 2: inverse ∝ (1, 0.4; 0.4, 1), off the diagonal positive.
    let report = check(&strip(&raising, ContactGrowth::Unknown)?)?;
    assert_eq!(report.supported_growth, ContactGrowth::Monotone);
    assert!(check(&strip(&raising, ContactGrowth::Monotone)?).is_ok());
    let convex = broken(check(&strip(&raising, ContactGrowth::Convex)?));
    assert_eq!(convex, Some(("gaps are convex in the approach", vec![0, 2], 0)));

    // Strong coupling to the next node and none beyond: the pressure of the middle one of three
    // falls, y₂ ∝ 1 − 2 c < 0.
    let falling = [1.0, 0.6, 0.0];
    let report = check(&strip(&falling, ContactGrowth::Unknown)?)?;
    assert_eq!(report.supported_growth, ContactGrowth::Unknown);
    let monotone = broken(check(&strip(&falling, ContactGrowth::Monotone)?));
    // Found where the ends are in contact and the gap between them opens: r₂ = 1 − 1.2.
    let opens = "contact grows monotonically";
    assert_eq!(monotone, Some((opens, vec![0, 2], 1)));
    Ok(())
}

#[test]
fn a_periodic_kernel_with_a_wave_of_no_stiffness_is_found_out() -> Result<(), Error> {
    // Symbol 1 + 2 a cos q at four nodes: a = −1/2 makes it zero at q = 0, a = 1/2 at the last wave.
    let ring = |a: f64, mean| -> Result<KernelTable, Error> {
        let grid = Grid::new(4, 1, 1.0, 1.0)?;
        let (periodic, growth) = (Boundary::Periodic, ContactGrowth::Unknown);
        let table = KernelTable::from_fn(grid, periodic, growth, |di, _| {
            [1.0, a, 0.0, a][di.rem_euclid(4) as usize]
        })?;
        Ok(table.with_mean_displacement(mean))
    };
    let (arbitrary, physical) = (MeanDisplacement::Arbitrary, MeanDisplacement::Physical);
    let last = check(&ring(0.5, arbitrary)?);
    let pi = std::f64::consts::PI;
    assert!(
        matches!(last, Err(Error::Kernel(KernelError::SymbolNotPositive { q, .. })) if q == (pi, 0.0))
    );
    let mean = check(&ring(-0.5, physical)?);
    assert!(matches!(
        mean,
        Err(Error::Kernel(KernelError::SymbolNotPositive { q: (0.0, 0.0), .. }))
    ));
    // If it is arbitrary it may be nothing.
    assert!(check(&ring(-0.5, arbitrary)?).is_ok());
    // With a = −1/4 it is 1/2 at q = 0, and 1 at the next wave, or 3/2.
    for (mean, expected) in [(physical, 0.5), (arbitrary, 1.0)] {
        let least = check(&ring(-0.25, mean)?)?.least_symbol.unwrap_or(f64::NAN);
        assert!((least - expected).abs() < 1e-15, "{mean:?}: {least}");
    }
    Ok(())
}

#[test]
fn coefficients_that_make_no_sense_are_refused_first() -> Result<(), Error> {
    struct Skew(Grid);
    impl InfluenceKernel for Skew {
        fn grid(&self) -> Grid {
            self.0
        }
        fn boundary(&self) -> Boundary {
            Boundary::Free
        }
        fn coefficient(&self, di: isize, _dj: isize) -> f64 {
            1.0 / (1.0 + (di as f64 - 0.1).abs())
        }
    }
    let refused = check(&Skew(Grid::new(4, 1, 1.0, 1.0)?));
    assert!(matches!(refused, Err(Error::Kernel(KernelError::NotSymmetric { .. }))));
    Ok(())
}

/// A kernel whose grid shrinks with every call gets an answer.
#[test]
fn a_grid_that_changes_is_no_cause_for_panic() {
    struct Shrinking(std::cell::Cell<usize>);
    impl InfluenceKernel for Shrinking {
        fn grid(&self) -> Grid {
            let n = self.0.get();
            self.0.set(n.saturating_sub(1).max(1));
            Grid::new(n, n, 1.0, 1.0).unwrap_or_else(|_| unreachable!())
        }
        fn boundary(&self) -> Boundary {
            Boundary::Free
        }
        fn coefficient(&self, di: isize, dj: isize) -> f64 {
            1.0 / (1.0 + (di * di + dj * dj) as f64)
        }
    }
    let table = KernelTable::new(&Shrinking(std::cell::Cell::new(5)));
    assert!(table.is_ok_and(|table| table.grid().shape() == (5, 5)));
    assert!(check(&Shrinking(std::cell::Cell::new(5))).is_ok());
}
