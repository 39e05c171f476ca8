//! Watched nodes, and how far their window goes.

use nalgebra::DMatrix;

use super::correction::AtEnd;
use super::play::{Course, Played};
use crate::Error;
use crate::loading::run::LoadingRun;
use crate::loading::scales::Scales;
use crate::updater::Schur;

/// The window ends at its widest spacing behind this part of its events.
const CUT: f64 = 0.85;

/// Watched nodes at the front.
#[derive(Debug)]
pub(super) struct Watched {
    pub(super) nodes: Vec<usize>,
    /// a, b: each gap now, and how fast it closes.
    pub(super) lines: Vec<[f64; 2]>,
    pub(super) schur: DMatrix<f64>,
    pub(super) row_sums: Vec<f64>,
    /// No other node touches before.
    pub(super) horizon: f64,
}

impl Watched {
    /// Gaps as lines.
    pub(super) fn courses(&self) -> Vec<Course> {
        let lines = self.lines.iter();
        lines.map(|&[a, b]| Course([a, b, 0.0, 0.0])).collect()
    }

    /// The Schur complement as an updater gives it.
    pub(super) fn complement(&self) -> Result<Schur, Error> {
        let mut schur = Schur::default();
        schur.resize(self.nodes.len())?;
        schur.matrix_mut().copy_from(&self.schur);
        Ok(schur)
    }

    /// What the solution at the front, the window's end, says of the watched nodes.
    pub(super) fn at_end<U>(&self, run: &LoadingRun<U>) -> Vec<AtEnd> {
        let approach = run.front.approach();
        let solution = run.field.solution();
        let first = run.contact.len().saturating_sub(self.nodes.len());
        let joined = &run.contact.order()[first..];
        let at = |&node: &usize| match joined.iter().position(|other| *other == node) {
            Some(place) => AtEnd {
                pressure: [
                    solution.pressure[first + place],
                    solution.rate[first + place],
                ],
                gap: [0.0; 2],
            },
            None => {
                let line = run.field.line(&run.problem, node, approach);
                AtEnd {
                    pressure: [0.0; 2],
                    gap: [line.gap, -line.closing],
                }
            }
        };
        self.nodes.iter().map(at).collect()
    }
}

/// How many events a window keeps, up to `most`, and where it ends: in the middle of the widest spacing behind
/// most of them.
pub(super) fn cut(events: &[Played], horizon: f64, most: usize, scales: &Scales) -> (usize, f64) {
    let count = events.len().min(most);
    let next = |events_kept: usize| {
        let last = events[events_kept - 1].time;
        match events.get(events_kept) {
            Some(event) => event.time,
            None if horizon < f64::INFINITY => horizon.max(last),
            None => 1.05 * last + 1e-12 * scales.length,
        }
    };
    let spacing = |kept: &usize| next(*kept) - events[*kept - 1].time;
    let widest = |range: std::ops::RangeInclusive<usize>| {
        range
            .rev()
            .max_by(|a, b| spacing(a).total_cmp(&spacing(b)))
            .unwrap_or(1)
    };
    let least = ((CUT * count as f64) as usize).clamp(1, count);
    let mut kept = widest(least..=count);
    if spacing(&kept) <= scales.tie {
        kept = widest(1..=count);
    }
    (kept, 0.5 * (events[kept - 1].time + next(kept)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loading::row;

    fn events(times: &[f64]) -> Vec<Played> {
        let events = times.iter().enumerate();
        events
            .map(|(position, &time)| Played { position, time })
            .collect()
    }

    fn cut_of(times: &[f64], horizon: f64, most: usize) -> (usize, f64) {
        let scales = Scales {
            length: 1e9,
            tolerance: 0.0,
            tie: 0.25,
        };
        cut(&events(times), horizon, most, &scales)
    }

    /// Ends in the middle of the widest spacing behind 85 of 100 events, the first of the widest.
    #[test]
    fn windows_end_where_events_are_far_apart() {
        let all = usize::MAX;
        // Ten events: behind the eighth, ninth or tenth.
        let even: Vec<f64> = (1..=10).map(f64::from).collect();
        assert_eq!(cut_of(&even, 11.0, all), (8, 8.5));
        assert_eq!(cut_of(&even, 13.0, all), (10, 11.5));
        // No other node touches before the last event: the horizon is rounding.
        assert_eq!(cut_of(&even, 9.5, all), (8, 8.5));
        let mut wide = even.clone();
        wide[9] = 12.0;
        assert_eq!(cut_of(&wide, 13.0, all), (9, 10.5));
        // A wider spacing in front of them is none of the window's end.
        wide = even
            .iter()
            .map(|time| if *time > 3.0 { time + 5.0 } else { *time })
            .collect();
        assert_eq!(cut_of(&wide, 16.0, all), (8, 13.5));
        // No more than are wanted: behind the fourth or fifth.
        assert_eq!(cut_of(&even, 11.0, 5), (4, 4.5));
        // Where these are ties, the widest of all; where all are, the window goes to its first event.
        let ties = [1.0, 2.0, 4.0, 4.25, 4.5, 4.75];
        assert_eq!(cut_of(&ties, 5.0, all), (2, 3.0));
        assert_eq!(cut_of(&ties[2..], 5.0, all), (1, 4.125));
    }

    /// Without a horizon a window goes on by a twentieth, and 10⁻¹² of the length, here 10⁻³.
    #[test]
    fn windows_without_a_horizon_end_a_little_behind() {
        let (kept, end) = cut_of(&[2.0, 16.0], f64::INFINITY, usize::MAX);
        // (16 + 16.8 + 0.001) / 2, rounded; the spacing of 14 is the wider one.
        assert_eq!((kept, end), (1, 9.0));
        let (kept, end) = cut_of(&[16.0], f64::INFINITY, usize::MAX);
        assert!(kept == 1 && (end - 16.4005).abs() < 1e-12, "{end}");
    }

    /// Of nodes that joined pressure and rate, of others gap and slope: with nodes 0 and 2 in contact at the approach 3, which
    /// carry 3/4 and 1/2, node 1 between them has sunk by 5/4 and sinks by a half more for each metre.
    #[test]
    fn the_end_of_a_window_is_that_of_its_solution() -> Result<(), Error> {
        let run = row::solved(&[0.0, 4.0, 1.0, 8.0], &[0, 2], 3.0)?;
        let of_node = [
            ([0.75, 0.25], [0.0; 2]),
            ([0.0; 2], [2.25, -0.5]),
            ([0.5, 0.25], [0.0; 2]),
            ([0.0; 2], [5.5, -0.75]),
        ];
        for nodes in [vec![1, 2, 3], vec![2], vec![3, 2, 1, 0]] {
            let size = nodes.len();
            let watched = Watched {
                nodes,
                lines: vec![[0.0; 2]; size],
                schur: DMatrix::identity(size, size),
                row_sums: vec![0.0; size],
                horizon: 1.0,
            };
            for (end, &node) in watched.at_end(&run).iter().zip(&watched.nodes) {
                let (pressure, gap) = of_node[node];
                for k in 0..2 {
                    // Roundings of a transform of numbers up to 8.
                    let errors = [end.pressure[k] - pressure[k], end.gap[k] - gap[k]];
                    assert!(
                        errors.iter().all(|error| error.abs() < 1e-13),
                        "{node} {end:?}"
                    );
                }
            }
        }
        Ok(())
    }
}
