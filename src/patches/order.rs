//! The order of contact from the states of a path, and its picture.

use nalgebra::DMatrix;

use crate::contact::ContactSequence;
use crate::loading::{ContactEvent, LoadingState};
use crate::{Error, Grid};

/// The nodes of a path in the order in which they touched, from its events: of the states of a path,
/// `(state.event, state.node)`.
///
/// Begin with first touch: nodes whose event is missing count as out of contact.
///
/// # Errors
///
/// [`Error::NodeLeaves`] if one leaves, with the number of the event, from 1 on; [`Error::OutOfRange`] for a node
/// outside the grid, and [`Error::AlreadyInContact`].
pub fn contact_sequence(
    grid: Grid,
    events: impl IntoIterator<Item = (ContactEvent, (usize, usize))>,
) -> Result<ContactSequence, Error> {
    let mut contact = ContactSequence::new(grid);
    for ((event, (ix, iy)), number) in events.into_iter().zip(1..) {
        match event {
            ContactEvent::Touch => contact.push(node_of(&grid, ix, iy)?)?,
            ContactEvent::Release => {
                return Err(Error::NodeLeaves { ix, iy, event: number });
            }
            ContactEvent::Yield | ContactEvent::Limit => (),
        }
    }
    Ok(contact)
}

/// A quantity of the state at which each node touched, for the first time if it leaves in between; NaN where none did.
///
/// One such map holds every contact map of a path: where the load of activation is at most W is the contact under the
/// load W.
///
/// ```
/// use asperity::patches::activation_map;
/// use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
/// let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space)
///     .max_area_fraction(0.5)
///     .build()?;
/// let history = path.run()?;
/// let load = activation_map(&path.grid(), history.states(), |state| state.contact.load)?;
/// let reached = path.state().map_or(0.0, |state| state.contact.load);
/// assert_eq!(load.map(|touched| touched <= reached), path.contact_map());
/// # Ok(())
/// # }
/// ```
///
/// # Errors
///
/// [`Error::OutOfRange`] for a node outside the grid.
pub fn activation_map(
    grid: &Grid,
    states: &[LoadingState],
    quantity: impl Fn(&LoadingState) -> f64,
) -> Result<DMatrix<f64>, Error> {
    let (nx, ny) = grid.shape();
    let mut map = DMatrix::from_element(nx, ny, f64::NAN);
    for state in states {
        let (ix, iy) = state.node;
        let node = node_of(grid, ix, iy)?;
        let value = &mut map.as_mut_slice()[node];
        if state.event == ContactEvent::Touch && value.is_nan() {
            *value = quantity(state);
        }
    }
    Ok(map)
}

/// The index of a node.
pub(super) fn node_of(grid: &Grid, ix: usize, iy: usize) -> Result<usize, Error> {
    let expected = "a node of the grid";
    Error::require("index ix of a node", ix as f64, ix < grid.nx(), expected)?;
    Error::require("index iy of a node", iy as f64, iy < grid.ny(), expected)?;
    Ok(grid.index(ix, iy))
}
