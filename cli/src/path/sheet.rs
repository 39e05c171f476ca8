//! Four panels in one file, with a title: the manner of `loading_curve.svg`.

use std::path::{Path, PathBuf};

use asperity_cli::chart_format::{self, ChartFormat};
use asperity_cli::outcome::Failure;
use asperity_cli::panel::{Area, Drawn, Panel, anchor};
use asperity_cli::picture;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// Width and height of the picture.
const SIZE: (i32, i32) = (1240, 980);

/// Drawing units to a pixel: plotters rounds to whole ones.
fn fine() -> i32 {
    if is_of_pixels() { picture::FINE } else { 8 }
}

fn is_of_pixels() -> bool {
    chart_format::chosen() == Some(ChartFormat::Png)
}

/// Writes what is drawn, as SVG unless another format was chosen.
pub(super) fn write(
    name: &Path,
    svg: impl for<'a> FnOnce(&Area<SVGBackend<'a>>) -> Drawn<SVGBackend<'a>>,
    png: impl for<'a> FnOnce(&Area<BitMapBackend<'a>>) -> Drawn<BitMapBackend<'a>>,
) -> Result<PathBuf, Failure> {
    match is_of_pixels() {
        true => picture::draw_fine(&name.with_extension("png"), SIZE, png),
        false => picture::draw_svg(name, SIZE, fine(), svg),
    }
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
    panel(0).write(area, text, (fine() * SIZE.0 / 2, fine() * y), 22 * fine(), pos)
}

/// The panel at a place from 0 to 3, row by row.
pub(super) fn panel(place: i32) -> Panel {
    Panel {
        left: fine() * (120 + (place % 2) * 620),
        top: fine() * (76 + (place / 2) * 460),
        width: fine() * 470,
        height: fine() * 350,
        font: fine() * 17,
        stroke: fine() as u32,
        text_rise: if is_of_pixels() { 0.2 } else { 0.0 },
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
        let x = panel.left + 18 * fine();
        let y = panel.top + (24 + 26 * line) * fine();
        let stroke = colour.stroke_width(3 * fine() as u32);
        area.draw(&PathElement::new(vec![(x, y), (x + 34 * fine(), y)], stroke))?;
        let pos = anchor(HPos::Left, VPos::Center);
        panel.write(area, name, (x + 44 * fine(), y), panel.font, pos)?;
    }
    Ok(())
}
