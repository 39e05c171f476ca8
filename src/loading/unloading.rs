//! The stiffness on unloading: that of all nodes in contact, those that have yielded among them.

use super::path::LoadingPath;
use super::snapshot::not_on_path;
use super::state::LoadingState;
use super::sum::Sum;
use crate::updater::RecursiveCholesky;
use crate::{Error, Problem};

impl LoadingPath {
    /// Adds the stiffnesses on unloading to states of this path, if it has a hardness:
    /// [`contact_unloading_stiffness`](crate::contact::PlasticState::contact_unloading_stiffness) and
    /// [`interfacial_unloading_stiffness`](crate::contact::PlasticState::interfacial_unloading_stiffness). Other paths
    /// unload as they load.
    ///
    /// On unloading all nodes in contact are elastic. A factor of their influence matrix in the order in which they
    /// touched has the stiffness after every touch, and yields do not change it: with w = L⁻¹e of the factor C = L Lᵀ
    /// it is ΔA Σ w² over the first n nodes. All states together cost one factor of the largest contact among them,
    /// n³/3 flops and 4n² bytes for n nodes, and are exact to rounding. Nodes that touch at the same approach have a
    /// stiffness each, of which only the last lasts.
    ///
    /// # Errors
    ///
    /// [`Error::StateNotReached`] for states beyond the present one, [`Error::NotOnPath`] for more nodes in contact
    /// than this path has had, [`Error::MemoryBudget`] if the factor does not fit beside what the path holds, and
    /// [`Error::FactorizationFailed`]. The states are left as they were then.
    pub fn add_unloading_stiffness(&self, states: &mut [LoadingState]) -> Result<(), Error> {
        let run = &self.run;
        if run.plastic.is_none() {
            return Ok(());
        }
        states.iter().try_for_each(|state| self.check_reached(state))?;
        let Some(largest) = states.iter().max_by_key(|state| state.contact.contact_nodes) else {
            return Ok(());
        };
        let most = largest.contact.contact_nodes;
        let order = self.contact_order();
        let order = order.get(..most).ok_or_else(|| {
            let (value, expected) = (most as f64, "no more than this path has had");
            not_on_path(largest, "number of nodes in contact", value, expected)
        })?;
        let own = self.phase.bytes(run.problem.grid().nodes(), run.contact.len());
        let needed = own.saturating_add(RecursiveCholesky::bytes_of(most));
        run.memory.check(needed, run.contact.len())?;
        let stiffnesses = Stiffnesses::of(run.surface(), order)?;
        for state in states {
            let [contact, interfacial] = stiffnesses.with(state.contact.contact_nodes);
            if let Some(plastic) = &mut state.contact.plastic {
                plastic.contact_unloading_stiffness = contact;
                plastic.interfacial_unloading_stiffness = interfacial;
            }
        }
        Ok(())
    }
}

/// Stiffnesses of the first n nodes in an order, for each n.
struct Stiffnesses {
    cell_area: f64,
    has_distant_point: bool,
    nodes: usize,
    /// eᵀ C⁻¹ e and sᵀ C⁻¹ e, with the row sums s.
    sums: Vec<[f64; 2]>,
}

impl Stiffnesses {
    fn of(problem: &Problem, order: &[usize]) -> Result<Self, Error> {
        let (factor, _) = RecursiveCholesky::of(problem, order)?;
        let (mut unit_unit, mut row_unit) = (Sum::default(), Sum::default());
        let sums = factor.border().iter().map(|[_, unit, row_sum]| {
            unit_unit.add(unit * unit);
            row_unit.add(row_sum * unit);
            [unit_unit.total(), row_unit.total()]
        });
        Ok(Self {
            cell_area: problem.grid().cell_area(),
            has_distant_point: problem.table().gauge().is_none(),
            nodes: problem.grid().nodes(),
            sums: sums.collect(),
        })
    }

    /// That of a distant point, if there is one, and the interfacial one.
    fn with(&self, contact_nodes: usize) -> [Option<f64>; 2] {
        let sums = contact_nodes.checked_sub(1).and_then(|last| self.sums.get(last));
        let Some([unit_unit, row_unit]) = sums else {
            return [None, None];
        };
        let stiffness = self.cell_area * unit_unit;
        // In full contact the mean gap cannot change, by identity and not by arithmetic.
        let closing = 1.0 - row_unit / self.nodes as f64;
        let is_full = contact_nodes == self.nodes;
        let interfacial = if is_full { f64::INFINITY } else { stiffness / closing };
        [self.has_distant_point.then_some(stiffness), Some(interfacial)]
    }
}
