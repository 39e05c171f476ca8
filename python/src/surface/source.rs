//! What a surface is made of: an array, a topography of another package, or a surface.

use asperity::io::LengthUnit;
use pyo3::prelude::*;

use super::{Heights, Surface};
use crate::arrays::{Found, Kind, Lengths, is_empty};
use crate::errors::{Failure, Fallible};
use crate::warnings::warn;

pub(super) fn surface(
    z: &Bound<'_, PyAny>,
    size: Option<&Lengths>,
    height_unit: Option<&str>,
) -> Fallible<Surface> {
    let nothing_else = size.is_none() && height_unit.is_none();
    if let Ok(surface) = z.cast::<Surface>() {
        if !nothing_else {
            return Err(Failure::arguments("a Surface has its size and is in metres"));
        }
        return Ok(copy(surface.get()));
    }
    // SurfaceTopography and what looks like it: `heights` is a method there, and an array has none.
    if z.hasattr("physical_sizes")? && z.getattr_opt("heights")?.is_some_and(|h| h.is_callable()) {
        if !nothing_else {
            return Err(Failure::arguments(
                "an object with physical_sizes and unit has its size: give neither size nor height_unit",
            ));
        }
        return of_topography(z);
    }
    let Some(size) = size else {
        return Err(Failure::arguments(
            "an array does not know its size: give size=(x, y) in metres",
        ));
    };
    let unit = height_unit.map(str::parse::<LengthUnit>).transpose()?;
    of_array(Found::of(z, "z", Kind::Real)?, size, unit.map_or(1.0, LengthUnit::metres))
}

fn copy(surface: &Surface) -> Surface {
    let heights = match &surface.heights {
        Heights::Whole(topography) => Heights::Whole(topography.clone()),
        Heights::Holed(heights) => Heights::Holed(heights.clone()),
    };
    Surface {
        grid: surface.grid,
        heights,
        title: surface.title.clone(),
        understood: surface.understood.clone(),
        notes: surface.notes.clone(),
        periodic: surface.periodic,
    }
}

fn of_array(found: Found<'_>, size: &Lengths, unit: f64) -> Fallible<Surface> {
    let shape = found.rows_and_columns()?;
    if is_empty(&found) {
        // The engine's words for it.
        return Err(Lengths::Same(1.0)
            .grid(shape)
            .err()
            .map_or_else(|| Failure::arguments("there are no heights"), Failure::from));
    }
    // What is too large is refused before it is copied.
    let grid = size.grid(shape)?;
    let mut heights = found.field()?;
    if unit != 1.0 {
        heights *= unit;
    }
    Ok(Surface::new(grid, heights)?)
}

/// A topography: `heights()` is [ix, iy], in the same unit as the sizes.
fn of_topography(topography: &Bound<'_, PyAny>) -> Fallible<Surface> {
    let py = topography.py();
    let found = Found::of(&topography.call_method0("heights")?, "heights()", Kind::Real)?;
    let sizes: Vec<f64> = topography
        .getattr("physical_sizes")?
        .extract()
        .map_err(|_| Failure::arguments("the topography does not know its physical_sizes"))?;
    let [x, y] = sizes[..] else {
        return Err(Failure::arguments(format!(
            "a topography must have two physical_sizes, and this one has {}",
            sizes.len()
        )));
    };
    let unit: Option<String> = match topography.getattr_opt("unit")? {
        Some(unit) => unit.extract()?,
        None => None,
    };
    let metres = match unit {
        Some(unit) => unit.parse::<LengthUnit>()?.metres(),
        None => {
            warn(py, "the topography has no unit: its heights and sizes are taken to be in m")?;
            1.0
        }
    };
    let periodic = match topography.getattr_opt("is_periodic")? {
        Some(periodic) => periodic.extract()?,
        None => None,
    };
    let found = found.transposed()?;
    let size = Lengths::Both([x * metres, y * metres]);
    Ok(Surface { periodic, ..of_array(found, &size, metres)? })
}
