//! What stands above the numbers of a text: lines like `# Width: 10 µm`, and names of columns.

use crate::io::fault::Fault;
use crate::io::unit::LengthUnit;

/// What the header says.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Header {
    pub(super) title: String,
    /// Side along x, side along y.
    width: Option<Length>,
    height: Option<Length>,
    /// Spacing along both.
    pixel: Option<Length>,
    pub(super) value_unit: Option<String>,
    /// What the numbers have to be multiplied by to be in their unit.
    pub(super) factor: Option<f64>,
    /// Unit of the coordinates of points.
    pub(super) lateral_unit: Option<String>,
    /// Whether columns are called x, y, z.
    pub(super) names_columns: bool,
    /// The number that stands for a missing value.
    pub(super) missing: Option<f64>,
}

/// A number and what is written behind it.
#[derive(Debug, Clone, PartialEq)]
struct Length {
    value: f64,
    unit: Option<String>,
}

// What Gwyddion writes above a matrix, in the languages that it speaks, in small letters.
const TITLE: &str = "channel|kanál|kanal|canal|canale|チャネル|채널|канал";
const WIDTH: &str = "width|šířka|breite|anchura|largeur|larghezza|幅|폭|largura|ширина";
const HEIGHT: &str = "height|výška|höhe|altura|hauteur|altezza|高さ|높이|высота";
const VALUE_UNIT: &str = "value units|jednotky hodnot|einheiten|werteinheiten|unités|unità valore|値の単位|값 단위|\
    unidades de valor|единицы измерения";
/// What another program calls it.
const DATA_UNIT: &str = "data unit";

impl Header {
    /// Takes in a line. Returns whether it says anything that is known.
    pub(super) fn add(&mut self, line: &str) -> bool {
        let line =
            line.trim_start_matches(|c: char| matches!(c, '#' | '%' | '"') || c.is_whitespace());
        let Some((key, value)) = line.split_once(['=', ':', '：']) else {
            return self.add_words(line);
        };
        let key = key.trim().to_lowercase();
        let value = value.trim();
        let is = |names: &str| names.split('|').any(|name| name == key);
        if is(TITLE) {
            self.title = value.to_string();
        } else if is(WIDTH) {
            self.width = Length::parse(value);
        } else if is(HEIGHT) {
            self.height = Length::parse(value);
        } else if is(VALUE_UNIT) || is(DATA_UNIT) {
            self.value_unit = some(value);
        } else if is("lateral units") {
            self.lateral_unit = some(value);
        } else if is("pixel size") {
            self.pixel = Length::parse(value);
        } else if let Some(unit) = key.strip_prefix("height conversion factor (->") {
            self.factor = number(value);
            self.value_unit = some(unit.trim_end_matches(')'));
        } else {
            return self.add_words(line);
        }
        true
    }

    /// Lines without a sign between key and value.
    fn add_words(&mut self, line: &str) -> bool {
        let mut words = line.split_whitespace();
        // The header of a grid of geographers.
        let (Some(key), Some(value), None) = (words.next(), words.next(), words.next()) else {
            return self.add_columns(line);
        };
        match key.to_ascii_lowercase().as_str() {
            "nodata_value" => {
                self.missing = number(value);
                self.missing.is_some()
            }
            "cellsize" => {
                self.pixel = Length::parse(value);
                self.pixel.is_some()
            }
            _ => self.add_columns(line),
        }
    }

    /// Names of columns, perhaps with units: `x y z`, `X [mm]; Y [mm]; Z [µm]`, `x_mm,y_mm,height_nm`.
    fn add_columns(&mut self, line: &str) -> bool {
        let mut units = [const { None }; 3];
        let mut column = None;
        let parts = |c: char| c.is_whitespace() || ";,/_()[]{}<>\"':=".contains(c);
        for word in line.split(parts).filter(|word| !word.is_empty()) {
            let name = word.to_lowercase();
            match (name.as_str(), column) {
                ("x", None) => column = Some(0),
                ("y", Some(0)) => column = Some(1),
                ("z" | "height" | "value", Some(1)) => column = Some(2),
                ("coordinate" | "position" | "axis" | "pos", Some(_)) => {}
                // Further columns may be called anything.
                (_, Some(2)) if word.parse::<LengthUnit>().is_err() => break,
                (_, Some(k)) if word.parse::<LengthUnit>().is_ok() => {
                    if let Some(unit) = units.get_mut(k) {
                        *unit = Some(word.to_string());
                    }
                }
                _ => return false,
            }
        }
        if column != Some(2) {
            return false;
        }
        let [x, y, z] = units;
        self.names_columns = true;
        // Coordinates in two units have none in common.
        self.lateral_unit = x.filter(|x| y.as_ref().is_none_or(|y| y == x));
        self.value_unit = z;
        true
    }

    /// Makes heights in their unit, NaN where they are missing, of the numbers in the file.
    pub(super) fn apply(&self, numbers: &mut [f64]) {
        let factor = self.factor.unwrap_or(1.0);
        for number in numbers {
            *number = if self.missing == Some(*number) { f64::NAN } else { *number * factor };
        }
    }

    /// Whether it gives the sides of a matrix.
    pub(super) fn has_sides(&self) -> bool {
        self.pixel.is_some() || self.width.is_some() && self.height.is_some()
    }

    /// The cell of a matrix, and its unit: that of the side along x.
    pub(super) fn cell(&self, (nx, ny): (usize, usize)) -> Result<Cell, Fault> {
        if let Some(pixel) = &self.pixel {
            return Ok((Some((pixel.value, pixel.value)), pixel.unit.clone()));
        }
        let (Some(width), Some(height)) = (&self.width, &self.height) else {
            return Ok((None, None));
        };
        // Units of the height in one of the width, if they can be compared.
        let ratio = if width.unit == height.unit {
            Some(1.0)
        } else {
            height.metres().zip(width.metres()).map(|(height, width)| height / width)
        };
        let ratio = ratio.ok_or_else(|| {
            let [width, height] =
                [width, height].map(|side| side.unit.as_deref().unwrap_or_default());
            fault!("the header gives the width in '{width}', but the height in '{height}'")
        })?;
        let cell = (width.value / nx as f64, height.value * ratio / ny as f64);
        Ok((Some(cell), width.unit.clone()))
    }
}

/// A cell in some unit, if both are known.
type Cell = (Option<(f64, f64)>, Option<String>);

impl Length {
    /// A number, and the unit behind it.
    fn parse(text: &str) -> Option<Self> {
        let end = text
            .find(|c: char| !(c.is_ascii_digit() || "+-.,eE".contains(c)))
            .unwrap_or(text.len());
        let (value, unit) = text.split_at(end);
        Some(Self { value: number(value)?, unit: some(unit) })
    }

    /// Metres in its unit.
    fn metres(&self) -> Option<f64> {
        Some(self.unit.as_deref()?.parse::<LengthUnit>().ok()?.metres())
    }
}

/// A number with a decimal point or comma.
fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    text.parse().or_else(|_| text.replace(',', ".").parse()).ok()
}

fn some(text: &str) -> Option<String> {
    Some(text.trim().to_string()).filter(|text| !text.is_empty())
}
