//! The load at which a body begins to yield.

use nalgebra::DMatrix;

use super::body::Subsurface;
use super::survey::{Greatest, Survey};
use super::tensor::Measure;
use crate::loading::History;
use crate::{ContactTarget, Error, LoadingPath, LoadingState, StressError};

/// The state of an elastic path at which a body begins to yield.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct FirstYield {
    /// The state.
    pub state: LoadingState,
    /// The greatest von Mises stress there, which is the yield stress within [`FirstYield::TOLERANCE`].
    pub greatest: Greatest,
}

impl FirstYield {
    /// How far von Mises' stress may be from the yield stress, relative to it.
    pub const TOLERANCE: f64 = 1e-4;
}

/// Loads that are tried at most: halves of logarithms from any load to any other.
const TRIALS: usize = 60;

impl Subsurface {
    /// The first load at which von Mises' stress reaches `yield_stress` \[Pa\] anywhere in the body; `None` if the path
    /// ends before. `path` is that of `history`.
    ///
    /// Found by interpolation between a load at which nothing yields and one at which something does, where the
    /// greatest stress goes with a power of the load. Should it fall and rise again on the way, it is one of the loads
    /// at which it passes the yield stress. Behind the first node that yields at its hardness it falls as well: there it
    /// is found if it is above the yield stress at the end of the path.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for the yield stress; [`StressError::BehindHardness`]; [`Error::NoConvergence`] if the
    /// greatest stress jumps past the yield stress, at depths that do not show where it is; those of [`Self::survey`]
    /// and [`LoadingPath::fields_at`](LoadingPath::fields_at).
    pub fn first_yield(
        &self,
        path: &mut LoadingPath,
        history: &History,
        yield_stress: f64,
    ) -> Result<Option<FirstYield>, Error> {
        let survey = |pressure: &DMatrix<f64>| self.survey(pressure, None);
        first_reached((path, history), yield_stress, survey)
    }

    /// How many materials the body has: its layers, and the base unless it is rigid.
    #[must_use]
    pub fn materials(&self) -> usize {
        self.spans().len()
    }

    /// The same of each material with a yield stress of its own, from the uppermost layer to the base.
    ///
    /// # Errors
    ///
    /// [`StressError::YieldStresses`] unless there is one for each of the [`materials`](Self::materials), and those of
    /// [`Self::first_yield`].
    pub fn first_yields(
        &self,
        path: &mut LoadingPath,
        history: &History,
        yield_stresses: &[f64],
    ) -> Result<Vec<Option<FirstYield>>, Error> {
        let spans = self.spans();
        let (given, materials) = (yield_stresses.len(), spans.len());
        if given != materials {
            return Err(StressError::YieldStresses { given, materials }.into());
        }
        let of_each = spans.into_iter().zip(yield_stresses);
        of_each
            .map(|(span, yield_stress)| {
                let survey = |pressure: &DMatrix<f64>| {
                    self.survey_within(span, pressure, &mut |_| Ok::<(), Error>(()))
                };
                first_reached((&mut *path, history), *yield_stress, survey)
            })
            .collect()
    }
}

/// The state at which von Mises' stress reaches a yield stress at any of the depths that `survey` looks at.
fn first_reached(
    (path, history): (&mut LoadingPath, &History),
    yield_stress: f64,
    survey: impl Fn(&DMatrix<f64>) -> Result<Survey, Error>,
) -> Result<Option<FirstYield>, Error> {
    let yield_stress = Error::require_positive("yield stress", yield_stress)?;
    let Some(last) = history.states().last() else { return Ok(None) };
    let mut at = |load: f64| -> Result<FirstYield, Error> {
        let state = history.at(ContactTarget::Load(load))?;
        let pressure = path.pressure_at(&state)?;
        let greatest = survey(&pressure)?.greatest(Measure::VonMises);
        Ok(FirstYield { state, greatest })
    };
    if last.contact.load <= 0.0 {
        return Ok(None);
    }
    let mut states = history.states().iter();
    let node = states.find(|state| state.contact.load > 0.0 && state.contact.yielded_nodes() > 0);
    let mut below: Option<FirstYield> = None;
    let mut above = at(node.unwrap_or(last).contact.load)?;
    if above.greatest.value < yield_stress {
        let Some(node) = node else { return Ok(None) };
        let reached = above.greatest.value;
        below = Some(above);
        above = at(last.contact.load)?;
        if above.greatest.value < yield_stress {
            let load = node.contact.load;
            return Err(StressError::BehindHardness { yield_stress, load, reached }.into());
        }
    }
    for _ in 0..TRIALS {
        let over = above.greatest.value / yield_stress;
        if over - 1.0 <= FirstYield::TOLERANCE {
            break;
        }
        let high = above.state.contact.load;
        let load = match &below {
            // As for a sphere, whose load goes with the cube of the stress.
            None => high * over.powi(-3),
            Some(below) => between(below, &above, yield_stress),
        };
        let found = at(load)?;
        if found.greatest.value < yield_stress {
            let is_there = found.greatest.value >= (1.0 - FirstYield::TOLERANCE) * yield_stress;
            if is_there {
                return Ok(Some(found));
            }
            below = Some(found);
        } else {
            above = found;
        }
    }
    let residual = above.greatest.value / yield_stress - 1.0;
    if residual <= FirstYield::TOLERANCE {
        return Ok(Some(above));
    }
    Err(Error::NoConvergence { residual, tolerance: FirstYield::TOLERANCE, iterations: TRIALS })
}

/// A load between two, by a power law through both stresses, not closer to either than a tenth of their logarithms'
/// distance.
fn between(below: &FirstYield, above: &FirstYield, yield_stress: f64) -> f64 {
    let [low, high] = [below, above].map(|found| libm::log(found.state.contact.load));
    let [from, to] = [below, above].map(|found| libm::log(found.greatest.value));
    let part = (libm::log(yield_stress) - from) / (to - from);
    let part = if part.is_finite() { part.clamp(0.1, 0.9) } else { 0.5 };
    libm::exp(low + part * (high - low))
}
