#![allow(clippy::unwrap_used)]

use super::*;
use crate::updater::cholesky::panels::remove_and;
use crate::updater::{Schur, dominant};

/// Rows of a factor: a whole panel, and a part of one.
const ROWS_HERE: usize = 300;

/// A factor whose diagonal is 4, and beside it powers of 1/2, so that errors do not grow.
fn entry(r: usize, c: usize) -> f64 {
    if r == c {
        return 4.0;
    }
    (-((r - c).min(40) as f64)).exp2()
}

fn factor() -> Panels {
    let mut panels = Panels::default();
    panels.push_rows(ROWS_HERE);
    for (r, row) in panels.rows_mut(0).enumerate() {
        for (c, value) in row[..=r].iter_mut().enumerate() {
            *value = entry(r, c);
        }
    }
    panels
}

/// Small integers, by row and by the number of a column since the beginning.
fn solution(row: usize, column: usize) -> f64 {
    ((row * (column + 2) + column) % 9) as f64 - 4.0
}

/// Columns of these numbers, which are watched beside `kept` (places) of those before, and solved for.
fn watch(columns: &mut Columns, factor: &Panels, kept: &[usize], numbers: &[usize]) {
    columns.watch(kept, numbers.len() - kept.len());
    columns.forward_substitute(factor, kept.len(), |row, first, values| {
        for (value, &number) in values.iter_mut().zip(&numbers[first..]) {
            let terms = (0..=row).map(|r| entry(row, r) * solution(r, number));
            *value = terms.sum();
        }
    });
}

fn check(columns: &Columns, numbers: &[usize], rows: usize) {
    for (position, &number) in numbers.iter().enumerate() {
        let (block, column) = columns.locate(position).unwrap();
        for row in 0..rows {
            let found = block.values[row * block.width + column];
            // Rounding errors of a few numbers up to 40.
            let error = found - solution(row, number);
            assert!(error.abs() < 1e-13, "{position} {row}: {error:e}");
        }
    }
    assert!(columns.locate(numbers.len()).is_none());
}

/// A block of 256 rows at a time.
#[test]
fn bytes_are_those_of_whole_panels() {
    for (rows, watched, bytes) in [
        (0, 9, 0),
        (1, 3, 256 * 3 * 8),
        (256, 1, 2048),
        (257, 7, 512 * 7 * 8),
        (usize::MAX, 1, usize::MAX),
        (256, usize::MAX, usize::MAX),
    ] {
        assert_eq!(Columns::bytes(rows, watched), bytes, "{rows} {watched}");
    }
}

/// Of two that are left the nearest size is used again, cut to what is wanted or made larger.
#[test]
fn room_is_used_again() {
    for (left, rows, width, used, capacity) in [
        ([3000, 600], 256, 2, 600, 512),
        ([600, 3000], 256, 2, 600, 512),
        ([600, 3000], 257, 6, 3000, 3072),
        ([600, 1800], 257, 2, 600, 1024),
    ] {
        let mut columns =
            Columns { spare: Vec::from(left.map(Vec::with_capacity)), ..Columns::default() };
        let room = columns.room(rows, width);
        assert!(room.is_empty());
        // An allocator may give a little more.
        assert!((capacity..capacity + 64).contains(&room.capacity()));
        let other = left.iter().find(|capacity| **capacity != used);
        let spare: Vec<usize> = columns.spare.iter().map(Vec::capacity).collect();
        assert_eq!(spare.first(), other, "{left:?} {rows} {width}");
    }
    assert!(Columns::default().room(1, 1).capacity() >= 256);
}

