//! The map in the files of `tests/data/surface_files`, for the tests of their readers.

use std::path::{Path, PathBuf};

use super::{MeasuredSurface, ReadOptions};
use crate::Error;

/// Height of node (ix, iy) in nanometres.
fn height(ix: usize, iy: usize) -> f64 {
    let (x, y) = (ix as f64, iy as f64);
    100.0 * x + 17.0 * y * y - 3.0 * x * y - 250.0
}

/// Nodes along x and y.
const SHAPE: (usize, usize) = (7, 5);

/// What files lack whose name begins with "missing".
const MISSING: [(usize, usize); 2] = [(2, 1), (6, 4)];

pub(super) fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/surface_files").join(name)
}

/// Asserts that a file holds the map to `digits` (relative to the height of each node), with cells of 2 µm × 3 µm if
/// `sized`, and returns what was read.
pub(super) fn assert_read(
    name: &str,
    options: &ReadOptions,
    digits: f64,
    sized: bool,
) -> Result<MeasuredSurface, Error> {
    let measured = options.read(path(name))?;
    assert_eq!(measured.heights.shape(), SHAPE, "{name}");
    let lacks = !name.starts_with("plain");
    for iy in 0..SHAPE.1 {
        for ix in 0..SHAPE.0 {
            let (found, expected) = (measured.heights[(ix, iy)], height(ix, iy) * 1e-9);
            if lacks && MISSING.contains(&(ix, iy)) {
                assert!(found.is_nan(), "{name}: {found} at ({ix}, {iy})");
            } else {
                let error = (found - expected).abs();
                assert!(
                    error <= digits * expected.abs(),
                    "{name}: {found} at ({ix}, {iy}), but {expected} was expected"
                );
            }
        }
    }
    assert_eq!(measured.missing, if lacks { 2 } else { 0 }, "{name}");
    assert_eq!(measured.cell.is_some(), sized, "{name}");
    if let Some((dx, dy)) = measured.cell {
        // Sides and spacings are written with digits that end; a division and a unit round.
        assert!((dx / 2e-6 - 1.0).abs() < 1e-14, "{name}: dx = {dx}");
        assert!((dy / 3e-6 - 1.0).abs() < 1e-14, "{name}: dy = {dy}");
    }
    Ok(measured)
}
