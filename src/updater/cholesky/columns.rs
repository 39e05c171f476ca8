//! Right-hand sides under forward substitution.

use std::mem;
use std::ops::Range;
use std::ptr;

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, MatMut, MatRef, Par};
use nalgebra::DMatrix;

use super::operations;
use super::panels::{Panels, Rotation, rotate};
use super::products::subtract_transposed;
use crate::parallel::{self, vectorized};
use crate::updater::WindowFactor;
use crate::updater::tuning::{CACHED_ROWS, LANES, ROWS, UNIT, WIDTH};

/// The forward-substituted columns `F = L⁻¹C_IP` of the watched nodes P, which grow with the
/// factor L.
///
/// The columns come in blocks, of which the first ones hold those that were watched before. A block is
/// stored row by row: then products with L run at full speed without repacking L.
#[derive(Debug, Clone, Default)]
pub(super) struct Columns {
    rows: usize,
    blocks: Vec<Block>,
    /// Buffers of blocks that are gone, for new ones: pages that are new to a process cost as much as a tenth of the
    /// products.
    spare: Vec<Vec<f64>>,
}

/// Some neighbouring columns, row by row.
#[derive(Debug, Clone, Default)]
struct Block {
    width: usize,
    values: Vec<f64>,
}

impl Block {
    /// The first rows of the columns `columns`.
    fn view(&self, rows: usize, columns: Range<usize>) -> MatRef<'_, f64> {
        view(&self.values, self.width, rows, columns)
    }
}

/// The first rows of some columns of a block.
fn view(values: &[f64], width: usize, rows: usize, columns: Range<usize>) -> MatRef<'_, f64> {
    if rows == 0 {
        return MatRef::from_row_major_slice(&[], rows, columns.len());
    }
    let start = &values[columns.start..];
    MatRef::from_row_major_slice_with_stride(start, rows, columns.len(), width)
}

impl Columns {
    /// Bytes that the columns of `watched` nodes take.
    pub(super) fn bytes(rows: usize, watched: usize) -> usize {
        rows.checked_next_multiple_of(ROWS)
            .and_then(|rows| rows.checked_mul(watched))
            .map_or(usize::MAX, |values| values.saturating_mul(size_of::<f64>()))
    }

    /// An empty buffer with room for so many rows, rounded up: a little too large now, it is large enough for the
    /// windows that follow.
    fn room(&mut self, rows: usize, width: usize) -> Vec<f64> {
        let values = rows.next_multiple_of(ROWS) * width;
        let spare = self.spare.iter().enumerate();
        let nearest = spare.min_by_key(|(_, room)| room.capacity().abs_diff(values));
        let nearest = nearest.map(|(index, _)| index);
        let mut room = nearest.map_or_else(Vec::new, |index| self.spare.swap_remove(index));
        room.clear();
        room.shrink_to(values);
        room.reserve_exact(values);
        room
    }

    /// Keeps, of the columns that were watched before, those at `kept` (ascending), and makes room
    /// for `new` more.
    pub(super) fn watch(&mut self, kept: &[usize], new: usize) {
        let rows = self.rows;
        let all: usize = self.blocks.iter().map(|block| block.width).sum();
        if kept.len() == all && all > 0 {
            return self.add(new);
        }
        let old = self.blocks.first().map_or(0, |block| block.width);
        if kept.last().is_some_and(|&last| last >= old) {
            // Some were new the last time, and nothing has touched since.
            return self.gather(kept, new);
        }
        self.blocks.truncate(1);
        if kept.is_empty() {
            self.blocks.clear();
        } else if let Some(block) = self.blocks.first_mut().filter(|_| kept.len() < old) {
            let mut to = 0;
            for row in 0..rows {
                for &position in kept {
                    block.values[to] = block.values[row * old + position];
                    to += 1;
                }
            }
            block.values.truncate(to);
            block.width = kept.len();
        }
        self.add(new);
    }

    /// The same where those to keep are in several blocks.
    fn gather(&mut self, kept: &[usize], new: usize) {
        let mut values = self.room(self.rows, kept.len());
        let located: Vec<_> = kept.iter().filter_map(|&position| self.locate(position)).collect();
        for row in 0..self.rows {
            values.extend(
                located.iter().map(|(block, column)| block.values[row * block.width + column]),
            );
        }
        self.blocks = vec![Block { width: kept.len(), values }];
        self.add(new);
    }

    /// Makes room for new columns.
    fn add(&mut self, new: usize) {
        let rows = self.rows;
        // An even number of blocks of much the same width, so that two threads end together.
        let blocks = 2 * new.div_ceil(2 * WIDTH);
        let units = new.div_ceil(UNIT);
        let end = |block: usize| new.min(block * units / blocks * UNIT);
        for block in 0..blocks {
            let width = end(block + 1) - end(block);
            if width > 0 {
                let values = self.room(rows, width);
                self.blocks.push(Block { width, values });
            }
        }
        self.spare.clear();
    }

