//! Contact at an approach that is given over time, as long as it grows.

use nalgebra::DMatrix;

use super::growth::{Growth, Kernel};
use super::hereditary::Hereditary;
use super::onset::Onset;
use super::piecewise_linear::PiecewiseLinear;
use super::prony::Prony;
use super::state::{CreepState, in_pieces};
use crate::bed::{Bed, Superposition};
use crate::kernel::Theory;
use crate::loading::LoadingState;
use crate::{BedError, CreepError, Error, LoadingPath};

/// The contact of viscoelastic bodies at a history of approach: stress relaxation.
///
/// While the approach does not fall, contact and gaps are those of the elastic path at it, whatever the bodies do; the
/// load is $`W(t) = \frac{1}{E^\ast} \int R(t - s)\, \mathrm{d}W_{el}(\delta(s))`$, and the pressure is made of the
/// same increments.
///
/// ```
/// use asperity::bed::Bed;
/// use asperity::creep::{PiecewiseLinear, Prony, Relaxation};
/// use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
/// let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space).max_load(500.0).build()?;
/// let history = path.run()?;
/// let bed = Bed::new(&history)?;
/// let rubber = Prony::shares(&[(1.0, 0.5)])?;
/// let approach = bed.at_load(200.0)?.approach;
/// let held = Relaxation::new(&bed, &rubber, &PiecewiseLinear::step(approach)?)?;
/// assert!((held.at(0.0)?.load - 200.0).abs() < 1e-10);
/// assert!((held.at(100.0)?.load - 100.0).abs() < 1e-10);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct Relaxation<'a> {
    bed: &'a Bed<'a>,
    approach: PiecewiseLinear,
    kernel: Kernel,
    /// The elastic load as the effective one.
    growth: Growth<'a>,
    /// The load that is left of it.
    relaxed: Hereditary,
    /// When the approach falls for the first time.
    recedes: Option<Onset>,
    /// When the path ends, and at which approach.
    ends: Option<(f64, f64)>,
    /// When the surfaces touch.
    touches: Option<f64>,
}

impl<'a> Relaxation<'a> {
    /// With the bed of a path, the modulus [relative to](Prony::relative_to) the E\* of that path, and the approach
    /// \[m\]; where it is negative the surfaces are apart.
    ///
    /// # Errors
    ///
    /// [`BedError`] if the elastic path has no state at an approach, other than that it ends before;
    /// [`Error::NotHomogeneous`] for a path on layers of several materials.
    pub fn new(bed: &'a Bed<'a>, prony: &Prony, approach: &PiecewiseLinear) -> Result<Self, Error> {
        bed.history().layering().check(Theory::Creep)?;
        let Elastic { knots, recedes, ends, touches } = Elastic::along(bed, approach)?;
        let elastic = Hereditary::creep(&Prony::elastic(1.0)?, &knots);
        Ok(Self {
            bed,
            approach: approach.clone(),
            kernel: Kernel::relaxation(prony),
            growth: Growth::new(bed.loads(), elastic),
            relaxed: Hereditary::relaxation(prony, &knots),
            recedes,
            ends,
            touches,
        })
    }

    /// The path.
    #[must_use]
    pub fn bed(&self) -> &'a Bed<'a> {
        self.bed
    }

    /// When the approach falls for the first time.
    #[must_use]
    pub fn recession(&self) -> Option<f64> {
        self.recedes.map(|recedes| recedes.time)
    }

    /// The state just after a time. Its effective load is the elastic load at the approach.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a time that is no number; [`CreepError::ContactRecedes`] if the approach has fallen
    /// before; [`BedError::PathEndsBefore`] if it is or has been beyond the path.
    pub fn at(&self, time: f64) -> Result<CreepState, Error> {
        Error::require("time", time, !time.is_nan(), "a number")?;
        let effective_load = self.growth.at(time);
        if let Some(Onset { time, .. }) = self.recedes.filter(|recedes| recedes.has_begun(time)) {
            let effective_load = self.growth.at(time);
            return Err(CreepError::ContactRecedes { time, effective_load }.into());
        }
        let approach = self.approach.value_at(time);
        let is_beyond =
            |(from, end): &(f64, f64)| time > *from || (time == *from && approach > *end);
        if let Some((_, end)) = self.ends.filter(is_beyond) {
            let before = self.approach.corners().iter().take_while(|corner| corner.0 <= time);
            let value = before.fold(approach, |most, corner| most.max(corner.1));
            return Err(BedError::PathEndsBefore { quantity: "approach", value, end }.into());
        }
        let elastic = self.bed.at_load(effective_load)?;
        let load = self.relaxed.place(time).map_or(0.0, |place| self.relaxed.relaxed(place));
        let state = CreepState::of_path(self.bed, &elastic, time, load);
        if approach >= 0.0 {
            return Ok(CreepState { approach, ..state });
        }
        Ok(CreepState {
            approach,
            contact_nodes: 0,
            contact_area: 0.0,
            contact_area_fraction: 0.0,
            mean_gap: state.mean_gap - approach,
            ..state
        })
    }

