//! Products of a matrix, stored row by row, with a few vectors: limited by how fast the matrix is read.

use std::array;

use crate::parallel::vectorized;
use crate::updater::tuning::LANES;

/// x −= Aᵀ y for N vectors y, given row by row, with the rows of A `width` apart.
///
/// Four rows at a time, so that x passes the cache a quarter as often.
pub(super) fn subtract_transposed<const N: usize>(
    a: &[f64],
    width: usize,
    y: &[[f64; N]],
    x: [&mut [f64]; N],
) {
    vectorized(
        #[inline(always)]
        || subtract_rows(a, width, y, x),
    );
}

#[inline(always)]
fn subtract_rows<const N: usize>(a: &[f64], width: usize, y: &[[f64; N]], x: [&mut [f64]; N]) {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Products of small integers are exact. Parts of a chunk of 32 columns, several and none; blocks of four rows, and
    /// some more; rows that are wider than what is wanted.
    #[test]
    fn products_are_subtracted() {
        for columns in [0, 1, 31, 32, 33, 64, 100] {
            for rows in 0..10 {
                for width in [columns, columns + 3] {
                    let entry = |r: usize, c: usize| ((5 * r + 3 * c) % 11) as f64 - 4.0;
                    let a: Vec<f64> =
                        (0..rows * width).map(|k| entry(k / width, k % width)).collect();
                    let y: Vec<[f64; 2]> =
                        (0..rows).map(|r| [r as f64 - 2.0, 3.0 - r as f64]).collect();
                    let start = |c: usize| [c as f64, 7.0];
                    let mut x: [Vec<f64>; 2] =
                        [0, 1].map(|k| (0..columns).map(|c| start(c)[k]).collect());
                    let [x0, x1] = &mut x;
                    subtract_transposed(&a, width, &y, [x0, x1]);
                    for (k, x) in x.iter().enumerate() {
                        for (c, found) in x.iter().enumerate() {
                            let products: f64 = (0..rows).map(|r| entry(r, c) * y[r][k]).sum();
                            let expected = start(c)[k] - products;
                            assert_eq!(*found, expected, "{columns} {rows} {width}");
                        }
                    }
                }
            }
        }
    }
}
