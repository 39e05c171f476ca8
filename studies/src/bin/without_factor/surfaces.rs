//! Surfaces that are easy and surfaces that are hard.

use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity::{Error, Grid, Surface};
use clap::ValueEnum;
use nalgebra::DMatrix;

/// What a surface looks like. All but the paper's have a side of 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Shape {
    /// The paper's Table 1, on a side of 10 mm.
    Paper,
    /// Self-affine, roll-off at a quarter of the side, short cut-off at four cells.
    Rough,
    /// The first rows of a square one: a strip whose rows differ.
    Strip,
    /// The same with its upper half worn flat.
    Worn,
    /// The same with heights in steps.
    Steps,
    /// The same stretched eightfold along x.
    Anisotropic,
    /// Uncorrelated heights.
    White,
    /// A paraboloid.
    Sphere,
    /// A cone.
    Cone,
    /// A pyramid.
    Pyramid,
    /// Crossed waves.
    Waves,
    /// Two by two copies of a rough surface, if both numbers of nodes are even: four nodes touch at a time.
    Tiled,
    /// A flat square punch on lower ground.
    Punch,
    /// A plane with three pits.
    Pits,
    /// A plane with one spike.
    Spike,
}

/// The grid, and the surface on it.
pub(crate) fn make(
    shape: Shape,
    (nx, ny, aspect): (usize, usize, f64),
    (hurst, seed): (f64, u64),
) -> Result<(Grid, HeightMap), Error> {
    let side = if shape == Shape::Paper { 1e-2 } else { 1.0 };
    let cell = side / nx as f64;
    let grid = Grid::new(nx, ny, cell * aspect, cell)?;
    let rough = |grid: &Grid| {
        let cutoff = 4.0 * cell * aspect.max(1.0);
        SelfAffine::new(hurst, 0.25, cutoff, Amplitude::RmsHeight(5e-3), seed)?.heights(grid)
    };
    let formula = |height: &dyn Fn(f64, f64) -> f64| {
        DMatrix::from_fn(nx, ny, |ix, iy| {
            let centred = |i: usize, n: usize| (i as f64 + 0.5) / n as f64 - 0.5;
            height(centred(ix, nx), centred(iy, ny))
        })
    };
    let at = |ix: usize, iy: usize| ix + nx * iy;
    let flat_but = |heights: &[(usize, f64)]| {
        let mut plane = DMatrix::zeros(nx, ny);
        for &(node, height) in heights {
            plane.as_mut_slice()[node] = height;
        }
        plane
    };
    let heights = match shape {
        Shape::Paper => SelfAffine::zhang2020(seed).heights(&grid)?,
        Shape::Rough => rough(&grid)?,
        Shape::Strip => {
            let square = rough(&Grid::new(nx, nx.max(ny), grid.dx(), grid.dy())?)?;
            square.columns(0, ny).into_owned()
        }
        Shape::Worn => {
            let heights = rough(&grid)?;
            let mut sorted: Vec<f64> = heights.iter().copied().collect();
            sorted.sort_by(f64::total_cmp);
            let middle = sorted[sorted.len() / 2];
            heights.map(|height| height.min(middle))
        }
        Shape::Steps => rough(&grid)?.map(|height| (height / 2.5e-3).round() * 2.5e-3),
        Shape::Anisotropic => rough(&Grid::new(nx, ny, cell, 0.125 * cell)?)?,
        Shape::White => {
            let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
            DMatrix::from_fn(nx, ny, |_, _| {
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                5e-3 * (state >> 11) as f64 / (1_u64 << 53) as f64
            })
        }
        Shape::Sphere => formula(&|x, y| -0.1 * (x * x + y * y)),
        Shape::Cone => formula(&|x, y| -0.1 * x.hypot(y)),
        Shape::Pyramid => formula(&|x, y| -0.1 * x.abs().max(y.abs())),
        Shape::Tiled => {
            let tile = rough(&Grid::new(nx / 2, ny / 2, grid.dx(), grid.dy())?)?;
            DMatrix::from_fn(nx, ny, |ix, iy| tile[(ix % tile.nrows(), iy % tile.ncols())])
        }
        Shape::Waves => {
            let wave = |x: f64| (4.0 * std::f64::consts::TAU * x).cos();
            formula(&|x, y| 0.01 * (wave(x) + wave(y)))
        }
        Shape::Punch => formula(&|x, y| {
            if x.abs().max(y.abs()) < 0.25 { 0.0 } else { -2e-3 }
        }),
        Shape::Pits => flat_but(&[
            (at(nx / 2, ny / 2), -2e-3),
            (at(nx / 3, ny / 5), -0.05),
            (at(nx / 4 + 1, ny / 7), -0.01),
        ]),
        Shape::Spike => flat_but(&[(at(nx / 2, ny / 2), 2e-3)]),
    };
    Ok((grid, HeightMap::new(heights)?))
}
