//! Steady cycles of load, and the energy that they cost.

use super::prony::Prony;
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
    pub dissipation: f64,
    /// Amplitude of the load over that of the approach \[N/m\]; infinite where that does not change, in full contact of
    /// a periodic half-space.
    pub stiffness: f64,
    /// Energy lost over π times both amplitudes: the sine of the phase as far as the contact is linear.
    pub loss_factor: f64,
    /// The last cycle, (approach, load).
    pub path: Vec<(f64, f64)>,
    /// How many cycles were run.
    pub cycles: usize,
    /// How far the energy lost is from that of the steady cycle, over the product of amplitudes, or the amplitude of
    /// the approach, over itself: the greater one, an estimate from how fast the changes from cycle to cycle die out.
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
    /// Half a percent of the energy that a viscoelastic solid with tan φ = 0.1 would lose comes of the steps.
    fn default() -> Self {
        Self { steps: 96, tolerance: 1e-5, most: 10_000 }
    }
}

/// How a number comes nearer to that of the steady cycle.
#[derive(Debug, Default)]
struct Approach {
    before: Option<f64>,
    change: f64,
}

impl Approach {
    /// What is still to come after a cycle: a geometric series with the ratio of the slowest mode, from the greatest
    /// change so far as that mode would have faded. The last changes alone, and their ratio, say too little: modes hide
    /// and cancel each other.
    fn distance(&mut self, number: f64, slowest: f64) -> f64 {
        let Some(before) = self.before.replace(number) else {
            return f64::INFINITY;
        };
        self.change = (number - before).abs().max(slowest * self.change);
        // The last change itself where nothing is to come: rounding.
        self.change * (slowest / (1.0 - slowest)).max(f64::EPSILON)
    }
}

/// How many changes of a cycle each term of creep goes at once, so that slow ones come to the steady cycle too.
///
/// The strain s of a term changes in a cycle by `(1 − e^(−T/τ)) (f − s)`, f being a mean of the force on its element.
/// In the steady cycle s = f. As strains grow, forces on elements in full contact fall: f − s as a function of the
/// strains has slopes from −1, for an element whose force is given, to −J(∞)/J(0), for one whose compression is. Hence
/// a step of `J(0)/J(∞)` times f − s never overshoots, and leaves at most `1 − J(0)/J(∞)` of what was left. A cycle by
/// itself is such a step for the terms that it changes by more.
struct Ahead {
    /// For each term, at least 1.
    changes: Vec<f64>,
    /// How much of the slowest mode is left after a cycle and this step.
    slowest: f64,
}

impl Ahead {
    fn new(prony: &Prony, period: f64) -> Self {
        let step = prony.equilibrium_modulus() / prony.instantaneous_modulus();
        let terms = prony.creep_terms().iter();
        let by_itself: Vec<f64> = terms.map(|term| -(-period / term.time).exp_m1()).collect();
        let least = by_itself.iter().copied().fold(1.0, f64::min);
        Self {
            changes: by_itself.iter().map(|change| (step / change).max(1.0)).collect(),
            slowest: 1.0 - least.max(step),
        }
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

    /// Cycles the load around a mean until the cycle is the steady one, within the tolerance. The bed goes on from its
    /// present state, so that [`settle`](Self::settle) before, or a sweep from period to period, saves cycles.
    ///
    /// A term that is much slower than the period goes many cycles ahead after each that is run: it takes some
    /// `J(∞)/J(0)` cycles to come nearer by the factor e, however slow it is. The time of the bed counts the cycles
    /// that were run.
    ///
    /// # Errors
    ///
    /// [`CreepError::NotSteady`] if the cycle is not as near to the steady one as the tolerance asks for after the most
    /// cycles; [`CreepError::NoSteadyCycle`] for bodies that flow; [`Error::NotPositive`] for amplitudes, periods and
    /// tolerances that are not; [`Error::OutOfRange`] for a mean load below the amplitude, fewer than 8 steps or more than a
    /// million, and no cycles; those of [`step`](Self::step).
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
        Error::require_positive("tolerance of a cycle", tolerance)?;
        if self.state().load != mean_load {
            self.step(0.0, Control::Load(mean_load))?;
        }
        let ahead = Ahead::new(self.prony(), period);
        let (mut energy, mut amplitudes) = (Approach::default(), Approach::default());
        let mut cycles = 0;
        loop {
            let before = self.strains().to_vec();
            let path = self.round(mean_load, amplitude, period, steps)?;
            cycles += 1;
            let lost = path.windows(2).map(|pair| {
                let load = 0.5 * (pair[0].1 + pair[1].1) - mean_load;
                load * (pair[1].0 - pair[0].0)
            });
            let dissipation: f64 = lost.sum();
            let approaches = path.iter().map(|point| point.0);
            let (low, high) = approaches
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            let approach_amplitude = 0.5 * (high - low);
            let scale = amplitude * approach_amplitude;
            // In full contact of a body that repeats mean planes come no closer: every cycle is the steady one.
            let distance = if approach_amplitude == 0.0 {
                0.0
            } else {
                let of_energy = energy.distance(dissipation, ahead.slowest) / scale;
                let change = amplitudes.distance(approach_amplitude, ahead.slowest);
                of_energy.max(change / approach_amplitude)
            };
            if distance <= tolerance {
                return Ok(Cycle {
                    period,
                    mean_load,
                    amplitude,
                    approach_amplitude,
                    dissipation,
                    stiffness: amplitude / approach_amplitude,
                    loss_factor: if scale > 0.0 {
                        dissipation / (std::f64::consts::PI * scale)
                    } else {
                        0.0
                    },
                    path,
                    cycles,
                    distance,
                });
            }
            if cycles >= most {
                return Err(CreepError::NotSteady { cycles, distance, tolerance }.into());
            }
            self.go_ahead(&before, &ahead.changes);
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
