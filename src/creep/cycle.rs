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
    /// By how much the last cycle lost more or less than the one before, over the product of amplitudes.
    pub change: f64,
}

/// How a cycle is run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleSettings {
    /// Steps of a cycle.
    pub steps: usize,
    /// The change of the energy lost, over the product of amplitudes, at which a cycle is steady.
    pub tolerance: f64,
    /// No more cycles than these.
    pub most: usize,
}

impl Default for CycleSettings {
    /// Half a percent of the energy that an elastic solid with tan φ = 0.1 would lose comes of the steps.
    fn default() -> Self {
        Self { steps: 96, tolerance: 1e-5, most: 60 }
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

    /// Cycles the load around a mean until each costs as much energy as the one before. The bed goes on from its present state, so that
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
        let mut before: Option<f64> = None;
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
            let change = before.map_or(f64::INFINITY, |before| (dissipated - before) / scale);
            if change.abs() <= tolerance || cycles >= most {
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
                    change,
                });
            }
            before = Some(dissipated);
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