    /// Fills the columns from `first` on (the beginning of a block) with right-hand sides and solves
    /// `L F = B` for them. `fill(row, c, values)` writes a row of the right-hand sides from
    /// column `c` on.
    ///
    /// Blocks are independent, so that the result does not depend on how many threads share them.
    pub(super) fn forward_substitute(
        &mut self,
        factor: &Panels,
        first: usize,
        fill: impl Fn(usize, usize, &mut [f64]) + Sync,
    ) {
        let mut starts = Vec::with_capacity(self.blocks.len());
        let mut position = 0;
        for block in &mut self.blocks {
            starts.push((position, block));
            position += starts.last().map_or(0, |(_, block)| block.width);
        }
        let new = starts.partition_point(|(start, _)| *start < first);
        let columns = starts[new..].iter().map(|(_, block)| block.width).sum();
        let work = operations::forward(factor.rows(), columns);
        parallel::for_each(work, &mut starts[new..], |(start, block)| {
            let width = block.width;
            for p in 0..factor.len() {
                let (first, count) = (p * ROWS, factor.rows_in(p));
                block.values.resize((first + count) * width, 0.0);
                let (above, here) = block.values.split_at_mut(first * width);
                for (row, values) in (first..).zip(here.chunks_mut(width)) {
                    fill(row, *start, values);
                }
                let above = view(above, width, first, 0..width);
                let mut here = MatMut::from_row_major_slice_mut(here, count, width);
                let left = factor.left(p);
                matmul(here.as_mut(), Accum::Add, left, above, -1.0, Par::Seq);
                solve_lower_triangular_in_place(factor.diagonal(p), here, Par::Seq);
            }
        });
    }

    /// `x ← L⁻¹ x` for some right-hand sides.
    pub(super) fn solve<const N: usize>(factor: &Panels, x: &mut [[f64; N]]) {
        let mut columns = Self::default();
        columns.watch(&[], N);
        columns.forward_substitute(factor, 0, |row, first, values| {
            values.copy_from_slice(&x[row][first..first + values.len()]);
        });
        let solved = columns.blocks.iter().flat_map(|block| block.values.chunks(block.width));
        for (x, solved) in x.iter_mut().zip(solved) {
            x.copy_from_slice(solved);
        }
    }

    /// `L⁻ᵀ F` for the columns at some positions. Columns are independent, so that the result does not depend on how
    /// many threads share them.
    pub(super) fn solved_backwards(&self, factor: &Panels, positions: &[usize]) -> DMatrix<f64> {
        let rows = factor.rows();
        let mut solved = DMatrix::zeros(rows, positions.len());
        let located = positions.iter().filter_map(|&position| self.locate(position));
        for ((block, column), target) in located.zip(solved.as_mut_slice().chunks_mut(rows.max(1)))
        {
            let values = block.values.get(column..).unwrap_or_default();
            for (target, value) in target.iter_mut().zip(values.iter().step_by(block.width)) {
                *target = *value;
            }
        }
        let work = operations::forward(rows, positions.len());
        let mut parts: Vec<&mut [f64]> =
            solved.as_mut_slice().chunks_mut((UNIT * rows).max(1)).collect();
        parallel::for_each(work, &mut parts, |part| {
            let width = part.len() / rows.max(1);
            let mut part = MatMut::from_column_major_slice_mut(part, rows, width);
            for p in (0..factor.len()).rev() {
                let (first, count) = (p * ROWS, factor.rows_in(p));
                let (above, below) = part.as_mut().split_at_row_mut(first);
                let mut here = below.subrows_mut(0, count);
                let diagonal = factor.diagonal(p).transpose();
                solve_upper_triangular_in_place(diagonal, here.as_mut(), Par::Seq);
                let left = factor.left(p).transpose();
                matmul(above, Accum::Add, left, here.as_ref(), -1.0, Par::Seq);
            }
        });
        solved
    }

    /// S −= Fᵀ F (lower triangle, column by column), but for the first `known` columns (all of those that were watched
    /// before, or none) among themselves.
    pub(super) fn subtract_gram(&self, known: usize, mut matrix: &mut [f64]) {
        let tiles = self.tiles();
        let size = tiles.last().map_or(0, |(start, _, columns)| start + columns.len());
        let new = tiles.partition_point(|(start, ..)| *start < known);
        let mut tasks = Vec::with_capacity(tiles.len());
        for first in 0..tiles.len() {
            let (s, rest) = matrix.split_at_mut(tiles[first].2.len() * size);
            matrix = rest;
            tasks.push((&tiles[first], &tiles[first.max(new)..], s));
        }
        let work = operations::gram(self.rows, size) - operations::gram(self.rows, known.min(size));
        parallel::for_each(work, &mut tasks, |((_, block, columns), tiles, s)| {
            let here = block.view(self.rows, columns.clone());
            for (start, block, rows) in *tiles {
                let below = block.view(self.rows, rows.clone()).transpose();
                let (height, width) = (rows.len(), columns.len());
                let s = &mut s[*start..];
                let s = MatMut::from_column_major_slice_with_stride_mut(s, height, width, size);
                matmul(s, Accum::Add, below, here, -1.0, Par::Seq);
            }
        });
    }

