//! The iterator over contact states.

use std::any::Any;
use std::fmt;
use std::iter::FusedIterator;
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut};

use super::path::LoadingPath;
use super::state::LoadingState;
use crate::Error;
use crate::updater::{Handover, LinearUpdater};

/// The exact loading path of a rigid rough surface on an elastic half-space.
///
/// A fused iterator: it yields one [`LoadingState`] for each node that touches (or yields, with a hardness, or leaves,
/// with a kernel that lets nodes leave), from first touch (approach 0, load 0) to full contact or a limit. If the limit
/// is a load, an approach or a mean gap, the last state is at exactly that limit. Afterwards, or after an error, it
/// yields `None`, and [`end`](LoadingPath::end) says why; so it does if a user-defined updater has panicked and the
/// panic was caught. Fields of the present state, the last one yielded, are computed on demand.
///
/// ```
/// use asperity::surface::{Amplitude, SelfAffine};
/// use asperity::{Boussinesq, Grid, LoadingSolver};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let half_space = Boussinesq::new(Grid::square(32, 1e-2)?, 1.0)?;
/// let surface = SelfAffine::new(0.8, 2.5e-3, 1.25e-3, Amplitude::RmsHeight(50e-6), 7)?;
/// let mut path = LoadingSolver::builder(&surface, &half_space)
///     .max_area_fraction(0.1)
///     .build()?;
/// while let Some(state) = path.next() {
///     let contact = state?.contact;
///     println!("{} nodes carry {} N", contact.contact_nodes, contact.load);
/// }
/// assert!(path.certificate()?.least_pressure > -1e-12);
/// # Ok(())
/// # }
/// ```
///
/// It is a thin shell: `U` says which [`LinearUpdater`] solves on the contact, and all else is that of the
/// [`LoadingPath`] that it dereferences to, which is compiled once for all of them.
#[must_use = "a path is computed as it is iterated over"]
pub struct LoadingSolver<U = Handover> {
    path: LoadingPath,
    updater: PhantomData<fn() -> U>,
}

impl<U> fmt::Debug for LoadingSolver<U> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LoadingSolver").field("path", &self.path).finish()
    }
}

impl<U: LinearUpdater> LoadingSolver<U> {
    pub(super) fn of(path: LoadingPath) -> Self {
        Self { path, updater: PhantomData }
    }

    /// The path alone.
    #[must_use]
    pub fn into_path(self) -> LoadingPath {
        self.path
    }

    /// The updater; `None` where the path goes on, or has begun, without a factor.
    #[must_use]
    pub fn updater(&self) -> Option<&U> {
        let updater: &dyn Any = self.path.linear_updater()?;
        updater.downcast_ref()
    }
}

impl<U> Deref for LoadingSolver<U> {
    type Target = LoadingPath;

    fn deref(&self) -> &LoadingPath {
        &self.path
    }
}

impl<U> DerefMut for LoadingSolver<U> {
    fn deref_mut(&mut self) -> &mut LoadingPath {
        &mut self.path
    }
}

impl<U> Iterator for LoadingSolver<U> {
    type Item = Result<LoadingState, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        self.path.next()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.path.size_hint()
    }
}

impl<U> FusedIterator for LoadingSolver<U> {}
