//! Partial slip under a tangential load.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use asperity::Error;
use asperity::bed::Bed;
use asperity::kernel::Theory;
use asperity::slip::{self, Friction, SlipCycle, SlipHistory, SlipState, SlipZone};
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Found, Kind, column, rows};
use crate::compute::{cancellable, detached};
use crate::errors::{Failure, Fallible};
use crate::increments::Increments;
use crate::materials::{self, Body};
use crate::results::result;
use crate::warnings::warn;

/// Fields under a tangential load.
#[derive(Clone, Copy)]
enum Sheared {
    Traction,
    Slip,
    FrictionWork,
}

/// A joint under a constant load: what a tangential load does to it. Made by `shear`.
///
/// All of it follows from the path of normal loading. The dissipation is that of a steady cycle.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct PartialSlip {
    increments: Increments,
    friction: Friction,
    load: f64,
}

/// What a joint does under a tangential load: partial slip, stiffness, dissipation, by Coulomb friction.
///
/// For bodies alike, or of Poisson's ratio 1/2 against a rigid one, stiffnesses are right within some per cent.
///
/// Parameters
/// ----------
/// path : LoadingPath or History
///     Elastic, from first touch on. Fields need a path.
/// friction : float
///     Coefficient of friction.
/// load : float, optional
///     Load that presses the joint [N]; that of the last state unless it is given.
/// bodies : (body, body), optional
///     Both bodies, each (E [Pa], nu), the name of one of `materials`, or ``"rigid"`` for the second; those of the path
///     if it knows them.
/// compliance_ratio : float, optional
///     In place of bodies: tangential over normal compliance E*/G*, (2 - nu) / (2 (1 - nu)) of one material.
/// check : bool
///     Warn where tangential tractions move the surfaces normally, and if the bodies have another E* than the path.
///
/// Returns
/// -------
/// PartialSlip
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> path = asp.load_path(asp.example_surface(nodes=32), asp.HalfSpace(115e9, boundary="free"), load=500.0)
/// >>> history = path.run(check=False)
/// >>> joint = asp.shear(path, friction=0.3, bodies=("steel", "steel"))
/// >>> joint.sliding_load, joint.cycle(75.0).dissipation > 0.0
/// (150.0, True)
#[pyfunction]
#[pyo3(signature = (path, *, friction, load=None, bodies=None, compliance_ratio=None, check=true))]
fn shear(
    py: Python<'_>,
    path: &Bound<'_, PyAny>,
    friction: f64,
    load: Option<f64>,
    bodies: Option<(Body, Body)>,
    compliance_ratio: Option<f64>,
    check: bool,
) -> Fallible<PartialSlip> {
    let increments = Increments::of(path)?;
    increments.history.layering().check(Theory::Slip)?;
    let bodies = match (bodies, compliance_ratio) {
        (None, None) => increments.bodies(py)?,
        (bodies, _) => bodies,
    };
    let law = match (&bodies, compliance_ratio) {
        (Some(bodies), None) => materials::friction(friction, bodies)?,
        (None, Some(ratio)) => Friction::new(friction, ratio)?,
        _ => {
            return Err(Failure::arguments(
                "give one of bodies and compliance_ratio, unless the path knows its bodies",
            ));
        }
    };
    if check {
        for warning in warnings(py, &increments, bodies.as_ref(), &law)? {
            warn(py, &warning)?;
        }
    }
    let friction = law;
    let last = increments.history.states().last().map(|state| state.contact.load);
    let load = load.or(last).unwrap_or(0.0);
    let joint = PartialSlip { increments, friction, load };
    joint.with(py, |joint| Ok(joint.sliding_load()))?;
    Ok(joint)
}

/// How far E* of the bodies may be from that of the path: materials are given with three digits.
const SAME_MODULUS: f64 = 1e-3;

/// What looks wrong with the bodies.
fn warnings(
    py: Python<'_>,
    increments: &Increments,
    bodies: Option<&(Body, Body)>,
    friction: &Friction,
) -> Fallible<Vec<String>> {
    let mut warnings = Vec::new();
    if let Some(beta) = friction.dundurs_beta().filter(|_| friction.is_coupled()) {
        warnings.push(format!(
            "Dundurs' beta is {beta:.3}: tangential tractions move these surfaces normally too, which is left out. At 0.29 the \
             tangential load of a first loading was up to 6 % less than here, steady cycles dissipated 2 to 10 % more (small ones \
             9 % less to 29 % more), and the first loading several times a quarter of the dissipation of a cycle"
        ));
    }
    if let (Some(bodies), Some(e_star)) = (bodies, increments.e_star(py)) {
        let found = materials::modulus(bodies)?;
        let is_same = (found / e_star - 1.0).abs() < SAME_MODULUS;
        if !is_same {
            warnings.push(format!(
                "the path has been computed with E* = {e_star:.4e} Pa, and these bodies have {found:.4e} Pa: only their ratio of \
                 compliances is used"
            ));
        }
    }
    Ok(warnings)
}

