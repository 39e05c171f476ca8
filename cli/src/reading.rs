//! The surface that a command line names: read, filled and levelled as it asks.

use std::path::Path;

use asperity::io::{LengthUnit, MeasuredSurface, ReadOptions, TextLayout};
use asperity::surface::{HeightMap, Topography, Trend, Warning};
use asperity::{Boundary, SurfaceError};
use asperity_cli::note;
use asperity_cli::number::{counted, quantity};
use asperity_cli::outcome::{Failure, of_program};
use clap::{Args, ValueEnum};
use nalgebra::DMatrix;
use serde_json::{Map, Value};

use crate::values::{LENGTH, layout, unit};

/// What a file does not say of itself, and how its surface is prepared.
#[derive(Debug, Clone, Args)]
pub(crate) struct Reading {
    /// Side of the surface along x, of a single column along y, in place of that in the file
    #[arg(long, value_name = "METRES", value_parser = LENGTH.positive())]
    pub(crate) side: Option<f64>,

    /// Side along y [default: that of square cells]
    #[arg(long, value_name = "METRES", value_parser = LENGTH.positive(), requires = "side", help_heading = "Reading the file")]
    pub(crate) side_y: Option<f64>,

    /// Unit of the heights, in place of that in the file: m, mm, um, nm, ...
    #[arg(long, value_name = "UNIT", value_parser = unit, help_heading = "Reading the file")]
    height_unit: Option<LengthUnit>,

    /// Unit of the lengths along x and y, in place of that in the file
    #[arg(long, value_name = "UNIT", value_parser = unit, help_heading = "Reading the file")]
    lateral_unit: Option<LengthUnit>,

    /// Name of the map, if the file contains several
    #[arg(long, value_name = "NAME", help_heading = "Reading the file")]
    channel: Option<String>,

    /// How the numbers of a text are arranged, where it does not say: matrix (heights only), x-row (positions along x
    /// in the first row), y-column (positions along y in the first column), axes (both), points (x, y, z in each line)
    #[arg(long, value_name = "LAYOUT", value_parser = layout, help_heading = "Reading the file")]
    layout: Option<TextLayout>,

    /// Take a NumPy array as an image, [row, column], whose rows are y; otherwise it is [ix, iy]. Rows of all
    /// other formats are y
    #[arg(long, help_heading = "Reading the file")]
    rows_are_y: bool,

    /// Use heights that a mask in the file marks as missing
    #[arg(long, help_heading = "Reading the file")]
    ignore_mask: bool,

    /// Interpolate missing nodes from the nodes around them, after --level
    #[arg(long, help_heading = "Reading the file")]
    fill: bool,

    /// Remove a trend from the heights, by least squares
    #[arg(long, value_enum, help_heading = "Reading the file")]
    level: Option<Level>,

    /// Turn peaks into valleys, for the replica of a surface
    #[arg(long, help_heading = "Reading the file")]
    invert: bool,
}

/// [`Trend`] on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Level {
    /// A tilted plane
    Plane,
    /// A surface of second degree: tilt and bow
    Quadratic,
}

impl From<Level> for Trend {
    fn from(level: Level) -> Self {
        match level {
            Level::Plane => Self::Plane,
            Level::Quadratic => Self::Quadratic,
        }
    }
}

impl Reading {
    /// What was asked for besides the sides, by option.
    pub(crate) fn given(&self) -> Map<String, Value> {
        let text = |value: Option<String>| value.map(Value::String);
        let flag = |is_given: bool| is_given.then_some(Value::Bool(true));
        let level = self.level.and_then(|level| level.to_possible_value());
        let options = [
            ("height-unit", text(self.height_unit.map(|unit| unit.to_string()))),
            ("lateral-unit", text(self.lateral_unit.map(|unit| unit.to_string()))),
            ("channel", text(self.channel.clone())),
            ("layout", text(self.layout.map(|layout| layout.to_string()))),
            ("rows-are-y", flag(self.rows_are_y)),
            ("ignore-mask", flag(self.ignore_mask)),
            ("fill", flag(self.fill)),
            ("level", text(level.map(|level| level.get_name().to_string()))),
            ("invert", flag(self.invert)),
        ];
        let given = options.into_iter();
        given.filter_map(|(name, value)| Some((name.to_string(), value?))).collect()
    }

    /// `Ok` if nothing else was asked for than sides: the rest is for a surface that is read from a file, and not for
    /// one that is generated.
    pub(crate) fn only_sides(&self) -> Result<(), Failure> {
        match self.given().keys().next() {
            None => Ok(()),
            Some(option) => Err(Failure::request(format!(
                "--{option} has no effect on a generated surface: use it with --surface FILE"
            ))),
        }
    }

