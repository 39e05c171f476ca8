//! Files of heights and other fields.
//!
//! [`read_surface`] reads what instruments write, from files, and [`ReadOptions::read_bytes`] from bytes.
//! [`ReadOptions`] says what a file leaves open (its side, its unit, which of several maps), and [`MeasuredSurface`] is
//! what was found. [`write_npy`], [`write_gsf`], [`write_x3p`] and [`write_vti`] pass fields on, and [`write_whole`]
//! takes care of files that a program writes itself.
//!
//! | format | extension | read | written |
//! |---|---|---|---|
//! | NumPy | `.npy` | floating-point numbers and integers | float64 |
//! | Gwyddion Simple Field | `.gsf` | float32 | float32 |
//! | Gwyddion | `.gwy` | all maps, masks | |
//! | ISO 25178-71 and BCR | `.sdf` | ASCII and binary, 1.0 and 2.0, profiles | |
//! | ISO 25178-72 | `.x3p` | all four types of number, missing points, profiles | float64 |
//! | Digital Surf | `.sur`, `.pro` | plain and compressed, profiles; of a surface with colours, the surface | |
//! | Mountains (Digital Surf) | `.mnt` | the surfaces in a document | |
//! | Alicona | `.al3d` | depth image | |
//! | Keyence | `.vk4`, `.vk6`, `.vk7` | height images | |
//! | Nanoscope (Bruker, Veeco) | `.spm`, `.di`, `.000` | all images | |
//! | Igor (Asylum Research) | `.ibw` | all layers of a wave of version 5 | |
//! | Nanosurf | `.nid` | all images | |
//! | Wyko (Vision) | `.opd` | heights | |
//! | Vision64, Dektak | `.opdx` | maps and profiles | |
//! | MetroPro (Zygo) | `.dat` | heights | |
//! | Sensofar | `.plu` | heights | |
//! | ISO 5436-2 of 2001, NPL | `.smd`, `.prf` | profiles | |
//! | text | `.txt`, `.asc`, `.csv`, `.xyz` | matrices, and lists of points | |
//!
//! A file is known by its first bytes, not by its name.
//!
//! # Which index is x
//!
//! Everywhere in this crate x is the first index, `[(ix, iy)]`. In all formats but `.npy` the rows of the file are
//! those of an image: row `iy`, and within it column `ix`. Rows are turned round in Nanoscope, Igor, Nanosurf and Wyko
//! alone, which have them from below; other formats differ, so that two surfaces which face each other have to be of one
//! format:
//!
//! ```text
//!   the file (an image)               the matrix                on the half-space
//!
//!        ix → 0   1   2               [(ix, iy)]                 y
//!   iy   0   a   b   c                [(0,0)] = a                ↑  d  e  f
//!   ↓    1   d   e   f                [(2,0)] = c                |  a  b  c
//!                                     [(0,1)] = d                └────────→ x
//! ```
//!
//! An array in a `.npy` file is taken as it is: `array[ix, iy]`. An image in NumPy, `image[row, column]`, has to be
//! transposed before it is saved. Formats differ in whether their first row is the top or the bottom of the surface:
//! maps may therefore look mirrored beside another program, which changes no result of an isotropic half-space.
//!
//! # Text
//!
//! Numbers may be parted by blanks, tabs, `;` or commas, with decimal points or commas. Empty cells, `NaN`, `BAD`,
//! `***` and the like are missing, and so are -9999 and other numbers that programs write for it, if they are far
//! outside of all heights. The header that Gwyddion writes gives sides, units and name; without one, the options have
//! to.
//!
//! A list has a point x, y, z in each row, in any order. The points have to lie on a regular grid, from which some may
//! be absent: they are missing. A list is known by names of its columns, `x y z`, perhaps with units, `x (µm)`, by the
//! extension `.xyz`, or by coordinates that are those of most of a grid. Positions in the first row or column of a
//! matrix are known by even steps. Where numbers can be read in several ways, [`TextLayout`] says which is meant;
//! [`MeasuredSurface::understood`] tells how a text was read.
//!
//! # What a file may ask for
//!
//! Sizes are compared with the length of the file before memory is taken. A member of an archive (X3P) may be at most
//! 256 times as long as the archive, and a list of points needs a sixteenth of the nodes of its grid.

#[macro_use]
mod fault;
mod bytes;
mod npy;
mod number;
mod vti;
mod whole_file;

#[cfg(feature = "io")]
mod al3d;
#[cfg(feature = "io")]
#[doc(hidden)]
pub mod archive;
#[cfg(feature = "io")]
mod compound;
#[cfg(feature = "io")]
mod format;
#[cfg(all(test, feature = "io"))]
mod full_disk;
#[cfg(feature = "io")]
mod gsf;
#[cfg(feature = "io")]
mod gwy;
#[cfg(feature = "io")]
mod ibw;
#[cfg(feature = "io")]
mod lines;
#[cfg(feature = "io")]
mod measured;
#[cfg(feature = "io")]
mod metropro;
#[cfg(feature = "io")]
mod mnt;
#[cfg(feature = "io")]
mod nanoscope;
#[cfg(feature = "io")]
mod nid;
#[cfg(feature = "io")]
mod opd;
#[cfg(feature = "io")]
mod opdx;
#[cfg(feature = "io")]
mod options;
#[cfg(feature = "io")]
mod output;
#[cfg(feature = "io")]
mod plu;
#[cfg(feature = "io")]
mod prf;
#[cfg(feature = "io")]
mod profile;
#[cfg(feature = "io")]
mod raw;
#[cfg(feature = "io")]
mod sdf;
#[cfg(feature = "io")]
mod sections;
#[cfg(feature = "io")]
mod sur;
#[cfg(all(test, feature = "io"))]
mod testing;
#[cfg(feature = "io")]
mod text;

#[cfg(feature = "io")]
mod unit;
#[cfg(feature = "io")]
mod vk4;
#[cfg(feature = "io")]
mod x3p;

pub use npy::{read_npy, read_npy_from, write_npy};
pub use vti::write_vti;
pub use whole_file::write_whole;

#[cfg(feature = "io")]
pub use self::{
    format::Format,
    gsf::write_gsf,
    measured::MeasuredSurface,
    options::{ReadOptions, channels, read_surface},
    text::TextLayout,
    unit::LengthUnit,
    x3p::write_x3p,
};
