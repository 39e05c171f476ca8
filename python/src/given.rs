//! What paths and single loads are given: a surface on a half-space, and a hardness.

use asperity::nalgebra::DMatrix;
use asperity::{Boundary, Grid, Warning};
use pyo3::prelude::*;

use crate::arrays::{Found, Kind};
use crate::compute::detached;
use crate::errors::Fallible;
use crate::half_space::HalfSpace;
use crate::surface::Surface;
use crate::warnings::{warn, warn_all};

/// A hardness: one number, or a map.
pub(crate) enum Hardness {
    Same(f64),
    Map(DMatrix<f64>),
}

impl Hardness {
    pub(crate) fn of(value: &Bound<'_, PyAny>, grid: &Grid) -> Fallible<Self> {
        match value.extract::<f64>() {
            Ok(hardness) => Ok(Self::Same(hardness)),
            Err(_) => Ok(Self::Map(Found::of(value, "hardness", Kind::Real)?.on(grid)?)),
        }
    }
}

/// Warns of what looks wrong with a surface on a half-space, and with a hardness that is one number.
pub(crate) fn warn_of(
    py: Python<'_>,
    surface: &Surface,
    body: &HalfSpace,
    hardness: Option<&Bound<'_, PyAny>>,
) -> Fallible<()> {
    let topography = surface.topography()?;
    warn_all(py, detached(py, || Warning::of_surface(topography))?)?;
    warn_all(py, body.warnings(surface.grid()))?;
    let hardness = hardness.and_then(|hardness| hardness.extract::<f64>().ok());
    let pair = hardness.zip(body.modulus());
    warn_all(py, pair.and_then(|(hardness, e_star)| Warning::of_hardness(hardness, e_star)))?;
    if surface.periodic() == Some(true) && body.surroundings() == Boundary::Free {
        warn(
            py,
            "the surface is said to be periodic, but the half-space is free: its edge is real there",
        )?;
    }
    Ok(())
}
