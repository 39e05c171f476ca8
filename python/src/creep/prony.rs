//! Moduli as Prony series.

use asperity::creep::{self, PronyTerm};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::{Found, Kind, column};
use crate::errors::Fallible;

/// The modulus of a linear viscoelastic body as a Prony series, in its two forms: relaxation and creep.
///
/// ``R(t) = r_inf + sum r exp(-t / rho)`` and ``J(t) = j0 + sum j (1 - exp(-t / tau)) + fluidity t``. Made by one of the static
/// methods below. For a contact it is the plane-strain modulus over the E* of the path: see `relative_to`.
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> rubber = asp.Prony.shares([(0.1, 0.3), (10.0, 0.2)])   # half of the modulus relaxes
/// >>> bool(abs(rubber.creep_at([1e9])[0] - 2.0) < 1e-12)
/// True
#[pyclass(frozen, module = "asperity")]
pub(crate) struct Prony {
    pub(crate) prony: creep::Prony,
    /// The method that has made it, and its arguments: made again, it is the same to the last digit.
    made: (&'static str, Py<PyTuple>),
}

impl Prony {
    fn new<'py>(
        py: Python<'py>,
        prony: creep::Prony,
        method: &'static str,
        arguments: impl IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error = PyErr>,
    ) -> Fallible<Self> {
        Ok(Self { prony, made: (method, arguments.into_pyobject(py)?.unbind()) })
    }
}

/// Times and amounts of some terms.
type Terms = Vec<(f64, f64)>;

fn terms(found: &[PronyTerm]) -> Terms {
    found.iter().map(|term| (term.time, term.amount)).collect()
}

#[pymethods]
impl Prony {
    /// From relaxation.
    ///
    /// Parameters
    /// ----------
    /// equilibrium : float
    ///     Modulus that is left in the end [Pa]; 0 for a body that flows.
    /// terms : list of (float, float)
    ///     Relaxation times [s] and moduli [Pa].
    ///
    /// Returns
    /// -------
    /// Prony
    #[staticmethod]
    fn relaxation(py: Python<'_>, equilibrium: f64, terms: Terms) -> Fallible<Self> {
        let made = creep::Prony::relaxation(equilibrium, &terms)?;
        Self::new(py, made, "relaxation", (equilibrium, terms))
    }

    /// From creep.
    ///
    /// Parameters
    /// ----------
    /// instantaneous : float
    ///     Compliance at once [1/Pa].
    /// terms : list of (float, float)
    ///     Retardation times [s] and compliances [1/Pa].
    /// fluidity : float
    ///     [1/(Pa s)], 0 unless the body flows.
    ///
    /// Returns
    /// -------
    /// Prony
    #[staticmethod]
    #[pyo3(signature = (instantaneous, terms, fluidity=0.0))]
    fn creep(py: Python<'_>, instantaneous: f64, terms: Terms, fluidity: f64) -> Fallible<Self> {
        let made = creep::Prony::creep(instantaneous, &terms, fluidity)?;
        Self::new(py, made, "creep", (instantaneous, terms, fluidity))
    }

    /// As parts of the instantaneous modulus, which is that of the path: the form of finite elements.
    ///
    /// Parameters
    /// ----------
    /// terms : list of (float, float)
    ///     Times [s] and shares that relax. If they add up to 1 the body flows.
    ///
    /// Returns
    /// -------
    /// Prony
    #[staticmethod]
    fn shares(py: Python<'_>, terms: Terms) -> Fallible<Self> {
        let made = creep::Prony::shares(&terms)?;
        Self::new(py, made, "shares", (terms,))
    }

    /// A body that does not creep.
    ///
    /// Parameters
    /// ----------
    /// modulus : float
    ///     [Pa]
    ///
    /// Returns
    /// -------
    /// Prony
    #[staticmethod]
    fn elastic(py: Python<'_>, modulus: f64) -> Fallible<Self> {
        Self::new(py, creep::Prony::elastic(modulus)?, "elastic", (modulus,))
    }

