//! Power spectral densities.

use std::f64::consts::{PI, TAU};

use crate::Error;
use crate::surface::{Axis, Topography};

/// Waves of about the same length, and their mean power spectral density.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SpectralBin {
    /// Mean wavevector of the waves, q = 2π/λ \[rad/m\].
    pub wavevector: f64,
    /// Mean power spectral density: \[m⁴\] of a surface, \[m³\] of profiles.
    pub density: f64,
    /// Number of waves. Of two waves that are conjugates of each other, as all are but those of exactly two cells, one
    /// says nothing that the other does not.
    pub waves: usize,
}

/// How wavevectors are put together for a radial mean.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum RadialBins {
    /// Rings of equal width: $`(k - \frac12) \Delta q < |\mathbf q| \le (k + \frac12) \Delta q`$ with Δq = 2π over the
    /// shorter side, k = 1, 2, … Waves longer than twice the shorter side, which oblong maps have, lie in none.
    Linear,
    /// Rings of equal width on a logarithmic scale, so many in a decade, from 2π over the longer side on: the first
    /// begins, and the last ends, a hundredth of a decade beyond the wavevectors. The bins of SurfaceTopography, for
    /// which 10 is the default.
    PerDecade(usize),
    /// Rings between these wavevectors \[rad/m\], which must increase; the upper one belongs to a ring.
    Edges(Vec<f64>),
}

impl RadialBins {
    /// Most rings in a decade.
    const MAX_PER_DECADE: usize = 10_000;

    /// The edges, for wavevectors from the least to the greatest.
    fn edges(&self, map: &Topography) -> Result<Vec<f64>, Error> {
        let grid = map.grid();
        let greatest = greatest_wavevector(map);
        match self {
            Self::Linear => {
                let width = TAU / grid.of_directions(grid.sides(), f64::min);
                // The cast saturates; the number is at most that of the nodes along the shorter side.
                let rings = (greatest / width + 0.5) as usize;
                Ok((0..=rings).map(|k| (k as f64 + 0.5) * width).collect())
            }
            Self::PerDecade(rings) => {
                let is_number = (1..=Self::MAX_PER_DECADE).contains(rings);
                let quantity = "number of bins in a decade";
                Error::require(quantity, *rings as f64, is_number, "from 1 to 10000")?;
                let least = TAU / grid.of_directions(grid.sides(), f64::max);
                const BEYOND: f64 = 0.01;
                let (first, last) = (libm::log10(least) - BEYOND, libm::log10(greatest) + BEYOND);
                let decades = libm::log10(greatest) - libm::log10(least);
                let edges = ((decades + 1.0) * *rings as f64).ceil().max(2.0);
                let step = (last - first) / (edges - 1.0);
                let exponents = (0..edges as usize).map(|k| first + k as f64 * step);
                Ok(exponents.map(|exponent| libm::pow(10.0, exponent)).collect())
            }
            Self::Edges(edges) => {
                // NaN is not greater than anything.
                let mut last = f64::NEG_INFINITY;
                for &edge in edges {
                    if edge > last && edge.is_finite() {
                        last = edge;
                        continue;
                    }
                    return Err(Error::OutOfRange {
                        quantity: "edge of a bin",
                        value: edge,
                        expected: "finite and greater than the one before",
                    });
                }
                Ok(edges.clone())
            }
        }
    }
}

/// Up to here there are waves in all directions: π over the longer side of a cell, but for directions of one node.
pub(super) fn greatest_wavevector(map: &Topography) -> f64 {
    let grid = map.grid();
    PI / grid.of_directions((grid.dx(), grid.dy()), f64::max)
}

