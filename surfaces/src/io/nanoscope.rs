//! Bruker's and Veeco's Nanoscope, `.spm`, `.di`, `.000` and so on: the images of a scanning probe microscope.
//!
//! Sources: SurfaceTopography's `DI.py`, Gwyddion's `nanoscope.c`, pySPM's `Bruker.py`; two files of instruments.
//!
//! A header of lines `\key: value` ends with `\*File list end`; sections begin with `\*`. One section for each image
//! says where its integers lie, and their scale: the whole range of integers is so many volts, and a line in another
//! section says how many nanometres a volt is, `\@Sens. Zscan: V 13.2283 nm/V`. The first row of an image is its
//! lowest.

use super::bytes::{Bytes, find, shape, shared};
use super::fault::Fault;
use super::number::{Number, parsed};
use super::raw::{Channel, Parsed};
use super::sections::{Section, Style};

pub(super) const BEGINS: &[&[u8]] = &[b"\\*File list", b"\\*EC File list"];

const END: &[u8] = b"\\*File list end";

const STYLE: Style = Style { begins: b"\\*", ends: b"", mark: "\\", between: ':' };

/// Most images in a file: there are a dozen signals, forwards and backwards.
const MOST: usize = 256;

pub(super) fn parse(file: &[u8]) -> Parsed {
    let end = find(file, END).ok_or_else(|| fault!("the header has no end, '\\*File list end'"))?;
    let header = file.get(..end).unwrap_or_default();
    let sections = Section::all(header, &STYLE);
    // Curves of forces are listed in the same way.
    let is_image = |section: &&Section| {
        section.name.ends_with(b"image list") && find(section.name, b"force").is_none()
    };
    let images: Vec<&Section> = sections.iter().filter(is_image).collect();
    ensure!(images.len() <= MOST, "there are {} images, more than {MOST}", images.len());
    let mut claimed = 0_usize;
    for image in &images {
        claimed = claimed.saturating_add(image.number("Data length")?);
    }
    let length = file.len();
    ensure!(
        claimed <= length,
        "the images are said to take {claimed} bytes, more than the file has, {length}"
    );
    images.into_iter().map(|image| channel(file, image, &sections)).collect()
}

/// One image.
fn channel(file: &[u8], image: &Section, sections: &[Section]) -> Result<Channel, Fault> {
    let (nx, ny) =
        shape(image.number::<u64>("Samps/line")?, image.number::<u64>("Number of lines")?)?;
    let length: usize = image.number("Data length")?;
    // Some versions write four bytes and say that there are two.
    let number = match length.checked_div(nx * ny) {
        Some(2) => Number::I16,
        Some(4) => Number::I32,
        _ => bail!(
            "{nx} x {ny} heights are said to take {length} bytes, but they have two or four each"
        ),
    };
    let mut bytes = Bytes::from(file, image.number("Data offset")?)?;
    let data = bytes.elements(nx * ny, number.size())?;
    let scale = image
        .find(|key| key.starts_with('@') && key.ends_with("Z scale"))
        .map(|text| Scale::parse(&text, sections))
        .transpose()?;
    // Without a scale, as in versions before 4.3, the integers are steps of the converter.
    let steps = (1.0, Some("LSB".to_string()));
    let (factor, unit) = scale
        .map_or(steps, |scale| (scale.range / 2_f64.powi(8 * number.size() as i32), scale.unit));
    let (cell, lateral_unit) = cell(image, sections, (nx, ny))?;
    let name = image.find(|key| key.ends_with("Image Data") || key == "Image data");
    let channel = Channel {
        name: name.as_deref().map(name_of).unwrap_or_default(),
        height_unit: unit,
        lateral_unit,
        notes: unfinished(image, (nx, ny)).into_iter().collect(),
        ..Channel::in_metres((nx, ny), number.decode_all(data, |value| value * factor)?, cell)
    };
    Ok(channel.turned())
}

