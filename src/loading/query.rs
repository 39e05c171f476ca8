//! What a path can be asked.

use nalgebra::DMatrix;

use super::limits::LoadingEnd;
use super::run::LoadingTimings;
use super::solver::{LoadingSolver, Procedure};
use super::state::LoadingState;
use crate::contact::{Certificate, Conditions, LengthScale};
use crate::updater::{LinearUpdater, Solution};
use crate::{Error, Grid, Problem};

/// How far a state of this path may be off, relative to its load, pressures and lengths, to be recognised:
/// states of an updater in mixed precision err by some 1e-7.
const RECOGNISED: f64 = 1e-6;

impl<U: LinearUpdater> LoadingSolver<U> {
    /// The contact problem.
    #[must_use]
    pub fn problem(&self) -> &Problem {
        &self.run.problem
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.run.problem.grid()
    }

    /// The updater.
    #[must_use]
    pub fn updater(&self) -> &U {
        &self.run.updater
    }

    /// Where the time went so far, besides the updater.
    #[must_use]
    pub fn timings(&self) -> LoadingTimings {
        self.run.timings
    }

    /// Why the path has ended; `None` while there is more to come.
    #[must_use]
    pub fn end(&self) -> Option<LoadingEnd> {
        self.end
    }

    /// The present state: the last one yielded, `None` before the first.
    #[must_use]
    pub fn state(&self) -> Option<LoadingState> {
        self.state
    }

