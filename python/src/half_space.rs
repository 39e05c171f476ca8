//! The elastic body.

use asperity::kernel::{self, InfluenceKernel, KernelTable};
use asperity::{
    Boundary, Boussinesq, ContactGrowth, Error, Grid, MeanDisplacement, PeriodicBoussinesq,
    Spectral, Warning,
};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::{Found, Kind, column};
use crate::choice::choose;
use crate::compute::detached;
use crate::errors::{Failure, Fallible};
use crate::layered::{Layers, Lowest, Parts};
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
/// boundary : {"free", "love", "spectral"}
///     What surrounds the surface. There is no default, because either choice does harm where the other is meant.
///
///     * ``"free"``: nothing; right for a sample of finite size.
///     * ``"love"``: the surface repeats with its sides; exact for a uniform pressure on each cell.
///     * ``"spectral"``: the same, seen by the waves of the grid alone, 2/(E* \|q\|): the kernel of tamaas and of
///       ContactMechanics.
///
/// See Also
/// --------
/// HalfSpace.layered : coats, thin films and graded bodies.
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
}

/// What answers.
enum Body {
    Free,
    Love,
    Spectral,
    Layered(Layers),
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

/// A kernel on its grid.
pub(crate) type Kernel = Box<dyn InfluenceKernel + Send + Sync>;

const BOUNDARIES: [(&str, Boundary); 2] =
    [("free", Boundary::Free), ("periodic", Boundary::Periodic)];
const MEANS: [(&str, MeanDisplacement); 2] =
    [("arbitrary", MeanDisplacement::Arbitrary), ("physical", MeanDisplacement::Physical)];
const GROWTHS: [(&str, ContactGrowth); 3] = [
    ("unknown", ContactGrowth::Unknown),
    ("monotone", ContactGrowth::Monotone),
    ("convex", ContactGrowth::Convex),
];

/// The word of a choice.
fn word<T: PartialEq>(choices: &[(&'static str, T)], choice: &T) -> &'static str {
    choices.iter().find(|(_, known)| known == choice).map_or("", |(word, _)| *word)
}

impl HalfSpace {
    /// A half-space of the engine.
    pub(crate) fn of_origin(origin: &kernel::KernelOrigin) -> Option<Self> {
        if let Some(layers) = Layers::of_origin(origin) {
            return Some(Self::of_layers(layers));
        }
        use kernel::KernelOrigin as Origin;
        let (body, e_star) = match origin {
            Origin::Boussinesq { e_star } => (Body::Free, *e_star),
            Origin::PeriodicBoussinesq { e_star } => (Body::Love, *e_star),
            Origin::Spectral { e_star } => (Body::Spectral, *e_star),
            _ => return None,
        };
        Some(Self { body, e_star: Some(e_star) })
    }

    fn of_layers(layers: Layers) -> Self {
        let e_star = layers.surface_modulus();
        Self { body: Body::Layered(layers), e_star: Some(e_star) }
    }

    fn layers_of(&self) -> Option<&Layers> {
        match &self.body {
            Body::Layered(layers) => Some(layers),
            _ => None,
        }
    }

    /// The influence coefficients on a grid.
    pub(crate) fn kernel(&self, py: Python<'_>, grid: Grid) -> Fallible<Kernel> {
        // None of these has no modulus.
        let e_star = self.e_star.unwrap_or(f64::NAN);
        fn boxed<K: InfluenceKernel + Send + Sync + 'static>(kernel: K) -> Kernel {
            Box::new(kernel)
        }
        match &self.body {
            Body::Free => Ok(boxed(Boussinesq::new(grid, e_star)?)),
            Body::Love => Ok(boxed(detached(py, || PeriodicBoussinesq::new(grid, e_star))??)),
            Body::Spectral => Ok(boxed(detached(py, || Spectral::new(grid, e_star))??)),
            Body::Layered(layers) => Ok(detached(py, || layers.kernel(grid))??),
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
            Body::Free => Boundary::Free,
            Body::Layered(layers) => layers.boundary(),
            Body::Coefficients(Coefficients { boundary, .. }) => *boundary,
            _ => Boundary::Periodic,
        }
    }

    pub(crate) fn modulus(&self) -> Option<f64> {
        self.e_star
    }

    /// What looks wrong with the modulus.
    pub(crate) fn warnings(&self) -> Option<Warning> {
        self.e_star.and_then(Warning::of_modulus)
    }
}

#[pymethods]
impl HalfSpace {
    #[new]
    #[pyo3(signature = (e_star, boundary))]
    fn new(e_star: f64, boundary: &str) -> Fallible<Self> {
        if !(e_star > 0.0 && e_star.is_finite()) {
            return Err(Error::NotPositive { quantity: "composite modulus", value: e_star }.into());
        }
        let body = match boundary {
            "free" => Body::Free,
            "love" => Body::Love,
            "spectral" => Body::Spectral,
            _ => {
                let known = [("free", ()), ("love", ()), ("spectral", ())];
                choose("boundary", boundary, &known)?;
                Body::Free
            }
        };
        Ok(Self { body, e_star: Some(e_star) })
    }

    /// Elastic layers, bonded to each other and to a base: coats, thin films, graded bodies.
    ///
    /// Parameters
    /// ----------
    /// layers : list of (float, float, float)
    ///     Young's modulus [Pa], Poisson's ratio (up to 1/2) and thickness [m] of each, the uppermost first.
    /// base : "rigid", (float, float) or str
    ///     What the lowest layer is bonded to: a rigid plane, or a half-space by Young's modulus [Pa] and Poisson's ratio
    ///     or the name of one of `materials`.
    /// boundary : {"free", "love", "spectral"}
    ///     As of `HalfSpace`.
    /// against : (float, float) or str, optional
    ///     The other body, an elastic half-space; rigid unless it is given.
    ///
    /// Returns
    /// -------
    /// HalfSpace
    ///     Its `e_star` is that of short waves: of the uppermost layer and the other body.
    ///
    /// Notes
    /// -----
    /// Of layers on a rigid base against a rigid body the mean displacement under a load is physical: the approach is that
    /// of the base. A coat that is stiffer than what it lies on bends, and contact may lose nodes as the approach grows; a
    /// path then finds each event by itself, releases included.
    ///
    /// Examples
    /// --------
    /// >>> import asperity as asp
    /// >>> coated = asp.HalfSpace.layered([(450e9, 0.25, 5e-6)], base="steel", boundary="free")
    /// >>> coated.layers, coated.base
    /// ([(450000000000.0, 0.25, 5e-06)], (210000000000.0, 0.3))
    #[staticmethod]
    #[pyo3(signature = (layers, *, base, boundary, against=None))]
    fn layered(
        layers: Vec<(f64, f64, f64)>,
        base: Lowest,
        boundary: &str,
        against: Option<materials::Body>,
    ) -> Fallible<Self> {
        Ok(Self::of_layers(Layers::of(&layers, &base, against.as_ref(), boundary)?))
    }

    /// A periodic body from its symbol: graded and anisotropic bodies.
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
        Ok(Self { body: Body::Symbol { symbol, mean, growth }, e_star })
    }

    /// A body from its influence coefficients.
    ///
    /// Parameters
    /// ----------
    /// coefficients : callable
    ///     ``coefficients(di, dj)``: displacement [m/Pa] at an offset of di columns and dj rows from a cell under unit
    ///     pressure, for arrays of whole numbers in one dimension, called once. C(-di, -dj) must be C(di, dj).
    /// boundary : {"free", "periodic"}
    ///     With ``"periodic"`` the coefficients repeat with the grid.
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
        Ok(Self { body, e_star })
    }

    /// Composite modulus [Pa]; None if it was not given.
    #[getter]
    fn e_star(&self) -> Option<f64> {
        self.e_star
    }

    /// ``"free"``, ``"love"`` or ``"spectral"``; of a body of your own ``"symbol"`` or ``"coefficients"``.
    #[getter]
    fn boundary(&self) -> &'static str {
        match &self.body {
            Body::Free => "free",
            Body::Love => "love",
            Body::Spectral => "spectral",
            Body::Layered(layers) => layers.word(),
            Body::Symbol { .. } => "symbol",
            Body::Coefficients(_) => "coefficients",
        }
    }

