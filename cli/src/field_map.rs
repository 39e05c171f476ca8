//! Maps of fields on a grid, coloured, with axes and a colour bar.

use std::path::{Path, PathBuf};

use asperity::Grid;
use nalgebra::DMatrix;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use crate::axis::Axis;
use crate::contour::contour;
use crate::outcome::Failure;
use crate::panel::{Area, Drawn, Panel, anchor, shade, text_width};
use crate::picture;

/// Pixels along the longer side of the map, about.
const SIDE: f64 = 860.0;
/// Pixels a side of the map has at least.
const SHORTEST: i32 = 60;
const FONT: i32 = 20;
const MARGIN: Margin = Margin { left: 130, right: 200, top: 80, bottom: 100 };
/// Values below the range.
const BELOW: RGBColor = RGBColor(230, 0, 0);
/// Nodes that have yielded, and those that are pulled or have no place on the scale.
const YIELDED: RGBColor = RGBColor(240, 120, 0);
const APART: RGBColor = RGBColor(196, 200, 206);

struct Margin {
    left: i32,
    right: i32,
    top: i32,
    bottom: i32,
}

/// How colours go with values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// In proportion to the value; what lies below the range is red.
    Linear,
    /// In proportion to the value, the greatest bright: for heights.
    Relief,
    /// In proportion to its logarithm, between positive ends; what lies below the range is as light as its end, and 0
    /// grey.
    Logarithmic,
}

/// A field to be drawn.
pub struct FieldMap<'a> {
    /// The grid.
    pub grid: &'a Grid,
    /// Unit of the sides of the grid.
    pub length_unit: &'a str,
    /// The values, NaN where nothing is to be drawn, infinite where nodes have yielded, and −∞ where nodes are pulled
    /// across a gap.
    pub values: &'a DMatrix<f64>,
    /// The least and the greatest value.
    pub range: (f64, f64),
    /// How colours go with values in between.
    pub scale: Scale,
    /// Values at which a line is drawn, between the nodes.
    pub contours: &'a [f64],
    /// What is drawn, and its SI unit.
    pub label: (&'a str, &'a str),
}

