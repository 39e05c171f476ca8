//! Products of a matrix, stored row by row, with a few vectors: limited by how fast the matrix is read.

use std::array;

use super::precision::Precision;
use crate::parallel::vectorized;

/// Numbers that are multiplied at a time: two to four of the widest vectors.
const LANES: usize = 32;
/// Numbers of a row that stay in the fastest cache while they meet several vectors.
const PIECE: usize = 1024;

/// x −= Aᵀ y for N vectors y, given row by row, with the rows of A `width` apart.
///
/// Four rows at a time, so that x passes the cache a quarter as often.
pub(super) fn subtract_transposed<T: Precision, const N: usize>(
    a: &[T],
    width: usize,
    y: &[[T; N]],
    x: [&mut [T]; N],
) {
    vectorized(
        #[inline(always)]
        || subtract_rows(a, width, y, x),
    );
}

#[inline(always)]
fn subtract_rows<T: Precision, const N: usize>(
    a: &[T],
    width: usize,
    y: &[[T; N]],
    x: [&mut [T]; N],
) {
    let columns = x.iter().map(|x| x.len()).min().unwrap_or_default();
    let whole = columns / LANES * LANES;
    let mut rest = x;
    let mut x = rest.each_mut().map(|x| {
        let whole = x.split_off_mut(..whole).unwrap_or_default();
        whole.as_chunks_mut::<LANES>().0
    });
    let row = |r: usize| &a[r * width..][..columns];
    let chunks = |r: usize| row(r).as_chunks::<LANES>().0;
    let (blocks, single) = y.as_chunks::<4>();
    for (block, [y0, y1, y2, y3]) in blocks.iter().enumerate() {
        let rows = array::from_fn::<_, 4, _>(|r| chunks(4 * block + r));
        for chunk in 0..whole / LANES {
            let [a0, a1, a2, a3] = rows.map(|row| &row[chunk]);
            for (i, x) in x.iter_mut().enumerate() {
                let x = &mut x[chunk];
                for k in 0..LANES {
                    x[k] -= (y0[i] * a0[k] + y1[i] * a1[k]) + (y2[i] * a2[k] + y3[i] * a3[k]);
                }
            }
        }
    }
    for (r, y) in (4 * blocks.len()..).zip(single) {
        for (chunk, a) in chunks(r).iter().enumerate() {
            for (x, y) in x.iter_mut().zip(y) {
                for (x, a) in x[chunk].iter_mut().zip(a) {
                    *x -= *y * *a;
                }
            }
        }
    }
    if whole < columns {
        for (r, y) in y.iter().enumerate() {
            for (i, x) in rest.iter_mut().enumerate() {
                for (x, a) in x.iter_mut().zip(&row(r)[whole..]) {
                    *x -= y[i] * *a;
                }
            }
        }
    }
}

/// products += A x for N vectors x, with the rows of A `width` apart; one product for each row and
/// vector.
pub(super) fn add_products<T: Precision, const N: usize>(
    a: &[T],
    width: usize,
    x: [&[T]; N],
    products: &mut [[T; N]],
) {
    let length = x.iter().map(|x| x.len()).min().unwrap_or_default();
    let row = |r: usize| &a[r * width..][..length];
    vectorized(
        #[inline(always)]
        || {
            let (pairs, rest) = products.as_chunks_mut();
            let single = 2 * pairs.len();
            for (r, [first, second]) in pairs.iter_mut().enumerate() {
                let [a, b] = two_dots([row(2 * r), row(2 * r + 1)], x);
                (0..N).for_each(|i| first[i] += a[i]);
                (0..N).for_each(|i| second[i] += b[i]);
            }
            for product in rest {
                let a = dots(row(single), x);
                (0..N).for_each(|i| product[i] += a[i]);
            }
        },
    );
}

/// Dot products of a row with each of some vectors of the same length, in an order of summation that
/// does not depend on the processor.
#[inline(always)]
pub(super) fn dots<T: Precision, const N: usize>(row: &[T], x: [&[T]; N]) -> [T; N] {
    let mut sums = [[T::default(); LANES]; N];
    let whole = row.len() / LANES * LANES;
    for start in (0..whole).step_by(PIECE) {
        let piece = start..whole.min(start + PIECE);
        for (sums, x) in sums.iter_mut().zip(x) {
            let (row, x) = (&row[piece.clone()], &x[piece.clone()]);
            let mut lanes = *sums;
            for (a, b) in row.as_chunks::<LANES>().0.iter().zip(x.as_chunks().0) {
                add_lanes(&mut lanes, a, b);
            }
            *sums = lanes;
        }
    }
    array::from_fn(|i| total(&sums[i], &row[whole..], &x[i][whole..]))
}

/// The same for two rows at a time.
#[inline(always)]
fn two_dots<T: Precision, const N: usize>(rows: [&[T]; 2], x: [&[T]; N]) -> [[T; N]; 2] {
    let mut sums = [[[T::default(); LANES]; N]; 2];
    let whole = rows[0].len() / LANES * LANES;
    // Piece by piece, so that the rows are read from memory once for all vectors.
    for start in (0..whole).step_by(PIECE) {
        let piece = start..whole.min(start + PIECE);
        let [first, second] = rows.map(|row| row[piece.clone()].as_chunks::<LANES>().0);
        for (i, x) in x.iter().enumerate() {
            let [mut lanes, mut others] = [sums[0][i], sums[1][i]];
            let x = x[piece.clone()].as_chunks().0;
            for ((a, c), b) in first.iter().zip(second).zip(x) {
                add_lanes(&mut lanes, a, b);
                add_lanes(&mut others, c, b);
            }
            [sums[0][i], sums[1][i]] = [lanes, others];
        }
    }
    array::from_fn(|r| array::from_fn(|i| total(&sums[r][i], &rows[r][whole..], &x[i][whole..])))
}

#[inline(always)]
fn add_lanes<T: Precision>(sums: &mut [T; LANES], a: &[T; LANES], b: &[T; LANES]) {
    for k in 0..LANES {
        sums[k] += a[k] * b[k];
    }
}

/// The sum of all lanes and of the products of what is left, less than fills them; in pairs, so that
/// few additions wait for one another.
#[inline(always)]
fn total<T: Precision>(sums: &[T; LANES], a: &[T], b: &[T]) -> T {
    let mut sums = *sums;
    if !a.is_empty() {
        let [mut lanes, mut others] = [[T::default(); LANES]; 2];
        lanes[..a.len()].copy_from_slice(a);
        others[..b.len()].copy_from_slice(b);
        add_lanes(&mut sums, &lanes, &others);
    }
    let mut count = LANES;
    while count > 1 {
        count /= 2;
        for k in 0..count {
            let other = sums[k + count];
            sums[k] += other;
        }
    }
    sums[0]
}
