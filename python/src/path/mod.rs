//! The loading path.

mod inner;
pub(crate) mod setup;
mod unloading;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use asperity::contact::Certificate;
use asperity::loading::{self, LoadingEnd};
use asperity::nalgebra::DMatrix;
use asperity::patches::constriction;
use asperity::record::LoadingRecord;
use asperity::{Error, Grid, LoadingState, Warning};
use numpy::{Element, PyArray1, PyArray2};
use parking_lot::{Mutex, MutexGuard};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The path of the engine.
pub(crate) type Engine = asperity::LoadingPath;
use self::inner::Inner;
use crate::arrays::{column, rows, shape};
use crate::choice::{self, Repeats};
use crate::compute::{detached, interruptible_with, locked};
use crate::errors::{Failure, Fallible};
use crate::history::{History, Setting, check_on_path};
use crate::results::result;
use crate::state::State;
use crate::surface::Surface;
use crate::targets::{Targets, named};
use crate::warnings::{of_contact, warn_all};

/// How long a path runs between two looks at signals and calls of `progress`.
const STRETCH: Duration = Duration::from_millis(50);

/// The exact loading path of a rough surface, event by event: made by `load_path` or `open`.
///
/// An iterator of `State`: one for each node that touches, or yields, computed when it is asked for. All states so far are
/// kept in `history`. `run` computes the rest at once. Fields of any state so far are computed on demand.
///
/// Notes
/// -----
/// The lock of the interpreter is released while something is computed, so that two paths in two threads run side by
/// side. One path may be used from several threads, which then take turns. After Ctrl-C, which is noticed between two
/// windows of events, nothing is lost, and the path goes on where it was.
///
/// An analysis that reads many states, such as `first_yield` or `Seal.curve`, works on in the background after Ctrl-C.
/// Until it is done, all that asks for states or fields of the path waits for it, `history` and ``repr`` too: another
/// Ctrl-C ends that wait.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct LoadingPath {
    inner: Arc<Mutex<Inner>>,
    setting: Setting,
    e_star: Option<f64>,
}

impl LoadingPath {
    fn new(inner: Inner, e_star: Option<f64>) -> Self {
        let engine = inner.engine();
        let setting = Setting {
            grid: engine.problem().grid(),
            boundary: engine.problem().boundary(),
            has_hardness: engine.hardness_map().is_some(),
        };
        Self { inner: Arc::new(Mutex::new(inner)), setting, e_star }
    }

    /// The path, for as long as nobody else uses it. No function of Python may be called meanwhile: it might ask for it too.
    fn lock(&self, py: Python<'_>) -> Fallible<MutexGuard<'_, Inner>> {
        locked(py, &self.inner)
    }

    fn grid(&self) -> &Grid {
        &self.setting.grid
    }

    pub(crate) fn history_now(&self, py: Python<'_>) -> Fallible<History> {
        let inner = self.lock(py)?;
        Ok(History { history: Arc::clone(&inner.history), setting: self.setting })
    }

    /// The state that is meant: the one given, or the last one.
    fn state_or_last(inner: &Inner, state: Option<PyRef<'_, State>>) -> Fallible<LoadingState> {
        match state {
            Some(state) => {
                check_on_path(&inner.history, &state.state)?;
                Ok(state.state)
            }
            None => inner.present().ok_or_else(|| {
                Error::OutOfRange {
                    quantity: "number of states so far",
                    value: 0.0,
                    expected: "at least 1: iterate the path or call run() first",
                }
                .into()
            }),
        }
    }

    /// Those that the half-space or the record of the path knows.
    pub(crate) fn elastic_bodies(&self, py: Python<'_>) -> Fallible<Vec<(f64, f64)>> {
        Ok(self.lock(py)?.bodies.clone())
    }

    /// Composite modulus, if it is known.
    pub(crate) fn modulus(&self) -> Option<f64> {
        self.e_star
    }

    /// What the engine computes, without the lock of the interpreter.
    pub(crate) fn computed<T: Send>(
        &self,
        py: Python<'_>,
        compute: impl FnOnce(&mut Engine) -> Result<T, Error> + Send,
    ) -> Fallible<T> {
        let mut inner = self.lock(py)?;
        let engine = inner.engine_mut();
        Ok(detached(py, || compute(engine))??)
    }

    /// What the engine computes of many of the states so far: Ctrl-C ends the wait, and the path is free again when
    /// what is under way is done.
    pub(crate) fn interruptible<T: Send + 'static>(
        &self,
        py: Python<'_>,
        compute: impl FnOnce(&mut Engine, &loading::History) -> Result<T, Error> + Send + 'static,
    ) -> Fallible<T> {
        Ok(interruptible_with(py, &self.inner, |inner| {
            let history = Arc::clone(&inner.history);
            compute(inner.engine_mut(), &history)
        })??)
    }

