//! Which format a file has.

use std::fmt;
use std::path::Path;

use super::raw::Parsed;
use super::text::TextLayout;
use super::{
    al3d, gsf, gwy, ibw, metropro, mnt, nanoscope, nid, npy, opd, opdx, plu, prf, sdf, sur, text,
    vk4, x3p,
};

/// A format of files with heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// NumPy, `.npy`.
    Npy,
    /// Gwyddion Simple Field, `.gsf`.
    GwyddionSimpleField,
    /// Gwyddion's own, `.gwy`.
    Gwyddion,
    /// ISO 25178-71 and its ancestor BCR, `.sdf`.
    Sdf,
    /// ISO 25178-72, `.x3p`.
    X3p,
    /// Digital Surf, `.sur`, `.pro`.
    DigitalSurf,
    /// Documents of Digital Surf's Mountains, `.mnt`.
    Mountains,
    /// Alicona, `.al3d`.
    Alicona,
    /// Keyence, `.vk4`, `.vk6`, `.vk7`.
    Keyence,
    /// Bruker's and Veeco's Nanoscope, `.spm`, `.di`, `.000`.
    Nanoscope,
    /// Igor's binary waves, as Asylum Research writes them, `.ibw`.
    Igor,
    /// Nanosurf, `.nid`.
    Nanosurf,
    /// Wyko's and Veeco's Vision, `.opd`.
    Wyko,
    /// Bruker's Vision64 and Dektak, `.opdx`.
    Vision64,
    /// Zygo's MetroPro, `.dat`.
    MetroPro,
    /// Sensofar, `.plu`.
    Sensofar,
    /// Profiles of ISO 5436-2 of 2001 and of the National Physical Laboratory, `.smd`, `.prf`.
    Profile,
    /// Rows of numbers, or lists of points.
    Text,
}

/// What decides what the bytes of a text leave open.
pub(super) struct Besides<'a> {
    pub(super) path: &'a Path,
    pub(super) layout: Option<TextLayout>,
}

/// What is known of a format.
struct Known {
    name: &'static str,
    endings: &'static [&'static str],
    /// Whether a file is one.
    is_it: fn(&[u8]) -> bool,
    /// Finds all maps in a file.
    parse: fn(&[u8], &Besides<'_>) -> Parsed,
}

