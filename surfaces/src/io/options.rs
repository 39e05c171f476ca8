//! Reading a surface: what a file says, and what the user adds to it.

use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

use nalgebra::DMatrix;

use super::bytes::{read_all, read_file, shared};
use super::fault::printable;
use super::format::{Besides, Format, not_read};
use super::measured::MeasuredSurface;
use super::raw::Channel;
use super::text::TextLayout;
use super::unit::{LengthUnit, with_factor};
use crate::number::{counted, quantity};
use crate::{Error, FileError};

/// Reads the heights in a file, in any of the [formats](super) that this crate knows.
///
/// Heights and cell come in metres; missing nodes are NaN. What the file leaves open has to be given in
/// [`ReadOptions`]; of a NumPy array, which never has a unit, heights are taken to be in metres, and
/// [`MeasuredSurface::notes`] says so.
///
/// # Errors
///
/// As [`ReadOptions::read`].
///
/// ```no_run
/// use asperity_surfaces::io::read_surface;
///
/// # fn main() -> Result<(), asperity_surfaces::Error> {
/// let measured = read_surface("ground.sdf")?;
/// println!("{measured}");
/// # Ok(())
/// # }
/// ```
pub fn read_surface(path: impl AsRef<Path>) -> Result<MeasuredSurface, Error> {
    ReadOptions::new().read(path)
}

/// The names of the maps in a file, in their order: what [`ReadOptions::channel`] chooses from.
///
/// # Errors
///
/// As [`ReadOptions::read`], but for units, which are not looked at.
pub fn channels(path: impl AsRef<Path>) -> Result<Vec<String>, Error> {
    let path = path.as_ref();
    let bytes = read_file(path).map_err(|fault| fault.in_file(path, UNREAD))?;
    Ok(names(&parse(&bytes, path, None)?.1))
}

/// What to read from a file, and what it does not say of itself.
///
/// ```no_run
/// use asperity_surfaces::io::{LengthUnit, ReadOptions};
///
/// # fn main() -> Result<(), asperity_surfaces::Error> {
/// let measured = ReadOptions::new()
///     .height_unit("nm".parse()?)
///     .side(1e-3)
///     .read("matrix.txt")?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
#[must_use]
pub struct ReadOptions {
    channel: Option<String>,
    side: Option<f64>,
    side_y: Option<f64>,
    height_unit: Option<LengthUnit>,
    lateral_unit: Option<LengthUnit>,
    ignore_mask: bool,
    layout: Option<TextLayout>,
    rows_are_y: bool,
}

impl ReadOptions {
    /// Everything as the file says.
    pub fn new() -> Self {
        Self::default()
    }

    /// The map of this name, in a file with several.
    pub fn channel(mut self, name: impl Into<String>) -> Self {
        self.channel = Some(name.into());
        self
    }

    /// The side along x \[m\], in place of what the file says; of a single column its length along y. Cells are square
    /// unless [`side_y`](Self::side_y) is given.
    pub fn side(mut self, metres: f64) -> Self {
        self.side = Some(metres);
        self
    }

    /// The side along y \[m\], in place of what the file says.
    pub fn side_y(mut self, metres: f64) -> Self {
        self.side_y = Some(metres);
        self
    }

    /// The unit of the numbers in the file, in place of the one that it names.
    ///
    /// A factor that a text gives belongs to its unit, and is left out with it. The scale of a file that is no text
    /// stays: it makes heights of what is stored.
    pub fn height_unit(mut self, unit: LengthUnit) -> Self {
        self.height_unit = Some(unit);
        self
    }

    /// The unit of lengths along x and y in the file, in place of the one that it names.
    pub fn lateral_unit(mut self, unit: LengthUnit) -> Self {
        self.lateral_unit = Some(unit);
        self
    }

    /// Keeps the heights of nodes that are marked in the file; otherwise they are missing.
    pub fn ignore_mask(mut self) -> Self {
        self.ignore_mask = true;
        self
    }

    /// How the numbers of a text are arranged, where it can be read in several ways, or in place of what it says.
    pub fn layout(mut self, layout: TextLayout) -> Self {
        self.layout = Some(layout);
        self
    }

    /// Takes a NumPy array as an image, `[row, column]`: its first index is y. The rows of all other formats are y
    /// anyway.
    pub fn rows_are_y(mut self) -> Self {
        self.rows_are_y = true;
        self
    }

