//! The contact problem: a surface on a half-space, before any node is in contact.

use std::sync::{Arc, OnceLock};

use crate::cell_response::CellResponse;
use crate::convolution::Convolution;
use crate::kernel::KernelTable;
use crate::surface::HeightMap;
use crate::{Boundary, ContactGrowth, Error, Grid, InfluenceKernel, Surface};

/// A contact problem: influence coefficients C and initial gap g on a grid. It is
/// made once, never changes, and all solvers and updaters read it.
///
/// ```
/// use asperity::surface::Paraboloid;
/// use asperity::{Boussinesq, Grid, Problem};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let half_space = Boussinesq::new(Grid::square(16, 1e-3)?, 100e9)?;
/// let problem = Problem::new(&Paraboloid::new(0.1)?, &half_space)?;
/// assert_eq!(problem.initial_gap().len(), 256);
/// assert!(problem.coefficient(0, 1) < problem.coefficient(0, 0));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct Problem {
    table: Arc<KernelTable>,
    gap: Vec<f64>,
    greatest_gap: f64,
    rms_height: f64,
    convolution: Arc<Convolution>,
    row_sums: OnceLock<Vec<f64>>,
}

impl Problem {
    /// Number of right-hand sides of a path: g, the unit vector and the row sums of C.
    pub(crate) const RHS: usize = 3;

    /// Samples `surface` on the grid of `kernel`, and tabulates the kernel.
    ///
    /// In the units of the input, the greatest gap g, the displacement C(0, 0) of a cell under its own unit
    /// pressure and the pressure g / C(0, 0) have to lie between 10⁻¹⁴⁰ and 10¹⁴⁰, so that their squares are
    /// numbers too; the stiffness ΔA / C(0, 0) of a cell, the load g ΔA / C(0, 0) and the energy g² ΔA / C(0, 0)
    /// between 10⁻²⁸⁰ and 10²⁸⁰. Surfaces without any gap are as good as others. A gap that is not 0 and so small
    /// that it, or its pressure, lies below 10⁻¹⁴⁰ counts as closed.
    ///
    /// # Errors
    ///
    /// Those of the surface and of [`KernelTable::new`]; [`Error::GridMismatch`] for heights of another grid;
    /// [`SurfaceError::HeightNotFinite`](crate::SurfaceError::HeightNotFinite); [`Error::OutOfRange`] for heights,
    /// cells and a modulus that are too far apart, and if sums of coefficients overflow;
    /// [`KernelError::SymbolNotPositive`] for a periodic kernel that is not positive definite.
    ///
    /// [`KernelError::SymbolNotPositive`]: crate::KernelError::SymbolNotPositive
    pub fn new(surface: &dyn Surface, kernel: &dyn InfluenceKernel) -> Result<Self, Error> {
        Self::of(surface, KernelTable::new(kernel)?.regular())
    }

    /// The same for a path with a hardness, on which no kernel promises more than that contact grows: large gauges then
    /// only cost digits.
    pub(crate) fn with_hardness(
        surface: &dyn Surface,
        kernel: &dyn InfluenceKernel,
    ) -> Result<Self, Error> {
        Self::of(surface, KernelTable::new(kernel)?.regular_for(ContactGrowth::Monotone))
    }

    fn of(surface: &dyn Surface, table: KernelTable) -> Result<Self, Error> {
        let convolution = Convolution::from_table(&table)?;
        convolution.check_definite(&table)?;
        let heights = HeightMap::sample(surface, &table.grid())?;
        let highest = heights.max_height();
        let greatest_gap = highest - heights.min_height();
        let cell = CellResponse::of(&table)?;
        if greatest_gap != 0.0 {
            cell.check(greatest_gap)?;
        }
        let negligible = cell.negligible_gap();
        let gap = heights.matrix().iter().map(|height| highest - height);
        let gap = gap.map(|gap| if gap < negligible { 0.0 } else { gap });
        Ok(Self {
            gap: gap.collect(),
            greatest_gap,
            rms_height: heights.rms_height(),
            convolution: Arc::new(convolution),
            table: Arc::new(table),
            row_sums: OnceLock::new(),
        })
    }

