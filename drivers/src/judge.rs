//! Solutions for one load, or another target, looked at densely and beside the path.

use asperity::loading::History;
use asperity::{
    ContactGrowth, ContactState, ContactTarget, Error, FixedLoadSolution, Grid, LoadingState,
    SurfaceError,
};
use nalgebra::DVector;

use crate::dense::{ContactSet, Dense, Scalars};
use crate::refusal::Circumstances;
use crate::verdict::{Tally, Verdict, Violation, ensure};
use crate::walk::{Demands, Walk};

/// How often the rounding errors of a solution a tolerance has to be for a solver to be sure of it.
const SURE: f64 = 100.0;

/// What a mean gap may be off by that was looked for, relative to the one without load.
const MEAN_GAP_ROUNDING: f64 = 1e-14;

/// Least displacement and pressure of a cell that are computed with, by `asperity::Problem::new`.
const LEAST: f64 = 1e-140;

/// How the solver is set up.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Settings {
    pub(crate) tolerance: f64,
    pub(crate) nested: bool,
    pub(crate) stiffness: bool,
}

/// What is known of the problem.
pub(crate) struct Judge {
    pub(crate) dense: Dense,
    pub(crate) grid: Grid,
    pub(crate) history: History,
    pub(crate) circumstances: Circumstances,
    pub(crate) settings: Settings,
}

impl Judge {
    /// Whether an error could not be helped.
    pub(crate) fn refusal(&self, error: &Error, target: ContactTarget) -> Verdict {
        let states = self.history.states();
        let unloaded = self.unloaded();
        let deserved = match (target, error) {
            // A search may come to loads with pressures beyond what is computed with.
            (
                ContactTarget::AreaFraction(_) | ContactTarget::MeanGap(_),
                Error::OutOfRange { value, .. },
            ) if *value != 0.0 && !(LEAST..=1.0 / LEAST).contains(value) => true,
            (
                ContactTarget::Load(value) | ContactTarget::Approach(value),
                Error::NotPositive { .. },
            ) => !(value > 0.0 && value.is_finite()),
            (ContactTarget::Approach(approach), Error::ApproachNotReached { .. }) => {
                self.dense.is_gauged() && approach >= unloaded * (1.0 - 1e-13)
            }
            (ContactTarget::MeanGap(value), Error::OutOfRange { .. }) => {
                !(value > 0.0 && value < unloaded * (1.0 - 1e-13))
            }
            (ContactTarget::AreaFraction(value), Error::OutOfRange { .. }) => {
                !(value > 0.0 && value <= 1.0)
            }
            (
                ContactTarget::AreaFraction(value),
                Error::Surface(SurfaceError::LessThanOneNode { .. }),
            ) => value * (self.grid.nodes() as f64) < 1.0 + 1e-12,
            // Nothing says that the mean gap of a body of which nothing is known falls below every value, or at all.
            (ContactTarget::MeanGap(value), Error::NoConvergence { .. }) => {
                let mut states = states.iter();
                self.circumstances.growth == ContactGrowth::Unknown
                    && states
                        .any(|state| state.contact.interfacial_stiffness.is_some_and(|k| k < 0.0))
                    && value < unloaded
            }
            (ContactTarget::AreaFraction(fraction), Error::NoConvergence { .. }) => {
                self.contact_shrinks() || self.is_never_reached(fraction)
            }
            _ => false,
        };
        if deserved || self.is_hopeless(error) {
            return Ok(Tally::refusal());
        }
        self.circumstances.judge(error)
    }

    /// The mean gap of surfaces that just touch.
    fn unloaded(&self) -> f64 {
        let states = self.history.states();
        states.first().map_or(0.0, |state| state.contact.mean_gap)
    }

    /// Whether the tolerance lies below the rounding errors of a solution.
    fn is_hopeless(&self, error: &Error) -> bool {
        matches!(error, Error::NoConvergence { .. })
            && self.settings.tolerance < SURE * self.circumstances.error
    }

    /// A number of nodes that no load has, since others touch together with them, or on a body whose contact shrinks,
    /// where a search may come to a load at which the number is jumped over once more.
    fn may_be_missed(&self, fraction: f64) -> bool {
        self.is_unreachable(fraction) || self.contact_shrinks()
    }

    /// Whether more load may mean fewer nodes.
    fn contact_shrinks(&self) -> bool {
        let states = self.history.states();
        let mut pairs = states.iter().zip(states.iter().skip(1));
        self.circumstances.growth == ContactGrowth::Unknown
            && pairs.any(|(one, next)| next.contact.contact_nodes < one.contact.contact_nodes)
    }

