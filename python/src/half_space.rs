//! The elastic body.

use asperity::kernel::{self, Base, InfluenceKernel, KernelTable, Layer, Layered, LayeredBody};
use asperity::surface::Axis;
use asperity::{
    Boundary, Boussinesq, ContactGrowth, Error, Grid, MeanDisplacement, PeriodicBoussinesq,
    SemiPeriodicBoussinesq, Spectral, Warning,
};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use pyo3::{PyTraverseError, PyVisit};

use crate::argument::one_of;
use crate::arrays::{Found, Kind, column};
use crate::choice::{BOUNDARIES, Repeats, choose, word};
use crate::compute::detached;
use crate::errors::{Failure, Fallible};
use crate::materials;
use crate::own_kernels;
use crate::results::result;
use crate::surface::Surface;

/// An elastic half-space, or another body that answers alike everywhere.
///
/// It has no grid: that comes with the surface.
///
/// Parameters
/// ----------
/// e_star : float
///     Composite modulus [Pa], ``1/E* = (1 - nu1²)/E1 + (1 - nu2²)/E2``: see `composite_modulus`.
/// boundary : {"free", "love", "spectral", "x", "y"}
///     What surrounds the surface. There is no default, because each choice is wrong where another is meant.
///
///     * ``"free"``: nothing; right for a sample of finite size.
///     * ``"love"``: the surface repeats with its sides; exact for a uniform pressure on each cell.
///     * ``"spectral"``: the same, seen by the waves of the grid alone, 2/(E* \|q\|): the kernel of tamaas and of
///       ContactMechanics.
///     * ``"x"``, ``"y"``: the surface repeats along this side, and nothing is beyond the other; exact for a uniform pressure
///       on each cell. Right for a strip of a profile that goes on, such as a roller's.
///
/// See Also
/// --------
/// HalfSpace.layered : coated, thin and graded bodies.
/// HalfSpace.from_symbol : a body of your own, from a function of the wavevector.
/// HalfSpace.from_coefficients : a body of your own, from influence coefficients.
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> asp.HalfSpace(asp.composite_modulus((210e9, 0.3), (70e9, 0.33)), boundary="free")
/// HalfSpace(e_star=58605196327.4077, boundary='free')
#[pyclass(frozen, module = "asperity")]
pub(crate) struct HalfSpace {
    body: Body,
    e_star: Option<f64>,
    /// Young's modulus \[Pa\] and Poisson's ratio of each elastic body of a half-space, if they are known.
    bodies: Vec<(f64, f64)>,
}

/// What answers.
enum Body {
    HalfSpace(Surroundings),
    Layers { body: LayeredBody, around: Around },
    Symbol { symbol: Py<PyAny>, mean: MeanDisplacement, growth: ContactGrowth },
    Coefficients(Coefficients),
}

/// Influence coefficients of the user.
struct Coefficients {
    function: Py<PyAny>,
    boundary: Boundary,
    mean: MeanDisplacement,
    growth: ContactGrowth,
}

/// What surrounds the grid, and what pressure is between nodes: the same along both sides.
#[derive(Clone, Copy, PartialEq)]
enum Around {
    Free,
    Love,
    Spectral,
}

/// The same along both sides, or periodic along one of them.
#[derive(Clone, Copy, PartialEq)]
enum Surroundings {
    Both(Around),
    Along(Axis),
}

const AROUND: [(&str, Around); 3] =
    [("free", Around::Free), ("love", Around::Love), ("spectral", Around::Spectral)];
const SURROUNDINGS: [(&str, Surroundings); 5] = [
    ("free", Surroundings::Both(Around::Free)),
    ("love", Surroundings::Both(Around::Love)),
    ("spectral", Surroundings::Both(Around::Spectral)),
    ("x", Surroundings::Along(Axis::X)),
    ("y", Surroundings::Along(Axis::Y)),
];