    /// The grid of surface and kernel.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.table.grid()
    }

    /// The surroundings of the grid.
    #[must_use]
    pub fn boundary(&self) -> Boundary {
        self.table.boundary()
    }

    /// How the kernel promises contact to grow.
    #[must_use]
    pub fn growth(&self) -> ContactGrowth {
        self.table.contact_growth()
    }

    /// The influence coefficients.
    #[must_use]
    pub fn table(&self) -> &KernelTable {
        &self.table
    }

    /// Initial gap `g = max z − z ≥ 0` \[m\] by node index.
    #[must_use]
    pub fn initial_gap(&self) -> &[f64] {
        &self.gap
    }

    /// Greatest initial gap \[m\].
    #[must_use]
    pub fn greatest_gap(&self) -> f64 {
        self.greatest_gap
    }

    /// Mean initial gap \[m\]: the mean gap of surfaces that just touch.
    #[must_use]
    pub fn mean_gap(&self) -> f64 {
        self.gap.iter().sum::<f64>() / self.gap.len() as f64
    }

    /// Least length that errors are relative to, for when the approach is zero: a part of the mean gap.
    pub(crate) fn least_length(&self) -> f64 {
        1e-6 * self.mean_gap()
    }

    /// Root mean square height Sq \[m\] about the mean height.
    #[must_use]
    pub fn rms_height(&self) -> f64 {
        self.rms_height
    }

    /// Displacement of node `node` under unit pressure on node `other` \[m/Pa\]; `None` if either lies
    /// outside the grid.
    #[must_use]
    pub fn coefficient(&self, node: usize, other: usize) -> Option<f64> {
        let nodes = self.gap.len();
        (node < nodes && other < nodes)
            .then(|| self.table.between(self.table.place(node), self.table.place(other)))
    }

    /// Displacement of every node under unit pressure on all of them \[m/Pa\], `sᵢ = Σⱼ Cᵢⱼ`: what turns
    /// pressures into a mean displacement, `Σᵢ uᵢ = Σⱼ sⱼ pⱼ`. Computed when it is first asked for.
    #[must_use]
    pub fn row_sums(&self) -> &[f64] {
        self.row_sums.get_or_init(|| {
            let mut sums = vec![0.0; self.gap.len()];
            let filled = self.convolution().apply(&vec![1.0; sums.len()], &mut sums);
            debug_assert!(filled.is_ok(), "both have one value for each node");
            sums
        })
    }

    /// A convolution with the kernel: memory of its own, the transform of the kernel shared.
    #[must_use]
    pub fn convolution(&self) -> Convolution {
        Convolution::clone(&self.convolution)
    }

    /// The tabulated kernel, shared.
    pub(crate) fn shared_table(&self) -> Arc<KernelTable> {
        Arc::clone(&self.table)
    }

    /// Whether its kernel is tabulated in this very table.
    pub(crate) fn has_table(&self, table: &Arc<KernelTable>) -> bool {
        Arc::ptr_eq(&self.table, table)
    }

    /// The right-hand sides (g, 1, s) at a node of the grid.
    pub(crate) fn rhs(&self, node: usize) -> [f64; Self::RHS] {
        [self.gap[node], 1.0, self.row_sums()[node]]
    }

    /// The problem of the nodes that do not carry a given load: the load's `displacement` comes to their gap, and nodes
    /// under it are not counted by row sums, to which they would come with `unit`, their displacement under a pressure
    /// of 1.
    pub(crate) fn under_load(&self, displacement: &[f64], unit: &[f64]) -> Self {
        let gap = self.gap.iter().zip(displacement).map(|(gap, u)| gap + u);
        let row_sums = self.row_sums().iter().zip(unit).map(|(sum, u)| sum - u);
        Self {
            table: Arc::clone(&self.table),
            gap: gap.collect(),
            greatest_gap: self.greatest_gap,
            rms_height: self.rms_height,
            convolution: Arc::clone(&self.convolution),
            row_sums: OnceLock::from(row_sums.collect::<Vec<_>>()),
        }
    }

    /// `Ok` if all nodes lie in the grid.
    pub(crate) fn check_nodes(&self, nodes: &[usize]) -> Result<(), Error> {
        let limit = self.gap.len();
        match nodes.iter().find(|&&node| node >= limit) {
            Some(&node) => Err(Error::NodeOutOfGrid { node, nodes: limit }),
            None => Ok(()),
        }
    }

    /// Bytes that a problem on a grid holds.
    pub(crate) fn bytes_on(grid: &Grid, boundary: Boundary) -> usize {
        let fields = 2 * grid.nodes() * size_of::<f64>();
        fields + KernelTable::bytes_on(grid) + Convolution::bytes_on(grid, boundary)
    }
}
