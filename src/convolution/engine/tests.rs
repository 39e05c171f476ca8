use super::*;
use crate::kernel::{Boussinesq, PeriodicBoussinesq};

fn held<T: Real>(engine: &Engine<T>) -> usize {
    let Spectra { rows, columns, scratch } = &engine.spectra;
    let of_part = |part: &Scratch<T>| size_of_val(&part.lines[..]) + part.work.bytes();
    size_of_val(&engine.filter.symbol[..])
        + size_of_val(&rows[..])
        + size_of_val(&columns[..])
        + scratch.iter().map(of_part).sum::<usize>()
}

/// What was allocated, for grids of one part and of several.
#[test]
fn bytes_are_those_held() -> Result<(), Error> {
    for grid in [Grid::new(13, 7, 1.0, 1.0)?, Grid::new(100, 97, 1.0, 1.0)?] {
        let free = KernelTable::new(&Boussinesq::new(grid, 1.0)?)?;
        let periodic = KernelTable::new(&PeriodicBoussinesq::new(grid, 1.0)?)?;
        for table in [free, periodic] {
            let double = Engine::from_table(&table)?;
            let single = double.to_single(1.0);
            assert_eq!(double.bytes(), held(&double));
            assert_eq!(single.bytes(), held(&single));
        }
    }
    Ok(())
}

/// By Parseval's theorem: the sum of squares of the coefficients over the number of waves, whatever the parity of
/// lengths.
#[test]
fn the_norm_of_the_symbol_is_that_of_the_coefficients() -> Result<(), Error> {
    for (nx, ny) in [(13, 7), (6, 4), (1, 5), (5, 1), (2, 2), (1, 1)] {
        let grid = Grid::new(nx, ny, 1.0, 0.5)?;
        let free = KernelTable::new(&Boussinesq::new(grid, 1.0)?)?;
        let periodic = KernelTable::new(&PeriodicBoussinesq::new(grid, 1.0)?)?;
        let (nx, ny) = (nx as isize, ny as isize);
        for (table, i, j) in [(free, 1 - nx, 1 - ny), (periodic, 0, 0)] {
            let offsets = (i..nx).flat_map(|di| (j..ny).map(move |dj| (di, dj)));
            let squares = offsets.filter_map(|(di, dj)| table.coefficient(di, dj));
            let squares = squares.map(|coefficient| coefficient.powi(2));
            let engine = Engine::<f64>::from_table(&table)?;
            let (px, py) = engine.padded();
            let expected = (squares.sum::<f64>() / (px * py) as f64).sqrt();
            let found = engine.norm_of_symbol();
            assert!((found / expected - 1.0).abs() < 1e-13, "{found} {expected}");
        }
    }
    Ok(())
}
