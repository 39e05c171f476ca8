//! Fields of a state, for other programs.

use std::path::{Path, PathBuf};

use asperity::contact::ContactFields;
use asperity::io::{write_gsf, write_npy, write_vti};
use asperity::{Grid, SurfaceError};
use clap::ValueEnum;
use nalgebra::DMatrix;

use asperity_cli::outcome::Failure;

/// How fields are written.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum Format {
    /// pressure.npy and gap.npy, for numpy.load: [ix, iy]
    Npy,
    /// pressure.gsf and gap.gsf, for Gwyddion
    Gsf,
    /// fields.vti with both, for ParaView
    Vti,
}

/// The surface that is left behind unloading.
pub(super) const RESIDUAL_SURFACES: [&str; 2] = ["residual_surface.npy", "residual_surface.x3p"];

impl Format {
    /// The files of a state, with an ending of their names.
    pub(super) fn files(self, ending: &str) -> [String; 3] {
        ["pressure", "gap", "plastic_depth"].map(|field| self.file(field, ending))
    }

    /// The file of a field.
    pub(crate) fn file(self, field: &str, ending: &str) -> String {
        match self {
            Self::Npy => format!("{field}{ending}.npy"),
            Self::Gsf => format!("{field}{ending}.gsf"),
            Self::Vti => format!("fields{ending}.vti"),
        }
    }
}

/// Pressure and gap, and with a hardness the plastic depth.
pub(crate) type Fields = Vec<(&'static str, DMatrix<f64>)>;

/// Those of a state that are written.
pub(super) fn of(fields: ContactFields, has_hardness: bool) -> Fields {
    let ContactFields { pressure, gap, plastic_depth, .. } = fields;
    let mut fields = vec![("pressure", pressure), ("gap", gap)];
    if has_hardness {
        fields.push(("plastic_depth", plastic_depth));
    }
    fields
}

/// Writes fields into a directory, with an ending of their names; returns the names of the files.
pub(crate) fn write(
    fields: &Fields,
    grid: &Grid,
    format: Format,
    (directory, ending): (&Path, &str),
) -> Result<Vec<PathBuf>, Failure> {
    let named = |name: PathBuf, written: Result<(), SurfaceError>| {
        written.map(|()| name.clone()).map_err(|error| Failure::writing(&name, error))
    };
    if let Format::Vti = format {
        let name = directory.join(format.file("", ending));
        let all: Vec<_> = fields.iter().map(|(name, field)| (*name, field)).collect();
        let written = write_vti(&name, grid, &all);
        return named(name, written).map(|name| vec![name]);
    }
    let one = |(field, values): &(&str, DMatrix<f64>)| {
        let name = directory.join(format.file(field, ending));
        let unit = if *field == "pressure" { "Pa" } else { "m" };
        let written = match format {
            Format::Gsf => write_gsf(&name, grid, values, unit),
            _ => write_npy(&name, values),
        };
        named(name, written)
    };
    fields.iter().map(one).collect()
}