    /// R −= Fᵀ X for X given row by row.
    pub(super) fn subtract_products<const N: usize>(&self, x: &[[f64; N]], mut r: &mut [[f64; N]]) {
        let tiles = self.tiles();
        let work = operations::reading(self.rows, r.len());
        let mut tasks = Vec::with_capacity(tiles.len());
        for (_, block, columns) in &tiles {
            let (here, rest) = r.split_at_mut(columns.len());
            r = rest;
            tasks.push((block, columns.start, here));
        }
        parallel::for_each(work, &mut tasks, |(block, column, r)| {
            let mut sums = [[0.0; WIDTH]; N];
            let values = block.values.get(*column..).unwrap_or_default();
            let targets = sums.each_mut().map(|sums| &mut sums[..r.len()]);
            subtract_transposed(values, block.width, x, targets);
            for (k, r) in r.iter_mut().enumerate() {
                for (r, sums) in r.iter_mut().zip(&sums) {
                    *r += sums[k];
                }
            }
        });
    }

    /// Ranges of at most [`WIDTH`] columns of one block: (first position, block, its columns).
    fn tiles(&self) -> Vec<(usize, &Block, Range<usize>)> {
        let mut tiles = Vec::new();
        let mut position = 0;
        for block in &self.blocks {
            for start in (0..block.width).step_by(WIDTH) {
                let end = (start + WIDTH).min(block.width);
                tiles.push((position + start, block, start..end));
            }
            position += block.width;
        }
        tiles
    }

    /// The block of a position, and the column in it.
    fn locate(&self, mut position: usize) -> Option<(&Block, usize)> {
        for block in &self.blocks {
            if position < block.width {
                return Some((block, position));
            }
            position -= block.width;
        }
        None
    }

    /// Appends to the factor the rows of the nodes that touched, and their rows of R to the columns
    /// of those that did not (at `untouched`, ascending).
    pub(super) fn commit(
        &mut self,
        factor: &mut Panels,
        touched: &WindowFactor,
        untouched: &[usize],
    ) {
        let before = self.rows;
        let width = untouched.len();
        let mut values = self.room(before + touched.len(), width);
        values.resize(before * width, 0.0);
        factor.push_rows(touched.len());
        let window = |position, event| touched.factor(position, event);
        let located = |positions: &[usize]| -> Vec<_> {
            positions
                .iter()
                .filter_map(|&position| Some((position, self.locate(position)?)))
                .collect()
        };
        // What is left of each block, by its columns there.
        let mut left: Vec<(&Block, Vec<usize>)> = Vec::new();
        for (_, (block, column)) in located(untouched) {
            match left.last_mut() {
                Some((last, columns)) if ptr::eq(*last, block) => columns.push(column),
                _ => left.push((block, vec![column])),
            }
        }

        let columns = located(touched.positions());
        // The new rows of L in pieces, each with its rows of F, so that a thread reads its part of F
        // once for all.
        let mut kept = values.chunks_mut((ROWS * width).max(1));
        let firsts = (0..before).step_by(ROWS);
        let mut pieces: Vec<Piece> = firsts
            .map(|first| Piece {
                first,
                rows: Vec::with_capacity(columns.len()),
                kept: kept.next().unwrap_or_default(),
            })
            .collect();
        for row in factor.rows_mut(before) {
            for (piece, target) in pieces.iter_mut().zip(row[..before].chunks_mut(ROWS)) {
                piece.rows.push(target);
            }
        }
        let work = operations::moving(before, touched.watched());
        parallel::for_each(work, &mut pieces, |Piece { first, rows, kept }| {
            let first = *first;
            let count = ROWS.min(before - first);
            // So few rows of F at a time stay in cache while all rows of L take from them.
            for start in (0..count).step_by(CACHED_ROWS) {
                let end = count.min(start + CACHED_ROWS);
                for ((_, (block, column)), target) in columns.iter().zip(&mut *rows) {
                    let values = &block.values[(first + start) * block.width + column..];
                    let values = values.iter().step_by(block.width);
                    for (target, value) in target[start..end].iter_mut().zip(values) {
                        *target = *value;
                    }
                }
                for row in start..end {
                    let mut values = &mut kept[row * width..][..width];
                    for (block, columns) in &left {
                        let source = &block.values[(first + row) * block.width..];
                        for (value, &column) in values.iter_mut().zip(columns) {
                            *value = source[column];
                        }
                        values = &mut values[columns.len()..];
                    }
                }
            }
        });

        for (last, row) in factor.rows_mut(before).enumerate() {
            let position = touched.positions()[last];
            for (event, target) in row[before..=before + last].iter_mut().enumerate() {
                *target = window(position, event);
            }
        }
        for event in 0..touched.len() {
            values.extend(untouched.iter().map(|&position| window(position, event)));
        }
        let blocks = mem::replace(&mut self.blocks, vec![Block { width, values }]);
        self.spare.extend(blocks.into_iter().map(|block| block.values));
        self.rows = before + touched.len();
    }

