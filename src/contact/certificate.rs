//! How exact a state is.

use crate::kernel::KernelTable;

/// How well a state fulfils the conditions of contact, `gap ≥ 0`, `p ≥ 0` and `p · gap = 0`, computed
/// afresh from its pressure with one convolution.
///
/// All figures are dimensionless: pressures relative to the mean pressure on the contact, loads to the
/// load, gaps to [`length`](Self::length). Zero would be exact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Certificate {
    /// Least pressure in contact: zero at a node that just touches, negative by rounding.
    pub least_pressure: f64,
    /// Least gap out of contact; infinite in full contact.
    #[cfg_attr(feature = "serde", serde(with = "unbounded"))]
    pub least_gap: f64,
    /// Greatest absolute gap in contact.
    pub greatest_contact_gap: f64,
    /// `Σ p |gap| / Σ p`.
    pub complementarity: f64,
    /// Difference between `ΔA Σ p` and the load.
    pub load_error: f64,
    /// Greatest pressure over the hardness of its node, less 1: 0 where nodes have yielded, above it by rounding;
    /// `None` without a hardness. Where nodes have yielded their plastic depth is no gap.
    pub excess_pressure: Option<f64>,
    /// The length that gaps are relative to \[m\]: the greatest of the rms height Sq, the approach δ and, on a
    /// periodic half-space of arbitrary mean displacement, `C(0, 0) p̄` with p̄ the mean pressure: far
    /// beyond full contact rounding grows with the pressure while the approach stays what it is. That
    /// `C(0, 0)` is of the size of a node's own displacement, and independent of the kernel's gauge.
    pub length: f64,
}

impl Certificate {
    /// With what (pressure, hardness) of every node say.
    pub(crate) fn with_hardness(self, nodes: impl Iterator<Item = (f64, f64)>) -> Self {
        let excess = nodes.map(|(pressure, hardness)| pressure / hardness - 1.0);
        Self { excess_pressure: Some(excess.fold(-1.0, f64::max)), ..self }
    }
}

/// A number that may be infinite, as `None` in formats without infinity, such as JSON.
#[cfg(feature = "serde")]
mod unbounded {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    // By reference, as serde calls it.
    #[allow(clippy::trivially_copy_pass_by_ref)]
    pub(super) fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        (*value != f64::INFINITY).then_some(*value).serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        let finite = Option::deserialize(deserializer)?;
        Ok(finite.unwrap_or(f64::INFINITY))
    }
}

/// The lengths of a contact problem that do not depend on its state: see [`Certificate::length`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct ErrorLength {
    rms_height: f64,
    /// C(0, 0) over the number of nodes if the mean displacement is arbitrary, else zero.
    own_displacement: f64,
}

impl ErrorLength {
    /// Of a surface of this rms height on the half-space of `table`.
    pub(crate) fn new(rms_height: f64, table: &KernelTable) -> Self {
        let own = match (table.gauge(), table.computing_gauge()) {
            (Some(present), Some(gauge)) => table.self_influence() - present + gauge,
            _ => 0.0,
        };
        Self { rms_height, own_displacement: own / table.grid().nodes() as f64 }
    }

    /// Root mean square height Sq.
    pub(crate) fn rms_height(self) -> f64 {
        self.rms_height
    }

    /// `C(0, 0) p̄` for pressures of the sum `sum`, or zero where the approach is scale enough.
    pub(crate) fn own_displacement(self, sum: f64) -> f64 {
        self.own_displacement * sum
    }
}

/// Input of a certificate besides the fields.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Conditions {
    /// Sum of pressures that belongs to the load.
    sum: f64,
    /// See [`Certificate::length`].
    length: f64,
}

impl Conditions {
    /// For a state under pressures of the sum `sum` at an approach, on a problem with these lengths.
    pub(crate) fn new(sum: f64, approach: f64, scale: ErrorLength) -> Self {
        let lengths = [approach, scale.own_displacement(sum)];
        Self { sum, length: lengths.into_iter().fold(scale.rms_height(), f64::max) }
    }

    /// From (pressure, gap, in contact) of every node.
    pub(crate) fn check(self, nodes: impl Iterator<Item = (f64, f64, bool)>) -> Certificate {
        let (mut count, mut sum, mut work) = (0_usize, 0.0, 0.0);
        let (mut least_pressure, mut least_gap) = (f64::INFINITY, f64::INFINITY);
        let mut contact_gap = 0.0_f64;
        for (pressure, gap, in_contact) in nodes {
            if in_contact {
                count += 1;
                sum += pressure;
                work += pressure * gap.abs();
                least_pressure = least_pressure.min(pressure);
                contact_gap = contact_gap.max(gap.abs());
            } else {
                least_gap = least_gap.min(gap);
            }
        }
        if count == 0 {
            least_pressure = 0.0;
        }
        let length = if self.length > 0.0 { self.length } else { 1.0 };
        Certificate {
            least_pressure: relative(least_pressure, relative(sum, count as f64)),
            least_gap: least_gap / length,
            greatest_contact_gap: contact_gap / length,
            complementarity: relative(work, sum * length),
            load_error: relative(sum - self.sum, self.sum),
            excess_pressure: None,
            length,
        }
    }
}

/// value / scale, zero for nothing out of nothing.
fn relative(value: f64, scale: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value / scale }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four nodes whose errors are known, all numbers short in binary: everything is exact.
    #[test]
    fn errors_are_those_of_the_fields() {
        let conditions = Conditions { sum: 4.0, length: 2.0 };
        let nodes = [
            (2.0, 0.125, true),
            (0.0, -0.5, false),
            (1.0, -0.25, true),
            (0.0, 3.0, false),
            (-1.0, 0.0, true),
        ];
        let certificate = conditions.check(nodes.into_iter());
        // −1 over a mean of 2/3.
        assert_eq!(certificate.least_pressure, -1.5);
        assert_eq!(certificate.least_gap, -0.25);
        assert_eq!(certificate.greatest_contact_gap, 0.125);
        // 2 · 1/8 + 1 · 1/4 over 2 · 2.
        assert_eq!(certificate.complementarity, 0.125);
        assert_eq!(certificate.load_error, -0.5);
        assert_eq!(certificate.length, 2.0);
    }

    /// The worst node counts, and below every hardness the excess is negative.
    #[test]
    fn pressures_beyond_their_hardness() {
        let excess = |nodes: [(f64, f64); 2]| {
            let certificate = Conditions { sum: 4.0, length: 2.0 }.check([].into_iter());
            certificate.with_hardness(nodes.into_iter()).excess_pressure
        };
        assert_eq!(excess([(3.0, 2.0), (1.0, 4.0)]), Some(0.5));
        assert_eq!(excess([(1.0, 4.0), (1.0, 2.0)]), Some(-0.5));
    }

    /// Nothing in contact is no error, and without any length there is none to divide by.
    #[test]
    fn nothing_in_contact() {
        let conditions = Conditions { sum: 0.0, length: 0.0 };
        let certificate = conditions.check([(0.0, 0.5, false)].into_iter());
        assert_eq!((certificate.least_pressure, certificate.load_error), (0.0, 0.0));
        assert_eq!((certificate.least_gap, certificate.complementarity), (0.5, 0.0));
        assert_eq!((certificate.greatest_contact_gap, certificate.length), (0.0, 1.0));
    }
}
