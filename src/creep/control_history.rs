//! Histories for the bed: of load or of approach, and the times at which to step through them.

use super::piecewise_linear::PiecewiseLinear;
use super::prony::Prony;
use super::state::CreepState;
use super::viscoelastic_bed::{Control, ViscoelasticBed};
use crate::Error;

/// What is given over time.
#[derive(Debug, Clone, PartialEq)]
pub enum ControlHistory {
    /// The load \[N\].
    Load(PiecewiseLinear),
    /// The approach \[m\].
    Approach(PiecewiseLinear),
}

impl ControlHistory {
    /// Its corners.
    #[must_use]
    pub fn corners(&self) -> &PiecewiseLinear {
        match self {
            Self::Load(corners) | Self::Approach(corners) => corners,
        }
    }

    fn control(&self, value: f64) -> Control {
        match self {
            Self::Load(_) => Control::Load(value),
            Self::Approach(_) => Control::Approach(value),
        }
    }
}

/// Most steps that a history is followed in.
const MOST_STEPS: usize = 10_000_000;

/// How steps are spread over time: short behind each corner, and longer from step to step, as the memory of the corner
/// fades.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// The first step behind a corner, over the shortest relaxation time.
    pub first: f64,
    /// The length of a step over that of the step before.
    pub growth: f64,
    /// The least number of steps from corner to corner.
    pub least: usize,
}

impl Default for Steps {
    /// Errors of some 10⁻⁴ of the approach.
    fn default() -> Self {
        Self { first: 0.02, growth: 1.06, least: 60 }
    }
}

impl Steps {
    /// Steps half as long, everywhere: what they change is three times the error that is left.
    #[must_use]
    pub fn halved(self) -> Self {
        let least = self.least.saturating_mul(2);
        Self { first: 0.5 * self.first, growth: self.growth.sqrt(), least }
    }

    /// The times of the steps from the first corner to `end`, all corners up to there among them. A jump has its time
    /// once.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for steps that are not positive, a growth below 1, an end that is not finite, and for more
    /// than ten million steps.
    pub fn times(
        &self,
        prony: &Prony,
        corners: &PiecewiseLinear,
        end: f64,
    ) -> Result<Vec<f64>, Error> {
        Error::require_positive("first step over the shortest relaxation time", self.first)?;
        let is_so = self.growth >= 1.0 && self.growth.is_finite();
        Error::require("growth of steps", self.growth, is_so, "at least 1 and finite")?;
        Error::require("end of a history", end, end.is_finite(), "finite")?;
        let check = |count: usize| {
            let (is_possible, expected) = (count <= MOST_STEPS, "at most ten million");
            Error::require("number of steps", count as f64, is_possible, expected)
        };
        // Beside a time far from 0 they would be rounding, and one step be left.
        check(self.least)?;
        let mut times = Vec::new();
        let shortest = prony.relaxation_terms().first().map(|term| term.time);
        let mut corners = corners.corners().iter().map(|corner| corner.0).peekable();
        let mut now = corners.next().unwrap_or(0.0);
        if now > end {
            return Ok(vec![end]);
        }
        times.push(now);
        while now < end {
            let until = corners.next().unwrap_or(end).min(end);
            let length = until - now;
            if length <= 0.0 {
                continue;
            }
            // A step that is rounding beside the time leads nowhere.
            let least = 4.0 * f64::EPSILON * now.abs().max(until.abs());
            // A body that does not creep needs none but for its curve.
            let mut step = (self.first * shortest.unwrap_or(length)).max(least);
            let start = now;
            let longest = length / self.least.max(1) as f64;
            loop {
                let next = now + step.min(longest);
                // A last step that is hardly one belongs to the one before.
                if next >= until - 0.3 * step.min(longest) || next <= now {
                    break;
                }
                check(times.len())?;
                times.push(next);
                now = next;
                step *= self.growth;
            }
            debug_assert!(now >= start);
            times.push(until);
            now = until;
        }
        Ok(times)
    }
}

