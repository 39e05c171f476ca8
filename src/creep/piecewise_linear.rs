//! Loads and approaches over time.

use crate::Error;

/// A load \[N\] or an approach \[m\] over time \[s\]: linear between corners, and held behind the last.
///
/// Two corners at one time are a jump; of more than two at one time the first and the last count, for what happens in
/// no time at all leaves no trace. Before the first corner the quantity is 0, so that a first corner at another value
/// is a jump too. A value that differs from the one before, or from 0, by less than 10⁻¹⁴ of the greatest so far is
/// taken for it: 0.1 + 0.2 held at 0.3 does not fall.
///
/// ```
/// use asperity::creep::PiecewiseLinear;
///
/// # fn main() -> Result<(), asperity::Error> {
/// // 100 N within half a second, held for an hour, half of it taken away at once.
/// let load = PiecewiseLinear::ramp(100.0, 0.5)?.hold(3600.0)?.jump(50.0)?;
/// assert_eq!(load.value_at(0.25), 50.0);
/// assert_eq!(load.value_at(1000.0), 100.0);
/// assert_eq!(load.value_at(4000.0), 50.0);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PiecewiseLinear {
    corners: Vec<(f64, f64)>,
    greatest: f64,
}

/// Values that differ by less than this part of the greatest are the same.
const SAME_VALUE: f64 = 1e-14;