    /// Bytes held at present, with `contact_nodes` of the present state in contact.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let run = &self.run;
        run.fixed_bytes()
            .saturating_add(run.updater.bytes(run.contact.len(), 0))
    }

    /// Node indices in contact at the present state, in the order in which they touched.
    #[must_use]
    pub fn contact_order(&self) -> Vec<usize> {
        let step = self.state.map_or(0, |state| state.step);
        let run = &self.run;
        run.releases.contact_at(run.contact.order(), step)
    }

    /// Which nodes are in contact at the present state.
    #[must_use]
    pub fn contact_map(&self) -> DMatrix<bool> {
        let (nx, ny) = self.grid().shape();
        let mut map = DMatrix::from_element(nx, ny, false);
        for node in self.contact_order() {
            map.as_mut_slice()[node] = true;
        }
        map
    }

    /// Pressure \[Pa\] at the present state, zero before the first: one backward substitution with the
    /// factor at hand.
    ///
    /// # Errors
    ///
    /// Those of the updater.
    pub fn pressure(&mut self) -> Result<DMatrix<f64>, Error> {
        match self.state {
            Some(state) => Ok(self.solve(&state)?.pressure),
            None => Ok(DMatrix::zeros(self.grid().nx(), self.grid().ny())),
        }
    }

    /// Pressure \[Pa\] at any state of this path up to the present one, or at a state between two events
    /// that [`History`](super::History) has read.
    ///
    /// Any state is a prefix of one factor, and costs one backward substitution. States before the last node
    /// that *left* the contact are no such prefix, and cost a factor of their own, n³/3 flops for n nodes in
    /// contact.
    ///
    /// # Errors
    ///
    /// [`Error::StateNotReached`] if the state lies beyond the present one; [`Error::NotOnPath`] if it is not
    /// a state of this path; those of the updater; before the last node that left,
    /// [`Error::MemoryBudget`] and [`Error::FactorizationFailed`].
    pub fn pressure_at(&mut self, state: &LoadingState) -> Result<DMatrix<f64>, Error> {
        let (step, present) = (state.step, self.state.map_or(0, |state| state.step));
        if step > present {
            return Err(Error::StateNotReached { step, present });
        }
        let solved = self.solve(state)?;
        self.recognise(state, &solved)?;
        Ok(solved.pressure)
    }

    /// Displacement of the half-space \[m\] at the present state, positive into it; about its mean if the
    /// half-space is periodic and its mean displacement arbitrary.
    ///
    /// # Errors
    ///
    /// Those of [`Self::pressure`].
    pub fn displacement(&mut self) -> Result<DMatrix<f64>, Error> {
        let pressure = self.pressure()?;
        let load = self.state.map_or(0.0, |state| state.load);
        let uniform = self.run.front.uniform_displacement(load);
        let field = self.run.field.displace(pressure.as_slice())?.iter();
        let (nx, ny) = pressure.shape();
        Ok(DMatrix::from_iterator(nx, ny, field.map(|u| u - uniform)))
    }

    /// Gap `g + u − δ` \[m\] at the present state: zero in contact, to rounding.
    ///
    /// # Errors
    ///
    /// Those of [`Self::pressure`].
    pub fn gap(&mut self) -> Result<DMatrix<f64>, Error> {
        let approach = self.state.map_or(0.0, |state| state.approach);
        let mut gap = self.displacement()?;
        for (value, initial) in gap.iter_mut().zip(self.run.problem.initial_gap()) {
            *value = initial + *value - approach;
        }
        Ok(gap)
    }

    /// Greatest pressure \[Pa\] at the present state.
    ///
    /// # Errors
    ///
    /// Those of [`Self::pressure`].
    pub fn max_pressure(&mut self) -> Result<f64, Error> {
        Ok(self.pressure()?.iter().copied().fold(0.0, f64::max))
    }

    /// How well the present state fulfils the conditions of contact, computed afresh.
    ///
    /// # Errors
    ///
    /// Those of [`Self::pressure`].
    pub fn certificate(&mut self) -> Result<Certificate, Error> {
        let contact = self.contact_map();
        let pressure = self.pressure()?;
        let state = self.state.map(|state| state.contact);
        let run = &mut self.run;
        let approach = state.map_or(0.0, |state| run.front.own_approach(&state));
        let reported = state.map_or(0.0, |state| state.approach);
        let gaps = run.field.displace(pressure.as_slice())?;
        let gaps = gaps.iter().zip(run.problem.initial_gap());
        let gaps = gaps.map(|(u, g)| g + u - approach);
        let nodes = pressure.iter().zip(gaps).zip(&contact);
        let nodes = nodes.map(|((p, gap), in_contact)| (*p, gap, *in_contact));
        let load = state.map_or(0.0, |state| state.load);
        let scale = LengthScale::new(run.problem.rms_height(), run.problem.table());
        let sum = load / run.problem.grid().cell_area();
        Ok(Conditions::new(sum, reported, scale).check(nodes))
    }

    /// The solution at a state of this path.
    fn solve(&mut self, state: &LoadingState) -> Result<Solved, Error> {
        let mut solution = Solution::default();
        let nodes = self.run.solve_at(state.step, &mut solution)?;
        let approach = self.run.front.own_approach(state);
        let (nx, ny) = self.grid().shape();
        let mut pressure = DMatrix::zeros(nx, ny);
        let values = pressure.as_mut_slice();
        for (&node, (y1, y2)) in nodes.iter().zip(solution.y1.iter().zip(&solution.y2)) {
            values[node] = y1 + approach * y2;
        }
        Ok(Solved {
            stiffness: self.grid().cell_area() * solution.y2.iter().sum::<f64>(),
            nodes,
            approach,
            pressure,
        })
    }

    /// `Ok` if a solution with the nodes and the approach of a state has its load, and pressures and gaps that
    /// a state has.
    fn recognise(&mut self, state: &LoadingState, solved: &Solved) -> Result<(), Error> {
        let refused = |quantity, value, expected| {
            Err(Error::NotOnPath {
                step: state.step,
                load: state.load,
                approach: state.approach,
                quantity,
                value,
                expected,
            })
        };
        let load = self.grid().cell_area() * solved.pressure.iter().sum::<f64>();
        let scale = load.abs().max(solved.stiffness * solved.approach);
        // At first touch nothing is left but the rounding of lengths as long as the greatest gap.
        let rounding = f64::EPSILON * solved.stiffness * self.run.problem.greatest_gap();
        // NaN is refused as well.
        let same_load = (load - state.load).abs() <= (RECOGNISED * scale).max(rounding);
        if !same_load || !state.approach.is_finite() {
            return refused("load", load, "the load of the state");
        }
        if let Procedure::Paper(_) = self.procedure {
            return Ok(());
        }
        let least = solved.nodes.iter().map(|&node| solved.pressure[node]);
        let least = least.fold(f64::INFINITY, f64::min);
        let rounding = rounding / self.grid().cell_area();
        if least < -(RECOGNISED * solved.pressure.max()).max(rounding) {
            return refused("least pressure in contact", least, "no tension");
        }
        let overlap = self.worst_overlap(state.step, solved)?;
        let length = self.run.problem.greatest_gap() + solved.approach.abs();
        if overlap < -RECOGNISED * length {
            return refused("least gap out of contact", overlap, "no overlap");
        }
        Ok(())
    }

    /// The gap of the node that touches next, which is the first to overlap; of all nodes out of contact if
    /// the next one is not known.
    fn worst_overlap(&mut self, step: usize, solved: &Solved) -> Result<f64, Error> {
        let run = &mut self.run;
        let gap = run.problem.initial_gap();
        if step < run.steps() {
            let next = run.releases.contact_at(run.contact.order(), step + 1);
            let Some(&node) = next.last().filter(|_| next.len() > solved.nodes.len()) else {
                // One that leaves: its pressure has been looked at.
                return Ok(0.0);
            };
            let table = run.problem.table();
            let place = table.place(node);
            let terms = solved.nodes.iter();
            let terms = terms
                .map(|&other| table.between(place, table.place(other)) * solved.pressure[other]);
            return Ok(gap[node] + terms.sum::<f64>() - solved.approach);
        }
        if solved.nodes.len() == gap.len() {
            return Ok(0.0);
        }
        let mut in_contact = vec![false; gap.len()];
        for &node in &solved.nodes {
            in_contact[node] = true;
        }
        let displacement = run.field.displace(solved.pressure.as_slice())?;
        let gaps = gap.iter().zip(displacement).zip(&in_contact);
        let out = gaps.filter(|(_, in_contact)| !**in_contact);
        let least = out.map(|((g, u), _)| g + u - solved.approach);
        Ok(least.fold(f64::INFINITY, f64::min))
    }
}

/// A solution at a state.
struct Solved {
    nodes: Vec<usize>,
    /// In the gauge of the kernel.
    approach: f64,
    /// dW/dδ for that approach.
    stiffness: f64,
    pressure: DMatrix<f64>,
}
