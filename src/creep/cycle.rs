//! Steady cycles of load, and the energy that they cost.

use super::viscoelastic_bed::{Control, ViscoelasticBed};
use crate::{CreepError, Error};

/// A cycle of load `W̄ + a sin(2πt/T)`.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Cycle {
    /// Period T \[s\].
    pub period: f64,
    /// Mean load W̄ \[N\].
    pub mean_load: f64,
    /// Amplitude a of the load \[N\].
    pub amplitude: f64,
    /// Amplitude of the approach, half of its range \[m\].
    pub approach_amplitude: f64,
    /// Energy lost in the last cycle, `∮ (W − W̄) dδ` \[J\].
    pub dissipated: f64,
    /// Amplitude of the load over that of the approach \[N/m\].
    pub stiffness: f64,
    /// Energy lost over π times both amplitudes: the tangent of the phase as far as the contact is linear.
    pub loss_factor: f64,
    /// The last cycle, (approach, load).
    pub path: Vec<(f64, f64)>,
    /// How many cycles were run.
    pub cycles: usize,
    /// How far the energy lost is from that of the steady cycle, over the product of amplitudes: an estimate, from how fast the changes from cycle to
    /// cycle die out. Infinite after one cycle.
    pub distance: f64,
}

/// How a cycle is run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleSettings {
    /// Steps of a cycle.
    pub steps: usize,
    /// The estimated [distance](Cycle::distance) from the steady cycle at which a cycle is taken for it.
    pub tolerance: f64,
    /// No more cycles than these.
    pub most: usize,
}

impl Default for CycleSettings {
    /// Half a percent of the energy that an elastic solid with tan φ = 0.1 would lose comes of the steps.
    fn default() -> Self {
        Self { steps: 96, tolerance: 1e-5, most: 1000 }
    }
}

/// How the energy lost comes nearer to that of the steady cycle.
#[derive(Debug, Default)]
struct Approach {
    before: Option<f64>,
    change: Option<f64>,
    ratio: Option<f64>,
}

impl Approach {
    /// What is still to come after a cycle: a geometric series whose ratio is the greater one of the last two, and no greater than that of the longest
    /// retardation time, `slowest`. A single small change says nothing: a slow mode changes little in a cycle that is much shorter than its time.
    fn distance(&mut self, dissipated: f64, slowest: f64) -> f64 {
        let change = self.before.map(|before| dissipated - before);
        let ratio = match (self.change, change) {
            (Some(earlier), Some(change)) => Some((change / earlier).abs()),
            _ => None,
        };
        let greatest = match (self.ratio, ratio) {
            (Some(earlier), Some(ratio)) => earlier.max(ratio).min(slowest),
            _ => slowest,
        };
        let left = greatest / (1.0 - greatest);
        *self = Self { before: Some(dissipated), change, ratio };
        // The last change itself where nothing is to come: rounding.
        change.map_or(f64::INFINITY, |change| change.abs() * left.max(f64::EPSILON))
    }
}

/// Steps of a cycle. A cycle keeps all its points: more of them are a mistake, and not an accuracy.
const MOST_STEPS: usize = 1_000_000;

impl ViscoelasticBed<'_> {
    /// Holds a load until nothing creeps any more: for some 40 of the longest retardation times.
    ///
    /// # Errors
    ///
    /// [`CreepError::NoSteadyCycle`] for bodies that flow, and those of [`step`](Self::step).
    pub fn settle(&mut self, load: f64) -> Result<(), Error> {
        self.check_solid()?;
        self.step(0.0, Control::Load(load))?;
        let terms = self.prony().creep_terms();
        let (Some(first), Some(last)) = (terms.first(), terms.last()) else {
            return Ok(());
        };
        let (mut step, end) = (0.02 * first.time, 40.0 * last.time);
        let mut passed = 0.0;
        while passed < end {
            self.step(step, Control::Load(load))?;
            passed += step;
            step *= 1.1;
        }
        Ok(())
    }

    /// Cycles the load around a mean until the energy that a cycle costs is that of the steady one, within the tolerance. The bed goes on from its present state, so that
    /// [`settle`](Self::settle) before, or a sweep from period to period, saves cycles.
    ///
    /// # Errors
    ///
    /// [`CreepError::NoSteadyCycle`] for bodies that flow; [`Error::NotPositive`] for amplitudes and periods that are not;
    /// [`Error::OutOfRange`] for a mean load below the amplitude, fewer than 8 steps or more than a million, and no cycles; those of
    /// [`step`](Self::step).
    pub fn cycle(
        &mut self,
        mean_load: f64,
        amplitude: f64,
        period: f64,
        settings: CycleSettings,
    ) -> Result<Cycle, Error> {
        self.check_solid()?;
        Error::require_positive("amplitude of a cycle", amplitude)?;
        Error::require_positive("period of a cycle", period)?;
        let expected = "at least the amplitude of the cycle, and finite";
        let is_so = mean_load >= amplitude && mean_load.is_finite();
        Error::require("mean load of a cycle", mean_load, is_so, expected)?;
        let CycleSettings { steps, tolerance, most } = settings;
        let is_so = (8..=MOST_STEPS).contains(&steps);
        Error::require("steps of a cycle", steps as f64, is_so, "from 8 to a million")?;
        Error::require("cycles at most", most as f64, most >= 1, "at least 1")?;
        if self.state().load != mean_load {
            self.step(0.0, Control::Load(mean_load))?;
        }
        let longest = self.prony().creep_terms().last().map_or(0.0, |term| term.time);
        // How much of the slowest mode is left after a cycle.
        let slowest = (-period / longest).exp();
        let mut approach = Approach::default();
        let mut cycles = 0;
        loop {
            let path = self.round(mean_load, amplitude, period, steps)?;
            cycles += 1;
            let lost = path.windows(2).map(|pair| {
                let load = 0.5 * (pair[0].1 + pair[1].1) - mean_load;
                load * (pair[1].0 - pair[0].0)
            });
            let dissipated: f64 = lost.sum();
            let approaches = path.iter().map(|point| point.0);
            let (low, high) = approaches
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            let approach_amplitude = 0.5 * (high - low);
            let scale = amplitude * approach_amplitude;
            let distance = approach.distance(dissipated, slowest) / scale;
            if distance <= tolerance || cycles >= most {
                return Ok(Cycle {
                    period,
                    mean_load,
                    amplitude,
                    approach_amplitude,
                    dissipated,
                    stiffness: amplitude / approach_amplitude,
                    loss_factor: dissipated / (std::f64::consts::PI * scale),
                    path,
                    cycles,
                    distance,
                });
            }
        }
    }

    /// One cycle, from its mean.
    fn round(
        &mut self,
        mean_load: f64,
        amplitude: f64,
        period: f64,
        steps: usize,
    ) -> Result<Vec<(f64, f64)>, Error> {
        let mut path = Vec::with_capacity(steps + 1);
        path.push((self.state().approach, self.state().load));
        for step in 1..=steps {
            let phase = std::f64::consts::TAU * step as f64 / steps as f64;
            let sine = if step == steps { 0.0 } else { phase.sin() };
            // At rounding a mean as large as the amplitude would come out negative.
            let load = (mean_load + amplitude * sine).max(0.0);
            let state = self.step(period / steps as f64, Control::Load(load))?;
            path.push((state.approach, state.load));
        }
        Ok(path)
    }

    fn check_solid(&self) -> Result<(), Error> {
        let fluidity = self.prony().fluidity();
        if fluidity > 0.0 {
            return Err(CreepError::NoSteadyCycle { fluidity }.into());
        }
        Ok(())
    }
}
