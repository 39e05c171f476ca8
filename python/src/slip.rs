//! Partial slip of a contact under a tangential load.

use std::sync::Arc;

use asperity::bed::Bed;
use asperity::nalgebra::DMatrix;
use asperity::slip::{Friction, PartialSlip as Joint, SlipCycle, SlipHistory, SlipState, SlipZone};
use asperity::{Error, loading};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Found, Kind, column, rows};
use crate::compute::detached;
use crate::errors::{Failure, Fallible};
use crate::history::History;
use crate::materials::Body;
use crate::path::{Engine, LoadingPath};
use crate::warnings::warn;

/// A contact under a load that a tangential load shears: made by `slip`.
///
/// Friction of Coulomb, and bodies that yield tangentially in proportion to what they do normally. Everything follows from
/// the states of the path; traction, slip and friction work take some of its fields.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct PartialSlip {
    history: Arc<loading::History>,
    path: Option<Py<LoadingPath>>,
    friction: Friction,
    load: f64,
    sliding: (f64, f64),
}

/// One number or several.
fn numbers(value: &Bound<'_, PyAny>, name: &'static str) -> Fallible<Vec<f64>> {
    let found = Found::of(value, name, Kind::Real)?;
    if found.shape.is_empty() { found.list_of(1) } else { found.list() }
}

impl PartialSlip {
    /// What a joint answers, without the lock of the interpreter.
    fn ask<T: Send>(
        &self,
        py: Python<'_>,
        compute: impl FnOnce(&Joint<'_>) -> Result<T, Error> + Send,
    ) -> Fallible<T> {
        Ok(detached(py, || {
            let bed = Bed::new(&self.history)?;
            compute(&Joint::new(&bed, self.load, self.friction)?)
        })??)
    }

    /// A field, which takes the path.
    fn field<T: Send>(
        &self,
        py: Python<'_>,
        compute: impl FnOnce(&Joint<'_>, &mut dyn Engine) -> Result<DMatrix<T>, Error> + Send,
    ) -> Fallible<DMatrix<T>> {
        let Some(path) = &self.path else {
            return Err(Failure::arguments("fields need a LoadingPath: a History has none"));
        };
        path.get().with_engine(py, |engine| {
            let bed = Bed::new(&self.history)?;
            compute(&Joint::new(&bed, self.load, self.friction)?, engine)
        })
    }
}

/// States as columns.
fn states<'py>(py: Python<'py>, states: &[SlipState]) -> Fallible<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    let reals = |get: fn(&SlipState) -> f64| column(py, states.iter().map(get).collect());
    let wholes = |get: fn(&SlipState) -> usize| {
        column(py, states.iter().map(|state| get(state) as i64).collect())
    };
    columns.set_item("load", reals(|s| s.load))?;
    columns.set_item("tangential_load", reals(|s| s.tangential_load))?;
    columns.set_item("displacement", reals(|s| s.displacement))?;
    columns.set_item("interfacial_displacement", reals(|s| s.interfacial_displacement))?;
    columns.set_item("stick_load", reals(|s| s.stick_load))?;
    columns.set_item("stick_nodes", wholes(|s| s.stick_nodes))?;
    columns.set_item("slipping_nodes", wholes(|s| s.slipping_nodes))?;
    columns.set_item("stick_area", reals(|s| s.stick_area))?;
    columns.set_item("slip_area", reals(|s| s.slip_area))?;
    columns.set_item("tangential_stiffness", reals(|s| s.tangential_stiffness))?;
    Ok(columns)
}

#[pymethods]
impl PartialSlip {
    /// Load that presses the contact [N].
    #[getter]
    fn load(&self) -> f64 {
        self.load
    }

    /// Coefficient of friction.
    #[getter]
    fn friction(&self) -> f64 {
        self.friction.coefficient()
    }

    /// Ratio of tangential to normal compliance of the bodies, E*/G*.
    #[getter]
    fn compliance_ratio(&self) -> f64 {
        self.friction.compliance_ratio()
    }