/// A layer: Young's modulus, Poisson's ratio and thickness, or a name and the thickness.
enum LayerArgument {
    Numbers((f64, f64, f64)),
    Named((String, f64)),
}
one_of!(
    LayerArgument,
    "a layer (Young's modulus, Poisson's ratio, thickness) or (name, thickness)",
    Numbers,
    Named
);

/// A kernel on its grid.
pub(crate) type Kernel = Box<dyn InfluenceKernel + Send + Sync>;

const MEANS: [(&str, MeanDisplacement); 2] =
    [("arbitrary", MeanDisplacement::Arbitrary), ("physical", MeanDisplacement::Physical)];
const GROWTHS: [(&str, ContactGrowth); 3] = [
    ("unknown", ContactGrowth::Unknown),
    ("monotone", ContactGrowth::Monotone),
    ("convex", ContactGrowth::Convex),
];

impl HalfSpace {
    fn of(body: Body, e_star: Option<f64>) -> Self {
        Self { body, e_star, bodies: Vec::new() }
    }

    /// A half-space of the engine.
    pub(crate) fn of_origin(origin: &kernel::KernelOrigin) -> Option<Self> {
        use kernel::KernelOrigin as Origin;
        let layered = |body: &LayeredBody, around| {
            let e_star = Some(body.surface_modulus());
            Some(Self::of(Body::Layers { body: body.clone(), around }, e_star))
        };
        let (surroundings, e_star) = match origin {
            Origin::Layered { body } => return layered(body, Around::Free),
            Origin::PeriodicLayered { body } => return layered(body, Around::Love),
            Origin::SpectralLayered { body } => return layered(body, Around::Spectral),
            Origin::Boussinesq { e_star } => (Surroundings::Both(Around::Free), *e_star),
            Origin::PeriodicBoussinesq { e_star } => (Surroundings::Both(Around::Love), *e_star),
            Origin::Spectral { e_star } => (Surroundings::Both(Around::Spectral), *e_star),
            Origin::SemiPeriodicBoussinesq { e_star, boundary } => {
                let axis = if *boundary == Boundary::PeriodicX { Axis::X } else { Axis::Y };
                (Surroundings::Along(axis), *e_star)
            }
            _ => return None,
        };
        Some(Self::of(Body::HalfSpace(surroundings), Some(e_star)))
    }

    /// The influence coefficients on a grid.
    pub(crate) fn kernel(&self, py: Python<'_>, grid: Grid) -> Fallible<Kernel> {
        // None of these has no modulus.
        let e_star = self.e_star.unwrap_or(f64::NAN);
        fn boxed<K: InfluenceKernel + Send + Sync + 'static>(kernel: K) -> Kernel {
            Box::new(kernel)
        }
        match &self.body {
            Body::HalfSpace(surroundings) => {
                let surroundings = *surroundings;
                let made = detached(py, || -> Result<Kernel, Error> {
                    Ok(match surroundings {
                        Surroundings::Both(Around::Free) => boxed(Boussinesq::new(grid, e_star)?),
                        Surroundings::Both(Around::Love) => {
                            boxed(PeriodicBoussinesq::new(grid, e_star)?)
                        }
                        Surroundings::Both(Around::Spectral) => boxed(Spectral::new(grid, e_star)?),
                        Surroundings::Along(axis) => {
                            boxed(SemiPeriodicBoussinesq::new(grid, e_star, axis)?)
                        }
                    })
                })??;
                Ok(made)
            }
            Body::Layers { body, around } => {
                let (body, around) = (body.clone(), *around);
                let made = detached(py, || match around {
                    Around::Free => Layered::free(grid, body),
                    Around::Love => Layered::periodic(grid, body),
                    Around::Spectral => Layered::spectral(grid, body),
                })??;
                Ok(boxed(made))
            }
            Body::Symbol { symbol, mean, growth } => {
                Ok(boxed(own_kernels::of_symbol(symbol.bind(py), grid, *mean, *growth)?))
            }
            Body::Coefficients(Coefficients { function, boundary, mean, growth }) => {
                let function = function.bind(py);
                let table = own_kernels::of_coefficients(function, grid, *boundary, *growth)?;
                Ok(boxed(table.with_mean_displacement(*mean)))
            }
        }
    }

    /// What surrounds the grid.
    pub(crate) fn surroundings(&self) -> Boundary {
        match &self.body {
            Body::HalfSpace(Surroundings::Along(Axis::X)) => Boundary::PeriodicX,
            Body::HalfSpace(Surroundings::Along(Axis::Y)) => Boundary::PeriodicY,
            Body::HalfSpace(Surroundings::Both(Around::Free))
            | Body::Layers { around: Around::Free, .. } => Boundary::Free,
            Body::HalfSpace(_) | Body::Layers { .. } | Body::Symbol { .. } => Boundary::Periodic,
            Body::Coefficients(Coefficients { boundary, .. }) => *boundary,
        }
    }

    pub(crate) fn modulus(&self) -> Option<f64> {
        self.e_star
    }

    /// Young's modulus \[Pa\] and Poisson's ratio of each elastic body, if they are known.
    pub(crate) fn elastic_bodies(&self) -> &[(f64, f64)] {
        &self.bodies
    }

    /// What looks wrong with it on a grid.
    pub(crate) fn warnings(&self, grid: &Grid) -> impl Iterator<Item = Warning> {
        let layers = match &self.body {
            Body::Layers { body, .. } => Warning::of_layers(body, grid),
            _ => None,
        };
        self.e_star.and_then(Warning::of_modulus).into_iter().chain(layers)
    }
}