    /// The state of the elastic path at the approach of a time; of first touch where the surfaces are apart.
    ///
    /// # Errors
    ///
    /// Those of [`at`](Self::at).
    pub fn path_state(&self, time: f64) -> Result<LoadingState, Error> {
        self.bed.path_state(self.at(time)?.effective_load)
    }

    /// When each knot of the path is reached \[s\], before contact recedes, if ever.
    #[must_use]
    pub fn times(&self) -> Vec<f64> {
        // Apart, the surfaces are without load, as at first touch.
        let Some(touch) = self.touches else { return Vec::new() };
        let times = self.growth.times(self.recession().unwrap_or(f64::INFINITY));
        times.into_iter().map(|time| time.max(touch)).collect()
    }

    /// The pressure at a time: see [`Creep::pressure`](super::Creep::pressure).
    ///
    /// # Errors
    ///
    /// Those of [`at`](Self::at), and [`Error::OutOfRange`] without pieces.
    pub fn pressure(&self, time: f64, pieces: usize) -> Result<Superposition, Error> {
        let until = (time, self.at(time)?.effective_load);
        in_pieces(&self.growth.increments(&self.kernel, time, until), pieces)
    }

    /// The gap at a time \[m\]: that of the elastic path at the approach, which `path` gives; where the surfaces are
    /// apart, by as much more than at first touch.
    ///
    /// # Errors
    ///
    /// Those of [`at`](Self::at) and of [`LoadingPath::fields_at`].
    pub fn gap(&self, time: f64, path: &mut LoadingPath) -> Result<DMatrix<f64>, Error> {
        let apart = (-self.at(time)?.approach).max(0.0);
        Ok(path.fields_at(&self.path_state(time)?)?.gap.map(|gap| gap + apart))
    }
}

/// The elastic load over time.
struct Elastic {
    /// (time, load): linear in between, for all knots of the path are among them.
    knots: Vec<(f64, f64)>,
    recedes: Option<Onset>,
    ends: Option<(f64, f64)>,
    touches: Option<f64>,
}

impl Elastic {
    fn along(bed: &Bed, approach: &PiecewiseLinear) -> Result<Self, Error> {
        let (loads, approaches) = (bed.loads(), bed.approaches());
        let mut knots: Vec<(f64, f64)> = Vec::new();
        let (mut before, mut touches): (Option<(f64, f64)>, Option<f64>) = (None, None);
        for &(time, value) in approach.corners() {
            let (start, from) = before.unwrap_or((time, 0.0));
            if value < from && from > 0.0 {
                let recedes = Onset { time: start, is_jump: time == start };
                return Ok(Self { knots, recedes: Some(recedes), ends: None, touches });
            }
            // Knots on the way, which a jump passes too.
            let first = approaches.partition_point(|knot| *knot <= from.max(0.0));
            let after = approaches.partition_point(|knot| *knot < value);
            let when = |at: f64| start + (time - start) * ((at - from) / (value - from));
            if value >= 0.0 {
                touches = touches.or(Some(if from < 0.0 { when(0.0) } else { start }));
            }
            if from < 0.0 && value > 0.0 {
                knots.push((when(0.0), 0.0));
            }
            let jumps = time == start;
            if !jumps && first < after {
                let passed = approaches[first..after].iter().zip(&loads[first..after]);
                knots.extend(passed.map(|(at, load)| (when(*at), *load)));
            }
            let end = approaches.last().copied().unwrap_or(0.0);
            match bed.at_approach(value.max(0.0)) {
                Ok(state) => knots.push((time, state.load)),
                Err(Error::Bed(BedError::PathEndsBefore { .. })) => {
                    knots.push((when(end), bed.last_load()));
                    let ends = Some((when(end), end));
                    return Ok(Self { knots, recedes: None, ends, touches });
                }
                Err(error) => return Err(error),
            }
            before = Some((time, value));
        }
        Ok(Self { knots, recedes: None, ends: None, touches })
    }
}
