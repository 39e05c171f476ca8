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

    /// Ticks, of which about `most` or fewer are labelled; none on an axis without a length.
    pub(crate) fn ticks(&self, most: usize) -> Vec<Tick> {
        let (from, to) = self.ends;
        if from == to || !(to - from).is_finite() {
            return Vec::new();
        }
        let ticks =
            if self.logarithmic { self.logarithmic_ticks(most) } else { self.linear_ticks(most) };
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

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, most: usize) -> Vec<String> {
        axis.ticks(most).into_iter().filter_map(|tick| tick.label).collect()
    }

    /// Whether there is a place, and where it is expected, to rounding.
    fn is_at(found: Option<f64>, expected: f64) -> bool {
        found.is_some_and(|place| (place - expected).abs() < 1e-12)
    }

    /// Worked out by hand: the least of 1, 2 and 5 times a power of ten that makes as few steps as are asked for.
    #[test]
    fn labels_of_linear_axes_are_round() {
        for (from, to, most, expected) in [
            (0.0, 1.0, 5, "0.0 0.2 0.4 0.6 0.8 1.0"),
            (-3.0, 3.0, 6, "-3 -2 -1 0 1 2 3"),
            (-0.05, 0.05, 4, "-0.05 0.00 0.05"),
            (1_000.000_05, 1_000.000_95, 5, "1000.0002 1000.0004 1000.0006 1000.0008"),
            (0.0, 5e6, 5, "0 1000000 2000000 3000000 4000000 5000000"),
            (0.0, 98.0, 1, "0"),
        ] {
            assert_eq!(labels(&Axis::plain("", from, to), most).join(" "), expected);
        }
    }

    /// A label is read back as the value whose place it has, to some roundings of the ends. A step is at most 5/2 of
    /// what would make as many steps as are asked for, so that there are never fewer than 2/5 of them, nor more ticks
    /// than one at each end of all steps.
    #[test]
    fn ticks_of_linear_axes_are_where_their_labels_say() {
        for (from, to) in [
            (0.0, 1.0),
            (-7.3, 0.2),
            (1_000.0, 1_000.001),
            (-1e-7, 1.0),
            (0.0, 3e-300),
            (-2e300, 5e300),
        ] {
            let axis = Axis::plain("", from, to);
            for most in 1..=9 {
                let ticks = axis.ticks(most);
                let labels = labels(&axis, most);
                let read = labels.iter().map(|label| label.parse().unwrap_or(f64::NAN));
                let values: Vec<f64> = read.collect();
                let number = values.len();
                assert!(number >= 2 * most / 5 && number <= most + 1, "{from} to {to}: {labels:?}");
                assert_eq!(ticks.len(), number);
                for (tick, value) in ticks.iter().zip(&values) {
                    let found = from + tick.place * (to - from);
                    let rounding = 8.0 * f64::EPSILON * (from.abs() + to.abs());
                    assert!((found - value).abs() <= rounding, "{found} is not {value}");
                }
                if let [first, .., last] = values[..] {
                    let step = format!("{:.6e}", (last - first) / (number - 1) as f64);
                    let round = ["1.000000e", "2.000000e", "5.000000e"];
                    assert!(round.iter().any(|digits| step.starts_with(digits)), "{step}");
                }
            }
        }
    }

    /// A quantity that does not change is in the middle of an axis that has labels, whatever its size: both ends are
    /// half a unit away.
    #[test]
    fn an_axis_of_one_value_has_it_in_its_middle() {
        for value in [0.0, 5.0, -5.0, 2e4, -3e-7, 4e12, 4e30, 1e-40] {
            let axis = Axis::linear("force", "N", value, value);
            assert!(is_at(axis.place(value), 0.5), "{value:e}");
            assert!(labels(&axis, 5).len() >= 2, "{value:e}");
        }
    }

    /// Worked out by hand: as many powers of ten as are asked for at most, with 2 and 5 of each where there are fewer
    /// than two.
    #[test]
    fn labels_of_logarithmic_axes_are_powers_of_ten() {
        for (from, to, most, expected) in [
            (1.0, 10.0, 6, "1|10"),
            (0.8, 1100.0, 6, "1|10|10²|10³"),
            (2e-3, 7.0, 6, "10⁻²|10⁻¹|1"),
            (3e-300, 3e299, 6, "10⁻²⁰⁰|10⁻¹⁰⁰|1|10¹⁰⁰|10²⁰⁰"),
            (0.03, 0.25, 6, "5 × 10⁻²|10⁻¹|2 × 10⁻¹"),
            (1.5, 6.0, 3, "2|5"),
        ] {
            let axis = Axis::plain_logarithmic("", from, to);
            assert_eq!(labels(&axis, most).join("|"), expected, "{from:e} to {to:e}");
        }
        let decade = Axis::plain_logarithmic("", 1.0, 10.0).ticks(6);
        assert_eq!(decade.len(), 10);
        for (digit, tick) in (1..=10).zip(decade) {
            assert!((10_f64.powf(tick.place) - f64::from(digit)).abs() < 1e-12, "{digit}");
        }
    }

    /// Half a decade is shown at least, and has one of 1, 2 and 5 times a power of ten: 2, 5/2 and 2 are all below √10.
    #[test]
    fn no_logarithmic_axis_is_without_labels() {
        for k in 0..100 {
            let value = 10_f64.powf(f64::from(k) / 37.0 - 1.4);
            let axis = Axis::plain_logarithmic("", value, value);
            assert!(is_at(axis.place(value), 0.5));
            assert!(is_at(axis.place(value * 10_f64.powf(0.25)), 1.0));
            assert!(!labels(&axis, 6).is_empty(), "{value}");
        }
    }

    /// Labels are in the unit of the greater end, and values are not.
    #[test]
    fn places_are_those_of_values_in_si_units() {
        let load = Axis::linear("load", "N", -2e4, 1e3);
        assert_eq!(load.label(), "load [kN]");
        assert_eq!(labels(&load, 5).join(" "), "-20 -15 -10 -5 0");
        for (value, place) in [(-2e4, 0.0), (-9500.0, 0.5), (1e3, 1.0), (22e3, 2.0)] {
            assert!(is_at(load.place(value), place), "{value}");
        }
        let pressure = Axis::logarithmic("pressure", "Pa", 2e3, 8e6);
        assert_eq!(pressure.label(), "pressure [MPa]");
        assert_eq!(labels(&pressure, 5).join(" "), "10⁻² 10⁻¹ 1");
        let middle = (2e3_f64 * 8e6).sqrt();
        for (value, place) in [(2e3, 0.0), (middle, 0.5), (8e6, 1.0)] {
            assert!(is_at(pressure.place(value), place), "{value}");
        }
    }

    /// Room is a part of the length of the axis, which is one of decades if it is logarithmic.
    #[test]
    fn there_is_room_at_the_ends() {
        let linear = Axis::plain("", 0.0, 10.0).with_room(0.1, 0.2);
        assert!(is_at(linear.place(-1.0), 0.0) && is_at(linear.place(12.0), 1.0));
        let logarithmic = Axis::plain_logarithmic("", 1.0, 100.0).with_room(0.5, 1.0);
        assert!(is_at(logarithmic.place(0.1), 0.0) && is_at(logarithmic.place(1e4), 1.0));
    }

    /// A place is a number or nothing, and there is no tick that has none.
    #[test]
    fn what_is_nowhere_has_no_place() {
        let linear = Axis::plain("", -1.0, 3.0);
        let logarithmic = Axis::plain_logarithmic("", 1e-3, 1e3);
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!((linear.place(value), logarithmic.place(value)), (None, None), "{value}");
        }
        for value in [0.0, -0.0, -1.0] {
            assert_eq!(logarithmic.place(value), None, "{value}");
        }
        // Beyond the ends there are places.
        assert!(is_at(linear.place(5.0), 1.5) && is_at(logarithmic.place(1e6), 1.5));
        let point = Axis::plain("", 2.0, 2.0);
        assert_eq!((point.place(2.0), point.place(3.0)), (None, None));
        for (from, to) in [(f64::NAN, f64::NAN), (0.0, f64::INFINITY)] {
            let endless = Axis::plain("", from, to);
            assert_eq!(labels(&endless, 5), [""; 0], "{from} to {to}");
        }
    }
}