#[pymethods]
impl HalfSpace {
    #[new]
    #[pyo3(signature = (e_star, boundary))]
    fn new(e_star: f64, boundary: &str) -> Fallible<Self> {
        let e_star = checked(e_star)?;
        let surroundings = choose("boundary", boundary, &SURROUNDINGS)?;
        Ok(Self::of(Body::HalfSpace(surroundings), Some(e_star)))
    }

    /// Two bodies, of which a path and its record know more than E*: `shear` and `interface_table` then take their ratio of compliances.
    ///
    /// Parameters
    /// ----------
    /// bodies : (body, body)
    ///     Each (E [Pa], nu), the name of one of `materials`, or ``"rigid"`` for the second.
    /// boundary : {"free", "love", "spectral", "x", "y"}
    ///     As of `HalfSpace`.
    ///
    /// Returns
    /// -------
    /// HalfSpace
    ///
    /// Examples
    /// --------
    /// >>> import asperity as asp
    /// >>> asp.HalfSpace.of_bodies(("steel", (70e9, 0.33)), boundary="free").bodies
    /// [(210000000000.0, 0.3), (70000000000.0, 0.33)]
    #[staticmethod]
    #[pyo3(signature = (bodies, boundary))]
    fn of_bodies(bodies: (materials::Body, materials::Body), boundary: &str) -> Fallible<Self> {
        let made = Self::new(materials::modulus(&bodies)?, boundary)?;
        let (first, second) = &bodies;
        let mut known = vec![first.numbers()?];
        if !second.is("rigid") {
            known.push(second.numbers()?);
        }
        Ok(Self { bodies: known, ..made })
    }

