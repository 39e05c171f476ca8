//! The greatest pressure that a surface bears.

use nalgebra::DMatrix;

use crate::{ContactGrowth, Error, Grid, KernelError, Problem};

/// The greatest pressure of each node \[Pa\].
///
/// With 0 ≤ p ≤ H the problem stays convex: minimise ½ pᵀCp + pᵀ(g − δ). Nodes that yield carry H, and are a load on
/// the others, whose problem is the elastic one with the initial gap g + C H.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Hardness {
    values: Vec<f64>,
    /// The one of all nodes, if it is the same.
    uniform: Option<f64>,
}

/// What a builder was given.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Limit<'a> {
    None,
    Uniform(f64),
    Map(&'a DMatrix<f64>),
}

impl Limit<'_> {
    /// The hardness of each node; `None` where no pressure is limited.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for a hardness that is not above zero, [`Error::GridMismatch`] for a map of another grid,
    /// and [`KernelError::GrowthUnknown`] for a kernel that does not promise that contact grows.
    pub(crate) fn resolve(self, problem: &Problem) -> Result<Option<Hardness>, Error> {
        let grid = problem.grid();
        let values = match self {
            Self::None => return Ok(None),
            Self::Uniform(hardness) => vec![hardness; grid.nodes()],
            Self::Map(map) => {
                grid.check_shape(map.shape())?;
                map.as_slice().to_vec()
            }
        };
        for &value in &values {
            // Infinity limits nothing.
            if value.is_nan() || value <= 0.0 {
                return Err(Error::NotPositive { quantity: "hardness", value });
            }
        }
        if values.iter().all(|value| value.is_infinite()) {
            return Ok(None);
        }
        if problem.growth() == ContactGrowth::Unknown {
            return Err(Error::Kernel(KernelError::GrowthUnknown));
        }
        let uniform = values.first().copied().filter(|h| values.iter().all(|value| value == h));
        Ok(Some(Hardness { values, uniform }))
    }
}

impl Hardness {
    /// The hardness of each node.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    /// The one of all nodes, if it is the same.
    pub(crate) fn uniform(&self) -> Option<f64> {
        self.uniform
    }

    /// `Ok` for a load \[N\] under which not all nodes yield.
    ///
    /// # Errors
    ///
    /// [`Error::BeyondHardness`].
    pub(crate) fn check(&self, load: f64, grid: &Grid) -> Result<(), Error> {
        let greatest = self.greatest_load(grid);
        if load < greatest {
            return Ok(());
        }
        let over_area = |load: f64| load / grid.nominal_area();
        Err(Error::BeyondHardness {
            load,
            mean_pressure: over_area(load),
            hardness: over_area(greatest),
        })
    }

    /// The load \[N\] under which all nodes yield.
    pub(crate) fn greatest_load(&self, grid: &Grid) -> f64 {
        self.values.iter().sum::<f64>() * grid.cell_area()
    }
}