impl PartialSlip {
    /// What the joint of the library says.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        ask: impl FnOnce(&slip::PartialSlip) -> Result<T, Error> + Send,
    ) -> Fallible<T> {
        let (history, load, friction) = (&*self.increments.history, self.load, self.friction);
        Ok(detached(py, || {
            let bed = Bed::new(history)?;
            ask(&slip::PartialSlip::new(&bed, load, friction)?)
        })??)
    }

    fn field<'py>(
        &self,
        py: Python<'py>,
        what: Sheared,
        load: f64,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        let (preload, friction) = (self.load, self.friction);
        let field = self.increments.field(py, |engine, bed| {
            let joint = slip::PartialSlip::new(bed, preload, friction)?;
            match what {
                Sheared::Traction => joint.traction(engine, load),
                Sheared::Slip => joint.slip(engine, load),
                Sheared::FrictionWork => joint.friction_work(engine, load),
            }
        })?;
        rows(py, field)
    }
}

#[pymethods]
impl PartialSlip {
    /// Load that presses the joint [N].
    #[getter]
    fn load(&self) -> f64 {
        self.load
    }

    /// Coefficient of friction of the joint.
    #[getter]
    fn friction(&self) -> f64 {
        self.friction.coefficient()
    }

    /// Ratio of tangential to normal compliance, E*/G*.
    #[getter]
    fn compliance_ratio(&self) -> f64 {
        self.friction.compliance_ratio()
    }

    /// Dundurs' beta of the bodies; NaN if they are not known.
    #[getter]
    fn dundurs_beta(&self) -> f64 {
        self.friction.dundurs_beta().unwrap_or(f64::NAN)
    }

    /// Tangential load at which the joint slides [N].
    #[getter]
    fn sliding_load(&self, py: Python<'_>) -> Fallible<f64> {
        self.with(py, |joint| Ok(joint.sliding_load()))
    }

    /// Displacement at which it begins to slide [m].
    #[getter]
    fn sliding_displacement(&self, py: Python<'_>) -> Fallible<f64> {
        self.with(py, |joint| Ok(joint.sliding_displacement()))
    }

