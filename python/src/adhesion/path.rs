//! The path of surfaces that stick.

use std::path::PathBuf;
use std::task::Poll;
use std::time::{Duration, Instant};

use asperity::adhesion as engine;
use asperity::adhesion::{AdhesiveEnd, AdhesiveFields, NodeState};
use asperity::nalgebra::DMatrix;
use asperity::record::AdhesiveRecord;
use asperity::{ContactTarget, Error, Grid, Warning};
use numpy::PyArray2;
use parking_lot::{Mutex, MutexGuard};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::branch::{AdhesiveBranch, AdhesiveState};
use crate::arrays::{rows, shape};
use crate::compute::{detached, locked};
use crate::errors::{Failure, Fallible};
use crate::surface::Surface;
use crate::targets::Targets;
use crate::warnings::warn_all;

/// How long a path runs between two looks at signals.
const STRETCH: Duration = Duration::from_millis(50);

/// A path with its states on all branches.
struct Inner {
    path: engine::AdhesivePath,
    states: engine::AdhesiveBranch,
}

impl Inner {
    /// The next state of the branch, if it comes until then.
    fn next(&mut self, end: Instant) -> Result<Poll<Option<engine::AdhesiveState>>, Error> {
        while !self.path.prepare()? {
            if Instant::now() >= end {
                return Ok(Poll::Pending);
            }
        }
        let state = self.path.next().transpose()?;
        self.states.extend(state);
        Ok(Poll::Ready(state))
    }

