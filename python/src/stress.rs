//! Stress below the surface.

use std::path::PathBuf;
use std::sync::atomic::Ordering;

use asperity::Error;
use asperity::kernel::KernelOrigin;
use asperity::nalgebra::DMatrix;
use asperity::record::LoadingRecord;
use asperity::stress::{FirstYield, Greatest, Measure, Subsurface};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::argument::whole;
use crate::arrays::{Found, Kind, Lengths, column, rows};
use crate::choice::Repeats;
use crate::compute::{cancellable, detached};
use crate::elastic_path::ElasticPath;
use crate::errors::{Failure, Fallible};
use crate::path::LoadingPath;
use crate::results::result;
use crate::state::State;

/// The stresses below a pressure. Made by `stress` and `stress_of`.
///
/// Tension is positive, z points into the body.
#[pyclass(frozen, module = "asperity")]
pub(crate) struct Stress {
    below: Subsurface,
    pressure: DMatrix<f64>,
}

/// The stresses below the surface at a state of a path: in a homogeneous half-space, or in layers.
///
/// Parameters
/// ----------
/// path : LoadingPath
/// poissons_ratio : float, optional
///     Of the body; that of the first body of the path if it knows it. Layers have their own, and take none.
/// state : State, optional
///     One of the path so far, or one that `History.at` has read from it; the last one if not given.
/// friction : float
///     Coefficient of friction of a contact that slides: tractions of so many times the pressure. On the other body they are
///     opposite, with the other sign. Not on layers.
/// angle : float
///     Direction of sliding in degrees from x towards y: that in which the other body moves over this one.
///
/// Returns
/// -------
/// Stress
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> path = asp.load_path(asp.example_surface(nodes=32), asp.HalfSpace(115e9, boundary="free"), load=500.0)
/// >>> history = path.run(check=False)
/// >>> greatest = asp.stress(path, 0.3).survey().greatest["von_mises"]
/// >>> greatest.value > 1e9, greatest.depth > 0.0
/// (True, True)
#[pyfunction]
#[pyo3(signature = (path, poissons_ratio=None, *, state=None, friction=0.0, angle=0.0))]
fn stress(
    py: Python<'_>,
    path: ElasticPath<'_>,
    poissons_ratio: Option<f64>,
    state: Option<PyRef<'_, State>>,
    friction: f64,
    angle: f64,
) -> Fallible<Stress> {
    let below = of_path(py, &path, poissons_ratio, (friction, angle))?;
    let pressure =
        path.at(py, state, |engine, state| engine.fields_at(state).map(|fields| fields.pressure))?;
    Ok(Stress { below, pressure })
}

/// The stresses below any pressure map.
///
/// Parameters
/// ----------
/// pressure : array_like of float
///     [Pa], ``[row, column]``.
/// size : (float, float) or float
///     Sides ``(x, y)`` [m]; one number is the side along x, with square cells.
/// poissons_ratio : float
///     Of the body.
/// periodic : bool or {"x", "y"}
///     Whether the map repeats with its sides, or the side along which it does.
/// friction, angle : float
///     As of `stress`.
///
/// Returns
/// -------
/// Stress
#[pyfunction]
#[pyo3(signature = (pressure, size, poissons_ratio, *, periodic, friction=0.0, angle=0.0))]
fn stress_of(
    pressure: &Bound<'_, PyAny>,
    size: Lengths,
    poissons_ratio: f64,
    periodic: Repeats,
    friction: f64,
    angle: f64,
) -> Fallible<Stress> {
    let found = Found::of(pressure, "pressure", Kind::Real)?;
    let grid = size.grid(found.rows_and_columns()?)?;
    let pressure = found.on(&grid)?;
    grid.check_finite("pressure", &pressure).map_err(Error::from)?;
    let below = Subsurface::new(grid, periodic.boundary()?, poissons_ratio)?;
    Ok(Stress { below: below.sliding(friction, angle.to_radians())?, pressure })
}

