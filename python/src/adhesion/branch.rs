//! The states of branches.

use asperity::adhesion as engine;
use asperity::adhesion::AdhesiveEvent;
use numpy::{Element, PyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};

use crate::arrays::column;
use crate::errors::{Failure, Fallible};
use crate::history::{iterated, state_at};

/// States are pickled as a branch of one.
fn pickled<'py>(
    py: Python<'py>,
    branch: &engine::AdhesiveBranch,
    is_one: bool,
) -> Fallible<Bound<'py, PyTuple>> {
    let text = serde_json::to_vec(branch).map_err(|error| Failure::arguments(error.to_string()))?;
    let restore = py.import("asperity._asperity")?.getattr("_restore_branch")?;
    Ok((restore, (PyBytes::new(py, &text), is_one)).into_pyobject(py)?)
}

/// A state of a path with adhesion: the instant at which a node comes near, touches, parts or goes out of range, or one of
/// the ends of a jump.
#[pyclass(frozen, eq, module = "asperity")]
#[derive(Clone, PartialEq)]
pub(crate) struct AdhesiveState {
    pub(super) state: engine::AdhesiveState,
}

#[pymethods]
impl AdhesiveState {
    /// Number of states up to here, on all branches of the path.
    #[getter]
    fn step(&self) -> usize {
        self.state.step
    }

    /// ``"loading"`` or ``"unloading"``.
    #[getter]
    fn branch(&self) -> &'static str {
        self.state.direction.name()
    }

    /// What happens: ``"near"``, ``"pull"``, ``"touch"``, ``"part"``, ``"soften"``, ``"far"``, ``"jump_start"``, ``"jump_end"``, or
    /// nothing, at a ``"limit"``.
    #[getter]
    fn event(&self) -> &'static str {
        self.state.event.name()
    }

    /// Row of the node to which it happens; at a jump that of the node that was unstable.
    #[getter]
    fn row(&self) -> usize {
        self.state.node.1
    }

    /// Column of that node.
    #[getter]
    fn column(&self) -> usize {
        self.state.node.0
    }

    /// Load W [N], below 0 where the surfaces are pulled apart.
    #[getter]
    fn load(&self) -> f64 {
        self.state.contact.load
    }

    /// Load over nominal area [Pa].
    #[getter]
    fn mean_pressure(&self) -> f64 {
        self.state.contact.mean_pressure()
    }

    /// Approach [m] from where surfaces that do not pull would touch; of the mean planes on a periodic half-space.
    #[getter]
    fn approach(&self) -> f64 {
        self.state.contact.approach
    }

    /// Number of nodes whose gap is 0.
    #[getter]
    fn contact_nodes(&self) -> usize {
        self.state.contact.contact_nodes
    }

    /// Number of nodes that are pulled across a gap, on the slope of the law.
    #[getter]
    fn soft_nodes(&self) -> usize {
        self.state.soft_nodes
    }

    /// Number of nodes that are pulled across a gap with the greatest stress.
    #[getter]
    fn cohesive_nodes(&self) -> usize {
        self.state.cohesive_nodes
    }

    /// Area of cells whose gap is 0 [m²].
    #[getter]
    fn contact_area(&self) -> f64 {
        self.state.contact.contact_area
    }

    /// The same over nominal area.
    #[getter]
    fn area_fraction(&self) -> f64 {
        self.state.contact.contact_area_fraction
    }

    /// Mean gap [m].
    #[getter]
    fn mean_gap(&self) -> f64 {
        self.state.contact.mean_gap
    }

    /// Contact stiffness dW/d(approach) on the way of the branch [N/m], which may be negative; NaN on a periodic half-space.
    #[getter]
    fn contact_stiffness(&self) -> f64 {
        self.state.contact.contact_stiffness.unwrap_or(f64::NAN)
    }

    /// Interfacial stiffness -dW/d(mean gap) [N/m]; infinite in full contact.
    #[getter]
    fn interfacial_stiffness(&self) -> f64 {
        self.state.contact.interfacial_stiffness.unwrap_or(f64::NAN)
    }

    /// Elastic energy [J].
    #[getter]
    fn elastic_energy(&self) -> f64 {
        self.state.contact.energy
    }

    /// Energy of adhesion [J], 0 out of range and negative otherwise.
    #[getter]
    fn adhesive_energy(&self) -> f64 {
        self.state.adhesive_energy
    }

    /// Energy lost in all jumps so far [J].
    #[getter]
    fn dissipated(&self) -> f64 {
        self.state.dissipated
    }

    /// Work of the load so far [J]: the sum of the three energies.
    #[getter]
    fn work(&self) -> f64 {
        self.state.work
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyTuple>> {
        pickled(py, &std::iter::once(self.state).collect(), true)
    }

    fn __repr__(&self) -> String {
        let contact = &self.state.contact;
        format!(
            "<AdhesiveState {} ({}, {}): {} nodes in contact, load {:.6e} N, approach {:.6e} m>",
            self.state.step,
            self.branch(),
            self.event(),
            contact.contact_nodes,
            contact.load,
            contact.approach
        )
    }
}

/// The states of a branch of a path with adhesion, or of several that follow each other.
///
/// A sequence of `AdhesiveState`, whose names its columns have.
#[pyclass(frozen, eq, sequence, module = "asperity")]
#[derive(Clone, PartialEq)]
pub(crate) struct AdhesiveBranch {
    pub(super) branch: engine::AdhesiveBranch,
}

impl AdhesiveBranch {
    fn column<'py, T: Element>(
        &self,
        py: Python<'py>,
        get: impl Fn(&engine::AdhesiveState) -> T,
    ) -> Bound<'py, PyArray1<T>> {
        column(py, self.branch.states().iter().map(get).collect())
    }
}

