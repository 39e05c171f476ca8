//! Products of a matrix, stored row by row, with a few vectors: limited by how fast the matrix is read.

use std::array;

use crate::parallel::vectorized;

/// Numbers that are multiplied at a time: two to four of the widest vectors.
const LANES: usize = 32;

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