    /// Keeps the first `rows` rows, of the columns of nodes that did not touch.
    pub(super) fn truncate(&mut self, rows: usize) {
        self.rows = rows;
        for block in &mut self.blocks {
            block.values.truncate(rows * block.width);
        }
    }

    /// Lets the columns at `kept` follow a factor that loses rows at `positions` (both ascending), and appends those of
    /// the nodes that leave: their rows of L, zero behind the diagonal. Of the remaining rows behind the first that
    /// goes each has its rotations, as [`remove_and`](super::panels::remove_and) makes them.
    ///
    /// With `C_IP = L F` and the remaining rows `L Q = (L', 0)` the columns are the first rows of `Qᵀ F`.
    pub(super) fn leave(
        &mut self,
        kept: &[usize],
        positions: &[usize],
        leaving: &[Vec<f64>],
        rotations: &[Vec<Rotation>],
    ) {
        let (rows, first) = (self.rows, positions.first().copied().unwrap_or(self.rows));
        let located: Vec<_> = kept.iter().filter_map(|&position| self.locate(position)).collect();
        let sources: Vec<Source<'_>> = located
            .into_iter()
            .map(|(block, column)| Source::Column(block, column))
            .chain(leaving.iter().map(|row| Source::Row(row)))
            .collect();
        let mut blocks: Vec<(&[Source<'_>], Block)> = sources
            .chunks(WIDTH.next_multiple_of(LANES))
            .map(|sources| (sources, Block::default()))
            .collect();
        let work = operations::rotations(sources.len(), rows - first, positions.len() / 2 + 1);
        parallel::for_each(work, &mut blocks, |(sources, block)| {
            let width = sources.len();
            let padded = width.next_multiple_of(LANES);
            let mut gone: Vec<f64> = Vec::with_capacity(positions.len() * padded);
            let mut line = vec![0.0; padded];
            block.width = width;
            block.values.reserve_exact((rows - positions.len()) * width);
            let mut rotations = rotations.iter();
            let mut next = positions.iter().peekable();
            for row in 0..rows {
                for (value, source) in line.iter_mut().zip(*sources) {
                    *value = match source {
                        Source::Column(block, column) => block.values[row * block.width + column],
                        Source::Row(values) => values.get(row).copied().unwrap_or_default(),
                    };
                }
                if next.next_if_eq(&&row).is_some() {
                    gone.extend_from_slice(&line);
                    continue;
                }
                if row > first
                    && let Some(rotations) = rotations.next()
                {
                    rotate_line(rotations, &mut line, &mut gone);
                }
                block.values.extend_from_slice(&line[..width]);
            }
        });
        self.blocks = blocks.into_iter().map(|(_, block)| block).collect();
        self.spare.clear();
        self.rows = rows - positions.len();
    }

    /// Forgets all columns, of a factor that has `rows` rows now.
    pub(super) fn forget(&mut self, rows: usize) {
        self.rows = rows;
        self.blocks.clear();
    }
}

/// Where a column comes from.
enum Source<'a> {
    Column(&'a Block, usize),
    /// A row of the factor.
    Row(&'a [f64]),
}

/// Rotates a row with each of those that are gone, one after the other.
fn rotate_line(rotations: &[Rotation], line: &mut [f64], gone: &mut [f64]) {
    let padded = line.len();
    vectorized(
        #[inline(always)]
        || {
            for (rotation, gone) in rotations.iter().zip(gone.chunks_exact_mut(padded)) {
                let line = line.as_chunks_mut::<LANES>().0;
                for (l, x) in line.iter_mut().zip(gone.as_chunks_mut::<LANES>().0) {
                    rotate(*rotation, l, x);
                }
            }
        },
    );
}

/// Rows of F on their way into rows of L, and into the columns that are kept.
struct Piece<'a> {
    /// The first row of F.
    first: usize,
    rows: Vec<&'a mut [f64]>,
    kept: &'a mut [f64],
}

#[cfg(test)]
mod tests;
