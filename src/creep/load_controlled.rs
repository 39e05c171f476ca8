//! Contact under a load that is given over time, as long as the effective load grows.

use super::growth::{Growth, Kernel};
use super::hereditary::{Hereditary, Place};
use super::onset::Onset;
use super::piecewise_linear::PiecewiseLinear;
use super::prony::Prony;
use super::state::{CreepState, in_pieces};
use crate::bed::{Bed, Superposition};
use crate::kernel::Theory;
use crate::loading::LoadingState;
use crate::{CreepError, Error};

/// The contact of viscoelastic bodies under a history of load. See the [module](super).
///
/// With $`W_e(t) = E^\ast \int J(t - s)\, \mathrm{d}W(s)`$ the *effective load*: while it has not fallen, contact,
/// gaps, approach and mean gap at t are those of the elastic path at $`W_e(t)`$, and the pressure is
/// ```math
/// p(t) = \frac{1}{E^\ast} \int R(t - s)\, \mathrm{d}p_e(s) \ge 0,
/// ```
/// $`p_e(s)`$ being that of the path at $`W_e(s)`$ (Lee and Radok, J. Appl. Mech. 27 (1960) 438, for spheres). It is
/// the effective load that must not fall: a load that is taken away slowly enough passes.
///
/// ```
/// use asperity::bed::Bed;
/// use asperity::creep::{PiecewiseLinear, Creep, Prony};
/// use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
/// let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space)
///     .max_load(500.0)
///     .build()?;
/// let history = path.run()?;
/// let bed = Bed::new(&history)?;
///
/// // 200 N at once, on bodies of which half of the modulus relaxes in a second.
/// let creep = Creep::new(&bed, &Prony::shares(&[(1.0, 0.5)])?, &PiecewiseLinear::step(200.0)?)?;
/// let (first, last) = (creep.at(0.0)?, creep.at(100.0)?);
/// assert_eq!(first.effective_load, 200.0);
/// assert!((last.effective_load - 400.0).abs() < 1e-9);
/// assert!(last.contact_nodes > first.contact_nodes);
/// let pressure = creep.pressure(100.0, 20)?.pressure(&bed, &mut path)?;
/// assert!((pressure.sum() * path.grid().cell_area() / 200.0 - 1.0).abs() < 1e-10);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct Creep<'a> {
    bed: &'a Bed<'a>,
    kernel: Kernel,
    growth: Growth<'a>,
    recession: Option<Recession>,
}

/// Where the effective load begins to fall, and with it the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Recession {
    /// Time \[s\].
    pub time: f64,
    /// Effective load there \[N\], its greatest.
    pub effective_load: f64,
    /// Whether it falls at once: then not even the state just after this time is one of the path.
    pub is_jump: bool,
}

impl Recession {
    /// Whether the contact has begun to recede just after a time.
    pub(super) fn has_begun(&self, time: f64) -> bool {
        Onset { time: self.time, is_jump: self.is_jump }.has_begun(time)
    }
}

impl<'a> Creep<'a> {
    /// With the bed of a path, the modulus [relative to](Prony::relative_to) the E\* of that path, and the load \[N\].
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a negative load; [`Error::NotHomogeneous`] for a path on layers of several materials.
    pub fn new(bed: &'a Bed<'a>, prony: &Prony, load: &PiecewiseLinear) -> Result<Self, Error> {
        bed.history().layering().check(Theory::Creep)?;
        for &(_, load) in load.corners() {
            Error::require("load at a corner", load, load >= 0.0, "at least 0")?;
        }
        let growth = Growth::new(bed.loads(), Hereditary::creep(prony, load.corners()));
        let recession = recession(growth.load()).map(|found| Recession {
            effective_load: growth.to_knot(found.effective_load),
            ..found
        });
        Ok(Self { bed, kernel: Kernel::relaxation(prony), growth, recession })
    }

    /// The path.
    #[must_use]
    pub fn bed(&self) -> &'a Bed<'a> {
        self.bed
    }

    /// When contact recedes for the first time: `None` if it never does, however long the last load is held.
    ///
    /// Found in closed form: between corners the rate of the effective load is a sum of exponentials, whose first
    /// root is bracketed by bounds of the sum and its derivatives.
    #[must_use]
    pub fn recession(&self) -> Option<Recession> {
        self.recession
    }

    /// $`W_e(t)`$ \[N\], just after t: whether or not it has fallen, and 0 before the first corner.
    #[must_use]
    pub fn effective_load(&self, time: f64) -> f64 {
        self.growth.at(time)
    }

