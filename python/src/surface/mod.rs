//! Heights on their grid.

mod files;
mod generate;
mod source;
mod statistics;

use std::path::PathBuf;

use asperity::nalgebra::DMatrix;
use asperity::surface::{
    Filter, Interpolation, Topography, Trend, Window, count_missing, fill_missing, level_measured,
};
use asperity::{Error, Grid, Surface as _, Warning};
use numpy::PyArray2;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::argument::{not_one, whole};
use crate::arrays::{self, Found, Kind, Lengths};
use crate::choice;
use crate::compute::detached;
use crate::errors::{Fallible, in_python};
use crate::warnings::warn_all;

/// A rough surface: heights in metres on a rectangular grid, positive towards the other body.
///
/// Parameters
/// ----------
/// z : array_like or object
///     Heights [m] as an array ``z[row, column]``: x runs along the columns, y down the rows, as in an image. Any dtype of
///     real numbers, any strides. NaN, infinite and masked heights are missing nodes. Or an object with the methods and
///     properties of a topography of SurfaceTopography: ``heights()``, which is ``[ix, iy]`` there, ``physical_sizes``,
///     ``unit`` and ``is_periodic``. Or another `Surface`.
/// size : (float, float) or float, optional
///     Sides ``(x, y)`` of the whole surface [m]: the spacing is side over number of nodes. One number is the side along x,
///     with square cells. An object that knows its sizes needs none.
/// height_unit : str, optional
///     Unit of `z`: ``"m"`` unless it is given, or ``"mm"``, ``"um"``, ``"nm"``, ... The size is in metres all the same.
///
/// See Also
/// --------
/// read : files of instruments.
/// self_affine : generated surfaces.
///
/// Notes
/// -----
/// The file formats of this library other than ``.npy`` hold images too. Only a ``.npy`` file read by `read` is
/// ``[ix, iy]``, as the Rust library and the program have it: ``Surface(numpy.load(name).T, size)`` is the same surface.
///
/// Examples
/// --------
/// >>> import numpy as np, asperity as asp
/// >>> z = 1e-6 * np.random.default_rng(1).standard_normal((48, 64))
/// >>> surface = asp.Surface(z, size=(64e-6, 48e-6))
/// >>> surface.shape, surface.missing
/// ((48, 64), 0)
#[pyclass(frozen, module = "asperity")]
pub(crate) struct Surface {
    grid: Grid,
    heights: Heights,
    /// Name of the map in its file, empty if it has none.
    title: String,
    /// How its text was understood, empty for other formats.
    understood: String,
    /// What was noticed in reading.
    notes: Vec<String>,
    /// Whether it was said to repeat.
    periodic: Option<bool>,
}

/// Heights with missing nodes, or without.
enum Heights {
    Whole(Topography),
    Holed(DMatrix<f64>),
}

impl Surface {
    /// A surface of heights, of which those that are not finite are missing.
    pub(crate) fn new(grid: Grid, heights: DMatrix<f64>) -> Result<Self, Error> {
        grid.check_shape(heights.shape())?;
        let heights = if count_missing(&heights) == 0 {
            Heights::Whole(Topography::new(grid, heights)?)
        } else {
            Heights::Holed(heights.map(|z| if z.is_finite() { z } else { f64::NAN }))
        };
        Ok(Self {
            grid,
            heights,
            title: String::new(),
            understood: String::new(),
            notes: Vec::new(),
            periodic: None,
        })
    }

    fn of(topography: Topography) -> Self {
        Self {
            grid: *topography.grid(),
            heights: Heights::Whole(topography),
            title: String::new(),
            understood: String::new(),
            notes: Vec::new(),
            periodic: None,
        }
    }

    /// What was made of this surface.
    fn with(&self, topography: Topography) -> Self {
        self.named(Self::of(topography))
    }

    /// The same of heights that may have holes.
    fn named(&self, made: Self) -> Self {
        Self { title: self.title.clone(), periodic: self.periodic, ..made }
    }

    /// The same heights; nothing is known of whether they repeat unless what was made of the whole still does.
    fn repeats_if(self, keeps: bool) -> Self {
        Self { periodic: self.periodic.filter(|_| keeps), ..self }
    }

