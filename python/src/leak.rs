//! Leakage through the gap.

use asperity::Warning;
use asperity::leak::{self, CriticalConstriction, Leak, LeakPoint};
use asperity::surface::Axis;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::argument::whole;
use crate::arrays::{Found, Kind, Lengths, column, rows};
use crate::choice::{self, Repeats};
use crate::compute::detached;
use crate::elastic_path::ElasticPath;
use crate::errors::Fallible;
use crate::results::result;
use crate::state::State;
use crate::warnings::warn_all;

/// A viscous fluid before one edge of the surface, pressed through the gap to the opposite one.
///
/// Reynolds' equation on the gap, ``div(g³ / (12 viscosity) grad p) = 0``: nothing flows through nodes in contact. The other
/// two edges are closed on a free half-space and joined on a periodic one. The pressure of the fluid does not open the gap.
///
/// Parameters
/// ----------
/// viscosity : float
///     [Pa s]: water 1e-3, air 1.8e-5, oils 1e-2 to 1.
/// pressure_drop : float
///     [Pa], from the lower end of the axis to the upper one.
/// along : {"x", "y"}
///     Direction in which the fluid is pressed.
/// least_gap : float
///     [m]: nothing flows through gaps of this height and less.
/// outlet_pressure : float, optional
///     [Pa], absolute: the fluid is an ideal gas that leaves at it. Leak rates and fluxes are volumes there; times this pressure
///     they are the throughput [Pa m³/s], of which 1 is 10 mbar l/s.
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> path = asp.load_path(asp.example_surface(nodes=32), asp.HalfSpace(1e9, boundary="love"), area_fraction=0.3)
/// >>> history = path.run(check=False)
/// >>> water = asp.Seal(1e-3, 1e5, along="x")
/// >>> water.leak(path).leak_rate > 0.0
/// True
#[pyclass(frozen, module = "asperity")]
pub(crate) struct Seal {
    seal: leak::Seal,
}

#[pymethods]
impl Seal {
    #[new]
    #[pyo3(signature = (viscosity, pressure_drop, along, *, least_gap=0.0, outlet_pressure=None))]
    fn new(
        viscosity: f64,
        pressure_drop: f64,
        along: &str,
        least_gap: f64,
        outlet_pressure: Option<f64>,
    ) -> Fallible<Self> {
        let seal = leak::Seal::new(viscosity, pressure_drop, choice::axis(along)?)?;
        let seal = seal.with_least_gap(least_gap)?;
        Ok(Self { seal: outlet_pressure.map_or(Ok(seal), |pressure| seal.with_gas(pressure))? })
    }

    /// Height [m] of gaps through which nothing flows any more.
    #[getter]
    fn least_gap(&self) -> f64 {
        self.seal.least_gap()
    }

    /// Absolute pressure [Pa] at which a gas leaves, None for a liquid.
    #[getter]
    fn outlet_pressure(&self) -> Option<f64> {
        self.seal.outlet_pressure()
    }

    /// Viscosity [Pa s].
    #[getter]
    fn viscosity(&self) -> f64 {
        self.seal.viscosity()
    }

    /// Pressure drop [Pa] from edge to edge.
    #[getter]
    fn pressure_drop(&self) -> f64 {
        self.seal.pressure_drop()
    }

