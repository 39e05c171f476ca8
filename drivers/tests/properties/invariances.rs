//! What must not matter: units, axes, the place of a period, windows, updaters, threads.

use std::collections::BTreeSet;

use asperity::updater::{ConjugateGradient, Dense, Handover, RecursiveCholesky};
use asperity::{Error, LoadingState};
use proptest::prelude::*;

use crate::case::{Body, Case, case, failed};
use crate::same::{EXACT, SAME, Scale, bits, same_path};

/// What states without a factor may be off: 10⁻⁵ at worst on large grids, and a window is a large part of so short a
/// path.
const ITERATED: f64 = 3e-4;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// Heights λ times as high on cells μ times as long, with a modulus ν times as large: approaches λ times, loads λμν
    /// times.
    #[test]
    fn units_do_not_matter(
        case in case(),
        exponents in (-3.0..3.0, -3.0..3.0, -3.0..3.0),
    ) {
        let [height, cell, modulus] = [exponents.0, exponents.1, exponents.2]
            .map(|exponent: f64| 10_f64.powf(exponent));
        let other = Case {
            cell: (cell * case.cell.0, cell * case.cell.1),
            e_star: modulus * case.e_star,
            heights: case.heights.iter().map(|z| height * z).collect(),
            ..case.clone()
        };
        let scale = Scale { length: height, load: height * cell * modulus };
        let expected = case.states().map_err(failed)?;
        let found = other.states().map_err(failed)?;
        same_path(&found, &expected, |node| node, scale, EXACT)?;
    }

    /// Only differences of heights count: a constant rounds them, by as much as it is larger.
    #[test]
    fn a_constant_height_does_not_matter(case in case(), constant in -1e-3..1e-3) {
        let other = Case {
            heights: case.heights.iter().map(|z| z + constant).collect(),
            ..case.clone()
        };
        let expected = case.states().map_err(failed)?;
        let found = other.states().map_err(failed)?;
        // Heights of 1e-5 next to a constant of 1e-3 keep 2e-14 of themselves, and pressures lose the condition number.
        let levels: BTreeSet<u64> = case.heights.iter().map(|z| z.to_bits()).collect();
        // Ties come apart, and in which order is a matter of rounding.
        if levels.len() == case.heights.len() {
            same_path(&found, &expected, |node| node, SAME, 10.0 * EXACT)?;
        }
    }

    /// The grid mirrored in x, in y, and turned by a right angle.
    #[test]
    fn axes_do_not_matter(case in case()) {
        let expected = case.states().map_err(failed)?;
        let (nx, ny) = case.nodes;
        let in_x = case.seen(case.nodes, case.cell, |ix, iy| (nx - 1 - ix, iy));
        let in_y = case.seen(case.nodes, case.cell, |ix, iy| (ix, ny - 1 - iy));
        let turned = case.seen((ny, nx), (case.cell.1, case.cell.0), |ix, iy| (iy, ny - 1 - ix));
        let found = in_x.states().map_err(failed)?;
        same_path(&found, &expected, |(ix, iy)| (nx - 1 - ix, iy), SAME, EXACT)?;
        let found = in_y.states().map_err(failed)?;
        same_path(&found, &expected, |(ix, iy)| (ix, ny - 1 - iy), SAME, EXACT)?;
        let found = turned.states().map_err(failed)?;
        same_path(&found, &expected, |(ix, iy)| (iy, ny - 1 - ix), SAME, EXACT)?;
    }

    /// A periodic half-space begins nowhere.
    #[test]
    fn periodic_surfaces_may_be_moved(case in case(), by in (0_usize..40, 0_usize..40)) {
        prop_assume!(case.body != Body::Free);
        let expected = case.states().map_err(failed)?;
        let (nx, ny) = case.nodes;
        let place = |(ix, iy): (usize, usize)| ((ix + by.0) % nx, (iy + by.1) % ny);
        let moved = case.seen(case.nodes, case.cell, |ix, iy| place((ix, iy)));
        let found = moved.states().map_err(failed)?;
        same_path(&found, &expected, place, SAME, EXACT)?;
    }

    /// Any window and any updater with a factor: one path. Without a factor the same events, and nearly the same
    /// states.
    #[test]
    fn windows_and_updaters_do_not_matter(
        case in case(),
        window in 1_usize..60,
    ) {
        let expected = case.path(RecursiveCholesky::new(), Some(1)).map_err(failed)?;
        let same = |found: Result<Vec<LoadingState>, Error>, allowed| {
            same_path(&found.map_err(failed)?, &expected, |node| node, SAME, allowed)
        };
        same(case.path(RecursiveCholesky::new(), None), EXACT)?;
        same(case.path(RecursiveCholesky::new(), Some(window)), EXACT)?;
        same(case.path(Dense::new(), Some(window)), EXACT)?;
        same(case.path(Handover::new(), Some(window)), EXACT)?;
        same(case.path(ConjugateGradient::new(), None), ITERATED)?;
    }

    /// Any number of threads: the same bits.
    #[test]
    fn threads_do_not_matter(case in case(), threads in 2_usize..5) {
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let pool = pool.map_err(|error| TestCaseError::fail(error.to_string()))?;
            pool.install(|| {
                let factor = case.path(RecursiveCholesky::new(), None)?;
                Ok((factor, case.path(ConjugateGradient::new(), None)?))
            })
            .map_err(failed)
        };
        let (one, many) = (run(1)?, run(threads)?);
        prop_assert_eq!(bits(&one.0), bits(&many.0));
        prop_assert_eq!(bits(&one.1), bits(&many.1));
    }
}
