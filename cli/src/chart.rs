//! Charts: panels with curves and legends, side by side in one file.

use std::path::{Path, PathBuf};

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use crate::axis::Axis;
use crate::chart_format::{self, ChartFormat};
use crate::outcome::Failure;
use crate::panel::{Area, Drawn, Panel, anchor};
use crate::picture::{FINE, draw_fine, draw_svg};

/// Blue.
pub const BLUE: RGBColor = RGBColor(0, 90, 160);
/// Orange.
pub const ORANGE: RGBColor = RGBColor(213, 94, 0);
/// Green.
pub const GREEN: RGBColor = RGBColor(0, 130, 95);
/// Purple.
pub const PURPLE: RGBColor = RGBColor(150, 70, 140);
/// Grey.
pub const GREY: RGBColor = RGBColor(110, 110, 110);
/// Black.
pub const BLACK: RGBColor = RGBColor(0, 0, 0);

/// Width and height of a chart in the picture.
const SIZE: (i32, i32) = (560, 440);
const FONT: i32 = 15;
/// Where the panel is in a chart: left, top, right, bottom margins.
const MARGINS: (i32, i32, i32, i32) = (88, 46, 26, 64);

/// Colour of a surface by its place in the study.
pub fn colour(place: usize) -> RGBColor {
    [BLUE, ORANGE, GREEN][place % 3]
}

/// Room that an axis upwards needs above the curves, so that they do not run through so many names in a corner there.
pub fn head_room(names: usize) -> f64 {
    0.05 + 0.1 * names as f64
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// A line through the points.
    Line,
    /// A dashed line through the points.
    Dashed,
    /// A dot at each point.
    Dots,
}

/// Points that belong together.
#[derive(Debug, Clone)]
pub struct Series {
    /// In the legend, unless it is empty.
    pub name: String,
    /// Of line or dots.
    pub colour: RGBColor,
    /// Line or dots.
    pub style: Style,
    /// In SI units, or as the axes have them.
    pub points: Vec<(f64, f64)>,
}

impl Series {
    /// A series for a chart.
    pub fn new(
        name: impl Into<String>,
        colour: RGBColor,
        style: Style,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        Self { name: name.into(), colour, style, points: points.into_iter().collect() }
    }

    /// Draws the points into a panel; a single one as a dot.
    pub fn draw<DB: DrawingBackend>(
        &self,
        area: &Area<DB>,
        panel: &Panel,
        axes: (&Axis, &Axis),
    ) -> Drawn<DB> {
        sample(area, panel, panel.trace(axes, self.points.iter().copied()), self)
    }
}

/// Where the legend is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Corner {
    /// Upper left.
    TopLeft,
    /// Upper right.
    TopRight,
    /// Lower left.
    BottomLeft,
    /// Lower right.
    BottomRight,
}

/// One panel with its title, axes and series.
pub struct Chart {
    /// Above the panel.
    pub title: String,
    /// Along the lower edge.
    pub x: Axis,
    /// Along the left edge.
    pub y: Axis,
    /// Drawn in this order.
    pub series: Vec<Series>,
    /// Where the names of the series are.
    pub legend: Corner,
}

/// Draws charts into a file, so many in a row: PNG, unless another format [was chosen](chart_format).
pub fn draw(charts: &[Chart], columns: usize, name: &Path) -> Result<PathBuf, Failure> {
    let rows = charts.len().div_ceil(columns);
    let size = (SIZE.0 * columns.min(charts.len()) as i32, SIZE.1 * rows as i32);
    let format = chart_format::chosen().unwrap_or(ChartFormat::Png);
    let name = &name.with_extension(format.ending());
    match format {
        ChartFormat::Png => draw_fine(name, size, |area| draw_all(charts, columns, area, RISE)),
        ChartFormat::Svg => draw_svg(name, size, FINE, |area| {
            area.fill(&WHITE)?;
            draw_all(charts, columns, area, 0.0)
        }),
    }
}

/// How far above a point pictures of pixels put a text that is to be centred there, in fonts; SVG centres it.
const RISE: f64 = 0.2;

fn draw_all<DB: DrawingBackend>(
    charts: &[Chart],
    columns: usize,
    area: &Area<DB>,
    text_rise: f64,
) -> Drawn<DB> {
    for (place, chart) in charts.iter().enumerate() {
        let at = (SIZE.0 * (place % columns) as i32, SIZE.1 * (place / columns) as i32);
        chart.draw(area, at, text_rise)?;
    }
    Ok(())
}

impl Chart {
    fn draw<DB: DrawingBackend>(
        &self,
        area: &Area<DB>,
        at: (i32, i32),
        text_rise: f64,
    ) -> Drawn<DB> {
        let (left, top, right, bottom) = MARGINS;
        let mut panel = Panel {
            left: FINE * (at.0 + left),
            top: FINE * (at.1 + top),
            width: FINE * (SIZE.0 - left - right),
            height: FINE * (SIZE.1 - top - bottom),
            font: FINE * FONT,
            stroke: FINE as u32,
            text_rise,
        };
        // Long numbers at the axis need more room.
        let more = (panel.space_left(&self.y) - FINE * left).max(0);
        panel.left += more;
        panel.width -= more;
        let middle = (panel.left + panel.width / 2, FINE * (at.1 + top / 2));
        let centred = anchor(HPos::Center, VPos::Center);
        panel.write(area, &self.title, middle, FINE * (FONT + 1), centred)?;
        panel.rule(area, &self.x, &self.y)?;
        for series in &self.series {
            series.draw(area, &panel, (&self.x, &self.y))?;
        }
        panel.frame(area, &self.x, &self.y)?;
        self.legend(area, &panel)
    }