impl FieldMap<'_> {
    /// Draws the map with a line above it, and writes the picture.
    pub fn write(&self, name: &Path, caption: &str) -> Result<PathBuf, Failure> {
        self.write_between(name, caption, [("x", 0.0), ("y", 0.0)])
    }

    /// The same of a vertical section, the middle of whose uppermost row is the surface, along an axis that begins at a
    /// value.
    pub fn write_section(
        &self,
        name: &Path,
        caption: &str,
        along: (&str, f64),
    ) -> Result<PathBuf, Failure> {
        let lowest = 0.5 * self.grid.dy() - self.grid.sides().1;
        self.write_between(name, caption, [along, ("height above the surface", lowest)])
    }

    /// The same with names of the axes and the values at which they begin.
    fn write_between(
        &self,
        name: &Path,
        caption: &str,
        axes: [(&str, f64); 2],
    ) -> Result<PathBuf, Failure> {
        let (width, height) = map_size(self.grid);
        let colours = self.colours();
        // Maps of profiles are narrower than what is written above them, or lower than the scale.
        let written = text_width(caption, FONT + 2) + 2 * FONT;
        let inner_width = width.max(written - MARGIN.left - MARGIN.right);
        let inner_height = height.max(scale_height(&colours));
        let size =
            (inner_width + MARGIN.left + MARGIN.right, inner_height + MARGIN.top + MARGIN.bottom);
        let panel = Panel {
            left: MARGIN.left + (inner_width - width) / 2,
            top: MARGIN.top + (inner_height - height) / 2,
            width,
            height,
            font: FONT,
            stroke: 1,
            text_rise: 0.2,
        };
        picture::draw(name, size, |area| {
            // The middle of the picture is further right than that of the map.
            let middle = panel.left + panel.width / 2;
            let middle = middle.max(written / 2).min(size.0 - written / 2);
            let centred = anchor(HPos::Center, VPos::Center);
            panel.write(area, caption, (middle, MARGIN.top / 2), FONT + 2, centred)?;
            self.draw(area, &panel, &colours, axes)?;
            area.present()
        })
    }

    /// The axis of the colours.
    fn colours(&self) -> Axis {
        let ((least, greatest), (label, unit)) = (self.range, self.label);
        match self.scale {
            Scale::Linear | Scale::Relief => Axis::linear(label, unit, least, greatest),
            Scale::Logarithmic => Axis::logarithmic(label, unit, least, greatest),
        }
    }

    fn draw<DB: DrawingBackend>(
        &self,
        area: &Area<DB>,
        panel: &Panel,
        colours: &Axis,
        [x, y]: [(&str, f64); 2],
    ) -> Drawn<DB> {
        for (place, value) in (0_i32..).zip(self.pixels(panel)) {
            let Some(value) = value else { continue };
            let at = (
                panel.left + place % panel.width,
                panel.top + panel.height - 1 - place / panel.width,
            );
            area.draw_pixel(at, &self.colour(colours, value))?;
        }
        let (lx, ly) = self.grid.sides();
        // One unit for both axes, that of the longer side.
        let longer = lx.max(ly);
        let [x, y] = [(x, lx), (y, ly)].map(|((name, from), side)| {
            let excess = (longer - side) / longer;
            let axis = Axis::linear(name, self.length_unit, from, from + longer);
            axis.with_room(0.0, -excess)
        });
        self.lines(area, panel, (&x, &y), colours)?;
        panel.frame(area, &x, &y)?;
        let higher = ((scale_height(colours) - panel.height) / 2).max(0);
        let bar = Panel {
            left: panel.left + panel.width + 28,
            top: panel.top - higher,
            width: 26,
            height: panel.height + 2 * higher,
            ..*panel
        };
        if self.range.1 > self.range.0 {
            self.colour_bar(area, &bar, colours)?;
        }
        self.marks(area, &bar)
    }

    /// The contours, dark on light colours and light on dark ones.
    fn lines<DB: DrawingBackend>(
        &self,
        area: &Area<DB>,
        panel: &Panel,
        axes: (&Axis, &Axis),
        colours: &Axis,
    ) -> Drawn<DB> {
        // Lines run where the colours change evenly.
        let even = |value: f64| match self.scale {
            Scale::Linear | Scale::Relief => value,
            Scale::Logarithmic => value.log10(),
        };
        let field = self.values.map(even);
        let (dx, dy) = (self.grid.dx(), self.grid.dy());
        let position = |(x, y): (f64, f64)| ((x + 0.5) * dx, (y + 0.5) * dy);
        for &level in self.contours {
            let colour = self.ink_on(colours.place(level));
            for piece in contour(&field, even(level)) {
                let points = panel.trace(axes, piece.map(position).into_iter());
                area.draw(&PathElement::new(points, colour.stroke_width(1)))?;
            }
        }
        Ok(())
    }

    /// The greatest value of the nodes that fall on each pixel, row by row from the lower left corner: however
    /// many nodes share a pixel, no contact is lost.
    fn pixels(&self, panel: &Panel) -> Vec<Option<f64>> {
        let (width, height) = (panel.width as usize, panel.height as usize);
        let (nx, ny) = self.grid.shape();
        let span = |node: usize, nodes: usize, pixels: usize| {
            let first = node * pixels / nodes;
            first..((node + 1) * pixels / nodes).max(first + 1)
        };
        let mut pixels = vec![None; width * height];
        for iy in 0..ny {
            for ix in 0..nx {
                let value = self.values[(ix, iy)];
                if value.is_nan() {
                    continue;
                }
                for row in span(iy, ny, height) {
                    for column in span(ix, nx, width) {
                        let pixel: &mut Option<f64> = &mut pixels[column + width * row];
                        *pixel = Some(pixel.map_or(value, |other| other.max(value)));
                    }
                }
            }
        }
        pixels
    }

    fn colour_bar<DB: DrawingBackend>(
        &self,
        area: &Area<DB>,
        bar: &Panel,
        colours: &Axis,
    ) -> Drawn<DB> {
        bar.colour_bar(area, colours, |share| self.shade(share))?;
        let across = Axis::plain("", 0.0, 1.0);
        for &level in self.contours {
            let ends = [(0.0, level), (1.0, level)].into_iter();
            bar.curve(area, (&across, colours), ends, self.ink_on(colours.place(level)))?;
        }
        Ok(())
    }

    /// Beside the ends of the bar, what has no place on it.
    fn marks<DB: DrawingBackend>(&self, area: &Area<DB>, bar: &Panel) -> Drawn<DB> {
        let has = |mark: f64| self.values.iter().any(|value| *value == mark);
        let marks: [(&str, RGBColor, bool); 2] = [
            ("below 0", BELOW, self.values.iter().any(|value| self.is_below(*value))),
            ("yielded", YIELDED, has(f64::INFINITY)),
        ];
        let top = bar.top - FONT;
        let marks = marks.into_iter().map(|mark| (mark, top));
        let apart = match self.scale {
            Scale::Logarithmic => ("0", APART, has(0.0)),
            Scale::Linear | Scale::Relief => ("pulled", APART, has(f64::NEG_INFINITY)),
        };
        let below = (apart, bar.top + bar.height + 2 * FONT);
        for ((text, colour, _), y) in marks.chain([below]).filter(|((.., is_there), _)| *is_there) {
            let at = (bar.left + bar.width, y);
            let pos = anchor(HPos::Right, VPos::Center);
            area.draw(&Rectangle::new(
                [(at.0 + 8, at.1 - 8), (at.0 + 24, at.1 + 8)],
                colour.filled(),
            ))?;
            bar.write(area, text, at, FONT, pos)?;
        }
        Ok(())
    }

    fn is_below(&self, value: f64) -> bool {
        let (least, greatest) = self.range;
        let is_number = value.is_finite();
        self.scale == Scale::Linear && is_number && value < least - 1e-9 * (greatest - least).abs()
    }

    fn colour(&self, colours: &Axis, value: f64) -> RGBColor {
        let (least, greatest) = self.range;
        if self.is_below(value) {
            return BELOW;
        }
        if value == f64::INFINITY {
            return YIELDED;
        }
        if value == f64::NEG_INFINITY || (value == 0.0 && self.scale == Scale::Logarithmic) {
            return APART;
        }
        match colours.place(value) {
            Some(share) if greatest > least => self.shade(share),
            _ => self.shade(0.0),
        }
    }

    /// A line that stands out on the colour at this place of the scale.
    fn ink_on(&self, place: Option<f64>) -> RGBColor {
        let is_dark = place.is_some_and(|place| (place > 0.5) != (self.scale == Scale::Relief));
        if is_dark { WHITE } else { BLACK }
    }

    fn shade(&self, share: f64) -> RGBColor {
        match self.scale {
            Scale::Relief => shade(1.0 - share),
            Scale::Linear | Scale::Logarithmic => shade(share),
        }
    }
}

/// Pixels that a scale has at least: as many as its label, which runs upwards.
fn scale_height(colours: &Axis) -> i32 {
    text_width(colours.label(), FONT * 9 / 8)
}

/// Pixels of the map: whole ones for each node if there are enough, in the proportions of the
/// nominal area.
fn map_size(grid: &Grid) -> (i32, i32) {
    let (lx, ly) = grid.sides();
    let pixels = |side: f64, nodes: usize| {
        let exact = SIDE * side / lx.max(ly);
        let nodes = nodes as f64;
        let whole = (exact / nodes).round().max(1.0) * nodes;
        let pixels = if whole < 1.2 * SIDE && nodes <= exact { whole } else { exact };
        (pixels.round() as i32).max(SHORTEST)
    };
    (pixels(lx, grid.nx()), pixels(ly, grid.ny()))
}