    /// A coated, thin or graded body: elastic layers, bonded to each other and to a base.
    ///
    /// Parameters
    /// ----------
    /// layers : list of (float, float, float) or (str, float)
    ///     Young's modulus [Pa], Poisson's ratio and thickness [m] of each, or the name of one of `materials` and the thickness;
    ///     the uppermost first.
    /// base : (float, float) or str
    ///     What the lowest layer is bonded to: ``"rigid"``, or Young's modulus [Pa] and Poisson's ratio of an elastic
    ///     half-space, or its name.
    /// boundary : {"free", "love", "spectral"}
    ///     As of `HalfSpace`: layers repeat in both directions or in none.
    /// against : (float, float) or str, optional
    ///     The other body; rigid unless it is given.
    ///
    /// Returns
    /// -------
    /// HalfSpace
    ///     Its `e_star` is that of the uppermost layer and the other body, which short waves see.
    ///
    /// Notes
    /// -----
    /// A coat that is stiffer than what it lies on may let nodes leave the contact: a path then computes events
    /// together only until a node leaves, which takes longer.
    #[staticmethod]
    #[pyo3(signature = (layers, base, boundary, *, against=None))]
    fn layered(
        layers: Vec<LayerArgument>,
        base: materials::Body,
        boundary: &str,
        against: Option<materials::Body>,
    ) -> Fallible<Self> {
        let around = choose("boundary", boundary, &AROUND)?;
        let layers = layers.iter().map(|layer| {
            Ok(match layer {
                LayerArgument::Numbers((youngs_modulus, poissons_ratio, thickness)) => Layer {
                    youngs_modulus: *youngs_modulus,
                    poissons_ratio: *poissons_ratio,
                    thickness: *thickness,
                },
                LayerArgument::Named((name, thickness)) => {
                    let (youngs_modulus, poissons_ratio) = materials::named_numbers(name)?;
                    Layer { youngs_modulus, poissons_ratio, thickness: *thickness }
                }
            })
        });
        let layers = layers.collect::<Fallible<Vec<Layer>>>()?;
        let base = if base.is("rigid") {
            Base::Rigid
        } else {
            let (youngs_modulus, poissons_ratio) = base.numbers()?;
            Base::HalfSpace { youngs_modulus, poissons_ratio }
        };
        let mut body = LayeredBody::new(&layers, base)?;
        if let Some(other) = against.filter(|other| !other.is("rigid")) {
            let (youngs_modulus, poissons_ratio) = other.numbers()?;
            body = body.against(asperity::plane_strain_modulus(youngs_modulus, poissons_ratio)?)?;
        }
        let e_star = Some(body.surface_modulus());
        Ok(Self::of(Body::Layers { body, around }, e_star))
    }

    /// A periodic body from its symbol: anisotropic bodies, foundations, laws of your own.
    ///
    /// Parameters
    /// ----------
    /// symbol : callable
    ///     ``symbol(qx, qy)``: displacement over pressure [m/Pa] of the wave ``exp(i q.x)``, for arrays of wavevectors
    ///     [rad/m] in one dimension, called once. It must be positive, and even under q -> -q.
    /// mean_displacement : {"arbitrary", "physical"}
    ///     Whether the mean displacement under a net load is a property of the body, as of a layer on a rigid base; the
    ///     symbol is then asked for q = 0 too.
    /// growth : {"unknown", "monotone", "convex"}
    ///     How contact is known to grow: see `check_half_space`. ``"unknown"`` is always right and costs a path most.
    /// e_star : float, optional
    ///     A modulus [Pa] that greatest pressures are compared with, for warnings.
    ///
    /// Returns
    /// -------
    /// HalfSpace
    #[staticmethod]
    #[pyo3(signature = (symbol, *, mean_displacement="arbitrary", growth="unknown", e_star=None))]
    fn from_symbol(
        symbol: Bound<'_, PyAny>,
        mean_displacement: &str,
        growth: &str,
        e_star: Option<f64>,
    ) -> Fallible<Self> {
        let mean = choose("mean_displacement", mean_displacement, &MEANS)?;
        let growth = choose("growth", growth, &GROWTHS)?;
        let symbol = callable(symbol, "symbol")?;
        let e_star = e_star.map(checked).transpose()?;
        Ok(Self::of(Body::Symbol { symbol, mean, growth }, e_star))
    }

