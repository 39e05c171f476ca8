//! The rectangular grid of nodes, and the numbering of its nodes.

use nalgebra::DMatrix;

use crate::Error;

/// An nx × ny grid of nodes, each at the centre of a cell of dx × dy.
///
/// Node (ix, iy) sits at x = (ix + ½) dx, y = (iy + ½) dy; the nominal area is (nx dx) × (ny dy),
/// so the spacing is side / nodes, without an end point. The index of a node is `ix + nx * iy`, which
/// is also the place of element `[(ix, iy)]` in the storage of a nalgebra `DMatrix`. In every field of
/// this crate x is the first index; an image `[row, column]` must be transposed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Unchecked")
)]
pub struct Grid {
    nx: usize,
    ny: usize,
    dx: f64,
    dy: f64,
}

/// What a grid is read from.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct Unchecked {
    nx: usize,
    ny: usize,
    dx: f64,
    dy: f64,
}

#[cfg(feature = "serde")]
impl TryFrom<Unchecked> for Grid {
    type Error = Error;

    fn try_from(found: Unchecked) -> Result<Self, Error> {
        Self::new(found.nx, found.ny, found.dx, found.dy)
    }
}

getters!(Grid {
    /// Nodes along x.
    nx: usize,
    /// Nodes along y.
    ny: usize,
    /// Cell size along x \[m\].
    dx: f64,
    /// Cell size along y \[m\].
    dy: f64,
});

impl Grid {
    /// Greatest number of nodes along a side.
    pub const MAX_SIDE: usize = 1 << 15;

    /// A grid of `nx` × `ny` nodes with cells of `dx` × `dy` metres.
    ///
    /// # Errors
    ///
    /// [`Error::EmptyGrid`], [`Error::GridTooLarge`] beyond [`Grid::MAX_SIDE`] nodes a side, and
    /// [`Error::NotPositive`] for a cell that is not.
    pub fn new(nx: usize, ny: usize, dx: f64, dy: f64) -> Result<Self, Error> {
        Self::check_nodes(nx, ny)?;
        let dx = Error::require_positive("cell size dx", dx)?;
        let dy = Error::require_positive("cell size dy", dy)?;
        let grid = Self { nx, ny, dx, dy };
        // What is derived from the cell must not overflow or vanish either.
        let (lx, ly) = grid.sides();
        Error::require_positive("side lx", lx)?;
        Error::require_positive("side ly", ly)?;
        Error::require_positive("cell area", grid.cell_area())?;
        Error::require_positive("nominal area", grid.nominal_area())?;
        Ok(grid)
    }

    /// A grid of `nx` × `ny` nodes over a rectangle of `lx` × `ly` metres.
    ///
    /// # Errors
    ///
    /// As [`Grid::new`].
    pub fn with_sides(nx: usize, ny: usize, lx: f64, ly: f64) -> Result<Self, Error> {
        Self::check_nodes(nx, ny)?;
        let lx = Error::require_positive("side lx", lx)?;
        let ly = Error::require_positive("side ly", ly)?;
        Self::new(nx, ny, lx / nx as f64, ly / ny as f64)
    }

    /// A square of side `side` metres with `n` × `n` nodes.
    ///
    /// # Errors
    ///
    /// As [`Grid::new`].
    pub fn square(n: usize, side: f64) -> Result<Self, Error> {
        Self::with_sides(n, n, side, side)
    }

    /// `Ok` for numbers of nodes that a grid can have.
    pub(crate) fn check_nodes(nx: usize, ny: usize) -> Result<(), Error> {
        if nx == 0 || ny == 0 {
            return Err(Error::EmptyGrid { nx, ny });
        }
        if nx > Self::MAX_SIDE || ny > Self::MAX_SIDE {
            return Err(Error::GridTooLarge { nx, ny, max_side: Self::MAX_SIDE });
        }
        Ok(())
    }

    /// The grid with twice as many nodes in either direction that has several, on which nothing meets itself around
    /// the border. They may be more than [`Grid::MAX_SIDE`].
    pub(crate) fn padded(&self) -> Self {
        let twice = |n: usize| if n > 1 { 2 * n } else { 1 };
        Self { nx: twice(self.nx), ny: twice(self.ny), ..*self }
    }