    /// States for so long; whether there are more.
    fn run_for(&mut self, time: Duration) -> Result<bool, Error> {
        let end = Instant::now() + time;
        while self.next(end)? != Poll::Ready(None) {
            if Instant::now() >= end {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// The path of a rough surface that sticks, event by event on both branches: made by `load_path` with `adhesion`, or by
/// `open`.
///
/// An iterator of `AdhesiveState`, up to the end of the branch. `run` computes the rest of it at once, and `unload` the way
/// back; `states` holds all states so far.
///
/// Notes
/// -----
/// What follows from contact that only grows (`patches`, `shear`, `creep`, `Seal`, `stress`, `report`) takes no such path.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct AdhesivePath {
    inner: Mutex<Inner>,
    grid: Grid,
    e_star: Option<f64>,
}

impl AdhesivePath {
    pub(crate) fn new(
        path: engine::AdhesivePath,
        states: engine::AdhesiveBranch,
        e_star: Option<f64>,
    ) -> Self {
        let grid = path.grid();
        Self { inner: Mutex::new(Inner { path, states }), grid, e_star }
    }

    fn lock(&self, py: Python<'_>) -> Fallible<MutexGuard<'_, Inner>> {
        locked(py, &self.inner)
    }

    /// The rest of the branch: its states from here on.
    fn rest(&self, py: Python<'_>) -> Fallible<AdhesiveBranch> {
        let begin = self.lock(py)?.states.states().len();
        loop {
            let goes_on = {
                let mut inner = self.lock(py)?;
                let inner = &mut *inner;
                detached(py, || inner.run_for(STRETCH))??
            };
            py.check_signals()?;
            if !goes_on {
                let inner = self.lock(py)?;
                let branch = inner.states.states()[begin..].iter().copied().collect();
                return Ok(AdhesiveBranch { branch });
            }
        }
    }

    fn turned(
        &self,
        py: Python<'_>,
        turn: impl FnOnce(&mut engine::AdhesivePath) -> Result<(), Error> + Send,
    ) -> Fallible<AdhesiveBranch> {
        {
            let mut inner = self.lock(py)?;
            let path = &mut inner.path;
            detached(py, || turn(path))??;
        }
        self.rest(py)
    }

    fn fields(
        &self,
        py: Python<'_>,
        state: Option<PyRef<'_, AdhesiveState>>,
    ) -> Fallible<AdhesiveFields> {
        let inner = self.lock(py)?;
        let state = state.map(|state| state.state).or_else(|| inner.path.state());
        let state = state.ok_or_else(|| {
            Failure::arguments("there are no states: iterate the path or call run() first")
        })?;
        let path = &inner.path;
        Ok(detached(py, || path.fields_at(&state))??)
    }

    fn map<'py>(
        &self,
        py: Python<'py>,
        state: Option<PyRef<'_, AdhesiveState>>,
        is: impl Fn(NodeState) -> bool,
    ) -> Fallible<Bound<'py, PyArray2<bool>>> {
        let nodes = self.fields(py, state)?.nodes;
        rows(py, nodes.map(is))
    }
}

#[pymethods]
impl AdhesivePath {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&self, py: Python<'_>) -> Fallible<Option<AdhesiveState>> {
        loop {
            let next = {
                let mut inner = self.lock(py)?;
                let inner = &mut *inner;
                detached(py, || inner.next(Instant::now() + STRETCH))??
            };
            if let Poll::Ready(state) = next {
                return Ok(state.map(|state| AdhesiveState { state }));
            }
            py.check_signals()?;
        }
    }

    /// Compute the rest of the branch.
    ///
    /// Returns
    /// -------
    /// AdhesiveBranch
    ///     Its states from the present one on.
    ///
    /// Raises
    /// ------
    /// AsperityError
    ///     The states up to there are in `states`.
    /// KeyboardInterrupt
    ///     After Ctrl-C; call `run` again to go on.
    fn run(&self, py: Python<'_>) -> Fallible<AdhesiveBranch> {
        self.rest(py)
    }

    /// Pull off from the present state, until no node is pulled any more, or to a target.
    ///
    /// Parameters
    /// ----------
    /// load, mean_pressure, approach, area_fraction, mean_gap : float, optional
    ///     One of them [N, Pa, m, -, m]; load, mean pressure and approach may be negative.
    ///
    /// Returns
    /// -------
    /// AdhesiveBranch
    ///     With `pull_off`, the force that it takes.
    #[pyo3(signature = (*, load=None, mean_pressure=None, approach=None, area_fraction=None, mean_gap=None))]
    fn unload(
        &self,
        py: Python<'_>,
        load: Option<f64>,
        mean_pressure: Option<f64>,
        approach: Option<f64>,
        area_fraction: Option<f64>,
        mean_gap: Option<f64>,
    ) -> Fallible<AdhesiveBranch> {
        let targets = Targets { load, mean_pressure, approach, area_fraction, mean_gap };
        if targets.all()?.is_empty() {
            return self.turned(py, engine::AdhesivePath::unload);
        }
        let target = targets.only()?;
        self.turned(py, |path| path.unload_to(target))
    }

    /// Press on from the present state, wherever that is, to a target.
    ///
    /// Parameters
    /// ----------
    /// load, mean_pressure, approach, area_fraction, mean_gap : float, optional
    ///     One of them [N, Pa, m, -, m]; load, mean pressure and approach may be negative.
    ///
    /// Returns
    /// -------
    /// AdhesiveBranch
    #[pyo3(signature = (*, load=None, mean_pressure=None, approach=None, area_fraction=None, mean_gap=None))]
    fn load_to(
        &self,
        py: Python<'_>,
        load: Option<f64>,
        mean_pressure: Option<f64>,
        approach: Option<f64>,
        area_fraction: Option<f64>,
        mean_gap: Option<f64>,
    ) -> Fallible<AdhesiveBranch> {
        let targets = Targets { load, mean_pressure, approach, area_fraction, mean_gap };
        let target = targets.only()?;
        self.turned(py, |path| path.load_to(target))
    }

    /// All states so far, on all branches.
    #[getter]
    fn states(&self, py: Python<'_>) -> Fallible<AdhesiveBranch> {
        Ok(AdhesiveBranch { branch: self.lock(py)?.states.clone() })
    }

    /// The last state so far, None before the first.
    #[getter]
    fn state(&self, py: Python<'_>) -> Fallible<Option<AdhesiveState>> {
        Ok(self.lock(py)?.path.state().map(|state| AdhesiveState { state }))
    }

    /// Why the branch has ended, None while there is more to come: ``"target"``, ``"no more events"`` or ``"failed"``.
    #[getter]
    fn end(&self, py: Python<'_>) -> Fallible<Option<&'static str>> {
        Ok(self.lock(py)?.path.end().map(|end| match end {
            AdhesiveEnd::Target => "target",
            AdhesiveEnd::NoMoreEvents => "no more events",
            _ => "failed",
        }))
    }

    /// The law on these cells: ``work`` [J/m²], ``stress`` [Pa], ``flat_range`` and ``range`` [m], and ``resolution``, the slope
    /// times the compliance of a cell.
    #[getter]
    fn law<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyDict>> {
        let law = self.lock(py)?.path.law();
        let numbers = [
            ("work", law.work()),
            ("stress", law.stress()),
            ("flat_range", law.flat_range()),
            ("range", law.range()),
            ("resolution", law.resolution()),
        ];
        let named = PyDict::new(py);
        for (name, number) in numbers {
            named.set_item(name, number)?;
        }
        Ok(named)
    }

    /// Rows and columns of the surface.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        shape(&self.grid)
    }

    /// Sides ``(x, y)`` of the surface [m].
    #[getter]
    fn size(&self) -> (f64, f64) {
        self.grid.sides()
    }

    /// Composite modulus [Pa]; None for a body of one's own without one.
    #[getter]
    fn e_star(&self) -> Option<f64> {
        self.e_star
    }

    /// The surface, with heights [m] from its highest node.
    #[getter]
    fn surface(&self, py: Python<'_>) -> Fallible<Surface> {
        let inner = self.lock(py)?;
        let heights = inner.path.problem().initial_gap().iter().map(|gap| -gap);
        let (nx, ny) = self.grid.shape();
        Ok(Surface::new(self.grid, DMatrix::from_iterator(nx, ny, heights))?)
    }

    /// Pressure [Pa] at a state, negative where the surfaces are pulled.
    ///
    /// Parameters
    /// ----------
    /// state : AdhesiveState, optional
    ///     One of this path so far; the last one if not given.
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    #[pyo3(signature = (state=None))]
    fn pressure<'py>(
        &self,
        py: Python<'py>,
        state: Option<PyRef<'_, AdhesiveState>>,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        rows(py, self.fields(py, state)?.pressure)
    }

