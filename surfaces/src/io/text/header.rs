//! What stands above the numbers of a text: lines like `# Width: 10 µm`, and names of columns.

use super::{markers, words};
use crate::io::fault::Fault;
use crate::io::unit::{LengthUnit, with_factor};

/// What the header says.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Header {
    pub(super) title: String,
    /// Side along x, side along y.
    width: Option<Length>,
    height: Option<Length>,
    /// Spacing along both, or along x, and that along y.
    pixel: Option<Length>,
    pixel_y: Option<Length>,
    /// Unit of sides and spacings that have none of their own, and that of those along y if it has another.
    pub(super) side_unit: Option<String>,
    pub(super) side_unit_y: Option<String>,
    pub(super) value_unit: Option<String>,
    /// What the numbers have to be multiplied by to be in their unit.
    pub(super) factor: Option<f64>,
    /// Whether that and the unit come from a line that any line with a unit overrules; no other factor is overruled.
    is_bit2nm: bool,
    /// Unit of the coordinates of points.
    pub(super) lateral_unit: Option<String>,
    /// Numbers of columns and rows.
    columns: Option<usize>,
    rows: Option<usize>,
    /// The last line that could be one of names of columns, and whether it is the last of all.
    pub(super) names: Option<String>,
    pub(super) ends_with_names: bool,
    /// The number that stands for a missing value.
    pub(super) missing: Option<f64>,
    /// The first number with a comma that may be a decimal one or part thousands.
    pub(super) doubtful: Option<String>,
    /// How many heights are void, as SPIP says: then rows of a mask follow theirs.
    void_count: Option<usize>,
    /// The nodes that this mask marks.
    pub(super) mask: Option<Vec<bool>>,
    /// The first line that only maps have: one of its sides, say.
    of_map: Option<String>,
    /// The first lines that say nothing that is known, and how many there are.
    unread: Vec<String>,
    unread_count: usize,
}

/// Lines that are shown of those that are not understood, and letters of any text of the file that is shown.
const SHOWN: usize = 3;
const SHOWN_LETTERS: usize = 40;

/// How far a step may be from the cell that a header gives, relative to it: both are rounded.
const SAME_STEP: f64 = 0.05;

/// How far a number in the file may be from the one that stands for a missing value, relative to it: both are rounded.
const SAME_MARK: f64 = 1e-6;

/// A number and what is written behind it.
#[derive(Debug, Clone, PartialEq)]
struct Length {
    value: f64,
    unit: Option<String>,
}

// What Gwyddion writes above a matrix, in the languages that it speaks, in small letters, and what WSxM and SPIP call
// it.
const TITLE: &str = "channel|kanál|kanal|canal|canale|チャネル|채널|канал";
const WIDTH: &str = "width|šířka|breite|anchura|largeur|larghezza|幅|폭|largura|ширина|x amplitude|x-length|x length";
const HEIGHT: &str =
    "height|výška|höhe|altura|hauteur|altezza|高さ|높이|высота|y amplitude|y-length|y length";
const VALUE_UNIT: &str = "value units|jednotky hodnot|einheiten|werteinheiten|unités|unità valore|値の単位|값 단위|\
    unidades de valor|единицы измерения";
/// What other programs call it.
const DATA_UNIT: &str = "data unit|unit data|exported image units|z-unit|z unit|z units|zunit|unit z|height unit|height units";
const SIDE_UNIT: &str = "x-unit|x unit|x units|xunit|unit x|xy unit|unit xy|xyunit";
const SIDE_UNIT_Y: &str = "y-unit|y unit|y units|yunit|unit y";
/// What stands above maps alone, besides sides and numbers of columns and rows.
const OF_MAP: &str = "scale y|exported image units";
const COLUMNS: &str = "x-pixels|nx|ncols|number of columns";
const ROWS: &str = "y-pixels|ny|nrows|number of rows";