    /// A body from its influence coefficients.
    ///
    /// Parameters
    /// ----------
    /// coefficients : callable
    ///     ``coefficients(di, dj)``: displacement [m/Pa] at an offset of di columns and dj rows from a cell under unit
    ///     pressure, for arrays of whole numbers in one dimension, called once. C(-di, -dj) must be C(di, dj).
    /// boundary : {"free", "periodic", "x", "y"}
    ///     With ``"periodic"`` the coefficients repeat with the grid, with ``"x"`` or ``"y"`` along this side alone.
    /// mean_displacement : {"arbitrary", "physical"}
    ///     As of `from_symbol`; it matters on a periodic body only.
    /// growth : {"unknown", "monotone", "convex"}
    ///     As of `from_symbol`.
    /// e_star : float, optional
    ///     A modulus [Pa] that greatest pressures are compared with, for warnings.
    ///
    /// Returns
    /// -------
    /// HalfSpace
    #[staticmethod]
    #[pyo3(signature = (coefficients, *, boundary, mean_displacement="arbitrary", growth="unknown", e_star=None))]
    fn from_coefficients(
        coefficients: Bound<'_, PyAny>,
        boundary: &str,
        mean_displacement: &str,
        growth: &str,
        e_star: Option<f64>,
    ) -> Fallible<Self> {
        let body = Body::Coefficients(Coefficients {
            boundary: choose("boundary", boundary, &BOUNDARIES)?,
            mean: choose("mean_displacement", mean_displacement, &MEANS)?,
            growth: choose("growth", growth, &GROWTHS)?,
            function: callable(coefficients, "coefficients")?,
        });
        Ok(Self::of(body, e_star.map(checked).transpose()?))
    }

    /// Young's modulus [Pa] and Poisson's ratio of each elastic body, if they are known: of one if the other is rigid.
    #[getter]
    fn bodies(&self) -> Vec<(f64, f64)> {
        self.bodies.clone()
    }

