//! Roughness of a profile.

use std::ops::Range;

use crate::Error;
use crate::surface::SLACK;
use crate::surface::topography::{Filter, Topography, Trend};

/// Heights of hills, and depths of dales, that count as elements of a profile, over Rz.
const COUNTED: f64 = 0.1;

/// Parameters of a profile by ISO 21920-2, in metres: with a cut-off wavelength those of its roughness (Ra, Rq, ...),
/// without one those of the primary profile (Pa, Pq, ...).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ProfileParameters {
    /// Cut-off wavelength λc \[m\] of the Gaussian filter (ISO 16610-21), if there is one.
    pub cutoff: Option<f64>,
    /// Length that is evaluated \[m\].
    pub evaluation_length: f64,
    /// Arithmetical mean height Ra \[m\].
    pub ra: f64,
    /// Root mean square height Rq \[m\].
    pub rq: f64,
    /// Maximum height Rz \[m\]: the mean over the sections, each as long as the cut-off.
    pub rz: f64,
    /// Total height Rt \[m\], from the lowest dale to the highest peak of all.
    pub rt: f64,
    /// Skewness Rsk; NaN if the profile is flat.
    pub rsk: f64,
    /// Kurtosis Rku, 3 for a normal distribution; NaN if the profile is flat.
    pub rku: f64,
    /// Mean spacing RSm \[m\] of elements, from hill to hill; hills lower and dales less deep than a tenth of Rz are no
    /// elements. `None` where there are fewer than two.
    pub rsm: Option<f64>,
}

impl Topography {
    /// The roughness of a profile: of a surface of one row of nodes, without its tilt.
    ///
    /// With a cut-off wavelength the waviness is taken off by the Gaussian filter, and half a cut-off or more at either
    /// end is not evaluated, where the filter sees one side only: what is left are whole sections.
    ///
    /// ```
    /// use asperity_surfaces::Grid;
    /// use asperity_surfaces::surface::Topography;
    /// use asperity_surfaces::nalgebra::DMatrix;
    ///
    /// # fn main() -> Result<(), asperity_surfaces::Error> {
    /// // A wave of 0.1 mm on a bow.
    /// let wave = |x: f64| 1e-6 * (std::f64::consts::TAU * x / 100.0).sin();
    /// let bow = |x: f64| 1e-12 * (x - 2800.0).powi(2);
    /// let heights = DMatrix::from_fn(5600, 1, |ix, _| wave(ix as f64) + bow(ix as f64));
    /// let profile = Topography::new(Grid::new(5600, 1, 1e-6, 1e-6)?, heights)?;
    /// let roughness = profile.profile_parameters(Some(0.8e-3))?;
    /// assert!((roughness.ra / (2.0 / std::f64::consts::PI * 1e-6) - 1.0).abs() < 0.02);
    /// assert!((roughness.rsm.unwrap_or_default() / 1e-4 - 1.0).abs() < 1e-3);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// Heights are taken from the mean of the part that is evaluated; that is what waves longer than the cut-off leave
    /// in it.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a surface of several rows, and for a cut-off of less than two steps or more than half
    /// the profile; [`Error::NotPositive`] for one that is not positive and finite.
    pub fn profile_parameters(&self, cutoff: Option<f64>) -> Result<ProfileParameters, Error> {
        let (nx, ny) = self.grid().shape();
        Error::require("number of rows of a profile", ny as f64, ny == 1, "1")?;
        let step = self.grid().dx();
        let levelled = self.level(Trend::Plane)?;
        let (profile, section) = match cutoff {
            None => (levelled, nx),
            Some(cutoff) => {
                Error::require_positive("cut-off wavelength", cutoff)?;
                let steps = cutoff / step;
                let fits = 2.0 * steps <= nx as f64 * (1.0 + SLACK) && steps >= 2.0 - SLACK;
                let expected = "at least two steps and at most half the profile";
                Error::require("cut-off wavelength in m", cutoff, fits, expected)?;
                let section = steps.round() as usize;
                let ends = section / 2;
                let sections = ((nx - 2 * ends) / section).max(1);
                let evaluated = (sections * section).min(nx - 2 * ends);
                let first = (nx - evaluated) / 2;
                let roughness = levelled.high_pass(cutoff, Filter::Gaussian)?;
                (roughness.crop(first..first + evaluated, 0..1)?, section)
            }
        };
        let map = profile.map();
        let mean = map.mean_height();
        let heights: Vec<f64> = map.matrix().iter().map(|height| height - mean).collect();
        let sections: Vec<f64> =
            heights.chunks_exact(section.min(heights.len())).map(extent).collect();
        let rz = sections.iter().sum::<f64>() / sections.len() as f64;
        Ok(ProfileParameters {
            cutoff,
            evaluation_length: heights.len() as f64 * step,
            ra: map.mean_absolute_height(),
            rq: map.rms_height(),
            rz,
            rt: map.peak_to_valley(),
            rsk: map.skewness(),
            rku: map.kurtosis(),
            rsm: mean_spacing(&heights, COUNTED * rz).map(|spacing| spacing * step),
        })
    }
}