    /// Dundurs' beta of the bodies; None if they were not given.
    #[getter]
    fn dundurs_beta(&self) -> Option<f64> {
        self.friction.dundurs_beta()
    }

    /// Tangential load at which the joint slides [N].
    #[getter]
    fn sliding_load(&self) -> f64 {
        self.sliding.0
    }

    /// Displacement at which it begins to slide [m].
    #[getter]
    fn sliding_displacement(&self) -> f64 {
        self.sliding.1
    }

    /// States under tangential loads that have grown from zero.
    ///
    /// Parameters
    /// ----------
    /// tangential_load : float or array_like
    ///     Of either sign [N], in one dimension.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     ``load``, ``tangential_load``, ``stick_load`` [N], ``displacement``, ``interfacial_displacement`` [m],
    ///     ``stick_nodes``, ``slipping_nodes``, ``stick_area``, ``slip_area`` [m²], ``tangential_stiffness`` [N/m].
    fn monotone<'py>(
        &self,
        py: Python<'py>,
        tangential_load: &Bound<'py, PyAny>,
    ) -> Fallible<Bound<'py, PyDict>> {
        let loads = numbers(tangential_load, "tangential_load")?;
        let found = self.ask(py, |joint| {
            loads.iter().map(|&load| joint.monotone(load)).collect::<Result<Vec<_>, _>>()
        })?;
        states(py, &found)
    }

    /// Steady cycles between opposite tangential loads, or between opposite displacements.
    ///
    /// Parameters
    /// ----------
    /// amplitude : float or array_like, optional
    ///     Amplitudes of the tangential load [N], in one dimension.
    /// displacement : float or array_like, optional
    ///     Amplitudes of the displacement [m] in place of it; the joint may slide.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     ``amplitude``, ``stick_load`` [N], ``displacement``, ``interfacial_displacement`` [m], ``dissipation`` [J],
    ///     ``secant_stiffness`` [N/m], ``loss_factor``, ``slipping_nodes``: where these are fewer than 50 the dissipation
    ///     depends on the grid.
    #[pyo3(signature = (amplitude=None, *, displacement=None))]
    fn cycle<'py>(
        &self,
        py: Python<'py>,
        amplitude: Option<&Bound<'py, PyAny>>,
        displacement: Option<&Bound<'py, PyAny>>,
    ) -> Fallible<Bound<'py, PyDict>> {
        let (values, is_load) = match (amplitude, displacement) {
            (Some(amplitude), None) => (numbers(amplitude, "amplitude")?, true),
            (None, Some(displacement)) => (numbers(displacement, "displacement")?, false),
            _ => return Err(Failure::arguments("give one of amplitude and displacement")),
        };
        let cycles = self.ask(py, |joint| {
            let cycle = |&value: &f64| {
                if is_load { joint.cycle(value) } else { joint.cycle_of_displacement(value) }
            };
            values.iter().map(cycle).collect::<Result<Vec<_>, _>>()
        })?;
        let columns = PyDict::new(py);
        let reals = |get: fn(&SlipCycle) -> f64| column(py, cycles.iter().map(get).collect());
        columns.set_item("amplitude", reals(|c| c.amplitude))?;
        columns.set_item("displacement", reals(|c| c.displacement))?;
        columns.set_item("interfacial_displacement", reals(|c| c.interfacial_displacement))?;
        columns.set_item("dissipation", reals(|c| c.dissipation))?;
        columns.set_item("secant_stiffness", reals(|c| c.secant_stiffness))?;
        columns.set_item("loss_factor", reals(|c| c.loss_factor))?;
        columns.set_item("stick_load", reals(|c| c.stick_load))?;
        let nodes = cycles.iter().map(|c| c.slipping_nodes as i64).collect();
        columns.set_item("slipping_nodes", column::<i64>(py, nodes))?;
        Ok(columns)
    }

    /// Any history of both loads, from no load on, along straight lines between its points.
    ///
    /// Parameters
    /// ----------
    /// load, tangential_load : array_like of float
    ///     Loads [N] at the points, in one dimension.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     As of `monotone`, at each point, and ``dissipation``: the energy lost up to there [J].
    fn history<'py>(
        &self,
        py: Python<'py>,
        load: &Bound<'py, PyAny>,
        tangential_load: &Bound<'py, PyAny>,
    ) -> Fallible<Bound<'py, PyDict>> {
        let loads = Found::of(load, "load", Kind::Real)?.list()?;
        let shears = Found::of(tangential_load, "tangential_load", Kind::Real)?.list()?;
        if loads.len() != shears.len() {
            let (expected, found) = (loads.len(), shears.len());
            return Err(Error::LengthMismatch { expected, found }.into());
        }
        let (found, lost): (Vec<SlipState>, Vec<f64>) = detached(py, || {
            let bed = Bed::new(&self.history)?;
            let mut joint = SlipHistory::new(&bed, self.friction);
            let steps = loads.iter().zip(&shears);
            let steps = steps.map(|(&p, &t)| Ok((joint.to(p, t)?, joint.dissipation())));
            steps.collect::<Result<Vec<_>, Error>>()
        })??
        .into_iter()
        .unzip();
        let columns = states(py, &found)?;
        columns.set_item("dissipation", column(py, lost))?;
        Ok(columns)
    }

    /// The joint as elements of a spring and a slider in series, one for each node in contact: the model of Iwan.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     ``stiffness`` [N/m], ``slip_displacement`` [m] and ``slip_force`` [N], in the order in which nodes have touched.
    fn elements<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyDict>> {
        let elements = self.ask(py, |joint| Ok(joint.jenkins_elements().collect::<Vec<_>>()))?;
        let columns = PyDict::new(py);
        let stiffness = elements.iter().map(|e| e.stiffness).collect();
        columns.set_item("stiffness", column::<f64>(py, stiffness))?;
        let displacement = elements.iter().map(|e| e.slip_displacement).collect();
        columns.set_item("slip_displacement", column::<f64>(py, displacement))?;
        let force = elements.iter().map(|e| e.slip_force()).collect();
        columns.set_item("slip_force", column::<f64>(py, force))?;
        Ok(columns)
    }

    /// Tangential traction [Pa] under a tangential load that has grown from zero.
    ///
    /// Parameters
    /// ----------
    /// tangential_load : float
    ///     [N]
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    fn traction<'py>(
        &self,
        py: Python<'py>,
        tangential_load: f64,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        rows(py, self.field(py, |joint, engine| engine.traction_of(joint, tangential_load))?)
    }

    /// Slip [m] of the nodes in contact, 0 where they stick: in a steady cycle the amplitude of their slip.
    ///
    /// Parameters
    /// ----------
    /// tangential_load : float
    ///     [N]
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    fn slip<'py>(
        &self,
        py: Python<'py>,
        tangential_load: f64,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        rows(py, self.field(py, |joint, engine| engine.slip_of(joint, tangential_load))?)
    }

    /// Which nodes are open (0), stick (1) and slip (2).
    ///
    /// Parameters
    /// ----------
    /// tangential_load : float
    ///     [N]
    ///
    /// Returns
    /// -------
    /// ndarray of int8, [row, column]
    fn stick_map<'py>(
        &self,
        py: Python<'py>,
        tangential_load: f64,
    ) -> Fallible<Bound<'py, PyArray2<i8>>> {
        let zones = self.field(py, |joint, engine| engine.zones_of(joint, tangential_load))?;
        rows(
            py,
            zones.map(|zone| match zone {
                SlipZone::Stick => 1_i8,
                SlipZone::Slip => 2,
                _ => 0,
            }),
        )
    }

    /// Work of friction of each node in a steady cycle [J/m²]: a map of wear.
    ///
    /// Parameters
    /// ----------
    /// amplitude : float
    ///     Of the tangential load [N].
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    ///     Times the area of a cell it sums to the dissipation of the cycle.
    fn wear_map<'py>(
        &self,
        py: Python<'py>,
        amplitude: f64,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        rows(py, self.field(py, |joint, engine| engine.friction_work_of(joint, amplitude))?)
    }

    fn __repr__(&self) -> String {
        let (mu, limit) = (self.friction.coefficient(), self.sliding.0);
        format!("<PartialSlip: {:e} N, friction {mu}; slides at {limit:e} N>", self.load)
    }
}