    /// Direction in which the fluid is pressed: ``"x"`` or ``"y"``.
    #[getter]
    fn along(&self) -> &'static str {
        match self.seal.along() {
            Axis::X => "x",
            Axis::Y => "y",
        }
    }

    /// The leak at a state of a path.
    ///
    /// Parameters
    /// ----------
    /// path : LoadingPath
    /// state : State, optional
    ///     One of the path so far, or one that `History.at` has read from it; the last one if not given.
    /// check : bool
    ///     Warn if the pressure drop is not small beside the mean pressure of the contact.
    ///
    /// Returns
    /// -------
    /// results.Leak
    #[pyo3(signature = (path, state=None, *, check=true))]
    fn leak<'py>(
        &self,
        py: Python<'py>,
        path: ElasticPath<'py>,
        state: Option<PyRef<'py, State>>,
        check: bool,
    ) -> Fallible<Bound<'py, PyAny>> {
        let seal = self.seal;
        let (leak, mean_pressure) = path.at(py, state, |engine, state| {
            Ok((seal.leak_at(engine, state)?, state.contact.mean_pressure()))
        })?;
        if check {
            warn_all(py, Warning::of_pressure_drop(seal.pressure_drop(), [mean_pressure]))?;
        }
        of_leak(py, leak)
    }

    /// The leak through any gap map.
    ///
    /// Parameters
    /// ----------
    /// gap : array_like of float
    ///     [m], ``[row, column]``.
    /// contact_map : array_like of bool
    ///     Nodes through which nothing flows.
    /// size : (float, float) or float
    ///     Sides ``(x, y)`` [m]; one number is the side along x, with square cells.
    /// periodic : bool or {"x", "y"}
    ///     Whether the map repeats with its sides, or the side along which it does. Sides along the flow are joined where it
    ///     repeats across the flow, and closed otherwise.
    ///
    /// Returns
    /// -------
    /// results.Leak
    #[pyo3(signature = (gap, contact_map, size, *, periodic))]
    fn leak_of<'py>(
        &self,
        py: Python<'py>,
        gap: &Bound<'py, PyAny>,
        contact_map: &Bound<'py, PyAny>,
        size: Lengths,
        periodic: Repeats,
    ) -> Fallible<Bound<'py, PyAny>> {
        let found = Found::of(gap, "gap", Kind::Real)?;
        let grid = size.grid(found.rows_and_columns()?)?;
        let gap = found.on(&grid)?;
        let contact = Found::of(contact_map, "contact_map", Kind::Truth)?.map_on(&grid)?;
        let boundary = periodic.boundary()?;
        of_leak(py, detached(py, || self.seal.leak(&gap, &contact, (&grid, boundary)))??)
    }

    /// The leak rate along a path, at states chosen where it changes, up to the one at which the last channel closes.
    ///
    /// Parameters
    /// ----------
    /// path : LoadingPath
    ///     With its states so far.
    /// states : int
    ///     Number of states, at least 2; the first, the last that leaks and the one at which the last channel closes
    ///     are always there.
    /// check : bool
    ///     As of `leak`.
    ///
    /// Returns
    /// -------
    /// results.LeakCurve
    #[pyo3(signature = (path, states=40, *, check=true))]
    fn curve<'py>(
        &self,
        py: Python<'py>,
        path: ElasticPath<'py>,
        #[pyo3(from_py_with = whole)] states: usize,
        check: bool,
    ) -> Fallible<Bound<'py, PyAny>> {
        let seal = self.seal;
        let curve =
            path.interruptible(py, move |engine, history| seal.curve(engine, history, states))?;
        if check {
            let pressures = curve.points.iter().map(|point| point.state.contact.mean_pressure());
            warn_all(py, Warning::of_pressure_drop(seal.pressure_drop(), pressures))?;
        }
        let values = |get: &dyn Fn(&LeakPoint) -> f64| {
            column(py, curve.points.iter().map(get).collect::<Vec<f64>>())
        };
        let constrictions = curve.points.iter().map(|point| narrowest(py, point.constriction));
        let constrictions: Vec<_> = constrictions.collect::<Fallible<_>>()?;
        let known: Vec<State> = curve.points.iter().map(|point| State::new(point.state)).collect();
        result!(py, "LeakCurve", {
            states: known,
            load: values(&|point| point.state.contact.load),
            mean_pressure: values(&|point| point.state.contact.mean_pressure()),
            area_fraction: values(&|point| point.state.contact.contact_area_fraction),
            mean_gap: values(&|point| point.state.contact.mean_gap),
            leak_rate: values(&|point| point.leak_rate),
            mean_field_leak_rate: values(&|point| point.mean_field_leak_rate),
            permeability: values(&|point| point.permeability),
            transverse_permeability: values(&|p| p.transverse_permeability.unwrap_or(f64::NAN)),
            constrictions: constrictions,
            imbalance: values(&|point| point.imbalance),
            closing: curve.closing.map(State::new),
        })
    }

    fn __repr__(&self) -> String {
        let (viscosity, drop) = (self.viscosity(), self.pressure_drop());
        let mut text = format!(
            "Seal(viscosity={viscosity:?}, pressure_drop={drop:?}, along='{}'",
            self.along()
        );
        if self.least_gap() > 0.0 {
            text += &format!(", least_gap={:?}", self.least_gap());
        }
        if let Some(outlet) = self.outlet_pressure() {
            text += &format!(", outlet_pressure={outlet:?}");
        }
        text + ")"
    }
}

fn narrowest<'py>(
    py: Python<'py>,
    constriction: Option<CriticalConstriction>,
) -> Fallible<Option<Bound<'py, PyAny>>> {
    let of = |found: CriticalConstriction| {
        result!(py, "CriticalConstriction", {
            row: found.node.1,
            column: found.node.0,
            gap: found.gap,
            pressure_drop: found.pressure_drop,
            dissipation: found.dissipation,
        })
    };
    constriction.map(of).transpose()
}

fn of_leak<'py>(py: Python<'py>, leak: Leak) -> Fallible<Bound<'py, PyAny>> {
    let sections: Bound<'py, PyArray1<f64>> = column(py, leak.sections);
    let fields = PyDict::new(py);
    fields.set_item("leak_rate", leak.leak_rate)?;
    fields.set_item("permeability", leak.permeability)?;
    let across = leak.transverse_permeability.unwrap_or(f64::NAN);
    fields.set_item("transverse_permeability", across)?;
    fields.set_item("mean_field_leak_rate", leak.mean_field_leak_rate)?;
    fields.set_item("constriction", narrowest(py, leak.constriction)?)?;
    fields.set_item("pressure", rows(py, leak.pressure)?)?;
    fields.set_item("flux_x", rows(py, leak.flux_x)?)?;
    fields.set_item("flux_y", rows(py, leak.flux_y)?)?;
    fields.set_item("sections", sections)?;
    fields.set_item("imbalance", leak.imbalance)?;
    fields.set_item("flowing_nodes", leak.flowing_nodes)?;
    fields.set_item("pools", leak.pools)?;
    fields.set_item("iterations", leak.iterations)?;
    crate::results::make(py, "Leak", &fields)
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Seal>()
}
