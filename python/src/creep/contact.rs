//! The contact of viscoelastic bodies over time.

use asperity::bed::{Bed, Superposition};
use asperity::creep::{
    Corners, Course, Creep as OfLoad, CreepState, Relaxation, Steps, Unloading, ViscoelasticBed,
};
use asperity::{Error, LoadingState};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::prony::Prony;
use crate::arrays::{Found, Kind, column, rows};
use crate::compute::detached;
use crate::errors::{Failure, Fallible};
use crate::increments::Increments;
use crate::path::Superposed;
use crate::state::State;

/// The contact of viscoelastic bodies under a history of load or approach, from the elastic path: made by `creep`.
///
/// While the contact grows everything is in closed form (`at`, `touch_times`, `pressure`). From `recession` on `follow` steps
/// through any history, and `unloading` solves a single unloading.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct Creep {
    increments: Increments,
    prony: Py<Prony>,
    course: Course,
}

/// Let the contact of viscoelastic bodies grow over time: creep under a load, or relaxation at an approach.
///
/// Nothing is solved for it: contact and gaps at a time are those of the elastic path of the same surface at an effective load.
///
/// Parameters
/// ----------
/// path : LoadingPath or History
///     Elastic, from first touch on, as far as the effective load grows. Fields need a path.
/// prony : Prony
///     The modulus over the E* of the path: `Prony.shares`, or `Prony.relative_to`.
/// times : array_like of float
///     Corners of the history [s], ascending; two at one time are a jump. Behind the last one the value is held.
/// load : array_like of float, optional
///     Loads at the corners [N].
/// approach : array_like of float, optional
///     Approaches at the corners [m], in place of loads.
///
/// Returns
/// -------
/// Creep
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> path = asp.load_path(asp.example_surface(nodes=32), asp.HalfSpace(1e6, boundary="free"), area_fraction=0.5)
/// >>> history = path.run(check=False)
/// >>> rubber = asp.Prony.shares([(1.0, 0.3)])
/// >>> held = asp.creep(path, rubber, [0.0, 0.0], load=[0.0, 0.01])     # 10 mN from t = 0 on
/// >>> held.at([0.0, 100.0])["effective_load"].round(5).tolist()
/// [0.01, 0.01429]
#[pyfunction]
#[pyo3(signature = (path, prony, times, *, load=None, approach=None))]
fn creep(
    path: &Bound<'_, PyAny>,
    prony: Py<Prony>,
    times: &Bound<'_, PyAny>,
    load: Option<&Bound<'_, PyAny>>,
    approach: Option<&Bound<'_, PyAny>>,
) -> Fallible<Creep> {
    let increments = Increments::of(path)?;
    let times = Found::of(times, "times", Kind::Real)?.list()?;
    let corners = |values: &Bound<'_, PyAny>, name| -> Fallible<Corners> {
        let values = Found::of(values, name, Kind::Real)?.list_of(times.len())?;
        Ok(Corners::new(times.iter().copied().zip(values))?)
    };
    let course = match (load, approach) {
        (Some(load), None) => Course::Load(corners(load, "load")?),
        (None, Some(approach)) => Course::Approach(corners(approach, "approach")?),
        _ => return Err(Failure::arguments("give one of load and approach")),
    };
    let creep = Creep { increments, prony, course };
    creep.grown(|_| Ok(()))?;
    Ok(creep)
}

/// Contact that grows, in closed form.
enum Grown<'a> {
    Load(OfLoad<'a>),
    Approach(Relaxation<'a>),
}

impl Grown<'_> {
    fn at(&self, time: f64) -> Result<CreepState, Error> {
        match self {
            Self::Load(creep) => creep.at(time),
            Self::Approach(relaxation) => relaxation.at(time),
        }
    }

    fn path_state(&self, time: f64) -> Result<LoadingState, Error> {
        match self {
            Self::Load(creep) => creep.path_state(time),
            Self::Approach(relaxation) => relaxation.path_state(time),
        }
    }

    fn pressure(&self, time: f64, pieces: usize) -> Result<Superposition, Error> {
        match self {
            Self::Load(creep) => creep.pressure(time, pieces),
            Self::Approach(relaxation) => relaxation.pressure(time, pieces),
        }
    }
}

