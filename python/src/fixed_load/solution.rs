//! The contact under one load.

use asperity::contact::ContactState;
use asperity::contact::PlasticState;
use asperity::fixed_load::FixedLoadSolution;
use asperity::nalgebra::{DMatrix, Scalar};
use asperity::patches::{ContactEdge, constriction};
use asperity::surface::HeightMap;
use numpy::{Element, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::argument::whole;
use crate::arrays::{rows, shape};
use crate::choice;
use crate::compute::detached;
use crate::errors::Fallible;
use crate::history::Setting;
use crate::patches::{PatchMap, label};
use crate::path::of_certificate;
use crate::results::result;
use crate::surface::Surface;

/// The contact at one load: numbers and fields.
///
/// Each field is a new array ``[row, column]``. Numbers that do not exist are NaN.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct Solution {
    solution: FixedLoadSolution,
    setting: Setting,
}

impl Solution {
    pub(super) fn new(solution: FixedLoadSolution, setting: Setting) -> Self {
        Self { solution, setting }
    }

    fn state(&self) -> &ContactState {
        &self.solution.contact
    }

    fn plastic(&self, get: impl Fn(&PlasticState) -> f64) -> f64 {
        self.solution.contact.plastic.as_ref().map_or(0.0, get)
    }
}

/// A copy of a field.
fn copy<'py, T: Element + Scalar>(
    py: Python<'py>,
    field: &DMatrix<T>,
) -> Fallible<Bound<'py, PyArray2<T>>> {
    rows(py, field.clone())
}

#[pymethods]
impl Solution {
    /// Load W [N].
    #[getter]
    fn load(&self) -> f64 {
        self.state().load
    }

    /// Load over nominal area [Pa].
    #[getter]
    fn mean_pressure(&self) -> f64 {
        self.state().load / self.setting.grid.nominal_area()
    }

    /// Greatest pressure [Pa].
    #[getter]
    fn max_pressure(&self) -> f64 {
        self.solution.fields.max_pressure()
    }

    /// Approach [m] from first touch; of the mean planes on a periodic half-space.
    #[getter]
    fn approach(&self) -> f64 {
        self.state().approach
    }

    /// Mean gap [m].
    #[getter]
    fn mean_gap(&self) -> f64 {
        self.state().mean_gap
    }

    /// Number of nodes in contact.
    #[getter]
    fn contact_nodes(&self) -> usize {
        self.state().contact_nodes
    }

    /// Contact area [m²], counted in cells.
    #[getter]
    fn contact_area(&self) -> f64 {
        self.state().contact_area
    }

    /// Contact area over nominal area.
    #[getter]
    fn area_fraction(&self) -> f64 {
        self.state().contact_area_fraction
    }

    /// Contact area [m²] without what whole cells count too much along the edges of patches.
    #[getter]
    fn corrected_area(&self) -> Fallible<f64> {
        let Setting { grid, boundary, .. } = self.setting;
        Ok(ContactEdge::of(&self.solution.fields.contact_map, grid, boundary)?.corrected_area())
    }

    /// Contact stiffness dW/d(approach) [N/m]; NaN on a periodic half-space, and if it was not asked for.
    #[getter]
    fn contact_stiffness(&self) -> f64 {
        self.state().contact_stiffness.unwrap_or(f64::NAN)
    }

    /// Interfacial stiffness -dW/d(mean gap) [N/m]; infinite in full contact, NaN if it was not asked for.
    #[getter]
    fn interfacial_stiffness(&self) -> f64 {
        self.state().interfacial_stiffness.unwrap_or(f64::NAN)
    }

    /// Elastic energy [J].
    #[getter]
    fn energy(&self) -> f64 {
        self.state().energy
    }

    /// Pressure [Pa], zero out of contact.
    #[getter]
    fn pressure<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyArray2<f64>>> {
        copy(py, &self.solution.fields.pressure)
    }

    /// Gap [m]: zero in contact, to within the tolerance.
    #[getter]
    fn gap<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyArray2<f64>>> {
        copy(py, &self.solution.fields.gap)
    }

    /// Displacement of the half-space [m], positive into it; about its mean on a periodic half-space.
    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyArray2<f64>>> {
        copy(py, &self.solution.fields.displacement)
    }

    /// Which nodes are in contact.
    #[getter]
    fn contact_map<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyArray2<bool>>> {
        copy(py, &self.solution.fields.contact_map)
    }

