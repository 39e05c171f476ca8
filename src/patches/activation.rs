//! A picture of the order of contact.

use nalgebra::DMatrix;

use crate::contact::node_of;
use crate::loading::{ContactEvent, LoadingState};
use crate::{Error, Grid};

/// A quantity of the state at which each node touched, for the first time if it leaves in between; NaN where none did.
///
/// One such map holds every contact map of a path on which no node leaves: where the load of activation is at most W is the contact under the
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
/// [`Error::NodeOutOfGrid`].
pub fn activation_map(
    grid: &Grid,
    states: &[LoadingState],
    quantity: impl Fn(&LoadingState) -> f64,
) -> Result<DMatrix<f64>, Error> {
    let (nx, ny) = grid.shape();
    let mut map = DMatrix::from_element(nx, ny, f64::NAN);
    for state in states {
        let node = node_of(grid, state.node)?;
        let value = &mut map.as_mut_slice()[node];
        if state.event == ContactEvent::Touch && value.is_nan() {
            *value = quantity(state);
        }
    }
    Ok(map)
}
