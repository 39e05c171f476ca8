//! Random rough surfaces for property tests, and dense solutions that share no code with the crate.
#![allow(clippy::unwrap_used, dead_code, unreachable_pub, missing_docs)]

use asperity::surface::{Amplitude, SelfAffine};
use asperity::{Grid, InfluenceKernel, Surface};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// How the heights of a random surface are made.
#[derive(Debug, Clone, Copy)]
pub enum Roughness {
    /// Independent heights.
    White,
    /// Independent heights, mostly averaged over 3 x 3 neighbours this often.
    Smoothed(usize),
    /// Eq. (23) with this Hurst exponent and this ratio of the roll-off to the short cut-off.
    SelfAffine(f64, f64),
}

/// One random problem.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    pub nodes: (usize, usize),
    pub cell: (f64, f64),
    pub e_star: f64,
    pub height: f64,
    pub roughness: Roughness,
    pub seed: u64,
    /// Nodes to watch, automatic if there are none.
    pub window: Option<usize>,
}

/// SplitMix64: a few lines whose output never changes.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

impl Case {
    pub fn grid(&self) -> Grid {
        let (nx, ny) = self.nodes;
        Grid::new(nx, ny, self.cell.0, self.cell.1).unwrap()
    }

    pub fn heights(&self) -> DMatrix<f64> {
        let (nx, ny) = self.nodes;
        let mut random = Random(self.seed);
        let white = DMatrix::from_fn(nx, ny, |_, _| self.height * random.next());
        match self.roughness {
            Roughness::White => white,
            Roughness::Smoothed(times) => (0..times).fold(white, |heights, _| smooth(&heights)),
            // No wave fits on a single node.
            Roughness::SelfAffine(..) if nx * ny == 1 => white,
            Roughness::SelfAffine(hurst, ratio) => {
                // Two cells of every direction that has more than one node.
                let sides = [(nx, self.cell.0), (ny, self.cell.1)];
                let sides = sides.iter().filter(|(n, _)| *n > 1);
                let short = sides.fold(0.0, |short: f64, (_, d)| short.max(2.0 * d));
                let amplitude = Amplitude::RmsHeight(self.height);
                let surface = SelfAffine::new(hurst, ratio * short, short, amplitude, self.seed);
                surface.unwrap().heights(&self.grid()).unwrap()
            }
        }
    }
}

/// Nine parts of the average over the 3 x 3 neighbours that exist and one of the height itself, so
/// that heights stay different on grids of less than three nodes a side.
fn smooth(heights: &DMatrix<f64>) -> DMatrix<f64> {
    let (nx, ny) = heights.shape();
    DMatrix::from_fn(nx, ny, |ix, iy| {
        let (mut sum, mut count) = (0.0, 0.0);
        for jx in ix.saturating_sub(1)..=(ix + 1).min(nx - 1) {
            for jy in iy.saturating_sub(1)..=(iy + 1).min(ny - 1) {
                sum += heights[(jx, jy)];
                count += 1.0;
            }
        }
        0.9 * sum / count + 0.1 * heights[(ix, iy)]
    })
}

pub fn roughness() -> impl Strategy<Value = Roughness> {
    prop_oneof![
        Just(Roughness::White),
        (1_usize..4).prop_map(Roughness::Smoothed),
        (0.1..1.0, 1.0..4.0).prop_map(|(hurst, ratio)| Roughness::SelfAffine(hurst, ratio)),
    ]
}

/// Noise, whose events are never simultaneous: their order means something.
pub fn noise() -> impl Strategy<Value = Roughness> {
    prop_oneof![Just(Roughness::White), (1_usize..4).prop_map(Roughness::Smoothed),]
}

/// Grids up to `side` nodes a side, strips among them, with cells up to ten times as long as wide,
/// in units from nanometres to metres and pascals to terapascals.
pub fn case(
    side: usize,
    roughness: impl Strategy<Value = Roughness>,
) -> impl Strategy<Value = Case> {
    let nodes = prop_oneof![
        6 => (1..=side, 1..=side),
        1 => (Just(1), 1..=side * side / 2),
        1 => (1..=side * side / 2, Just(1)),
    ];
    let window = prop_oneof![
        2 => Just(None),
        1 => Just(Some(1)),
        3 => (2_usize..60).prop_map(Some),
    ];
    // Exponents of: cell size, ratio of its sides, modulus, height over cell size.
    let exponents = (-9.0..0.0, -1.0..1.0, 0.0..12.0, -3.0..1.0);
    (nodes, exponents, roughness, any::<u64>(), window).prop_map(
        |(nodes, (size, aspect, modulus, height), roughness, seed, window)| {
            let size = 10_f64.powf(size);
            Case {
                nodes,
                cell: (size, size * 10_f64.powf(aspect)),
                e_star: 10_f64.powf(modulus),
                height: size * 10_f64.powf(height),
                roughness,
                seed,
                window,
            }
        },
    )
}

/// Influence coefficients between nodes given by their indices, straight from the kernel.
pub fn influence<K: InfluenceKernel>(
    kernel: &K,
    rows: &[usize],
    columns: &[usize],
) -> DMatrix<f64> {
    let grid = kernel.grid();
    DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
        let (a, b) = (grid.coordinates(rows[i]), grid.coordinates(columns[j]));
        kernel.coefficient(a.0 as isize - b.0 as isize, a.1 as isize - b.1 as isize)
    })
}

/// Pressures that press the `contact` nodes into the plane of `approach`: C p = approach - gap, by LU.
pub fn dense_pressure<K: InfluenceKernel>(
    kernel: &K,
    contact: &[usize],
    gap: &[f64],
    approach: f64,
) -> DVector<f64> {
    let rhs =
        DVector::from_iterator(contact.len(), contact.iter().map(|&node| approach - gap[node]));
    influence(kernel, contact, contact).lu().solve(&rhs).unwrap()
}

/// Initial gaps by node index.
pub fn initial_gap(heights: &DMatrix<f64>) -> Vec<f64> {
    let highest = heights.max();
    heights.iter().map(|height| highest - height).collect()
}

/// Rms height.
pub fn rms(heights: &DMatrix<f64>) -> f64 {
    let mean = heights.mean();
    (heights.map(|h| (h - mean) * (h - mean)).sum() / heights.len() as f64).sqrt()
}
