//! Loops over independent chunks: on rayon's threads with feature `rayon`, one after the other
//! without it. What a chunk computes does not depend on which, so results are the same bit for bit.

#[cfg(feature = "rayon")]
use std::sync::Mutex;

#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// Operations, a product and a sum of a matrix product say, that pay for waking one thread more: it takes
/// some 0.05 ms to come, and the one that waits for it as long again.
#[cfg(feature = "rayon")]
const WORTH_WAKING: usize = 1 << 22;

/// Runs both, at the same time if there are threads.
pub fn join(a: impl FnOnce() + Send, b: impl FnOnce() + Send) {
    #[cfg(feature = "rayon")]
    rayon::join(a, b);
    #[cfg(not(feature = "rayon"))]
    {
        a();
        b();
    }
}

/// Calls `work` for each item, some `operations` in all. The calling thread takes its share, and all of
/// it if it is small.
pub fn for_each<T: Send>(operations: usize, items: &mut [T], work: impl Fn(&mut T) + Sync + Send) {
    #[cfg(feature = "rayon")]
    {
        let threads = rayon::current_num_threads().min(items.len());
        let woken = (operations / WORTH_WAKING).min(threads.saturating_sub(1));
        let items = Mutex::new(items.iter_mut());
        let next = || items.lock().ok().and_then(|mut items| items.next());
        let share = || std::iter::from_fn(next).for_each(&work);
        if woken == 0 {
            share();
        } else {
            rayon::in_place_scope(|scope| {
                (0..woken).for_each(|_| scope.spawn(|_| share()));
                share();
            });
        }
    }
    #[cfg(not(feature = "rayon"))]
    {
        let _ = operations;
        items.iter_mut().for_each(work);
    }
}

/// Calls `work(i, chunk i)` for chunks of `size` values.
pub fn for_each_chunk<T: Send>(
    values: &mut [T],
    size: usize,
    work: impl Fn(usize, &mut [T]) + Sync + Send,
) {
    #[cfg(feature = "rayon")]
    values.par_chunks_mut(size).enumerate().for_each(|(i, chunk)| work(i, chunk));
    #[cfg(not(feature = "rayon"))]
    for (i, chunk) in values.chunks_mut(size).enumerate() {
        work(i, chunk);
    }
}

/// Calls `work(index, block, scratch)` for every block of `length` elements of `data`.
///
/// The blocks are divided into as many parts as there are `scratch`es; with a single one everything
/// happens in the calling thread. Which thread takes which part does not touch the result.
pub fn for_each_block<T, S, F>(data: &mut [T], length: usize, scratch: &mut [S], work: F)
where
    T: Send,
    S: Send,
    F: Fn(usize, &mut [T], &mut S) + Send + Sync,
{
    let blocks_a_part = data.len().div_ceil(length).div_ceil(scratch.len());
    let work_on_part = |(part, (data, scratch)): (usize, (&mut [T], &mut S))| {
        for (block, data) in data.chunks_mut(length).enumerate() {
            work(part * blocks_a_part + block, data, scratch);
        }
    };
    let part_length = blocks_a_part * length;
    #[cfg(feature = "rayon")]
    if scratch.len() > 1 {
        data.par_chunks_mut(part_length).zip(scratch).enumerate().for_each(work_on_part);
        return;
    }
    data.chunks_mut(part_length).zip(scratch).enumerate().for_each(work_on_part);
}

/// Runs `work` on one of the threads that its loops are divided among: a thread outside of them
/// would go to sleep, and have to be woken, at every loop.
pub fn inside<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    #[cfg(feature = "rayon")]
    return rayon::scope(|_| work());
    #[cfg(not(feature = "rayon"))]
    work()
}

/// Runs `work`, which must be inlined, compiled for the widest vectors this processor has. Without
/// fused multiply-add, which Rust never introduces by itself, results do not depend on which.
#[inline(always)]
pub fn vectorized(work: impl FnOnce()) {
    pulp::Arch::new().dispatch(work);
}
