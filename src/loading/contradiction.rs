//! Whether the end of a window contradicts its events.

use super::run::LoadingRun;
use crate::Problem;
use crate::contact::ContactSequence;

/// How far a solution may be from what contact that grows does, before it contradicts that.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slack {
    /// Overlap \[m\].
    pub(super) gap: f64,
    /// Tension, and pressure beyond the hardness, times what a unit pressure displaces \[m\].
    pub(super) tension: f64,
    pub(super) excess: f64,
    /// Rates of pressures, relative to the greatest, and of plastic depths.
    pub(super) rate: f64,
}

impl Slack {
    /// Without bounds.
    pub(super) const ANY: Self = Self {
        gap: f64::INFINITY,
        tension: f64::INFINITY,
        excess: f64::INFINITY,
        rate: f64::INFINITY,
    };
}

/// What at the end of a window contradicts contact that grows: overlap, tension, a pressure beyond the hardness, or a
/// plastic depth that is negative or falls. Returns the time, from the end on, at which the first of these began by its
/// rate: not after 0, and −∞ where no rate tells; `None` if there is none.
pub(super) fn contradiction(
    run: &LoadingRun,
    (problem, contact, yielded): (&Problem, &ContactSequence, &[usize]),
    (approach, slack): (f64, Slack),
) -> Option<f64> {
    let length = slack.gap;
    let [tension, excess] =
        [slack.tension, slack.excess].map(|u| u / problem.table().self_influence());
    let plastic = run.plastic.as_deref();
    let has_yielded = |node: usize| {
        plastic.is_some_and(|plastic| plastic.has_yielded(node)) || yielded.contains(&node)
    };
    let before = |left: f64, rate: f64| if rate > 0.0 { left / rate } else { f64::NEG_INFINITY };
    let lines = run.field.lines(problem, contact, approach);
    let outside = lines.filter_map(|(node, line)| {
        if !has_yielded(node) {
            return (line.gap < -length).then(|| before(line.gap, line.closing));
        }
        // A plastic depth is not negative and does not fall.
        let recovers = line.gap > length || line.closing < -slack.rate;
        recovers.then_some(f64::NEG_INFINITY)
    });
    let hardness = |node: usize| plastic.map_or(f64::INFINITY, |p| p.hardness().values()[node]);
    let rates = &run.field.solution().rate;
    let pressures = run.field.pressures(contact, approach).zip(rates);
    let inside = pressures.filter_map(|((node, value), &rate)| {
        let left = hardness(node) - value;
        let pulls = (value.is_nan() || value < -tension).then_some(f64::NEG_INFINITY);
        pulls.or_else(|| (left < -excess).then(|| before(left, rate)))
    });
    outside.chain(inside).reduce(f64::min)
}