impl Topography {
    /// Radially averaged power spectral density C(q) \[m⁴\] of the map, taken as periodic: the mean over the waves of
    /// each ring of
    ///
    /// ```math
    /// C(\mathbf q) = \frac1A \Bigl| \Delta A \sum_{ij} h_{ij}\, e^{-i \mathbf q \cdot \mathbf x_{ij}} \Bigr|^2
    ///     = A\, |\hat h_{\mathbf q}|^2, \qquad
    /// S_q^2 = \frac1A \sum_{\mathbf q \ne 0} C(\mathbf q)
    ///    \approx \frac1{4 \pi^2} \int C \,\mathrm d^2 q
    /// ```
    ///
    /// in the normalisation of Jacobs, Junge and Pastewka: (2π)² times that of
    /// [`Spectrum::psd`](crate::surface::Spectrum::psd). Rings reach up to π over the longer side of a cell; those
    /// without waves are left out. Level a map that is not periodic, and put a [window](Self::window) on it, before.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for edges that do not increase, and for a number of bins that is 0 or above 10 000.
    ///
    /// # References
    ///
    /// T. D. B. Jacobs, T. Junge and L. Pastewka, Quantitative characterization of surface topography using spectral
    /// analysis, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001.
    pub fn radial_psd(&self, bins: &RadialBins) -> Result<Vec<SpectralBin>, Error> {
        let edges = bins.edges(self)?;
        let mut rings = vec![(0.0, 0.0, 0_usize); edges.len()];
        for wave in self.waves().iter() {
            let q = libm::hypot(wave.q.0, wave.q.1);
            let after = edges.partition_point(|edge| *edge < q);
            if after > 0 && after < edges.len() {
                let (wavevector, power, waves) = &mut rings[after - 1];
                *wavevector += wave.count as f64 * q;
                *power += wave.count as f64 * wave.power;
                *waves += wave.count;
            }
        }
        let area = self.grid().nominal_area();
        let filled = rings.into_iter().filter(|(_, _, waves)| *waves > 0);
        Ok(filled
            .map(|(wavevector, power, waves)| SpectralBin {
                wavevector: wavevector / waves as f64,
                density: area * (power / waves as f64),
                waves,
            })
            .collect())
    }

    /// Power spectral density C¹ᴰ(q) \[m³\] of the profiles along `axis`, taken as periodic, averaged over all of them:
    ///
    /// ```math
    /// C^\mathrm{1D}(q_k) = \frac1L \Bigl\langle \Bigl| \Delta x \sum_i h_{ij}\, e^{-i q_k x_i} \Bigr|^2 \Bigr\rangle_j,
    ///    \qquad q_k = \frac{2 \pi k}L, \quad k = 1, 2, \dots, \lfloor n/2 \rfloor
    /// ```
    ///
    /// Two-sided: the mean square height about the mean of each profile is 1/L times the sum over positive and
    /// negative k, where k = n/2 counts once. Normalisation as for [`radial_psd`](Self::radial_psd).
    #[must_use]
    pub fn psd_along(&self, axis: Axis) -> Vec<SpectralBin> {
        let (nodes, side) = (axis.of(self.grid().shape()), axis.of(self.grid().sides()));
        // By Parseval's theorem the mean over profiles is the sum over waves across them.
        let mut sums = vec![(0.0, 0_usize); nodes / 2 + 1];
        for wave in self.waves().iter() {
            if let Some((power, waves)) = sums.get_mut(axis.of(wave.k).unsigned_abs() as usize) {
                *power += wave.count as f64 * wave.power;
                *waves += wave.count;
            }
        }
        let bins = sums.into_iter().enumerate().skip(1);
        bins.map(|(k, (power, waves))| SpectralBin {
            wavevector: TAU * k as f64 / side,
            density: side * power / if 2 * k == nodes { 1.0 } else { 2.0 },
            waves,
        })
        .collect()
    }

    /// Shortest and longest wavelength \[m\] of which the map has waves in all directions and in one: two cells, of the
    /// longer side, and the longer side of the map. Directions with one node do not count.
    #[must_use]
    pub fn bandwidth(&self) -> (f64, f64) {
        let longest = self.grid().of_directions(self.grid().sides(), f64::max);
        (TAU / greatest_wavevector(self), longest)
    }
}
