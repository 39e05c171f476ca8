//! A framed panel with two axes, on any plotters backend.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, FontTransform, register_font as register};

use crate::axis::Axis;
use crate::outcome::Failure;

/// Fonts for viewers of the SVG; all metrics are those of the first one, which is embedded.
const FONT: &str = "DejaVu Sans, Verdana, sans-serif";
/// Colour of text and frames.
const INK: RGBColor = RGBColor(34, 34, 34);
const GRID: RGBColor = RGBColor(226, 226, 226);

/// A drawing area in pixels.
pub type Area<DB> = DrawingArea<DB, Shift>;
/// The outcome of drawing.
pub type Drawn<DB> = Result<(), DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

/// Makes the embedded font known, so that no font need be installed.
pub fn register_font() -> Result<(), Failure> {
    register(FONT, FontStyle::Normal, dejavu::sans::regular())
        .map_err(|_| Failure::request("the embedded font is damaged"))
}

/// Where a text is anchored.
pub fn anchor(horizontal: HPos, vertical: VPos) -> Pos {
    Pos::new(horizontal, vertical)
}

/// A rectangle of pixels with an axis along its lower and its left edge.
pub struct Panel {
    /// Its left edge.
    pub left: i32,
    /// Its upper edge.
    pub top: i32,
    /// Along x.
    pub width: i32,
    /// Along y.
    pub height: i32,
    /// Size of the font of tick labels.
    pub font: i32,
    /// Width of the lines of the frame; curves are twice as wide.
    pub stroke: u32,
    /// How far above a point, in fonts, the backend puts a text that is to be centred there.
    pub text_rise: f64,
}

impl Panel {
    /// Writes a text.
    pub fn write<DB: DrawingBackend>(
        &self,
        area: &Area<DB>,
        text: &str,
        at: (i32, i32),
        size: i32,
        pos: Pos,
    ) -> Drawn<DB> {
        let style = TextStyle::from((FONT, size).into_font()).color(&INK).pos(pos);
        let rise = match pos.v_pos {
            VPos::Center => (self.text_rise * f64::from(size)).round() as i32,
            _ => 0,
        };
        area.draw(&Text::new(text.to_string(), (at.0, at.1 + rise), style))
    }

    /// How many labels find room along the lower and along the left edge.
    fn room(&self) -> [usize; 2] {
        [self.width / (4 * self.font), self.height / (2 * self.font)]
            .map(|labels| labels.clamp(1, 6) as usize)
    }

    /// Length of the line of a tick.
    fn tick(&self, labelled: bool) -> i32 {
        if labelled { self.font * 2 / 5 } else { self.font / 4 }
    }

    /// The pixel at a place from 0 to 1 along both axes, with y upwards.
    fn pixel(&self, x: f64, y: f64) -> (f64, f64) {
        (
            f64::from(self.left) + x * f64::from(self.width),
            f64::from(self.top + self.height) - y * f64::from(self.height),
        )
    }

    /// Ruled lines across the panel at the ticks.
    pub fn rule<DB: DrawingBackend>(&self, area: &Area<DB>, x: &Axis, y: &Axis) -> Drawn<DB> {
        self.rule_upright(area, x)?;
        let ticks = y.ticks(self.room()[1]).into_iter();
        for tick in ticks.filter(|tick| tick.label.is_some()) {
            self.line(area, [(0.0, tick.place), (1.0, tick.place)])?;
        }
        Ok(())
    }

    /// Those at the ticks of the axis along the lower edge.
    pub fn rule_upright<DB: DrawingBackend>(&self, area: &Area<DB>, x: &Axis) -> Drawn<DB> {
        let ticks = x.ticks(self.room()[0]).into_iter();
        for tick in ticks.filter(|tick| tick.label.is_some()) {
            self.line(area, [(tick.place, 0.0), (tick.place, 1.0)])?;
        }
        Ok(())
    }

    fn line<DB: DrawingBackend>(&self, area: &Area<DB>, ends: [(f64, f64); 2]) -> Drawn<DB> {
        let ends = ends.map(|(x, y)| rounded(self.pixel(x, y)));
        area.draw(&PathElement::new(ends.to_vec(), GRID.stroke_width(self.stroke)))
    }

    /// Frame, ticks and labels of both axes.
    pub fn frame<DB: DrawingBackend>(&self, area: &Area<DB>, x: &Axis, y: &Axis) -> Drawn<DB> {
        self.border(area)?;
        self.frame_below(area, x)?;
        self.frame_left(area, y)
    }

    /// Ticks and label of an axis along the lower edge.
    pub fn frame_below<DB: DrawingBackend>(&self, area: &Area<DB>, x: &Axis) -> Drawn<DB> {
        let ink = INK.stroke_width(self.stroke);
        let bottom = self.top + self.height;
        for tick in x.ticks(self.room()[0]) {
            let (at, _) = rounded(self.pixel(tick.place, 0.0));
            let length = self.tick(tick.label.is_some());
            area.draw(&PathElement::new(vec![(at, bottom), (at, bottom - length)], ink))?;
            if let Some(label) = tick.label {
                let pos = anchor(HPos::Center, VPos::Top);
                self.write(area, &label, (at, bottom + self.font / 2), self.font, pos)?;
            }
        }
        self.write(
            area,
            x.label(),
            (self.left + self.width / 2, bottom + self.font * 9 / 4),
            self.font * 9 / 8,
            anchor(HPos::Center, VPos::Top),
        )
    }

