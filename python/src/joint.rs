//! Conductance of joints, and their laws as tables for finite elements.

use std::sync::Arc;

use asperity::joint::{self, Carrier, Conduction, FeProgram, FeUnits, InterfaceRow};
use asperity::kernel::Theory;
use asperity::{ContactState, Error};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::column;
use crate::choice::choose;
use crate::compute::detached;
use crate::errors::{Failure, Fallible};
use crate::increments::Increments;
use crate::materials::{self, Body};

const CARRIERS: [(&str, Carrier); 2] = [("heat", Carrier::Heat), ("current", Carrier::Current)];

/// Conduction of an increments' path: E* is that of the path unless it is given.
fn conduction(
    py: Python<'_>,
    increments: &Increments,
    resistivity: f64,
    carrier: &str,
    e_star: Option<f64>,
    gap: Option<(f64, f64)>,
) -> Fallible<Conduction> {
    let e_star = e_star.or_else(|| increments.e_star(py)).ok_or_else(|| {
        Failure::arguments(
            "a path on a body of your own, or a History, does not know its modulus: give e_star",
        )
    })?;
    let made = match choose("carrier", carrier, &CARRIERS)? {
        Carrier::Heat => Conduction::thermal(e_star, resistivity)?,
        Carrier::Current => Conduction::electrical(e_star, resistivity)?,
    };
    Ok(match gap {
        Some((conductivity, jump)) => made.with_gap(conductivity, jump)?,
        None => made,
    })
}

/// Conductance at each state of a path [W/K or S], by Barber's relation to the stiffness, ``1/R = 2 K / (rho E*)``.
///
/// Nodes that have yielded conduct as well: with a hardness K is the stiffness on unloading, of all nodes in contact, which costs a factor
/// of the largest contact at each call. It needs the path.
///
/// Parameters
/// ----------
/// path : LoadingPath or History
/// resistivity : float
///     The sum of both bodies [m K/W or ohm m].
/// carrier : {"heat", "current"}
///     What is conducted.
/// e_star : float, optional
///     Composite modulus [Pa]; that of the path unless it is given.
/// gap : (float, float), optional
///     Conductivity of what fills the gap [W/(m K) or S/m], and the sum of its jump distances [m], in parallel.
/// interface : bool
///     That of the interface alone, by the interfacial stiffness, as a finite element model of both bodies needs it.
///
/// Returns
/// -------
/// ndarray of float
///     NaN without a stiffness.
#[pyfunction]
#[pyo3(signature = (path, resistivity, *, carrier="heat", e_star=None, gap=None, interface=false))]
fn conductance<'py>(
    py: Python<'py>,
    path: &Bound<'py, PyAny>,
    resistivity: f64,
    carrier: &str,
    e_star: Option<f64>,
    gap: Option<(f64, f64)>,
    interface: bool,
) -> Fallible<Bound<'py, PyArray1<f64>>> {
    let increments = Increments::of(path)?;
    let conduction = conduction(py, &increments, resistivity, carrier, e_star, gap)?;
    let body = increments.history.layering();
    body.check(Theory::Conductance)?;
    let of = |contact: &ContactState| match interface {
        true => conduction.of_interface(contact, body),
        false => conduction.of(contact, body),
    };
    let history = increments.with_unloading_stiffness(py)?;
    let states = history.states().iter();
    let values = states.map(|state| Ok(of(&state.contact)?.unwrap_or(f64::NAN)));
    Ok(column(py, values.collect::<Result<_, Error>>()?))
}

/// Barber's bounds of the conductance at each state, for a surface with more roughness than the grid resolves.
///
/// Paths on which nodes yield are refused: ``load_path(path.residual_surface(), ...)`` is elastic, and has bounds.
///
/// Parameters
/// ----------
/// path : LoadingPath or History
/// resistivity : float
///     The sum of both bodies [m K/W or ohm m].
/// unresolved : float
///     Height of the roughness that is left out, from valley to peak [m].
/// carrier, e_star, gap
///     As of `conductance`.
///
/// Returns
/// -------
/// (ndarray of float, ndarray of float)
///     Lower and upper bounds; the upper one is infinite where the path tells of none.
#[pyfunction]
#[pyo3(signature = (path, resistivity, unresolved, *, carrier="heat", e_star=None, gap=None))]
#[allow(clippy::type_complexity)] // two arrays
fn conductance_bounds<'py>(
    py: Python<'py>,
    path: &Bound<'py, PyAny>,
    resistivity: f64,
    unresolved: f64,
    carrier: &str,
    e_star: Option<f64>,
    gap: Option<(f64, f64)>,
) -> Fallible<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>)> {
    let increments = Increments::of(path)?;
    let conduction = conduction(py, &increments, resistivity, carrier, e_star, gap)?;
    let bounds = detached(py, || conduction.bounds(&increments.history, unresolved))??;
    let (lower, upper) = bounds.iter().map(|bounds| (bounds.lower, bounds.upper)).unzip();
    Ok((column(py, lower), column(py, upper)))
}

/// The laws of an interface as a short table, for finite elements: made by `interface_table`.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct InterfaceTable {
    table: joint::InterfaceTable,
}