impl Creep {
    fn grown<T>(&self, ask: impl FnOnce(&Grown) -> Result<T, Error>) -> Fallible<T> {
        let bed = self.increments.bed()?;
        Ok(ask(&self.on(&bed)?)?)
    }

    fn on<'a>(&self, bed: &'a Bed<'a>) -> Result<Grown<'a>, Error> {
        let prony = &self.prony.get().prony;
        Ok(match &self.course {
            Course::Load(load) => Grown::Load(OfLoad::new(bed, prony, load)?),
            Course::Approach(approach) => Grown::Approach(Relaxation::new(bed, prony, approach)?),
        })
    }

    /// The single unloading of a history of load.
    fn unloaded<T>(&self, ask: impl FnOnce(&Unloading) -> Result<T, Error>) -> Fallible<T> {
        let bed = self.increments.bed()?;
        match self.on(&bed)? {
            Grown::Load(creep) => Ok(ask(&Unloading::new(&creep)?)?),
            Grown::Approach(_) => Err(Failure::arguments(
                "a single unloading is solved under a load: `follow` steps through approaches",
            )),
        }
    }

    fn field_of<'py>(
        &self,
        py: Python<'py>,
        superposition: Superposition,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        let field = self.increments.field(py, |engine, bed| {
            engine.superposed(Superposed::Pressure, &superposition, bed)
        })?;
        rows(py, field)
    }
}

/// States over time as columns.
fn columns<'py>(py: Python<'py>, states: &[CreepState]) -> Fallible<Bound<'py, PyDict>> {
    let of = |get: fn(&CreepState) -> f64| column(py, states.iter().map(get).collect::<Vec<f64>>());
    let columns = PyDict::new(py);
    columns.set_item("time", of(|state| state.time))?;
    columns.set_item("load", of(|state| state.load))?;
    columns.set_item("effective_load", of(|state| state.effective_load))?;
    columns.set_item("approach", of(|state| state.approach))?;
    let nodes = states.iter().map(|state| state.contact_nodes as i64).collect();
    columns.set_item("contact_nodes", column::<i64>(py, nodes))?;
    columns.set_item("contact_area", of(|state| state.contact_area))?;
    columns.set_item("area_fraction", of(|state| state.contact_area_fraction))?;
    columns.set_item("mean_gap", of(|state| state.mean_gap))?;
    Ok(columns)
}

#[pymethods]
impl Creep {
    /// When the contact recedes for the first time [s]; None if it never does.
    #[getter]
    fn recession(&self) -> Fallible<Option<f64>> {
        self.grown(|grown| {
            Ok(match grown {
                Grown::Load(creep) => creep.recession().map(|recession| recession.time),
                Grown::Approach(relaxation) => relaxation.recession(),
            })
        })
    }

    /// When each state of the path is reached [s]: as many as are before the contact recedes.
    #[getter]
    fn touch_times<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyArray1<f64>>> {
        let times = self.grown(|grown| {
            Ok(match grown {
                Grown::Load(creep) => creep.times(),
                Grown::Approach(relaxation) => relaxation.times(),
            })
        })?;
        Ok(column(py, times))
    }

    /// States at some times, in closed form.
    ///
    /// Parameters
    /// ----------
    /// times : array_like of float
    ///     [s], each just after a jump there.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     ``time``, ``load``, ``effective_load``, ``approach``, ``contact_nodes``, ``contact_area``, ``area_fraction``, ``mean_gap``.
    ///
    /// Raises
    /// ------
    /// AsperityError
    ///     Of the kind ``"ContactRecedes"`` behind `recession`, and ``"PathEnds"`` if the path does not reach as far.
    fn at<'py>(&self, py: Python<'py>, times: &Bound<'py, PyAny>) -> Fallible<Bound<'py, PyDict>> {
        let times = Found::of(times, "times", Kind::Real)?.list()?;
        let states =
            self.grown(|grown| times.iter().map(|time| grown.at(*time)).collect::<Result<_, _>>())?;
        let states: Vec<CreepState> = states;
        columns(py, &states)
    }