impl ViscoelasticBed<'_> {
    /// Follows a history, and returns the states at some times, ascending, each just after a jump there. Corners on the
    /// way are steps of their own; else the steps are from time to time.
    ///
    /// A bed that has made no step yet begins with the history. Another one goes on with it from its present time, at
    /// which corners have been passed. Nothing bears before the first corner.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for times that fall, and those of [`step`](Self::step).
    pub fn follow(
        &mut self,
        course: &ControlHistory,
        times: &[f64],
    ) -> Result<Vec<CreepState>, Error> {
        let corners = course.corners().corners();
        let (Some(&(begin, _)), Some(&first)) = (corners.first(), times.first()) else {
            return Ok(Vec::new());
        };
        Error::require("time of a state", first, first.is_finite(), "finite")?;
        let is_new = self.begin_at(begin.min(first));
        let mut next = if is_new {
            // Unloaded up to the first corner.
            if first >= begin {
                self.step(0.0, course.control(0.0))?;
            }
            0
        } else {
            let now = self.state().time;
            corners.partition_point(|corner| corner.0 <= now)
        };
        let mut states = Vec::with_capacity(times.len());
        for &time in times {
            while let Some(&(at, value)) = corners.get(next).filter(|corner| corner.0 <= time) {
                if next == 0 && self.state().time < at {
                    self.to(at, course.control(0.0))?;
                }
                self.to(at, course.control(value))?;
                next += 1;
            }
            let state = if self.state().time < time || next == 0 {
                self.to(time, course.control(course.corners().value_at(time)))?
            } else {
                self.state()
            };
            let is_next = state.time <= time;
            Error::require("time of a state", time, is_next, "no earlier than the one before")?;
            states.push(state);
        }
        Ok(states)
    }

    /// In one step to a time, which the state then has to the last digit.
    fn to(&mut self, time: f64, control: Control) -> Result<CreepState, Error> {
        let duration = time - self.state().time;
        let expected = "no earlier than the one before";
        Error::require("time of a step", time, duration >= 0.0, expected)?;
        self.step(duration, control)?;
        Ok(self.set_time(time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: the first step is a quarter of the shortest time, 2 s, and each twice as long as the one before. Behind
    /// a corner all begins anew.
    #[test]
    fn steps_grow_behind_each_corner() -> Result<(), Error> {
        let body = Prony::relaxation(1.0, &[(2.0, 1.0), (30.0, 1.0)])?;
        let load = PiecewiseLinear::step(1.0)?;
        let steps = Steps { first: 0.25, growth: 2.0, least: 1 };
        assert_eq!(steps.times(&body, &load, 10.0)?, [0.0, 0.5, 1.5, 3.5, 7.5, 10.0]);
        // None is longer than a quarter of the whole.
        let short = Steps { least: 4, ..steps };
        assert_eq!(short.times(&body, &load, 10.0)?, [0.0, 0.5, 1.5, 3.5, 6.0, 8.5, 10.0]);
        // At 3.5 s hardly a step would be left to the corner.
        let load = load.hold(4.0)?.to(2.0, 4.0)?;
        assert_eq!(steps.times(&body, &load, 8.0)?, [0.0, 0.5, 1.5, 4.0, 4.5, 5.5, 8.0]);
        Ok(())
    }

    /// Steps without end are refused: 10¹⁰ in a second, and 4 × 10⁷ of a body that does not creep.
    #[test]
    fn too_many_steps_are_refused() -> Result<(), Error> {
        let load = PiecewiseLinear::step(1.0)?;
        let body = Prony::relaxation(1.0, &[(1.0, 1.0)])?;
        let even = Steps { first: 1e-10, growth: 1.0, least: 1 };
        let many = Steps { least: 40_000_000, ..Steps::default() };
        for (steps, body) in [(even, &body), (many, &Prony::elastic(1.0)?)] {
            let refused = steps.times(body, &load, 1.0);
            assert!(matches!(refused, Err(Error::OutOfRange { quantity: "number of steps", .. })));
        }
        let most = (0..70).fold(Steps::default(), |steps, _| steps.halved());
        assert_eq!(most.least, usize::MAX);
        let later = PiecewiseLinear::new([(1e3, 0.0), (1e3, 1.0)])?;
        assert!(matches!(most.times(&body, &later, 1001.0), Err(Error::OutOfRange { .. })));
        Ok(())
    }

    /// Half as long is twice as many: where steps grow, and where the least number of them counts, as on a body that
    /// does not creep.
    #[test]
    fn halved_steps_are_twice_as_many() -> Result<(), Error> {
        let load = PiecewiseLinear::step(1.0)?;
        let (creeping, elastic) = (Prony::relaxation(1.0, &[(2.0, 1.0)])?, Prony::elastic(1.0)?);
        let growing = Steps { least: 1, ..Steps::default() };
        let [whole, half] = [growing, growing.halved()].map(|s| s.times(&creeping, &load, 1e6));
        let (whole, half) = (whole?, half?);
        // n steps from a on with the growth g come to a (gⁿ − 1)/(g − 1), which is 10⁶ s at n = 244.1; with a/2 and √g
        // at 487.6. A last step that is hardly one is none.
        assert_eq!([whole.len() - 1, half.len() - 1], [244, 488]);
        assert_eq!((whole[1], half[1]), (0.04, 0.02));
        for (steps, count) in [(Steps::default(), 60), (Steps::default().halved(), 120)] {
            let times = steps.times(&elastic, &load, 1.0)?;
            assert_eq!(times.len() - 1, count);
            // Sums of so many.
            assert!((times[1] * count as f64 - 1.0).abs() < 1e-14);
        }
        Ok(())
    }

    /// Behind a late corner too, where the shortest relaxation time is less than rounding of the time: as many as
    /// there are to be at least, each later than the one before, up to the last that a time can tell.
    #[test]
    fn steps_behind_late_corners() -> Result<(), Error> {
        let body = Prony::shares(&[(1e-8, 0.2), (1e7, 0.3)])?;
        for corners in [[0.0, 3e8, 6e8], [-6e8, -3e8, 0.0], [0.0, 3e8, 3e8 + 1e-3]] {
            let [begin, late, end] = corners;
            let load = PiecewiseLinear::new([(begin, 200.0), (late, 200.0), (end, 20.0)])?;
            for steps in [Steps::default(), Steps { least: 1, ..Steps::default() }] {
                let times = steps.times(&body, &load, end)?;
                assert!(times.is_sorted_by(|a, b| a < b));
                let behind = times.iter().filter(|time| **time > late).count();
                assert!(behind >= steps.least && behind < 1000, "{corners:?}: {behind}");
                assert_eq!((times.first(), times.last()), (Some(&begin), Some(&end)));
                // A time of 3·10⁸ s is right to 6·10⁻⁸ s.
                let place = times.partition_point(|time| *time <= late);
                assert_eq!(times[place - 1], late);
                let first = times[place] - late;
                assert!(first > 0.0 && first < 1e-6, "{corners:?}: {first:e}");
            }
        }
        Ok(())
    }
}