    /// The same with the record of the states so far.
    pub(crate) fn with_record<T: Send + 'static>(
        &self,
        py: Python<'_>,
        compute: impl FnOnce(&mut Engine, &LoadingRecord) -> Result<T, Error> + Send + 'static,
    ) -> Fallible<T> {
        Ok(interruptible_with(py, &self.inner, |inner| {
            let record = inner.record()?;
            compute(inner.engine_mut(), &record)
        })??)
    }

    /// What the engine computes at a state, without the lock of the interpreter.
    pub(crate) fn at<T: Send>(
        &self,
        py: Python<'_>,
        state: Option<PyRef<'_, State>>,
        compute: impl FnOnce(&mut Engine, &LoadingState) -> Result<T, Error> + Send,
    ) -> Fallible<T> {
        let mut inner = self.lock(py)?;
        let state = Self::state_or_last(&inner, state)?;
        let engine = inner.engine_mut();
        Ok(detached(py, || compute(engine, &state))??)
    }

    /// A field of a state.
    fn field<'py, T: Element + asperity::nalgebra::Scalar + Send>(
        &self,
        py: Python<'py>,
        state: Option<PyRef<'_, State>>,
        compute: impl FnOnce(&mut Engine, &LoadingState) -> Result<DMatrix<T>, Error> + Send,
    ) -> Fallible<Bound<'py, PyArray2<T>>> {
        rows(py, self.at(py, state, compute)?)
    }

    /// Why the path has ended, in a word.
    fn end_in_words(end: LoadingEnd) -> &'static str {
        match end {
            LoadingEnd::FullContact => "full contact",
            LoadingEnd::FullyPlastic => "fully plastic",
            LoadingEnd::Load => "load",
            LoadingEnd::Approach => "approach",
            LoadingEnd::MeanGap => "mean gap",
            LoadingEnd::AreaFraction => "area fraction",
            LoadingEnd::Nodes => "nodes",
            LoadingEnd::Memory => "memory",
            LoadingEnd::NoMoreEvents => "no more events",
            _ => "failed",
        }
    }

    /// What looks wrong with the last state.
    fn warnings(&self, py: Python<'_>) -> Fallible<Vec<Warning>> {
        let mut inner = self.lock(py)?;
        let Some(state) = inner.present() else {
            return Ok(Vec::new());
        };
        let Setting { grid, boundary, has_hardness } = self.setting;
        let e_star = self.e_star.filter(|_| !has_hardness);
        let engine = inner.engine_mut();
        let warnings = detached(py, move || {
            let fields = engine.fields_at(&state)?;
            of_contact(&fields.pressure, &fields.contact_map, (&grid, boundary), e_star)
        });
        Ok(warnings??)
    }
}

