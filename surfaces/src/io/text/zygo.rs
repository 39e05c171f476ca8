//! Text of a Zygo interferometer: a list of points in pixels, with heights in µm.
//!
//! Fourteen lines of a header end with `#`. The fourth gives the first pixel and the numbers of pixels, the eighth the
//! size of a pixel in metres, 0 if it is not known.

use super::names::Columns;
use super::points;
use super::table::Table;
use crate::io::bytes::shape;
use crate::io::fault::Fault;
use crate::io::lines::Lines;
use crate::io::number::parsed;
use crate::io::raw::{Channel, Parsed};

pub(super) const BEGINS: &[u8] = b"Zygo XYZ Data File";

/// The other text that MetroPro exports.
pub(super) const NOT_READ: &[u8] = b"Zygo ASCII Data File";

/// What stands for a missing height.
const MISSING: &str = "No Data";

pub(super) fn parse(lines: Lines) -> Parsed {
    let mut header = Vec::new();
    let mut points = Vec::new();
    let mut ends = 0;
    for line in lines {
        let text = line.text();
        let text = text.trim();
        match (text, ends) {
            ("#", _) => ends += 1,
            (_, 0) => header.push(text.to_string()),
            ("", _) => {}
            (_, 1) => {
                let (place, z) = match text.strip_suffix(MISSING) {
                    Some(place) => (place, Some(f64::NAN)),
                    None => (text, None),
                };
                let numbers =
                    place.split_whitespace().map(|word| parsed("a point", word, line.offset));
                let numbers: Vec<f64> = numbers.chain(z.map(Ok)).collect::<Result<_, Fault>>()?;
                ensure!(
                    numbers.len() == 3,
                    at(line.offset),
                    "line {} has {} numbers, but x, y and a height were expected",
                    line.number,
                    numbers.len()
                );
                points.extend(numbers);
            }
            _ => bail!(
                at(line.offset),
                "line {} begins another map: a text has to hold one only",
                line.number
            ),
        }
    }
    let number = |line: usize, word: usize| -> Result<f64, Fault> {
        let text = header.get(line - 1).and_then(|line| line.split_whitespace().nth(word));
        parsed(&format!("number {} of line {line}", word + 1), text.unwrap_or_default(), None)
    };
    let stated = shape(number(4, 2)? as u64, number(4, 3)? as u64)?;
    let pixel = number(8, 6)?;
    let table = Table::of_points(points);
    let found = points::map(&Columns::behind(0, "x and y in pixels"), &table)?.channel()?;
    ensure!(
        found.shape == stated,
        "the header says {} x {} pixels, but the points make {} x {}",
        stated.0,
        stated.1,
        found.shape.0,
        found.shape.1
    );
    Ok(vec![Channel {
        height_unit: Some("um".to_string()),
        lateral_unit: Some("m".to_string()),
        cell: Some((pixel, pixel)).filter(|_| pixel > 0.0),
        understood: format!("Zygo's list: {}, heights in µm", found.understood),
        ..found
    }])
}
