//! The patches along a path.

use std::sync::Arc;

use asperity::contact::ContactSequence;
use asperity::loading;
use asperity::patches::{
    Connectivity, MergeTree, PatchHistory, PatchState, Percolation, activation_map,
};
use asperity::{ContactEvent, LoadingState};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::at::{PatchMap, label};
use crate::argument::whole;
use crate::arrays::{column, rows};
use crate::choice::{choose, connectivity};
use crate::compute::detached;
use crate::errors::{Failure, Fallible};
use crate::history::{History, Setting, check_on_path};
use crate::path::LoadingPath;
use crate::results::result;
use crate::state::State;

/// The patches of contact along a path: made by `patches`.
///
/// Arrays have one value for each state of the history. At a limit, and where a node yields, it is that of the last touch.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct PatchAnalysis {
    history: Arc<loading::History>,
    setting: Setting,
    contact: ContactSequence,
    connectivity: Connectivity,
    states: Vec<PatchState>,
}

/// The contact patches along a path: numbers, percolation, the tree of mergers, and the map of activation.
///
/// Parameters
/// ----------
/// path : LoadingPath or History
///     With the states so far.
/// connectivity : {8, 4}
///     Whether cells with a corner in common belong to one patch.
///
/// Returns
/// -------
/// PatchAnalysis
///
/// Raises
/// ------
/// AsperityError
///     Of the kind ``"NodeLeaves"`` for a path on which a node leaves the contact: there is no order of contact then.
#[pyfunction]
#[pyo3(signature = (path, *, connectivity=8))]
fn patches(
    py: Python<'_>,
    path: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = whole)] connectivity: usize,
) -> Fallible<PatchAnalysis> {
    let connectivity = self::connectivity(connectivity)?;
    let (history, setting) = if let Ok(path) = path.cast::<LoadingPath>() {
        let history = path.get().history_now(py)?;
        (history.history, history.setting)
    } else if let Ok(history) = path.cast::<History>() {
        if !history.get().is_whole() {
            return Err(Failure::arguments(
                "patches are followed from node to node, and states of this history are left out",
            ));
        }
        (Arc::clone(&history.get().history), history.get().setting)
    } else {
        return Err(Failure::arguments("patches needs a LoadingPath or a History"));
    };
    let (contact, states) = detached(py, || {
        let contact = history.contact_sequence(setting.grid)?;
        let mut touched = PatchHistory::new(&contact, setting.boundary, connectivity);
        let mut present = None;
        let states = history.states().iter().filter_map(|state| {
            if state.event == ContactEvent::Touch {
                present = touched.next();
            }
            present
        });
        let states: Vec<PatchState> = states.collect();
        Ok::<_, asperity::Error>((contact, states))
    })??;
    Ok(PatchAnalysis { history, setting, contact, connectivity, states })
}

impl PatchAnalysis {
    fn wholes<'py>(
        &self,
        py: Python<'py>,
        get: impl Fn(&PatchState) -> usize,
    ) -> Bound<'py, PyArray1<i64>> {
        column(py, self.states.iter().map(|state| get(state) as i64).collect())
    }

    fn reals<'py>(
        &self,
        py: Python<'py>,
        get: impl Fn(&PatchState) -> f64,
    ) -> Bound<'py, PyArray1<f64>> {
        column(py, self.states.iter().map(get).collect())
    }

    /// The state at which so many nodes touched.
    fn touched(&self, nodes: usize) -> Option<LoadingState> {
        let touches = self.history.states().iter().filter(|s| s.event == ContactEvent::Touch);
        touches.copied().nth(nodes.checked_sub(1)?)
    }

    fn percolation_of<'py>(
        &self,
        py: Python<'py>,
        found: &Percolation,
    ) -> Fallible<Bound<'py, PyAny>> {
        let state =
            |nodes: Option<usize>| nodes.and_then(|nodes| self.touched(nodes)).map(State::new);
        result!(py, "Percolation", {
            contact_x: state(found.contact_x),
            contact_y: state(found.contact_y),
            seal_x: state(found.seal_x),
            seal_y: state(found.seal_y),
        })
    }
}

/// Quantities of a map of activation.
type Quantity = fn(&LoadingState) -> f64;
const QUANTITIES: [(&str, Quantity); 5] = [
    ("load", |state| state.contact.load),
    ("mean_pressure", |state| state.contact.mean_pressure()),
    ("approach", |state| state.contact.approach),
    ("area_fraction", |state| state.contact.contact_area_fraction),
    ("mean_gap", |state| state.contact.mean_gap),
];