    /// Young's modulus [Pa], Poisson's ratio and thickness [m] of each layer, the uppermost first; None without layers.
    #[getter]
    fn layers(&self) -> Option<Vec<(f64, f64, f64)>> {
        self.layers_of().map(|layers| layers.parts().0)
    }

    /// Young's modulus [Pa] and Poisson's ratio of what the layers lie on; None if it is rigid, and without layers.
    #[getter]
    fn base(&self) -> Option<(f64, f64)> {
        self.layers_of().and_then(|layers| layers.parts().1)
    }

    /// Displacement over pressure of waves on a layered body [m/Pa]: the symbol, as a function of the wave number.
    ///
    /// Parameters
    /// ----------
    /// wave_number : array_like of float
    ///     Wave numbers q = 2 pi / wavelength [rad/m], in one dimension.
    ///
    /// Returns
    /// -------
    /// ndarray of float
    ///     Infinite at q = 0 unless base and other body are rigid; 2/(E* q) of a body without layers.
    fn compliance<'py>(
        &self,
        py: Python<'py>,
        wave_number: &Bound<'py, PyAny>,
    ) -> Fallible<Bound<'py, numpy::PyArray1<f64>>> {
        let waves = Found::of(wave_number, "wave_number", Kind::Real)?.list()?;
        let values = match (&self.body, self.e_star) {
            (Body::Layered(layers), _) => layers.compliance(&waves),
            (Body::Free | Body::Love | Body::Spectral, Some(e_star)) => {
                waves.iter().map(|q| 2.0 / (e_star * q.abs())).collect()
            }
            _ => return Err(Failure::arguments("a body of your own knows its compliance itself")),
        };
        Ok(column(py, values))
    }

    /// Whether surface and body repeat with the sides of the grid.
    #[getter]
    fn is_periodic(&self) -> bool {
        self.surroundings() == Boundary::Periodic
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> Fallible<Bound<'py, PyTuple>> {
        let (py, this) = (slf.py(), slf.get());
        if let Some(layers) = this.layers_of() {
            let restore = py.import("asperity._asperity")?.getattr("_restore_layered")?;
            return Ok((restore, (layers.parts(),)).into_pyobject(py)?);
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
        let state = (this.boundary(), this.e_star, function, words.map(str::to_string));
        Ok((restore, state).into_pyobject(py)?)
    }

    fn __repr__(&self, py: Python<'_>) -> Fallible<String> {
        let own = |name: &str, function: &Py<PyAny>| -> Fallible<String> {
            Ok(format!("HalfSpace.from_{name}({})", function.bind(py).repr()?))
        };
        match &self.body {
            Body::Layered(layers) => layers.repr(py),
            Body::Symbol { symbol, .. } => own("symbol", symbol),
            Body::Coefficients(Coefficients { function, .. }) => own("coefficients", function),
            _ => {
                let e_star = self.e_star.unwrap_or(f64::NAN).into_pyobject(py)?.repr()?;
                Ok(format!("HalfSpace(e_star={e_star}, boundary='{}')", self.boundary()))
            }
        }
    }
}

