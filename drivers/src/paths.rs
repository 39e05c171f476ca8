//! Whole paths on small grids.

use asperity::contact::ContactFields;
use asperity::loading::{History, LoadingEnd};
use asperity::{ContactGrowth, ContactRule, Error, Grid, InfluenceKernel, LoadingState};

use crate::compare::{Bounds, same_path};
use crate::dense::Dense;
use crate::draw::Draw;
use crate::kernels;
use crate::limits::Limit;
use crate::problem::Sample;
use crate::refusal::Circumstances;
use crate::variant::{Path, Run, Solver, Variant};
use crate::verdict::{Tally, Verdict, Violation};
use crate::walk::{Demands, Walk};

/// Gaps in contact that solutions by iteration leave, relative to the approach:
/// [`ConjugateGradient`](asperity::updater::ConjugateGradient).
const ITERATED: f64 = 1e-10;
/// Error of a solution beyond which iterations are not tried: their tolerance would be below it.
const WELL_CONDITIONED: f64 = 1e-9;

/// Draws a contact problem and follows its path twice: by default, and in another manner that is drawn as well, with
/// another updater, window, rule, limit, number of threads, or from states in its middle. Every state is looked at
/// densely; refusals have to be deserved.
///
/// # Errors
///
/// What is wrong.
pub fn paths(bytes: &[u8]) -> Verdict {
    let mut draw = Draw::new(bytes);
    Sample::look(&mut draw, kernels::ALL, |sample, draw| Trial::new(sample).run(draw))
}

/// A problem, and what is known of it.
pub(crate) struct Trial<'a> {
    pub(crate) sample: &'a Sample,
    pub(crate) grid: Grid,
    pub(crate) dense: Dense,
    pub(crate) circumstances: Circumstances,
}

impl<'a> Trial<'a> {
    pub(crate) fn new(sample: &'a Sample) -> Self {
        let dense = Dense::of_sample(sample).in_gauge_of_paths(sample.kernel.contact_growth());
        Self {
            sample,
            grid: sample.kernel.grid(),
            circumstances: Circumstances::of(&dense, sample.kernel.contact_growth()),
            dense,
        }
    }

    pub(crate) fn run(&self, draw: &mut Draw<'_>) -> Verdict {
        let reference = Variant::REFERENCE;
        let (mut tally, expected) = self
            .follow(&reference, &[], draw)
            .map_err(|violation| violation.during("by default"))?;
        let iterations = self.circumstances.error < WELL_CONDITIONED && draw.once_in(2);
        let mut variant = Variant::draw(draw, iterations);
        let from = match draw.once_in(3) {
            true if variant.rule == ContactRule::FirstContact => draw.whole(0, expected.len()),
            _ => 0,
        };
        let earlier = &expected[..from];
        if from == 0 {
            variant.limit =
                Limit::draw(draw, &expected, &self.grid).unless_rounding(&self.dense, &expected);
        }
        let context = || format!("{variant:?} behind {from} states");
        let windows = self.circumstances.growth != ContactGrowth::Unknown;
        tally += if variant.is_exact() || !windows {
            self.follow(&variant, earlier, draw).map_err(|violation| violation.during(context()))?.0
        } else {
            self.follow_by_iterations(&variant, earlier, &expected)
                .map_err(|violation| violation.during(context()))?
        };
        Ok(tally)
    }

    /// What is accepted of a variant.
    fn circumstances(&self, variant: &Variant) -> Circumstances {
        Circumstances {
            budget: matches!(variant.solver, Solver::Handover(Some(_))),
            tolerance: (!variant.is_exact()).then_some(ITERATED),
            ..self.circumstances
        }
    }

