//! The record of a path: to read, to keep, and to go on from.
//!
//! A [`LoadingRecord`] holds the surface, what kernel it was, the states and why they end: enough to read the path at
//! any load, approach, mean gap or area ([`history`](LoadingRecord::history)), to compute the fields of any of its
//! states ([`replay`](LoadingRecord::replay)), and to go on in another process ([`resume`](LoadingRecord::resume)).
//! Paths with adhesion have an [`AdhesiveRecord`].
//!
//! ```
//! use asperity::record::LoadingRecord;
//! use asperity::{Boussinesq, ContactTarget, Grid, LoadingSolver, SelfAffine};
//!
//! # fn main() -> Result<(), asperity::Error> {
//! let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
//! let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space)
//!     .max_load(500.0)
//!     .build()?;
//! let history = path.run()?;
//! let record = LoadingRecord::new(&path, history)?;
//!
//! // Fields of a state, without the path:
//! let at_100_newtons = record.history().at(ContactTarget::Load(100.0))?;
//! let mut replay = record.replay()?;
//! let pressure = replay.fields_at(&at_100_newtons)?.pressure;
//! # assert!(pressure.max() > 0.0);
//!
//! // And on to 600 N:
//! let mut path = record.resume()?;
//! path.continue_to(ContactTarget::Load(600.0))?;
//! # assert_eq!(path.last().transpose()?.map(|state| state.contact.load), Some(600.0));
//! # Ok(())
//! # }
//! ```

mod adhesive;
mod front;
mod increments;
mod kernel;
#[cfg(feature = "io")]
mod npz;
#[cfg(feature = "serde")]
mod parts;
mod stiffnesses;

pub use adhesive::AdhesiveRecord;
pub use kernel::KernelRecord;

use nalgebra::DMatrix;

use crate::contact::ContactSequence;
use crate::kernel::{InfluenceKernel, KernelOrigin, KernelTable};
use crate::loading::{
    ContactRule, History, LoadingBuilder, LoadingEnd, LoadingState, Replayed, replay,
};
use crate::surface::HeightMap;
use crate::updater::ConjugateGradient;
use crate::{
    ContactTarget, Error, Grid, LoadingPath, LoadingSolver, composite_modulus, plane_strain_modulus,
};

/// A path as a record. See the [module](self).
#[derive(Debug, Clone)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "parts::Parts", into = "parts::Parts")
)]
pub struct LoadingRecord {
    grid: Grid,
    /// Heights from the highest node.
    heights: HeightMap,
    kernel: KernelRecord,
    settings: Settings,
    history: History,
    end: Option<LoadingEnd>,
    /// Young's modulus \[Pa\] and Poisson's ratio of each elastic body.
    bodies: Vec<(f64, f64)>,
}

/// How far E* of the bodies may be from that of the kernel, relative to it: the rounding of a few operations.
const SAME_MODULUS: f64 = 1e-12;

/// The settings of a path.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Settings {
    /// Which node was taken to touch next.
    pub rule: ContactRule,
    /// Where it was to end, whichever came first.
    pub targets: Vec<ContactTarget>,
    /// The hardness, if it had one.
    #[cfg_attr(feature = "serde", serde(default))]
    pub hardness: Option<RecordedHardness>,
}

/// The hardness of a path.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum RecordedHardness {
    /// The same for all nodes \[Pa\].
    Uniform(f64),
    /// That of each node \[Pa\], x fast; `None` where it is infinite.
    Map(Vec<Option<f64>>),
}

impl RecordedHardness {
    /// Of a map.
    fn of(map: &DMatrix<f64>) -> Self {
        match map.iter().next() {
            Some(first) if map.iter().all(|value| value == first) => Self::Uniform(*first),
            _ => Self::Map(map.iter().map(|value| value.is_finite().then_some(*value)).collect()),
        }
    }

    /// Of each node of a grid.
    fn map(&self, grid: &Grid) -> Result<DMatrix<f64>, Error> {
        let (nx, ny) = grid.shape();
        match self {
            Self::Uniform(hardness) => Ok(DMatrix::from_element(nx, ny, *hardness)),
            Self::Map(values) if values.len() == grid.nodes() => {
                let values = values.iter().map(|value| value.unwrap_or(f64::INFINITY));
                Ok(DMatrix::from_iterator(nx, ny, values))
            }
            Self::Map(values) => {
                Err(Error::LengthMismatch { expected: grid.nodes(), found: values.len() })
            }
        }
    }
}