    /// Reads a file.
    ///
    /// The sizes that a file claims are compared with its length before memory is asked for.
    ///
    /// # Errors
    ///
    /// [`FileError::Io`](crate::FileError::Io) if the file cannot be read;
    /// [`FileError::UnknownFormat`](crate::FileError::UnknownFormat); [`FileError::BadFile`](crate::FileError::BadFile)
    /// for a defect, with its place; [`Error::EmptyGrid`] and [`Error::GridTooLarge`];
    /// [`FileError::NoUnit`](crate::FileError::NoUnit) where the unit is missing or no length;
    /// [`FileError::WhichChannel`](crate::FileError::WhichChannel) where there are several maps or none of that name;
    /// [`Error::NotPositive`] for a side that is not.
    pub fn read(&self, path: impl AsRef<Path>) -> Result<MeasuredSurface, Error> {
        let path = path.as_ref();
        self.of(&read_file(path).map_err(|fault| fault.in_file(path, UNREAD))?, path)
    }

    /// Reads the bytes of a file that is not on disk: one of an archive, of a database, from a network.
    ///
    /// `name` is the file's: errors call it so, and lists of points are known by its extension `.xyz`. It may be empty.
    ///
    /// ```
    /// use asperity_surfaces::io::ReadOptions;
    ///
    /// # fn main() -> Result<(), asperity_surfaces::Error> {
    /// let points = "0 0 1\n1 0 2\n0 1 3\n1 1 4";
    /// let options = ReadOptions::new().height_unit("um".parse()?).lateral_unit("mm".parse()?);
    /// let measured = options.read_bytes(points, "stylus.xyz")?;
    /// assert_eq!(measured.heights[(1, 0)], 2e-6);
    /// assert_eq!(measured.cell, Some((1e-3, 1e-3)));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// As [`ReadOptions::read`].
    pub fn read_bytes(
        &self,
        bytes: impl AsRef<[u8]>,
        name: impl AsRef<Path>,
    ) -> Result<MeasuredSurface, Error> {
        self.of(bytes.as_ref(), name.as_ref())
    }

    /// Reads all bytes of a source, and these as [`ReadOptions::read_bytes`] does.
    ///
    /// # Errors
    ///
    /// As [`ReadOptions::read`].
    pub fn read_from(
        &self,
        source: impl Read,
        name: impl AsRef<Path>,
    ) -> Result<MeasuredSurface, Error> {
        let name = name.as_ref();
        self.of(&read_all(source).map_err(|fault| fault.in_file(name, UNREAD))?, name)
    }

    /// The surface in the bytes of a file.
    fn of(&self, bytes: &[u8], path: &Path) -> Result<MeasuredSurface, Error> {
        let (format, channels) = parse(bytes, path, self.layout)?;
        let names = names(&channels);
        let mut channel = self.choose(channels, path)?;
        if self.rows_are_y && format == Format::Npy {
            channel = channel.transposed();
        }
        let unit = channel.height_unit.take();
        let mut replaced = Vec::new();
        // NumPy's metre is an assumption, see below.
        let stated = unit.as_deref().filter(|_| format != Format::Npy);
        let stated = stated.map(|unit| with_factor(channel.factor, unit));
        replaced.extend(replacement("heights", self.height_unit, stated.as_deref()));
        if self.height_unit.is_none() {
            channel.values.iter_mut().for_each(|value| *value *= channel.factor);
        }
        let height = metres(self.height_unit, unit).map_err(|found| {
            let (path, option) = (path.to_path_buf(), "`ReadOptions::height_unit`");
            FileError::NoUnit { path, quantity: "heights", found, option }
        })?;
        // A side in place of that of the file needs no unit.
        let is_used = self.side.is_none() && channel.cell.is_some();
        let unit = channel.lateral_unit.as_deref().filter(|_| is_used);
        replaced.extend(replacement("lengths along x and y", self.lateral_unit, unit));
        let cell = self.cell(&mut channel, path)?;
        let mut notes = channel.notes;
        notes.extend(channel.note_of_side.filter(|_| self.side.is_some()));
        notes.append(&mut replaced);
        if let Some(mask) = channel.mask.filter(|_| !self.ignore_mask) {
            let nodes = channel.values.iter_mut().zip(&mask).filter(|(_, marked)| **marked);
            let marked = nodes.map(|(value, _)| *value = f64::NAN).count();
            if marked > 0 {
                let are = if marked == 1 { "marks is" } else { "marks are" };
                notes.push(format!(
                    "{} that a mask {are} taken as missing",
                    counted(marked, "node")
                ));
            }
        }
        if let (Some(layout), true) = (self.layout, format != Format::Text) {
            notes.push(format!("the layout '{layout}' is for texts: a file of {format} says itself how it is laid out"));
        }
        // What neither the file nor the options say, in words.
        if format == Format::Npy && self.height_unit.is_none() {
            let of_axes = match self.rows_are_y {
                true => "",
                false => {
                    "; its first index is taken for x (`ReadOptions::rows_are_y` takes an image, whose rows are y)"
                }
            };
            notes.push(format!(
                "a NumPy array has no unit: its heights are assumed to be in m{of_axes}"
            ));
        }
        let (nx, ny) = channel.shape;
        if let (Some((dx, dy)), Some(_), None) = (cell, self.side, self.side_y) {
            let (axis, side) = if nx == 1 { ("x", dx) } else { ("y", ny as f64 * dy) };
            notes.push(format!(
                "cells are assumed to be square: the side along {axis} is {}",
                quantity(side, "m", 6)
            ));
        }
        let infinite =
            || channel.values.iter().enumerate().filter(|(_, value)| value.is_infinite());
        if let Some((first, value)) = infinite().next() {
            notes.push(format!(
                "{} {value} at node ({}, {}), and taken as missing, as in files of several makers; a node that is never to touch \
                 needs a finite height far below the others, but none such as -9999, which stands for a missing one",
                match infinite().count() {
                    1 => "1 height is infinite,".to_string(),
                    count => format!("{count} heights are infinite, the first"),
                },
                first % nx,
                first / nx
            ));
        }
        for value in &mut channel.values {
            // Infinite values mark missing nodes as well, in files of several makers.
            *value = if value.is_finite() { *value * height } else { f64::NAN };
        }
        let missing = channel.values.iter().filter(|value| value.is_nan()).count();
        let heights = DMatrix::from_vec(nx, ny, channel.values);
        let title = channel.name;
        let understood = channel.understood;
        let channels = names;
        Ok(MeasuredSurface { heights, missing, cell, title, channels, format, understood, notes })
    }