    /// Names in a corner, on white so that curves do not run through them.
    fn legend<DB: DrawingBackend>(&self, area: &Area<DB>, panel: &Panel) -> Drawn<DB> {
        let named: Vec<&Series> = self.series.iter().filter(|s| !s.name.is_empty()).collect();
        if named.is_empty() {
            return Ok(());
        }
        let size = FINE * (FONT - 2);
        let line = FINE * (FONT + 4);
        let widest = named.iter().map(|s| s.name.chars().count()).max().unwrap_or(0) as i32;
        let width = FINE * 44 + widest * size * 11 / 20;
        let height = line * named.len() as i32 + FINE * 6;
        let inset = FINE * 8;
        let x = match self.legend {
            Corner::TopLeft | Corner::BottomLeft => panel.left + inset,
            Corner::TopRight | Corner::BottomRight => panel.left + panel.width - width - inset,
        };
        let y = match self.legend {
            Corner::TopLeft | Corner::TopRight => panel.top + inset,
            Corner::BottomLeft | Corner::BottomRight => panel.top + panel.height - height - inset,
        };
        area.draw(&Rectangle::new([(x, y), (x + width, y + height)], WHITE.mix(0.85).filled()))?;
        for (place, series) in (0_i32..).zip(named) {
            let middle = y + FINE * 3 + line * place + line / 2;
            let (from, to) = (x + FINE * 4, x + FINE * 34);
            let points = match series.style {
                Style::Dots => vec![((from + to) / 2, middle)],
                _ => vec![(from, middle), (to, middle)],
            };
            sample(area, panel, points, series)?;
            let at = (x + FINE * 40, middle);
            let pos = anchor(HPos::Left, VPos::Center);
            panel.write(area, &series.name, at, size, pos)?;
        }
        Ok(())
    }
}

/// Draws pixels in the manner of a series.
fn sample<DB: DrawingBackend>(
    area: &Area<DB>,
    panel: &Panel,
    mut points: Vec<(i32, i32)>,
    series: &Series,
) -> Drawn<DB> {
    let stroke = series.colour.stroke_width(2 * panel.stroke);
    points.dedup();
    // A line without a length would not show.
    match if points.len() > 1 { series.style } else { Style::Dots } {
        Style::Line => draw_line(area, &points, stroke),
        Style::Dashed => dashes(&points).iter().try_for_each(|dash| draw_line(area, dash, stroke)),
        Style::Dots => {
            for point in points {
                area.draw(&Circle::new(point, 3 * panel.stroke, series.colour.filled()))?;
            }
            Ok(())
        }
    }
}

/// Draws a line in pieces that end where it turns back: on such a corner plotters draws a spike without end.
fn draw_line<DB: DrawingBackend>(
    area: &Area<DB>,
    points: &[(i32, i32)],
    stroke: ShapeStyle,
) -> Drawn<DB> {
    let mut first = 0;
    for (k, three) in points.windows(3).enumerate() {
        let way = |from: (i32, i32), to: (i32, i32)| {
            [i64::from(to.0) - i64::from(from.0), i64::from(to.1) - i64::from(from.1)]
        };
        let ([ax, ay], [bx, by]) = (way(three[0], three[1]), way(three[1], three[2]));
        if ax * bx + ay * by < 0 {
            area.draw(&PathElement::new(&points[first..k + 2], stroke))?;
            first = k + 1;
        }
    }
    area.draw(&PathElement::new(&points[first..], stroke))
}

/// Cuts a line into dashes.
fn dashes(points: &[(i32, i32)]) -> Vec<Vec<(i32, i32)>> {
    let (dash, gap) = (f64::from(FINE) * 8.0, f64::from(FINE) * 5.0);
    let mut all = Vec::new();
    let mut current: Vec<(i32, i32)> = points.first().copied().into_iter().collect();
    let mut drawing = true;
    let mut left = dash;
    for pair in points.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let (dx, dy) = (f64::from(to.0 - from.0), f64::from(to.1 - from.1));
        let length = dx.hypot(dy);
        let mut done = 0.0;
        while length - done > left {
            done += left;
            let at = (
                from.0 + (dx * done / length).round() as i32,
                from.1 + (dy * done / length).round() as i32,
            );
            if drawing {
                current.push(at);
                all.push(std::mem::take(&mut current));
            } else {
                current = vec![at];
            }
            drawing = !drawing;
            left = if drawing { dash } else { gap };
        }
        left -= length - done;
        if drawing {
            current.push(to);
        }
    }
    if current.len() > 1 {
        all.push(current);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Needles end at their points, but for the width of the line: nothing is drawn far above or below.
    #[test]
    fn lines_that_turn_back_have_no_spikes() -> Result<(), String> {
        let (width, height) = (120, 150);
        let mut pixels = vec![255; 3 * width * height];
        {
            let size = (width as u32, height as u32);
            let area = BitMapBackend::with_buffer(&mut pixels, size).into_drawing_area();
            let needles = (0..80).map(|k| (20 + k, [60, 90, 62, 88][k as usize % 4]));
            let points: Vec<(i32, i32)> = needles.collect();
            draw_line(&area, &points, BLUE.stroke_width(6)).map_err(|error| error.to_string())?;
            area.present().map_err(|error| error.to_string())?;
        }
        let line = 3 * width;
        let is_blank = |rows: std::ops::Range<usize>| {
            pixels[rows.start * line..rows.end * line].iter().all(|byte| *byte == 255)
        };
        // Half of the width beyond the points, and a pixel.
        assert!(is_blank(0..56) && is_blank(95..150) && !is_blank(60..91));
        Ok(())
    }
}
