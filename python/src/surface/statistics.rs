//! Statistics of surfaces.

use asperity::Grid;
use asperity::nalgebra::DMatrix;
use asperity::surface::{
    Axis, Estimate, FittedTrend, MaterialRatio, RadialBins, SpectralBin, Topography, Trend,
};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyString};

use crate::arrays::{Found, Kind, column};
use crate::compute::detached;
use crate::errors::{Failure, Fallible};
use crate::results::result;

pub(super) fn trend<'py>(
    py: Python<'py>,
    (grid, heights): (&Grid, &DMatrix<f64>),
    trend: Trend,
) -> Fallible<Bound<'py, PyAny>> {
    let fitted = detached(py, || FittedTrend::of_measured(grid, heights, trend))??;
    result!(py, "Trend", {
        height: fitted.height(),
        slopes: fitted.slopes(),
        curvatures: fitted.curvatures(),
        tilt: fitted.tilt(),
    })
}

pub(super) fn moments<'py>(py: Python<'py>, surface: &Topography) -> Fallible<Bound<'py, PyAny>> {
    let moments = detached(py, || surface.spectral_moments())?;
    result!(py, "SpectralMoments", {
        m0: moments.m0(),
        m2: moments.m2(),
        m4: moments.m4(),
        rms_height: moments.rms_height(),
        rms_gradient: moments.rms_gradient(),
        rms_laplacian: moments.rms_laplacian(),
        rms_curvature: moments.rms_curvature(),
        nayak_parameter: moments.nayak_parameter(),
    })
}

pub(super) fn radial_psd<'py>(
    py: Python<'py>,
    surface: &Topography,
    bins: Option<&Bound<'py, PyAny>>,
) -> Fallible<Bound<'py, PyAny>> {
    let bins = match bins {
        None => RadialBins::Linear,
        Some(bins) if bins.extract::<&str>().is_ok_and(|word| word == "linear") => {
            RadialBins::Linear
        }
        Some(bins) => match bins.extract::<usize>() {
            Ok(number) if !bins.is_instance_of::<PyBool>() => RadialBins::PerDecade(number),
            // An array, or a sequence that is no text.
            _ if bins.hasattr("__len__")? && !bins.is_instance_of::<PyString>() => {
                RadialBins::Edges(Found::of(bins, "bins", Kind::Real)?.list()?)
            }
            _ => {
                return Err(Failure::arguments(
                    "bins must be 'linear', a number of rings in a decade, or wavevectors",
                ));
            }
        },
    };
    let spectrum = detached(py, || surface.radial_psd(&bins))??;
    of_bins(py, &spectrum)
}

pub(super) fn psd_along<'py>(
    py: Python<'py>,
    surface: &Topography,
    axis: Axis,
) -> Fallible<Bound<'py, PyAny>> {
    of_bins(py, &detached(py, || surface.psd_along(axis))?)
}

fn of_bins<'py>(py: Python<'py>, bins: &[SpectralBin]) -> Fallible<Bound<'py, PyAny>> {
    result!(py, "PowerSpectrum", {
        wavevector: column(py, bins.iter().map(|bin| bin.wavevector).collect()),
        density: column(py, bins.iter().map(|bin| bin.density).collect()),
        waves: column(py, bins.iter().map(|bin| bin.waves as i64).collect()),
    })
}

pub(super) fn profile_parameters<'py>(
    py: Python<'py>,
    surface: &Topography,
    cutoff: Option<f64>,
) -> Fallible<Bound<'py, PyAny>> {
    let found = detached(py, || surface.profile_parameters(cutoff))??;
    result!(py, "ProfileParameters", {
        cutoff: found.cutoff,
        evaluation_length: found.evaluation_length,
        ra: found.ra,
        rq: found.rq,
        rz: found.rz,
        rt: found.rt,
        rsk: found.rsk,
        rku: found.rku,
        rsm: found.rsm,
    })
}

pub(super) fn areal_parameters<'py>(
    py: Python<'py>,
    surface: &Topography,
) -> Fallible<Bound<'py, PyAny>> {
    let found = detached(py, || surface.areal_parameters())??;
    result!(py, "ArealParameters", {
        sa: found.sa,
        sq: found.sq,
        sz: found.sz,
        sp: found.sp,
        sv: found.sv,
        ssk: found.ssk,
        sku: found.sku,
        sdq: found.sdq,
        sdr: found.sdr,
        sal: found.sal,
        str: found.str,
        sk: found.core.sk,
        spk: found.core.spk,
        svk: found.core.svk,
        smrk1: found.core.smrk1,
        smrk2: found.core.smrk2,
    })
}

/// The part of a surface at or above each height.
pub(super) fn material_ratio<'py>(
    py: Python<'py>,
    surface: &Topography,
    heights: &[f64],
) -> Fallible<Bound<'py, PyAny>> {
    let ratios = detached(py, || {
        let curve = MaterialRatio::of(surface.map());
        heights.iter().map(|&height| curve.at_height(height)).collect::<Vec<f64>>()
    })?;
    Ok(column(py, ratios).into_any())
}

pub(super) fn fit_self_affine<'py>(
    py: Python<'py>,
    surface: &Topography,
) -> Fallible<Bound<'py, PyAny>> {
    let fit = detached(py, || surface.fit_self_affine())??;
    let one = |estimate: Estimate| result!(py, "Estimate", { value: estimate.value, standard_error: estimate.standard_error });
    let perhaps = |estimate: Option<Estimate>| estimate.map(one).transpose();
    result!(py, "SelfAffineFit", {
        hurst: one(fit.hurst)?,
        rolloff_wavelength: perhaps(fit.rolloff_wavelength)?,
        short_cutoff_wavelength: perhaps(fit.short_cutoff_wavelength)?,
        long_cutoff_wavelength: perhaps(fit.long_cutoff_wavelength)?,
        prefactor: fit.prefactor,
        dispersion: fit.dispersion,
    })
}
