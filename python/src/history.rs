//! The states of a path, as columns.

use std::sync::Arc;

use asperity::contact::PlasticState;
use asperity::patches::ContactEdge;
use asperity::{Boundary, ContactEvent, ContactState, Error, Grid, LoadingState, loading};
use numpy::{PyArray1, PyArrayMethods, PyFixedUnicode, PyReadonlyArray1};
use pyo3::exceptions::{PyIndexError, PyOverflowError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PySlice, PySliceMethods, PyTuple};

use crate::arrays::{column, shape};
use crate::choice::{BOUNDARIES, LAYERINGS, choose, word};
use crate::errors::{Failure, Fallible};
use crate::state::{self, State};
use crate::targets::Targets;

/// A number of a state, and how it is put into one.
struct Real {
    name: &'static str,
    get: fn(&LoadingState) -> f64,
    set: fn(&mut LoadingState, f64),
}

/// Makes a column of a field of the contact.
macro_rules! real {
    ($name:literal, $($field:ident).+) => {
        Real { name: $name, get: |s| s.$($field).+, set: |s, x| s.$($field).+ = x }
    };
    ($name:literal, optional $field:ident) => {
        Real {
            name: $name,
            get: |s| s.contact.$field.unwrap_or(f64::NAN),
            set: |s, x| s.contact.$field = (!x.is_nan()).then_some(x),
        }
    };
}

/// The numbers of every state; NaN stands for a stiffness that there is not.
const REALS: [Real; 9] = [
    real!("approach", contact.approach),
    real!("load", contact.load),
    real!("contact_area", contact.contact_area),
    real!("area_fraction", contact.contact_area_fraction),
    real!("mean_gap", contact.mean_gap),
    real!("contact_stiffness", optional contact_stiffness),
    real!("interfacial_stiffness", optional interfacial_stiffness),
    real!("energy", contact.energy),
    real!("approach_error", approach_error),
];

/// The same for all, and no column.
const NOMINAL_AREA: Real = real!("nominal_area", contact.nominal_area);

/// A number of what has yielded.
struct Plastic {
    name: &'static str,
    get: fn(&PlasticState) -> f64,
    set: fn(&mut PlasticState, f64),
}

macro_rules! plastic {
    ($name:literal, $field:ident) => {
        Plastic { name: $name, get: |s| s.$field, set: |s, x| s.$field = x }
    };
}

/// Those that paths with a hardness have.
const PLASTIC: [Plastic; 5] = [
    plastic!("yielded_area_fraction", yielded_area_fraction),
    plastic!("plastic_volume", volume),
    plastic!("plastic_work", work),
    plastic!("plastic_volume_per_load", volume_per_load),
    plastic!("plastic_work_per_load", work_per_load),
];

/// How far beyond an event a state between two of them may be, relative to these.
const SAME: f64 = 1e-9;

/// `Ok` if a state is one of a path, or lies between two of its events.
pub(crate) fn check_on_path(history: &loading::History, state: &LoadingState) -> Result<(), Error> {
    let (step, events) = (state.step, history.events());
    let after = events.partition_point(|event| event.step <= step);
    let present = history.states().last().map_or(0, |last| last.step);
    let event = after.checked_sub(1).and_then(|k| events.get(k));
    let last = history.states().last().filter(|last| step <= last.step);
    let (Some(event), Some(last)) = (event, last) else {
        return Err(Error::StateNotReached { step, present });
    };
    let (load, approach) = (state.contact.load, state.contact.approach);
    let load_of: fn(&LoadingState) -> f64 = |state| state.contact.load;
    let approach_of: fn(&LoadingState) -> f64 = |state| state.contact.approach;
    let both = [("load", load_of), ("approach", approach_of)];
    // Behind full contact the history is read on and on.
    let read_on = || {
        let is_same = |found: &LoadingState| {
            both.iter().all(|(_, of)| (of(found) - of(state)).abs() <= SAME * of(state).abs())
        };
        [history.at_load(load), history.at_approach(approach)].into_iter().flatten().find(is_same)
    };
    let next = events.get(after).copied().or_else(read_on).unwrap_or(*last);
    let off = |quantity, value| {
        let expected = "as at the events before and behind it";
        Err(Error::NotOnPath { step, load, approach, quantity, value, expected })
    };
    if state.contact.contact_nodes != event.contact.contact_nodes {
        return off("number of nodes in contact", event.contact.contact_nodes as f64);
    }
    for (quantity, of) in both {
        let (from, to) = (of(event), of(&next));
        let rounding = SAME * (from.abs() + to.abs());
        if of(state) < from - rounding || of(state) > to + rounding {
            return off(quantity, from);
        }
    }
    Ok(())
}