    /// The map that was asked for; without a name, the only one, or the only one that is a length.
    fn choose(&self, mut channels: Vec<Channel>, path: &Path) -> Result<Channel, Error> {
        let several = channels.len() > 1;
        let fits = |channel: &Channel| match &self.channel {
            Some(wanted) => channel.name == *wanted,
            None => !several || metres(None, channel.height_unit.clone()).is_ok(),
        };
        let mut chosen = (0..channels.len()).filter(|k| fits(&channels[*k]));
        if let (Some(only), None) = (chosen.next(), chosen.next()) {
            return Ok(channels.swap_remove(only));
        }
        let (path, channels) = (path.to_path_buf(), names(&channels));
        Err(FileError::WhichChannel { path, wanted: self.channel.clone(), channels }.into())
    }

    /// The cell in metres, `None` if neither the file nor the options give it.
    fn cell(&self, channel: &mut Channel, path: &Path) -> Result<Option<(f64, f64)>, Error> {
        let (nx, ny) = channel.shape;
        let given = |side: Option<f64>, n: usize, name| {
            side.map(|side| {
                let side = Error::require_positive(name, side)?;
                // The least numbers there are vanish when they are divided.
                Error::require_positive("cell of that side", side / n as f64)
            })
            .transpose()
        };
        // Along a single column there is one length that anybody means.
        let along = if nx == 1 && self.side_y.is_none() { ny } else { nx };
        let dx = given(self.side, along, "side")?;
        let dy = given(self.side_y, ny, "side along y")?;
        if let Some(dx) = dx {
            return Ok(Some((dx, dy.unwrap_or(dx))));
        }
        let Some(cell) = channel.cell else {
            return Ok(None);
        };
        let unit = channel.lateral_unit.take();
        let metres = metres(self.lateral_unit, unit).map_err(|found| {
            let option = "`ReadOptions::lateral_unit` or `ReadOptions::side`";
            let path = path.to_path_buf();
            FileError::NoUnit { path, quantity: "lengths along x and y", found, option }
        })?;
        let dx = Error::require_positive("cell along x in the file", cell.0 * metres)?;
        let dy_of_file = Error::require_positive("cell along y in the file", cell.1 * metres)?;
        Ok(Some((dx, dy.unwrap_or(dy_of_file))))
    }
}

/// Texts of the file without control characters, wherever they are shown: terminals obey them.
fn made_printable(mut channel: Channel) -> Channel {
    for text in [&mut channel.name, &mut channel.understood].into_iter().chain(&mut channel.notes) {
        *text = printable(text);
    }
    for unit in [&mut channel.height_unit, &mut channel.lateral_unit].into_iter().flatten() {
        *unit = printable(&shared(unit.trim()));
    }
    channel
}

/// Maps whose names occur more than once get numbers, so that each can be chosen.
fn told_apart(mut channels: Vec<Channel>) -> Vec<Channel> {
    let names = names(&channels);
    let mut times: HashMap<&str, usize> = HashMap::new();
    names.iter().for_each(|name| *times.entry(name).or_default() += 1);
    let mut seen: HashMap<&str, usize> = HashMap::new();
    for (channel, name) in channels.iter_mut().zip(&names) {
        if times.get(name.as_str()).is_some_and(|times| *times > 1) {
            let number = seen.entry(name).or_default();
            loop {
                *number += 1;
                channel.name = format!("{name} [{number}]");
                // A name that stands in the file stays with its map.
                if !times.contains_key(channel.name.as_str()) {
                    break;
                }
            }
        }
    }
    channels
}