#[pymethods]
impl PatchAnalysis {
    /// Number of patches at each state.
    #[getter]
    fn number<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.wholes(py, |state| state.patches)
    }

    /// Nodes of the largest patch at each state.
    #[getter]
    fn largest<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.wholes(py, |state| state.largest)
    }

    /// Length of all edges [m] at each state, along the sides of cells.
    #[getter]
    fn perimeter<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |state| state.perimeter.length(&self.setting.grid))
    }

    /// Contact area [m²] at each state without what whole cells count too much along the edges.
    #[getter]
    fn corrected_area<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |state| state.corrected_area(&self.setting.grid))
    }

    /// When contact percolates, and when the gap seals: from one end of the surface to the other, whatever the boundary.
    ///
    /// Where a periodic boundary is open across, patches and channels pass it. Channels pass through sides of cells, whatever the connectivity of
    /// patches: from ``seal_x`` on `Seal` finds no leak along x.
    ///
    /// Returns
    /// -------
    /// results.Percolation
    ///     The first `State` of each, None for what had not happened at the last state.
    fn percolation<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyAny>> {
        let found = detached(py, || {
            Percolation::of(&self.contact, self.setting.boundary, self.connectivity)
        })?;
        self.percolation_of(py, &found)
    }

    /// When a patch winds around a periodic grid, and so goes on without end, and when the last channel that does is closed.
    ///
    /// Along a direction in which the boundary does not repeat it is `percolation`. A patch winds no sooner than it leads from end to
    /// end, and the last channel that winds closes no later than the last one from end to end.
    ///
    /// Returns
    /// -------
    /// results.Percolation
    fn winding<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyAny>> {
        let found = detached(py, || {
            Percolation::winding(&self.contact, self.setting.boundary, self.connectivity)
        })?;
        self.percolation_of(py, &found)
    }

    /// All patches in the order of their births, with what each merged into: the data of a dendrogram.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     ``birth`` (number of nodes in contact when its first node touched), ``row`` and ``column`` of that node,
    ///     ``merged`` (the same of its end, -1 if it lasts), ``into`` (number of the patch that goes on, -1), ``nodes``.
    fn merge_tree<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyDict>> {
        let tree = detached(py, || {
            MergeTree::new(&self.contact, self.setting.boundary, self.connectivity)
        })?;
        let wholes = |get: &dyn Fn(&asperity::patches::Branch) -> i64| {
            column(py, tree.branches().iter().map(get).collect())
        };
        let columns = PyDict::new(py);
        columns.set_item("birth", wholes(&|branch| branch.birth as i64))?;
        columns.set_item("row", wholes(&|branch| branch.node.1 as i64))?;
        columns.set_item("column", wholes(&|branch| branch.node.0 as i64))?;
        let merged = |b: &asperity::patches::Branch| b.merger.map_or(-1, |m| m.step as i64);
        columns.set_item("merged", wholes(&merged))?;
        let into = |b: &asperity::patches::Branch| b.merger.map_or(-1, |m| m.into as i64);
        columns.set_item("into", wholes(&into))?;
        columns.set_item("nodes", wholes(&|branch| branch.nodes as i64))?;
        Ok(columns)
    }

    /// A quantity of the state at which each node touched, NaN where none did: one map that holds every contact map.
    ///
    /// Parameters
    /// ----------
    /// quantity : {"load", "mean_pressure", "approach", "area_fraction", "mean_gap"}
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    #[pyo3(signature = (quantity="load"))]
    fn activation<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        let quantity = choose("quantity", quantity, &QUANTITIES)?;
        rows(py, activation_map(&self.setting.grid, self.history.states(), quantity)?)
    }

    /// The patches of one state.
    ///
    /// Parameters
    /// ----------
    /// state : State
    ///     One of the path.
    ///
    /// Returns
    /// -------
    /// PatchMap
    ///     Without loads: ``label_patches(path.contact_map(state), ..., pressure=path.pressure(state))`` has them.
    fn at(&self, py: Python<'_>, state: PyRef<'_, State>) -> Fallible<PatchMap> {
        check_on_path(&self.history, &state.state)?;
        let contact = self.contact.map_at(state.state.contact.contact_nodes);
        label(py, &contact, None, &self.setting, self.connectivity)
    }

    fn __len__(&self) -> usize {
        self.states.len()
    }

    fn __repr__(&self) -> String {
        let connectivity = if self.connectivity == Connectivity::Four { 4 } else { 8 };
        format!("<PatchAnalysis: {} states, {connectivity}-connected>", self.states.len())
    }
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PatchAnalysis>()?;
    module.add_function(wrap_pyfunction!(patches, module)?)
}
