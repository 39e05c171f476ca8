//! Text of a Wyko interferometer: heights in waves of light, one line for each place along x, from below (as in
//! Gwyddion's `opdfile.c`).
//!
//! A line of names ends with the type, the length in bytes and the value of a block. Pixels are in mm, the wavelength
//! in nm.

use std::collections::HashMap;

use super::table::Table;
use crate::io::bytes::shape;
use crate::io::fault::Fault;
use crate::io::lines::Lines;
use crate::io::number::{parsed, positive};
use crate::io::raw::{Channel, Parsed};

pub(super) const BEGINS: &[u8] = b"Wyko ASCII Data File";

pub(super) fn parse(mut lines: Lines) -> Parsed {
    let mut blocks: HashMap<String, String> = HashMap::new();
    // The second of three flags: heights are in nm.
    let first = lines.next().map(|line| line.text()).unwrap_or_default();
    let is_in_nm = first.split_whitespace().rev().nth(1) == Some("1");
    loop {
        let line = lines.next().ok_or_else(|| fault!("there is no line RAW_DATA in it"))?;
        let text = line.text();
        let mut words = text.split_whitespace();
        let name = match text.split_once('\t') {
            Some((name, _)) => name.trim(),
            None => words.next().unwrap_or_default(),
        };
        if name.eq_ignore_ascii_case("RAW_DATA") {
            break;
        }
        if let Some(value) = text.split_whitespace().last() {
            blocks.insert(name.to_lowercase(), value.to_string());
        }
    }
    let value = |name: &str| blocks.get(&name.to_lowercase());
    let count = |name: &str| -> Result<u64, Fault> {
        let value = value(name).ok_or_else(|| fault!("there is no line '{name}' in it"))?;
        parsed(name, value, None)
    };
    let number = |name: &str| {
        let number = value(name).map(|value| positive(name, parsed(name, value, None)?, None));
        number.transpose()
    };
    let (nx, ny) = shape(count("X Size")?, count("Y Size")?)?;
    let table = Table::of_lines(lines, nx)?;
    let found = (table.rows(), table.columns);
    ensure!(
        found == (nx, ny),
        "{nx} lines of {ny} heights were expected, but there are {} of {}",
        found.0,
        found.1
    );
    // Line ix holds the nodes (ix, ·).
    let mut values = crate::io::bytes::reserved(nx * ny)?;
    for iy in 0..ny {
        values.extend(table.values.iter().skip(iy).step_by(ny).copied());
    }
    let wave = number("Wavelength")?.zip(number("Mult")?).map(|(wave, mult)| wave / mult);
    let unit = if is_in_nm { Some(1.0) } else { wave };
    let pixel = number("Pixel_size")?;
    let aspect = number("Aspect")?.unwrap_or(1.0);
    let of_waves = unit.filter(|_| !is_in_nm).map(|unit| format!(" of {unit} nm"));
    let heights =
        if is_in_nm { "nm".to_string() } else { format!("waves{}", of_waves.unwrap_or_default()) };
    let channel = Channel {
        name: value("Title").cloned().unwrap_or_default(),
        height_unit: Some(if unit.is_some() { "nm" } else { "waves" }.to_string()),
        factor: unit.unwrap_or(1.0),
        lateral_unit: Some("mm".to_string()),
        understood: format!(
            "Wyko's text: {nx} lines along x of {ny} heights along y, in {heights}"
        ),
        ..Channel::in_metres((nx, ny), values, pixel.map(|pixel| (pixel, pixel * aspect)))
    };
    Ok(vec![channel.turned()])
}