    /// The state of the elastic path whose contact and gap those of a time are, for its fields: ``path.gap(state)``.
    ///
    /// Parameters
    /// ----------
    /// time : float
    ///     [s]
    ///
    /// Returns
    /// -------
    /// State
    ///     Its load is the effective one, and its pressure not that of the time.
    fn path_state(&self, time: f64) -> Fallible<State> {
        Ok(State::new(self.grown(|grown| grown.path_state(time))?))
    }

    /// Pressure [Pa] at a time.
    ///
    /// Parameters
    /// ----------
    /// time : float
    ///     [s]
    /// pieces : int
    ///     Of how many fields of the path it is made: twenty leave some 1e-3 of the greatest pressure.
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    #[pyo3(signature = (time, pieces=40))]
    fn pressure<'py>(
        &self,
        py: Python<'py>,
        time: f64,
        pieces: usize,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        self.field_of(py, self.grown(|grown| grown.pressure(time, pieces))?)
    }

    /// States of a single unloading under a load, in closed form: contact that has grown and recedes once.
    ///
    /// Parameters
    /// ----------
    /// times : array_like of float
    ///     [s]
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     ``time``, ``load``, ``contact_time`` (the earlier time that had this contact), ``contact_nodes`` and
    ///     ``contact_area``.
    fn unloading<'py>(
        &self,
        py: Python<'py>,
        times: &Bound<'py, PyAny>,
    ) -> Fallible<Bound<'py, PyDict>> {
        let times = Found::of(times, "times", Kind::Real)?.list()?;
        let states = self.unloaded(|unloading| {
            times.iter().map(|time| unloading.at(*time)).collect::<Result<Vec<_>, _>>()
        })?;
        let columns = PyDict::new(py);
        columns.set_item("time", column::<f64>(py, states.iter().map(|s| s.time).collect()))?;
        columns.set_item("load", column::<f64>(py, states.iter().map(|s| s.load).collect()))?;
        let contact_time = states.iter().map(|s| s.contact_time).collect();
        columns.set_item("contact_time", column::<f64>(py, contact_time))?;
        let nodes = states.iter().map(|s| s.contact.contact_nodes as i64).collect();
        columns.set_item("contact_nodes", column::<i64>(py, nodes))?;
        let area = states.iter().map(|s| s.contact.contact_area).collect();
        columns.set_item("contact_area", column::<f64>(py, area))?;
        Ok(columns)
    }

    /// Follow the history in steps of time, whatever it is: receding and returning contact included.
    ///
    /// Parameters
    /// ----------
    /// end : float
    ///     Until when [s].
    /// halvings : int
    ///     How often the steps are halved: each time leaves a third of the error, some 1e-4 of the approach without.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     As of `at`, one value for each step.
    #[pyo3(signature = (end, halvings=0))]
    fn follow<'py>(
        &self,
        py: Python<'py>,
        end: f64,
        halvings: u32,
    ) -> Fallible<Bound<'py, PyDict>> {
        let prony = &self.prony.get().prony;
        let states = detached(py, || {
            let steps = (0..halvings.min(16)).fold(Steps::default(), |steps, _| steps.halved());
            let times = steps.times(prony, self.course.corners(), end)?;
            let bed = self.increments.bed()?;
            ViscoelasticBed::new(&bed, prony)?.follow(&self.course, &times)
        })??;
        columns(py, &states)
    }

    fn __repr__(&self) -> String {
        let (of, corners) = match &self.course {
            Course::Load(corners) => ("load", corners),
            Course::Approach(corners) => ("approach", corners),
        };
        format!(
            "<Creep: {of} over {} corners, until {:e} s>",
            corners.corners().len(),
            corners.end()
        )
    }
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Creep>()?;
    module.add_function(wrap_pyfunction!(creep, module)?)
}
