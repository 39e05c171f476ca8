//! Surfaces that are generated, and shapes.

use asperity::surface::{
    Amplitude, BiWave, Cone, Cylinder, EllipticParaboloid, Paraboloid, SelfAffine, Topography, Wave,
};
use asperity::{Grid, LoadingSolver, Surface as Heights};
use pyo3::prelude::*;

use super::Surface;
use crate::argument::whole;
use crate::arrays::Lengths;
use crate::choice::axis;
use crate::compute::detached;
use crate::errors::{Failure, Fallible};

/// Nodes beyond which a surface has to leave room for its path: less than that is not made in vain.
const LARGE: usize = 1 << 26;

/// `Ok` if there is room for a surface on a grid, and for its path.
pub(super) fn check_room(grid: &Grid) -> Result<(), asperity::Error> {
    match grid.nodes() > LARGE {
        true => LoadingSolver::check_room(grid, asperity::Boundary::Free, None),
        false => Ok(()),
    }
}

/// The heights of a shape on a grid.
fn sampled(py: Python<'_>, shape: &(impl Heights + Sync), grid: Grid) -> Fallible<Surface> {
    check_room(&grid)?;
    Ok(Surface::of(detached(py, || Topography::sample(shape, grid))??))
}

/// Generate a self-affine surface with random phases.
///
/// Parameters
/// ----------
/// shape : (int, int)
///     Rows and columns.
/// size : (float, float) or float
///     Sides ``(x, y)`` [m]; one number is the side along x, with square cells.
/// hurst : float
///     Hurst exponent, 0 to 1.
/// rolloff : float
///     Roll-off wavelength [m]: longer waves have the same power.
/// short_cutoff : float
///     Shortest wavelength [m].
/// long_cutoff : float, optional
///     Longest wavelength [m].
/// rms_height, rms_gradient, prefactor : float
///     One of them fixes the amplitude, exactly: root mean square height [m], gradient (that of the spectrum, as in
///     `Surface.moments`; differences of nodes, `Surface.rms_gradient`, find less), or the prefactor of the spectrum
///     [m^(2 - 2H)].
/// seed : int
///     The same seed gives the same surface, bit for bit, on every machine.
///
/// Returns
/// -------
/// Surface
#[pyfunction]
#[pyo3(signature = (shape, size, *, hurst, rolloff, short_cutoff, long_cutoff=None, rms_height=None, rms_gradient=None, prefactor=None, seed))]
#[allow(clippy::too_many_arguments)] // each is a keyword
fn self_affine(
    py: Python<'_>,
    #[pyo3(from_py_with = whole)] shape: (usize, usize),
    size: Lengths,
    hurst: f64,
    rolloff: f64,
    short_cutoff: f64,
    long_cutoff: Option<f64>,
    rms_height: Option<f64>,
    rms_gradient: Option<f64>,
    prefactor: Option<f64>,
    #[pyo3(from_py_with = whole)] seed: u64,
) -> Fallible<Surface> {
    let amplitude = match (rms_height, rms_gradient, prefactor) {
        (Some(height), None, None) => Amplitude::RmsHeight(height),
        (None, Some(gradient), None) => Amplitude::RmsGradient(gradient),
        (None, None, Some(prefactor)) => Amplitude::Prefactor(prefactor),
        _ => return Err(Failure::arguments("give one of rms_height, rms_gradient and prefactor")),
    };
    let mut surface = SelfAffine::new(hurst, rolloff, short_cutoff, amplitude, seed)?;
    if let Some(long_cutoff) = long_cutoff {
        surface = surface.with_long_cutoff_wavelength(long_cutoff)?;
    }
    sampled(py, &surface, size.grid(shape)?)
}

/// The surface of the program's first command: self-affine, after Zhang, Zhang & Jin, Friction 8 (2020) 970.
///
/// Hurst exponent 0.8, rms height 50 µm, roll-off at 2.5 mm, and a shortest wavelength that the grid resolves: eight cells,
/// but not less than 78.125 µm and not more than the roll-off.
///
/// Parameters
/// ----------
/// nodes : int
///     Rows and columns.
/// seed : int
/// size : float
///     Side [m].
/// short_cutoff : float, optional
///     Shortest wavelength [m], in place of eight cells.
///
/// Returns
/// -------
/// Surface
#[pyfunction]
#[pyo3(signature = (nodes=256, seed=1, *, size=1e-2, short_cutoff=None))]
fn example_surface(
    py: Python<'_>,
    #[pyo3(from_py_with = whole)] nodes: usize,
    #[pyo3(from_py_with = whole)] seed: u64,
    size: f64,
    short_cutoff: Option<f64>,
) -> Fallible<Surface> {
    const CELLS_OF_SHORTEST_WAVE: f64 = 8.0;
    let grid = Grid::square(nodes, size)?;
    let paper = SelfAffine::zhang2020(seed);
    let (rolloff, least) = (paper.rolloff_wavelength(), paper.short_cutoff_wavelength());
    let resolved = CELLS_OF_SHORTEST_WAVE * grid.dx();
    let shortest = short_cutoff.unwrap_or(resolved.max(least).min(rolloff));
    let surface = SelfAffine::new(paper.hurst(), rolloff, shortest, paper.amplitude(), seed)?;
    sampled(py, &surface, grid)
}