impl LoadingRecord {
    /// The record of a path and of the states that it has yielded, with the end of its last window if these are all of
    /// them.
    ///
    /// # Errors
    ///
    /// [`Error::StateNotReached`] if the last state lies beyond the present one of the path, and those of
    /// [`Self::from_parts`].
    pub fn new(path: &LoadingPath, history: History) -> Result<Self, Error> {
        let present = path.state().map_or(0, |state| state.step);
        if let Some(step) = history.states().last().map(|state| state.step)
            && step > present
        {
            return Err(Error::StateNotReached { step, present });
        }
        let events = history.events().last().map(|state| state.step);
        let reaches = events.is_some() && events == path.state().map(|state| state.step);
        let history = history.with_window_end(reaches.then(|| path.window_end()).flatten());
        let problem = path.problem();
        let grid = problem.grid();
        let heights = problem.initial_gap().iter().map(|gap| -gap);
        let (nx, ny) = grid.shape();
        let heights = HeightMap::new(DMatrix::from_iterator(nx, ny, heights))?;
        let kernel = KernelRecord::of(problem.table());
        let hardness = path.hardness_map().map(|map| RecordedHardness::of(&map));
        let settings = Settings { rule: path.rule(), targets: path.targets(), hardness };
        // Of some of the states it has not ended.
        let is_whole = events == path.state().map(|state| state.step);
        let end = path.end().filter(|_| is_whole);
        Self::from_parts(grid, heights, kernel, settings, history, end)
    }

    /// A record made of what it consists of: from a file, for example.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] for heights of another grid; [`Error::WrongBoundary`] for surroundings that the kernel
    /// does not have; [`Error::RecordNotFinite`] for a state with a scalar that no state has; [`Error::NotOnPath`],
    /// [`Error::NodeOutOfGrid`], [`Error::AlreadyInContact`] and [`Error::NotInContact`] for states that are in no order
    /// of a path; [`Error::Inconsistent`] for a number of a state that does not follow from the states before, which
    /// have the rates of all that changes between two events.
    pub fn from_parts(
        grid: Grid,
        heights: HeightMap,
        kernel: KernelRecord,
        settings: Settings,
        history: History,
        end: Option<LoadingEnd>,
    ) -> Result<Self, Error> {
        grid.check_shape(heights.shape())?;
        kernel.check_boundary()?;
        replay(&grid, &history, |_, _, _| {})?;
        for state in history.states() {
            let step = state.step;
            let not_finite = |(quantity, value)| Error::RecordNotFinite { step, quantity, value };
            state.contact.not_finite().map_or(Ok(()), |found| Err(not_finite(found)))?;
            if state.approach_error.is_nan() {
                return Err(not_finite(("estimated error of the approach", f64::NAN)));
            }
            // All kernels of this crate have one.
            if state.contact.interfacial_stiffness.is_none() && kernel.origin != KernelOrigin::Other
            {
                return Err(not_finite(("interfacial stiffness", f64::NAN)));
            }
        }
        let layering = kernel.origin.layering(kernel.boundary);
        let end_of_window = history.window_end();
        let ahead = end_of_window.map_or(&[][..], |end| &end.ahead);
        if !ahead.is_empty() {
            let events: History = history.events().iter().chain(ahead).copied().collect();
            replay(&grid, &events, |_, _, _| {})?;
        }
        let states: Vec<LoadingState> = history.states().iter().chain(ahead).copied().collect();
        let hardness =
            settings.hardness.as_ref().map(|hardness| hardness.map(&grid)).transpose()?;
        increments::check(&grid, &heights, (&kernel.origin, hardness.as_ref()), &states)?;
        if let Some(end_of_window) = end_of_window {
            front::check(&grid, &states, &end_of_window.next)?;
        }
        let history = history.on(layering);
        Ok(Self { grid, heights, kernel, settings, history, end, bodies: Vec::new() })
    }

    /// The same with the bodies, each its Young's modulus \[Pa\] and Poisson's ratio, whose composite modulus the
    /// kernel has: of one body if the other is rigid, none if only E* is known. The path does not depend on them; what
    /// is tangential does.
    ///
    /// # Errors
    ///
    /// Those of [`plane_strain_modulus`] and [`composite_modulus`]; [`Error::LengthMismatch`] for more than two, and
    /// [`Error::OutOfRange`] if their composite modulus is not that of the kernel, or if that is of layers.
    pub fn with_bodies(mut self, bodies: &[(f64, f64)]) -> Result<Self, Error> {
        let e_star = match *bodies {
            [] => None,
            [(youngs_modulus, poissons_ratio)] => {
                Some(plane_strain_modulus(youngs_modulus, poissons_ratio)?)
            }
            [first, second] => Some(composite_modulus(first, second)?),
            _ => return Err(Error::LengthMismatch { expected: 2, found: bodies.len() }),
        };
        if let Some(e_star) = e_star {
            let own = self.kernel.origin.composite_modulus().unwrap_or(f64::NAN);
            let is_same = (e_star / own - 1.0).abs() <= SAME_MODULUS;
            let expected = "that of the kernel of the path";
            Error::require("composite modulus of the bodies", e_star, is_same, expected)?;
        }
        self.bodies = bodies.to_vec();
        Ok(self)
    }