/// The name of a column and what it holds.
type Column = (&'static str, fn(&engine::AdhesiveState) -> f64);

const COLUMNS: [Column; 11] = [
    ("approach", |s| s.contact.approach),
    ("load", |s| s.contact.load),
    ("contact_area", |s| s.contact.contact_area),
    ("area_fraction", |s| s.contact.contact_area_fraction),
    ("mean_gap", |s| s.contact.mean_gap),
    ("contact_stiffness", |s| s.contact.contact_stiffness.unwrap_or(f64::NAN)),
    ("interfacial_stiffness", |s| s.contact.interfacial_stiffness.unwrap_or(f64::NAN)),
    ("elastic_energy", |s| s.contact.energy),
    ("adhesive_energy", |s| s.adhesive_energy),
    ("dissipated", |s| s.dissipated),
    ("work", |s| s.work),
];

#[pymethods]
impl AdhesiveBranch {
    /// The greatest pull [N]: of unloading the force that pulls the surfaces apart, under a dead load too; of loading that
    /// with which they pull each other in. 0 where nothing pulls.
    #[getter]
    fn pull_off(&self) -> f64 {
        self.branch.pull_off()
    }

    /// Energy lost in jumps [J] from the first of these states to the last.
    #[getter]
    fn energy_lost(&self) -> f64 {
        self.branch.dissipated()
    }

    /// Number of jumps.
    #[getter]
    fn jumps(&self) -> usize {
        let states = self.branch.states().iter();
        states.filter(|state| state.event == AdhesiveEvent::JumpEnd).count()
    }

    /// Load [N] of each state.
    #[getter]
    fn load<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, |s| s.contact.load)
    }

    /// Approach [m] of each state.
    #[getter]
    fn approach<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, |s| s.contact.approach)
    }

    /// All columns.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     ``step``, ``branch``, ``event``, ``row``, ``column``, ``contact_nodes``, ``soft_nodes``, ``cohesive_nodes``, ``approach`` [m],
    ///     ``load`` [N], ``contact_area`` [m²], ``area_fraction``, ``mean_gap`` [m], ``contact_stiffness``, ``interfacial_stiffness``
    ///     [N/m], ``elastic_energy``, ``adhesive_energy``, ``dissipated`` and ``work`` [J].
    fn columns<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        let numpy = py.import("numpy")?;
        let states = self.branch.states();
        let words = |words: Vec<&'static str>| numpy.call_method1("array", (words, "U10"));
        columns.set_item("step", self.column(py, |s| s.step as i64))?;
        let branches = states.iter().map(|s| s.direction.name()).collect();
        columns.set_item("branch", words(branches)?)?;
        columns.set_item("event", words(states.iter().map(|s| s.event.name()).collect())?)?;
        columns.set_item("row", self.column(py, |s| s.node.1 as i64))?;
        columns.set_item("column", self.column(py, |s| s.node.0 as i64))?;
        let contact_nodes = self.column(py, |s| s.contact.contact_nodes as i64);
        columns.set_item("contact_nodes", contact_nodes)?;
        columns.set_item("soft_nodes", self.column(py, |s| s.soft_nodes as i64))?;
        columns.set_item("cohesive_nodes", self.column(py, |s| s.cohesive_nodes as i64))?;
        for (name, get) in COLUMNS {
            columns.set_item(name, self.column(py, get))?;
        }
        Ok(columns)
    }

    /// The load [N] at an approach [m], the first time that the branch is there.
    ///
    /// Parameters
    /// ----------
    /// approach : float
    ///
    /// Returns
    /// -------
    /// float or None
    ///     None for an approach that it never has.
    fn load_at(&self, approach: f64) -> Option<f64> {
        self.branch.load_at(approach)
    }

    /// The approach [m] at a load [N], the first time that the branch is there.
    ///
    /// Parameters
    /// ----------
    /// load : float
    ///
    /// Returns
    /// -------
    /// float or None
    ///     None for a load that it never has, or only within a jump.
    fn approach_at(&self, load: f64) -> Option<f64> {
        self.branch.approach_at(load)
    }

    fn __len__(&self) -> usize {
        self.branch.states().len()
    }

    fn __iter__<'py>(slf: &Bound<'py, Self>) -> Fallible<Bound<'py, PyAny>> {
        iterated(slf, slf.get().branch.states().len())
    }

    fn __getitem__(&self, index: &Bound<'_, PyAny>) -> PyResult<AdhesiveState> {
        Ok(AdhesiveState { state: *state_at(self.branch.states(), index)? })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyTuple>> {
        pickled(py, &self.branch, false)
    }

    fn __repr__(&self) -> String {
        format!(
            "<AdhesiveBranch: {} states; greatest pull {:.6e} N, {:.6e} J lost>",
            self.branch.states().len(),
            self.branch.pull_off(),
            self.branch.dissipated()
        )
    }
}

/// States from a pickle.
#[pyfunction]
fn _restore_branch<'py>(py: Python<'py>, data: &[u8], is_one: bool) -> Fallible<Bound<'py, PyAny>> {
    let branch: engine::AdhesiveBranch =
        serde_json::from_slice(data).map_err(|error| Failure::arguments(error.to_string()))?;
    if let ([state], true) = (branch.states(), is_one) {
        return Ok(AdhesiveState { state: *state }.into_pyobject(py)?.into_any());
    }
    Ok(AdhesiveBranch { branch }.into_pyobject(py)?.into_any())
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<AdhesiveState>()?;
    module.add_class::<AdhesiveBranch>()?;
    module.add_function(wrap_pyfunction!(_restore_branch, module)?)
}