    /// W(t) \[N\], just after t.
    #[must_use]
    pub fn load(&self, time: f64) -> f64 {
        let load = self.growth.load();
        load.place(time).map_or(0.0, |place| load.value(place))
    }

    /// The state just after a time; before the first corner that of first touch.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a time that is no number; [`CreepError::ContactRecedes`] if the effective load has
    /// fallen before; [`CreepError::PathEnds`] if it is beyond the path.
    pub fn at(&self, time: f64) -> Result<CreepState, Error> {
        self.check(time)?;
        let effective_load = self.effective_load(time);
        let elastic = self.bed.at_load(effective_load);
        let elastic = elastic.map_err(|error| self.ends(error, time, effective_load))?;
        Ok(CreepState::of_path(self.bed, &elastic, time, self.load(time)))
    }

    /// The state of the elastic path whose contact, gap and approach those of a time are: for
    /// [`fields_at`](crate::LoadingPath::fields_at), [`contact_map_at`](crate::LoadingPath::contact_map_at), and
    /// [`patches`](crate::patches). Its load is the effective one, and its pressure not that of the time.
    ///
    /// # Errors
    ///
    /// Those of [`at`](Self::at).
    pub fn path_state(&self, time: f64) -> Result<LoadingState, Error> {
        self.at(time)?;
        self.bed.path_state(self.effective_load(time))
    }

    /// When each knot of the path is reached \[s\]: state k of its history at the k-th of these times. As many as are
    /// reached before contact recedes, if ever.
    #[must_use]
    pub fn times(&self) -> Vec<f64> {
        self.growth.times(self.recession.map_or(f64::INFINITY, |recession| recession.time))
    }

    /// When an effective load \[N\] is reached, before contact recedes; `None` if it is not.
    #[must_use]
    pub fn time_of(&self, effective_load: f64) -> Option<f64> {
        let until = self.recession.map_or(f64::INFINITY, |recession| recession.time);
        if effective_load.is_nan() || effective_load < 0.0 {
            return None;
        }
        let knots = [0.0, effective_load];
        let times = Growth::new(&knots, self.growth.load().clone()).times(until);
        times.get(1).copied()
    }

    /// The pressure at a time, as increments of the path with the weights `R(t − s)/E*`, in at most so many pieces of
    /// one weight each: [`Superposition::pressure`] makes the field of it.
    ///
    /// With as many pieces as the path has states it is exact. Each piece takes a field of the path; twenty leave some
    /// 10⁻³ of the greatest pressure, and a third of it or less each time their number is doubled.
    ///
    /// # Errors
    ///
    /// Those of [`at`](Self::at), and [`Error::OutOfRange`] without pieces.
    pub fn pressure(&self, time: f64, pieces: usize) -> Result<Superposition, Error> {
        let until = (time, self.at(time)?.effective_load);
        in_pieces(&self.growth.increments(&self.kernel, time, until), pieces)
    }

    pub(super) fn growth(&self) -> &Growth<'a> {
        &self.growth
    }

    pub(super) fn kernel(&self) -> &Kernel {
        &self.kernel
    }

    fn check(&self, time: f64) -> Result<(), Error> {
        Error::require("time", time, !time.is_nan(), "a number")?;
        match self.recession.filter(|recession| recession.has_begun(time)) {
            Some(Recession { time, effective_load, .. }) => {
                Err(CreepError::ContactRecedes { time, effective_load }.into())
            }
            None => Ok(()),
        }
    }

    /// That the path ends, with the time until when it is enough.
    fn ends(&self, error: Error, time: f64, effective_load: f64) -> Error {
        let path_ends = self.bed.last_load();
        if effective_load <= path_ends {
            return error;
        }
        let until = self.time_of(path_ends).unwrap_or(time);
        CreepError::PathEnds { time, effective_load, path_ends, until }.into()
    }
}

/// The first fall of the effective load.
fn recession(load: &Hereditary) -> Option<Recession> {
    for (corner, &(start, _)) in load.corners().iter().enumerate() {
        let effective_load = load.response(Place { corner, since: 0.0 }).0;
        let jump = load.response_to_jump(corner);
        if jump < 0.0 {
            let effective_load = effective_load - jump;
            return Some(Recession { time: start, effective_load, is_jump: true });
        }
        let duration = load.duration(corner);
        let length = if duration.is_finite() { duration } else { load.long() };
        if length > 0.0
            && let Some(since) = load.rate(corner).first_negative(length)
        {
            let effective_load = load.response(Place { corner, since }).0;
            return Some(Recession { time: start + since, effective_load, is_jump: false });
        }
    }
    None
}
