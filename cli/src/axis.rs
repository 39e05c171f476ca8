//! An axis: a quantity with its unit, a scale, and ticks.

use crate::number::{power_of_ten, scientific};
use crate::units;

/// A tick: its place along the axis from 0 to 1, and its label if it has one.
pub(crate) struct Tick {
    pub(crate) place: f64,
    pub(crate) label: Option<String>,
}

/// A labelled axis.
pub struct Axis {
    label: String,
    logarithmic: bool,
    /// Ends of the axis, in the unit of `label`, or their decimal logarithms.
    ends: (f64, f64),
    /// What one unit of `label` is in SI units.
    unit: f64,
}

impl Axis {
    /// A linear axis, in the [unit](units::of) that suits it.
    pub fn linear(quantity: &str, si_unit: &str, from: f64, to: f64) -> Self {
        let (unit, name) = units::of(si_unit, from.abs().max(to.abs()));
        let (from, to) = (from / unit, to / unit);
        Self {
            label: format!("{quantity} [{name}]"),
            logarithmic: false,
            ends: if from < to { (from, to) } else { (from - 0.5, from + 0.5) },
            unit,
        }
    }

    /// A logarithmic axis in the [unit](units::of) that suits its upper end, between positive ends.
    pub fn logarithmic(quantity: &str, si_unit: &str, from: f64, to: f64) -> Self {
        let (unit, name) = units::of(si_unit, to);
        let axis = Self::plain_logarithmic(&format!("{quantity} [{name}]"), from / unit, to / unit);
        Self { unit, ..axis }
    }

    /// A logarithmic axis of a quantity without unit, or whose label has it, between positive ends.
    pub fn plain_logarithmic(label: &str, from: f64, to: f64) -> Self {
        let (from, to) = (from.log10(), to.log10());
        // At least half a decade, so that there is something to label.
        let middle = 0.5 * (from + to);
        let half = (0.5 * (to - from)).max(0.25);
        Self {
            label: label.to_string(),
            logarithmic: true,
            ends: (middle - half, middle + half),
            unit: 1.0,
        }
    }

    /// A linear axis of a quantity without unit, or whose label has it.
    pub fn plain(label: &str, from: f64, to: f64) -> Self {
        Self { label: label.to_string(), logarithmic: false, ends: (from, to), unit: 1.0 }
    }

    /// The same axis with some room at both ends, given as fractions of its length.
    pub fn with_room(mut self, before: f64, after: f64) -> Self {
        let length = self.ends.1 - self.ends.0;
        self.ends.0 -= before * length;
        self.ends.1 += after * length;
        self
    }

    /// Quantity and unit.
    pub(crate) fn label(&self) -> &str {
        &self.label
    }

    /// Place along the axis of a value in SI units, `None` if a logarithmic axis has none.
    pub(crate) fn place(&self, value: f64) -> Option<f64> {
        let value = value / self.unit;
        let value = if self.logarithmic {
            if value <= 0.0 {
                return None;
            }
            value.log10()
        } else {
            value
        };
        let place = (value - self.ends.0) / (self.ends.1 - self.ends.0);
        place.is_finite().then_some(place)
    }

    /// Ticks, of which about `most` or fewer are labelled.
    pub(crate) fn ticks(&self, most: usize) -> Vec<Tick> {
        let ticks =
            if self.logarithmic { self.logarithmic_ticks(most) } else { self.linear_ticks(most) };
        let (from, to) = self.ends;
        ticks
            .into_iter()
            .map(|(value, label)| Tick { place: (value - from) / (to - from), label })
            .filter(|tick| (-1e-9..=1.0 + 1e-9).contains(&tick.place))
            .collect()
    }

    fn linear_ticks(&self, most: usize) -> Vec<(f64, Option<String>)> {
        let (from, to) = self.ends;
        let coarse = (to - from) / most.max(1) as f64;
        let decade = 10_f64.powf(coarse.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0]
            .into_iter()
            .map(|factor| factor * decade)
            .find(|step| *step >= coarse * (1.0 - 1e-9))
            .unwrap_or(10.0 * decade);
        let decimals = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
        let first = (from / step - 1e-9).ceil() as i64;
        let last = (to / step + 1e-9).floor() as i64;
        (first..=last)
            .map(|k| {
                let value = k as f64 * step;
                (value, Some(format!("{value:.decimals$}")))
            })
            .collect()
    }

    fn logarithmic_ticks(&self, most: usize) -> Vec<(f64, Option<String>)> {
        let (from, to) = self.ends;
        let (first, last) = (from.floor() as i32, to.ceil() as i32);
        let whole = (to.floor() - from.ceil()) as i32 + 1;
        let every = (whole as usize).div_ceil(most.max(1)).max(1) as i32;
        let mut ticks = Vec::new();
        for exponent in first..=last {
            let labelled = exponent.rem_euclid(every) == 0;
            ticks.push((f64::from(exponent), labelled.then(|| power_of_ten(exponent))));
            if every > 1 {
                continue;
            }
            for digit in 2..=9_u8 {
                let value = f64::from(exponent) + f64::from(digit).log10();
                // Within a decade or so, powers of ten alone say too little.
                let labelled = whole < 2 && (digit == 2 || digit == 5);
                let label = scientific(10_f64.powf(value), 1);
                ticks.push((value, labelled.then_some(label)));
            }
        }
        ticks
    }
}
