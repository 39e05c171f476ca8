//! The contact of viscoelastic bodies over time.

use asperity::bed::{Bed, Superposition};
use asperity::creep::{
    ControlHistory, Creep as OfLoad, CreepState, PiecewiseLinear, Prony as Law, Relaxation, Steps,
    Unloading,
};
use asperity::{Error, LoadingState};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::columns::columns;
use super::prony::Prony;
use super::steps::CreepSteps;
use crate::argument::whole;
use crate::arrays::{Found, Kind, column, rows};
use crate::compute::detached;
use crate::errors::{Failure, Fallible};
use crate::increments::Increments;
use crate::state::State;

/// The contact of viscoelastic bodies under a history of load or approach, from the elastic path: made by `creep`.
///
/// While the contact grows everything is in closed form (`at`, `touch_times`, `pressure`). From `recession` on `follow` steps
/// through any history, and `unloading` solves a single unloading.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct Creep {
    increments: Increments,
    prony: Py<Prony>,
    course: ControlHistory,
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
    py: Python<'_>,
    path: &Bound<'_, PyAny>,
    prony: Py<Prony>,
    times: &Bound<'_, PyAny>,
    load: Option<&Bound<'_, PyAny>>,
    approach: Option<&Bound<'_, PyAny>>,
) -> Fallible<Creep> {
    let increments = Increments::of(path)?;
    let times = Found::of(times, "times", Kind::Real)?.list()?;
    let corners = |values: &Bound<'_, PyAny>, name| -> Fallible<PiecewiseLinear> {
        let values = Found::of(values, name, Kind::Real)?.list_of(times.len())?;
        Ok(PiecewiseLinear::new(times.iter().copied().zip(values))?)
    };
    let course = match (load, approach) {
        (Some(load), None) => ControlHistory::Load(corners(load, "load")?),
        (None, Some(approach)) => ControlHistory::Approach(corners(approach, "approach")?),
        _ => return Err(Failure::arguments("give one of load and approach")),
    };
    let creep = Creep { increments, prony, course };
    creep.grown(py, |_| Ok(()))?;
    Ok(creep)
}

/// Contact that grows, in closed form.
enum Grown<'a> {
    Load(OfLoad<'a>),
    Approach(Relaxation<'a>),
}

impl<'a> Grown<'a> {
    fn on(bed: &'a Bed<'a>, prony: &Law, course: &ControlHistory) -> Result<Self, Error> {
        Ok(match course {
            ControlHistory::Load(load) => Self::Load(OfLoad::new(bed, prony, load)?),
            ControlHistory::Approach(approach) => {
                Self::Approach(Relaxation::new(bed, prony, approach)?)
            }
        })
    }

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
    /// What the contact of the library says, as long as it grows.
    fn grown<T: Send>(
        &self,
        py: Python<'_>,
        ask: impl FnOnce(&Grown) -> Result<T, Error> + Send,
    ) -> Fallible<T> {
        let (history, prony, course) = (&*self.increments.history, self.law(), &self.course);
        Ok(detached(py, || {
            let bed = Bed::new(history)?;
            ask(&Grown::on(&bed, prony, course)?)
        })??)
    }

    /// The same of a single unloading, under a load.
    fn unloaded<T: Send>(
        &self,
        py: Python<'_>,
        ask: impl FnOnce(&Unloading) -> Result<T, Error> + Send,
    ) -> Fallible<T> {
        let ControlHistory::Load(load) = &self.course else {
            return Err(Failure::arguments(
                "a single unloading is solved under a load: `follow` steps through approaches",
            ));
        };
        let (history, prony) = (&*self.increments.history, self.law());
        Ok(detached(py, || {
            let bed = Bed::new(history)?;
            ask(&Unloading::new(&OfLoad::new(&bed, prony, load)?)?)
        })??)
    }

    fn law(&self) -> &Law {
        &self.prony.get().prony
    }

    fn field_of<'py>(
        &self,
        py: Python<'py>,
        superposition: Superposition,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        let field = self.increments.field(py, |engine, bed| superposition.pressure(bed, engine))?;
        rows(py, field)
    }
}

#[pymethods]
impl Creep {
    /// When the contact recedes for the first time [s]; None if it never does.
    #[getter]
    fn recession(&self, py: Python<'_>) -> Fallible<Option<f64>> {
        self.grown(py, |grown| {
            Ok(match grown {
                Grown::Load(creep) => creep.recession().map(|recession| recession.time),
                Grown::Approach(relaxation) => relaxation.recession(),
            })
        })
    }

