//! Nanosurf, `.nid`: the images of a scanning probe microscope.
//!
//! Sources: SurfaceTopography's `EZD.py`, Gwyddion's `ezdfile.c`, NSFopen; a file of an instrument.
//!
//! A header of sections `[DataSet-0:1]` with lines `key=value` ends with `#!`. Groups of channels are listed in the
//! section `DataSet`; their integers follow in the same order, each image from its lowest row on. `Dim2Range` is what
//! all integers of that length span, from `Dim2Min` on.

use std::collections::HashMap;

use super::bytes::{Bytes, Order, find, shape, shared};
use super::fault::Fault;
use super::number::Number;
use super::raw::{Channel, Parsed};
use super::sections::{Section, Style};

pub(super) const BEGINS: &[u8] = b"[DataSet]";

const END: &[u8] = b"#!";

const STYLE: Style = Style { begins: b"[", ends: b"]", mark: "", between: '=' };

/// Most groups, and most channels of a group.
const MOST: usize = 64;

pub(super) fn parse(file: &[u8]) -> Parsed {
    let end = find(file, END).ok_or_else(|| fault!("the header has no end, '#!'"))?;
    let sections = Section::all(file.get(..end).unwrap_or_default(), &STYLE);
    let set = sections.first().ok_or_else(|| fault!("the header has no section"))?;
    // The first of each name; there are as many as the header has room for.
    let named: HashMap<&[u8], &Section> =
        sections.iter().rev().map(|section| (section.name, section)).collect();
    let mut bytes = Bytes::from(file, end + END.len())?;
    let mut channels = Vec::new();
    let groups: usize = set.number("GroupCount")?;
    ensure!(groups <= MOST, "there are {groups} groups, more than {MOST}");
    for group in 0..groups {
        let count: usize = set.number(&format!("Gr{group}-Count"))?;
        ensure!(count <= MOST, "group {group} has {count} channels, more than {MOST}");
        for channel in 0..count {
            let Some(name) = set.get(&format!("Gr{group}-Ch{channel}")) else {
                continue;
            };
            let section = named.get(name.as_bytes());
            let section = section.ok_or_else(|| fault!("there is no section '{name}'"))?;
            channels.extend(image(section, &mut bytes)?);
        }
    }
    Ok(channels)
}

/// The image that begins here, `None` if its lines are no lengths: curves of spectroscopy.
fn image(section: &Section, bytes: &mut Bytes) -> Result<Option<Channel>, Fault> {
    let (nx, ny) = shape(section.number::<u64>("Points")?, section.number::<u64>("Lines")?)?;
    let mode = section.need("SaveMode")?;
    ensure!(mode == "Binary", "the numbers are saved as '{mode}', but 'Binary' was expected");
    let is_signed = match section.need("SaveSign")?.as_str() {
        "Signed" => true,
        "Unsigned" => false,
        other => bail!("SaveSign is '{other}', but 'Signed' or 'Unsigned' was expected"),
    };
    let number = match (section.number::<u32>("SaveBits")?, is_signed) {
        (8, true) => Number::I8,
        (8, false) => Number::U8,
        (16, true) => Number::I16,
        (16, false) => Number::U16,
        (32, true) => Number::I32,
        (32, false) => Number::U32,
        (bits, _) => bail!("the numbers have {bits} bits each, but 8, 16 or 32 were expected"),
    };
    let order = match section.need("SaveOrder")?.as_str() {
        "Intel" => Order::Little,
        "Motorola" => Order::Big,
        other => bail!("SaveOrder is '{other}', but 'Intel' or 'Motorola' was expected"),
    };
    let axis = |axis: usize, what: &str| format!("Dim{axis}{what}");
    let range = |k: usize| section.number::<f64>(&axis(k, "Range"));
    let text = |key: &str| section.get(key).map(|text| shared(&text));
    let unit = |k: usize| text(&axis(k, "Unit")).filter(|unit| !unit.is_empty());
    let (lx, ly, lz) = (range(0)?, range(1)?, range(2)?);
    let least: f64 = section.number("Dim2Min")?;
    let all = 2_f64.powi(8 * number.size() as i32);
    let below = if is_signed { all / 2.0 } else { 0.0 };
    let data = bytes.elements(nx * ny, number.size())?;
    let (x, y) = (unit(0), unit(1));
    if x != y {
        return Ok(None);
    }
    let values = number.decode_ordered(data, order, |value| least + (value + below) / all * lz)?;
    let (frame, name) = (text("Frame"), text(&axis(2, "Name")));
    let channel = Channel {
        name: format!("{} ({})", frame.unwrap_or_default(), name.unwrap_or_default()),
        height_unit: unit(2),
        lateral_unit: x,
        ..Channel::in_metres((nx, ny), values, Some((lx / nx as f64, ly / ny as f64)))
    };
    Ok(Some(channel.turned()))
}
