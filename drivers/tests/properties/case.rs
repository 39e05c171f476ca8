//! Random surfaces on every body of the library.

use asperity::surface::HeightMap;
use asperity::updater::{LinearUpdater, RecursiveCholesky};
use asperity::{
    Boussinesq, Error, Grid, InfluenceKernel, LoadingSolver, LoadingState, PeriodicBoussinesq,
    Spectral,
};
use nalgebra::DMatrix;
use proptest::prelude::*;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Body {
    Free,
    Periodic,
    Spectral,
}

/// A surface on a body.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    pub(crate) body: Body,
    pub(crate) nodes: (usize, usize),
    pub(crate) cell: (f64, f64),
    pub(crate) e_star: f64,
    /// By node.
    pub(crate) heights: Vec<f64>,
}

pub(crate) fn case() -> impl Strategy<Value = Case> {
    let body = prop::sample::select(vec![Body::Free, Body::Periodic, Body::Spectral]);
    let nodes = prop_oneof![
        4 => (1_usize..=10, 1_usize..=10),
        1 => (Just(1), 1_usize..=40),
        1 => (1_usize..=40, Just(1)),
    ];
    let aspect = prop_oneof![Just(1.0), 0.2..5.0];
    (body, nodes, aspect).prop_flat_map(|(body, nodes, aspect)| {
        let levels = prop_oneof![
            // Noise, without a tie.
            3 => Just(None),
            // A few levels: many nodes touch together.
            1 => (2_u32..8).prop_map(Some),
        ];
        let heights = prop::collection::vec(0.0..1.0, nodes.0 * nodes.1);
        (levels, heights).prop_map(move |(levels, heights): (Option<u32>, Vec<f64>)| Case {
            body,
            nodes,
            cell: (1e-3, 1e-3 * aspect),
            e_star: 1e9,
            heights: match levels {
                None => heights.iter().map(|height| 1e-5 * height).collect(),
                Some(levels) => {
                    let levels = f64::from(levels);
                    let steps = heights.iter().map(|height| (levels * height).floor());
                    steps.map(|step| 1e-5 * step / levels).collect()
                }
            },
        })
    })
}

impl Case {
    pub(crate) fn grid(&self) -> Result<Grid, Error> {
        Ok(Grid::new(self.nodes.0, self.nodes.1, self.cell.0, self.cell.1)?)
    }

    pub(crate) fn matrix(&self) -> DMatrix<f64> {
        DMatrix::from_column_slice(self.nodes.0, self.nodes.1, &self.heights)
    }

    pub(crate) fn surface(&self) -> Result<HeightMap, Error> {
        Ok(HeightMap::new(self.matrix())?)
    }

    pub(crate) fn kernel(&self) -> Result<Box<dyn InfluenceKernel + Send + Sync>, Error> {
        let grid = self.grid()?;
        Ok(match self.body {
            Body::Free => Box::new(Boussinesq::new(grid, self.e_star)?),
            Body::Periodic => Box::new(PeriodicBoussinesq::new(grid, self.e_star)?),
            Body::Spectral => Box::new(Spectral::new(grid, self.e_star)?),
        })
    }

    /// The path with an updater and, if that is given, windows of so many nodes.
    pub(crate) fn path<U: LinearUpdater>(
        &self,
        updater: U,
        window: Option<usize>,
    ) -> Result<Vec<LoadingState>, Error> {
        let (surface, kernel) = (self.surface()?, self.kernel()?);
        let builder = LoadingSolver::builder(&surface, &kernel).updater(updater);
        let builder = match window {
            Some(nodes) => builder.window_size(nodes),
            None => builder,
        };
        builder.build()?.collect()
    }

    pub(crate) fn states(&self) -> Result<Vec<LoadingState>, Error> {
        self.path(RecursiveCholesky::new(), None)
    }

    /// The same surface seen with other axes: node (ix, iy) of it is `place(ix, iy)` of this one.
    pub(crate) fn seen(
        &self,
        nodes: (usize, usize),
        cell: (f64, f64),
        place: impl Fn(usize, usize) -> (usize, usize),
    ) -> Self {
        let matrix = self.matrix();
        let heights = DMatrix::from_fn(nodes.0, nodes.1, |ix, iy| matrix[place(ix, iy)]);
        Self { nodes, cell, heights: heights.as_slice().to_vec(), ..self.clone() }
    }
}

pub(crate) fn failed(error: Error) -> TestCaseError {
    TestCaseError::fail(error.to_string())
}