impl PiecewiseLinear {
    /// From corners (time, value).
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] without a corner, for times and values that are not finite, for a time before that of the
    /// corner before it, and where a value changes too fast for double precision.
    pub fn new(corners: impl IntoIterator<Item = (f64, f64)>) -> Result<Self, Error> {
        let mut all = Self { corners: Vec::new(), greatest: 0.0 };
        for (time, value) in corners {
            all.push(time, value)?;
        }
        let count = all.corners.len();
        Error::require("number of corners", count as f64, count > 0, "at least 1")?;
        Ok(all)
    }

    /// This value from t = 0 on.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] if it is not finite.
    pub fn step(value: f64) -> Result<Self, Error> {
        Self::new([(0.0, 0.0), (0.0, value)])
    }

    /// From 0 to this value in this time.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new).
    pub fn ramp(value: f64, duration: f64) -> Result<Self, Error> {
        Self::new([(0.0, 0.0), (duration, value)])
    }

    /// Then held for this time.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new).
    pub fn hold(self, duration: f64) -> Result<Self, Error> {
        let (_, value) = self.last();
        self.to(value, duration)
    }

    /// Then to another value in this time.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new).
    pub fn to(mut self, value: f64, duration: f64) -> Result<Self, Error> {
        let (time, _) = self.last();
        self.push(time + duration, value)?;
        Ok(self)
    }

    /// Then to another value at once.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new).
    pub fn jump(self, value: f64) -> Result<Self, Error> {
        self.to(value, 0.0)
    }

    /// Then cycles around the last value: `x + a sin(2πt/T)` for so many periods T, in straight pieces, so many a
    /// period.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new), and [`Error::OutOfRange`] for fewer than 4 pieces.
    pub fn cycles(
        mut self,
        amplitude: f64,
        period: f64,
        periods: usize,
        pieces: usize,
    ) -> Result<Self, Error> {
        Error::require("pieces of a period", pieces as f64, pieces >= 4, "at least 4")?;
        let (start, mean) = self.last();
        for cycle in 0..periods {
            for piece in 1..=pieces {
                let phase = piece as f64 / pieces as f64;
                let sine = (std::f64::consts::TAU * phase).sin();
                let sine = if piece == pieces { 0.0 } else { sine };
                self.push(start + (cycle as f64 + phase) * period, mean + amplitude * sine)?;
            }
        }
        Ok(self)
    }

    /// The corners (time, value). Times are sums of durations: what comes after 0.1 s and 0.2 s comes after
    /// 0.30000000000000004 s.
    #[must_use]
    pub fn corners(&self) -> &[(f64, f64)] {
        &self.corners
    }

    /// The time of the last corner \[s\].
    #[must_use]
    pub fn end(&self) -> f64 {
        self.last().0
    }

    /// The value at a time, just after a jump there.
    #[must_use]
    pub fn value_at(&self, time: f64) -> f64 {
        let after = self.corners.partition_point(|corner| corner.0 <= time);
        let Some(&(start, value)) = after.checked_sub(1).and_then(|k| self.corners.get(k)) else {
            return 0.0;
        };
        match self.corners.get(after) {
            Some(&(end, next)) => value + (next - value) * ((time - start) / (end - start)),
            None => value,
        }
    }

    fn last(&self) -> (f64, f64) {
        self.corners.last().copied().unwrap_or((0.0, 0.0))
    }

    fn push(&mut self, time: f64, value: f64) -> Result<(), Error> {
        Error::require("time of a corner", time, time.is_finite(), "finite")?;
        Error::require("value at a corner", value, value.is_finite(), "finite")?;
        self.greatest = self.greatest.max(value.abs());
        let known = self.corners.last().map(|corner| corner.1).into_iter().chain([0.0]);
        let mut same = known.filter(|known| (value - known).abs() <= SAME_VALUE * self.greatest);
        let value = same.next().unwrap_or(value);
        if let Some(&(before, old)) = self.corners.last() {
            let expected = "no earlier than the corner before";
            Error::require("time of a corner", time, time >= before, expected)?;
            let rate = if time > before { (value - old) / (time - before) } else { 0.0 };
            let expected = "a rate that double precision can hold";
            Error::require("change from corner to corner", rate, rate.is_finite(), expected)?;
        }
        let at_once = self.corners.iter().rev().take_while(|corner| corner.0 == time).count();
        let is_first = at_once == self.corners.len();
        // The value before the first corner, 0, is a corner too.
        if at_once + usize::from(is_first) >= 2 {
            self.corners.pop();
        }
        self.corners.push((time, value));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_linear_between_corners() -> Result<(), Error> {
        let x = PiecewiseLinear::new([(1.0, 2.0), (3.0, 6.0), (3.0, 1.0), (4.0, 1.0)])?;
        for (time, value) in
            [(0.9, 0.0), (1.0, 2.0), (2.0, 4.0), (3.0, 1.0), (3.5, 1.0), (4.0, 1.0), (9.0, 1.0)]
        {
            assert_eq!(x.value_at(time), value, "{time}");
        }
        assert_eq!((x.value_at(f64::NAN), x.value_at(f64::INFINITY), x.end()), (0.0, 1.0, 4.0));
        Ok(())
    }

    #[test]
    fn what_happens_at_once_is_one_jump() -> Result<(), Error> {
        let x = PiecewiseLinear::new([
            (0.0, 5.0),
            (0.0, 3.0),
            (1.0, 4.0),
            (1.0, 0.0),
            (1.0, 9.0),
            (1.0, 2.0),
        ])?;
        assert_eq!(x.corners(), [(0.0, 3.0), (1.0, 4.0), (1.0, 2.0)]);
        assert_eq!(PiecewiseLinear::step(7.0)?.corners(), [(0.0, 7.0)]);
        Ok(())
    }

    #[test]
    fn values_of_rounding_are_none() -> Result<(), Error> {
        let x = PiecewiseLinear::new([
            (0.0, 0.0),
            (1.0, 0.1 + 0.2),
            (2.0, 0.3),
            (3.0, 0.3 - 0.1 * 3.0),
        ])?;
        assert_eq!(x.corners()[2].1, 0.1 + 0.2);
        assert_eq!(x.corners()[3].1, 0.0);
        // What is small by itself is not.
        let small = [(0.0, 1e-20), (1.0, 2e-20), (2.0, 1.0), (3.0, 1.0 - 1e-13)];
        assert_eq!(PiecewiseLinear::new(small)?.corners(), small);
        Ok(())
    }

    #[test]
    fn cycles_come_back_to_their_mean() -> Result<(), Error> {
        let x = PiecewiseLinear::step(5.0)?.cycles(2.0, 4.0, 3, 4)?;
        let expected = [(1.0, 7.0), (2.0, 5.0), (3.0, 3.0), (4.0, 5.0)];
        assert_eq!(x.corners().len(), 13);
        for (found, expected) in x.corners()[1..5].iter().zip(expected) {
            // The sine of π is 1e-16.
            assert!(
                (found.0, (found.1 - expected.1).abs() < 1e-15) == (expected.0, true),
                "{found:?}"
            );
        }
        assert_eq!(x.corners()[12], (12.0, 5.0));
        Ok(())
    }

    #[test]
    fn what_is_no_history_is_refused() {
        for corners in [
            vec![],
            vec![(f64::NAN, 0.0)],
            vec![(0.0, f64::INFINITY)],
            vec![(1.0, 0.0), (0.5, 1.0)],
            vec![(0.0, -1e308), (1.0, 1e308)],
            vec![(0.0, 0.0), (1e-320, 1.0)],
        ] {
            let refused = PiecewiseLinear::new(corners.clone());
            assert!(matches!(refused, Err(Error::OutOfRange { .. })), "{corners:?}");
        }
        assert!(PiecewiseLinear::ramp(1.0, -1.0).is_err());
        assert!(PiecewiseLinear::step(1.0).and_then(|x| x.cycles(0.1, 1.0, 1, 3)).is_err());
    }
}