    /// When each state of the path is reached [s]: as many as are before the contact recedes.
    #[getter]
    fn touch_times<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyArray1<f64>>> {
        let times = self.grown(py, |grown| {
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
    ///     Of the kind ``"ContactRecedes"`` behind `recession`, and ``"PathEnds"``, of an approach ``"PathEndsBefore"``,
    ///     if the path does not reach as far.
    fn at<'py>(&self, py: Python<'py>, times: &Bound<'py, PyAny>) -> Fallible<Bound<'py, PyDict>> {
        let times = Found::of(times, "times", Kind::Real)?.list()?;
        let states = self.grown(py, |grown| {
            times.iter().map(|time| grown.at(*time)).collect::<Result<Vec<_>, _>>()
        })?;
        columns(py, &states)
    }

    /// The state of the elastic path whose contact and gap those of a time are, for its fields: ``path.gap(state)``.
    ///
    /// Where an approach below 0 holds the surfaces apart it is that of first touch, whose gap is too narrow: `gap` has
    /// the one of the time, and ``seal.leak_of(held.gap(t), no_contact, path.size, periodic=path.periodic)``, with a
    /// map of False alone, the leak.
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
    fn path_state(&self, py: Python<'_>, time: f64) -> Fallible<State> {
        Ok(State::new(self.grown(py, |grown| grown.path_state(time))?))
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
        #[pyo3(from_py_with = whole)] pieces: usize,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        self.field_of(py, self.grown(py, |grown| grown.pressure(time, pieces))?)
    }

    /// Gap [m] at a time: none in contact.
    ///
    /// Parameters
    /// ----------
    /// time : float
    ///     [s]
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    fn gap<'py>(&self, py: Python<'py>, time: f64) -> Fallible<Bound<'py, PyArray2<f64>>> {
        let field = match &self.course {
            ControlHistory::Load(_) => {
                let state = self.grown(py, |grown| grown.path_state(time))?;
                self.increments
                    .field(py, |engine, _| engine.fields_at(&state).map(|fields| fields.gap))?
            }
            ControlHistory::Approach(approach) => {
                let prony = self.law();
                self.increments.field(py, |engine, bed| {
                    Relaxation::new(bed, prony, approach)?.gap(time, engine)
                })?
            }
        };
        rows(py, field)
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
        let states = self.unloaded(py, |unloading| {
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

    /// Times for `follow`, and for curves: close behind each corner, and further apart as its memory fades.
    ///
    /// Parameters
    /// ----------
    /// end : float
    ///     The last of them [s].
    /// steps : int
    ///     The least number of steps from one corner to the next.
    /// halvings : int
    ///     How often all steps are halved: each time leaves a quarter of the error, some 1e-4 of the approach without.
    ///
    /// Returns
    /// -------
    /// ndarray of float
    ///     [s], all corners among them.
    #[pyo3(signature = (end, *, steps=60, halvings=0))]
    fn step_times<'py>(
        &self,
        py: Python<'py>,
        end: f64,
        #[pyo3(from_py_with = whole)] steps: usize,
        #[pyo3(from_py_with = whole)] halvings: usize,
    ) -> Fallible<Bound<'py, PyArray1<f64>>> {
        let least = Steps { least: steps, ..Steps::default() };
        // More often than a number has bits nothing is left to halve.
        let steps = (0..halvings.min(usize::BITS as usize)).fold(least, |steps, _| steps.halved());
        let times = detached(py, || steps.times(self.law(), self.course.corners(), end))??;
        Ok(column(py, times))
    }

    /// Follow the history in steps of time, whatever it is: receding and returning contact included.
    ///
    /// Parameters
    /// ----------
    /// times : array_like of float
    ///     Ends of the steps [s], ascending, as of `step_times`. Corners of the history are steps of their own besides.
    ///
    /// Returns
    /// -------
    /// CreepSteps
    ///     The states at these times, each just after a jump there, and the fields of the last one.
    ///
    /// Raises
    /// ------
    /// AsperityError
    ///     Of the kind ``"BedEnds"`` if the path does not reach as far.
    fn follow(&self, py: Python<'_>, times: &Bound<'_, PyAny>) -> Fallible<CreepSteps> {
        let times = Found::of(times, "times", Kind::Real)?.list()?;
        CreepSteps::follow(py, &self.increments, self.law(), &self.course, times)
    }

    fn __repr__(&self) -> String {
        let (of, corners) = match &self.course {
            ControlHistory::Load(corners) => ("load", corners),
            ControlHistory::Approach(corners) => ("approach", corners),
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
