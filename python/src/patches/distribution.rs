//! How pressures and gaps are distributed over the nodes.

use asperity::nalgebra::DMatrix;
use asperity::patches::{Bins, FieldDistribution, gap_distribution, pressure_distribution};
use asperity::{Error, Grid};
use pyo3::prelude::*;

use crate::argument::whole;
use crate::arrays::{Found, Kind, column};
use crate::compute::detached;
use crate::errors::{Failure, Fallible};
use crate::results::result;

/// Over what a distribution is.
type Of = fn(&DMatrix<f64>, &DMatrix<bool>, Bins) -> Result<FieldDistribution, Error>;

fn distribution<'py>(
    py: Python<'py>,
    (field, name): (&Bound<'py, PyAny>, &'static str),
    contact_map: &Bound<'py, PyAny>,
    bins: (Option<usize>, Option<usize>),
    of: Of,
) -> Fallible<Bound<'py, PyAny>> {
    let bins = match bins {
        (None, Some(per_decade)) => Bins::PerDecade(per_decade),
        (bins, None) => Bins::Linear(bins.unwrap_or(50)),
        _ => return Err(Failure::arguments("give bins or per_decade, and not both")),
    };
    let field = Found::of(field, name, Kind::Real)?;
    let (rows, columns) = field.rows_and_columns()?;
    let grid = Grid::new(columns, rows, 1.0, 1.0)?;
    let (field, map) =
        (field.on(&grid)?, Found::of(contact_map, "contact_map", Kind::Truth)?.map_on(&grid)?);
    let found = detached(py, || of(&field, &map, bins))??;
    let histogram = &found.histogram;
    result!(py, "Distribution", {
        edges: column(py, histogram.edges().to_vec()),
        counts: column(py, histogram.counts().iter().map(|count| *count as i64).collect()),
        density: column(py, histogram.density()),
        outside: histogram.outside(),
        area_fraction: found.contact_area_fraction,
    })
}

/// The distribution of the pressure over the nodes in contact.
///
/// Parameters
/// ----------
/// pressure : array_like of float
///     [Pa], ``[row, column]``.
/// contact_map : array_like of bool
/// bins : int, optional
///     Number of bins of one width, 50 unless it is given.
/// per_decade : int, optional
///     Bins of one ratio instead, so many for each factor of ten.
///
/// Returns
/// -------
/// results.Distribution
///     Its density has the integral 1; times ``area_fraction`` it is that over the nominal area.
#[pyfunction(name = "pressure_distribution")]
#[pyo3(signature = (pressure, contact_map, *, bins=None, per_decade=None))]
fn of_pressure<'py>(
    py: Python<'py>,
    pressure: &Bound<'py, PyAny>,
    contact_map: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = whole)] bins: Option<usize>,
    #[pyo3(from_py_with = whole)] per_decade: Option<usize>,
) -> Fallible<Bound<'py, PyAny>> {
    distribution(py, (pressure, "pressure"), contact_map, (bins, per_decade), pressure_distribution)
}

/// The distribution of the gap over the nodes out of contact.
///
/// Parameters
/// ----------
/// gap : array_like of float
///     [m], ``[row, column]``.
/// contact_map : array_like of bool
/// bins, per_decade : int, optional
///     As of `pressure_distribution`.
///
/// Returns
/// -------
/// results.Distribution
#[pyfunction(name = "gap_distribution")]
#[pyo3(signature = (gap, contact_map, *, bins=None, per_decade=None))]
fn of_gap<'py>(
    py: Python<'py>,
    gap: &Bound<'py, PyAny>,
    contact_map: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = whole)] bins: Option<usize>,
    #[pyo3(from_py_with = whole)] per_decade: Option<usize>,
) -> Fallible<Bound<'py, PyAny>> {
    distribution(py, (gap, "gap"), contact_map, (bins, per_decade), gap_distribution)
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(of_pressure, module)?)?;
    module.add_function(wrap_pyfunction!(of_gap, module)?)
}