/// Friction of a coefficient between bodies, or with a ratio of compliances.
fn friction_of(
    coefficient: f64,
    ratio: Option<f64>,
    bodies: Option<(Body, Option<Body>)>,
) -> Fallible<Friction> {
    match (ratio, bodies) {
        (Some(ratio), None) => Ok(Friction::new(coefficient, ratio)?),
        (None, Some((first, second))) => {
            let second = second.map(|body| body.numbers()).transpose()?;
            Ok(Friction::between(coefficient, first.numbers()?, second)?)
        }
        _ => Err(Failure::arguments("give one of compliance_ratio and bodies")),
    }
}

/// What a tangential load does to a contact: partial slip, stiffness, and the energy that cycles cost.
///
/// Parameters
/// ----------
/// path : LoadingPath or History
///     From first touch on, without yielding. Fields need a `LoadingPath`.
/// friction : float
///     Coefficient of friction.
/// load : float, optional
///     Load that presses the contact [N]; that of the last state unless it is given.
/// compliance_ratio : float, optional
///     Ratio of tangential to normal compliance of the bodies, E*/G*: (2 - nu)/(2 (1 - nu)) of one material.
/// bodies : (body, body or None), optional
///     Both bodies in place of it, each by Young's modulus [Pa] and Poisson's ratio or by the name of one of `materials`;
///     None is a rigid one.
/// check : bool
///     Warn if tangential tractions move the surfaces normally too, which is left out.
///
/// Returns
/// -------
/// PartialSlip
///
/// Raises
/// ------
/// AsperityError
///     Of the kinds of beds of springs for a path on which nodes leave or yield, and ``"PathEndsBefore"`` for a load beyond
///     it.
#[pyfunction]
#[pyo3(signature = (path, *, friction, load=None, compliance_ratio=None, bodies=None, check=true))]
fn slip(
    py: Python<'_>,
    path: &Bound<'_, PyAny>,
    friction: f64,
    load: Option<f64>,
    compliance_ratio: Option<f64>,
    bodies: Option<(Body, Option<Body>)>,
    check: bool,
) -> Fallible<PartialSlip> {
    let friction = friction_of(friction, compliance_ratio, bodies)?;
    let (history, path) = if let Ok(path) = path.cast::<LoadingPath>() {
        (path.get().history_now(py).history, Some(path.clone().unbind()))
    } else if let Ok(history) = path.cast::<History>() {
        (Arc::clone(&history.get().history), None)
    } else {
        return Err(Failure::arguments("slip needs a LoadingPath or a History"));
    };
    let (load, sliding) = detached(py, || {
        let bed = Bed::new(&history)?;
        let load = load.unwrap_or(bed.last_load());
        let joint = Joint::new(&bed, load, friction)?;
        Ok::<_, Error>((load, (joint.sliding_load(), joint.sliding_displacement())))
    })??;
    if let Some(beta) = friction.dundurs_beta().filter(|_| check && friction.is_coupled()) {
        warn(
            py,
            &format!(
                "Dundurs' beta is {beta:.3}: tangential tractions move these surfaces normally too, which is left out"
            ),
        )?;
    }
    Ok(PartialSlip { history, path, friction, load, sliding })
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PartialSlip>()?;
    module.add_function(wrap_pyfunction!(slip, module)?)
}