    /// The state under a tangential load that has grown from zero.
    ///
    /// Parameters
    /// ----------
    /// tangential_load : float
    ///     [N], of either sign.
    ///
    /// Returns
    /// -------
    /// results.SlipState
    ///
    /// Raises
    /// ------
    /// AsperityError
    ///     Of the kind ``"JointSlides"`` beyond `sliding_load`.
    fn monotone<'py>(&self, py: Python<'py>, tangential_load: f64) -> Fallible<Bound<'py, PyAny>> {
        let state = self.with(py, |joint| joint.monotone(tangential_load))?;
        result!(py, "SlipState", {
            load: state.load,
            tangential_load: state.tangential_load,
            displacement: state.displacement,
            interfacial_displacement: state.interfacial_displacement,
            stick_load: state.stick_load,
            stick_nodes: state.stick_nodes,
            slipping_nodes: state.slipping_nodes,
            stick_area: state.stick_area,
            slip_area: state.slip_area,
            tangential_stiffness: state.tangential_stiffness,
        })
    }

    /// The first loading: the states under many tangential loads, each grown from zero.
    ///
    /// Parameters
    /// ----------
    /// tangential_loads : array_like of float
    ///     [N]
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     The fields of `results.SlipState` as columns.
    fn loading<'py>(
        &self,
        py: Python<'py>,
        tangential_loads: &Bound<'py, PyAny>,
    ) -> Fallible<Bound<'py, PyDict>> {
        let loads = Found::of(tangential_loads, "tangential_loads", Kind::Real)?.list()?;
        let states = self.with(py, |joint| {
            loads.iter().map(|load| joint.monotone(*load)).collect::<Result<Vec<_>, _>>()
        })?;
        columns(py, &states)
    }

    /// The steady cycle of a tangential load between -amplitude and amplitude.
    ///
    /// Parameters
    /// ----------
    /// amplitude : float
    ///     [N]
    ///
    /// Returns
    /// -------
    /// results.SlipCycle
    fn cycle<'py>(&self, py: Python<'py>, amplitude: f64) -> Fallible<Bound<'py, PyAny>> {
        of_cycle(py, &self.with(py, |joint| joint.cycle(amplitude))?)
    }

    /// The steady cycle of a displacement between -displacement and displacement, beyond sliding too.
    ///
    /// Parameters
    /// ----------
    /// displacement : float
    ///     [m]
    ///
    /// Returns
    /// -------
    /// results.SlipCycle
    fn cycle_of_displacement<'py>(
        &self,
        py: Python<'py>,
        displacement: f64,
    ) -> Fallible<Bound<'py, PyAny>> {
        of_cycle(py, &self.with(py, |joint| joint.cycle_of_displacement(displacement))?)
    }

    /// Many cycles at once.
    ///
    /// Parameters
    /// ----------
    /// amplitudes : array_like of float
    ///     [N]
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     The fields of `results.SlipCycle` as columns.
    fn cycles<'py>(
        &self,
        py: Python<'py>,
        amplitudes: &Bound<'py, PyAny>,
    ) -> Fallible<Bound<'py, PyDict>> {
        let amplitudes = Found::of(amplitudes, "amplitudes", Kind::Real)?.list()?;
        let cycles: Vec<SlipCycle> = self.with(py, |joint| {
            amplitudes.iter().map(|amplitude| joint.cycle(*amplitude)).collect()
        })?;
        let values = |get: fn(&SlipCycle) -> f64| column(py, cycles.iter().map(get).collect());
        let columns = PyDict::new(py);
        columns.set_item("amplitude", values(|cycle| cycle.amplitude))?;
        columns.set_item("displacement", values(|cycle| cycle.displacement))?;
        let interfacial = values(|cycle| cycle.interfacial_displacement);
        columns.set_item("interfacial_displacement", interfacial)?;
        columns.set_item("dissipation", values(|cycle| cycle.dissipation))?;
        columns.set_item("secant_stiffness", values(|cycle| cycle.secant_stiffness))?;
        columns.set_item("loss_factor", values(|cycle| cycle.loss_factor))?;
        columns.set_item("stick_load", values(|cycle| cycle.stick_load))?;
        let nodes = cycles.iter().map(|cycle| cycle.slipping_nodes as i64).collect();
        columns.set_item("slipping_nodes", column::<i64>(py, nodes))?;
        let few = cycles.iter().map(SlipCycle::has_few_nodes).collect();
        columns.set_item("has_few_nodes", column::<bool>(py, few))?;
        Ok(columns)
    }

    /// The joint as elements of a spring and a slider in series, side by side: Iwan's model.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     ``stiffness`` [N/m] and ``slip_displacement`` [m] of each, in the order in which nodes have touched.
    fn jenkins_elements<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyDict>> {
        let elements = self.with(py, |joint| {
            let elements = joint.jenkins_elements();
            Ok(elements.map(|e| (e.stiffness, e.slip_displacement)).collect::<Vec<_>>())
        })?;
        let (stiffness, displacement): (Vec<f64>, Vec<f64>) = elements.into_iter().unzip();
        let columns = PyDict::new(py);
        columns.set_item("stiffness", column(py, stiffness))?;
        columns.set_item("slip_displacement", column(py, displacement))?;
        Ok(columns)
    }

    /// The joint under any history of load and tangential load, from no load on, along straight lines between corners.
    ///
    /// Parameters
    /// ----------
    /// load : array_like of float
    ///     [N]
    /// tangential_load : array_like of float
    ///     [N], of the same length.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     One value for each corner: the fields of `results.SlipState`, and ``dissipation`` and ``stored_energy`` [J] so far.
    fn follow<'py>(
        &self,
        py: Python<'py>,
        load: &Bound<'py, PyAny>,
        tangential_load: &Bound<'py, PyAny>,
    ) -> Fallible<Bound<'py, PyDict>> {
        let loads = Found::of(load, "load", Kind::Real)?.list()?;
        let found = Found::of(tangential_load, "tangential_load", Kind::Real)?;
        let tangential = found.list_of(loads.len())?;
        let (history, friction) = (Arc::clone(&self.increments.history), self.friction);
        let followed = cancellable(py, move |is_left| {
            let bed = Bed::new(&history)?;
            let mut history = SlipHistory::new(&bed, friction);
            let corners = loads.iter().zip(&tangential);
            let goes_on = corners.take_while(|_| !is_left.load(Ordering::Relaxed));
            let steps = goes_on.map(|(load, tangential)| {
                let state = history.to(*load, *tangential)?;
                Ok((state, history.dissipation(), history.stored_energy()?))
            });
            steps.collect::<Result<Vec<_>, Error>>()
        })??;
        let states: Vec<SlipState> = followed.iter().map(|(state, ..)| *state).collect();
        let columns = columns(py, &states)?;
        let lost = followed.iter().map(|(_, dissipation, _)| *dissipation).collect();
        columns.set_item("dissipation", column::<f64>(py, lost))?;
        let stored = followed.iter().map(|(.., stored)| *stored).collect();
        columns.set_item("stored_energy", column::<f64>(py, stored))?;
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
        self.field(py, Sheared::Traction, tangential_load)
    }

    /// Slip [m] of the nodes in contact, 0 where they stick.
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
        self.field(py, Sheared::Slip, tangential_load)
    }

    /// Work of friction of each node in a steady cycle, per area [J/m²]: where it wears.
    ///
    /// Parameters
    /// ----------
    /// amplitude : float
    ///     [N]
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    fn friction_work<'py>(
        &self,
        py: Python<'py>,
        amplitude: f64,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        self.field(py, Sheared::FrictionWork, amplitude)
    }

    /// Which nodes stick, and which slip.
    ///
    /// Parameters
    /// ----------
    /// tangential_load : float
    ///     [N]
    ///
    /// Returns
    /// -------
    /// ndarray of int8, [row, column]
    ///     0 out of contact, 1 stick, 2 slip.
    fn zones<'py>(
        &self,
        py: Python<'py>,
        tangential_load: f64,
    ) -> Fallible<Bound<'py, PyArray2<i8>>> {
        let (preload, friction) = (self.load, self.friction);
        let zones = self.increments.field(py, |engine, bed| {
            slip::PartialSlip::new(bed, preload, friction)?.zones(engine, tangential_load)
        })?;
        rows(
            py,
            zones.map(|zone| match zone {
                SlipZone::Stick => 1_i8,
                SlipZone::Slip => 2,
                _ => 0,
            }),
        )
    }

    fn __repr__(&self) -> String {
        let (load, friction) = (self.load, self.friction());
        format!("<PartialSlip: load {load:.6e} N, coefficient of friction {friction}>")
    }
}