/// From the lowest to the highest.
fn extent(heights: &[f64]) -> f64 {
    let Range { start, end } =
        heights.iter().fold(f64::INFINITY..f64::NEG_INFINITY, |range, &height| {
            range.start.min(height)..range.end.max(height)
        });
    end - start
}

/// Steps between the places at which the profile rises through its mean line, from a dale that counts to a hill that
/// does.
fn mean_spacing(heights: &[f64], counted: f64) -> Option<f64> {
    let mut rises: Vec<f64> = Vec::new();
    // Where it last rose through the mean line after a dale.
    let mut was_low = heights.first().is_some_and(|height| *height < -counted);
    let mut rose = None;
    for (k, pair) in heights.windows(2).enumerate() {
        let &[before, after] = pair else { continue };
        if after < -counted {
            (was_low, rose) = (true, None);
        }
        if before < 0.0 && after >= 0.0 {
            rose = Some(k as f64 + before / (before - after));
        }
        if was_low && after > counted {
            rises.extend(rose.take());
            was_low = false;
        }
    }
    let (first, last) = (rises.first()?, rises.last()?);
    (rises.len() > 1).then(|| (last - first) / (rises.len() - 1) as f64)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, SQRT_2, TAU};

    use nalgebra::DMatrix;

    use super::*;
    use crate::Grid;

    fn profile(nodes: usize, height: impl Fn(f64) -> f64) -> Result<Topography, Error> {
        let heights = DMatrix::from_fn(nodes, 1, |ix, _| height(ix as f64));
        Topography::new(Grid::new(nodes, 1, 1e-6, 1e-6)?, heights)
    }

    /// A sine of 20 waves: Pa = 2A/π, Pq = A/√2, Pt = Pz = 2A, Psk = 0, Pku = 3/2, PSm = λ, with a tilt or without.
    #[test]
    fn a_sine_has_known_parameters() -> Result<(), Error> {
        let (amplitude, wave) = (2e-6, 250.0);
        for tilt in [0.0, 1e-8] {
            let sine = |x: f64| amplitude * (TAU * (x + 0.5) / wave).sin();
            let surface = profile(5000, |x| sine(x) + tilt * x)?;
            // What a plane takes off a sine of whole waves is 6 / (π n) of its amplitude at most, n the number of
            // waves.
            let close = |found: f64, expected: f64, tolerance: f64| {
                assert!((found / expected - 1.0).abs() < tolerance, "{found:e} {expected:e}");
            };
            let found = surface.profile_parameters(None)?;
            close(found.ra, 2.0 / PI * amplitude, 0.01);
            close(found.rq, amplitude / SQRT_2, 0.01);
            close(found.rt, 2.0 * amplitude, 0.1);
            assert_eq!((found.rz, found.cutoff), (found.rt, None));
            close(found.rku, 1.5, 0.02);
            assert!(found.rsk.abs() < 0.05);
            close(found.rsm.unwrap_or_default(), wave * 1e-6, 1e-3);
            close(found.evaluation_length, 5e-3, 1e-12);
        }
        Ok(())
    }

    /// One node of nine is raised: two heights, of the shares q = 1/9 and 1 − q, have Ra = 2 q (1 − q) h, Rsk = (1 − 2q)
    /// / √(q (1 − q)) and Rku = 1 / (q (1 − q)) − 3.
    #[test]
    fn two_heights() -> Result<(), Error> {
        let surface = profile(9 * 41, |x| if x % 9.0 == 4.0 { 1e-6 } else { 0.0 })?;
        let found = surface.profile_parameters(None)?;
        let expected = [16.0 / 81.0 * 1e-6, 7.0 / 8.0_f64.sqrt(), 81.0 / 8.0 - 3.0];
        for (found, expected) in [found.ra, found.rsk, found.rku].into_iter().zip(expected) {
            // Of some hundred terms, and what rounds of a line that is none.
            assert!((found / expected - 1.0).abs() < 1e-12, "{found:e} {expected:e}");
        }
        Ok(())
    }

    /// A wave as long as the cut-off keeps half of its amplitude, and one of a tenth all but exp(−100 ln 2) of it; a
    /// long one is waviness.
    #[test]
    fn the_cutoff_parts_roughness_from_waviness() -> Result<(), Error> {
        let cutoff = 800.0;
        for (wave, share) in
            [(cutoff, 0.5), (0.1 * cutoff, 1.0), (4.0 * cutoff, 1.0 - (-(2_f64.ln()) / 16.0).exp())]
        {
            let surface = profile(8000, |x| 1e-6 * (TAU * x / wave).sin())?;
            let found = surface.profile_parameters(Some(cutoff * 1e-6))?;
            assert!(
                (found.rq / (share * 1e-6 / SQRT_2) - 1.0).abs() < 0.03,
                "{wave}: {:e}",
                found.rq
            );
            assert!((found.evaluation_length / 7.2e-3 - 1.0).abs() < 1e-12);
            assert_eq!(found.cutoff, Some(cutoff * 1e-6));
            if wave <= cutoff {
                assert!(
                    (found.rz / (2.0 * share * 1e-6) - 1.0).abs() < 0.03,
                    "{wave}: {:e}",
                    found.rz
                );
                assert!((found.rsm.unwrap_or_default() / (wave * 1e-6) - 1.0).abs() < 0.01);
            }
        }
        Ok(())
    }

    /// Ripples of less than a tenth of Rz are no elements; a saw tooth has a uniform distribution of heights: Rq = Rt /
    /// √12, Rku = 9/5.
    #[test]
    fn small_ripples_are_no_elements() -> Result<(), Error> {
        let ripple = |x: f64| 0.05e-6 * (TAU * x / 10.0).sin();
        let surface = profile(4000, |x| 1e-6 * (TAU * x / 200.0).sin() + ripple(x))?;
        let spacing = surface.profile_parameters(None)?.rsm.unwrap_or_default();
        assert!((spacing / 200e-6 - 1.0).abs() < 0.01, "{spacing:e}");
        let saw =
            profile(20_000, |x| 1e-6 * ((x + 0.5) / 100.0).fract())?.profile_parameters(None)?;
        assert!((saw.rq / (saw.rt / 12_f64.sqrt()) - 1.0).abs() < 0.02, "{saw:?}");
        assert!((saw.rku / 1.8 - 1.0).abs() < 0.02);
        Ok(())
    }

    /// Whole sections are evaluated, in the middle: a profile and its mirror image have the same Rz, a peak in it.
    #[test]
    fn sections_are_whole() -> Result<(), Error> {
        let rough = |x: f64| 1e-6 * ((7.3 * x).sin() + if x == 1590.0 { 10.0 } else { 0.0 });
        let surface = profile(1690, rough)?;
        let found = surface.profile_parameters(Some(100e-6))?;
        // Nodes 95 to 1594.
        assert!((found.evaluation_length / 1.5e-3 - 1.0).abs() < 1e-12, "{found:?}");
        let mirrored = surface.flip(crate::surface::Axis::X).profile_parameters(Some(100e-6))?;
        assert!((found.rz / mirrored.rz - 1.0).abs() < 1e-9, "{found:?} {mirrored:?}");
        Ok(())
    }

    #[test]
    fn what_is_no_profile_is_refused() -> Result<(), Error> {
        let heights = DMatrix::from_fn(8, 8, |ix, iy| (ix + iy) as f64);
        let map = Topography::new(Grid::square(8, 1e-3)?, heights)?;
        assert!(matches!(map.profile_parameters(None), Err(Error::OutOfRange { value: 8.0, .. })));
        let short = profile(100, |x| x.sin())?;
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 51e-6, 0.1e-6, 1.4e-6] {
            assert!(short.profile_parameters(Some(bad)).is_err(), "{bad}");
        }
        let flat = profile(100, |_| 1.0)?.profile_parameters(None)?;
        assert_eq!((flat.rt, flat.rsm), (0.0, None));
        Ok(())
    }
}
