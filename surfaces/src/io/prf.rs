//! Profiles as ISO 5436-2 of 2001 lays them out, `.smd`, and the National Physical Laboratory, `.prf`.
//!
//! Sources: the description of both at resource.npl.co.uk/softgauges; the writer of the program Nmm2Profile.
//!
//! Lines of words. Records end with a line `EOR` (`.prf`), or with one that begins with the sign ETX (`.smd`, where a
//! zero ends each word). The first describes the axes, `CX M 4 MM 1 D`: type, number of points, unit, what the numbers
//! are multiplied by, type of the numbers, and in `.smd` the spacing. The second says what else is known, in `.prf` the
//! spacing, `SPACING CX 0.00025`; the third has a height in each line.

use super::bytes::{latin1, reserved, shape};
use super::fault::Fault;
use super::lines::{Line, Lines};
use super::number::{parsed, positive};
use super::profile;
use super::raw::{Channel, Parsed};

/// Lines within which both axes are described, and their bytes.
const HEADER_LINES: usize = 8;
const HEADER_BYTES: usize = 4096;

/// Whether both axes are described at the beginning, and that of a profile.
pub(super) fn looks_like(file: &[u8]) -> bool {
    let begin = file.get(..HEADER_BYTES).unwrap_or(file);
    let lines = || Lines::new(begin, 0).take(HEADER_LINES).map(words);
    let has = |name: &str| lines().any(|words| words.first().is_some_and(|word| word == name));
    has("CX") && has("CZ") && lines().flatten().any(|word| word == "PRF")
}

pub(super) fn parse(file: &[u8]) -> Parsed {
    let (mut x, mut z) = (None, None);
    let mut spacing = None;
    let mut heights = Vec::new();
    let mut record = 1;
    for line in Lines::new(file, 0) {
        let words = words(line);
        if ends_record(line) {
            record += 1;
            if let (3, Some(z)) = (record, &z) {
                // A digit for each height, and what ends its line.
                let left = file.len() - line.offset;
                let Axis { count, .. } = z;
                ensure!(
                    count.saturating_mul(2) <= left + 1,
                    at(line.offset),
                    "{count} heights do not fit into the {left} bytes from here to the end"
                );
                heights = reserved(*count)?;
            }
            continue;
        }
        match (record, words.first().map(String::as_str)) {
            (1, Some("CX")) => x = Some(Axis::read(&words, line)?),
            (1, Some("CZ")) => z = Some(Axis::read(&words, line)?),
            (2, Some("SPACING")) if words.get(1).is_some_and(|axis| axis == "CX") => {
                let step = words.get(2).map_or("", String::as_str);
                spacing = Some((parsed("SPACING", step, line.offset)?, line.offset));
            }
            (3, Some(height)) => {
                let height: f64 = parsed("a height", height, line.offset)?;
                ensure!(
                    words.len() == 1 && z.as_ref().is_some_and(|z| heights.len() < z.count),
                    at(line.offset),
                    "line {} holds more than the heights that the header counts",
                    line.number
                );
                heights.push(height);
            }
            _ => {}
        }
    }
    ensure!(record != 3, at(file.len()), "the file ends within the heights");
    let lacks = |what: &str| fault!("it lacks the description of {what}");
    let (x, z) = (x.ok_or_else(|| lacks("CX"))?, z.ok_or_else(|| lacks("CZ"))?);
    shape(z.count, 1)?;
    let found = heights.len();
    ensure!(
        found == z.count && x.count == z.count,
        at(file.len()),
        "the header counts {} points along CX and {} along CZ, but there are {found} heights",
        x.count,
        z.count
    );
    let (step, at) = spacing
        .or(x.spacing)
        .ok_or_else(|| fault!("it gives no spacing of the points along CX"))?;
    let step = positive("the spacing along CX", step, at)?;
    heights.iter_mut().for_each(|height| *height *= z.factor);
    let note = (x.factor != 1.0).then(|| {
        format!(
            "numbers along CX are to be multiplied by {:e}: the spacing, {step} {}, is taken as it is",
            x.factor, x.unit
        )
    });
    Ok(vec![Channel {
        height_unit: Some(z.unit),
        lateral_unit: Some(x.unit),
        notes: note.into_iter().collect(),
        ..profile::channel(heights, step)
    }])
}

/// What the header says of an axis.
struct Axis {
    count: usize,
    unit: String,
    factor: f64,
    /// The spacing of the points, and where it stands.
    spacing: Option<(f64, usize)>,
}

impl Axis {
    fn read(words: &[String], line: Line) -> Result<Self, Fault> {
        let word = |k: usize| words.get(k).map_or("", String::as_str);
        let (axis, at) = (word(0), line.offset);
        let kind = word(1);
        // Heights are absolute (A), positions incremental (I), of either kind measured (M).
        let expected = if axis == "CX" { "I" } else { "A" };
        ensure!(
            [expected, "M"].contains(&kind),
            at(at),
            "{axis} has the type '{kind}': only profiles at even steps are read, of type {expected} or M"
        );
        let count: f64 = parsed(&format!("the number of points along {axis}"), word(2), at)?;
        ensure!(
            count >= 1.0 && count.fract() == 0.0 && count <= f64::from(u32::MAX),
            at(at),
            "{axis} has {count} points"
        );
        let factor = positive(
            &format!("the factor of {axis}"),
            parsed(&format!("the factor of {axis}"), word(4), at)?,
            at,
        )?;
        let spacing = match words.get(6) {
            Some(step) if axis == "CX" => Some((parsed("the spacing along CX", step, at)?, at)),
            _ => None,
        };
        // Names of units are in capital letters in `.prf`.
        Ok(Self { count: count as usize, unit: word(3).to_lowercase(), factor, spacing })
    }
}

/// Whether a line ends a record.
fn ends_record(line: Line) -> bool {
    line.bytes.starts_with(b"\x03") || line.bytes.trim_ascii() == b"EOR"
}

/// The words of a line, parted by blanks and zeros.
fn words(line: Line) -> Vec<String> {
    let parts = |byte: &u8| *byte == 0 || byte.is_ascii_whitespace();
    line.bytes.split(parts).filter(|word| !word.is_empty()).map(latin1).collect()
}