impl Header {
    /// Takes in a line. Returns whether it says anything that is known.
    pub(super) fn add(&mut self, line: &str) -> Result<bool, Fault> {
        let line =
            line.trim_matches(|c: char| matches!(c, '#' | '%' | '"' | '\\') || c.is_whitespace());
        if line.is_empty() {
            return Ok(false);
        }
        self.ends_with_names = false;
        if let Some((key, value)) = line.split_once(['=', ':', '：'])
            && let Some(is_read) = self.add_value(key, value.trim())?
        {
            if is_of_map(key) {
                self.of_map.get_or_insert_with(|| shown(line));
            }
            if !is_read {
                self.leave(line);
            }
            return Ok(true);
        }
        let words = line.split_once(char::is_whitespace);
        if words.is_some_and(|(key, value)| self.add_word(key, value.trim())) {
            return Ok(true);
        }
        if words::could_be(line) {
            self.names = Some(line.to_string());
            self.ends_with_names = true;
            return Ok(true);
        }
        self.leave(line);
        Ok(false)
    }

    /// A line that is not used.
    fn leave(&mut self, line: &str) {
        if self.unread.len() < SHOWN {
            self.unread.push(shown(line));
        }
        self.unread_count += 1;
    }

    /// A length, and a note of it where its comma may mean two things.
    fn length(&mut self, text: &str) -> Option<Length> {
        if may_part_thousands(text) {
            self.doubtful.get_or_insert_with(|| shown(text));
        }
        Length::parse(text)
    }

    /// What heights are multiplied by: without it they would be wrong by any factor.
    fn factor_of(&mut self, key: &str, value: &str) -> Result<f64, Fault> {
        let factor = self.length(value).ok_or_else(|| {
            fault!(
                "the heights have to be multiplied by '{}', but '{}' does not begin with a number; \
                 write it with a decimal point, and without signs that part thousands",
                shown(key),
                shown(value)
            )
        })?;
        Ok(factor.value)
    }

    /// A line with a sign between key and value. Returns whether the value can be read, `None` for an unknown key.
    fn add_value(&mut self, key: &str, value: &str) -> Result<Option<bool>, Fault> {
        let key = key.trim().to_lowercase();
        let is = |names: &str| is_one(&key, names);
        let mut is_read = true;
        if is(TITLE) {
            self.title = value.to_string();
        } else if is(WIDTH) {
            self.width = self.length(value);
            is_read = self.width.is_some();
        } else if is(HEIGHT) {
            self.height = self.length(value);
            is_read = self.height.is_some();
        } else if is(VALUE_UNIT) || is(DATA_UNIT) {
            self.set_value_unit(some(value));
        } else if is(SIDE_UNIT) {
            self.side_unit = some(value);
        } else if is(SIDE_UNIT_Y) {
            self.side_unit_y = some(value);
        } else if is(COLUMNS) {
            self.columns = value.parse().ok();
            is_read = self.columns.is_some();
        } else if is(ROWS) {
            self.rows = value.parse().ok();
            is_read = self.rows.is_some();
        } else if is("voidpixels") {
            self.void_count = value.parse().ok();
            is_read = self.void_count.is_some();
        } else if is("lateral units") {
            self.lateral_unit = some(value);
        } else if is("pixel size") || is("scale x") {
            self.pixel = self.length(value);
            is_read = self.pixel.is_some();
        } else if is("scale y") {
            self.pixel_y = self.length(value);
            is_read = self.pixel_y.is_some();
        } else if is("z amplitude") {
            // WSxM gives the range of heights; its unit is that of them all.
            self.set_value_unit(Length::parse(value).and_then(|range| range.unit));
        } else if is("file format") && value.eq_ignore_ascii_case("ascii") {
            // SPIP has lengths in nm.
            self.side_unit.get_or_insert_with(|| "nm".to_string());
        } else if is("bit2nm") {
            // A unit of its own takes precedence, on whichever line it stands.
            if self.value_unit.is_none() {
                self.is_bit2nm = true;
                self.factor = Some(self.factor_of(&key, value)?);
                self.value_unit = some("nm");
            }
        } else if let Some(unit) = key.strip_prefix("height conversion factor (->") {
            self.is_bit2nm = false;
            self.factor = Some(self.factor_of(&key, value)?);
            self.value_unit = some(unit.trim_end_matches(')'));
        } else {
            return Ok(None);
        }
        Ok(Some(is_read))
    }

