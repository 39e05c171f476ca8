//! Pictures of pixels, as PNG files, and of lines and text, as SVG files.

use std::path::{Path, PathBuf};

use plotters::prelude::*;
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};

use crate::outcome::{self, Failure};
use crate::panel::{Area, Drawn};

/// Pixels of a fine drawing for one of its picture: what makes lines smooth.
pub const FINE: i32 = 3;

/// Draws a picture of a width and a height, and writes it.
pub fn draw(
    name: &Path,
    size: (i32, i32),
    drawing: impl for<'a> FnOnce(&Area<BitMapBackend<'a>>) -> Drawn<BitMapBackend<'a>>,
) -> Result<PathBuf, Failure> {
    let encoded = pixels(size, drawing).and_then(|pixels| encode(size, &pixels));
    keep(name, encoded)
}

/// Draws something [`FINE`] times as large as the picture, and writes the picture.
pub fn draw_fine(
    name: &Path,
    (width, height): (i32, i32),
    drawing: impl for<'a> FnOnce(&Area<BitMapBackend<'a>>) -> Drawn<BitMapBackend<'a>>,
) -> Result<PathBuf, Failure> {
    let encoded = pixels((FINE * width, FINE * height), drawing)
        .and_then(|fine| encode((width, height), &averages(&fine, width as usize)));
    keep(name, encoded)
}

/// Draws lines and text in `fine` units to a pixel, of which plotters needs whole ones, and writes them as SVG.
pub fn draw_svg(
    name: &Path,
    (width, height): (i32, i32),
    fine: i32,
    drawing: impl for<'a> FnOnce(&Area<SVGBackend<'a>>) -> Drawn<SVGBackend<'a>>,
) -> Result<PathBuf, Failure> {
    let units = (fine * width, fine * height);
    let mut text = String::new();
    {
        let size = (units.0 as u32, units.1 as u32);
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        let drawn = drawing(&area).and_then(|()| area.present());
        drawn.map_err(|error| Failure::writing(name, error.to_string()))?;
    }
    let in_units = format!("width=\"{}\" height=\"{}\"", units.0, units.1);
    outcome::write(
        name,
        text.replacen(&in_units, &format!("width=\"{width}\" height=\"{height}\""), 1),
    )
}

/// Three bytes for each pixel of a drawing on white.
fn pixels(
    (width, height): (i32, i32),
    drawing: impl for<'a> FnOnce(&Area<BitMapBackend<'a>>) -> Drawn<BitMapBackend<'a>>,
) -> Result<Vec<u8>, String> {
    let mut pixels = vec![0; 3 * width as usize * height as usize];
    {
        let size = (width as u32, height as u32);
        let area = BitMapBackend::with_buffer(&mut pixels, size).into_drawing_area();
        let drawn = area.fill(&WHITE).and_then(|()| drawing(&area));
        drawn.map_err(|error| error.to_string())?;
    }
    Ok(pixels)
}

/// The picture of so many columns of which this is the fine drawing.
fn averages(pixels: &[u8], columns: usize) -> Vec<u8> {
    let fine = FINE as usize;
    let average = |x: usize, y: usize, channel: usize| {
        let inside = (0..fine * fine).map(|k| {
            let place = (y * fine + k / fine) * fine * columns + x * fine + k % fine;
            usize::from(pixels[3 * place + channel])
        });
        // Sixteen levels are enough for smooth lines, and make a small file.
        ((inside.sum::<usize>() / (fine * fine) + 8) / 17 * 17) as u8
    };
    (0..pixels.len() / (fine * fine))
        .map(|k| average(k / 3 % columns, k / 3 / columns, k % 3))
        .collect()
}

/// The bytes of a PNG file.
fn encode((width, height): (i32, i32), pixels: &[u8]) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    // Even areas compress best as they are.
    encoder.set_compression(Compression::High);
    encoder.set_filter(Filter::NoFilter);
    let write = |mut image: png::Writer<&mut Vec<u8>>| -> Result<(), EncodingError> {
        image.write_image_data(pixels)?;
        image.finish()
    };
    let written = encoder.write_header().and_then(write);
    written.map_err(|error| error.to_string())?;
    Ok(bytes)
}

fn keep(name: &Path, encoded: Result<Vec<u8>, String>) -> Result<PathBuf, Failure> {
    match encoded {
        Ok(bytes) => outcome::write(name, bytes),
        Err(error) => Err(Failure::writing(name, error)),
    }
}
