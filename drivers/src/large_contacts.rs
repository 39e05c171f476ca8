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

/// Draws a surface on a half-space, on cells from square to 100 times as long as wide, periodic ones to 10 times, and
/// follows its path to full contact with a factor and without. The path without has the same events and is as exact as
/// it says, and some state of that with a factor is looked at densely.
///
/// # Errors
///
/// What is wrong.
pub fn large_contacts(bytes: &[u8]) -> Verdict {
    let mut draw = Draw::new(bytes);
    let shape = (draw.whole(SIDES.0, SIDES.1), draw.whole(SIDES.0, SIDES.1));
    let sample = Sample::half_space(&mut draw, shape, ConjugateGradient::MAX_ASPECT)?;
    run(&sample, &mut draw).map_err(|violation| violation.during(sample.context()))
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
