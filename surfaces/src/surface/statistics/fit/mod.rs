//! A self-affine spectrum, fitted to the spectrum of a map.

mod dependence;
mod law;

use std::f64::consts::TAU;

use self::law::{Law, Ring, fit};
use super::power::{RadialBins, SpectralBin, greatest_wavevector};
use crate::Error;
use crate::surface::Topography;

/// Rings in a decade of wavevectors: each is so narrow (1 %) that the density in it is that at its mean, and at
/// small wavevectors every length of wave has a ring of its own.
const RINGS_PER_DECADE: usize = 230;

/// Fewest rings for a fit of three parameters.
const FEWEST_RINGS: usize = 8;

/// A cut-off is seen by comparing the waves within so much of ln q below a wavevector with those above it, …
const REACH: f64 = 0.15;

/// … so many at least on either side, …
const FEWEST_WAVES: f64 = 32.0;

/// … as a fall of the mean density by this factor. The steepest power law, H = 1, falls by 1.8, and of 16 + 16
/// independent waves one mean in a million is 11 times the other.
const FALL: f64 = 20.0;

/// Falls by more are alike: behind them is the rounding of the transform, and the first of them is the cut-off.
const TO_NOTHING: f64 = 1e4;

/// Rings at the long end with less than this part of the greatest density have no power: they lie beyond a long
/// cut-off.
const NO_POWER: f64 = 1e-3;

/// A number with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its standard error, one standard deviation.
    pub standard_error: f64,
}

/// A self-affine spectrum, as that of [`SelfAffine`](crate::SelfAffine), that was fitted to the spectrum of a map:
///
/// ```math
/// C(q) = C_0 \begin{cases}
///     q_r^{-2(1+H)} & q_l \le q < q_r \\
///     q^{-2(1+H)} & q_r \le q \le q_s \\
///     0 & \text{else} \end{cases}, \qquad q = \frac{2 \pi}\lambda
/// ```
///
/// On a single row, a profile, the density falls with $`q^{-(1 + 2H)}`$ instead: that of a cut through a surface of the
/// exponent H.
///
/// Made by [`Topography::fit_self_affine`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SelfAffineFit {
    /// Hurst exponent H. Nothing keeps it between 0 and 1: a number beyond says that the map is not self-affine.
    pub hurst: Estimate,
    /// Roll-off wavelength λ_r \[m\]; `None` if the power law begins with the longest waves.
    pub rolloff_wavelength: Option<Estimate>,
    /// Short cut-off wavelength λ_s \[m\]; `None` if the power law goes on to the shortest waves of the grid.
    pub short_cutoff_wavelength: Option<Estimate>,
    /// Long cut-off wavelength λ_l \[m\]; `None` if the longest waves of the map have power.
    pub long_cutoff_wavelength: Option<Estimate>,
    /// Prefactor C₀ \[m^(2 − 2H)\] in the normalisation of [`Spectrum`](crate::surface::Spectrum).
    pub prefactor: f64,
    /// Mean square of the relative residuals, weighted by the number of independent waves: 1 for a surface whose
    /// amplitudes are random (Gaussian), and greater than 1 where the spectrum is not of this form. Of a surface like
    /// `SelfAffine`, whose phases alone are random, it is almost 0, and so are the standard errors: there the width of
    /// the rings decides, 10⁻⁵ of a wavelength.
    pub dispersion: f64,
}