/// Widths of blocks in multiples of 48 but for the last, an even number of them if there are so many.
#[test]
fn blocks_are_of_much_the_same_width() {
    for (new, widths) in [
        (1, &[1][..]),
        (48, &[48]),
        (96, &[48, 48]),
        (100, &[48, 52]),
        (144, &[48, 96]),
        (288, &[144, 144]),
        (289, &[48, 96, 96, 49]),
        (600, &[96, 96, 96, 96, 96, 120]),
    ] {
        let mut columns = Columns::default();
        columns.watch(&[], new);
        let found: Vec<usize> = columns.blocks.iter().map(|block| block.width).collect();
        assert_eq!(found.iter().sum::<usize>(), new);
        assert!(found.iter().all(|width| *width <= WIDTH), "{found:?}");
        assert_eq!(found, widths);
    }
}

/// `L F = B` gives the columns that B was made of; they are recognised when they are watched again, and both products
/// are those of the columns.
#[test]
fn columns_are_solved_for_and_kept() {
    let factor = factor();
    let mut columns = Columns { rows: ROWS_HERE, ..Columns::default() };
    let mut numbers: Vec<usize> = (0..350).collect();
    watch(&mut columns, &factor, &[], &numbers);
    check(&columns, &numbers, ROWS_HERE);
    check_products(&columns, &numbers);
    // Of the first block, some, in their order, and 200 more.
    let first = columns.blocks[0].width;
    let kept: Vec<usize> = (0..first).filter(|place| place % 3 != 1).collect();
    numbers = kept.iter().copied().chain(1000..1200).collect();
    watch(&mut columns, &factor, &kept, &numbers);
    check(&columns, &numbers, ROWS_HERE);
    check_products(&columns, &numbers);
    // All of them; then none.
    let kept: Vec<usize> = (0..columns.blocks[0].width).collect();
    numbers.truncate(kept.len());
    watch(&mut columns, &factor, &kept, &numbers);
    check(&columns, &numbers, ROWS_HERE);
    watch(&mut columns, &factor, &[], &[7]);
    check(&columns, &[7], ROWS_HERE);
    columns.forget(3);
    assert!(columns.rows == 3 && columns.locate(0).is_none());
}

/// Sums of products of integers are exact but for the rounding errors of the columns.
fn check_products(columns: &Columns, numbers: &[usize]) {
    let size = numbers.len();
    let mut gram = vec![1.0; size * size];
    columns.subtract_gram(0, &mut gram);
    let x: Vec<[f64; 2]> = (0..ROWS_HERE).map(|r| [(r % 5) as f64, 1.0]).collect();
    let mut reduced = vec![[2.0, 3.0]; size];
    columns.subtract_products(&x, &mut reduced);
    let column = |number: usize| (0..ROWS_HERE).map(move |row| solution(row, number));
    for (j, &other) in numbers.iter().enumerate() {
        for (i, &number) in numbers.iter().enumerate().skip(j) {
            let product: f64 = column(number).zip(column(other)).map(|(a, b)| a * b).sum();
            // 300 products up to 16 with relative errors of 10⁻¹⁵.
            assert!((gram[i + size * j] - (1.0 - product)).abs() < 1e-10);
        }
        for k in 0..2 {
            let product: f64 = column(other).zip(&x).map(|(a, x)| a * x[k]).sum();
            let expected = [2.0, 3.0][k] - product;
            assert!((reduced[j][k] - expected).abs() < 1e-10);
        }
    }
}

