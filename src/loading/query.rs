//! What a path can be asked at its present state.

use nalgebra::DMatrix;

use super::certificate::Certificate;
use super::solver::{LoadingSolver, LoadingTimings};
use super::state::ContactState;
use crate::updater::LinearUpdater;
use crate::{Error, Grid, InfluenceKernel, Surface};

impl<S: Surface, K: InfluenceKernel, U: LinearUpdater> LoadingSolver<S, K, U> {
    /// The surface that touches.
    pub fn surface(&self) -> &S {
        &self.surface
    }

    /// The kernel of the half-space.
    pub fn kernel(&self) -> &K {
        &self.kernel
    }

    /// The updater.
    pub fn updater(&self) -> &U {
        &self.updater
    }

    /// Where the time went so far, beside the updater.
    #[must_use]
    pub fn timings(&self) -> LoadingTimings {
        self.timings
    }

    /// The grid of both.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// The present state: the last one yielded, `None` before the first.
    #[must_use]
    pub fn state(&self) -> Option<ContactState> {
        self.state
    }

    /// Node indices in contact, in the order in which they touched.
    #[must_use]
    pub fn contact_order(&self) -> &[usize] {
        &self.contact[..self.state.map_or(0, |state| state.contact_nodes)]
    }

    /// Which nodes are in contact at the present state.
    #[must_use]
    pub fn contact_map(&self) -> DMatrix<bool> {
        let (nx, ny) = self.grid.shape();
        let mut map = DMatrix::from_element(nx, ny, false);
        for &node in self.contact_order() {
            map.as_mut_slice()[node] = true;
        }
        map
    }

    /// Pressure \[Pa\] at the present state, zero before the first.
    ///
    /// One backward substitution with the factor at hand.
    ///
    /// # Errors
    ///
    /// Those of the updater.
    pub fn pressure(&mut self) -> Result<DMatrix<f64>, Error> {
        match self.state {
            Some(state) => self.pressure_at(&state),
            None => Ok(DMatrix::zeros(self.grid.nx(), self.grid.ny())),
        }
    }

    /// Pressure \[Pa\] at any state of this path up to the present one, or at a state between two
    /// events obtained from [`ContactState::at_load`] and its kin.
    ///
    /// Any state is a prefix of one factor, and costs one backward substitution; but states before
    /// the last node that *left* the contact are not, and cost a factor of their own, n³/3 for n
    /// nodes in contact.
    ///
    /// # Errors
    ///
    /// [`Error::StateNotReached`] if the state lies beyond the present one; those of the updater;
    /// before the last node that left, [`Error::MemoryBudget`] and [`Error::FactorizationFailed`].
    pub fn pressure_at(&mut self, state: &ContactState) -> Result<DMatrix<f64>, Error> {
        let step = state.step;
        let present = self.state.map_or(0, |state| state.step);
        if step > present {
            return Err(Error::StateNotReached { step, present });
        }
        let contact = self.solve_at(step)?;
        let approach = self.gauged_approach(state);
        let mut pressure = DMatrix::zeros(self.grid.nx(), self.grid.ny());
        let values = pressure.as_mut_slice();
        let solution = self.solution.y1.iter().zip(&self.solution.y2);
        for (node, (y1, y2)) in contact.into_iter().zip(solution) {
            values[node] = y1 + approach * y2;
        }
        Ok(pressure)
    }

    /// Displacement of the half-space \[m\] at the present state, positive into it; about its mean
    /// if the half-space is periodic.
    ///
    /// # Errors
    ///
    /// Those of [`Self::pressure`].
    pub fn displacement(&mut self) -> Result<DMatrix<f64>, Error> {
        let pressure = self.pressure()?;
        // What the gauge adds everywhere.
        let uniform = self.gauge * self.state.map_or(0.0, |state| state.load);
        let field = self.fields.displacement(pressure.as_slice())?.iter();
        let (nx, ny) = self.grid.shape();
        Ok(DMatrix::from_iterator(nx, ny, field.map(|u| u - uniform)))
    }

    /// Gap \[m\] at the present state, $g + u - \delta$: zero in contact but for rounding.
    ///
    /// # Errors
    ///
    /// Those of [`Self::pressure`].
    pub fn gap(&mut self) -> Result<DMatrix<f64>, Error> {
        let approach = self.state.map_or(0.0, |state| state.approach);
        let mut gap = self.displacement()?;
        for (value, initial) in gap.iter_mut().zip(self.system.gap()) {
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
        let state = self.state;
        let contact = self.contact_map();
        let pressure = self.pressure()?;
        let approach = state.map_or(0.0, |state| self.gauged_approach(&state));
        let displacement = self.fields.displacement(pressure.as_slice())?;
        let gaps = self
            .system
            .gap()
            .iter()
            .zip(displacement)
            .map(|(g, u)| g + u - approach);
        let nodes = pressure
            .iter()
            .copied()
            .zip(gaps)
            .zip(contact.iter().copied());
        let load = state.map_or(0.0, |state| state.load);
        Ok(Certificate::of(
            nodes,
            load / self.grid.cell_area(),
            [self.rms_height, approach],
        ))
    }

    /// The approach of a state in the gauge of the kernel, in which $u = C p$; that of the state
    /// itself if the half-space is free.
    pub(super) fn gauged_approach(&self, state: &ContactState) -> f64 {
        state.approach + self.gauge * state.load
    }
}