    /// For the garbage collector: functions may refer to what has this body.
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        match &self.body {
            Body::Symbol { symbol: function, .. }
            | Body::Coefficients(Coefficients { function, .. }) => visit.call(function),
            Body::HalfSpace(_) | Body::Layers { .. } => Ok(()),
        }
    }

    /// Composite modulus [Pa]; None if it was not given.
    #[getter]
    fn e_star(&self) -> Option<f64> {
        self.e_star
    }

    /// ``"free"``, ``"love"``, ``"spectral"``, ``"x"`` or ``"y"``; of a body of your own ``"symbol"`` or ``"coefficients"``.
    #[getter]
    fn boundary(&self) -> &'static str {
        match &self.body {
            Body::HalfSpace(surroundings) => word(&SURROUNDINGS, surroundings),
            Body::Layers { around, .. } => word(&AROUND, around),
            Body::Symbol { .. } => "symbol",
            Body::Coefficients(_) => "coefficients",
        }
    }

    /// Whether surface and body repeat with the sides of the grid, or ``"x"`` or ``"y"`` if they do along one.
    #[getter]
    fn periodic(&self) -> Repeats {
        Repeats::of(self.surroundings())
    }

    /// Sum of the thicknesses of all layers [m]; None without layers.
    #[getter]
    fn thickness(&self) -> Option<f64> {
        match &self.body {
            Body::Layers { body, .. } => Some(body.thickness()),
            _ => None,
        }
    }

    /// Young's modulus [Pa], Poisson's ratio and thickness [m] of each layer, the uppermost first; None without layers.
    #[getter]
    fn layers(&self) -> Option<Vec<(f64, f64, f64)>> {
        let Body::Layers { body, .. } = &self.body else { return None };
        let numbers = |layer: &Layer| (layer.youngs_modulus, layer.poissons_ratio, layer.thickness);
        Some(body.layers().iter().map(numbers).collect())
    }

    /// Young's modulus [Pa] and Poisson's ratio of what the layers lie on; None if it is rigid, and without layers.
    #[getter]
    fn base(&self) -> Option<(f64, f64)> {
        match &self.body {
            Body::Layers { body, .. } => match body.base() {
                Base::HalfSpace { youngs_modulus, poissons_ratio } => {
                    Some((youngs_modulus, poissons_ratio))
                }
                Base::Rigid => None,
            },
            _ => None,
        }
    }

    /// Displacement over pressure of waves [m/Pa] of a body with layers: what it is, as a function of the wave number.
    ///
    /// Parameters
    /// ----------
    /// wave_numbers : array_like of float
    ///     2 pi over the wavelengths [rad/m].
    ///
    /// Returns
    /// -------
    /// ndarray of float
    ///     That of a half-space would be ``2 / (e_star * q)``, which is what short waves see.
    fn compliance<'py>(
        &self,
        py: Python<'py>,
        wave_numbers: &Bound<'py, PyAny>,
    ) -> Fallible<Bound<'py, PyArray1<f64>>> {
        let waves = Found::of(wave_numbers, "wave_numbers", Kind::Real)?.list()?;
        let Body::Layers { body, .. } = &self.body else {
            return Err(Failure::arguments(
                "the body has no layers: its compliance is 2 / (e_star q)",
            ));
        };
        Ok(column(py, waves.iter().map(|q| body.compliance(*q)).collect()))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> Fallible<Bound<'py, PyTuple>> {
        let (py, this) = (slf.py(), slf.get());
        if let Body::Layers { body, .. } = &this.body {
            let restore = py.import("asperity._asperity")?.getattr("_restore_layers")?;
            let data = serde_json::to_string(body);
            let data = data.map_err(|error| Failure::arguments(error.to_string()))?;
            return Ok((restore, (data, this.boundary())).into_pyobject(py)?);
        }
        let restore = py.import("asperity._asperity")?.getattr("_restore_half_space")?;
        let (function, words) = match &this.body {
            Body::Symbol { symbol, mean, growth } => {
                (Some(symbol), ["", word(&MEANS, mean), word(&GROWTHS, growth)])
            }
            Body::Coefficients(Coefficients { function, boundary, mean, growth }) => (
                Some(function),
                [word(&BOUNDARIES, boundary), word(&MEANS, mean), word(&GROWTHS, growth)],
            ),
            _ => (None, ["", "", ""]),
        };
        let words = words.map(str::to_string);
        let state = (this.boundary(), this.e_star, function, words, this.bodies.clone());
        Ok((restore, state).into_pyobject(py)?)
    }

    fn __repr__(&self, py: Python<'_>) -> Fallible<String> {
        let own = |name: &str, function: &Py<PyAny>| -> Fallible<String> {
            Ok(format!("HalfSpace.from_{name}({})", function.bind(py).repr()?))
        };
        match &self.body {
            Body::Layers { body, .. } => {
                let count = body.layers().len();
                let (thickness, boundary) = (body.thickness(), self.boundary());
                let plural = if count == 1 { "layer" } else { "layers" };
                Ok(format!(
                    "<HalfSpace of {count} {plural}, {thickness:e} m; boundary '{boundary}'>"
                ))
            }
            Body::Symbol { symbol, .. } => own("symbol", symbol),
            Body::Coefficients(Coefficients { function, .. }) => own("coefficients", function),
            _ => {
                let e_star = self.e_star.unwrap_or(f64::NAN).into_pyobject(py)?.repr()?;
                Ok(format!("HalfSpace(e_star={e_star}, boundary='{}')", self.boundary()))
            }
        }
    }
}

/// A composite modulus \[Pa\] that is one.
fn checked(e_star: f64) -> Result<f64, Error> {
    match e_star > 0.0 && e_star.is_finite() {
        true => Ok(e_star),
        false => Err(Error::NotPositive { quantity: "composite modulus", value: e_star }),
    }
}

fn callable(function: Bound<'_, PyAny>, name: &str) -> Fallible<Py<PyAny>> {
    if function.is_callable() {
        Ok(function.unbind())
    } else {
        Err(Failure::arguments(format!("{name} must be a function of two arrays")))
    }
}

