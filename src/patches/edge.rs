//! The edge of a contact that nodes join and leave.

use nalgebra::DMatrix;

use super::lattice::Lattice;
use super::{Connectivity, Perimeter};
use crate::contact::node_of;
use crate::loading::ContactEvent;
use crate::{Boundary, Error, Grid};

/// The perimeter of a contact from event to event, and with it the corrected contact area of every state.
///
/// An event costs a look at four neighbours. Nodes may leave the contact too, other than with
/// [`PatchHistory`](super::PatchHistory).
///
/// ```
/// use asperity::patches::ContactEdge;
/// use asperity::{Boussinesq, Grid, InfluenceKernel, LoadingSolver, SelfAffine};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
/// let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space)
///     .max_area_fraction(0.1)
///     .build()?;
/// let mut edge = ContactEdge::new(half_space.grid(), half_space.boundary());
/// for state in path.by_ref() {
///     let state = state?;
///     edge.follow(state.event, state.node)?;
///     println!("{} m² in cells, {} m² corrected", state.contact.contact_area, edge.corrected_area());
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct ContactEdge {
    grid: Grid,
    lattice: Lattice,
    in_contact: Vec<bool>,
    contact_nodes: usize,
    perimeter: Perimeter,
}

impl ContactEdge {
    /// Of no node in contact.
    #[must_use]
    pub fn new(grid: Grid, boundary: Boundary) -> Self {
        Self {
            grid,
            lattice: Lattice::new(grid, boundary, Connectivity::Four),
            in_contact: vec![false; grid.nodes()],
            contact_nodes: 0,
            perimeter: Perimeter::default(),
        }
    }

    /// Of the nodes that a map shows in contact.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if the map has another shape than the grid.
    pub fn of(contact_map: &DMatrix<bool>, grid: Grid, boundary: Boundary) -> Result<Self, Error> {
        grid.check_shape(contact_map.shape())?;
        let mut edge = Self::new(grid, boundary);
        let nodes = contact_map.iter().enumerate();
        nodes.filter(|(_, is_in)| **is_in).for_each(|(node, _)| edge.change(node, true));
        Ok(edge)
    }

    /// Follows an event of a path: at a limit, and where a node yields, nothing changes.
    ///
    /// # Errors
    ///
    /// [`Error::NodeOutOfGrid`]; [`Error::AlreadyInContact`] and [`Error::NotInContact`] for one that cannot join or
    /// leave.
    pub fn follow(&mut self, event: ContactEvent, (ix, iy): (usize, usize)) -> Result<(), Error> {
        let node = node_of(&self.grid, (ix, iy))?;
        match (event, self.in_contact[node]) {
            (ContactEvent::Touch, true) => return Err(Error::AlreadyInContact { ix, iy }),
            (ContactEvent::Release | ContactEvent::Yield, false) => {
                return Err(Error::NotInContact { ix, iy });
            }
            (ContactEvent::Limit, _) | (ContactEvent::Yield, true) => (),
            (ContactEvent::Touch | ContactEvent::Release, is_in) => self.change(node, !is_in),
        }
        Ok(())
    }

    fn change(&mut self, node: usize, joins: bool) {
        let sign = if joins { 1 } else { -1 };
        let in_contact = &self.in_contact;
        self.perimeter.change(&self.lattice, node, sign, |other| in_contact[other]);
        self.in_contact[node] = joins;
        self.contact_nodes = self.contact_nodes.saturating_add_signed(sign);
    }

    /// Number of nodes in contact.
    #[must_use]
    pub fn contact_nodes(&self) -> usize {
        self.contact_nodes
    }

    /// The perimeter.
    #[must_use]
    pub fn perimeter(&self) -> Perimeter {
        self.perimeter
    }

    /// Contact area \[m²\] without what cells count too much: see [`Perimeter::corrected_area`].
    #[must_use]
    pub fn corrected_area(&self) -> f64 {
        self.perimeter.corrected_area(self.contact_nodes, &self.grid)
    }
}