/// An iterator over so many items of a sequence.
pub(crate) fn iterated<'py>(
    sequence: &Bound<'py, PyAny>,
    length: usize,
) -> Fallible<Bound<'py, PyAny>> {
    let builtins = sequence.py().import("builtins")?;
    let places = builtins.getattr("range")?.call1((length,))?;
    Ok(builtins.getattr("map")?.call1((sequence.getattr("__getitem__")?, places))?)
}

/// The one of some states that an index means, which may be an integer of any size.
pub(crate) fn state_at<'a, T>(states: &'a [T], index: &Bound<'_, PyAny>) -> PyResult<&'a T> {
    let count = states.len();
    let place = match index.extract::<isize>() {
        Err(error) if error.is_instance_of::<PyOverflowError>(index.py()) => None,
        Err(error) => return Err(error),
        // Below 0 from the end.
        Ok(place) => usize::try_from(place).ok().or_else(|| count.checked_add_signed(place)),
    };
    let missing = || PyIndexError::new_err(format!("there are {count} states"));
    place.and_then(|place| states.get(place)).ok_or_else(missing)
}

/// What a history is of.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Setting {
    pub(crate) grid: Grid,
    pub(crate) boundary: Boundary,
    pub(crate) has_hardness: bool,
}

/// Shape, cell, boundary, and whether there is a hardness, as they are pickled.
pub(crate) type PickledSetting = ((usize, usize), (f64, f64), String, bool);

impl Setting {
    pub(crate) fn pickled(&self) -> PickledSetting {
        let Self { grid, boundary, has_hardness } = *self;
        let boundary = word(&BOUNDARIES, &boundary).to_string();
        (shape(&grid), (grid.dx(), grid.dy()), boundary, has_hardness)
    }

    pub(crate) fn restored(pickled: PickledSetting) -> Fallible<Self> {
        let ((rows, columns), (dx, dy), boundary, has_hardness) = pickled;
        let grid = Grid::new(columns, rows, dx, dy)?;
        let boundary = choose("boundary", &boundary, &BOUNDARIES)?;
        Ok(Self { grid, boundary, has_hardness })
    }
}

/// The states of a path in the order of loading, as columns: new arrays of NumPy with one value for each state.
///
/// A sequence of `State`; a slice of it is a history of fewer states, enough for slip, creep and conductance. Where no
/// state between others is left out, `at` reads it exactly at any load, approach, mean gap or area: between two events a
/// path is linear in the approach.
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> surface = asp.example_surface(nodes=32)
/// >>> path = asp.load_path(surface, asp.HalfSpace(115e9, boundary="love"), area_fraction=0.5)
/// >>> history = path.run(check=False)
/// >>> len(history), history.load.dtype, history.event[0]
/// (512, dtype('float64'), np.str_('touch'))
#[pyclass(frozen, sequence, module = "asperity")]
pub(crate) struct History {
    pub(crate) history: Arc<loading::History>,
    pub(crate) setting: Setting,
}

impl History {
    pub(crate) fn states(&self) -> &[LoadingState] {
        self.history.states()
    }

    /// Whether no event is left out, so that the states tell which nodes are in contact.
    pub(crate) fn is_whole(&self) -> bool {
        self.history.events().iter().zip(1..).all(|(state, step)| state.step == step)
    }

    fn reals<'py>(
        &self,
        py: Python<'py>,
        get: impl Fn(&LoadingState) -> f64,
    ) -> Bound<'py, PyArray1<f64>> {
        column(py, self.states().iter().map(get).collect())
    }

    fn wholes<'py>(
        &self,
        py: Python<'py>,
        get: impl Fn(&LoadingState) -> usize,
    ) -> Bound<'py, PyArray1<i64>> {
        column(py, self.states().iter().map(|state| get(state) as i64).collect())
    }

    fn plastic<'py>(
        &self,
        py: Python<'py>,
        get: impl Fn(&PlasticState) -> f64,
    ) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |state| state.contact.plastic.as_ref().map_or(0.0, &get))
    }
}

