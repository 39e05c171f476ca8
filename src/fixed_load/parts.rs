//! A solution as plain data, for the feature `serde`.

use nalgebra::{DMatrix, Scalar};
use serde::{Deserialize, Serialize};

use super::{FixedLoadSolution, SolverEffort};
use crate::Error;
use crate::contact::{Certificate, ContactState};

/// What a solution consists of; fields have x fast.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Parts {
    /// Nodes along x and y.
    shape: (usize, usize),
    state: ContactState,
    pressure: Vec<f64>,
    gap: Vec<f64>,
    displacement: Vec<f64>,
    contact_map: Vec<bool>,
    /// Empty if stiffnesses were not asked for.
    pressure_rate: Vec<f64>,
    certificate: Certificate,
    effort: SolverEffort,
}

impl From<FixedLoadSolution> for Parts {
    fn from(solution: FixedLoadSolution) -> Self {
        Self {
            shape: solution.pressure.shape(),
            state: solution.state,
            pressure: solution.pressure.data.into(),
            gap: solution.gap.data.into(),
            displacement: solution.displacement.data.into(),
            contact_map: solution.contact_map.data.into(),
            pressure_rate: solution.pressure_rate.data.into(),
            certificate: solution.certificate,
            effort: solution.effort,
        }
    }
}

impl TryFrom<Parts> for FixedLoadSolution {
    type Error = Error;

    fn try_from(parts: Parts) -> Result<Self, Error> {
        let (nx, ny) = parts.shape;
        if nx == 0 || ny == 0 {
            return Err(crate::SurfaceError::EmptyGrid { nx, ny }.into());
        }
        let mut state = parts.state;
        let pressure_rate = if parts.pressure_rate.is_empty() {
            DMatrix::zeros(0, 0)
        } else {
            state.restore_infinity();
            matrix(parts.shape, parts.pressure_rate)?
        };
        Ok(Self {
            state,
            pressure: matrix(parts.shape, parts.pressure)?,
            gap: matrix(parts.shape, parts.gap)?,
            displacement: matrix(parts.shape, parts.displacement)?,
            contact_map: matrix(parts.shape, parts.contact_map)?,
            pressure_rate,
            certificate: parts.certificate,
            effort: parts.effort,
        })
    }
}

/// A field of one value for each node.
fn matrix<T: Scalar>((nx, ny): (usize, usize), values: Vec<T>) -> Result<DMatrix<T>, Error> {
    let expected = nx.saturating_mul(ny);
    if values.len() != expected {
        return Err(Error::LengthMismatch {
            expected,
            found: values.len(),
        });
    }
    Ok(DMatrix::from_vec(nx, ny, values))
}