    pub(crate) fn grid(&self) -> &Grid {
        &self.grid
    }

    pub(crate) fn periodic(&self) -> Option<bool> {
        self.periodic
    }

    fn matrix(&self) -> &DMatrix<f64> {
        match &self.heights {
            Heights::Whole(topography) => topography.heights(),
            Heights::Holed(heights) => heights,
        }
    }

    /// The heights, if none is missing.
    pub(crate) fn topography(&self) -> Result<&Topography, Error> {
        match &self.heights {
            Heights::Whole(topography) => Ok(topography),
            // The error that counts them.
            Heights::Holed(heights) => match Topography::new(self.grid, heights.clone()) {
                Err(error) => Err(error.into()),
                Ok(_) => Err(Error::LengthMismatch { expected: 0, found: heights.len() }),
            },
        }
    }

    /// What is made of the heights without the lock of the interpreter.
    fn made(
        &self,
        py: Python<'_>,
        make: impl FnOnce(&Topography) -> Result<Topography, asperity::SurfaceError> + Send,
    ) -> Fallible<Self> {
        let topography = self.topography()?;
        Ok(self.with(detached(py, || make(topography))??))
    }
}

/// A range of rows or columns.
type Range = Option<(usize, usize)>;

fn range(given: &Bound<'_, PyAny>) -> PyResult<Range> {
    whole(given).map_err(|error| match error.is_instance_of::<PyTypeError>(given.py()) {
        true => not_one(given, "(first, behind the last)"),
        false => error,
    })
}

#[pymethods]
impl Surface {
    #[new]
    #[pyo3(signature = (z, size=None, *, height_unit=None))]
    fn from_object(
        z: &Bound<'_, PyAny>,
        size: Option<Lengths>,
        height_unit: Option<&str>,
    ) -> Fallible<Self> {
        source::surface(z, size.as_ref(), height_unit)
    }

    /// Heights [m], a new array ``[row, column]``, NaN where they are missing.
    #[getter]
    fn z<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyArray2<f64>>> {
        arrays::rows(py, self.matrix().clone())
    }