/// The laws of the interface as a table: pressure over overclosure, and over the pressure conductance, tangential stiffness and
/// slip limit.
///
/// Parameters
/// ----------
/// path : LoadingPath or History
/// resistivity : float, optional
///     The sum of both bodies [m K/W or ohm m], for conductances.
/// carrier, e_star, gap
///     As of `conductance`; the last two go together with resistivity.
/// friction : float, optional
///     Coefficient of friction, for tangential stiffness and slip limit; with bodies or their ratio of compliances.
/// bodies : (body, body), optional
///     Both bodies, as of `shear`: they have the ratio of compliances; those of the path if it knows them.
/// compliance_ratio : float, optional
///     In place of bodies: tangential over normal compliance, E*/G*.
/// tolerance : float
///     Greatest relative error of linear interpolation.
///
/// Returns
/// -------
/// InterfaceTable
#[pyfunction]
#[pyo3(signature = (path, *, resistivity=None, carrier="heat", e_star=None, gap=None, friction=None, bodies=None, compliance_ratio=None, tolerance=0.01))]
#[allow(clippy::too_many_arguments)] // each is a keyword
fn interface_table(
    py: Python<'_>,
    path: &Bound<'_, PyAny>,
    resistivity: Option<f64>,
    carrier: &str,
    e_star: Option<f64>,
    gap: Option<(f64, f64)>,
    friction: Option<f64>,
    bodies: Option<(Body, Body)>,
    compliance_ratio: Option<f64>,
    tolerance: f64,
) -> Fallible<InterfaceTable> {
    choose("carrier", carrier, &CARRIERS)?;
    if resistivity.is_none() && (gap.is_some() || e_star.is_some()) {
        return Err(Failure::arguments(
            "gap and e_star are for conductances: give resistivity too",
        ));
    }
    let increments = Increments::of(path)?;
    let history = match (resistivity, friction) {
        (None, None) => Arc::clone(&increments.history),
        _ => increments.with_unloading_stiffness(py)?,
    };
    if friction.is_some() {
        history.layering().check(Theory::TangentialStiffness)?;
    }
    let mut builder = joint::InterfaceTable::builder(&history).tolerance(tolerance);
    if let Some(resistivity) = resistivity {
        let made = conduction(py, &increments, resistivity, carrier, e_star, gap)?;
        builder = builder.conduction(made);
    }
    let bodies = match (friction, bodies, compliance_ratio) {
        (Some(_), None, None) => increments.bodies(py)?,
        (_, bodies, _) => bodies,
    };
    match (friction, bodies, compliance_ratio) {
        (Some(friction), None, Some(ratio)) => builder = builder.friction(friction, ratio),
        (Some(friction), Some(bodies), None) => {
            let friction = materials::friction(friction, &bodies)?;
            builder = builder.friction(friction.coefficient(), friction.compliance_ratio());
        }
        (None, None, None) => {}
        _ => {
            return Err(Failure::arguments(
                "friction goes together with one of bodies and compliance_ratio",
            ));
        }
    }
    Ok(InterfaceTable { table: detached(py, || builder.build())?? })
}

#[pymethods]
impl InterfaceTable {
    /// All columns by name, per nominal area.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray
    ///     ``pressure`` [Pa], ``overclosure`` [m]; if asked for ``thermal_conductance`` [W/(m² K)] or
    ///     ``electrical_conductance`` [S/m²], ``tangential_stiffness`` [Pa/m] and ``slip_limit`` [Pa].
    fn columns<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyDict>> {
        let all = self.table.rows();
        let columns = PyDict::new(py);
        let put = |name: &str, get: fn(&InterfaceRow) -> Option<f64>| {
            let values: Option<Vec<f64>> = all.iter().map(get).collect();
            values.map_or(Ok(()), |values| columns.set_item(name, column(py, values)))
        };
        put("pressure", |row| Some(row.pressure))?;
        put("overclosure", |row| Some(row.overclosure))?;
        if let Some(carrier) = self.table.carrier() {
            put(carrier.column(), |row| row.conductance)?;
        }
        put("tangential_stiffness", |row| row.tangential_stiffness)?;
        put("slip_limit", |row| row.slip_limit)?;
        Ok(columns)
    }

    /// The table in the words of a program.
    ///
    /// Parameters
    /// ----------
    /// program : {"abaqus", "calculix", "moose", "csv"}
    /// units : {"SI", "mm-N-MPa"}
    ///     The second are mm, N, MPa, t, s and A, in which power is in mW and voltage in mV.
    ///
    /// Returns
    /// -------
    /// str
    #[pyo3(signature = (program, units="SI"))]
    fn text(&self, program: &str, units: &str) -> Fallible<String> {
        let systems = [("SI", FeUnits::Si), ("mm-N-MPa", FeUnits::Millimetres)];
        let units = choose("units", units, &systems)?;
        let programs = [
            ("abaqus", FeProgram::Abaqus),
            ("calculix", FeProgram::CalculiX),
            ("moose", FeProgram::Moose),
            ("csv", FeProgram::Csv),
        ];
        Ok(self.table.text_in(choose("program", program, &programs)?, units))
    }

    fn __len__(&self) -> usize {
        self.table.rows().len()
    }

    fn __repr__(&self) -> String {
        format!("<InterfaceTable: {} rows>", self.table.rows().len())
    }
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<InterfaceTable>()?;
    module.add_function(wrap_pyfunction!(conductance, module)?)?;
    module.add_function(wrap_pyfunction!(conductance_bounds, module)?)?;
    module.add_function(wrap_pyfunction!(interface_table, module)?)
}
