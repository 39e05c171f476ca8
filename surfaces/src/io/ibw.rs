//! Igor's binary waves, `.ibw`, as Asylum Research's microscopes write them: the layers of a wave.
//!
//! Sources: WaveMetrics' technical note 003, SurfaceTopography's `IBW.py`; a file of an instrument and one of Gwyddion.
//!
//! Version 5 has a header of 64 bytes, which gives the lengths of what follows the numbers, and one of 320 bytes with
//! type, shape, steps and units of the wave; longer units follow the numbers. Layers, the third dimension, are maps,
//! whose names are labels of that dimension. The unit of the wave is the metre even if some layers are phases: these
//! are known by their names. The first row is the lowest. Earlier versions have one dimension, and shorter headers.

use super::bytes::{Bytes, Order, shape, text_before_zero};
use super::fault::Fault;
use super::number::Number;
use super::raw::{Channel, Parsed};

/// The headers of version 5, and those of each version together.
const FIRST: usize = 64;
const HEADERS: usize = FIRST + 320;
const VERSIONS: [(u8, usize); 3] = [(2, 16 + 110), (3, 20 + 110), (5, HEADERS)];

/// Places of fields in them.
const LENGTHS: usize = 8;
const TYPE: usize = FIRST + 16;
const NAME: usize = FIRST + 28;
const SHAPE: usize = FIRST + 68;
const STEPS: usize = FIRST + 84;
const UNITS: usize = FIRST + 148;

/// Bytes of a label, which is as long as a unit may be, and of a unit in the header.
const LABEL: usize = 32;
const UNIT: usize = 4;

/// Most layers of a wave: there are a dozen signals, forwards and backwards.
const MOST: u32 = 256;

/// What the names of layers begin with that have the unit of the wave.
const LENGTHS_OF_WAVE: [&str; 4] = ["Height", "ZSensor", "Deflection", "Amplitude"];

/// Units, or none, of others, which are no lengths although the wave says so. Beside a layer of these or those, labels
/// that are not known are volts.
const OTHERS: [(&str, Option<&str>); 7] = [
    ("Phase", Some("deg")),
    ("Current", Some("A")),
    ("Frequency", Some("Hz")),
    ("Dissipation", Some("W")),
    ("Capacitance", Some("F")),
    ("Count", None),
    ("QFactor", None),
];
const VOLT: &str = "V";

/// What may stand before these names.
const PREFIXES: [&str; 2] = ["DAC", "Nap"];

/// Whether these are the headers of a wave: their sum in whole numbers of 16 bits is zero.
pub(super) fn looks_like(file: &[u8]) -> bool {
    VERSIONS.into_iter().any(|(version, length)| {
        (file.starts_with(&[version, 0]) || file.starts_with(&[0, version]))
            && file.get(..length).is_some_and(|headers| checksum(headers, order(file)) == 0)
    })
}

fn order(file: &[u8]) -> Order {
    if file.first() == Some(&0) { Order::Big } else { Order::Little }
}

fn checksum(headers: &[u8], order: Order) -> u16 {
    let numbers = headers.chunks_exact(2).filter_map(|pair| pair.try_into().ok());
    let number = |pair| match order {
        Order::Little => u16::from_le_bytes(pair),
        Order::Big => u16::from_be_bytes(pair),
    };
    numbers.map(number).fold(0, u16::wrapping_add)
}

