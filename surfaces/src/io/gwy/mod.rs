//! Gwyddion's own format, `.gwy`.
//!
//! A map is the component `/N/data` of the outermost container, N any number: an object `GwyDataField` with `xres` ×
//! `yres` values and sides `xreal`, `yreal`, in the units `si_unit_xy` and `si_unit_z`. `/N/data/title` is its name,
//! and `/N/mask`, a field of the same shape, marks nodes with values above ½. Everything else is passed over.
//!
//! Source: Gwyddion's user guide, chapter "Gwyddion native data".

mod tree;

use std::collections::BTreeMap;

use self::tree::{Object, Value};
use super::bytes::{Bytes, shape};
use super::fault::Fault;
use super::number::Number;
use super::raw::{Channel, Parsed};

const MAGIC: &[u8] = b"GWYP";

const FIELD: &str = "GwyDataField";

pub(super) fn parse(file: &[u8]) -> Parsed {
    let mut bytes = Bytes::new(file);
    bytes.take(MAGIC.len())?;
    let root = Object::read(file, &mut bytes)?;
    let name = String::from_utf8_lossy(root.name);
    ensure!(name == "GwyContainer", at(MAGIC.len()), "expected a GwyContainer, but found '{name}'");
    // A container has no order: maps are put into that of their numbers, as Gwyddion lists them.
    let mut maps: BTreeMap<u64, Map> = BTreeMap::new();
    for component in root.components()? {
        let (key, value) = component?;
        let Some((number, what)) = numbered(key) else {
            continue;
        };
        match (what, value) {
            ("data", Value::Object(field)) if field.name == FIELD.as_bytes() => {
                maps.entry(number).or_default().field = Some(field);
            }
            ("mask", Value::Object(field)) if field.name == FIELD.as_bytes() => {
                maps.entry(number).or_default().mask = Some(field);
            }
            ("data/title", Value::Text(title)) => maps.entry(number).or_default().title = title,
            _ => {}
        }
    }
    maps.retain(|_, map| map.field.is_some());
    let titles: Vec<String> = maps.iter().map(|(number, map)| map.title(*number)).collect();
    let mut times: BTreeMap<&str, usize> = BTreeMap::new();
    titles.iter().for_each(|title| *times.entry(title).or_default() += 1);
    let mut channels = Vec::new();
    for ((number, map), title) in maps.iter().zip(&titles) {
        // Names that occur more than once are told apart, so that each can be chosen.
        let is_only = times[title.as_str()] == 1;
        let name = if is_only { title.clone() } else { format!("{title} [{number}]") };
        channels.extend(map.channel(name)?);
    }
    Ok(channels)
}

/// Number and remainder of a key `/N/...`.
fn numbered(key: &[u8]) -> Option<(u64, &str)> {
    let key = std::str::from_utf8(key).ok()?.strip_prefix('/')?;
    let (number, what) = key.split_once('/')?;
    Some((number.parse().ok()?, what))
}

/// What belongs to one number.
#[derive(Debug, Default)]
struct Map<'a> {
    field: Option<Object<'a>>,
    mask: Option<Object<'a>>,
    title: &'a [u8],
}

impl Map<'_> {
    fn title(&self, number: u64) -> String {
        match String::from_utf8_lossy(self.title).trim() {
            "" => format!("/{number}/data"),
            title => title.to_string(),
        }
    }

    fn channel(&self, name: String) -> Result<Option<Channel>, Fault> {
        let Some(field) = &self.field else {
            return Ok(None);
        };
        let ((nx, ny), heights) = values(field)?;
        // Sides default to 1 in the format, which is no size of any surface.
        let cell = match (field.find("xreal")?, field.find("yreal")?) {
            (Some(Value::Double(x)), Some(Value::Double(y))) => {
                Some((x / nx as f64, y / ny as f64))
            }
            _ => None,
        };
        let mut channel = Channel {
            name,
            height_unit: unit(field, "si_unit_z")?,
            lateral_unit: unit(field, "si_unit_xy")?,
            ..Channel::in_metres((nx, ny), heights, cell)
        };
        if let Some(mask) = &self.mask {
            let (shape, marks) = values(mask)?;
            if shape == channel.shape {
                channel.mask = Some(marks.iter().map(|mark| *mark > 0.5).collect());
            } else {
                channel.notes.push(format!(
                    "the mask has {} x {} nodes, the map {nx} x {ny}: it is not used",
                    shape.0, shape.1
                ));
            }
        }
        Ok(Some(channel))
    }
}

/// Shape and values of a field.
fn values(field: &Object) -> Result<((usize, usize), Vec<f64>), Fault> {
    let at = field.begin;
    let lacks = |name: &str| fault!(at(at), "the GwyDataField has no '{name}' of the right type");
    let count = |name: &str| match field.find(name)? {
        Some(Value::Int(count)) => u64::try_from(count)
            .map_err(|_| fault!(at(at), "{name} is {count}, but a number of nodes was expected")),
        _ => Err(lacks(name)),
    };
    let (nx, ny) = shape(count("xres")?, count("yres")?)?;
    let Some(Value::Doubles(data)) = field.find("data")? else {
        return Err(lacks("data"));
    };
    let found = data.len() / 8;
    ensure!(found == nx * ny, at(at), "a field of {nx} x {ny} nodes has {found} values");
    Ok(((nx, ny), Number::F64.decode_all(data, |value| value)?))
}

/// What a unit is called; `None` if there is no name, or an empty one: the numbers are counts then.
fn unit(field: &Object, name: &str) -> Result<Option<String>, Fault> {
    let Some(Value::Object(unit)) = field.find(name)? else {
        return Ok(None);
    };
    let Some(Value::Text(text)) = unit.find("unitstr")? else {
        return Ok(None);
    };
    let text = String::from_utf8_lossy(text);
    Ok(Some(text.trim().to_string()).filter(|text| !text.is_empty()))
}

#[cfg(test)]
mod tests;
