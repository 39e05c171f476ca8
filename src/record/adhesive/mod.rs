//! Records of paths with adhesion.

#[cfg(feature = "io")]
mod npz;

use nalgebra::DMatrix;

use super::KernelRecord;
use super::increments::areas;
use crate::adhesion::{
    Adhesion, AdhesiveBranch, AdhesiveBuilder, AdhesivePath, AdhesiveState, Direction, Trace,
};
use crate::surface::HeightMap;
use crate::{ContactTarget, Error, Grid, InfluenceKernel, KernelTable};

/// How far numbers that follow from others may be from them, relative to the greatest of these.
const SAME: f64 = 1e-9;

/// The record of a path with adhesion, all its branches in one: the surface, the kernel, the law, the states, and what
/// happened to nodes.
///
/// ```
/// use asperity::adhesion::{Adhesion, AdhesivePath};
/// use asperity::record::AdhesiveRecord;
/// use asperity::{Boussinesq, ContactTarget, Grid, SelfAffine};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let half_space = Boussinesq::new(Grid::square(32, 1e-3)?, 1e6)?;
/// let surface = SelfAffine::zhang2020(1);
/// let mut path = AdhesivePath::builder(&surface, &half_space, Adhesion::work(0.05))
///     .until(ContactTarget::Load(0.01))
///     .build()?;
/// let loading = path.run()?;
/// let record = AdhesiveRecord::new(&path, loading)?;
///
/// // Unloading, elsewhere:
/// let mut path = record.path()?;
/// path.unload()?;
/// assert!(path.run()?.pull_off() > 0.0);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct AdhesiveRecord {
    grid: Grid,
    /// Heights from the highest node.
    heights: HeightMap,
    kernel: KernelRecord,
    adhesion: Adhesion,
    states: AdhesiveBranch,
    trace: Trace,
    /// Which way the last branch goes and where it is to end, if it has not come there.
    pending: Option<(Direction, Vec<ContactTarget>)>,
}

impl AdhesiveRecord {
    /// The record of a path and of all states that it has yielded, on all its branches.
    ///
    /// # Errors
    ///
    /// [`Error::LengthMismatch`] for fewer states or more, as for those of one branch of several,
    /// [`Error::StateNotReached`] for others than these, and [`Error::Inconsistent`] and
    /// [`Error::RecordNotFinite`] for numbers that no state has.
    pub fn new(path: &AdhesivePath, states: AdhesiveBranch) -> Result<Self, Error> {
        let present = path.state().map_or(0, |state| state.step);
        let steps = states.states().iter().map(|state| state.step);
        if states.states().len() != present {
            let found = states.states().len();
            return Err(Error::LengthMismatch { expected: present, found });
        }
        if !steps.eq(1..=present) {
            let step = states.states().last().map_or(0, |state| state.step);
            return Err(Error::StateNotReached { step, present });
        }
        let problem = path.problem();
        let (nx, ny) = problem.grid().shape();
        let heights = problem.initial_gap().iter().map(|gap| -gap);
        Self {
            grid: problem.grid(),
            heights: HeightMap::new(DMatrix::from_iterator(nx, ny, heights))?,
            kernel: KernelRecord::of(problem.table()),
            adhesion: path.adhesion(),
            trace: path.trace(),
            pending: path.pending().map(|(direction, targets)| (direction, targets.to_vec())),
            states,
        }
        .checked()
    }

