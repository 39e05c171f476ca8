//! One unloading in closed form: contact that has grown, and then recedes.

use super::growth::Kernel;
use super::hereditary::Place;
use super::load_controlled::{Creep, Recession};
use super::onset::Onset;
use super::state::in_pieces;
use crate::bed::{BedState, Superposition};
use crate::loading::LoadingState;
use crate::{CreepError, Error};

/// A single unloading under a given load. See the [module](super).
///
/// Behind the greatest effective load the contact at t is that of an earlier time t₁, at which it was on its way up:
/// ```math
/// \frac{1}{E^\ast} \int_0^{t_1} R(t - s)\, \mathrm{d}W_e(s) = W(t), \qquad
/// p(t) = \frac{1}{E^\ast} \int_0^{t_1} R(t - s)\, \mathrm{d}p_e(s)
/// ```
/// (Ting, J. Appl. Mech. 33 (1966) 845, for bodies of revolution; here of any surface). t₁ is one bracketed root in
/// closed forms: no step of time. Approach and mean gap take the recovery of what is no longer in contact, and with it
/// the [bed](super::ViscoelasticBed).
///
/// ```
/// use asperity::bed::Bed;
/// use asperity::creep::{PiecewiseLinear, Creep, Prony, Unloading};
/// use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
/// let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space).max_load(500.0).build()?;
/// let history = path.run()?;
/// let bed = Bed::new(&history)?;
/// let load = PiecewiseLinear::ramp(200.0, 1.0)?.to(0.0, 1.0)?;
/// let creep = Creep::new(&bed, &Prony::shares(&[(1.0, 0.5)])?, &load)?;
/// let unloading = Unloading::new(&creep)?;
/// let state = unloading.at(1.8)?;
/// assert!(state.contact_time < 1.0);
/// assert!((unloading.pressure(1.8, 40)?.load() / 40.0 - 1.0).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct Unloading<'a, 'b> {
    creep: &'b Creep<'a>,
    derivative: Kernel,
    recession: Option<Recession>,
    /// When the contact grows again.
    returns: Option<Onset>,
}

/// The contact at a time of unloading.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct UnloadingState {
    /// Time t \[s\].
    pub time: f64,
    /// Load W \[N\].
    pub load: f64,
    /// The earlier time t₁ that had this contact \[s\]; t itself while it grows.
    pub contact_time: f64,
    /// The elastic state with this contact: its load, approach and mean gap are those of the path and not those at t.
    pub contact: BedState,
}

impl<'a, 'b> Unloading<'a, 'b> {
    /// Of a history of load.
    ///
    /// # Errors
    ///
    /// Those of [`Bed::at_load`](crate::bed::Bed::at_load) if the path does not reach the greatest effective load.
    pub fn new(creep: &'b Creep<'a>) -> Result<Self, Error> {
        let recession = creep.recession();
        let derivative = creep.kernel().derivative();
        let mut made = Self { creep, derivative, recession, returns: None };
        if let Some(recession) = recession {
            creep.bed().at_load(recession.effective_load)?;
            made.returns = made.find_return(recession);
        }
        Ok(made)
    }

    /// When the contact grows again: until then it is a single unloading.
    #[must_use]
    pub fn returns(&self) -> Option<f64> {
        self.returns.map(|returns| returns.time)
    }

    /// The contact just after a time.
    ///
    /// # Errors
    ///
    /// [`CreepError::ContactReturns`] for times when it has grown again, and those of [`Creep::at`] before it recedes.
    pub fn at(&self, time: f64) -> Result<UnloadingState, Error> {
        let Some(recession) = self.receded(time) else {
            let state = self.creep.at(time)?;
            let contact = self.creep.bed().at_load(state.effective_load)?;
            return Ok(UnloadingState { time, load: state.load, contact_time: time, contact });
        };
        if let Some(Onset { time, .. }) = self.returns.filter(|returns| returns.has_begun(time)) {
            return Err(CreepError::ContactReturns { time }.into());
        }
        let (contact_time, effective_load) = self.contact(recession, time);
        let contact = self.creep.bed().at_load(effective_load)?;
        Ok(UnloadingState { time, load: self.creep.load(time), contact_time, contact })
    }

    /// The state of the path that has this contact: for [`contact_map_at`](crate::LoadingPath::contact_map_at).
    ///
    /// # Errors
    ///
    /// Those of [`at`](Self::at).
    pub fn path_state(&self, time: f64) -> Result<LoadingState, Error> {
        self.creep.bed().path_state(self.at(time)?.contact.load)
    }

    /// The pressure at a time: see [`Creep::pressure`].
    ///
    /// # Errors
    ///
    /// Those of [`at`](Self::at), and [`Error::OutOfRange`] without pieces.
    pub fn pressure(&self, time: f64, pieces: usize) -> Result<Superposition, Error> {
        let UnloadingState { contact_time, contact, .. } = self.at(time)?;
        let until = (contact_time, contact.load);
        in_pieces(&self.creep.growth().increments(self.creep.kernel(), time, until), pieces)
    }

    fn receded(&self, time: f64) -> Option<Recession> {
        self.recession.filter(|recession| recession.has_begun(time))
    }

    /// t₁ and the effective load of the contact: that of later times would carry more than the load. What was put on at
    /// once is taken off in part.
    fn contact(&self, recession: Recession, time: f64) -> (f64, f64) {
        let (growth, load) = (self.creep.growth(), self.creep.load(time));
        if load <= 0.0 {
            // What is left of the first contact may have underflowed.
            let begin = growth.load().corners().first().map_or(0.0, |corner| corner.0);
            return (begin.min(recession.time), 0.0);
        }
        // Just before a jump that ends the growth it is as large as ever.
        let whole = (recession.time, recession.effective_load);
        let left = growth.left(self.creep.kernel(), (time, load), recession.time);
        left.map_or(whole, |(since, effective_load)| (since.min(recession.time), effective_load))
    }

    /// The first corner behind the recession from which on the contact grows again.
    ///
    /// Between corners the load that a contact carries is convex in time and W is linear, so that the contact, once it
    /// recedes, goes on to do so up to the next corner. Behind a corner it does if the load falls at least as fast as
    /// relaxation takes it from the contact, or so nearly that no more than rounding is missing in the end: what it
    /// carries lies above its tangent, and under a load that is held no term goes on for longer than its time.
    fn find_return(&self, recession: Recession) -> Option<Onset> {
        let growth = self.creep.growth();
        let load = growth.load();
        let mut greatest = 0.0_f64;
        let slowest = self.creep.kernel().slowest();
        for (corner, &(time, value)) in load.corners().iter().enumerate() {
            greatest = greatest.max(value);
            if !recession.has_begun(time) {
                continue;
            }
            if load.jump(corner) > 0.0 {
                return Some(Onset { time, is_jump: true });
            }
            if load.duration(corner) == 0.0 {
                continue;
            }
            let contact = self.contact(recession, time);
            let relaxes = growth.carried_by(&self.derivative, time, contact);
            let rate = load.slope(corner);
            let value = load.value(Place { corner, since: 0.0 }).max(0.0);
            let is_none = value == 0.0 && rate <= 0.0;
            let duration = load.duration(corner);
            let reach = if rate == 0.0 { duration.min(slowest) } else { duration };
            // Of a load that is hardly more than rounding itself, half is none.
            let rounding = (ROUNDING * greatest).min(0.5 * value);
            if (rate - relaxes) * reach > rounding && !is_none {
                return Some(Onset { time, is_jump: false });
            }
        }
        None
    }
}

/// Part of the greatest load so far below which what is missing of a load is rounding.
const ROUNDING: f64 = 1e-12;
