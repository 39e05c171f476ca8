//! What varies along x on a grid that repeats along x alone.

use asperity_fft::{Fft, Plan};
use num_complex::Complex64;

use super::cells::Stresses;
use super::depth::Depth;
use super::load::{COMPONENTS, Response};
use super::waves::along_a_line;
use crate::Grid;
use crate::convolution::fast_size;
use crate::parallel::for_each_chunk;

/// What varies along x as a wave of the number q fades across as exp(−q|y|), so that it is the same on a grid that also
/// repeats across, at a distance of so many of its lengths: 4·10⁻¹⁷ is left.
const APART: f64 = 6.0;

/// A spectrum at one wave.
type Spectra = [Complex64; COMPONENTS];

/// Adds the waves that vary along x of the response to a load on one cell, at offsets of 0 ≤ i < nx and 0 ≤ j < ny, i
/// fastest.
///
/// Each wave along x has a period across of its own, the shorter the faster it fades, so that no grid of all of them is
/// held.
pub(super) fn add_waves_along_x(
    values: &mut [Stresses],
    grid: &Grid,
    depth: &Depth,
    response: &Response,
) {
    let (nx, ny) = grid.shape();
    let sides = (grid.dx(), grid.dy());
    let signs: [(f64, f64); COMPONENTS] = std::array::from_fn(|c| response.signs(c));
    let mut lines = vec![[0.0; COMPONENTS]; nx / 2 * ny];
    for_each_chunk(&mut lines, ny, |place, line| {
        let kx = place + 1;
        let apart = (APART * grid.sides().0 / (kx as f64 * grid.dy())).ceil() as usize;
        let period = fast_size(ny.saturating_add(apart));
        let of_wave = along_a_line(kx, (nx, period), sides, depth, response);
        if of_wave.is_empty() {
            return;
        }
        let spectrum = of_wave.iter().map(|values| {
            // Odd functions are sums of sines.
            std::array::from_fn(|c| match signs[c] {
                (_, y) if y < 0.0 => Complex64::new(0.0, values[c]),
                _ => Complex64::new(values[c], 0.0),
            })
        });
        let per = 1.0 / period as f64;
        let put = |j: usize, c: usize, value: f64| line[j][c] = per * value;
        transform(&*f64::complex_inverse(period), &spectrum.collect::<Vec<_>>(), ny, put);
    });
    let plan = f64::complex_inverse(nx);
    for_each_chunk(values, nx, |j, row| {
        let spectrum = (0..=nx / 2).map(|kx| {
            let Some(place) = kx.checked_sub(1) else {
                return [Complex64::ZERO; COMPONENTS];
            };
            let value = &lines[j + ny * place];
            std::array::from_fn(|c| match signs[c] {
                (x, y) if x < 0.0 => Complex64::new(0.0, y * value[c]),
                _ => Complex64::new(value[c], 0.0),
            })
        });
        let per = 1.0 / nx as f64;
        let add = |i: usize, c: usize, value: f64| row[i][c] += per * value;
        transform(&*plan, &spectrum.collect::<Vec<_>>(), nx, add);
    });
}

/// Hands over the first `count` values of the real functions whose spectra are given at 0 ≤ k ≤ n/2, or from 0 to where
/// nothing is left. A wave that is its own mirror image has a real part alone.
fn transform(
    plan: &dyn Fft<f64>,
    spectrum: &[Spectra],
    count: usize,
    mut put: impl FnMut(usize, usize, f64),
) {
    let n = plan.len();
    let mut line = vec![Complex64::ZERO; n];
    let mut scratch = vec![Complex64::ZERO; plan.get_inplace_scratch_len()];
    // Two at a time, as real and imaginary parts.
    for first in (0..COMPONENTS).step_by(2) {
        line.fill(Complex64::ZERO);
        for (k, values) in spectrum.iter().enumerate() {
            let (a, b) = (values[first], values[first + 1]);
            let mirrored = (n - k) % n;
            if mirrored == k {
                line[k] = Complex64::new(a.re, b.re);
            } else {
                line[k] = Complex64::new(a.re - b.im, a.im + b.re);
                line[mirrored] = Complex64::new(a.re + b.im, b.re - a.im);
            }
        }
        plan.process_with_scratch(&mut line, &mut scratch);
        for (j, value) in line.iter().take(count).enumerate() {
            put(j, first, value.re);
            put(j, first + 1, value.im);
        }
    }
}
