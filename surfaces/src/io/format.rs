//! Which format a file has.

use std::fmt;
use std::path::Path;

use super::raw::Parsed;
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

impl Format {
    /// The format of a file with these bytes: by how it begins, and text if nothing else.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        const MAGIC: [(&[u8], Format); 16] = [
            (b"\x93NUMPY", Format::Npy),
            (b"Gwyddion Simple Field 1.0\n", Format::GwyddionSimpleField),
            (b"GWYP", Format::Gwyddion),
            (b"aISO-1.0", Format::Sdf),
            (b"bISO-1.0", Format::Sdf),
            (b"aISO-2.0", Format::Sdf),
            (b"bISO-2.0", Format::Sdf),
            (b"aBCR-", Format::Sdf),
            (b"bBCR-", Format::Sdf),
            (b"ABCR-", Format::Sdf),
            (b"BBCR-", Format::Sdf),
            (b"PK\x03\x04", Format::X3p),
            (b"DIGITAL SURF", Format::DigitalSurf),
            (b"DSCOMPRESSED", Format::DigitalSurf),
            (b"AliconaImaging\0", Format::Alicona),
            (b"VK4_", Format::Keyence),
        ];
        MAGIC
            .iter()
            .find(|(magic, _)| bytes.starts_with(magic))
            .map(|(_, format)| *format)
            .or_else(|| text::looks_like(bytes).then_some(Self::Text))
    }

    /// All maps in a file of this format; its name decides only what its bytes leave open.
    pub(super) fn parse(self, bytes: &[u8], path: &Path) -> Parsed {
        match self {
            Self::Npy => npy::parse(bytes).map(|channel| vec![channel]),
            Self::GwyddionSimpleField => gsf::parse(bytes),
            Self::Gwyddion => gwy::parse(bytes),
            Self::Sdf => sdf::parse(bytes),
            Self::X3p => x3p::parse(bytes),
            Self::DigitalSurf => sur::parse(bytes),
            Self::Alicona => al3d::parse(bytes),
            Self::Keyence => vk4::parse(bytes),
            Self::Text => text::parse(bytes, path),
        }
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Npy => "NumPy",
            Self::GwyddionSimpleField => "Gwyddion Simple Field",
            Self::Gwyddion => "Gwyddion",
            Self::Sdf => "SDF",
            Self::X3p => "X3P",
            Self::DigitalSurf => "Digital Surf",
            Self::Alicona => "Alicona",
            Self::Keyence => "Keyence VK4",
            Self::Text => "text",
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