    /// # Errors
    ///
    /// [`Error::WrongBoundary`], [`Error::RecordNotFinite`], [`Error::Inconsistent`], and those of [`Trace::follow`].
    fn checked(self) -> Result<Self, Error> {
        self.grid.check_shape(self.heights.shape())?;
        self.kernel.check_boundary()?;
        let states = self.states.states();
        if states.len() != self.trace.marks.len() {
            let (expected, found) = (self.trace.marks.len(), states.len());
            return Err(Error::LengthMismatch { expected, found });
        }
        self.trace.follow(self.grid.nodes(), |place, counts| {
            areas(&self.grid, states[place].step, &states[place].contact)?;
            check(&states[place], self.trace.marks[place].1, counts)
        })?;
        Ok(self)
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

    /// The law of adhesion that was asked for.
    #[must_use]
    pub fn adhesion(&self) -> Adhesion {
        self.adhesion
    }

    /// The states of all branches, in their order.
    #[must_use]
    pub fn states(&self) -> &AdhesiveBranch {
        &self.states
    }

    /// Which way the last branch goes, and where it is to end; `None` if it has come there.
    #[must_use]
    pub fn pending(&self) -> Option<(Direction, &[ContactTarget])> {
        self.pending.as_ref().map(|(direction, targets)| (*direction, &targets[..]))
    }

    /// The path at its last state: to go on to where its branch was to end, to turn around, to go on elsewhere
    /// ([`load_to`](AdhesivePath::load_to), [`unload`](AdhesivePath::unload)), and for
    /// [fields](AdhesivePath::fields_at) of its states.
    ///
    /// # Errors
    ///
    /// Those of [`Self::make_kernel`] and of [`AdhesiveBuilder::build`](crate::adhesion::AdhesiveBuilder::build);
    /// [`Error::Inconsistent`] if the nodes do not carry the load of the last state.
    pub fn path(&self) -> Result<AdhesivePath, Error> {
        self.path_on(&self.make_kernel()?, None)
    }

    /// The kernel, made again.
    ///
    /// # Errors
    ///
    /// Those of [`LoadingRecord::make_kernel`](super::LoadingRecord::make_kernel).
    pub fn make_kernel(&self) -> Result<KernelTable, Error> {
        self.kernel.make(self.grid)
    }

    /// The same on the kernel given, which must be the one of the record, for kernels that are not of this crate; and
    /// within a [memory budget](crate::adhesion::AdhesiveBuilder::memory_budget) other than that by default.
    ///
    /// # Errors
    ///
    /// [`Error::WrongKernel`] if it is another one, and as above.
    pub fn path_on(
        &self,
        kernel: &dyn InfluenceKernel,
        memory_budget: Option<usize>,
    ) -> Result<AdhesivePath, Error> {
        let builder = AdhesivePath::builder(&self.heights, kernel, self.adhesion);
        let builder = memory_budget.into_iter().fold(builder, AdhesiveBuilder::memory_budget);
        let last = self.states.states().last();
        // Targets of a branch of unloading are none from where the surfaces are apart.
        let pending = self.pending();
        let targets = pending.iter().flat_map(|(_, targets)| *targets);
        let targets = targets.filter(|_| last.is_none()).copied();
        let builder = targets.fold(builder, AdhesiveBuilder::until);
        let mut path = builder.build()?;
        self.kernel.check(path.problem().table())?;
        if let Some(last) = last {
            path.restore(self.trace.clone(), *last, pending)?;
        }
        Ok(path)
    }
}

/// `Ok` if what a state, at an approach in the gauge of the kernel, says of its nodes and of its energies is so.
fn check(
    state: &AdhesiveState,
    in_gauge: f64,
    [soft, cohesive, in_contact]: [usize; 3],
) -> Result<(), Error> {
    let contact = &state.contact;
    let energies = [contact.energy, state.adhesive_energy, state.dissipated, state.work];
    let names = ["elastic energy", "energy of adhesion", "dissipated energy", "work"];
    let mut of_energies = names.into_iter().zip(energies);
    let not_finite = contact.not_finite().or(of_energies.find(|(_, energy)| !energy.is_finite()));
    if let Some((quantity, value)) = not_finite {
        return Err(Error::RecordNotFinite { step: state.step, quantity, value });
    }
    let wrong = |quantity, value, expected, reason| {
        Err(Error::Inconsistent { step: state.step, quantity, value, expected, reason })
    };
    let counts = [
        ("number of soft nodes", state.soft_nodes, soft),
        ("number of cohesive nodes", state.cohesive_nodes, cohesive),
        ("number of nodes in contact", contact.contact_nodes, in_contact),
    ];
    for (quantity, value, expected) in counts {
        if value != expected {
            return wrong(quantity, value as f64, expected as f64, "of them are");
        }
    }
    let [elastic, adhesive, dissipated, work] = energies;
    // Energies about the mean planes are differences of those in the gauge.
    let unit = (contact.load * in_gauge).abs();
    let unit = energies.iter().fold(unit, |most: f64, energy| most.max(energy.abs()));
    let sum = elastic + adhesive + dissipated;
    if (work - sum).abs() > SAME * unit {
        return wrong("work", work, sum, "is the sum of the energies");
    }
    Ok(())
}
