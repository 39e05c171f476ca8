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