    /// Rows and columns of the arrays on this surface: nodes along y and along x.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        arrays::shape(&self.grid)
    }

    /// Sides ``(x, y)`` [m].
    #[getter]
    fn size(&self) -> (f64, f64) {
        self.grid.sides()
    }

    /// Sides ``(dx, dy)`` of a cell [m].
    #[getter]
    fn cell(&self) -> (f64, f64) {
        (self.grid.dx(), self.grid.dy())
    }

    /// Nominal area [m²].
    #[getter]
    fn area(&self) -> f64 {
        self.grid.nominal_area()
    }

    /// Number of missing nodes.
    #[getter]
    fn missing(&self) -> usize {
        count_missing(self.matrix())
    }

    /// Name of the map in its file, empty if it has none.
    #[getter]
    fn title(&self) -> &str {
        &self.title
    }

    /// How a text was understood: which numbers are heights, and what parts them; empty for other formats.
    #[getter]
    fn understood(&self) -> &str {
        &self.understood
    }

    /// What was noticed in reading, and what was assumed.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| in_python(note)).collect()
    }

    /// Whether the surface was said to repeat with its sides; None if nothing was said.
    #[getter]
    fn is_periodic(&self) -> Option<bool> {
        self.periodic
    }

    /// Fill missing nodes smoothly from those around them; all others stay as they are, bit for bit.
    ///
    /// Take a tilt off before, with `level`: what is filled first is tipped with the plane, and may carry most of the
    /// load.
    ///
    /// Returns
    /// -------
    /// Surface
    ///     Each missing height is the mean of its neighbours: the discrete harmonic function of the measured ones.
    ///
    /// Raises
    /// ------
    /// AsperityError
    ///     If all heights are missing.
    fn fill_missing(&self, py: Python<'_>) -> Fallible<Self> {
        let matrix = self.matrix();
        let filled = detached(py, || fill_missing(matrix.clone()))??;
        let made_up = asperity::surface::Warning::of_filling(self.missing(), matrix.len());
        warn_all(py, made_up.map(Warning::Surface))?;
        Ok(self.with(Topography::new(self.grid, filled)?))
    }

    /// Take a trend off the heights, by least squares of those that were measured. Missing nodes stay missing:
    /// `fill_missing` comes after.
    ///
    /// Parameters
    /// ----------
    /// trend : {"plane", "quadratic", "mean"}
    ///     A tilted plane, a polynomial of second degree, or the mean height.
    ///
    /// Returns
    /// -------
    /// Surface
    #[pyo3(signature = (trend="plane"))]
    fn level(&self, py: Python<'_>, trend: &str) -> Fallible<Self> {
        let trend = choice::trend(trend)?;
        let heights = detached(py, || level_measured(&self.grid, self.matrix(), trend))??;
        Ok(self.named(Self::new(self.grid, heights)?).repeats_if(trend == Trend::Mean))
    }

    /// The trend that `level` would take off.
    ///
    /// Parameters
    /// ----------
    /// trend : {"plane", "quadratic", "mean"}
    ///
    /// Returns
    /// -------
    /// results.Trend
    #[pyo3(signature = (trend="plane"))]
    fn trend<'py>(&self, py: Python<'py>, trend: &str) -> Fallible<Bound<'py, PyAny>> {
        statistics::trend(py, (&self.grid, self.matrix()), choice::trend(trend)?)
    }

    /// A piece of the surface, which may have no missing nodes where the whole has some. Nothing is said of whether it
    /// repeats, unless it is the whole.
    ///
    /// Parameters
    /// ----------
    /// rows, columns : (int, int), optional
    ///     First one and the one after the last; all of them if not given.
    ///
    /// Returns
    /// -------
    /// Surface
    #[pyo3(signature = (rows=None, columns=None))]
    fn crop(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = range)] rows: Range,
        #[pyo3(from_py_with = range)] columns: Range,
    ) -> Fallible<Self> {
        let of = |range: Range, all: usize| range.map_or(0..all, |(start, end)| start..end);
        let (columns, rows) = (of(columns, self.grid.nx()), of(rows, self.grid.ny()));
        let is_whole = (rows.len(), columns.len()) == self.shape();
        // Of a surface with holes too: a piece may have none.
        let matrix = self.matrix();
        let piece = detached(py, || {
            let first = (columns.start, rows.start);
            let blank = Topography::new(self.grid, DMatrix::zeros(matrix.nrows(), matrix.ncols()))?;
            let grid = *blank.crop(columns, rows)?.grid();
            Self::new(grid, matrix.view(first, grid.shape()).into_owned())
        })??;
        Ok(self.named(piece).repeats_if(is_whole))
    }

    /// The same surface on another number of nodes.
    ///
    /// Parameters
    /// ----------
    /// shape : (int, int)
    ///     Rows and columns.
    /// method : {"fourier", "bilinear"}
    ///     The trigonometric polynomial through the nodes, exact for a periodic map, or linear between four nodes, for any.
    ///
    /// Returns
    /// -------
    /// Surface
    #[pyo3(signature = (shape, method="bilinear"))]
    fn resample(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = whole)] shape: (usize, usize),
        method: &str,
    ) -> Fallible<Self> {
        let method = choice::interpolation(method)?;
        let (lx, ly) = self.grid.sides();
        generate::check_room(&Grid::with_sides(shape.1, shape.0, lx, ly)?)?;
        let made = self.made(py, |surface| surface.resample(shape.1, shape.0, method))?;
        Ok(made.repeats_if(method == Interpolation::Fourier))
    }

    /// Keep the long waves.
    ///
    /// Parameters
    /// ----------
    /// cutoff : float
    ///     Cut-off wavelength [m].
    /// filter : {"gaussian", "sharp"}
    ///     The Gaussian filter of ISO 16610-61, or all waves down to the cut-off and none below, for a periodic map.
    ///
    /// Returns
    /// -------
    /// Surface
    #[pyo3(signature = (cutoff, filter="gaussian"))]
    fn low_pass(&self, py: Python<'_>, cutoff: f64, filter: &str) -> Fallible<Self> {
        let filter = choice::filter(filter)?;
        let made = self.made(py, |surface| surface.low_pass(cutoff, filter))?;
        Ok(made.repeats_if(filter == Filter::Sharp))
    }

    /// Keep the short waves: the surface less its `low_pass`.
    ///
    /// Parameters
    /// ----------
    /// cutoff : float
    ///     Cut-off wavelength [m].
    /// filter : {"gaussian", "sharp"}
    ///
    /// Returns
    /// -------
    /// Surface
    #[pyo3(signature = (cutoff, filter="gaussian"))]
    fn high_pass(&self, py: Python<'_>, cutoff: f64, filter: &str) -> Fallible<Self> {
        let filter = choice::filter(filter)?;
        let made = self.made(py, |surface| surface.high_pass(cutoff, filter))?;
        Ok(made.repeats_if(filter == Filter::Sharp))
    }

    /// Heights above their mean times a weight that falls to zero at the border, before a spectrum of a map that does not
    /// repeat. The mean square height is kept.
    ///
    /// Parameters
    /// ----------
    /// kind : {"hann", "tukey"}
    /// fraction : float, optional
    ///     Tapered part of each side of a Tukey window, 0 to 1.
    ///
    /// Returns
    /// -------
    /// Surface
    #[pyo3(signature = (kind="hann", fraction=0.5))]
    fn window(&self, py: Python<'_>, kind: &str, fraction: f64) -> Fallible<Self> {
        let choices = [("hann", Window::Hann), ("tukey", Window::Tukey(fraction))];
        let window = choice::choose("kind", kind, &choices)?;
        self.made(py, |surface| surface.window(window))
    }

    /// Turn the surface round: rows become columns.
    ///
    /// Returns
    /// -------
    /// Surface
    fn transpose(&self, py: Python<'_>) -> Fallible<Self> {
        self.made(py, |surface| Ok(surface.transpose()))
    }

    /// Mirror the surface along an axis.
    ///
    /// Parameters
    /// ----------
    /// axis : {"x", "y"}
    ///
    /// Returns
    /// -------
    /// Surface
    fn flip(&self, py: Python<'_>, axis: &str) -> Fallible<Self> {
        let axis = choice::axis(axis)?;
        self.made(py, |surface| Ok(surface.flip(axis)))
    }

    /// Move the surface by whole nodes; what leaves it at one edge comes in at the opposite one.
    ///
    /// Parameters
    /// ----------
    /// along_x, along_y : int
    ///     Nodes; negative ones move it back.
    ///
    /// Returns
    /// -------
    /// Surface
    fn shift(&self, py: Python<'_>, along_x: isize, along_y: isize) -> Fallible<Self> {
        self.made(py, |surface| Ok(surface.shift(along_x, along_y)))
    }

    /// Multiply the heights by a number.
    ///
    /// Parameters
    /// ----------
    /// factor : float
    ///
    /// Returns
    /// -------
    /// Surface
    fn scaled(&self, py: Python<'_>, factor: f64) -> Fallible<Self> {
        self.made(py, |surface| surface.scaled(factor))
    }

    /// Peaks become valleys, as for the replica of a surface.
    fn __neg__(&self, py: Python<'_>) -> Fallible<Self> {
        self.made(py, |surface| Ok(surface.invert()))
    }

    /// The composite roughness of two surfaces on the same grid. It repeats if both do.
    fn __add__(&self, py: Python<'_>, other: PyRef<'_, Self>) -> Fallible<Self> {
        let second = other.topography()?;
        let sum = |first: &Topography| Topography::sample(&first.plus(second), *first.grid());
        let both = self.periodic.zip(other.periodic);
        Ok(Self { periodic: both.map(|(one, other)| one && other), ..self.made(py, sum)? })
    }

    /// What looks wrong with the surface, in words: slopes that are too steep, a tilt, a grid that does not resolve it.
    ///
    /// Returns
    /// -------
    /// list of str
    ///     Empty if nothing does. `load_path`, `solve` and `sweep` give the same as warnings.
    fn check(&self, py: Python<'_>) -> Fallible<Vec<String>> {
        let topography = self.topography()?;
        let warnings = detached(py, || Warning::of_surface(topography))?;
        Ok(warnings.iter().map(|warning| in_python(&warning.to_string())).collect())
    }

    /// Arithmetical mean height Sa [m] (ISO 25178-2); no tilt is removed.
    #[getter]
    fn sa(&self) -> Fallible<f64> {
        Ok(self.topography()?.map().mean_absolute_height())
    }

    /// Root mean square height Sq [m] about the mean height; no tilt is removed.
    #[getter]
    fn sq(&self) -> Fallible<f64> {
        Ok(self.topography()?.map().rms_height())
    }

    /// Height of the highest node above the lowest Sz [m].
    #[getter]
    fn sz(&self) -> Fallible<f64> {
        Ok(self.topography()?.map().peak_to_valley())
    }

    /// Skewness Ssk of the heights as they are; `areal_parameters` takes off their tilt.
    #[getter]
    fn ssk(&self) -> Fallible<f64> {
        Ok(self.topography()?.map().skewness())
    }

    /// Kurtosis Sku of the heights as they are, 3 for a normal distribution; `areal_parameters` takes off their tilt.
    #[getter]
    fn sku(&self) -> Fallible<f64> {
        Ok(self.topography()?.map().kurtosis())
    }

    /// Root mean square gradient, two-dimensional, from forward differences.
    #[getter]
    fn rms_gradient(&self) -> Fallible<f64> {
        Ok(self.topography()?.rms_gradient())
    }

    /// Root mean square slopes along x and along y, from forward differences.
    #[getter]
    fn rms_slopes(&self) -> Fallible<(f64, f64)> {
        Ok(self.topography()?.rms_slopes())
    }

    /// Root mean square Laplacian [1/m], from second differences.
    #[getter]
    fn rms_laplacian(&self) -> Fallible<f64> {
        Ok(self.topography()?.rms_laplacian())
    }

    /// Root mean square curvature [1/m], half the Laplacian.
    #[getter]
    fn rms_curvature(&self) -> Fallible<f64> {
        Ok(self.topography()?.rms_curvature())
    }

    /// Shortest wavelength [m] of which the map has waves in all directions, and the longest that it has in one: two cells, of
    /// the longer side, and the longer side of the map.
    #[getter]
    fn bandwidth(&self) -> Fallible<(f64, f64)> {
        Ok(self.topography()?.bandwidth())
    }

    /// Spectral moments, the map taken as periodic.
    ///
    /// Returns
    /// -------
    /// results.SpectralMoments
    fn moments<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyAny>> {
        statistics::moments(py, self.topography()?)
    }

    /// Power spectral density [m⁴], radially averaged, the map taken as periodic.
    ///
    /// Parameters
    /// ----------
    /// bins : "linear", int or array_like of float
    ///     Rings of equal width, so many rings in a decade, or rings between these wavevectors [rad/m].
    ///
    /// Returns
    /// -------
    /// results.PowerSpectrum
    ///     Wavevectors q = 2π/λ [rad/m], densities and numbers of waves.
    #[pyo3(signature = (bins=None))]
    fn psd<'py>(
        &self,
        py: Python<'py>,
        bins: Option<&Bound<'py, PyAny>>,
    ) -> Fallible<Bound<'py, PyAny>> {
        statistics::radial_psd(py, self.topography()?, bins)
    }

    /// Power spectral density [m³] of the profiles along an axis, averaged over them.
    ///
    /// Parameters
    /// ----------
    /// axis : {"x", "y"}
    ///
    /// Returns
    /// -------
    /// results.PowerSpectrum
    fn psd_along<'py>(&self, py: Python<'py>, axis: &str) -> Fallible<Bound<'py, PyAny>> {
        statistics::psd_along(py, self.topography()?, choice::axis(axis)?)
    }

    /// The roughness of a profile, a surface of one row, without its tilt (ISO 21920).
    ///
    /// Parameters
    /// ----------
    /// cutoff : float, optional
    ///     Cut-off wavelength [m] of the Gaussian filter: the parameters are those of the roughness, Ra, Rz, ...; without it those of the
    ///     primary profile, Pa, Pz, ...
    ///
    /// Returns
    /// -------
    /// results.ProfileParameters
    #[pyo3(signature = (cutoff=None))]
    fn profile_parameters<'py>(
        &self,
        py: Python<'py>,
        cutoff: Option<f64>,
    ) -> Fallible<Bound<'py, PyAny>> {
        statistics::profile_parameters(py, self.topography()?, cutoff)
    }

    /// Texture by ISO 25178-2, without the tilt: heights, skewness, gradient and developed area, autocorrelation length and
    /// texture aspect ratio, core, peaks and dales of the material ratio curve.
    ///
    /// Returns
    /// -------
    /// results.ArealParameters
    fn areal_parameters<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyAny>> {
        statistics::areal_parameters(py, self.topography()?)
    }

    /// The part of the surface at or above heights: Smr(c), or Rmr(c) of a profile.
    ///
    /// Parameters
    /// ----------
    /// heights : array_like, one-dimensional
    ///     Heights [m] in the values of the surface.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    fn material_ratio<'py>(
        &self,
        py: Python<'py>,
        heights: &Bound<'py, PyAny>,
    ) -> Fallible<Bound<'py, PyAny>> {
        let heights = Found::of(heights, "heights", Kind::Real)?.list()?;
        statistics::material_ratio(py, self.topography()?, &heights)
    }

    /// Fit a self-affine spectrum with roll-off and cut-offs, with standard errors.
    ///
    /// Level a map that does not repeat and put a `window` on it before.
    ///
    /// Returns
    /// -------
    /// results.SelfAffineFit
    fn fit_self_affine<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyAny>> {
        statistics::fit_self_affine(py, self.topography()?)
    }

    /// The pressure of full contact about its mean [Pa], `p(q) = E* |q| h(q) / 2`, the map taken as periodic.
    ///
    /// Parameters
    /// ----------
    /// e_star : float
    ///     Composite modulus [Pa].
    ///
    /// Returns
    /// -------
    /// ndarray of float, [row, column]
    fn full_contact_pressure<'py>(
        &self,
        py: Python<'py>,
        e_star: f64,
    ) -> Fallible<Bound<'py, PyArray2<f64>>> {
        let topography = self.topography()?;
        arrays::rows(py, detached(py, || topography.full_contact_pressure(e_star))??)
    }

    /// Write the heights into a file, which has one name only when it is whole.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     The extension says the format: ``.npy`` (float64, ``[ix, iy]`` as `read` and the program take it), ``.gsf``
    ///     (float32) or ``.x3p`` (float64).
    fn save(&self, py: Python<'_>, path: PathBuf) -> Fallible<()> {
        files::save(py, &path, &self.grid, self.matrix())
    }

    fn __eq__(&self, other: PyRef<'_, Self>) -> bool {
        let bits = |matrix: &DMatrix<f64>| matrix.iter().map(|z| z.to_bits()).collect::<Vec<_>>();
        self.grid == other.grid && bits(self.matrix()) == bits(other.matrix())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Fallible<Bound<'py, PyTuple>> {
        let restore = py.import("asperity._asperity")?.getattr("_restore_surface")?;
        let (cell, z) = ((self.grid.dx(), self.grid.dy()), self.z(py)?);
        let words = (self.title.clone(), self.understood.clone(), self.notes.clone());
        let state = (z, cell, words, self.periodic);
        Ok((restore, state).into_pyobject(py)?)
    }

    fn __repr__(&self) -> String {
        let ((rows, columns), (x, y)) = (self.shape(), self.size());
        let missing = match self.missing() {
            0 => String::new(),
            missing => format!(", {missing} nodes missing"),
        };
        format!("<Surface: {rows} x {columns} rows and columns, {x:.6e} m x {y:.6e} m{missing}>")
    }
}

/// A surface that was pickled.
#[pyfunction]
#[pyo3(signature = (z, cell, words, periodic))]
fn _restore_surface(
    z: &Bound<'_, PyAny>,
    cell: (f64, f64),
    words: (String, String, Vec<String>),
    periodic: Option<bool>,
) -> Fallible<Surface> {
    let found = Found::of(z, "z", Kind::Real)?;
    let (rows, columns) = found.rows_and_columns()?;
    let grid = Grid::new(columns, rows, cell.0, cell.1)?;
    let (title, understood, notes) = words;
    Ok(Surface { title, understood, notes, periodic, ..Surface::new(grid, found.on(&grid)?)? })
}

pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Surface>()?;
    module.add_function(wrap_pyfunction!(_restore_surface, module)?)?;
    files::register(module)?;
    generate::register(module)
}
