//! How much of a surface lies above a height.

use crate::surface::HeightMap;

/// The part of all heights over which the core of a surface is sought: 40 %, by ISO 25178-2.
const CORE: f64 = 0.4;

/// The material ratio curve, after Abbott and Firestone: the part of a map, or of a profile, that lies at or above a
/// height.
///
/// ```
/// use asperity_surfaces::surface::{HeightMap, MaterialRatio};
/// use asperity_surfaces::nalgebra::DMatrix;
///
/// # fn main() -> Result<(), asperity_surfaces::Error> {
/// let map = HeightMap::new(DMatrix::from_fn(10, 10, |ix, iy| (ix + 10 * iy) as f64))?;
/// let curve = MaterialRatio::of(&map);
/// assert_eq!(curve.at_height(90.0), 0.1);
/// // All heights are as frequent: there is a core and nothing else.
/// let core = curve.core();
/// assert!((core.sk - 100.0).abs() < 1e-9 && core.spk == 0.0 && core.svk == 0.0);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialRatio {
    /// All heights \[m\], the highest first.
    heights: Vec<f64>,
}

/// What the material ratio curve is divided into: a core that bears, peaks above it that are worn off, and dales below
/// that hold lubricant (ISO 25178-2; of a profile filtered by ISO 21920-2 Rk, Rpk, Rvk, Rmrk1 and Rmrk2).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CoreParameters {
    /// Height Sk of the core \[m\].
    pub sk: f64,
    /// Reduced height Spk of the peaks \[m\]: twice their mean height above the core.
    pub spk: f64,
    /// Reduced depth Svk of the dales \[m\].
    pub svk: f64,
    /// Material ratio Smrk1 at the upper end of the core.
    pub smrk1: f64,
    /// Material ratio Smrk2 at its lower end.
    pub smrk2: f64,
}

impl MaterialRatio {
    /// Of all heights of a map.
    #[must_use]
    pub fn of(map: &HeightMap) -> Self {
        let mut heights: Vec<f64> = map.matrix().iter().copied().collect();
        heights.sort_unstable_by(|a, b| b.total_cmp(a));
        Self { heights }
    }

    /// The part of the surface at or above a height \[m\]: Smr(c), or Rmr(c) of a profile. NaN above NaN.
    #[must_use]
    pub fn at_height(&self, height: f64) -> f64 {
        if height.is_nan() {
            return height;
        }
        let above = self.heights.partition_point(|other| *other >= height);
        above as f64 / self.heights.len() as f64
    }

    /// The height \[m\] that so much of the surface, from 0 to 1, lies above: Smc(p), or Rmc(p). Each node stands for
    /// as much; between their middles it is interpolated.
    #[must_use]
    pub fn height_at(&self, ratio: f64) -> f64 {
        let last = self.heights.len() - 1;
        let place = (ratio * self.heights.len() as f64 - 0.5).clamp(0.0, last as f64);
        let before = place as usize;
        let (here, next) = (self.heights[before], self.heights[(before + 1).min(last)]);
        here + (place - before as f64) * (next - here)
    }