impl Topography {
    /// Fits a self-affine spectrum with roll-off and cut-offs to that of the map, taken as periodic.
    ///
    /// Level a map that is not periodic, and put a [window](Self::window) on it, before: without, the jump at its
    /// border has a power law of its own, and the dispersion shows it. The window smears each wave over its neighbours:
    /// so fewer of them are independent, which the standard errors count, and where the spectrum is steep the longest
    /// waves seem too long. Without a roll-off H comes out too great for it, by 0.02 with Hann's window on 128 × 128
    /// nodes, half of its standard error.
    ///
    /// # How
    ///
    /// * Cut-offs come first. The short one is where the mean density falls, from one side of a wavevector to the
    ///   other, by a factor of 20 or more within 15 %; the long one is where waves begin to have more than
    ///   a thousandth of the greatest density. Their standard errors are those of a place anywhere between two rings
    ///   of waves, which are some 2 % apart for the short one. Where a window smears it, as many waves are left out
    ///   below it as it reaches above.
    /// * ln C = a − 2(1 + H) max(0, ln q − ln q_r), or 1 + 2H of a profile, is then fitted to the densities of 230 rings a decade by
    ///   least squares, each weighted by its number of independent waves (half of all), iterated so that the
    ///   residuals are those of C and not of its logarithm. This is Whittle's likelihood: the
    ///   density of one wave of a Gaussian surface is distributed exponentially, the mean logarithm of which is not the
    ///   logarithm of the mean.
    /// * Standard errors are those of independent waves (the inverse of Fisher's information), times the root of what
    ///   the relative residuals of waves say: their mean square and their covariances with the waves up to two further
    ///   along either axis, as far as these exceed those with waves four to seven further; or times the root of the
    ///   dispersion, if that is more. With Hann's window the first is 35²/18² = 3.8. What they do not know is how far
    ///   the spectrum of a real surface is from the law: a dispersion well above 1 shows that.
    /// * There is a roll-off if the plateau improves the likelihood beyond what it would by chance
    ///   (twice the difference of its logarithms, over the dispersion, is above 10) and is three rings long. One of the
    ///   few waves that a profile has may be missed, and H comes out too small: of profiles with five waves on the
    ///   plateau 43 % lie within one standard error, and not 68 %.
    ///
    /// # Errors
    ///
    /// [`Error::TooFewWaves`] for fewer than eight rings with power between the cut-offs, as on grids of
    /// some 6 × 6 nodes, and [`Error::NoConvergence`] if the densities are so far from a power law that the
    /// iteration fails.
    ///
    /// # References
    ///
    /// P. Whittle, Ark. Mat. 2 (1953) 423. A Gaussian surface: P. R. Nayak, J. Lubr. Technol. 93 (1971) 398.
    pub fn fit_self_affine(&self) -> Result<SelfAffineFit, Error> {
        let bins = self.radial_psd(&RadialBins::PerDecade(RINGS_PER_DECADE))?;
        let limit = greatest_wavevector(self);
        // The last ring reaches into wavevectors that not all directions have.
        let bins: Vec<_> =
            bins.into_iter().filter(|bin| bin.wavevector <= limit * (1.0 + 1e-12)).collect();
        let greatest = bins.iter().map(|bin| bin.density).fold(0.0, f64::max);
        let first = bins.iter().position(|bin| bin.density > NO_POWER * greatest);
        let too_few = |found: usize| Error::TooFewWaves { found, needed: FEWEST_RINGS };
        let Some(first) = first else {
            return Err(too_few(0));
        };
        let bins_with_power = &bins[first..];
        let fall = Fall::of(bins_with_power);
        let intact = fall.map_or(f64::INFINITY, |fall| fall.intact(bins_with_power));
        let band = bins_with_power.iter().take_while(|bin| bin.wavevector < intact);
        let rings: Vec<_> = band
            .map(|bin| Ring {
                x: libm::log(bin.wavevector),
                density: bin.density / greatest,
                weight: 0.5 * bin.waves as f64,
            })
            .collect();
        if rings.len() < FEWEST_RINGS {
            return Err(too_few(rings.len()));
        }
        let law = fit(&rings)?;
        let unit = greatest / self.grid().nominal_area();
        let among = (bins_with_power[0].wavevector, bins_with_power[rings.len() - 1].wavevector);
        let variance =
            dependence::variance(&self.waves(), among, |q| unit * law.density(libm::log(q)));
        // The root of what a mean over independent waves is to be multiplied by.
        let dependence = variance.max(law.dispersion).sqrt();
        // The ring that the fall starts with may be cut in two: the place is anywhere between its neighbours.
        let short = fall.map(|fall| {
            let above = bins_with_power.get(fall.start + 1);
            let above = above.unwrap_or(&bins_with_power[fall.start]);
            place_between(&bins_with_power[fall.start - 1], above)
        });
        let long = (first > 0).then(|| place_between(&bins[first - 1], &bins[first]));
        // The exponent is 2(1 + H), or 1 + 2H; and the density of a profile is one along a line, without the width.
        let (beside, density) = match self.grid().length_of_profile() {
            None => (1.0, greatest),
            Some(length) => (0.5, greatest * TAU * length / self.grid().nominal_area()),
        };
        Ok(SelfAffineFit {
            hurst: Estimate {
                value: 0.5 * law.exponent - beside,
                standard_error: 0.5 * dependence * law.exponent_error,
            },
            rolloff_wavelength: law.rolloff_error.map(|error| {
                let value = TAU / libm::exp(law.rolloff);
                Estimate { value, standard_error: dependence * error * value }
            }),
            short_cutoff_wavelength: short,
            long_cutoff_wavelength: long,
            prefactor: prefactor(&law, density),
            dispersion: law.dispersion,
        })
    }
}

