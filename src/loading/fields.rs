//! Fields of the states of a path, computed on demand.

use nalgebra::DMatrix;

use super::path::LoadingPath;
use super::snapshot::Snapshot;
use super::state::LoadingState;
use crate::contact::{Certificate, Conditions, ContactFields, ErrorLength};
use crate::{Error, HeightMap};

impl LoadingPath {
    /// Node indices in contact at the present state, in the order in which they touched.
    #[must_use]
    pub fn contact_order(&self) -> Vec<usize> {
        self.order_at(self.state.map_or(0, |state| state.step))
    }

    /// Which nodes are in contact at the present state.
    #[must_use]
    pub fn contact_map(&self) -> DMatrix<bool> {
        self.map_of(self.state.map_or(0, |state| state.step))
    }

    /// The same at any state up to the present one.
    ///
    /// # Errors
    ///
    /// [`Error::StateNotReached`].
    pub fn contact_map_at(&self, state: &LoadingState) -> Result<DMatrix<bool>, Error> {
        self.check_reached(state)?;
        Ok(self.map_of(state.step))
    }

    fn map_of(&self, step: usize) -> DMatrix<bool> {
        let (nx, ny) = self.grid().shape();
        let mut map = DMatrix::from_element(nx, ny, false);
        for node in self.order_at(step) {
            map.as_mut_slice()[node] = true;
        }
        map
    }

    fn order_at(&self, step: usize) -> Vec<usize> {
        let releases = &self.run.releases;
        releases.with_yielded(releases.contact_at(self.run.contact.order(), step), step)
    }

    /// Which nodes have yielded at a state up to the present one, with a [hardness](super::LoadingBuilder::hardness).
    ///
    /// # Errors
    ///
    /// [`Error::StateNotReached`].
    pub fn yielded_map_at(&self, state: &LoadingState) -> Result<DMatrix<bool>, Error> {
        self.check_reached(state)?;
        Ok(self.yielded_by(state.step))
    }

    fn yielded_by(&self, step: usize) -> DMatrix<bool> {
        let mut map = DMatrix::from_element(self.grid().nx(), self.grid().ny(), false);
        for node in self.run.releases.yielded_at(step) {
            map.as_mut_slice()[node] = true;
        }
        map
    }

    /// Pressure, gap, displacement, maps and plastic depth of the present state, without contact before the first: one
    /// backward substitution with the factor at hand, and one convolution. The window of a state may have gone on to
    /// nodes that leave or yield: see [`Self::fields_at`]. No pressure is negative: tension within the error of a
    /// state, as on a node that has just touched, is zero.
    ///
    /// # Errors
    ///
    /// [`Error::NotOnPath`] for more tension than that; those of [`Self::fields_at`].
    pub fn fields(&mut self) -> Result<ContactFields, Error> {
        let pressure = self.solved()?;
        self.fields_under(pressure, self.state)
    }

    /// The same at any state of this path up to the present one, or at a state between two events
    /// that [`History`](super::History) has read.
    ///
    /// Any state is a prefix of one factor, and costs one backward substitution. States before the last node that
    /// *left* the contact or *yielded* are no such prefix, and cost a factor of their own, n³/3 flops for n nodes in
    /// contact. Without a factor a state costs a solution; one before the last node that left or yielded takes as much
    /// memory again as iterations, or as a factor of its contact if nothing yields and that is less.
    ///
    /// # Errors
    ///
    /// [`Error::StateNotReached`] if the state lies beyond the present one; [`Error::NotOnPath`] if it is not
    /// a state of this path; those of the updater, of iterations [`Error::NoConvergence`]; before the last node that
    /// left or yielded, [`Error::MemoryBudget`] and [`Error::FactorizationFailed`].
    pub fn fields_at(&mut self, state: &LoadingState) -> Result<ContactFields, Error> {
        let pressure = self.solved_at(state)?;
        self.fields_under(pressure, Some(*state))
    }

    /// Fields under a pressure as it was solved for.
    fn fields_under(
        &mut self,
        pressure: DMatrix<f64>,
        state: Option<LoadingState>,
    ) -> Result<ContactFields, Error> {
        let (step, load, approach) = state.map_or((0, 0.0, 0.0), |state| {
            (state.step, state.contact.load, state.contact.approach)
        });
        let displacement = self.displacement_under(&pressure, load)?;
        let yielded_map = self.yielded_by(step);
        let total_gap = self.total_gap_over(&displacement, approach);
        let gap =
            total_gap.zip_map(&yielded_map, |gap, has_yielded| if has_yielded { 0.0 } else { gap });
        Ok(ContactFields {
            pressure: pressure.map(without_tension),
            gap,
            displacement,
            contact_map: self.map_of(step),
            plastic_depth: total_gap.zip_map(&yielded_map, depth),
            yielded_map,
        })
    }

