//! Sums and updates of long vectors in chunks of a fixed size, so that results are the same bit
//! for bit whatever the number of threads.

use std::ops::Range;

use super::tuning::{ALONE, CHUNK};
use crate::parallel::{for_each_chunk, vectorized};

/// Reduces `0..length` chunk by chunk, and the chunks in their order.
fn reduce<T: Copy + Send>(
    length: usize,
    start: T,
    part: impl Fn(Range<usize>) -> T + Sync + Send,
    join: impl Fn(T, T) -> T,
) -> T {
    if length <= CHUNK {
        return join(start, part(0..length));
    }
    let of = |chunk: usize| part(chunk * CHUNK..length.min((chunk + 1) * CHUNK));
    let chunks = length.div_ceil(CHUNK);
    if length <= ALONE {
        return (0..chunks).map(of).fold(start, join);
    }
    let mut parts = vec![start; chunks];
    for_each_chunk(&mut parts, 1, |chunk, value| value[0] = of(chunk));
    parts.into_iter().fold(start, join)
}

/// Σ value(i) for i below `length`.
pub(crate) fn sum_over(length: usize, value: impl Fn(usize) -> f64 + Sync + Send) -> f64 {
    let part = |range: Range<usize>| {
        let mut total = 0.0;
        vectorized(
            #[inline(always)]
            || total = lanes(range, &value),
        );
        total
    };
    reduce(length, 0.0, part, |a, b| a + b)
}

/// A sum in eight interleaved parts, which a vector unit can do at once.
#[inline(always)]
fn lanes(range: Range<usize>, value: &impl Fn(usize) -> f64) -> f64 {
    const LANES: usize = 8;
    let mut totals = [0.0; LANES];
    let mut i = range.start;
    while i + LANES <= range.end {
        for (lane, total) in totals.iter_mut().enumerate() {
            *total += value(i + lane);
        }
        i += LANES;
    }
    let rest: f64 = (i..range.end).map(value).sum();
    totals.into_iter().sum::<f64>() + rest
}

/// Greatest value(i) for i below `length`, and `start` if none exceeds it. NaN wins.
pub(crate) fn greatest(
    length: usize,
    start: f64,
    value: impl Fn(usize) -> f64 + Sync + Send,
) -> f64 {
    let larger = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
    let part = |range: Range<usize>| range.map(&value).fold(start, larger);
    reduce(length, start, part, larger)
}

/// A number of either precision; sums are always in double.
pub(crate) trait Value: Copy + Default + Into<f64> + Send + Sync {}

impl Value for f32 {}
impl Value for f64 {}

/// Σ aᵢ.
pub(crate) fn sum<A: Value>(a: &[A]) -> f64 {
    sum_over(a.len(), |i| a[i].into())
}

/// Σ aᵢ bᵢ.
pub(crate) fn dot<A: Value, B: Value>(a: &[A], b: &[B]) -> f64 {
    let b = &b[..a.len()];
    sum_over(a.len(), |i| a[i].into() * b[i].into())
}

/// y ← y + factor x.
pub(crate) fn add_scaled<X: Value>(y: &mut [f64], factor: f64, x: &[X]) {
    let add = |y: &mut [f64], x: &[X]| {
        vectorized(
            #[inline(always)]
            || {
                for (y, x) in y.iter_mut().zip(x) {
                    *y += factor * (*x).into();
                }
            },
        );
    };
    if y.len() <= ALONE {
        return add(y, x);
    }
    for_each_chunk(y, CHUNK, |chunk, y| add(y, &x[chunk * CHUNK..]));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_integers_are_exact() {
        for length in [0_usize, 1, 7, 8, 4096, 4097, 20_000, ALONE, ALONE + 1, 50_001] {
            let exact = (length * length.saturating_sub(1) / 2) as f64;
            assert_eq!(sum_over(length, |i| i as f64), exact);
            let last = length.saturating_sub(1) as f64;
            assert_eq!(greatest(length, 0.0, |i| i as f64), last);
        }
    }

    /// In small whole numbers, on one thread and on as many as there are: every value is reached once.
    #[test]
    fn multiples_are_added_to_every_value() {
        for length in [0_usize, 1, 4097, ALONE, ALONE + 1, 50_001] {
            let x: Vec<f32> = (0..length).map(|i| i as f32).collect();
            let mut y: Vec<f64> = (0..length).map(|i| (3 * i) as f64).collect();
            add_scaled(&mut y, -2.0, &x);
            assert!(y.iter().enumerate().all(|(i, y)| *y == i as f64), "{length}");
        }
    }

    #[test]
    fn greatest_passes_nan_on() {
        assert!(greatest(3, 0.0, |i| [1.0, f64::NAN, 2.0][i]).is_nan());
        // In any part of many.
        for place in [0, 4096, 40_000, 49_999] {
            let value = |i: usize| if i == place { f64::NAN } else { i as f64 };
            assert!(greatest(50_000, 0.0, value).is_nan(), "{place}");
        }
    }
}
