//! Arrays of NumPy and fields of the engine.
//!
//! An array `[row, column]` in C order has its values in the order in which the engine stores a field `[(ix, iy)]`: x, which is the
//! column, runs fastest. So nothing is transposed here, and the axes only change their names.

use asperity::nalgebra::{DMatrix, Scalar};
use asperity::{Error, Grid};
use numpy::ndarray::Array2;
use numpy::{Element, IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

use crate::argument::one_of;
use crate::errors::{Failure, Fallible, Number, Numbers};

/// An array that was found to have numbers in it.
pub(crate) struct Found<'py> {
    array: Bound<'py, PyAny>,
    name: &'static str,
    pub(crate) shape: Vec<usize>,
}

/// What numbers an array may have.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    Real,
    Truth,
}

impl<'py> Found<'py> {
    /// An array of numbers, or of what NumPy makes one of. Masked numbers become NaN; there is no truth that says as much.
    pub(crate) fn of(value: &Bound<'py, PyAny>, name: &'static str, kind: Kind) -> Fallible<Self> {
        let py = value.py();
        let numpy = py.import(intern!(py, "numpy"))?;
        let masked = numpy.getattr(intern!(py, "ma"))?;
        let is_mask = |value: &Bound<'py, PyAny>| {
            masked.call_method1(intern!(py, "isMaskedArray"), (value,))?.is_truthy()
        };
        // Rows that are masked keep their masks.
        let mut has_masks = false;
        if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
            for row in value.try_iter()? {
                has_masks |= is_mask(&row?)?;
            }
        }
        let value =
            &if has_masks { masked.call_method1("stack", (value,))? } else { value.clone() };
        let is_masked = is_mask(value)?;
        let array =
            if is_masked { value.clone() } else { numpy.call_method1("asarray", (value,))? };
        let dtype = array.getattr(intern!(py, "dtype"))?;
        let letter: String = dtype.getattr(intern!(py, "kind"))?.extract()?;
        let shape: Vec<usize> = array.getattr(intern!(py, "shape"))?.extract()?;
        let fits = match kind {
            Kind::Real => matches!(letter.as_str(), "f" | "i" | "u"),
            Kind::Truth => letter == "b",
        };
        if !fits {
            let wanted = if kind == Kind::Real { "real numbers" } else { "bool" };
            let dtype = dtype.str()?.to_string();
            return Err(Failure::Array {
                message: format!("{name} must be an array of {wanted}, but its dtype is {dtype}"),
                numbers: vec![("argument", name.into()), ("dtype", Number::Text(dtype))],
            });
        }
        let array = if !is_masked {
            array
        } else if kind == Kind::Real {
            let filled = array.call_method1("astype", (numpy.getattr("float64")?,))?;
            filled.call_method1("filled", (f64::NAN,))?
        } else {
            if masked.call_method1(intern!(py, "is_masked"), (&array,))?.is_truthy()? {
                return Err(Failure::Array {
                    message: format!("{name} has masked values: fill them with True or False"),
                    numbers: vec![("argument", name.into())],
                });
            }
            array.call_method0("filled")?
        };
        Ok(Self { array, name, shape })
    }

    /// Rows and columns, if these are the axes.
    pub(crate) fn rows_and_columns(&self) -> Fallible<(usize, usize)> {
        match self.shape[..] {
            [rows, columns] => Ok((rows, columns)),
            _ => Err(self.wrong_shape("two dimensions, [row, column]")),
        }
    }

    fn wrong_shape(&self, expected: &str) -> Failure {
        let (name, shape) = (self.name, &self.shape);
        let numbers: Numbers =
            vec![("argument", name.into()), ("shape", Number::Counts(shape.clone()))];
        Failure::Array {
            message: format!("{name} must have {expected}, but its shape is {shape:?}"),
            numbers,
        }
    }

    /// The same with the axes exchanged.
    pub(crate) fn transposed(self) -> PyResult<Self> {
        let array = self.array.getattr("T")?;
        let shape = self.shape.into_iter().rev().collect();
        Ok(Self { array, shape, ..self })
    }

    /// The numbers as they are, in C order, each at a place in memory that is one for numbers.
    fn in_order(&self, dtype: &str) -> PyResult<Bound<'py, PyAny>> {
        let options = (&self.array, dtype, ["C", "ALIGNED"]);
        self.array.py().import("numpy")?.call_method1("require", options)
    }

    /// The field of these numbers.
    pub(crate) fn field(&self) -> Fallible<DMatrix<f64>> {
        let (rows, columns) = self.rows_and_columns()?;
        let array: PyReadonlyArray2<'_, f64> = self.in_order("float64")?.extract()?;
        Ok(DMatrix::from_vec(columns, rows, values(array.as_slice())?))
    }

    /// The field of these numbers on a grid.
    pub(crate) fn on(&self, grid: &Grid) -> Fallible<DMatrix<f64>> {
        let (rows, columns) = self.rows_and_columns()?;
        grid.check_shape((columns, rows))?;
        self.field()
    }

    /// The map of these truths on a grid.
    pub(crate) fn map_on(&self, grid: &Grid) -> Fallible<DMatrix<bool>> {
        let (rows, columns) = self.rows_and_columns()?;
        grid.check_shape((columns, rows))?;
        let array: PyReadonlyArray2<'_, bool> = self.in_order("bool")?.extract()?;
        Ok(DMatrix::from_vec(columns, rows, values(array.as_slice())?))
    }

    /// The numbers of one axis.
    pub(crate) fn list(&self) -> Fallible<Vec<f64>> {
        if self.shape.len() != 1 {
            return Err(self.wrong_shape("one dimension"));
        }
        let array: PyReadonlyArray1<'_, f64> = self.in_order("float64")?.extract()?;
        values(array.as_slice())
    }

    /// The numbers of an axis of so many, or one number for all of them.
    pub(crate) fn list_of(&self, count: usize) -> Fallible<Vec<f64>> {
        match self.shape[..] {
            [] => {
                let value: f64 = self.array.call_method0("item")?.extract()?;
                Ok(vec![value; count])
            }
            [found] if found == count => self.list(),
            _ => Err(self.wrong_shape(&format!("{count} values in one dimension"))),
        }
    }
}