#[pymethods]
impl History {
    /// All columns by name, for ``pandas.DataFrame``, ``xarray.Dataset`` or ``numpy.savez``.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     float64, int64 (step, row, column, contact_nodes) and text (event). The columns of yielding are there if the
    ///     path has a hardness.
    fn columns<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        columns.set_item("step", self.step(py))?;
        columns.set_item("row", self.row(py))?;
        columns.set_item("column", self.column(py))?;
        columns.set_item("event", self.event(py))?;
        columns.set_item("contact_nodes", self.contact_nodes(py))?;
        columns.set_item("mean_pressure", self.mean_pressure(py))?;
        for real in &REALS {
            columns.set_item(real.name, self.reals(py, real.get))?;
        }
        columns.set_item("corrected_area", self.corrected_area(py)?)?;
        if self.setting.has_hardness {
            columns.set_item("yielded_nodes", self.yielded_nodes(py))?;
            for plastic in &PLASTIC {
                columns.set_item(plastic.name, self.plastic(py, plastic.get))?;
            }
        }
        Ok(columns)
    }

    /// The state at exactly this load, mean pressure, approach or mean gap, or the first with as many nodes in contact as
    /// fit into this fraction of the nominal area.
    ///
    /// Parameters
    /// ----------
    /// load, mean_pressure, approach, area_fraction, mean_gap : float
    ///     One of them [N, Pa, m, -, m].
    ///
    /// Returns
    /// -------
    /// State
    ///
    /// Raises
    /// ------
    /// AsperityError
    ///     For what lies outside the path, and where states between the first and the last have been left out.
    #[pyo3(signature = (*, load=None, mean_pressure=None, approach=None, area_fraction=None, mean_gap=None))]
    fn at(
        &self,
        load: Option<f64>,
        mean_pressure: Option<f64>,
        approach: Option<f64>,
        area_fraction: Option<f64>,
        mean_gap: Option<f64>,
    ) -> Fallible<State> {
        let targets = Targets { load, mean_pressure, approach, area_fraction, mean_gap };
        let gap = self.states().windows(2).find(|pair| pair[1].step > pair[0].step + 1);
        if let Some([before, after]) = gap {
            return Err(Failure::arguments(format!(
                "between states, `at` needs all of them: {} to {} are left out of this history",
                before.step + 1,
                after.step - 1
            )));
        }
        Ok(State::new(self.history.at(targets.only()?)?))
    }

    /// Number of events up to each state, 1 for first touch.
    #[getter]
    fn step<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.wholes(py, |state| state.step)
    }

    /// Row of the node of each event.
    #[getter]
    fn row<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.wholes(py, |state| state.node.1)
    }

    /// Column of the node of each event.
    #[getter]
    fn column<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.wholes(py, |state| state.node.0)
    }

    /// What happens: ``"touch"``, ``"release"``, ``"limit"`` or ``"yield"``, as an array of text.
    #[getter]
    fn event<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<PyFixedUnicode<7>>> {
        let letters = ContactEvent::ALL.map(|event| {
            let mut letters = [0_u32; 7];
            for (letter, character) in letters.iter_mut().zip(event.name().chars()) {
                *letter = character.into();
            }
            PyFixedUnicode(letters)
        });
        let events = self.states().iter().map(|s| letters[usize::from(s.event.code())]);
        column(py, events.collect())
    }

    /// The same as numbers, int8: places in `EVENTS`, for ``pandas.Categorical.from_codes(h.event_code, asp.EVENTS)``.
    #[getter]
    fn event_code<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i8>> {
        column(py, self.states().iter().map(|s| s.event.code().cast_signed()).collect())
    }

    /// Number of nodes in contact.
    #[getter]
    fn contact_nodes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.wholes(py, |state| state.contact.contact_nodes)
    }

    /// Load W [N].
    #[getter]
    fn load<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |state| state.contact.load)
    }

    /// Load over nominal area [Pa].
    #[getter]
    fn mean_pressure<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |state| state.contact.mean_pressure())
    }

    /// Approach [m] from first touch; of the mean planes on a periodic half-space.
    #[getter]
    fn approach<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |state| state.contact.approach)
    }

    /// Contact area [m²], counted in cells.
    #[getter]
    fn contact_area<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |state| state.contact.contact_area)
    }

    /// Contact area over nominal area.
    #[getter]
    fn area_fraction<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |state| state.contact.contact_area_fraction)
    }

    /// Contact area [m²] without what whole cells count too much along the edges of patches; NaN if states are left out.
    #[getter]
    fn corrected_area<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyArray1<f64>>> {
        if !self.is_whole() {
            return Ok(self.reals(py, |_| f64::NAN));
        }
        let mut edge = ContactEdge::new(self.setting.grid, self.setting.boundary);
        let areas = self.states().iter().map(|state| {
            edge.follow(state.event, state.node)?;
            Ok(edge.corrected_area())
        });
        Ok(column(py, areas.collect::<Result<_, Error>>()?))
    }

    /// Mean gap [m].
    #[getter]
    fn mean_gap<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |state| state.contact.mean_gap)
    }

    /// Contact stiffness dW/d(approach) on further loading [N/m]; NaN on a periodic half-space.
    #[getter]
    fn contact_stiffness<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |state| state.contact.contact_stiffness.unwrap_or(f64::NAN))
    }

    /// Interfacial stiffness -dW/d(mean gap) [N/m]; infinite in full contact.
    #[getter]
    fn interfacial_stiffness<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |state| state.contact.interfacial_stiffness.unwrap_or(f64::NAN))
    }

    /// Elastic energy [J].
    #[getter]
    fn energy<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |state| state.contact.energy)
    }

    /// Estimated error of the approach [m], 0 where events are exact to rounding.
    #[getter]
    fn approach_error<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.reals(py, |state| state.approach_error)
    }

    /// Number of nodes that have yielded; 0 without a hardness.
    #[getter]
    fn yielded_nodes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.wholes(py, |state| state.contact.plastic.map_or(0, |plastic| plastic.yielded_nodes))
    }

    /// Their area over the nominal area.
    #[getter]
    fn yielded_area_fraction<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.plastic(py, |plastic| plastic.yielded_area_fraction)
    }

    /// Volume of the plastic depth [m³].
    #[getter]
    fn plastic_volume<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.plastic(py, |plastic| plastic.volume)
    }

    /// Energy that is lost [J].
    #[getter]
    fn plastic_work<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.plastic(py, |plastic| plastic.work)
    }

    /// Rows and columns of the surface.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        shape(&self.setting.grid)
    }

    /// Whether the path has a hardness.
    #[getter]
    fn has_hardness(&self) -> bool {
        self.setting.has_hardness
    }

    fn __len__(&self) -> usize {
        self.states().len()
    }

    fn __iter__<'py>(slf: &Bound<'py, Self>) -> Fallible<Bound<'py, PyAny>> {
        iterated(slf, slf.get().states().len())
    }

    fn __getitem__<'py>(
        &self,
        py: Python<'py>,
        index: &Bound<'py, PyAny>,
    ) -> Fallible<Bound<'py, PyAny>> {
        let states = self.states();
        let Ok(slice) = index.cast::<PySlice>() else {
            return Ok(Bound::new(py, State::new(*state_at(states, index)?))?.into_any());
        };
        let count = isize::try_from(states.len()).unwrap_or(isize::MAX);
        let found = slice.indices(count)?;
        if found.step < 0 {
            return Err(Failure::arguments("the states of a history are in their order"));
        }
        let places = (found.start..found.stop).step_by(found.step as usize);
        let kept = places.filter_map(|place| states.get(place as usize)).copied();
        let layering = self.history.layering();
        let history = Arc::new(kept.collect::<loading::History>().on(layering));
        Ok(Bound::new(py, Self { history, setting: self.setting })?.into_any())
    }

    fn __eq__(&self, other: PyRef<'_, Self>) -> bool {
        self.setting == other.setting && self.history == other.history
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyTuple>> {
        let restore = py.import("asperity._asperity")?.getattr("_restore_history")?;
        let layering = word(&LAYERINGS, &self.history.layering());
        let state = (table(py, self.states())?, self.setting.pickled(), layering);
        Ok((restore, state).into_pyobject(py)?)
    }

    fn __repr__(&self) -> String {
        let last = self.states().last();
        let end = last.map_or(String::new(), |s| format!(", up to {:.6e} N", s.contact.load));
        format!("<History: {} states{end}>", self.states().len())
    }
}

