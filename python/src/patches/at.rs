//! The patches of one contact.

use asperity::Grid;
use asperity::nalgebra::DMatrix;
use asperity::patches::{Connectivity, Patch, PatchLoad, Patches};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::argument::whole;
use crate::arrays::{Found, Kind, Lengths, column, rows};
use crate::choice::{self, Repeats};
use crate::compute::detached;
use crate::errors::Fallible;
use crate::history::Setting;

/// The patches of a contact: one value for each patch in every array, in the order of their labels.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct PatchMap {
    patches: Patches,
    loads: Option<Vec<PatchLoad>>,
    grid: Grid,
}

/// The patches of a contact map, and what they carry.
pub(crate) fn label(
    py: Python<'_>,
    contact: &DMatrix<bool>,
    pressure: Option<&DMatrix<f64>>,
    setting: &Setting,
    connectivity: Connectivity,
) -> Fallible<PatchMap> {
    let Setting { grid, boundary, .. } = *setting;
    let (patches, loads) = detached(py, || {
        let patches = Patches::new(contact, &grid, boundary, connectivity)?;
        let loads = pressure.map(|pressure| patches.loads(pressure)).transpose()?;
        Ok::<_, asperity::Error>((patches, loads))
    })??;
    Ok(PatchMap { patches, loads, grid })
}

impl PatchMap {
    fn reals<'py>(
        &self,
        py: Python<'py>,
        get: impl Fn(&Patch) -> f64,
    ) -> Bound<'py, PyArray1<f64>> {
        column(py, self.patches.patches().iter().map(get).collect())
    }

    /// NaN without a pressure.
    fn carried<'py>(
        &self,
        py: Python<'py>,
        get: impl Fn(&PatchLoad) -> f64,
    ) -> Bound<'py, PyArray1<f64>> {
        let values = match &self.loads {
            Some(loads) => loads.iter().map(get).collect(),
            None => vec![f64::NAN; self.patches.patches().len()],
        };
        column(py, values)
    }
}

#[pymethods]
impl PatchMap {
    /// For every node the number of its patch, from 1 on, or 0 out of contact: int64, ``[row, column]``.
    #[getter]
    fn labels<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyArray2<i64>>> {
        rows(py, self.patches.labels().map(|label| label as i64))
    }

    /// Number of nodes of each patch.
    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        column(py, self.patches.patches().iter().map(|patch| patch.nodes as i64).collect())
    }

    /// Area [m²], counted in cells.
    #[getter]
    fn area<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |patch| patch.area)
    }

    /// Area [m²] without what whole cells count too much along its edge.
    #[getter]
    fn corrected_area<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |patch| patch.perimeter.corrected_area(patch.nodes, &self.grid))
    }

    /// Length of its edge [m], along the sides of cells.
    #[getter]
    fn perimeter<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |patch| patch.perimeter.length(&self.grid))
    }

    /// x of its centre [m], NaN for one that goes on without end along x.
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |patch| patch.centroid.0)
    }

    /// y of its centre [m], NaN for one that goes on without end along y.
    #[getter]
    fn y<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |patch| patch.centroid.1)
    }

    /// Whether it goes on without end along x, around a periodic boundary.
    #[getter]
    fn wraps_x<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        column(py, self.patches.patches().iter().map(|patch| patch.wraps.0).collect())
    }

    /// The same along y.
    #[getter]
    fn wraps_y<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        column(py, self.patches.patches().iter().map(|patch| patch.wraps.1).collect())
    }

    /// Load on each patch [N]; NaN without a pressure.
    #[getter]
    fn load<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.carried(py, |load| load.load)
    }

    /// Load over area [Pa].
    #[getter]
    fn mean_pressure<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.carried(py, |load| load.mean_pressure)
    }

    /// Greatest pressure [Pa].
    #[getter]
    fn max_pressure<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.carried(py, |load| load.max_pressure)
    }

    /// All columns by name, for ``pandas.DataFrame``.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    fn columns<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        columns.set_item("nodes", self.nodes(py))?;
        columns.set_item("area", self.area(py))?;
        columns.set_item("corrected_area", self.corrected_area(py))?;
        columns.set_item("perimeter", self.perimeter(py))?;
        columns.set_item("x", self.x(py))?;
        columns.set_item("y", self.y(py))?;
        columns.set_item("wraps_x", self.wraps_x(py))?;
        columns.set_item("wraps_y", self.wraps_y(py))?;
        columns.set_item("load", self.load(py))?;
        columns.set_item("mean_pressure", self.mean_pressure(py))?;
        columns.set_item("max_pressure", self.max_pressure(py))?;
        Ok(columns)
    }

    fn __len__(&self) -> usize {
        self.patches.patches().len()
    }

    fn __repr__(&self) -> String {
        format!("<PatchMap: {} patches>", self.patches.patches().len())
    }
}

/// The patches of any contact map.
///
/// Parameters
/// ----------
/// contact_map : array_like of bool
///     ``[row, column]``.
/// size : (float, float) or float
///     Sides ``(x, y)`` [m]; one number is the side along x, with square cells.
/// periodic : bool or {"x", "y"}
///     Whether the map repeats with its sides, or the side along which it does.
/// connectivity : {8, 4}
///     Whether cells with a corner in common belong together.
/// pressure : array_like of float, optional
///     Pressure [Pa], for the loads on the patches.
///
/// Returns
/// -------
/// PatchMap
#[pyfunction]
#[pyo3(signature = (contact_map, size, *, periodic, connectivity=8, pressure=None))]
fn label_patches(
    py: Python<'_>,
    contact_map: &Bound<'_, PyAny>,
    size: Lengths,
    periodic: Repeats,
    #[pyo3(from_py_with = whole)] connectivity: usize,
    pressure: Option<&Bound<'_, PyAny>>,
) -> Fallible<PatchMap> {
    let found = Found::of(contact_map, "contact_map", Kind::Truth)?;
    let grid = size.grid(found.rows_and_columns()?)?;
    let contact = found.map_on(&grid)?;
    let pressure = match pressure {
        Some(pressure) => Some(Found::of(pressure, "pressure", Kind::Real)?.on(&grid)?),
        None => None,
    };
    let boundary = periodic.boundary()?;
    let setting = Setting { grid, boundary, has_hardness: false };
    label(py, &contact, pressure.as_ref(), &setting, choice::connectivity(connectivity)?)
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PatchMap>()?;
    module.add_function(wrap_pyfunction!(label_patches, module)?)
}