    /// What is in a file, as it is.
    pub(crate) fn measured(&self, file: &Path) -> Result<MeasuredSurface, Failure> {
        let mut options = ReadOptions::new();
        if let Some(side) = self.side {
            options = options.side(side);
        }
        if let Some(side) = self.side_y {
            options = options.side_y(side);
        }
        if let Some(unit) = self.height_unit {
            options = options.height_unit(unit);
        }
        if let Some(unit) = self.lateral_unit {
            options = options.lateral_unit(unit);
        }
        if let Some(name) = &self.channel {
            options = options.channel(name);
        }
        if let Some(layout) = self.layout {
            options = options.layout(layout);
        }
        if self.rows_are_y {
            options = options.rows_are_y();
        }
        if self.ignore_mask {
            options = options.ignore_mask();
        }
        if let (Some(_), Some(unit)) = (self.side, self.lateral_unit) {
            note!(
                "note: --lateral-unit {unit} is not used, because --side gives the lengths, in metres unless it has a unit"
            );
        }
        options
            .read(file)
            .map_err(|error| Failure::new(format!("cannot read {}", file.display()), error))
    }

    /// The surface in a file, as it is to touch; what is done to it is said on stderr.
    pub(crate) fn surface(&self, file: &Path) -> Result<Topography, Failure> {
        let failed = |error| Failure::new(format!("cannot use {}", file.display()), error);
        let mut measured = self.measured(file)?;
        note!("file       {measured}");
        if !measured.understood.is_empty() {
            note!("understood {}", measured.understood);
        }
        for note in &measured.notes {
            note!("note: {}", of_program(note));
        }
        measured.grid().map_err(failed)?;
        let missing = measured.missing;
        if missing > 0 && !self.fill {
            return measured.topography().map_err(failed);
        }
        let (sx, sy) = measured.trend(Trend::Plane).map_err(failed)?.slopes();
        note!("tilt       {sx:.2e} along x, {sy:.2e} along y");
        if self.level.is_some() {
            let before = measured_sq(&measured.heights).map_err(failed)?;
            measured = self.levelled(measured).map_err(failed)?;
            let now = measured_sq(&measured.heights).map_err(failed)?;
            note!(
                "levelled   Sq {} before, {} now",
                quantity(before, "m", 5),
                quantity(now, "m", 5)
            );
        }
        if missing > 0 {
            measured = measured.fill_missing().map_err(failed)?;
            note!("filled     {}, interpolated from the nodes around", counted(missing, "node"));
            if let Some(warning) = Warning::of_filling(missing, measured.heights.len()) {
                eprintln!("warning: {warning}");
            }
        }
        if self.invert {
            note!("inverted   peaks are now valleys");
        }
        measured.topography().map(|surface| self.inverted(surface)).map_err(failed)
    }

    /// `Ok` unless a surface is one row of nodes that does not repeat across: a strip as narrow as a cell, which nobody
    /// means.
    pub(crate) fn check_row(surface: &Topography, boundary: Boundary) -> Result<(), Failure> {
        let ((nx, ny), [x_repeats, y_repeats]) = (surface.grid().shape(), boundary.repeats());
        let across = match (nx, ny) {
            (_, 1) if !y_repeats => "y",
            (1, _) if !x_repeats => "x",
            _ => return Ok(()),
        };
        Err(Failure::request(format!(
            "a profile is one row of nodes, which has to repeat across: give --periodic {across}, as in line contact, or --periodic love, \
             if it repeats along its length as well"
        )))
    }

    /// Whether missing nodes are to be filled.
    pub(crate) fn fills(&self) -> bool {
        self.fill
    }

    /// Without the trend that is not wanted: before holes are filled, which would be tipped with it.
    pub(crate) fn levelled(
        &self,
        measured: MeasuredSurface,
    ) -> Result<MeasuredSurface, SurfaceError> {
        match self.level {
            Some(level) => measured.level(level.into()),
            None => Ok(measured),
        }
    }

    /// Turned upside down if that was asked for.
    pub(crate) fn inverted(&self, surface: Topography) -> Topography {
        if self.invert { surface.invert() } else { surface }
    }
}

/// Rms height of the nodes that were measured \[m\].
fn measured_sq(heights: &DMatrix<f64>) -> Result<f64, SurfaceError> {
    let measured: Vec<f64> = heights.iter().copied().filter(|z| z.is_finite()).collect();
    Ok(HeightMap::new(DMatrix::from_vec(measured.len(), 1, measured))?.rms_height())
}
