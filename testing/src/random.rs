//! Random rough surfaces for property tests.

use asperity::surface::{Amplitude, SelfAffine};
use asperity::{Grid, Surface};
use nalgebra::DMatrix;
use proptest::prelude::*;

use crate::surfaces::smooth;

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
    /// Along x and y.
    pub nodes: (usize, usize),
    /// Sides of a cell \[m\].
    pub cell: (f64, f64),
    /// Composite modulus \[Pa\].
    pub e_star: f64,
    /// What heights are in proportion to \[m\].
    pub height: f64,
    /// How heights are made.
    pub roughness: Roughness,
    /// Of their random numbers.
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
    /// Its grid.
    #[must_use]
    pub fn grid(&self) -> Grid {
        let (nx, ny) = self.nodes;
        Grid::new(nx, ny, self.cell.0, self.cell.1).unwrap()
    }

    /// Its heights \[m\].
    #[must_use]
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

/// Every roughness.
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

/// Rms height.
#[must_use]
pub fn rms(heights: &DMatrix<f64>) -> f64 {
    let mean = heights.mean();
    (heights.map(|h| (h - mean) * (h - mean)).sum() / heights.len() as f64).sqrt()
}