    /// Ticks and label of an axis along the left edge.
    pub fn frame_left<DB: DrawingBackend>(&self, area: &Area<DB>, y: &Axis) -> Drawn<DB> {
        let ink = INK.stroke_width(self.stroke);
        for tick in y.ticks(self.room()[1]) {
            let (_, at) = rounded(self.pixel(0.0, tick.place));
            let length = self.tick(tick.label.is_some());
            let line = vec![(self.left, at), (self.left + length, at)];
            area.draw(&PathElement::new(line, ink))?;
            if let Some(label) = tick.label {
                let pos = anchor(HPos::Right, VPos::Center);
                self.write(area, &label, (self.left - self.font / 2, at), self.font, pos)?;
            }
        }
        let at = (self.left - self.beside(y), self.top + self.height / 2);
        upwards(area, y.label(), at, self.font * 9 / 8)
    }

    /// Pixels between the left edge and the label of its axis.
    fn beside(&self, y: &Axis) -> i32 {
        let labels = y.ticks(self.room()[1]).into_iter().filter_map(|tick| tick.label);
        let widest = labels.map(|label| text_width(&label, self.font)).max().unwrap_or(0);
        widest + self.font * 5 / 4
    }

    /// Pixels that an axis along the left edge takes, with its label.
    pub(crate) fn space_left(&self, y: &Axis) -> i32 {
        self.beside(y) + self.font * 3 / 2
    }

    /// All shades as a bar, with an axis along its right edge.
    pub fn colour_bar<DB: DrawingBackend>(
        &self,
        area: &Area<DB>,
        y: &Axis,
        shade: impl Fn(f64) -> RGBColor,
    ) -> Drawn<DB> {
        for row in 0..self.height {
            let share = 1.0 - (f64::from(row) + 0.5) / f64::from(self.height);
            let top = self.top + row;
            area.draw(&Rectangle::new(
                [(self.left, top), (self.left + self.width, top + 1)],
                shade(share).filled(),
            ))?;
        }
        self.frame_right(area, y)
    }

    /// Frame with one axis, upwards along its right edge.
    fn frame_right<DB: DrawingBackend>(&self, area: &Area<DB>, y: &Axis) -> Drawn<DB> {
        self.border(area)?;
        let right = self.left + self.width;
        let mut widest = 0;
        for tick in y.ticks(self.room()[1]) {
            let (_, at) = rounded(self.pixel(0.0, tick.place));
            let line = vec![(right, at), (right + self.tick(true), at)];
            area.draw(&PathElement::new(line, INK.stroke_width(self.stroke)))?;
            if let Some(label) = tick.label {
                let pos = anchor(HPos::Left, VPos::Center);
                self.write(area, &label, (right + self.font * 3 / 4, at), self.font, pos)?;
                widest = widest.max(text_width(&label, self.font));
            }
        }
        let size = self.font * 9 / 8;
        let at = (right + self.font * 3 / 4 + widest + size * 7 / 4, self.top + self.height / 2);
        upwards(area, y.label(), at, size)
    }

    /// The rectangle alone.
    pub fn border<DB: DrawingBackend>(&self, area: &Area<DB>) -> Drawn<DB> {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)];
        let corners = corners.map(|(x, y)| rounded(self.pixel(x, y)));
        let ink = INK.stroke_width(self.stroke);
        area.draw(&PathElement::new(corners.to_vec(), ink))
    }

    /// A curve through points in SI units; stretches that would not show are left out, and so are
    /// points that have no place on the axes.
    pub fn curve<DB: DrawingBackend>(
        &self,
        area: &Area<DB>,
        axes: (&Axis, &Axis),
        points: impl Iterator<Item = (f64, f64)>,
        colour: RGBColor,
    ) -> Drawn<DB> {
        area.draw(&PathElement::new(self.trace(axes, points), colour.stroke_width(2 * self.stroke)))
    }

    /// The pixels of [`Self::curve`].
    pub(crate) fn trace(
        &self,
        (x, y): (&Axis, &Axis),
        points: impl Iterator<Item = (f64, f64)>,
    ) -> Vec<(i32, i32)> {
        // Half the width of the line: nearer points do not show.
        let apart = f64::from(self.stroke);
        let mut kept: Vec<(f64, f64)> = Vec::new();
        let mut last = None;
        let places = points.filter_map(|(a, b)| Some((x.place(a)?, y.place(b)?)));
        let inside = |place: f64| (-1e-9..=1.0 + 1e-9).contains(&place);
        for place in places.filter(|(a, b)| inside(*a) && inside(*b)) {
            let point = self.pixel(place.0, place.1);
            let far = kept.last().is_none_or(|previous| {
                (point.0 - previous.0).abs().max((point.1 - previous.1).abs()) >= apart
            });
            if far {
                kept.push(point);
            }
            last = Some(point);
        }
        kept.extend(last);
        kept.into_iter().map(rounded).collect()
    }
}

/// Light for the least share of the greatest pressure, dark for all of it, so that both stand out on
/// white.
pub fn shade(share: f64) -> RGBColor {
    ViridisRGB.get_color(0.93 * (1.0 - share.clamp(0.0, 1.0)))
}

/// A text that runs upwards, centred at a point, with its foot there.
fn upwards<DB: DrawingBackend>(
    area: &Area<DB>,
    text: &str,
    at: (i32, i32),
    size: i32,
) -> Drawn<DB> {
    let style = TextStyle::from((FONT, size).into_font())
        .color(&INK)
        .transform(FontTransform::Rotate270)
        .pos(anchor(HPos::Center, VPos::Bottom));
    area.draw(&Text::new(text.to_string(), at, style))
}

/// Width of a text in pixels.
pub(crate) fn text_width(text: &str, size: i32) -> i32 {
    (FONT, size).into_font().box_size(text).map_or(0, |(width, _)| width as i32)
}

fn rounded((x, y): (f64, f64)) -> (i32, i32) {
    (x.round() as i32, y.round() as i32)
}