/// All that there is of some states, in arrays.
pub(crate) fn table<'py>(py: Python<'py>, states: &[LoadingState]) -> Fallible<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    let wholes = |get: fn(&LoadingState) -> usize| {
        column(py, states.iter().map(|state| get(state) as i64).collect())
    };
    table.set_item("step", wholes(|s| s.step))?;
    table.set_item("ix", wholes(|s| s.node.0))?;
    table.set_item("iy", wholes(|s| s.node.1))?;
    table.set_item("contact_nodes", wholes(|s| s.contact.contact_nodes))?;
    // -1 where there is no hardness.
    let yielded = states.iter().map(|s| s.contact.plastic.map_or(-1, |p| p.yielded_nodes as i64));
    table.set_item("yielded_nodes", column(py, yielded.collect()))?;
    let events: Vec<i8> = states.iter().map(|s| s.event.code().cast_signed()).collect();
    table.set_item("event", column(py, events))?;
    for real in REALS.iter().chain([&NOMINAL_AREA]) {
        table.set_item(real.name, column(py, states.iter().map(real.get).collect()))?;
    }
    for plastic in &PLASTIC {
        let values = states.iter().map(|s| s.contact.plastic.as_ref().map_or(0.0, plastic.get));
        table.set_item(plastic.name, column(py, values.collect()))?;
    }
    Ok(table)
}