    /// Gap [m] at a state.
    ///
    /// Parameters
    /// ----------
    /// state : AdhesiveState, optional
    ///     As of `pressure`.
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    #[pyo3(signature = (state=None))]
    fn gap<'py>(
        &self,
        py: Python<'py>,
        state: Option<PyRef<'_, AdhesiveState>>,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        rows(py, self.fields(py, state)?.gap)
    }

    /// Which nodes are in contact at a state: those whose gap is 0.
    ///
    /// Parameters
    /// ----------
    /// state : AdhesiveState, optional
    ///     As of `pressure`.
    ///
    /// Returns
    /// -------
    /// ndarray of bool, [row, column]
    #[pyo3(signature = (state=None))]
    fn contact_map<'py>(
        &self,
        py: Python<'py>,
        state: Option<PyRef<'_, AdhesiveState>>,
    ) -> Fallible<Bound<'py, PyArray2<bool>>> {
        self.map(py, state, |node| node == NodeState::Contact)
    }

    /// Which nodes are pulled across a gap at a state.
    ///
    /// Parameters
    /// ----------
    /// state : AdhesiveState, optional
    ///     As of `pressure`.
    ///
    /// Returns
    /// -------
    /// ndarray of bool, [row, column]
    #[pyo3(signature = (state=None))]
    fn pulled_map<'py>(
        &self,
        py: Python<'py>,
        state: Option<PyRef<'_, AdhesiveState>>,
    ) -> Fallible<Bound<'py, PyArray2<bool>>> {
        self.map(py, state, |node| matches!(node, NodeState::Soft | NodeState::Cohesive))
    }

    /// Write the record of all branches so far, which `open` reads, and `numpy.load` opens.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     A ``.npz`` file. It has this name only when it is whole.
    fn save(&self, py: Python<'_>, path: PathBuf) -> Fallible<()> {
        let inner = self.lock(py)?;
        let inner = &*inner;
        Ok(detached(py, || {
            AdhesiveRecord::new(&inner.path, inner.states.clone())?.write_npz(path, &[])
        })??)
    }

    fn __repr__(&self, py: Python<'_>) -> Fallible<String> {
        let inner = self.lock(py)?;
        let (rows, columns) = shape(&self.grid);
        let states = inner.states.states().len();
        Ok(format!("<AdhesivePath: {states} states on {rows} x {columns} rows and columns>"))
    }
}

/// Sets up a path, and warns of what looks wrong with its law.
pub(crate) fn set_up(
    py: Python<'_>,
    surface: &Surface,
    (kernel, law): (&(dyn asperity::InfluenceKernel + Send + Sync), engine::Adhesion),
    (targets, window_size, memory_budget): (Vec<ContactTarget>, Option<usize>, Option<usize>),
    (e_star, check): (Option<f64>, bool),
) -> Fallible<AdhesivePath> {
    let topography = surface.topography()?;
    let path = detached(py, move || {
        let mut builder = engine::AdhesivePath::builder(topography, kernel, law);
        for target in targets {
            builder = builder.until(target);
        }
        if let Some(size) = window_size {
            builder = builder.window_size(size);
        }
        if let Some(bytes) = memory_budget {
            builder = builder.memory_budget(bytes);
        }
        builder.build()
    })??;
    if let (true, Some(e_star)) = (check, e_star) {
        warn_all(py, Warning::of_adhesion(topography, &path.law(), e_star))?;
    }
    Ok(AdhesivePath::new(path, engine::AdhesiveBranch::default(), e_star))
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<AdhesivePath>()
}
