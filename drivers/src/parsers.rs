//! Files of every format, hostile ones most of all.

use allocation_counter::measure;
use asperity::Grid;
use asperity::io::{
    LengthUnit, MeasuredSurface, ReadOptions, TextLayout, channels, read_npy, write_gsf, write_npy,
    write_x3p,
};
use nalgebra::DMatrix;

use crate::draw::Draw;
use crate::edits::edit;
use crate::files::{BEGINNINGS, FILES};
use crate::scratch::{Scratch, bytes_of};
use crate::verdict::{Tally, Verdict, Violation, ensure};

/// Bytes of memory for each byte of a file. One byte can make a height of eight in several maps with masks, and a row
/// of six bytes a point, which needs no more than sixteen nodes of a grid.
const MEMORY: u64 = 64;
/// What deflate can make of a byte at most, and what its two bytes of a height take when they are read.
const INFLATED: u64 = 1032 * (1 + 8 / 2) + MEMORY;
/// What any file takes: messages, paths, the tables of an inflater.
const ANYWAY: u64 = 1 << 18;
/// Nodes up to which missing ones are filled.
const FILLED: usize = 1 << 12;
/// Longest file.
const LONGEST: usize = 1 << 16;

/// Reads bytes as a file of heights: as they are, behind the beginning of some format, as a file that was tampered
/// with, or as what the library has written. No panic, no more memory than the length of the file allows, nothing
/// infinite in what was read; and what was read is the same when it is written and read again.
///
/// # Errors
///
/// What is wrong.
pub fn parsers(bytes: &[u8]) -> Verdict {
    let mut draw = Draw::new(bytes);
    let kind = draw.whole(0, 3);
    let options = options(&mut draw)?;
    let scratch = Scratch::new()?;
    let mut layout_of_text = None;
    let file = match kind {
        0 => draw.rest().to_vec(),
        1 => {
            let beginning = draw.one_of(BEGINNINGS[0], &BEGINNINGS);
            [beginning, draw.rest()].concat()
        }
        2 => {
            layout_of_text = layout(&mut draw);
            let mut file = draw.one_of(FILES[0], &FILES).to_vec();
            edit(&mut draw, &mut file, LONGEST);
            file
        }
        _ => {
            let mut file = written(&mut draw, &scratch)?;
            edit(&mut draw, &mut file, LONGEST);
            file
        }
    };
    let with_layout = layout_of_text.is_some();
    let options =
        layout_of_text.map_or_else(|| options.clone(), |layout| options.clone().layout(layout));
    read(&file, &options, with_layout, &scratch)
}

/// What is asked of a reader: nothing, mostly, and otherwise whatever there is.
fn options(draw: &mut Draw<'_>) -> Result<ReadOptions, Violation> {
    let options = ReadOptions::new();
    Ok(match draw.whole(0, 7) {
        0..=2 => options,
        3 => options.height_unit(LengthUnit::METRE).lateral_unit(LengthUnit::METRE),
        4 => {
            let unit = draw.one_of("nm", &["µm", "Å", "in", "cm", "mm", "pm", "fm"]);
            let unit: LengthUnit = unit
                .parse()
                .map_err(|error| Violation::new(format!("{unit} was refused: {error}")))?;
            options.height_unit(unit).side(draw.decades(-9.0, 3.0))
        }
        5 => options.side(draw.any()).side_y(draw.any()),
        6 => options.channel(draw.one_of("Height", &["", "Topo", "ZSensor", "\0"])),
        _ => options.ignore_mask().side(1.0),
    })
}

/// How a text is to be read, now and then.
fn layout(draw: &mut Draw<'_>) -> Option<TextLayout> {
    let place = draw.whole(0, 4 * TextLayout::ALL.len());
    TextLayout::ALL.get(place).copied()
}

/// A file that the library has written, of heights that are drawn: any numbers.
fn written(draw: &mut Draw<'_>, scratch: &Scratch) -> Result<Vec<u8>, Violation> {
    let (nx, ny) = (draw.whole(1, 6), draw.whole(1, 6));
    let any = draw.once_in(2);
    let heights = DMatrix::from_fn(nx, ny, |_, _| if any { draw.any() } else { draw.unit() });
    let (dx, dy) = (draw.decades(-9.0, 3.0), draw.decades(-9.0, 3.0));
    let grid = Grid::new(nx, ny, dx, dy)
        .map_err(|error| Violation::new(format!("a sensible grid was refused: {error}")))?;
    let path = scratch.path("written");
    let done = match draw.whole(0, 2) {
        0 => write_npy(&path, &heights),
        1 => write_gsf(&path, &grid, &heights, "m"),
        _ => write_x3p(&path, &grid, &heights),
    };
    done.map_err(|error| Violation::new(format!("{nx} x {ny} heights were not written: {error}")))?;
    bytes_of(&path)
}