    /// The unit of a line without a factor.
    fn set_value_unit(&mut self, unit: Option<String>) {
        let is_open = self.factor.is_none() || self.is_bit2nm;
        if is_open && unit.is_some() {
            (self.value_unit, self.factor, self.is_bit2nm) = (unit, None, false);
        }
    }

    /// The header of a grid of geographers: lines without a sign between key and value.
    fn add_word(&mut self, key: &str, value: &str) -> bool {
        let key = key.to_ascii_lowercase();
        match key.as_str() {
            "nodata_value" => self.missing = number(value),
            "cellsize" => {
                self.pixel = self.length(value);
                return self.pixel.is_some();
            }
            "ncols" => self.columns = value.parse().ok(),
            "nrows" => self.rows = value.parse().ok(),
            _ => return false,
        }
        number(value).is_some()
    }

    /// `Ok` if the matrix has the shape that the header gives.
    pub(super) fn check_shape(&self, (nx, ny): (usize, usize)) -> Result<(), Fault> {
        for (name, stated, found) in [("columns", self.columns, nx), ("rows", self.rows, ny)] {
            if let Some(stated) = stated {
                ensure!(stated == found, "the header says {stated} {name}, but there are {found}");
            }
        }
        Ok(())
    }

    /// Takes the mask of SPIP from behind the heights: 0 for each that is void, 1 for any other (as in Gwyddion's
    /// `spip-asc.c`). Whether there is one.
    pub(super) fn take_mask(
        &mut self,
        columns: usize,
        values: &mut Vec<f64>,
    ) -> Result<bool, Fault> {
        let Some(count) = self.void_count.filter(|count| *count > 0) else {
            return Ok(false);
        };
        let is_mask = |rows: &[f64]| rows.iter().all(|number| matches!(*number, 0.0 | 1.0));
        let rows = values.len() / columns.max(1);
        if self.rows == Some(rows) {
            return Ok(false);
        }
        let nodes = values.len() / 2;
        ensure!(
            self.columns == Some(columns)
                && self.rows.is_some_and(|stated| 2 * stated == rows)
                && values.get(nodes..).is_some_and(is_mask),
            "the header says that {count} of the heights are void: it has to say as well how many columns and rows \
             there are, and as many rows of 0, where the height is void, and 1 are expected behind those of the \
             heights; there are {rows} rows of {columns} numbers in all; without the line 'voidpixels' all are \
             read as heights"
        );
        let mask = values.split_off(nodes);
        self.mask = Some(mask.into_iter().map(|valid| valid == 0.0).collect());
        Ok(true)
    }

    /// What is said of lines that are not understood.
    pub(super) fn unread(&self) -> String {
        let more = if self.unread_count > self.unread.len() { ", ..." } else { "" };
        match self.unread_count {
            0 => String::new(),
            1 => format!("; a line above them is not used: '{}'", self.unread.join("', '")),
            count => format!(
                "; {count} lines above them are not used: '{}'{more}",
                self.unread.join("', '")
            ),
        }
    }