    /// The surface with the plastic depth of the present state taken off, from its highest node before: none of its
    /// heights \[m\] is positive.
    ///
    /// Its elastic contact is that of unloading from this state, and of loading again up to it (flow rule of perfect
    /// plasticity; gaps only close on loading). Beyond, the path of the first surface goes on.
    ///
    /// # Errors
    ///
    /// Those of [`Self::fields`].
    pub fn residual_surface(&mut self) -> Result<HeightMap, Error> {
        let fields = self.fields()?;
        self.without(&fields.plastic_depth)
    }

    /// The same at any state up to the present one: see [`Self::fields_at`].
    ///
    /// # Errors
    ///
    /// Those of [`Self::fields_at`].
    pub fn residual_surface_at(&mut self, state: &LoadingState) -> Result<HeightMap, Error> {
        let fields = self.fields_at(state)?;
        self.without(&fields.plastic_depth)
    }

    fn without(&self, depth: &DMatrix<f64>) -> Result<HeightMap, Error> {
        let heights = self.problem().initial_gap().iter().zip(depth).map(|(gap, v)| -(gap + v));
        let (nx, ny) = depth.shape();
        Ok(HeightMap::new(DMatrix::from_iterator(nx, ny, heights))?)
    }

    pub(super) fn check_reached(&self, state: &LoadingState) -> Result<(), Error> {
        let (step, present) = (state.step, self.state.map_or(0, |state| state.step));
        if step > present {
            return Err(Error::StateNotReached { step, present });
        }
        Ok(())
    }

    /// The pressure alone at a state: see [`Self::fields_at`].
    pub(crate) fn pressure_at(&mut self, state: &LoadingState) -> Result<DMatrix<f64>, Error> {
        Ok(self.solved_at(state)?.map(without_tension))
    }

    /// The pressure of the present state as it was solved for. Gaps in contact are closed under it; with tension set to
    /// zero they would not be.
    fn solved(&mut self) -> Result<DMatrix<f64>, Error> {
        let Some(state) = self.state else {
            return Ok(DMatrix::zeros(self.grid().nx(), self.grid().ny()));
        };
        let snapshot = Snapshot::of(&self.run, &mut self.phase, &state)?;
        snapshot.check_tension(&self.run, self.phase.tolerance(), &state)?;
        Ok(snapshot.pressure)
    }

    fn solved_at(&mut self, state: &LoadingState) -> Result<DMatrix<f64>, Error> {
        self.check_reached(state)?;
        let snapshot = Snapshot::of(&self.run, &mut self.phase, state)?;
        snapshot.recognise(&mut self.run, &self.phase, state)?;
        Ok(snapshot.pressure)
    }

    fn displacement_under(
        &mut self,
        pressure: &DMatrix<f64>,
        load: f64,
    ) -> Result<DMatrix<f64>, Error> {
        let uniform = self.run.scalars.uniform_displacement(load);
        let field = self.run.field.displace(pressure.as_slice())?.iter();
        let (nx, ny) = pressure.shape();
        Ok(DMatrix::from_iterator(nx, ny, field.map(|u| u - uniform)))
    }

    /// Gaps `g + u − δ`: minus the plastic depth where nodes have yielded.
    fn total_gap_over(&self, displacement: &DMatrix<f64>, approach: f64) -> DMatrix<f64> {
        let mut gap = displacement.clone();
        for (value, initial) in gap.iter_mut().zip(self.problem().initial_gap()) {
            *value = initial + *value - approach;
        }
        gap
    }

    /// How well the present state fulfils the conditions of contact, computed afresh.
    ///
    /// # Errors
    ///
    /// Those of [`Self::fields`].
    pub fn certificate(&mut self) -> Result<Certificate, Error> {
        let pressure = self.solved()?;
        self.certify(&pressure, self.state)
    }

    /// The same at any state up to the present one: see [`Self::fields_at`].
    ///
    /// # Errors
    ///
    /// Those of [`Self::fields_at`].
    pub fn certificate_at(&mut self, state: &LoadingState) -> Result<Certificate, Error> {
        let pressure = self.solved_at(state)?;
        self.certify(&pressure, Some(*state))
    }

