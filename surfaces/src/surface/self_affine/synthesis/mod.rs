//! Random phases, and the sum of waves that makes the heights.

mod fft;

use nalgebra::DMatrix;
use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use self::fft::InverseFft;
use super::lattice::Lattice;
use super::spectrum::Spectrum;
use crate::Grid;
use crate::surface::turns;

/// Phases of the waves (m, n) of one m ≥ 0, in turns, for n = 0, −1, 1, −2, 2, …
///
/// The key stream of ChaCha8 with the seed in the first eight bytes of the key (little-endian, the
/// others zero) and m as its stream number; two 32-bit words, the lower one first, a wave.
fn phases(seed: u64, m: i64) -> impl Iterator<Item = (i64, f64)> {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    let mut generator = ChaCha8Rng::from_seed(key);
    generator.set_stream(m.unsigned_abs());
    (0_i64..).map(move |k| {
        let n = if k % 2 == 0 { k / 2 } else { -(k + 1) / 2 };
        let turns = (generator.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        (n, turns)
    })
}

/// Heights of the surface with the given spectrum and seed, at the nodes of the grid.
pub(super) fn heights(spectrum: &Spectrum, seed: u64, grid: &Grid) -> DMatrix<f64> {
    let (nx, ny) = grid.shape();
    let band = spectrum.band();
    let lattice = Lattice::new(grid, band.rolloff_wavelength);
    let m_limit = band.limit(nx, lattice.step_x);
    let n_limit = band.limit(ny, lattice.step_y);
    let mut scratch = Vec::new();

    // Along y: one transform for every m >= 0 in the band. The result is stored with m fastest.
    let rows = m_limit as usize + 1;
    let mut half = vec![Complex64::ZERO; rows * ny];
    let along_y = InverseFft::new(ny);
    let mut waves = vec![Complex64::ZERO; ny];
    let mut transformed = vec![Complex64::ZERO; ny];
    for m in 0..=m_limit {
        waves.fill(Complex64::ZERO);
        for (n, phase) in phases(seed, m).take_while(|(n, _)| *n <= n_limit) {
            let multiplicity = lattice.multiplicity(m, n);
            let amplitude = spectrum.amplitude(lattice.wave_number(m, n));
            if multiplicity == 0.0 || amplitude == 0.0 {
                continue;
            }
            if multiplicity == 1.0 {
                // A wave that is its own conjugate is real: its phase can only be 0 or π.
                let sign = if phase < 0.5 { 1.0 } else { -1.0 };
                waves[n as usize] = Complex64::new(sign * amplitude, 0.0);
                continue;
            }
            // Node (0, 0) sits half a cell from the corner: heights belong to positions.
            let shift = 0.5 * (m as f64 / nx as f64 + n as f64 / ny as f64);
            let wave = turns::cis(phase + shift) * amplitude;
            waves[n.rem_euclid(ny as i64) as usize] = wave;
            if m == 0 || 2 * m as usize == nx {
                waves[(-n).rem_euclid(ny as i64) as usize] = wave.conj();
            }
        }
        along_y.process(&waves, &mut transformed, &mut scratch);
        for (iy, value) in transformed.iter().enumerate() {
            half[iy * rows + m as usize] = *value;
        }
    }

    // Along x: the heights are real, so two columns fit into one transform, as its real and
    // imaginary parts; the other half of the waves are the conjugates of those at hand.
    let along_x = InverseFft::new(nx);
    let mut waves = vec![Complex64::ZERO; nx];
    let mut transformed = vec![Complex64::ZERO; nx];
    let mut heights = DMatrix::zeros(nx, ny);
    let zeros = vec![Complex64::ZERO; rows];
    let i = |z: Complex64| Complex64::new(-z.im, z.re);
    for iy in (0..ny).step_by(2) {
        let first = &half[iy * rows..(iy + 1) * rows];
        let second = half.get((iy + 1) * rows..(iy + 2) * rows).unwrap_or(&zeros);
        for (m, (a, b)) in first.iter().zip(second).enumerate() {
            if m == 0 || 2 * m == nx {
                waves[m] = Complex64::new(a.re, b.re);
            } else {
                waves[m] = a + i(*b);
                waves[nx - m] = a.conj() + i(b.conj());
            }
        }
        along_x.process(&waves, &mut transformed, &mut scratch);
        for (ix, value) in transformed.iter().enumerate() {
            heights[(ix, iy)] = value.re;
            if iy + 1 < ny {
                heights[(ix, iy + 1)] = value.im;
            }
        }
    }
    heights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_come_from_the_documented_key_stream() {
        let found: Vec<_> = phases(0x0123_4567_89ab_cdef, 3).take(40).collect();
        let order: Vec<_> = found.iter().map(|(n, _)| *n).collect();
        assert_eq!(order[..7], [0, -1, 1, -2, 2, -3, 3]);
        let mut key = [0; 32];
        key[..8].copy_from_slice(&[0xef, 0xcd, 0xab, 0x89, 0x67, 0x45, 0x23, 0x01]);
        for (k, (n, turns)) in found.into_iter().enumerate() {
            let mut generator = ChaCha8Rng::from_seed(key);
            generator.set_stream(3);
            generator.set_word_pos(2 * k as u128);
            let low = u64::from(generator.next_u32());
            let high = u64::from(generator.next_u32());
            let bits = (low | high << 32) >> 11;
            assert_eq!(turns, bits as f64 * 2.0_f64.powi(-53), "n = {n}");
            assert!((0.0..1.0).contains(&turns));
        }
    }
}
