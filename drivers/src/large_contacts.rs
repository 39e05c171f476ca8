//! Contacts of more nodes than an updater without a factor looks at together.

use asperity::loading::{History, LoadingEnd};
use asperity::updater::ConjugateGradient;
use asperity::{ContactRule, InfluenceKernel};

use crate::compare::{Bounds, same_path};
use crate::dense::Dense;
use crate::draw::Draw;
use crate::limits::Limit;
use crate::problem::Sample;
use crate::variant::{Run, Solver, Variant};
use crate::verdict::{Tally, Verdict, Violation, ensure};
use crate::walk::{Demands, Walk};

/// Nodes of a side: more than 144 nodes in all, which [`ConjugateGradient`] takes in as a whole.
const SIDES: (usize, usize) = (13, 24);

/// Cells of a periodic half-space on which nodes yield.
const LONGEST: f64 = 100.0;
/// How far states of different windows may be apart, for each unit of the ratio of the sides: fifty times what they
/// were on 24 × 24 nodes of uncorrelated heights.
const AGREEMENT: f64 = 1e-12;

/// Draws a surface on a half-space, on cells from square to 100 times as long as wide, periodic ones to 10 times, and
/// follows its path to full contact with a factor and without. The path without has the same events and is as exact as
/// it says, and some state of that with a factor is looked at densely. Sometimes another one, with a hardness, has the
/// states that it has with windows of one event.
///
/// # Errors
///
/// What is wrong.
pub fn large_contacts(bytes: &[u8]) -> Verdict {
    let mut draw = Draw::new(bytes);
    let shape = (draw.whole(SIDES.0, SIDES.1), draw.whole(SIDES.0, SIDES.1));
    let sample = Sample::half_space(&mut draw, shape, ConjugateGradient::MAX_ASPECT)?;
    let mut tally = run(&sample, &mut draw).map_err(|v| v.during(sample.context()))?;
    if draw.once_in(2) {
        let shape = (draw.whole(SIDES.0, SIDES.1), draw.whole(SIDES.0, SIDES.1));
        let mut sample = match draw.once_in(3) {
            true => Sample::half_space(&mut draw, shape, LONGEST)?,
            false => Sample::of_long_cells(&mut draw, shape)?,
        };
        sample.harden(&mut draw);
        let window = draw.one_of(None, &[Some(8), Some(64)]);
        tally += windows_agree(&sample, window).map_err(|v| v.during(sample.context()))?;
    }
    Ok(tally)
}

/// Where nodes yield a path with a factor has the same states whatever its windows.
fn windows_agree(sample: &Sample, window: Option<usize>) -> Verdict {
    let states = |window: Option<usize>| {
        let variant = Variant { window, ..Variant::REFERENCE };
        match variant.run(sample, &[], |_, _| Ok(()))? {
            Run::Followed { states, failure: None, .. } => Ok(states),
            Run::Refused(error) | Run::Followed { failure: Some(error), .. } => {
                Err(Violation::new(format!("windows of {window:?}: {error}")))
            }
        }
    };
    let (found, single) = (states(window)?, states(Some(1))?);
    ensure!(
        found.len() == single.len(),
        "windows of {window:?}: {} states, and one by one {}",
        found.len(),
        single.len()
    );
    let Some(last) = single.last() else { return Ok(Tally::default()) };
    let grid = sample.kernel.grid();
    // Rounding of heights and pressures, which the condition multiplies: some 20 times the ratio of the sides.
    let rounding = AGREEMENT * grid.cell_aspect();
    // Of a flat surface what its pressures displace a cell by.
    let own = sample.kernel.coefficient(0, 0) / grid.nominal_area();
    let height = sample.surface.peak_to_valley() + last.contact.approach.abs();
    let length = height + own * last.contact.load;
    let force = length / own;
    let mut tally = Tally::default();
    for (state, expected) in found.iter().zip(&single) {
        let (own, other) = (state.contact, expected.contact);
        let what = |violation: Violation| {
            violation.during(format!("windows of {window:?}: {state:?} in place of {expected:?}"))
        };
        tally.close("approach", own.approach, other.approach, rounding * length).map_err(what)?;
        tally.close("load", own.load, other.load, rounding * force).map_err(what)?;
    }
    Ok(tally)
}

fn run(sample: &Sample, draw: &mut Draw<'_>) -> Verdict {
    let grid = sample.kernel.grid();
    // Enough for iterations on the whole grid, and for the factor of a part of it.
    let seam = Some(draw.whole(450, 900) * 2048);
    let mut variant = Variant {
        solver: draw.one_of(Solver::Iterations, &[Solver::Handover(seam)]),
        window: match draw.whole(0, 1) {
            0 => None,
            _ => Some(draw.whole(1, 100)),
        },
        rule: ContactRule::FirstContact,
        limit: Limit::None,
        threads: [draw.whole(1, 3); 2].into(),
    };
    let mut factor = Variant::REFERENCE;
    // Each path once more, on another number of threads.
    if draw.once_in(3) {
        factor.window = variant.window;
        factor.threads.1 = draw.whole(1, 3);
        variant.threads.1 = draw.whole(1, 3);
    }
    let exact = follow(sample, &factor)?;
    let found =
        follow(sample, &variant).map_err(|violation| violation.during(format!("{variant:?}")))?;
    for path in [&exact, &found] {
        ensure!(
            path.events().len() == grid.nodes(),
            "{variant:?}: a path of {} events, and not to full contact",
            path.events().len()
        );
    }
    let dense = Dense::new(&sample.kernel, sample.surface.matrix())
        .in_gauge_of_paths(sample.kernel.contact_growth());
    let mut tally = Tally::default();
    same_path((found.events(), exact.events()), &Bounds::LARGE, &dense, &mut tally)
        .map_err(|violation| violation.during(format!("{variant:?}")))?;
    // One state of the factor beside a dense solution of its contact, which takes longer than the path.
    if draw.once_in(2) {
        let (before, next) = exact.events().split_at(draw.whole(0, grid.nodes() - 1));
        let mut walk = Walk::new(&dense, grid, Demands::EXACT);
        walk.skip(before)?;
        walk.follow(&next[..1])?;
        tally += walk.tally();
    }
    Ok(tally)
}

/// A path to full contact, with the same bits on any number of threads.
fn follow(sample: &Sample, variant: &Variant) -> Result<History, Violation> {
    match variant.run(sample, &[], |_, _| Ok(()))? {
        Run::Refused(error) => Err(Violation::new(format!("it was refused: {error}"))),
        Run::Followed { states, failure: None, end: Some(LoadingEnd::FullContact), .. } => {
            variant.check_threads(sample, &[], &states)?;
            Ok(History::from_iter(states))
        }
        Run::Followed { states, failure, end, .. } => Err(Violation::new(format!(
            "it ended after {} states, {end:?}: {failure:?}",
            states.len()
        ))),
    }
}
