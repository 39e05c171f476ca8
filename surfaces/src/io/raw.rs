//! What a reader finds in a file, before units and options are applied.

use nalgebra::DMatrix;

use super::fault::Fault;

/// One map of a file, in the file's own units.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Channel {
    /// Its name, or an empty text where the format has none.
    pub(super) name: String,
    /// Nodes along x and y.
    pub(super) shape: (usize, usize),
    /// Value of node (ix, iy) at `ix + nx * iy`, NaN where it is missing.
    pub(super) values: Vec<f64>,
    /// Unit of the values as the file writes it, `None` where it has none.
    pub(super) height_unit: Option<String>,
    /// What the values have to be multiplied by to be in that unit.
    pub(super) factor: f64,
    /// Cell along x and y.
    pub(super) cell: Option<(f64, f64)>,
    /// Unit of the cell as the file writes it, `None` where it has none.
    pub(super) lateral_unit: Option<String>,
    /// Nodes that somebody marked in the file, in the order of the values.
    pub(super) mask: Option<Vec<bool>>,
    /// How the file was understood, where its format leaves that open.
    pub(super) understood: String,
    /// What the user should know of a side that is given in place of that of the file.
    pub(super) note_of_side: Option<String>,
    /// What the user should know: a checksum that does not match, a header that contradicts itself.
    pub(super) notes: Vec<String>,
}

impl Channel {
    /// A map without a name, in metres.
    pub(super) fn in_metres(
        shape: (usize, usize),
        values: Vec<f64>,
        cell: Option<(f64, f64)>,
    ) -> Self {
        Self {
            name: String::new(),
            shape,
            values,
            height_unit: Some("m".to_string()),
            factor: 1.0,
            cell,
            lateral_unit: Some("m".to_string()),
            mask: None,
            understood: String::new(),
            note_of_side: None,
            notes: Vec::new(),
        }
    }
}

impl Channel {
    /// The map of an array whose first index is y, which has neither cell nor mask.
    pub(super) fn transposed(self) -> Self {
        let (nx, ny) = self.shape;
        let values = DMatrix::from_vec(nx, ny, self.values).transpose();
        Self { shape: (ny, nx), values: values.data.into(), ..self }
    }

    /// The map of a file whose first row is the lowest of the image.
    pub(super) fn turned(mut self) -> Self {
        let (nx, ny) = self.shape;
        let mut rows = self.values.as_mut_slice();
        for _ in 0..ny / 2 {
            let (first, rest) = rows.split_at_mut(nx);
            let (between, last) = rest.split_at_mut(rest.len() - nx);
            first.swap_with_slice(last);
            rows = between;
        }
        self
    }
}

/// What a reader makes of the bytes of a file: all maps in it.
pub(super) type Parsed = Result<Vec<Channel>, Fault>;