/// What there is to say of an image that was not scanned to its end.
fn unfinished(image: &Section, (nx, ny): (usize, usize)) -> Option<String> {
    let length = |key: &str| image.get(key)?.parse::<usize>().ok();
    let x = length("Valid data len X").unwrap_or(nx);
    let y = length("Valid data len Y").unwrap_or(ny);
    let is_whole = (x, y) == (nx, ny);
    (!is_whole).then(|| {
        format!("{x} x {y} of the {nx} x {ny} nodes are valid, as the file says; all are read")
    })
}

/// What all integers together are worth.
struct Scale {
    range: f64,
    unit: Option<String>,
}

impl Scale {
    /// Of `V [Sens. Zscan] (0.0029 V/LSB) 192.3 V`, and the line with that sensitivity.
    fn parse(text: &str, sections: &[Section]) -> Result<Self, Fault> {
        let value = text.rsplit(')').next().unwrap_or_default();
        let (range, unit) = number_and_unit(value)?;
        let sensitivity = text
            .split_once('[')
            .and_then(|(_, rest)| rest.split_once(']'))
            .map(|(name, _)| name)
            .filter(|name| !name.is_empty());
        let Some(name) = sensitivity else {
            return Ok(Self { range, unit });
        };
        let key = format!("@{name}");
        let line = sections.iter().find_map(|section| section.get(&key));
        let line =
            line.ok_or_else(|| fault!("there is no line '{key}', which the scale refers to"))?;
        let (factor, per) = number_and_unit(line.trim_start_matches(['V', 'C']))?;
        // `nm/V`, or nothing where nobody has calibrated.
        let unit = per.and_then(|per| match per.split_once('/') {
            Some((of, volt)) => (Some(volt) == unit.as_deref()).then(|| of.to_string()),
            None => Some(per),
        });
        Ok(Self { range: range * factor, unit })
    }
}

/// A number and what is written behind it.
fn number_and_unit(text: &str) -> Result<(f64, Option<String>), Fault> {
    let text = text.trim();
    let (number, unit) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    let number: f64 = parsed("a scale", number, None)?;
    ensure!(number.is_finite(), "a scale is {number}, which is not finite");
    Ok((number, named(unit)))
}

/// A unit, in which `~` is the sign of a millionth.
fn named(unit: &str) -> Option<String> {
    Some(shared(unit.trim()).replace('~', "µ")).filter(|unit| !unit.is_empty())
}

/// What stands in quotes, otherwise what stands in brackets.
fn name_of(text: &str) -> String {
    let quoted = text.split('"').nth(1).filter(|name| !name.is_empty());
    let bracketed = || text.split(['[', ']']).nth(1);
    quoted.or_else(bracketed).unwrap_or(text).to_string()
}

/// A cell in some unit, if both are known.
type Cell = (Option<(f64, f64)>, Option<String>);

/// The size of a pixel: of the sides of the image, otherwise of the scan.
fn cell(image: &Section, sections: &[Section], (nx, ny): (usize, usize)) -> Result<Cell, Fault> {
    let of = |section: &Section| section.get("Scan Size");
    let scans = || sections.iter().filter(|section| section.name.ends_with(b"scan list"));
    let Some(text) = of(image).or_else(|| scans().find_map(of)) else {
        return Ok((None, None));
    };
    let words: Vec<&str> = text.split_whitespace().collect();
    let (x, y, unit) = match *words.as_slice() {
        [x, y, unit] => (x, y, unit),
        [x, unit] => (x, x, unit),
        _ => bail!("the scan size is '{text}', but one or two numbers and a unit were expected"),
    };
    let (x, mut y): (f64, f64) = (parsed("Scan Size", x, None)?, parsed("Scan Size", y, None)?);
    let aspect = image.get("Aspect Ratio").and_then(|aspect| {
        let (a, b) = aspect.split_once(':')?;
        Some(b.trim().parse::<f64>().ok()? / a.trim().parse::<f64>().ok()?)
    });
    if let Some(aspect) = aspect.filter(|aspect| x == y && aspect.is_finite() && *aspect > 0.0) {
        y *= aspect;
    }
    Ok((Some((x / nx as f64, y / ny as f64)), named(unit)))
}
