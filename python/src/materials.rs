//! Moduli and hardnesses of bodies.

use asperity::material::{HardnessScale, Material};
use asperity::slip::Friction;
use asperity::{composite_modulus as composite, plane_strain_modulus as plane_strain};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::argument::one_of;
use crate::errors::{Failure, Fallible};
use crate::results::result;

/// A body by its name, or by Young's modulus and Poisson's ratio.
pub(crate) enum Body {
    Named(String),
    Numbers((f64, f64)),
}
one_of!(Body, "(Young's modulus, Poisson's ratio) or the name of a material", Named, Numbers);

impl Body {
    /// Young's modulus \[Pa\] and Poisson's ratio.
    pub(crate) fn numbers(&self) -> Fallible<(f64, f64)> {
        match self {
            Self::Numbers(numbers) => Ok(*numbers),
            Self::Named(name) => named_numbers(name),
        }
    }

    /// Whether it was given by this word.
    pub(crate) fn is(&self, word: &str) -> bool {
        matches!(self, Self::Named(name) if name.eq_ignore_ascii_case(word))
    }
}

/// Friction between two bodies, of which the second may be rigid.
pub(crate) fn friction(coefficient: f64, (first, second): &(Body, Body)) -> Fallible<Friction> {
    let second = if second.is("rigid") { None } else { Some(second.numbers()?) };
    Ok(Friction::between(coefficient, first.numbers()?, second)?)
}

/// E* of two bodies, of which the second may be rigid \[Pa\].
pub(crate) fn modulus((first, second): &(Body, Body)) -> Fallible<f64> {
    let (e, nu) = first.numbers()?;
    if second.is("rigid") {
        return Ok(plane_strain(e, nu)?);
    }
    Ok(composite((e, nu), second.numbers()?)?)
}

/// Those of the material of a name.
pub(crate) fn named_numbers(name: &str) -> Fallible<(f64, f64)> {
    let material = named(name)?;
    Ok((material.youngs_modulus, material.poissons_ratio))
}

fn named(name: &str) -> Fallible<&'static Material> {
    Material::named(name).ok_or_else(|| {
        let names: Vec<&str> = Material::ALL.iter().map(|material| material.name).collect();
        Failure::arguments(format!("no material is called '{name}': {} are", names.join(", ")))
    })
}

/// Composite modulus of two bodies [Pa], ``1/E* = (1 - nu1²)/E1 + (1 - nu2²)/E2``.
///
/// Parameters
/// ----------
/// first : (float, float) or str
///     Young's modulus [Pa] and Poisson's ratio, or the name of one of `materials`.
/// second : (float, float) or str, optional
///     The other body, or "rigid"; rigid unless it is given.
///
/// Returns
/// -------
/// float
///     No factor 2: the E' of elastohydrodynamics is 2 E*.
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> asp.composite_modulus("steel") == 210e9 / (1 - 0.3 * 0.3)
/// True
#[pyfunction]
#[pyo3(signature = (first, second=None))]
fn composite_modulus(first: Body, second: Option<Body>) -> Fallible<f64> {
    let second = second.unwrap_or_else(|| Body::Named("rigid".to_string()));
    modulus(&(first, second))
}

/// Typical values of materials at room temperature.
///
/// Returns
/// -------
/// dict of str to results.Material
///     Young's modulus [Pa], Poisson's ratio, and hardness [Pa] as a mean pressure under an indenter, None where none is
///     known. Those of an alloy or a polymer vary: for results that matter give your own.
#[pyfunction]
fn materials(py: Python<'_>) -> Fallible<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for material in &Material::ALL {
        let values = result!(py, "Material", {
            youngs_modulus: material.youngs_modulus,
            poissons_ratio: material.poissons_ratio,
            hardness: material.hardness,
        })?;
        all.set_item(material.name, values)?;
    }
    Ok(all)
}

/// A hardness [Pa] from a number of Brinell, Vickers or, between 20 and 68, Rockwell C.
///
/// Parameters
/// ----------
/// number : float
/// scale : {"HB", "HV", "HRC"}
///     HRC by ASTM E140 for carbon and alloy steels, within 1.5 %.
///
/// Returns
/// -------
/// float
///     Mean pressure under the indenter [Pa].
#[pyfunction]
#[pyo3(signature = (number, scale))]
fn hardness(number: f64, scale: &str) -> Fallible<f64> {
    const SCALES: [(&str, HardnessScale); 3] = [
        ("HB", HardnessScale::Brinell),
        ("HV", HardnessScale::Vickers),
        ("HRC", HardnessScale::RockwellC),
    ];
    Ok(crate::choice::choose("scale", scale, &SCALES)?.pascals(number)?)
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(composite_modulus, module)?)?;
    module.add_function(wrap_pyfunction!(materials, module)?)?;
    module.add_function(wrap_pyfunction!(hardness, module)?)
}