/// The state of a path at which a body begins to yield: von Mises' stress reaches its yield stress.
///
/// Parameters
/// ----------
/// path : LoadingPath
///     With its states so far.
/// yield_stress : float
///     [Pa]
/// poissons_ratio, friction, angle
///     As of `stress`.
///
/// Returns
/// -------
/// results.FirstYield or None
///     None if the path ends before.
///
/// Raises
/// ------
/// AsperityError
///     If nodes of a path with a hardness yield before that, and the stress at its end is below `yield_stress`: in
///     between it may have been above (``kind`` is ``"BehindHardness"``).
#[pyfunction]
#[pyo3(signature = (path, yield_stress, poissons_ratio=None, *, friction=0.0, angle=0.0))]
fn first_yield<'py>(
    py: Python<'py>,
    path: ElasticPath<'py>,
    yield_stress: f64,
    poissons_ratio: Option<f64>,
    friction: f64,
    angle: f64,
) -> Fallible<Option<Bound<'py, PyAny>>> {
    let below = of_path(py, &path, poissons_ratio, (friction, angle))?;
    let found = path.interruptible(py, move |engine, history| {
        below.first_yield(engine, history, yield_stress)
    })?;
    found.map(|found| of_first(py, found)).transpose()
}

/// The same of each material of a body with layers.
///
/// Parameters
/// ----------
/// path : LoadingPath
///     With its states so far.
/// yield_stresses : array_like of float
///     [Pa], one for each layer from the uppermost on, and one for the base unless that is rigid.
/// poissons_ratio, friction, angle
///     As of `stress`.
///
/// Returns
/// -------
/// list of results.FirstYield or None
///     One for each; None if the path ends before.
///
/// Raises
/// ------
/// AsperityError
///     As of `first_yield`.
#[pyfunction]
#[pyo3(signature = (path, yield_stresses, poissons_ratio=None, *, friction=0.0, angle=0.0))]
fn first_yields<'py>(
    py: Python<'py>,
    path: ElasticPath<'py>,
    yield_stresses: &Bound<'py, PyAny>,
    poissons_ratio: Option<f64>,
    friction: f64,
    angle: f64,
) -> Fallible<Vec<Option<Bound<'py, PyAny>>>> {
    let strengths = Found::of(yield_stresses, "yield_stresses", Kind::Real)?.list()?;
    let below = of_path(py, &path, poissons_ratio, (friction, angle))?;
    let found = path.interruptible(py, move |engine, history| {
        below.first_yields(engine, history, &strengths)
    })?;
    found.into_iter().map(|found| found.map(|found| of_first(py, found)).transpose()).collect()
}

fn of_first<'py>(py: Python<'py>, found: FirstYield) -> Fallible<Bound<'py, PyAny>> {
    result!(py, "FirstYield", {
        state: State::new(found.state),
        greatest: of_greatest(py, found.greatest)?,
    })
}

/// The body of a path.
fn of_path(
    py: Python<'_>,
    path: &LoadingPath,
    poissons_ratio: Option<f64>,
    (friction, angle): (f64, f64),
) -> Fallible<Subsurface> {
    let ratio = match poissons_ratio {
        Some(ratio) => Some(ratio),
        None => path.elastic_bodies(py)?.first().map(|(_, ratio)| *ratio),
    };
    let of_record = move |record: &LoadingRecord| match (ratio, &record.kernel().origin) {
        // Layers have ratios of their own.
        (
            None,
            KernelOrigin::Layered { .. }
            | KernelOrigin::PeriodicLayered { .. }
            | KernelOrigin::SpectralLayered { .. },
        ) => Subsurface::of_record(record, 0.0).map(Some),
        (None, _) => Ok(None),
        (Some(ratio), _) => Subsurface::of_record(record, ratio).map(Some),
    };
    let below = path.with_record(py, move |_, record| of_record(record))?.ok_or_else(|| {
        Failure::arguments("give poissons_ratio, unless the path knows its bodies")
    })?;
    if poissons_ratio.is_some() && below.layers().is_some() {
        return Err(Failure::arguments(
            "poissons_ratio is that of a homogeneous body, and this path is on layers, which have their own",
        ));
    }
    Ok(below.sliding(friction, angle.to_radians())?)
}

#[pymethods]
impl Stress {
    /// The pressure on the surface [Pa], ``[row, column]``.
    #[getter]
    fn pressure<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyAny>> {
        Ok(rows(py, self.pressure.clone())?.into_any())
    }