/// A half-space that was pickled.
#[pyfunction]
fn _restore_half_space(
    boundary: &str,
    e_star: Option<f64>,
    function: Option<Bound<'_, PyAny>>,
    words: [String; 3],
    bodies: Vec<(f64, f64)>,
) -> Fallible<HalfSpace> {
    let [surroundings, mean, growth] = &words;
    match (boundary, function) {
        ("symbol", Some(symbol)) => HalfSpace::from_symbol(symbol, mean, growth, e_star),
        ("coefficients", Some(function)) => {
            HalfSpace::from_coefficients(function, surroundings, mean, growth, e_star)
        }
        _ => Ok(HalfSpace { bodies, ..HalfSpace::new(e_star.unwrap_or(f64::NAN), boundary)? }),
    }
}

/// A body with layers that was pickled.
#[pyfunction]
fn _restore_layers(data: &str, boundary: &str) -> Fallible<HalfSpace> {
    let body: LayeredBody =
        serde_json::from_str(data).map_err(|error| Failure::arguments(error.to_string()))?;
    let around = choose("boundary", boundary, &AROUND)?;
    let e_star = Some(body.surface_modulus());
    Ok(HalfSpace::of(Body::Layers { body, around }, e_star))
}

/// Test what a body promises, for those who bring their own.
///
/// Coefficients are finite, symmetric and periodic, the influence matrix is positive definite, and contact grows as
/// promised: on some 250 sets of nodes, or on all of them on a grid of up to ten nodes.
///
/// Parameters
/// ----------
/// surface : Surface
///     For its grid.
/// half_space : HalfSpace
///
/// Returns
/// -------
/// results.KernelReport
///
/// Raises
/// ------
/// AsperityError
///     Of the kind ``"BrokenPromise"``, with the set of nodes, the node and the value.
#[pyfunction]
fn check_half_space<'py>(
    py: Python<'py>,
    surface: PyRef<'py, Surface>,
    half_space: PyRef<'py, HalfSpace>,
) -> Fallible<Bound<'py, PyAny>> {
    let kernel = half_space.kernel(py, *surface.grid())?;
    let report = detached(py, || kernel::check(&*kernel))??;
    result!(py, "KernelReport", {
        contact_sets: report.contact_sets,
        largest_contact: report.largest_contact,
        exhaustive: report.exhaustive,
        least_symbol: report.least_symbol,
        promised_growth: word(&GROWTHS, &report.promised_growth),
        supported_growth: word(&GROWTHS, &report.supported_growth),
    })
}

/// The coefficients of a kernel that a body has on a grid, for tests of bodies of one's own.
///
/// Parameters
/// ----------
/// surface : Surface
///     For its grid.
/// half_space : HalfSpace
///
/// Returns
/// -------
/// ndarray of float, [row, column]
///     Displacement [m/Pa] of each node under unit pressure on node (0, 0).
#[pyfunction]
fn influence<'py>(
    py: Python<'py>,
    surface: PyRef<'py, Surface>,
    half_space: PyRef<'py, HalfSpace>,
) -> Fallible<Bound<'py, numpy::PyArray2<f64>>> {
    let grid = *surface.grid();
    let kernel = half_space.kernel(py, grid)?;
    let table = detached(py, || KernelTable::new(&*kernel))??;
    let (nx, ny) = grid.shape();
    let field = asperity::nalgebra::DMatrix::from_fn(nx, ny, |ix, iy| {
        table.coefficient(ix as isize, iy as isize).unwrap_or(f64::NAN)
    });
    crate::arrays::rows(py, field)
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<HalfSpace>()?;
    module.add_function(wrap_pyfunction!(_restore_half_space, module)?)?;
    module.add_function(wrap_pyfunction!(_restore_layers, module)?)?;
    module.add_function(wrap_pyfunction!(check_half_space, module)?)?;
    module.add_function(wrap_pyfunction!(influence, module)?)
}
