//! Heights of every sort that makes a path hard: ties, plateaus, peaks, pits.

use asperity_testing::surfaces::smooth;
use nalgebra::DMatrix;

use crate::draw::Draw;

/// How heights are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Class {
    /// Two bytes for each node: what a fuzzer can work on.
    Given,
    /// Independent heights.
    Noise,
    /// Independent heights averaged over their neighbours.
    Smooth,
    /// A few levels, each at many nodes.
    Quantised,
    /// Noise, worn down to a plateau.
    Worn,
    /// Noise that mirrors itself along x and along y.
    Symmetric,
    Paraboloid,
    Wave,
    Steps,
    /// Flat but for a few peaks.
    Spikes,
    /// Flat but for a few holes.
    Pits,
    Constant,
}

/// Heights of an nx × ny grid between 0 and 1, in a class that is drawn.
pub(crate) fn heights(draw: &mut Draw<'_>, (nx, ny): (usize, usize)) -> DMatrix<f64> {
    let class = draw.one_of(
        Class::Given,
        &[
            Class::Noise,
            Class::Smooth,
            Class::Quantised,
            Class::Worn,
            Class::Symmetric,
            Class::Paraboloid,
            Class::Wave,
            Class::Steps,
            Class::Spikes,
            Class::Pits,
            Class::Constant,
        ],
    );
    let mut noise = draw.noise();
    let white = DMatrix::from_fn(nx, ny, |_, _| noise());
    // From -1 to 1 along each side.
    let x = |ix: usize| (2 * ix + 1) as f64 / nx as f64 - 1.0;
    let y = |iy: usize| (2 * iy + 1) as f64 / ny as f64 - 1.0;
    match class {
        Class::Given => DMatrix::from_fn(nx, ny, |_, _| draw.unit()),
        Class::Noise => white,
        Class::Smooth => {
            let times = draw.whole(1, 3);
            (0..times).fold(white, |heights, _| smooth(&heights))
        }
        Class::Quantised => {
            let levels = draw.whole(2, 12) as f64;
            white.map(|height| (levels * height).floor() / levels)
        }
        Class::Worn => {
            let plateau = draw.unit();
            white.map(|height| height.min(plateau))
        }
        Class::Symmetric => {
            let fold = |i: usize, n: usize| i.min(n - 1 - i);
            DMatrix::from_fn(nx, ny, |ix, iy| white[(fold(ix, nx), fold(iy, ny))])
        }
        Class::Paraboloid => {
            let (a, b) = (draw.unit(), draw.unit());
            DMatrix::from_fn(nx, ny, |ix, iy| 1.0 - 0.5 * (a * x(ix).powi(2) + b * y(iy).powi(2)))
        }
        Class::Wave => {
            let (a, b) = (draw.whole(0, 3) as f64, draw.whole(0, 3) as f64);
            DMatrix::from_fn(nx, ny, |ix, iy| {
                let phase = std::f64::consts::PI * (a * x(ix) + b * y(iy));
                0.5 + 0.5 * phase.cos()
            })
        }
        Class::Steps => {
            let (wide, high) = (draw.whole(1, nx), draw.unit());
            DMatrix::from_fn(nx, ny, |ix, iy| {
                0.1 * high * (ix / wide) as f64 + 0.5 * chessboard(ix, iy)
            })
        }
        Class::Spikes => {
            DMatrix::from_fn(nx, ny, |ix, iy| if white[(ix, iy)] > 0.9 { 1.0 } else { 0.0 })
        }
        Class::Pits => {
            DMatrix::from_fn(nx, ny, |ix, iy| if white[(ix, iy)] > 0.9 { 0.0 } else { 1.0 })
        }
        Class::Constant => DMatrix::from_element(nx, ny, 0.3),
    }
}

/// 0 and 1 by turns.
fn chessboard(ix: usize, iy: usize) -> f64 {
    ((ix + iy) % 2) as f64
}