    /// Core, peaks and dales.
    ///
    /// The core is where the secant over 40 % of all heights falls least; the line of least squares there, extended to
    /// 0 and 100 %, ends at its upper and lower height. What lies above, and below, is a triangle of the same area.
    #[must_use]
    pub fn core(&self) -> CoreParameters {
        let heights = &self.heights;
        let count = heights.len();
        // Two points make a line.
        let span = ((CORE * count as f64).round() as usize).clamp(1, count.max(2) - 1);
        let fall = |k: &usize| heights[*k] - heights[(k + span).min(count - 1)];
        let starts = 0..count.saturating_sub(span).max(1);
        let start = starts.min_by(|a, b| fall(a).total_cmp(&fall(b))).unwrap_or_default();
        let core = &heights[start..(start + span + 1).min(count)];
        let ratio = |k: usize| (k as f64 + 0.5) / count as f64;
        let middle = 0.5 * (ratio(start) + ratio(start + core.len() - 1));
        // From the first on: heights that are all the same have no other mean.
        let above_first = core.iter().map(|height| height - core[0]).sum::<f64>();
        let mean = core[0] + above_first / core.len() as f64;
        let (mut products, mut squares) = (0.0, 0.0);
        for (k, height) in core.iter().enumerate() {
            let way = ratio(start + k) - middle;
            products += way * (height - mean);
            squares += way * way;
        }
        let slope = if squares > 0.0 { (products / squares).min(0.0) } else { 0.0 };
        let upper = mean - slope * middle;
        let lower = upper + slope;
        let excess = |heights: &[f64], from: f64| {
            let sum: f64 = heights.iter().map(|height| (height - from).abs()).sum();
            if heights.is_empty() { 0.0 } else { 2.0 * sum / heights.len() as f64 }
        };
        // What rounds lies on the line.
        let slack = 4.0 * f64::EPSILON * upper.abs().max(lower.abs());
        let peaks = heights.partition_point(|height| *height > upper + slack);
        let dales = heights.partition_point(|height| *height >= lower - slack);
        CoreParameters {
            sk: upper - lower,
            spk: excess(&heights[..peaks], upper),
            svk: excess(&heights[dales..], lower),
            smrk1: peaks as f64 / count as f64,
            smrk2: dales as f64 / count as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::Error;

    fn curve(heights: &[f64]) -> Result<MaterialRatio, Error> {
        let map = HeightMap::new(DMatrix::from_row_slice(1, heights.len(), heights))?;
        Ok(MaterialRatio::of(&map))
    }

    /// Of 1, 2, 3 and 4 m a half lies at or above 3, and 2.5 m is in the middle.
    #[test]
    fn ratios_and_heights() -> Result<(), Error> {
        let curve = curve(&[3.0, 1.0, 4.0, 2.0])?;
        for (height, ratio) in
            [(5.0, 0.0), (4.0, 0.25), (3.0, 0.5), (2.5, 0.5), (1.0, 1.0), (0.0, 1.0)]
        {
            assert_eq!(curve.at_height(height), ratio);
        }
        for (ratio, height) in [(0.0, 4.0), (0.125, 4.0), (0.25, 3.5), (0.5, 2.5), (1.0, 1.0)] {
            assert_eq!(curve.height_at(ratio), height);
        }
        Ok(())
    }

    /// Heights that are normally distributed: the line over the middle 40 % in closed form, by parts with p = Φ(x),
    /// `∫ (p − 1/2) x dp = erf(a)/(2√π) − 0.4 φ(a)` from −a to a, over `2 · 0.2³/3`. With its upper end at t half of
    /// that, `1 − Φ(t)` lies above, `φ(t)/(1 − Φ(t)) − t` on average.
    #[test]
    fn normal_heights_have_a_known_core() -> Result<(), Error> {
        let count = 100_001;
        // Φ⁻¹ by bisection.
        let normal = |x: f64| 0.5 * libm::erfc(-x / std::f64::consts::SQRT_2);
        let quantile = |p: f64| {
            let (mut low, mut high) = (-9.0, 9.0);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if normal(middle) < p { low = middle } else { high = middle }
            }
            0.5 * (low + high)
        };
        let heights: Vec<f64> =
            (0..count).map(|k| quantile((k as f64 + 0.5) / count as f64)).collect();
        let core = curve(&heights)?.core();
        let density = |x: f64| (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
        let a = quantile(0.7);
        let sum = libm::erf(a) / (2.0 * std::f64::consts::PI.sqrt()) - 0.4 * density(a);
        let sk = sum / (2.0 * 0.2_f64.powi(3) / 3.0);
        let t = 0.5 * sk;
        let above = 1.0 - normal(t);
        let spk = 2.0 * (density(t) / above - t);
        for (found, expected) in [
            (core.sk, sk),
            (core.spk, spk),
            (core.svk, spk),
            (core.smrk1, above),
            (core.smrk2, 1.0 - above),
        ] {
            // A hundred thousand steps.
            assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
        }
        Ok(())
    }

    /// A plateau with grooves in a tenth of it: no core of any height, and dales of twice their depth.
    #[test]
    fn plateaus_with_grooves() -> Result<(), Error> {
        let heights: Vec<f64> = (0..100).map(|k| if k % 10 == 0 { -3.0 } else { 1.0 }).collect();
        let core = curve(&heights)?.core();
        assert_eq!((core.sk, core.spk, core.svk), (0.0, 0.0, 8.0));
        assert_eq!((core.smrk1, core.smrk2), (0.0, 0.9));
        // However the height of the plateau rounds: of 3 and of 11 times 0.1 the sum is above, and below, the product.
        for count in [5, 25] {
            let heights: Vec<f64> = (0..count).map(|k| if k == 0 { -3.0 } else { 0.1 }).collect();
            let core = curve(&heights)?.core();
            assert_eq!((core.sk, core.spk, core.smrk1), (0.0, 0.0, 0.0));
            assert!((core.svk - 6.2).abs() < 1e-14, "{core:?}");
            assert_eq!(core.smrk2, f64::from(count - 1) / f64::from(count));
        }
        Ok(())
    }

    #[test]
    fn few_heights_have_a_core() -> Result<(), Error> {
        for heights in [&[1.0][..], &[2.0, 1.0], &[3.0, 2.0, 1.0]] {
            let core = curve(heights)?.core();
            assert!(core.sk.is_finite() && core.sk >= 0.0, "{core:?}");
        }
        Ok(())
    }
}
