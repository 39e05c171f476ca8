//! How well the grid resolves a contact.

use std::fmt;

use asperity::patches::{Connectivity, ContactEdge, Patches};
use asperity::{Boundary, Error, Grid};
use asperity_cli::number::{area, counted};
use nalgebra::DMatrix;

/// The patches of a contact, and what cells count too much along their edges.
pub(crate) struct Resolution {
    patches: usize,
    contact_nodes: usize,
    /// Areas \[m²\].
    area: f64,
    pub(crate) corrected_area: f64,
}

impl Resolution {
    pub(crate) fn of(
        contact_map: &DMatrix<bool>,
        grid: &Grid,
        boundary: Boundary,
    ) -> Result<Self, Error> {
        let edge = ContactEdge::of(contact_map, *grid, boundary)?;
        let found = Patches::new(contact_map, grid, boundary, Connectivity::Four)?;
        Ok(Self {
            patches: found.patches().len(),
            contact_nodes: edge.contact_nodes(),
            area: edge.contact_nodes() as f64 * grid.cell_area(),
            corrected_area: edge.corrected_area(),
        })
    }
}

impl fmt::Display for Resolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.patches == 0 {
            return write!(f, "no patch");
        }
        let size = match self.patches {
            1 => counted(self.contact_nodes, "node"),
            patches => {
                format!("{:.1} nodes on average", self.contact_nodes as f64 / patches as f64)
            }
        };
        write!(
            f,
            "{} of {size}; contact area {} as counted in cells, {} corrected ({:.1} % less)",
            counted(self.patches, "patch"),
            area(self.area, 4),
            area(self.corrected_area, 4),
            100.0 * (1.0 - self.corrected_area / self.area)
        )
    }
}
