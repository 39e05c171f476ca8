//! How exact a state is.

/// How well a state of contact fulfils the conditions of contact,
/// $\text{gap} \ge 0$, $p \ge 0$, $p \cdot \text{gap} = 0$, computed afresh from its pressure.
///
/// All figures are relative and dimensionless: pressures to the mean pressure on the contact, gaps
/// to the rms height of the surface (to the approach if the surface is flat). Zero would be exact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Certificate {
    /// Least pressure in contact: the newest node's, zero, or negative by rounding.
    pub least_pressure: f64,
    /// Least gap out of contact; infinite in full contact.
    pub least_gap: f64,
    /// Greatest absolute gap in contact.
    pub greatest_contact_gap: f64,
    /// Difference between the sum of pressures and the load.
    pub load_error: f64,
}

impl Certificate {
    /// From ((pressure, gap), in contact) of every node, the expected sum of pressures, and the
    /// scales of length to choose from.
    pub(super) fn of(
        nodes: impl Iterator<Item = ((f64, f64), bool)>,
        expected_sum: f64,
        lengths: [f64; 2],
    ) -> Self {
        let (mut count, mut sum) = (0_usize, 0.0);
        let (mut least_pressure, mut least_gap) = (f64::INFINITY, f64::INFINITY);
        let mut contact_gap = 0.0_f64;
        for ((pressure, gap), in_contact) in nodes {
            if in_contact {
                count += 1;
                sum += pressure;
                least_pressure = least_pressure.min(pressure);
                contact_gap = contact_gap.max(gap.abs());
            } else {
                least_gap = least_gap.min(gap);
            }
        }
        let mean = relative(sum, count as f64);
        let length = lengths
            .into_iter()
            .find(|length| *length > 0.0)
            .unwrap_or(1.0);
        Self {
            least_pressure: if count == 0 {
                0.0
            } else {
                relative(least_pressure, mean)
            },
            least_gap: least_gap / length,
            greatest_contact_gap: contact_gap / length,
            load_error: relative(sum - expected_sum, sum),
        }
    }
}

/// value / scale, zero for nothing out of nothing.
fn relative(value: f64, scale: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value / scale }
}