    /// The units of x and of heights: those in names of columns, which must not contradict these lines, or theirs.
    pub(super) fn units(&self, [x, z]: [Option<&String>; 2]) -> Result<[Option<String>; 2], Fault> {
        let of_x = self.lateral_unit.as_ref().or(self.side_unit.as_ref());
        let of_z = self.value_unit.as_ref();
        let told = of_z.map(|unit| with_factor(self.factor.unwrap_or(1.0), unit));
        for (of, name, head) in [("heights", z, told.as_ref()), ("x", x, of_x)] {
            if let (Some(name), Some(head)) = (name, head) {
                ensure!(
                    ratio(Some(name), Some(head)) == Some(1.0),
                    "of {of}, the name of the column says '{}', but the header '{}'",
                    shown(name),
                    shown(head)
                );
            }
        }
        Ok([x.or(of_x).cloned(), z.or(of_z).cloned()])
    }

    /// Units of what has none of its own, along x and y.
    pub(super) fn side_units(&self) -> [Option<&String>; 2] {
        let of_x = self.side_unit.as_ref();
        [of_x, self.side_unit_y.as_ref().or(of_x)]
    }

    /// Makes NaN of the numbers that stand for missing heights.
    pub(super) fn remove_marks(&self, numbers: &mut [f64], notes: &mut Vec<String>) {
        if let Some(missing) = self.missing {
            let is_mark = |number: f64| (number - missing).abs() <= SAME_MARK * missing.abs();
            numbers.iter_mut().filter(|number| is_mark(**number)).for_each(|n| *n = f64::NAN);
        }
        // A mask says it of every node.
        if self.mask.is_some() {
            return;
        }
        notes.append(&mut markers::remove(numbers));
        notes.extend(self.void_count.filter(|count| *count > 0).map(|count| {
            format!("the header says that {count} of the heights are void, but no rows behind them say which")
        }));
    }

    /// Whether it says that there is a matrix: it gives sides, or numbers of columns and rows.
    pub(super) fn is_of_matrix(&self) -> bool {
        self.has_sides() || self.counts()
    }

    /// The first line that only a map has.
    pub(super) fn of_map(&self) -> Option<&str> {
        self.of_map.as_deref()
    }

    /// What is said of a side that stands alone: cells do not follow from it.
    pub(super) fn lone_side(&self) -> Option<String> {
        let is_lone = !self.has_sides() && (self.width.is_some() || self.height.is_some());
        let line = self.of_map().filter(|_| is_lone)?;
        Some(format!("'{line}' gives one side of two, and is not used"))
    }

    pub(super) fn has_sides(&self) -> bool {
        self.pixel.is_some() || self.width.is_some() && self.height.is_some()
    }

    /// Whether it gives a number of columns, or of rows.
    pub(super) fn counts(&self) -> bool {
        self.columns.is_some() || self.rows.is_some()
    }

    /// The number of columns that it gives.
    pub(super) fn stated_columns(&self) -> Option<usize> {
        self.columns
    }

    /// Whether these are the numbers of columns and rows, as far as it gives them.
    pub(super) fn has_counts(&self, columns: usize, rows: usize) -> bool {
        self.columns.is_none_or(|stated| stated == columns)
            && self.rows.is_none_or(|stated| stated == rows)
    }

    /// Makes a cell of its sides one of those steps along x and y with which the sides are those from the first node to
    /// the last. Returns what is said of it.
    pub(super) fn fit_to_steps(
        &self,
        (dx, dy): &mut (f64, f64),
        (nx, ny): (usize, usize),
        [along_x, along_y]: [Option<f64>; 2],
    ) -> Option<String> {
        let mut fitted = Vec::new();
        for (name, cell, n, step) in [("x", dx, nx, along_x), ("y", dy, ny, along_y)] {
            // A spacing is no side.
            let Some(step) = step.filter(|_| self.pixel.is_none() && n > 1) else { continue };
            let edges = *cell * n as f64 / (n - 1) as f64;
            if is_same_step(step, edges) && (step - edges).abs() < (step - *cell).abs() {
                *cell = step;
                fitted.push(name);
            }
        }
        (!fitted.is_empty()).then(|| {
            format!(
                "the sides of the header are those from the first position to the last along {}, so that cells are \
                 the steps of the positions",
                fitted.join(" and ")
            )
        })
    }

