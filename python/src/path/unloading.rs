//! The way back from a state on which nodes have yielded.

use std::sync::Arc;

use asperity::loading::History as States;
use asperity::{LoadingSolver, LoadingState};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::{LoadingPath, Setting};
use crate::arrays::column;
use crate::choice::Repeats;
use crate::compute::detached;
use crate::errors::{Failure, Fallible};
use crate::history::History;
use crate::surface::Surface;

/// Elastic unloading from the last state of a path: made by `LoadingPath.unload`.
///
/// What yielded stays, so that the way back is that of the surface that is left. Columns go down from the last load of the
/// path, and count the approach from the first touch of the first surface.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct Unloading {
    loading: History,
    surface: Py<Surface>,
    touch: f64,
    last: LoadingState,
}

pub(super) fn unload(path: &Bound<'_, LoadingPath>) -> Fallible<Unloading> {
    let (py, this) = (path.py(), path.get());
    let (last, map, kernel, means) = {
        let mut inner = this.lock(py)?;
        let last = LoadingPath::state_or_last(&inner, None)?;
        let means = inner.means;
        let engine = inner.engine_mut();
        let map = detached(py, || engine.residual_surface_at(&last))??;
        (last, map, engine.problem().table().clone(), means)
    };
    if last.contact.plastic.is_none() {
        return Err(Failure::arguments(
            "unloading needs a path with a hardness: elastic contact goes back through the same states",
        ));
    }
    let load = last.contact.load;
    let touch = -map.max_height();
    let Setting { grid, boundary, .. } = this.setting;
    let states = if load > 0.0 {
        let solver = detached(py, || {
            means.give(LoadingSolver::builder(&map, &kernel)).max_load(load).build()
        })??;
        let inner = super::Inner::live(solver.into_path(), &[], means);
        let unloading = LoadingPath::new(inner, this.e_star);
        unloading.run(py, None, false)?;
        let states = unloading.history_now(py)?.history;
        Arc::new(States::clone(&states).up_to_load(load))
    } else {
        Arc::new(States::default())
    };
    let setting = Setting { grid, boundary, has_hardness: false };
    Ok(Unloading {
        loading: History { history: states, setting },
        surface: Py::new(py, Surface::new(grid, map.into_matrix())?)?,
        touch,
        last,
    })
}

impl Unloading {
    fn down<'py>(
        &self,
        py: Python<'py>,
        get: impl Fn(&LoadingState) -> f64,
    ) -> Bound<'py, PyArray1<f64>> {
        column(py, self.loading.states().iter().rev().map(get).collect())
    }
}

#[pymethods]
impl Unloading {
    /// The states on the way back, from the greatest load to the last touch.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     ``load`` [N], ``approach`` [m], ``mean_gap`` [m], ``contact_area`` [m²], ``area_fraction``,
    ///     ``contact_stiffness`` and ``interfacial_stiffness`` [N/m], ``energy`` [J].
    fn columns<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        columns.set_item("load", self.down(py, |s| s.contact.load))?;
        columns.set_item("approach", self.down(py, |s| s.contact.approach + self.touch))?;
        columns.set_item("mean_gap", self.down(py, |s| s.contact.mean_gap))?;
        columns.set_item("contact_area", self.down(py, |s| s.contact.contact_area))?;
        columns.set_item("area_fraction", self.down(py, |s| s.contact.contact_area_fraction))?;
        let stiffness = |s: &LoadingState| s.contact.contact_stiffness.unwrap_or(f64::NAN);
        columns.set_item("contact_stiffness", self.down(py, stiffness))?;
        let stiffness = |s: &LoadingState| s.contact.interfacial_stiffness.unwrap_or(f64::NAN);
        columns.set_item("interfacial_stiffness", self.down(py, stiffness))?;
        columns.set_item("energy", self.down(py, |s| s.contact.energy))?;
        Ok(columns)
    }

    /// The same states as a `History` of loading the surface that is left, up to the greatest load. Its approach counts from
    /// the first touch of that surface.
    #[getter]
    fn reloading(&self) -> History {
        History { history: Arc::clone(&self.loading.history), setting: self.loading.setting }
    }

    /// The surface that is left, with heights [m] from the highest node of the first one.
    #[getter]
    fn surface(&self, py: Python<'_>) -> Py<Surface> {
        self.surface.clone_ref(py)
    }

    /// Approach [m] at which the surfaces part, from the first touch of the first surface.
    #[getter]
    fn separation(&self) -> f64 {
        self.touch
    }

    /// Energy [J] that comes back.
    #[getter]
    fn energy_returned(&self) -> f64 {
        self.last.contact.energy
    }

    /// Energy [J] that is lost.
    #[getter]
    fn energy_lost(&self) -> f64 {
        self.last.contact.plastic.map_or(0.0, |plastic| plastic.work)
    }

    /// Volume [m³] that is lost.
    #[getter]
    fn plastic_volume(&self) -> f64 {
        self.last.contact.plastic.map_or(0.0, |plastic| plastic.volume)
    }

    /// Whether the half-space repeats with the sides of the surface, or ``"x"`` or ``"y"`` if it does along one.
    #[getter]
    fn periodic(&self) -> Repeats {
        Repeats::of(self.loading.setting.boundary)
    }

    fn __repr__(&self) -> String {
        format!(
            "<Unloading: {} states from {:.6e} N; {:.6e} J lost>",
            self.loading.states().len(),
            self.last.contact.load,
            self.energy_lost()
        )
    }
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Unloading>()
}
