//! Which format a file has.

use std::fmt;
use std::path::Path;

use super::raw::Parsed;
use super::text::TextLayout;
use super::{al3d, gsf, gwy, npy, sdf, sur, text, vk4, x3p};

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
    /// Digital Surf, `.sur`.
    DigitalSurf,
    /// Alicona, `.al3d`.
    Alicona,
    /// Keyence, `.vk4`.
    Keyence,
    /// Rows of numbers, or lists of points.
    Text,
}

/// What decides what the bytes of a text leave open.
pub(super) struct Besides<'a> {
    pub(super) path: &'a Path,
    pub(super) layout: Option<TextLayout>,
}

/// Finds all maps in a file.
type Parse = fn(&[u8], &Besides<'_>) -> Parsed;

impl Format {
    const ALL: [Self; 9] = [
        Self::Npy,
        Self::GwyddionSimpleField,
        Self::Gwyddion,
        Self::Sdf,
        Self::X3p,
        Self::DigitalSurf,
        Self::Alicona,
        Self::Keyence,
        Self::Text,
    ];

    /// Name, how its files begin, and reader.
    fn known(self) -> (&'static str, &'static [&'static [u8]], Parse) {
        match self {
            Self::Npy => ("NumPy", &[b"\x93NUMPY"], |file, _| npy::parse(file)),
            Self::GwyddionSimpleField => {
                ("Gwyddion Simple Field", &[b"Gwyddion Simple Field 1.0\n"], |file, _| {
                    gsf::parse(file)
                })
            }
            Self::Gwyddion => ("Gwyddion", &[b"GWYP"], |file, _| gwy::parse(file)),
            Self::Sdf => ("SDF", sdf::BEGINS, |file, _| sdf::parse(file)),
            Self::X3p => ("X3P", &[b"PK\x03\x04"], |file, _| x3p::parse(file)),
            Self::DigitalSurf => {
                ("Digital Surf", &[b"DIGITAL SURF", b"DSCOMPRESSED"], |file, _| sur::parse(file))
            }
            Self::Alicona => ("Alicona", &[b"AliconaImaging\0"], |file, _| al3d::parse(file)),
            Self::Keyence => ("Keyence VK4", &[b"VK4_"], |file, _| vk4::parse(file)),
            Self::Text => {
                ("text", &[], |file, besides| text::parse(file, besides.path, besides.layout))
            }
        }
    }

    /// The format of a file with these bytes: by how it begins, and text if nothing else.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        let is_it = |format: &Self| format.known().1.iter().any(|begin| bytes.starts_with(begin));
        let text = || text::looks_like(bytes).then_some(Self::Text);
        Self::ALL.into_iter().find(is_it).or_else(text)
    }

    /// All maps in a file of this format.
    pub(super) fn parse(self, bytes: &[u8], besides: &Besides<'_>) -> Parsed {
        self.known().2(bytes, besides)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.known().0
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
