//! Any history of viscoelastic contact, in steps of time.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use asperity::Error;
use asperity::bed::Bed;
use asperity::creep::{ControlHistory, CreepState, Prony, ViscoelasticBed};
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::columns::columns;
use crate::argument::whole;
use crate::arrays::rows;
use crate::compute::cancellable;
use crate::errors::Fallible;
use crate::increments::Increments;

/// A history of viscoelastic contact that was followed in steps: made by `Creep.follow`.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct CreepSteps {
    increments: Increments,
    prony: Prony,
    course: ControlHistory,
    times: Vec<f64>,
    states: Vec<CreepState>,
    halvings: usize,
}

impl CreepSteps {
    pub(super) fn follow(
        py: Python<'_>,
        increments: &Increments,
        prony: &Prony,
        course: &ControlHistory,
        times: Vec<f64>,
    ) -> Fallible<Self> {
        let given = (Arc::clone(&increments.history), prony.clone(), course.clone(), times.clone());
        let (states, halvings) = cancellable(py, move |is_left| {
            let (history, prony, course, times) = given;
            let bed = Bed::new(&history)?;
            let mut contact = ViscoelasticBed::new(&bed, &prony)?;
            let mut states = Vec::with_capacity(times.len());
            for time in times {
                if is_left.load(Ordering::Relaxed) {
                    break;
                }
                states.extend(contact.follow(&course, &[time])?);
            }
            Ok::<_, Error>((states, contact.halvings()))
        })??;
        Ok(Self {
            increments: increments.again(py),
            prony: prony.clone(),
            course: course.clone(),
            times,
            states,
            halvings,
        })
    }

    /// The contact at the last time. It refers to the bed of its path, and so is followed there once more.
    fn last<'a>(&self, bed: &'a Bed<'a>) -> Result<ViscoelasticBed<'a>, Error> {
        let mut contact = ViscoelasticBed::new(bed, &self.prony)?;
        contact.follow(&self.course, &self.times)?;
        Ok(contact)
    }
}

#[pymethods]
impl CreepSteps {
    /// All states by name.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     As of `Creep.at`, one value for each time.
    fn columns<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyDict>> {
        columns(py, &self.states)
    }

    /// How often a step was halved because pressures would have been negative.
    #[getter]
    fn halvings(&self) -> usize {
        self.halvings
    }

    /// Pressure [Pa] at the last time.
    ///
    /// Parameters
    /// ----------
    /// pieces : int
    ///     Of how many fields of the path it is made.
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    #[pyo3(signature = (pieces=40))]
    fn pressure<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = whole)] pieces: usize,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        let field = self
            .increments
            .field(py, |engine, bed| self.last(bed)?.pressure(pieces)?.pressure(bed, engine))?;
        rows(py, field)
    }

    /// Gap [m] at the last time: none in contact.
    ///
    /// Parameters
    /// ----------
    /// pieces : int
    ///     Of how many fields of the path it is made.
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    #[pyo3(signature = (pieces=40))]
    fn gap<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = whole)] pieces: usize,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        let field = self.increments.field(py, |engine, bed| self.last(bed)?.gap(pieces, engine))?;
        rows(py, field)
    }

    fn __len__(&self) -> usize {
        self.states.len()
    }

    fn __repr__(&self) -> String {
        let last = self.states.last();
        let end = last.map_or(String::new(), |state| format!(", until {:e} s", state.time));
        format!("<CreepSteps: {} states{end}>", self.states.len())
    }
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<CreepSteps>()
}
