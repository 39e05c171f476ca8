//! The table `path.csv`: one line for each state.

use asperity::patches::ContactEdge;
use asperity::{Boundary, Error, Grid, LoadingState};

/// Writes the lines of `path.csv`, in the order of the states.
///
/// ```
/// use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine};
/// use asperity_report::PathTable;
///
/// # fn main() -> Result<(), asperity::Error> {
/// let grid = Grid::square(32, 1.25e-3)?;
/// let half_space = Boussinesq::new(grid, 115e9)?;
/// let path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space).max_load(500.0).build()?;
/// let mut table = PathTable::new(grid, asperity::Boundary::Free);
/// let mut text = format!("{}\n", PathTable::HEADER);
/// for state in path {
///     text += &format!("{}\n", table.line(&state?)?);
/// }
/// assert!(text.starts_with("step,ix,iy,event,approach,load,"));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct PathTable {
    /// The edge of the contact, for its corrected area.
    edge: ContactEdge,
}

impl PathTable {
    /// The names of the columns, in SI units.
    pub const HEADER: &'static str = "step,ix,iy,event,approach,load,contact_area,contact_area_fraction,mean_gap,\
        contact_stiffness,interfacial_stiffness,corrected_contact_area,approach_error,yielded_area_fraction";

    /// Without a state.
    #[must_use]
    pub fn new(grid: Grid, boundary: Boundary) -> Self {
        Self { edge: ContactEdge::new(grid, boundary) }
    }

    /// The line of the next state, without its end. `{:e}` prints the shortest digits that read back as the same
    /// number.
    ///
    /// # Errors
    ///
    /// Those of [`ContactEdge::follow`], for states that are in no order of a path.
    pub fn line(&mut self, state: &LoadingState) -> Result<String, Error> {
        self.edge.follow(state.event, state.node)?;
        let ((ix, iy), contact) = (state.node, &state.contact);
        Ok(format!(
            "{},{ix},{iy},{},{:e},{:e},{:e},{:e},{:e},{},{},{:e},{:e},{:e}",
            state.step,
            state.event.name(),
            contact.approach,
            contact.load,
            contact.contact_area,
            contact.contact_area_fraction,
            contact.mean_gap,
            stiffness(contact.contact_stiffness),
            stiffness(contact.interfacial_stiffness),
            self.edge.corrected_area(),
            state.approach_error,
            contact.plastic.map_or(0.0, |plastic| plastic.yielded_area_fraction),
        ))
    }
}

/// Empty where there is none: on a periodic half-space.
fn stiffness(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| format!("{value:e}"))
}
