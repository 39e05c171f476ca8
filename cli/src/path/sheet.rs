//! Four panels in one SVG file, with a title: the manner of `loading_curve.svg`.

use std::path::{Path, PathBuf};

use asperity_cli::outcome::{self, Failure};
use asperity_cli::panel::{Area, Drawn, Panel, anchor};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// Width and height of the picture.
const SIZE: (i32, i32) = (1240, 980);
/// Drawing units to a pixel: plotters rounds to whole ones.
const FINE: i32 = 8;

/// Writes what `draw` draws.
pub(super) fn write(
    name: &Path,
    draw: impl FnOnce(&DrawingArea<SVGBackend<'_>, plotters::coord::Shift>) -> Result<(), String>,
) -> Result<PathBuf, Failure> {
    let (width, height) = (SIZE.0 * FINE, SIZE.1 * FINE);
    let mut text = String::new();
    let backend = SVGBackend::with_string(&mut text, (width as u32, height as u32));
    draw(&backend.into_drawing_area()).map_err(|error| Failure::writing(name, error))?;
    let fine = format!("width=\"{width}\" height=\"{height}\"");
    let size = format!("width=\"{}\" height=\"{}\"", SIZE.0, SIZE.1);
    outcome::write(name, text.replacen(&fine, &size, 1))
}

/// Writes the title of the picture.
pub(super) fn title<DB: DrawingBackend>(area: &Area<DB>, text: &str) -> Drawn<DB> {
    centred(area, text, 34)
}

/// Writes a text in place of the panels.
pub(super) fn instead<DB: DrawingBackend>(area: &Area<DB>, text: &str) -> Drawn<DB> {
    centred(area, text, SIZE.1 / 2)
}

fn centred<DB: DrawingBackend>(area: &Area<DB>, text: &str, y: i32) -> Drawn<DB> {
    let pos = anchor(HPos::Center, VPos::Center);
    panel(0).write(area, text, (FINE * SIZE.0 / 2, FINE * y), 22 * FINE, pos)
}

/// The panel at a place from 0 to 3, row by row.
pub(super) fn panel(place: i32) -> Panel {
    Panel {
        left: FINE * (120 + (place % 2) * 620),
        top: FINE * (76 + (place / 2) * 460),
        width: FINE * 470,
        height: FINE * 350,
        font: FINE * 17,
        stroke: FINE as u32,
        text_rise: 0.0,
    }
}

/// Names of the curves of a panel, in its upper left corner; those without a name are left out.
pub(super) fn legend<'a, DB: DrawingBackend>(
    area: &Area<DB>,
    panel: &Panel,
    curves: impl IntoIterator<Item = (RGBColor, &'a str)>,
) -> Drawn<DB> {
    let named = curves.into_iter().filter(|(_, name)| !name.is_empty());
    for (line, (colour, name)) in (0_i32..).zip(named) {
        let x = panel.left + 18 * FINE;
        let y = panel.top + (24 + 26 * line) * FINE;
        let stroke = colour.stroke_width(3 * FINE as u32);
        area.draw(&PathElement::new(vec![(x, y), (x + 34 * FINE, y)], stroke))?;
        let pos = anchor(HPos::Left, VPos::Center);
        panel.write(area, name, (x + 44 * FINE, y), panel.font, pos)?;
    }
    Ok(())
}