fn values<T: Copy, E: std::fmt::Display>(slice: Result<&[T], E>) -> Fallible<Vec<T>> {
    // What NumPy was asked for is contiguous.
    slice.map(<[T]>::to_vec).map_err(|error| Failure::Panic(error.to_string()))
}

/// Columns of a table, or values along the states of a path, for a new array.
pub(crate) fn column<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    PyArray1::from_vec(py, values)
}

/// A field as a new array [row, column] in C order.
pub(crate) fn rows<T: Element + Scalar>(
    py: Python<'_>,
    field: DMatrix<T>,
) -> Fallible<Bound<'_, PyArray2<T>>> {
    let (columns, rows) = field.shape();
    let values: Vec<T> = field.data.into();
    let array = Array2::from_shape_vec((rows, columns), values);
    let array = array.map_err(|error| Failure::Panic(error.to_string()))?;
    Ok(array.into_pyarray(py))
}

/// Rows and columns of arrays on a grid.
pub(crate) fn shape(grid: &Grid) -> (usize, usize) {
    (grid.ny(), grid.nx())
}

/// Whether an array of NumPy has no values in it.
pub(crate) fn is_empty(found: &Found<'_>) -> bool {
    found.shape.contains(&0)
}

/// Lengths along x and y \[m\]: two numbers, or one for both.
pub(crate) enum Lengths {
    Same(f64),
    Both([f64; 2]),
}
one_of!(Lengths, "a number or (x, y)", Same, Both);

impl Lengths {
    /// The grid of an array \[row, column\] with these sides \[m\]; of square cells if there is one.
    pub(crate) fn grid(&self, (rows, columns): (usize, usize)) -> Result<Grid, Error> {
        let (x, y) = self.x_and_y();
        let y = y.unwrap_or(x / columns.max(1) as f64 * rows as f64);
        Ok(Grid::with_sides(columns, rows, x, y)?)
    }

    /// Along x, and along y if it is given apart.
    pub(crate) fn x_and_y(&self) -> (f64, Option<f64>) {
        match *self {
            Self::Both([x, y]) => (x, Some(y)),
            Self::Same(x) => (x, None),
        }
    }
}
