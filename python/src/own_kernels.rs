//! Kernels that are functions of Python: each is asked once, for all that the engine will ask it.

use asperity::kernel::KernelTable;
use asperity::{Boundary, ContactGrowth, Error, Grid, MeanDisplacement};
use pyo3::prelude::*;

use crate::arrays::{Found, Kind, column};
use crate::compute::detached;
use crate::errors::Fallible;

/// The kernel of a symbol.
pub(crate) fn of_symbol(
    symbol: &Bound<'_, PyAny>,
    grid: Grid,
    mean: MeanDisplacement,
    growth: ContactGrowth,
) -> Fallible<KernelTable> {
    let py = symbol.py();
    // The waves that are asked for, in their order; it does not depend on the answers.
    let (mut qx, mut qy) = (Vec::new(), Vec::new());
    let asked = detached(py, || {
        KernelTable::from_symbol(grid, mean, growth, |x, y| {
            qx.push(x);
            qy.push(y);
            1.0
        })
        .map(drop)
    })?;
    // A single node of arbitrary mean: nothing is asked for.
    if qx.is_empty() {
        asked?;
    }
    let count = qx.len();
    let answer = symbol.call1((column(py, qx), column(py, qy)))?;
    let values = Found::of(&answer, "the answer of symbol", Kind::Real)?.list_of(count)?;
    Ok(detached(py, || {
        let mut values = values.into_iter();
        KernelTable::from_symbol(grid, mean, growth, |_, _| values.next().unwrap_or(f64::NAN))
    })??)
}

/// The kernel of influence coefficients.
pub(crate) fn of_coefficients(
    coefficients: &Bound<'_, PyAny>,
    grid: Grid,
    boundary: Boundary,
    growth: ContactGrowth,
) -> Fallible<KernelTable> {
    let py = coefficients.py();
    let (nx, ny) = (grid.nx() as i64, grid.ny() as i64);
    let offsets = (1 - ny..ny).flat_map(|dj| (1 - nx..nx).map(move |di| (di, dj)));
    let (di, dj): (Vec<i64>, Vec<i64>) = offsets.unzip();
    let count = di.len();
    let answer = coefficients.call1((column(py, di), column(py, dj)))?;
    let values = Found::of(&answer, "the answer of coefficients", Kind::Real)?.list_of(count)?;
    let place = move |di: isize, dj: isize| {
        let (di, dj) = (di as i64 + nx - 1, dj as i64 + ny - 1);
        (di + (2 * nx - 1) * dj) as usize
    };
    let table = detached(py, || {
        KernelTable::from_fn(grid, boundary, growth, |di, dj| {
            values.get(place(di, dj)).copied().unwrap_or(f64::NAN)
        })
    })?;
    table.map_err(|error: Error| error.into())
}