    /// How well a pressure fulfils the conditions of contact at a state.
    fn certify(
        &mut self,
        pressure: &DMatrix<f64>,
        state: Option<LoadingState>,
    ) -> Result<Certificate, Error> {
        let step = state.map_or(0, |state| state.step);
        let (contact, yielded) = (self.map_of(step), self.yielded_by(step));
        let state = state.map(|state| state.contact);
        let run = &mut self.run;
        let gap: &[f64] = match &run.plastic {
            Some(plastic) => plastic.surface().initial_gap(),
            None => run.problem.initial_gap(),
        };
        let approach = state.map_or(0.0, |state| run.scalars.own_approach(&state));
        let reported = state.map_or(0.0, |state| state.approach);
        let gaps = run.field.displace(pressure.as_slice())?;
        let gaps = gaps.iter().zip(gap).zip(&yielded);
        // Yielded nodes overlap by their plastic depth.
        let gaps = gaps.map(|((u, g), has_yielded)| {
            let gap = g + u - approach;
            if *has_yielded { gap.max(0.0) } else { gap }
        });
        let nodes = pressure.iter().zip(gaps).zip(&contact);
        let nodes = nodes.map(|((p, gap), in_contact)| (*p, gap, *in_contact));
        let load = state.map_or(0.0, |state| state.load);
        let scale = ErrorLength::new(run.problem.rms_height(), run.problem.table());
        let sum = load / run.problem.grid().cell_area();
        let certificate = Conditions::new(sum, reported, scale).check(nodes);
        Ok(match &run.plastic {
            Some(plastic) => {
                let hardness = plastic.hardness().values().iter().copied();
                certificate.with_hardness(pressure.iter().copied().zip(hardness))
            }
            None => certificate,
        })
    }

    /// `Ok` if the present state fulfils the conditions of contact as well as the solution of this path can: load,
    /// pressures and gaps are right to 10⁻⁶, and to 10⁻⁴ where the approach of its event is an estimate. An exact path
    /// is right to some 10⁻¹², so that what is refused is no rounding.
    ///
    /// # Errors
    ///
    /// [`Error::NotOnPath`] with what is wrong, and those of [`Self::fields`].
    pub fn verify(&mut self) -> Result<(), Error> {
        let Some(state) = self.state else {
            return Ok(());
        };
        let certificate = self.certificate()?;
        let snapshot = Snapshot::of(&self.run, &mut self.phase, &state)?;
        snapshot.recognise(&mut self.run, &self.phase, &state)?;
        snapshot.check_gaps(&self.run, &state, &certificate)
    }
}

/// A pressure, if tension within the error of a state is none.
fn without_tension(pressure: f64) -> f64 {
    // NaN stays.
    if pressure <= 0.0 { 0.0 } else { pressure }
}

