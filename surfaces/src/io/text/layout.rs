//! How the numbers of a text may be arranged, as the user says.

use std::fmt;
use std::str::FromStr;

use super::table::Table;
use crate::number::counted;
use crate::{Error, FileError};

/// How the numbers of a text are arranged, where it does not say so itself.
///
/// ```
/// use asperity_surfaces::io::TextLayout;
///
/// # fn main() -> Result<(), asperity_surfaces::Error> {
/// let layout: TextLayout = "x-row".parse()?;
/// assert_eq!(layout, TextLayout::RowOfX);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TextLayout {
    /// Heights and nothing else, `matrix`.
    Matrix,
    /// Positions along x in the first row, and heights below, `x-row`.
    RowOfX,
    /// Positions along y in the first column, and heights beside it, `y-column`.
    ColumnOfY,
    /// Both, with a corner that means nothing, `axes`.
    Axes,
    /// A point x, y, z in each row, `points`.
    Points,
}

impl TextLayout {
    /// All there are.
    pub const ALL: [Self; 5] =
        [Self::Matrix, Self::RowOfX, Self::ColumnOfY, Self::Axes, Self::Points];

    /// How it is called.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Matrix => "matrix",
            Self::RowOfX => "x-row",
            Self::ColumnOfY => "y-column",
            Self::Axes => "axes",
            Self::Points => "points",
        }
    }

    /// Whether the first row, and the first column, are no heights.
    pub(super) fn positions(self) -> (bool, bool) {
        (matches!(self, Self::RowOfX | Self::Axes), matches!(self, Self::ColumnOfY | Self::Axes))
    }

    /// What a table is in this layout.
    pub(super) fn told(self, table: &Table) -> String {
        let (columns, rows) = (table.columns, table.rows());
        let (along_x, along_y) = self.positions();
        let heights = format!(
            "{} of {}",
            counted(rows - usize::from(along_x), "row"),
            counted(columns - usize::from(along_y), "height")
        );
        let what = match self {
            Self::Matrix => heights,
            Self::RowOfX => format!("{heights} below a row of positions along x"),
            Self::ColumnOfY => format!("{heights} beside a column of positions along y"),
            Self::Axes => format!("{heights} below a row and beside a column of positions"),
            Self::Points => counted(rows, "point"),
        };
        format!("'{}', {what}", self.name())
    }
}

impl FromStr for TextLayout {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let found = Self::ALL.into_iter().find(|layout| layout.name() == text);
        found.ok_or_else(|| FileError::NoLayout { layout: text.to_string() }.into())
    }
}

impl fmt::Display for TextLayout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
