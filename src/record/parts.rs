//! A record as plain data, for the feature `serde`.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::{KernelRecord, LoadingRecord, Settings};
use crate::loading::{LoadingEnd, LoadingState};
use crate::surface::HeightMap;
use crate::{Error, Grid};

/// The parts of a record.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Parts {
    grid: Grid,
    /// Heights \[m\], x fast.
    heights: Vec<f64>,
    kernel: KernelRecord,
    settings: Settings,
    states: Vec<LoadingState>,
    end: Option<LoadingEnd>,
    #[serde(default)]
    bodies: Vec<(f64, f64)>,
}

impl From<LoadingRecord> for Parts {
    fn from(record: LoadingRecord) -> Self {
        Self {
            grid: record.grid,
            heights: record.heights.into_matrix().data.into(),
            kernel: record.kernel,
            settings: record.settings,
            states: record.history.states().to_vec(),
            end: record.end,
            bodies: record.bodies,
        }
    }
}

impl TryFrom<Parts> for LoadingRecord {
    type Error = Error;

    fn try_from(parts: Parts) -> Result<Self, Error> {
        let grid = parts.grid;
        if parts.heights.len() != grid.nodes() {
            return Err(Error::LengthMismatch {
                expected: grid.nodes(),
                found: parts.heights.len(),
            });
        }
        let heights = HeightMap::new(DMatrix::from_vec(grid.nx(), grid.ny(), parts.heights))?;
        let mut states = parts.states;
        for state in &mut states {
            state.contact.restore_infinity();
        }
        let history = states.into_iter().collect();
        Self::from_parts(grid, heights, parts.kernel, parts.settings, history, parts.end)?
            .with_bodies(&parts.bodies)
    }
}