    /// Whether `count` numbers in such steps can be positions: any can unless there is a side, with which they have to
    /// agree, be they those of cells or those of nodes from edge to edge.
    pub(super) fn may_be_axis(&self, count: usize, along_x: bool, step: f64) -> bool {
        if count < 2 || !self.has_sides() {
            return true;
        }
        let Ok((Some((dx, dy)), _)) = self.cell((count, count)) else {
            return true;
        };
        let cell = if along_x { dx } else { dy };
        let edges = cell * count as f64 / (count - 1) as f64;
        [cell, edges].into_iter().any(|cell| is_same_step(step.abs(), cell))
    }

    /// The cell of a matrix, and its unit: that of the side along x.
    pub(super) fn cell(&self, (nx, ny): (usize, usize)) -> Result<Cell, Fault> {
        let (x, y, nx, ny) = match (&self.pixel, &self.width, &self.height) {
            (Some(pixel), ..) => (pixel, self.pixel_y.as_ref().unwrap_or(pixel), 1, 1),
            (None, Some(width), Some(height)) => (width, height, nx, ny),
            _ => return Ok((None, None)),
        };
        let [of_x, of_y] = self.side_units();
        // A pixel that stands for both sides is in the unit of x.
        let of_y = if std::ptr::eq(x, y) { of_x } else { of_y };
        let (unit_x, unit_y) = (x.unit.as_ref().or(of_x), y.unit.as_ref().or(of_y));
        let ratio = ratio(unit_y, unit_x).ok_or_else(|| {
            let [width, height] = [unit_x, unit_y].map(|unit| shown(unit.map_or("", |unit| unit)));
            fault!("the header gives the width in '{width}', but the height in '{height}'")
        })?;
        let cell = (x.value / nx as f64, y.value * ratio / ny as f64);
        Ok((Some(cell), unit_x.cloned()))
    }
}

/// The beginning of a text of the file, as it is shown.
pub(super) fn shown(text: &str) -> String {
    text.chars().take(SHOWN_LETTERS).collect()
}

fn is_same_step(step: f64, cell: f64) -> bool {
    (step - cell).abs() <= SAME_STEP * cell
}

/// Whether a key, in small letters, is one of these names.
fn is_one(key: &str, names: &str) -> bool {
    names.split('|').any(|name| name == key)
}

/// Whether a key that is known stands above maps alone.
fn is_of_map(key: &str) -> bool {
    let key = key.trim().to_lowercase();
    [WIDTH, HEIGHT, OF_MAP].iter().any(|names| is_one(&key, names))
}

/// How many of another unit a unit is, if they can be compared.
pub(super) fn ratio(of: Option<&String>, other: Option<&String>) -> Option<f64> {
    if of == other {
        return Some(1.0);
    }
    let metres = |unit: Option<&String>| LengthUnit::in_file(unit?).map(LengthUnit::metres);
    Some(metres(of)? / metres(other)?)
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
}

/// Whether a text begins with digits, a comma and three digits, as thousands are parted: a decimal comma looks the
/// same, unless 0 is before it.
pub(super) fn may_part_thousands(text: &str) -> bool {
    let Some((before, after)) = text.split_once(',') else {
        return false;
    };
    let before = before.trim_start_matches(['+', '-']);
    let digits = after.bytes().take_while(u8::is_ascii_digit).count();
    let is_group =
        (1..=3).contains(&before.len()) && before.bytes().all(|byte| byte.is_ascii_digit());
    is_group && !before.starts_with('0') && digits == 3
}

/// A number with a decimal point or comma.
fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    text.parse().or_else(|_| text.replace(',', ".").parse()).ok()
}

fn some(text: &str) -> Option<String> {
    Some(text.trim().to_string()).filter(|text| !text.is_empty())
}
