//! Files of surfaces.

use std::path::{Path, PathBuf};

use asperity::io::{
    self, Format, LengthUnit, MeasuredSurface, ReadOptions, TextLayout, write_gsf, write_npy,
    write_vti, write_x3p,
};
use asperity::nalgebra::DMatrix;
use asperity::{FileError, Grid};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use super::Surface;
use crate::arrays::{Found, Kind, Lengths};
use crate::compute::detached;
use crate::errors::{Failure, Fallible};
use crate::warnings::warn;

/// Read a surface from the file of an instrument.
///
/// Parameters
/// ----------
/// source : str, os.PathLike, bytes or file object
///     A file of one of the `formats`; which one is known by the content. A file object is one with ``read()`` that returns bytes.
/// channel : str, optional
///     Name of the map, in a file with several.
/// size : (float, float) or float, optional
///     Sides ``(x, y)`` [m] in place of what the file says; one number is the side along x, of a single column along y, with
///     square cells.
/// height_unit, lateral_unit : str, optional
///     Units in place of those in the file.
/// layout : {"matrix", "x-row", "y-column", "axes", "points"}, optional
///     How the numbers of a text are arranged, where it does not say: heights only, with positions along x in the first
///     row, along y in the first column, or both, or a point x, y, z in each line.
/// rows_are_y : bool
///     Take the array of a ``.npy`` file as an image, ``[row, column]``, as `numpy.save` writes ``z``.
/// ignore_mask : bool
///     Keep the heights of nodes that a mask in the file marks.
/// name : str, optional
///     Name of the file that bytes are from: errors call it so, and lists of points are known by ``.xyz``.
///
/// Returns
/// -------
/// Surface
///     Missing nodes are NaN. How a text was understood is in `Surface.understood`. What was assumed is in `Surface.notes`, and is given as a warning.
///
/// Raises
/// ------
/// FileError
///     An `OSError` as well: a file that is not there, is damaged, or leaves something open.
///
/// Notes
/// -----
/// The rows of a file are those of an image. Only a ``.npy`` file holds ``[ix, iy]``, as the program and the Rust library
/// have it and `Surface.save` writes it; an image that was saved by ``numpy.save(name, z)`` needs ``rows_are_y=True``.
#[pyfunction]
#[pyo3(signature = (source, channel=None, *, size=None, height_unit=None, lateral_unit=None, layout=None, rows_are_y=false, ignore_mask=false, name=None))]
#[allow(clippy::too_many_arguments)] // each is a keyword
fn read(
    py: Python<'_>,
    source: &Bound<'_, PyAny>,
    channel: Option<String>,
    size: Option<Lengths>,
    height_unit: Option<&str>,
    lateral_unit: Option<&str>,
    layout: Option<&str>,
    rows_are_y: bool,
    ignore_mask: bool,
    name: Option<PathBuf>,
) -> Fallible<Surface> {
    let mut options = ReadOptions::new();
    if let Some(channel) = channel {
        options = options.channel(channel);
    }
    if let Some(size) = size {
        let (x, y) = size.x_and_y();
        options = options.side(x);
        if let Some(y) = y {
            options = options.side_y(y);
        }
    }
    if let Some(unit) = height_unit {
        options = options.height_unit(unit.parse::<LengthUnit>()?);
    }
    if let Some(unit) = lateral_unit {
        options = options.lateral_unit(unit.parse::<LengthUnit>()?);
    }
    if let Some(layout) = layout {
        options = options.layout(layout.parse::<TextLayout>()?);
    }
    if rows_are_y {
        options = options.rows_are_y();
    }
    if ignore_mask {
        options = options.ignore_mask();
    }
    let measured = match Source::of(source)? {
        Source::File(path) => detached(py, || options.read(path))??,
        Source::Bytes(bytes, found) => {
            let name = name.or(found).unwrap_or_else(|| "these bytes".into());
            detached(py, || options.read_bytes(bytes, name))??
        }
    };
    for note in &measured.notes {
        warn(py, note)?;
    }
    surface(measured)
}

fn surface(measured: MeasuredSurface) -> Fallible<Surface> {
    let grid = measured.grid()?;
    let MeasuredSurface { heights, title, understood, notes, .. } = measured;
    Ok(Surface { title, understood, notes, ..Surface::new(grid, heights)? })
}

/// The formats of files that `read` reads.
///
/// Returns
/// -------
/// dict of str to list of str
///     What names of files of each format end with; a file is known by its content all the same.
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> asp.formats()["Keyence"]
/// ['vk4', 'vk6', 'vk7']
#[pyfunction]
fn formats(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let formats = PyDict::new(py);
    for format in Format::ALL {
        formats.set_item(format.name(), format.endings().to_vec())?;
    }
    Ok(formats)
}

/// The names of the maps in a file.
///
/// Parameters
/// ----------
/// path : str or os.PathLike
///
/// Returns
/// -------
/// list of str
///     What `read` takes as `channel`.
#[pyfunction]
fn channels(py: Python<'_>, path: PathBuf) -> Fallible<Vec<String>> {
    Ok(detached(py, || io::channels(path))??)
}

