//! The patches of one contact: where each is, how large, and what it carries.

use nalgebra::DMatrix;

use super::forest::Forest;
use super::lattice::{Lattice, place};
use super::{Connectivity, Perimeter};
use crate::surface::Axis;
use crate::{Boundary, Error, Grid};

/// The shape of a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Patch {
    /// Number of nodes.
    pub nodes: usize,
    /// Area \[m²\], counted in cells.
    pub area: f64,
    /// Centre of its area (x, y) \[m\], between 0 and the sides of the grid. A patch across a periodic
    /// border is put together before; one that goes on without end along a direction has no centre along it, and
    /// NaN stands there.
    pub centroid: (f64, f64),
    /// Its perimeter.
    pub perimeter: Perimeter,
    /// Whether it goes on without end along x and along y, around a periodic boundary.
    pub wraps: (bool, bool),
}

/// The load on a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PatchLoad {
    /// Load $`\Delta A \sum p`$ \[N\].
    pub load: f64,
    /// Mean pressure \[Pa\], load over area.
    pub mean_pressure: f64,
    /// Greatest pressure \[Pa\].
    pub max_pressure: f64,
}

/// The patches of a contact at one state, of a path or of a solution for one load.
///
/// ```
/// use asperity::patches::{Connectivity, Patches};
/// use asperity::{Boussinesq, FixedLoadSolver, Grid, InfluenceKernel, SelfAffine};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
/// let solved = FixedLoadSolver::new(&SelfAffine::zhang2020(1), &half_space)?.solve(100.0)?;
/// let (grid, boundary) = (half_space.grid(), half_space.boundary());
/// let patches = Patches::new(&solved.fields.contact_map, &grid, boundary, Connectivity::Eight)?;
/// let loads = patches.loads(&solved.fields.pressure)?;
/// for (patch, carried) in patches.patches().iter().zip(&loads) {
///     println!("{} nodes carry {} N", patch.nodes, carried.load);
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Patches {
    grid: Grid,
    labels: DMatrix<usize>,
    patches: Vec<Patch>,
}

/// A patch as its nodes come together.
#[derive(Debug, Clone, Copy, Default)]
struct Gathered {
    nodes: usize,
    /// Sums of the indices along x and y, with whole periods added. At most 2³⁰ nodes, each within 2¹⁵ + 1 periods of
    /// 2¹⁵.
    indices: [i64; 2],
    perimeter: Perimeter,
}

impl Patches {
    /// The patches of the nodes that a map shows in contact.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if the map has another shape than the grid.
    pub fn new(
        contact_map: &DMatrix<bool>,
        grid: &Grid,
        boundary: Boundary,
        connectivity: Connectivity,
    ) -> Result<Self, Error> {
        grid.check_shape(contact_map.shape())?;
        let lattice = Lattice::new(*grid, boundary, connectivity);
        let mut forest = Forest::new(lattice);
        let in_contact = contact_map.as_slice();
        let nodes = in_contact.iter().enumerate();
        let nodes = nodes.filter_map(|(node, is_in)| is_in.then_some(node));
        for node in nodes.clone() {
            forest.add(node);
        }
        let (nx, ny) = grid.shape();
        let mut labels = DMatrix::zeros(nx, ny);
        let mut label_of = vec![0; grid.nodes()];
        let (mut gathered, mut roots): (Vec<Gathered>, Vec<usize>) = (Vec::new(), Vec::new());
        for node in nodes {
            let (root, winding) = forest.find(node);
            if label_of[root] == 0 {
                gathered.push(Gathered::default());
                roots.push(root);
                label_of[root] = gathered.len();
            }
            let label = label_of[root];
            labels.as_mut_slice()[node] = label;
            let patch = &mut gathered[label - 1];
            patch.nodes += 1;
            let (at, sides) = (lattice.coordinates(node), [nx, ny]);
            for k in 0..2 {
                patch.indices[k] += at[k] as i64 + i64::from(winding[k]) * sides[k] as i64;
            }
            let is_edge = |other: usize| isize::from(!in_contact[other]);
            patch.perimeter.add(&lattice, node, 1, is_edge);
        }
        let patches = gathered.iter().zip(roots).map(|(patch, root)| {
            let mut wraps = |axis| lattice.wraps(axis) && forest.percolates(root, axis);
            patch.finish(grid, (wraps(Axis::X), wraps(Axis::Y)))
        });
        Ok(Self { grid: *grid, patches: patches.collect(), labels })
    }

    /// The patches, in the order of their first nodes in storage: x runs fastest.
    #[must_use]
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// For every node the number of its patch, from 1 on, or 0 out of contact: patch k is
    /// `patches()[k - 1]`.
    #[must_use]
    pub fn labels(&self) -> &DMatrix<usize> {
        &self.labels
    }

    /// The load on each patch under a pressure \[Pa\], in the order of [`patches`](Self::patches).
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if the pressure has another shape, and [`Error::FieldNotFinite`].
    pub fn loads(&self, pressure: &DMatrix<f64>) -> Result<Vec<PatchLoad>, Error> {
        self.grid.check_finite("pressure", pressure)?;
        let none = PatchLoad { load: 0.0, mean_pressure: 0.0, max_pressure: f64::NEG_INFINITY };
        let mut loads = vec![none; self.patches.len()];
        let nodes = pressure.iter().zip(self.labels.iter());
        for (&pressure, &label) in nodes {
            if label > 0 {
                let carried = &mut loads[label - 1];
                carried.load += pressure;
                carried.max_pressure = carried.max_pressure.max(pressure);
            }
        }
        for (carried, patch) in loads.iter_mut().zip(&self.patches) {
            // The sum of pressures until here.
            carried.mean_pressure = carried.load / patch.nodes as f64;
            carried.load *= self.grid.cell_area();
        }
        Ok(loads)
    }
}

impl Gathered {
    fn finish(&self, grid: &Grid, wraps: (bool, bool)) -> Patch {
        let (lx, ly) = grid.sides();
        let center = |axis: Axis, wraps: bool, n: usize, side: f64| {
            if wraps {
                return f64::NAN;
            }
            // In halves of a cell, as whole numbers, so that taking periods off loses nothing.
            let nodes = self.nodes as i64;
            let all = 2 * nodes * n as i64;
            let halves = (2 * self.indices[place(axis)] + nodes).rem_euclid(all);
            side * (halves as f64 / all as f64)
        };
        Patch {
            nodes: self.nodes,
            area: self.nodes as f64 * grid.cell_area(),
            centroid: (
                center(Axis::X, wraps.0, grid.nx(), lx),
                center(Axis::Y, wraps.1, grid.ny(), ly),
            ),
            perimeter: self.perimeter,
            wraps,
        }
    }
}