    /// Follows a path whose states are all exact, and looks at each of them.
    fn follow(
        &self,
        variant: &Variant,
        earlier: &[LoadingState],
        draw: &mut Draw<'_>,
    ) -> Result<(Tally, Vec<LoadingState>), Violation> {
        let demands =
            Demands { residual: if variant.is_exact() { 0.0 } else { ITERATED }, ..Demands::EXACT };
        let parts = [draw.unit(), draw.unit()];
        let run = variant.run(self.sample, earlier, |path, states| {
            self.read(path, variant, [earlier, states], demands, parts)
        })?;
        let (states, failure, end, more) = match run {
            Run::Refused(error) => {
                return Ok((self.judge_refusal(variant, &error)?, Vec::new()));
            }
            Run::Followed { states, failure, end, more } => (states, failure, end, more),
        };
        let mut walk = Walk::new(&self.dense, self.grid, demands);
        walk.skip(earlier)?;
        walk.follow(&states)?;
        match end {
            Some(LoadingEnd::NoMoreEvents) => walk.check_no_more_events()?,
            Some(LoadingEnd::FullContact | LoadingEnd::FullyPlastic) => {
                walk.check_nothing_is_left()?;
            }
            _ => (),
        }
        let mut tally = walk.tally();
        tally += more;
        if let Some(error) = failure {
            let circumstances =
                Circumstances { on_the_edge: walk.on_the_edge(), ..self.circumstances(variant) };
            let verdict = circumstances.judge(&error);
            tally += verdict
                .map_err(|violation| violation.during(format!("after {} states", states.len())))?;
        } else if earlier.is_empty() || !states.is_empty() {
            variant.limit.check_end(end, &states, &self.grid)?;
        }
        variant.check_threads(self.sample, earlier, &states)?;
        Ok((tally, states))
    }

    /// Follows a path whose states are estimates between the ends of windows, and compares it with the exact one.
    fn follow_by_iterations(
        &self,
        variant: &Variant,
        earlier: &[LoadingState],
        expected: &[LoadingState],
    ) -> Verdict {
        let run = variant.run(self.sample, earlier, |_, _| Ok(()))?;
        let (states, failure, end) = match run {
            Run::Refused(error) => return self.judge_refusal(variant, &error),
            Run::Followed { states, failure, end, .. } => (states, failure, end),
        };
        let mut tally = Tally::default();
        let events = History::from_iter(states.iter().copied());
        let whole: Vec<LoadingState> = earlier.iter().chain(events.events()).copied().collect();
        if variant.rule == ContactRule::FirstContact {
            let yields = self.dense.hardness().is_some();
            let bounds = if yields { Bounds::SMALL_YIELDING } else { Bounds::SMALL };
            same_path((&whole, expected), &bounds, &self.dense, &mut tally)?;
        }
        if let Some(error) = failure {
            tally += self.circumstances(variant).judge(&error)?;
        } else if earlier.is_empty() || !states.is_empty() {
            variant.limit.check_end(end, &states, &self.grid)?;
        }
        variant.check_threads(self.sample, earlier, &states)?;
        Ok(tally)
    }

    fn judge_refusal(&self, variant: &Variant, error: &Error) -> Verdict {
        let heights = self.sample.surface.matrix();
        let unloaded = heights.map(|height| heights.max() - height).mean();
        if variant.limit.deserves(error, &self.grid, unloaded, self.sample.greatest_load()) {
            return Ok(Tally::refusal());
        }
        self.circumstances(variant)
            .judge(error)
            .map_err(|violation| violation.during("it was refused"))
    }

    /// Fields, certificates and readings of a path, compared with dense ones.
    fn read(
        &self,
        path: &mut Path,
        variant: &Variant,
        [earlier, states]: [&[LoadingState]; 2],
        demands: Demands,
        parts: [f64; 2],
    ) -> Verdict {
        let mut tally = Tally::default();
        let all: Vec<LoadingState> = earlier.iter().chain(states).copied().collect();
        let history = History::from_iter(all.iter().copied());
        let Some(last) = all.last() else {
            return Ok(tally);
        };
        for part in parts {
            let asked = part * last.contact.load;
            let Some(state) = history.at_load(asked) else {
                return Err(Violation::new(format!("no reading at the load {asked:e}")));
            };
            let steps = history.events().partition_point(|s| s.step <= state.step);
            let mut walk = Walk::new(&self.dense, self.grid, demands);
            walk.pass(&history.events()[..steps])?;
            match path.fields_at(&state) {
                Ok(ContactFields { pressure, gap, plastic_depth, .. }) => {
                    let context =
                        |violation: Violation| violation.during(format!("reading {state:?}"));
                    walk.compare_fields(&state, [&pressure, &gap, &plastic_depth])
                        .map_err(context)?;
                    tally += walk.tally();
                    if self.sample.hardness.is_some() {
                        tally += self.beside(path, &state, &walk).map_err(context)?;
                    }
                }
                Err(error) => tally += self.circumstances(variant).judge(&error)?,
            }
        }
        Ok(tally)
    }
}