/// Where the bytes of a file are.
enum Source {
    File(PathBuf),
    Bytes(Vec<u8>, Option<PathBuf>),
}

impl Source {
    fn of(source: &Bound<'_, PyAny>) -> Fallible<Self> {
        if let Ok(bytes) = source.cast::<PyBytes>() {
            return Ok(Self::Bytes(bytes.as_bytes().to_vec(), None));
        }
        if let Ok(path) = source.extract::<PathBuf>() {
            return Ok(Self::File(path));
        }
        if !source.hasattr("read")? {
            let bytes = source.py().import("builtins")?.getattr("bytes")?;
            let is_buffer = source.is_instance_of::<pyo3::types::PyByteArray>()
                || source.get_type().name()? == "memoryview";
            if is_buffer {
                return Ok(Self::Bytes(bytes.call1((source,))?.extract()?, None));
            }
            return Err(Failure::arguments(
                "source must be the name of a file, bytes, or a file object",
            ));
        }
        let read = source.call_method0("read")?;
        let Ok(bytes) = read.cast::<PyBytes>() else {
            return Err(Failure::arguments("a file object must be opened in binary mode, \"rb\""));
        };
        let name = source.getattr("name").ok().and_then(|name| name.extract().ok());
        Ok(Self::Bytes(bytes.as_bytes().to_vec(), name))
    }
}

/// Writes heights in the format of the extension.
pub(super) fn save(
    py: Python<'_>,
    path: &Path,
    grid: &Grid,
    heights: &DMatrix<f64>,
) -> Fallible<()> {
    let extension = path.extension().map(|end| end.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("npy") => Ok(detached(py, || write_npy(path, heights))??),
        Some("gsf") => Ok(detached(py, || write_gsf(path, grid, heights, "m"))??),
        Some("x3p") => Ok(detached(py, || write_x3p(path, grid, heights))??),
        _ => {
            let reason = "a surface cannot be written with this extension: .npy, .gsf and .x3p say the format";
            let source = std::io::Error::new(std::io::ErrorKind::Unsupported, reason);
            Err(FileError::Io { path: path.to_path_buf(), source }.into())
        }
    }
}

/// Write fields for other programs.
///
/// Parameters
/// ----------
/// path : str or os.PathLike
///     Its ending says the format: ``.vti`` for ParaView, with any number of fields; ``.gsf`` for Gwyddion, or ``.npy``, which is
///     ``[ix, iy]`` as those of the program are, with one.
/// fields : dict of str to array_like of float
///     Each ``[row, column]``, by its name.
/// size : (float, float) or float
///     Sides ``(x, y)`` [m]; one number is the side along x, with square cells.
/// unit : str
///     Of the values, in a ``.gsf`` file.
///
/// Examples
/// --------
/// >>> import asperity as asp
/// >>> path = asp.load_path(asp.example_surface(nodes=32), asp.HalfSpace(115e9, boundary="free"), load=100.0)
/// >>> history = path.run(check=False)
/// >>> asp.save_fields("fields.vti", {"pressure": path.pressure(), "gap": path.gap()}, path.size)   # doctest: +SKIP
#[pyfunction]
#[pyo3(signature = (path, fields, size, *, unit=""))]
fn save_fields(
    py: Python<'_>,
    path: PathBuf,
    fields: &Bound<'_, PyDict>,
    size: Lengths,
    unit: &str,
) -> Fallible<()> {
    let mut grid: Option<Grid> = None;
    let mut found = Vec::new();
    for (name, values) in fields {
        let values = Found::of(&values, "fields", Kind::Real)?;
        let grid = match grid {
            Some(grid) => grid,
            None => *grid.insert(size.grid(values.rows_and_columns()?)?),
        };
        found.push((name.extract::<String>()?, values.on(&grid)?));
    }
    let Some(grid) = grid else {
        return Err(Failure::arguments("there is no field to write"));
    };
    let extension = path.extension().map(|end| end.to_string_lossy().to_lowercase());
    match (extension.as_deref(), &found[..]) {
        (Some("vti"), all) => {
            let all: Vec<_> = all.iter().map(|(name, field)| (name.as_str(), field)).collect();
            Ok(detached(py, || write_vti(&path, &grid, &all))??)
        }
        (Some("gsf"), [(_, field)]) => Ok(detached(py, || write_gsf(&path, &grid, field, unit))??),
        (Some("npy"), [(_, field)]) => Ok(detached(py, || write_npy(&path, field))??),
        _ => Err(Failure::arguments(
            "the file must end in .vti, or with a single field in .gsf or .npy",
        )),
    }
}

pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(read, module)?)?;
    module.add_function(wrap_pyfunction!(channels, module)?)?;
    module.add_function(wrap_pyfunction!(formats, module)?)?;
    module.add_function(wrap_pyfunction!(save_fields, module)?)
}
