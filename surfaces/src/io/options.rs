//! Reading a surface: what a file says, and what the user adds to it.

use std::io::Read;
use std::path::Path;

use nalgebra::DMatrix;

use super::bytes::{read_all, read_file};
use super::fault::Fault;
use super::format::Format;
use super::measured::MeasuredSurface;
use super::raw::Channel;
use super::unit::LengthUnit;
use crate::{Error, FileError};

/// Reads the heights in a file, in any of the [formats](super) that this crate knows.
///
/// Heights and cell come in metres; missing nodes are NaN. What the file leaves open has to be given in [`ReadOptions`]; of
/// a NumPy array, which never has a unit, heights are taken to be in metres, and [`MeasuredSurface::notes`] says so.
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
    let (_, channels) = parse(&named(path, read_file(path))?, path)?;
    Ok(names(&channels))
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
pub struct ReadOptions {
    channel: Option<String>,
    side: Option<f64>,
    side_y: Option<f64>,
    height_unit: Option<LengthUnit>,
    lateral_unit: Option<LengthUnit>,
    ignore_mask: bool,
}

impl ReadOptions {
    /// Everything as the file says.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The map of this name, in a file with several.
    #[must_use]
    pub fn channel(mut self, name: impl Into<String>) -> Self {
        self.channel = Some(name.into());
        self
    }

    /// The side along x \[m\], in place of what the file says. Cells are square unless
    /// [`side_y`](Self::side_y) is given.
    #[must_use]
    pub fn side(mut self, metres: f64) -> Self {
        self.side = Some(metres);
        self
    }

    /// The side along y \[m\], in place of what the file says.
    #[must_use]
    pub fn side_y(mut self, metres: f64) -> Self {
        self.side_y = Some(metres);
        self
    }

    /// The unit of the numbers in the file, in place of the one that it names.
    #[must_use]
    pub fn height_unit(mut self, unit: LengthUnit) -> Self {
        self.height_unit = Some(unit);
        self
    }

    /// The unit of lengths along x and y in the file, in place of the one that it names.
    #[must_use]
    pub fn lateral_unit(mut self, unit: LengthUnit) -> Self {
        self.lateral_unit = Some(unit);
        self
    }

    /// Keeps the heights of nodes that are marked in the file; otherwise they are missing.
    #[must_use]
    pub fn ignore_mask(mut self) -> Self {
        self.ignore_mask = true;
        self
    }

    /// Reads a file.
    ///
    /// The sizes that a file claims are compared with its length before memory is asked for.
    ///
    /// # Errors
    ///
    /// [`FileError::Io`](crate::FileError::Io) if the file cannot be read; [`FileError::UnknownFormat`](crate::FileError::UnknownFormat); [`FileError::BadFile`](crate::FileError::BadFile) for a defect, with
    /// its place; [`Error::EmptyGrid`] and [`Error::GridTooLarge`]; [`FileError::NoUnit`](crate::FileError::NoUnit) where the unit is
    /// missing or no length; [`FileError::WhichChannel`](crate::FileError::WhichChannel) where there are several maps or none of that name;
    /// [`Error::NotPositive`] for a side that is not.
    pub fn read(&self, path: impl AsRef<Path>) -> Result<MeasuredSurface, Error> {
        let path = path.as_ref();
        self.of(&named(path, read_file(path))?, path)
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
        self.of(&named(name, read_all(source))?, name)
    }

    /// The surface in the bytes of a file.
    fn of(&self, bytes: &[u8], path: &Path) -> Result<MeasuredSurface, Error> {
        let (format, channels) = parse(bytes, path)?;
        let names = names(&channels);
        let mut channel = self.choose(channels, path)?;
        let height = self.height_factor(&channel, path)?;
        let cell = self.cell(&channel, path)?;
        let mut notes = std::mem::take(&mut channel.notes);
        self.apply_mask(&mut channel, &mut notes);
        notes.extend(self.assumed(format, cell, channel.shape));
        let mut missing = 0;
        for value in &mut channel.values {
            // Infinite values mark missing nodes as well, in files of several makers.
            *value = if value.is_finite() { *value * height } else { f64::NAN };
            missing += usize::from(value.is_nan());
        }
        let (nx, ny) = channel.shape;
        Ok(MeasuredSurface {
            heights: DMatrix::from_vec(nx, ny, channel.values),
            missing,
            cell,
            title: channel.name,
            channels: names,
            format,
            notes,
        })
    }

    /// The map that was asked for; without a name, the only one, or the only one that is a length.
    fn choose(&self, mut channels: Vec<Channel>, path: &Path) -> Result<Channel, Error> {
        let several = channels.len() > 1;
        let fits = |channel: &Channel| match &self.channel {
            Some(wanted) => channel.name == *wanted,
            None => !several || is_length(channel.height_unit.as_deref()),
        };
        let mut chosen = (0..channels.len()).filter(|k| fits(&channels[*k]));
        if let (Some(only), None) = (chosen.next(), chosen.next()) {
            return Ok(channels.swap_remove(only));
        }
        Err(Error::File(FileError::WhichChannel {
            path: path.to_path_buf(),
            wanted: self.channel.clone(),
            channels: names(&channels),
        }))
    }

