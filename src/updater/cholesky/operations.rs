//! How much work the parts of a factorisation are, in products of a matrix product: from it follows how many threads
//! share them, and nothing else.

/// The solution of `L F = B` for so many columns: n²/2 products each.
pub(super) fn forward(rows: usize, columns: usize) -> usize {
    columns * rows * rows / 2
}

/// `Fᵀ F`, of which half is computed.
pub(super) fn gram(rows: usize, columns: usize) -> usize {
    rows * columns * columns / 2
}

/// A product of a matrix of so many rows and columns with a vector or two: as long as it takes to read it.
pub(super) fn reading(rows: usize, columns: usize) -> usize {
    16 * rows * columns
}

/// A rotation of all rows for each pair of a column and one of so many others: three products each.
pub(super) fn rotations(rows: usize, columns: usize, others: usize) -> usize {
    3 * rows * columns * others
}

/// A matrix that is moved: a number on its way to memory that is new takes as long as so many products.
pub(super) fn moving(rows: usize, columns: usize) -> usize {
    64 * rows * columns
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six rows and four columns: 18 products a column; 4 · 4/2 of 6 each; 24 numbers, rotated with two others.
    #[test]
    fn work_of_a_small_matrix() {
        let found = [forward(6, 4), gram(6, 4), reading(6, 4), moving(6, 4), rotations(6, 4, 2)];
        assert_eq!(found, [72, 48, 384, 1536, 144]);
    }
}