/// Whether bytes begin with any of these.
fn begins(file: &[u8], with: &[&[u8]]) -> bool {
    with.iter().any(|begin| file.starts_with(begin))
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 18] = [
        Self::Npy,
        Self::GwyddionSimpleField,
        Self::Gwyddion,
        Self::Sdf,
        Self::X3p,
        Self::DigitalSurf,
        Self::Mountains,
        Self::Alicona,
        Self::Keyence,
        Self::Nanoscope,
        Self::Igor,
        Self::Nanosurf,
        Self::Wyko,
        Self::Vision64,
        Self::MetroPro,
        Self::Sensofar,
        Self::Profile,
        Self::Text,
    ];

    fn known(self) -> Known {
        match self {
            Self::Npy => Known {
                name: "NumPy",
                endings: &["npy"],
                is_it: |file| begins(file, &[b"\x93NUMPY"]),
                parse: |file, _| npy::parse(file),
            },
            Self::GwyddionSimpleField => Known {
                name: "Gwyddion Simple Field",
                endings: &["gsf"],
                is_it: |file| begins(file, &[b"Gwyddion Simple Field 1.0\n"]),
                parse: |file, _| gsf::parse(file),
            },
            Self::Gwyddion => Known {
                name: "Gwyddion",
                endings: &["gwy"],
                is_it: |file| begins(file, &[b"GWYP"]),
                parse: |file, _| gwy::parse(file),
            },
            Self::Sdf => Known {
                name: "SDF",
                endings: &["sdf"],
                is_it: |file| begins(file, sdf::BEGINS),
                parse: |file, _| sdf::parse(file),
            },
            Self::X3p => Known {
                name: "X3P",
                endings: &["x3p"],
                is_it: |file| begins(file, &[b"PK\x03\x04"]),
                parse: |file, _| x3p::parse(file),
            },
            Self::DigitalSurf => Known {
                name: "Digital Surf",
                endings: &["sur", "pro"],
                is_it: |file| begins(file, sur::BEGINS),
                parse: |file, _| sur::parse(file),
            },
            Self::Mountains => Known {
                name: "Mountains",
                endings: &["mnt"],
                is_it: |file| begins(file, &[mnt::BEGINS]),
                parse: |file, _| mnt::parse(file),
            },
            Self::Alicona => Known {
                name: "Alicona",
                endings: &["al3d"],
                is_it: |file| begins(file, &[b"AliconaImaging\0"]),
                parse: |file, _| al3d::parse(file),
            },
            Self::Keyence => Known {
                name: "Keyence",
                endings: &["vk4", "vk6", "vk7"],
                is_it: |file| begins(file, vk4::BEGINS),
                parse: |file, _| vk4::parse(file),
            },
            Self::Nanoscope => Known {
                name: "Nanoscope",
                endings: &["spm", "di", "000"],
                is_it: |file| begins(file, nanoscope::BEGINS),
                parse: |file, _| nanoscope::parse(file),
            },
            Self::Igor => Known {
                name: "Igor",
                endings: &["ibw"],
                is_it: ibw::looks_like,
                parse: |file, _| ibw::parse(file),
            },
            Self::Nanosurf => Known {
                name: "Nanosurf",
                endings: &["nid"],
                is_it: |file| begins(file, &[nid::BEGINS]),
                parse: |file, _| nid::parse(file),
            },
            Self::Wyko => Known {
                name: "Wyko",
                endings: &["opd"],
                is_it: |file| begins(file, &[opd::BEGINS]),
                parse: |file, _| opd::parse(file),
            },
            Self::Vision64 => Known {
                name: "Vision64",
                endings: &["opdx"],
                is_it: |file| begins(file, &[opdx::BEGINS]),
                parse: |file, _| opdx::parse(file),
            },
            Self::MetroPro => Known {
                name: "MetroPro",
                endings: &["dat"],
                is_it: |file| begins(file, metropro::BEGINS),
                parse: |file, _| metropro::parse(file),
            },
            Self::Sensofar => Known {
                name: "Sensofar",
                endings: &["plu"],
                is_it: plu::looks_like,
                parse: |file, _| plu::parse(file),
            },
            Self::Profile => Known {
                name: "ISO 5436-2",
                endings: &["smd", "prf"],
                is_it: prf::looks_like,
                parse: |file, _| prf::parse(file),
            },
            Self::Text => Known {
                name: "text",
                endings: &["txt", "asc", "csv", "xyz"],
                is_it: text::looks_like,
                parse: |file, besides| text::parse(file, besides.path, besides.layout),
            },
        }
    }

    /// The format of a file with these bytes.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        Self::ALL.into_iter().find(|format| (format.known().is_it)(bytes))
    }

    /// All maps in a file of this format.
    pub(super) fn parse(self, bytes: &[u8], besides: &Besides<'_>) -> Parsed {
        (self.known().parse)(bytes, besides)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.known().name
    }

    /// What names of its files end with. A file is known by its content all the same.
    #[must_use]
    pub fn endings(self) -> &'static [&'static str] {
        self.known().endings
    }
}

/// What a file is that begins like one of a format that is not read, and what to do with it.
pub(super) fn not_read(bytes: &[u8]) -> &'static str {
    let known: [(&[u8], &str); 3] = [
        (b"\x89HDF", "; it is an HDF5 file, as .datx: export it as .x3p, .sdf or text"),
        (b"CDF", "; it is a NetCDF file: export it as .npy or text"),
        (b"II*\0", "; it is a TIFF picture: export heights as .x3p, .sdf or text"),
    ];
    known.into_iter().find(|(begin, _)| bytes.starts_with(begin)).map_or("", |(_, what)| what)
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
