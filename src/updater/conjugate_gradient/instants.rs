//! The part of the pressure inside a window that local solutions leave out.

use super::tuning::MOST;

/// Instants of a window at which the pressure is known, and what the local solutions left out of it there.
///
/// The part left out grows from nothing with the pressure of the nodes that join. Between two instants it is
/// interpolated by the sum of these pressures, and makes a start for solutions there.
#[derive(Debug, Clone, Default)]
pub(super) struct Instants {
    /// By the sum of pressures.
    known: Vec<Instant>,
}

#[derive(Debug, Clone)]
struct Instant {
    /// Of the pressures on nodes that joined.
    sum: f64,
    /// Pressure left out at each node of the grid, in units of the greatest.
    left_out: Vec<f32>,
    unit: f64,
}

impl Instant {
    /// Adds a part of what was left out.
    fn add(&self, part: f64, pressure: &mut [f64]) {
        let part = part * self.unit;
        for (value, left_out) in pressure.iter_mut().zip(&self.left_out) {
            *value += part * f64::from(*left_out);
        }
    }
}

impl Instants {
    /// How many there are.
    #[cfg(test)]
    pub(super) fn len(&self) -> usize {
        self.known.len()
    }

    /// No window.
    pub(super) fn clear(&mut self) {
        self.known.clear();
    }

    /// Adds an instant with its solution and what the local solutions made of it.
    pub(super) fn add(&mut self, sum: f64, solved: &[f64], carried: &[f64]) {
        let left_out = solved.iter().zip(carried).map(|(a, b)| a - b);
        let most = left_out.clone().fold(0.0, |most: f64, p| most.max(p.abs()));
        let unit = if most > 0.0 { most } else { 1.0 };
        let instant =
            Instant { sum, left_out: left_out.map(|p| (p / unit) as f32).collect(), unit };
        let place = self.known.partition_point(|other| other.sum < sum);
        self.known.insert(place, instant);
        if self.known.len() > MOST {
            // Near ties are settled from first to last: the least sum is needed no more.
            self.known.remove(0);
        }
    }

    /// Adds to a pressure what the local solutions leave out of it.
    pub(super) fn complete(&self, sum: f64, pressure: &mut [f64]) {
        let after = self.known.partition_point(|other| other.sum < sum);
        let Some(next) = self.known.get(after) else {
            return;
        };
        let last = after.checked_sub(1).and_then(|last| self.known.get(last));
        let before = last.map_or(0.0, |last| last.sum);
        let part = (sum - before) / (next.sum - before);
        if !(0.0..=1.0).contains(&part) {
            return;
        }
        next.add(part, pressure);
        if let Some(last) = last {
            last.add(1.0 - part, pressure);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_is_interpolated() {
        let mut instants = Instants::default();
        let completed = |instants: &Instants, sum: f64| {
            let mut pressure = vec![10.0, 20.0];
            instants.complete(sum, &mut pressure);
            pressure
        };
        // Nothing is known.
        assert_eq!(completed(&instants, 1.0), [10.0, 20.0]);
        // The end of the window, then an instant inside.
        instants.add(4.0, &[5.0, 9.0], &[1.0, 1.0]);
        assert_eq!(completed(&instants, 1.0), [11.0, 22.0]);
        instants.add(2.0, &[3.0, 3.0], &[2.0, 3.0]);
        assert_eq!(completed(&instants, 1.0), [10.5, 20.0]);
        assert_eq!(completed(&instants, 2.0), [11.0, 20.0]);
        assert_eq!(completed(&instants, 3.0), [12.5, 24.0]);
        assert_eq!(completed(&instants, 4.0), [14.0, 28.0]);
        // Beyond the end, and where the sum says nothing.
        assert_eq!(completed(&instants, 5.0), [10.0, 20.0]);
        assert_eq!(completed(&instants, f64::NAN), [10.0, 20.0]);
        assert_eq!(completed(&instants, -1.0), [10.0, 20.0]);
        instants.clear();
        assert_eq!(completed(&instants, 3.0), [10.0, 20.0]);
        // Beyond the range of single precision, on either side.
        for unit in [1e100, 1e-100] {
            let mut pressure = vec![0.0; 2];
            instants.add(4.0, &[unit, 2.0 * unit], &[0.0, 0.0]);
            instants.complete(2.0, &mut pressure);
            assert_eq!(pressure, [0.5 * unit, unit]);
            instants.clear();
        }
    }

    /// Of two instants with the same sum the later one counts.
    #[test]
    fn the_later_of_two_solutions_counts() {
        let mut instants = Instants::default();
        instants.add(2.0, &[1.0], &[0.0]);
        instants.add(2.0, &[3.0], &[0.0]);
        let mut pressure = vec![0.0];
        instants.complete(2.0, &mut pressure);
        assert_eq!((instants.len(), pressure), (2, vec![3.0]));
    }

    #[test]
    fn the_last_instants_and_the_end_are_kept() {
        let mut instants = Instants::default();
        for sum in [8.0, 1.0, 2.0, 3.0, 4.0] {
            instants.add(sum, &[sum], &[0.0]);
        }
        let sums: Vec<f64> = instants.known.iter().map(|instant| instant.sum).collect();
        assert_eq!(sums, [3.0, 4.0, 8.0]);
    }
}