/// The rows of nodes that touch are their columns and their part of the factor of the Schur complement; the other
/// columns grow by theirs.
#[test]
fn nodes_that_touch_become_rows() {
    let mut factor = factor();
    let mut columns = Columns { rows: ROWS_HERE, ..Columns::default() };
    let numbers: Vec<usize> = (0..100).collect();
    watch(&mut columns, &factor, &[], &numbers);
    let mut schur = Schur::default();
    schur.resize(100).unwrap();
    schur.matrix_mut().copy_from(&nalgebra::DMatrix::from_fn(100, 100, dominant));
    // From both blocks, in no order.
    let positions = [70, 3, 99, 50];
    let touched = WindowFactor::of(schur, &positions).unwrap();
    let untouched: Vec<usize> = (0..100).filter(|p| !positions.contains(p)).collect();
    columns.commit(&mut factor, &touched, &untouched);
    assert_eq!((factor.rows(), columns.rows), (ROWS_HERE + 4, ROWS_HERE + 4));
    for (event, row) in factor.rows_mut(ROWS_HERE).enumerate() {
        for (c, value) in row[..ROWS_HERE].iter().enumerate() {
            assert!((value - solution(c, positions[event])).abs() < 1e-13);
        }
        for earlier in 0..=event {
            assert_eq!(row[ROWS_HERE + earlier], touched.factor(positions[event], earlier));
        }
    }
    check(&columns, &untouched, ROWS_HERE);
    let grown = |columns: &Columns, rows: usize| {
        for (place, &position) in untouched.iter().enumerate() {
            let (block, column) = columns.locate(place).unwrap();
            assert_eq!(block.values.len(), rows * block.width);
            for row in ROWS_HERE..rows {
                let found = block.values[row * block.width + column];
                assert_eq!(found, touched.factor(position, row - ROWS_HERE));
            }
        }
    };
    grown(&columns, ROWS_HERE + 4);
    columns.truncate(ROWS_HERE + 2);
    assert_eq!(columns.rows, ROWS_HERE + 2);
    grown(&columns, ROWS_HERE + 2);
}

/// Behind rows that leave, the remaining factor times the columns is what the whole factor made of them, without these
/// rows; and times the columns of the nodes that left it is their rows of the matrix.
#[test]
fn columns_follow_a_factor_that_loses_rows() {
    let whole = factor();
    let row = |r: usize| whole.row(r);
    let inner = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    // Both ends, a border of panels, one row alone, and so many that their columns fill a block and more.
    let many: Vec<usize> = (0..ROWS_HERE).filter(|row| row % 5 < 3).collect();
    for positions in [&[0, 17, 255, 256, ROWS_HERE - 1][..], &[100], &[ROWS_HERE - 1], &many, &[]] {
        let mut panels = whole.clone();
        let mut columns = Columns { rows: ROWS_HERE, ..Columns::default() };
        let numbers: Vec<usize> = (0..350).collect();
        watch(&mut columns, &panels, &[], &numbers);
        // Of all blocks.
        let kept: Vec<usize> = numbers.iter().copied().filter(|number| number % 3 != 1).collect();
        let leaving: Vec<Vec<f64>> = positions.iter().map(|&r| row(r).to_vec()).collect();
        let mut rotations = Vec::new();
        remove_and(&mut panels, positions, |column| rotations.push(column));
        columns.leave(&kept, positions, &leaving, &rotations);
        let rest: Vec<usize> = (0..ROWS_HERE).filter(|row| !positions.contains(row)).collect();
        assert_eq!((panels.rows(), columns.rows), (rest.len(), rest.len()));
        let right = |r: usize, place: usize| match kept.get(place) {
            Some(&number) => (0..=r).map(|c| entry(r, c) * solution(c, number)).sum(),
            None => inner(row(r), row(positions[place - kept.len()])),
        };
        let count = kept.len() + positions.len();
        let check = |columns: &Columns, places: &[usize]| {
            for (position, &place) in places.iter().enumerate() {
                let (block, column) = columns.locate(position).unwrap();
                let values: Vec<f64> =
                    block.values.iter().skip(column).step_by(block.width).copied().collect();
                assert_eq!(values.len(), rest.len());
                for (k, &r) in rest.iter().enumerate() {
                    let error = inner(panels.row(k), &values) - right(r, place);
                    // Rounding errors of some hundred numbers up to 20, rotated some hundred times.
                    assert!(error.abs() < 1e-12, "{positions:?}: {place} {r} {error:e}");
                }
            }
            assert!(columns.locate(places.len()).is_none());
        };
        check(&columns, &(0..count).collect::<Vec<_>>());
        // They are known again when some of them are watched.
        let again: Vec<usize> = (0..count).filter(|place| place % 4 != 2).collect();
        columns.watch(&again, 0);
        check(&columns, &again);
    }
}