    /// The grid with x and y exchanged.
    #[must_use]
    pub fn transposed(&self) -> Self {
        Self { nx: self.ny, ny: self.nx, dx: self.dy, dy: self.dx }
    }

    /// Number of nodes along x and y, the shape of every field on this grid.
    #[must_use]
    pub fn shape(&self) -> (usize, usize) {
        (self.nx, self.ny)
    }

    /// Number of nodes.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.nx * self.ny
    }

    /// Sides of the nominal rectangle \[m\].
    #[must_use]
    pub fn sides(&self) -> (f64, f64) {
        (self.nx as f64 * self.dx, self.ny as f64 * self.dy)
    }

    /// The longer or the shorter of two lengths, one along x and one along y; a direction of one node does not count.
    pub(crate) fn of_directions<T>(&self, (x, y): (T, T), of: fn(T, T) -> T) -> T {
        match self.shape() {
            (_, 1) => x,
            (1, _) => y,
            _ => of(x, y),
        }
    }

    /// The side of a profile, a grid of one row or one column; `None` for a map. One node is a row.
    pub(crate) fn length_of_profile(&self) -> Option<f64> {
        let (lx, ly) = self.sides();
        match self.shape() {
            (_, 1) => Some(lx),
            (1, _) => Some(ly),
            _ => None,
        }
    }

    /// Longer side of a cell over the shorter one.
    #[must_use]
    pub fn cell_aspect(&self) -> f64 {
        (self.dx / self.dy).max(self.dy / self.dx)
    }

    /// Area of a cell, ΔA = dx dy \[m²\].
    #[must_use]
    pub fn cell_area(&self) -> f64 {
        self.dx * self.dy
    }

    /// Nominal contact area A₀ \[m²\].
    #[must_use]
    pub fn nominal_area(&self) -> f64 {
        self.nodes() as f64 * self.cell_area()
    }

    /// Centre of the nominal rectangle \[m\].
    #[must_use]
    pub fn center(&self) -> (f64, f64) {
        let (lx, ly) = self.sides();
        (0.5 * lx, 0.5 * ly)
    }

    /// Position of node (ix, iy) \[m\].
    #[must_use]
    pub fn position(&self, ix: usize, iy: usize) -> (f64, f64) {
        ((ix as f64 + 0.5) * self.dx, (iy as f64 + 0.5) * self.dy)
    }

    /// Index of node (ix, iy), its place in the storage of a field; `None` if it lies outside.
    #[must_use]
    pub fn node(&self, ix: usize, iy: usize) -> Option<usize> {
        (ix < self.nx && iy < self.ny).then(|| self.index(ix, iy))
    }

    /// [`Grid::node`] of a node that is known to be on the grid.
    #[doc(hidden)]
    #[must_use]
    pub fn index(&self, ix: usize, iy: usize) -> usize {
        ix + self.nx * iy
    }

    /// The pair (ix, iy) of a node index.
    #[must_use]
    pub fn coordinates(&self, node: usize) -> (usize, usize) {
        (node % self.nx, node / self.nx)
    }

    /// Wavevector \[rad/m\] of the wave (kx, ky) of a Fourier transform on this grid, of the two directions in
    /// which it can be said to run the one of the longer wave.
    #[must_use]
    pub fn wave_vector(&self, kx: usize, ky: usize) -> (f64, f64) {
        let along = |k: usize, n: usize, side: f64| {
            let signed = if 2 * k > n { k as f64 - n as f64 } else { k as f64 };
            std::f64::consts::TAU * signed / side
        };
        let (lx, ly) = self.sides();
        (along(kx, self.nx, lx), along(ky, self.ny, ly))
    }

    /// The number of nodes whose cells make up at most `fraction` (above 0, up to 1) of the nominal
    /// area: ⌊fraction M⌋, where 0.1 of 10 nodes is one node whatever the last bit of the product.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a fraction that is not above 0 and at most 1, and
    /// [`Error::LessThanOneNode`] for one that is smaller than 1/M.
    pub fn nodes_in(&self, fraction: f64) -> Result<usize, Error> {
        let is_one = fraction > 0.0 && fraction <= 1.0;
        Error::require("area fraction", fraction, is_one, "above 0 and at most 1")?;
        let all = self.nodes() as f64;
        // A fraction computed as k/M falls short of k nodes by at most three rounding errors.
        let nodes = (fraction * all * (1.0 + 4.0 * f64::EPSILON)).floor();
        if nodes < 1.0 {
            return Err(Error::LessThanOneNode { fraction, least: 1.0 / all });
        }
        Ok((nodes as usize).min(self.nodes()))
    }

    /// `Ok` if a field of the given shape lives on this grid.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] otherwise.
    pub fn check_shape(&self, found: (usize, usize)) -> Result<(), Error> {
        let expected = self.shape();
        if found == expected { Ok(()) } else { Err(Error::GridMismatch { expected, found }) }
    }

    /// `Ok` if a field, which the error calls `field`, lives on this grid and is finite.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] and [`Error::FieldNotFinite`].
    pub fn check_finite(&self, field: &'static str, values: &DMatrix<f64>) -> Result<(), Error> {
        self.check_shape(values.shape())?;
        let Some(node) = values.iter().position(|value| !value.is_finite()) else {
            return Ok(());
        };
        let (ix, iy) = self.coordinates(node);
        Err(Error::FieldNotFinite { field, ix, iy, value: values[node] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_node_is_where_its_index_says() -> Result<(), Error> {
        let grid = Grid::new(3, 4, 1.0, 1.0)?;
        for node in 0..grid.nodes() {
            let (ix, iy) = grid.coordinates(node);
            assert_eq!(grid.node(ix, iy), Some(node));
        }
        for (ix, iy) in [(3, 0), (0, 4), (3, usize::MAX), (usize::MAX, usize::MAX)] {
            assert_eq!(grid.node(ix, iy), None);
        }
        Ok(())
    }

    #[test]
    fn a_fraction_of_k_nodes_is_k_nodes() -> Result<(), Error> {
        for (nx, ny) in [(1, 1), (10, 1), (7, 7), (49, 3), (1000, 999)] {
            let grid = Grid::new(nx, ny, 1.0, 1.0)?;
            let all = grid.nodes();
            for k in (1..=all).step_by(1 + all / 1000) {
                assert_eq!(grid.nodes_in(k as f64 / all as f64)?, k);
                // In two steps, and a little more and less than k nodes.
                assert_eq!(grid.nodes_in(k as f64 * (1.0 / all as f64))?, k);
                assert_eq!(grid.nodes_in(((k as f64 + 0.9) / all as f64).min(1.0))?, k);
            }
        }
        Ok(())
    }

    #[test]
    fn fractions_without_a_node_are_refused() -> Result<(), Error> {
        let grid = Grid::new(10, 10, 1.0, 1.0)?;
        for fraction in [0.0, -0.1, 1.0 + 1e-12, f64::NAN, f64::INFINITY] {
            let refused = grid.nodes_in(fraction);
            assert!(matches!(refused, Err(Error::OutOfRange { .. })), "{fraction}");
        }
        for fraction in [0.0099, 1e-300] {
            let refused = grid.nodes_in(fraction);
            assert!(matches!(refused, Err(Error::LessThanOneNode { least: 0.01, .. })));
        }
        Ok(())
    }

    /// A grid is read as it was written, and checked as any other.
    #[cfg(feature = "serde")]
    #[test]
    fn a_grid_is_data() -> Result<(), Box<dyn std::error::Error>> {
        let grid = Grid::new(3, 4, 0.1, 1.0 / 3.0)?;
        let text = serde_json::to_string(&grid)?;
        assert_eq!(serde_json::from_str::<Grid>(&text)?, grid);
        let refused = |from, to| {
            let other = text.replacen(from, to, 1);
            assert_ne!(other, text);
            serde_json::from_str::<Grid>(&other).map_err(|error| error.to_string())
        };
        let empty = refused("\"nx\":3", "\"nx\":0");
        assert!(empty.is_err_and(|error| error.contains("a grid of 0 x 4 nodes is empty")));
        let flat = refused("\"dx\":0.1", "\"dx\":-0.1");
        assert!(flat.is_err_and(|error| error.contains("dx must be positive")));
        Ok(())
    }
}
