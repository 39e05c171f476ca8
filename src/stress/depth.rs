//! A depth, or an extrapolation to it from greater ones. Lengths are in long sides of a cell.

use super::lanes::{LANES, Lanes, each, fades};

/// Depths from which shallower ones are extrapolated, 1, 2, … long sides of a cell.
const NODES: usize = 10;

/// A sum of responses at one or several depths.
#[derive(Debug, Clone, Copy)]
pub(super) enum Depth {
    /// Those at one.
    At(f64),
    /// Lagrange's polynomial through those at 1, 2, ….
    Extrapolated { weights: [f64; NODES] },
}

impl Depth {
    /// The extrapolation from responses at 1, 2, … to the depth z.
    ///
    /// Far from a load its response varies with depth over as much as the distance is: at a distance of r the error is
    /// some 10! × 10 / r¹², and beyond [`REACH`](Self::REACH) nothing.
    pub(super) fn extrapolated(z: f64) -> Self {
        let weights = std::array::from_fn(|k| {
            let own = (k + 1) as f64;
            let others = (1..=NODES).map(|j| j as f64).filter(|other| *other != own);
            others.map(|other| (z - other) / (own - other)).product()
        });
        Self::Extrapolated { weights }
    }

    /// All loads beyond it together err by 10⁻¹² of their mean.
    pub(super) const REACH: f64 = 90.0;

    /// The least depth.
    pub(super) fn least(&self) -> f64 {
        match *self {
            Self::At(z) => z,
            Self::Extrapolated { .. } => 1.0,
        }
    }

    /// Weights and depths.
    pub(super) fn parts(&self) -> Vec<(f64, f64)> {
        match *self {
            Self::At(z) => vec![(1.0, z)],
            Self::Extrapolated { weights } => {
                (1..).zip(weights).map(|(k, w)| (w, f64::from(k))).collect()
            }
        }
    }

    /// The sums of e^(−q z) and of q z e^(−q z), of waves side by side.
    #[inline(always)]
    pub(super) fn of_waves(&self, q: &Lanes) -> (Lanes, Lanes) {
        match *self {
            Self::At(z) => {
                let plain = fades(&each(|k| q[k] * z));
                (plain, each(|k| q[k] * z * plain[k]))
            }
            Self::Extrapolated { weights } => {
                // Polynomials in e^(−q).
                let step = fades(q);
                let (mut plain, mut deep) = ([0.0; LANES], [0.0; LANES]);
                for (place, weight) in weights.into_iter().enumerate().rev() {
                    let by_depth = (place + 1) as f64 * weight;
                    plain = each(|k| step[k] * (plain[k] + weight));
                    deep = each(|k| step[k] * (deep[k] + by_depth));
                }
                (plain, each(|k| q[k] * deep[k]))
            }
        }
    }
}