/// States as columns.
fn columns<'py>(py: Python<'py>, states: &[SlipState]) -> Fallible<Bound<'py, PyDict>> {
    let of = |get: fn(&SlipState) -> f64| column(py, states.iter().map(get).collect::<Vec<f64>>());
    let nodes = |get: fn(&SlipState) -> usize| {
        column(py, states.iter().map(|state| get(state) as i64).collect::<Vec<i64>>())
    };
    let columns = PyDict::new(py);
    columns.set_item("load", of(|state| state.load))?;
    columns.set_item("tangential_load", of(|state| state.tangential_load))?;
    columns.set_item("displacement", of(|state| state.displacement))?;
    columns.set_item("interfacial_displacement", of(|s| s.interfacial_displacement))?;
    columns.set_item("stick_load", of(|state| state.stick_load))?;
    columns.set_item("stick_nodes", nodes(|state| state.stick_nodes))?;
    columns.set_item("slipping_nodes", nodes(|state| state.slipping_nodes))?;
    columns.set_item("stick_area", of(|state| state.stick_area))?;
    columns.set_item("slip_area", of(|state| state.slip_area))?;
    columns.set_item("tangential_stiffness", of(|state| state.tangential_stiffness))?;
    Ok(columns)
}

fn of_cycle<'py>(py: Python<'py>, cycle: &SlipCycle) -> Fallible<Bound<'py, PyAny>> {
    result!(py, "SlipCycle", {
        amplitude: cycle.amplitude,
        displacement: cycle.displacement,
        interfacial_displacement: cycle.interfacial_displacement,
        dissipation: cycle.dissipation,
        secant_stiffness: cycle.secant_stiffness,
        loss_factor: cycle.loss_factor,
        stick_load: cycle.stick_load,
        slipping_nodes: cycle.slipping_nodes,
        has_few_nodes: cycle.has_few_nodes(),
    })
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PartialSlip>()?;
    module.add_function(wrap_pyfunction!(shear, module)?)
}