#[pymethods]
impl LoadingPath {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&self, py: Python<'_>) -> Fallible<Option<State>> {
        let mut inner = self.lock(py)?;
        let state = if inner.waiting() > 0 {
            inner.next()?
        } else {
            let inner = &mut *inner;
            detached(py, || inner.next())??
        };
        Ok(state.map(State::new))
    }

    /// Compute the rest of the path.
    ///
    /// Parameters
    /// ----------
    /// progress : bool or callable, optional
    ///     True shows a bar, by tqdm if that is installed. A function is called some times a second with the part of the
    ///     path that is done, 0 to 1, and the last `State`.
    /// check : bool
    ///     Warn if the greatest pressure at the end is more than solids bear elastically or is made by the edge of the surface, if
    ///     the grid does not resolve the patches of contact, and if the path ends before there is a load.
    ///
    /// Returns
    /// -------
    /// History
    ///     All states of the path from first touch on.
    ///
    /// Raises
    /// ------
    /// AsperityError
    ///     The states up to there are in `history`.
    /// KeyboardInterrupt
    ///     After Ctrl-C; call `run` again to go on.
    #[pyo3(signature = (*, progress=None, check=true))]
    fn run(
        &self,
        py: Python<'_>,
        progress: Option<&Bound<'_, PyAny>>,
        check: bool,
    ) -> Fallible<History> {
        let bar = Progress::new(py, progress)?;
        let result = (|| loop {
            let (goes_on, done, state) = {
                let mut inner = self.lock(py)?;
                let inner = &mut *inner;
                let goes_on = detached(py, || inner.run_for(STRETCH))??;
                (goes_on, inner.done(), inner.present())
            };
            py.check_signals()?;
            bar.show(done, state)?;
            if !goes_on {
                return Ok::<_, Failure>(());
            }
        })();
        bar.close()?;
        result?;
        if check {
            warn_all(py, self.warnings(py)?)?;
        }
        self.history_now(py)
    }

    /// Go on to a target beyond the end of the path: all limits before are forgotten, and `run` or the iterator goes on.
    ///
    /// Parameters
    /// ----------
    /// load, mean_pressure, approach, area_fraction, mean_gap : float
    ///     One of them [N, Pa, m, -, m].
    #[pyo3(signature = (*, load=None, mean_pressure=None, approach=None, area_fraction=None, mean_gap=None))]
    fn continue_to(
        &self,
        py: Python<'_>,
        load: Option<f64>,
        mean_pressure: Option<f64>,
        approach: Option<f64>,
        area_fraction: Option<f64>,
        mean_gap: Option<f64>,
    ) -> Fallible<()> {
        let targets = Targets { load, mean_pressure, approach, area_fraction, mean_gap };
        let target = targets.only()?;
        let mut inner = self.lock(py)?;
        let inner = &mut *inner;
        Ok(detached(py, || inner.continue_to(target))??)
    }

    /// All states so far.
    #[getter]
    fn history(&self, py: Python<'_>) -> Fallible<History> {
        self.history_now(py)
    }

    /// The last state so far, None before the first.
    #[getter]
    fn state(&self, py: Python<'_>) -> Fallible<Option<State>> {
        Ok(self.lock(py)?.present().map(State::new))
    }

    /// Why the path has ended, None while there is more to come: ``"load"``, ``"approach"``, ``"mean gap"``,
    /// ``"area fraction"``, ``"nodes"``, ``"full contact"``, ``"fully plastic"``, ``"memory"``, ``"no more events"`` or
    /// ``"failed"``.
    #[getter]
    fn end(&self, py: Python<'_>) -> Fallible<Option<&'static str>> {
        Ok(self.lock(py)?.end().map(Self::end_in_words))
    }

    /// Where the path is to end, by name.
    #[getter]
    fn targets<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyDict>> {
        let targets = PyDict::new(py);
        let all = self.lock(py)?.targets();
        for (name, value) in all.into_iter().map(named) {
            targets.set_item(name, value)?;
        }
        Ok(targets)
    }

    /// Rows and columns of the surface.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        shape(self.grid())
    }

    /// Sides ``(x, y)`` of the surface [m].
    #[getter]
    fn size(&self) -> (f64, f64) {
        self.grid().sides()
    }

    /// Composite modulus [Pa]; None for a body of one's own without one.
    #[getter]
    fn e_star(&self) -> Option<f64> {
        self.e_star
    }

    /// Young's modulus [Pa] and Poisson's ratio of each elastic body, if the half-space or the record of the path knows them: of one if
    /// the other is rigid.
    #[getter]
    fn bodies(&self, py: Python<'_>) -> Fallible<Vec<(f64, f64)>> {
        self.elastic_bodies(py)
    }

    /// Whether the half-space repeats with the sides of the surface, or ``"x"`` or ``"y"`` if it does along one: what
    /// functions of maps take as ``periodic``.
    #[getter]
    fn periodic(&self) -> Repeats {
        Repeats::of(self.setting.boundary)
    }

    /// The surface, with heights [m] from its highest node.
    #[getter]
    fn surface(&self, py: Python<'_>) -> Fallible<Surface> {
        let inner = self.lock(py)?;
        let gaps = inner.engine().problem().initial_gap().iter().map(|gap| -gap);
        let (nx, ny) = self.grid().shape();
        Ok(Surface::new(*self.grid(), DMatrix::from_iterator(nx, ny, gaps))?)
    }

    /// Hardness of each node [Pa], ``[row, column]``; None without one.
    #[getter]
    fn hardness<'py>(&self, py: Python<'py>) -> Fallible<Option<Bound<'py, PyArray2<f64>>>> {
        let map = self.lock(py)?.engine().hardness_map();
        map.map(|map| rows(py, map)).transpose()
    }

    /// Number of nodes in contact when the factor was given up for iterations, None while it is in use.
    #[getter]
    fn handed_over_at(&self, py: Python<'_>) -> Fallible<Option<usize>> {
        Ok(self.lock(py)?.engine().handed_over_at())
    }

    /// Bytes that the engine holds for the path.
    #[getter]
    fn nbytes(&self, py: Python<'_>) -> Fallible<usize> {
        Ok(self.lock(py)?.engine().bytes())
    }

    /// Pressure [Pa] at a state.
    ///
    /// Parameters
    /// ----------
    /// state : State, optional
    ///     One of this path so far, or one that `History.at` has read from it; the last one if not given.
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    #[pyo3(signature = (state=None))]
    fn pressure<'py>(
        &self,
        py: Python<'py>,
        state: Option<PyRef<'_, State>>,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        self.field(py, state, |engine, state| engine.fields_at(state).map(|fields| fields.pressure))
    }

    /// Gap [m] at a state: zero in contact, to rounding.
    ///
    /// Parameters
    /// ----------
    /// state : State, optional
    ///     As of `pressure`.
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    #[pyo3(signature = (state=None))]
    fn gap<'py>(
        &self,
        py: Python<'py>,
        state: Option<PyRef<'_, State>>,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        self.field(py, state, |engine, state| engine.fields_at(state).map(|fields| fields.gap))
    }

    /// Displacement of the half-space [m] at a state, positive into it; about its mean on a periodic half-space.
    ///
    /// Parameters
    /// ----------
    /// state : State, optional
    ///     As of `pressure`.
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    #[pyo3(signature = (state=None))]
    fn displacement<'py>(
        &self,
        py: Python<'py>,
        state: Option<PyRef<'_, State>>,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        self.field(py, state, |engine, state| {
            engine.fields_at(state).map(|fields| fields.displacement)
        })
    }

    /// Which nodes are in contact at a state.
    ///
    /// Parameters
    /// ----------
    /// state : State, optional
    ///     As of `pressure`.
    ///
    /// Returns
    /// -------
    /// ndarray of bool, [row, column]
    #[pyo3(signature = (state=None))]
    fn contact_map<'py>(
        &self,
        py: Python<'py>,
        state: Option<PyRef<'_, State>>,
    ) -> Fallible<Bound<'py, PyArray2<bool>>> {
        self.field(py, state, |engine, state| engine.contact_map_at(state))
    }

    /// Which nodes have yielded at a state: none without a hardness.
    ///
    /// Parameters
    /// ----------
    /// state : State, optional
    ///     As of `pressure`.
    ///
    /// Returns
    /// -------
    /// ndarray of bool, [row, column]
    #[pyo3(signature = (state=None))]
    fn yielded_map<'py>(
        &self,
        py: Python<'py>,
        state: Option<PyRef<'_, State>>,
    ) -> Fallible<Bound<'py, PyArray2<bool>>> {
        self.field(py, state, |engine, state| engine.yielded_map_at(state))
    }

    /// Plastic depth [m] at a state: by how much yielded nodes would overlap, 0 elsewhere.
    ///
    /// Parameters
    /// ----------
    /// state : State, optional
    ///     As of `pressure`.
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    #[pyo3(signature = (state=None))]
    fn plastic_depth<'py>(
        &self,
        py: Python<'py>,
        state: Option<PyRef<'_, State>>,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        self.field(py, state, |engine, state| {
            engine.fields_at(state).map(|fields| fields.plastic_depth)
        })
    }

    /// The surface with the plastic depth of a state taken off: that of elastic unloading from there.
    ///
    /// Parameters
    /// ----------
    /// state : State, optional
    ///     As of `pressure`.
    ///
    /// Returns
    /// -------
    /// Surface
    #[pyo3(signature = (state=None))]
    fn residual_surface(
        &self,
        py: Python<'_>,
        state: Option<PyRef<'_, State>>,
    ) -> Fallible<Surface> {
        let map = self.at(py, state, |engine, state| engine.residual_surface_at(state))?;
        Ok(Surface::new(*self.grid(), map.into_matrix())?)
    }

    /// Unload from the last state, elastically: what yielded stays. The updater and the memory budget are those of the path.
    ///
    /// Returns
    /// -------
    /// Unloading
    ///     States, energies, and the surface that is left.
    fn unload(slf: &Bound<'_, Self>) -> Fallible<unloading::Unloading> {
        unloading::unload(slf)
    }

    /// How well a state fulfils the conditions of contact, computed afresh from its pressure.
    ///
    /// Parameters
    /// ----------
    /// state : State, optional
    ///     As of `pressure`.
    ///
    /// Returns
    /// -------
    /// results.Certificate
    ///     Relative to the mean pressure on the contact, the load and a length; zero would be exact.
    #[pyo3(signature = (state=None))]
    fn certificate<'py>(
        &self,
        py: Python<'py>,
        state: Option<PyRef<'_, State>>,
    ) -> Fallible<Bound<'py, PyAny>> {
        let certificate = self.at(py, state, |engine, state| engine.certificate_at(state))?;
        of_certificate(py, &certificate)
    }

    /// The narrowest place of the widest channel that leads along an axis through the nodes out of contact.
    ///
    /// Parameters
    /// ----------
    /// axis : {"x", "y"}
    /// state : State, optional
    ///     As of `pressure`.
    ///
    /// Returns
    /// -------
    /// results.Constriction or None
    ///     None if no channel leads all the way.
    #[pyo3(signature = (axis, state=None))]
    fn constriction<'py>(
        &self,
        py: Python<'py>,
        axis: &str,
        state: Option<PyRef<'_, State>>,
    ) -> Fallible<Option<Bound<'py, PyAny>>> {
        let axis = choice::axis(axis)?;
        let Setting { grid, boundary, .. } = self.setting;
        let found = self.at(py, state, |engine, state| {
            let fields = engine.fields_at(state)?;
            constriction(&fields.gap, &fields.contact_map, (&grid, boundary), axis)
        })?;
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

    /// Nodes in contact at the last state, in the order in which they touched.
    ///
    /// Returns
    /// -------
    /// (ndarray of int, ndarray of int)
    ///     Rows and columns.
    #[allow(clippy::type_complexity)] // two arrays
    fn contact_order<'py>(
        &self,
        py: Python<'py>,
    ) -> Fallible<(Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<i64>>)> {
        let order = self.lock(py)?.record()?.contact()?;
        let nodes = order.order().iter().map(|node| self.grid().coordinates(*node));
        let (columns, rows) = nodes.map(|(ix, iy)| (ix as i64, iy as i64)).unzip();
        Ok((column(py, rows), column(py, columns)))
    }

    /// Write the record of the path so far, which `open` and the program read, and `numpy.load` opens.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     A ``.npz`` file. It has this name only when it is whole.
    /// fields : bool
    ///     Whether pressure and gap of the last state go into it, and the plastic depth.
    #[pyo3(signature = (path, *, fields=false))]
    fn save(&self, py: Python<'_>, path: PathBuf, fields: bool) -> Fallible<()> {
        let mut inner = self.lock(py)?;
        let inner = &mut *inner;
        let has_hardness = self.setting.has_hardness;
        Ok(detached(py, move || {
            let record = inner.record()?;
            let mut written = Vec::new();
            if let (true, Some(state)) = (fields, inner.present()) {
                let fields = inner.engine_mut().fields_at(&state)?;
                written.extend([("pressure", fields.pressure), ("gap", fields.gap)]);
                if has_hardness {
                    written.push(("plastic_depth", fields.plastic_depth));
                }
            }
            let written: Vec<_> = written.iter().map(|(name, field)| (*name, field)).collect();
            record.write_npz(path, &written)
        })??)
    }

    fn __repr__(&self, py: Python<'_>) -> Fallible<String> {
        let inner = self.lock(py)?;
        let (rows, columns) = self.shape();
        let states = inner.history.states().len();
        let end = inner.end().map_or("more to come", Self::end_in_words);
        Ok(format!(
            "<LoadingPath: {states} states on {rows} x {columns} rows and columns; end: {end}>"
        ))
    }
}