/// Reads a file and looks at what was found.
fn read(file: &[u8], options: &ReadOptions, with_layout: bool, scratch: &Scratch) -> Verdict {
    let path = scratch.file("file", file)?;
    let mut outcome = None;
    let memory = measure(|| outcome = Some(options.read(&path)));
    let inflates = [&b"PK"[..], b"DSCOMPRESSED", b"VK6", b"VK7", b"\xd0\xcf\x11\xe0"];
    let inflates = inflates.iter().any(|magic| file.starts_with(magic));
    let limit = ANYWAY + file.len() as u64 * if inflates { INFLATED } else { MEMORY };
    ensure!(
        memory.bytes_max <= limit,
        "{} bytes of memory for a file of {}, more than {limit}",
        memory.bytes_max,
        file.len()
    );
    let names = channels(&path);
    match outcome {
        Some(Ok(surface)) => {
            // Without a layout a text may be refused.
            let known = with_layout || names.is_ok_and(|names| names == surface.channels);
            ensure!(known, "a map was read, but not the names of all maps");
            look_at(&surface)?;
            write_again(&surface, scratch)?;
            Ok(Tally { checked: 1, ..Tally::default() })
        }
        // Any bytes but those of a surface deserve a refusal, in words.
        Some(Err(error)) => {
            ensure!(!error.to_string().is_empty(), "a refusal without a reason");
            Ok(Tally::refusal())
        }
        None => Err(Violation::new("nothing was read")),
    }
}

/// What is true of any map that was read.
fn look_at(surface: &MeasuredSurface) -> Result<(), Violation> {
    let (nx, ny) = surface.heights.shape();
    ensure!(
        (1..=Grid::MAX_SIDE).contains(&nx) && (1..=Grid::MAX_SIDE).contains(&ny),
        "a map of {nx} x {ny} nodes"
    );
    let infinite = surface.heights.iter().find(|height| height.is_infinite());
    ensure!(infinite.is_none(), "a height is {infinite:?}");
    let missing = surface.heights.iter().filter(|h| h.is_nan()).count();
    ensure!(missing == surface.missing, "{missing} heights are missing, not {}", surface.missing);
    if let Some((dx, dy)) = surface.cell {
        ensure!(
            dx > 0.0 && dx.is_finite() && dy > 0.0 && dy.is_finite(),
            "cells of {dx:e} x {dy:e}"
        );
    }
    ensure!(!surface.to_string().is_empty(), "a map that has nothing to say");
    let is_grid = surface.grid().is_ok();
    if missing < nx * ny && nx * ny <= FILLED {
        let filled = surface.clone().fill_missing();
        let filled =
            filled.map_err(|error| Violation::new(format!("filling {missing}: {error}")))?;
        ensure!(
            filled.missing == 0 && filled.heights.iter().all(|h| h.is_finite()),
            "heights are missing after they were filled"
        );
        ensure!(filled.topography().is_ok() == is_grid, "a whole map has no topography");
    }
    let whole = is_grid && missing == 0;
    ensure!(
        surface.clone().topography().is_ok() == whole,
        "a topography of {missing} missing heights, with a grid: {is_grid}"
    );
    Ok(())
}

/// Whether two maps hold the same bits, but for those of NaN.
fn same(a: &DMatrix<f64>, b: &DMatrix<f64>) -> bool {
    let equal = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
    a.shape() == b.shape() && a.iter().zip(b).all(equal)
}

/// What was read is written, and read again.
fn write_again(surface: &MeasuredSurface, scratch: &Scratch) -> Result<(), Violation> {
    let failed = |error: asperity::SurfaceError| Violation::new(format!("written again: {error}"));
    let heights = &surface.heights;
    let path = scratch.path("again");
    write_npy(&path, heights).map_err(failed)?;
    ensure!(same(&read_npy(&path).map_err(failed)?, heights), "another map in a .npy file");
    let Ok(grid) = surface.grid() else {
        return Ok(());
    };
    let (lx, ly) = grid.sides();
    let expected = (lx / grid.nx() as f64, ly / grid.ny() as f64);
    // Sides and cells follow from each other by a product and a quotient.
    let close = |a: f64, b: f64| (a - b).abs() <= 4.0 * f64::EPSILON * b;
    for format in ["gsf", "x3p"] {
        let (written, rounded) = match format {
            // Seven digits, of which those beyond the range are none.
            "gsf" => (
                write_gsf(&path, &grid, heights, "m"),
                heights.map(|height| {
                    let single = f64::from(height as f32);
                    if single.is_finite() { single } else { f64::NAN }
                }),
            ),
            _ => (write_x3p(&path, &grid, heights), heights.clone()),
        };
        written.map_err(failed)?;
        let again = ReadOptions::new().read(&path).map_err(failed)?;
        ensure!(same(&again.heights, &rounded), "another map in a .{format} file");
        let Some((dx, dy)) = again.cell else {
            return Err(Violation::new(format!("no cell in a .{format} file")));
        };
        ensure!(
            close(dx, expected.0) && close(dy, expected.1),
            "cells of {dx:e} x {dy:e} in a .{format} file instead of {expected:?}"
        );
    }
    Ok(())
}