/// What the name of a layer tells of its unit; `None` if it is not known.
enum Named {
    OfWave,
    Other(Option<&'static str>),
}

impl Named {
    fn of(name: &str) -> Option<Self> {
        let bare = |name, prefix: &&str| str::strip_prefix(name, *prefix).unwrap_or(name);
        let name = PREFIXES.iter().fold(name, bare);
        let is_of_wave = LENGTHS_OF_WAVE.iter().any(|begin| name.starts_with(begin));
        let other = || OTHERS.iter().find(|(begin, _)| name.starts_with(begin));
        if is_of_wave { Some(Self::OfWave) } else { other().map(|(_, unit)| Self::Other(*unit)) }
    }
}

/// Units of the layers of a wave.
fn units(names: &[String], of_wave: Option<&String>) -> Vec<Option<String>> {
    let known: Vec<_> = names.iter().map(|name| Named::of(name)).collect();
    let is_known = known.iter().any(Option::is_some);
    let unit = |(name, known): (&String, _)| match known {
        Some(Named::Other(unit)) => unit.map(str::to_string),
        None if is_known && !name.is_empty() => Some(VOLT.to_string()),
        Some(Named::OfWave) | None => of_wave.cloned(),
    };
    names.iter().zip(known).map(unit).collect()
}

pub(super) fn parse(file: &[u8]) -> Parsed {
    let order = order(file);
    let at = |place: usize| Ok::<_, Fault>(Bytes::from(file, place)?.ordered(order));
    let version = at(0)?.u16()?;
    ensure!(
        version == 5,
        at(0),
        "it is a wave of version {version}, which has one dimension; maps are those of version 5"
    );
    let mut numbers = at(SHAPE)?;
    let (nx, ny) = (numbers.u32()?, numbers.u32()?);
    let (layers, more) = (numbers.u32()?.max(1), numbers.u32()?);
    ensure!(ny > 0, at(SHAPE), "it has one dimension: a profile is no surface");
    ensure!(more == 0, at(SHAPE), "it has four dimensions, but two or three were expected");
    ensure!(layers <= MOST, at(SHAPE + 8), "it has {layers} layers, more than {MOST}");
    let (nx, ny) = shape(nx, ny)?;
    let kind = at(TYPE)?.u16()?;
    let number = match kind {
        2 => Number::F32,
        4 => Number::F64,
        8 => Number::I8,
        16 => Number::I16,
        32 => Number::I32,
        72 => Number::U8,
        80 => Number::U16,
        96 => Number::U32,
        _ => bail!(at(TYPE), "its numbers have the type {kind}, but real numbers were expected"),
    };
    let mut steps = at(STEPS)?;
    let cell = (steps.f64()?.abs(), steps.f64()?.abs());
    let text =
        |place: usize, length: usize| Ok::<_, Fault>(text_before_zero(at(place)?.take(length)?));
    let mut data = at(HEADERS)?;
    let layer = (nx * ny).saturating_mul(number.size());
    let all = data.elements(layers as usize, layer)?;
    // Behind the numbers: a formula, a note, long units of the numbers and of four dimensions, labels of as many.
    let mut lengths = at(LENGTHS)?;
    let mut behind = HEADERS.saturating_add(all.len());
    let mut part = || {
        let (place, length) = (behind, lengths.u32()? as usize);
        behind = behind.saturating_add(length);
        Ok::<_, Fault>((place, length))
    };
    let (_formula, _note) = (part()?, part()?);
    let mut unit = |short: usize| {
        let (place, length) = part()?;
        ensure!(length <= LABEL, at(place), "a unit has {length} bytes, more than {LABEL}");
        let unit = if length > 0 { text(place, length) } else { text(short, UNIT) }?;
        Ok::<_, Fault>(Some(unit).filter(|unit| !unit.is_empty()))
    };
    let (height_unit, x, y) = (unit(UNITS)?, unit(UNITS + UNIT)?, unit(UNITS + 2 * UNIT)?);
    ensure!(x == y, at(UNITS), "x is in {x:?}, but y in {y:?}");
    for _ in 0..4 {
        part()?;
    }
    let (labels, length_of_labels) = part()?;
    let has_labels = length_of_labels >= LABEL.saturating_mul(1 + layers as usize);
    let whole = text(NAME, LABEL)?;
    let name = |k: usize| match layers {
        // The first label is that of the dimension.
        _ if has_labels => text(labels.saturating_add((1 + k) * LABEL), LABEL),
        1 => Ok(whole.clone()),
        _ => Ok(format!("{whole} {}", k + 1)),
    };
    let names = (0..layers as usize).map(name).collect::<Result<Vec<_>, _>>()?;
    let units = units(&names, height_unit.as_ref());
    all.chunks_exact(layer)
        .zip(names.into_iter().zip(units))
        .map(|(bytes, (name, height_unit))| {
            let channel = Channel {
                name,
                height_unit,
                lateral_unit: x.clone(),
                ..Channel::in_metres(
                    (nx, ny),
                    number.decode_ordered(bytes, order, |z| z)?,
                    Some(cell),
                )
            };
            Ok(channel.turned())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_have_units_of_their_own() {
        let metre = "m".to_string();
        let found = |names: &[&str]| {
            let names: Vec<_> = names.iter().map(ToString::to_string).collect();
            units(&names, Some(&metre))
                .into_iter()
                .map(Option::unwrap_or_default)
                .collect::<Vec<_>>()
        };
        let of_microscope = [
            ("HeightTrace", "m"),
            ("NapZSensorRetrace", "m"),
            ("DACDeflection", "m"),
            ("Amplitude", "m"),
            ("NapPhaseTrace", "deg"),
            ("CapacitanceTrace", "F"),
            ("CountTrace", ""),
            ("QFactorTrace", ""),
            ("UserIn0Trace", "V"),
            ("InputTrace", "V"),
        ];
        let (names, wanted): (Vec<_>, Vec<_>) = of_microscope.into_iter().unzip();
        assert_eq!(found(&names), wanted);
        // What is called so by nobody but the user is what the wave says.
        assert_eq!(found(&["Surface00", "before"]), ["m", "m"]);
    }
}
