//! Keyence, `.vk4`: the height images; `.vk6` and `.vk7`: an archive with a `.vk4` in it.
//!
//! Sources: Gwyddion's `keyence.c`, SurfaceTopography's `VK.py`, surfalize's `vk.py`, itom's `DataObjectIO`, and the
//! `vk4-python-driver` of Torkian and Gunn (OSTI 1419732), which agree on the layout. No file of an instrument was at
//! hand.
//!
//! After `VK4_`, a version and four zeros comes a table of places in the file: that of the conditions of the
//! measurement, and those of up to three height images, zero where there is none. The conditions give the size of a
//! pixel and of a step in height in picometres. An image is a header, a palette, and unsigned integers of 8, 16 or
//! 32 bits.
//!
//! Nodes of value zero are marked, and so are missing unless the caller ignores the mask: to itom they are nodes
//! without a measurement, to the other readers heights.

use super::archive::inflated;
use super::bytes::{Bytes, shape};
use super::fault::Fault;
use super::number::{Number, positive};
use super::raw::{Channel, Parsed};

const MAGIC: &[u8] = b"VK4_";

const ARCHIVES: [&[u8]; 2] = [b"VK6", b"VK7"];

pub(super) const BEGINS: &[&[u8]] = &[MAGIC, ARCHIVES[0], ARCHIVES[1]];

/// The member of the archive behind `VK6`, the length of a picture, and the picture.
const MEMBER: &str = "Vk4File";

/// Where the table of places begins, and the place of the first height image in it.
const TABLE: usize = 12;
const HEIGHT: usize = TABLE + 6 * 4;

/// Where the conditions give the size of a pixel along x and y, and then the step in height.
const PIXEL: usize = 42 * 4;
const STEP: usize = PIXEL + 8;

/// Bytes of the palette of an image.
const PALETTE: usize = 768;

/// Metres in a picometre.
const PICOMETRE: f64 = 1e-12;

pub(super) fn parse(file: &[u8]) -> Parsed {
    if !ARCHIVES.iter().any(|begin| file.starts_with(begin)) {
        return images(file);
    }
    images(&inflated(file, MEMBER)?)
        .map_err(|fault| fault.prefixed(&format!("member '{MEMBER}': ")))
}

fn images(file: &[u8]) -> Parsed {
    let mut bytes = Bytes::new(file);
    ensure!(bytes.take(MAGIC.len())? == MAGIC, at(0), "the file does not begin with 'VK4_'");
    bytes.seek(TABLE)?;
    let conditions = bytes.u32()? as usize;
    bytes.seek(HEIGHT)?;
    let places = [bytes.u32()?, bytes.u32()?, bytes.u32()?];

    bytes.seek(conditions.saturating_add(PIXEL))?;
    let mut length = || Ok::<_, Fault>(f64::from(bytes.u32()?) * PICOMETRE);
    let cell = (length()?, length()?);
    let step = positive("the step in height", length()?, conditions + STEP)?;

    let images = places.into_iter().enumerate().filter(|(_, place)| *place > 0);
    images
        .map(|(k, place)| {
            bytes.seek(place as usize)?;
            let name = format!("Height {}", k + 1);
            Ok(Channel { name, cell: Some(cell), ..image(&mut bytes, step)? })
        })
        .collect()
}

/// The image that begins here.
fn image(bytes: &mut Bytes, step: f64) -> Result<Channel, Fault> {
    let at = bytes.offset();
    let (nx, ny) = shape(bytes.u32()?, bytes.u32()?)?;
    let bits = bytes.u32()?;
    let number = match bits {
        8 => Number::U8,
        16 => Number::U16,
        32 => Number::U32,
        _ => bail!(at(at + 8), "the heights have {bits} bits each, but 8, 16 or 32 were expected"),
    };
    let compression = bytes.u32()?;
    let length = bytes.u32()? as usize;
    ensure!(
        length == (nx * ny).saturating_mul(number.size()),
        at(at + 16),
        "{nx} x {ny} heights of {bits} bits are said to take {length} bytes (compression {compression})"
    );
    let _range = (bytes.u32()?, bytes.u32()?);
    bytes.take(PALETTE)?;
    let values = number.decode_all(bytes.take(length)?, |value| value * step)?;
    let zeros = values.iter().filter(|value| **value == 0.0).count();
    let mut channel = Channel::in_metres((nx, ny), values, None);
    if zeros > 0 {
        channel.mask = Some(channel.values.iter().map(|value| *value == 0.0).collect());
        channel.notes = vec![match zeros {
            1 => "1 node holds 0, and is marked: it may not have been measured".to_string(),
            _ => format!("{zeros} nodes hold 0, and are marked: they may not have been measured"),
        }];
    }
    Ok(channel)
}

#[cfg(test)]
mod tests;