fn names(channels: &[Channel]) -> Vec<String> {
    channels.iter().map(|channel| channel.name.clone()).collect()
}

/// Metres for a unit: the one given, otherwise that of the file, which is told if it is no length.
fn metres(given: Option<LengthUnit>, found: Option<String>) -> Result<f64, Option<String>> {
    let of_file = || LengthUnit::in_file(found.as_deref()?);
    given.or_else(of_file).map(LengthUnit::metres).ok_or(found)
}

/// What is said of a unit that takes the place of another in the file.
fn replacement(of: &str, given: Option<LengthUnit>, found: Option<&str>) -> Option<String> {
    let (given, found) = (given?, found?);
    (LengthUnit::in_file(found) != Some(given))
        .then(|| format!("the {of} are taken to be in {given}, although the file says '{found}'"))
}

/// What errors call a file before its format is known.
const UNREAD: &str = "surface";

/// The format of a file, and all maps in it.
fn parse(
    bytes: &[u8],
    path: &Path,
    layout: Option<TextLayout>,
) -> Result<(Format, Vec<Channel>), Error> {
    let format = Format::of(bytes).ok_or_else(|| FileError::UnknownFormat {
        path: path.to_path_buf(),
        begins: bytes.iter().take(8).copied().collect(),
        what: not_read(bytes),
    })?;
    let channels = format.parse(bytes, &Besides { path, layout }).and_then(|channels| {
        ensure!(!channels.is_empty(), "there is no map in it");
        Ok(told_apart(channels.into_iter().map(made_printable).collect()))
    });
    Ok((format, channels.map_err(|fault| fault.in_file(path, format.name()))?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a profile, a side is its length, along whichever axis it runs.
    #[test]
    fn a_side_of_a_single_column_is_its_length() -> Result<(), Error> {
        let cell = |shape: (usize, usize), options: &ReadOptions| {
            let values = vec![0.0; shape.0 * shape.1];
            options.cell(&mut Channel::in_metres(shape, values, None), Path::new("z.npy"))
        };
        let side = ReadOptions::new().side(2e-3);
        assert_eq!(cell((1, 2000), &side)?, Some((1e-6, 1e-6)));
        assert_eq!(cell((2000, 1), &side)?, Some((1e-6, 1e-6)));
        assert_eq!(cell((1, 2000), &side.side_y(4e-3))?, Some((2e-3, 2e-6)));
        Ok(())
    }

    /// Terminals obey control characters: those of a file are not passed on, neither by what is read nor by errors.
    #[test]
    fn no_control_characters_of_files_are_shown() -> Result<(), Error> {
        let rows = "1.5 4.25 1 5\n2 6.5 2 8\n5 8 9.75 3\n1 2 9 4\n";
        let head =
            "# Channel: a\x1b[2Jb\n# Width: 1 m\n# Height: 1 m\n# by \x1b]0;c\x07\tand \u{9b}3m\n";
        // They are few among other letters, or the file is no text.
        let head = format!("{head}# {}\n", " ".repeat(1000));
        let text = format!("{head}# Value units: m\n{rows}");
        let read = ReadOptions::new().read_bytes(&text, "map.txt")?;
        assert_eq!(
            (&*read.title, &*read.channels),
            ("a\u{fffd}[2Jb", &["a\u{fffd}[2Jb".to_string()][..])
        );
        assert!(read.understood.contains("by \u{fffd}]0;c\u{fffd} and \u{fffd}3m"));
        let shown = format!("{read} {} {:?}", read.understood, read.notes);
        assert!(!shown.contains(char::is_control), "{shown:?}");
        // The name that was told is the one to ask for.
        assert!(ReadOptions::new().channel("a\u{fffd}[2Jb").read_bytes(&text, "map.txt").is_ok());
        for text in [
            format!("{head}# Value units: \x1b[1m V\n{rows}"),
            format!("{head}{rows}1 2 \x1b[1m 3\n"),
        ] {
            let refused = ReadOptions::new().read_bytes(&text, "map.txt");
            let said = refused.map_err(|error| error.to_string());
            assert!(
                said.as_ref()
                    .is_err_and(|said| said.contains("\u{fffd}[1m") && !said.contains('\x1b')),
                "{said:?}"
            );
        }
        Ok(())
    }

    #[test]
    fn names_with_numbers_are_not_given_again() {
        let named = |name: &str| Channel {
            name: name.to_string(),
            ..Channel::in_metres((1, 1), vec![0.0], None)
        };
        let found = told_apart(["A", "B", "A", "A [1]", "A"].map(named).into());
        assert_eq!(names(&found), ["A [2]", "B", "A [3]", "A [1]", "A [4]"]);
    }
}
