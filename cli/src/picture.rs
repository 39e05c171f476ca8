//! Pictures of pixels, as PNG files.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use plotters::prelude::*;
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};

use crate::outcome::Failure;
use crate::panel::{Area, Drawn};

/// Pixels of a fine drawing for one of its picture: what makes lines smooth.
pub const FINE: i32 = 3;

/// Draws a picture of a width and a height, and writes it.
pub fn draw(
    name: &Path,
    size: (i32, i32),
    drawing: impl for<'a> FnOnce(&Area<BitMapBackend<'a>>) -> Drawn<BitMapBackend<'a>>,
) -> Result<PathBuf, Failure> {
    pixels(size, drawing)
        .and_then(|pixels| write(name, size, &pixels))
        .map_err(|error| Failure::new(format!("cannot write {}", name.display()), error))
}

/// Draws something [`FINE`] times as large as the picture, and writes the picture.
pub fn draw_fine(
    name: &Path,
    (width, height): (i32, i32),
    drawing: impl for<'a> FnOnce(&Area<BitMapBackend<'a>>) -> Drawn<BitMapBackend<'a>>,
) -> Result<PathBuf, Failure> {
    pixels((FINE * width, FINE * height), drawing)
        .and_then(|fine| write(name, (width, height), &averages(&fine, width as usize)))
        .map_err(|error| Failure::new(format!("cannot write {}", name.display()), error))
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

fn write(name: &Path, (width, height): (i32, i32), pixels: &[u8]) -> Result<PathBuf, String> {
    let encode = || -> Result<(), EncodingError> {
        let file = BufWriter::new(File::create(name)?);
        let mut encoder = Encoder::new(file, width as u32, height as u32);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        // Even areas compress best as they are.
        encoder.set_compression(Compression::High);
        encoder.set_filter(Filter::NoFilter);
        encoder.write_header()?.write_image_data(pixels)
    };
    match encode() {
        Ok(()) => Ok(name.to_path_buf()),
        Err(error) => Err(error.to_string()),
    }
}