    /// Metres for the numbers of the file.
    fn height_factor(&self, channel: &Channel, path: &Path) -> Result<f64, Error> {
        let unit = channel.height_unit.as_deref();
        factor(self.height_unit, unit).ok_or_else(|| {
            Error::File(FileError::NoUnit {
                path: path.to_path_buf(),
                quantity: "heights",
                found: unit.map(str::to_string),
                option: "`ReadOptions::height_unit`",
            })
        })
    }

    /// The cell in metres, `None` if neither the file nor the options give it.
    fn cell(&self, channel: &Channel, path: &Path) -> Result<Option<(f64, f64)>, Error> {
        let (nx, ny) = channel.shape;
        let given = |side: Option<f64>, n: usize, name| {
            side.map(|side| {
                let side = Error::require_positive(name, side)?;
                // The least numbers there are vanish when they are divided.
                Error::require_positive("cell of that side", side / n as f64)
            })
            .transpose()
        };
        let dx = given(self.side, nx, "side along x")?;
        let dy = given(self.side_y, ny, "side along y")?;
        if let (Some(dx), dy) = (dx, dy) {
            return Ok(Some((dx, dy.unwrap_or(dx))));
        }
        let Some(cell) = channel.cell else {
            return Ok(None);
        };
        let unit = channel.lateral_unit.as_deref();
        let metres = factor(self.lateral_unit, unit).ok_or_else(|| {
            Error::File(FileError::NoUnit {
                path: path.to_path_buf(),
                quantity: "lengths along x and y",
                found: unit.map(str::to_string),
                option: "`ReadOptions::lateral_unit` or `ReadOptions::side`",
            })
        })?;
        let dx = Error::require_positive("cell along x in the file", cell.0 * metres)?;
        let dy_of_file = Error::require_positive("cell along y in the file", cell.1 * metres)?;
        Ok(Some((dx, dy.unwrap_or(dy_of_file))))
    }

    /// What neither the file nor the options say, in words.
    fn assumed(
        &self,
        format: Format,
        cell: Option<(f64, f64)>,
        (_, ny): (usize, usize),
    ) -> Vec<String> {
        let mut assumed = Vec::new();
        if format == Format::Npy && self.height_unit.is_none() {
            assumed
                .push("a NumPy array has no unit: its heights are assumed to be in m".to_string());
        }
        if let (Some((_, dy)), Some(_), None) = (cell, self.side, self.side_y) {
            assumed.push(format!(
                "cells are assumed to be square: the side along y is {:e} m",
                ny as f64 * dy
            ));
        }
        assumed
    }

    fn apply_mask(&self, channel: &mut Channel, notes: &mut Vec<String>) {
        let Some(mask) = channel.mask.as_ref().filter(|_| !self.ignore_mask) else {
            return;
        };
        let mut marked = 0;
        for (value, _) in channel.values.iter_mut().zip(mask).filter(|(_, marked)| **marked) {
            *value = f64::NAN;
            marked += 1;
        }
        if marked > 0 {
            notes.push(format!("{marked} nodes that a mask marks are taken as missing"));
        }
    }
}

fn names(channels: &[Channel]) -> Vec<String> {
    channels.iter().map(|channel| channel.name.clone()).collect()
}

/// Metres for a unit: the one given, otherwise that of the file.
fn factor(given: Option<LengthUnit>, found: Option<&str>) -> Option<f64> {
    let unit = match given {
        Some(unit) => unit,
        None => found?.parse().ok()?,
    };
    Some(unit.metres())
}

fn is_length(unit: Option<&str>) -> bool {
    unit.is_some_and(|unit| unit.parse::<LengthUnit>().is_ok())
}

/// What was read, or the error that names the file.
fn named<T>(path: &Path, read: Result<T, Fault>) -> Result<T, Error> {
    read.map_err(|fault| fault.in_file(path, "surface"))
}

/// The format of a file, and all maps in it.
fn parse(bytes: &[u8], path: &Path) -> Result<(Format, Vec<Channel>), Error> {
    let format = Format::of(bytes).ok_or_else(|| {
        Error::File(FileError::UnknownFormat {
            path: path.to_path_buf(),
            begins: bytes.iter().take(8).copied().collect(),
        })
    })?;
    format
        .parse(bytes, path)
        .and_then(|channels| {
            if channels.is_empty() {
                return Err(Fault::malformed("there is no map in it"));
            }
            Ok((format, channels))
        })
        .map_err(|fault| fault.in_file(path, format.name()))
}