    /// Pressure per unit of load [1/m²], on further loading; None if stiffnesses were not asked for.
    #[getter]
    fn pressure_rate<'py>(&self, py: Python<'py>) -> Fallible<Option<Bound<'py, PyArray2<f64>>>> {
        let rate = &self.solution.pressure_rate;
        (!rate.is_empty()).then(|| copy(py, rate)).transpose()
    }

    /// Which nodes have yielded; None without a hardness.
    #[getter]
    fn yielded_map<'py>(&self, py: Python<'py>) -> Fallible<Option<Bound<'py, PyArray2<bool>>>> {
        let FixedLoadSolution { contact, fields, .. } = &self.solution;
        contact.plastic.map(|_| copy(py, &fields.yielded_map)).transpose()
    }

    /// Plastic depth [m]: by how much yielded nodes would overlap; None without a hardness.
    #[getter]
    fn plastic_depth<'py>(&self, py: Python<'py>) -> Fallible<Option<Bound<'py, PyArray2<f64>>>> {
        let FixedLoadSolution { contact, fields, .. } = &self.solution;
        contact.plastic.map(|_| copy(py, &fields.plastic_depth)).transpose()
    }

    /// Number of nodes that have yielded.
    #[getter]
    fn yielded_nodes(&self) -> usize {
        self.solution.contact.plastic.map_or(0, |plastic| plastic.yielded_nodes)
    }

    /// Their area over the nominal area.
    #[getter]
    fn yielded_area_fraction(&self) -> f64 {
        self.plastic(|plastic| plastic.yielded_area_fraction)
    }

    /// Volume of the plastic depth [m³].
    #[getter]
    fn plastic_volume(&self) -> f64 {
        self.plastic(|plastic| plastic.volume)
    }

    /// Energy that is lost [J].
    #[getter]
    fn plastic_work(&self) -> f64 {
        self.plastic(|plastic| plastic.work)
    }

    /// The surface with the plastic depth taken off: that of elastic unloading from here.
    ///
    /// Parameters
    /// ----------
    /// surface : Surface
    ///     The one that was pressed.
    ///
    /// Returns
    /// -------
    /// Surface
    fn residual_surface(&self, surface: PyRef<'_, Surface>) -> Fallible<Surface> {
        let pressed = asperity::Surface::heights(&surface.topography()?, &self.setting.grid)?;
        let left = self.solution.residual_surface(&HeightMap::new(pressed)?)?;
        Ok(Surface::new(*surface.grid(), left.into_matrix())?)
    }

    /// How well the conditions of contact are met, computed afresh: a `results.Certificate`.
    #[getter]
    fn certificate<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyAny>> {
        of_certificate(py, &self.solution.certificate)
    }

    /// What the solution took: a `results.Effort`.
    #[getter]
    fn effort<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyAny>> {
        let effort = &self.solution.effort;
        result!(py, "Effort", {
            iterations: effort.iterations,
            stiffness_iterations: effort.stiffness_iterations,
            convolutions: effort.convolutions,
            coarse_convolutions: effort.coarse_convolutions,
        })
    }

    /// The patches of contact: where each is, how large, and what it carries.
    ///
    /// Parameters
    /// ----------
    /// connectivity : {8, 4}
    ///     Whether cells with a corner in common belong together.
    ///
    /// Returns
    /// -------
    /// PatchMap
    #[pyo3(signature = (*, connectivity=8))]
    fn patches(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = whole)] connectivity: usize,
    ) -> Fallible<PatchMap> {
        let (contact, pressure) =
            (&self.solution.fields.contact_map, &self.solution.fields.pressure);
        label(py, contact, Some(pressure), &self.setting, choice::connectivity(connectivity)?)
    }

    /// The narrowest place of the widest channel that leads along an axis through the nodes out of contact.
    ///
    /// Parameters
    /// ----------
    /// axis : {"x", "y"}
    ///
    /// Returns
    /// -------
    /// results.Constriction or None
    ///     None if no channel leads all the way.
    fn constriction<'py>(
        &self,
        py: Python<'py>,
        axis: &str,
    ) -> Fallible<Option<Bound<'py, PyAny>>> {
        let axis = choice::axis(axis)?;
        let Setting { grid, boundary, .. } = self.setting;
        let (gap, contact) = (&self.solution.fields.gap, &self.solution.fields.contact_map);
        let found = detached(py, || constriction(gap, contact, (&grid, boundary), axis))??;
        found
            .map(|found| {
                result!(py, "Constriction", {
                    row: found.node.1,
                    column: found.node.0,
                    gap: found.gap,
                })
            })
            .transpose()
    }

    /// Rows and columns.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        shape(&self.setting.grid)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyTuple>> {
        pickle::reduce(py, &self.solution, &self.setting)
    }

    fn __repr__(&self) -> String {
        let state = self.state();
        format!(
            "<Solution: load {:.6e} N, {} nodes in contact, approach {:.6e} m, mean gap {:.6e} m>",
            state.load, state.contact_nodes, state.approach, state.mean_gap
        )
    }
}

/// Solutions as bytes: the data of serde, in a format that keeps every bit of a number.
mod pickle {
    use super::*;
    use crate::errors::Failure;
    use crate::history::PickledSetting;
    use pyo3::types::PyBytes;

    pub(super) fn reduce<'py>(
        py: Python<'py>,
        solution: &FixedLoadSolution,
        setting: &Setting,
    ) -> Fallible<Bound<'py, PyTuple>> {
        let restore = py.import("asperity._asperity")?.getattr("_restore_solution")?;
        let text = serde_json::to_vec(solution);
        let text = text.map_err(|error| Failure::arguments(error.to_string()))?;
        Ok((restore, (PyBytes::new(py, &text), setting.pickled())).into_pyobject(py)?)
    }

    /// A solution that was pickled.
    #[pyfunction]
    fn _restore_solution(data: &[u8], setting: PickledSetting) -> Fallible<Solution> {
        let solution = serde_json::from_slice(data);
        let solution = solution.map_err(|error| Failure::arguments(error.to_string()))?;
        Ok(Solution { solution, setting: Setting::restored(setting)? })
    }

    pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add_function(wrap_pyfunction!(_restore_solution, module)?)
    }
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Solution>()?;
    pickle::register(module)
}
