//! Zygo's MetroPro, `.dat`: the heights of an interferometer.
//!
//! Sources: Zygo's MetroPro reference guide as quoted by several readers, SurfaceTopography's `MetroPro.py`, prysm's
//! `io.py`; a file of an instrument.
//!
//! A header, most significant byte first, then intensities, which are not read, then heights in parts of a wavelength:
//! an integer is `S·O·λ/R`, with the scale S of the interferometer, the obliquity O, and the resolution R.

use super::bytes::{Bytes, Order, shape};
use super::fault::Fault;
use super::number::{Number, positive};
use super::raw::{Channel, Parsed};

pub(super) const BEGINS: &[&[u8]] =
    &[b"\x88\x1b\x03\x6f", b"\x88\x1b\x03\x70", b"\x88\x1b\x03\x71"];

/// Places in the header.
const HEADER: usize = 6;
const INTENSITIES: usize = 60;
const SHAPE: usize = 68;
const SCALE: usize = 164;
const WAVELENGTH: usize = 168;
const OBLIQUITY: usize = 176;
const PIXEL: usize = 184;
const RESOLUTION: usize = 218;
/// Not 0 where heights are stored with their signs changed.
const SIGN: usize = 232;

/// Integers from here on stand for missing heights.
const MISSING: f64 = 2_147_483_640.0;

pub(super) fn parse(file: &[u8]) -> Parsed {
    let field = |place: usize| Ok::<_, Fault>(Bytes::from(file, place)?.ordered(Order::Big));
    let length = |place: usize, name: &str| positive(name, f64::from(field(place)?.f32()?), place);
    let mut sizes = field(SHAPE)?;
    let (nx, ny) = shape(sizes.u16()?, sizes.u16()?)?;
    let claimed = sizes.u32()? as usize;
    let needed = (nx * ny).saturating_mul(Number::I32.size());
    ensure!(
        claimed == needed,
        at(SHAPE + 4),
        "{nx} x {ny} heights are said to take {claimed} bytes"
    );
    let parts = match field(RESOLUTION)?.u16()? {
        0 => 4096.0,
        1 => 32768.0,
        2 => 131_072.0,
        other => {
            bail!(at(RESOLUTION), "the resolution of phases is {other}, but 0, 1 or 2 was expected")
        }
    };
    let sign = if field(SIGN)?.u16()? == 0 { 1.0 } else { -1.0 };
    let step = sign
        * length(SCALE, "the scale of the interferometer")?
        * length(WAVELENGTH, "the wavelength")?
        * length(OBLIQUITY, "the obliquity")?
        / parts;
    let header = field(HEADER)?.u32()? as usize;
    let mut bytes = field(header.saturating_add(field(INTENSITIES)?.u32()? as usize))?;
    let data = bytes.take(needed)?;
    let height = |value: f64| if value >= MISSING { f64::NAN } else { value * step };
    let values = Number::I32.decode_ordered(data, Order::Big, height)?;
    // Zero where nobody has calibrated.
    let pixel = f64::from(field(PIXEL)?.f32()?);
    let cell = Some((pixel, pixel)).filter(|_| pixel != 0.0);
    Ok(vec![Channel::in_metres((nx, ny), values, cell)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two heights of 1 and 2 parts of a wavelength of 4096 m, as they are and with their signs changed.
    #[test]
    fn signs_are_those_of_the_header() {
        for (sign, expected) in [(0_u8, [1.0, 2.0]), (1, [-1.0, -2.0])] {
            let mut file = vec![0; 834];
            file[..4].copy_from_slice(BEGINS[0]);
            file[HEADER..HEADER + 4].copy_from_slice(&834_u32.to_be_bytes());
            file[SHAPE..SHAPE + 8].copy_from_slice(&[0, 2, 0, 1, 0, 0, 0, 8]);
            for (place, value) in [(SCALE, 1.0_f32), (WAVELENGTH, 4096.0), (OBLIQUITY, 1.0)] {
                file[place..place + 4].copy_from_slice(&value.to_be_bytes());
            }
            file[SIGN + 1] = sign;
            file.extend([1_i32, 2].map(i32::to_be_bytes).concat());
            let parsed = parse(&file).ok().unwrap_or_default();
            let values: Vec<f64> = parsed.into_iter().flat_map(|channel| channel.values).collect();
            assert_eq!(values, expected);
        }
    }
}
