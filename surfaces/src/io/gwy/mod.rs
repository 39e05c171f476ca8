//! Gwyddion's own format, `.gwy`.
//!
//! A map is the component `/N/data` of the outermost container, N any number: an object `GwyDataField` with `xres` ×
//! `yres` values and sides `xreal`, `yreal`, in the units `si_unit_xy` and `si_unit_z`. `/N/data/title` is its name, and
//! `/N/mask`, a field of the same shape, marks nodes with values above ½. Everything else is passed over.
//!
//! Source: Gwyddion's user guide, chapter "Gwyddion native data".

mod tree;

use std::collections::{BTreeMap, HashMap};

use self::tree::{Object, Value};
use super::bytes::{Bytes, shape};
use super::fault::Fault;
use super::raw::{Channel, Parsed, decode};

const MAGIC: &[u8] = b"GWYP";

pub(super) fn parse(file: &[u8]) -> Parsed {
    let mut bytes = Bytes::new(file);
    bytes.take(MAGIC.len())?;
    let root = Object::read(file, &mut bytes)?;
    if !root.is("GwyContainer") {
        return Err(Fault::at(
            MAGIC.len(),
            format!("expected a GwyContainer, but found '{}'", root.name()),
        ));
    }
    // A container has no order: maps are put into that of their numbers, as Gwyddion lists them.
    let mut maps: BTreeMap<u64, Map> = BTreeMap::new();
    for component in root.components()? {
        let (key, value) = component?;
        let Some((number, what)) = numbered(key) else {
            continue;
        };
        match (what, value) {
            ("data", Value::Object(field)) if field.is(FIELD) => {
                maps.entry(number).or_default().field = Some(field);
            }
            ("mask", Value::Object(field)) if field.is(FIELD) => {
                maps.entry(number).or_default().mask = Some(field);
            }
            ("data/title", Value::Text(title)) => maps.entry(number).or_default().title = title,
            _ => {}
        }
    }
    let mut channels = Vec::new();
    let mut numbers = Vec::new();
    for (number, map) in maps {
        if let Some(field) = map.field {
            channels.push(map.channel(number, &field)?);
            numbers.push(number);
        }
    }
    tell_apart(&mut channels, &numbers);
    Ok(channels)
}

/// Number and remainder of a key `/N/...`.
fn numbered(key: &[u8]) -> Option<(u64, &str)> {
    let key = std::str::from_utf8(key).ok()?.strip_prefix('/')?;
    let (number, what) = key.split_once('/')?;
    Some((number.parse().ok()?, what))
}

/// Adds their number to names that occur more than once, so that each can be chosen.
fn tell_apart(channels: &mut [Channel], numbers: &[u64]) {
    let mut times: HashMap<String, usize> = HashMap::new();
    for channel in &*channels {
        *times.entry(channel.name.clone()).or_default() += 1;
    }
    for (channel, number) in channels.iter_mut().zip(numbers) {
        if times.get(&channel.name).is_some_and(|times| *times > 1) {
            channel.name = format!("{} [{number}]", channel.name);
        }
    }
}

const FIELD: &str = "GwyDataField";

/// What belongs to one number.
#[derive(Debug, Default)]
struct Map<'a> {
    field: Option<Object<'a>>,
    mask: Option<Object<'a>>,
    title: &'a [u8],
}

impl Map<'_> {
    fn channel(&self, number: u64, field: &Object) -> Result<Channel, Fault> {
        let title = String::from_utf8_lossy(self.title);
        let mut channel = Channel {
            name: match title.trim() {
                "" => format!("/{number}/data"),
                title => title.to_string(),
            },
            ..channel(field)?
        };
        if let Some(mask) = &self.mask {
            let (shape, marks) = values(mask)?;
            if shape == channel.shape {
                channel.mask = Some(marks.iter().map(|mark| *mark > 0.5).collect());
            } else {
                channel.notes.push(format!(
                    "the mask has {} x {} nodes, the map {} x {}: it is not used",
                    shape.0, shape.1, channel.shape.0, channel.shape.1
                ));
            }
        }
        Ok(channel)
    }
}

/// A field without a name.
fn channel(field: &Object) -> Result<Channel, Fault> {
    let ((nx, ny), values) = values(field)?;
    // Sides default to 1 in the format, which is no size of any surface.
    let cell = match (field.find("xreal")?, field.find("yreal")?) {
        (Some(Value::Double(x)), Some(Value::Double(y))) => Some((x / nx as f64, y / ny as f64)),
        _ => None,
    };
    Ok(Channel {
        height_unit: unit(field, "si_unit_z")?,
        lateral_unit: unit(field, "si_unit_xy")?,
        ..Channel::in_metres((nx, ny), values, cell)
    })
}

/// Shape and values of a field.
fn values(field: &Object) -> Result<((usize, usize), Vec<f64>), Fault> {
    let count = |name: &str| match field.find(name)? {
        Some(Value::Int(count)) => u64::try_from(count).map_err(|_| {
            Fault::at(
                field.begin(),
                format!("{name} is {count}, but a number of nodes was expected"),
            )
        }),
        _ => Err(lacks(field, name)),
    };
    let (nx, ny) = shape(count("xres")?, count("yres")?)?;
    let Some(Value::Doubles(data)) = field.find("data")? else {
        return Err(lacks(field, "data"));
    };
    if data.len() / 8 != nx * ny {
        return Err(Fault::at(
            field.begin(),
            format!("a field of {nx} x {ny} nodes has {} values", data.len() / 8),
        ));
    }
    let values = decode(data, 8, |b| b.try_into().map_or(f64::NAN, f64::from_le_bytes))?;
    Ok(((nx, ny), values))
}

fn lacks(field: &Object, name: &str) -> Fault {
    Fault::at(field.begin(), format!("the GwyDataField has no '{name}' of the right type"))
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