    /// Young's modulus \[Pa\] and Poisson's ratio of each elastic body, if they are known: of one if the other is
    /// rigid.
    #[must_use]
    pub fn bodies(&self) -> &[(f64, f64)] {
        &self.bodies
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Heights of the surface from its highest node \[m\]: none is positive.
    #[must_use]
    pub fn heights(&self) -> &HeightMap {
        &self.heights
    }

    /// The parameters of the kernel.
    #[must_use]
    pub fn kernel(&self) -> &KernelRecord {
        &self.kernel
    }

    /// The kernel, made again, in the gauge in which the path was followed.
    ///
    /// # Errors
    ///
    /// [`Error::ForeignKernel`] if it is not one of this crate, and [`Error::WrongKernel`] if this version makes
    /// another one of it.
    pub fn make_kernel(&self) -> Result<KernelTable, Error> {
        self.kernel.make(self.grid)
    }

    /// The settings of the path.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The states, to be read at any load, approach, mean gap or area up to the last one.
    #[must_use]
    pub fn history(&self) -> &History {
        &self.history
    }

    /// The states.
    #[must_use]
    pub fn states(&self) -> &[LoadingState] {
        self.history.states()
    }

    /// Why the path ended, `None` if it had not.
    #[must_use]
    pub fn end(&self) -> Option<LoadingEnd> {
        self.end
    }

    /// The nodes in contact at the last state, in the order in which they touched.
    ///
    /// # Errors
    ///
    /// Those of states that are in no order of a path: [`Self::from_parts`] has refused them.
    pub fn contact(&self) -> Result<ContactSequence, Error> {
        let Replayed { contact, .. } = replay(&self.grid, &self.history, |_, _, _| {})?;
        Ok(contact)
    }

    /// The path once more, behind its last state, with the default updater: to where it was to end, or beyond, by
    /// [`LoadingPath::continue_to`]. See [`LoadingBuilder::resume`](crate::loading::LoadingBuilder::resume) for
    /// what it costs, and for other updaters.
    ///
    /// The same nodes touch next as on a path that was never interrupted. A record [made](Self::new) at the last state
    /// of its path knows where the window of that state ended, and how the factor grew: all states are the same bit for
    /// bit, on a kernel [with a gauge](crate::PeriodicBoussinesq::with_gauge) of yours to rounding. Otherwise they are
    /// the same to their estimated error, with a factor to rounding: windows begin elsewhere.
    ///
    /// # Errors
    ///
    /// Those of [`Self::make_kernel`] and of [`LoadingBuilder::resume`](crate::loading::LoadingBuilder::resume).
    pub fn resume(&self) -> Result<LoadingSolver, Error> {
        let kernel = self.make_kernel()?;
        let hardness = self.hardness_map()?;
        let mut builder = self.builder(&kernel, hardness.as_ref());
        for &target in &self.settings.targets {
            builder = builder.until(target);
        }
        builder.resume(&self.history)
    }

    /// The hardness of each node, if the path had one.
    ///
    /// # Errors
    ///
    /// [`Error::LengthMismatch`] for one of another grid.
    pub fn hardness_map(&self) -> Result<Option<DMatrix<f64>>, Error> {
        self.settings.hardness.as_ref().map(|hardness| hardness.map(&self.grid)).transpose()
    }

    fn builder<'a>(
        &'a self,
        kernel: &'a dyn InfluenceKernel,
        hardness: Option<&'a DMatrix<f64>>,
    ) -> LoadingBuilder<'a> {
        let builder = LoadingSolver::builder(&self.heights, kernel).rule(self.settings.rule);
        match hardness {
            Some(hardness) => builder.hardness_map(hardness),
            None => builder,
        }
    }

    /// The path as it was, for the fields of its states
    /// ([`LoadingPath::fields_at`]): each is one solution on a known contact set, without a factor.
    ///
    /// # Errors
    ///
    /// Those of [`Self::make_kernel`] and of [`LoadingBuilder::build`](crate::loading::LoadingBuilder::build).
    pub fn replay(&self) -> Result<LoadingPath, Error> {
        self.replay_on(&self.make_kernel()?)
    }

    /// The same on the kernel given, which must be the one of the record: for kernels that are not of this crate.
    ///
    /// # Errors
    ///
    /// [`Error::WrongKernel`] if it is another one, and as above.
    pub fn replay_on(&self, kernel: &dyn InfluenceKernel) -> Result<LoadingPath, Error> {
        let hardness = self.hardness_map()?;
        let builder = self.builder(kernel, hardness.as_ref());
        let mut solver = builder.updater(ConjugateGradient::new()).build()?.into_path();
        self.kernel.check(solver.problem().table())?;
        solver.restore(&self.history)?;
        Ok(solver)
    }
}

/// The error of a state whose quantity has a value in place of another one.
fn inconsistent(
    step: usize,
    quantity: &'static str,
    [value, expected]: [f64; 2],
    reason: &'static str,
) -> Error {
    Error::Inconsistent { step, quantity, value, expected, reason }
}