    /// The plane-strain modulus E(t) / (1 - nu²) of a body whose E(t) this is.
    ///
    /// Parameters
    /// ----------
    /// poissons_ratio : float
    ///     Poisson's ratio, which does not depend on time.
    ///
    /// Returns
    /// -------
    /// Prony
    fn plane_strain(slf: &Bound<'_, Self>, poissons_ratio: f64) -> Fallible<Self> {
        let made = slf.get().prony.plane_strain(poissons_ratio)?;
        Self::new(slf.py(), made, "plane_strain", (slf, poissons_ratio))
    }

    /// This body on top of another one: creep functions add up.
    ///
    /// Parameters
    /// ----------
    /// other : Prony
    ///     In the same unit.
    ///
    /// Returns
    /// -------
    /// Prony
    fn in_series(slf: &Bound<'_, Self>, other: &Bound<'_, Self>) -> Fallible<Self> {
        let made = slf.get().prony.in_series(&other.get().prony)?;
        Self::new(slf.py(), made, "in_series", (slf, other))
    }

    /// The same modulus over another one: over the E* of a path.
    ///
    /// Parameters
    /// ----------
    /// modulus : float
    ///     [Pa]
    ///
    /// Returns
    /// -------
    /// Prony
    fn relative_to(slf: &Bound<'_, Self>, modulus: f64) -> Fallible<Self> {
        let made = slf.get().prony.relative_to(modulus)?;
        Self::new(slf.py(), made, "relative_to", (slf, modulus))
    }

    /// The creep function J(t) [1/Pa].
    ///
    /// Parameters
    /// ----------
    /// times : array_like of float
    ///     [s]
    ///
    /// Returns
    /// -------
    /// ndarray of float
    fn creep_at<'py>(
        &self,
        py: Python<'py>,
        times: &Bound<'py, PyAny>,
    ) -> Fallible<Bound<'py, PyArray1<f64>>> {
        let times = Found::of(times, "times", Kind::Real)?.list()?;
        Ok(column(py, times.iter().map(|time| self.prony.creep_at(*time)).collect()))
    }

    /// The relaxation function R(t) [Pa].
    ///
    /// Parameters
    /// ----------
    /// times : array_like of float
    ///     [s]
    ///
    /// Returns
    /// -------
    /// ndarray of float
    fn relaxation_at<'py>(
        &self,
        py: Python<'py>,
        times: &Bound<'py, PyAny>,
    ) -> Fallible<Bound<'py, PyArray1<f64>>> {
        let times = Found::of(times, "times", Kind::Real)?.list()?;
        Ok(column(py, times.iter().map(|time| self.prony.relaxation_at(*time)).collect()))
    }

    /// Terms of relaxation: times [s] and moduli [Pa].
    #[getter]
    fn relaxation_terms(&self) -> Terms {
        terms(self.prony.relaxation_terms())
    }

    /// Terms of creep: times [s] and compliances [1/Pa].
    #[getter]
    fn creep_terms(&self) -> Terms {
        terms(self.prony.creep_terms())
    }

    /// Modulus that is left in the end [Pa].
    #[getter]
    fn equilibrium_modulus(&self) -> f64 {
        self.prony.equilibrium_modulus()
    }

    /// Modulus at once [Pa].
    #[getter]
    fn instantaneous_modulus(&self) -> f64 {
        self.prony.instantaneous_modulus()
    }

    /// Fluidity [1/(Pa s)], 0 unless the body flows.
    #[getter]
    fn fluidity(&self) -> f64 {
        self.prony.fluidity()
    }

    fn __eq__(&self, other: PyRef<'_, Self>) -> bool {
        self.prony == other.prony
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> Fallible<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, (method, arguments)) = (slf.py(), &slf.get().made);
        Ok((py.get_type::<Self>().getattr(*method)?, arguments.bind(py).clone()))
    }

    fn __repr__(&self) -> String {
        let (at_once, left) = (self.instantaneous_modulus(), self.equilibrium_modulus());
        let terms = self.prony.relaxation_terms().len();
        format!("<Prony: {at_once:e} Pa at once, {left:e} Pa in the end, {terms} terms>")
    }
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Prony>()
}
