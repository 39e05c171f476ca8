//! Small dense algebra in single precision, for preconditioners: they need no more.

/// Numbers that are multiplied at a time.
const LANES: usize = 16;

/// `x ← A⁻¹ x` for a symmetric positive definite A given column by column, of which only the lower triangle
/// is read; it becomes its Cholesky factor.
#[inline(always)]
pub(crate) fn solve_in_place(a: &mut [f32], size: usize, x: &mut [f32]) {
    for j in 0..size {
        let (before, rest) = a.split_at_mut(j * size);
        let column = &mut rest[j..size];
        subtract_columns(before, size, j, column);
        // Rounding must not end it: a solution that is a little off is as good as any.
        let root = column[0].max(1e-6).sqrt();
        let inverse = 1.0 / root;
        column[0] = root;
        for value in &mut column[1..] {
            *value *= inverse;
        }
        x[j] *= inverse;
        let (here, below) = x[j..].split_at_mut(1);
        for (value, entry) in below.iter_mut().zip(&column[1..]) {
            *value -= entry * here[0];
        }
    }
    for j in (0..size).rev() {
        let column = &a[j * size + j..(j + 1) * size];
        let (here, below) = x[j..].split_at_mut(1);
        here[0] = (here[0] - product(&column[1..], below)) / column[0];
    }
}

/// column −= Σ_k L_jk L_k from row j down, for all columns k before j; four at a time, so that the column
/// passes the registers a quarter as often.
#[inline(always)]
fn subtract_columns(before: &[f32], size: usize, j: usize, column: &mut [f32]) {
    let mut blocks = before.chunks_exact(4 * size);
    for block in &mut blocks {
        let of = |k: usize| &block[k * size + j..(k + 1) * size];
        let (c0, c1, c2, c3) = (of(0), of(1), of(2), of(3));
        let (a0, a1, a2, a3) = (c0[0], c1[0], c2[0], c3[0]);
        for ((((value, x0), x1), x2), x3) in column.iter_mut().zip(c0).zip(c1).zip(c2).zip(c3) {
            *value -= (a0 * x0 + a1 * x1) + (a2 * x2 + a3 * x3);
        }
    }
    for other in blocks.remainder().chunks_exact(size) {
        let other = &other[j..];
        let factor = other[0];
        for (value, x) in column.iter_mut().zip(other) {
            *value -= factor * x;
        }
    }
}

/// Σ aᵢ bᵢ in a fixed order.
#[inline(always)]
pub(crate) fn product(a: &[f32], b: &[f32]) -> f32 {
    let mut sums = [0.0_f32; LANES];
    let (whole, rest) = a.as_chunks::<LANES>();
    let (others, others_rest) = b.as_chunks::<LANES>();
    for (a, b) in whole.iter().zip(others) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    let rest: f32 = rest.iter().zip(others_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f32>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small integers come back from a matrix that is dominated by its diagonal, of sizes up to and beyond blocks of
    /// four columns and of 16 numbers.
    #[test]
    fn equations_are_solved_in_place() {
        for size in [1, 2, 4, 5, 16, 18, 37] {
            let entry = |i: usize, j: usize| {
                let (i, j) = (i.min(j), i.max(j));
                if i == j { 64.0 } else { ((3 * i + 5 * j) % 7) as f32 / 8.0 }
            };
            let expected = |i: usize| (i % 5) as f32 - 2.0;
            let mut matrix: Vec<f32> = (0..size * size)
                .map(|k| (k % size, k / size))
                // Nothing above the diagonal is read.
                .map(|(i, j)| if i < j { f32::NAN } else { entry(i, j) })
                .collect();
            let mut x: Vec<f32> =
                (0..size).map(|i| (0..size).map(|j| entry(i, j) * expected(j)).sum()).collect();
            solve_in_place(&mut matrix, size, &mut x);
            for (i, found) in x.iter().enumerate() {
                // The condition number is near 1: some ten rounding errors of 6·10⁻⁸ of numbers up to 2.
                assert!((found - expected(i)).abs() < 2e-6, "{size} {i}: {found}");
            }
        }
    }

    /// Sums of products of small integers are exact.
    #[test]
    fn products_have_all_their_terms() {
        for length in [0, 1, 15, 16, 17, 32, 45] {
            let a: Vec<f32> = (0..length).map(|k| (k % 7) as f32 - 2.0).collect();
            let b: Vec<f32> = (0..length).map(|k| (k % 5) as f32 + 1.0).collect();
            let sum: f32 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
            assert_eq!(product(&a, &b), sum);
        }
    }
}
