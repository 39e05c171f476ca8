//! The line between contact and no contact, and the area that cells count too much along it.

use std::f64::consts::{LN_2, PI};

use super::lattice::Lattice;
use crate::Grid;

/// The perimeter of a contact, or of one of its patches, in sides of cells.
///
/// A side belongs to it if the node on one side of it is in contact and that on the other is not. On a periodic
/// boundary that is all. On a free one, sides of cells in contact at the border of the grid belong to it as well: they
/// are counted apart, since it is the surface that ends there, and not the contact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Perimeter {
    /// Sides along x, each of length dx, inside the grid.
    pub along_x: usize,
    /// Sides along y, each of length dy, inside the grid.
    pub along_y: usize,
    /// Sides along x on the border of the grid.
    pub border_along_x: usize,
    /// Sides along y on the border of the grid.
    pub border_along_y: usize,
}

impl Perimeter {
    /// The factor $`c = (\pi - 1 + \ln 2)/24 = 0.1181`$ of [`corrected_area`](Self::corrected_area).
    pub const AREA_CORRECTION: f64 = (PI - 1.0 + LN_2) / 24.0;

    /// Number of sides, those on the border included.
    #[must_use]
    pub fn sides(&self) -> usize {
        let sides = [self.along_x, self.along_y, self.border_along_x, self.border_along_y];
        sides.into_iter().fold(0, usize::saturating_add)
    }

    /// Length \[m\], the border included. It is the length along the sides of cells: 4/π times that of a
    /// smooth line, on average over its directions.
    #[must_use]
    pub fn length(&self, grid: &Grid) -> f64 {
        let along_x = self.along_x.saturating_add(self.border_along_x);
        let along_y = self.along_y.saturating_add(self.border_along_y);
        along_x as f64 * grid.dx() + along_y as f64 * grid.dy()
    }

    /// The contact area \[m²\] without what cells count too much along its edges, for the contact of
    /// `contact_nodes` nodes that has this perimeter:
    /// ```math
    /// A = n\, \Delta A - c\, S_d\, \Delta, \qquad c = \frac{\pi - 1 + \ln 2}{24}
    /// ```
    /// with `n` nodes in contact, `Δ` the side of a cell and $`S_d`$ the length of the perimeter along the sides of
    /// cells. A cell counts as a whole although the edge of the contact runs through it, and `c` is what is too much
    /// on average over straight edges of all directions. On a Hertz contact the correction overshoots: it takes away
    /// some 120 % of the error.
    ///
    /// Where dx ≠ dy, each side counts with the cell's extent across it, $`S_d Δ \to (n_x\, dx)\, dy +
    /// (n_y\, dy)\, dx`$ for $`n_x`$ sides along x and $`n_y`$ along y: all the same area ΔA. It is the
    /// correction of the picture that is stretched until its cells are square, in which edges of all directions are
    /// taken to be equally frequent. Sides on the border of the grid cut no cell, and are left out.
    ///
    /// Yastrebov, Anciaux & Molinari, Tribol. Int. 114 (2017) 161.
    #[must_use]
    pub fn corrected_area(&self, contact_nodes: usize, grid: &Grid) -> f64 {
        let sides = self.along_x.saturating_add(self.along_y) as f64;
        grid.cell_area() * (contact_nodes as f64 - Self::AREA_CORRECTION * sides)
    }

    /// A node joins the contact, or leaves it if `sign` is −1: sides between it and the other nodes in contact become
    /// inner ones, or edges again.
    pub(super) fn change(
        &mut self,
        lattice: &Lattice,
        node: usize,
        sign: isize,
        is_in: impl Fn(usize) -> bool,
    ) {
        self.add(lattice, node, sign, |other| {
            // Periodic along a side of one node: the cell is its own neighbour.
            let inner = other == node;
            let edge = if is_in(other) { -1 } else { 1 };
            if inner { 0 } else { sign * edge }
        });
    }

    /// Adds the sides of a node's cell: inside the grid `change` each, a function of the node on the other side, and
    /// on the border `border` each.
    pub(super) fn add(
        &mut self,
        lattice: &Lattice,
        node: usize,
        border: isize,
        change: impl Fn(usize) -> isize,
    ) {
        for (k, other) in lattice.beside(node).into_iter().enumerate() {
            let (inside, at_border) = if k < 2 {
                (&mut self.along_y, &mut self.border_along_y)
            } else {
                (&mut self.along_x, &mut self.border_along_x)
            };
            let (sides, change) = match other {
                Some(other) => (inside, change(other.node)),
                None => (at_border, border),
            };
            *sides = sides.saturating_add_signed(change);
        }
    }
}