/// The plastic depth of a node.
fn depth(total_gap: f64, has_yielded: bool) -> f64 {
    // What rounds is none.
    if has_yielded { (-total_gap).max(0.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loading::LoadingSolver;
    use crate::{ContactTarget, test_chain};

    /// Nodes 0 and 2 touch at 0 and at the approach 1, and the path ends at 3, where they carry 3/4 and 1/2.
    fn path() -> Result<(LoadingSolver, Vec<LoadingState>), Error> {
        let (surface, kernel) =
            (test_chain::surface(&[0.0, 9.0, 1.0, 9.0])?, test_chain::kernel(4)?);
        let builder = LoadingSolver::builder(&surface, &kernel).until(ContactTarget::Approach(3.0));
        let mut path = builder.build()?;
        assert!(path.contact_order().is_empty() && !path.contact_map().iter().any(|is_in| *is_in));
        assert_eq!(
            (path.fields()?.pressure, path.fields()?.max_pressure()),
            (DMatrix::zeros(4, 1), 0.0)
        );
        let states = path.by_ref().collect::<Result<Vec<_>, _>>()?;
        assert_eq!(states.len(), 3);
        Ok((path, states))
    }

    fn near(found: &DMatrix<f64>, expected: [f64; 4]) {
        assert_eq!(found.shape(), (4, 1));
        for (found, expected) in found.iter().zip(expected) {
            // Rounding errors of a transform of numbers up to 9.
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
    }

    #[test]
    fn fields_of_the_present_state() -> Result<(), Error> {
        let (mut path, _) = path()?;
        assert_eq!(path.contact_order(), [0, 2]);
        assert_eq!(path.contact_map().as_slice(), [true, false, true, false]);
        near(&path.fields()?.pressure, [0.75, 0.0, 0.5, 0.0]);
        near(&path.fields()?.displacement, [3.0, 1.25, 2.0, 0.5]);
        near(&path.fields()?.gap, [0.0, 7.25, 0.0, 6.5]);
        assert!((path.fields()?.max_pressure() - 0.75).abs() < 1e-15);
        // The mean pressure in contact is 5/8; heights have the root mean square 4.26.
        let found = path.certificate()?;
        let squares: f64 = [4.75, 4.25, 3.75, 4.25].iter().map(|h: &f64| h * h).sum();
        let length = (squares / 4.0).sqrt();
        for (found, expected) in [
            (found.length, length),
            (found.least_pressure, 0.8),
            (found.least_gap, 6.5 / length),
            (found.greatest_contact_gap, 0.0),
            (found.load_error, 0.0),
        ] {
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
        Ok(())
    }

    /// Every state of the path passes. Invented ones do not: an approach at which a node in contact is pulled, one at
    /// which a node beside them overlaps, and one that is no number.
    #[test]
    fn what_is_no_state_of_contact_is_refused() -> Result<(), Error> {
        let (mut path, states) = path()?;
        path.verify()?;
        let last = states[2];
        // Both nodes are in contact from the approach 1 on; below it the second one is pulled.
        let invented = last.contact.at_approach(0.5).unwrap_or(last.contact);
        path.state = Some(last.with(invented));
        let refused = path.verify();
        assert!(
            matches!(refused, Err(Error::NotOnPath { quantity: "least pressure in contact", value, .. }) if value < -0.1),
            "{refused:?}"
        );
        let invented = last.contact.at_approach(15.0).unwrap_or(last.contact);
        path.state = Some(last.with(invented));
        let refused = path.verify();
        assert!(
            matches!(refused, Err(Error::NotOnPath { quantity: "least gap out of contact", value, .. }) if value < -0.5),
            "{refused:?}"
        );
        let mut lost = last;
        lost.contact.approach = f64::NAN;
        path.state = Some(lost);
        assert!(path.verify().is_err());
        path.state = None;
        path.verify()
    }

    #[test]
    fn fields_of_earlier_states() -> Result<(), Error> {
        let (mut path, states) = path()?;
        let [first, second, _] = states[..] else {
            unreachable!("three states");
        };
        assert_eq!(path.contact_map_at(&first)?.as_slice(), [true, false, false, false]);
        assert_eq!(path.contact_map_at(&second)?.as_slice(), [true, false, true, false]);
        near(&path.pressure_at(&first)?, [0.0; 4]);
        near(&path.pressure_at(&second)?, [0.25, 0.0, 0.0, 0.0]);
        near(&path.fields_at(&second)?.displacement, [1.0, 0.25, 0.0, 0.0]);
        near(&path.fields_at(&second)?.gap, [0.0, 8.25, 0.0, 8.0]);
        // As found there: the second node has no pressure yet, and the least gap is 8.
        let found = path.certificate_at(&second)?;
        assert!((found.least_gap * found.length - 8.0).abs() < 1e-13, "{found:?}");
        assert!(found.least_pressure.abs() < 1e-13, "{found:?}");
        let last = path.present()?;
        assert_eq!(path.certificate_at(&last)?, path.certificate()?);
        let mut beyond = second;
        beyond.step = 3;
        for refused in [path.contact_map_at(&beyond).err(), path.pressure_at(&beyond).err()] {
            assert!(matches!(refused, Some(Error::StateNotReached { step: 3, present: 2 })));
        }
        Ok(())
    }

    /// Where the mean displacement is arbitrary displacements are about their mean.
    #[test]
    fn displacements_are_about_their_mean() -> Result<(), Error> {
        let kernel = crate::PeriodicBoussinesq::new(crate::Grid::new(6, 6, 1.0, 1.0)?, 1.0)?;
        let surface = crate::HeightMap::new(DMatrix::from_fn(6, 6, |ix, iy| {
            -(ix as f64 - 2.3).powi(2) - (iy as f64 - 3.1).powi(2)
        }))?;
        let mut path = LoadingSolver::builder(&surface, &kernel).max_nodes(5).build()?;
        let states = path.by_ref().collect::<Result<Vec<_>, _>>()?;
        let mut greatest = 0.0_f64;
        for state in &states {
            let displacement = path.fields_at(state)?.displacement;
            greatest = greatest.max(displacement.max());
            assert!(displacement.mean().abs() < 1e-12 * greatest.max(1.0));
        }
        assert!(greatest > 0.1, "{greatest}");
        Ok(())
    }
}
