//! Transposition, in two steps that both touch memory in long runs.
//!
//! Lines (rows or columns) are stored in blocks of [`BLOCK`], interleaved: all numbers at place 0
//! of the lines of a block, then all at place 1, and so on. The lines of the other direction that
//! belong to one block then find a tile of [`BLOCK`] × [`BLOCK`] numbers in one piece. A plain
//! transposition of a grid of 512 × 512 nodes takes a page of memory for every two cache lines,
//! which was 40 % of the time of a convolution.

use num_complex::Complex;

use super::real::Real;
use super::tuning::BLOCK;

/// Number of blocks needed for so many lines.
pub(super) fn blocks(lines: usize) -> usize {
    lines.div_ceil(BLOCK)
}

/// Distance between the lines of a block before they are interleaved.
///
/// It is at least `length` rounded up to whole tiles, and an odd number of cache lines: with a
/// power of two the lines would compete for the same few places of the cache.
pub(super) fn pitch(length: usize) -> usize {
    const PER_CACHE_LINE: usize = 4;
    blocks(length) * BLOCK + PER_CACHE_LINE
}

/// Interleaves [`BLOCK`] lines, which begin every `pitch` numbers.
pub(super) fn interleave<T: Real>(
    lines: &[Complex<T>],
    pitch: usize,
    interleaved: &mut [Complex<T>],
) {
    let (interleaved, _) = interleaved.as_chunks_mut::<BLOCK>();
    let length = interleaved.len();
    let lines: [_; BLOCK] = std::array::from_fn(|line| &lines[line * pitch..][..length]);
    for (place, numbers) in interleaved.iter_mut().enumerate() {
        for (number, line) in numbers.iter_mut().zip(&lines) {
            *number = line[place];
        }
    }
}

/// Collects a block of lines of the other direction from blocks of interleaved ones.
///
/// `interleaved` holds lines of `length` numbers; line number t of the result consists of the
/// numbers at place `BLOCK * block + t` of each of them, and begins at `t * pitch`.
pub(super) fn gather<T: Real>(
    interleaved: &[Complex<T>],
    length: usize,
    block: usize,
    lines: &mut [Complex<T>],
    pitch: usize,
) {
    let first = block * BLOCK;
    let count = BLOCK.min(length - first);
    for (tile, source) in interleaved.chunks_exact(length * BLOCK).enumerate() {
        let (numbers, _) = source[first * BLOCK..].as_chunks::<BLOCK>();
        for (line, numbers) in lines.chunks_mut(pitch).zip(&numbers[..count]) {
            line[tile * BLOCK..][..BLOCK].copy_from_slice(numbers);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transposes_a_rectangle() {
        // 11 lines of 13 numbers; the number says which.
        let (lines, length) = (11, 13);
        let number = |line: usize, place: usize| Complex::new(line as f64, place as f64);
        let across = pitch(length);
        let mut interleaved = vec![Complex::default(); blocks(lines) * BLOCK * length];
        for (block, target) in interleaved.chunks_mut(BLOCK * length).enumerate() {
            let mut source = vec![Complex::default(); BLOCK * across];
            for (line, source) in source.chunks_mut(across).enumerate() {
                for (place, value) in source.iter_mut().enumerate() {
                    *value = number(block * BLOCK + line, place);
                }
            }
            interleave(&source, across, target);
        }
        let along = pitch(lines);
        for block in 0..blocks(length) {
            let mut target = vec![Complex::default(); BLOCK * along];
            gather(&interleaved, length, block, &mut target, along);
            for (t, column) in target.chunks(along).enumerate() {
                let place = block * BLOCK + t;
                for (line, &value) in column[..lines].iter().enumerate() {
                    if place < length {
                        assert_eq!(value, number(line, place));
                    }
                }
            }
        }
    }
}
