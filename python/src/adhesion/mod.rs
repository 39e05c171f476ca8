//! Surfaces that stick: the law, the path, and its branches.

mod branch;
mod path;

use asperity::adhesion as engine;
use pyo3::prelude::*;

use crate::errors::Fallible;
pub(crate) use path::{AdhesivePath, set_up};

/// How much two surfaces stick: the pull on a gap, which `load_path` takes as `adhesion`.
///
/// The pull is the cohesive stress where the gap is short, and falls in proportion to the gap to 0 at the range; the
/// work of adhesion is the area under it.
///
/// Parameters
/// ----------
/// work_of_adhesion : float
///     Work of adhesion w [J/m²].
/// adhesion_range : float, optional
///     Gap [m] at which the pull ends; the shortest that the cells resolve unless it is given, which is the limit of JKR
///     on this grid.
/// cohesive_stress : float, optional
///     Greatest pull [Pa], in the law of Maugis; without it the pull falls from 2w over the range.
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> asp.Adhesion(0.05, adhesion_range=5e-9)
/// <Adhesion: 5.000000e-2 J/m², range 5.000000e-9 m>
#[pyclass(frozen, eq, module = "asperity")]
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Adhesion {
    work: f64,
    range: Option<f64>,
    stress: Option<f64>,
}

impl Adhesion {
    /// That of the engine.
    pub(crate) fn law(self) -> engine::Adhesion {
        let law = match self.stress {
            Some(stress) => engine::Adhesion::maugis(self.work, stress),
            None => engine::Adhesion::work(self.work),
        };
        self.range.into_iter().fold(law, engine::Adhesion::range)
    }
}

#[pymethods]
impl Adhesion {
    #[new]
    #[pyo3(signature = (work_of_adhesion, *, adhesion_range=None, cohesive_stress=None))]
    fn new(
        work_of_adhesion: f64,
        adhesion_range: Option<f64>,
        cohesive_stress: Option<f64>,
    ) -> Fallible<Self> {
        let law = Self { work: work_of_adhesion, range: adhesion_range, stress: cohesive_stress };
        law.law().check()?;
        Ok(law)
    }

    /// Work of adhesion w [J/m²].
    #[getter]
    fn work_of_adhesion(&self) -> f64 {
        self.work
    }

    /// Gap [m] at which the pull ends; None for the shortest that the cells resolve.
    #[getter]
    fn adhesion_range(&self) -> Option<f64> {
        self.range
    }

    /// Greatest pull [Pa]; None where it follows from work and range.
    #[getter]
    fn cohesive_stress(&self) -> Option<f64> {
        self.stress
    }

    fn __getnewargs_ex__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<((f64,), Bound<'py, pyo3::types::PyDict>)> {
        let more = pyo3::types::PyDict::new(py);
        more.set_item("adhesion_range", self.range)?;
        more.set_item("cohesive_stress", self.stress)?;
        Ok(((self.work,), more))
    }

    fn __repr__(&self) -> String {
        let range = self.range.map_or_else(String::new, |range| format!(", range {range:.6e} m"));
        let stress = self.stress.map_or_else(String::new, |s| format!(", at most {s:.6e} Pa"));
        format!("<Adhesion: {:.6e} J/m²{range}{stress}>", self.work)
    }
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Adhesion>()?;
    branch::register(module)?;
    path::register(module)
}