    /// Poisson's ratio of the body.
    #[getter]
    fn poissons_ratio(&self) -> f64 {
        self.below.poissons_ratio()
    }

    /// All components and measures at a depth.
    ///
    /// Parameters
    /// ----------
    /// depth : float
    ///     [m], 0 on the surface.
    ///
    /// Returns
    /// -------
    /// results.StressField
    fn at_depth<'py>(&self, py: Python<'py>, depth: f64) -> Fallible<Bound<'py, PyAny>> {
        let (field, maps) = detached(py, || {
            let field = self.below.at_depth(&self.pressure, depth)?;
            let maps = Measure::ALL.map(|measure| field.map(measure));
            Ok::<_, Error>((field, maps))
        })??;
        let fields = PyDict::new(py);
        fields.set_item("depth", field.depth)?;
        let names = ["xx", "yy", "zz", "yz", "xz", "xy"];
        for (name, component) in names.into_iter().zip(field.components()) {
            fields.set_item(name, rows(py, component.clone())?)?;
        }
        for (measure, map) in Measure::ALL.into_iter().zip(maps) {
            fields.set_item(measure.name(), rows(py, map)?)?;
        }
        crate::results::make(py, "StressField", &fields)
    }

    /// The greatest stresses over depth.
    ///
    /// Parameters
    /// ----------
    /// depths : array_like of float, optional
    ///     [m]; if not given, from the surface to the size of the largest patch, and around the greatest stress.
    ///
    /// Returns
    /// -------
    /// results.StressSurvey
    #[pyo3(signature = (depths=None))]
    fn survey<'py>(
        &self,
        py: Python<'py>,
        depths: Option<&Bound<'py, PyAny>>,
    ) -> Fallible<Bound<'py, PyAny>> {
        let depths = depths.map(|depths| Found::of(depths, "depths", Kind::Real)?.list());
        let depths = depths.transpose()?;
        let (below, pressure) = (self.below.clone(), self.pressure.clone());
        let survey = cancellable(py, move |is_left| {
            below.survey_with(&pressure, depths.as_deref(), |_| {
                match is_left.load(Ordering::Relaxed) {
                    true => Err(Failure::arguments("nobody waits for this survey any more")),
                    false => Ok(()),
                }
            })
        })??;
        let fields = PyDict::new(py);
        let depth = survey.depths.iter().map(|depth| depth.depth).collect::<Vec<f64>>();
        fields.set_item("depth", column(py, depth))?;
        let greatest = PyDict::new(py);
        for measure in Measure::ALL {
            let values = survey.depths.iter().map(|depth| depth.greatest(measure).value);
            fields.set_item(measure.name(), column(py, values.collect::<Vec<f64>>()))?;
            let most = of_greatest(py, survey.greatest(measure))?;
            greatest.set_item(measure.name(), most)?;
        }
        fields.set_item("greatest", greatest)?;
        crate::results::make(py, "StressSurvey", &fields)
    }

    /// Writes the stresses at evenly spaced depths as a volume that ParaView opens (``.vti``).
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    /// step : float
    ///     Distance of depths [m].
    /// count : int
    ///     Number of depths, the first on the surface.
    fn write_volume(
        &self,
        py: Python<'_>,
        path: PathBuf,
        step: f64,
        #[pyo3(from_py_with = whole)] count: usize,
    ) -> Fallible<()> {
        let write = || self.below.write_volume(&self.pressure, (step, count), &path, |_| ());
        Ok(detached(py, write)??)
    }

    fn __repr__(&self) -> String {
        let (nx, ny) = self.pressure.shape();
        format!("Stress({ny} x {nx} nodes, poissons_ratio={:?})", self.poissons_ratio())
    }
}

fn of_greatest<'py>(py: Python<'py>, greatest: Greatest) -> Fallible<Bound<'py, PyAny>> {
    result!(py, "GreatestStress", {
        value: greatest.value,
        depth: greatest.depth,
        row: greatest.node.1,
        column: greatest.node.0,
    })
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Stress>()?;
    module.add_function(wrap_pyfunction!(stress, module)?)?;
    module.add_function(wrap_pyfunction!(stress_of, module)?)?;
    module.add_function(wrap_pyfunction!(first_yield, module)?)?;
    module.add_function(wrap_pyfunction!(first_yields, module)?)
}