    /// More nodes than are ever in contact: on a body that promises nothing others may stay away under any load.
    fn is_never_reached(&self, fraction: f64) -> bool {
        let most = self.history.states().iter();
        let most = most.map(|state| state.contact.contact_nodes).max();
        self.circumstances.growth == ContactGrowth::Unknown
            && self.grid.nodes_in(fraction).ok() > most
    }

    /// The interval of loads with as many nodes in contact as fit into a fraction is nothing, or as narrow as solutions
    /// are exact, in load or in gap.
    fn is_unreachable(&self, fraction: f64) -> bool {
        let Ok(nodes) = self.grid.nodes_in(fraction) else {
            return true;
        };
        let states = self.history.states();
        let mut has = states.iter().zip(states.iter().skip(1).map(Some).chain([None]));
        let Some((state, next)) = has.find(|(state, _)| state.contact.contact_nodes == nodes)
        else {
            return true;
        };
        let Some(next) = next else {
            return false;
        };
        let slack = (SURE * self.settings.tolerance).max(self.circumstances.error);
        let (start, end) = (&state.contact, &next.contact);
        // No node closes by more than all nodes together, so within what gaps may be off by nothing tells these numbers
        // apart.
        let closing = self.dense.own_length(start.mean_gap - end.mean_gap);
        let nodes = self.grid.nodes() as f64;
        end.load - start.load <= slack * nodes * end.load || closing * nodes <= self.gap_error(end)
    }

    /// Looks at a solution.
    pub(crate) fn solution(&self, solution: &FixedLoadSolution, target: ContactTarget) -> Verdict {
        let mut tally = Tally::default();
        let (state, dense) = (&solution.contact, &self.dense);
        let nodes = self.grid.nodes();
        let found = dense.scalars(state);
        let pressure = DVector::from_iterator(
            nodes,
            solution.fields.pressure.iter().map(|p| dense.own_pressure(*p)),
        );
        let sum = pressure.sum();
        ensure!(pressure.min() >= 0.0, "a pressure is negative");
        let rounding = Dense::rounding(nodes);
        tally.close("sum of pressures", found.sum, sum, rounding * sum)?;
        let (displacement, lengths) = dense.displace(&pressure);
        let rounding = rounding * (lengths + found.own_approach.abs() + dense.gap().max());
        let allowed = self.gap_error(state) + rounding;
        let gap = dense.gap() + displacement.add_scalar(-found.own_approach);
        let mut mean_gap = 0.0;
        let mut contact = Vec::new();
        for node in 0..nodes {
            let (p, own) = (pressure[node], dense.own_length(solution.fields.gap[node]));
            tally.close("gap", own, gap[node], rounding)?;
            let moved = dense.own_length(solution.fields.displacement[node]);
            let expected = displacement[node] - dense.gauge() * sum;
            tally.close("displacement", moved, expected, rounding)?;
            let in_contact = solution.fields.contact_map[node];
            ensure!(
                in_contact == (p > 0.0 || own <= 0.0),
                "node {node} is in contact: {in_contact}, with pressure {p:e} and gap {own:e}"
            );
            if in_contact {
                contact.push(node);
                tally.close("gap in contact", gap[node], 0.0, allowed)?;
            } else {
                mean_gap += gap[node] / nodes as f64;
            }
            tally.not_negative("gap", gap[node], allowed)?;
        }
        ensure!(
            state.contact_nodes == contact.len(),
            "{} nodes are in contact, not {}",
            contact.len(),
            state.contact_nodes
        );
        tally.close("mean gap", found.mean_gap, mean_gap, rounding)?;
        let rms_height = dense.gap().variance().sqrt();
        let approach = dense.own_length(state.approach);
        let expected = rms_height.max(approach).max(dense.own_displacement(sum));
        if expected > 0.0 {
            let length = dense.own_length(solution.certificate.length);
            tally.close("length of errors", length, expected, rounding)?;
        }
        let energy = 0.5 * (pressure.dot(&displacement) - dense.gauge() * sum * sum);
        tally.close("energy", found.energy, energy, rounding * sum)?;
        self.check_stiffness(solution, &contact, &mut tally)?;
        self.check_target(solution, target)?;
        self.check_path(state, &pressure, &contact, allowed, &mut tally)?;
        tally.checked += 1;
        Ok(tally)
    }

    /// Stiffnesses are those of the contact of the solution.
    fn check_stiffness(
        &self,
        solution: &FixedLoadSolution,
        contact: &[usize],
        tally: &mut Tally,
    ) -> Result<(), Violation> {
        if solution.contact.interfacial_stiffness.is_none() {
            ensure!(!self.settings.stiffness, "there is no stiffness");
            return Ok(());
        }
        // Iterations end at half the tolerance, and so does what steps in single precision are estimated to spoil; on
        // cells of 8000 : 1 that was some three times as much.
        let set = ContactSet::new(&self.dense, contact, 2.0 * self.settings.tolerance);
        match set.filter(|set| set.closing_error < 0.1) {
            Some(set) => {
                let found = self.dense.scalars(&solution.contact);
                rates_are_those_of(&set, (solution, &found), self.grid.cell_area(), tally)
            }
            None => Ok(()),
        }
    }