fn callable(function: Bound<'_, PyAny>, name: &str) -> Fallible<Py<PyAny>> {
    if function.is_callable() {
        Ok(function.unbind())
    } else {
        Err(Failure::arguments(format!("{name} must be a function of two arrays")))
    }
}

/// A layered body that was pickled.
#[pyfunction]
fn _restore_layered(parts: Parts) -> Fallible<HalfSpace> {
    Ok(HalfSpace::of_layers(Layers::of_parts(&parts)?))
}

/// A half-space that was pickled.
#[pyfunction]
fn _restore_half_space(
    boundary: &str,
    e_star: Option<f64>,
    function: Option<Bound<'_, PyAny>>,
    words: [String; 3],
) -> Fallible<HalfSpace> {
    let [surroundings, mean, growth] = &words;
    match (boundary, function) {
        ("symbol", Some(symbol)) => HalfSpace::from_symbol(symbol, mean, growth, e_star),
        ("coefficients", Some(function)) => {
            HalfSpace::from_coefficients(function, surroundings, mean, growth, e_star)
        }
        _ => HalfSpace::new(e_star.unwrap_or(f64::NAN), boundary),
    }
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
    module.add_function(wrap_pyfunction!(_restore_layered, module)?)?;
    module.add_function(wrap_pyfunction!(check_half_space, module)?)?;
    module.add_function(wrap_pyfunction!(influence, module)?)
}
