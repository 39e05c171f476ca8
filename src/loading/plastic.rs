//! The nodes that have yielded on a path.

use std::sync::Arc;

use crate::convolution::Convolution;
use crate::hardness::Hardness;
use crate::{Boundary, Error, Grid, Problem};

/// A path's hardness, and the nodes that have yielded.
///
/// They carry their hardness H, which is a load on the others. The contact of these is elastic, with the initial gap
/// g + C H under that load.
#[derive(Debug)]
pub(super) struct Plastic {
    hardness: Arc<Hardness>,
    /// The problem of the surface, on which nothing has yielded.
    surface: Arc<Problem>,
    has_yielded: Vec<bool>,
    count: usize,
    /// How many of them yielded in each window: their displacements are sums over windows.
    groups: Vec<usize>,
    /// Sum of the pressures of these nodes \[Pa\].
    sum: f64,
    /// What they displace. The gap of the elastic problem contains it as well, but to rounding of heights.
    displaced: Displaced,
}

/// What nodes that yield displace.
#[derive(Debug)]
pub(super) struct Displaced {
    /// Under their hardness.
    load: Vec<f64>,
    /// Under a pressure of 1.
    unit: Vec<f64>,
}

impl Displaced {
    /// Under their hardness.
    pub(super) fn load(&self) -> &[f64] {
        &self.load
    }
}

impl Plastic {
    /// None yet. Returns the problem of the elastic nodes as well.
    pub(super) fn new(hardness: Hardness, problem: Problem) -> (Self, Problem) {
        let none = Self::none(Arc::new(hardness), Arc::new(problem));
        let elastic = none.elastic(&none.surface, &none.displaced);
        (none, elastic)
    }

    /// None has yielded.
    fn none(hardness: Arc<Hardness>, surface: Arc<Problem>) -> Self {
        let nodes = surface.grid().nodes();
        let nothing = vec![0.0; nodes];
        Self {
            hardness,
            surface,
            has_yielded: vec![false; nodes],
            count: 0,
            groups: Vec::new(),
            sum: 0.0,
            displaced: Displaced { load: nothing.clone(), unit: nothing },
        }
    }

    /// Bytes on a grid.
    pub(super) fn bytes_on(grid: &Grid, boundary: Boundary) -> usize {
        let fields = 9 * size_of::<f64>() + size_of::<bool>();
        grid.nodes() * fields + Convolution::bytes_on(grid, boundary)
    }

    pub(super) fn hardness(&self) -> &Hardness {
        &self.hardness
    }

    /// The problem of the surface, on which nothing has yielded.
    pub(super) fn surface(&self) -> &Problem {
        &self.surface
    }

    /// Number of nodes that have yielded.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// How many of them yielded in each window.
    pub(super) fn groups(&self) -> &[usize] {
        &self.groups
    }

    /// Sum of their pressures \[Pa\].
    pub(super) fn sum(&self) -> f64 {
        self.sum
    }

    pub(super) fn has_yielded(&self, node: usize) -> bool {
        self.has_yielded[node]
    }

    /// Displacement of all nodes under a pressure of 1 on those that have yielded.
    pub(super) fn unit(&self) -> &[f64] {
        &self.displaced.unit
    }

    /// The same under their hardness.
    pub(super) fn load(&self) -> &[f64] {
        &self.displaced.load
    }

    /// What nodes displace when they yield.
    pub(super) fn displaced(&self, nodes: &[usize]) -> Result<Displaced, Error> {
        let hardness = |node: usize| self.hardness.values()[node];
        let displacement = |pressure: &dyn Fn(usize) -> f64| -> Result<Vec<f64>, Error> {
            let mut field = vec![0.0; self.has_yielded.len()];
            for &node in nodes {
                field[node] = pressure(node);
            }
            let mut displaced = vec![0.0; field.len()];
            self.surface.convolution().apply(&field, &mut displaced)?;
            Ok(displaced)
        };
        if nodes.is_empty() {
            let nothing = vec![0.0; self.has_yielded.len()];
            return Ok(Displaced { load: nothing.clone(), unit: nothing });
        }
        let load = displacement(&hardness)?;
        let unit = match self.hardness.uniform() {
            Some(hardness) => load.iter().map(|u| u / hardness).collect(),
            None => displacement(&|_| 1.0)?,
        };
        Ok(Displaced { load, unit })
    }

    /// The problem of the nodes that stay elastic, from the one before.
    pub(super) fn elastic(&self, before: &Problem, displaced: &Displaced) -> Problem {
        before.under_load(&displaced.load, &displaced.unit)
    }

    /// The same after more nodes have yielded.
    pub(super) fn grown(&self, nodes: &[usize], displaced: &Displaced) -> Self {
        let mut has_yielded = self.has_yielded.clone();
        let mut sum = self.sum;
        for &node in nodes {
            has_yielded[node] = true;
            sum += self.hardness.values()[node];
        }
        let add =
            |before: &[f64], more: &[f64]| before.iter().zip(more).map(|(u, v)| u + v).collect();
        let before = &self.displaced;
        Self {
            hardness: Arc::clone(&self.hardness),
            surface: Arc::clone(&self.surface),
            has_yielded,
            count: self.count + nodes.len(),
            groups: [&self.groups[..], &[nodes.len()]].concat(),
            sum,
            displaced: Displaced {
                load: add(&before.load, &displaced.load),
                unit: add(&before.unit, &displaced.unit),
            },
        }
    }

    /// The same when nodes have yielded in groups, one after the other, and the problem of the elastic ones: with the
    /// roundings of a path that went through these groups.
    pub(super) fn after<'a>(
        &self,
        groups: impl Iterator<Item = &'a [usize]>,
    ) -> Result<(Self, Problem), Error> {
        let (mut plastic, mut problem) = self.beside(&[])?;
        for yielded in groups {
            let displaced = plastic.displaced(yielded)?;
            problem = plastic.elastic(&problem, &displaced);
            plastic = plastic.grown(yielded, &displaced);
        }
        Ok((plastic, problem))
    }

    /// The same when these nodes and no others have yielded, and the problem of the elastic ones.
    pub(super) fn beside(&self, yielded: &[usize]) -> Result<(Self, Problem), Error> {
        let displaced = self.displaced(yielded)?;
        let none = Self::none(Arc::clone(&self.hardness), Arc::clone(&self.surface));
        Ok((none.grown(yielded, &displaced), self.elastic(&self.surface, &displaced)))
    }
}