/// The states of a table.
fn states(table: &Bound<'_, PyDict>) -> Fallible<Vec<LoadingState>> {
    fn values<T: numpy::Element + Copy>(table: &Bound<'_, PyDict>, name: &str) -> Fallible<Vec<T>> {
        let column = table.get_item(name)?;
        let column = column.ok_or_else(|| Failure::arguments(format!("no column {name}")))?;
        let column: PyReadonlyArray1<'_, T> = column.extract()?;
        column.to_vec().map_err(|error| Failure::arguments(error.to_string()))
    }
    let wholes = |name: &str| values::<i64>(table, name);
    let (step, ix, iy) = (wholes("step")?, wholes("ix")?, wholes("iy")?);
    let (nodes, yielded) = (wholes("contact_nodes")?, wholes("yielded_nodes")?);
    let events = values::<i8>(table, "event")?;
    let count = step.len();
    if [&ix, &iy, &nodes, &yielded].iter().any(|c| c.len() != count) || events.len() != count {
        return Err(Failure::arguments("columns of different lengths"));
    }
    let any = Grid::new(1, 1, 1.0, 1.0)?;
    let mut states = Vec::with_capacity(count);
    for k in 0..count {
        let whole = |value: i64| value.max(0) as usize;
        let mut contact = ContactState::new(&any, whole(nodes[k]), 0.0, 0.0, 0.0);
        if yielded[k] >= 0 {
            let mut plastic = PlasticState::default();
            plastic.yielded_nodes = whole(yielded[k]);
            contact.plastic = Some(plastic);
        }
        let node = (whole(ix[k]), whole(iy[k]));
        states.push(LoadingState::new(whole(step[k]), state::event(events[k])?, node, contact));
    }
    for real in REALS.iter().chain([&NOMINAL_AREA]) {
        for (state, value) in states.iter_mut().zip(values::<f64>(table, real.name)?) {
            (real.set)(state, value);
        }
    }
    for plastic in &PLASTIC {
        for (state, value) in states.iter_mut().zip(values::<f64>(table, plastic.name)?) {
            if let Some(found) = &mut state.contact.plastic {
                (plastic.set)(found, value);
            }
        }
    }
    Ok(states)
}

/// A state that was pickled.
#[pyfunction]
fn _restore_states(table: &Bound<'_, PyDict>, is_one: bool) -> Fallible<State> {
    let states = states(table)?;
    match states[..] {
        [state] if is_one => Ok(State::new(state)),
        _ => Err(Failure::arguments("a state has one row")),
    }
}

/// A history that was pickled.
#[pyfunction]
fn _restore_history(
    table: &Bound<'_, PyDict>,
    setting: PickledSetting,
    layering: &str,
) -> Fallible<History> {
    let setting = Setting::restored(setting)?;
    let layering = choose("layering", layering, &LAYERINGS)?;
    let history = states(table)?.into_iter().collect::<loading::History>().on(layering);
    Ok(History { history: Arc::new(history), setting })
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<History>()?;
    module.add_function(wrap_pyfunction!(_restore_states, module)?)?;
    module.add_function(wrap_pyfunction!(_restore_history, module)?)
}
