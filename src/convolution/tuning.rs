//! The tuned numbers of convolutions: only time depends on them, as bench `convolution` measures it.

// Threads

/// Parts into which the blocks of a large grid are divided, each with its own working memory.
///
/// It does not depend on the number of threads: they take parts as they become free.
pub(super) const PARTS: usize = 32;
/// Nodes from which threads are worth waking.
pub(super) const PARALLEL_NODES: usize = 96 * 96;

// Memory

/// Lines stored and transposed together: eight complex numbers are two cache lines.
///
/// Blocks of 4 and of 16 took 10-30 % longer on grids of 512 × 512 and 1024 × 1024 nodes.
pub(super) const BLOCK: usize = 8;

// Sizes of transforms

/// Prime factors with a fast butterfly, and the time each takes per point.
///
/// The times are relative to half that of a factor of two. They come from a least-squares fit to
/// the times of all lengths up to 4200 with only these factors (rustfft 6.4 with AVX): 0.16, 0.31,
/// 0.70, 0.78 and 0.90 ns per point.
pub(super) const FACTORS: [(usize, usize); 5] = [(2, 2), (3, 4), (5, 9), (7, 10), (11, 11)];
/// What a point costs whatever the factors: it is filled, multiplied by the symbol and copied.
pub(super) const PER_POINT: usize = 2;