    /// What the gaps of a solution may be off by.
    fn gap_error(&self, state: &ContactState) -> f64 {
        let own = self.dense.own_displacement(self.dense.scalars(state).sum);
        self.settings.tolerance * self.dense.own_length(state.approach).max(own)
    }

    fn check_target(
        &self,
        solution: &FixedLoadSolution,
        target: ContactTarget,
    ) -> Result<(), Violation> {
        let state = &solution.contact;
        let tolerance = self.settings.tolerance;
        let is_there = match target {
            ContactTarget::Load(load) => state.load == load,
            ContactTarget::Approach(approach) => {
                (state.approach - approach).abs() <= tolerance * approach
            }
            ContactTarget::MeanGap(mean_gap) => {
                let off = (state.mean_gap - mean_gap).abs();
                let rounding = MEAN_GAP_ROUNDING * self.unloaded();
                self.dense.own_length(off) <= self.gap_error(state) || off <= rounding
            }
            ContactTarget::AreaFraction(fraction) => {
                self.grid.nodes_in(fraction).ok() == Some(state.contact_nodes)
                    || self.may_be_missed(fraction)
            }
            _ => true,
        };
        ensure!(is_there, "{state:?} is not at the target");
        Ok(())
    }

    /// The state of the path at the same load.
    ///
    /// With the pressures p and gaps w of the solution and p*, w* of the path the difference d = p − p* of two
    /// pressures of one sum has `dᵀ C d = dᵀ (w − w*) ≤ pᵀ w − p*ᵀ w`, because neither p nor w* is negative and `p*ᵀ w*
    /// = 0`: at most the sums of both times the greatest gap in contact or overlap.
    fn check_path(
        &self,
        state: &ContactState,
        pressure: &DVector<f64>,
        contact: &[usize],
        allowed: f64,
        tally: &mut Tally,
    ) -> Result<(), Violation> {
        let Some(exact) = self.history.at_load(state.load) else {
            // Of a flat surface, or one whose path has ended.
            return Ok(());
        };
        let Some((set, order)) = self.contact_of(&exact)? else {
            return Ok(());
        };
        let found = self.dense.of(&exact);
        let instant = set.at(found.own_approach);
        let difference = pressure - &instant.pressure;
        let sums = pressure.sum() + instant.pressure.abs().sum();
        let (displacement, _) = self.dense.displace(&difference);
        let energy = difference.dot(&displacement);
        let allowed = allowed + instant.gap_error;
        tally.not_negative("energy of a difference", energy, sums * allowed)?;
        tally.close("energy of a difference", energy, 0.0, sums * allowed)?;
        let mut same: Vec<usize> = order;
        same.sort_unstable();
        if same == contact {
            // Then `C_II d = Δδ e + r`, of which the sum of d leaves nothing but r.
            let own = self.dense.own_approach(state.approach, state.load);
            let error = set.sum_error(allowed) / set.rate.sum().abs();
            tally.close("approach of the path", own, found.own_approach, error + allowed)?;
        }
        Ok(())
    }

    /// The equations of the contact of a state of the path, and its nodes.
    fn contact_of(
        &self,
        state: &LoadingState,
    ) -> Result<Option<(ContactSet<'_>, Vec<usize>)>, Violation> {
        let mut walk = Walk::new(&self.dense, self.grid, Demands::EXACT);
        let events = self.history.events();
        let steps = events.partition_point(|event| event.step <= state.step);
        walk.skip(&events[..steps])?;
        let nodes = walk.contact().to_vec();
        Ok(ContactSet::new(&self.dense, &nodes, 0.0).map(|set| (set, nodes)))
    }
}

/// Stiffnesses, the pressure of each newton and what is lost of it are those of a set of nodes in contact.
pub(crate) fn rates_are_those_of(
    set: &ContactSet<'_>,
    (solution, found): (&FixedLoadSolution, &Scalars),
    cell_area: f64,
    tally: &mut Tally,
) -> Result<(), Violation> {
    set.check_rates(found, tally)?;
    let [(_, error), _] = set.stiffnesses();
    let area = cell_area * set.rate.sum();
    let allowed = (set.rate_error() + error * set.rate.amax()) / area.abs();
    for (found, rate) in solution.pressure_rate.iter().zip(set.rate.iter()) {
        tally.close("rate of pressure", *found, rate / area, allowed)?;
    }
    Ok(())
}
