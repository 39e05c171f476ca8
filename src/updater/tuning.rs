//! The tuned numbers of factors and Schur complements: only time depends on them, as bench `updater` measures it.

// The factor

/// Rows of a panel: large enough that products of blocks run at the speed of plain GEMM, small
/// enough that the unused upper half of the diagonal blocks does not matter.
pub(crate) const ROWS: usize = 256;
/// Rows that are rotated together, so that a rotation is one vector operation.
pub(crate) const ROTATED: usize = 16;
/// Columns that are rotated before the next rows are: so many that their rotations stay in cache.
pub(crate) const ROTATED_COLUMNS: usize = 128;
/// Numbers that are multiplied at a time: two to four of the widest vectors.
pub(crate) const LANES: usize = 32;
/// Panels that are solved between two meetings of the threads, which take some 0.1 ms each.
pub(crate) const GROUP: usize = 4;
/// Rows of a triangle that is solved row by row.
pub(crate) const SMALL: usize = 32;
/// Unknowns that one thread updates at a time in a backward substitution: enough for rows of L to
/// stream from memory, few enough to stay in cache.
pub(crate) const COLUMNS_AT_ONCE: usize = 1024;

// New columns

/// Greatest width of a block of new columns: wide enough for GEMM at full speed, narrow enough
/// that there are several to share among threads: each block reads all of L.
pub(crate) const WIDTH: usize = 144;
/// Columns of a block come in so many: the matrix product is slower by a fifth for other widths.
pub(crate) const UNIT: usize = 48;
/// Rows of the columns that are spread over the rows of the factor at a time.
pub(crate) const CACHED_ROWS: usize = 16;
/// Nodes that join at a time: so many that a factor grows at the speed of a matrix product.
pub(crate) const JOINED: usize = 256;

// Schur complements

/// Columns that a thread changes at a time.
pub(crate) const TILE: usize = 144;
/// Watched nodes from which waking threads costs less than it saves.
pub(crate) const PARALLEL: usize = 400;
/// Events that are subtracted from the whole Schur complement at a time. Those since then are
/// subtracted from one column after the other: together they are least work where a column of so
/// many events stays in the fastest cache.
pub(crate) const BLOCK: usize = 32;