/// Puts a shape where it is asked for.
macro_rules! placed {
    ($py:ident, $made:expr, $shape:ident, $size:ident, $center:ident) => {{
        let made = match $center {
            Some((x, y)) => $made.centered_at(x, y)?,
            None => $made,
        };
        sampled($py, &made, $size.grid($shape)?)
    }};
}

/// A paraboloid of revolution, ``z = -(x² + y²) / (2 R)``: the stand-in for a sphere.
///
/// Parameters
/// ----------
/// radius : float or (float, float)
///     Radius of curvature [m], or those along x and along y.
/// shape : (int, int)
///     Rows and columns.
/// size : (float, float) or float
///     Sides ``(x, y)`` [m].
/// center : (float, float), optional
///     Place (x, y) of the apex [m]; the centre unless it is given.
///
/// Returns
/// -------
/// Surface
#[pyfunction]
#[pyo3(signature = (radius, shape, size, *, center=None))]
fn paraboloid(
    py: Python<'_>,
    radius: Lengths,
    #[pyo3(from_py_with = whole)] shape: (usize, usize),
    size: Lengths,
    center: Option<(f64, f64)>,
) -> Fallible<Surface> {
    match radius.x_and_y() {
        (x, Some(y)) => placed!(py, EllipticParaboloid::new(x, y)?, shape, size, center),
        (radius, None) => placed!(py, Paraboloid::new(radius)?, shape, size, center),
    }
}

/// A cylinder, ``z = -d² / (2 R)`` at a distance d from its ridge.
///
/// Parameters
/// ----------
/// radius : float
///     Radius [m].
/// shape : (int, int)
///     Rows and columns.
/// size : (float, float) or float
///     Sides ``(x, y)`` [m].
/// axis : {"x", "y"}
///     Direction of the ridge.
/// center : (float, float), optional
///     A point (x, y) of the ridge [m].
///
/// Returns
/// -------
/// Surface
#[pyfunction]
#[pyo3(signature = (radius, shape, size, *, axis="y", center=None))]
fn cylinder(
    py: Python<'_>,
    radius: f64,
    #[pyo3(from_py_with = whole)] shape: (usize, usize),
    size: Lengths,
    axis: &str,
    center: Option<(f64, f64)>,
) -> Fallible<Surface> {
    placed!(py, Cylinder::new(radius, self::axis(axis)?)?, shape, size, center)
}

/// A cone, ``z = -t r``.
///
/// Parameters
/// ----------
/// slope : float
///     Slope t of the flank.
/// shape : (int, int)
///     Rows and columns.
/// size : (float, float) or float
///     Sides ``(x, y)`` [m].
/// center : (float, float), optional
///     Place (x, y) of the apex [m].
///
/// Returns
/// -------
/// Surface
#[pyfunction]
#[pyo3(signature = (slope, shape, size, *, center=None))]
fn cone(
    py: Python<'_>,
    slope: f64,
    #[pyo3(from_py_with = whole)] shape: (usize, usize),
    size: Lengths,
    center: Option<(f64, f64)>,
) -> Fallible<Surface> {
    placed!(py, Cone::new(slope)?, shape, size, center)
}

/// A cosine wave along one axis, or along both.
///
/// Parameters
/// ----------
/// amplitude : float
///     Amplitude [m].
/// wavelength : float or (float, float)
///     Wavelength [m] of a wave along `axis`, or those along x and y of one in both directions.
/// shape : (int, int)
///     Rows and columns.
/// size : (float, float) or float
///     Sides ``(x, y)`` [m].
/// axis : {"x", "y"}
///     Direction along which the heights of a wave in one direction vary.
/// center : (float, float), optional
///     Place (x, y) of a crest [m].
///
/// Returns
/// -------
/// Surface
#[pyfunction]
#[pyo3(signature = (amplitude, wavelength, shape, size, *, axis="x", center=None))]
fn wave(
    py: Python<'_>,
    amplitude: f64,
    wavelength: Lengths,
    #[pyo3(from_py_with = whole)] shape: (usize, usize),
    size: Lengths,
    axis: &str,
    center: Option<(f64, f64)>,
) -> Fallible<Surface> {
    match wavelength.x_and_y() {
        (x, Some(y)) => placed!(py, BiWave::new(amplitude, x, y)?, shape, size, center),
        (length, None) => {
            placed!(py, Wave::new(amplitude, length, self::axis(axis)?)?, shape, size, center)
        }
    }
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(self_affine, module)?)?;
    module.add_function(wrap_pyfunction!(example_surface, module)?)?;
    module.add_function(wrap_pyfunction!(paraboloid, module)?)?;
    module.add_function(wrap_pyfunction!(cylinder, module)?)?;
    module.add_function(wrap_pyfunction!(cone, module)?)?;
    module.add_function(wrap_pyfunction!(wave, module)?)
}