/// A certificate as a result.
pub(crate) fn of_certificate<'py>(
    py: Python<'py>,
    certificate: &Certificate,
) -> Fallible<Bound<'py, PyAny>> {
    result!(py, "Certificate", {
        least_pressure: certificate.least_pressure,
        least_gap: certificate.least_gap,
        greatest_contact_gap: certificate.greatest_contact_gap,
        complementarity: certificate.complementarity,
        load_error: certificate.load_error,
        excess_pressure: certificate.excess_pressure,
        length: certificate.length,
    })
}

/// Who is told how far a path is.
struct Progress<'py> {
    told: Option<Bound<'py, PyAny>>,
    /// Whether it is a bar of this package, which is to be closed.
    is_bar: bool,
}

impl<'py> Progress<'py> {
    fn new(py: Python<'py>, asked: Option<&Bound<'py, PyAny>>) -> Fallible<Self> {
        let nobody = Self { told: None, is_bar: false };
        match asked {
            Some(asked) if asked.is_callable() => {
                Ok(Self { told: Some(asked.clone()), is_bar: false })
            }
            Some(asked) if asked.is_truthy()? => {
                let bar = py.import("asperity._progress")?.getattr("Bar")?.call0()?;
                Ok(Self { told: Some(bar), is_bar: true })
            }
            _ => Ok(nobody),
        }
    }

    fn show(&self, done: f64, state: Option<LoadingState>) -> Fallible<()> {
        if let (Some(told), Some(state)) = (&self.told, state) {
            told.call1((done, State::new(state)))?;
        }
        Ok(())
    }

    fn close(&self) -> Fallible<()> {
        if let (Some(told), true) = (&self.told, self.is_bar) {
            told.call_method0("close")?;
        }
        Ok(())
    }
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<LoadingPath>()?;
    unloading::register(module)
}
