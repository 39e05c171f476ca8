//! The increments of a path, which slip, creep and joints are made of.

use std::sync::Arc;

use asperity::bed::Bed;
use asperity::{Error, LoadingState, loading};
use pyo3::prelude::*;

use crate::errors::{Failure, Fallible};
use crate::history::History;
use crate::materials::Body;
use crate::path::{Engine, LoadingPath};

/// The states of a path, and the path itself where fields are to be had.
pub(crate) struct Increments {
    pub(crate) history: Arc<loading::History>,
    path: Option<Py<LoadingPath>>,
}

impl Increments {
    /// Of a path with its states so far, or of a history.
    pub(crate) fn of(object: &Bound<'_, PyAny>) -> Fallible<Self> {
        if let Ok(path) = object.cast::<LoadingPath>() {
            let history = path.get().history_now(object.py())?.history;
            return Ok(Self { history, path: Some(path.clone().unbind()) });
        }
        let Ok(history) = object.cast::<History>() else {
            return Err(Failure::arguments("a LoadingPath or a History is needed"));
        };
        Ok(Self { history: Arc::clone(&history.get().history), path: None })
    }

    /// The same once more.
    pub(crate) fn again(&self, py: Python<'_>) -> Self {
        let path = self.path.as_ref().map(|path| path.clone_ref(py));
        Self { history: Arc::clone(&self.history), path }
    }

    /// The bed of the path.
    pub(crate) fn bed(&self) -> Result<Bed<'_>, Error> {
        Bed::new(&self.history)
    }

    /// Its states with the stiffness on unloading, if it is a path on which nodes may yield.
    pub(crate) fn with_unloading_stiffness(
        &self,
        py: Python<'_>,
    ) -> Fallible<Arc<loading::History>> {
        let has_hardness = |state: &LoadingState| state.contact.plastic.is_some();
        match &self.path {
            Some(path) if self.history.states().iter().any(has_hardness) => {
                let mut states = self.history.states().to_vec();
                let states = path.bind(py).get().computed(py, |engine| {
                    engine.add_unloading_stiffness(&mut states)?;
                    Ok(states)
                })?;
                let history: loading::History = states.into_iter().collect();
                Ok(Arc::new(history.on(self.history.layering())))
            }
            None if self.history.states().iter().any(lacks_stiffness) => Err(Failure::arguments(
                "nodes have yielded, and the stiffness on unloading, of all nodes in contact, needs the path: a History has the states of \
                 it alone",
            )),
            _ => Ok(Arc::clone(&self.history)),
        }
    }

    /// E* of the path, if it is known.
    pub(crate) fn e_star(&self, py: Python<'_>) -> Option<f64> {
        self.path.as_ref().and_then(|path| path.bind(py).get().modulus())
    }

    /// Both bodies of the path, if it knows them.
    pub(crate) fn bodies(&self, py: Python<'_>) -> Fallible<Option<(Body, Body)>> {
        let known = match &self.path {
            Some(path) => path.bind(py).get().elastic_bodies(py)?,
            None => Vec::new(),
        };
        let rigid = || Body::Named("rigid".to_string());
        Ok(known.split_first().map(|(first, rest)| {
            (Body::Numbers(*first), rest.first().map_or_else(rigid, |b| Body::Numbers(*b)))
        }))
    }

    /// What the engine of the path computes.
    pub(crate) fn field<T: Send>(
        &self,
        py: Python<'_>,
        compute: impl FnOnce(&mut Engine, &Bed) -> Result<T, Error> + Send,
    ) -> Fallible<T> {
        let Some(path) = &self.path else {
            return Err(Failure::arguments(
                "fields need the path: a History has the states of it alone",
            ));
        };
        let bed = self.bed()?;
        path.bind(py).get().computed(py, |engine| compute(engine, &bed))
    }
}

/// Whether nodes have yielded at a state without the stiffness of all that are in contact.
fn lacks_stiffness(state: &LoadingState) -> bool {
    let plastic = state.contact.plastic.as_ref();
    plastic.is_some_and(|p| p.yielded_nodes > 0 && p.interfacial_unloading_stiffness.is_none())
}