/// C₀ from the plateau C₀ q_r^(−2(1+H)), or of a profile with 1 + 2H, whose density is (2π)² times that of `Spectrum`
/// in these units.
fn prefactor(law: &Law, unit: f64) -> f64 {
    let logarithm = law.plateau + law.exponent * law.rolloff + libm::log(unit);
    libm::exp(logarithm) / (TAU * TAU)
}

/// Where the density falls to nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Fall {
    /// The ring from which on the density has fallen.
    start: usize,
    /// The ring from which on it has fallen by most: some waves further on where a window smears the spectrum.
    end: usize,
}

impl Fall {
    /// The steepest fall of the density, if there is one.
    fn of(bins: &[SpectralBin]) -> Option<Self> {
        let mut run: Option<usize> = None;
        let mut steepest: Option<(f64, Self)> = None;
        for end in 1..bins.len() {
            let fall = fall(bins, end).min(TO_NOTHING);
            if fall < FALL {
                run = None;
                continue;
            }
            let start = *run.get_or_insert(end);
            if steepest.is_none_or(|(most, _)| fall > most) {
                steepest = Some((fall, Self { start, end }));
            }
        }
        steepest.map(|(_, fall)| fall)
    }

    /// Greatest wavevector at which the density is as without the fall: as far below its start as its end is above.
    fn intact(&self, bins: &[SpectralBin]) -> f64 {
        let [start, end] = [self.start, self.end].map(|ring| bins[ring].wavevector);
        // The ring next to the start may be cut in two.
        bins[self.start - 1].wavevector.min(start * (start / end))
    }
}

/// Mean density below a ring over that from it on; 0 with too few waves on either side.
fn fall(bins: &[SpectralBin], ring: usize) -> f64 {
    let (below, above) = bins.split_at(ring);
    let (Some(last), Some(next)) = (below.last(), above.first()) else {
        return 0.0;
    };
    let reach = libm::exp(REACH);
    let below =
        mean(below.iter().rev().take_while(|bin| bin.wavevector * reach >= last.wavevector));
    let above = mean(above.iter().take_while(|bin| bin.wavevector <= next.wavevector * reach));
    match (below, above) {
        (Some(below), Some(above)) if below > 0.0 => below / above,
        _ => 0.0,
    }
}

/// Mean density of enough waves.
fn mean<'a>(bins: impl Iterator<Item = &'a SpectralBin>) -> Option<f64> {
    let (sum, waves) = bins.fold((0.0, 0.0), |(sum, waves), bin| {
        let count = bin.waves as f64;
        (sum + count * bin.density, waves + count)
    });
    (waves >= FEWEST_WAVES).then_some(sum / waves)
}

/// A wavelength anywhere between two rings: its mean, and the standard deviation of a uniform distribution.
fn place_between(below: &SpectralBin, above: &SpectralBin) -> Estimate {
    let (longer, shorter) = (TAU / below.wavevector, TAU / above.wavevector);
    Estimate {
        value: 0.5 * (longer + shorter),
        standard_error: (longer - shorter) / 12.0_f64.sqrt(),
    }
}

#[cfg(test)]
mod tests;
