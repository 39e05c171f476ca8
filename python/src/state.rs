//! A state of contact.

use asperity::{ContactEvent, ContactState, LoadingState};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::errors::{Failure, Fallible};

/// The event of a number.
pub(crate) fn event(code: i8) -> Fallible<ContactEvent> {
    let all = ContactEvent::ALL.get(usize::from(code.cast_unsigned()));
    all.copied().ok_or_else(|| Failure::arguments(format!("no event has the code {code}")))
}

/// A state of contact: the instant at which a node touches, yields or leaves, or one between two of these.
///
/// Numbers that do not exist are NaN: the contact stiffness of a periodic half-space, for example.
#[pyclass(frozen, module = "asperity")]
#[derive(Clone)]
pub(crate) struct State {
    pub(crate) state: LoadingState,
}

impl State {
    pub(crate) fn new(state: LoadingState) -> Self {
        Self { state }
    }

    fn contact(&self) -> &ContactState {
        &self.state.contact
    }

    /// A number of what has yielded: 0 without a hardness.
    fn plastic(&self, get: fn(&asperity::contact::PlasticState) -> f64) -> f64 {
        self.contact().plastic.as_ref().map_or(0.0, get)
    }
}

#[pymethods]
impl State {
    /// Number of events up to here, 1 for first touch.
    #[getter]
    fn step(&self) -> usize {
        self.state.step
    }

    /// What happens: ``"touch"``, ``"release"``, ``"yield"``, or nothing, at a ``"limit"``.
    #[getter]
    fn event(&self) -> &'static str {
        self.state.event.name()
    }

    /// Row of the node to which it happens; at a limit of that of the last event.
    #[getter]
    fn row(&self) -> usize {
        self.state.node.1
    }

    /// Column of that node.
    #[getter]
    fn column(&self) -> usize {
        self.state.node.0
    }

    /// Number of nodes in contact.
    #[getter]
    fn contact_nodes(&self) -> usize {
        self.contact().contact_nodes
    }

    /// Load W [N].
    #[getter]
    fn load(&self) -> f64 {
        self.contact().load
    }

    /// Load over nominal area [Pa].
    #[getter]
    fn mean_pressure(&self) -> f64 {
        self.contact().mean_pressure()
    }

    /// Approach [m] from first touch; of the mean planes on a periodic half-space.
    #[getter]
    fn approach(&self) -> f64 {
        self.contact().approach
    }

    /// Contact area [m²], counted in cells.
    #[getter]
    fn contact_area(&self) -> f64 {
        self.contact().contact_area
    }

    /// Contact area over nominal area.
    #[getter]
    fn area_fraction(&self) -> f64 {
        self.contact().contact_area_fraction
    }

    /// Mean gap [m].
    #[getter]
    fn mean_gap(&self) -> f64 {
        self.contact().mean_gap
    }

    /// Contact stiffness dW/d(approach) on further loading [N/m]; NaN on a periodic half-space.
    #[getter]
    fn contact_stiffness(&self) -> f64 {
        self.contact().contact_stiffness.unwrap_or(f64::NAN)
    }

    /// Interfacial stiffness -dW/d(mean gap) [N/m]; infinite in full contact.
    #[getter]
    fn interfacial_stiffness(&self) -> f64 {
        self.contact().interfacial_stiffness.unwrap_or(f64::NAN)
    }

    /// Elastic energy [J], which comes back on unloading.
    #[getter]
    fn energy(&self) -> f64 {
        self.contact().energy
    }

    /// Estimated error of the approach [m], 0 where events are exact to rounding.
    #[getter]
    fn approach_error(&self) -> f64 {
        self.state.approach_error
    }

    /// Number of nodes that have yielded.
    #[getter]
    fn yielded_nodes(&self) -> usize {
        self.contact().plastic.map_or(0, |plastic| plastic.yielded_nodes)
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

    fn __eq__(&self, other: PyRef<'_, Self>) -> bool {
        self.state == other.state
    }

    fn __hash__(&self) -> u64 {
        use std::hash::{DefaultHasher, Hash, Hasher};
        let mut hasher = DefaultHasher::new();
        let numbers = [self.contact().load, self.contact().approach];
        (self.state.step, self.state.node, numbers.map(f64::to_bits)).hash(&mut hasher);
        hasher.finish()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyTuple>> {
        let restore = py.import("asperity._asperity")?.getattr("_restore_states")?;
        // As a table of one state.
        let state = (crate::history::table(py, &[self.state])?, true);
        Ok((restore, state).into_pyobject(py)?)
    }

    fn __repr__(&self) -> String {
        let contact = self.contact();
        format!(
            "<State {} ({}): {} nodes in contact, load {:.6e} N, approach {:.6e} m, mean gap {:.6e} m>",
            self.state.step,
            self.event(),
            contact.contact_nodes,
            contact.load,
            contact.approach,
            contact.mean_gap
        )
    }
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("EVENTS", PyTuple::new(module.py(), ContactEvent::ALL.map(ContactEvent::name))?)?;
    module.add_class::<State>()
}
