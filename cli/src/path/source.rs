//! The surfaces of a path, from files.

use std::path::Path;

use asperity::Surface;
use asperity::surface::{Axis, Topography};
use asperity_cli::note;
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;
use md5::{Digest, Md5};
use serde_json::{Value, json};

use super::options::Options;
use super::shift::Shift;

/// A surface, its name, and what it is from.
pub(super) type Made = (Topography, String, Value);

/// The surface of a file, with that of the other body on it if both are rough.
pub(super) fn read(file: &Path, options: &Options) -> Result<Made, Failure> {
    let first = options.reading.surface(file)?;
    let mut name = file.display().to_string();
    let Some(other) = &options.against_surface else {
        let source = source_of(&name, &first, options);
        return Ok((first, name, source));
    };
    let second = options.reading.surface(other)?;
    let (first_grid, grid) = (first.grid(), second.grid());
    if first_grid != grid {
        let in_words = |grid: &asperity::Grid| {
            let ((nx, ny), (lx, ly)) = (grid.shape(), grid.sides());
            format!("{nx} x {ny} nodes on {} x {}", quantity(lx, "m", 6), quantity(ly, "m", 6))
        };
        return Err(Failure::request(format!(
            "two rough surfaces need one grid: {name} has {}, and {} has {}",
            in_words(first_grid),
            other.display(),
            in_words(grid)
        )));
    }
    // Face to face: the other one is turned over, about y.
    let facing = second.flip(Axis::X);
    let facing = match options.against_turned {
        true => facing.flip(Axis::X).flip(Axis::Y),
        false => facing,
    };
    let facing = match options.against_shift {
        Some(shift) => shifted(&facing, shift, options)?,
        None => facing,
    };
    let failed = |error| Failure::new("cannot put the surfaces on each other", error);
    let both = Topography::sample(&(&first).plus(&facing), *first_grid).map_err(failed)?;
    name = format!("{name} against {}", other.display());
    note!(
        "facing     {} is turned over about y{}{}",
        other.display(),
        match options.against_turned {
            true => ", and by 180° in its plane",
            false => "",
        },
        match options.against_shift {
            Some(Shift(ix, iy)) => format!(", and moved by {ix} and {iy} nodes along x and y"),
            None => String::new(),
        }
    );
    let mut source = source_of(&name, &both, options);
    source["against_turned"] = json!(options.against_turned);
    source["against_shift"] = json!(options.against_shift.map(|Shift(ix, iy)| [ix, iy]));
    Ok((both, name, source))
}

/// A surface moved as asked, along directions in which it repeats.
fn shifted(
    surface: &Topography,
    Shift(ix, iy): Shift,
    options: &Options,
) -> Result<Topography, Failure> {
    let repeats = options.boundary().repeats();
    for (shift, along, repeats) in [(ix, "x", repeats[0]), (iy, "y", repeats[1])] {
        if shift != 0 && !repeats {
            return Err(Failure::request(format!(
                "--against-shift moves along {along} what has to repeat there, and this half-space does not: give \
                 --periodic love, or cut both files to the part that is to touch"
            )));
        }
    }
    Ok(surface.shift(ix, iy))
}

/// What the settings say of it.
fn source_of(name: &str, surface: &Topography, options: &Options) -> Value {
    json!({
        "file": name,
        "heights_md5": fingerprint(surface),
        "reading": options.reading.given(),
    })
}

/// MD5 of the heights as they are pressed, in 64 bits each, x fast.
pub(super) fn fingerprint(surface: &Topography) -> String {
    let mut hash = Md5::new();
    for height in surface.map().matrix() {
        hash.update(height.to_le_bytes());
    }
    let digits = hash.finalize();
    digits.iter().map(|byte| format!("{byte:02x}")).collect()
}
